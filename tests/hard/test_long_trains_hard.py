"""Long trains: as exact as short ones, in time and memory that grow with their length and no faster."""

import math
import tracemalloc
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from exact_increments import exact_increments
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import RangeError
from fegear.dynamics.motion import motion_model as packing
from fegear.dynamics.motion.motion import simulate
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.packed_model import pack
from fegear.dynamics.motion.shooting import has_fixed_direction
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train import branches, increments
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.increments import dynamic_increments
from fegear.dynamics.train.matrices import damping_matrix, elements, projected, stiffness_matrix
from fegear.dynamics.train.network import Network
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.segments import in_series, segment_shapes
from fegear.dynamics.train.train import Body, Damper, Mesh, Shaft, Torque, Train


def row_of_bodies(count, meshes, *, zeta=0.01, seed=0, spread=0.5, powers=(4.0, 6.0)):
    """Bodies in a row, gear pairs spread evenly among shafts of `powers` decades of stiffness."""
    rng = np.random.default_rng(seed)
    bodies = tuple(Body(f"b{i}", 1e-3 * 10 ** rng.uniform(-spread, spread)) for i in range(count))
    at = {int((m + 0.5) * (count - 1) / meshes) for m in range(meshes)}
    shafts, pairs = [], []
    for i in range(count - 1):
        ends = f"b{i}", f"b{i + 1}"
        k = 10 ** rng.uniform(*powers)
        if i in at:
            c = 2.0 * zeta * math.sqrt(3e8 * 0.2)
            pairs.append(Mesh(f"m{i}", *ends, 0.04, 0.05 * (-1) ** i, 40, 50, 3e8, c))
        else:
            shafts.append(Shaft(f"s{i}", *ends, k, 2.0 * zeta * math.sqrt(k * 1e-3)))
    return Train(bodies, tuple(shafts), tuple(pairs))


def exact_in_a_row(train, omega, digits=40):
    """Q of every mesh from the equations of a row of bodies, solved as a band of three in many digits."""
    with mpmath.workdps(digits):
        n, w, mp = train.size, mpmath.mpf(omega), mpmath.mpf
        main = [-w * w * mp(float(j)) for j in train.inertia]
        side = [mp(0)] * (n - 1)
        rows = [None] * len(train.meshes)
        for e in elements(train):
            y = mp(e.stiffness) + mpmath.mpc(0, 1) * w * mp(e.damping)
            ra, rb = mp(e.radius_a), mp(e.radius_b)
            assert e.b == e.a + 1
            main[e.a] += y * ra * ra
            main[e.b] += y * rb * rb
            side[e.a] += y * ra * rb
            if e.mesh >= 0:
                rows[e.mesh] = (e.a, ra, rb, y, mp(e.stiffness))
        pivots, factors = [main[0]], []
        for i in range(n - 1):
            factors.append(side[i] / pivots[i])
            pivots.append(main[i + 1] - factors[i] * side[i])
        q = np.empty((len(rows), len(rows)), dtype=complex)
        for j, (at, ra, rb, _, k) in enumerate(rows):
            x = [mp(0)] * n
            x[at], x[at + 1] = ra * k, rb * k
            for i in range(n - 1):
                x[i + 1] -= factors[i] * x[i]
            x[n - 1] /= pivots[n - 1]
            for i in range(n - 2, -1, -1):
                x[i] = x[i] / pivots[i] - factors[i] * x[i + 1]
            for i, (to, ta, tb, y, own) in enumerate(rows):
                q[i, j] = complex((ta * x[to] + tb * x[to + 1]) * y / own - (1 if i == j else 0))
        return q


@pytest.mark.parametrize(
    ("count", "meshes", "zeta", "powers"),
    [
        (200, 1, 0.01, (4.0, 6.0)),
        (200, 1, 0.0, (4.0, 6.0)),
        (60, 12, 0.0, (4.0, 6.0)),
        (60, 12, 0.01, (1.0, 14.0)),
    ],
    ids=["damped", "undamped", "many meshes", "soft and stiff"],
)
def test_increments_of_long_trains_keep_all_digits(count, meshes, zeta, powers):
    """Every entry within 1e-12 of its exact value, from rigid-body motion through all the modes to beyond them."""
    train = row_of_bodies(count, meshes, zeta=zeta, powers=powers)
    omega = 2.0 * math.pi * np.array([1e-6, 0.1, 31.0, 137.0, 999.0, 2718.0, 1e5])
    found = dynamic_increments(train, omega)
    for n, w in enumerate(omega):
        exact = exact_in_a_row(train, w)
        # far beyond a train's modes what reaches from end to end underflows
        error = np.abs(found[:, :, n] - exact) / np.maximum(np.abs(exact), 1e-250)
        assert error.max() < 1e-12, (w, error.max())


