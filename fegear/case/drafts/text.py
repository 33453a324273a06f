"""The text of a drafted case: its gears and its pair, and around them the template of its kind."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from importlib.resources import files
from string import Template

from fegear.base.errors import GeometryError
from fegear.case.drafts.answers import HELICAL, Answers, ends
from fegear.case.drafts.kinds import KINDS, STAGES
from fegear.case.drafts.shafts_text import amount, length, shafts_text
from fegear.case.drafts.stage_sizes import BACKLASH, centre_distance
from fegear.case.drafts.stages import LaidOut, laid_out, staged, with_room
from fegear.case.text_file import toml_string
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import USUAL_RING_RIM
from fegear.geometry.rack import BasicRack

_HEAD = """\
# {about}.
#   fegear run {file}      computes it; the report is results/{stem}/report.html
#   fegear plan {file}     what would be computed, why, and how long it would take
#   fegear results{pad}   list of all available results
# Values marked "assumed" were not specified: replace them by those of the drawing.

title = {title}
# Requested results; only these and what they require are computed.\
"""
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
_PAIR = """\
[pair.{pair}]
driver = {first}
driven = {second}
{load}
speed = {speed}{speed_note}
{centre_distance}
{range}
"""
#: What the rating of a pair asks for besides, assumed.
_OPERATED = """\
lubricant = {{ viscosity_40 = "220 mm^2/s", temperature = "70 degC" }}     # assumed: mineral oil ISO VG 220
operation = {{ application_factor = 1.0, life = {life} }}     # {assumed}
"""
#: What a drawing may have, and the effect that lets it count: on, or off and how it would be written.
_RELIEF = "relief = {{ tip = {{ amount = {tip_relief}, length = {relief_length} }} }}"
_NO_RELIEF = 'relief = { tip = { amount = "15 um", length = "4 mm" } }'
_LINE_ERROR = (
    "line_error = {{ over_face = {lead_error} }}     # gap along the line of action, over the full face width\n"
)
_NO_LINE_ERROR = (
    '# line_error = { over_face = "10 um" }     # off: helix deviation over the face width; also set misalignment = '
    "true\n"
)
_EFFECTS = {
    "tip_relief": (
        "relief = true     # on: tip relief of both gears",
        f"# relief = true     # off: for gears with {_NO_RELIEF}",
    ),
    "lead_error": (
        "misalignment = true     # on: helix deviation",
        "# misalignment = true     # off: for pairs with line_error or misalignment",
    ),
}
_ON = "relief = true     # on: tip relief of both gears, crowning of the pinion"
#: Column of comments behind keys.
_COMMENTS = 30
_ASSUMED, _SIZED = "     # assumed", "     # assumed, for the torque"
_OF_DRAWING = "replace by that of the drawing"
#: Questions about the pair, not its gears.
_OF_PAIR = ("torque", "speed", "lead_error", "life")
#: Speeds of a train's motion, as shares of the given one.
_SLOWEST, _FASTEST = 0.5, 1.5
#: Length of the tip relief that is assumed of helical gears [modules]; crowning over its amount. Their flanks are
#: hardly ever left without: line load and pressure at sharp edges have no finite limit. A parabola starts without kink.
_ALONG, _CROWNING = 1.6, 0.3
_ROUNDED = 'relief = {{ tip = {{ amount = {amount}, length = {length}, shape = "parabolic" }} }}'
_CROWNED = "lead = {{ crowning = {crowning} }}"
#: Height of a rack's reference line above its back, assumed [modules].
_RACK_HEIGHT = 9.0
_RACK_RELIEF = "tip_relief = {{ amount = {tip_relief}, length = {relief_length} }}"
_NO_RACK_RELIEF = '# tip_relief = { amount = "15 um", length = "2 mm" }'
#: What a rating asks of a gear besides, assumed.
_RATED = """\
tolerance_class = 6     # ISO 1328; assumed
roughness = { flank_rz = "4 um", root_rz = "16 um" }     # assumed
strength = { material = "case-hardened-steel", quality = "MQ" }     # assumed
material = { young_modulus = "206 GPa" }     # assumed: steel"""
#: Inertia of motor and machine over that of the gear beside them, assumed.
_BODIES = 10.0
_STEEL = 7850.0
#: Backlash of a train's mesh, assumed [modules].
_BACKLASH = 0.05
#: Rounded profile shifts make whole centre distances to so much [mm].
_ROUNDED_MM = 2e-3
#: Radius at which a gear body is fixed, over its root radius, and its rim at least, over the tooth depth; half a
#: contact's width [modules]: as a case without them.
_BORE, _RIM, _HALF_WIDTH = 0.5, 1.21, 0.02
#: Mesh stiffness per face width, assumed for a ring and for reliefs [Pa]: c_gamma of ISO 6336 for steel.
_PER_WIDTH = 20e9


