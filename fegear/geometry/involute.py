"""The involute function and its inverse, exact to round-off from the base circle outward (ISO 21771, 4.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Below this roll angle t - atan(t) loses digits to cancellation; the series then needs few terms.
_SERIES_BELOW = 0.15


def polar_angle(roll: ArrayLike) -> NDArray[np.float64]:
    """Involute polar angle inv(alpha) = tan(alpha) - alpha as a function of the roll angle tan(alpha).

    Parameters
    ----------
    roll : array_like
        Roll angle t = tan(alpha) [rad], any shape.

    Returns
    -------
    ndarray
        t - atan(t) [rad], accurate to round-off relative to its own (cubically small) size.
    """
    t = np.asarray(roll, dtype=float)
    q = np.minimum(t * t, _SERIES_BELOW**2)
    series = np.zeros_like(t)
    for n in range(21, 1, -2):  # t^3/3 - t^5/5 + ...; the first neglected term is below 1e-19 of the sum
        series = 1.0 / n - q * series
    return np.where(np.abs(t) < _SERIES_BELOW, t * q * series, t - np.arctan(t))


def roll_of_polar_angle(angle: ArrayLike) -> NDArray[np.float64]:
    """Inverse of `polar_angle`: roll angle t [rad] with t - atan(t) = `angle`, for any angle >= 0.

    Starts from the limits t ~ (3 v)^(1/3) near the base circle and t ~ v + pi/2 far from it; Halley's
    iteration then triples the digits each step.
    """
    v = np.asarray(angle, dtype=float)
    s = np.cbrt(3.0 * v)
    t = np.where(v < 1.0, s * (1.0 + s * s / 5.0 / (1.0 + 0.2 * s * s)), v + 0.5 * np.pi)
    for _ in range(8):
        f = polar_angle(t) - v
        d1 = t * t / (1.0 + t * t)
        d2 = 2.0 * t / (1.0 + t * t) ** 2
        denominator = 2.0 * d1 * d1 - f * d2
        t = t - np.where(denominator > 0.0, 2.0 * f * d1 / np.where(denominator > 0.0, denominator, 1.0), 0.0)
    return t


def inv(pressure_angle: ArrayLike) -> NDArray[np.float64]:
    """Involute function inv(alpha) = tan(alpha) - alpha of a pressure angle [rad]."""
    return polar_angle(np.tan(np.asarray(pressure_angle, dtype=float)))


def pressure_angle_of_inv(value: ArrayLike) -> NDArray[np.float64]:
    """Pressure angle alpha [rad] with inv(alpha) = `value` (>= 0)."""
    return np.arctan(roll_of_polar_angle(value))