@pytest.mark.parametrize(
    ("count", "meshes"), [(120, 30), pytest.param(500, 30, marks=pytest.mark.long)], ids=["120", "500"]
)
def test_thirty_gear_pairs_in_one_train_keep_all_digits(count, meshes):
    """500 bodies with 30 gear pairs at 1,000 frequencies took over 200 s, an elimination for each; now 4."""
    train = row_of_bodies(count, meshes)
    omega = 2.0 * math.pi * np.array([0.1, 137.0, 2718.0])
    found = dynamic_increments(train, omega)
    for n, w in enumerate(omega):
        exact = exact_in_a_row(train, w)
        assert (np.abs(found[:, :, n] - exact) / np.maximum(np.abs(exact), 1e-250)).max() < 1e-12


def test_forks_and_links_side_by_side_are_swept_like_rows():
    """A node with four branches, two gear pairs and a shaft between the same two bodies, one pair on a rigid shaft."""
    bodies = tuple(Body(name, 1e-3 * (n + 1)) for n, name in enumerate("abcdefgh"))
    train = Train(
        bodies,
        (Shaft("s1", "a", "b", 3e4, 0.02), Shaft("s2", "c", "e", 5e4, 0.1), Shaft("s3", "b", "f", 1e3, 0.0),
         Shaft("s4", "g", "h", 2e4, 0.1)),
        (Mesh("m1", "b", "c", 0.04, -0.04, 40, 40, 3e8, 900.0), Mesh("m2", "b", "c", 0.05, -0.05, 50, 50, 1e8, 0.0),
         Mesh("m3", "d", "b", 0.02, 0.06, 20, 60, 2e8, 300.0), Mesh("m4", "b", "g", 0.03, 0.04, 30, 40, 2e8, 300.0)),
        (Damper("d", None, 0.3), Damper("h", None, 0.1)),
    )  # fmt: skip
    for hertz in (1e-3, 40.0, 700.0, 2e3, 3e4):
        omega = 2.0 * math.pi * hertz
        assert dynamic_increments(train, omega) == pytest.approx(exact_increments(train, omega), rel=1e-12)


def test_work_grows_with_the_bodies_and_not_with_the_gear_pairs(monkeypatch):
    """Steps of the elimination of a train without loops, whatever its number of gear pairs: less than two a body."""
    steps = []

    def counted(*arguments):
        steps.append(arguments[0].value.size)
        return in_series(*arguments)

    monkeypatch.setattr(branches, "in_series", counted)
    taken = {}
    for count, meshes in ((200, 1), (400, 1), (400, 30)):
        steps.clear()
        dynamic_increments(row_of_bodies(count, meshes), 2.0 * math.pi * np.array([100.0, 1000.0]))
        taken[count, meshes] = sum(steps)
    # two frequencies, each at most twice: in plain and in long floats
    assert all(found <= 2 * 2 * 2 * count for (count, _), found in taken.items())


def ring(count, closed, k=1.0):
    """Equal discs in a row, or in a ring, with shafts of unit stiffness and one gear pair in the middle."""
    bodies = tuple(Body(str(i), 1.0) for i in range(count))
    middle = (count - 1) // 2
    shafts = [Shaft(f"s{i}", str(i), str(i + 1), k) for i in range(count - 1) if i != middle]
    if closed:
        shafts.append(Shaft("back", str(count - 1), "0", k))
    return Train(bodies, tuple(shafts), (Mesh("g", str(middle), str(middle + 1), 1.0, -1.0, 20, 20, k),))


