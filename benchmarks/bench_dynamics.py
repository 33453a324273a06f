"""Frequency chain and speed sweep: what the issue asks 0.3 s, 10 s and 8 minutes for.

Run with ``pytest benchmarks/bench_dynamics.py --benchmark-only``. The first call compiles the integrator (kept on disk
for later processes); it is made before the clock starts.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import speed_sweep, steady_state
from fegear.dynamics.train.charts import FourInertia, chart_point, linear_tip_relief
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.increments import dynamic_increments
from fegear.dynamics.train.mesh_force_spectrum import mesh_force_spectrum
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Damper, Mesh, Shaft, Torque, Train, mesh_damping, shaft_damping

R, PITCH, FORCE = 0.04177, 9.373e-3, 8890.0


def four_square():
    r, t = 0.0417693, 1615.0 * 0.0417693
    return Train(
        bodies=(Body("1", 0.004112), Body("2", 0.0008010), Body("3", 0.002994)),
        meshes=(
            Mesh("I", "1", "2", r, r, 28, 28, 1 / 1.26312e-8),
            Mesh("II", "1", "3", -r, -r, 35, 35, 1 / 2.1052e-9),
        ),
        dampers=(
            Damper("1", None, 12.61), Damper("2", None, 6.305), Damper("3", None, 6.305), Damper("2", "3", 43.5)
        ),
        torques=(Torque("2", t), Torque("3", -t)),
    )  # fmt: skip


def four_inertia():
    j = 1.22e-3
    return FourInertia(10 * j, j, j, 10 * j, 2.18e4, 2.18e4, R, R, 28, 28, FORCE, 0.05, 0.10, 2e-5)


def pair(amount=0.0, length=1.0):
    """Tooth pairs of contact ratio 1.64 with linear tip relief."""
    half, single = 0.82 * PITCH, 0.18 * PITCH
    start = half - length * (half - single)

    def separation(x):
        return linear_tip_relief(x, half, start, amount) + linear_tip_relief(x, -half, -start, amount)

    return MeshExcitation.from_tooth_pair(
        lambda x: 3.1e8 * (1 - 0.3 * (x / half) ** 2), separation, -half, half, PITCH, breaks=[start, -start],
        tolerance=1e-8,
    )  # fmt: skip


def test_frequency_chain_64_harmonics_200_speeds(benchmark):
    k = Periodic.through_points([0, 0.3, 0.3, 0.7, 0.7, 1], np.array([1, 1, 1.6, 1.6, 1, 1]) * 2e-5)
    speeds = np.linspace(500, 15000, 200) * math.pi / 30
    found = benchmark(mesh_force_spectrum, four_square(), [k, k.scaled(0.1)], speeds, 64)
    assert found.coefficients.shape == (2, 2, 64, 200)


def row_of_bodies(count, meshes):
    """Bodies in a row, gear pairs spread evenly among shafts, torques at both ends."""
    at = {int((m + 0.5) * (count - 1) / meshes) for m in range(meshes)}
    bodies = tuple(Body(f"b{i}", 1e-3 * (1.0 + 0.3 * math.sin(i))) for i in range(count))
    shafts, pairs = [], []
    for i in range(count - 1):
        if i in at:
            c = mesh_damping(0.05, 3e8, 0.04, 0.05, 1e-3, 1e-3)
            pairs.append(Mesh(f"m{i}", f"b{i}", f"b{i + 1}", 0.04, 0.05, 40, 50, 3e8, c))
        else:
            k = 2e5 * (1.0 + 0.2 * math.cos(i))
            shafts.append(Shaft(f"s{i}", f"b{i}", f"b{i + 1}", k, shaft_damping(0.01, k, 1e-3, 1e-3)))
    free = Train(bodies, tuple(shafts), tuple(pairs))
    last = bodies[-1].name
    ends = Torque("b0", 100.0), Torque(last, -100.0 / free.ratios[free.dof[last]])
    return replace(free, torques=ends)


@pytest.mark.parametrize(("bodies", "meshes"), [(200, 1), (60, 30), (1000, 1), (2000, 1), (500, 30)])
def test_increments_of_long_trains_at_1000_frequencies(benchmark, bodies, meshes):
    """Asked for: 5 s and 500 MB with one gear pair, 30 s with thirty; 2,000 bodies in 2.5 medians of 1,000."""
    train = row_of_bodies(bodies, meshes)
    omega = 2.0 * math.pi * np.logspace(1, 4, 1000)
    found = benchmark.pedantic(dynamic_increments, (train, omega), rounds=5)
    assert found.shape == (meshes, meshes, 1000)


@pytest.mark.usefixtures("losing_contact")
def test_motion_of_200_bodies_at_four_speeds(benchmark):
    """Asked for: 30 s."""
    stiffness = Periodic.through_points([0, 0.35, 0.35, 0.65, 0.65, 1], [3.6e8, 3.6e8, 2.4e8, 2.4e8, 3.6e8, 3.6e8])
    error = Periodic.fit(lambda s: 1e-6 * np.cos(2.0 * np.pi * s), degree=10, tolerance=1e-12)
    model = MotionModel(row_of_bodies(200, 1), (MeshExcitation.from_mesh(stiffness, error),), 100.0)
    speeds = np.array([400.0, 1000.0, 2000.0, 4000.0]) * math.pi / 30

    def run():
        return [steady_state(model.at_speed(float(speed))) for speed in speeds]

    assert all(state.repeats for state in benchmark.pedantic(run, rounds=1))


@pytest.fixture(scope="module")
def losing_contact():
    found = pair()
    model = MotionModel(four_inertia().train(1 / found.mean_compliance()), (found,), 1000.0)
    steady_state(model)
    return model


def test_sweep_of_100_speeds_with_contact_loss(benchmark, losing_contact):
    speeds = np.linspace(1500, 16000, 100)[::-1] * math.pi / 30
    states = benchmark.pedantic(speed_sweep, (losing_contact, speeds), {"tolerance": 5e-4}, rounds=3)
    assert any(state.apart[0] > 0 for state in states)


def test_one_speed_with_lsoda_run_to_steady_state(benchmark, losing_contact):
    """The same with scipy's LSODA: one speed (of the hundred), 400 mesh periods from the static state."""
    train, excitation = losing_contact.train, losing_contact.excitations[0]
    j, g, c = train.inertia, train.approach[0], train.meshes[0].damping
    ks, cs = train.shafts[0].stiffness, train.shafts[0].damping
    frequency = 28 * 10_500 / 60

    def rhs(t, y):
        s = t * frequency
        x = g @ y[:4]
        w = sum(
            float(k(s)) * max(x - float(e(s)), 0.0)
            for k, e in zip(excitation.stiffness, excitation.separation, strict=True)
        )
        w += c * (g @ y[4:]) if x > 0 else 0.0
        a, b = ks * (y[0] - y[1]) + cs * (y[4] - y[5]), ks * (y[2] - y[3]) + cs * (y[6] - y[7])
        return np.concatenate([y[4:], (train.torque + np.array([-a, a, -b, b]) - g * w) / j])

    y = np.concatenate([np.array([FORCE * R / ks, 0, 0, -FORCE * R / ks]), np.zeros(4)])
    y[:2] += 2e-5 / R

    def run():
        return solve_ivp(rhs, (0, 400 / frequency), y, "LSODA", rtol=1e-6, atol=1e-10)

    assert benchmark.pedantic(run, rounds=1).success


@pytest.mark.usefixtures("losing_contact")
def test_one_amount_of_the_design_chart(benchmark):
    """31 lengths x 61 speeds at one of the six amounts, on one core."""
    speeds = np.linspace(2000, 16000, 61) * math.pi / 30
    lengths = np.linspace(0.25, 1.28, 31)

    def chart():
        return [chart_point(four_inertia(), pair(2.5e-5, float(n)), speeds, direction="static") for n in lengths]

    assert len(benchmark.pedantic(chart, rounds=1)) == 31
