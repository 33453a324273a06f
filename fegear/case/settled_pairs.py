"""Pairs with numbers for what they give otherwise: torque from power, profile shifts from a distance, thinner teeth."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NoReturn

from fegear.base.errors import FegearError, GeometryError, InputError
from fegear.geometry.shift_of_thickness import ToothNumbers

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.case.gear import GearPart
    from fegear.case.pair import PairPart
    from fegear.geometry.gear import Gear
    from fegear.geometry.shift_sum import MeshNumbers

#: Backlash that is none [m].
_NONE = 1e-9
#: Profile shift coefficients beyond this are those of no gear.
_LARGEST = 3.0
#: Keys by which a case says how thick the teeth of a gear are.
_SHIFTED = ("profile_shift", "tooth_thickness", "span", "over_balls", "over_pins", "chordal_thickness")

#: Keys of a pair from which profile shifts or allowances are derived, and what to do instead.
_DERIVING = {
    "shift_distribution": "set profile_shift of both gears",
    "normal_backlash": "set thickness_allowance of the gears",
    "circumferential_backlash": "set thickness_allowance of the gears",
}


def numbers_of(part: GearPart) -> ToothNumbers:
    """What a gear is before its teeth have a thickness."""
    angle, helix = part.pressure_angle, part.helix_angle or 0.0
    if part.transverse_pressure_angle is not None:
        angle = math.atan(math.tan(part.transverse_pressure_angle) * math.cos(helix))
    return ToothNumbers(part.teeth, angle, helix, part.internal)


def settled_pairs(
    pairs: Mapping[str, PairPart], gears: Mapping[str, GearPart], written: Mapping[str, GearPart]
) -> tuple[dict[str, PairPart], dict[str, GearPart], list[str]]:
    """Pairs and gears with torques, profile shifts and thickness allowances as numbers, and what was made of what.

    Parameters
    ----------
    pairs : mapping
    gears, written : mapping
        Settled as far as each can be alone, and as the case has them.

    Raises
    ------
    InputError
        If a pair asks for what its gears cannot give.
    """
    made, found, said = dict(pairs), dict(gears), []
    shifted = {name: next((key for key in _SHIFTED if key in part.given), "") for name, part in written.items()}
    thinned = {name: "thickness_allowance" in part.model_fields_set for name, part in written.items()}
    known = {name: part for name, part in pairs.items() if {part.driver, part.driven} <= gears.keys()}
    for name, part in known.items():
        _refuse_asymmetric(name, part, gears)
        if part.power is not None and part.speed is not None:
            torque = part.power / part.speed
            made[name] = part.model_copy(update={"torque": torque})
            said.append(
                f"Pair {name}: torque {torque:.6g} N m derived from power = {part.power * 1e-3:.6g} kW and speed."
            )
    for name, part in known.items():
        if part.shift_distribution is not None:
            said.append(_share(name, part, found, shifted))
    for name, part in known.items():
        if part.normal_backlash is not None or part.circumferential_backlash is not None:
            said.append(_thin(name, part, found, thinned))
    return made, found, said


def _refuse_asymmetric(name: str, part: PairPart, gears: Mapping[str, GearPart]) -> None:
    """Refuse to derive shifts or thickness of asymmetric teeth."""
    gear = next((gear for gear in (part.driver, part.driven) if gears[gear].asymmetric), None)
    for key, remedy in _DERIVING.items():
        if gear is not None and getattr(part, key) is not None:
            _refuse(name, key, "(given)", f"is not available for the asymmetric teeth of gear {gear}", remedy)


def _mesh(part: PairPart, gears: Mapping[str, GearPart]) -> tuple[MeshNumbers, float]:
    """Both gears before their teeth have a thickness, and their module [m]."""
    from fegear.geometry.shift_sum import MeshNumbers

    driver, driven = gears[part.driver], gears[part.driven]
    return MeshNumbers(numbers_of(driver), numbers_of(driven)), driver.module_length


def _share(name: str, part: PairPart, gears: dict[str, GearPart], shifted: dict[str, str]) -> str:
    """Give both gears of a pair their profile shifts; returns what was made of what."""
    rule, names = part.shift_distribution or "", (part.driver, part.driven)
    mesh, m = _mesh(part, gears)
    takes = {"driver": names[:1], "driven": names[1:]}.get(rule, names)
    for gear in takes:
        if shifted[gear]:
            _refuse(
                name, "shift_distribution", f'"{rule}"', f"contradicts gear.{gear}.{shifted[gear]}",
                f"remove {shifted[gear]} of gear {gear}, or shift_distribution",
            )  # fmt: skip
    distance = part.centre_distance or math.nan
    try:
        total = mesh.shifts(distance / m)
    except GeometryError:
        _refuse(
            name, "centre_distance", _mm(distance), f"must be at least {_mm(mesh.base_radii * m)} (base circles)",
            "increase it",
        )  # fmt: skip
    if names[0] == names[1]:
        first = 0.5 * total
    elif rule == "driver":
        first = total - gears[names[1]].x
    elif rule == "driven":
        first = gears[names[0]].x
    elif rule == "equal":
        first = 0.5 * total
    else:
        first = _searched(name, part, gears, total)
    if max(abs(first), abs(total - first)) > _LARGEST:
        _refuse(
            name, "centre_distance", _mm(distance),
            f"requires profile shift coefficients of {first:.4g} and {total - first:.4g}, above {_LARGEST:g}",
            f"check it: {_mm(mesh.distance(0.0) * m)} without profile shift",
        )  # fmt: skip
    for gear, shift in zip(names, (first, total - first), strict=True):
        gears[gear] = gears[gear].model_copy(update={"profile_shift": shift})
        shifted[gear] = shifted[gear] or f"profile_shift (derived in pair.{name})"
    return (
        f"Pair {name}: profile shift coefficients x = {first:.6g} ({names[0]}) and {total - first:.6g} ({names[1]}), "
        f"sum {total:.6g}, derived from centre_distance = {_mm(distance)} and shift_distribution = {rule}."
    )


def _searched(name: str, part: PairPart, gears: Mapping[str, GearPart], total: float) -> float:
    """The driver's profile shift at which sliding or root stress of both gears are equal."""
    rule = part.shift_distribution or ""
    if gears[part.driver].internal or gears[part.driven].internal:
        _refuse(
            name, "shift_distribution", f'"{rule}"', "is not available for internal pairs",
            'use "driver", "driven" or "equal"',
        )  # fmt: skip
    from fegear.geometry.shift_sum import shared_evenly

    difference = _sliding(part, gears, total) if rule == "equal-sliding" else _root_stress(part, gears, total)
    found = shared_evenly(difference, total)
    if found is None:
        _refuse(
            name, "shift_distribution", f'"{rule}"', f"has no solution for the sum of x = {total:.4g}",
            'use "equal", or give profile_shift of one gear and use "driver" or "driven"',
        )  # fmt: skip
    return found