def draft(answers: Answers, stem: str, schema: str = "") -> str:
    """Write a case file.

    Parameters
    ----------
    answers : Answers
    stem : str
        Name of the file, without its ending.
    schema : str
        File beside it that tells editors what a case may hold; empty for none.

    Returns
    -------
    str
        TOML with comments.
    """
    kind = KINDS[answers.kind]
    if answers.kind in STAGES:
        answers = with_room(answers)
    file = f"{stem}.toml"
    teeth = "/".join(answers.numbers("teeth"))
    stages = staged(answers) if STAGES.get(answers.kind, 1) > 1 else None
    modules = [answers["module"]] if stages is None else [one["module"] for one in stages.stages]
    *others, last = dict.fromkeys(re.sub(r"(?<=\d)(?=[A-Za-z]+$)", " ", one) for one in modules)
    module = f"{', '.join(others)} and {last}" if others else last
    head = _HEAD.format(
        about=kind.about[0].upper() + kind.about[1:],
        file=file,
        stem=stem,
        pad=" " * len(file),
        title=toml_string(f"{stem}: {teeth} teeth, module {module}"),
    )
    values = {
        "head": head,
        "first": kind.gears[0],
        "second": kind.gears[-1],
        "gears": "" if stages else "\n".join(_gear(answers, number) for number in range(len(kind.gears))),
        "pair": ""
        if stages or "torque" not in kind.asks or len(kind.gears) < 2
        else _pair(answers, _placed(answers, answers) if answers.kind == "gearbox" else None),
        "line_error": _LINE_ERROR.format(**_texts(answers, ("lead_error",)))
        if answers.has("lead_error")
        else _NO_LINE_ERROR,
        "load_factors": _load_factors(answers),
        "half_width": length(_HALF_WIDTH * answers.si("module")),
        "relief": _ON if _modified_by_assumption(answers) else _EFFECTS["tip_relief"][not answers.has("tip_relief")],
        "misalignment": _EFFECTS["lead_error"][not answers.has("lead_error")],
        **(_train(answers) if answers.kind == "train" else {}),
        **(_planetary(answers) if answers.kind == "planetary" else {}),
        **(_gearbox(answers) if answers.kind == "gearbox" else {}),
        **(_several_stages(answers, stages) if stages else {}),
        **(_study(answers) if answers.kind == "study" else {}),
        **(_rack(answers) if answers.kind == "rack" else {}),
    }
    template = files("fegear.case.drafts").joinpath("templates", _template(answers)).read_text("utf-8")
    hint = f"#:schema ./{schema}\n" if schema else ""
    return hint + "\n".join(map(_aligned, Template(template).substitute(values).splitlines())) + "\n"


def _template(answers: Answers) -> str:
    if STAGES.get(answers.kind, 1) > 1:
        return "stages.toml"
    return "relief_helical.toml" if answers.kind == "relief" and answers.helical else f"{answers.kind}.toml"


