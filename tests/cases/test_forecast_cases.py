"""What a plan foretells: every stage has a say, a shape counts once, and the seconds are about right (long run)."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene, read_scene
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import forecast_seconds, plan_lines
from fegear.engine.stage import Stage, Task
from fegear.results.catalogue import STAGES

ROOT = Path(__file__).parents[2]
CASES = ROOT / "cases"


def planned(name: str, *overrides: str):
    scene = read_scene(CASES / f"{name}.toml", overrides)
    return scene, make_plan(scene, STAGES)


@pytest.mark.dear
def test_every_task_of_every_case_is_predicted():
    silent = Stage(lambda _scene: (), *3 * (lambda *_: None,)).forecast
    assert not [stage.name for stage in STAGES if stage.forecast is silent]
    for path in sorted(set(CASES.glob("*.toml")) - {CASES / "own_mesh.toml"}):  # how long a mesh takes is its maker's
        scene, plan = planned(path.stem)
        seconds = forecast_seconds(scene, plan)
        assert all(found is not None and found > 0.0 for found in seconds), path.stem
        # What a drawing leaves to be derived is said in a note.
        assert path.stem == "typed_drawing" or not plan.remarks, path.stem


def test_a_shape_is_solved_once_and_counts_once():
    scene, plan = planned("pinion_and_wheel", 'results=["stiffness", "load-sharing"]')
    by_task = dict(zip([step.task for step in plan.steps], forecast_seconds(scene, plan), strict=True))
    solutions = [task for task in by_task if task.stage == "gear-solution"]
    assert [task.subject for task in solutions] == ["pinion", "wheel"]
    assert by_task[Task("loaded-pair", "I")] < 0.5 * by_task[solutions[0]]
    twins = planned("calculix_pair", "pair.I.driven=a")
    assert [step.task.stage for step in twins[1].steps].count("gear-solution") == 1


@pytest.mark.parametrize(
    ("name", "more", "less"),
    [
        ("calculix_pair", "effects.corner_contact=true", "effects.corner_contact=false"),
        ("calculix_pair", "effects.neighbour_coupling=true", "effects.neighbour_coupling=false"),
        ("calculix_pair", "accuracy.tolerance=1e-4", "accuracy.tolerance=1e-2"),
        ("lin_dynamic_factor", "effects.contact_loss=true", "effects.contact_loss=false"),
        ("lin_dynamic_factor", "effects.friction=true", "effects.friction=false"),
        ("litvin_lead", "tooth_contact.positions=4000", "tooth_contact.positions=400"),
        ("lin_design_chart", "dynamics.chart={ amounts = [0.5, 1.0], lengths = [0.5, 0.8, 1.0] }",
         "dynamics.chart={ amounts = [0.5], lengths = [0.5] }"),
    ],
)  # fmt: skip
def test_what_costs_more_is_predicted_to_cost_more(name, more, less):
    total = [sum(found or 0.0 for found in forecast_seconds(*planned(name, option))) for option in (more, less)]
    assert total[0] > 1.1 * total[1]


@pytest.mark.parametrize(
    ("width", "loads", "measured"),  # CPU seconds, z = 500, slices, one core
    [("20 mm", 4, 3.7), ("45 mm", 4, 17.5), ("90 mm", 4, 104.0), ("20 mm", 24, 8.9), ("45 mm", 24, 27.0)],
)
def test_wide_faces_and_many_loads_are_predicted_within_a_factor_of_three(width, loads, measured):
    gear = {"teeth": 500, "module": "2 mm", "face_width": width}
    pair = {"driver": "a", "driven": "b", "width": "slices", "loads": [f"{500 * n} N" for n in range(1, loads + 1)]}
    effects = {"neighbour_coupling": True, "hertz": "load-dependent"}
    case = {"results": ["load-distribution"], "gear": {"a": gear, "b": gear}, "pair": {"I": pair}, "effects": effects}
    scene = build_scene(case, "wide", CASES)
    plan = make_plan(scene, STAGES)
    by_task = dict(zip([step.task for step in plan.steps], forecast_seconds(scene, plan), strict=True))
    assert measured / 3.0 < by_task[Task("loaded-flanks", "I")] < 3.0 * measured


def test_the_plan_says_where_the_run_time_is_unknown():
    mesh = next((ROOT / "meshes").glob("*.msh"))
    lines = plan_lines(*planned("lin_table1", f"gear.a.tooth_mesh='{mesh}'"))
    assert any("excluding gear-solution of a (CPU time unknown)" in line for line in lines)
    assert any("CPU time unknown" in line for line in lines)


def test_effects_that_nothing_uses_are_reported_by_plan_and_run():
    scene, plan = planned("lin_tip_relief", "effects.friction=true")
    assert plan.idle_effects == ("friction",)
    lines = [line for line in plan_lines(scene, plan) if line.startswith("Note: ")]
    asked = 'request "tooth-friction" or "dynamic-factor" or "vibration-revolution" or "design-chart"'
    assert f"{asked}, or switch the effect off" in lines[0]


@pytest.mark.parametrize(
    ("name", "overrides", "key", "remedy"),
    [
        ("lin_design_chart", ("effects.contact_loss=false",), "effects.contact_loss", "set contact_loss = true"),
        ("lin_design_chart", ("effects.parametric=false",), "effects.parametric", "set parametric = true"),
        ("lin_dynamic_factor", ("train.mesh.I.backlash='60 um'", "effects.contact_loss=false"),
         "train.mesh.I.backlash", "switch the effect on"),
        ("lin_dynamic_factor", ("effects.friction=true", "effects.parametric=false"), "effects.friction",
         "set effects.parametric = true"),
        ("litvin_lead", ("effects.misalignment=false",), "pair.I.misalignment", "set misalignment = true"),
    ],
)  # fmt: skip
def test_results_without_an_effect_that_they_need_are_refused_with_the_remedy(name, overrides, key, remedy):
    with pytest.raises(InputError) as caught:
        planned(name, *overrides)
    assert caught.value.key == key
    assert remedy in str(caught.value)


@pytest.mark.long
def test_seconds_are_within_a_factor_of_three():
    """Every task of every case but the design chart, which takes minutes; on a machine of the usual kind."""
    script = ROOT / "benchmarks" / "forecasts.py"
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, check=True, env=dict(os.environ)
    )
    rows = [line.split() for line in done.stdout.splitlines()[1:]]
    off = [row for row in rows if not 1.0 / 3.0 < float(row[-1]) < 3.0]
    assert not [row for row in off if row[1] == "all"]
    assert len(off) <= 0.05 * len(rows), off


def test_shafts_without_damping_are_counted_where_teeth_part():
    """A motion that never settles takes the most effort, which damping or teeth that never part save."""
    shafts = [f"train.shaft.{name}.damping_ratio=0" for name in ("input", "output")]

    def seconds(*overrides: str) -> float:
        scene, plan = planned("lin_dynamic_factor", *overrides)
        steps = zip(plan.steps, forecast_seconds(scene, plan), strict=True)
        (found,) = [each for step, each in steps if step.task.stage == "motion"]
        return found

    damped, bare = seconds(), seconds(*shafts)
    assert bare > 5.0 * damped
    assert seconds(shafts[0]) == bare
    kept = "effects.contact_loss=false"
    assert seconds(kept) == seconds(kept, *shafts)