def _with(part: PairPart, gears: Mapping[str, GearPart], first: float, total: float) -> tuple[GearPart, GearPart]:
    driver, driven = gears[part.driver], gears[part.driven]
    return (
        driver.model_copy(update={"profile_shift": first}),
        driven.model_copy(update={"profile_shift": total - first}),
    )


def _sliding(part: PairPart, gears: Mapping[str, GearPart], total: float) -> Callable[[float], float | None]:
    """Specific sliding of the driver at A less that of the driven gear at E, over the driver's profile shift."""
    mesh, m = _mesh(part, gears)
    distance = (part.centre_distance or math.nan) / m

    def difference(first: float) -> float | None:
        tips = []
        for gear, numbers in zip(_with(part, gears, first, total), (mesh.driver, mesh.driven), strict=True):
            usual = numbers.pitch_radius + gear.x + gear.rack.build(gear.pressure_angle, m).addendum
            tips.append(usual if gear.tip_diameter is None else 0.5 * gear.tip_diameter / m)
        one, other = mesh.end_sliding(distance, (tips[0], tips[1]))
        return one - other if math.isfinite(one) and math.isfinite(other) else None

    return difference


def _root_stress(part: PairPart, gears: Mapping[str, GearPart], total: float) -> Callable[[float], float | None]:
    """Nominal root stress of the driver less that of the driven gear, as a share, over the driver's profile shift."""
    from fegear.formulas.iso6336.part3_pair import RatingChoice, ToothLoad, rate_helical, virtual_contact_ratio
    from fegear.geometry.pair import GearPair

    def stress(gear: Gear, pair: GearPair) -> float:
        load = ToothLoad(
            1.0 / gear.face_width, virtual_contact_ratio(gear, pair.contact_ratio), pair.overlap_ratio, gear.helix_angle
        )
        return rate_helical(gear, load, RatingChoice(2019)).stress

    def difference(first: float) -> float | None:
        try:
            driver, driven = (gear.build("gear") for gear in _with(part, gears, first, total))
            pair = GearPair(driver, driven, part.centre_distance or math.nan)
            one, other = stress(driver, pair), stress(driven, pair)
        except FegearError:
            return None
        return (one - other) / (one + other)

    return difference


def _thin(name: str, part: PairPart, gears: dict[str, GearPart], thinned: dict[str, bool]) -> str:
    """Make the teeth of a pair thinner until it has its backlash; returns what was made of what."""
    key = "normal_backlash" if part.normal_backlash is not None else "circumferential_backlash"
    given, names = getattr(part, key), (part.driver, part.driven)
    mesh, m = _mesh(part, gears)
    try:
        shifts = sum(gears[gear].x for gear in names)
        distance = mesh.distance(shifts) if part.centre_distance is None else part.centre_distance / m
        normal = given / m if key == "normal_backlash" else mesh.normal_backlash(distance, given / m)
        generating = mesh.shifts_with_backlash(distance, normal)
    except GeometryError as error:
        raise error.under(f"pair.{name}") from None
    whole = 2.0 * m * math.tan(mesh.driver.normal_pressure_angle) * (shifts - generating)
    free = [gear for gear in dict.fromkeys(names) if not thinned[gear]]
    if not free:
        _refuse(
            name, key, _mm(given), f"contradicts thickness_allowance of {' and '.join(dict.fromkeys(names))}",
            "remove the allowance of one gear, or the backlash",
        )  # fmt: skip
    rest = whole - sum(gears[gear].allowance for gear in names if thinned[gear])
    each = rest / sum(gear in free for gear in names)
    if each > 0.5 * m:
        _refuse(
            name, key, _mm(given), f"requires a thickness allowance of {_mm(each)}, more than half a module",
            "check the unit, or reduce it",
        )  # fmt: skip
    if each < -_NONE:
        _refuse(
            name, key, _mm(given), "is less than centre distance and gears give without any allowance",
            "reduce centre_distance, increase the profile shifts, or remove it",
        )  # fmt: skip
    for gear in free:
        gears[gear] = gears[gear].model_copy(update={"thickness_allowance": max(each, 0.0)})
        thinned[gear] = True
    return (
        f"Pair {name}: thickness allowance {max(each, 0.0) * 1e6:.4g} um of {' and '.join(free)} derived from {key} = "
        f"{_mm(given)}."
    )


def _mm(length: float) -> str:
    return f"{length * 1e3:.6g} mm"


def _refuse(name: str, key: str, value: str, rule: str, remedy: str) -> NoReturn:
    raise InputError(f"pair.{name}.{key}", value, rule, remedy)
