"""Hertzian line contact: half-width, pressure, and how much each body gives way.

Sources: H. Hertz, J. reine angew. Math. 92 (1881) 156-171; K. L. Johnson, Contact Mechanics, Cambridge University
Press 1985, sections 4.2(c) and 5.6. Stresses under the line of symmetry: Johnson Eqs. 4.46.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError

Plane = Literal["strain", "stress"]

#: Hertz takes both bodies as half-planes; beyond this half-width over the smaller radius his parabola is no circle.
LARGEST_WIDTH_RATIO = 0.3
#: Distance in half-widths from which on the stresses are less than 1e-4 of the peak pressure.
_FAR = 1e4


@dataclass(frozen=True, slots=True)
class LineContact:
    """A Hertzian line contact; arrays of one shape.

    Parameters
    ----------
    line_load : ndarray
        w, load per unit length [N/m].
    half_width : ndarray
        a [m].
    peak_pressure : ndarray
        p_0 = 2 w / (pi a) [Pa].
    """

    line_load: Array
    half_width: Array
    peak_pressure: Array

    @property
    def greatest_shear(self) -> Array:
        """Largest shear stress below the surface in the contact's plane, 0.3003 p_0 at the depth 0.7862 a [Pa]."""
        return _SHEAR_FACTOR * self.peak_pressure


# tau/p_0 = s - s^2 / sqrt(1 + s^2) at s = z/a (Johnson, Eqs. 4.46); stationary at s^4 + s^2 = 1
_SHEAR_DEPTH = math.sqrt(0.5 * (math.sqrt(5.0) - 1.0))
_SHEAR_FACTOR = _SHEAR_DEPTH - _SHEAR_DEPTH**2 / math.sqrt(1.0 + _SHEAR_DEPTH**2)


def contact_modulus(modulus_a: float, poisson_a: float, modulus_b: float, poisson_b: float) -> float:
    """E* [Pa] of two bodies in plane strain: 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b (Johnson, Eq. 4.5)."""
    for name, e, nu in (("a", modulus_a, poisson_a), ("b", modulus_b, poisson_b)):
        _check_material(e, nu, name)
    return 1.0 / ((1.0 - poisson_a**2) / modulus_a + (1.0 - poisson_b**2) / modulus_b)


def relative_curvature(radius_a: ArrayLike, radius_b: ArrayLike) -> Array:
    """Relative curvature 1/R_a + 1/R_b [1/m]; radii are positive where convex, negative where concave, inf for a flat.

    Formed as (R_a + R_b) / (R_a R_b): for nearly conforming flanks the sum of the radii is exact where the sum of the
    reciprocals has lost every digit.

    Raises
    ------
    RangeError
        If a radius is zero or NaN.
    """
    a, b = np.broadcast_arrays(np.asarray(radius_a, dtype=float), np.asarray(radius_b, dtype=float))
    if not np.all((np.abs(a) > 0.0) & (np.abs(b) > 0.0)):
        raise RangeError("radius of curvature", 0.0, "must not be zero", "edges have no Hertzian contact")
    finite = np.isfinite(a) & np.isfinite(b)
    fa, fb = np.where(finite, a, 1.0), np.where(finite, b, 1.0)
    # one division after the other: the product of two large or two tiny radii may leave the range of floats
    return np.where(finite, (fa + fb) / fa / fb, 1.0 / a + 1.0 / b)


def line_contact(line_load: ArrayLike, curvature: ArrayLike, modulus: float) -> LineContact:
    """Half-width a = sqrt(4 w / (pi kappa E*)) and peak pressure p_0 = sqrt(w kappa E* / pi).

    Parameters
    ----------
    line_load : array_like
        w >= 0, load per unit length [N/m]; zero gives a contact of no width and no pressure.
    curvature : array_like
        kappa > 0, relative curvature [1/m] (`relative_curvature`).
    modulus : float
        E* [Pa] (`contact_modulus`).

    Raises
    ------
    RangeError
        If the load is negative, the flanks conform (kappa <= 0), or the contact would be wider than the bodies' radii
        allow (a kappa > 0.3).
    """
    w, kappa = np.broadcast_arrays(np.asarray(line_load, dtype=float), np.asarray(curvature, dtype=float))
    if not np.all(w >= 0.0):
        raise RangeError("line load", f"{np.min(w):.6g} N/m", "must not be negative (no tension in the contact)")
    if not np.all(kappa > 0.0):
        raise RangeError(
            "relative curvature",
            f"{np.min(kappa):.6g} 1/m",
            "must be positive",
            "flats, or a concave flank of equal or smaller radius, have conformal contact",
        )
    if not (math.isfinite(modulus) and modulus > 0.0):
        raise RangeError("contact modulus", modulus, "must be positive and finite")
    a = np.sqrt(4.0 / math.pi * (w / modulus) / kappa)
    wide = a * kappa
    if np.any(wide > LARGEST_WIDTH_RATIO):
        raise RangeError(
            "half-width times relative curvature",
            f"{np.max(wide):.4g}",
            f"exceeds {LARGEST_WIDTH_RATIO}: the contact is too wide for Hertz's half-planes",
            "reduce the load or solve the contact by FE",
        )
    return LineContact(w, a, np.sqrt(w / math.pi * modulus * kappa))


