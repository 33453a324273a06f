"""Inertias of a train that look like another unit: over those of the gears of their body."""

from types import SimpleNamespace

import pytest

from fegear.base.notes import NoteClass
from fegear.case.built.train import train_inputs
from fegear.case.reading import build_scene
from fegear.results.train.gear_train import _unlikely


def inputs(folder, **body):
    gear = {"module": "2.5 mm", "face_width": "20 mm"}
    document = {
        "results": ["dynamic-factor"],
        "gear": {"a": {"teeth": 25, **gear}, "b": {"teeth": 41, **gear}},
        "pair": {"I": {"driver": "a", "driven": "b", "torque": "90 N m"}},
        "train": {"body": {"one": body, "two": {"gears": ["b"]}},
                  "mesh": {"I": {"driver": "one", "driven": "two", "damping_ratio": 0.07}},
                  "torque": {"one": "90 N m"}, "balance": "two"},
        "dynamics": {"speeds": {"start": "1500 rpm", "stop": "3000 rpm", "count": 7}},
    }  # fmt: skip
    return train_inputs(build_scene(document, "case", folder))


@pytest.mark.parametrize("gears", [{"gears": ["a"]}, {}])
def test_a_unit_that_is_a_millionth_is_noticed(tmp_path, gears):
    found = inputs(tmp_path, inertia="0.002 kg*mm^2", **gears)
    own = inputs(tmp_path, gears=["a"]).spec.bodies[0].inertia
    assert found.unlikely == pytest.approx({"one": 2e-9 / own})
    (note,) = _unlikely(SimpleNamespace(asked=found))
    assert note.kind is NoteClass.ASSUMED
    assert note.startswith("train.body.one.inertia is ")
    assert "1 kg m² = 10⁶ kg mm²" in note
    assert inputs(tmp_path, inertia="2000 kg*mm^2", **gears).unlikely == {}
    assert inputs(tmp_path, inertia="2000 kg*m^2", **gears).unlikely == pytest.approx({"one": 2e3 / own})


def test_nothing_in_addition_to_gears_is_usual_and_little_in_place_of_them_is_not(tmp_path):
    assert inputs(tmp_path, gears=["a"], inertia="0 kg*m^2").unlikely == {}
    own = inputs(tmp_path, gears=["a"]).spec.bodies[0].inertia
    tenth, hundredth = (f"{part * own} kg*m^2" for part in (0.1, 0.01))
    assert inputs(tmp_path, inertia=tenth).unlikely == {}
    assert set(inputs(tmp_path, inertia=hundredth).unlikely) == {"one"}
    assert inputs(tmp_path, gears=["a"], inertia=hundredth).unlikely == {}