@pytest.mark.parametrize("closed", [False, True], ids=["row", "ring"])
@pytest.mark.parametrize("count", [8, 10, 20])
def test_partial_resonances_cost_no_digits(count, closed):
    """Equal discs at w^2 = k/J: a disc on its shaft swings at its own frequency, its pivot is exactly zero.

    Natural frequencies of the whole are elsewhere: at w^2 = 2 - 2 cos(pi n/count), or cos(2 pi n/count) for the ring.
    """
    train = ring(count, closed)
    omega = np.array([1.0, 1.0 + 1e-9, 1.0 - 1e-5, 1.3])
    found = dynamic_increments(train, omega)
    for n, w in enumerate(omega):
        assert found[0, 0, n] == pytest.approx(exact_increments(train, w)[0, 0], rel=1e-12)


@pytest.mark.parametrize("closed", [False, True], ids=["row", "ring"])
def test_resonances_of_long_trains_without_damping_are_refused(closed):
    train = ring(24 if closed else 21, closed)
    with pytest.raises(RangeError, match="is a natural frequency of the undamped train:"):
        dynamic_increments(train, [0.7, 1.0])
    beside = 1.0 + 1e-9
    assert dynamic_increments(train, beside)[0, 0] == pytest.approx(exact_increments(train, beside)[0, 0], rel=1e-6)


def test_a_mode_that_leaves_the_gear_pair_alone_is_no_resonance_of_it():
    """24 equal discs at w^2 = k/J: the pair in the middle turns as one in that mode."""
    train = ring(24, closed=False)
    assert dynamic_increments(train, 1.0)[0, 0] == pytest.approx(exact_increments(train, 1.0 + 1e-13)[0, 0], abs=1e-11)


@st.composite
def tangled(draw):
    """Small trains with loops of shafts, several slipping dampers, very light gears and very stiff shafts."""
    n = draw(st.integers(3, 7))
    decades = st.floats(-12.0, 0.0)
    bodies = tuple(Body(str(i), 10.0 ** draw(decades)) for i in range(n))
    shafts, meshes = [], []
    for i in range(1, n):
        other = draw(st.integers(max(0, i - 2), i - 1))
        if i == 1 or draw(st.booleans()):
            za, zb = draw(st.sampled_from([(16, 64), (64, 16), (32, 32)]))
            meshes.append(Mesh(f"m{i}", str(other), str(i), za / 1024, zb / 1024, za, zb,
                               10.0 ** draw(st.floats(6.0, 9.5)), draw(st.sampled_from([0.0, 10.0, 1e3]))))  # fmt: skip
        else:
            k = 10.0 ** draw(st.floats(1.0, 14.0))
            shafts.append(Shaft(f"s{i}", str(other), str(i), k, draw(st.sampled_from([0.0, 0.1]))))
    speeds = Train(bodies, tuple(shafts), tuple(meshes)).exact_ratios
    pairs = [(a, b) for a in range(n) for b in range(a) if speeds[a] == speeds[b]]
    if pairs:
        for number, (a, b) in enumerate(draw(st.lists(st.sampled_from(pairs), max_size=2))):
            shafts.append(Shaft(f"loop{number}", str(a), str(b), 10.0 ** draw(st.floats(2.0, 7.0)), 0.1))
    any_two = st.lists(st.integers(0, n - 1), min_size=2, max_size=2, unique=True)
    slips = tuple(
        Damper(str(a), str(b), 10.0 ** draw(st.floats(-3.0, 2.0))) for a, b in draw(st.lists(any_two, max_size=3))
    )
    ground = tuple(Damper(str(i), None, 10.0 ** draw(st.floats(-4.0, 2.0))) for i in range(n) if draw(st.booleans()))
    return Train(bodies, tuple(shafts), tuple(meshes), slips + ground)


@given(tangled(), st.floats(-6.0, 6.0))
def test_increments_of_tangled_trains_equal_forty_digits(train, power):
    """Every entry, as far as the numbers of the train themselves hold: near a resonance their last place counts."""
    omega = 2.0 * math.pi * 10.0**power
    wanted = exact_increments(train, omega)
    found = dynamic_increments(train, omega)
    moved = np.abs(exact_increments(train, omega * (1.0 + 1e-9)) - wanted) * 1e9
    assert (np.abs(found - wanted) <= 1e-12 * np.abs(wanted) + 1e-14 * moved).all()


