"""Weber and Banaschek's deformation of teeth: bending, shear, foundation by equal energy, and the contact.

Source: C. Weber and K. Banaschek, Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten Raedern,
Schriftenreihe Antriebstechnik 11, Vieweg 1953; with nu = 0.3 in plane strain (what they print, per unit width):

    tooth:      (cos^2 a / E) { 10.92 int (y_p - y)^2 / (2x)^3 dy + 3.1 (1 + 0.294 tan^2 a) int dy / (2x) }
    foundation: (cos^2 a / E) { 5.2 (y_p/s_f)^2 + y_p/s_f + 1.4 (1 + 0.294 tan^2 a) }
    contact, both bodies: (2 (1 - nu^2) / (pi E)) [ln(4 t_1 t_2 / b_H^2) - nu / (1 - nu)]

Here the coefficients keep their closed forms, so that other Poisson's ratios and plane stress follow: 10.92 =
12 (1 - nu^2), 3.1 = 2.4 (1 + nu), 5.2 = 18 (1 - nu^2)/pi, 1 = 2 (1 + nu)(1 - 2 nu), 1.4 = 4.8 (1 - nu^2)/pi, 0.294 =
(1 - nu)/2.4. All arms run from the point where the line of action crosses the centre line, all sections from the root
circle (s_f is the chord there).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.formulas import beam, hertz
from fegear.formulas.hertz import Plane
from fegear.formulas.outcome import ComplianceSource, ToothCompliance
from fegear.formulas.root_section import load_line
from fegear.geometry.gear import Gear


def coefficients(poisson_ratio: float, plane: Plane) -> dict[str, float]:
    """The seven coefficients of the formulas above, all multiplying cos^2(a)/E.

    Keys: `bending` (10.92), `shear` (3.1), `axial` (3.1 x 0.294), `rotation` (5.2), `coupling` (1),
    `shift` (1.4), `sink` (1.4 x 0.294).
    """
    nu = poisson_ratio
    stretch = 1.0 - nu**2 if plane == "strain" else 1.0
    coupling = 2.0 * (1.0 + nu) * (1.0 - 2.0 * nu) if plane == "strain" else 2.0 * (1.0 - nu)
    shift = 4.8 / math.pi * stretch
    return {
        "bending": 12.0 * stretch,
        "shear": 2.4 * (1.0 + nu),
        "axial": stretch,
        "rotation": 18.0 / math.pi * stretch,
        "coupling": coupling,
        "shift": shift,
        "sink": shift * stretch / (2.4 * (1.0 + nu)),
    }


def tooth_compliance(gear: Gear, radius: ArrayLike, nodes: int = beam.NODES) -> ToothCompliance:
    """Compliance of a tooth of `gear` per unit face width at load radii [m], without the contact.

    Raises
    ------
    RangeError
        If a radius is off the involute.
    """
    tooth, e = gear.external_tooth, gear.material.young_modulus
    k = coefficients(gear.material.poisson_ratio, gear.plane_assumption)
    load = load_line(tooth, np.asarray(radius, dtype=float) / gear.module)
    half, foot = beam.root_circle_chord(tooth)
    i = beam.integrals(beam.sections(tooth, load, tooth.trochoid.start, nodes), load.apex)
    c2, s2 = np.cos(load.angle) ** 2, np.sin(load.angle) ** 2
    arm = (load.apex - foot) / (2.0 * half)
    return ToothCompliance(
        radius=load.radius * gear.module,
        bending=c2 * k["bending"] / 12.0 * i.bending_2 / e,
        shear=c2 * k["shear"] * i.area / e,
        axial=s2 * k["axial"] * i.area / e,
        foundation=(c2 * (k["rotation"] * arm * arm + k["coupling"] * arm + k["shift"]) + s2 * k["sink"]) / e,
    )


def contact_approach(gear: Gear, radius: ArrayLike, line_load: ArrayLike, half_width: ArrayLike) -> Array:
    """Contact deflection of one tooth [m]: Hertz down to the tooth's centre line along the line of action."""
    r = np.asarray(radius, dtype=float)
    depth = load_line(gear.external_tooth, r / gear.module).depth.reshape(r.shape) * gear.module
    m = gear.material
    return hertz.approach(line_load, half_width, depth, m.young_modulus, m.poisson_ratio, gear.plane_assumption)


SOURCE = ComplianceSource(
    "weber-banaschek",
    tooth_compliance,
    contact_approach,
    "Weber and Banaschek, Schriftenreihe Antriebstechnik 11 (1953)",
)
