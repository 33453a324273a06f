"""Questions of a first course on a pair of gears: answers by formulas of textbooks beside those of fegear.

What needs solved gears (transmission error, double contact, root stress) the page asks and answers by itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.formulas.hertz import contact_modulus, line_contact, relative_curvature
from fegear.geometry.checks import LEAST_TIP_THICKNESS, tip_thickness, undercut_of
from fegear.geometry.involute import inv, pressure_angle_of_inv
from fegear.geometry.pair import MEMBERS
from fegear.geometry.path_of_contact import specific_sliding
from fegear.results.exercises.helical import of_helical_pair
from fegear.results.exercises.wording import (
    DIGITS,
    RPM,
    Exercise,
    degrees,
    distance,
    figures,
    mm,
    same,
    signed,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair, Member

#: Tip thickness that case-hardened teeth want [modules].
_HARDENED = 0.4


def exercises_of_pair(scene: Scene, name: str) -> list[Exercise]:
    """Questions on a pair; none of asymmetric teeth, whose formulas are not those of textbooks."""
    pair = scene.pairs[name]
    if pair.asymmetric:
        return []
    part = scene.case.pair[name]
    load = part.normal_load(pair)
    return list(_of_pair(_Mesh(pair, None if load is None else load * part.halves, part.speed or 0.0)))


@dataclass(frozen=True)
class _Mesh:
    """A pair, its load along the transverse line of action [N] or None, and the speed of its driver [rad/s] or 0."""

    pair: GearPair
    load: float | None
    speed: float

    @property
    def helical(self) -> bool:
        return self.pair.driver.helix_angle != 0.0

    @property
    def reference_distance(self) -> float:
        """a = m_t (z_1 + z_2) / 2 [m]."""
        return abs(self.pair.driver.pitch_radius + self.pair.side * self.pair.driven.pitch_radius)

    @property
    def working_radius(self) -> float:
        """Of the driver's working pitch circle [m]."""
        return self.pair.driver.base_radius / math.cos(self.pair.working_pressure_angle)

    @property
    def torque(self) -> float:
        """Of the driver [N m]."""
        return (self.load or 0.0) * self.pair.driver.base_radius


def _of_pair(mesh: _Mesh) -> Iterator[Exercise]:
    yield _undercut(mesh.pair)
    yield _contact_ratio(mesh.pair)
    yield _sliding(mesh)
    yield _ratio(mesh)
    yield _centre_distance(mesh)
    yield _base_pitch(mesh)
    yield _tip_thickness(mesh.pair)
    if mesh.helical:
        yield from of_helical_pair(mesh.pair, mesh.load)
    if mesh.load:
        yield _forces(mesh)
        if not mesh.helical:
            yield _pressure(mesh, mesh.load)


# ---- geometry --------------------------------------------------------------------------------------------------------


def _undercut(pair: GearPair) -> Exercise:
    found = {member: one for member in MEMBERS if (one := undercut_of(pair.gear(member))) is not None}
    said = [
        f"The {member} gear is undercut: {figures(one.lost * 1e3, 2)} mm of its involute above the base circle are cut "
        f"away; profile_shift = {signed(one.enough, 4)} and more avoid it."
        for member, one in found.items() if one.lost > 0.0
    ]  # fmt: skip
    if not said:
        limits = ", ".join(f"{signed(one.enough, 4)} ({member})" for member, one in found.items())
        begins = f"; undercut begins below profile_shift = {limits}" if limits else ""
        said = [f"Neither gear is undercut{begins}."]
    straight = {member: one.straight for member, one in found.items() if one.straight is not None}
    if straight:
        usual = ", ".join(f"{signed(_least_shift(pair.gear(member)), 3)} ({member})" for member in straight)
        rule = "x_min = h − z sin²α_t / (2 cos β)" if pair.driver.helix_angle else "x_min = h − z sin²α/2"
        said.append(
            f"Rule: {rule}. Textbooks take h = 1: {usual}; the flank of this rack is straight down to "
            f"h = {' and '.join(dict.fromkeys(f'{one:.3f}' for one in straight.values()))} modules below its reference "
            "line."
        )
    return Exercise("Geometry", "Is a gear undercut, and which profile shift avoids it?", " ".join(said))


