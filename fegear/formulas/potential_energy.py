"""The potential-energy method: the strain energy of the tooth as a cantilever, on Sainsot's elastic body.

Sources: D. C. H. Yang and J. Y. Lin, Hertzian Damping, Tooth Friction and Bending Elasticity in Gear Impact Dynamics,
ASME J. Mech. Trans. Autom. Design 109 (1987) 189-196 (bending, axial, linear Hertz); X. Tian, MSc thesis, University of
Alberta 2004 (shear); Sainsot, Velex and Duverger 2004 (body); Z. Wan et al., Mech. Mach. Theory 72 (2014) 76-90 (the
beam starts on the root circle and follows the real fillet).

    U = int M^2/(2 E I) + 1.2 N_s^2/(2 G A) + N_a^2/(2 E A) dy,   M = W [cos a (y_j - y) - sin a x_j]

The literature writes E for bending and axial force in every case, which is plane stress. A gear in plane strain gets
E/(1 - nu^2) there; Sainsot's body keeps E as printed. Contact: Yang and Sun's linear 4 (1 - nu^2)/(pi E) per unit
width for both bodies, half of it for each.

Sainsot's foundation: the deflection of a gear body, an elastic ring, under one tooth.

Source: P. Sainsot, P. Velex and O. Duverger, Contribution of Gear Body to Tooth Deflections - A New Bidimensional
Analytical Formula, ASME J. Mech. Design 126 (2004) 748-752, Eqs. 14 and 15, Table 1:

    delta_f = (w cos^2 a / E) { L (u/S)^2 + M (u/S) + P (1 + Q tan^2 a) }

with u from the root circle's section to the line of action on the centre line, S the root thickness (arc), and
L, M, P, Q polynomials of h = r_f / r_bore and theta_f, half the tooth's angle on the root circle. The fit was made
with Young's modulus E alone; it is used here as printed, without a plane-strain factor.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.formulas import beam, hertz
from fegear.formulas.outcome import ComplianceSource, ToothCompliance
from fegear.formulas.root_section import LoadLine, load_line
from fegear.geometry.gear import Gear


def tooth_compliance(gear: Gear, radius: ArrayLike, nodes: int = beam.NODES) -> ToothCompliance:
    """Compliance of a tooth of `gear` per unit face width at load radii [m], without the contact.

    Raises
    ------
    RangeError
        If a radius is off the involute, or the body lies outside the range of Sainsot's fit.
    """
    tooth = gear.external_tooth
    load = load_line(tooth, np.asarray(radius, dtype=float) / gear.module)
    return on_body(gear, load, beam.sections(tooth, load, tooth.trochoid.start, nodes), beam.root_half_angle(tooth))


def on_body(gear: Gear, load: LoadLine, cut: beam.Sections, theta: float) -> ToothCompliance:
    """Compliance of a cantilever with the sections `cut` below each load, on Sainsot's body.

    Parameters
    ----------
    gear : Gear
    load : LoadLine
        N loads.
    cut : Sections
        Shape (N, M).
    theta : float
        Half the tooth's angle on the root circle [rad].

    Raises
    ------
    RangeError
        If the body lies outside the range of Sainsot's fit.
    """
    tooth, nu, e = gear.external_tooth, gear.material.poisson_ratio, gear.material.young_modulus
    i = beam.integrals(cut, load.y)
    c, s = np.cos(load.angle), np.sin(load.angle)
    flexibility = 1.0 / gear.plane_modulus
    moment = c * c * i.bending_2 - 2.0 * c * s * load.x * i.bending_1 + (s * load.x) ** 2 * i.bending_0
    arm = (load.apex - tooth.root_radius * math.cos(theta)) / (2.0 * theta * tooth.root_radius)
    ratio = gear.root_radius / gear.bore_radius
    return ToothCompliance(
        radius=load.radius * gear.module,
        bending=flexibility * moment,
        shear=2.4 * (1.0 + nu) / e * c * c * i.area,
        axial=flexibility * s * s * i.area,
        foundation=foundation_compliance(arm, load.angle, ratio, theta) / e,
    )


def contact_approach(gear: Gear, radius: ArrayLike, line_load: ArrayLike, half_width: ArrayLike) -> Array:
    """Yang and Sun's linear contact deflection of one tooth [m], 2 (1 - nu^2) w / (pi E) whatever the curvature."""
    w, _, _ = np.broadcast_arrays(np.asarray(line_load, dtype=float), radius, half_width)
    m = gear.material
    return np.asarray(2.0 / math.pi * hertz.flexibility(m.young_modulus, m.poisson_ratio, "strain") * w)


SOURCE = ComplianceSource(
    "potential-energy",
    tooth_compliance,
    contact_approach,
    "Yang and Lin 1987, Tian 2004, Wan et al. 2014; body: Sainsot, Velex and Duverger 2004",
)


#: Table 1: rows L, M, P, Q; columns A to F of A/theta^2 + B h^2 + C h/theta + D/theta + E h + F.
TABLE_1 = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)


#: Where the fit was made: h = r_f / r_bore and theta_f [rad].
RANGE_H, RANGE_THETA = (1.4, 7.0), (0.01, 0.12)


def coefficients(radius_ratio: float, root_half_angle: float) -> tuple[float, float, float, float]:
    """L*, M*, P*, Q* (Eq. 15).

    Parameters
    ----------
    radius_ratio : float
        h = r_f / r_bore, 1.4 to 7.
    root_half_angle : float
        theta_f [rad], 0.01 to 0.12.

    Raises
    ------
    RangeError
        Outside the range of the fit.
    """
    h, theta = radius_ratio, root_half_angle
    if not RANGE_H[0] <= h <= RANGE_H[1]:
        raise RangeError(
            "root radius / bore radius",
            f"{h:.4g}",
            f"must be between {RANGE_H[0]} and {RANGE_H[1]}, the fitted range of Sainsot's polynomials",
            "use FE for thin rims and solid bodies",
        )
    if not RANGE_THETA[0] <= theta <= RANGE_THETA[1]:
        raise RangeError(
            "half tooth angle at the root",
            f"{theta:.4g} rad",
            f"must be between {RANGE_THETA[0]} and {RANGE_THETA[1]} rad, the fitted range of Sainsot's polynomials",
            "use another compliance source for gears with few teeth (potential-energy-simplified, the tooth without "
            "fillet, covers 17 teeth and more)",
        )
    big_l, m, p, q = (float(v) for v in TABLE_1 @ np.array([1.0 / theta**2, h * h, h / theta, 1.0 / theta, h, 1.0]))
    return big_l, m, p, q


def foundation_compliance(
    slenderness: ArrayLike, load_angle: ArrayLike, radius_ratio: float, root_half_angle: float
) -> Array:
    """E x deflection per unit line load of the gear body (Eq. 14), dimensionless.

    Parameters
    ----------
    slenderness : array_like
        u_f / S_f.
    load_angle : array_like
        a [rad].
    radius_ratio, root_half_angle : float
        h and theta_f, see `coefficients`.
    """
    big_l, m, p, q = coefficients(radius_ratio, root_half_angle)
    s, a = np.asarray(slenderness, dtype=float), np.asarray(load_angle, dtype=float)
    return np.asarray(np.cos(a) ** 2 * (big_l * s * s + m * s + p * (1.0 + q * np.tan(a) ** 2)))
