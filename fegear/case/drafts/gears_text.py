"""The gears of a drafted case as tables of a case file."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import replace

from fegear.base.errors import GeometryError
from fegear.case.drafts.answers import HELICAL, Answers
from fegear.case.drafts.kinds import KINDS
from fegear.case.drafts.shafts_text import amount, length
from fegear.case.drafts.stage_sizes import centre_distance
from fegear.case.text_file import toml_string
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import USUAL_RING_RIM
from fegear.geometry.rack import BasicRack

_SPUR = """\
[gear.{name}]
teeth = {teeth}
module = {module}{module_note}
pressure_angle = {pressure_angle}
profile_shift = {profile_shift}{profile_shift_note}
rack = {rack}{rack_note}
face_width = {face_width}{face_width_note}
bore_radius = "{bore_radius}"     # gear body fixed there: {bore_note}
# tip_diameter = "{tip_diameter}"     # default: this value, d + 2 m (1 + x)
# thickness_allowance = "75 um"     # thinner teeth, for backlash
{relief}
# material = {{ young_modulus = "206.8 GPa", poisson_ratio = 0.3 }}     # default: steel
"""
_HELICAL = """\
[gear.{name}]
teeth = {teeth}
normal_module = {module}{module_note}
pressure_angle = {pressure_angle}     # in the normal section
helix_angle = {helix_angle}{helix_angle_note}
hand = "{hand}"
profile_shift = {profile_shift}{profile_shift_note}
rack = {rack}{rack_note}
face_width = {face_width}{face_width_note}
bore_radius = "{bore_radius}"     # gear body fixed there: {bore_note}
{relief}
"""
_RING = """\
[gear.{name}]
internal = true
teeth = {teeth}
module = {module}{module_note}
pressure_angle = {pressure_angle}
profile_shift = {profile_shift}{profile_shift_note}     # above zero toward the tip: diameters shrink (ISO 21771)
cutter = {{ teeth = {cutter}, profile_shift = 0.0, addendum = 1.25, tip_radius = 0.2 }}     # in modules; assumed
rim_thickness = {rim}     # radial, beyond the root circle; outer circle fixed; assumed
face_width = {face_width}{face_width_note}
# tip_diameter = "{tip_diameter}"     # default: this value, d - 2 m (1 + x)
# thickness_allowance = "75 um"     # thinner teeth, for backlash
# material = {{ young_modulus = "206.8 GPa", poisson_ratio = 0.3 }}     # default: steel
"""
#: What a drawing may have, and the effect that lets it count: on, or off and how it would be written.
_RELIEF = "relief = {{ tip = {{ amount = {tip_relief}, length = {relief_length} }} }}"
NO_RELIEF = 'relief = { tip = { amount = "15 um", length = "4 mm" } }'
ASSUMED = "     # assumed"
_OF_DRAWING = "replace by that of the drawing"
#: Questions about the pair, not its gears.
_OF_PAIR = ("torque", "speed", "lead_error", "life")
#: Length of the tip relief that is assumed of helical gears [modules]; crowning over its amount. Their flanks are
#: hardly ever left without: line load and pressure at sharp edges have no finite limit. A parabola starts without kink.
_ALONG, _CROWNING = 1.6, 0.3
_ROUNDED = 'relief = {{ tip = {{ amount = {amount}, length = {length}, shape = "parabolic" }} }}'
_CROWNED = "lead = {{ crowning = {crowning} }}"
#: What a rating asks of a gear besides, assumed.
_RATED = """\
tolerance_class = 6     # ISO 1328; assumed
roughness = { flank_rz = "4 um", root_rz = "16 um" }     # assumed
strength = { material = "case-hardened-steel", quality = "MQ" }     # assumed
material = { young_modulus = "206 GPa" }     # assumed: steel"""
#: Radius at which a gear body is fixed, over its root radius, and its rim at least, over the tooth depth: as a
#: case without them.
_BORE, _RIM = 0.5, 1.21
#: Mesh stiffness per face width, assumed for a ring and for reliefs [Pa]: c_gamma of ISO 6336 for steel.
PER_WIDTH = 20e9


def texts_of(answers: Answers, names: tuple[str, ...]) -> dict[str, str]:
    """Answers as text of a case, each with its note."""
    quoted = {name: toml_string(answers[name]) for name in names}
    return quoted | {f"{name}_note": note_of(answers, name) for name in names}


def note_of(answers: Answers, name: str) -> str:
    """Comment of an assumed answer, empty for a given one."""
    return ASSUMED if answers.assumed(name) else ""


