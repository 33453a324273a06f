"""Random mutations of drives: shafts, bearings, planetary sets, ring gears, measured flanks, webs, REXS models.

Refused in one sentence, or answered in finite numbers; no traceback. Number `n` is always the same mutation.
"""

from __future__ import annotations

import json
import math
import random
import tomllib
import traceback
import warnings
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
import rexs_models
from mutations import failures, mutated, processor_seconds, sentence, torn

from fegear.base.errors import FegearError
from fegear.case.reading import build_scene, parse_document
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import plan_lines
from fegear.engine.run import run_plan
from fegear.exchange.rexs.model_to_case import case_of
from fegear.exchange.rexs.reading import read_model
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
SHAFTS = """
results = ["shaft-deflection"]
[gear.a]
teeth = 20
normal_module = "3 mm"
helix_angle = "15 deg"
hand = "right"
bore_radius = "15 mm"
face_width = "30 mm"
[gear.b]
teeth = 50
normal_module = "3 mm"
helix_angle = "15 deg"
hand = "left"
bore_radius = "20 mm"
face_width = "30 mm"
[pair.I]
driver = "a"
driven = "b"
centre_distance = "108.75 mm"
torque = "100 N*m"
[shaft."in"]
gears = [{ gear = "a", at = "40 mm" }]
bearings = [{ bearing = "ball", at = "10 mm" }, { bearing = "roller", at = "110 mm", reversed = true }]
loads = [{ at = "0 mm", force = ["0 N", "-80 N", "0 N"], moment = ["1 N*m", "0 N*m", "0 N*m"] }]
coupling = "0 mm"
[[shaft."in".sections]]
length = "60 mm"
outer = "30 mm"
[[shaft."in".sections]]
length = "60 mm"
outer = "30 mm"
outer_end = "35 mm"
inner = "5 mm"
[shaft.out]
axis = ["108.75 mm", "0 mm"]
sections = [{ length = "120 mm", outer = "40 mm" }]
gears = [{ gear = "b", at = "40 mm" }]
bearings = [{ bearing = "plain", at = "10 mm" }, { bearing = "fixed", at = "110 mm" }]
coupling = "120 mm"
[bearing.ball]
elements = { kind = "ball", count = 9, diameter = "12.7 mm", pitch_diameter = "65 mm", clearance = "15 um" }
life = { dynamic_rating = "32.5 kN", axial_factor = 1.6, limit = 0.3 }
[bearing.roller]
elements = { kind = "roller", count = 15, diameter = "9 mm", pitch_diameter = "50 mm", roller_length = "9 mm" }
[bearing.plain]
radial = "200 N/um"
tilting = "1e4 N*m/rad"
radial_clearance = "5 um"
[bearing.fixed]
radial = "200 N/um"
fixed = true
housing_radial = "400 N/um"
"""
SET = """
results = ["planet-set", "planet-load-sharing", "planet-modes"]
[gear.sun]
teeth = 25
module = "2 mm"
face_width = "25 mm"
[gear.planet]
teeth = 29
module = "2 mm"
face_width = "25 mm"
[planetary.P]
sun = "sun"
planet = "planet"
ring_teeth = 83
planets = 4
fixed = "ring"
input = "sun"
torque = "320 N*m"
speed = "1800 rpm"
mesh_efficiency = 0.98
floating = ["sun"]
stiffness = { sun_mesh = "400 N/um", ring_mesh = "480 N/um", pin = "250 N/um", carrier = "150 N/um" }
pin_errors = { tangential = ["20 um", "0 um", "-10 um", "0 um"] }
body = { carrier = { mass = "3.2 kg", inertia = "0.009 kg*m^2" } }
"""
RING = """
results = ["geometry", "tooth-geometry-check"]
[gear.planet]
teeth = 23
module = "4 mm"
profile_shift = 0.3
face_width = "40 mm"
[gear.ring]
internal = true
teeth = 60
module = "4 mm"
profile_shift = -0.3
cutter = { teeth = 25, profile_shift = 0.1, addendum = 1.25, tip_radius = 0.2 }
tip_diameter = "236 mm"
rim_thickness = "16 mm"
thickness_allowance = "80 um"
face_width = "40 mm"
[pair.I]
driver = "planet"
driven = "ring"
torque = "500 N*m"
"""
MEASURED = """
results = ["measured-flanks", "geometry"]
[gear.pinion]
teeth = 21
module = "3 mm"
face_width = "12 mm"
tolerance_class = 6
relief = { tip = { amount = "8 um", length = "1.5 mm" } }
lead = { crowning = "3 um" }
measured = { profile = "profile.csv", lead = "lead.csv" }
[gear.wheel]
teeth = 32
module = "3 mm"
face_width = "12 mm"
[pair.I]
driver = "pinion"
driven = "wheel"
"""
BODY = """
results = ["body-modes"]
[gear.a]
teeth = 24
module = "2 mm"
bore_radius = "6 mm"
face_width = "12 mm"
[gear.a.body]
rim_thickness = "3 mm"
web_thickness = "3 mm"
web_offset = "1.5 mm"
web_inclination = "-8 deg"
hub_radius = "11 mm"
hub_width = "10 mm"
[accuracy]
tolerance = 5e-2
"""
#: What is computed of them takes milliseconds; of the others the inputs of every stage are made.
QUICK = {SHAFTS: "shaft-deflection", SET: "planet-modes", RING: "geometry", MEASURED: "measured-flanks", BODY: None}
MODELS = (rexs_models.two_stages, rexs_models.planetary_set)


