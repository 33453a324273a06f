"""Random mutations of case files and of the arguments of Python: refused in one sentence, or answered; no traceback.

The mutator is seeded, so that what it finds can be found again: number `n` is always the same mutation.
"""

from __future__ import annotations

import copy
import datetime as dt
import decimal
import fractions
import math
import random
import signal
import tomllib
import traceback
import warnings
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pint
import pytest

import fegear
from fegear.base.errors import FegearError, shown
from fegear.case.drafts.answers import KINDS, Answers
from fegear.case.drafts.text import draft
from fegear.case.reading import build_scene, parse_document
from fegear.engine.plan import make_plan, plan_lines
from fegear.engine.run import Results, run_plan
from fegear.results.catalogue import STAGES
from fegear.workbench import run as workbench_run

ROOT = Path(__file__).parents[2]
BASES = sorted((ROOT / "cases").rglob("*.toml"))
DRAFTS = [draft(Answers(kind, {}), kind) for kind in KINDS]
#: What is cheap enough to be computed after it was mutated.
CHEAP = """
results = ["geometry", "load-sharing", "transmission-error"]
[gear.a]
teeth = 20
module = "3 mm"
profile_shift = 0.2
face_width = "20 mm"
[gear."齿轮"]
teeth = 33
module = "3 mm"
face_width = "20 mm"
tip_radius_rounding = "0.1 mm"
relief = { tip = { amount = "12 um", normalised_length = 0.9 } }
[pair.I]
driver = "a"
driven = "齿轮"
load = "1615 N"
compliance = { source = "weber-banaschek" }
[effects]
hertz = "load-dependent"
relief = true
"""
UNITS = [
    "mm",
    "um",
    "m",
    "inch",
    "deg",
    "rad",
    "N",
    "kN",
    "N*m",
    "MPa",
    "GPa",
    "rpm",
    "kg/m^3",
    "h",
    "degC",
    "",
    "lb",
    "°",
    "µm",
]
STRANGE = [
    "", " ", "x", "nan", "inf", "-inf mm", "0 mm", "-3 mm", "1e400 mm", "1e-400 mm", "3,175 mm", "1/2 inch", "齿轮",
    "Ω",
    "a\nb",
    "n" * 3000, "../../etc/passwd", "\u200b", "a.b", '"', "{}", "%s", "3 mm 4 mm", "٣ mm", "true",
    0, -1, 1, 10**9, 10**400, -(10**400), 0.0, -0.0, 1e-320, 1e308, math.nan, math.inf, True, False,
    [], [[]], ["1 mm"], [0, 1], [True], {}, {"a": 1}, {"": ""}, {"start": 0}, dt.date(2026, 1, 1),
    dt.time(1),
]  # fmt: skip


@contextmanager
def processor_seconds(most: float):
    """Nothing takes longer than so many seconds of the processor."""

    def stop(_number, _frame):
        raise TimeoutError(f"took more than {most} s")

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, most)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


def places(table, path=()):
    """All keys of a document, tables included."""
    entries = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in list(entries):
        yield (*path, key)
        if isinstance(value, (dict, list)):
            yield from places(value, (*path, key))


def reached(table, place):
    """What stands at a place."""
    for step in place:
        table = table[step]
    return table


def changed_value(value, draw: random.Random):
    """A value near to another one, or far from it."""
    if draw.random() < 0.2:
        return draw.choice(STRANGE)
    if isinstance(value, bool):
        return not value
    if isinstance(value, (int, float)):
        factor = draw.choice([-1, 10, 0.1, 1e3, 1e-3, 1e6, 1e-6, 1e12, 1.001])
        return int(value * factor) if isinstance(value, int) and draw.random() < 0.7 else value * factor
    if isinstance(value, str):
        head, _, unit = value.partition(" ")
        try:
            number = float(head)
        except ValueError:
            at = draw.randrange(len(value) + 1)
            return value[:at] + draw.choice(["", "x", "é", " ", value[at:] or "y"]) + value[at + 1 :]
        how = draw.random()
        if how < 0.4:
            return f"{number * draw.choice([-1, 0, 10, 1e3, 1e-3, 1e6, 1e-6, 1e15])!r} {unit}"
        return f"{head} {draw.choice(UNITS)}" if how < 0.8 else number
    if isinstance(value, list):
        return draw.choice([value * 50, value[:1], value[::-1], [*value, draw.choice(STRANGE)], [value], value[1:]])
    if isinstance(value, dict):
        return draw.choice([list(value), {**value, "x": 1}, dict(list(value.items())[1:]), list(value.values())])
    return draw.choice(STRANGE)