def _aligned(line: str) -> str:
    """Put the comment behind a key below those of the other lines."""
    found = re.fullmatch(r"(.*\S) {2,}(# .*)", line)
    return f"{found[1]:<{_COMMENTS - 1}}  {found[2]}" if found and not line.startswith("#   ") else line


def _texts(answers: Answers, names: tuple[str, ...]) -> dict[str, str]:
    quoted = {name: toml_string(answers[name]) for name in names}
    return quoted | {f"{name}_note": _note(answers, name) for name in names}


def _note(answers: Answers, name: str) -> str:
    return _ASSUMED if answers.assumed(name) else ""


def _gear(answers: Answers, number: int, other: Mapping[str, str] | None = None) -> str:
    """A gear; `other` texts stand in place of its own."""
    kind = KINDS[answers.kind]
    texts = _texts(answers, ("module", *(name for name in kind.asks if name not in _OF_PAIR)))
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
    lines = [_RELIEF.format(**texts) if answers.has("tip_relief") else f"# {_NO_RELIEF}"]
    if answers.kind in HELICAL:
        depth, along = _deflection(answers), _ALONG * answers.si("module")
        crowned = _CROWNED.format(crowning=toml_string(amount(_CROWNING * depth, "um")))
        if _modified_by_assumption(answers):
            sizes = {"amount": toml_string(amount(depth, "um")), "length": toml_string(amount(along, "mm"))}
            lines = [_ROUNDED.format(**sizes) + _ASSUMED]
        if number == 0:
            lines.append(crowned + _ASSUMED if _modified_by_assumption(answers) else f"# {crowned}")
    return "\n".join([*lines, _RATED] if answers.kind == "gearbox" else lines)


def _deflection(answers: Answers) -> float:
    """Mean deflection of a helical mesh under its torque, which a tip relief makes up for [m]."""
    turn = math.cos(answers.si("helix_angle"))
    radius = 0.5 * answers.si("module") * int(answers.numbers("teeth")[0]) / turn
    radius *= math.cos(math.atan(math.tan(answers.si("pressure_angle")) / turn))
    return answers.si("torque") / (radius * answers.si("face_width") * _PER_WIDTH)


def _modified_by_assumption(answers: Answers) -> bool:
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


def _pair(answers: Answers, other: Mapping[str, str] | None = None) -> str:
    """The pair; `other` texts stand in place of its own."""
    first, second = map(json.dumps, KINDS[answers.kind].gears)
    distance = length(centre_distance(answers))
    own = {
        "pair": "I", "first": first, "second": second, "load": _load(answers),
        "centre_distance": f'# centre_distance = "{distance}"     # default: zero backlash',
        "range": _range(answers), **_texts(answers, ("speed",)),
    }  # fmt: skip
    return _PAIR.format(**{**own, **(other or {})})


def _placed(answers: Answers, stage: Answers) -> dict[str, str]:
    """Centre distance of a stage of a gearbox, in whole millimetres where its profile shifts make it so; backlash."""
    distance = length(centre_distance(stage))
    line = f"# centre_distance = {toml_string(distance)}     # default: that of the profile shifts"
    if _whole(answers, stage):
        distance = f"{centre_distance(stage) * 1e3:.0f} mm"
        line = f"centre_distance = {toml_string(distance)}     # assumed; profile shifts make it so"
    backlash = amount(BACKLASH * stage.si("module"), "um")
    thinner = f"normal_backlash = {toml_string(backlash)}     # assumed: thinner teeth of both gears"
    return {"centre_distance": f"{line}\n{thinner}"}


def _operated(answers: Answers) -> str:
    assumed = "assumed" if answers.assumed("life") else "application factor assumed"
    return _OPERATED.format(life=toml_string(answers["life"]), assumed=assumed)


