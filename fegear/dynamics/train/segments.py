"""Coordinates in which long trains stay sparse: turns of one part of the train against the next, from halves to pairs.

Natural modes reach over the whole train, so that every shaft's damper couples all of them: the work of a time step
grows with the square of the number of bodies, with tangents with its cube. Here the train is cut in two at a link in
its middle, each half again, down to single bodies, and each cut gives one coordinate: the halves turning against each
other, each as a rigid body, their momenta in balance. These shapes are orthogonal by mass to each other and to the
rigid-body motion, and a link strains only those whose parts it lies in: log n of them.

The equations of a train solved as they stand, for frequencies at which elimination finds no good pivot.

On a loop a body whose own springs hold it at its own resonance leaves nothing to divide by. Gaussian elimination with
pivots finds its way round; steps of refinement with residuals in long floats give back the digits. At low frequency,
where inertia disappears next to stiffness, `star_mesh` is far better: whoever asks compares the bounds of round-off.

Numbers that carry a bound of their own round-off, to first order, for whole arrays of frequencies at once.

The bound counts units of the last place, whatever the length of the floats: times the machine epsilon it is an error.
It says which of two ways to one number kept more digits, and when longer floats are worth their time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.dynamics.train.matrices import elements
from fegear.dynamics.train.network import Network
from fegear.dynamics.train.train import Train

Values = NDArray[np.inexact]
Bounds = NDArray[np.floating]


@dataclass(frozen=True, slots=True)
class Rounded:
    """A value and the size of its round-off in machine epsilons.

    Attributes
    ----------
    value : ndarray, shape (frequencies,)
    error : ndarray, shape (frequencies,)
        Bound of the absolute error, divided by the machine epsilon.
    """

    value: Values
    error: Bounds

    @classmethod
    def given(cls, value: Values) -> Rounded:
        """A number that comes from input: right to its last place."""
        return cls(value, np.abs(value))

    @classmethod
    def zero(cls, like: Values) -> Rounded:
        """Zero, exactly."""
        return cls(np.zeros_like(like), np.zeros(like.shape, dtype=np.abs(like[:0]).dtype))

    def __neg__(self) -> Rounded:
        return Rounded(-self.value, self.error)

    def __add__(self, other: Rounded) -> Rounded:
        value = self.value + other.value
        return Rounded(value, self.error + other.error + np.abs(value))

    def __sub__(self, other: Rounded) -> Rounded:
        value = self.value - other.value
        return Rounded(value, self.error + other.error + np.abs(value))

    def __mul__(self, other: Rounded) -> Rounded:
        size, times = np.abs(self.value), np.abs(other.value)
        return Rounded(self.value * other.value, size * other.error + self.error * times + 2.0 * size * times)

    def __truediv__(self, other: Rounded) -> Rounded:
        by = np.abs(other.value)
        value = self.value / other.value
        return Rounded(value, (self.error + np.abs(value) * other.error) / by + 3.0 * np.abs(value))

    def times(self, factor: float | np.floating) -> Rounded:
        """The number times one that is exact."""
        value = np.multiply(self.value, factor)
        return Rounded(value, np.multiply(self.error, np.abs(factor)) + np.abs(value))


def beside_zero(one: Rounded, other: Rounded) -> Values:
    """The sum of two numbers; where they cancel altogether, a unit of their last place (one, if both are zero)."""
    total = one.value + other.value
    size = np.abs(one.value) + np.abs(other.value)
    last = np.finfo(size.dtype).eps * size
    return np.asarray(np.where(total == 0.0, np.where(last == 0.0, 1.0, last), total))


def share(part: Rounded, rest: Rounded, whole: Values | None = None) -> Rounded:
    """part / (part + rest), each error by its true derivative: a small rest matters little, however uncertain.

    `whole`: their sum, where it is known and kept from zero already.
    """
    whole = beside_zero(part, rest) if whole is None else whole
    size, left, by = np.abs(part.value), np.abs(rest.value), np.abs(whole)
    value = part.value / whole
    return Rounded(value, (left * part.error + size * rest.error) / by**2 + 3.0 * np.abs(value))


def in_series(one: Rounded, other: Rounded, total: Values, elsewhere: Bounds | float = 0.0) -> Rounded:
    """one x other / total, the total being their sum with others whose errors add up to `elsewhere`.

    Each error counts by its true derivative: a huge admittance in series with a small one passes on the small one,
    however uncertain it is itself.
    """
    value = one.value * other.value / total
    size, by = np.abs(total), np.abs(value)
    a, b = np.abs(one.value), np.abs(other.value)
    error = b * np.abs(total - one.value) * one.error + a * np.abs(total - other.value) * other.error
    return Rounded(value, (error / size + by * elsewhere) / size + 3.0 * by)


def segment_shapes(train: Train) -> Array:
    """Rigid-body motion, then one shape for each cut, as columns in rotation angles with unit modal mass.

    Parameters
    ----------
    train : Train

    Returns
    -------
    ndarray, shape (size, size)
    """
    mass = train.inertia * train.ratios**2
    shapes = np.zeros((train.size, train.size))
    shapes[:, 0] = train.ratios / np.sqrt(mass.sum())
    waiting = [_spanning_tree(train)]
    column = 1
    while waiting:
        near = waiting.pop()
        if len(near) < 2:
            continue
        one, other = _halves(near)
        heavy, light = float(mass[one].sum()), float(mass[other].sum())
        # momenta balance: heavy a + light b = 0; unit modal mass: heavy a^2 + light b^2 = 1
        shapes[one, column] = train.ratios[one] * np.sqrt(light / (heavy * (heavy + light)))
        shapes[other, column] = -train.ratios[other] * np.sqrt(heavy / (light * (heavy + light)))
        column += 1
        waiting.extend({node: near[node] & part for node in part} for part in (set(one), set(other)))
    return shapes


def _spanning_tree(train: Train) -> dict[int, set[int]]:
    """Neighbours of each node in a tree of springs over the whole train."""
    all_near: list[list[int]] = [[] for _ in range(train.size)]
    for part in elements(train):
        if part.b >= 0 and part.stiffness > 0.0 and part.a != part.b:
            all_near[part.a].append(part.b)
            all_near[part.b].append(part.a)
    near: dict[int, set[int]] = {0: set()}
    reached = [0]
    for node in reached:
        for other in all_near[node]:
            if other not in near:
                near[other] = {node}
                near[node].add(other)
                reached.append(other)
    return near


def _halves(near: dict[int, set[int]]) -> tuple[list[int], list[int]]:
    """Two connected parts of a tree, as equal as one cut makes them."""
    root = next(iter(near))
    order, parent = [root], {root: root}
    for node in order:
        for other in near[node]:
            if other != parent[node]:
                parent[other] = node
                order.append(other)
    below = dict.fromkeys(order, 1)
    for node in reversed(order[1:]):
        below[parent[node]] += below[node]
    cut = min(order[1:], key=lambda node: abs(2 * below[node] - len(order)))
    inside = {cut}
    for node in order:
        if parent[node] in inside and node != root:
            inside.add(node)
    return sorted(inside), sorted(set(order) - inside)


#: Steps of refinement; each gains what doubles leave of a condition number.
REFINEMENTS = 4


def _add(
    matrix: NDArray[np.clongdouble], a: int, b: int, turn_a: np.floating, turn_b: np.floating, y: np.complexfloating
) -> None:
    """Put in what acts on ``turn_a q_a + turn_b q_b``."""
    for p, turn_p in ((a, turn_a), (b, turn_b)):
        for q, turn_q in ((a, turn_a), (b, turn_b)):
            matrix[p, q] += y * turn_p * turn_q


def _matrix(network: Network, w: np.longdouble) -> NDArray[np.clongdouble]:
    matrix = np.diag((-w * w * network.mass + 1j * w * network.ground).astype(np.clongdouble))
    one = np.longdouble(1.0)
    for link in network.links:
        _add(matrix, link.a, link.b, one, -one, link.stiffness + 1j * w * link.damping)
    for slip in network.slips:
        _add(matrix, slip.a, slip.b, slip.turn_a, slip.turn_b, 1j * w * slip.damping)
    return matrix


def lags_by_pivots(network: Network, w: NDArray[np.longdouble], mesh: int) -> list[Rounded]:
    """Difference of approach of every gear pair per unit force on the approach of one [m/N].

    Parameters
    ----------
    network : Network
        In long floats.
    w : ndarray, shape (frequencies,)
        Angular frequencies [rad/s], positive.
    mesh : int
        The gear pair on which the force acts.
    """
    count, eps = network.turns.size, np.finfo(np.longdouble).eps
    rows = np.zeros((count, network.size), dtype=np.longdouble)
    for link in network.links:
        if link.mesh >= 0:
            rows[link.mesh, link.a] += network.turns[link.mesh]
            rows[link.mesh, link.b] -= network.turns[link.mesh]
    value = np.zeros((count, w.size), dtype=np.clongdouble)
    error = np.full((count, w.size), np.inf, dtype=np.longdouble)
    for n, at in enumerate(w):
        matrix = _matrix(network, at)
        # equal scales on the diagonal, so that light bodies have their say among heavy ones
        scale = 1.0 / np.sqrt(np.abs(matrix).sum(axis=1))
        matrix = scale[:, None] * matrix * scale
        load = scale * rows[mesh]
        try:
            inverse = np.linalg.inv(matrix.astype(complex))
        except np.linalg.LinAlgError:
            continue
        x = np.zeros(network.size, dtype=np.clongdouble)
        for _ in range(REFINEMENTS):
            change = inverse @ (load - matrix @ x).astype(complex)
            x = x + change
        residual = 4.0 * (np.abs(matrix) @ np.abs(x) + np.abs(load))
        value[:, n] = rows @ (scale * x)
        scaled = rows * scale
        error[:, n] = np.abs(scaled.astype(float) @ inverse) @ residual + np.abs(scaled) @ np.abs(change) / eps
    return [Rounded(value[i], error[i]) for i in range(count)]
