"""What a change of a gearbox leaves in the cache: 3D gears, whatever shafts, bearings and loads do."""

import copy
import tomllib
from pathlib import Path

import pytest

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import key_without_needs
from fegear.results.catalogue import STAGES

CASE = tomllib.loads((Path(__file__).parents[2] / "cases" / "gearbox_misaligned.toml").read_text(encoding="utf-8"))


def keys_of_gears(changes):
    """Keys of the solved 3D gears of a gearbox, by gear."""
    case = copy.deepcopy(CASE) | {"results": ["load-distribution"]}
    for pair in case["pair"].values():
        pair["width"] = "solid"
    for path, value in changes.items():
        *tables, key = path.split(".")
        table = case
        for name in tables:
            table = table[name]
        table[key] = value
    scene = build_scene(case, "box", Path())
    steps = [step for step in make_plan(scene, STAGES).steps if step.task.stage == "solid-solution"]
    assert sorted(step.task.subject for step in steps) == ["a", "b", "c", "d"]
    return {step.task.subject: key_without_needs(scene, step).digest for step in steps}


@pytest.fixture(scope="module")
def usual():
    return keys_of_gears({})


@pytest.mark.parametrize(
    "changes",
    [
        {"bearing.plain.radial": "250 N/um", "bearing.ball.elements.count": 8},
        {"shaft.in.sections": [{"length": "120 mm", "outer": "26 mm"}], "shaft.mid.bearings": [
            {"bearing": "ball", "at": "5 mm"}, {"bearing": "ball", "at": "115 mm"}]},
        {"pair.I.torque": "140 N*m", "pair.II.torque": "333.34 N*m", "pair.I.loads": ["0.8 kN", "2.2 kN"]},
    ],
    ids=["bearings", "shafts", "loads"],
)  # fmt: skip
def test_other_bearings_shafts_and_loads_leave_the_solved_gears(usual, changes):
    assert keys_of_gears(changes) == usual


def test_another_bore_of_a_gear_is_another_gear(usual):
    found = keys_of_gears({"gear.b.bore_radius": "24 mm"})
    assert {name for name in usual if found[name] != usual[name]} == {"b"}