def _load(answers: Answers) -> str:
    """The torque, or the range of torques that a relief is designed for."""
    both = ends(answers["torque"])
    if both is None:
        torque = _texts(answers, ("torque",))
        return f"torque = {torque['torque']}{torque['torque_note']}"
    start, stop = map(toml_string, both)
    return f"torques = {{ start = {start}, stop = {stop}, count = 3 }}     # relief for both ends and the middle"


def _range(answers: Answers) -> str:
    """Further loads, or of a relief design the range of torques that it may be for."""
    if answers.kind != "relief":
        return '# loads = ["2 kN", "4 kN"]     # further loads along the line of action'
    if ends(answers["torque"]):
        return "# weights = [1, 1, 1]     # weight of each torque"
    start, stop = (toml_string(f"{share * answers.si('torque'):.3g} N*m") for share in (0.5, 1.0))
    return f"# torques = {{ start = {start}, stop = {stop}, count = 3 }}     # relief for a range, instead of torque"


def _load_factors(answers: Answers) -> str:
    """Loads at which the robustness of a relief is evaluated: by default those of a range."""
    if answers.has("torque") and ends(answers["torque"]):
        return "# load_factors = [0.5, 1.0]     # of the design load; default: the torques of the range"
    return "load_factors = [0.5, 0.75, 1.0, 1.25]     # of the design load"


def _train(answers: Answers) -> Mapping[str, str]:
    """Motor, shafts and machine of a size that suits the gears."""
    radii = [0.5 * answers.si("module") * int(teeth) for teeth in answers.numbers("teeth")]
    inertia = [_BODIES * 0.5 * math.pi * _STEEL * answers.si("face_width") * radius**4 for radius in radii]
    millimetres = partial(amount, unit="mm")
    speed = answers.si("speed")
    return {
        "torque": answers["torque"],
        "backlash": amount(_BACKLASH * answers.si("module"), "um"),
        "motor_inertia": f"{inertia[0]:.3g} kg*m^2",
        "load_inertia": f"{inertia[1]:.3g} kg*m^2",
        "shaft_length": millimetres(8.0 * radii[0]),
        "input_diameter": millimetres(1.2 * radii[0]),
        "output_diameter": millimetres(1.2 * radii[0] * (radii[1] / radii[0]) ** (1.0 / 3.0)),
        "slowest": amount(_SLOWEST * speed, "rpm"),
        "fastest": amount(_FASTEST * speed, "rpm"),
    }


def _gearbox(answers: Answers) -> Mapping[str, str]:
    """Gears, shafts and bearings of one stage."""
    found, names = laid_out((answers,)), KINDS["gearbox"].gears
    gears = [_gear(answers, n, _bored(found, n)) for n in range(len(found.holes))]
    return {
        "gears": "\n".join(gears), "shafts": shafts_text(found, names), "operated": _operated(answers),
    }  # fmt: skip


def _whole(answers: Answers, stage: Answers) -> bool:
    """Whether the centre distance of a stage is whole millimetres by assumed profile shifts."""
    distance = 1e3 * centre_distance(stage)
    return answers.rounded and "profile_shift" in answers.suited and abs(distance - round(distance)) < _ROUNDED_MM


def _bored(found: LaidOut, at: int) -> dict[str, str]:
    """Hole of a gear, and what is said of it where there is none."""
    texts = {"bore_radius": length(found.holes[at])}
    if found.cut[at]:
        texts["bore_note"] = "teeth cut into the shaft, which is solid below them"
    return texts


