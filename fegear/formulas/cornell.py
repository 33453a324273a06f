"""Cornell's tooth compliance: a cantilever of varying depth on an elastic foundation.

Sources: R. W. Cornell, Compliance and Stress Sensitivity of Spur Gear Teeth, ASME J. Mech. Design 103 (1981) 447-459,
in the form of H.-H. Lin, R. L. Huston and J. J. Coy, On Dynamic Loads in Parallel Shaft Transmissions, NASA
TM-100180 part 1 (1987), Eqs. 5 to 11. The sum over elements of Eqs. 6 and 7 is taken to its limit, an integral:

    q_b = (W / E_e F) { cos^2 b int u^2/I - cos b sin b Y_j int u/I + [2.4 (1 + nu) cos^2 b + sin^2 b] int 1/A }

with u the height of the load point above the section, Y_j half the tooth's thickness at the load point, b the load
angle, E_e = E/(1 - nu^2) in plane strain and E in plane stress (Eqs. 8 and 9; also for the shear term, as printed).
The beam is built in where the fillet's tangent makes 75 degrees with the centre line (Cornell's fillet angle), or at
the root circle where the fillet never turns that far; the foundation (Cornell after O'Donnell) takes l_f from that
section to the line of action on the centre line, and its thickness h_f.

Lengths and angles of Cornell's root section over load positions: what Figs. B.1 and B.2 of NASA CR-3626 show.

Source: W. D. Mark, NASA CR-3626 (1982), Appendix B, Eqs. B.2 to B.10, in the symbols of `cornell_heywood`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.formulas import beam, palmgren
from fegear.formulas.cornell_heywood import RootSection, critical_angle, lever
from fegear.formulas.hertz import Plane
from fegear.formulas.outcome import ComplianceSource, ToothCompliance
from fegear.formulas.root_section import fillet_parameter, load_line, tangent_range
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear

#: Tangent angle of the fillet at which Cornell builds the beam in [rad].
FOUNDATION_TANGENT = math.radians(75.0)


def foundation_compliance(slenderness: ArrayLike, load_angle: ArrayLike, poisson_ratio: float, plane: Plane) -> Array:
    """E x deflection per unit line load of Cornell's foundation, dimensionless.

    Parameters
    ----------
    slenderness : array_like
        k = l_f / h_f.
    load_angle : array_like
        b [rad].
    poisson_ratio : float
        nu.
    plane : {"strain", "stress"}
        Cornell's wide and narrow tooth.
    """
    k, b, nu = np.asarray(slenderness, dtype=float), np.asarray(load_angle, dtype=float), poisson_ratio
    axial = 1.534 * (1.0 + np.tan(b) ** 2 / (2.4 * (1.0 + nu)))
    if plane == "strain":
        coupling, factor = 2.0 * (1.0 - nu - 2.0 * nu**2) / (1.0 - nu**2), 1.0 - nu**2
    else:
        coupling, factor = 2.0 * (1.0 - nu), 1.0
    return np.asarray(factor * np.cos(b) ** 2 * (5.306 * k * k + coupling * k + axial))


def tooth_compliance(gear: Gear, radius: ArrayLike, nodes: int = beam.NODES) -> ToothCompliance:
    """Compliance of a tooth of `gear` per unit face width at load radii [m], without the contact.

    Parameters
    ----------
    gear : Gear
        Its plane assumption decides between Cornell's wide (strain) and narrow (stress) tooth.
    radius : array_like
        Load radii on the involute [m].
    nodes : int
        Gauss nodes per smooth piece of the outline.

    Raises
    ------
    RangeError
        If a radius is off the involute.
    """
    tooth, nu, e = gear.external_tooth, gear.material.poisson_ratio, gear.material.young_modulus
    plane = gear.plane_assumption
    load = load_line(tooth, np.asarray(radius, dtype=float) / gear.module)
    root = fillet_parameter(tooth, min(FOUNDATION_TANGENT, tangent_range(tooth)[1]))
    half, foot = (float(v) for v in tooth.trochoid.points(root))
    i = beam.integrals(beam.sections(tooth, load, root, nodes), load.y)
    c, s = np.cos(load.angle), np.sin(load.angle)
    flexibility = 1.0 / gear.plane_modulus
    k = (load.apex - foot) / (2.0 * half)
    return ToothCompliance(
        radius=load.radius * gear.module,
        bending=flexibility * (c * c * i.bending_2 - c * s * load.x * i.bending_1),
        shear=flexibility * 2.4 * (1.0 + nu) * c * c * i.area,
        axial=flexibility * s * s * i.area,
        foundation=foundation_compliance(k, load.angle, nu, plane) / e,
    )


def contact_approach(gear: Gear, radius: ArrayLike, line_load: ArrayLike, half_width: ArrayLike) -> Array:
    """Palmgren's contact deflection of one tooth [m] (Eq. 10); it knows neither the radius nor the contact's width."""
    w, _, _ = np.broadcast_arrays(np.asarray(line_load, dtype=float), radius, half_width)
    return palmgren.approach(w, gear.face_width, gear.material.young_modulus)


SOURCE = ComplianceSource(
    "cornell",
    tooth_compliance,
    contact_approach,
    "Cornell 1981; Lin, Huston and Coy, NASA TM-100180 part 1 (1987), Eqs. 5-11; contact after Palmgren",
)


@dataclass(frozen=True, slots=True)
class SectionLengths:
    """A section and what belongs to each of N loads; arrays of shape (N,), lengths as those of the section.

    Parameters
    ----------
    section : RootSection
    roll : ndarray
        epsilon [rad].
    load_angle : ndarray
        phi' (B.5) [rad].
    load_half_angle : ndarray
        gamma (B.10), between the tooth's centre line and the load point [rad].
    load_thickness : ndarray
        h_W (B.6).
    arm : ndarray
        l_0 (B.9), from R_m to where the line of action crosses the centre line.
    place : ndarray
        gamma_s (B.2) [rad].
    a, b : ndarray
        A (B.3) and B (B.4) there.
    thickness : ndarray
        h_s.
    to_load, to_line : ndarray
        l_s (B.7) and l_s' (B.8): from the section to the load point and to that crossing.
    """

    section: RootSection
    roll: Array
    load_angle: Array
    load_half_angle: Array
    load_thickness: Array
    arm: Array
    place: Array
    a: Array
    b: Array
    thickness: Array
    to_load: Array
    to_line: Array


def section_lengths(section: RootSection, roll: ArrayLike) -> SectionLengths:
    """Lengths and angles of a section for loads at roll angles eps [rad].

    Raises
    ------
    RangeError
        If a load acts below the root section or the roll angle is none of the flank's.
    """
    eps, r = np.atleast_1d(np.asarray(roll, dtype=float)), section.fillet_radius
    angle, half, arm = lever(section, eps)
    place, _ = critical_angle(section, eps)
    thickness = section.root_thickness + 2.0 * r * (1.0 - np.cos(place))
    to_line = arm + r * np.sin(place)
    return SectionLengths(
        section, eps, angle, section.base_half_angle - eps + np.arctan(eps), 2.0 * half, arm, place, thickness / r,
        to_line / r, thickness, to_line + half * np.tan(angle), to_line,
    )  # fmt: skip


def radial_section_lengths(tooth: Tooth, radii: ArrayLike) -> SectionLengths:
    """The same of a generated tooth replaced by Cornell's, for loads at `radii`; lengths in modules."""
    return section_lengths(RootSection.radial_of(tooth), load_line(tooth, radii).roll)
