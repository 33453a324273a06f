"""Modes of a helical pair followed by the continuity of their shapes over a parameter.

A step is taken when every shape resembles its successor (modal assurance) and no two modes have changed places on the
way; else it is halved. So where two modes come near each other, the steps shrink until it shows what happens there:

- the frequencies meet (to within `SAME` of the highest): a crossing, and both shapes go straight through it;
- they stay apart: a veering, in which the two modes exchange their shapes, and each branch goes on as its frequency
  does.

The branches are therefore those of the limit of small steps, and do not depend on the values that were asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import ConvergenceError, InputError
from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel
from fegear.dynamics.train.modes import undamped_modes

Model = HelicalPairModel | ReducedPairModel


#: Frequencies nearer than this share of the highest are one: round-off would mix their shapes.
SAME = 1e-10
#: Share of a step that lies beside its start.
_ASIDE = 1e-4
#: Whether two modes cross or veer is decided where they are so near (share of the highest frequency).
_CLOSE = 1e-6
#: Frequencies that keep apart by less than this share have a veering if shapes are exchanged; they are out of it where
#: they are so many times the least distance apart.
_NARROW, _CLEAR = 0.1, 4.0


class Meeting(NamedTuple):
    """Two branches that meet: at a crossing the gap is zero, at a veering the least one that was seen.

    `first` and `second` count from 0; `gap` is a difference of Lambda.
    """

    value: float
    first: int
    second: int
    gap: float


@dataclass(frozen=True, eq=False)
class FollowedModes:
    """Modes followed over a parameter.

    Parameters
    ----------
    values : ndarray, shape (m,)
        Parameter values.
    ratio : ndarray, shape (m, n)
        Lambda of each branch, numbered by falling frequency at the value from which they are followed.
    shapes : ndarray, shape (m, dof, n)
        Mass-normalised shapes, signs continuous.
    likeness : float
        Least modal assurance between neighbouring steps on any branch.
    crossings : tuple of Meeting
        Where two frequencies coincide.
    veerings : tuple of Meeting
        Where two modes exchange their shapes while a tenth of their frequency or less keeps them apart.
    """

    values: Array
    ratio: Array
    shapes: Array
    likeness: float
    crossings: tuple[Meeting, ...] = ()
    veerings: tuple[Meeting, ...] = ()


class _State(NamedTuple):
    """Modes at one value, in the order of the branches, in coordinates in which the mass is 1.

    `vectors` are orthonormal columns, `matrix` has the squares of Lambda as eigenvalues.
    """

    value: float
    ratio: Array
    vectors: Array
    matrix: Array
    mass: Array


def follow_modes(
    build: Callable[[float], Model], values: ArrayLike, *, start: float | None = None, least: float = 0.8,
    depth: int = 50,
) -> FollowedModes:  # fmt: skip
    """Follow modes by their shape over a parameter such as helix angle or bearing stiffness.

    Parameters
    ----------
    build : callable
        Parameter -> model; masses may change, the number of coordinates may not.
    values : array_like, shape (m,)
        Parameter values, rising.
    start : float, optional
        Value at which the branches are numbered by falling frequency and from which they are followed both ways; the
        first one by default.
    least : float
        Least modal assurance to accept for a step, more than one half.
    depth : int
        Largest number of halvings.

    Raises
    ------
    InputError
        If the values do not rise.
    ConvergenceError
        If modes still change abruptly after that many halvings.
    """
    grid = np.asarray(values, dtype=float)
    if grid.ndim != 1 or grid.size < 1 or not np.all(np.isfinite(grid)) or np.any(np.diff(grid) <= 0.0):
        raise InputError("values", f"{grid.size} values", "must be finite and increasing")
    origin = float(grid[0] if start is None else start)
    first = _first(build, origin, grid)
    up = _Path(build, first, grid[grid >= origin], least, depth)
    down = _Path(build, first, grid[grid < origin][::-1], least, depth)
    states = [*down.states[::-1], *up.states]
    crossings, veerings = _meetings([*down.trail[:0:-1], *up.trail])
    return FollowedModes(
        grid, np.array([s.ratio for s in states]),
        np.array([s.vectors / np.sqrt(s.mass)[:, None] for s in states]), min(up.likeness, down.likeness),
        tuple(sorted({*crossings, *up.crossings, *down.crossings})), tuple(sorted(veerings)),
    )  # fmt: skip


def _modes(build: Callable[[float], Model], value: float) -> _State:
    model = build(value)
    frequency, shape = undamped_modes(model.mass, model.stiffness)
    root = np.sqrt(model.mass)[:, None]
    matrix = model.stiffness / (root * root.T * model.natural_frequency**2)
    return _State(value, frequency / model.natural_frequency, root * shape, matrix, model.mass)


def _first(build: Callable[[float], Model], origin: float, grid: Array) -> _State:
    """Modes at the origin; those of one frequency with the shapes that they have beside it."""
    state = _modes(build, origin)
    others = grid[grid != origin]
    if not others.size or _one_space(state.ratio).sum() == state.ratio.size:
        return state
    beside = _modes(build, origin + _ASIDE * float(others[np.argmin(np.abs(others - origin))] - origin))
    return state._replace(vectors=_straightened(beside.vectors, state.vectors, _one_space(state.ratio)))


class _Path:
    """Branches from a first state over values in one direction; the trail has the steps between them as well."""

    def __init__(self, build: Callable[[float], Model], first: _State, values: Array, least: float, depth: int) -> None:
        self.build, self.least, self.depth = build, least, depth
        self.likeness, self.states, self.trail = 1.0, list[_State](), [first]
        self.crossings = list[Meeting]()
        for value in values:
            self._follow(float(value), depth)
            self.states.append(self.trail[-1])

    def _follow(self, stop: float, left: int) -> None:
        old = self.trail[-1]
        if stop == old.value:
            return
        new = _modes(self.build, stop)
        new, likeness = _matched(old, new, _one_space(new.ratio))
        good = likeness >= self.least and not np.any(_swapped(old, new))
        if not good and (joined := _crossing_pairs(old, new)).any():
            new, likeness = _matched(old, new, joined | np.eye(joined.shape[0], dtype=bool))
            swapped = _swapped(old, new)
            good = likeness >= self.least and not np.any(swapped & ~joined)
            if good:
                self.crossings += [
                    Meeting(_nearest_approach(old, new, a, b)[0], a, b, 0.0)
                    for a, b in np.argwhere(np.triu(swapped)).tolist()
                ]
        if good:
            self.likeness = min(self.likeness, likeness)
            self.trail.append(new)
            return
        middle = 0.5 * (old.value + stop)
        if left == 0 or middle in (old.value, stop):
            raise ConvergenceError(
                f"Mode shapes change abruptly between {old.value:.9g} and {stop:.9g} (MAC {likeness:.2g} after "
                f"{self.depth} bisections): the branches meet. Choose values that avoid this point."
            )
        self._follow(middle, left - 1)
        self._follow(stop, left - 1)


def _nearest_approach(old: _State, new: _State, a: int, b: int) -> tuple[float, float]:
    """Value at which two modes come nearest each other, and how far apart Lambda^2 stays, to first order.

    In the plane of half their difference and their coupling, the two-by-two matrix of the shapes runs along a line;
    its distance from the origin does not depend on which two vectors of their space are taken.
    """
    two = old.vectors[:, [a, b]]
    points = []
    for matrix in (old.matrix, new.matrix):
        block = two.T @ matrix @ two
        points.append(np.array([block[0, 0] - block[1, 1], 2.0 * block[0, 1]]))
    way = points[1] - points[0]
    length = float(way @ way)
    if length == 0.0:
        return old.value, float(np.hypot(*points[0]))
    at = -float(points[0] @ way) / length
    return old.value + at * (new.value - old.value), abs(float(np.linalg.det(points))) / length**0.5


def _crossing_pairs(old: _State, new: _State) -> NDArray[np.bool_]:
    """Neighbours so close that the step shows whether they meet, and that come within `SAME` of each other."""
    count, top = old.ratio.size, float(old.ratio.max())
    found = np.zeros((count, count), dtype=bool)
    for a in range(count):
        for b in range(a + 1, count):
            apart = max(abs(old.ratio[a] - old.ratio[b]), abs(new.ratio[a] - new.ratio[b]))
            if apart <= _CLOSE * top:
                least = _nearest_approach(old, new, a, b)[1]
                found[a, b] = found[b, a] = least <= SAME * top * (old.ratio[a] + old.ratio[b])
    return found


def _meetings(trail: list[_State]) -> tuple[list[Meeting], list[Meeting]]:
    """Crossings and veerings along a trail."""
    crossings, veerings = [], []
    ratio, vectors = np.array([s.ratio for s in trail]), np.array([s.vectors for s in trail])
    for a in range(ratio.shape[1]):
        for b in range(a + 1, ratio.shape[1]):
            apart = np.abs(ratio[:, a] - ratio[:, b])
            near = apart <= SAME * ratio.max(axis=1)
            # Frequencies that are one all along do not meet.
            met = np.flatnonzero(near[1:] & ~near[:-1]) + 1
            crossings += [Meeting(trail[k].value, a, b, 0.0) for k in met]
            for k in np.flatnonzero((apart[1:-1] < apart[:-2]) & (apart[1:-1] <= apart[2:]) & ~near[1:-1]) + 1:
                away = apart >= _CLEAR * apart[k]
                if apart[k] > _NARROW * ratio[k, a] or not (away[:k].any() and away[k:].any()):
                    continue
                before, after = int(np.flatnonzero(away[:k])[-1]), k + int(np.argmax(away[k:]))
                if float(vectors[before, :, a] @ vectors[after, :, b]) ** 2 > 0.5:
                    veerings.append(Meeting(trail[k].value, a, b, float(apart[k])))
    return crossings, veerings


def _matched(old: _State, new: _State, alike: NDArray[np.bool_]) -> tuple[_State, float]:
    """New modes in the order and with the signs of the old ones, and the least modal assurance.

    `alike` says which of the new modes are one space, whose basis is turned to that of the old ones.
    """
    from scipy.optimize import linear_sum_assignment

    assurance = (old.vectors.T @ new.vectors) ** 2
    _, order = linear_sum_assignment(-np.minimum(assurance @ alike, 1.0))
    vectors = _straightened(old.vectors, new.vectors[:, order], alike[np.ix_(order, order)])
    along = np.einsum("ir,ir->r", old.vectors, vectors)
    ratio = np.sqrt(np.maximum(np.einsum("ir,ij,jr->r", vectors, new.matrix, vectors), 0.0))
    ratio = np.where(alike.sum(axis=0)[order] > 1, ratio, new.ratio[order])
    return (
        new._replace(ratio=ratio, vectors=vectors * np.where(along < 0.0, -1.0, 1.0)),
        float((along**2).min()),
    )


def _one_space(ratio: Array) -> NDArray[np.bool_]:
    """Which modes have the frequency of which, (n, n)."""
    return np.asarray(np.abs(ratio[:, None] - ratio[None, :]) <= SAME * max(float(ratio.max()), 1e-300))


def _straightened(target: Array, vectors: Array, alike: NDArray[np.bool_]) -> Array:
    """Vectors of one space turned within it to those that they continue (orthogonal Procrustes)."""
    vectors = vectors.copy()
    for group in {tuple(np.flatnonzero(row)) for row in alike if row.sum() > 1}:
        own = list(group)
        u, _, v = np.linalg.svd(vectors[:, own].T @ target[:, own])
        vectors[:, own] = vectors[:, own] @ (u @ v)
    return vectors


def _swapped(old: _State, new: _State) -> NDArray[np.bool_]:
    """Which branches have changed places by more than frequencies that are one, (n, n)."""
    before, after = (s.ratio[:, None] - s.ratio[None, :] for s in (old, new))
    clear = ~(_one_space(old.ratio) | _one_space(new.ratio))
    return np.asarray(clear & (before * after < 0.0))
