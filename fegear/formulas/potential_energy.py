"""The potential-energy method: the strain energy of the tooth as a cantilever, on Sainsot's elastic body.

Sources: D. C. H. Yang and J. Y. Lin, Hertzian Damping, Tooth Friction and Bending Elasticity in Gear Impact Dynamics,
ASME J. Mech. Trans. Autom. Design 109 (1987) 189-196 (bending, axial, linear Hertz); X. Tian, MSc thesis, University of
Alberta 2004 (shear); Sainsot, Velex and Duverger 2004 (body); Z. Wan et al., Mech. Mach. Theory 72 (2014) 76-90 (the
beam starts on the root circle and follows the real fillet).

    U = int M^2/(2 E I) + 1.2 N_s^2/(2 G A) + N_a^2/(2 E A) dy,   M = W [cos a (y_j - y) - sin a x_j]

The literature writes E for bending and axial force in every case, which is plane stress. A gear in plane strain gets
E/(1 - nu^2) there; Sainsot's body keeps E as printed. Contact: Yang and Sun's linear 4 (1 - nu^2)/(pi E) per unit
width for both bodies, half of it for each.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.formulas import beam, hertz, sainsot
from fegear.formulas.compliance import ComplianceSource, ToothCompliance
from fegear.formulas.load_line import load_line

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.geometry import Gear


def tooth_compliance(gear: Gear, radius: ArrayLike, nodes: int = beam.NODES) -> ToothCompliance:
    """Compliance of a tooth of `gear` per unit face width at load radii [m], without the contact.

    Raises
    ------
    RangeError
        If a radius is off the involute, or the body lies outside the range of Sainsot's fit.
    """
    tooth, nu, e = gear.tooth, gear.material.poisson_ratio, gear.material.young_modulus
    load = load_line(tooth, np.asarray(radius, dtype=float) / gear.module)
    i = beam.integrals(beam.sections(tooth, load, tooth.trochoid.start, nodes), load.y)
    c, s = np.cos(load.angle), np.sin(load.angle)
    flexibility = 1.0 / gear.plane_modulus
    moment = c * c * i.bending_2 - 2.0 * c * s * load.x * i.bending_1 + (s * load.x) ** 2 * i.bending_0
    theta = beam.root_half_angle(tooth)
    arm = (load.apex - tooth.root_radius * math.cos(theta)) / (2.0 * theta * tooth.root_radius)
    ratio = gear.root_radius / gear.bore_radius
    return ToothCompliance(
        radius=load.radius * gear.module,
        bending=flexibility * moment,
        shear=2.4 * (1.0 + nu) / e * c * c * i.area,
        axial=flexibility * s * s * i.area,
        foundation=sainsot.foundation_compliance(arm, load.angle, ratio, theta) / e,
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
