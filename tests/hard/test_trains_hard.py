"""Gear trains at the edges: no damping, no speed, shafts of no and of endless stiffness, modes on top of each other."""

import math

import mpmath
import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.increments import dynamic_increments
from fegear.dynamics.train.matrices import static_forces
from fegear.dynamics.train.modes import modes
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Mesh, Shaft, Torque, Train, mesh_damping

R, J, K, FORCE = 0.05, 2e-3, 2e8, 500.0
NATURAL = math.sqrt(2.0 * K * R * R / J)


def two_discs(zeta, backlash=math.inf):
    """One oscillator: mass J / (2 R^2) on the mesh stiffness."""
    c = mesh_damping(zeta, K, R, R, J, J)
    return Train(
        (Body("1", J), Body("2", J)), meshes=(Mesh("g", "1", "2", R, R, 30, 30, K, c, backlash),),
        torques=(Torque("1", FORCE * R), Torque("2", FORCE * R)),
    )  # fmt: skip


def swinging(zeta, ratio=1.0, amplitude=1e-9):
    error = Periodic.fit(lambda s: amplitude * np.cos(2 * np.pi * s), degree=10, tolerance=1e-13)
    excitation = MeshExcitation.from_mesh(Periodic.constant(K), error)
    return MotionModel(two_discs(zeta), (excitation,), ratio * NATURAL / 30)


# ---- damping --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("zeta", [1e-2, 1e-4, 1e-6])
def test_amplitude_at_resonance_is_one_over_damping_and_keeps_its_digits(zeta):
    """The shooting matrix I - M is as near singular as the damping is small; the force keeps its relative accuracy."""
    amplitude = 1e-7 * zeta  # so small that the teeth stay together
    state = steady_state(swinging(zeta, amplitude=amplitude), tolerance=1e-9)
    assert state.changes == 0
    h = 1.0 / (2j * zeta)  # k / (k - m w^2 + i w c) at w = w0
    force = abs(K * (h - 1.0) + 2j * zeta * K * h) * amplitude
    assert state.largest[0] - FORCE == pytest.approx(force, rel=1e-6)
    assert FORCE - state.smallest[0] == pytest.approx(force, rel=1e-6)


def test_exactly_no_damping_at_resonance_is_refused_by_motion_and_by_transfer_functions_alike():
    with pytest.raises(RangeError, match="is an undamped resonance: no steady-state"):
        steady_state(swinging(0.0))
    exact = Train((Body("1", 1.0), Body("2", 1.0)), meshes=(Mesh("I", "1", "2", 1.0, 1.0, 20, 20, 2.0),))
    with pytest.raises(RangeError, match="is a natural frequency of the undamped train"):
        dynamic_increments(exact, [1.0, 2.0])
    # ... and a hair beside it, where the answer is large but finite, it is given.
    q = dynamic_increments(exact, 2.0 * (1.0 + np.array([-1e-9, 1e-9])))[0, 0]
    assert np.abs(q) == pytest.approx([5e8, 5e8], rel=1e-5)


def test_undamped_motion_beside_resonance_is_finite_on_both_sides():
    for ratio in (0.999, 1.001):
        state = steady_state(swinging(0.0, ratio, 1e-9))
        gain = abs(1.0 / (1.0 - ratio**2) - 1.0)
        assert state.largest[0] - FORCE == pytest.approx(K * 1e-9 * gain, rel=1e-5)


# ---- speed ----------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("speed", [1e-1, 1e-2, 1e-3])
def test_speed_toward_zero_leaves_the_static_transmission_error(speed):
    """What is left of dynamics falls with the square of the speed; zero itself is refused, with the answer to take."""
    model = swinging(0.05, amplitude=1e-6).at_speed(speed * NATURAL / 30)
    state = steady_state(model, tolerance=1e-9)
    still = FORCE / K + 1e-6  # load over stiffness, and the error's crest
    t = np.linspace(0.0, model.period, 65)
    approach = state.trajectory(1).approach(t)[:, 0]
    assert approach.max() == pytest.approx(still, rel=1.2 * speed**2 + 1e-8)
    assert state.largest[0] == pytest.approx(FORCE, rel=0.5 * speed)
    with pytest.raises(RangeError, match="use the static result for zero speed"):
        model.at_speed(0.0)


def train(input_shaft=2e4, branch=30.0, pump=1e-5, with_pump=True):
    """Motor, input shaft, a gear pair, and a pump on a branch."""
    bodies = [Body("motor", 0.02), Body("a", 0.0012), Body("b", 0.004)]
    shafts = [Shaft("s1", "motor", "a", input_shaft, 0.0)]
    if with_pump:
        bodies.append(Body("pump", pump))
        shafts.append(Shaft("s2", "b", "pump", branch, 0.0))
    return Train(tuple(bodies), tuple(shafts), (Mesh("p", "a", "b", 0.03, 0.06, 20, 40, 3e8, 500.0),),
                 torques=(Torque("motor", 10.0), Torque("b", 20.0)))  # fmt: skip


