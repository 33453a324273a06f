"""A default that is written out changes nothing: no refusal, no other case, no other plan, no other input of a stage.

Every key that the schema gives a default is written into every shipped case that may have it, and into a few more that
have what no shipped one has.
"""

import copy
import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError
from written_defaults import Schema, places, without, written
from written_out import written_out

from fegear.base.errors import FegearError
from fegear.case.gear import GearPart
from fegear.case.reading import build_scene
from fegear.case.shaft import BearingPart
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import plan_content
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
SCHEMA = Schema()
#: A note on what was assumed goes when the default is written: it was confirmed.
CONFIRMED = {
    "MaterialPart.young_modulus", "StrengthPart.quality", "OperationPart.application_factor",
    "ShaftInSpacePart.yield_strength",
}  # fmt: skip
#: A column's name, which no shipped trace has by default: the traces of `test_gauges_unit` do.
ELSEWHERE = {"MeasuredStrainPart.strain_column"}
#: The first and the last with `samples`, as the page says.
DRAWN = {"StudyPart.load_position": [0.0, 1.0]}


#: Points of the fillet of NASA's test gear.
_MADE = Tooth(28, BasicRack(1.0, 1.25, 0.25)).fillet
FILLET = {
    axis: [f"{3.175 * value!r} mm" for value in row]
    for axis, row in zip("xy", _MADE.points(np.linspace(_MADE.start, _MADE.end, 9)).tolist(), strict=True)
}


def plan_of(document, folder):
    scene = build_scene(document, "case", folder)
    plan = make_plan(scene, STAGES)
    return scene, plan


def difference(one, other):
    """What of two cases is not the same; empty if all is, fields that do not count in comparisons included."""
    (scene, plan), (scene_2, plan_2) = one, other
    if scene.case.model_dump() != scene_2.case.model_dump():
        return "the case"
    if plan_content(scene, plan) != plan_content(scene_2, plan_2):
        return "the plan"
    for step, step_2 in zip(plan.steps, plan_2.steps, strict=True):
        if written_out(step.inputs(scene)) != written_out(step_2.inputs(scene_2)):
            return f"what {step.task} reads"
    return ""


def stated(document):
    """Key, place and default of all that may be written out."""
    found = []
    for ident, path, node in places(SCHEMA, document):
        default = SCHEMA.default(ident, node)
        if ident in DRAWN and document["study"].get("samples"):
            default = DRAWN[ident]
        if default is not None and ident not in CONFIRMED:
            found.append((ident, path, default))
    return found


def wrong(document, folder):
    """Keys whose defaults change something, with what; all at once first, for they nearly never do."""
    base = plan_of(document, folder)

    def tried(some):
        made = document
        for _, path, default in some:
            made = written(made, path, default)
        try:
            return difference(base, plan_of(made, folder))
        except FegearError as refusal:
            return str(refusal)

    def narrowed(some):
        change = tried(some)
        if not change:
            return []
        half = len(some) // 2
        return narrowed(some[:half]) + narrowed(some[half:]) if half else [(*some[0], change)]

    return narrowed(stated(document))


def shipped():
    return sorted(CASES.rglob("*.toml"))


@cache
def document_of(path):
    return tomllib.loads(path.read_text("utf-8"))


@pytest.mark.dear("measured_flanks")
@pytest.mark.parametrize("path", shipped(), ids=lambda path: path.stem)
def test_in_a_shipped_case(path):
    assert wrong(document_of(path), path.parent) == []


