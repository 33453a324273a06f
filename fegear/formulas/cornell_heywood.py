"""Cornell's modified Heywood formula for the root stress, with his iteration for its place.

Sources: R. W. Cornell, ASME J. Mech. Design 103 (1981) 447-459, as given by W. D. Mark, The Transfer Function Method
for Gear System Dynamics Applied to Conventional and Minimum Excitation Gearing Designs, NASA CR-3626 (1982),
Appendix B: Eqs. B.1 to B.10. The root is a circle of radius r whose tangent is parallel to the tooth's centre line at
height R_m, where the tooth is h_0 thick; gamma_s runs along that circle.

Radial compression is subtracted (last term of B.1). A plane stress field under given loads on a solid without holes
does not depend on Poisson's ratio: the formula serves plane stress and plane strain alike.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import ConvergenceError, RangeError
from fegear.formulas.outcome import RootStress, RootStressSource
from fegear.formulas.root_section import (
    fillet_parameter,
    fillet_point,
    load_line,
    refuse_helix,
    sharpest_fillet_radius,
    tangent_range,
)
from fegear.geometry.external_tooth import Tooth


@dataclass(frozen=True, slots=True)
class RootSection:
    """A tooth in Cornell's symbols; any consistent unit of length.

    Parameters
    ----------
    base_radius : float
        R_b.
    base_half_angle : float
        beta, angle between the tooth's centre line and the involute on the base circle [rad].
    fillet_radius : float
        r.
    fillet_height : float
        R_m, height of the fillet circle's centre above the gear's centre.
    root_thickness : float
        h_0, tooth thickness at that height.
    heywood_parameter : float
        v, about 1/4.
    """

    base_radius: float
    base_half_angle: float
    fillet_radius: float
    fillet_height: float
    root_thickness: float
    heywood_parameter: float = 0.25

    def __post_init__(self) -> None:
        """Refuse teeth that cannot be."""
        for name in ("base_radius", "base_half_angle", "fillet_radius", "fillet_height", "root_thickness"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise RangeError(f"root section {name}", value, "must be positive and finite")
        if not (math.isfinite(self.heywood_parameter) and self.heywood_parameter >= 0.0):
            raise RangeError("heywood_parameter", self.heywood_parameter, "must not be negative", "0.25 is usual")

    @classmethod
    def radial(
        cls, base_radius: float, base_half_angle: float, fillet_radius: float, fillet_height: float, v: float = 0.25
    ) -> RootSection:
        """Cornell's own tooth: below the base circle the flank is radial, so h_0 = 2 R_m tan(beta)."""
        thickness = 2.0 * fillet_height * math.tan(base_half_angle)
        return cls(base_radius, base_half_angle, fillet_radius, fillet_height, thickness, v)

    @classmethod
    def radial_of(cls, tooth: Tooth, v: float = 0.25) -> RootSection:
        """Cornell's radial tooth with the base half angle, root circle and sharpest fillet radius of a generated one.

        R_m is the height of the point where a circle of that radius on the root circle touches the radial flank:
        R_m = cos(beta) sqrt((r_f + r)^2 - r^2). The paper states no rule for R_m; for a root circle of
        40.005 mm, a dedendum of 1.4 modules, this one gives its 4.0909406 cm to seven digits. Lengths in modules.

        Raises
        ------
        RangeError
            If the root circle lies outside the base circle, where no radial flank exists, or the tooth is helical.
        """
        refuse_helix(tooth)
        if tooth.root_radius >= tooth.base_radius:
            raise RangeError(
                "root radius",
                f"{tooth.root_radius:.6g} modules",
                f"is not below the base radius {tooth.base_radius:.6g}: there is no radial flank",
                "use the section of the generated tooth",
            )
        r = sharpest_fillet_radius(tooth)
        height = math.cos(tooth.base_half_angle) * math.sqrt(tooth.root_radius * (tooth.root_radius + 2.0 * r))
        return cls.radial(tooth.base_radius, tooth.base_half_angle, r, height, v)


@dataclass(frozen=True, slots=True)
class CornellStress:
    """Root stress and place for N loads.

    Parameters
    ----------
    stress : ndarray
        sigma per unit line load, in 1/length.
    angle : ndarray
        gamma_s of the place [rad].
    iterations : int
        Steps that the slowest load took.
    """

    stress: Array
    angle: Array
    iterations: int


