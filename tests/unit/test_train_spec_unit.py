"""A train without a case: what it is given, its balance, damping ratios, backlash and phases."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.dynamics.motion.motion_spec import MotionSpec
from fegear.dynamics.motion.moving_train import motion_model, steady_motions
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.friction_law import FrictionLaw, benedict_kelley, buckingham
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Torque, mesh_damping
from fegear.dynamics.train.train_spec import MeshSpec, ShaftSpec, TrainSpec, assemble, build_train
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

RACK = BasicRack(1.0, 1.25, 0.25)
PAIR = GearPair(Gear(Tooth(20, RACK), 3e-3, 20e-3), Gear(Tooth(50, RACK), 3e-3, 20e-3))
STIFFNESS = 4e8


def spec(**changes):
    """A motor on a stiff shaft, one mesh, a machine that balances the torque."""
    made = TrainSpec(
        (Body("motor", 0.01), Body("pinion", 1e-3), Body("machine", 0.2)),
        (MeshSpec("m", "pinion", "machine", PAIR, damping_ratio=0.1, phase=0.3),), (Torque("motor", 100.0),),
        (ShaftSpec("s", "motor", "pinion", 2e4, damping_ratio=0.02),), balance="machine", speed_of="machine",
    )  # fmt: skip
    return replace(made, **changes)


def excitation(**changes):
    """Teeth of constant stiffness with a transmission error of 5 um."""
    error = Periodic.constant(0.0)
    return replace(MeshExcitation.from_mesh(Periodic.constant(STIFFNESS), error), **changes)


def test_the_balance_follows_from_the_ratio_and_the_force_presses_the_teeth():
    train = build_train(spec())
    assert [(t.body, t.value) for t in train.torques][1] == ("machine", pytest.approx(250.0))
    made = assemble(spec(), {"m": excitation()})
    assert made.forces == pytest.approx(100.0 / PAIR.driver.base_radius)
    assert made.speed_ratio == pytest.approx(20 / 50)
    assert made.speed_of == "machine"
    assert assemble(spec(speed_of=""), {"m": excitation()}).speed_of == "motor"


def test_a_torque_the_other_way_lets_the_other_gear_drive():
    made = assemble(spec(torques=(Torque("motor", -100.0),)), {"m": excitation()})
    (mesh,) = made.meshes
    assert made.forces[0] > 0.0
    assert not mesh.a_drives
    assert mesh.pair.driver.teeth == 50


@pytest.mark.parametrize("rigid", [False, True])
def test_damping_ratios_refer_to_what_turns_together(rigid):
    shaft = ShaftSpec("s", "motor", "pinion", math.inf if rigid else 2e4)
    (mesh,) = build_train(spec(shafts=(shaft,)), {"m": STIFFNESS}).meshes
    inertia = 0.011 if rigid else 1e-3
    radii = PAIR.driver.base_radius, PAIR.driven.base_radius
    assert mesh.damping == pytest.approx(mesh_damping(0.1, STIFFNESS, *radii, inertia, 0.2), rel=1e-12)
    assert mesh.stiffness == STIFFNESS


def test_given_stiffness_damping_and_backlash_stand_before_those_of_the_teeth():
    given = replace(spec().meshes[0], stiffness=1e8, damping=30.0, damping_ratio=None, backlash=math.inf)
    (mesh,) = build_train(spec(meshes=(given,)), {"m": STIFFNESS}).meshes
    assert (mesh.stiffness, mesh.damping, mesh.backlash) == (1e8, 30.0, math.inf)
    assert build_train(spec()).meshes[0].backlash == PAIR.free_backlash


def test_every_mesh_runs_at_its_phase():
    """Whatever phase the springs were made at: that of the mesh is given once."""
    made = assemble(spec(), {"m": excitation(phase=0.7)})
    assert made.phases == (0.3,)
    still = replace(spec().meshes[0], phase=0.0)
    assert assemble(spec(meshes=(still,)), {"m": excitation(phase=0.7)}).phases == (0.0,)


def test_friction_laws():
    sliding, rolling, force = np.array([0.0, 1.0, 4.0]), np.array([5.0, 5.0, 6.0]), np.array([1e3, 2e3, 2e3])
    assert FrictionLaw().of(PAIR)(sliding, rolling, force) == pytest.approx(buckingham(sliding))
    assert FrictionLaw("constant", coefficient=0.07).of(PAIR)(sliding, rolling, force) == pytest.approx([0.07] * 3)
    found = FrictionLaw("benedict-kelley", viscosity=0.02).of(PAIR)(sliding[1:], rolling[1:], force[1:])
    wanted = benedict_kelley(force[1:] / PAIR.face_width, 0.02, sliding[1:], rolling[1:])
    assert found == pytest.approx(wanted)


def test_teeth_that_excite_nothing_carry_the_mean_force_at_every_speed():
    made = assemble(spec(), {"m": excitation()})
    asked = MotionSpec(False, True, False, FrictionLaw(), "machine", "up", 1e-4, np.array([50.0, 100.0]))
    assert motion_model(asked, made, 100.0).static == pytest.approx(made.forces)
    states = steady_motions(asked, made)
    assert [state.kind for state in states] == ["periodic"] * 2
    assert np.array([state.tooth_force for state in states])[:, 0] == pytest.approx(made.forces[0], rel=1e-6)