def stresses_below(along: ArrayLike, depth: ArrayLike) -> tuple[Array, Array, Array]:
    """Stresses below a line contact without friction over its peak pressure (Johnson, Eqs. 4.47 to 4.49).

    Both distances are in half-widths and count as `_FAR` beyond it, where next to nothing presses.

    Parameters
    ----------
    along : array_like
        From the middle of the contact.
    depth : array_like
        Below the surface, >= 0.

    Returns
    -------
    along, down, shear : ndarray
        Normal stresses along the surface and into the depth, and shear stress.
    """
    x, z = (np.clip(np.asarray(value, dtype=float), -_FAR, _FAR) for value in (along, depth))
    inner = 1.0 - x**2 + z**2
    whole = np.hypot(inner, 2.0 * x * z)
    larger = np.sqrt(0.5 * (whole + np.abs(inner)))  # of m and n, the other from m n = |x| z: no cancellation
    other = np.divide(np.abs(x) * z, larger, out=np.zeros(np.shape(larger)), where=larger > 0.0)
    m, n = np.where(inner >= 0.0, larger, other), np.where(inner >= 0.0, other, larger)
    total = np.maximum(m**2 + n**2, np.finfo(float).tiny)
    part = (z**2 + n**2) / total
    shear = -np.sign(x) * n * (m**2 - z**2) / total
    return np.asarray(2.0 * z - m * (1.0 + part)), np.asarray(-m * (1.0 - part)), np.asarray(shear)


def approach(
    line_load: ArrayLike,
    half_width: ArrayLike,
    depth: ArrayLike,
    young_modulus: float,
    poisson_ratio: float,
    plane: Plane = "strain",
) -> Array:
    r"""How much one body gives way: the surface's middle against the point at `depth` below it [m].

    .. math:: \delta = \frac{2 w (1-\nu^2)}{\pi E}\Bigl[\operatorname{asinh}\frac{d}{a}
              - \frac{\nu}{1-\nu}\,\frac{d}{d + \sqrt{a^2 + d^2}}\Bigr]

    exactly, by integrating Johnson's stresses 4.46 down the line of symmetry; for d >> a it is the usual
    (2 w (1 - nu^2) / (pi E)) [ln(2 d / a) - nu / (2 (1 - nu))]. In plane stress (1 - nu^2)/E is 1/E and nu/(1 - nu)
    is nu. A line contact on a half-plane has no depth-free approach: the depth is part of the answer.

    Parameters
    ----------
    line_load : array_like
        w [N/m], >= 0; zero load gives zero.
    half_width : array_like
        a [m] of the contact, > 0 where the load is.
    depth : array_like
        d [m], >= 0; Weber and Banaschek take the distance to the tooth's centre line along the line of action.
    young_modulus, poisson_ratio : float
        E [Pa], nu of this body.
    plane : {"strain", "stress"}

    Raises
    ------
    RangeError
        If an argument is negative, or a loaded contact has no width.
    """
    w, a, d = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (line_load, half_width, depth)))
    _check_material(young_modulus, poisson_ratio, "body")
    for name, value in (("line load", w), ("half-width", a), ("depth", d)):
        if not np.all(value >= 0.0):
            raise RangeError(name, f"{np.min(value):.6g}", "must not be negative")
    loaded = w > 0.0
    if np.any(loaded & (a == 0.0)):
        raise RangeError(
            "half-width", 0.0, "gives an infinite deflection under a load", "use the value from line_contact"
        )
    width = np.where(loaded, a, 1.0)
    bracket = np.arcsinh(d / width) - lateral_ratio(poisson_ratio, plane) * d / (d + np.hypot(width, d))
    return np.where(loaded, 2.0 * w / math.pi * flexibility(young_modulus, poisson_ratio, plane) * bracket, 0.0)


def flexibility(young_modulus: float, poisson_ratio: float, plane: Plane) -> float:
    """(1 - nu^2)/E in plane strain, 1/E in plane stress [1/Pa]."""
    return ((1.0 - poisson_ratio**2) if plane == "strain" else 1.0) / young_modulus


def lateral_ratio(poisson_ratio: float, plane: Plane) -> float:
    """Poisson's ratio of the plane problem: nu/(1 - nu) in plane strain, nu in plane stress."""
    return poisson_ratio / (1.0 - poisson_ratio) if plane == "strain" else poisson_ratio


def _check_material(young_modulus: float, poisson_ratio: float, name: str) -> None:
    if not (math.isfinite(young_modulus) and young_modulus > 0.0):
        raise RangeError(f"young_modulus ({name})", young_modulus, "must be positive and finite")
    if not -1.0 < poisson_ratio < 0.5:
        raise RangeError(f"poisson_ratio ({name})", poisson_ratio, "must be inside (-1, 0.5)")
