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

from dataclasses import replace
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
    tooth, whole = gear.external_tooth, potential_energy.tooth_compliance(gear, radius, nodes)
    load = load_line(tooth, np.asarray(radius, dtype=float) / gear.module)
    cut = beam.sections(tooth, load, tooth.trochoid.start, nodes)
    x, y = tip
    left = np.where(cut.height > y, 0.5 * (cut.half_thickness + np.minimum(cut.half_thickness, x)), cut.half_thickness)
    if not left.min() > 0.0:
        raise RangeError("depth", x, "must leave material in every beam section", "reduce the depth of the crack")
    i = beam.integrals(beam.Sections(cut.height, left, cut.weight), load.y)
    c, s = np.cos(load.angle), np.sin(load.angle)
    flexibility = 1.0 / gear.plane_modulus
    moment = c * c * i.bending_2 - 2.0 * c * s * load.x * i.bending_1 + (s * load.x) ** 2 * i.bending_0
    shear = 2.4 * (1.0 + gear.material.poisson_ratio) / gear.material.young_modulus
    return replace(
        whole, bending=flexibility * moment, shear=shear * c * c * i.area, axial=flexibility * s * s * i.area
    )