def lever(section: RootSection, roll: ArrayLike) -> tuple[Array, Array, Array]:
    """Load angle phi' = eps - beta (B.5), half load-point thickness h_W/2 (B.6), l_0 (B.9) at roll angles eps [rad]."""
    eps = np.asarray(roll, dtype=float)
    if not np.all(eps >= 0.0):
        raise RangeError("roll angle", f"{np.min(eps):.6g} rad", "must not be negative")
    angle = eps - section.base_half_angle
    if not np.all(angle < 0.5 * math.pi):
        raise RangeError("roll angle", f"{np.max(eps):.6g} rad", "gives a load along the tooth centre line")
    gamma = section.base_half_angle - eps + np.arctan(eps)
    load_radius = section.base_radius * np.hypot(1.0, eps)
    if not np.all(gamma > 0.0):
        raise RangeError("roll angle", f"{np.max(eps):.6g} rad", "is beyond the intersection of the flanks")
    # R_W [cos gamma - sin gamma tan phi'] is R_b / cos phi': the line of action crosses the centre line there
    return angle, load_radius * np.sin(gamma), section.base_radius / np.cos(angle) - section.fillet_height


def critical_angle(
    section: RootSection, roll: ArrayLike, start: ArrayLike = math.pi / 6, tolerance: float = 1e-12
) -> tuple[Array, int]:
    """Place gamma_s [rad] of the largest stress by Cornell's iteration B.2 to B.4.

    Parameters
    ----------
    section : RootSection
    roll : array_like
        Roll angles eps >= 0 of the load points [rad].
    start : array_like
        First gamma_s [rad]; it converges from anywhere between 0 and pi/2.
    tolerance : float
        Largest last step [rad].

    Returns
    -------
    angle : ndarray
    iterations : int

    Raises
    ------
    RangeError
        If a load acts below the root, where B.2 has no solution.
    ConvergenceError
        If the iteration does not settle in 200 steps.
    """
    angle, _, arm = lever(section, roll)
    tangent, r = np.tan(angle), section.fillet_radius
    gamma = np.broadcast_to(np.asarray(start, dtype=float), np.shape(angle)).copy()
    count = 0
    while count < 200:
        count += 1
        a = section.root_thickness / r + 2.0 * (1.0 - np.cos(gamma))
        b = arm / r + np.sin(gamma)
        new = next_angle(a, b, tangent)
        step = float(np.max(np.abs(new - gamma), initial=0.0))
        gamma = new
        if step <= tolerance:
            break
    else:
        raise ConvergenceError(
            f"Cornell's iteration for the critical section did not converge (last step {step:.3g} rad)"
        )
    if not np.all((gamma > 0.0) & (gamma < 0.5 * math.pi)):
        raise RangeError(
            "load point",
            f"{float(np.min(arm)):.4g} above the fillet's centre",
            "acts too low on the flank: no stress maximum in the fillet",
        )
    return gamma, count


def next_angle(a: ArrayLike, b: ArrayLike, tangent: ArrayLike) -> Array:
    """Return gamma_s from A = h_s/r, B = l_s'/r and tan(phi'): the right-hand side of B.2."""
    a, b, t = (np.asarray(value, dtype=float) for value in (a, b, tangent))
    p = a**0.7
    return np.asarray(
        np.arctan2((1.0 + 0.16 * p) * a, b * (4.0 + 0.416 * p) - (1.0 / 3.0 + 0.016 * p) * a * t), dtype=float
    )


def stress_at(section: RootSection, roll: ArrayLike, gamma: ArrayLike) -> Array:
    """Root stress per unit line load (B.1, 1/length) at the place gamma_s [rad] for loads at roll angles [rad]."""
    angle, half_load_thickness, arm = lever(section, roll)
    g, r = np.asarray(gamma, dtype=float), section.fillet_radius
    thickness = section.root_thickness + 2.0 * r * (1.0 - np.cos(g))
    lever_primed = arm + r * np.sin(g)
    return modified_heywood(
        thickness,
        lever_primed,
        lever_primed + half_load_thickness * np.tan(angle),
        2.0 * half_load_thickness,
        r,
        angle,
        section.heywood_parameter,
    )


