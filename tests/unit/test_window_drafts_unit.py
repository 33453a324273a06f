"""Previews of pairs with a width, beginnings by job, the load's range, gears beside each other in the form."""

from __future__ import annotations

import tomllib

import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.drafts.kinds import KINDS
from fegear.case.reading import build_scene, parse_document
from fegear.engine.run import key_without_needs, run_plan
from fegear.window import beginnings
from fegear.window.beginnings import JOBS, examples, job_of, picture, templates_of
from fegear.window.designs import draft_of
from fegear.window.drag_handles import hands_of
from fegear.window.form import beside, form, in_rows
from fegear.window.glance import glance_tasks, plan_with

WIDE = """
results = ["load-distribution"]
[gear.a]
teeth = 20
normal_module = "3 mm"
helix_angle = "15 deg"
hand = "right"
face_width = "12 mm"
profile_shift = 0.2
[gear.b]
teeth = 24
normal_module = "3 mm"
helix_angle = "15 deg"
hand = "left"
face_width = "12 mm"
tip_diameter = "82 mm"
[pair.I]
driver = "a"
driven = "b"
load = "3600 N"
"""


def scene_of(text):
    return build_scene(parse_document(text, "c"), "c", None)


def plan_of(scene):
    return plan_with(scene, glance_tasks(scene, ()), [])


def test_a_pair_with_a_width_has_a_preview_by_coupled_slices_until_its_gears_are_known():
    scene, cache = scene_of(WIDE), SolutionCache()
    plan = plan_of(scene)
    draft = draft_of(scene, plan, cache, plan_of)
    assert draft is not None
    assert "coupled slices" in draft.told
    assert draft.scene.width_of("I") == "slices"
    assert not draft.scene.estimates
    assert {str(one.task) for one in draft.plan.steps} >= {"load-distribution of I", "transmission-error of I"}
    assert {one.task for one in draft.plan.steps} <= {one.task for one in plan.steps}  # each is replaced by its result
    assert scene.width_of("I") == "solid"
    solved = [step for step in plan.steps if step.task.stage == "solid-solution"]
    known = {key_without_needs(scene, step) for step in solved}
    assert draft_of(scene, plan, known, plan_of) is None


@pytest.mark.dear
def test_a_preview_has_the_numbers_of_the_glance_and_solves_no_solid():
    scene, cache = scene_of(WIDE), SolutionCache()
    plan = plan_of(scene)
    draft = draft_of(scene, plan, cache, plan_of)
    found = run_plan(draft.scene, draft.plan, cache=cache).values
    assert 1.0 < found["I.K_Hbeta"].si < 1.3
    assert {"I.te_peak_to_peak", "I.driver.largest_root_tension"} <= {one.name for one in found}
    assert draft_of(scene, plan, cache, plan_of) is not None


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('load = "3600 N"', 'load = "3600 N"\nwidth = "slices"'),  # these are as quick
        (
            'face_width = "12 mm"',
            'face_width = "12 mm"\nbore_radius = "12 mm"\nbody = { rim_thickness = "8 mm", web_thickness = "4 mm" }',
        ),
    ],
)
def test_what_slices_do_not_know_or_are_has_no_preview_by_them(old, new):
    scene = scene_of(WIDE.replace(old, new))
    assert draft_of(scene, plan_of(scene), SolutionCache(), plan_of) is None


def test_every_kind_of_draft_and_every_case_of_the_gallery_is_offered_once():
    kinds = [kind for job in JOBS for kind, _ in templates_of(job)]
    assert sorted(kinds) == sorted(KINDS)
    cases = [name for rows in examples().values() for name, _ in rows]
    assert sorted(cases) == sorted(beginnings.gallery())
    assert all(title for rows in examples().values() for _, title in rows)
    assert all(examples().values())
    for job in JOBS:
        assert picture(job).startswith("<svg")
        assert "nan" not in picture(job)


