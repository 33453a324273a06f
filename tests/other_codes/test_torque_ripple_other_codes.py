"""Motion under torque ripple against scipy, from an own right-hand side, through losses of contact and back flanks.

Motor, shaft, two gears, shaft, machine: nothing of fegear is in the reference, which goes from one change of contact
to the next by events of `solve_ivp`.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fegear.dynamics.motion.motion import simulate
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.torque_ripple import TorqueRipple
from fegear.dynamics.train.train import Body, Damper, Mesh, Shaft, Torque, Train

R1, R2, TEETH = 0.04, 0.08, 20
INERTIA = np.array([1e-2, 1e-3, 6e-3, 5e-2])
SHAFTS, SHAFT_DAMPING, GROUND = (2.2e4, 6.0e4), (2.0, 4.0), 0.05
STIFFNESS, SWING, DAMPING, BACKLASH = 3e8, 0.25, 900.0, 20e-6
TORQUE = 60.0
#: Torque at the motor and at the machine: amplitude, order per turn of the motor, phase.
AT_MOTOR, AT_MACHINE = (150.0, 2, 0.6), (60.0, 3, -0.4)


def drive(ground=0.0):
    return Train(
        (Body("motor", INERTIA[0]), Body("1", INERTIA[1]), Body("2", INERTIA[2]), Body("machine", INERTIA[3])),
        (Shaft("in", "motor", "1", SHAFTS[0], SHAFT_DAMPING[0]),
         Shaft("out", "2", "machine", SHAFTS[1], SHAFT_DAMPING[1])),
        (Mesh("g", "1", "2", R1, R2, TEETH, 2 * TEETH, STIFFNESS, DAMPING, BACKLASH),),
        (Damper("machine", None, ground),) if ground else (),
        (Torque("motor", TORQUE), Torque("machine", TORQUE * R2 / R1)),
    )  # fmt: skip


def model(speed, ground=0.0):
    k = Periodic.fit(lambda s: STIFFNESS * (1.0 + SWING * np.cos(2.0 * np.pi * s)), degree=10, tolerance=1e-12)
    ripple = tuple(
        TorqueRipple(name, name, (size,), (phase,), (order, 1))
        for name, (size, order, phase) in (("motor", AT_MOTOR), ("machine", AT_MACHINE))
    )
    return MotionModel(drive(ground), (MeshExcitation.from_mesh(k),), speed, ripple=ripple)


def accelerations(t, y, speed, side, ground):
    """`side`: 1 on the working flanks, -1 on the back flanks, 0 apart; the mean turning is taken away."""
    q, v = y[:4], y[4:]
    torque = np.array([TORQUE, 0.0, 0.0, TORQUE * R2 / R1])
    torque[0] += AT_MOTOR[0] * math.cos(AT_MOTOR[1] * speed * t + AT_MOTOR[2])
    torque[3] += AT_MACHINE[0] * math.cos(AT_MACHINE[1] * speed * t + AT_MACHINE[2]) - ground * v[3]
    for (a, b), k, c in zip(((0, 1), (2, 3)), SHAFTS, SHAFT_DAMPING, strict=True):
        twist = k * (q[a] - q[b]) + c * (v[a] - v[b])
        torque[a] -= twist
        torque[b] += twist
    force = mesh_force(t, y, speed, side)
    torque[1] -= R1 * force
    torque[2] -= R2 * force
    return np.concatenate([v, torque / INERTIA])


def mesh_force(t, y, speed, side):
    if side == 0:
        return 0.0
    k = STIFFNESS * (1.0 + SWING * math.cos(TEETH * speed * t))
    gap = R1 * y[1] + R2 * y[2] + (BACKLASH if side < 0 else 0.0)
    return k * gap + DAMPING * (R1 * y[5] + R2 * y[6])


def integrated(start, until, speed, times, ground=0.0):
    """Mesh force at the times, the end state, and how often contact changed."""
    t, y, changes = 0.0, np.array(start, dtype=float), 0
    approach = R1 * y[1] + R2 * y[2]
    side = 1 if approach > 0.0 else (-1 if approach < -BACKLASH else 0)
    forces = np.empty(times.size)

    def front(_t, y, *_):
        return R1 * y[1] + R2 * y[2]

    def back(_t, y, *_):
        return R1 * y[1] + R2 * y[2] + BACKLASH

    while t < until:
        front.terminal = back.terminal = True
        front.direction, back.direction = (-1 if side == 1 else 1), (1 if side == -1 else -1)
        events = {1: [front], 0: [front, back], -1: [back]}[side]
        found = solve_ivp(
            accelerations, (t, until), y, "DOP853", args=(speed, side, ground), events=events, rtol=1e-11,
            atol=1e-13, dense_output=True, max_step=2e-5,
        )  # fmt: skip
        inside = (times >= t) & (times <= found.t[-1])
        forces[inside] = [mesh_force(at, found.sol(at), speed, side) for at in times[inside]]
        t, y = float(found.t[-1]), found.y[:, -1]
        if t < until:
            changes += 1
            met = next(event for event, hits in zip(events, found.t_events, strict=True) if hits.size)
            side = {1: 0, -1: 0, 0: 1 if met is front else -1}[side]
    return forces, y, changes


@pytest.mark.dear
@pytest.mark.parametrize(("rpm", "ground"), [(4000.0, 0.0), (2000.0, 0.0), (4000.0, GROUND)])
def test_motion_from_the_static_state_is_that_of_scipy(rpm, ground):
    """One common period of ripple and mesh; teeth part, and strike back flanks; a damper that the turning works."""
    speed = rpm * math.pi / 30.0
    moving = model(speed, ground)
    assert moving.period == pytest.approx(2.0 * math.pi / speed)
    path = simulate(moving, moving.period, tolerance=1e-12)
    times = np.linspace(0.0, 0.999 * moving.period, 1001)
    start = np.concatenate([path.angles(0.0), path.angles(0.0, 1)])
    forces, _, changes = integrated(start, moving.period, speed, times, ground)
    assert changes == path.passage.changes
    assert changes > 6
    mean = float(moving.static[0])
    assert np.max(np.abs(forces - path.mesh_forces(times)[:, 0])) < 1e-7 * mean
    assert forces.min() < -0.1 * mean


@pytest.mark.dear
@pytest.mark.parametrize("rpm", [4000.0, 6000.0])
def test_scipy_started_on_the_steady_motion_stays_on_it(rpm):
    speed = rpm * math.pi / 30.0
    state = steady_state(model(speed), tolerance=1e-9)
    assert state.kind == "periodic"
    path = state.trajectory(state.periods)
    until = state.periods * state.model.period
    times = np.linspace(0.0, until, 20001)
    start = np.concatenate([path.angles(0.0), path.angles(0.0, 1)])
    forces, end, changes = integrated(start, until, speed, times)
    assert changes == state.changes
    mean = float(state.model.static[0])
    assert state.largest[0] == pytest.approx(forces.max(), abs=1e-3 * mean)
    assert state.largest[0] >= forces.max() - 1e-7 * mean
    twist = np.array([[1, -1, 0, 0], [0, R1, R2, 0], [0, 0, 1, -1]])
    for part in (slice(0, 4), slice(4, 8)):
        before, after = twist @ start[part], twist @ end[part]
        assert np.max(np.abs(after - before)) < 1e-6 * np.max(np.abs(before))


def test_a_ripple_without_a_common_period_is_shifted_to_one_that_is_nearly_its_own():
    """Order pi of one turn: the motion over the shifted period is what waiting leaves of the true one, nearly."""
    speed = 3000.0 * math.pi / 30.0
    k = Periodic.fit(lambda s: STIFFNESS * (1.0 + SWING * np.cos(2.0 * np.pi * s)), degree=10, tolerance=1e-12)
    odd = TorqueRipple("r", "motor", (10.0,), (0.0,), frequency=50.0 * math.pi)
    shifted = MotionModel(drive(), (replace(MeshExcitation.from_mesh(k), parting=False),), speed, ripple=(odd,))
    assert 0.0 < abs(shifted.common.stretch[0] - 1.0) <= 1e-4
    state = steady_state(shifted, tolerance=1e-8)
    waited = replace(shifted, ripple=(replace(odd, frequency=50.0 * 22.0 / 7.0),))
    assert waited.common.stretch == pytest.approx((1.0,), abs=1e-9)
    other = steady_state(waited, tolerance=1e-8)
    assert state.largest[0] == pytest.approx(other.largest[0], rel=3e-3)
