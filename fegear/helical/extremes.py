"""Extremes of a periodic function with kinks, located through its values and slopes, independent of any grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    #: Place, value and slope at one end of some cells.
    Ends = tuple[Array, Array, Array]

#: Places per period at which sign changes of the slope are looked for.
NODES = 72


@dataclass(frozen=True, slots=True)
class Extreme:
    """An extreme value, where it lies [rad], and how far at most it may be off."""

    value: float
    angle: float
    error: float


def extremes(
    function: Callable[[Array], tuple[Array, Array]], start: float, period: float, tolerance: float = 1e-13
) -> tuple[Extreme, Extreme]:
    """Smallest and largest value of a periodic function that is piecewise smooth.

    Between two places where the slope has opposite signs the tangents intersect; the next place is there. At a kink
    this converges like Newton's method, at a smooth top it bisects, and for a function that is concave (at a top) or
    convex (at a bottom) between the places the intersection bounds what is still missing.

    Parameters
    ----------
    function : callable
        Angles [rad] -> values, slopes.
    start, period : float
        The period to look at [rad].
    tolerance : float
        Bound of the error of the values at which to stop, beside a 1e-5th of their range.

    Returns
    -------
    lowest, highest : Extreme
    """
    x = start + period * np.arange(NODES) / NODES
    f, d = function(x)
    known = [Extreme(float(f[i]), float(x[i]), 0.0) for i in (int(np.argmin(f)), int(np.argmax(f)))]
    tolerance += 1e-5 * (known[1].value - known[0].value)
    after = np.roll(np.arange(NODES), -1)
    # A cell matters only if its tangents can cross beyond what is known already.
    for which, sign in ((0, -1.0), (1, 1.0)):
        cells = np.flatnonzero((sign * d > 0.0) & (sign * d[after] < 0.0))
        left = (x[cells], sign * f[cells], sign * d[cells])
        right = (x[cells] + period / NODES, sign * f[after[cells]], sign * d[after[cells]])
        known[which] = _climb(function, sign, left, right, known[which], tolerance, 1e-12 * period)
    return known[0], known[1]


def _climb(
    function: Callable[[Array], tuple[Array, Array]],
    sign: float,
    left: Ends,
    right: Ends,
    best: Extreme,
    tolerance: float,
    narrow: float,
) -> Extreme:
    """Largest value of sign * function in cells with rising left and falling right ends (place, value, slope)."""
    (a, fa, da), (b, fb, db) = left, right
    missing = 0.0
    for _ in range(60):
        meet = (da * a - fa - db * b + fb) / (da - db)
        bound = fa + da * (meet - a)
        live = bound - sign * best.value > tolerance
        missing = float(np.max(bound - sign * best.value, initial=0.0))
        if not live.any():
            break
        a, b, fa, da, fb, db, meet = (v[live] for v in (a, b, fa, da, fb, db, meet))
        m = np.clip(meet, a + 1e-3 * (b - a), b - 1e-3 * (b - a))
        value, slope = function(m)
        fm, dm = sign * value, sign * slope
        top = int(np.argmax(fm))
        if fm[top] > sign * best.value:
            best = Extreme(float(value[top]), float(m[top]), 0.0)
        rising = dm > 0.0
        a, fa, da = np.where(rising, m, a), np.where(rising, fm, fa), np.where(rising, dm, da)
        b, fb, db = np.where(rising, b, m), np.where(rising, fb, fm), np.where(rising, db, dm)
        keep = (b - a > narrow) & (da > 0.0) & (db < 0.0)
        a, b, fa, da, fb, db = (v[keep] for v in (a, b, fa, da, fb, db))
    return Extreme(best.value, best.angle, max(missing, 0.0))
