"""Extremes of a periodic function of smooth pieces, by branch and bound on cells that know their ends' slopes.

The transmission error of a gear set is smooth as long as one tooth pair leads with one kind of contact. Where another
pair takes the lead its slope jumps, where the kind changes its curvature does, and neither place is known beforehand.
Nothing is therefore assumed about convexity: in every cell a cubic takes up values and slopes of the ends, what it
misses at places inside bounds what it may miss elsewhere, and a cell is looked into until it can hold no extreme.

Roots of many scalar functions at once that cannot escape their brackets.
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


_EPS = 4.0 * np.finfo(float).eps


_LAST_STEP = 1e-8


def falling_root(
    function: Callable[..., tuple[Array, Array]], lo: Array, hi: Array, guess: Array, parameters: Parameters
) -> Array:
    """Where functions fall through zero: Newton's method inside a shrinking bracket, bisection where that stalls.

    Parameters
    ----------
    function : callable
        ``function(x, *parameters) -> value, slope``, elementwise on 1-D arrays.
    lo, hi : ndarray, shape (n,)
        Brackets. Where the function is negative at `lo` already, the answer is `lo`; where positive at `hi`, `hi`.
    guess : ndarray, shape (n,)
        Where to start; put into the bracket if outside.
    parameters : tuple of ndarray, each of shape (n,)
        Further arguments, one element per function.

    Returns
    -------
    ndarray, shape (n,)
        Always inside the bracket and accurate to a few units in the last place.
    """
    answer = np.clip(guess, lo, hi)
    which = np.flatnonzero(hi > lo)
    a, b, x = lo[which], hi[which], answer[which]
    scale = np.maximum(np.abs(a), np.abs(b))
    before, last = b - a, b - a
    tried_a, tried_b = np.zeros(which.size, dtype=bool), np.zeros(which.size, dtype=bool)
    parameters = tuple(p[which] for p in parameters)
    for _ in range(120):
        if which.size == 0:
            break
        value, slope = function(x, *parameters)
        a, b = np.where(value >= 0.0, x, a), np.where(value <= 0.0, x, b)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            newton = np.where(slope < 0.0, x - value / slope, np.where(value > 0.0, b, a))
        # A Newton step must stay in the bracket and at least halve the step before the last. A step past an end that
        # has not been tried goes there, because the sign at the end may already be the answer.
        past_a, past_b = (newton <= a) & ~tried_a, (newton >= b) & ~tried_b
        tried_a, tried_b = tried_a | past_a | (value > 0.0), tried_b | past_b | (value < 0.0)
        newton = np.clip(newton, a, b)
        new = np.where((np.abs(newton - x) <= 0.5 * before) | past_a | past_b, newton, 0.5 * (a + b))
        new = np.where(value == 0.0, x, new)
        # Newton's error after a step is of the order of the step squared, so a small step is the last one needed.
        close = (np.abs(new - x) <= _LAST_STEP * scale) & (new == newton)
        before, last, x = last, np.abs(new - x), new
        done = close | (value == 0.0) | (b - a <= _EPS * scale)
        answer[which] = np.where(
            x - lo[which] <= _EPS * scale, lo[which], np.where(hi[which] - x <= _EPS * scale, hi[which], x)
        )
        if done.any():
            keep = ~done
            which, a, b, x, scale = which[keep], a[keep], b[keep], x[keep], scale[keep]
            before, last, tried_a, tried_b = before[keep], last[keep], tried_a[keep], tried_b[keep]
            parameters = tuple(p[keep] for p in parameters)
    return answer


def falling_bracket(
    function: Callable[..., Array], lo: Array, hi: Array, parameters: Parameters, tolerance: Array, zero: float = 0.0
) -> tuple[Array, Array]:
    """Shrink brackets around the place where functions known by value only fall through zero (Chandrupatla).

    The functions may jump: the bracket then closes on the jump. Where a function has one sign throughout, both ends
    of the answer are the end that belongs to that sign.

    Parameters
    ----------
    function : callable
        ``function(x, *parameters) -> value``, elementwise on 1-D arrays; finite.
    lo, hi : ndarray, shape (n,)
        Brackets.
    parameters : tuple of ndarray, each of shape (n,)
        Further arguments.
    tolerance : ndarray, shape (n,)
        Width of the bracket that is small enough.
    zero : float
        Round-off of the function: a value no larger counts as zero, and the place as found.

    Returns
    -------
    lo, hi : ndarray, shape (n,)
        The function is positive at lo and not positive at hi.
    """
    f_lo, f_hi = function(lo, *parameters), function(hi, *parameters)
    out_lo, out_hi = np.where(f_hi > 0.0, hi, lo), np.where(f_lo <= 0.0, lo, hi)
    found = (np.abs(f_lo) <= zero) | (np.abs(f_hi) <= zero)
    nearer = np.where(np.abs(f_lo) <= np.abs(f_hi), lo, hi)
    out_lo, out_hi = np.where(found, nearer, out_lo), np.where(found, nearer, out_hi)
    which = np.flatnonzero((f_lo > 0.0) & (f_hi <= 0.0) & (hi - lo > tolerance) & ~found)
    # b is the newest point, a the other end of the bracket, c the point before (Chandrupatla 1997).
    a, fa, b, fb = lo[which], f_lo[which], hi[which], f_hi[which]
    tol = tolerance[which]
    parameters = tuple(p[which] for p in parameters)
    fraction = np.full(which.size, 0.5)
    for _ in range(200):
        if which.size == 0:
            break
        x = a + fraction * (b - a)
        fx = function(x, *parameters)
        same = (fx > 0.0) == (fa > 0.0)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, fx
        here = np.abs(fa) <= zero
        out_lo[which], out_hi[which] = np.where((fa > 0.0) | here, a, b), np.where((fa > 0.0) & ~here, b, a)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            xi = (a - b) / (c - b)
            phi = (fa - fb) / (fc - fb)
            inverse = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        least = 0.5 * tol / np.maximum(np.abs(b - a), 1e-300)
        smooth = (phi**2 < xi) & ((1.0 - phi) ** 2 < 1.0 - xi) & np.isfinite(inverse)
        fraction = np.clip(np.where(smooth, inverse, 0.5), np.minimum(least, 0.5), np.maximum(1.0 - least, 0.5))
        keep = ~here & (np.abs(b - a) > tol) & (np.spacing(np.abs(a)) < 0.5 * np.abs(b - a))
        if not keep.all():
            which = which[keep]
            a, fa, b, fb, tol, fraction = (v[keep] for v in (a, fa, b, fb, tol, fraction))
            parameters = tuple(p[keep] for p in parameters)
    return out_lo, out_hi
