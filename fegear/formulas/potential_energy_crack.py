"""The potential-energy method for a cracked tooth, as diagnosis uses it: a cantilever with dead material at the crack.

Sources: S. Wu, M. J. Zuo and A. Parey, Simulation of spur gear dynamics and estimation of fault growth, J. Sound Vib.
317 (2008) 608-624; F. Chaari, T. Fakhfakh and M. Haddar, Eur. J. Mech. A 28 (2009) 461-468; Z. Chen and Y. Shao,
Eng. Fail. Anal. 18 (2011) 2149-2164. No page with gear data and numbers together was at hand: formulas as these papers
and their successors give them, beam and body as in `potential_energy`.

Material on the crack's side of a line from its tip, parallel to the tooth's centre line, carries nothing: of a section
of half thickness x above the tip x + min(x, h_q) is left, h_q the distance of the tip from the centre line (negative
beyond it). Arms stay those of the whole tooth, and so does the body (Sainsot, Velex and Duverger).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.formulas import beam, potential_energy
from fegear.formulas.root_section import load_line

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.formulas.outcome import ToothCompliance
    from fegear.geometry.gear import Gear


def cracked_tooth_compliance(
    gear: Gear, radius: ArrayLike, tip: tuple[float, float], nodes: int = beam.NODES
) -> ToothCompliance:
    """Compliance of a cracked tooth per unit face width at load radii [m], without the contact.

    Parameters
    ----------
    gear : Gear
    radius : array_like
        [m].
    tip : (float, float)
        Of the crack [modules], in the tooth's frame: gear centre at the origin, centre line along +y, loaded flank at
        x > 0.
    nodes : int
        As of `potential_energy.tooth_compliance`.

    Raises
    ------
    RangeError
        If nothing of a section is left, or as for a tooth without a crack.
    """
    tooth = gear.external_tooth
    load = load_line(tooth, np.asarray(radius, dtype=float) / gear.module)
    cut = without_dead_material(beam.sections(tooth, load, tooth.trochoid.start, nodes), tip)
    return potential_energy.on_body(gear, load, cut, beam.root_half_angle(tooth))


def without_dead_material(cut: beam.Sections, tip: tuple[float, float]) -> beam.Sections:
    """Sections of a tooth with a crack that ends at `tip` (x, y) [modules].

    Raises
    ------
    RangeError
        If nothing of a section is left.
    """
    x, y = tip
    left = np.where(cut.height > y, 0.5 * (cut.half_thickness + np.minimum(cut.half_thickness, x)), cut.half_thickness)
    if not left.min() > 0.0:
        raise RangeError(
            "crack", f"(tip {abs(x):.4g} modules beyond the centre line of the tooth)",
            "must leave material in every beam section", "reduce the depth of the crack",
        )  # fmt: skip
    return beam.Sections(cut.height, left, cut.weight)
