"""Heywood's fillet stress of a loaded projection.

Sources: R. B. Heywood, Tensile Fillet Stresses in Loaded Projections, Proc. IMechE 159 (1948) 384-391; used for gears
by B. W. Kelley and R. Pedersen, The Beam Strength of Modern Gear-Tooth Design, SAE Trans. 66 (1958) 137-157:

    sigma = (W/t) [1 + 0.26 (e/R)^0.7] { 1.5 a/e^2 + cos(b)/(2 e) + 0.45/sqrt(b e) }

with e half the thickness of the section, R the fillet radius, a the moment arm of the load about the middle of the
section, b (in the root) the distance from the load point to the fillet point, and cos(b) of the angle between the
load and the outward centre line (negative for a load that presses the tooth down). Heywood does not say where on a
changing fillet to apply it: here it is applied all along the true fillet, and the largest value counts.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.formulas.outcome import RootStress, RootStressSource
from fegear.formulas.root_section import fillet_point, fillet_radii, load_line
from fegear.geometry.external_tooth import Tooth

#: Of the polynomial through the stress beside its largest value, over a 64th of the fillet.
_DEGREE = 8


def concentration_factor(half_thickness: ArrayLike, fillet_radius: ArrayLike) -> Array:
    """1 + 0.26 (e/R)^0.7 of a fillet of radius R beside a section of half thickness e (any one unit of length)."""
    e, r = np.asarray(half_thickness, dtype=float), np.asarray(fillet_radius, dtype=float)
    if not np.all(e >= 0.0):
        raise RangeError("half thickness", f"{np.min(e):.6g}", "must not be negative")
    if not np.all(r > 0.0):
        raise RangeError("fillet radius", f"{np.min(r):.6g}", "must be positive (no finite factor for a sharp corner)")
    return np.asarray(1.0 + 0.26 * (e / r) ** 0.7)


def fillet_stress(
    half_thickness: ArrayLike, moment_arm: ArrayLike, distance: ArrayLike, fillet_radius: ArrayLike, pull: ArrayLike
) -> Array:
    """Stress per unit line load [1/length] of Heywood's projection.

    Parameters
    ----------
    half_thickness, moment_arm, distance, fillet_radius : array_like
        e, a, b, R.
    pull : array_like
        Cosine of the angle between load and outward centre line, -sin(phi') on a gear tooth.
    """
    e, a, b, pull = (np.asarray(v, dtype=float) for v in (half_thickness, moment_arm, distance, pull))
    if not (np.all(e > 0.0) and np.all(b > 0.0)):
        raise RangeError(
            "section", f"{float(np.min(e)):.6g}", "must have positive thickness and a distance from the load"
        )
    factor = concentration_factor(e, fillet_radius)
    return np.asarray(factor * (1.5 * a / e**2 + pull / (2.0 * e) + 0.45 / np.sqrt(b * e)))


def tooth_root_stress(tooth: Tooth, radius: float) -> RootStress:
    """Heywood's largest fillet stress of a generated tooth under a load at `radius` [modules]."""
    load = load_line(tooth, radius)
    f = tooth.trochoid

    def stress(beta: ArrayLike) -> Array:
        x, y = f.points(beta)
        arm = (load.apex[0] - y) * math.cos(load.angle[0])
        distance = np.hypot(load.x[0] - x, load.y[0] - y)
        return fillet_stress(x, arm, distance, fillet_radii(tooth, beta), -math.sin(load.angle[0]))

    # beside the load itself the last term is singular; only a maximum inside the fillet is one of the fillet
    grid = np.linspace(f.start, f.end - 1e-3 * (f.end - f.start), 129)
    values = stress(grid)
    inner = np.flatnonzero((values[1:-1] >= values[:-2]) & (values[1:-1] > values[2:])) + 1
    if inner.size == 0:
        raise RangeError(
            "load radius",
            f"{radius:.6g} modules",
            "gives no stress maximum inside the fillet (increases to its end)",
        )
    i = int(inner[np.argmax(values[inner])])
    # where the slope of a polynomial through it is zero: the largest value itself knows half of the place's digits
    places = Chebyshev.interpolate(stress, _DEGREE, (grid[i - 1], grid[i + 1])).deriv().roots().real
    places = np.clip(places, grid[i - 1], grid[i + 1])
    beta = float(places[np.argmax(stress(places))])
    p = fillet_point(tooth, beta)
    return RootStress(float(stress(beta)), p.half_thickness, p.height, p.fillet_radius, p.tangent_angle)


SOURCE = RootStressSource(
    "heywood",
    tooth_root_stress,
    "Heywood 1948; Kelley and Pedersen 1958",
    "largest value along the true fillet with its local radius; radial compression subtracted",
)