@pytest.mark.parametrize(
    ("text", "job"),
    [
        ('results = ["relief"]', "relief"), ('results = ["natural-modes"]\nshaft = {}', "train"),
        ('results = ["misalignment"]\nshaft = {}', "gearbox"),
        ('results = ["load-sharing"]\nplanetary = {}', "planetary"),
        ('results = ["rating"]', "pair"), ('results = ["load-distribution"]', "face"), ("results = 3", "stiffness"),
        ("results = [1, {}]", "stiffness"), ("", "stiffness"),
    ],
)  # fmt: skip
def test_a_case_is_offered_with_its_job(text, job):
    assert job_of(tomllib.loads(text)) == job


def test_the_slider_goes_over_the_torques_of_the_case():
    def load(lines):
        return hands_of(scene_of(WIDE.replace('load = "3600 N"', lines)))["I"]["load"]

    assert load('load = "3600 N"') == {"key": "load", "text": "3600 N"}
    assert load('torques = ["150 N*m", "0.3 kN*m"]') == {"key": "torque", "text": "300 N*m", "range": [150.0, 300.0]}
    over = load('torque = "0.2 kN*m"\ntorques = { start = "150 N*m", stop = "300 N*m", count = 3 }')
    assert over == {"key": "torque", "text": "0.2 kN*m", "range": [0.15, 0.225, 0.3]}  # in the unit of the case
    assert load('load = "2 kN"\ntorques = ["150 N*m", "300 N*m"]') == {"key": "load", "text": "2 kN"}
    assert load('loads = ["2 kN", "3 kN", "3 kN"]') == {"key": "load", "text": "3000 N", "range": [2000.0, 3000.0]}
    assert load('loads = ["2 kN"]') == {"key": "load", "text": "2000 N"}
    assert load('power = "10 kW"\nspeed = "1500 rpm"\nloads = ["2 kN", "3 kN"]') is None


def test_the_gears_of_a_pair_stand_beside_each_other_key_by_key():
    document = tomllib.loads(WIDE)
    sections = form(document)
    rows = beside(sections, document)
    assert [len(row) for row in rows if row[0].path[:1] == ("gear",)] == [2]
    (two,) = [row for row in rows if len(row) == 2]
    assert [one.path for one in two] == [("gear", "a"), ("gear", "b")]
    pairs = in_rows(two)
    assert all(a.path[2:] == b.path[2:] and (a.given or b.given or a.required) for a, b in pairs)
    keys = [a.path[-1] for a, _ in pairs]
    assert {"teeth", "hand", "profile_shift", "tip_diameter"} <= set(keys)
    assert keys.index("teeth") == 0
    tip = next(row for row in pairs if row[0].path[-1] == "tip_diameter")
    assert [one.given for one in tip] == [False, True]


@pytest.mark.parametrize(
    "pair",
    ['pair = 3', 'pair.I = 3', 'pair.I = { driver = "a" }', 'pair.I = { driver = "a", driven = "a" }',
     'pair.I = { driver = "a", driven = "nobody" }', 'pair.I = { driver = 1, driven = ["a"] }'],
)  # fmt: skip
def test_gears_of_no_pair_stand_below_each_other(pair):
    document = tomllib.loads(f"{pair}\ngear.a = {{ teeth = 20 }}\ngear.b = {{ teeth = 30 }}")
    rows = beside(form(document), document)
    assert all(len(row) == 1 for row in rows)
    assert [row[0].path for row in rows if row[0].path[:1] == ("gear",)] == [("gear", "a"), ("gear", "b")]


def test_a_gear_of_two_pairs_stands_beside_one_mate_only():
    document = tomllib.loads(
        'gear.c = { teeth = 9 }\ngear.a = { teeth = 20 }\ngear.b = { teeth = 30 }\n'
        'pair.I = { driver = "a", driven = "b" }\npair.II = { driver = "b", driven = "c" }'
    )  # fmt: skip
    rows = [
        tuple(one.path[1] for one in row) for row in beside(form(document), document) if row[0].path[:1] == ("gear",)
    ]
    assert rows == [("c",), ("a", "b")]