def mutated(document, draw: random.Random):
    """A document with one to three things changed."""
    made = copy.deepcopy(document)
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        every = list(places(made))
        ends = [place for place in every if not isinstance(reached(made, place), (dict, list))]
        every = ends if ends and draw.random() < 0.75 else every
        if not every:
            break
        *above, key = draw.choice(every)
        table = reached(made, above)
        how = draw.random()
        if how < 0.75:
            table[key] = changed_value(table[key], draw)
        elif how < 0.81:
            del table[key]
        elif how < 0.86 and isinstance(table, dict):
            table[draw.choice([f"{key}s", str(key)[:-1], str(key).upper(), "", "齿"])] = table.pop(key)
        elif how < 0.95:
            table[key] = copy.deepcopy(reached(made, draw.choice(every)))
        elif isinstance(table, dict):
            table |= dict.fromkeys([str(key), "extra"], draw.choice(STRANGE))
    return made


def torn(text: str, draw: random.Random) -> str:
    """A text with characters or lines lost, doubled, swapped, or of another kind."""
    for _ in range(draw.choice([1, 1, 2, 5])):
        at = draw.randrange(len(text) + 1)
        lines = text.splitlines(keepends=True)
        line = draw.randrange(len(lines) or 1)
        sign = draw.choice(['"', "[", "]", "{", "=", ".", "\n", "\0", "é", "\ufeff", "9", "-", "#", ","])
        text = draw.choice([
            text[:at] + text[at + 1 :], text[:at] + sign + text[at:], text[:at],
            "".join(lines[:line] + lines[line + 1 :]),
            "".join(lines[: line + 1] + lines[line:]), "".join(draw.sample(lines, len(lines))),
        ])  # fmt: skip
    return text


def judge_case(number: int) -> str:
    """What becomes of a mutated case file: empty if it is refused in a sentence or answered."""
    draw = random.Random(number)  # noqa: S311
    cheap = number % 8 == 0
    path = draw.choice(BASES)
    text = CHEAP if cheap else draw.choice(DRAFTS) if draw.random() < 0.1 else path.read_text("utf-8")
    try:
        with processor_seconds(60.0), warnings.catch_warnings():
            warnings.simplefilter("error")
            if draw.random() < 0.15:
                document = parse_document(torn(text, draw), "(a text)")
            else:
                document = mutated(tomllib.loads(text), draw)
            scene = build_scene(document, "mutated", path.parent)
            plan = make_plan(scene, STAGES)
            if not cheap:
                list(plan_lines(scene, plan))
                for step in plan.steps:  # which builds what is computed with, and reads the files
                    step.stage.inputs(scene, step.task.subject)
            elif {step.stage.name for step in plan.steps} <= {
                "geometry",
                "loaded-pair",
                "load-sharing",
                "transmission-error",
            }:
                found = run_plan(scene, plan)
                for value in found.values:
                    assert math.isfinite(value.si), f"{value.name} is {value.si}"
    except FegearError as refusal:
        return sentence(refusal)
    except Exception:  # noqa: BLE001  (any other is what is looked for)
        return traceback.format_exc(limit=-4)
    return ""


def sentence(refusal: FegearError) -> str:
    """Empty if a refusal is one sentence that can be read."""
    text = str(refusal)
    good = text and "\n" not in text and len(text) < 2500 and text.endswith((".", '"', "?"))
    return "" if good else f"no sentence: {text[:300]!r}"


def failures(judge, numbers) -> str:
    told = {number: judge(number) for number in numbers}
    return "\n".join(f"mutation {number}: {what}" for number, what in told.items() if what)


def test_a_sample_of_mutated_case_files_is_refused_in_a_sentence_or_answered():
    assert failures(judge_case, range(0, 2000, 40)) == ""


@pytest.mark.long
@pytest.mark.parametrize("first", range(0, 2000, 250))
def test_mutated_case_files_are_refused_in_a_sentence_or_answered(first):
    assert failures(judge_case, range(first, first + 250)) == ""


UNIT = pint.UnitRegistry()
ODD = [
    *STRANGE, None, 3j, b"90 N*m", bytearray(b"x"), {1, 2}, frozenset(), range(3), object(), object, len, ...,
    np.bool_(True), np.int64(20), np.float32(0.1), np.nan, np.array(3.0), np.zeros(3), np.zeros((2, 2)),
    np.array(["1 mm"]),
    np.array([None]), np.datetime64("2026-01-01"), np.array([]), decimal.Decimal("0.1"), fractions.Fraction(1, 10),
    UNIT.Quantity(3.0, "mm"), UNIT.Quantity(90.0, "N*m"), UNIT.Quantity(np.array([1.0, 2.0]), "mm"),
    UNIT.Quantity(20.0, "degC"),
    UNIT.Quantity(3, ""), "\ud800", "a\0b", {3: 4}, {None: None}, [None], (1.0, "2 mm"), 10**5000,
    Path("nowhere"), 10**30, [["90 N*m"]], {"source": "fe", "x": 1}, {"tip": {"amount": 1.0}}, Exception("x"),
]  # fmt: skip


