"""What a case says of the tolerances that deviations are drawn inside."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.errors import InputError
from fegear.geometry.pair import MEMBERS
from fegear.models.pair_inputs import gear_name

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.case.robustness import TolerancePart
    from fegear.design.tolerance_draws import Kind, Limits


def tolerance_part(scene: Scene) -> TolerancePart:
    """``[robustness]``, which the case must have."""
    if scene.case.robustness is None:
        raise InputError("robustness", "(not given)", "is needed to draw deviations", "write a table [robustness]")
    return scene.case.robustness


def chosen_pair(scene: Scene) -> tuple[str, ...]:
    """The pair that ``[robustness]`` names, or the only one; none without the table."""
    part = scene.case.robustness
    if part is None:
        return ()
    if part.pair is not None:
        if part.pair not in scene.pairs:
            raise InputError("robustness.pair", f'"{part.pair}"', "is no pair of this case")
        return (part.pair,)
    if len(scene.pairs) != 1:
        raise InputError(
            "robustness.pair", "(not given)", f"is needed in a case of {len(scene.pairs)} pairs", "name one of them"
        )
    return tuple(scene.pairs)


def refuse_no_tolerance(scene: Scene, name: str, limits: Limits) -> None:
    """Refuse a pair none of whose wanted deviations has a tolerance."""
    pairs = (limits.profile_slope, limits.profile_form, limits.helix_slope, limits.pitch)
    if not limits.centre_distance and not any(any(pair) for pair in pairs):
        raise InputError(
            "robustness", "no tolerance", "leaves nothing to draw",
            f"give gear.{gear_name(scene, name, 'driver')}.tolerance_class",
        )  # fmt: skip


def limits_of(scene: Scene, name: str, usual: tuple[Kind, ...]) -> Limits:
    """Largest deviations of a pair, of the kinds that the case names or else of the usual ones.

    f_pT is an arc of the reference circle; flanks meet that deviation along the line of action, where it is shorter.
    """
    from fegear.design.tolerance_draws import Limits
    from fegear.formulas.iso1328 import tolerances_of

    part = tolerance_part(scene)
    wanted: tuple[Kind, ...] = tuple(part.deviations or usual)
    found = []
    pitch = [0.0, 0.0]
    for i, member in enumerate(MEMBERS):
        gear = gear_name(scene, name, member)
        grade, made = scene.case.gear[gear].tolerance_class, scene.gears[gear]
        own = None if grade is None else tolerances_of(made, grade)
        found.append(own)
        if own is not None and "pitch" in wanted:
            pitch[i] = own.base_pitch(made.transverse_pressure_angle)

    def both(kind: Kind, key: str) -> tuple[float, float]:
        one, other = (getattr(own, key) if own and kind in wanted else 0.0 for own in found)
        return one, other

    return Limits(
        part.centre_distance if "centre-distance" in wanted else 0.0, both("profile-slope", "profile_slope"),
        both("profile-form", "profile_form"), both("helix-slope", "helix_slope"), (pitch[0], pitch[1]),
    )  # fmt: skip


def unclassed(scene: Scene, gears: tuple[str, str]) -> tuple[str, ...]:
    """Gears without a tolerance class."""
    return tuple(gear for gear in dict.fromkeys(gears) if scene.case.gear[gear].tolerance_class is None)