def _least_shift(gear: Gear) -> float:
    """Profile shift without undercut by a rack that is straight down to one module."""
    return 1.0 - 0.5 * gear.teeth * math.sin(gear.transverse_pressure_angle) ** 2 / math.cos(gear.helix_angle)


def _contact_ratio(pair: GearPair) -> Exercise:
    question = "How large is the contact ratio?"
    ratio = f"{mm(pair.path_length)} / {mm(pair.base_pitch)} = {pair.contact_ratio:.3f}"
    below = " Below 1 motion is not transmitted continuously." if pair.contact_ratio < 1.0 else ""
    radii = [(one.tip_radius, one.base_radius) for one in (pair.driver, pair.driven)]
    if any(tip <= base for tip, base in radii):
        return Exercise("Geometry", question, f"Path of contact over base pitch: {ratio}.{below}")
    tips = [math.sqrt(tip**2 - base**2) for tip, base in radii]
    angle = pair.working_pressure_angle
    between = pair.centre_distance * math.sin(angle)
    signs = [one.tooth.side for one in (pair.driver, pair.driven)]  # -1 of a ring, whose tip circle is the inner one
    by_tips = (sum(side * tip for side, tip in zip(signs, tips, strict=True)) - pair.side * between) / pair.base_pitch
    t = "t" if pair.driver.helix_angle else ""
    roots, lengths = (
        _sum(*zip((*signs, -pair.side), terms, strict=True))
        for terms in (
            ("√(r_a1² − r_b1²)", "√(r_a2² − r_b2²)", f"a sin α_w{t}"),
            [figures(one * 1e3, DIGITS) for one in (*tips, between)],
        )
    )
    formula = f"ε = ({roots}) / p_b{t} = ({lengths}) mm / {mm(pair.base_pitch)} = {by_tips:.3f}"
    if same(by_tips, pair.contact_ratio):
        overlap = f"; overlap ratio {pair.overlap_ratio:.3f}" if pair.overlap_ratio else ""
        return Exercise("Geometry", question, f"{formula}{overlap}.{below}")
    return Exercise("Geometry", question, f"{formula}; fegear: {ratio}, because {_shortened_by(pair)}.{below}")


def _sum(*terms: tuple[float, str]) -> str:
    """Terms with their signs, those added first."""
    plus, *more = sorted(terms, key=lambda one: one[0] < 0.0)
    return plus[1] + "".join(f" {'−' if sign < 0.0 else '+'} {term}" for sign, term in more)


def _shortened_by(pair: GearPair) -> str:
    """What ends the path of contact before the tip circles do."""
    found = []
    for member, verb, x in zip(MEMBERS, ("begins", "ends"), (pair.x_start, pair.x_end), strict=True):
        gear = pair.gear(member)
        if abs(x - float(pair.x_of_radius(gear.form_radius, member))) < 1e-9 * pair.base_pitch:
            undercut = undercut_of(gear)
            cut = ", which is undercut" if undercut is not None and undercut.lost > 0.0 else ""
            found.append(f"the path of contact {verb} at the root form circle of the {member} gear{cut}")
    return " and ".join(found) or "the involute ends below the tip circle"


def _sliding(mesh: _Mesh) -> Exercise:
    pair = mesh.pair
    most = ("A", pair.x_start) if -pair.x_start > pair.x_end else ("E", pair.x_end)
    velocity = ""
    if mesh.speed:
        fastest = mesh.speed * abs(1.0 + pair.side / pair.ratio) * abs(most[1])
        velocity = f", {figures(fastest, 3)} m/s at {figures(mesh.speed * RPM, DIGITS)} rpm"
    specific = ", ".join(f"{_specific(pair, member, 'A', 'E')}" for member in MEMBERS)
    return Exercise(
        "Geometry",
        "Where on the path of contact do the flanks not slide, where most, and how large is the specific sliding at A "
        "and E?",
        f"Not at C, the pitch point; the sliding velocity v_g = (ω₁ {'−' if pair.internal else '+'} ω₂) g increases "
        f"with the distance g from it and is largest at {most[0]} (A: {mm(abs(pair.x_start))}, E: "
        f"{mm(abs(pair.x_end))} from C{velocity}). Specific sliding ζ₁ = 1 − z₁ρ₂ / (z₂ρ₁), ζ₂ = 1 − z₂ρ₁ / (z₁ρ₂): "
        f"{specific}.",
    )