def modified_heywood(
    h_s: ArrayLike, l_primed: ArrayLike, l_s: ArrayLike, h_w: ArrayLike, r: ArrayLike, angle: ArrayLike, v: float
) -> Array:
    """B.1 in its own symbols: stress per unit line load [1/length].

    Parameters
    ----------
    h_s, l_primed, l_s, h_w, r : array_like
        Section thickness, distances from the section to the line of action on the centre line and to the load point,
        thickness at the load point, fillet radius.
    angle : array_like
        phi' [rad].
    v : float
        Heywood's parameter.

    Raises
    ------
    RangeError
        If the load acts at or below the section.
    """
    h, lp, ls, hw, radius, phi = (np.asarray(x, dtype=float) for x in (h_s, l_primed, l_s, h_w, r, angle))
    if not (np.all(ls > 0.0) and np.all(lp > 0.0)):
        raise RangeError("load point", f"{float(np.min(ls)):.4g} above the section", "must be above the root section")
    t = np.tan(phi)
    bending = 6.0 * lp / h**2 + np.sqrt(0.72 / (h * ls)) * (1.0 - hw / h * v * t) - t / h
    return np.asarray(np.cos(phi) * (1.0 + 0.26 * (h / (2.0 * radius)) ** 0.7) * bending)


def root_stress(section: RootSection, roll: ArrayLike) -> CornellStress:
    """Largest root stress per unit line load and its place, for loads at roll angles eps [rad]."""
    gamma, count = critical_angle(section, roll)
    return CornellStress(stress_at(section, roll, gamma), gamma, count)


def tooth_root_stress(tooth: Tooth, radius: float) -> RootStress:
    """Cornell's root stress of a generated tooth under a load at `radius` [modules].

    The fillet circle is the trochoid's circle of curvature at the place itself: the place solves B.2 with A, B taken
    from the true section. Where B.2 points beyond an end of the fillet the end is taken, and the remark says so.
    """
    from scipy.optimize import brentq

    load = load_line(tooth, radius)
    tangent = math.tan(float(load.angle[0]))

    def excess(parameter: float) -> float:
        p = fillet_point(tooth, parameter)
        lever_primed = float(load.apex[0]) - p.height
        wanted = next_angle(p.thickness / p.fillet_radius, lever_primed / p.fillet_radius, tangent)
        return float(wanted) - p.tangent_angle

    # the tangent turns monotonically along the fillet, so the place is sought in the fillet's own parameter
    involute, root = fillet_parameter(tooth, max(tangent_range(tooth)[0], 0.0)), tooth.trochoid.start
    remark = ""
    if excess(involute) <= 0.0:
        place, remark = involute, "B.2 points above the fillet: taken where the fillet meets the involute"
    elif excess(root) >= 0.0:
        place, remark = root, "B.2 points below the fillet: taken where the fillet meets the root circle"
    else:
        place = brentq(excess, root, involute, xtol=1e-13)
    p = fillet_point(tooth, place)
    stress = modified_heywood(
        p.thickness,
        load.apex - p.height,
        load.y - p.height,
        2.0 * load.x,
        p.fillet_radius,
        load.angle,
        0.25,
    )
    return RootStress(float(stress[0]), p.half_thickness, p.height, p.fillet_radius, p.tangent_angle, remark)


def radial_root_stress(tooth: Tooth, radius: float) -> RootStress:
    """Cornell's root stress of a generated tooth replaced by his own: radial flank and sharpest fillet radius.

    The load at `radius` [modules] must lie on the true involute. The place returned is the one on the circle.
    """
    section = RootSection.radial_of(tooth)
    roll = load_line(tooth, radius).roll
    found = root_stress(section, roll)
    g, r = float(found.angle[0]), section.fillet_radius
    x = 0.5 * section.root_thickness + r * (1.0 - math.cos(g))
    return RootStress(float(found.stress[0]), x, section.fillet_height - r * math.sin(g), r, g)


_CITATION = "Cornell 1981; Mark, NASA CR-3626 (1982), Eqs. B.1-B.10"
SOURCE = RootStressSource(
    "cornell",
    radial_root_stress,
    _CITATION,
    "Cornell's tooth: radial flank below the base circle, circular fillet of the trochoid's smallest radius; place by "
    "B.2; radial compression subtracted",
)
TROCHOID_SOURCE = RootStressSource(
    "cornell-trochoid",
    tooth_root_stress,
    _CITATION,
    "the true section and its local fillet radius at the place that B.2 gives; radial compression subtracted",
)