# ---- growth ---------------------------------------------------------------------------------------------------------
def peak_memory(train, frequencies):
    """Largest memory in use on the way [bytes], beside what is handed back."""
    omega = 2.0 * math.pi * np.logspace(1, 4, frequencies)
    tracemalloc.start()
    try:
        q = dynamic_increments(train, omega)
        return tracemalloc.get_traced_memory()[1] - q.nbytes
    finally:
        tracemalloc.stop()


def test_memory_is_bounded_whatever_the_train_and_the_frequencies():
    """Blocks are sized to memory: 200 bodies took 4 GB, and 60 bodies with 30 gear pairs more than there was."""
    assert peak_memory(row_of_bodies(200, 1), 500) < 50e6
    assert peak_memory(row_of_bodies(200, 1), 2000) < 50e6
    assert peak_memory(row_of_bodies(30, 10), 250) < 50e6


def test_elimination_fills_nothing_in_on_rows_and_one_link_a_node_on_loops():
    """The work and the memory are the links at each node when its turn comes: one on a row, two on a loop."""
    row = row_of_bodies(200, 30)
    for mesh in (0, 15, 29):
        steps = Network.of(row).order(mesh)
        assert sorted(node for node, _ in steps) == sorted(set(range(200)) - set(row_ends(row, mesh)))
        assert all(len(others) == 1 for _, others in steps)
    assert all(len(others) <= 2 for _, others in Network.of(ring(200, closed=True)).order(0))


def row_ends(train, mesh):
    return train.dof[train.meshes[mesh].a], train.dof[train.meshes[mesh].b]


def test_blocks_leave_no_trace(monkeypatch):
    """One frequency at a time, in blocks of sixteen or all at once: the same to the last places."""
    train = row_of_bodies(40, 3, zeta=0.0, seed=3)
    omega = 2.0 * math.pi * np.logspace(1, 4, 40)
    whole = dynamic_increments(train, omega)
    monkeypatch.setattr(increments, "MEMORY", 1)
    parts = dynamic_increments(train, omega)
    single = np.stack([dynamic_increments(train, w) for w in omega], axis=-1)
    assert parts == pytest.approx(whole, rel=1e-13)
    assert single == pytest.approx(whole, rel=1e-13)


def test_one_source_is_a_column_of_all():
    train = row_of_bodies(30, 5)
    omega = np.array([0.0, 300.0, -300.0, 4e4])
    assert dynamic_increments(train, omega, [3, 1]) == pytest.approx(dynamic_increments(train, omega)[:, [3, 1]])


# ---- motion ---------------------------------------------------------------------------------------------------------
def loaded(train, force=2000.0):
    """The train with torques at both ends that press its one gear pair with this force."""
    torque = force * train.meshes[0].radius_a
    last = train.bodies[-1].name
    ends = Torque(train.bodies[0].name, torque), Torque(last, -torque / train.ratios[train.dof[last]])
    return replace(train, torques=ends)


def shaken(train, speed, amplitude=1e-7):
    """In motion, with mean mesh stiffness and a transmission error of one harmonic."""
    error = Periodic.fit(lambda s: amplitude * np.cos(2.0 * np.pi * s), degree=10, tolerance=1e-13)
    stiffness = Periodic.constant(train.meshes[0].stiffness)
    return MotionModel(loaded(train), (MeshExcitation.from_mesh(stiffness, error),), speed)


@pytest.mark.parametrize(
    ("count", "ratio"),
    [(80, 0.6), pytest.param(200, 0.3, marks=pytest.mark.long), pytest.param(200, 2.0, marks=pytest.mark.long)],
)
def test_motion_of_long_trains_is_that_of_forty_digits(count, ratio):
    """Constant stiffness: the largest force is the mean and k |Q| times the transmission error's amplitude."""
    train = row_of_bodies(count, 1)
    speed = ratio * 2.0 * math.pi * 2000.0 / 40
    state = steady_state(shaken(train, speed), tolerance=1e-8)
    mesh = train.meshes[0]
    q = exact_in_a_row(train, 40 * speed)[0, 0]
    assert state.changes == 0
    assert state.largest[0] == pytest.approx(2000.0 + mesh.stiffness * abs(q) * 1e-7, rel=1e-7)
    assert state.smallest[0] == pytest.approx(2000.0 - mesh.stiffness * abs(q) * 1e-7, rel=1e-7)


