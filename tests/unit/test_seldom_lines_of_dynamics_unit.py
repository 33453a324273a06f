"""Lines of the dynamics that only long runs come to, each by a law of its own: made-up parts in place of the run."""

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import ConvergenceError, InputError, RangeError
from fegear.contact.plane.sidebands import without_mesh_harmonics
from fegear.dynamics.compound import mesh_phases
from fegear.dynamics.compound.compound_set import Shaft
from fegear.dynamics.helical_pair import mode_following
from fegear.dynamics.helical_pair.mode_following import _nearest_approach, _State
from fegear.dynamics.motion import coexisting, motion, motion_over_revolution, shooting, steady_state
from fegear.dynamics.motion.motion import Trajectory, propagate
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.packed_model import pack
from fegear.dynamics.motion.shooting import floquet_frame
from fegear.dynamics.planetary.kinematics import CENTRALS
from fegear.dynamics.planetary.mesh_law import MeshSprings, WidenedSprings
from fegear.dynamics.planetary.one_sided import equilibrium
from fegear.dynamics.planetary.set_motion import SetMotion
from fegear.dynamics.planetary.set_motion_over_revolution import set_motion_over_revolution
from fegear.dynamics.planetary.steady_modes import on_common_pieces
from fegear.dynamics.train import charts
from fegear.dynamics.train.back_flanks import BackFlanks
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.friction import with_friction
from fegear.dynamics.train.network import Link, Network, Slip
from fegear.dynamics.train.one_cause import _fitted
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.segments import lags_by_pivots
from fegear.dynamics.train.torque_response import _ways
from fegear.dynamics.train.train import Body, Mesh, Torque, Train

K, FORCE, R, J = 2e8, 500.0, 0.05, 2e-3


def wave(mean, depth, phase=0.0):
    return Periodic.fit(lambda s: mean * (1.0 + depth * np.cos(2.0 * np.pi * s + phase)), degree=12, tolerance=1e-9)


# ---- trains ----------------------------------------------------------------------------------------------------------
def test_the_even_stiffness_of_back_flanks_is_the_reverse_of_the_mean_compliance():
    """Of K (1 + d cos) that is K sqrt(1 - d^2)."""
    even = BackFlanks(wave(K, 0.6), 0.3).even
    assert even.shift == 0.3
    assert even.stiffness(np.array([0.0, 0.2, 0.7])) == pytest.approx([0.8 * K] * 3, rel=1e-9)


def test_a_break_that_is_one_with_the_end_of_a_period_makes_no_piece():
    found = Periodic.fit(lambda s: s * (1.0 - s), breaks=(0.5, 0.5 + 5e-13, 1.0 - 5e-13, 5e-13), degree=4)
    assert found.breaks == pytest.approx([0.0, 0.5, 1.0], abs=0.0)
    # not so near, it does
    assert Periodic.fit(lambda s: s * (1.0 - s), breaks=(0.5, 1.0 - 1e-11), degree=4).breaks.size == 4


def test_what_a_link_s_angle_is_the_sum_of():
    """Angles of nodes of any size: links of the tree are their own, others add up to nothing round their loop."""
    ends = [(0, 1), (2, 1), (2, 3), (3, 0), (4, 2), (4, 4), (1, 4)]
    stiff = [1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0]  # the third, a damper only, is the last to be on the tree
    links = [Link(a, b, np.float64(k), np.float64(1.0), -1) for (a, b), k in zip(ends, stiff, strict=True)]
    rows = _ways(links, 5)
    angles = np.random.default_rng(1).normal(size=5)
    own = np.array([angles[a] - angles[b] for a, b in ends])
    on_tree = np.count_nonzero(rows, axis=1) == 1
    assert on_tree.tolist() == [True, True, False, True, True, True, False]
    np.testing.assert_allclose(rows @ own, np.where(on_tree, own, 0.0), atol=1e-12)
    np.testing.assert_array_equal(np.diag(rows), 1.0)


