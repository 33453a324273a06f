"""The potential-energy method on the simplified tooth of the diagnosis literature: an involute, and no fillet.

Sources: X. Tian, MSc thesis, University of Alberta 2004; S. Wu, M. J. Zuo and A. Parey, J. Sound Vib. 317 (2008)
608-624; X. Liang, M. J. Zuo and M. Pandey, Mech. Mach. Theory 76 (2014) 20-38 (root and base circle apart); body:
Sainsot, Velex and Duverger 2004; crack: Z. Chen and Y. Shao, Eng. Fail. Anal. 18 (2011) 2149-2164. No page with gear
data and numbers together was at hand: formulas as these papers and their successors give them.

The involute begins on the base circle, where half the tooth's angle is psi_b; below it, down to the root circle, the
section keeps its thickness 2 r_b sin psi_b. Where the root circle is the larger one the involute begins there. The
body's half angle theta_f is that of this tooth on the root circle, smaller than that of a generated tooth with its
fillets, so that Sainsot's fit covers fewer teeth: 19 of the standard basic rack have 0.106 instead of 0.149 rad.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.formulas import beam, potential_energy
from fegear.formulas.outcome import ComplianceSource
from fegear.formulas.potential_energy_crack import without_dead_material
from fegear.formulas.root_section import load_line

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.formulas.outcome import ToothCompliance
    from fegear.formulas.root_section import LoadLine
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear


def tooth_compliance(
    gear: Gear, radius: ArrayLike, tip: tuple[float, float] | None = None, nodes: int = beam.NODES
) -> ToothCompliance:
    """Compliance of a tooth, cracked or not, per unit face width at load radii [m], without the contact.

    Parameters
    ----------
    gear : Gear
    radius : array_like
        [m].
    tip : (float, float), optional
        Of a crack [modules], in the tooth's frame as of `potential_energy_crack`.
    nodes : int
        Gauss nodes on the involute.

    Raises
    ------
    RangeError
        If a radius is off the involute, the body lies outside the range of Sainsot's fit, or a crack leaves nothing
        of a section.
    """
    tooth = gear.external_tooth
    load = load_line(tooth, np.asarray(radius, dtype=float) / gear.module)
    cut = _sections(tooth, load, nodes)
    if tip is not None:
        cut = without_dead_material(cut, tip)
    return potential_energy.on_body(gear, load, cut, root_half_angle(tooth))


def root_half_angle(tooth: Tooth) -> float:
    """Half the angle of the simplified tooth on the root circle, theta_f [rad]."""
    ratio = tooth.base_radius / tooth.root_radius
    if ratio > 1.0:
        return math.asin(ratio * math.sin(tooth.base_half_angle))
    pressure_angle = math.acos(ratio)
    return tooth.base_half_angle - (math.tan(pressure_angle) - pressure_angle)


def _sections(tooth: Tooth, load: LoadLine, nodes: int) -> beam.Sections:
    """Sections from the root circle up to each load."""
    ratio = tooth.root_radius / tooth.base_radius
    high = beam.involute_sections(tooth, load, math.sqrt(max(ratio * ratio - 1.0, 0.0)), nodes)
    if ratio >= 1.0:
        return high
    half, top = (tooth.base_radius * f(tooth.base_half_angle) for f in (math.sin, math.cos))
    foot = tooth.root_radius * math.cos(root_half_angle(tooth))
    g, w = np.polynomial.legendre.leggauss(nodes)  # exact without a crack; its tip is a jump between two nodes
    shape = (load.roll.size, nodes)
    low = foot + 0.5 * (1.0 + g) * (top - foot), np.full(nodes, half), 0.5 * w * (top - foot)
    return beam.Sections(
        *(
            np.concatenate([np.broadcast_to(below, shape), above], axis=1)
            for below, above in zip(low, (high.height, high.half_thickness, high.weight), strict=True)
        )
    )


#: For `fegear.formulas.sources.pair_compliance`.
SOURCE = ComplianceSource(
    "potential-energy-simplified",
    tooth_compliance,
    potential_energy.contact_approach,
    "Tian 2004, Wu, Zuo and Parey 2008, Liang, Zuo and Pandey 2014; body: Sainsot, Velex and Duverger 2004",
)