OMEGA = 2.0 * np.pi * np.logspace(1, 4, 25)


# ---- shafts ---------------------------------------------------------------------------------------------------------
def test_a_shaft_of_endless_stiffness_joins_its_bodies():
    rigid = dynamic_increments(train(math.inf), OMEGA)
    frequencies = modes(train(math.inf)).frequencies
    errors = []
    for stiffness in (1e10, 1e12, 1e14, 1e16):
        found = dynamic_increments(train(stiffness), OMEGA)
        errors.append(float(np.max(np.abs(found / rigid - 1.0))))
        low = modes(train(stiffness)).frequencies[: frequencies.size]
        assert low[1:] == pytest.approx(frequencies[1:], rel=1e7 / stiffness + 1e-13)
    # proportional to the shaft's compliance, down to round-off
    assert errors[1] == pytest.approx(1e-2 * errors[0], rel=0.1)
    assert errors[-1] < 1e-8
    assert static_forces(train(1e16)) == pytest.approx(static_forces(train(math.inf)), rel=1e-12)


def test_a_branch_on_a_shaft_of_vanishing_stiffness_is_not_there():
    alone = dynamic_increments(train(with_pump=False), OMEGA)
    errors = [
        float(np.max(np.abs(dynamic_increments(train(branch=stiffness), OMEGA) / alone - 1.0)))
        for stiffness in (1e-4, 1e-6, 1e-8)
    ]
    assert errors[1] == pytest.approx(1e-2 * errors[0], rel=0.05)
    assert errors[-1] < 1e-8


@pytest.mark.parametrize("stiffness", [0.0, -1.0, math.nan])
def test_shafts_of_no_stiffness_are_refused_with_what_to_do(stiffness):
    with pytest.raises(InputError, match=r"shaft\.s1\.stiffness"):
        train(stiffness)


# ---- digits ---------------------------------------------------------------------------------------------------------
def test_soft_and_stiff_parts_of_one_train_keep_their_frequencies_in_fifty_digits():
    """Shafts of 1e-3 and meshes of 1e9: frequencies from an eigenvalue problem would lose the soft one altogether."""
    soft = Train(
        (Body("1", 1e-4), Body("2", 2e-4), Body("3", 0.5)), (Shaft("s", "2", "3", 1e-3),),
        (Mesh("g", "1", "2", 0.01, 0.02, 20, 40, 1e9),),
    )  # fmt: skip
    with mpmath.workdps(50):
        j1, j2, j3 = (mpmath.mpf(float(v)) for v in soft.inertia)
        k, s, r1, r2 = mpmath.mpf(1e9), mpmath.mpf(1e-3), mpmath.mpf(0.01), mpmath.mpf(0.02)
        stiff = mpmath.matrix([[k * r1**2, k * r1 * r2, 0], [k * r1 * r2, k * r2**2 + s, -s], [0, -s, s]])
        root = mpmath.diag([1 / mpmath.sqrt(j) for j in (j1, j2, j3)])
        exact = [float(mpmath.sqrt(abs(v))) / (2 * math.pi) for v in mpmath.eigsy(root * stiff * root)[0]]
    found = modes(soft).frequencies
    assert found[0] == 0.0
    assert found[1:] == pytest.approx(sorted(exact)[1:], rel=1e-13)


def test_slow_increments_keep_all_digits_where_the_plain_formula_keeps_none():
    """R H - 1 at 1e-7 Hz is a difference of numbers that agree in all their digits."""
    t, w = train(), 2.0 * np.pi * 1e-7
    with mpmath.workdps(50):
        m, n = mpmath.mpf, t.size
        A, g = mpmath.matrix(n, n), mpmath.matrix(n, 1)
        mesh, s1, s2 = t.meshes[0], t.shafts[0], t.shafts[1]
        y = mpmath.mpc(m(mesh.stiffness), m(w) * m(mesh.damping))
        g[t.dof["a"]], g[t.dof["b"]] = m(mesh.radius_a), m(mesh.radius_b)
        for i in range(n):
            A[i, i] -= m(w) ** 2 * m(float(t.inertia[i]))
            for j in range(n):
                A[i, j] += y * g[i] * g[j]
        for shaft in (s1, s2):
            p, q = t.dof[shaft.a], t.dof[shaft.b]
            for i, j, sign in ((p, p, 1), (q, q, 1), (p, q, -1), (q, p, -1)):
                A[i, j] += sign * m(shaft.stiffness)
        h = mpmath.lu_solve(A, g * m(mesh.stiffness))
        exact = complex(((g.T * h)[0]) * (y / m(mesh.stiffness)) - 1)
    found = complex(dynamic_increments(t, w)[0, 0])
    assert abs(exact) < 1e-14  # the plain formula in doubles is round-off alone
    assert abs(found - exact) < 1e-12 * abs(exact)
