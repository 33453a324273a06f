"""What a lecture asks first: undercut, before anything is solved, and the transmission error at half the torque."""

from pathlib import Path

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.geometry.checks import pair_checks
from fegear.results.catalogue import STAGES
from fegear.window.on_gears import gears_in_mesh
from fegear.window.order import HarrisMaps


def scene_of(*, teeth=14, shift=0.0, torque="400 N*m", results=("geometry",), **effects):
    gear = {"module": "5 mm", "face_width": "50 mm"}
    gears = {name: {"teeth": z, "profile_shift": x, **gear} for name, z, x in (("p", teeth, shift), ("w", 37, -shift))}
    pair = {"driver": "p", "driven": "w", "torque": torque, "compliance": {"source": "weber-banaschek"}}
    document = {"title": "a lecture", "results": list(results), "gear": gears, "pair": {"I": pair}}
    return build_scene({**document, "effects": {"hertz": "load-dependent", **effects}}, "lecture", Path())


def run(scene):
    return run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache())


def test_undercut_is_said_before_anything_is_solved():
    scene = scene_of()
    (found,) = gears_in_mesh(scene, "I")["undercut"]
    tooth = scene.gears["p"].tooth
    # with its rounding of 0.25 modules the straight part of the rack's tip reaches 1.25 - 0.25 (1 - sin 20 deg) deep
    sine = np.sin(np.radians(20.0))
    assert found["enough"] == pytest.approx(1.25 - 0.25 * (1.0 - sine) - 14 * sine**2 / 2, abs=1e-4)
    assert found["straight"] == pytest.approx(1.25 - 0.25 * (1.0 - sine), rel=1e-12)
    assert found["member"] == "driver"
    assert found["lost"] == pytest.approx(5.0 * (tooth.form_radius - tooth.base_radius), rel=1e-9)
    (said,) = run(scene).outcomes[Task("geometry", "")].answer.sentences
    least = f"none from profile_shift = {found['enough']:.4f} on"
    assert f"14 and 37 teeth, driver undercut (0.047 mm of the involute; {least}), contact ratio" in said


def test_from_the_least_profile_shift_on_nothing_is_cut_away():
    enough = gears_in_mesh(scene_of(), "I")["undercut"][0]["enough"]
    assert gears_in_mesh(scene_of(shift=enough), "I")["undercut"] == []
    assert gears_in_mesh(scene_of(shift=enough - 0.01), "I")["undercut"]
    (said,) = run(scene_of(shift=enough)).outcomes[Task("geometry", "")].answer.sentences
    assert "undercut" not in said


def test_an_exercise_has_the_transmission_error_at_half_the_torque():
    whole = run(scene_of(results=["transmission-error"]))
    found = HarrisMaps().at_rest(whole)["I"]
    half = run(scene_of(results=["transmission-error"], torque="200 N*m"))
    for key, one in (("full", whole), ("half", half)):
        expected = next(value for value in one.values if value.name == "I.te_peak_to_peak")
        assert found[key] == pytest.approx(expected.value, rel=5e-3)
    assert found["half"] < 0.9 * found["full"]


def test_of_broken_rules_the_one_that_stops_the_motion_is_named():
    found = run(scene_of(teeth=8, results=["tooth-geometry-check"])).outcomes[Task("tooth-geometry-check", "")]
    (said,) = found.answer.sentences
    assert " rules not met, the worst: I: transverse contact ratio is 0." in said
    found = run(scene_of(results=["tooth-geometry-check"])).outcomes[Task("tooth-geometry-check", "")]
    assert " of 10 rules not met: p: undercut is " in found.answer.sentences[0]


@pytest.mark.parametrize(
    ("tip_diameter", "broken"),
    [("243.15 mm", []), ("242.9 mm", ["ring tip, pinion root", "ring tip corner, pinion fillet"])],
)
def test_a_ring_tip_that_just_touches_the_end_of_the_fillet_breaks_no_rule(tip_diameter, broken):
    """Below the ring tip of the first the pinion's involute goes on for 7 µm, and a search finds -0.7 nm."""
    gear = {"module": "3 mm", "face_width": "30 mm"}
    cutter = {"teeth": 41, "addendum": 1.25, "tip_radius": 0.2}
    ring = {"teeth": 83, "internal": True, "tip_diameter": tip_diameter, "cutter": cutter}
    pair = {"driver": "p", "driven": "r", "torque": "150 N*m"}
    document = {"title": "t", "results": ["geometry"], "pair": {"I": pair},
                "gear": {"p": {"teeth": 24, "rack": "ISO 53 C", **gear}, "r": gear | ring}}  # fmt: skip
    checks = pair_checks("I", build_scene(document, "t", Path()).pairs["I"])
    corner = next(one for one in checks if one.rule == "ring tip corner, pinion fillet")
    assert abs(corner.value) < 1e-8 or broken
    assert [one.rule for one in checks if not one.holds] == broken


def test_a_tip_below_the_form_circle_is_said_once():
    found = run(scene_of(teeth=8, results=["geometry", "load-sharing"], corner_contact=True))
    assert len([one for one in found.remarks if "reaches below the root form circle" in str(one)]) == 1


@pytest.mark.parametrize(("teeth", "interrupted"), [(8, True), (14, False)])
def test_a_contact_ratio_below_one_is_said_in_the_answer(teeth, interrupted):
    scene = scene_of(teeth=teeth)
    (said,) = run(scene).outcomes[Task("geometry", "")].answer.sentences
    assert ("below 1: motion is not transmitted continuously" in said) == interrupted
    assert (scene.pairs["I"].contact_ratio < 1.0) == interrupted
