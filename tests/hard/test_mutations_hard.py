"""Random mutations of case files and of the arguments of Python: refused in one sentence, or answered; no traceback.

The mutator is seeded, so that what it finds can be found again: number `n` is always the same mutation.
"""

from __future__ import annotations

import copy
import decimal
import fractions
import math
import random
import tomllib
import traceback
import warnings
from pathlib import Path

import numpy as np
import pint
import pytest
from mutations import STRANGE, failures, mutated, processor_seconds, sentence, torn

import fegear
from fegear.base.errors import FegearError, shown
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.kinds import KINDS
from fegear.case.drafts.text import draft
from fegear.case.reading import build_scene, parse_document
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import plan_lines
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


def newer_doors(folder):
    """Rings, bodies, shafts, sets, measured flanks, drawings and models, with arguments that are right."""
    write_traces(folder)
    ring = {
        "teeth": 60, "module": "4 mm", "internal": True, "profile_shift": -0.3, "tip_diameter": "236 mm",
        "cutter": {"teeth": 25, "profile_shift": 0.1, "addendum": 1.25, "tip_radius": 0.2}, "rim_thickness": "16 mm",
        "thickness_allowance": "80 um", "face_width": "40 mm", "name": "环",
    }  # fmt: skip
    wide = {
        "teeth": 20, "normal_module": "3 mm", "helix_angle": "15 deg", "hand": "right", "face_width": "30 mm",
        "bore_radius": "12 mm", "lead": {"crowning": "3 um"}, "bias": "2 um", "measured": {"lead": "lead.csv"},
        "body": {"rim_thickness": "4 mm", "web_thickness": "6 mm", "hub_radius": "16 mm"}, "name": "wide",
    }  # fmt: skip
    mate = {**{k: v for k, v in wide.items() if k not in ("body", "measured")}, "hand": "left", "name": "mate"}
    planet = fegear.Gear(23, "4 mm", profile_shift=0.3, face_width="40 mm", name="planet")
    in_ring = fegear.Pair(planet, fegear.Gear(**ring))
    helical = fegear.Pair(fegear.Gear(**{**mate, "hand": "right", "name": "a"}), fegear.Gear(**mate))
    shafts, planets = (tomllib.loads((ROOT / "cases" / f"{name}.toml").read_text("utf-8"))
                       for name in ("two_stage_shafts", "planetary_set"))  # fmt: skip
    found = helical.data
    return [
        (fegear.Gear, ring),
        (fegear.Gear, wide),
        (fegear.Pair, {"driver": planet, "driven": in_ring.driven, "name": "R", "torque": "90 N*m"}),
        (fegear.Pair, {"driver": helical.driver, "driven": helical.driven, "width": "slices", "axial_offset": "1 mm",
                       "line_error": {"over_face": "6 um"}, "shafts": {}, "lubricant": {}, "iso_6336": {}}),
        (fegear.load_sharing, {"pair": in_ring, "torque": "90 N*m", "effects": {"corner_contact": True}}),
        (fegear.rating, {"pair": in_ring, "torque": "90 N*m", "speed": "900 rpm", "operation": {"life": "1000 h"}}),
        (fegear.run, {"case": shafts, "changes": {"shaft.mid.sections": [{"length": "120 mm", "outer": "40 mm"}]},
                      "results": ["shaft-deflection"]}),
        (fegear.run, {"case": planets, "changes": {"planetary.P.planets": 4}, "results": ["planet-set"]}),
        (planet.export, {"folder": folder / "drawn", "formats": "dxf"}),
        (planet.data.export, {"folder": folder / "drawn", "formats": "dxf,step", "gears": ("planet",)}),
        (planet.data.save, {"folder": folder / "saved"}),
        (helical.relieved, {"design": found, "shape": "linear"}),
    ]  # fmt: skip


def write_traces(folder):
    for kind in ("lead", "profile"):
        (folder / f"{kind}.csv").write_bytes((ROOT / "cases" / "data" / f"measured_pinion_{kind}.csv").read_bytes())


@pytest.mark.usefixtures("planned_alone")
def test_a_sample_of_wrong_arguments_of_newer_doors_is_refused_or_answered(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = newer_doors(tmp_path)
    assert failures(lambda number: judge_call(asked, number), range(0, 1000, 20)) == ""


@pytest.mark.long
@pytest.mark.usefixtures("planned_alone")
def test_wrong_arguments_of_newer_doors_are_refused_or_answered(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = newer_doors(tmp_path)
    assert failures(lambda number: judge_call(asked, number), range(1000)) == ""
