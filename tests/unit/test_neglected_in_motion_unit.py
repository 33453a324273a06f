"""At which speed, of which meshes and with what changed a motion more is made for what a moving train neglects."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, replace
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.case.built import neglected_in_motion as neglected
from fegear.case.built.neglected_in_motion import (
    FactorChange,
    backlash_changes,
    contact_loss_changes,
    friction_changes,
)


@dataclass(frozen=True)
class Mesh:
    backlash: float = 0.0


@dataclass(frozen=True)
class Moving:
    meshes: tuple


@dataclass(frozen=True)
class Data:
    train: Moving
    forces: np.ndarray
    meshes: tuple = ()


@dataclass(frozen=True)
class Asked:
    contact_loss: bool = False
    friction: bool = False
    parametric: bool = True
    tolerance: float = 1e-4
    start: str = "start"


FORCES = np.array([1000.0, 2000.0, 0.0])


def data(backlash=(0.0, 0.0, 0.0), meshes=()):
    return Data(Moving(tuple(Mesh(one) for one in backlash)), FORCES, tuple(meshes))


def state(speed, force=(1.2, 1.3), behind=(0.0, 0.0), smallest=(0.5, 0.5), kind="periodic"):
    return Space(
        model=Space(speed=speed), tooth_force=np.append(force, 0.0) * FORCES, behind=np.append(behind, 1.0),
        smallest=np.append(smallest, -9.0) * FORCES, kind=kind,
    )  # fmt: skip


@pytest.fixture
def made(monkeypatch):
    """Motions that are asked for; each has factors of 2."""
    asked = []

    def model(given, train, speed):
        return Space(given=given, train=train, speed=speed)

    def motion(given, one, start, tolerance):
        assert one.given is given
        asked.append((given, one.train, one.speed, start, tolerance))
        return state(one.speed, (2.0, 2.0))

    module = Space(motion_model=model, steady_motion=motion)
    monkeypatch.setitem(sys.modules, "fegear.dynamics.motion.moving_train", module)
    return asked


def test_a_change_is_of_meshes_that_carry_load_and_relative_to_their_mean_force(made):
    one = data()
    found = neglected._changes(Asked(), one, state(70.0))
    assert found == [FactorChange(0, 70.0, pytest.approx(1.2), pytest.approx(0.8)),
                     FactorChange(1, 70.0, pytest.approx(1.3), pytest.approx(0.7))]  # fmt: skip
    assert [change.share for change in found] == pytest.approx([0.8 / 1.2, 0.7 / 1.3])
    assert FactorChange(0, 1.0, 2.0, -0.5).share == 0.25
    ((given, train, speed, start, tolerance),) = made
    assert (given, train, speed, start, tolerance) == (Asked(), one, 70.0, "start", 1e-3)
    neglected._changes(Asked(tolerance=1e-2), one, state(70.0))
    assert made[1][-1] == 1e-2


def test_room_behind_the_teeth_is_unlimited_where_there_is_none_and_else_as_it_is():
    found = neglected._with_backlash(data((0.0, 50e-6, math.inf)))
    assert [mesh.backlash for mesh in found.train.meshes] == [math.inf, 50e-6, math.inf]


def test_unlimited_backlash_is_tried_where_the_other_flanks_of_tight_meshes_carry_longest(made):
    states = [
        state(10.0, behind=(0.2, 0.9)), state(20.0, behind=(0.4, 0.0)), state(30.0, behind=(0.3, 0.5)),
        state(40.0, behind=(0.8, 0.0), kind="chaotic"),
    ]  # fmt: skip
    found = backlash_changes(Asked(contact_loss=True), data((0.0, 30e-6, 0.0)), states)
    assert [(change.mesh, change.speed) for change in found] == [(0, 20.0)]
    assert [mesh.backlash for mesh in made[0][1].train.meshes] == [math.inf, 30e-6, math.inf]
    both = backlash_changes(Asked(contact_loss=True), data(), states)
    assert [(change.mesh, change.speed) for change in both] == [(0, 10.0), (1, 10.0)]


@pytest.mark.parametrize(
    ("asked", "backlash", "states"),
    [
        (Asked(contact_loss=False), (0.0, 0.0, 0.0), [state(10.0, behind=(0.5, 0.5))]),
        (Asked(contact_loss=True), (30e-6, 1e-6, 0.0), [state(10.0, behind=(0.5, 0.5))]),
        (Asked(contact_loss=True), (0.0, 0.0, 0.0), [state(10.0)]),
        (Asked(contact_loss=True), (0.0, 0.0, 0.0), [state(10.0, behind=(0.5, 0.5), kind="chaotic")]),
        (Asked(contact_loss=True), (0.0, 0.0, 0.0), []),
    ],
)
def test_there_is_no_work_where_backlash_can_change_nothing(made, asked, backlash, states):
    assert backlash_changes(asked, data(backlash), states) == []
    assert made == []


def excitation(*separations):
    """Tooth pairs, each in contact in its half of the base pitch and a little beyond."""
    k = [lambda s: np.where(s < 0.6, 1.0, 0.0), lambda s: np.where(s > 0.4, 1.0, 0.0)]
    return Space(excitation=Space(
        stiffness=k, separation=[lambda s, one=one: 0.0 * s + one for one in separations], slotted=True,
    ))  # fmt: skip


def test_contact_loss_is_tried_at_the_speed_of_the_smallest_force_with_room_behind(made):
    states = [state(10.0, smallest=(0.1, -0.2)), state(20.0, smallest=(-0.4, 0.5)),
              state(30.0, smallest=(-5.0, 0.0), kind="growing")]  # fmt: skip
    found = contact_loss_changes(Asked(), data((0.0, 2e-6, 0.0)), states)
    assert [change.speed for change in found] == [20.0, 20.0]
    given, train, *_ = made[0]
    assert given == Asked(contact_loss=True)
    assert [mesh.backlash for mesh in train.train.meshes] == [math.inf, 2e-6, math.inf]
    made.clear()
    assert contact_loss_changes(Asked(), data(), states[2:]) == []
    assert contact_loss_changes(Asked(), data(), []) == []
    touching = [state(10.0, smallest=(0.0, 0.1))]
    alike, apart = excitation(1e-6, 1e-6), excitation(1e-6, 3e-6)
    assert contact_loss_changes(Asked(), data(meshes=(alike, alike)), touching) == []
    assert contact_loss_changes(Asked(parametric=False), data(meshes=(alike, apart)), touching) == []
    assert made == []
    assert len(contact_loss_changes(Asked(), data(meshes=(alike, apart)), touching)) == 2


def test_pairs_that_never_touch_together_are_not_held_apart():
    assert neglected._held_apart(excitation(1e-6, 3e-6).excitation)
    one = excitation(1e-6, 1e-6 + 0.9e-12).excitation
    assert not neglected._held_apart(one)
    one.stiffness = [lambda s: np.where(s < 0.5, 1.0, 0.0), lambda s: np.where(s >= 0.5, 1.0, 0.0)]
    one.separation = [lambda s: 0.0 * s, lambda s: 0.0 * s + 1.0]
    assert not neglected._held_apart(one)


def test_friction_is_tried_at_the_speed_of_the_largest_factor_of_motions_that_repeat(made):
    one = data(meshes=(excitation(0.0, 0.0),))
    states = [state(10.0, (1.2, 1.4)), state(20.0, (1.6, 1.1)), state(30.0, (3.0, 1.0), kind="chaotic")]
    assert [change.speed for change in friction_changes(Asked(), one, states)] == [20.0, 20.0]
    assert made[0][:2] == (Asked(friction=True), one)
    made.clear()
    lumped = Space(excitation=Space(slotted=False))
    assert friction_changes(Asked(), replace(one, meshes=(one.meshes[0], lumped)), states) == []
    assert friction_changes(Asked(parametric=False), one, states) == []
    assert friction_changes(Asked(), one, states[2:]) == []
    assert made == []
