"""Fourier coefficients of periodic functions with jumps and kinks: Gauss quadrature piece by piece.

A sampled transform of a function with jumps converges like 1/N; between the break points the function is smooth, and
Gauss quadrature converges there faster than any power.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.brief import Brief
from fegear.base.errors import InputError

#: Ratio of neighbouring distances above which round-off in the nearer value would decide the vertex of a parabola.
_UNEVEN = 8.0


@dataclass(frozen=True, slots=True)
class Panels:
    """Quadrature points over one period, none of them on a break point.

    Parameters
    ----------
    x : ndarray, shape (Q,)
        Points [m], ascending.
    weights : ndarray, shape (Q,)
        [m]; they add up to the period. Zero at points beside break points that are there for extremes only.
    period : float
        [m].
    breaks : ndarray
        Break points [m], first and last one period apart.
    kinks : bool
        Whether there may be kinks between break points, too: a parabola through three points beside one rises above it.
    """

    x: Array
    weights: Array
    period: float
    breaks: Array
    kinks: bool = False

    def highest(self, values: Array) -> float:
        """Largest value of a function known at the points, shape (Q,), and between them where it turns smoothly.

        Between three points of one piece, the highest in the middle, it is the vertex of the parabola through them;
        not where they stand too unevenly for that, beside break points, where they are close together anyway.
        """
        i = int(np.argmax(values))
        top = float(values[i])
        piece = np.searchsorted(self.breaks, self.x[max(i - 1, 0) : i + 2], side="right")
        if piece.size < 3 or piece[0] != piece[2]:
            return top
        before, after = self.x[i] - self.x[i - 1], self.x[i + 1] - self.x[i]
        if not 0.0 < max(before, after) <= _UNEVEN * min(before, after):
            return top
        falls, rises = (top - values[i + 1]) / after, (top - values[i - 1]) / before
        bend = (falls + rises) / (before + after)
        if not bend > 0.0:
            return top
        slope = (rises * after - falls * before) / (before + after)
        above = float(slope * slope / (4.0 * bend))
        return top + (min(above, self._kink_above(values, i)) if self.kinks else above)

    def _kink_above(self, values: Array, i: int) -> float:
        """How far the lines through both points before and both behind a largest value meet above it, at least 0.

        That is where a kink between them is, and above any smooth top; infinite where the lines do not meet there.
        """
        if not 1 < i < values.size - 2:
            return math.inf
        x, f = self.x[i - 2 : i + 3] - self.x[i], values[i - 2 : i + 3] - values[i]
        if not (x[1] > x[0] and x[4] > x[3]):
            return math.inf
        rise, fall = (f[1] - f[0]) / (x[1] - x[0]), (f[4] - f[3]) / (x[4] - x[3])
        if not rise > fall:
            return math.inf
        at = float(f[3] - f[1] + rise * x[1] - fall * x[3]) / (rise - fall)
        return max(float(f[1] + rise * (at - x[1])), 0.0) if x[1] <= at <= x[3] else math.inf


#: Distance from break points at which both sides of them are looked at [periods]: beyond the slack that a pair at the
#: end of the path is given.
SIDE = 1e-9


def panels(
    start: float, period: float, breaks: ArrayLike = (), waves: int = 12, order: int = 16, *, ends: bool = False
) -> Panels:
    """Lay composite Gauss quadrature over one period, between break points.

    Each piece is mapped by 3 s^2 - 2 s^3, which crowds the points at its ends: where a pair comes into contact the load
    starts like d / ln(1/d), whose derivatives are infinite.

    Parameters
    ----------
    start, period : float
        [m].
    breaks : array_like
        Places of jumps and kinks [m], brought into the period.
    waves : int
        Highest harmonic that will be asked for; about two waves go to each subdivision.
    order : int
        Points per subdivision.
    ends : bool
        Whether points without weight stand beside the break points, where functions have their one-sided extremes.
    """
    inside = np.mod(np.asarray(breaks, dtype=float) - start, period)
    edges = np.unique(np.concatenate([[0.0], inside, [period]]))
    keep = np.concatenate([[True], np.diff(edges) > 1e-12 * period])
    edges = edges[keep]
    edges[-1] = period
    t, w = _gauss(order)
    t, w = 0.5 * (t + 1.0), 0.5 * w
    xs, ws = [], []
    for a, b in pairwise(edges):
        parts = max(1, math.ceil(1.5 * waves * (b - a) / period / (0.16 * order)))
        s = (np.arange(parts)[:, None] + t).ravel() / parts
        at, weights = s * s * (3.0 - 2.0 * s), np.tile(w, parts) / parts * 6.0 * s * (1.0 - s)
        aside = min(SIDE * period / (b - a), 0.5)
        if ends:
            # Of a narrow piece no point may stand nearer to a jump than that: it would belong to the other side.
            at = np.concatenate([[aside], np.clip(at, aside, 1.0 - aside), [1.0 - aside]])
            weights = np.concatenate([[0.0], weights, [0.0]])
        xs.append(a + (b - a) * at)
        ws.append((b - a) * weights)
    return Panels(start + np.concatenate(xs), np.concatenate(ws), period, start + edges)


@functools.cache
def _gauss(order: int) -> tuple[Array, Array]:
    """Points and weights between -1 and 1: their eigenvalues take longer than laying the points."""
    return np.polynomial.legendre.leggauss(order)


@dataclass(frozen=True, slots=True)
class FourierSeries(Brief):
    """Fourier series f(x) = sum_n c_n exp(2 pi i n x / A), f real.

    Parameters
    ----------
    coefficients : ndarray, shape (N + 1, ...)
        c_0 to c_N; the negative ones are their conjugates.
    period : float
        A [m].
    """

    coefficients: NDArray[np.complex128]
    period: float

    @property
    def mean(self) -> Array:
        """c_0."""
        return np.asarray(self.coefficients[0].real)

    @property
    def cosine(self) -> Array:
        """Factors of cos(2 pi n x / A), n = 1..N (0-peak)."""
        return np.asarray(2.0 * self.coefficients[1:].real)

    @property
    def sine(self) -> Array:
        """Factors of sin(2 pi n x / A), n = 1..N (0-peak)."""
        return np.asarray(-2.0 * self.coefficients[1:].imag)

    @property
    def amplitude(self) -> Array:
        """Amplitudes, n = 1..N (0-peak)."""
        return np.asarray(2.0 * np.abs(self.coefficients[1:]))

    def evaluate(self, x: ArrayLike) -> Array:
        """The partial sum at x [m], shape of x followed by the series' own."""
        at = np.asarray(x, dtype=float)
        n = np.arange(1, self.coefficients.shape[0])
        waves = np.exp(2j * math.pi / self.period * np.multiply.outer(at, n))
        return np.asarray(self.coefficients[0].real + 2.0 * (waves @ self.coefficients[1:]).real)