def test_lags_by_pivots_are_those_of_the_equations_with_dampers_that_slip():
    """Two gear pairs and a damper on 2 q_0 - 0.5 q_2, solved as they stand in doubles."""
    mass, ground = np.array([2.0, 3.0, 0.7]), np.array([0.1, 0.0, 0.3])
    links = ((0, 1, 400.0, 1.5), (1, 2, 900.0, 0.4))
    slips = ((0, 2, 2.0, -0.5, 7.0), (1, 0, 1.0, 3.0, 0.2))
    turns, long = np.array([0.5, 2.0]), np.longdouble
    network = Network(
        3, mass.astype(long), ground.astype(long),
        tuple(Link(a, b, long(k), long(c), mesh) for mesh, (a, b, k, c) in enumerate(links)),
        tuple(Slip(a, b, long(p), long(q), c) for a, b, p, q, c in slips), turns.astype(long),
    )  # fmt: skip
    ways = np.zeros((2, 3))
    for mesh, (a, b, _, _) in enumerate(links):
        ways[mesh, a], ways[mesh, b] = turns[mesh], -turns[mesh]
    at = np.array([3.0, 14.0])
    for mesh in (0, 1):
        found = lags_by_pivots(network, at.astype(long), mesh)
        for n, w in enumerate(at):
            matrix = np.diag(-w * w * mass + 1j * w * ground)
            for a, b, k, c in links:
                of = np.zeros(3)
                of[a], of[b] = 1.0, -1.0
                matrix = matrix + (k + 1j * w * c) * np.outer(of, of)
            for a, b, p, q, c in slips:
                of = np.zeros(3)
                of[a], of[b] = p, q
                matrix = matrix + 1j * w * c * np.outer(of, of)
            exact = ways @ np.linalg.solve(matrix, ways[mesh])
            np.testing.assert_allclose([complex(one.value[n]) for one in found], exact, rtol=1e-11)
            assert all(float(one.error[n]) > 0.0 for one in found)


@pytest.mark.parametrize("power", [0.0, 0.5])
def test_a_cause_that_explains_nothing_changes_nothing(power):
    base = np.array([100.0, 230.0, 410.0])
    found, computed = _fitted(lambda factors: base * np.asarray(factors)[:, None] ** power, base)
    assert found == 1.0
    np.testing.assert_array_equal(computed, base)


def test_a_cause_that_explains_all_is_found():
    base = np.array([100.0, 230.0, 410.0])
    found, computed = _fitted(lambda factors: base * np.asarray(factors)[:, None] ** 0.5, base * 1.2)
    assert found == pytest.approx(1.44, rel=1e-5)
    assert computed == pytest.approx(1.2 * base, rel=1e-5)


@pytest.mark.parametrize("ring_drives", [False, True])
@pytest.mark.parametrize("a_drives", [True, False])
def test_friction_of_an_internal_pair_has_the_levers_of_its_flanks_and_takes_the_sliding_power(ring_drives, a_drives):
    """Radii of curvature r tan(alpha) and x, of the ring less toward its tip; power mu F v |x| (1/r_1 - 1/r_2)."""
    small, large, angle, mu, frequency = 0.04, 0.11, 0.4, 0.05, 600.0
    pitch = 2.0 * math.pi * small / 28
    driver, driven = (large, small) if ring_drives else (small, large)
    one, other = (driver, -driven) if a_drives else (-driven, driver)
    springs = MeshExcitation.from_tooth_pair(
        lambda x: 3e8 * np.ones_like(x), lambda x: np.zeros_like(x), -0.8 * pitch, 0.8 * pitch, pitch
    )
    teeth = (round(abs(radius) * 700.0) for radius in (one, other))
    mesh = Mesh("g", "1", "2", one, other, *teeth, 3e8)
    law = {"a_drives": a_drives, "internal": True}
    found = with_friction(springs, mesh, pitch, angle, frequency, FORCE, lambda *_: mu, **law)
    speed = frequency * pitch
    turning = (speed / one, -speed / other) if a_drives else (-speed / one, speed / other)
    for j, torques in enumerate(found.friction):
        s = np.linspace(0.03, 0.97, 12)
        s = s[found.stiffness[j](s) > 0.0]
        x = (s + found.first_slot + j) * pitch
        power = sum(torque(s) * turns for torque, turns in zip(torques, turning, strict=True))
        np.testing.assert_allclose(power, -mu * speed * np.abs(x) * (1.0 / small - 1.0 / large), rtol=1e-5, atol=1e-8)
        toward_tip = -x if ring_drives else x  # of the ring, whose flanks are hollow, inward
        levers = {small: small * math.tan(angle) + toward_tip, large: large * math.tan(angle) + toward_tip}
        for torque, radius in zip(torques, (one, other), strict=True):
            np.testing.assert_allclose(np.abs(torque(s)), mu * levers[abs(radius)], rtol=1e-5)


