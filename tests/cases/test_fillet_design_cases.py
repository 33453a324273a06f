"""``fillet-design``: from a case to points that a case reads back, the stress it promises, its notes and refusals."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import tomlkit

from fegear.base.errors import InputError
from fegear.base.notes import NoteClass, class_of
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.design.fillet.fillet_limits import Limits
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.fillet_shapes import EllipseOnSpace
from fegear.results.catalogue import STAGES
from fegear.results.pair.fillet_design_data import FilletDesignInputs
from fegear.results.pair.fillet_design_sheet import FILLET_DESIGN_SHEET
from fegear.results.relief.applied_fillet import applied_fillet

GEAR = {"module": "3 mm", "face_width": "6 mm", "bore_radius": "12 mm"}
CASE = {
    "results": ["fillet-design"],
    "neglected": False,
    "gear": {"a": {"teeth": 20, **GEAR}, "b": {"teeth": 31, **GEAR}},
    "pair": {"I": {"driver": "a", "driven": "b", "load": "1 kN"}},
    "fillet_design": {"gear": "b", "waves": 1, "searches": 1},
    "effects": {"neighbour_coupling": True},
    "accuracy": {"tolerance": 0.1},
}
TEXT = tomlkit.dumps(CASE)


def plan_of(document):
    scene = build_scene(document, "case", Path())
    return scene, make_plan(scene, STAGES)


def changed(path, value):
    """The case with one key changed."""
    document = tomllib.loads(TEXT)
    *tables, key = path.split(".")
    table = document
    for name in tables:
        table = table.setdefault(name, {})
    table[key] = value
    return document


@pytest.fixture(scope="module")
def cache():
    return SolutionCache()


@pytest.fixture(scope="module")
def outcome(cache):
    scene, plan = plan_of(tomllib.loads(TEXT))
    return run_plan(scene, plan, cache=cache).outcomes[Task("fillet-design", "I")]


def asked(**changes):
    scene, _ = plan_of(tomllib.loads(TEXT))
    inputs = STAGES.called("fillet-design").inputs(scene, "I")
    assert isinstance(inputs, FilletDesignInputs)
    return replace(inputs, **changes)


def value(outcome, name):
    (found,) = (one for one in outcome.values if one.name == f"I.b.{name}")
    return found


def table(outcome, name):
    (found,) = (one for one in outcome.tables if one.name == name)
    return found


@pytest.mark.dear
def test_the_designed_fillet_is_less_stressed_and_the_answer_says_by_how_much(outcome):
    design = outcome.data.design
    present, full, best = (value(outcome, f"root_stress_{one}") for one in ("present", "full_rounded", "optimum"))
    assert best.si < full.si < present.si
    assert value(outcome, "gain").si == pytest.approx(1.0 - best.si / present.si)
    assert value(outcome, "gain").si > 0.15
    assert design.kept
    assert value(outcome, "minimum_radius").si >= 0.1 * 3e-3
    (said,) = outcome.answer.sentences
    assert "fillet of gear b by 41 points" in said
    assert f"(-{100.0 * value(outcome, 'gain').si:.0f} ± " in said
    stress = table(outcome, "fillet_stress_I_b")
    for name, one in (("present", present), ("optimum", best)):
        rows = stress["fillet"] == name
        assert stress["stress"][rows].max() == pytest.approx(one.si * 1e-6, rel=2e-2)
        assert np.all(np.diff(stress["arc"][rows]) > 0.0)
    # A single search is not proof, and the note says so.
    assert any("not verified" in note for note in outcome.remarks)


@pytest.mark.dear
def test_an_applied_fillet_has_the_stress_that_its_design_promises(outcome, cache):
    tables = {one.name: one for one in outcome.tables}
    found = applied_fillet(TEXT, Path("case.toml"), CASE, tables, "results/case")
    again = applied_fillet(found.text, Path("case.toml"), CASE, tables, "results/case")
    assert again.text == found.text
    document = tomllib.loads(found.text)
    assert len(document["gear"]["b"]["fillet"]["x"]) == 41
    assert "fillet" not in document["gear"]["a"]
    document["results"] = ["root-stress-history"]
    scene, plan = plan_of(document)
    history = run_plan(scene, plan, cache=cache).outcomes[Task("root-stress-history", "I")]
    (found,) = (one.si for one in history.values if one.name == "I.driven.largest_root_tension")
    assert found == pytest.approx(value(outcome, "root_stress_optimum").si, rel=3e-3)


@pytest.mark.dear
def test_a_generated_fillet_comes_with_its_tool(outcome, cache):
    """With the designed tip ground on the rack; without `generated`, fillets may be that no rack makes."""
    document = changed("fillet_design.generated", True)
    scene, plan = plan_of(document)
    found = run_plan(scene, plan, cache=cache).outcomes[Task("fillet-design", "I")]
    assert found.data.design.kept
    free, hobbed = (value(one, "root_stress_optimum").si for one in (outcome, found))
    assert free * (1.0 - 1e-3) < hobbed < value(found, "root_stress_full_rounded").si
    tip = table(found, "fillet_tool_I_b")
    assert (tip["half_width"][0], tip["height"][0]) == (pytest.approx(0.0, abs=1e-6), pytest.approx(1.25 * 3.0))
    assert np.all(np.diff(tip["half_width"]) > 0.0)
    assert np.all(np.diff(tip["height"]) < 0.0)
    flank = 0.25 * math.pi * 3.0 - tip["height"][-1] * math.tan(math.radians(20.0))
    assert tip["half_width"][-1] == pytest.approx(flank, abs=1e-4)
    assert value(found, "minimum_tool_radius").si >= 0.0999 * 3e-3
    assert "a rack (hob) generates it" in found.answer.sentences[-1]
    assert len(found.figures[0].panels) == 3


@pytest.mark.dear
def test_a_fillet_that_no_rack_makes_says_so(outcome):
    bad = with_fillet(outcome.data.design.present.tooth, EllipseOnSpace(form_radius=1.001 * base(outcome)))
    found = presented(outcome, best=replace(outcome.data.design.best, tooth=bad))
    assert any("set fillet_design.generated = true" in note for note in found.remarks)
    assert not any(one.name.startswith("fillet_tool") for one in found.tables)
    assert not any(one.name.endswith("minimum_tool_radius") for one in found.values)


def base(outcome):
    """Base radius of the gear that gets the fillet [modules]."""
    return outcome.data.design.present.tooth.base_radius


def presented(outcome, inputs=None, **changes):
    """The same with another design."""
    data = replace(outcome.data, design=replace(outcome.data.design, **changes))
    return FILLET_DESIGN_SHEET.present(data, inputs or asked())


@pytest.mark.dear
def test_what_is_not_proven_or_not_within_the_limits_is_said(outcome):
    design = outcome.data.design
    (name, one), = design.found.items()  # fmt: skip
    other = replace(one, stress=1.04 * one.stress)
    both = presented(outcome, found={name: one, "bumps": other})
    assert "2 searches differ by 4.0 %" in both.answer.sentences[1]
    assert any("not verified" in n and class_of(n) is NoteClass.BEYOND_TOLERANCE for n in both.remarks)
    agreeing = presented(outcome, found={name: one, "bumps": replace(one, stress=1.001 * one.stress)})
    assert "agree within 0.10 %" in agreeing.answer.sentences[1]
    assert not any("not verified" in n for n in agreeing.remarks)
    # A fillet that breaks its limits is not taken, whatever its stress, unless all do.
    broken = replace(one, stress=0.9 * one.stress, room=-0.1)
    assert replace(design, found={name: one, "bumps": broken}).first == name
    none = presented(outcome, found={name: broken})
    assert any(class_of(n) is NoteClass.FAILS for n in none.remarks)
    assert "no fillet" in none.answer.sentences[0]
    assert not any("generated = false" in n for n in none.remarks)
    hobbed = presented(outcome, asked(limits=Limits(generated=True)), found={name: broken})
    assert any("generated = false" in n for n in hobbed.remarks)
    above = presented(outcome, full=replace(design.full, stress=0.99 * design.best.stress))
    assert any("the full fillet of a rack is less stressed by 1.0 %" in n for n in above.remarks)
    assert not any("full fillet of a rack is less" in n for n in outcome.remarks)
    worse = presented(outcome, best=replace(design.best, stress=1.2 * design.present.stress))
    assert any("does not exceed" in n for n in worse.remarks)
    alone = presented(outcome, full=None, off=(math.nan, math.nan))
    assert not any(v.name.endswith(("full_rounded", "deeper", "higher")) for v in alone.values)
    assert any("comparison with a rack" in n for n in alone.remarks)


@pytest.mark.dear
def test_alternating_is_said(outcome):
    found = presented(outcome, asked(objective="alternating"))
    assert "alternating root stress" in found.answer.sentences[0]
    assert "alternating" in value(found, "root_stress_optimum").meaning


@pytest.mark.parametrize(
    ("path", "given", "key"),
    [
        ("fillet_design.pair", "J", "fillet_design.pair"),
        ("fillet_design.gear", "c", "fillet_design.gear"),
        ("fillet_design.objective", "least", "fillet_design.objective"),
        ("fillet_design.searches", 4, "fillet_design.searches"),
        ("fillet_design.clearance", "-1 um", "fillet_design.clearance"),
        ("fillet_design.minimum_radius", "0 mm", "fillet_design.minimum_radius"),
        ("fillet_design.minimum_tool_radius", "0.5 mm", "fillet_design.minimum_tool_radius"),
        ("fillet_design.generated", "yes", "fillet_design.generated"),
        ("pair.I.width", "slices", "pair.I.width"),
        ("pair.I.compliance", {"source": "cornell"}, "pair.I.compliance.source"),
        ("gear.c", {"teeth": 20, **GEAR}, ""),
    ],
)
def test_refusals_name_their_key(path, given, key):
    document = changed(path, given)
    if not key:  # a gear of the case, but not of the pair
        document["fillet_design"]["gear"], key = "c", "fillet_design.gear"
    with pytest.raises(InputError) as refused:
        plan_of(document)
    assert refused.value.key == key


def test_several_pairs_need_a_name_and_a_run_without_a_design_has_no_fillet():
    document = changed("pair.K", {"driver": "a", "driven": "b", "load": "1 kN"})
    with pytest.raises(InputError, match=r"fillet_design.pair .*I, K"):
        plan_of(document)
    with pytest.raises(InputError, match="has no designed fillet"):
        applied_fillet(TEXT, Path("case.toml"), CASE, {}, "results/case")


def test_limits_are_lengths_and_defaults_are_those_of_the_design():
    scene, plan = plan_of(changed("fillet_design.minimum_radius", "0.6 mm"))
    (step,) = (one for one in plan.steps if one.task.stage == "fillet-design")
    limits = step.inputs(scene).limits
    assert (limits.smallest_radius, limits.clearance) == (pytest.approx(0.2), Limits().clearance)


@pytest.mark.long
@pytest.mark.parametrize("objective", ["tension", "alternating"])
def test_three_searches_verify_each_other(objective, cache):
    document = changed("fillet_design", {"gear": "a", "objective": objective})
    document["accuracy"]["tolerance"] = 0.02
    scene, plan = plan_of(document)
    found = run_plan(scene, plan, cache=cache).outcomes[Task("fillet-design", "I")]
    assert len(found.answer.sentences) == 2
    assert "3 searches agree" in found.answer.sentences[1]
    gain = next(one for one in found.values if one.name == "I.a.gain")
    assert 0.2 < gain.si < 0.4
    assert 0.0 < gain.si_error < 0.03


ASYMMETRIC = {"pressure_angle": "28 deg", "coast_pressure_angle": "20 deg", "rack": {"tip_radius": 0.2}}


def asymmetric(**design):
    """The same with two flanks, and a pair that loads the coast flanks."""
    document = tomllib.loads(TEXT)
    for gear in document["gear"].values():
        gear.update(ASYMMETRIC)
    document["pair"]["J"] = {"driver": "b", "driven": "a", "load": "700 N"}
    document["fillet_design"] |= {"pair": "I", **design}
    return document


@pytest.mark.dear
def test_both_fillets_of_asymmetric_teeth_come_with_points_that_a_case_reads_back(cache, monkeypatch):
    monkeypatch.setattr("fegear.design.fillet.fillet_search._ROUNDS", 2)  # near the least, in a tenth of the time
    document = asymmetric(other_pair="J", gear="b")
    scene, plan = plan_of(document)
    found = run_plan(scene, plan, cache=cache).outcomes[Task("fillet-design", "I")]
    names = ("present", "full_rounded", "optimum")
    largest, drive, coast = (
        [value(found, f"root_stress_{one}{side}").si for one in names] for side in ("", "_drive", "_coast")
    )
    assert largest[2] < largest[1] < largest[0]
    assert np.maximum(drive, coast) == pytest.approx(largest, rel=5e-3)
    assert "fillets of both sides of gear b by 41 points: root stress with pair J" in found.answer.sentences[0]
    text, tables = tomlkit.dumps(document), {one.name: one for one in found.tables}
    applied = applied_fillet(text, Path("case.toml"), document, tables, "results/case")
    again = tomllib.loads(applied.text)
    assert {"fillet", "coast_fillet"} <= again["gear"]["b"].keys()
    designed, best = build_scene(again, "case", Path()).gears["b"].tooth, found.data.design.best.tooth
    for one, other in ((designed, best), (designed.back, best.back)):
        assert one.form_radius == pytest.approx(other.form_radius, rel=1e-8)
        assert one.fillet.points(0.5 * one.fillet.end) == pytest.approx(
            other.fillet.points(0.5 * other.fillet.end), abs=1e-6
        )
    assert designed.turn == pytest.approx(best.turn, abs=1e-8)
    assert any("gear.b.coast_fillet = {" in note for note in found.remarks)


@pytest.mark.parametrize(
    ("design", "said"),
    [
        ({"objective": "alternating"}, "fillet_design.other_pair = (not given): is required for alternating stress"),
        ({"other_pair": "K"}, "fillet_design.other_pair"),
        ({"gear": "c"}, "fillet_design.gear"),
    ],
)
def test_refusals_of_asymmetric_teeth_name_their_key(design, said):
    with pytest.raises(InputError, match="fillet_design") as refused:
        plan_of(asymmetric(**design))
    assert said in str(refused.value)


def test_pairs_that_load_the_same_flanks_are_refused():
    document = asymmetric(other_pair="J", gear="b")
    document["gear"]["c"] = dict(document["gear"]["a"])
    document["pair"]["J"] = {"driver": "c", "driven": "b", "load": "700 N"}
    with pytest.raises(InputError, match="loads the drive flanks of gear b as pair I does"):
        plan_of(document)
    del document["fillet_design"]["other_pair"]
    assert plan_of(document)[1].steps
