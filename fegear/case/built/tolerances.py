"""What a case says of the tolerances that deviations are drawn inside."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.case.built.gear_deviations import Deviation, gear_deviations, own_deviation
from fegear.case.built.members import gear_name
from fegear.case.part import at
from fegear.geometry.pair import MEMBERS, GearPair

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.case.studies import TolerancePart
    from fegear.design.robustness.tolerance_draws import Kind, Limits


#: Deviations of a gear by the kinds that are drawn.
_NAMES: dict[Kind, Deviation] = {
    "profile-slope": "profile_slope", "profile-form": "profile_form", "helix-slope": "helix_slope",
    "pitch": "base_pitch",
}  # fmt: skip


def tolerance_part(scene: Scene) -> TolerancePart:
    """``[robustness]``, which the case must have."""
    if scene.case.robustness is None:
        raise InputError("robustness", "(not given)", "is required to sample deviations", "add a table [robustness]")
    return scene.case.robustness


def chosen_pair(scene: Scene) -> tuple[str, ...]:
    """The pair that ``[robustness]`` names, or the only one; none without the table."""
    part = scene.case.robustness
    if part is None:
        return ()
    if part.pair is not None:
        if part.pair not in scene.pairs:
            raise InputError("robustness.pair", f'"{part.pair}"', "is not a pair of this case")
        return (part.pair,)
    if len(scene.pairs) != 1:
        raise InputError(
            "robustness.pair",
            "(not given)",
            f"is required in a case with {len(scene.pairs)} pairs",
            "specify one of them",
        )
    return tuple(scene.pairs)


def refuse_no_tolerance(scene: Scene, name: str, limits: Limits) -> None:
    """Refuse a pair none of whose wanted deviations has a tolerance."""
    pairs = (limits.profile_slope, limits.profile_form, limits.helix_slope, limits.pitch)
    if not limits.centre_distance and not any(any(pair) for pair in pairs):
        raise InputError(
            "robustness", "no tolerance", "gives no deviations to sample",
            f"specify gear.{gear_name(scene, name, 'driver')}.tolerance_class or deviations",
        )  # fmt: skip


def refuse_jammed(pair: GearPair, name: str, limits: Limits) -> None:
    """Refuse deviations of the centre distance at which the teeth of the drawing touch on both flanks."""
    room = pair.side * (pair.centre_distance - pair.tight_centre_distance)
    other = "smaller" if pair.internal else "larger"
    if limits.centre_distance > room * (1.0 + 1e-9) + 1e-12:
        raise InputError(
            "robustness.centre_distance", f"{limits.centre_distance * 1e3:.6g} mm",
            f"leaves no backlash: pair {name} has only {room * 1e3:.4g} mm of centre distance until both flanks touch",
            f"specify thickness_allowance of a gear of pair {name}, or a {other} centre_distance",
        )  # fmt: skip


def limits_of(scene: Scene, name: str, usual: tuple[Kind, ...]) -> Limits:
    """Largest deviations of a pair, of the kinds that the case names or else of the usual ones.

    A gear's own deviations take the place of those of its class. f_pT is an arc of the reference circle; flanks meet
    that deviation along the line of action, where it is shorter.

    Raises
    ------
    InputError
        If a class is asked of a gear outside the sizes of ISO 1328-1.
    """
    from fegear.design.robustness.tolerance_draws import Limits
    # DROP

    part = tolerance_part(scene)
    kinds = _of_flanks(part, usual)
    found: list[dict[Deviation, float]] = []
    for member in MEMBERS:
        gear = gear_name(scene, name, member)
        drawn = scene.case.gear[gear]
        try:
            found.append(gear_deviations(drawn, scene.gears[gear], drawn.tolerance_class, kinds))
        except InputError as error:
            missing = ", ".join(one for one in kinds if own_deviation(drawn, one) is None)
            remedy = f"specify {missing} of gear.{gear}.deviations, or change robustness.deviations"
            error = type(error)(error.key, error.value, error.rule, remedy)
            raise at(f"gear.{gear}", error, None if drawn.is_helical else {"normal_module": "module"}) from None

    def both(kind: Deviation) -> tuple[float, float]:
        return found[0].get(kind, 0.0), found[1].get(kind, 0.0)

    wanted = "centre-distance" in (part.deviations or usual)
    return Limits(
        part.centre_distance if wanted else 0.0, both("profile_slope"), both("profile_form"), both("helix_slope"),
        both("base_pitch"),
    )  # fmt: skip


def untold(scene: Scene, gears: tuple[str, str], usual: tuple[Kind, ...]) -> tuple[str, ...]:
    """Sentences on deviations that are not drawn, for the case says nothing of them."""
    kinds, told = _of_flanks(tolerance_part(scene), usual), []
    for gear in dict.fromkeys(gears):
        part = scene.case.gear[gear]
        if part.tolerance_class is not None:
            continue
        missing = [kind for kind in kinds if own_deviation(part, kind) is None]
        if len(missing) == len(kinds):
            told.append(assuming(f"Gear {gear}: no tolerance_class specified; nominal flanks used in every sample."))
        elif missing:
            told.append(
                assuming(
                    f"Gear {gear}: no tolerance_class and no {', '.join(missing)} specified in its deviations; nominal "
                    "values of these used in every sample."
                )
            )
    return tuple(told)


def _of_flanks(part: TolerancePart, usual: tuple[Kind, ...]) -> tuple[Deviation, ...]:
    """Kinds that a gear's tolerances tell."""
    return tuple(_NAMES[kind] for kind in (part.deviations or usual) if kind != "centre-distance")
