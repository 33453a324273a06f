"""The FZG test gears of scuffing and micropitting tests.

Source: ISO 14635-1 (type A) and FVA information sheet 54/7 (type C); the dimensions as published reports of tests give
them. Centre distance 91.5 mm, 16 and 24 teeth, module 4.5 mm, 20 deg.
"""

from __future__ import annotations

import math

from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tooth import Tooth

_MODULE, _DISTANCE = 4.5e-3, 91.5e-3


def _pair(shifts: tuple[float, float], tips: tuple[float, float], widths: tuple[float, float]) -> GearPair:
    steel, gears = Material(206e9, 0.3), []
    for teeth, shift, tip, width in zip((16, 24), shifts, tips, widths, strict=True):
        rack = BasicRack.named("A", math.radians(20.0))
        tooth = Tooth(teeth, rack, profile_shift=shift, tip_radius=0.5 * tip / _MODULE)
        gears.append(Gear(tooth, _MODULE, 0.5 * tooth.root_radius * _MODULE, width, steel))
    return GearPair(gears[0], gears[1], _DISTANCE)


def fzg_type_c() -> GearPair:
    """FZG gears type C: x = 0.1817 and 0.1715, addendum of one module uncut, face 14 mm.

    Tips of 82.64 and 118.54 mm, as a public program has them (C. Fernandes, GEARpie: no addendum reduction). With those
    of 82.46 and 118.36 mm, cut for the full clearance, the test's bulk temperature and film are further from print.
    """
    return _pair((0.1817, 0.1715), (82.635e-3, 118.544e-3), (14e-3, 14e-3))


def fzg_type_a() -> GearPair:
    """FZG gears type A: x = 0.8532 and -0.5, tips 88.77 and 112.5 mm, face 20 mm: much sliding at the pinion's tip."""
    return _pair((0.8532, -0.5), (88.77e-3, 112.5e-3), (20e-3, 20e-3))