@pytest.mark.parametrize(
    ("direction", "start"), [("up", "follow"), ("down", "follow"), ("static", "static"), ("rest", "rest")]
)
def test_a_chart_has_its_speeds_rising_whichever_way_they_were_swept(monkeypatch, direction, start):
    swept = []

    def sweep(model, order, *, start, tolerance):
        swept.append((order.tolist(), start, tolerance))
        return tuple(f"at {speed:g}" for speed in order)

    monkeypatch.setattr(charts, "speed_sweep", sweep)
    monkeypatch.setattr(charts, "SpeedChart", SimpleNamespace(of=lambda *given: given))
    model = SimpleNamespace(static=np.array([-5.0, 40.0, 0.0]))
    speed, states, mesh, force = charts.speed_chart(model, [3.0, 1.0, 2.0], mesh=1, direction=direction, tolerance=1e-5)
    assert (speed.tolist(), states, mesh, force) == ([1.0, 2.0, 3.0], ("at 1", "at 2", "at 3"), 1, 40.0)
    assert swept == [([3.0, 2.0, 1.0] if direction == "down" else [1.0, 2.0, 3.0], start, 1e-5)]
    for idle in (0, 2):
        with pytest.raises(RangeError, match="is the mean force: must be positive"):
            charts.speed_chart(model, [1.0], mesh=idle, direction=direction)
    with pytest.raises(InputError, match="direction"):
        charts.speed_chart(model, [1.0], mesh=1, direction="sideways")


# ---- helical pairs ---------------------------------------------------------------------------------------------------
def test_two_modes_come_nearest_where_their_line_passes_the_origin():
    """Half the difference d and coupling c of two squares: nearest where (d, c) is shortest, apart by twice that."""
    vectors = np.eye(3)[:, [2, 0, 1]]

    def state(value, difference, coupling):
        two = np.array([[5.0 + 0.5 * difference, coupling], [coupling, 5.0 - 0.5 * difference]])
        matrix = np.zeros((3, 3))
        matrix[:2, :2], matrix[2, 2] = two, 99.0
        return _State(value, np.ones(3), vectors, matrix, np.eye(3))

    at, apart = _nearest_approach(state(1.0, -3.0, 0.1), state(3.0, 1.0, 0.1), 1, 2)
    assert (at, apart) == pytest.approx((2.5, 0.2))
    alike = state(1.0, 3.0, 2.0)
    assert _nearest_approach(alike, state(3.0, 3.0, 2.0), 1, 2) == pytest.approx((1.0, 5.0))


def test_branches_that_meet_are_given_up_after_as_many_bisections_as_asked_for(monkeypatch):
    """Shapes that are never alike between 2 and 3: nearer to 2 by halves, nothing of it kept."""
    asked = []

    def modes(build, value):
        asked.append(value)
        return _State(value, np.array([1.0, 2.0]), np.eye(2), np.eye(2), np.eye(2))

    def matched(old, new, together):
        return new, 1.0 if new.value <= 2.0 else 0.3

    monkeypatch.setattr(mode_following, "_modes", modes)
    monkeypatch.setattr(mode_following, "_matched", matched)
    first = modes(None, 0.0)
    path = mode_following._Path(None, first, np.array([1.0, 2.0]), 0.9, 3)
    assert [one.value for one in path.states] == [1.0, 2.0]
    asked.clear()
    with pytest.raises(ConvergenceError, match=r"between 2 and 2.125 \(MAC 0.3 after 3 bisections\)"):
        path._follow(3.0, 3)
    assert asked == [3.0, 2.5, 2.25, 2.125]
    # halves that are alike are kept on the way
    monkeypatch.setattr(mode_following, "_matched", lambda old, new, together: (
        new, 1.0 if abs(new.value - old.value) <= 0.3 else 0.3))  # fmt: skip
    again = mode_following._Path(None, first, np.array([1.0]), 0.9, 2)
    assert [one.value for one in again.trail] == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert [one.value for one in again.states] == [1.0]
    with pytest.raises(ConvergenceError):
        mode_following._Path(None, first, np.array([1.0]), 0.9, 1)


# ---- planetary sets --------------------------------------------------------------------------------------------------
def test_the_other_shaft_of_a_compound_set_sees_its_planet_where_that_stands():
    """The planet sees its mate where the pair's direction is; a ring likewise, a planet from the other side."""
    toothed = SimpleNamespace(
        other=Shaft.__new__(Shaft), other_wheel=SimpleNamespace(internal=False),
        planets=SimpleNamespace(angles=(0.7, 2.0)),
    )  # fmt: skip
    of = SimpleNamespace(direction=lambda one: 0.2)
    assert mesh_phases._seen(of, toothed, 0) == 0.2
    assert mesh_phases._seen(of, toothed, 1) == 0.7
    toothed.other_wheel.internal = True
    assert mesh_phases._seen(of, toothed, 1) == 0.2
    toothed.other, toothed.other_wheel.internal = SimpleNamespace(), False
    assert mesh_phases._seen(of, toothed, 1) == 0.2 + math.pi


