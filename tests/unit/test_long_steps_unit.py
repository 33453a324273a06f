"""Long steps of a motion, uncompiled: collocation against exact solutions, its tables, elimination and series."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import legendre, polynomial
from scipy.linalg import expm

from fegear.dynamics.motion.kernel import COMPILED, collocation
from fegear.dynamics.motion.kernel.arrays import Collocation
from fegear.dynamics.motion.kernel.collocation import _long_loads, _solve, _to_powers, collocate
from fegear.dynamics.motion.kernel.series import _damping_series, damping_at, swing_at
from fegear.dynamics.motion.radau import STAGES, radau

TABLE = radau()


@pytest.fixture(autouse=True)
def uncompiled(monkeypatch):
    """Functions call each other as plain Python, whatever an earlier test of the process had compiled."""
    for module in COMPILED:
        for name, one in list(vars(module).items()):
            if hasattr(one, "py_func"):
                monkeypatch.setattr(module, name, one.py_func)


# ---- tables ----------------------------------------------------------------------------------------------------------
def test_integrals_to_the_nodes_are_exact_for_polynomials_below_the_stages():
    assert STAGES == TABLE.nodes.size == 10
    assert TABLE.nodes[-1] == 1.0
    assert (np.diff(TABLE.nodes, prepend=0.0) > 0.0).all()
    for power in range(STAGES):
        np.testing.assert_allclose(
            TABLE.integrate @ TABLE.nodes**power, TABLE.nodes ** (power + 1) / (power + 1), atol=1e-14
        )
    # The last row is a rule of quadrature of order 2 S - 1 (Radau).
    for power in range(2 * STAGES - 1):
        assert TABLE.integrate[-1] @ TABLE.nodes**power == pytest.approx(1.0 / (power + 1), rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_values_at_zero_and_the_nodes_become_powers_of_time(seed):
    chance = np.random.default_rng(seed)
    row, h = chance.normal(size=STAGES + 1), float(chance.uniform(0.3, 3.0))
    values = polynomial.polyval(h * np.append(0.0, TABLE.nodes), row)
    out = np.full(STAGES + 4, 7.0)
    last = _to_powers(TABLE, values, h, out)
    np.testing.assert_allclose(out * h ** np.arange(out.size), np.append(row, [0.0] * 3) * h ** np.arange(out.size),
                               atol=1e-7 * np.abs(values).max())  # fmt: skip
    shifted = legendre.poly2leg(polynomial.Polynomial(row)(polynomial.Polynomial([0.5 * h, 0.5 * h])).coef)
    assert last == pytest.approx(np.abs(shifted[-2:]).max(), rel=1e-8)
    (few,) = (Collocation(*(np.asarray(part) for part in radau(3))),)
    assert _to_powers(few, np.array([1.0, 1.0, 1.0, 1.0]), h, np.empty(5)) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_elimination_changes_rows_and_gives_up_where_there_is_no_solution(seed):
    chance = np.random.default_rng(seed)
    matrix, right = chance.normal(size=(5, 5)), chance.normal(size=(5, 2))
    matrix[0, 0] = matrix[2, 1] = 0.0
    wanted, solution = np.linalg.solve(matrix, right), right.copy()
    assert _solve(matrix.copy(), solution)
    np.testing.assert_allclose(solution, wanted, rtol=1e-9, atol=1e-11)
    singular = matrix.copy()
    singular[3] = 0.0
    assert not _solve(singular, right.copy())
    assert not _solve(np.full((2, 2), np.nan), np.ones((2, 1)))


# ---- a step ----------------------------------------------------------------------------------------------------------
TOLERANCE = 1e-10


def drive(stiffness=3.0, damping=0.4, *, touching=True, levers=(0.0, 0.0), momentary=0, free=(0, 0)):
    """Two coordinates with a gear pair between them, whose separation grows evenly; one line of a force that swings."""
    train = SimpleNamespace(
        K=np.array([[2.0, -0.5], [-0.5, 1.0]]), C=np.array([[0.3, 0.1], [0.1, 0.2]]), f=np.array([0.7, -0.2]),
        free=np.array(free), swing=np.array([[0.6, 0.0]]), swing_rate=np.array([0.9]), swing_phase=np.array([0.4]),
    )  # fmt: skip
    meshes = SimpleNamespace(
        approach=np.array([[1.0, -2.0]]), lever=np.array([[[0.3, 0.0], [0.0, 0.5]]]), damping=np.array([damping]),
        stiffness=np.array([stiffness]), momentary=np.array([momentary]),
    )  # fmt: skip
    springs = SimpleNamespace(mesh_of=np.array([0]))
    length = STAGES + 3
    work = SimpleNamespace(
        X=np.zeros((length, 2, 2)), load=np.full((1, length, 1), 9.0), slide=np.full((1, length), 9.0),
        rub=np.full((1, length), 9.0),
        local=np.array([[[stiffness, 0.0], [0.2, 0.05], [levers[0], 0.0], [levers[1], 0.0]]]),
    )  # fmt: skip
    return train, meshes, springs, SimpleNamespace(tolerance=TOLERANCE), TABLE, work, np.array([int(touching)])


X0, V0 = np.array([[0.4, 1.0], [-0.3, 0.5]]), np.array([[0.1, 0.0], [0.2, -1.0]])


def exact(parts, t, start):
    """The state at a time of the step, of all linear: by the exponential of a matrix with time and both waves in it."""
    train, meshes, _, _, _, work, status = parts
    k, rub = work.local[0, 0, 0] * status[0], meshes.damping[0] * status[0]
    a = meshes.approach[0]
    push = a - work.local[0, 2, 0] * meshes.lever[0, 0] - work.local[0, 3, 0] * meshes.lever[0, 1]
    K, C = train.K + k * np.outer(push, a), train.C + rub * np.outer(a, a)
    rate, phase = train.swing_rate[0], train.swing_phase[0]
    whole = np.zeros((8, 8))  # x, v, 1, t, cos, sin
    whole[:2, 2:4] = np.eye(2)
    whole[2:4, :2], whole[2:4, 2:4] = -K, -C
    whole[2:4, 4] = train.f + push * k * work.local[0, 1, 0]
    whole[2:4, 5] = push * k * work.local[0, 1, 1]
    whole[2:4, 6] = train.swing[0]
    whole[5, 4], whole[6, 7], whole[7, 6] = 1.0, -rate, rate
    at = rate * start + phase
    first = np.concatenate([X0[:, 0], V0[:, 0], [1.0, 0.0, math.cos(at), math.sin(at)]])
    second = np.concatenate([X0[:, 1], V0[:, 1], np.zeros(4)])
    return np.stack([(expm(whole * t) @ one)[:4] for one in (first, second)], axis=1)


@pytest.mark.parametrize("more", [{}, {"touching": False}, {"levers": (0.2, -0.1)}, {"momentary": 1}])
def test_a_step_follows_the_exact_motion_and_its_tangents(more):
    parts, h, start = drive(**more), 0.2, 1.7
    work, status = parts[5], parts[6]
    assert collocate(*parts, X0, V0, h, start)
    for t in (0.0, 0.3 * h, h):
        wanted = exact(parts, t, start)
        found = np.array([[polynomial.polyval(t, work.X[:, i, c]) for c in range(2)] for i in range(2)])
        np.testing.assert_allclose(found, wanted[:2], atol=1e-10)
        rate = np.array([polynomial.polyval(t, polynomial.polyder(work.X[:, i, 0])) for i in range(2)])
        # Force of the spring on flanks so far beyond their separation, and of the damper between them.
        spring, damper = work.load[0, :, 0], work.slide[0]
        pressed = parts[1].approach[0] @ wanted[:2, 0] - (0.2 + 0.05 * t)
        assert polynomial.polyval(t, spring) == pytest.approx(3.0 * status[0] * pressed, abs=1e-9)
        assert polynomial.polyval(t, damper) == pytest.approx(0.4 * status[0] * (parts[1].approach[0] @ rate), abs=1e-7)


def test_a_step_too_long_for_what_vibrates_is_none():
    assert collocate(*drive(), X0, V0, 0.2, 0.0)
    assert not collocate(*drive(), X0, V0, 12.0, 0.0)
    assert not collocate(*drive(stiffness=3e4), X0, V0, 0.2, 0.0)
    # Rigid motion does not count in its own column, its rate does; a tangent always counts.
    assert not collocate(*drive(free=(1, 1)), X0, V0, 12.0, 0.0)


def test_a_step_whose_matrix_has_no_solution_or_whose_loads_miss_the_tolerance_is_none(monkeypatch):
    parts = drive()
    parts[0].K[0, 0] = np.nan
    assert not collocate(*parts, X0, V0, 0.2, 0.0)
    monkeypatch.setattr(collocation, "_long_loads", lambda *given: False)
    assert not collocate(*drive(), X0, V0, 0.2, 0.0)


def test_loads_of_a_spring_that_jumps_within_the_step_miss_the_tolerance():
    _, meshes, springs, _, table, work, status = drive()
    nodes = np.append(0.0, table.nodes)
    path = np.zeros((nodes.size, 2, 1))
    path[:, 0, 0] = 1.0 + nodes
    speed = np.zeros_like(path)
    speed[:, 0, 0] = 2.0
    assert _long_loads(meshes, springs, table, work, status, path, speed, 1.0, 1e-10)
    np.testing.assert_allclose(work.load[0, :2, 0], [3.0 * 0.8, 3.0 * 0.95], atol=1e-10)
    np.testing.assert_allclose(work.slide[0, :2], [0.8, 0.0], atol=1e-10)
    for part in (path, speed):
        part[6:, 0, 0] += 0.5
        assert not _long_loads(meshes, springs, table, work, status, path, speed, 1.0, 1e-10)
        assert _long_loads(meshes, springs, table, work, status, path, speed, 1.0, 1e3)
        part[6:, 0, 0] -= 0.5


# ---- damping of the teeth that touch ---------------------------------------------------------------------------------
def pairs(status, *, momentary=1):
    """One gear pair with two springs that change their stiffness; damping 0.6 at a mean stiffness of 4."""
    meshes = SimpleNamespace(
        approach=np.ones((1, 2)), damping=np.array([0.6]), stiffness=np.array([4.0]), momentary=np.array([momentary])
    )
    springs = SimpleNamespace(mesh_of=np.array([0, 0]))
    local = np.zeros((2, 4, 3))
    local[0, 0], local[1, 0] = (3.0, 0.5, -0.2), (2.0, -0.3, 0.1)
    work = SimpleNamespace(local=local, rub=np.full((1, 8), 5.0))
    return meshes, springs, work, np.array(status)


@pytest.mark.parametrize("status", [(1, 1), (1, 0), (0, 1), (0, 0)])
def test_damping_follows_the_square_root_of_the_stiffness_of_what_touches(status):
    meshes, springs, work, which = pairs(status)
    _damping_series(meshes, springs, work, which)
    for t in (0.0, 0.1, 0.2):
        total = sum(polynomial.polyval(t, work.local[s, 0]) for s in (0, 1) if status[s])
        wanted = 0.6 * math.sqrt(total / 4.0)
        assert damping_at(meshes, springs, work, which, 0, t) == pytest.approx(wanted)
        assert polynomial.polyval(t, work.rub[0] if any(status) else [0.0]) == pytest.approx(wanted, rel=1e-7)
    constant = pairs(status, momentary=0)
    _damping_series(*constant)
    assert constant[2].rub[0, 0] == damping_at(*constant, 0, 0.1) == (0.6 if any(status) else 0.0)
    assert constant[2].rub[0, 1] == 5.0  # of a constant only the first is read


def test_springs_without_stiffness_damp_nothing():
    parts = pairs((1, 1))
    parts[2].local[:, 0, 0] = -1.0
    _damping_series(*parts)
    assert parts[2].rub[0, 0] == 0.0
    assert damping_at(*parts, 0, 0.0) == 0.0


def test_forces_that_swing_are_the_sum_of_their_lines():
    train = SimpleNamespace(
        swing=np.array([[1.0, 2.0], [3.0, 4.0]]), swing_rate=np.array([0.5, 2.0]), swing_phase=np.array([0.1, 0.2])
    )
    for i, (a, b) in enumerate(((1.0, 3.0), (2.0, 4.0))):
        assert swing_at(train, i, 0.7) == pytest.approx(a * math.cos(0.45) + b * math.cos(1.6))
