"""A cubic spline in plain numpy: importing scipy's interpolation costs more time than a whole gear pair."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array


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
    # Dense: N is about a hundred, made once per gear.
    a, r = np.zeros((n, n)), np.zeros(n)
    i = np.arange(1, n - 1)
    a[i, i - 1], a[i, i], a[i, i + 1] = h[1:], 2.0 * (h[:-1] + h[1:]), h[:-1]
    r[1:-1] = 3.0 * (h[1:] * d[:-1] + h[:-1] * d[1:])
    a[0, 0], a[0, 1] = h[1], h[0] + h[1]
    r[0] = ((h[0] + 2.0 * (h[0] + h[1])) * h[1] * d[0] + h[0] ** 2 * d[1]) / (h[0] + h[1])
    a[-1, -1], a[-1, -2] = h[-2], h[-1] + h[-2]
    r[-1] = ((h[-1] + 2.0 * (h[-1] + h[-2])) * h[-2] * d[-1] + h[-1] ** 2 * d[-2]) / (h[-1] + h[-2])
    return Spline(at, value, np.asarray(np.linalg.solve(a, r), dtype=float))
