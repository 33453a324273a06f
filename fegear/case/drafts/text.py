"""The text of a drafted case: its gears and its pair, and around them the template of its kind."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from importlib.resources import files
from string import Template

from fegear.case.drafts.answers import Answers, ends
from fegear.case.drafts.gears_text import NO_RELIEF, gear_text, modified_by_assumption, note_of, texts_of
from fegear.case.drafts.kinds import KINDS, STAGES
from fegear.case.drafts.kinds_text import planetary_texts, rack_texts, study_texts, train_texts
from fegear.case.drafts.shafts_text import amount, length, shafts_text
from fegear.case.drafts.stage_sizes import BACKLASH, centre_distance
from fegear.case.drafts.stages import LaidOut, laid_out, staged, with_room
from fegear.case.text_file import toml_string

_HEAD = """\
# {about}.
#   fegear run {file}      computes it; the report is results/{stem}/report.html
#   fegear plan {file}     what would be computed, why, and how long it would take
#   fegear results{pad}   list of all available results
# Values marked "assumed" were not specified: replace them by those of the drawing.

title = {title}
# Requested results; only these and what they require are computed.\
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
        f"# relief = true     # off: for gears with {NO_RELIEF}",
    ),
    "lead_error": (
        "misalignment = true     # on: helix deviation",
        "# misalignment = true     # off: for pairs with line_error or misalignment",
    ),
}
_ON = "relief = true     # on: tip relief of both gears, crowning of the pinion"
#: Column of comments behind keys.
_COMMENTS = 30
_SIZED = "     # assumed, for the torque"
#: Half a contact's width [modules]: as a case without it.
_HALF_WIDTH = 0.02
#: Rounded profile shifts make whole centre distances to so much [mm].
_ROUNDED_MM = 2e-3


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
        "gears": "" if stages else "\n".join(gear_text(answers, number) for number in range(len(kind.gears))),
        "pair": ""
        if stages or "torque" not in kind.asks or len(kind.gears) < 2
        else _pair(answers, _placed(answers, answers) if answers.kind == "gearbox" else None),
        "line_error": _LINE_ERROR.format(**texts_of(answers, ("lead_error",)))
        if answers.has("lead_error")
        else _NO_LINE_ERROR,
        "load_factors": _load_factors(answers),
        "half_width": length(_HALF_WIDTH * answers.si("module")),
        "relief": _ON if modified_by_assumption(answers) else _EFFECTS["tip_relief"][not answers.has("tip_relief")],
        "misalignment": _EFFECTS["lead_error"][not answers.has("lead_error")],
        **(train_texts(answers) if answers.kind == "train" else {}),
        **(planetary_texts(answers) if answers.kind == "planetary" else {}),
        **(_gearbox(answers) if answers.kind == "gearbox" else {}),
        **(_several_stages(answers, stages) if stages else {}),
        **(study_texts(answers) if answers.kind == "study" else {}),
        **(rack_texts(answers) if answers.kind == "rack" else {}),
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


def _pair(answers: Answers, other: Mapping[str, str] | None = None) -> str:
    """The pair; `other` texts stand in place of its own."""
    first, second = map(json.dumps, KINDS[answers.kind].gears)
    distance = length(centre_distance(answers))
    own = {
        "pair": "I", "first": first, "second": second, "load": _load(answers),
        "centre_distance": f'# centre_distance = "{distance}"     # default: zero backlash',
        "range": _range(answers), **texts_of(answers, ("speed",)),
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
        torque = texts_of(answers, ("torque",))
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


def _gearbox(answers: Answers) -> Mapping[str, str]:
    """Gears, shafts and bearings of one stage."""
    found, names = laid_out((answers,)), KINDS["gearbox"].gears
    gears = [gear_text(answers, n, _bored(found, n)) for n in range(len(found.holes))]
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
            grown = {f"{name}_note": note_of(answers, name) for name in ("module", "face_width")}
        if answers.sized:
            grown = {"module_note": _SIZED if answers.assumed("module") else "",
                     "face_width_note": _SIZED if answers.assumed("face_width") else ""}  # fmt: skip
        grown["profile_shift_note"], before = note_of(answers, "profile_shift"), "I" * stage
        for member in range(2):
            at = 2 * stage + member
            other = {"name": names[at], "hand": hands[at % 4], **_bored(found, at), **grown}
            gears.append(gear_text(own, member, other))
        follows = {
            "load": f"torque = {toml_string(own['torque'])}     # that of pair {before} times its ratio",
            "speed_note": f"     # that of pair {before} over its ratio",
        } if stage else {"load": _load(answers), "speed_note": note_of(answers, "speed")}  # fmt: skip
        first, second = map(json.dumps, names[2 * stage : 2 * stage + 2])
        pairs.append(
            _pair(
                own, {"pair": "I" * (stage + 1), "first": first, "second": second, **follows, **_placed(answers, own)}
            )
            + _operated(answers)
        )
    return {"gears": "\n".join(gears), "pairs": "\n".join(pairs), "shafts": shafts_text(found, names)}
