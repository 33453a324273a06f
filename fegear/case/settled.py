"""A case in which every gear has module, profile shift and thickness allowance as numbers, from whatever was given.

What is made of another dimension is said in a sentence for each, for the notes of a run.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, TypeVar

from fegear.base.errors import GeometryError, InputError
from fegear.case.gear_teeth import DERIVED
from fegear.case.part import at
from fegear.case.settled_pairs import numbers_of, settled_pairs
from fegear.geometry.materials import named_material

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.case.gear import GearPart
    from fegear.case.gear_material import MaterialPart
    from fegear.case.model import Case
    from fegear.geometry.shift_of_thickness import ToothNumbers

T = TypeVar("T")
#: Thickness that two readings of one tooth may differ by [m]: less than any gauge sees.
_SAME = 1e-9
#: Steps in which `no-undercut` is rounded up: four digits, as profile shifts are printed.
_STEPS = 1e4
#: Lengths in the messages of the geometry.
_MODULES = re.compile(r"(\d[\d.e+-]*) modules")
#: Sizes that are other names of the module.
_SIZES = ("circular_pitch", "normal_circular_pitch", "transverse_module")


def settled(case: Case) -> tuple[Case, tuple[str, ...]]:
    """The case with numbers for what its gears give otherwise, and what was made of what.

    Raises
    ------
    InputError
        If a dimension is that of no tooth.
    """
    gears: dict[str, GearPart] = {}
    said: list[str] = []
    for name, part in case.gear.items():
        gears[name], notes = settled_gear(part, name)
        said += notes
    pairs, gears, notes = settled_pairs(case.pair, gears, case.gear)
    return case.model_copy(update={"gear": gears, "pair": pairs}), (*said, *notes)


def settled_gear(part: GearPart, name: str) -> tuple[GearPart, list[str]]:
    """One gear, and sentences about what was made of what."""
    said = []
    for step in (_size, _angle, _allowance, _shift, _measured, _material, _steel):
        part, note = step(part, name)
        said += [f"Gear {name}: {note}."] if note else []
    return part, said


def _size(part: GearPart, _name: str) -> tuple[GearPart, str]:
    key = next((key for key in _SIZES if getattr(part, key) is not None), None)
    if key is None:
        return part, ""
    what = "module m" if key == "circular_pitch" else "normal module m_n"
    return part, f"{what} = {_mm(part.module_length)} derived from {key} = {_mm(getattr(part, key))}"


def _angle(part: GearPart, _name: str) -> tuple[GearPart, str]:
    transverse = part.transverse_pressure_angle
    if transverse is None:
        return part, ""
    normal = numbers_of(part).normal_pressure_angle
    note = (
        f"normal pressure angle {math.degrees(normal):.6g} deg derived from transverse_pressure_angle = "
        f"{math.degrees(transverse):.6g} deg"
    )
    return part.model_copy(update={"pressure_angle": normal}), note


def _allowance(part: GearPart, name: str) -> tuple[GearPart, str]:
    designation = part.thickness_allowance
    if not isinstance(designation, str) or designation == DERIVED:
        return part, ""
    from fegear.formulas.din3967 import thickness_limits

    diameter = 2.0 * numbers_of(part).pitch_radius * part.module_length
    limits = _under(name, lambda: thickness_limits(designation, diameter))
    note = (
        f"thickness allowance {_um(limits.mean)}, mean of {designation} (DIN 3967 at d = {_mm(diameter)}: "
        f"A_sne = {_um(-limits.upper)}, T_sn = {_um(limits.tolerance)})"
    )
    return part.model_copy(update={"thickness_allowance": limits.mean}), note


def _shift(part: GearPart, name: str) -> tuple[GearPart, str]:
    """The profile shift as a number in the sign of ISO 21771."""
    shift = part.profile_shift
    if isinstance(shift, str):
        if part.internal:
            raise InputError(
                f"gear.{name}.profile_shift", f'"{shift}"', "applies only to external gears",
                "give the profile shift as a number",
            )  # fmt: skip
        numbers = numbers_of(part)
        rack = _under(name, lambda: part.rack.build(numbers.normal_pressure_angle, part.module_length))
        least = max(numbers.least_shift(rack) + _thinner(part), 0.0)
        rounded = math.ceil(least * _STEPS - 1e-6) / _STEPS
        note = f"profile shift coefficient x = {rounded:.4f}, the minimum without undercut"
        return part.model_copy(update={"profile_shift": rounded}), note
    if not part.internal or part.profile_shift_sign != "khk":
        return part, ""
    note = (
        f"profile shift coefficient x = {-shift:.6g} in the sign of ISO 21771 (positive towards the tooth tip), "
        f"{shift:.6g} in that of KHK"
    )
    return part.model_copy(update={"profile_shift": -shift, "profile_shift_sign": "iso-21771"}), note if shift else ""


def _thinner(part: GearPart) -> float:
    """x - x_E of the thickness allowance."""
    return 0.5 * part.allowance / part.module_length / math.tan(numbers_of(part).normal_pressure_angle)


def _measured(part: GearPart, name: str) -> tuple[GearPart, str]:
    """Profile shift, or thickness allowance, of the thickness that a gear gives."""
    key = part.measure
    if key is None:
        return part, ""
    numbers, m = numbers_of(part), part.module_length
    try:
        generating = _generating_shift(part, numbers, m)
    except GeometryError as error:  # in modules
        rule = _MODULES.sub(lambda found: _mm(float(found[1]) * m), error.rule)
        raise InputError(f"gear.{name}.{error.key}", _mm(getattr(part, error.key)), rule, error.remedy) from None
    if part.thickness_allowance != DERIVED:
        shift = generating + _thinner(part)
        note = f"profile shift coefficient x = {shift:.6g} derived from {_reading(part, key)}"
        return part.model_copy(update={"profile_shift": shift}), note
    taken = 2.0 * m * math.tan(numbers.normal_pressure_angle) * (part.x - generating)
    if taken < -_SAME:
        raise InputError(
            f"gear.{name}.{key}", _mm(getattr(part, key)),
            f"gives a tooth {_um(-taken)} thicker than profile_shift does", "check both, or remove profile_shift",
        )  # fmt: skip
    note = f"thickness allowance {_um(max(taken, 0.0))} derived from {_reading(part, key)} and x = {part.x:.6g}"
    return part.model_copy(update={"thickness_allowance": max(taken, 0.0)}), note


def _generating_shift(part: GearPart, numbers: ToothNumbers, m: float) -> float:
    """x_E of the thickness that a gear gives."""
    if part.tooth_thickness is not None:
        return numbers.shift_of_thickness(part.tooth_thickness / m)
    if part.span is not None:
        return numbers.shift_of_span(part.span / m, part.span_teeth or 1)
    ball = (part.ball_diameter or math.nan) / m
    if part.over_balls is not None:
        return numbers.shift_over_balls(part.over_balls / m, ball)
    if part.over_pins is not None:
        return numbers.shift_over_balls(part.over_pins / m, ball, opposite=part.has_helix, key="over_pins")
    chord = (part.chordal_thickness or math.nan) / m
    if part.chordal_height is None:
        return numbers.shift_of_chord(chord)
    return numbers.shift_of_chord_at(chord, part.chordal_height / m, 0.5 * (part.tip_diameter or math.nan) / m)


def _modulus(material: MaterialPart) -> str:
    """With which modulus a plastic is computed, and what it is for."""
    said = f"E = {material.modulus * 1e-9:.4g} GPa"
    if material.creep_modulus is not None:
        return f"{said} (creep_modulus) for long-term loads; vibration depends on the short-term modulus"
    if material.modulus_over_temperature is not None:
        return f"{said} at {material.temperature:g} degC (modulus_over_temperature), for short-term loads"
    return ""


def _material(part: GearPart, _name: str) -> tuple[GearPart, str]:
    if soft := _modulus(part.material):
        return part, soft
    found = None if part.material.name is None else named_material(part.material.name)
    if found is None:
        return part, ""
    material = part.material
    return part, (
        f"material {found.name}: E = {material.young_modulus * 1e-9:.4g} GPa, nu = {material.poisson_ratio:.4g}, "
        f"density {material.density:.4g} kg/m^3 ({found.source}); stress numbers are those of strength"
    )


def _steel(part: GearPart, _name: str) -> tuple[GearPart, str]:
    if part.strength is None or part.strength.steel is None:
        return part, ""
    return part, (
        f"{part.strength.steel} is rated as {part.strength.material} of ISO 6336-5; confirm heat treatment, hardness "
        "and stress numbers of strength"
    )


def _reading(part: GearPart, key: str) -> str:
    """What was given, for a sentence."""
    text = f"{key} = {_mm(getattr(part, key))}"
    if key == "span":
        return f"{text} over {part.span_teeth} teeth"
    if key in ("over_balls", "over_pins"):
        return f"{text} with ball_diameter = {_mm(part.ball_diameter or math.nan)}"
    return text if part.chordal_height is None else f"{text} at chordal_height = {_mm(part.chordal_height)}"


def _mm(length: float) -> str:
    return f"{length * 1e3:.6g} mm"


def _um(length: float) -> str:
    return f"{length * 1e6:.4g} um"


def _under(name: str, made: Callable[[], T]) -> T:
    """The answer of a lower layer, its refusals under the keys of the gear."""
    try:
        return made()
    except (GeometryError, InputError) as error:
        raise at(f"gear.{name}", error) from None
