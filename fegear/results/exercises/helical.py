"""Questions on helical teeth: both sections, overlap ratio, virtual number of teeth, axial force."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.formulas.iso6336.part3_root_stress import virtual_teeth
from fegear.geometry.pair import MEMBERS
from fegear.results.exercises.wording import DIGITS, Exercise, degrees, figures, mm, same

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.geometry.pair import GearPair

_TOPIC = "Helical teeth"
#: An overlap ratio this near to an integer is one.
_WHOLE = 0.02


def of_helical_pair(pair: GearPair, load: float | None) -> Iterator[Exercise]:
    """Questions on a helical pair under a load along the transverse line of action [N], or None."""
    yield _sections(pair)
    yield _overlap(pair)
    yield _virtual(pair)
    if load:
        yield _axial(pair, load)


def _beside(formula: float, own: float, written: str) -> str:
    """What fegear has, where it is not what the formula gives."""
    return "as in fegear" if same(formula, own) else f"fegear: {written}"


def _sections(pair: GearPair) -> Exercise:
    gear, beta = pair.driver, abs(pair.driver.helix_angle)
    module = gear.module / math.cos(beta)
    angle = math.atan(math.tan(gear.normal_pressure_angle) / math.cos(beta))
    at_angle = gear.transverse_pressure_angle
    diameters = [(one.teeth * module, 2.0 * one.pitch_radius) for one in (pair.driver, pair.driven)]
    each = ", ".join(
        f"{member} {mm(by_hand)}" + ("" if same(by_hand, own) else f" (fegear {mm(own)})")
        for member, (by_hand, own) in zip(MEMBERS, diameters, strict=True)
    )
    return Exercise(
        _TOPIC,
        "How large are module and pressure angle in the transverse section, and the reference diameters?",
        f"m_t = m_n / cos β = {mm(gear.module)} / cos {degrees(beta)} = {mm(module)} "
        f"({_beside(module, gear.transverse_module, mm(gear.transverse_module))}); tan α_t = tan α_n / cos β: α_t = "
        f"{degrees(angle)} ({_beside(angle, at_angle, degrees(at_angle))}); d = z m_t: {each}. The tool is chosen by "
        "m_n, the centre distance follows from m_t.",
    )


def _overlap(pair: GearPair) -> Exercise:
    beta, module, own = abs(pair.driver.helix_angle), pair.driver.module, pair.overlap_ratio
    ratio = pair.face_width * math.sin(beta) / (math.pi * module)
    whole = abs(own - round(own)) < _WHOLE and own > 0.5
    lines = "as here" if whole else f"the next with b = {mm(math.ceil(own) * math.pi * module / math.sin(beta))}"
    return Exercise(
        _TOPIC,
        "How large is the overlap ratio, and what does an integer one do?",
        f"ε_β = b sin β / (π m_n) = {mm(pair.face_width)} · sin {degrees(beta)} / (π · {mm(module)}) = {ratio:.3f} "
        f"({_beside(ratio, own, f'{own:.3f}')}); ε_γ = ε_α + ε_β = {pair.contact_ratio:.3f} + {own:.3f} = "
        f"{pair.total_contact_ratio:.3f}. With an integer ε_β the total length of the contact lines is constant over "
        f"the mesh cycle: {lines}.",
    )


def _virtual(pair: GearPair) -> Exercise:
    said = []
    for member in MEMBERS:
        gear = pair.gear(member)
        beta = abs(gear.helix_angle)
        own = virtual_teeth(gear.teeth, beta, gear.normal_pressure_angle)
        usual = gear.teeth / math.cos(beta) ** 3
        said.append(
            f"{member} {gear.teeth} / cos³ {degrees(beta)} = {figures(usual, DIGITS)} (fegear: {figures(own, DIGITS)})"
        )
    return Exercise(
        _TOPIC,
        "How many teeth has the virtual spur gear in the normal section?",
        f"z_v = z / cos³β: {', '.join(said)}. fegear takes z_n = z / (cos²β_b cos β) of ISO 6336-3 for root stress by "
        "formulas. Undercut and form factor are those of a spur gear with so many teeth.",
    )


def _axial(pair: GearPair, load: float) -> Exercise:
    gear, beta = pair.driver, abs(pair.driver.helix_angle)
    tangential = load * math.cos(gear.transverse_pressure_angle)  # at the reference circle: 2 T / d
    by_hand, own = tangential * math.tan(beta), load * math.tan(abs(gear.base_helix_angle))
    moment = by_hand * gear.pitch_radius
    return Exercise(
        _TOPIC,
        "How large is the axial force on the bearings, and how is it avoided?",
        f"F_a = F_t tan β = {figures(tangential, DIGITS)} N · tan {degrees(beta)} = {figures(by_hand, DIGITS)} N with "
        f"F_t = 2 T₁ / d₁; from the force along the line of action F_bt tan β_b = {figures(load, DIGITS)} N · tan "
        f"{degrees(abs(gear.base_helix_angle))} = {figures(own, DIGITS)} N ({_beside(by_hand, own, 'as given')}). It "
        f"also tilts the shaft of the driver by F_a d₁/2 = {figures(moment, DIGITS)} N m. Its sense changes with hand "
        "and sense of the torque; the halves of double helical gears balance.",
    )