def fourier_series(points: Panels, values: ArrayLike, harmonics: int) -> FourierSeries:
    """Coefficients of a function known at the quadrature points.

    Parameters
    ----------
    points : Panels
    values : array_like, shape (Q, ...)
    harmonics : int
        N.
    """
    f = np.asarray(values, dtype=float)
    weighted = (points.weights / points.period).reshape(-1, *[1] * (f.ndim - 1)) * f
    waves = _powers(np.exp(-2j * math.pi / points.period * points.x), harmonics)
    return FourierSeries(np.tensordot(waves, weighted, axes=(1, 0)), points.period)


def _powers(of: NDArray[np.complex128], highest: int) -> NDArray[np.complex128]:
    """Powers 0 to `highest`, one row each, by doubling: the last is log2 of its number multiplications deep."""
    found = np.empty((highest + 1, of.size), dtype=complex)
    found[0], number = 1.0, 1
    while number <= highest:
        more = min(number, highest + 1 - number)
        np.multiply(found[:more], found[number - 1] * of, out=found[number : number + more])
        number += more
    return found


#: Harmonics of the effective error in its source.
EFFECTIVE_HARMONICS = 12


def effective_error(series: FourierSeries, harmonics: int = EFFECTIVE_HARMONICS) -> Array:
    """A_e = A_1 + sqrt(sum_i A_i^2), i = 1..12, of a transmission error [m] (NASA TM-89901).

    Parameters
    ----------
    series : FourierSeries
        Of the static transmission error over one base pitch; amplitudes 0-peak.
    harmonics : int
        12 in the source.
    """
    a = series.amplitude
    if a.shape[0] < harmonics:
        raise InputError("harmonics", a.shape[0], f"must be at least {harmonics} for the effective error")
    return np.asarray(a[0] + np.sqrt((a[:harmonics] ** 2).sum(axis=0)))
