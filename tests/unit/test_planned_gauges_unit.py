"""Gauges before there is a trace, and traces of encoders over torque: what their sentences state."""

import copy
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.results.pair.error_over_torques import torque_of_gain
from fegear.results.pair.gauges_together import of_all_gauges
from fegear.results.pair.planned_gauges import PlannedGauge


def gauge(name, peak, towards_root, towards_tip, placement=1e-4):
    place = np.array([-placement, 0.0, placement])
    return PlannedGauge.of(name, peak, place, peak * (1.0 + np.array([towards_root, 0.0, towards_tip])))


def test_the_place_that_counts_most_is_named_with_its_direction():
    said = of_all_gauges([gauge("a", 8e-4, 0.02, -0.03), gauge("b", -9e-4, -0.051, 0.012), gauge("c", 5e-4, 0.0, 0.0)])
    assert said == (
        "Three gauges, computed peak strain -900 µm/m (b) to 800 µm/m (a); displaced within its tolerance b changes "
        "most, by up to -5.1 % (0.1 mm towards the root), c least, by up to 0 %."
    )
    assert gauge("a", 8e-4, 0.02, -0.03).by_placement == (
        "-3.0 % (0.1 mm towards the tip) to +2.0 % (0.1 mm towards the root)"
    )
    assert gauge("a", 8e-4, -0.02, -0.03).by_placement == "-3.0 % (0.1 mm towards the tip)"
    assert of_all_gauges([gauge("a", 8e-4, 0.02, -0.03)]) == ""
    assert of_all_gauges([gauge("a", 8e-4, 0.0, 0.0), gauge("b", 9e-4, 0.0, 0.0)]).endswith("to 900 µm/m (b).")
    assert of_all_gauges([gauge("a", 8e-4, 0.02, -0.03), None]) == ""  # one is measured, and not judged


def test_the_torque_that_explains_a_transmission_error_is_between_those_computed_or_near_them():
    torques = np.array([100.0, 200.0, 300.0])
    assert torque_of_gain(torques, 240.0 / torques, 300.0) == pytest.approx(240.0)
    assert torque_of_gain(torques, 330.0 / torques, 300.0) == pytest.approx(330.0)
    assert torque_of_gain(torques, 480.0 / torques, 300.0) is None
    assert torque_of_gain(torques[:1], np.array([1.1]), 100.0) is None
    twice = np.array([1.21, 1.0 / 1.21, 1.21])  # least with the relief's own torque: the nearer of two
    assert torque_of_gain(torques, twice, 100.0) == pytest.approx(2.0**0.5 * 100.0)
    assert torque_of_gain(torques, twice, 300.0) == pytest.approx(6.0**0.5 * 100.0)


TRAIN = {
    "results": ["gear-modes"],
    "gear": {name: {"teeth": z, "module": "2 mm", "face_width": "10 mm"} for name, z in (("a", 20), ("b", 31))},
    "pair": {"p": {"driver": "a", "driven": "b", "torque": "16 N*m"}},
    "train": {
        "body": {"one": {"inertia": "1 kg*m^2", "gears": ["a"]}, "two": {"inertia": "2 kg*m^2"}},
        "mesh": {"m": {"driver": "one", "driven": "two", "pair": "p"}},
        "torque": {"one": "16 N*m"},
        "balance": "two",
    },
}


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        (
            "pair",
            None,
            'train.mesh.m.pair = (not given): is required: no pair of this case is called m; set pair = "',
        ),
        ("driver", "a", 'train.mesh.m.driver = "a": is a gear, not a body of the train; set "one", the body that has'),
        (
            "driven",
            "b",
            'train.mesh.m.driven = "b": is a gear, not a body of the train; specify one of the bodies one',
        ),
        ("driven", "tow", 'train.mesh.m.driven = "tow": is not a body of this case; did you mean "two"?'),
    ],
)
def test_a_mesh_without_its_pair_and_gears_in_place_of_bodies_are_refused_by_what_was_written(key, value, said):
    document = copy.deepcopy(TRAIN)
    mesh = document["train"]["mesh"]["m"]
    mesh.pop(key)
    if value is not None:
        mesh[key] = value
    with pytest.raises(InputError) as refused:
        build_scene(document, "case", Path())
    assert str(refused.value).startswith(said)
