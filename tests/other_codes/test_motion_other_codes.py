"""Steady motion by shooting against scipy: DOP853 and Radau run through contact changes (events) to the steady state.

The reference is written from the equations of TM-100180 alone (1 to 4 and 19 to 24, repaired): a list of springs, a
right-hand side, events; it shares no code with the integrator.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.back_flanks import BackFlanks
from fegear.dynamics.train.charts import FourInertia
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.verify.rigs import CASES, R, excitation, four_inertia, reference, shooting


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
    assert (state.behind[0] > 0) == ("back-side" in name)
    assert state.largest[0] / force == pytest.approx(largest / force, abs=1e-10)
    twist = np.array([[1, -1, 0, 0], [0, 1, -1, 0], [0, 0, 1, -1]])
    for part in (slice(0, 4), slice(4, 8)):
        before, after = twist @ start[part], twist @ end[part]
        assert np.max(np.abs(after - before)) < 1e-9 * np.max(np.abs(before))


@pytest.mark.parametrize("behind", [1.7e8, 6.0e8])
def test_back_flanks_of_another_stiffness_push_with_it(behind):
    """As above, the back flanks with a stiffness of their own."""
    rpm, backlash, amplitude, force, shaft = next(one for name, one in CASES.items() if "back-side" in name)
    system = four_inertia(force, backlash, shaft)
    train = system.train(0.64 * 4.2e8 + 0.36 * 2.6e8)
    of_own = replace(excitation(amplitude), back=BackFlanks(Periodic.constant(behind), -0.4))
    state = steady_state(MotionModel(train, (of_own,), rpm * math.pi / 30), tolerance=1e-11)
    path = state.trajectory(1)
    start = np.concatenate([path.angles(0.0), path.angles(0.0, 1)])
    largest, _, end = reference(system, rpm, amplitude, 2 * state.periods, "DOP853", 1e-12, start, behind=behind,
                                looked=2 * state.periods)  # fmt: skip
    assert state.behind[0] > 0
    assert state.largest[0] / force == pytest.approx(largest / force, abs=1e-9)
    twist = np.array([[1, -1, 0, 0], [0, 1, -1, 0], [0, 0, 1, -1]])
    before, after = twist @ start[4:], twist @ end[4:]
    assert np.max(np.abs(after - before)) < 1e-8 * np.max(np.abs(before))


@pytest.mark.dear
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
    rpm, backlash, amplitude, force, shaft = CASES["loss of contact"]
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


@pytest.mark.dear
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