def test_springs_of_wider_teeth_are_so_many_times_as_stiff_under_so_many_times_the_force():
    few = {key: np.arange(3.0) + number for number, key in enumerate(MeshSprings._fields)}
    one = MeshSprings(**few)
    teeth = SimpleNamespace(at=lambda place: one, cycles=4, breaks=np.array([0.1]))
    wide = WidenedSprings(teeth, 2.5)
    found = wide.at(np.zeros(3))
    for key in MeshSprings._fields:
        expected = few[key] * (2.5 if key in ("stiffness", "level") else 1.0)
        np.testing.assert_array_equal(getattr(found, key), expected)
    assert wide.cycles == 4
    assert wide.breaks.tolist() == [0.1]


def test_forces_on_common_pieces_are_the_functions_without_their_means_each_behind_by_its_delay():
    """Breaks on either side of a base pitch's end, nearer than any piece, are one."""
    saws = [Periodic.fit(lambda s, a=a: a * s * (1.0 - s), degree=4) for a in (3.0, 5.0)]
    for delays in ((0.25, 0.6), (0.0, 1.0 - 1e-14), (0.5, 0.5 + 1e-14)):
        found = on_common_pieces(saws, np.array(delays))
        assert found.starts.size == (2 if delays[0] == 0.25 else 1)
        assert found.widths.sum() == pytest.approx(1.0)
        v = np.array([[-0.8, 0.3, 0.9]])
        for piece, (start, width) in enumerate(zip(found.starts, found.widths, strict=True)):
            place = start + 0.5 * width * (v[0] + 1.0)
            exact = [one(place - late) - one.mean for one, late in zip(saws, delays, strict=True)]
            np.testing.assert_allclose(found.at(np.array([piece]), v)[:, 0], exact, atol=1e-10)


@pytest.mark.parametrize("apart", [3e-6, -2e-6])
def test_a_direction_that_nothing_loads_stays_where_its_spring_would_begin_to_bear(apart):
    """One spring on each coordinate, loads on the first: the other is free, next to where all springs bear."""
    stiffness, separation = np.array([[1e8, 4e7]]), np.array([[1e-6, apart]])
    found = equilibrium(np.zeros((2, 2)), np.eye(2), stiffness, separation, np.array([50.0, 0.0]))
    np.testing.assert_allclose(found, [[1e-6 + 50.0 / 1e8, apart]], rtol=1e-5)


def test_a_set_at_another_speed_and_with_more_damping_is_the_same_beside():
    @dataclass(frozen=True)
    class Linear:
        damping_ratio: float
        meshed: str = "meshed"

    @dataclass(frozen=True)
    class Moving:
        linear: Linear
        mesh_frequency: float = 3.0

    moves = Moving(Linear(0.02))
    assert SetMotion.more_damped(moves, 4.0) == Moving(Linear(0.08))
    assert SetMotion.more_damped(moves, 400.0) == Moving(Linear(0.99))
    assert SetMotion.at_speed(moves, 14.0 * math.pi) == Moving(Linear(0.02), pytest.approx(7.0))


def made_up_motion(duration, pitches, columns):
    """Of a trajectory: waves of one and of three periods in so many base pitches, and one that averaging takes out."""
    whole = duration / (FREQUENCY * duration / pitches)

    def angles(time, order=0):
        w = 2.0 * np.pi / whole
        waves = np.cos(w * time + 0.5 * np.pi * order) * w**order + 0.3 * np.cos(3.0 * w * time)
        gone = np.cos(np.pi * time / whole) if duration > 1.5 * whole else 0.0
        return np.stack([(k + 1.0) * waves + gone for k in range(columns)], axis=-1)

    def forces(time):
        return 50.0 + np.stack([(k + 1.0) * np.cos(2.0 * np.pi * time / whole) for k in range(6)], axis=-1)

    return SimpleNamespace(duration=duration, angles=angles, approach=angles, mesh_forces=forces)


FREQUENCY = 250.0


