"""From ``double_helical`` of a pair to the two halves that the mechanics loads together."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.built.gear_flanks import gear_flanks
from fegear.case.built.members import gear_name
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.solid_influence import solid_gear_to_solve
from fegear.case.set_pairs import set_of_pair
from fegear.contact.double_helical.double_spec import DoubleHelicalSpec, mirrored, of_other_hand, twist_between
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.case.built.solid_influence import SolidGearToSolve
    from fegear.case.double_helical import DoubleHelicalPart
    from fegear.case.reading import Scene
    from fegear.contact.pair_spec import PairSpec


@dataclass(frozen=True)
class DoubleToLoad:
    """All that a double helical pair depends on besides the solved gears of the case.

    Parameters
    ----------
    spec : DoubleHelicalSpec
    nominal : float
        Load of both halves that single numbers are for [N].
    second : tuple of (str or SolidGearToSolve)
        Driver and driven at end II: a gear of the case by its name, or one that mirrors the gear at end I.
    frequency : float
        Of the mesh [Hz]; NaN without a speed.
    estimates : bool
    gears : (str, str)
        Names of driver and driven.
    assumed, rigid : bool
        Whether it is assumed which member floats, and that shafts do not twist where it counts.
    """

    spec: DoubleHelicalSpec
    nominal: float
    second: tuple[str | SolidGearToSolve, str | SolidGearToSolve]
    frequency: float
    estimates: bool
    gears: tuple[str, str] = field(compare=False)
    assumed: bool = field(default=False, compare=False)
    rigid: bool = field(default=False, compare=False)

    @property
    def name(self) -> str:
        """Of the pair."""
        return self.spec.halves[0].name


def double_part(scene: Scene, name: str) -> DoubleHelicalPart:
    """The keys of a double helical pair, or a refusal."""
    part, in_set = scene.case.pair[name].double_helical, set_of_pair(scene.case, name)
    if part is not None and in_set is not None:
        raise InputError(
            f"planetary.{in_set}.double_helical", "true",
            "gives both halves the same load: double-helical is available for pairs outside planetary gear sets",
            "remove double-helical from results, or describe the pair in a case of its own",
        )  # fmt: skip
    if part is None:
        raise InputError(
            f"pair.{name}.double_helical", "(not given)", "is required for double-helical",
            'set double_helical = { gap = "40 mm" }',
        )  # fmt: skip
    return part


def double_helical_pairs(scene: Scene) -> tuple[str, ...]:
    """All double helical pairs; every pair where there is none, so that this is reported."""
    found = tuple(
        name for name, part in scene.case.pair.items()
        if part.double_helical is not None and set_of_pair(scene.case, name) is None
    )  # fmt: skip
    return found or tuple(scene.pairs)


def double_to_load(scene: Scene, name: str) -> DoubleToLoad:
    """Collect what a case says of a double helical pair.

    Raises
    ------
    InputError
    """
    part, given = scene.case.pair[name], double_part(scene, name)
    pair, first = scene.pairs[name], pair_spec(scene, name, over_face=True)
    gears = gear_name(scene, name, "driver"), gear_name(scene, name, "driven")
    others = given.second_driver, given.second_driven
    floating = given.floats(pair)
    key = f"pair.{name}.double_helical"
    loads, nominal = tuple(2.0 * load for load in first.loads), 2.0 * first.nominal
    try:
        spec = DoubleHelicalSpec(
            (first, _second(scene, first, others)), loads, floating,
            math.inf if given.axial_play is None else given.axial_play, given.axial_force,
            twist_between(pair, given.gap, given.torque_in, given.torque_out), key,
            gap=given.gap, apex_offset=given.apex_offset, stagger=given.stagger,
        )  # fmt: skip
    except InputError as error:
        raise error if error.key.startswith("pair.") else error.under(key) from None
    second = tuple(
        _mirror_of(scene, gear) if other is None else other for gear, other in zip(gears, others, strict=True)
    )
    turns = math.nan if part.speed is None else part.speed / (2.0 * math.pi)
    stops = floating is None or given.axial_play is not None
    return DoubleToLoad(
        spec, nominal, (second[0], second[1]), turns * pair.driver.teeth, scene.estimates, gears,
        given.floating is None, stops and given.gap > 0.0 and not (given.torque_in and given.torque_out),
    )  # fmt: skip


def _mirror_of(scene: Scene, gear: str) -> SolidGearToSolve:
    asked = solid_gear_to_solve(scene, gear)
    return replace(asked, gear=of_other_hand(asked.gear))


def _second(scene: Scene, first: PairSpec, others: tuple[str | None, str | None]) -> PairSpec:
    """The half at end II: the mirror image, with the gears of its own that the case gives."""
    from fegear.case.built.flank_modifications import with_face

    half = mirrored(first)
    driver, driven = (
        (half.pair.gear(member), half.flanks(member)) if other is None
        else (scene.gears[other], with_face(scene, gear_flanks(scene, other)))
        for member, other in zip(MEMBERS, others, strict=True)
    )  # fmt: skip
    pair = replace(half.pair, driver=driver[0], driven=driven[0])
    return replace(half, pair=pair, driver=driver[1], driven=driven[1])


def check_double(scene: Scene, name: str) -> None:
    """Refuse pairs whose halves cannot be loaded together.

    Raises
    ------
    InputError
    """
    from fegear.case.built.pair_checks import check_wide_pair
    from fegear.case.built.solid_influence import check_solid_gear

    given = double_part(scene, name)
    if scene.case.pair[name].width == "plane":
        raise InputError(
            f"pair.{name}.width", '"plane"', "contradicts double_helical (3D)", 'set width = "solid" or "slices"'
        )
    check_wide_pair(scene, name)
    for other in given.others.values():
        if other is not None:
            check_solid_gear(scene, other)
    asked = double_to_load(scene, name)
    refuse_another_space(asked)
    refuse_pushed_off(asked)


def refuse_another_space(asked: DoubleToLoad) -> None:
    """Refuse an apex offset with which teeth of one half would be in another tooth space than those of the other.

    Raises
    ------
    InputError
    """
    spec = asked.spec
    limit = 0.5 * spec.halves[0].pair.base_pitch / min(abs(one) for one in spec.seat.twist)
    if abs(spec.apex_offset) >= limit:
        raise InputError(
            f"{spec.name}.apex_offset", f"{spec.apex_offset * 1e3:.6g} mm",
            f"must be below {limit * 1e3:.4g} mm in size (half a pitch at the flanks)", "check its unit",
        )  # fmt: skip


def refuse_pushed_off(asked: DoubleToLoad) -> None:
    """Refuse an axial force that pushes a member without stops off its mate.

    Raises
    ------
    InputError
    """
    spec = asked.spec
    limit = min(abs(one) for one in spec.seat.twist) * spec.loads[0]
    if math.isinf(spec.axial_play) and abs(spec.axial_force) >= limit:
        raise InputError(
            f"{spec.name}.axial_force", f"{spec.axial_force:.6g} N",
            f"must be below {limit:.6g} N in size, the axial force of one half that carries the whole load",
            "reduce it, or specify axial_play",
        )  # fmt: skip
