"""Predictions of `fegear plan` follow what tasks took in earlier runs on the machine."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import fegear
from fegear.case.reading import read_scene
from fegear.cli import program
from fegear.engine.own_speed import OwnSpeed, own_speed, remember
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import forecast_seconds, plan_content, plan_lines
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASE = Path(__file__).parents[2] / "cases" / "lin_tip_relief.toml"
ASKED = ['results=["geometry", "load-sharing"]']


def test_a_stage_is_scaled_by_its_own_tasks_and_another_by_all():
    speed = OwnSpeed().after([("relief", 4.0, 1.0), ("geometry", 0.1, 0.1), ("relief", 2.0, 0.5)])
    assert speed.count == 3
    assert speed.factor("relief") == pytest.approx(0.25)
    assert speed.factor("geometry") == pytest.approx(1.0)
    assert speed.factor("rating") == pytest.approx(1.6 / 6.1)
    assert OwnSpeed().factor("relief") == 1.0
    later = speed.after([("relief", 1.0, 3.0)] * 8)
    assert later.factor("relief") == pytest.approx(3.0)  # a machine that became slower, a version that did


def test_a_run_is_remembered_and_a_plan_scaled(tmp_path):
    scene = read_scene(CASE, ASKED)
    plan = make_plan(scene, STAGES)
    results = run_plan(scene, plan)
    predicted = forecast_seconds(scene, plan)
    remember(results, predicted, tmp_path / "new")
    speed = own_speed(tmp_path / "new")
    assert speed.count == len(plan.steps)
    for step, before, after in zip(plan.steps, predicted, speed.scaled(plan, predicted), strict=True):
        taken = results.timings[step.task].processor
        assert taken > 0.0
        if [other.stage.name for other in plan.steps].count(step.stage.name) == 1:
            assert after == pytest.approx(taken)
        assert after != before
    total = sum(one or 0.0 for one in speed.scaled(plan, predicted))
    lines = "\n".join(plan_lines(scene, plan, speed))
    assert f"Estimated CPU time: about {total:.2g} s by {speed.count} tasks of earlier runs on this machine" in lines
    assert sum(step["seconds"] for step in plan_content(scene, plan, speed)["steps"]) == pytest.approx(total)
    assert "on a reference machine" in "\n".join(plan_lines(scene, plan))


@pytest.mark.parametrize(
    "kept", ["", "[]", "{}", '{"version": "0.0.1", "tasks": {"relief": [[1, 2]]}}',
             json.dumps({"version": fegear.__version__, "tasks": {"relief": [[0.0, 1.0]]}}),
             json.dumps({"version": fegear.__version__, "tasks": {"relief": [["x", 1.0]]}}),
             json.dumps({"version": fegear.__version__, "tasks": {"relief": [[1e-300, 1e300]]}}),
             json.dumps({"version": fegear.__version__, "tasks": {"relief": [[1e308, 1.0], [1e308, 1.0]]}}),
             "[" * 200_000],
)  # fmt: skip
def test_a_file_of_another_version_or_a_broken_one_is_none(tmp_path, kept):
    (tmp_path / "speed.json").write_text(kept)
    assert own_speed(tmp_path) == OwnSpeed()


def test_a_run_of_a_machine_that_stood_does_not_count(tmp_path):
    scene = read_scene(CASE, ASKED)
    plan = make_plan(scene, STAGES)
    results = run_plan(scene, plan)
    for task, timing in list(results.timings.items()):
        results.timings[task] = timing._replace(processor=1e4)
    remember(results, forecast_seconds(scene, plan), tmp_path)
    assert own_speed(tmp_path) == OwnSpeed()


def test_where_nothing_can_be_written_a_run_goes_on(tmp_path):
    (tmp_path / "file").write_text("")
    scene = read_scene(CASE, ASKED)
    plan = make_plan(scene, STAGES)
    remember(run_plan(scene, plan), forecast_seconds(scene, plan), tmp_path / "file")
    assert own_speed(tmp_path / "file") == OwnSpeed()


def test_run_and_plan_of_the_command_line(monkeypatch, tmp_path):
    monkeypatch.setenv("FEGEAR_CACHE", str(tmp_path / "cache"))

    def said(*arguments: str) -> str:
        result = CliRunner().invoke(program(), list(arguments), catch_exceptions=False)
        assert result.exit_code == 0
        return result.output

    assert "on a reference machine" in said("plan", str(CASE))
    said("run", str(CASE), "--set", ASKED[0], "--out", str(tmp_path / "out"), "--no-plots")
    assert "of earlier runs on this machine" in said("plan", str(CASE))
