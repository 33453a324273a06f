"""Tolerances of the tip reliefs of a pair: those of ``[design] tolerances``, else by the flank tolerance class."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.case.built.gear_deviations import gear_deviations
from fegear.case.built.members import gear_name
from fegear.case.design import TipTolerancePart
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.formulas.iso1328 import flank_tolerances
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.case.gear import GearPart
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear

#: Flank tolerance class of a gear that has none.
USUAL_CLASS = 5
#: Sizes [m] that the tolerances of a profile are asked of, where a gear is smaller or larger than the standard's.
_DIAMETER, _MODULE, _FACE = (5e-3, 15.0), (0.5e-3, 70e-3), 20e-3


def tip_tolerances(scene: Scene, name: str) -> tuple[TipTolerance, TipTolerance]:
    """Tolerances of the tip reliefs of driver and driven gear of a pair."""
    asked = (scene.case.design.tolerances if scene.case.design else None) or TipTolerancePart()
    driver, driven = (
        _tolerance(scene.case.gear[gear_name(scene, name, member)], scene.pairs[name].gear(member), asked)
        for member in MEMBERS
    )
    return driver, driven


def _tolerance(part: GearPart, gear: Gear, asked: TipTolerancePart) -> TipTolerance:
    grade = USUAL_CLASS if part.tolerance_class is None else part.tolerance_class
    try:
        found = gear_deviations(part, gear, grade, ("profile_slope", "profile_form"), rounded=True)
        slope, form = found["profile_slope"], found["profile_form"]
    except RangeError:
        diameter, module = np.clip(2.0 * gear.pitch_radius, *_DIAMETER), np.clip(gear.module, *_MODULE)
        by_class = flank_tolerances(grade, float(diameter), float(module), _FACE).rounded
        slope, form = by_class.profile_slope, by_class.profile_form
    return TipTolerance(slope if asked.amount is None else asked.amount, asked.length, form)