def _specific(pair: GearPair, member: Member, *letters: str) -> str:
    places = {"A": pair.x_start, "E": pair.x_end}
    found = (float(specific_sliding(pair, places[letter], member)) for letter in letters)
    return f"{member} " + " and ".join(
        f"{figures(one, 3) if math.isfinite(one) else '−∞'} at {letter}"
        for one, letter in zip(found, letters, strict=True)
    )


def _ratio(mesh: _Mesh) -> Exercise:
    pair = mesh.pair
    u = pair.ratio
    said = [f"i = n₁/n₂ = z₂/z₁ = {pair.driven.teeth}/{pair.driver.teeth} = {figures(u, DIGITS)}"]
    if mesh.speed:
        said.append(f"n₂ = {figures(mesh.speed * RPM / u, DIGITS)} rpm")
    if mesh.load:
        said.append(f"T₂ = i T₁ = {figures(u * mesh.torque, DIGITS)} N m without losses")
    sense = "the same sense of rotation" if pair.internal else "opposite senses of rotation"
    return Exercise("Geometry", "How large is the transmission ratio, and what speed and torque has the driven gear?",
                    f"{'; '.join(said)}; {sense}.")  # fmt: skip


def _centre_distance(mesh: _Mesh) -> Exercise:
    pair, a = mesh.pair, mesh.reference_distance
    tooth = pair.driver.symmetric_tooth
    shifts = tooth.profile_shift + pair.driven.symmetric_tooth.profile_shift
    teeth = tooth.side * tooth.teeth + pair.driven.tooth.side * pair.driven.teeth
    t, n, reference, cos = ("_wt", "_n", "_t", " / cos β") if mesh.helical else ("_w", "", "", "")
    between = "|z₁ − z₂|" if pair.internal else "(z₁ + z₂)"
    signed = "(z₂ − z₁)" if tooth.side < 0.0 else "(z₁ − z₂)" if pair.internal else between
    said = f"a = m{n} {between}{cos} / 2 = {distance(a)}"
    tight = a
    if abs(shifts) > 1e-12:
        angle = float(pressure_angle_of_inv(
            float(inv(tooth.pressure_angle)) + 2.0 * shifts * math.tan(tooth.normal_pressure_angle) / teeth
        ))  # fmt: skip
        tight = a * math.cos(tooth.pressure_angle) / math.cos(angle)
        said += (
            f"; inv α{t} = inv α{reference} + 2 (x₁ + x₂) tan α{n} / {signed}: α{t} = {degrees(angle)}, "
            f"a_w = a cos α{reference} / cos α{t} = {distance(tight)} without backlash"
        )
    else:
        said += ", the working centre distance without backlash, since x₁ + x₂ = 0"
    if abs(pair.centre_distance - tight) > 1e-4 * pair.driver.module:
        said += (
            f"; the case has {distance(pair.centre_distance)}: α{t} = {degrees(pair.working_pressure_angle)}, normal "
            f"backlash {mm(pair.normal_backlash)}"
        )
    elif pair.normal_backlash > 1e-4 * pair.driver.module:
        said += f"; thinner teeth give {mm(pair.normal_backlash)} of normal backlash at it"
    return Exercise("Geometry", "How large are reference and working centre distance?", f"{said}.")


def _base_pitch(mesh: _Mesh) -> Exercise:
    pair, gear = mesh.pair, mesh.pair.driver
    if mesh.helical:
        angles = f"cos {degrees(gear.transverse_pressure_angle)} / cos {degrees(abs(gear.helix_angle))}"
        formula = f"p_bt = π m_n cos α_t / cos β = π · {mm(gear.module)} · {angles}"
    else:
        formula = f"p_b = π m cos α = π · {mm(gear.module)} · cos {degrees(gear.normal_pressure_angle)}"
    return Exercise(
        "Geometry",
        "How large is the base pitch, and why must it be equal on both gears?",
        f"{formula} = {mm(pair.base_pitch)}: the distance of successive flanks along the line of action, on which the "
        "next tooth pair comes into contact while this one still is.",
    )


