"""Steady motion by shooting against scipy: DOP853 and Radau run through contact changes (events) to the steady state.

The reference is written from the equations of TM-100180 alone (1 to 4 and 19 to 24, repaired): a list of springs, a
right-hand side, events; it shares no code with the integrator.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.charts import FourInertia
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic

R = 0.04177
JUMPS = (0.32, 0.68, 1.0)
STIFFNESS = (4.2e8, 2.6e8, 4.2e8)


def four_inertia(force, backlash, shaft_ratio):
    j = 1.22e-3
    return FourInertia(10 * j, j, j, 10 * j, 2.18e4, 2.18e4, R, R, 28, 28, force, shaft_ratio, 0.08, backlash)


def excitation(amplitude=0.0):
    """Stiffness that jumps twice per base pitch, and a transmission error of one harmonic."""
    k = Periodic.through_points([0, 0.32, 0.32, 0.68, 0.68, 1], [4.2e8, 4.2e8, 2.6e8, 2.6e8, 4.2e8, 4.2e8])
    if amplitude == 0.0:
        return MeshExcitation.from_mesh(k)
    e = Periodic.fit(lambda s: amplitude * np.cos(2 * np.pi * s), degree=10, tolerance=1e-13)
    return MeshExcitation.from_mesh(k, e)


def reference(system, rpm, amplitude, periods, method, rtol, start=None, mesh=(STIFFNESS, JUMPS), looked=2):
    """By scipy: largest mesh force and contact changes over the last periods, and the state at the end."""
    stiffness, jumps = mesh
    mean = np.dot(stiffness, np.diff(jumps, prepend=0.0))
    j = np.array([system.motor, system.gear_1, system.gear_2, system.load])
    cs = 2 * system.shaft_ratio * math.sqrt(system.shaft_1 / (1 / j[0] + 1 / j[1]))
    cg = 2 * system.mesh_ratio * math.sqrt(mean * j[1] * j[2] / (R * R * (j[1] + j[2])))
    w, s, ks = system.force, system.backlash, system.shaft_1
    f = 28 * rpm / 60
    torque = np.array([w * R, 0.0, 0.0, -w * R])

    def e(t):
        return amplitude * math.cos(2 * math.pi * f * t)

    def force(t, y, mode, k):
        rate = R * (y[5] - y[6])
        x = R * (y[1] - y[2])
        return (k * (x - e(t)) + cg * rate, 0.0, k * (x + s) + cg * rate)[mode]

    def rhs(t, y, mode, k):
        a, b = ks * (y[0] - y[1]) + cs * (y[4] - y[5]), ks * (y[2] - y[3]) + cs * (y[6] - y[7])
        m = R * force(t, y, mode, k)
        return np.concatenate([y[4:], (torque + np.array([-a, a - m, m - b, b])) / j])

    # static state: the mesh carries w, the shafts w R
    x0 = w / stiffness[0] + amplitude
    angle = np.array([w * R / ks + x0 / R, x0 / R, 0.0, -w * R / ks])
    y = np.concatenate([angle, np.zeros(4)]) if start is None else start
    t, largest, changes = 0.0, -math.inf, 0
    mode = 0 if R * (y[1] - y[2]) > e(0.0) else (2 if R * (y[1] - y[2]) < -s else 1)
    for n in range(periods):
        for k, jump in zip(stiffness, jumps, strict=True):
            end = (n + jump) / f
            while t < end:

                def front(t, y, *_):
                    return R * (y[1] - y[2]) - e(t)

                def back(t, y, *_):
                    return R * (y[1] - y[2]) + s

                front.terminal = back.terminal = True
                front.direction, back.direction = (-1 if mode == 0 else 1), (1 if mode == 2 else -1)
                events = [[front], [front, back], [back]][mode] if math.isfinite(s) else [front]
                run = solve_ivp(rhs, (t, end), y, method, events=events, args=(mode, k), rtol=rtol,
                                atol=rtol * 1e-6, dense_output=n >= periods - looked)  # fmt: skip
                if n >= periods - looked and mode != 1:
                    fine = np.linspace(t, run.t[-1], 200)
                    values = [force(u, run.sol(u), mode, k) for u in fine]
                    i = int(np.argmax(values))
                    a, b = fine[max(i - 1, 0)], fine[min(i + 1, 199)]
                    best = minimize_scalar(lambda u, run=run, mode=mode, k=k: -force(u, run.sol(u), mode, k),
                                           bounds=(a, b), method="bounded", options={"xatol": 1e-14})  # fmt: skip
                    largest = max(largest, values[i], -best.fun)
                t, y = run.t[-1], run.y[:, -1]
                if run.status == 1:
                    changes += n >= periods - looked
                    mode = (0 if len(run.t_events[0]) else 2) if mode == 1 else 1
    return largest, changes, y


def shooting(system, rpm, amplitude, tolerance):
    train = system.train(0.64 * 4.2e8 + 0.36 * 2.6e8)
    return steady_state(MotionModel(train, (excitation(amplitude),), rpm * math.pi / 30), tolerance=tolerance)


CASES = {
    # rpm, backlash, amplitude of the transmission error, mean force, damping ratio of the shafts
    "always in contact": (5000.0, math.inf, 0.0, 8890.0, 0.8),
    "contact loss": (10500.0, math.inf, 0.0, 8890.0, 0.1),
    "contact loss and backside contact": (7500.0, 1.2e-5, 1.08e-5, 1000.0, 0.8),
}


@pytest.mark.parametrize("name", CASES)
def test_scipy_started_on_the_steady_motion_stays_on_it(name):
    """DOP853 at rtol 1e-12 with events over two periods: same forces to 1e-10, same state to 1e-9 of its size."""
    rpm, backlash, amplitude, force, shaft = CASES[name]
    system = four_inertia(force, backlash, shaft)
    state = shooting(system, rpm, amplitude, 1e-11)
    assert state.kind == "periodic"
    assert state.periods == 1
    path = state.trajectory(1)
    start = np.concatenate([path.angles(0.0), path.angles(0.0, 1)])
    largest, changes, end = reference(system, rpm, amplitude, 2, "DOP853", 1e-12, start)
    assert 2 * state.changes == changes
    assert (changes > 0) == (name != "always in contact")
    assert (state.behind[0] > 0) == ("backside" in name)
    assert state.largest[0] / force == pytest.approx(largest / force, abs=1e-10)
    twist = np.array([[1, -1, 0, 0], [0, 1, -1, 0], [0, 0, 1, -1]])
    for part in (slice(0, 4), slice(4, 8)):
        before, after = twist @ start[part], twist @ end[part]
        assert np.max(np.abs(after - before)) < 1e-9 * np.max(np.abs(before))


@pytest.mark.parametrize(
    "name", [name if "backside" in name else pytest.param(name, marks=pytest.mark.long) for name in CASES]
)
def test_waiting_for_the_transient_ends_on_the_same_motion(name):
    """DOP853 from the static state over 150 periods; the slowest motion decays by 0.93 a period: 1e-4 is left."""
    rpm, backlash, amplitude, force, shaft = CASES[name]
    system = four_inertia(force, backlash, shaft)
    largest, _, _ = reference(system, rpm, amplitude, 150, "DOP853", 1e-9)
    assert shooting(system, rpm, amplitude, 1e-11).largest[0] / force == pytest.approx(largest / force, rel=1e-3)


def test_radau_started_on_the_steady_motion_stays_on_it():
    """An implicit method at rtol 1e-10 agrees to 1e-8: what its own error leaves."""
    rpm, backlash, amplitude, force, shaft = CASES["contact loss"]
    system = four_inertia(force, backlash, shaft)
    state = shooting(system, rpm, amplitude, 1e-11)
    path = state.trajectory(1)
    start = np.concatenate([path.angles(0.0), path.angles(0.0, 1)])
    largest, changes, _ = reference(system, rpm, amplitude, 2, "Radau", 1e-10, start)
    assert 2 * state.changes == changes
    assert state.largest[0] / force == pytest.approx(largest / force, abs=1e-8)


@pytest.mark.parametrize("tolerance", [5e-4, 1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("name", CASES)
def test_the_tolerance_asked_for_is_met(name, tolerance):
    rpm, backlash, amplitude, force, shaft = CASES[name]
    system = four_inertia(force, backlash, shaft)
    fine = shooting(system, rpm, amplitude, 2e-13).largest[0]
    assert abs(shooting(system, rpm, amplitude, tolerance).largest[0] - fine) <= tolerance * force


def random_rig(seed):
    """Inertias, shafts, damping, backlash, stiffness, speed and error of a rig within a wide range."""
    rng = np.random.default_rng(seed)
    gear, motor, shaft = rng.uniform(0.5e-3, 4e-3), rng.uniform(2e-3, 4e-2), rng.uniform(0.5e4, 8e4)
    high = rng.uniform(2e8, 6e8)
    low, jumps = high * rng.uniform(0.5, 0.95), (*np.sort(rng.uniform(0.1, 0.9, 2)).tolist(), 1.0)
    force, backlash = rng.uniform(500.0, 9000.0), (math.inf if rng.random() < 0.3 else rng.uniform(0.5e-5, 5e-5))
    system = FourInertia(motor, gear, gear, motor, shaft, shaft, R, R, 28, 28, force, rng.uniform(0.05, 0.5),
                         rng.uniform(0.03, 0.15), backlash)  # fmt: skip
    natural = math.sqrt(2.0 * R * R / gear * high) / (2.0 * math.pi)  # of the gears on the teeth alone [Hz]
    rpm = 60.0 / 28 * natural * rng.uniform(0.2, 1.6)
    # An error above the backlash would press both flanks at once, which the reference does not know.
    error = min(rng.uniform(0.0, 1.5) * force / high, 0.8 * backlash)
    return system, rpm, error, ((high, low, high), jumps)


@pytest.mark.parametrize("seed", range(60))
def test_random_rigs_move_as_an_own_integration_says(seed):
    """Started on the steady motion, scipy stays on it for its periods, with its contact changes and its largest force.

    Both the stiffness (of which the damping is a share) and the error of transmission are drawn.
    """
    system, rpm, amplitude, mesh = random_rig(seed)
    (high, low, _), (first, second, _) = mesh
    places = [0, first, first, second, second, 1]
    k = Periodic.through_points(places, [high, high, low, low, high, high])
    e = Periodic.fit(lambda s: amplitude * np.cos(2 * np.pi * s), degree=10, tolerance=1e-13)
    mean = high * (1.0 - second + first) + low * (second - first)
    model = MotionModel(system.train(mean), (MeshExcitation.from_mesh(k, e),), rpm * math.pi / 30)
    state = steady_state(model, tolerance=1e-11)
    assert state.kind == "periodic", state.kind
    path = state.trajectory(state.periods)
    start = np.concatenate([path.angles(0.0), path.angles(0.0, 1)])
    largest, changes, end = reference(
        system, rpm, amplitude, state.periods, "DOP853", 1e-12, start, mesh, looked=state.periods
    )
    assert changes == state.changes
    assert state.largest[0] / system.force == pytest.approx(largest / system.force, abs=1e-8)
    twist = np.array([[1, -1, 0, 0], [0, 1, -1, 0], [0, 0, 1, -1]])
    for part in (slice(0, 4), slice(4, 8)):
        before, after = twist @ start[part], twist @ end[part]
        assert np.max(np.abs(after - before)) < 1e-7 * np.max(np.abs(before))