@pytest.fixture
def planned_alone(monkeypatch):
    """Whatever would be computed is planned alone, but for what takes milliseconds."""

    def run(scene, plan, *rest, **more):
        quick = {step.stage.name for step in plan.steps} <= {"geometry", "loaded-pair", "transmission-error"}
        quick = quick and not any(part.compliance.source == "fe" for part in scene.case.pair.values())
        return run_plan(scene, plan, *rest, **more) if quick else Results(scene, plan, {}, {})

    monkeypatch.setattr(workbench_run, "run_plan", run)


def questions(folder):
    """Functions of the workbench with arguments that are right."""
    gear = {"teeth": 20, "module": "3 mm", "face_width": "10 mm", "profile_shift": 0.1, "name": "Räd",
            "relief": {"tip": {"amount": "10 um", "length": "1 mm"}}, "spacing_errors": [0.0] * 20,
            "rack": {"addendum": 1.0}, "material": {"density": "7850 kg/m^3"}, "bore_radius": 0.01}  # fmt: skip
    driver, driven = fegear.Gear(**gear), fegear.Gear(23, "3 mm", face_width="10 mm", name="b")
    pair = fegear.Pair(driver, driven, compliance="weber-banaschek")
    case = {"results": ["geometry"], "gear": {"a": {"teeth": 20, "module": "3 mm"}}}
    shared = {"torque": "90 N*m", "effects": {"relief": True}, "tolerance": 1e-3, "progress": False, "cache": None}
    return [
        (fegear.Gear, gear),
        (fegear.Pair, {"driver": driver, "driven": driven, "centre_distance": "65 mm", "compliance": "cornell",
                       "name": "I", "speed": "900 rpm", "misalignment": {}, "iso_6336": {}}),
        (driver.changed, {"teeth": 21, "name": "c", "relief": None}),
        (fegear.run, {"case": case, "changes": {"gear.a.teeth": 21}, "results": "geometry", "progress": None,
                      "cache": None, "scheduler": None}),
        (fegear.stiffness_table, {"gear": driver, "radii": ["30 mm"], "positions": None, "contact_half_width": "0.1 mm",
                                  "face_positions": None, "source": None, "tolerance": 0.01}),
        (fegear.root_stress, {"gears": [driver, driven], "positions": 3, "tolerance": 0.1}),
        (fegear.transmission_error, {"pair": pair, "load": None, **shared}),
        (fegear.relief, {"pair": pair, "design": {"peak": 1.2}, **shared}),
        (fegear.dynamic_factor, {"pair": pair, "speeds": ["900 rpm"], "damping_ratio": 0.1, "train": None,
                                 "dynamics": {}, **shared}),
        (fegear.rating, {"pair": pair, "speed": "900 rpm", "operation": {}, "beside": "agma-2101", **shared}),
        (pair.data.__getitem__, {}),
        (pair.data.plot().save, {"folder": folder / "plots", "kind": "png"}),
    ]  # fmt: skip


def judge_call(asked, number: int) -> str:
    """What becomes of a call with arguments that are wrong, or not."""
    draw = random.Random(number)  # noqa: S311
    function, right = copy.copy(asked[number % len(asked)])
    wrong = dict(right)
    for _ in range(draw.choice([1, 1, 2])):
        key = draw.choice(list(right) or ["name"])
        value = draw.choice(ODD)
        nested = isinstance(right.get(key), (dict, list)) and draw.random() < 0.6
        wrong[key] = mutated(right[key], draw) if nested else value
    try:
        with processor_seconds(60.0), warnings.catch_warnings():
            warnings.simplefilter("error")
            repr(function(*wrong.values()) if function.__name__ == "__getitem__" else function(**wrong))
    except FegearError as refusal:
        return sentence(refusal)
    except Exception:  # noqa: BLE001
        told = ", ".join(f"{key}={shown(value)}" for key, value in wrong.items() if value is not right.get(key))
        return f"{function.__name__}({told})\n{traceback.format_exc(limit=-4)}"
    return ""


@pytest.mark.usefixtures("planned_alone")
def test_a_sample_of_wrong_arguments_is_refused_in_a_sentence_or_answered(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = questions(tmp_path)
    assert failures(lambda number: judge_call(asked, number), range(0, 1000, 7)) == ""


@pytest.mark.long
@pytest.mark.usefixtures("planned_alone")
def test_wrong_arguments_are_refused_in_a_sentence_or_answered(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = questions(tmp_path)
    assert failures(lambda number: judge_call(asked, number), range(1000)) == ""
