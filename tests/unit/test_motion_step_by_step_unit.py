"""The loop of motion as plain Python: trains of one or two coordinates against another integrator, line by line.

As machine code it leaves no trace of what runs, and a change of it takes minutes to compile.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from fegear.dynamics.motion import kernel
from fegear.dynamics.motion.kernel.arrays import DONE, TOO_MANY_EVENTS, TOO_MANY_STEPS
from fegear.dynamics.motion.kernel.integration import travel as compiled_or_plain
from fegear.dynamics.motion.radau import radau

PLAIN = getattr(compiled_or_plain, "py_func", compiled_or_plain)


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    """Undo what an earlier test of this process may have compiled."""
    for module in kernel.COMPILED:
        for name, one in list(vars(module).items()):
            if hasattr(one, "py_func"):
                monkeypatch.setattr(module, name, one.py_func)


def train(K, C, f, swing=(), swing_rate=(), swing_phase=(), free=None):
    n = len(f)
    return kernel.TrainArrays(
        np.array(K, float), np.array(C, float), np.array(f, float),
        np.ones(n, np.int64) if free is None else np.array(free, np.int64),
        np.array(swing, float).reshape(-1, n), np.array(swing_rate, float), np.array(swing_phase, float),
    )  # fmt: skip


def meshes(approach, damping, stiffness, momentary, lever=None):
    approach = np.array(approach, float)
    lever = np.zeros((len(approach), 2, approach.shape[1])) if lever is None else np.array(lever, float)
    return kernel.MeshArrays(
        approach, lever, np.array(damping, float), np.array(stiffness, float), np.array(momentary, np.int64)
    )


def springs(mesh_of, side, rate, phase, cuts, poly):
    first = np.concatenate([[0], np.cumsum([len(one) - 1 for one in cuts])]).astype(np.int64)
    return kernel.SpringArrays(
        np.array(mesh_of, np.int64), np.array(side, float), np.array(rate, float), np.array(phase, float), first,
        np.concatenate(cuts).astype(float), np.concatenate(poly).astype(float),
    )  # fmt: skip


def moved(parts, x0, v0, until, start=0.0, *, columns=1, status=None, **rule):
    """Travel; what came of it, with the contact in the end."""
    of_train, of_meshes, of_springs = parts
    given = kernel.Rule(
        **{"order": 10, "tolerance": 1e-10, "longest": 0.5, "max_steps": 4000, "want_peaks": True, "keep": 0,
           "friction": True} | rule
    )  # fmt: skip
    n = len(x0)
    x, v = np.zeros((n, columns)), np.zeros((n, columns))
    x[:, 0], v[:, 0] = x0, v0
    if columns > 1:
        x[:, 1 : n + 1], v[:, n + 1 :] = np.eye(n), np.eye(n)
    pushes = np.zeros(len(of_springs.side), np.int8) if status is None else status
    found = PLAIN(of_train, of_meshes, of_springs, radau(), given, x, v, start, until, pushes, status is None)
    return kernel.Travelled(*found), pushes


class Reference:
    """The same equations at one time and state, from the arrays, as the docstrings of them have it."""

    def __init__(self, parts):
        self.train, self.meshes, self.springs = parts

    def spring(self, s, t):
        """Stiffness, separation and friction torques of a spring; whether it exists there."""
        one = self.springs
        u = (one.rate[s] * t + one.phase[s]) % 1.0
        own = _cuts(one, s)
        piece = min(np.searchsorted(own, u, side="right") - 1, own.size - 2)
        rows = one.poly[one.first[s] + piece]
        at = 2.0 * (u - own[piece]) / (own[piece + 1] - own[piece]) - 1.0
        return *(rows @ at ** np.arange(rows.shape[1])), bool(rows[0].any())

    def forces(self, t, x, v):
        """Elastic loads of the springs, whether they push, and damping forces of the meshes."""
        load, pushes = np.zeros(len(self.springs.side)), np.zeros(len(self.springs.side), bool)
        touched = np.zeros(len(self.meshes.damping))
        for s, (m, side) in enumerate(zip(self.springs.mesh_of, self.springs.side, strict=True)):
            stiffness, separation, _, _, exists = self.spring(s, t)
            gap = self.meshes.approach[m] @ x - separation
            if exists and (side == 0.0 or side * gap > 0.0):
                load[s], pushes[s] = stiffness * gap, True
                touched[m] += stiffness
        damped = np.zeros(len(touched))
        for m, sum_of_stiffness in enumerate(touched):
            if pushes[self.springs.mesh_of == m].any():
                grown = math.sqrt(sum_of_stiffness / self.meshes.stiffness[m]) if self.meshes.momentary[m] else 1.0
                damped[m] = self.meshes.damping[m] * grown * (self.meshes.approach[m] @ v)
        return load, pushes, damped

    def slopes(self, t, state):
        x, v = np.split(state, 2)
        load, _, damped = self.forces(t, x, v)
        force = self.train.f - self.train.K @ x - self.train.C @ v - self.meshes.approach.T @ damped
        for line, rate, phase in zip(self.train.swing, self.train.swing_rate, self.train.swing_phase, strict=True):
            force = force + line * math.cos(rate * t + phase)
        for s, m in enumerate(self.springs.mesh_of):
            at_a, at_b = self.spring(s, t)[2:4]
            force = force - self.meshes.approach[m] * load[s]
            force = force + (self.meshes.lever[m, 0] * at_a + self.meshes.lever[m, 1] * at_b) * load[s]
        return np.concatenate([v, force])

    def run(self, x0, v0, start, until):
        """State at many times."""
        times = np.linspace(start, until, 401)
        found = solve_ivp(
            self.slopes, (start, until), [*x0, *v0], method="RK45", rtol=1e-7, atol=1e-8, max_step=0.06, t_eval=times
        )  # fmt: skip
        return times, *np.split(found.y.T, 2, axis=1)


NO_MESHES = (
    meshes(np.zeros((0, 2)), [], [], []),
    springs([], [], [], [], [np.zeros(0)], [np.zeros((0, 4, 1))])._replace(first=np.zeros(1, np.int64)),
)


def test_two_coupled_coordinates_without_teeth_move_as_the_exponential_of_their_matrix():
    K, C, f = np.array([[3.0, -1.0], [-1.0, 2.0]]), np.array([[0.2, -0.05], [-0.05, 0.1]]), np.array([0.4, -0.3])
    x0, v0, until = np.array([0.3, -0.2]), np.array([0.5, 0.8]), 2.3
    found, _ = moved((train(K, C, f), *NO_MESHES), x0, v0, until, columns=5, keep=200)
    matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-K, -C]])
    after, rest = expm(until * matrix), np.linalg.solve(K, f)
    expected = after @ np.concatenate([x0 - rest, v0]) + np.concatenate([rest, [0.0, 0.0]])
    assert np.concatenate([found.x[:, 0], found.v[:, 0]]) == pytest.approx(expected, abs=1e-9)
    assert np.vstack([found.x[:, 1:], found.v[:, 1:]]) == pytest.approx(after, abs=1e-9)
    assert (found.code, found.changes) == (DONE, 0)
    # The record: polynomials that go on from one another, from the start to the end.
    times, rows = found.times[: found.steps + 1], found.polynomials[: found.steps]
    assert (times[0], times[-1]) == (0.0, until)
    assert (np.diff(times) > 0.0).all()
    ends = [sum(row[k] * h**k for k in range(len(row))) for row, h in zip(rows, np.diff(times), strict=True)]
    assert rows[0, :2] == pytest.approx(np.stack([x0, v0]))
    assert np.array(ends[:-1]) == pytest.approx(rows[1:, 0], abs=1e-12)
    assert ends[-1] == pytest.approx(found.x[:, 0], abs=1e-12)


def test_a_force_that_swings_moves_the_train_as_a_closed_form_has_it():
    # x'' = a cos(w t + p), from rest at time s: v = a/w (sin(wt+p) - sin(ws+p)).
    lines = [[0.7, 0.0], [0.0, -0.4]], [3.0, 1.2], [0.4, -0.9]
    start, until = 0.6, 2.9
    still = train(np.zeros((2, 2)), np.zeros((2, 2)), [0.0, 0.0], *lines, free=[0, 0])
    found, _ = moved((still, *NO_MESHES), [0.1, 0.2], [0.0, 0.0], until, start)
    for i, (a, w, p) in enumerate(((0.7, 3.0, 0.4), (-0.4, 1.2, -0.9))):
        at, first = w * until + p, w * start + p
        assert found.v[i, 0] == pytest.approx(a / w * (math.sin(at) - math.sin(first)), abs=1e-9)
        moves = a / w**2 * (math.cos(first) - math.cos(at)) - a / w * math.sin(first) * (until - start)
        assert found.x[i, 0] == pytest.approx((0.1, 0.2)[i] + moves, abs=1e-9)


def one_mesh(momentary, friction=0.0, damping=0.3):
    """Two front springs of unlike halves of a period, and a back flank; beside them a mesh that never parts."""
    front = np.zeros((2, 4, 3))
    front[0, 0], front[1, 0] = [2.0, 0.5, -0.2], [1.4, -0.3, 0.0]
    front[0, 1], front[1, 1] = [0.05, 0.1, 0.02], [-0.04, 0.03, 0.0]
    front[:, 2], front[:, 3] = [friction, 0.2 * friction, 0.0], [-0.5 * friction, 0.0, 0.0]
    second = np.zeros((3, 4, 3))  # none in the middle third
    second[0, 0], second[2, 0] = [0.9, 0.4, 0.1], [1.1, -0.2, 0.0]
    second[:, 1] = [0.02, -0.06, 0.0]
    second[:, 2] = [0.6 * friction, 0.0, 0.0]
    back, always = np.zeros((1, 4, 3)), np.zeros((1, 4, 3))
    back[0, :2, 0], always[0, :2, 0] = [2.5, -0.5], [1.7, 0.1]
    of_springs = springs(
        [0, 0, 0, 1], [1.0, 1.0, -1.0, 0.0], [0.31, 0.31, 0.31, 0.2], [0.15, 0.65, 0.0, 0.0],
        [[0.0, 0.45, 1.0], [0.0, 0.3, 0.7, 1.0], [0.0, 1.0], [0.0, 1.0]], [front, second, back, always],
    )  # fmt: skip
    of_meshes = meshes(
        [[1.0, 0.6], [-0.3, 0.8]], [damping, 0.1], [2.2, 1.7], [momentary, 0],
        [[[0.4, -0.2], [0.1, 0.3]], [[0.0, 0.0], [0.0, 0.0]]],
    )  # fmt: skip
    whole = train([[0.3, 0.05], [0.05, 0.4]], [[0.02, 0.0], [0.0, 0.03]], [0.5, 0.2], [[0.9, 0.1]], [2.1], [0.3])
    return whole, of_meshes, of_springs


@pytest.mark.parametrize(("momentary", "friction"), [(0, 0.0), (1, 0.3)])
def test_teeth_that_part_and_meet_move_as_another_integrator_has_it(momentary, friction):
    parts, x0, v0, start, until = one_mesh(momentary, friction), [0.4, -0.1], [-1.6, -1.2], 0.2, 3.7
    found, pushes = moved(parts, x0, v0, until, start, friction=friction > 0.0)
    reference = Reference(parts)
    times, x, v = reference.run(x0, v0, start, until)
    assert found.x[:, 0] == pytest.approx(x[-1], abs=1e-4)
    assert found.v[:, 0] == pytest.approx(v[-1], abs=1e-4)
    every = [reference.forces(*one) for one in zip(times, x, v, strict=True)]
    load, contact = np.array([one[0] for one in every]), np.array([one[1] for one in every])
    total = np.stack([load[:, :3].sum(axis=1), load[:, 3]], axis=1) + np.array([one[2] for one in every])
    assert pushes.tolist() == contact[-1].astype(int).tolist()
    front, back = contact[:, :2].any(axis=1), contact[:, 2]
    share = np.array([(~front & ~back).mean(), back.mean()]) * (until - start)
    assert (share > 0.2).all()  # both happen
    assert [found.apart[0], found.behind[0]] == pytest.approx(share, abs=0.02)
    assert found.apart[1] == found.behind[1] == 0.0
    assert found.high == pytest.approx(total.max(axis=0), abs=5e-3)
    assert found.low == pytest.approx(total.min(axis=0), abs=5e-3)
    # Changes but those at break points, at which springs begin to exist and cease to.
    change = np.diff(contact[:, :3], axis=0)
    turn = (parts[2].rate[:3] * times[:-1, None] + parts[2].phase[:3]) % 1.0
    further = turn + parts[2].rate[:3] * np.diff(times)[0]
    broken = [np.searchsorted(_cuts(parts[2], s), (turn[:, s], further[:, s])) for s in range(3)]
    at_cut = np.stack([first != last for first, last in broken], axis=1)
    assert np.count_nonzero(change & ~at_cut) == found.changes >= 5
    # Each tooth carries its share of the damping force.
    signed = load[:, :3] * [1.0, 1.0, -1.0]
    pushing = np.where(signed > 0.0, signed, 0.0)
    damped = np.abs(total[:, 0])[:, None] * pushing / np.maximum(pushing.sum(axis=1), 1e-9)[:, None]
    against = np.sign(total[:, 0])[:, None] * [1.0, 1.0, -1.0] > 0.0
    assert found.tooth[:3] == pytest.approx(np.where(against, damped, 0.0).max(axis=0), abs=5e-3)


def _cuts(of_springs, s):
    return of_springs.cuts[of_springs.first[s] + s : of_springs.first[s + 1] + s + 1]


def test_tangents_are_slopes_of_the_motion_through_changes_of_contact():
    parts, x0, v0, until = one_mesh(0, 0.2), np.array([0.4, -0.1]), np.array([-1.6, -1.2]), 2.5
    found, _ = moved(parts, x0, v0, until, columns=5, want_peaks=False)
    assert found.changes >= 3
    tangent, step = np.vstack([found.x[:, 1:], found.v[:, 1:]]), 1e-5
    for k in range(4):
        ends = []
        for sign in (1.0, -1.0):
            state = np.concatenate([x0, v0])
            state[k] += sign * step
            end, _ = moved(parts, *np.split(state, 2), until, want_peaks=False)
            ends.append(np.concatenate([end.x[:, 0], end.v[:, 0]]))
        assert tangent[:, k] == pytest.approx((ends[0] - ends[1]) / (2.0 * step), abs=2e-4)


def test_a_run_goes_on_from_where_an_earlier_one_ended():
    parts, x0, v0 = one_mesh(1, 0.3), [0.4, -0.1], [-1.6, -1.2]
    whole, at_end = moved(parts, x0, v0, 3.0)
    half, status = moved(parts, x0, v0, 1.7)
    rest, status = moved(parts, half.x[:, 0], half.v[:, 0], 3.0, 1.7, status=status)
    assert rest.x == pytest.approx(whole.x, abs=1e-8)
    assert rest.v == pytest.approx(whole.v, abs=1e-8)
    assert status.tolist() == at_end.tolist()
    assert half.changes + rest.changes == whole.changes
    assert np.maximum(half.high, rest.high) == pytest.approx(whole.high)
    assert half.apart + rest.apart == pytest.approx(whole.apart)


def test_without_contact_nothing_is_looked_for_and_apart_is_all_of_the_time():
    still = train(np.zeros((1, 1)), np.zeros((1, 1)), [0.0])
    spring = np.zeros((1, 4, 1))
    spring[0, 0, 0], spring[0, 1, 0] = 1.0, 2.0
    parts = still, meshes([[1.0]], [0.1], [1.0], [0]), springs([0], [1.0], [0.1], [0.0], [[0.0, 1.0]], [spring])
    found, status = moved(parts, [0.5], [0.25], 3.0, longest=10.0)
    assert found.x[0, 0] == pytest.approx(1.25)
    assert (found.apart[0], found.high[0], found.low[0], found.changes) == (pytest.approx(3.0), 0.0, 0.0, 0)
    assert not status.any()
    later, status = moved(parts, [0.5], [0.5], 3.0 + math.pi, longest=10.0, friction=False)
    # It meets the tooth at 3 with half a unit of speed.
    assert status.tolist() == [1]
    assert later.apart[0] == pytest.approx(3.0, abs=1e-9)
    damped = math.sqrt(1.0 - 0.05**2)
    elapsed = math.pi
    at = 0.5 / damped * math.exp(-0.05 * elapsed) * math.sin(damped * elapsed)
    assert later.x[0, 0] == pytest.approx(2.0 + at, abs=1e-9)


def test_too_many_steps_and_too_many_changes_end_a_run_with_their_code():
    parts = one_mesh(0)
    still = train([[1.0]], [[0.0]], [0.0]), meshes(np.zeros((0, 1)), [], [], []), NO_MESHES[1]
    few, _ = moved(still, [0.4], [0.0], 6.0, max_steps=3)
    assert (few.code, few.steps) == (TOO_MANY_STEPS, 3)
    often, _ = moved(parts, [0.4, -0.1], [-1.6, -1.2], 6.0, max_steps=20, longest=10.0, tolerance=1e-3)
    assert often.code == TOO_MANY_EVENTS
    assert often.changes == 6


def test_a_vibration_that_has_died_away_leaves_few_long_steps():
    # x'' = -9 x - 12 x' + cos(w t): its slow part is Re(e^{iwt} / (9 - w^2 + 12 i w)).
    w, until = 0.02, 1200.0
    parts = train([[9.0]], [[12.0]], [0.0], [[1.0]], [w], [0.3]), meshes(np.zeros((0, 1)), [], [], []), NO_MESHES[1]
    rule = {"order": 20, "tolerance": 1e-9, "longest": math.inf}
    found, _ = moved(parts, [0.4], [0.0], until, keep=400, **rule)
    slow = np.exp(1j * (w * until + 0.3)) / (9.0 - w**2 + 12.0j * w)
    assert [found.x[0, 0], found.v[0, 0]] == pytest.approx([slow.real, (1j * w * slow).real], abs=1e-8)
    steps = np.diff(found.times[: found.steps + 1])
    short = moved(parts, [0.4], [0.0], 20.0, order=20, tolerance=1e-9, longest=1e3)[0]
    assert steps.max() > 40.0 * 20.0 / short.steps  # none is worth it below
    assert found.steps < 0.25 * until / 20.0 * short.steps
    assert found.times[found.steps] == until
    for row, time in zip(found.polynomials[: found.steps], found.times, strict=False):
        if time > 60.0:
            slow = np.exp(1j * (w * time + 0.3)) / (9.0 - w**2 + 12.0j * w)
            assert row[:2, 0] == pytest.approx([slow.real, (1j * w * slow).real], abs=1e-8)


def test_a_long_step_carries_tangents():
    parts = train([[9.0]], [[12.0]], [1.0]), meshes(np.zeros((0, 1)), [], [], []), NO_MESHES[1]
    found, _ = moved(
        parts, [0.4], [0.0], 300.0, columns=3, order=20, tolerance=1e-9, longest=math.inf, want_peaks=False
    )
    few = moved(parts, [0.4], [0.0], 300.0, columns=3, order=20, tolerance=1e-9, longest=1e3, want_peaks=False)[0]
    assert found.steps < 0.5 * few.steps
    after = expm(300.0 * np.array([[0.0, 1.0], [-9.0, -12.0]]))
    assert np.vstack([found.x[:, 1:], found.v[:, 1:]]) == pytest.approx(after, abs=1e-9)
    assert found.x[0, 0] == pytest.approx(1.0 / 9.0, abs=1e-9)


def test_a_record_that_is_full_keeps_the_first_steps():
    parts = one_mesh(0)
    whole, _ = moved(parts, [0.4, -0.1], [-1.6, -1.2], 2.0, keep=200)
    few, _ = moved(parts, [0.4, -0.1], [-1.6, -1.2], 2.0, keep=5)
    assert whole.steps == few.steps > 5
    assert few.times.tolist() == whole.times[:6].tolist()
    assert few.polynomials.tolist() == whole.polynomials[:5].tolist()
    assert few.contact.tolist() == whole.contact[:5].tolist()
    # Contact changes from step to step as the motion reports it.
    assert np.abs(np.diff(whole.contact[: whole.steps], axis=0)).sum() >= whole.changes
