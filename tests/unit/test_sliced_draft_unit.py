"""What a long run of pairs with a width says first, by coupled slices."""

from __future__ import annotations

import re

import pytest

from fegear.case.reading import build_scene, parse_document
from fegear.commands.run import _say_draft
from fegear.commands.terminal import Voice
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import forecast_seconds
from fegear.results.catalogue import STAGES
from fegear.studies import sliced_draft
from fegear.studies.sliced_draft import draft_of_run, sliced

WIDE = """
results = ["load-distribution", "geometry"]
[gear.a]
teeth = 20
normal_module = "3 mm"
helix_angle = "15 deg"
hand = "right"
face_width = "12 mm"
[gear.b]
teeth = 24
normal_module = "3 mm"
helix_angle = "15 deg"
hand = "left"
face_width = "12 mm"
[pair.I]
driver = "a"
driven = "b"
load = "3600 N"
[load_distribution]
positions = 6
"""
LONG = WIDE.replace("12 mm", "60 mm")


def planned(text):
    scene = build_scene(parse_document(text, "c"), "c", None)
    return scene, make_plan(scene, STAGES)


def test_a_long_run_has_a_draft_of_the_same_results_that_is_much_shorter():
    scene, plan = planned(LONG)
    draft = draft_of_run(scene, plan)
    assert draft is not None
    assert draft.scene.width_of("I") == "slices"
    assert draft.scene.case.results == scene.case.results
    assert not draft.scene.estimates
    assert draft.scene.case.load_distribution.positions == 6  # fewer than those of a draft
    assert draft.seconds == pytest.approx(sum(forecast_seconds(scene, plan)))
    assert sum(forecast_seconds(draft.scene, draft.plan)) < 0.3 * draft.seconds


@pytest.mark.parametrize(
    "text",
    [
        WIDE + "[accuracy]\ntolerance = 0.1",  # short
        LONG.replace('load = "3600 N"', 'load = "3600 N"\nwidth = "slices"'),
        LONG.replace(
            'face_width = "60 mm"',
            'face_width = "60 mm"\nbore_radius = "12 mm"\nbody = { rim_thickness = "8 mm", web_thickness = "4 mm" }',
        ),
    ],
)
def test_what_is_short_or_cannot_be_sliced_has_no_draft(text):
    assert draft_of_run(*planned(text)) is None


def test_a_pair_that_stays_plane_is_left_as_it_is():
    text = WIDE.replace('helix_angle = "15 deg"\n', "").replace('hand = "right"\n', "").replace('hand = "left"\n', "")
    scene, _ = planned(text.replace("normal_module", "module").replace('"load-distribution", ', ""))
    assert sliced(scene, ["geometry"]).width_of("I") == "plane"


@pytest.mark.dear
def test_the_draft_is_said_beside_the_progress(monkeypatch, capsys):
    monkeypatch.setattr(sliced_draft, "_LONG", 0.0)
    monkeypatch.setattr(sliced_draft, "_SHARE", 9.0)
    scene, plan = planned(WIDE)
    _say_draft(scene, plan, Voice(), kept=False)
    out, err = capsys.readouterr()
    assert out == ""
    lines = err.splitlines()
    assert lines[0] == "Draft by coupled slices, without estimated errors:"
    assert any(re.match(r"  Pair I\b.*K_Hβ 1\.\d", line) for line in lines)
    assert all(line.startswith("  ") for line in lines[1:-1])  # also changes, which are lines of one sentence
    assert lines[-1].startswith("The result with 3D gears follows, in about ")
    assert "--cache keeps the gears" in lines[-1]
    _say_draft(scene, plan, Voice(quiet=True), kept=True)
    assert capsys.readouterr().err == ""