def gear_text(answers: Answers, number: int, other: Mapping[str, str] | None = None) -> str:
    """A gear; `other` texts stand in place of its own."""
    kind = KINDS[answers.kind]
    texts = texts_of(answers, ("module", *(name for name in kind.asks if name not in _OF_PAIR)))
    texts["relief"] = _modified(answers, number, texts)
    texts |= {"name": kind.gears[number], "teeth": answers.numbers("teeth")[number]}
    shift = float(answers.numbers("profile_shift")[number])
    texts["profile_shift"] = repr(shift)
    if answers.kind == "ring":
        return _ring(answers, texts, shift)
    if answers.internal and number:
        texts["teeth"] = texts["teeth"].removeprefix("-")
        return _cleared(_ring(answers, texts, shift), answers) + texts["relief"] + "\n"
    texts["rack"] = json.dumps(f"ISO 53 {answers['rack'].strip()[-1].upper()}")
    module, teeth, dedendum = answers.si("module"), int(texts["teeth"]), BasicRack.named(answers["rack"]).dedendum
    turn = math.cos(answers.si("helix_angle")) if answers.helical else 1.0
    root = 0.5 * teeth / turn - dedendum + shift
    bore, note = _BORE * root, "half the root radius"
    if 0.0 < (thinner := root - _RIM * (1.0 + dedendum)) < bore:
        bore, note = thinner, "a rim of 1.2 tooth depths"
    texts |= {"bore_radius": length(bore * module), "bore_note": f"{note}; {_OF_DRAWING}"}
    if answers.kind == "gearbox":
        texts |= {"bore_note": f"that of the shaft; {_OF_DRAWING}"}
    if answers.helical:
        return _HELICAL.format(**{**texts, "hand": ("right", "left")[number], **(other or {})})
    texts["tip_diameter"] = length(module * (teeth + 2.0 * (1.0 + shift)))
    return _SPUR.format(**{**texts, **(other or {})})


def _modified(answers: Answers, number: int, texts: Mapping[str, str]) -> str:
    """Lines for the flanks of a gear, and for its rating in a gearbox."""
    lines = [_RELIEF.format(**texts) if answers.has("tip_relief") else f"# {NO_RELIEF}"]
    if answers.kind in HELICAL:
        depth, along = _deflection(answers), _ALONG * answers.si("module")
        crowned = _CROWNED.format(crowning=toml_string(amount(_CROWNING * depth, "um")))
        if modified_by_assumption(answers):
            sizes = {"amount": toml_string(amount(depth, "um")), "length": toml_string(amount(along, "mm"))}
            lines = [_ROUNDED.format(**sizes) + ASSUMED]
        if number == 0:
            lines.append(crowned + ASSUMED if modified_by_assumption(answers) else f"# {crowned}")
    return "\n".join([*lines, _RATED] if answers.kind == "gearbox" else lines)


def _deflection(answers: Answers) -> float:
    """Mean deflection of a helical mesh under its torque, which a tip relief makes up for [m]."""
    turn = math.cos(answers.si("helix_angle"))
    radius = 0.5 * answers.si("module") * int(answers.numbers("teeth")[0]) / turn
    radius *= math.cos(math.atan(math.tan(answers.si("pressure_angle")) / turn))
    return answers.si("torque") / (radius * answers.si("face_width") * PER_WIDTH)


def modified_by_assumption(answers: Answers) -> bool:
    """Whether tip relief and crowning are assumed; "none" for an answer is none."""
    return answers.kind in HELICAL and answers.assumed("tip_relief")


def _ring(answers: Answers, texts: Mapping[str, str], shift: float) -> str:
    """A ring gear with a cutter of two fifths of its teeth, which makes involutes up to usual tip circles.

    Of half of them where a pinion reaches deep into its spaces.
    """
    teeth, module = int(texts["teeth"]), answers.si("module")
    cutter = teeth // 2 if answers.internal else 2 * teeth // 5
    return _RING.format(
        **texts, cutter=max(10, cutter), rim=json.dumps(length(USUAL_RING_RIM * module)),
        tip_diameter=length(module * (teeth - 2.0 * (1.0 + shift))),
    )  # fmt: skip


def _cleared(text: str, answers: Answers) -> str:
    """A ring gear with the tip circle that clears its pinion's fillet, where the default one does not.

    The involute of the pinion begins at its root form circle, where the ring's tip may touch it at most (ISO 21771).
    """
    teeth, ring = (abs(int(z)) for z in answers.numbers("teeth"))
    shift, of_ring = map(float, answers.numbers("profile_shift"))
    module, pressure = answers.si("module"), answers.si("pressure_angle")
    rack = replace(BasicRack.named(answers["rack"]), pressure_angle=pressure)
    try:
        form = Tooth(teeth, rack, profile_shift=shift).form_radius
    except GeometryError:
        return text  # refused with the case
    base, of_pinion = (0.5 * z * math.cos(pressure) for z in (ring, teeth))
    along = math.sqrt(max((centre_distance(answers) / module) ** 2 - (base - of_pinion) ** 2, 0.0))
    clear = math.hypot(base, along + math.sqrt(max(form**2 - of_pinion**2, 0.0)))
    if clear <= 0.5 * ring - 1.0 - of_ring:
        return text
    diameter = math.ceil(2.0 * clear * module * 1e5) / 1e5
    said = f'tip_diameter = "{length(diameter)}"     # clears the fillet of the pinion; d - 2 m (1 + x) does not'
    return re.sub(r"# tip_diameter = .*", said, text)
