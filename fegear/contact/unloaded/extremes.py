"""Extremes of a periodic function of smooth pieces, by branch and bound on cells that know their ends' slopes.

The transmission error of a gear set is smooth as long as one tooth pair leads with one kind of contact. Where another
pair takes the lead its slope jumps, where the kind changes its curvature does, and neither place is known beforehand.
Nothing is therefore assumed about convexity: in every cell a cubic takes up values and slopes of the ends, what it
misses at places inside bounds what it may miss elsewhere, and a cell is looked into until it can hold no extreme.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array

Pieces = Callable[[Array], tuple[Array, ...]]
Parameters = tuple[NDArray[np.generic], ...]


#: Cells per period to begin with, each with a place in its middle.
CELLS = 96


#: Part of the function's range to which extremes are located.
PRECISION = 1e-8


#: What a cubic may miss in a cell, over what it misses at the places that were looked at. A kink anywhere in the cell
#: leaves at most 3.7 of it, a fourth derivative 1.
_MISSED = 4.0


_ROUNDS = 200


_SIGNS = (-1.0, 1.0)


#: More cells than this are left as they are, with what they may hold counted as error: round-off has no top to find.
_MOST = 1000


@dataclass(frozen=True, slots=True)
class Extreme:
    """An extreme value, where it lies [rad], and how far at most it may be off."""

    value: float
    angle: float
    error: float


@dataclass(frozen=True, slots=True)
class _Cells:
    """Cells with places, values, slopes and piece numbers of their ends, shape (2, n), and what a cubic may miss."""

    x: Array
    f: Array
    d: Array
    piece: Array
    missed: Array

    @property
    def width(self) -> Array:
        return np.asarray(self.x[1] - self.x[0])

    def __getitem__(self, index: NDArray[np.bool_]) -> _Cells:
        return _Cells(self.x[:, index], self.f[:, index], self.d[:, index], self.piece[:, index], self.missed[index])

    def cubic(self, t: Array) -> tuple[Array, Array]:
        """Value and slope at parts t of the width, shape (m, n) or (n,), of the cubic through both ends."""
        h, (fa, fb), (da, db) = self.width, self.f, self.d
        rise = fb - fa
        second, third = 3.0 * rise - h * (2.0 * da + db), h * (da + db) - 2.0 * rise
        return fa + t * (h * da + t * (second + t * third)), da + t * (2.0 * second + 3.0 * t * third) / h

    def highest(self, sign: float) -> tuple[Array, Array]:
        """Largest value of sign * cubic, and the part of the width at which it lies."""
        h, (fa, fb), (da, db) = self.width, self.f, self.d
        rise = fb - fa
        a, b, c = 3.0 * (h * (da + db) - 2.0 * rise), 2.0 * (3.0 * rise - h * (2.0 * da + db)), h * da
        with np.errstate(divide="ignore", invalid="ignore"):
            # Both roots of the derivative without cancellation.
            q = -0.5 * (b + np.copysign(np.sqrt(b * b - 4.0 * a * c), b))
            roots = np.stack([q / a, c / q])
        places = np.stack([np.zeros_like(h), np.ones_like(h), *np.clip(np.nan_to_num(roots), 0.0, 1.0)])
        values = sign * self.cubic(places)[0]
        best = values.argmax(axis=0)
        column = np.arange(h.size)
        return values[best, column], places[best, column]


def extremes(function: Pieces, start: float, period: float, tolerance: float = 1e-13) -> tuple[Extreme, Extreme]:
    """Smallest and largest value of a periodic function of smooth pieces.

    Parameters
    ----------
    function : callable
        Angles [rad] -> values, slopes, numbers of the smooth pieces. Pieces may meet in kinks, and jump.
    start, period : float
        The period to look at [rad].
    tolerance : float
        Bound of the error of the values at which to stop, beside a 1e-8th of their range.

    Returns
    -------
    lowest, highest : Extreme
        The errors are what the cells given up may still hold above the values. They are estimates as far as a piece
        may hide between two neighbouring places, a 192th of the period apart.
    """
    x = start + period * np.arange(2 * CELLS + 1) / (2 * CELLS)
    f, d, piece = (np.append(v, v[:1]) for v in function(x[:-1]))
    if not np.isfinite(f).all():  # somewhere nothing touches
        low, high = int(np.argmin(f)), int(np.argmax(f))
        return Extreme(float(f[low]), float(x[low]), np.inf), Extreme(float(f[high]), float(x[high]), np.inf)
    x_, f_, d_, piece_ = (np.stack([v[:-1:2], v[2::2]]) for v in (x, f, d, piece))
    whole = _Cells(x_, f_, d_, piece_, np.zeros(CELLS))
    cells = _split(whole, x[None, 1::2], (f[None, 1::2], d[None, 1::2], piece[None, 1::2]))
    best = {sign: _best(sign, x, f) for sign in _SIGNS}
    given_up = dict.fromkeys(_SIGNS, -np.inf)
    for _ in range(_ROUNDS):
        limit = tolerance + PRECISION * sum(value for value, _ in best.values())
        bounds = {sign: _bound(cells, sign) for sign in _SIGNS}
        live = {sign: bounds[sign] > best[sign][0] + limit for sign in _SIGNS}
        wide = cells.width > 1e-12 * period
        look = (live[1.0] | live[-1.0]) & wide
        ended = not look.any() or look.sum() > _MOST
        for sign in _SIGNS:
            left = wide if ended else wide & ~look
            given_up[sign] = max(given_up[sign], float(np.max(bounds[sign][left], initial=-np.inf)))
        if ended:
            break
        cells, wanted = cells[look], np.where(live[1.0], 1.0, -1.0)[look]
        places = _places(cells, wanted)
        values = function(places.ravel())
        for sign in _SIGNS:
            best[sign] = max(best[sign], _best(sign, places.ravel(), values[0]))
        cells = _split(cells, places, tuple(v.reshape(places.shape) for v in values))
    lowest, highest = (
        Extreme(sign * best[sign][0], best[sign][1], max(given_up[sign] - best[sign][0], 0.0)) for sign in _SIGNS
    )
    return lowest, highest


def _best(sign: float, x: Array, f: Array) -> tuple[float, float]:
    """Largest value of sign * f, and its place."""
    i = int(np.argmax(sign * f))
    return float(sign * f[i]), float(x[i])


def _bound(cells: _Cells, sign: float) -> Array:
    """What sign * function may reach in each cell."""
    return np.asarray(cells.highest(sign)[0] + cells.missed)


def _places(cells: _Cells, sign: Array) -> Array:
    """Places inside each cell to look at, shape (5, n), rising: its quarters, and both sides of the likeliest extreme.

    Within one piece that is the top of the cubic; between two pieces the crossing of the ends' tangents, which nears a
    kink as Newton's method nears a root.
    """
    h, (fa, fb), (da, db) = cells.width, cells.f, cells.d
    top = np.where(sign > 0.0, cells.highest(1.0)[1], cells.highest(-1.0)[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        kink = np.nan_to_num((fb - fa - h * db) / (h * (da - db)), nan=0.5)
    guess = np.clip(np.where(cells.piece[0] == cells.piece[1], top, kink), 0.02, 0.98)
    parts = np.stack([np.full_like(h, q) for q in (0.25, 0.5, 0.75)] + [guess - 1e-2, guess + 1e-2])
    return np.asarray(np.sort(cells.x[0] + h * parts, axis=0))


def _split(cells: _Cells, places: Array, found: tuple[Array, ...]) -> _Cells:
    """The parts of cells between the places, shape (m, n), with what the cubics through the whole cells missed."""
    f, d, piece = found
    h = cells.width
    value, slope = cells.cubic((places - cells.x[0]) / h)
    missed = _MISSED * np.max(np.abs(f - value) + 0.25 * h * np.abs(d - slope), axis=0)

    def ends(of_cells: Array, inside: Array) -> Array:
        chain = np.concatenate([of_cells[:1], inside, of_cells[1:]])
        return np.stack([chain[:-1].ravel(), chain[1:].ravel()])

    x, slopes, pieces = ends(cells.x, places), ends(cells.d, d), ends(cells.piece, piece)
    # Between two pieces no cubic is to be trusted: the tangents of the ends of one kink part no further than this.
    between = np.where(pieces[0] == pieces[1], 0.0, 0.25 * (x[1] - x[0]) * np.abs(slopes[1] - slopes[0]))
    return _Cells(x, ends(cells.f, f), slopes, pieces, np.tile(missed, places.shape[0] + 1) + between)