@pytest.mark.parametrize("times", [1, 2])
def test_a_motion_over_all_base_pitches_is_that_of_its_trajectory(times):
    """Sampled from the mesh's own phase on, the mean where it goes round so many times; orders are those of a wave."""
    pitches, phase = 5, 0.3
    state = SimpleNamespace(
        trajectory=lambda **_: made_up_motion(times * pitches / FREQUENCY, pitches, 3), repeats=True,
        behind=np.zeros(2),
        model=SimpleNamespace(parts=lambda: SimpleNamespace(frequency=np.array([1.0, FREQUENCY]))),
    )  # fmt: skip
    pair = SimpleNamespace(driver=SimpleNamespace(teeth=20), gear=lambda member: SimpleNamespace(teeth=20))
    found = motion_over_revolution.motion_over_revolution(state, 1, pair, pitches, phase)
    assert (found.averaged, found.cycles, found.frequency, found.repeats) == (times, pitches, FREQUENCY, True)
    turned = found.time * FREQUENCY
    assert (turned[0], turned[-1] + turned[1]) == pytest.approx((0.0, pitches))
    np.testing.assert_allclose(found.driver_angle, turned * 2.0 * np.pi / 20)
    angle = 2.0 * np.pi * (turned - phase) / pitches
    np.testing.assert_allclose(found.te, 2.0 * (np.cos(angle) + 0.3 * np.cos(3.0 * angle)), atol=1e-9)
    np.testing.assert_allclose(found.te_residual, found.te, atol=1e-9)
    np.testing.assert_allclose(found.force, 50.0 + 2.0 * np.cos(angle), atol=1e-9)
    w = 2.0 * np.pi * FREQUENCY / pitches
    np.testing.assert_allclose(
        found.acceleration, 2.0 * (-(w**2) * np.cos(angle) + 0.3 * np.cos(3.0 * angle)), rtol=1e-6
    )
    orders = found.orders
    fields = [getattr(orders, name) for name in orders.__dataclass_fields__]
    np.testing.assert_array_equal(fields[0], np.arange(1, fields[0].size + 1))
    np.testing.assert_allclose(fields[1], fields[0] / pitches)
    np.testing.assert_allclose(fields[2], fields[0] * FREQUENCY / pitches)
    assert fields[3][:3] == pytest.approx([2.0, 0.0, 0.6], abs=1e-9)
    assert fields[4][:3] == pytest.approx([2.0, 0.0, 0.0], abs=1e-9)
    assert fields[5][0] == pytest.approx(2.0 * w**2)


def test_what_one_tooth_changes_of_a_motion_is_zero_in_all_other_base_pitches():
    """A pulse in one of eleven base pitches comes out as it is; the residual signal spreads its mean over all."""
    pitches, samples = 11, 64
    s = np.arange(samples) / samples
    usual, pulse = 3.0 + np.cos(2.0 * np.pi * s), np.zeros((pitches, samples))
    pulse[4] = np.exp(-(((s - 0.5) / 0.1) ** 2))
    te, force = (usual + pulse).ravel(), (10.0 * usual - 50.0 * pulse).ravel()
    rest = without_mesh_harmonics(te, pitches)
    found = motion_over_revolution.MotionOverRevolution(
        None, pitches, 1.0, 1, True, te, te, te, rest, force, te, fine_te=te, fine_force=force
    )
    np.testing.assert_allclose(found.te_change, pulse.ravel(), atol=1e-14)
    assert found.dynamic_te_change_max == pytest.approx(1.0)
    assert found.dynamic_te_residual_max == pytest.approx(1.0 - 1.0 / pitches)
    assert (found.mesh_force_max, found.mesh_force_max_ordinary) == pytest.approx((40.0, 40.0))
    np.testing.assert_allclose(found.te_change - rest, np.tile(pulse.mean(axis=0), pitches), atol=1e-12)


