"""The speed of a pair's driver: its own, else what the train's one speed makes of it, whichever body that is of."""

import math
from pathlib import Path

import pytest

from fegear.case.built.pair_surface import pair_speed
from fegear.case.reading import read_scene

CASE = Path(__file__).parents[2] / "cases" / "two_stage_gearbox.toml"
RPM = math.pi / 30.0


def speeds(*changes):
    scene = read_scene(CASE, list(changes))
    return [pair_speed(scene, name) / RPM for name in ("first", "second")]


def test_a_pair_turns_with_the_train():
    assert speeds() == pytest.approx([3000.0, 3000.0 * 21 / 53], rel=1e-12)
    machine_at = 3000.0 * 53 / 21 * 61 / 19  # the machine turns at 3000
    assert speeds('dynamics.speed_of="machine"') == pytest.approx([machine_at, machine_at * 21 / 53], rel=1e-12)
    assert speeds('dynamics.speed_of="wheel_1"') == pytest.approx([3000.0 * 53 / 21, 3000.0], rel=1e-12)


def test_its_own_speed_comes_first_and_none_is_none():
    assert speeds('pair.second.speed="500 rpm"') == pytest.approx([3000.0, 500.0], rel=1e-12)
    scene = read_scene(CASE, ['dynamics.speeds=["1000 rpm", "2000 rpm"]'])
    assert scene.case.dynamics.one_speed / RPM == pytest.approx(3000.0)
