"""Gear pairs whose teeth never part are linear: closed forms hold where contact loss would bend them."""

import math

import numpy as np
import pytest

from fegear.dynamics.motion.motion import simulate
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Mesh, Torque, Train, mesh_damping

R, J, K, FORCE = 0.05, 2e-3, 2e8, 500.0
NATURAL = math.sqrt(2 * K * R * R / J)


def two_discs(zeta=0.05):
    c = mesh_damping(zeta, K, R, R, J, J)
    return Train(
        (Body("1", J), Body("2", J)),
        meshes=(Mesh("g", "1", "2", R, R, 30, 30, K, c),),
        torques=(Torque("1", FORCE * R), Torque("2", FORCE * R)),
    )


def path(relief=0.0):
    """Tooth pairs over a path of 1.6 base pitches, softer at its ends, relieved there."""
    end = 0.8

    def stiffness(x):
        return 0.7 * K * (1.0 - 0.3 * (x / end) ** 2)

    def separation(x):
        return relief * np.maximum(np.abs(x) - 0.3, 0.0) / 0.5

    return MeshExcitation.from_tooth_pair(stiffness, separation, -end, end, 1.0, breaks=(-0.3, 0.3))


@pytest.mark.parametrize("ratio", [0.5, 1.0, 1.4])
def test_one_oscillator_pulled_far_below_zero_in_closed_form(ratio):
    a, zeta, w = 2e-5, 0.05, ratio * NATURAL
    mass = J / (2 * R * R)
    c = 2 * zeta * math.sqrt(K * mass)
    H = K / (K - mass * w * w + 1j * w * c)
    force = abs(K * (H - 1) * a + 1j * w * c * H * a)
    error = Periodic.fit(lambda s: a * np.cos(2 * np.pi * s), degree=10, tolerance=1e-13)
    lumped = MeshExcitation.from_mesh(Periodic.constant(K), error).never_parting(FORCE)
    state = steady_state(MotionModel(two_discs(zeta), (lumped,), w / 30), tolerance=1e-9)
    assert FORCE - force < -0.9 * FORCE
    assert state.smallest[0] == pytest.approx(FORCE - force, rel=1e-8)
    assert state.largest[0] == pytest.approx(FORCE + force, rel=1e-8)
    assert (state.changes, state.apart[0], state.behind[0]) == (0, 0.0, 0.0)


@pytest.mark.parametrize("relief", [0.0, 3e-6, 8e-6])
def test_the_static_answers_stay(relief):
    free = path(relief)
    held = free.never_parting(FORCE)
    s = (np.arange(64) + 0.5) / 64
    np.testing.assert_allclose(held.approach(FORCE, s), free.approach(FORCE, s), rtol=1e-7)
    share = [np.maximum(k(s) * (free.approach(FORCE, s) - m(s)), 0.0)
             for k, m in zip(free.stiffness, free.separation, strict=True)]  # fmt: skip
    zeta = held.approach(FORCE, s)
    for k, m, expected in zip(held.stiffness, held.separation, share, strict=True):
        np.testing.assert_allclose(k(s) * (zeta - m(s)), expected, atol=1e-5 * FORCE)
    assert held.slotted
    assert held.first_slot == free.first_slot


def test_where_no_tooth_would_part_it_changes_nothing():
    """Perfect flanks, far from resonance: all pairs on the path bear all the time."""
    train, speed = two_discs(0.1), 0.13 * NATURAL / 30
    free, held = (steady_state(MotionModel(train, (e,), speed), tolerance=1e-9)
                  for e in (path(), path().never_parting(FORCE)))  # fmt: skip
    assert free.smallest[0] > 0.0
    assert held.largest[0] == pytest.approx(free.largest[0], rel=1e-7)
    assert held.tooth_force[0] == pytest.approx(free.tooth_force[0], rel=1e-6)


def test_motions_add_up():
    """Linear in time: twice the way from the steady motion stays twice the way."""
    model = MotionModel(two_discs(), (path(8e-6).never_parting(FORCE),), 0.9 * NATURAL / 30)
    steady = steady_state(model, tolerance=1e-9)
    time = np.linspace(0.0, 2.0 * model.period, 41)

    def away(kick):
        moved = simulate(model, 2.0 * model.period, start=(steady.x + kick, steady.v)).angles(time)
        return moved - simulate(model, 2.0 * model.period, start=(steady.x, steady.v)).angles(time)

    once, twice = away(0.7), away(1.4)
    np.testing.assert_allclose(twice, 2.0 * once, atol=1e-7 * np.abs(twice).max())