@pytest.mark.parametrize("times", [1, 2])
def test_a_motion_of_a_set_over_all_base_pitches_is_that_of_its_trajectory(times):
    pitches, size = 4, 12
    work = np.zeros(size)
    driving = CENTRALS[1]
    work[1], work[3 * 1 + 2] = 6.0, -2.0  # over what the driving member has of them: 3 and -1
    meshed = SimpleNamespace(
        model=SimpleNamespace(torque_load=lambda torque: torque * work, count=3, found="set"), driving=driving,
        mean_force=70.0,
    )  # fmt: skip
    run = SimpleNamespace(
        linear=SimpleNamespace(meshed=meshed), mesh_frequency=FREQUENCY, period=pitches / FREQUENCY
    )  # fmt: skip
    state = SimpleNamespace(
        trajectory=lambda **_: made_up_motion(times * pitches / FREQUENCY, pitches, size), kind="periodic",
        apart=np.array([0.1, 0.4]), largest=np.array([90.0, 80.0]),
    )  # fmt: skip
    found = set_motion_over_revolution(run, state, 2, (20, 31), True)
    turned = found.signals
    assert (turned.base_pitches, turned.odd_planet, turned.teeth, turned.frequency) == (pitches, 2, (20, 31), FREQUENCY)
    assert (turned.found, turned.clockwise, turned.mean_force) == ("set", True, 70.0)
    count = found.te.size
    angle = 2.0 * np.pi * np.arange(count) / count
    np.testing.assert_allclose(found.te, (3.0 * 2.0 - 6.0) * (np.cos(angle) + 0.3 * np.cos(3.0 * angle)), atol=1e-9)
    assert found.mesh_force.shape == (2, 3, count)
    for k in range(6):
        np.testing.assert_allclose(found.mesh_force[k // 3, k % 3], 50.0 + (k + 1.0) * np.cos(angle), atol=1e-9)
    np.testing.assert_allclose(found.time * FREQUENCY, np.arange(count) * pitches / count)


# ---- motion in time --------------------------------------------------------------------------------------------------
def two_discs(damping=40.0, **others):
    mesh = Mesh("g", "1", "2", R, R, 30, 30, K, damping, **others)
    train = Train(
        (Body("1", J), Body("2", J)), meshes=(mesh,), torques=(Torque("1", FORCE * R), Torque("2", FORCE * R))
    )
    return MotionModel(train, (MeshExcitation.from_mesh(wave(K, 0.2), Periodic.constant(0.0)),), 90.0)


def test_more_damping_is_that_of_the_teeth():
    found = two_discs(40.0).more_damped(2.5)
    assert found.train.meshes[0].damping == 100.0
    assert found.train.meshes[0].stiffness == K
    assert found.speed == 90.0


def test_a_motion_that_cannot_be_followed_says_of_what_there_was_too_much(monkeypatch):
    model, kernel = two_discs(), motion.kernel
    packed = pack(model)
    start = np.zeros(packed.size)

    def ends_with(code):
        fields = {key: np.zeros(1) for key in kernel.Travelled._fields} | {"code": code, "steps": 7, "changes": 9}
        monkeypatch.setattr(kernel, "compiled", lambda: lambda *given: tuple(kernel.Travelled(**fields)))

    for code, what in ((kernel.TOO_MANY_STEPS, "time steps"), (kernel.TOO_MANY_STEPS + 1, "changes of contact")):
        assert code != kernel.DONE
        ends_with(code)
        with pytest.raises(ConvergenceError, match=rf"at 90 rad/s stopped after 7 steps: too many {what} in 2 units"):
            propagate(packed, start, start, 2.0)


def test_a_request_to_stop_comes_through_the_errors_that_hide_it(monkeypatch):
    hidden, outer = SystemError("inner"), SystemError("outer")
    hidden.__cause__, outer.__cause__ = KeyboardInterrupt(), hidden

    def stopped(*given):
        raise outer

    packed = pack(two_discs())
    monkeypatch.setattr(motion.kernel, "compiled", lambda: stopped)
    with pytest.raises(KeyboardInterrupt):
        propagate(packed, np.zeros(packed.size), np.zeros(packed.size), 1.0)
    monkeypatch.setattr(motion.kernel, "compiled", lambda: lambda *given: (_ for _ in ()).throw(SystemError("alone")))
    with pytest.raises(SystemError, match="alone"):
        propagate(packed, np.zeros(packed.size), np.zeros(packed.size), 1.0)


def test_the_force_of_a_gear_pair_is_that_of_its_springs_and_of_its_damper_while_teeth_touch():
    """Two pairs: one with a damper that follows the stiffness in contact, C sqrt(K(t)/K), the other with its own."""
    elastic = np.array([[3.0, 4.0, 5.0], [3.0, 0.0, 0.0]])
    stiffness = np.array([[2.0, 7.0, 1.0], [2.0, 7.0, 1.0]])
    packed = SimpleNamespace(
        damping=np.array([0.5, 0.25]), mesh_of=np.array([0, 0, 1]), approach=np.array([[1.0, 2.0], [0.0, 4.0]]),
        force_unit=10.0, momentary=np.array([True, False]), stiffness=np.array([4.0, 9.0]),
    )  # fmt: skip
    rate, contact = np.array([[0.3, 0.1], [0.3, 0.1]]), np.array([[1, 1, 1], [1, 0, 0]])
    moves = SimpleNamespace(
        packed=packed, passage=SimpleNamespace(contact=contact), _springs=lambda time: (elastic, stiffness),
        _at=lambda time, derivative: (rate, np.array([0, 1])),
    )  # fmt: skip
    found = Trajectory.mesh_forces(moves, np.array([0.0, 1.0]))
    whole, part = (0.5 * 0.5 * 10.0 * math.sqrt(k / 4.0) for k in (9.0, 2.0))
    np.testing.assert_allclose(found, [[7.0 + whole, 5.0 + 0.25 * 0.4 * 10.0], [3.0 + part, 0.0]])


def test_growth_is_the_mean_logarithm_after_the_first_fifth(monkeypatch):
    steps = iter([9.0, 9.0, *np.exp(np.arange(10.0))])
    monkeypatch.setattr(coexisting, "moving", lambda packed: np.array([True, False, True]))

    def passage(packed, x, v, duration, **how):
        size = next(steps)
        return SimpleNamespace(x=x + 1.0, v=v, tangent=np.diag([size, 1e9, size]))

    monkeypatch.setattr(coexisting, "propagate", passage)
    packed = SimpleNamespace(period=1.0)
    assert coexisting.growth(packed, 0.0, 0.0, 1e-6, periods=10) == pytest.approx(4.5)
    steps = iter([1.0, 0.0])
    assert coexisting.growth(packed, 0.0, 0.0, 1e-6, periods=10) == -math.inf


def test_states_of_an_orbit_follow_each_other_period_by_period(monkeypatch):
    monkeypatch.setattr(coexisting, "moving", lambda packed: np.array([True, False, True, True]))
    asked = []

    def passage(packed, x, v, duration, *, tolerance, peaks):
        asked.append((duration, tolerance, peaks))
        return SimpleNamespace(x=2.0 * x, v=v - 1.0)

    monkeypatch.setattr(coexisting, "propagate", passage)
    state = np.array([1.0, 5.0, 3.0, 4.0])
    orbit = SimpleNamespace(
        packed=SimpleNamespace(period=0.4), x=state[:2], v=state[2:], periods=3, state=state[[0, 2, 3]]
    )
    points = coexisting._points(orbit, 1e-7)
    assert [one.tolist() for one in points] == [[2.0, 2.0, 3.0], [4.0, 1.0, 2.0], [8.0, 0.0, 1.0]]
    assert asked == [(0.4, 1e-7, False)] * 3
    assert not coexisting._closes_sooner(orbit, 1e-7)
    assert not coexisting._same(orbit, orbit, 1e-7)
    for at in (0, 1, 2):  # an orbit that passes there is the same; the last point is where it began, not sooner
        orbit.state = points[at] + 0.4 * coexisting.SAME
        assert coexisting._closes_sooner(orbit, 1e-7) == (at < 2)
        assert coexisting._same(orbit, orbit, 1e-7)
    other = SimpleNamespace(**{**vars(orbit), "periods": 2})
    assert not coexisting._same(orbit, other, 1e-7)


def test_teeth_that_never_part_have_their_closed_motion_or_grow(monkeypatch):
    """Where none is found as fast as a motion grows, beside an unstable one by its largest multiplier."""
    monkeypatch.setattr(steady_state, "_growing", lambda packed, rate, multipliers=None: (rate, multipliers))
    monkeypatch.setattr(steady_state, "growth", lambda packed, x, v, step: ("growth", packed, x, v, step))
    monkeypatch.setattr(steady_state, "periodic_motion", lambda orbit: orbit)
    orbit = SimpleNamespace(stable=False, radius=math.e**2, multipliers="multipliers")
    for found, expected in (
        (None, (("growth", "packed", 1, 2, 3), None)),
        (orbit, (pytest.approx(2.0), "multipliers")),
    ):
        monkeypatch.setattr(steady_state, "close", lambda *given, found=found: found)
        assert steady_state._linear("packed", 1, 2, 3) == expected
    orbit.stable = True
    assert steady_state._linear("packed", 1, 2, 3) is orbit


@pytest.mark.parametrize("far", [0.0, 1e6])
def test_round_off_of_large_coordinates_does_not_keep_an_orbit_from_being_found(monkeypatch, far):
    """A map that halves the distance to its fixed point, with a jitter in the last places of that."""
    steps = iter(range(99))

    def passage(packed, x, v, duration, **how):
        jitter = 1e-8 * (-1.0) ** next(steps) if far else 0.0
        return SimpleNamespace(
            x=far + 0.5 * (x - far) + jitter, v=-0.5 * v, tangent=np.diag([0.5, -0.5]), changes=0,
            apart=np.zeros(1), behind=np.zeros(1), high=None,
        )  # fmt: skip

    monkeypatch.setattr(shooting, "propagate", passage)
    packed = SimpleNamespace(free=np.array([True]), size=1, period=1.0)
    found = shooting.close(packed, np.array([far + 2.0]), np.array([0.3]), 2, 1e-14)
    assert found is not None
    assert found.periods == 2
    assert [*found.x, *found.v] == pytest.approx([far, 0.0], abs=1e-7)
    assert next(steps) < 5


@pytest.mark.parametrize(
    ("radius", "far", "periods"),
    [(0.9, 1.0, 66), (0.5, 1.0, 10), (0.9, 0.0, 0), (1.0, 1.0, None), (1.2, 1.0, None), (0.999999, 1.0, None)],
)
def test_a_way_to_an_orbit_is_followed_until_a_thousandth_of_it_is_left(monkeypatch, radius, far, periods):
    """ln(1000) over the logarithm of the multiplier; as long as any transient where it does not shrink."""
    asked = []

    def way(packed, x, v, duration, *, tolerance, peaks):
        asked.append((duration / 0.25, tolerance, peaks))
        return SimpleNamespace(changes=changes)

    monkeypatch.setattr(steady_state, "propagate", way)
    monkeypatch.setattr(steady_state, "moving", lambda packed: np.array([True, True, False, True]))
    x, v = np.array([1.0, 2.0]), np.array([9.0, 4.0])
    orbit = SimpleNamespace(
        packed=SimpleNamespace(period=0.25), radius=radius, state=np.array([1.0, 2.0 - far, 4.0 + 0.5 * far])
    )
    for changes in (0, 3):
        kept = steady_state._keeps_contact(orbit, x, v, 1e-6)
        assert kept == (changes == 0 or periods == 0)
    expected = steady_state.TRANSIENT if periods is None else periods
    assert asked == ([(expected, 1e-6, False)] * 2 if expected else [])


def test_steps_are_a_thousandth_of_the_tolerance_and_no_finer_than_round_off():
    assert [steady_state.step_for(tolerance) for tolerance in (1e-2, 3e-5)] == pytest.approx([1e-5, 3e-8])
    assert steady_state.step_for(1.1e-13) == 1e-14
    for tolerance in (1e-13, 1.01e-2, 0.0, math.nan):
        with pytest.raises(RangeError, match=r"must be between 1e-13 and 1e-2"):
            steady_state.step_for(tolerance)


@pytest.mark.parametrize(("closes", "periods"), [(1, 1), (2, 2), (3, 3), (4, 6), (6, 6)])
def test_a_periodic_motion_has_the_fewest_periods_after_which_it_closes(monkeypatch, closes, periods):
    """Of an orbit of six: its divisors are tried, from one on; numbers are those of the whole motion."""

    def passage(packed, x, v, duration, **how):
        turns = round(duration / 0.5)
        off = 0.0 if turns % closes == 0 else 1.0
        return SimpleNamespace(
            x=x + off, v=v, largest=np.full(1, 10.0 * turns), smallest=np.full(1, -1.0), tooth_force=np.full(1, 3.0),
            apart=np.full(1, 0.2), behind=np.full(1, 0.1), changes=turns, tangent=0.8**turns * np.eye(2),
        )  # fmt: skip

    monkeypatch.setattr(steady_state, "propagate", passage)
    monkeypatch.setattr(steady_state, "moving", lambda packed: np.array([True, True]))
    monkeypatch.setattr(steady_state, "Orbit", lambda packed, x, v, divisor, short, miss: made(divisor, miss))

    def made(count, miss):
        return SimpleNamespace(
            packed=SimpleNamespace(period=0.5, model="model"), x=np.ones(1), v=np.zeros(1), periods=count, miss=miss,
            radius=0.8**count, multipliers=np.full(2, 0.8**count),
        )  # fmt: skip

    found = steady_state.periodic_motion(made(6, 1e-9))
    assert (found.kind, found.periods) == ("periodic", periods)
    assert (found.largest[0], found.changes) == (10.0 * periods, periods)
    numbers = [value for value in vars(found).values() if isinstance(value, float)]
    assert sum(abs(value - math.log(0.8)) < 1e-9 for value in numbers) == 1  # its growth in a period


def test_velocities_stay_in_bounds_or_not_whatever_distances_do():
    packed = SimpleNamespace(free=np.array([True, True, False]))
    far, most = 1e3 * steady_state.UNBOUNDED, steady_state.UNBOUNDED

    def bounded(*states):
        return steady_state._bounded(packed, SimpleNamespace(states=np.array(states)))

    assert bounded([far, -far, most, -most, 0.0], [0.0] * 5)
    assert not bounded([0.0] * 5, [0.0, 0.0, 0.0, -1.01 * most, 0.0])
    assert not bounded([0.0, 0.0, 0.0, 0.0, 1.01 * most])
    assert not bounded([math.nan, 0.0, 0.0, 0.0, 0.0])


def test_a_direction_that_a_period_leaves_where_it_is_is_found_in_any_units():
    units = np.diag([1.0, 1e7, 1e-6])
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.3, 0.2, 0.5]])
    for fixed, expected in ((0.5, False), (1.0, True), (1.0 + 1e-7, False), (-1.0, False)):
        turn[2, 2] = fixed
        for scale in (np.eye(3), units):
            assert shooting.has_fixed_direction(scale @ turn @ np.linalg.inv(scale)) == expected


def test_a_floquet_frame_takes_a_period_apart_or_is_none():
    turn = np.array([[0.5, 0.3], [0.0, -0.2]])
    frame = floquet_frame(turn)
    apart = frame @ turn @ np.linalg.inv(frame)
    assert sorted(np.diag(apart).real) == pytest.approx([-0.2, 0.5])
    np.testing.assert_allclose(apart - np.diag(np.diag(apart)), 0.0, atol=1e-14)
    jordan = np.array([[0.5, 1.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.1]])
    np.testing.assert_array_equal(floquet_frame(jordan), np.eye(3))