#: What no shipped case has: a case, and tables that are joined to it.
MORE = {
    "sizing": ("sizing_spur", {"sizing": {
        "limits": {"mass": "20 kg"}, "pinion_shifts": [0.2, 0.3], "shift_sums": [0.0], "centre_distance": "112 mm"}}),
    "growth": ("cracked_tooth", {"results": ["crack-path"], "crack_growth": {"toughness": 60.0}}),
    "pins": ("ring_gear", {"gear": {"ring": {"rim_support": {"kind": "pins", "pins": 6, "width": "5 mm"}}}}),
    "held": ("ring_gear", {"gear": {"ring": {"rim_support": {"kind": "held"}}}}),
    "friction": ("surface_and_loss", {"pair": {"I": {"friction": {"coefficient": 0.05}}}}),
    "fillet": ("nasa_four_square", {"gear": {"test": {"fillet": {"kind": "points", **FILLET}}}}),
    "root relief": ("nasa_four_square", {"gear": {"test": {"relief": {"root": {
        "amount": "5 um", "length": "1 mm"}}}}}),
    "lead": ("spur_over_the_face", {"effects": {"relief": True}, "gear": {"a": {"lead": {"slope": "3 um"}}}}),
    "line error": ("spur_misaligned", {"pair": {"I": {"line_error": {"crowning": "3 um"}}}}),
    "fillet design": ("nasa_four_square", {
        "results": ["fillet-design"], "fillet_design": {"pair": "I", "gear": "test"}}),
    "rack relief": ("rack_and_pinion", {"effects": {"relief": True}, "rack": {"axis": {
        "tip_relief": {"amount": "5 um", "height": "0.5 mm"}}}}),
    "grid": ("helical_flank_design", {"flank_design": {"grid": {"crownings": ["2 um"]}}}),
    "followed": ("blankenship_singh", {"transmissibility": {"I": {"follow": {
        "bearing_stiffness": {"start": 0.5, "stop": 2.0},
        "mesh_stiffness": {"start": "100 N/um", "stop": "200 N/um"}}}}}),
    "force": ("blankenship_singh_forces", {"transmissibility": {"I": {"excitation": {
        "external": [{"on": "driver", "order": 1, "y": "1 N"}]}}}}),
    "pit": ("cracked_tooth", {"results": ["mesh-stiffness-revolution"], "gear": {"pinion": {"odd_tooth": [
        {"pits": [{"diameter": ["49 mm", "50 mm"], "depth": "50 um"}]}]}}}),
    "keyway": ("cracked_tooth", {"results": ["mesh-stiffness-revolution"], "gear": {"pinion": {"odd_tooth": [
        {"keyway": {}}]}}}),
    "hole": ("cracked_tooth", {"results": ["mesh-stiffness-revolution"], "gear": {"pinion": {"odd_tooth": [
        {"hole": {"diameter": "1 mm", "position_radius": "19.5 mm"}}]}}}),
    "catalogue": ("two_stage_shafts", {
        "bearing": {"printed": {"designation": "6206", "catalogue": {"static_rating": "11.2 kN"}}},
        "shaft": {"in": {"bearings": [{"bearing": "ball", "at": "10 mm"}, {"bearing": "printed", "at": "110 mm"}]}}}),
    "sleeve": ("two_stage_shafts", {"shaft": {
        "in": {"bearings": [{"bearing": "ball", "at": "10 mm"}, {"bearing": "ball", "at": "110 mm"},
                            *({"bearing": "ball", "at": at, "around": "sleeve"} for at in ("70 mm", "90 mm"))]},
        "sleeve": {"start": "65 mm", "sections": [{"length": "30 mm", "outer": "50 mm", "inner": "40 mm"}]}}}),
}  # fmt: skip


def joined(document, more):
    """A document with tables added, key by key."""
    made = copy.deepcopy(document)
    for key, value in more.items():
        made[key] = joined(made.get(key, {}), value) if isinstance(value, dict) else value
    return made


def more(name):
    stem, tables = MORE[name]
    path = next(path for path in shipped() if path.stem == stem)
    return joined(document_of(path), tables), path.parent


@pytest.mark.parametrize("name", MORE)
def test_in_a_case_with_what_no_shipped_one_has(name):
    assert wrong(*more(name)) == []


def documents():
    return [(document_of(path), path.parent) for path in shipped()] + [more(name) for name in MORE]


def never_absent():
    """Keys with a default that every one of these cases states where it has their table."""
    everywhere = {f"{part}.{key}" for part, key, node in SCHEMA.every() if SCHEMA.default(f"{part}.{key}", node)}
    seen = {ident for document, _ in documents() for ident, _, _ in stated(document)}
    return everywhere - seen - CONFIRMED - ELSEWHERE


def given_at(document, idents):
    return [(ident, path, node) for ident, path, node, given in SCHEMA.entries(document) if given and ident in idents]


@pytest.mark.dear
def test_every_default_of_the_schema_stands_in_one_of_these_cases():
    left = never_absent()
    for document, _ in documents():
        left -= {ident for ident, _, _ in given_at(document, left)}
    assert left == set()


@pytest.mark.dear
def test_of_keys_that_every_case_states_once_they_are_taken_out():
    left = never_absent()
    for document, folder in documents():
        for ident, path, node in given_at(document, left):
            taken = without(document, path)
            try:
                base = plan_of(taken, folder)
            except FegearError:  # here the case needs what it says
                continue
            assert difference(base, plan_of(written(taken, path, SCHEMA.default(ident, node)), folder)) == "", ident
            left.discard(ident)
    assert left == set()


BALLS = {"kind": "ball", "count": 9, "diameter": "12.7 mm", "pitch_diameter": "65 mm"}
RING = {
    "teeth": 60, "module": "3 mm", "internal": True, "tip_diameter": "176 mm", "rim_thickness": "10 mm",
    "cutter": {"teeth": 25, "addendum": 1.25, "tip_radius": 0.2},
}  # fmt: skip


def test_of_a_bearing_with_elements():
    written = BearingPart.model_validate({"elements": BALLS, "fixed": False})
    assert written.given == BearingPart.model_validate({"elements": BALLS}).given == {"elements"}
    with pytest.raises(ValidationError, match="contradicts other keys"):
        BearingPart.model_validate({"elements": BALLS, "fixed": True})


def test_of_an_internal_gear():
    assert GearPart.model_validate(RING | {"tooth_mesh_fillet": "rack"}).internal
    assert GearPart.model_validate(RING | {"rack": {}}).internal
    with pytest.raises(ValidationError, match="is not used for an internal gear"):
        GearPart.model_validate(RING | {"rack": "ISO 53 C"})
