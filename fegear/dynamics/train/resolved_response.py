"""Frequencies at which a response is drawn: dense where it bends, upon every resonance and down into every zero.

An even grid steps over what is narrower than its spacing. Here every natural frequency is a point of its own, and
intervals are halved until the logarithm of each amplitude runs straight in them to within a tolerance.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array

#: How far the logarithm of an amplitude may lie beside the drawn line (1 % of the amplitude).
BEND = 0.01
#: Intervals get no shorter than this share of the range: six decades up a pole, or down into a zero.
SHORTEST = 1e-6
#: Amplitudes below this share of a curve's median are not resolved, nor is a curve below `_NOTHING` of the others.
_FLOOR, _NOTHING = 1e-9, 1e-12
#: Rounds of halving, and points at most.
_ROUNDS, _MOST = 40, 60_000


def resolved_grid(
    response: Callable[[Array], Array], grid: ArrayLike, poles: ArrayLike = (), undamped: ArrayLike = (),
) -> Array:  # fmt: skip
    """Points over which all amplitudes can be drawn with straight lines.

    Parameters
    ----------
    response : callable
        Points, shape (n,) -> amplitudes, shape (n, ...), not negative.
    grid : array_like, shape (m,)
        Points to begin with, rising; their ends are kept.
    poles : array_like
        Where peaks may be narrower than the grid (damped natural frequencies): points of their own.
    undamped : array_like
        Where the response is unbounded: approached from both sides, never evaluated. `broken` parts the line there.

    Returns
    -------
    ndarray, shape (p,)
        Rising; without the undamped poles themselves.
    """
    start = np.asarray(grid, dtype=float)
    low, high = float(start[0]), float(start[-1])
    near = SHORTEST * (high - low)

    def inside(points: ArrayLike) -> Array:
        given = np.asarray(points, dtype=float)
        return given[(given >= low) & (given <= high)]

    infinite = np.unique(inside(undamped))
    beside = np.concatenate([infinite - near, infinite + near])
    x = np.unique(np.concatenate([start, inside(poles), inside(beside)]))
    if infinite.size:
        x = x[np.abs(x[:, None] - infinite).min(axis=1) >= 0.5 * near]
    y = _flat(response(x))
    usual = np.where(np.median(y, axis=0) > 0.0, np.median(y, axis=0), y.max(axis=0))
    floor = np.maximum(_FLOOR * usual, _NOTHING * usual.max(initial=0.0)) + np.finfo(float).tiny
    size = np.log(np.maximum(y, floor))
    active = np.ones(x.size - 1, dtype=bool)
    for _ in range(_ROUNDS):
        active &= np.diff(x) > near
        if infinite.size:  # no interval with a pole in it is halved: its ends stand right beside it
            active &= np.searchsorted(infinite, x[1:]) == np.searchsorted(infinite, x[:-1])
        index = np.flatnonzero(active)
        if not index.size or x.size > _MOST:
            break
        middle = 0.5 * (x[index] + x[index + 1])
        between = np.log(np.maximum(_flat(response(middle)), floor))
        bent = (np.abs(between - 0.5 * (size[index] + size[index + 1])) > BEND).any(axis=1)
        # Halves of a bent interval and the neighbours of both are looked at again.
        again = np.zeros(x.size - 1, dtype=bool)
        again[index[bent]] = True
        grown = again | np.append(again[1:], False) | np.insert(again[:-1], 0, False)
        order = np.argsort(np.concatenate([x, middle]), kind="stable")
        x, size = np.concatenate([x, middle])[order], np.concatenate([size, between])[order]
        parted = np.zeros(grown.size, dtype=int)
        parted[index] = 1
        active = np.repeat(grown, 1 + parted)
    return x


def _flat(amplitudes: Array) -> Array:
    """Amplitudes of all curves that are any, shape (n, k)."""
    return np.asarray(amplitudes, dtype=float).reshape(len(amplitudes), -1)


def broken(x: Array, y: Array, at: ArrayLike) -> tuple[Array, Array]:
    """A curve with a gap at every point `at` that it passes: nothing is drawn across a pole.

    Parameters
    ----------
    x : ndarray, shape (p,)
    y : ndarray, shape (p, ...)
    at : array_like
    """
    places = np.asarray(at, dtype=float)
    places = places[(places > x[0]) & (places < x[-1])]
    where = np.searchsorted(x, places)
    return np.insert(x, where, places), np.insert(y, where, np.nan, axis=0)
