"""Questions on a rack and pinion: travel, forces, distance and backlash, contact ratio, undercut."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import FegearError
from fegear.case.built.rack import rack_inputs
from fegear.geometry.checks import undercut_of
from fegear.results.exercises.wording import DIGITS, Exercise, degrees, distance, figures, mm, same, signed

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.geometry.rack_and_pinion import RackAndPinion

_TOPIC = "Rack and pinion"


def exercises_of_rack(scene: Scene, name: str) -> list[Exercise]:
    """Questions on a rack; none of one that cannot mesh, for which the case is refused."""
    try:
        inputs = rack_inputs(scene, name)
    except FegearError:
        return []
    pair = inputs.pair
    found = [_travel(pair), _distance(pair), _contact_ratio(pair), _undercut(pair)]
    return [*found, _forces(pair, inputs.force)] if inputs.force else found


def _sub(pair: RackAndPinion) -> tuple[str, str]:
    """Index of the transverse section, and of the normal one, where there are two."""
    return ("_t", "_n") if pair.rack.helix_angle else ("", "")


def _travel(pair: RackAndPinion) -> Exercise:
    pinion, (t, n) = pair.pinion, _sub(pair)
    beta = abs(pair.rack.helix_angle)
    pitch = math.pi * pinion.module / math.cos(beta)
    helix = f" / cos {degrees(beta)}" if beta else ""
    of_rack = "as the pitch of the rack in fegear" if same(pitch, pair.rack.pitch) else f"fegear: {mm(pair.rack.pitch)}"
    return Exercise(
        _TOPIC,
        "How far does the rack travel per tooth and per revolution of the pinion?",
        f"p{t} = π m{n}{' / cos β' if beta else ''} = π · {mm(pinion.module)}{helix} = {mm(pitch)} per tooth "
        f"({of_rack}); π d = z p{t} = {pinion.teeth} · {mm(pitch)} = {mm(pinion.teeth * pitch)} per revolution. The "
        "pinion rolls on its reference circle at every distance: a profile shift does not change the travel.",
    )


def _distance(pair: RackAndPinion) -> Exercise:
    pinion, (t, _) = pair.pinion, _sub(pair)
    tooth = pinion.symmetric_tooth
    shift = tooth.profile_shift
    tight = pinion.pitch_radius + shift * pinion.module
    angle = pair.rack.pressure_angle
    backlash = 2.0 * (pair.distance - tight) * math.tan(angle)
    own = pair.backlash
    known = "" if abs(backlash - own) < 1e-7 else (
        f"; fegear: {signed(own * 1e6, 1)} µm, with the thickness allowances of pinion and rack")  # fmt: skip
    return Exercise(
        _TOPIC,
        "At which distance does the pinion run on the rack, and how large is the backlash?",
        f"Without backlash d/2 + x m{'_n' if t else ''} = {distance(tight)} from pinion axis to reference line (x = "
        f"{signed(shift, 3)}). At {distance(pair.distance)}: j{t} = 2 (a − d/2 − x m{'_n' if t else ''}) tan α{t} = "
        f"{signed(backlash * 1e6, 1)} µm{known}. The pressure angle stays that of the rack, {degrees(angle)}.",
    )


def _contact_ratio(pair: RackAndPinion) -> Exercise:
    pinion, rack, (t, _) = pair.pinion, pair.rack, _sub(pair)
    angle = rack.pressure_angle
    outer = math.sqrt(max(pinion.tip_radius**2 - pinion.base_radius**2, 0.0)) - pinion.pitch_radius * math.sin(angle)
    height = rack.tooth.tip_height * rack.module - pair.rolling_height
    inner = height / math.sin(angle)
    ratio = (outer + inner) / rack.base_pitch
    own = pair.contact_ratio
    reason = "the pinion is undercut" if pinion.tooth.undercut else "tips are rounded or chamfered"
    known = "as in fegear" if same(ratio, own) else f"fegear: {own:.3f}, since {reason}"
    overlap = f" Overlap ratio {pair.overlap_ratio:.3f}, total {pair.total_contact_ratio:.3f}." if t else ""
    return Exercise(
        _TOPIC,
        "How large is the contact ratio, and why is it higher than with a wheel?",
        f"ε = (√(r_a² − r_b²) − r sin α{t} + h / sin α{t}) / p_b{t[1:]} = ({figures(outer * 1e3, DIGITS)} + "
        f"{figures(inner * 1e3, DIGITS)}) mm / {mm(rack.base_pitch)} = {ratio:.3f} ({known}), with the rack's tip "
        f"h = {mm(height)} above the rolling line. A wheel with infinitely many teeth has the longest path before the "
        f"pitch point.{overlap}",
    )


def _undercut(pair: RackAndPinion) -> Exercise:
    pinion, (t, _) = pair.pinion, _sub(pair)
    tooth = pinion.symmetric_tooth
    sine = math.sin(pinion.transverse_pressure_angle) ** 2
    cosine = math.cos(abs(pinion.helix_angle))
    shift = 1.0 - 0.5 * pinion.teeth * sine / cosine
    verdict = "is undercut" if pinion.tooth.undercut else "is not undercut"
    if (found := undercut_of(pinion)) is not None:
        straight = (
            "" if found.straight is None else f"; the flank of its tool is straight down to h = {found.straight:.3f}"
        )
        verdict += f"{straight}: profile_shift = {signed(found.enough, 4)} and more avoid it"
    return Exercise(
        _TOPIC,
        "From how many teeth on does a rack tool not undercut the pinion, and what does this pinion need?",
        f"z_min = 2{' cos β' if t else ''} / sin²α{t} = {figures(2.0 * cosine / sine, DIGITS)} without profile shift; "
        f"with z = {pinion.teeth} and h = 1: x_min = h − z sin²α{t} / {'(2 cos β)' if t else '2'} = "
        f"{signed(shift, 3)}, the pinion has x = {signed(tooth.profile_shift, 3)} (fegear: it {verdict}).",
    )


def _forces(pair: RackAndPinion, force: float) -> Exercise:
    pinion, (t, _) = pair.pinion, _sub(pair)
    angle, beta = pair.rack.pressure_angle, abs(pair.rack.helix_angle)
    torque = force * pinion.pitch_radius
    said = [
        f"T = F_t d/2 = {figures(force, DIGITS)} N · {mm(pinion.pitch_radius)} = {figures(torque, DIGITS)} N m",
        f"F_r = F_t tan α{t} = {figures(force * math.tan(angle), DIGITS)} N lifts the pinion off the rack",
    ]
    if beta:
        said.append(f"F_a = F_t tan β = {figures(force * math.tan(beta), DIGITS)} N along the axis of the pinion")
    along = force / math.cos(angle)
    said.append(f"F_t / cos α{t} = {figures(along, DIGITS)} N along the {'transverse ' if beta else ''}line of action")
    return Exercise(
        _TOPIC,
        "Which torque does the pinion need, and which forces act on its bearings?",
        f"{'; '.join(said)}. fegear shares this force among the tooth pairs in contact.",
    )
