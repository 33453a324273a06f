"""Laws of motion on random trains: reciprocity, passivity, limits at standstill, two ways to one answer."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fegear.dynamics.train.increments import dynamic_increments
from fegear.dynamics.train.matrices import damping_matrix, mass_matrix, static_forces, stiffness_matrix
from fegear.dynamics.train.modes import damped_eigenvalues, modes
from fegear.dynamics.train.train import (
    Body,
    Damper,
    Mesh,
    Shaft,
    Torque,
    Train,
    joined_inertias,
    mesh_damping,
    shaft_damping,
)


def powers(low, high):
    return st.floats(low, high).map(lambda e: 10.0**e)


@st.composite
def trains(draw, damped=True):
    """Trees of two to seven bodies over many decades, in equilibrium under torques at both ends."""
    n = draw(st.integers(2, 7))
    bodies = tuple(Body(str(i), draw(powers(-5.0, 0.5))) for i in range(n))
    shafts, meshes = [], []
    for i in range(1, n):
        other = str(draw(st.integers(0, i - 1)))
        if i == 1 or draw(st.booleans()):
            za, zb, module = draw(st.integers(12, 90)), draw(st.integers(12, 90)), draw(powers(-3.2, -2.0))
            c = draw(powers(0.0, 3.5)) if damped else 0.0
            meshes.append(
                Mesh(f"m{i}", other, str(i), za * module / 2, zb * module / 2, za, zb, draw(powers(6.0, 9.5)), c)
            )
        else:
            c = draw(powers(-3.0, 1.0)) if damped else 0.0
            shafts.append(Shaft(f"s{i}", other, str(i), draw(powers(2.0, 8.0)), c))
    dampers = ()
    if damped:
        dampers = tuple(Damper(str(i), None, draw(powers(-4.0, 1.0))) for i in range(n) if draw(st.booleans()))
    plain = Train(bodies, tuple(shafts), tuple(meshes), dampers)
    ratios = plain.ratios[[plain.dof[str(i)] for i in range(n)]]
    drive, load = 100.0, -100.0 * ratios[0] / ratios[n - 1]
    return Train(bodies, tuple(shafts), tuple(meshes), dampers, (Torque("0", drive), Torque(str(n - 1), load)))


frequencies = 2.0 * np.pi * np.logspace(-2.0, 4.5, 14)


@given(trains())
def test_increments_are_reciprocal(train):
    """What mesh j's error does to mesh i's force, mesh i's error does to mesh j's."""
    q = dynamic_increments(train, frequencies)
    k = np.array([m.stiffness for m in train.meshes])
    lag = np.array([1.0 + 1j * frequencies * m.damping / m.stiffness for m in train.meshes])
    force = k[:, None, None] * q / lag[:, None, :]
    size = np.sqrt(np.abs(np.einsum("iiw->iw", force)))
    scale = size[:, None, :] * size[None, :, :] + np.abs(force)
    assert (np.abs(force - np.swapaxes(force, 0, 1)) <= 1e-9 * scale).all()


@given(trains())
def test_errors_can_only_feed_power_into_a_damped_train(train):
    """Passivity: force of the springs on rate of error is an impedance of positive real part, all meshes together.

    (Mesh damping acts on the bodies' approach, so that errors work against the springs alone.)
    """
    q = dynamic_increments(train, frequencies)
    k = np.array([m.stiffness for m in train.meshes])
    lag = np.array([1.0 + 1j * frequencies * m.damping / m.stiffness for m in train.meshes])
    own = np.eye(len(train.meshes))[:, :, None]
    springs = k[:, None, None] * ((q + own) / lag[:, None, :] - own)
    z = np.moveaxis(-springs / (1j * frequencies), 2, 0)
    hermitian = 0.5 * (z + np.conj(np.swapaxes(z, 1, 2)))
    round_off = 1e-8 * np.abs(z).max(axis=(1, 2)) + 1e-13 * k.max() / frequencies
    assert (np.linalg.eigvalsh(hermitian).min(axis=1) >= -round_off).all()
    values = damped_eigenvalues(train)
    assert values[0] == 0.0  # the train turns freely
    assert values.real.max() < 1e-12 * np.abs(values).max()


@given(trains())
def test_at_standstill_a_tree_feels_no_error_and_forces_follow_from_the_torques(train):
    assert np.abs(dynamic_increments(train, 0.0)).max() == 0.0
    forces = static_forces(train)
    # Cut the tree at a mesh: the torques on one side are what it carries.
    for i, mesh in enumerate(train.meshes):
        side = {mesh.a}
        grown = True
        parts = [(s.a, s.b) for s in train.shafts] + [(m.a, m.b) for j, m in enumerate(train.meshes) if j != i]
        while grown:
            more = {b for a, b in parts if a in side} | {a for a, b in parts if b in side}
            grown = not more <= side
            side |= more
        torque = sum(t.value * train.ratios[train.dof[t.body]] for t in train.torques if t.body in side)
        expected = torque / (mesh.radius_a * train.ratios[train.dof[mesh.a]])
        assert forces[i] == pytest.approx(expected, rel=1e-12, abs=1e-12 * np.abs(forces).max())


@given(trains(damped=False), st.floats(0.0, 1.0))
def test_direct_elimination_and_the_sum_over_modes_agree(train, where):
    """Undamped, away from resonances: Q_ij = sum_r (g_i shape_r)(g_j shape_r) k_j / (w_r^2 - w^2) - delta_ij."""
    found = modes(train)
    natural = 2.0 * math.pi * found.frequencies
    assume(natural.size > 2)
    k = int(where * (natural.size - 2)) + 1
    low, high = natural[k - 1], natural[k]
    assume(high - low > 1e-3 * high)
    w = 0.5 * (low + high)
    row = train.approach @ found.shapes
    stiffness = np.array([m.stiffness for m in train.meshes])
    by_modes = np.einsum("ir,jr,r->ij", row[:, 1:], row[:, 1:], 1.0 / (natural[1:] ** 2 - w**2)) * stiffness
    direct = dynamic_increments(train, w).real
    exact = by_modes - np.eye(len(train.meshes))
    assert direct == pytest.approx(exact, rel=1e-6, abs=1e-8 * (1.0 + np.abs(by_modes).max()))


@given(trains())
def test_matrices_are_those_of_a_passive_system(train):
    K, C, M = stiffness_matrix(train), damping_matrix(train), mass_matrix(train)
    for matrix in (K, C, M):
        assert (matrix == matrix.T).all()
        root = np.sqrt(np.maximum(np.abs(np.diag(matrix)), 1e-300))
        assert np.linalg.eigvalsh(matrix / np.outer(root, root)).min() > -1e-12
    # Turning as a whole strains nothing.
    assert np.abs(K @ train.ratios).max() <= 1e-12 * np.abs(K).max() * np.abs(train.ratios).max()
    found = modes(train)
    assert found.frequencies[0] == 0.0
    assert (np.diff(found.frequencies) >= 0.0).all()
    assert (found.mesh_energy >= 0.0).all()
    assert (found.mesh_energy.sum(axis=1) <= 1.0 + 1e-9).all()


@st.composite
def stiff_rows(draw):
    """Rows of bodies on shafts, some of them rigid, with gear pairs between: inertias, kinds, damping ratio."""
    n = draw(st.integers(3, 7))
    inertias = [10.0 ** draw(st.floats(-5.0, 0.0)) for _ in range(n)]
    kinds = [draw(st.sampled_from(["rigid", "elastic", "gears"])) for _ in range(n - 2)]
    kinds.insert(draw(st.integers(0, n - 2)), "gears")
    return inertias, kinds, draw(st.floats(0.01, 0.5))


def row(inertias, kinds, ratio, stiffness):
    """The row with this stiffness for rigid shafts; damping ratios refer to the bodies that rigid shafts join."""
    bodies = tuple(Body(str(i), j) for i, j in enumerate(inertias))
    rigid = [Shaft(f"s{i}", str(i), str(i + 1), math.inf) for i, kind in enumerate(kinds) if kind == "rigid"]
    joined = joined_inertias(bodies, rigid)
    shafts, meshes = [], []
    for i, kind in enumerate(kinds):
        a, b = str(i), str(i + 1)
        if kind == "gears":
            c = mesh_damping(ratio, 3e8, 0.04, 0.05, joined[a], joined[b])
            meshes.append(Mesh(f"m{i}", a, b, 0.04, 0.05, 40, 50, 3e8, c))
        else:
            k = 1e5 if kind == "elastic" else stiffness
            c = shaft_damping(ratio, k, joined[a], joined[b]) if kind == "elastic" else 0.0
            shafts.append(Shaft(f"s{i}", a, b, k, c))
    return Train(bodies, tuple(shafts), tuple(meshes))


@given(stiff_rows())
def test_rigid_shafts_are_the_limit_of_ever_stiffer_ones(drawn):
    """Increments, natural frequencies and damped eigenvalues; and the same as one body of the joined inertia."""
    inertias, kinds, ratio = drawn
    rigid = row(inertias, kinds, ratio, math.inf)
    omega = 2.0 * np.pi * np.array([1e-2, 10.0, 1e3])
    exact = dynamic_increments(rigid, omega)
    errors = [
        float(np.max(np.abs(dynamic_increments(row(inertias, kinds, ratio, k), omega) / exact - 1.0)))
        for k in (1e14, 1e16)
    ]
    assert errors[1] <= 2e-2 * errors[0] + 1e-12
    assert errors[0] < 1e-4
    # by hand: bodies with rigid shafts between them as one
    heads = [0, *(i + 1 for i, kind in enumerate(kinds) if kind != "rigid")]
    sums = [sum(inertias[a:b]) for a, b in zip(heads, [*heads[1:], len(inertias)], strict=True)]
    one = row(sums, [kind for kind in kinds if kind != "rigid"], ratio, math.inf)
    assert dynamic_increments(one, omega) == pytest.approx(exact, rel=1e-12)
    assert modes(one).frequencies == pytest.approx(modes(rigid).frequencies, rel=1e-12)
    assert np.abs(damped_eigenvalues(one)) == pytest.approx(np.abs(damped_eigenvalues(rigid)), rel=1e-9)


@given(powers(-5.0, 0.0), powers(-5.0, 0.0), powers(-5.0, 0.0), powers(-5.0, 0.0), st.floats(0.01, 0.9))
def test_a_damping_ratio_is_that_of_the_mode_when_shafts_are_rigid(motor, gear_1, gear_2, load, ratio):
    """Motor, gear, gear and load on rigid shafts swing as one oscillator, with the damping ratio that was asked for."""
    train = row([motor, gear_1, gear_2, load], ["rigid", "gears", "rigid"], ratio, math.inf)
    swinging = damped_eigenvalues(train)[-1]
    assert -swinging.real / abs(swinging) == pytest.approx(ratio, rel=1e-9)