def test_coordinates_of_long_trains_are_sparse():
    """A step in time costs what the stiffness and damping matrices hold: rows of log n entries, not of n."""
    for count in (100, 200, 400):
        packed = pack(shaken(row_of_bodies(count, 1), 100.0))
        filled = np.count_nonzero((packed.K != 0.0) | (packed.C != 0.0))
        assert filled < 2.0 * count * math.log2(count)


def test_long_and_short_trains_move_alike(monkeypatch):
    """The same motion in natural modes and in segments, with contact loss."""
    train, speed = row_of_bodies(40, 1), 2.0 * math.pi * 2000.0 / 40
    parts = 2000.0 / (train.meshes[0].stiffness * abs(dynamic_increments(train, 40 * speed)[0, 0]))
    model = shaken(train, speed, 1.2 * parts)
    segments = simulate(model, 12.0 * model.period, tolerance=1e-12, max_steps=2000)
    monkeypatch.setattr(packing, "LONG", 1000)
    modal = simulate(model, 12.0 * model.period, tolerance=1e-12, max_steps=2000)
    assert segments.passage.changes == modal.passage.changes > 2
    time = np.linspace(0.0, 12.0 * model.period, 200)
    assert segments.approach(time) == pytest.approx(modal.approach(time), rel=1e-7, abs=1e-7 * 2000.0 / 3e8)


@given(tangled())
def test_segments_are_coordinates_of_any_train(train):
    """Orthogonal by mass, the first the free turning; the train's springs in them give its natural frequencies."""
    shapes = segment_shapes(train)
    assert shapes.T @ (train.inertia[:, None] * shapes) == pytest.approx(np.eye(train.size), abs=1e-12)
    assert shapes[:, 0] / shapes[0, 0] == pytest.approx(train.ratios, rel=1e-12)
    plain = shapes.T @ stiffness_matrix(train, meshes=False) @ shapes
    assert projected(train, shapes, "stiffness") == pytest.approx(plain, abs=1e-12 * np.abs(plain).max() + 1e-300)
    damped = shapes.T @ damping_matrix(train, meshes=False) @ shapes
    assert projected(train, shapes, "damping") == pytest.approx(damped, abs=1e-12 * np.abs(damped).max() + 1e-300)


# ---- very light gears -----------------------------------------------------------------------------------------------
@pytest.mark.parametrize("scale", [1.0, 1e5, 1e9])
def test_what_stands_still_is_reported_in_whatever_units(scale):
    """A turning of 0.3 rad moves every direction, one of zero none, however small a light gear makes velocities."""
    for angle, fixed in ((0.3, False), (0.0, True), (1e-12, True)):
        c, s = math.cos(angle), math.sin(angle)
        assert has_fixed_direction(np.array([[c, s * scale], [-s / scale, c]])) is fixed


@pytest.mark.long
def test_a_gear_of_next_to_no_inertia_is_no_resonance():
    """1e-12 kg m^2 between a shaft and the teeth, undamped: the forces are those of forty digits."""
    radius, k, amplitude, speed = 0.05, 2e8, 1e-8, 100.0
    train = Train(
        (Body("motor", 2e-3), Body("gear", 1e-12), Body("load", 2e-3)),
        (Shaft("s", "motor", "gear", 1e4),),
        (Mesh("p", "gear", "load", radius, radius, 30, 30, k),),
        torques=(Torque("motor", 25.0), Torque("load", 25.0)),
    )
    error = Periodic.fit(lambda s: amplitude * np.cos(2.0 * np.pi * s), degree=10, tolerance=1e-13)
    model = MotionModel(train, (MeshExcitation.from_mesh(Periodic.constant(k), error),), speed)
    state = steady_state(model)
    shaking = k * abs(exact_increments(train, 30 * speed)[0, 0]) * amplitude
    assert state.largest[0] == pytest.approx(500.0 + shaking, abs=1e-6 * 500.0)
    assert state.smallest[0] == pytest.approx(500.0 - shaking, abs=1e-6 * 500.0)
