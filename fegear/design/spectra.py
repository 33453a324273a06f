"""Closed-form spectra of the loading ramps (Mark, braces of Eqs. 4.15b and 4.16), safe at every argument."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array


def sinusoidal_factor(q: ArrayLike, slope: float) -> Array:
    """sinc(q) (1 - s q^2) / (1 - q^2), with sinc(q) = sin(pi q)/(pi q); (1 - s)/2 at q = 1 (Mark 4.15b).

    Beyond q = 1/2 the zero of sin(pi q) at q = 1 is written out, sin(pi q) = sin(pi (1 - q)), so nothing cancels.
    """
    a = np.abs(np.asarray(q, dtype=float))
    near = a < 0.5
    inner, outer = np.where(near, a, 0.0), np.where(near, 1.0, a)
    kernel = np.where(near, np.sinc(inner) / (1.0 - inner * inner), np.sinc(1.0 - outer) / (outer * (1.0 + outer)))
    return np.asarray(kernel * (1.0 - slope * a * a))


def polynomial_factor(q: ArrayLike, slope: float, exponent: int) -> Array:
    """(r - s)/(r - 1) sinc(q) + r (s - 1)/(r - 1) J_{r-1}(pi q) (Mark 4.16)."""
    r, s = exponent, slope
    q = np.asarray(q, dtype=float)
    return np.asarray(((r - s) * np.sinc(q) + r * (s - 1.0) * cosine_moment(math.pi * q, r - 1)) / (r - 1.0))


def cosine_moment(a: ArrayLike, p: int) -> Array:
    """J_p(a), the integral of t^p cos(a t) from 0 to 1, for even p.

    The recurrence J_p = sin a / a + p cos a / a^2 - p (p - 1)/a^2 J_{p-2} shrinks errors when a > p and multiplies them
    when a is smaller; there the integrand is a polynomial times few waves, which Gauss quadrature integrates to
    round-off.
    """
    x = np.abs(np.asarray(a, dtype=float))
    limit = max(40.0, 2.0 * p)
    t, w = np.polynomial.legendre.leggauss(p + 40)
    t, w = 0.5 * (t + 1.0), 0.5 * w
    small, large = np.minimum(x, limit), np.maximum(x, limit)
    quadrature = np.cos(np.multiply.outer(small, t)) @ (w * t**p)
    sine, cosine = np.sin(large) / large, np.cos(large) / large**2
    recurrence = sine
    for k in range(2, p + 1, 2):
        recurrence = sine + k * cosine - k * (k - 1) / large**2 * recurrence
    return np.asarray(np.where(x < limit, quadrature, recurrence))