def _several_stages(answers: Answers, found: LaidOut) -> Mapping[str, str]:
    """Gears, pairs, shafts and bearings of several stages."""
    names, hands = KINDS[answers.kind].gears, ("right", "left", "left", "right")
    gears, pairs = [], []
    for stage, own in enumerate(found.stages):
        grown = {"module_note": "     # assumed: grows as the cube root of the torque",
                 "face_width_note": "     # assumed: as many modules as that of the first stage"}  # fmt: skip
        if not stage:
            grown = {f"{name}_note": _note(answers, name) for name in ("module", "face_width")}
        if answers.sized:
            grown = {"module_note": _SIZED if answers.assumed("module") else "",
                     "face_width_note": _SIZED if answers.assumed("face_width") else ""}  # fmt: skip
        grown["profile_shift_note"], before = _note(answers, "profile_shift"), "I" * stage
        for member in range(2):
            at = 2 * stage + member
            other = {"name": names[at], "hand": hands[at % 4], **_bored(found, at), **grown}
            gears.append(_gear(own, member, other))
        follows = {
            "load": f"torque = {toml_string(own['torque'])}     # that of pair {before} times its ratio",
            "speed_note": f"     # that of pair {before} over its ratio",
        } if stage else {"load": _load(answers), "speed_note": _note(answers, "speed")}  # fmt: skip
        first, second = map(json.dumps, names[2 * stage : 2 * stage + 2])
        pairs.append(
            _pair(
                own, {"pair": "I" * (stage + 1), "first": first, "second": second, **follows, **_placed(answers, own)}
            )
            + _operated(answers)
        )
    return {"gears": "\n".join(gears), "pairs": "\n".join(pairs), "shafts": shafts_text(found, names)}


def _planetary(answers: Answers) -> Mapping[str, str]:
    """A ring that suits, and as many planets as stand evenly between the teeth, three if they do."""
    sun, planet = map(int, answers.numbers("teeth"))
    module, face, both = answers.si("module"), answers.si("face_width"), sun + planet
    shift = max(0.0, float(answers.numbers("profile_shift")[1]))
    tip = planet + 2.0 + 2.0 * shift
    fit = [n for n in (3, 4, 5, 2) if 2 * both % n == 0 and both * math.sin(math.pi / n) > tip]
    planets = next(iter(fit), 1)
    radius = 0.5 * both * module
    carrier = math.pi * _STEEL * face * radius**2
    speed, stiffness = answers.si("speed"), _PER_WIDTH * face
    torque, at = (toml_string(answers[key]) for key in ("torque", "speed"))
    return {
        "ring_teeth": str(sun + 2 * planet),
        "planets": str(planets),
        "set_torque": torque,
        "set_speed": at,
        "slowest": amount(_SLOWEST * speed, "rpm"),
        "fastest": amount(_FASTEST * speed, "rpm"),
        "ring_mesh": amount(stiffness, "N/um"),
        "pin": amount(0.5 * stiffness, "N/um"),
        "carrier_mass": f"{carrier:.3g} kg",
        "carrier_inertia": f"{0.5 * carrier * radius**2:.3g} kg*m^2",
        "pin_errors": ", ".join(['"20 um"', *['"0 um"'] * (planets - 1)]),
    }


def _study(answers: Answers) -> Mapping[str, str]:
    teeth, shift = int(answers.numbers("teeth")[0]), float(answers.numbers("profile_shift")[0])
    return {
        "study_teeth": str(sorted({17, 20, 28, 50, 100, teeth})),
        "study_shift": str(sorted({0.0, 0.3, shift})),
    }


def _rack(answers: Answers) -> Mapping[str, str]:
    """A rack of usual height, with the relief of the pinion."""
    module, relieved = answers.si("module"), answers.has("tip_relief")
    texts = _texts(answers, ("torque", "tip_relief", "relief_length") if relieved else ("torque",))
    return {
        "reference_height": length(_RACK_HEIGHT * module),
        "backlash": amount(_BACKLASH * module, "um"),
        "torque": texts["torque"],
        "torque_note": ", assumed" if answers.assumed("torque") else "",
        "rack_relief": _RACK_RELIEF.format(**texts) if relieved else _NO_RACK_RELIEF,
        "rack_relief_effect": "relief = true     # on: tip relief of pinion and rack" if relieved
        else "# relief = true     # off: for a pinion with relief or a rack with tip_relief",
    }  # fmt: skip