def _tip_thickness(pair: GearPair) -> Exercise:
    said = []
    for member in MEMBERS:
        gear = pair.gear(member)
        if gear.tooth.internal:
            continue
        own, usual = tip_thickness(gear), _usual_tip_thickness(gear)
        here = f"{member} {mm(usual)} = {figures(usual / gear.module, 3)} m"
        if not same(own, usual):
            here += f" (fegear: {mm(own)}, with thickness allowance and the end of the involute below a tip rounding)"
        said.append(here)
    n, t, helix = ("_n", "_t", " cos β_a") if pair.driver.helix_angle else ("", "", "")
    at_tip = f"α_a{t[1:]}"
    return Exercise(
        "Geometry",
        "How thick are the teeth at the tip circle, and is that enough?",
        f"s_a = d_a ((π/2 + 2 x tan α{n}) / z + inv α{t} − inv {at_tip}){helix}: {'; '.join(said)}. Usual minimum "
        f"{LEAST_TIP_THICKNESS} m, case-hardened {_HARDENED} m.",
    )


def _usual_tip_thickness(gear: Gear) -> float:
    """By the formula of textbooks, with the nominal profile shift and the tip circle [m]."""
    tooth, radius = gear.symmetric_tooth, gear.tip_radius
    at_reference = (0.5 * math.pi + 2.0 * tooth.profile_shift * math.tan(tooth.normal_pressure_angle)) / tooth.teeth
    tip_angle = math.acos(min(gear.base_radius / radius, 1.0))
    arc = 2.0 * radius * (at_reference + float(inv(tooth.pressure_angle)) - float(inv(tip_angle)))
    return arc * math.cos(math.atan(gear.twist * radius))


# ---- forces and stresses ---------------------------------------------------------------------------------------------


def _forces(mesh: _Mesh) -> Exercise:
    pair, angle, radius = mesh.pair, mesh.pair.working_pressure_angle, mesh.working_radius
    tangential = mesh.torque / radius
    said = [
        f"F_t = 2 T₁ / d_w1 = {figures(tangential, DIGITS)} N",
        f"F_r = F_t tan α_w{'t' if mesh.helical else ''} = {figures(tangential * math.tan(angle), DIGITS)} N",
    ]
    normal = tangential / math.cos(angle)
    if mesh.helical:
        axial = tangential * math.tan(abs(pair.working_helix_angle))
        normal /= math.cos(pair.driver.base_helix_angle)
        said.append(f"F_a = F_t tan β_w = {figures(axial, DIGITS)} N")
    else:
        said.append("F_a = 0 (spur)")
    said.append(f"normal to the flank F_n = {figures(normal, DIGITS)} N")
    other = ""
    if not same(radius, pair.driver.pitch_radius):
        at_reference = mesh.torque / pair.driver.pitch_radius
        other = f" ISO 6336 takes F_t at the reference circle: 2 T₁ / d₁ = {figures(at_reference, DIGITS)} N."
    along = "" if mesh.helical else " F_n is the sum of the loads of all tooth pairs in fegear."
    return Exercise("Forces and stresses", "Which forces act between the gears (tangential, radial, axial)?",
                    f"{'; '.join(said)}.{other}{along}")  # fmt: skip


def _pressure(mesh: _Mesh, load: float) -> Exercise:
    pair = mesh.pair
    materials = [(one.material.young_modulus, one.material.poisson_ratio) for one in (pair.driver, pair.driven)]
    modulus = contact_modulus(*materials[0], *materials[1])
    radii = [float(pair.flank_curvature_radius(0.0, member)) for member in MEMBERS]
    curvature = float(relative_curvature(*radii))
    pressure = float(line_contact(load / pair.face_width, curvature, modulus).peak_pressure)
    shared = pair.x_lpstc <= 0.0 <= pair.x_hpstc and pair.contact_ratio < 2.0
    alone = "C lies where one tooth pair carries all of the load" if shared else (
        "at C two tooth pairs share the load, so that the pressure there is lower")  # fmt: skip
    return Exercise(
        "Forces and stresses",
        "How large is the Hertzian pressure at the pitch point?",
        f"p = √(F_n E* / (π b ρ)) = {figures(pressure * 1e-6, DIGITS)} MPa with one tooth pair in contact: "
        f"F_n = {figures(load, DIGITS)} N, b = {mm(pair.face_width)}, ρ = ρ₁ρ₂ / (ρ₁ {'−' if pair.internal else '+'} "
        f"ρ₂) = {mm(1.0 / curvature)}, 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂; {alone}.",
        "largest_hertz_pressure",
        "The maximum over the path of contact in fegear is {}: elsewhere flanks are more curved, and loads shared.",
    )
