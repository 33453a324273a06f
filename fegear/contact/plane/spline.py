"""A cubic spline in plain numpy: importing scipy's interpolation costs more time than a whole gear pair."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array


@dataclass(frozen=True)
class Spline:
    """Not-a-knot cubic spline through points; the end pieces go on outside.

    Parameters
    ----------
    x, y : ndarray, shape (N,)
        Ascending positions, N >= 4, and values.
    slope : ndarray, shape (N,)
        Derivatives at the points.
    """

    x: Array
    y: Array
    slope: Array

    def __call__(self, at: ArrayLike) -> Array:
        """Interpolate (Hermite form)."""
        t = np.asarray(at, dtype=float)
        i = np.clip(np.searchsorted(self.x, t, side="right") - 1, 0, self.x.size - 2)
        h = self.x[i + 1] - self.x[i]
        s = (t - self.x[i]) / h
        rise = (self.y[i + 1] - self.y[i]) / h
        a, b = self.slope[i] - rise, self.slope[i + 1] - rise
        return np.asarray(self.y[i] + s * h * (rise + (1.0 - s) * (a * (1.0 - s) - b * s)))


def spline(x: ArrayLike, y: ArrayLike) -> Spline:
    """Make the not-a-knot cubic spline: the third derivative too is continuous at the second and last but one point."""
    at, value = np.array(x, dtype=float), np.array(y, dtype=float)
    n = at.size
    h = np.diff(at)
    d = np.diff(value) / h
    lower, middle, upper, r = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    lower[1:-1], middle[1:-1], upper[1:-1] = h[1:], 2.0 * (h[:-1] + h[1:]), h[:-1]
    r[1:-1] = 3.0 * (h[1:] * d[:-1] + h[:-1] * d[1:])
    middle[0], upper[0] = h[1], h[0] + h[1]
    r[0] = ((h[0] + 2.0 * (h[0] + h[1])) * h[1] * d[0] + h[0] ** 2 * d[1]) / (h[0] + h[1])
    middle[-1], lower[-1] = h[-2], h[-1] + h[-2]
    r[-1] = ((h[-1] + 2.0 * (h[-1] + h[-2])) * h[-2] * d[-1] + h[-1] ** 2 * d[-2]) / (h[-1] + h[-2])
    return Spline(at, value, _tridiagonal(lower, middle, upper, r))


def _tridiagonal(lower: Array, middle: Array, upper: Array, right: Array) -> Array:
    """Solve a tridiagonal system by elimination without exchanges.

    Every row but the first and the last is dominated by its middle; the first leaves h_0 + h_1 > 0 to the second, whose
    multiplier is then 1 + h_1/h_0 over 1, so nothing grows.
    """
    m, r = middle.tolist(), right.tolist()
    low, up = lower.tolist(), upper.tolist()
    for i in range(1, len(m)):
        share = low[i] / m[i - 1]
        m[i] -= share * up[i - 1]
        r[i] -= share * r[i - 1]
    r[-1] /= m[-1]
    for i in range(len(m) - 2, -1, -1):
        r[i] = (r[i] - up[i] * r[i + 1]) / m[i]
    return np.array(r)
