"""Tolerances of what is ground on a pair: those of ``[design] tolerances``, else by the flank tolerance class."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.case.built.gear_deviations import own_deviation
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
    part = scene.case.gear[gear_name(scene, name, bearer)]
    by_class = _by_class(part, pair.gear(bearer))
    tip = tip_tolerances(scene, name)
    twist = tip[MEMBERS.index(bearer)]
    slope = asked.helix_slope if asked.helix_slope is not None else own_deviation(part, "helix_slope")
    exact = (
        by_class.helix_slope if slope is None else None,
        by_class.helix_form if asked.crowning is None else None,
        twist.unrounded,
    )
    slope = by_class.rounded.helix_slope if slope is None else slope
    crowning = by_class.rounded.helix_form if asked.crowning is None else asked.crowning
    return FlankTolerance(tip, LeadTolerance(slope, crowning, twist.amount, exact))


def _asked(scene: Scene) -> TipTolerancePart:
    return (scene.case.design.tolerances if scene.case.design else None) or TipTolerancePart()


def _class_of(part: GearPart) -> int:
    return USUAL_CLASS if part.tolerance_class is None else part.tolerance_class


def _by_class(part: GearPart, gear: Gear) -> FlankTolerances:
    """Unrounded tolerances of a gear's class; beyond the standard's sizes those of the nearest gear that it has."""
    grade = _class_of(part)
    try:
        return tolerances_of(gear, grade)
    except RangeError:
        diameter, module = np.clip(2.0 * gear.pitch_radius, *_DIAMETER), np.clip(gear.module, *_MODULE)
        return flank_tolerances(grade, float(diameter), float(module), _FACE)


def _tolerance(part: GearPart, gear: Gear, asked: TipTolerancePart) -> TipTolerance:
    by_class = _by_class(part, gear)
    slope, form = own_deviation(part, "profile_slope"), own_deviation(part, "profile_form")
    form = by_class.rounded.profile_form if form is None else form
    if asked.amount is not None:
        return TipTolerance(asked.amount, asked.length, form)
    if slope is not None:
        return TipTolerance(slope, asked.length, form, _origin_of_slope(part))
    return TipTolerance(
        by_class.rounded.profile_slope, asked.length, form, _origin_of_slope(part), _class_of(part),
        by_class.profile_slope,
    )  # fmt: skip


def _origin_of_slope(part: GearPart) -> str:
    """Where f_Halpha of a gear comes from, in words."""
    if own_deviation(part, "profile_slope") is not None:
        return "f_Hα as specified"
    return f"f_Hα of class {_class_of(part)}" + (", assumed" if part.tolerance_class is None else "")
