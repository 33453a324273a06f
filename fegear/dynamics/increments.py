"""Dynamic increment functions Q_ij of any gear train, free of cancellation at every frequency.

Q_ij(w) is the dynamic increment of the transmission error of gear pair i per unit static transmission error of gear
pair j: W_i = Q_ij zeta_j / C_i (W. D. Mark, transfer function method, Eqs. 2.58 to 2.60, for any number of meshes).

Formed as Mark writes them, R (H_11 + H_21) - 1, they lose all digits at low frequency, where the train turns as a
rigid body: Q_II falls like w or w^2 while its two terms stay at one. Here the angles are divided by the speed ratios,
which turns the train into an electrical network: every elastic element joins two nodes, and only inertia and dampers
to ground leak out. Nodes are eliminated one by one (star to mesh) with the leaks kept apart from the links, so that
no leak is ever lost beside a stiffness (the idea of Grassmann, Taksar and Heyman for Markov chains). Two right-hand
sides are solved together and the better one is taken entry by entry:

- *from above* (fast): the teeth push at mesh j with k zeta; good where inertia keeps the train still;
- *from below* (slow): the train is cut at mesh j and one side turned against the other without strain, their centre of
  leakage at rest; only leaks act on the difference, so that small results come from small numbers. This is
  Q_ii = -D(mesh i removed)/D in another form.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.matrices import Element, elements
from fegear.errors import RangeError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from fegear.dynamics.train import Train

    Array = NDArray[np.float64]
    ComplexArray = NDArray[np.complexfloating]

#: What is left of the last pivot beside its terms when a frequency counts as an undamped resonance.
RESONANCE = 1e-12
#: Estimated relative round-off beyond which a frequency is solved again with longer floats.
DOUBTFUL = 1e-12
#: Frequencies solved together, so that the arrays stay in the cache.
BLOCK = 1024


def dynamic_increments(train: Train, omega: ArrayLike) -> ComplexArray:
    """Dynamic increment functions of every ordered pair of meshes.

    Parameters
    ----------
    train : Train
        The gear train; its meshes carry their mean stiffness 1/C.
    omega : array_like, shape (...)
        Angular frequency [rad/s], zero included (the static limit); negative values give the complex conjugate.

    Returns
    -------
    ndarray, shape (meshes, meshes, ...)
        Q[i, j]: from the static transmission error of mesh j to C_i times the force of mesh i.

    Raises
    ------
    RangeError
        If a frequency is not finite, or meets a resonance without damping.
    """
    w = np.asarray(omega, dtype=float)
    flat = np.abs(w).ravel()
    if not np.all(np.isfinite(flat)):
        raise RangeError("frequency", "nan or inf", "must be finite")
    network = _Network.of(train)
    count = len(train.meshes)
    found = np.empty((count, count, flat.size), dtype=complex)
    for start in range(0, flat.size, BLOCK):
        part = slice(start, start + BLOCK)
        q, doubt = network.increments(flat[part])
        weak = np.any(doubt > DOUBTFUL * np.abs(q), axis=(0, 1))
        if np.any(weak):
            q[:, :, weak] = network.careful(flat[part][weak], q[:, :, weak], doubt[:, :, weak])
        found[:, :, part] = q
    negative = (w < 0.0).ravel()
    found[:, :, negative] = np.conj(found[:, :, negative])
    return found.reshape((count, count, *w.shape))


def _spanning_sides(size: int, links: Sequence[Element], weights: Array, cut: int) -> NDArray[np.bool_]:
    """Nodes on the `a` side of link `cut`, when it is cut out of the stiffest spanning tree that holds it."""
    order = [cut, *(int(k) for k in np.argsort(-weights, kind="stable") if k != cut)]
    label = list(range(size))
    tree: list[Element] = []
    for k in order:
        link = links[k]
        if label[link.a] != label[link.b]:
            old, new = label[link.b], label[link.a]
            label = [new if value == old else value for value in label]
            if k != cut:
                tree.append(link)
    side = np.zeros(size, dtype=bool)
    side[links[cut].a] = True
    grown = True
    while grown:
        grown = False
        for link in tree:
            if side[link.a] != side[link.b]:
                side[[link.a, link.b]] = True
                grown = True
    return side


@dataclass(frozen=True)
class _Network:
    """The train as a network of admittances in the angles divided by the speed ratios.

    `ends`: the two nodes of each link; `turns`: what its two nodes add to its approach; `excess`: their sum, zero
    when the link follows the rigid-body motion.
    """

    train: Train
    links: tuple[Element, ...]
    leaks: tuple[Element, ...]
    turns: Array
    excess: Array
    sides: NDArray[np.bool_]

    @classmethod
    def of(cls, train: Train) -> _Network:
        parts = elements(train)
        links = tuple(part for part in parts if part.b >= 0)
        leaks = tuple(part for part in parts if part.b < 0)
        ratio = train.ratios
        turns = np.array([[p.radius_a * ratio[p.a], p.radius_b * ratio[p.b]] for p in links]).reshape(-1, 2)
        geared = np.array([p.geared for p in links], dtype=bool)
        turns[geared, 1] = -turns[geared, 0]
        excess = np.where(geared, 0.0, turns.sum(axis=1))
        stiffness = np.array([p.stiffness for p in links])
        # a tree is chosen by stiffness: dampers close it only where no spring can
        weights = stiffness * turns[:, 0] ** 2 if links else stiffness
        sides = np.array([_spanning_sides(train.size, links, weights, m) for m in range(len(train.meshes))])
        return cls(train, links, leaks, turns, excess, sides.reshape(-1, train.size))

    def careful(self, w: Array, q: ComplexArray, doubt: Array) -> ComplexArray:
        """Improve increments in doubt: longest floats there are, every node in turn as the root, the best of each.

        What cancels is a small force beside larger ones that balance; it is exact when summed from the side of the
        train where nothing larger flows, and which side that is depends on the root of the elimination.
        """
        long = w.astype(np.longdouble)
        for root in range(self.train.size):
            other, other_doubt = self.increments(long, root)
            better = other_doubt < doubt
            q, doubt = np.where(better, other, q), np.where(better, other_doubt, doubt)
        return q

    def _ground(self) -> int:
        """The node with the most damping to ground, or the heaviest one."""
        held = np.zeros(self.train.size)
        for part in self.leaks:
            held[part.a] += part.damping * self.train.ratios[part.a] ** 2
        return int(np.argmax(held if held.any() else self.train.inertia * self.train.ratios**2))

    def _rank(self, root: int) -> NDArray[np.intp]:
        """Order of elimination: nodes far from the root first."""
        distance = np.full(self.train.size, self.train.size)
        distance[root] = 0
        for _ in range(self.train.size):
            for link in self.links:
                near = min(distance[link.a], distance[link.b]) + 1
                distance[link.a], distance[link.b] = min(distance[link.a], near), min(distance[link.b], near)
        rank = np.empty(self.train.size, dtype=np.intp)
        rank[np.argsort(-distance, kind="stable")] = np.arange(self.train.size)
        return rank

    def increments(self, w: NDArray[np.floating], root: int = -1) -> tuple[ComplexArray, Array]:
        """Q[i, j, frequency] and an estimate of its round-off, in the precision of `w`."""
        kind = np.result_type(w.dtype, np.complex64)
        size, meshes = self.train.size, len(self.train.meshes)
        yq = [link.stiffness + 1j * w * link.damping for link in self.links]
        Y = np.zeros((w.size, size, size), dtype=kind)
        leak = np.zeros((w.size, size), dtype=kind)
        leak += -np.square(w)[:, None] * self.train.inertia * self.train.ratios**2
        for part in self.leaks:
            leak[:, part.a] += 1j * w * part.damping * self.train.ratios[part.a] ** 2
        for link, y, turn, over in zip(self.links, yq, self.turns, self.excess, strict=True):
            Y[:, link.a, link.b] -= y * turn[0] * turn[1]
            Y[:, link.b, link.a] -= y * turn[0] * turn[1]
            leak[:, link.a] += y * turn[0] * over
            leak[:, link.b] += y * turn[1] * over
        rhs, total, start = self._right_hand_sides(w, yq, leak)
        lag, doubt = _eliminate(Y, leak, rhs, total, w, self._rank(self._ground() if root < 0 else root))

        found = np.empty((meshes, meshes, w.size), dtype=kind)
        error = np.empty((meshes, meshes, w.size))
        for i in range(meshes):
            a, b, turn = self.links[i].a, self.links[i].b, self.turns[i, 0]
            for j in range(meshes):
                own = 1.0 if i == j else 0.0
                above = turn * lag[:, a, b, j] - own
                crossing = np.zeros(w.size, dtype=kind)
                if i != j and self.sides[j, a] != self.sides[j, b]:
                    crossing = turn * (start[:, j, a] - start[:, j, b])
                k = meshes + j
                below = turn * lag[:, a, b, k] + crossing
                # the one whose terms are smaller has the smaller round-off
                doubt_above = abs(turn) * doubt[:, a, b, j] + own
                doubt_below = abs(turn) * doubt[:, a, b, k] + np.abs(crossing)
                best = np.where(doubt_below <= doubt_above, below, above)
                stiffness_i, stiffness_j = self.links[i].stiffness, self.links[j].stiffness
                scale = (yq[i] / stiffness_i) * (stiffness_j / yq[j])
                found[i, j] = best * scale
                error[i, j] = np.finfo(w.dtype).eps * np.minimum(doubt_below, doubt_above) * np.abs(scale)
        return found, error

    def _right_hand_sides(
        self, w: NDArray[np.floating], yq: list[ComplexArray], leak: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """Columns from above, then from below; what each column sums to; and the strain-free turns of the cut train."""
        size, meshes = self.train.size, len(self.train.meshes)
        rhs = np.zeros((w.size, size, 2 * meshes), dtype=leak.dtype)
        start = np.zeros((w.size, meshes, size), dtype=leak.dtype)
        inertia = -np.square(w)[:, None] * self.train.inertia * self.train.ratios**2
        slips = self._slipping(w)
        for j in range(meshes):
            link, turn = self.links[j], self.turns[j]
            rhs[:, link.a, j] += yq[j] * turn[0]
            rhs[:, link.b, j] += yq[j] * turn[1]
            side = self.sides[j]
            near, far = leak[:, side].sum(axis=1), leak[:, ~side].sum(axis=1)
            both = near + far
            still = both == 0.0
            scale = np.where(still, 1.0, both * turn[0])
            start[:, j, side] = np.where(still, 0.5 / turn[0], far / scale)[:, None]
            start[:, j, ~side] = np.where(still, -0.5 / turn[0], -near / scale)[:, None]
            k = meshes + j
            rhs[:, :, k] = -inertia * start[:, j]
            heavy = inertia[:, side].sum(axis=1), inertia[:, ~side].sum(axis=1)
            for y, row in slips:
                # the slip is formed from the *other* leaks: its own part cancels exactly, and would leave only noise
                on, off = row[side].sum(), row[~side].sum()
                slip = on * heavy[1] - off * heavy[0]
                for y2, row2 in slips:
                    slip = slip + y2 * row2.sum() * (on * row2[~side].sum() - off * row2[side].sum())
                rhs[:, :, k] -= (y * slip / scale)[:, None] * row
            for n, other in enumerate(self.links):
                if n == j or not other.geared or side[other.a] == side[other.b]:
                    continue
                # another path across the cut, strained by the turn
                force = yq[n] * self.turns[n, 0] ** 2 * (start[:, j, other.a] - start[:, j, other.b])
                rhs[:, other.a, k] -= force
                rhs[:, other.b, k] += force
        return rhs, np.zeros((w.size, 2 * meshes), dtype=leak.dtype), start

    def _slipping(self, w: NDArray[np.floating]) -> list[tuple[ComplexArray, Array]]:
        """Dampers that the rigid-body motion works: admittance, and slip per turn of each node."""
        found = []
        for link, turn in zip(self.links, self.turns, strict=True):
            if not link.geared:
                row = np.zeros(self.train.size)
                row[link.a], row[link.b] = turn
                found.append((1j * w * link.damping, row))
        for part in self.leaks:
            row = np.zeros(self.train.size)
            row[part.a] = self.train.ratios[part.a]
            found.append((1j * w * part.damping, row))
        return found


def _eliminate(
    Y: ComplexArray,
    leak: ComplexArray,
    rhs: ComplexArray,
    total: ComplexArray,
    w: NDArray[np.floating],
    rank: NDArray[np.intp],
) -> tuple[ComplexArray, Array]:
    """Solve (diag(leak + sum Y) - Y) q = rhs for every frequency, leaks and sums kept apart from the links.

    `total` is the exact sum of each right-hand side over the nodes. The last node takes what is left of it or its own
    entry, whichever lost less to cancellation. Returned are the differences q_a - q_b, formed from what pulls at each
    node and never by subtraction, shape (frequencies, size, size, columns), and the size of the terms they came from.
    """
    frequencies, size, _ = Y.shape
    row = np.arange(frequencies)
    left = np.broadcast_to(np.arange(size), (frequencies, size)).copy()
    bound, rhs_bound, total_bound = np.abs(leak), np.abs(rhs), np.abs(total)
    steps = []
    for _ in range(size - 1):
        pivot = leak + Y.sum(axis=2)
        terms = bound + np.abs(Y).sum(axis=2)
        quality = np.abs(pivot) / np.where(terms == 0.0, 1.0, terms)
        # in the given order, unless a node is near a resonance of its own
        chosen = np.argmax(np.where(quality >= 0.5, 1.0 + size - rank[left], quality), axis=1)
        keep = np.argsort(np.arange(left.shape[1])[None, :] == chosen[:, None], axis=1, kind="stable")[:, :-1]
        S = pivot[row, chosen]
        S = np.where(S == 0.0, np.maximum(1e-16 * terms[row, chosen], np.finfo(float).tiny), S)
        y = Y[row[:, None], chosen[:, None], keep]
        b = rhs[row, chosen]
        leak_p, bound_p = leak[row, chosen], bound[row, chosen]
        steps.append(
            (
                left[row, chosen],
                np.take_along_axis(left, keep, axis=1),
                y,
                b,
                leak_p,
                S,
                rhs_bound[row, chosen],
                bound_p,
            )
        )
        part = y / S[:, None]
        Y = Y[row[:, None, None], keep[:, :, None], keep[:, None, :]] + part[:, :, None] * y[:, None, :]
        index = np.arange(keep.shape[1])
        Y[:, index, index] = 0.0
        leak = np.take_along_axis(leak, keep, axis=1) + part * leak_p[:, None]
        bound = np.take_along_axis(bound, keep, axis=1) + np.abs(part) * bound_p[:, None]
        b_bound = rhs_bound[row, chosen]
        rhs = rhs[row[:, None], keep] + part[:, :, None] * b[:, None, :]
        rhs_bound = rhs_bound[row[:, None], keep] + np.abs(part)[:, :, None] * b_bound[:, None, :]
        total = total - b * (leak_p / S)[:, None]
        total_bound = total_bound + b_bound * np.abs(leak_p / S)[:, None]
        left = np.take_along_axis(left, keep, axis=1)
    q = np.zeros((frequencies, size, rhs.shape[2]), dtype=rhs.dtype)
    last, limit = leak[:, 0], bound[:, 0]
    resonant = (np.abs(last) < RESONANCE * limit) & (w > 0.0)
    if np.any(resonant):
        where = float(w[resonant][0]) / (2.0 * math.pi)
        raise RangeError(
            "frequency",
            f"{where:.9g} Hz",
            "is a natural frequency of the train without damping: the response has no bound",
            "give the train damping or leave this frequency out",
        )
    own = total_bound <= rhs_bound[:, 0]
    load = np.where(own, total, rhs[:, 0])
    floor = np.where(last == 0.0, 1.0, last)[:, None]
    held = np.where(last == 0.0, 0.0, 1.0)[:, None]
    q[row, left[:, 0]] = held * load / floor
    # sizes of the terms behind each result: round-off times these bounds its error
    behind = np.zeros(q.shape, dtype=bound.dtype)
    behind[row, left[:, 0]] = held * np.where(own, total_bound, rhs_bound[:, 0]) / np.abs(floor)
    lag = np.zeros((frequencies, size, size, rhs.shape[2]), dtype=rhs.dtype)
    doubt = np.zeros(lag.shape, dtype=bound.dtype)
    for node, others, y, b, leak_p, S, b_bound, leak_bound in reversed(steps):
        known, known_behind = q[row[:, None], others], behind[row[:, None], others]
        pair = row[:, None, None], others[:, :, None], others[:, None, :]
        size_y, size_S = np.abs(y), np.abs(S)[:, None]
        value = (b + np.einsum("fa,fam->fm", y, known)) / S[:, None]
        value_behind = (b_bound + np.einsum("fa,fam->fm", size_y, known_behind)) / size_S
        # the difference to each node known already: from what pulls at this one, or by subtraction
        pull = b[:, None, :] - leak_p[:, None, None] * known
        pull = (pull + np.einsum("fb,fbam->fam", y, lag[pair])) / S[:, None, None]
        pull_behind = b_bound[:, None, :] + leak_bound[:, None, None] * known_behind
        pull_behind = (pull_behind + np.einsum("fb,fbam->fam", size_y, doubt[pair])) / size_S[:, :, None]
        plain_behind = value_behind[:, None, :] + known_behind
        across = np.where(pull_behind <= plain_behind, pull, value[:, None, :] - known)
        least = np.minimum(pull_behind, plain_behind)
        lag[row[:, None], node[:, None], others], lag[row[:, None], others, node[:, None]] = across, -across
        doubt[row[:, None], node[:, None], others] = doubt[row[:, None], others, node[:, None]] = least
        q[row, node], behind[row, node] = value, value_behind
    return lag, doubt