def answered(scene, quick):
    """What a scene is planned to compute, and computes where that is quick: finite numbers."""
    plan = make_plan(scene, STAGES)
    list(plan_lines(scene, plan))
    if not quick or len(plan.steps) > 12 or any("influence" in step.stage.name for step in plan.steps):
        for step in plan.steps:
            step.stage.inputs(scene, step.task.subject)
        return
    for value in run_plan(scene, plan).values:
        assert not math.isnan(value.si), f"{value.name} is {value.si}"


def test_what_is_mutated_is_answered_as_it_is(tmp_path):
    for kind in ("profile", "lead"):
        (tmp_path / f"{kind}.csv").write_bytes((CASES / "data" / f"measured_pinion_{kind}.csv").read_bytes())
    for text, wanted in QUICK.items():
        scene = build_scene(parse_document(text, "(a text)"), "case", tmp_path)
        plan = make_plan(scene, STAGES)
        assert wanted is None or wanted in {step.stage.name for step in plan.steps}
        answered(scene, wanted)
    for number, make in enumerate(MODELS):
        for name, content in (("json", json.dumps({"model": make()})), ("xml", in_xml(make()).decode())):
            path = tmp_path / f"{number}.rexs{'j' if name == 'json' else ''}"
            path.write_text(content, "utf-8")
            text = case_of(read_model(path), None, "model")
            answered(build_scene(parse_document(text, "(a model)"), "imported", tmp_path), None)


def judge_drive(folder):
    """How a mutated case file, its files of measured traces, or a REXS model is taken."""

    def judge(number: int) -> str:
        draw = random.Random(number)  # noqa: S311
        try:
            with processor_seconds(60.0), warnings.catch_warnings():
                warnings.simplefilter("error")
                if number % 6 == 5:
                    from_a_model(draw, folder)
                else:
                    from_a_case(draw, list(QUICK)[number % 6], folder)
        except FegearError as refusal:
            return sentence(refusal)
        except Exception:  # noqa: BLE001  (any other is what is looked for)
            return traceback.format_exc(limit=-4)
        return ""

    return judge


def from_a_case(draw, text, folder):
    if text == MEASURED:
        for kind in ("profile", "lead"):
            rows = (CASES / "data" / f"measured_pinion_{kind}.csv").read_text("utf-8")
            written = torn(rows, draw) if draw.random() < 0.4 else rows
            coding = draw.choice(["utf-8", "utf-8", "utf-16", "latin-1", "utf-8-sig"])
            (folder / f"{kind}.csv").write_bytes(written.encode(coding, errors="replace"))
    if draw.random() < 0.15:
        document = parse_document(torn(text, draw), "(a text)")
    else:
        document = mutated(tomllib.loads(text), draw)
    answered(build_scene(document, "mutated", folder), QUICK[text])


def in_xml(tree) -> bytes:
    """A model as the standard's XML."""
    root = ET.Element("model", version=str(tree.get("version")), applicationId="test")
    parts = ET.SubElement(root, "components")
    for one in tree["components"]:
        made = ET.SubElement(parts, "component", {k: str(one.get(k, "")) for k in ("id", "type", "name")})
        for each in one["attributes"]:
            value = each.get("value", each.get("float", ""))
            attribute = ET.SubElement(made, "attribute", id=each["id"], unit=str(each.get("unit", "none")))
            if isinstance(value, list):
                array = ET.SubElement(attribute, "array")
                for x in value:
                    ET.SubElement(array, "c").text = str(x)
            else:
                attribute.text = str(value)
    relations = ET.SubElement(root, "relations")
    for one in tree["relations"]:
        made = ET.SubElement(relations, "relation", {k: str(one[k]) for k in ("id", "type")})
        for each in one["refs"]:
            ET.SubElement(made, "ref", {k: str(each[k]) for k in ("id", "role")})
    return ET.tostring(root)


def from_a_model(draw, folder):
    tree = draw.choice(MODELS)()
    if draw.random() < 0.3:  # the same in XML, with characters lost
        path = folder / "model.rexs"
        path.write_text(torn(in_xml(tree).decode(), draw), "utf-8", errors="replace")
    else:
        path = folder / "model.rexsj"
        text = json.dumps({"model": mutated(tree, draw)}, default=str)
        path.write_text(torn(text, draw) if draw.random() < 0.15 else text, "utf-8", errors="replace")
    text = case_of(read_model(path), draw.choice([None, None, 1, 7, -1]), "model", spectrum=draw.random() < 0.2)
    answered(build_scene(parse_document(text, "(a model)"), "imported", folder), None)


def test_a_sample_of_mutated_drives_is_refused_in_a_sentence_or_answered(tmp_path):
    assert failures(judge_drive(tmp_path), range(0, 2000, 40)) == ""


@pytest.mark.long
@pytest.mark.parametrize("first", range(0, 2000, 250))
def test_mutated_drives_are_refused_in_a_sentence_or_answered(first, tmp_path):
    assert failures(judge_drive(tmp_path), range(first, first + 250)) == ""
