"""Tolerances of what is ground on a pair: those of ``[design] tolerances``, else by the flank tolerance class."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.case.built.gear_deviations import gear_deviations, own_deviation
from fegear.case.built.members import gear_name
from fegear.case.design import TipTolerancePart
from fegear.design.flanks.flank_tolerance import FlankTolerance, LeadTolerance
from fegear.design.flanks.forms import lead_bearer
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.formulas.iso1328 import flank_tolerances, tolerances_of
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.case.gear import GearPart
    from fegear.case.reading import Scene
    from fegear.formulas.iso1328 import FlankTolerances
    from fegear.geometry.gear import Gear

#: Flank tolerance class of a gear that has none.
USUAL_CLASS = 5
#: Sizes [m] that the tolerances of a profile are asked of, where a gear is smaller or larger than the standard's.
_DIAMETER, _MODULE, _FACE = (5e-3, 15.0), (0.5e-3, 70e-3), 20e-3


def tip_tolerances(scene: Scene, name: str) -> tuple[TipTolerance, TipTolerance]:
    """Tolerances of the tip reliefs of driver and driven gear of a pair."""
    asked = _asked(scene)
    driver, driven = (
        _tolerance(scene.case.gear[gear_name(scene, name, member)], scene.pairs[name].gear(member), asked)
        for member in MEMBERS
    )
    return driver, driven


def flank_tolerance(scene: Scene, name: str) -> FlankTolerance:
    """Tolerances of all that is ground on a pair of teeth with a width; lead is that of the gear that bears it."""
    asked, pair = _asked(scene), scene.pairs[name]
    bearer = lead_bearer(pair)
    gear, part = pair.gear(bearer), scene.case.gear[gear_name(scene, name, bearer)]
    grade = _class_of(part)
    tips = tip_tolerances(scene, name)
    try:
        allowed = tolerances_of(gear, grade).rounded
        slope = gear_deviations(part, gear, grade, ["helix_slope"], rounded=True)["helix_slope"]
    except RangeError:
        allowed = _inside_the_standard(gear, grade)
        slope = allowed.helix_slope
    lead = LeadTolerance(
        slope if asked.helix_slope is None else asked.helix_slope,
        allowed.helix_form if asked.crowning is None else asked.crowning,
        tips[MEMBERS.index(bearer)].amount,
    )
    return FlankTolerance(tips, lead)


def _asked(scene: Scene) -> TipTolerancePart:
    return (scene.case.design.tolerances if scene.case.design else None) or TipTolerancePart()


def _class_of(part: GearPart) -> int:
    return USUAL_CLASS if part.tolerance_class is None else part.tolerance_class


def _inside_the_standard(gear: Gear, grade: int) -> FlankTolerances:
    """Tolerances of the nearest gear that the standard has."""
    diameter, module = np.clip(2.0 * gear.pitch_radius, *_DIAMETER), np.clip(gear.module, *_MODULE)
    return flank_tolerances(grade, float(diameter), float(module), _FACE).rounded


def _tolerance(part: GearPart, gear: Gear, asked: TipTolerancePart) -> TipTolerance:
    grade = _class_of(part)
    try:
        found = gear_deviations(part, gear, grade, ("profile_slope", "profile_form"), rounded=True)
        slope, form = found["profile_slope"], found["profile_form"]
    except RangeError:
        usual = _inside_the_standard(gear, grade)
        slope, form = usual.profile_slope, usual.profile_form
    if asked.amount is not None:
        return TipTolerance(asked.amount, asked.length, form)
    by_class = None if own_deviation(part, "profile_slope") is not None else grade
    return TipTolerance(slope, asked.length, form, _origin_of_slope(part), by_class)


def _origin_of_slope(part: GearPart) -> str:
    """Where f_Halpha of a gear comes from, in words."""
    if own_deviation(part, "profile_slope") is not None:
        return "f_Hα as specified"
    return f"f_Hα of class {_class_of(part)}" + (", assumed" if part.tolerance_class is None else "")
