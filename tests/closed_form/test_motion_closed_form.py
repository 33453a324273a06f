"""Motion in closed form and by law: order, energy, static limit, rigid shafts, antiphase, non-periodic motion."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError, RangeError
from fegear.dynamics.motion.kernel.polynomials import largest_force
from fegear.dynamics.motion.motion import propagate, simulate, starting_state, static_state
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.packed_model import pack
from fegear.dynamics.motion.steady_state import speed_sweep, steady_state
from fegear.dynamics.train.charts import FourInertia, speed_chart
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.matrices import damping_matrix, stiffness_matrix
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Damper, Mesh, Shaft, Torque, Train, mesh_damping

CASES = Path(__file__).parents[2] / "cases"
R, J, K = 0.05, 2e-3, 2e8
NATURAL = math.sqrt(2 * K * R * R / J)


def cosine(amplitude, harmonic=1):
    return Periodic.fit(lambda s: amplitude * np.cos(2 * np.pi * harmonic * s), degree=10, tolerance=1e-13)


def two_discs(force=500.0, zeta=0.02, backlash=math.inf):
    """Two equal discs in mesh: one oscillator of natural frequency sqrt(2 k R^2/J)."""
    c = mesh_damping(zeta, K, R, R, J, J)
    return Train(
        (Body("1", J), Body("2", J)),
        meshes=(Mesh("g", "1", "2", R, R, 30, 30, K, c, backlash),),
        torques=(Torque("1", force * R), Torque("2", force * R)),
    )


def model(ratio, amplitude=5e-8, **train):
    """Two discs at a mesh frequency of `ratio` natural frequencies, transmission error of one harmonic."""
    found = MeshExcitation.from_mesh(Periodic.constant(K), cosine(amplitude))
    return MotionModel(two_discs(**train), (found,), ratio * NATURAL / 30)


def jumping():
    return Periodic.through_points([0, 0.32, 0.32, 0.68, 0.68, 1], [4.2e8, 4.2e8, 2.6e8, 2.6e8, 4.2e8, 4.2e8])


def four_inertia(shaft=2.18e4, backlash=math.inf, shaft_ratio=0.05):
    j = 1.22e-3
    return FourInertia(10 * j, j, j, 10 * j, shaft, shaft, 0.04177, 0.04177, 28, 28, 8890.0, shaft_ratio, 0.1, backlash)


@pytest.mark.parametrize("ratio", [0.2, 0.9, 1.0, 1.7])
def test_one_oscillator_in_closed_form(ratio):
    """m x'' + c x' + k (x - e) = W, e = a cos(w t): force |k (H - 1) + i w c H| a with H = k/(k - m w^2 + i w c)."""
    a, zeta, w = 5e-8, 0.02, ratio * NATURAL
    mass = J / (2 * R * R)
    c = 2 * zeta * math.sqrt(K * mass)
    H = K / (K - mass * w * w + 1j * w * c)
    force = abs(K * (H - 1) * a + 1j * w * c * H * a)
    state = steady_state(model(ratio, a, zeta=zeta), tolerance=1e-10)
    assert state.changes == 0
    assert state.largest[0] == pytest.approx(500.0 + force, rel=1e-9)
    assert state.smallest[0] == pytest.approx(500.0 - force, rel=1e-9)
    # multipliers: exp((-zeta +- i sqrt(1 - zeta^2)) w0 T)
    assert np.abs(state.multipliers) == pytest.approx(math.exp(-zeta * 2 * math.pi / ratio), rel=1e-9)


@pytest.mark.parametrize("order", [4, 6, 8])
def test_observed_order(order):
    """Half the step, 2^order less error, with stiffness that varies smoothly between its break points."""
    k = Periodic.fit(lambda s: K * (1 + 0.3 * np.cos(2 * np.pi * s)), degree=10, tolerance=1e-13)
    packed = pack(MotionModel(two_discs(), (MeshExcitation.from_mesh(k),), 0.8 * NATURAL / 30))
    x, v = np.array([3.0]), np.array([0.5])
    exact = propagate(packed, x, v, packed.period, tolerance=1e-16).x
    errors = []
    counts = (24, 32, 48, 64, 96, 128)
    for steps in counts:
        got = propagate(packed, x, v, packed.period, tolerance=1e30, order=order, longest=packed.period / steps)
        errors.append(float(np.max(np.abs(got.x - exact))))
    # x carries the series to its order, velocities one less: the motion converges with order - 1 or better. Errors of
    # single steps cancel by chance at some step counts, so the order is the slope through all of them.
    observed = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order - 1.3 < observed < order + 1.0


def test_energy_balance():
    """Change of kinetic energy equals the work of torques, shafts, dampers and teeth, with contact loss, to 1e-10."""
    system = four_inertia(backlash=2e-5)
    train = system.train(jumping().mean)
    run = simulate(
        MotionModel(train, (MeshExcitation.from_mesh(jumping()),), 10_500 * math.pi / 30), 0.004, tolerance=1e-13
    )
    assert run.passage.changes > 4
    knots = run.passage.times * run.packed.time_unit
    nodes, weights = np.polynomial.legendre.leggauss(24)
    a, b = knots[:-1, None], knots[1:, None]
    t = 0.5 * (a + b) + 0.5 * (b - a) * nodes
    angle, rate, force = run.angles(t), run.angles(t, 1), run.mesh_forces(t)
    torque = train.torque - angle @ stiffness_matrix(train, meshes=False) - rate @ damping_matrix(train, meshes=False)
    torque = torque - force @ train.approach
    work = np.sum(0.5 * (b - a) * weights * np.sum(torque * rate, axis=-1))
    ends = run.angles(np.array([0.0, run.duration]), 1)
    kinetic = 0.5 * np.sum(train.inertia * ends**2, axis=-1)
    scale = 0.5 * np.max(np.sum(train.inertia * rate**2, axis=-1))
    assert abs((kinetic[1] - kinetic[0]) - work) < 1e-10 * scale


def test_speed_toward_zero_tends_to_the_static_answer():
    """With smooth excitation the largest force at 20, 10 and 5 rpm approaches the mean force, second order in speed."""
    excess = []
    for rpm in (400.0, 200.0, 100.0):
        found = MeshExcitation.from_mesh(Periodic.constant(K), cosine(2e-6))
        state = steady_state(MotionModel(two_discs(), (found,), rpm * math.pi / 30), tolerance=1e-11)
        excess.append(state.mesh_force_factor[0] - 1.0)
    assert excess[2] < 2e-4
    assert excess[0] / excess[1] == pytest.approx(4.0, rel=0.1) or excess[0] / excess[1] == pytest.approx(2.0, rel=0.1)
    assert excess[1] / excess[2] == pytest.approx(excess[0] / excess[1], rel=0.1)


def test_static_start_is_at_rest():
    packed = pack(MotionModel(four_inertia().train(3e8), (MeshExcitation.from_mesh(Periodic.constant(3e8)),), 1e-3))
    x, v = static_state(packed)
    after = propagate(packed, x, v, 50.0, tolerance=1e-13)
    assert after.x == pytest.approx(x, abs=1e-9)
    assert np.max(np.abs(after.v)) < 1e-9


def test_start_from_rest_strikes_twice_the_load():
    """A torque put on suddenly doubles the static deflection of an undamped oscillator."""
    still = MotionModel(two_discs(zeta=0.0), (MeshExcitation.from_mesh(Periodic.constant(K)),), 1.0)
    run = simulate(still, 4 * math.pi / NATURAL, start="rest", tolerance=1e-12)
    assert run.passage.largest[0] == pytest.approx(1000.0, rel=1e-9)
    assert run.approach(math.pi / NATURAL)[0] == pytest.approx(2 * 500.0 / K, rel=1e-9)


def test_rigid_shafts_are_the_limit_of_stiff_ones():
    k = MeshExcitation.from_mesh(jumping())
    factors = [
        steady_state(MotionModel(four_inertia(shaft).train(jumping().mean), (k,), 300.0), tolerance=1e-8)
        .mesh_force_factor[0]
        for shaft in (1e9, 1e10, math.inf)
    ]  # fmt: skip
    assert four_inertia(math.inf).train(1e8).size == 2
    assert abs(factors[1] - factors[2]) < 0.2 * abs(factors[0] - factors[2]) < 0.01


def test_identical_meshes_in_antiphase_cancel_on_the_shared_gear():
    """A gear between two equal ones: odd harmonics of the two meshes half a pitch apart cancel in its motion."""
    c = mesh_damping(0.03, K, R, R, J, J)
    train = Train(
        (Body("sun", J), Body("a", J), Body("b", J)),
        meshes=(Mesh("A", "sun", "a", R, R, 30, 30, K, c), Mesh("B", "sun", "b", R, R, 30, 30, K, c)),
        torques=(Torque("sun", 1000.0 * R), Torque("a", 500.0 * R), Torque("b", 500.0 * R)),
    )
    one = MeshExcitation.from_mesh(Periodic.constant(K), cosine(5e-8))
    speed = 0.9 * NATURAL / 30
    t = np.linspace(0, 2 * math.pi / (30 * speed), 64, endpoint=False)
    swing = {}
    for phase in (0.0, 0.5):
        state = steady_state(MotionModel(train, (one, replace(one, phase=phase)), speed), tolerance=1e-11)
        angle = state.trajectory(1).angles(t)[:, 0]
        swing[phase] = np.ptp(angle)
        if phase:
            force = state.trajectory(1).mesh_forces(t)
            assert force[:, 1] == pytest.approx(np.roll(force[:, 0], -32), rel=1e-8)
    assert swing[0.5] < 1e-8 * swing[0.0]


@pytest.mark.parametrize("law", ["constant", "momentary"])
@pytest.mark.parametrize(("ratio", "amplitude", "backlash"), [(1.0, 7.5e-6, 2e-5), (0.9, 5e-6, math.inf)])
def test_tangents_are_the_derivative_of_the_motion(ratio, amplitude, backlash, law):
    """Through teeth that part and touch, on both flanks, where damping sets in with a jump: central differences.

    The jump's sign was the wrong way round: multipliers of motions that lose contact were 7 % and more off.
    """
    found = model(ratio, amplitude, backlash=backlash)
    mesh = replace(found.train.meshes[0], damping_law=law)
    packed = pack(replace(found, train=replace(found.train, meshes=(mesh,))))
    x, v = static_state(packed)
    n, length = packed.size, 3.0 * packed.period

    def end(y):
        after = propagate(packed, y[:n], y[n:], length, tolerance=1e-13, peaks=False)
        return np.concatenate([after.x, after.v])

    y = np.concatenate([x, v])
    passage = propagate(packed, x, v, length, tolerance=1e-13, peaks=False, tangents=True)
    assert passage.changes >= 4
    assert (passage.behind[0] > 0.0) == math.isfinite(backlash)
    h = 1e-6
    differences = np.array([(end(y + h * e) - end(y - h * e)) / (2.0 * h) for e in np.eye(2 * n)]).T
    assert passage.tangent == pytest.approx(differences, abs=1e-6 * np.abs(differences).max())


def test_backlash_of_zero_is_a_two_sided_spring():
    """Swung beyond its static deflection, a pair without backlash follows the cosine through zero."""
    k = MeshExcitation.from_mesh(Periodic.constant(K))
    t = np.linspace(0.0, 6 * math.pi / NATURAL, 100)
    static, swing = 500.0 / K, 3 * 500.0 / K
    path = {}
    for backlash in (0.0, 1e-6):
        still = MotionModel(two_discs(zeta=0.0, backlash=backlash), (k,), 1.0)
        packed = pack(still)
        x, v = static_state(packed)
        run = simulate(still, t[-1], start=(x * (1 + swing / static), v), tolerance=1e-13)
        path[backlash] = run.approach(t)[:, 0]
        assert run.passage.changes > 4
    assert path[0.0] == pytest.approx(static + swing * np.cos(NATURAL * t), abs=1e-9 * swing)
    assert np.max(np.abs(path[1e-6] - path[0.0])) > 0.1 * swing


def test_zero_damping_at_resonance_is_refused():
    with pytest.raises(RangeError, match="is an undamped resonance: no steady-state"):
        steady_state(model(1.0, zeta=0.0))
    # off resonance an undamped train has a periodic motion all the same
    assert steady_state(model(0.7, zeta=0.0)).kind == "periodic"


@pytest.mark.dear("1.0-7.5e-06-2e-05-chaotic-0")
@pytest.mark.parametrize(
    ("ratio", "amplitude", "backlash", "kind", "periods"),
    [
        (1.3, 2.5e-6, 1e-5, "periodic", 2),
        (1.3, 7.5e-6, 2e-5, "periodic", 4),
        (0.4, 1.5e-5, 5e-6, "periodic", 3),
        (1.0, 7.5e-6, 2e-5, "chaotic", 0),
        pytest.param(0.5, 1.5e-5, 2e-5, "chaotic", 0, marks=pytest.mark.long),
    ],
)
def test_slack_teeth_that_hammer_both_flanks(ratio, amplitude, backlash, kind, periods):
    """Period multiples are found and chaos is named; the chaotic growth of tangents is seen on the motion itself."""
    state = steady_state(model(ratio, amplitude, backlash=backlash), tolerance=1e-6)
    assert (state.kind, state.periods) == (kind, periods)
    packed = pack(state.model)
    if kind == "periodic":
        assert np.abs(state.multipliers[0]) < 1.0
        after = propagate(packed, state.x, state.v, periods * packed.period, tolerance=1e-12)
        assert after.x == pytest.approx(state.x, abs=1e-4)
        once = propagate(packed, state.x, state.v, packed.period, tolerance=1e-12)
        assert np.max(np.abs(once.x - state.x)) > 1e-2
    else:
        assert state.growth > 0.1
        assert state.behind[0] > 0.0
        # two motions a hair apart part by about exp(growth) a period, on the mean over many: some draw them together
        n = 100
        one = propagate(packed, state.x, state.v, n * packed.period, tolerance=1e-13)
        two = propagate(packed, state.x + 1e-9, state.v, n * packed.period, tolerance=1e-13)
        assert np.max(np.abs(one.x - two.x)) > 1e-8


@pytest.mark.dear
def test_quasi_periodic_motion_is_named():
    """Shafts with a damping ratio of 0.005 near 11,000 rpm: multipliers leave the unit circle off the real axis."""
    system = four_inertia(backlash=2e-5, shaft_ratio=0.005)
    found = MotionModel(system.train(jumping().mean), (MeshExcitation.from_mesh(jumping()),), 10_242 * math.pi / 30)
    state = steady_state(found, tolerance=1e-6)
    assert state.kind == "quasi-periodic"
    assert state.periods == 0
    assert abs(state.growth) < 0.01


def test_hysteresis_between_sweeping_up_and_down():
    """The pair keeps its contact-loss branch when speed falls (PAPERS: unmodified gears)."""
    system = four_inertia()
    found = MotionModel(system.train(jumping().mean), (MeshExcitation.from_mesh(jumping()),), 1.0)
    speeds = np.arange(8000.0, 12001.0, 100.0) * math.pi / 30
    up = speed_chart(found, speeds, direction="up")
    down = speed_chart(found, speeds, direction="down")
    only_down = (down.apart > 0.0) & (up.apart == 0.0)
    assert np.count_nonzero(only_down) >= 3
    assert np.all(down.dynamic_factor[only_down] > 1.2 * up.dynamic_factor[only_down])
    same = ~only_down & (np.abs(up.apart - down.apart) < 1e-3)
    assert down.dynamic_factor[same] == pytest.approx(up.dynamic_factor[same], abs=2e-3)


def test_ground_damping_keeps_the_rigid_motion_in():
    """A slipping or grounded damper works against the free turning: same forces as Mark's transfer functions give."""
    c = mesh_damping(0.05, K, R, R, J, J)
    train = Train(
        (Body("1", J), Body("2", J), Body("3", 4 * J)),
        (Shaft("s", "2", "3", 3e4, 0.5),),
        (Mesh("g", "1", "2", R, R, 30, 30, K, c),),
        (Damper("1", None, 2.0), Damper("3", None, 1.0)),
        (Torque("1", 50.0), Torque("3", 50.0)),
    )
    from fegear.dynamics.train.tooth_force import dynamic_error

    speed, e = 0.7 * NATURAL / 30, cosine(1e-7, 3)
    state = steady_state(
        MotionModel(train, (MeshExcitation.from_mesh(Periodic.constant(K), e),), speed), tolerance=1e-11
    )
    t = np.linspace(0, state.model.period, 50)[1:-1]
    s = t * train.mesh_frequencies(speed)[0]
    fourier = 1000.0 + K * (dynamic_error(train, [e], 0, 0, speed, s, 8) - e(s))
    assert state.trajectory(1, tolerance=1e-13).mesh_forces(t)[:, 0] == pytest.approx(fourier, abs=1e-6)


def test_refusals():
    k = MeshExcitation.from_mesh(Periodic.constant(K))
    with pytest.raises(RangeError, match="must be positive"):
        MotionModel(two_discs(), (k,), 0.0)
    with pytest.raises(InputError, match="one per gear pair"):
        MotionModel(two_discs(), (), 1.0)
    with pytest.raises(InputError, match="is a negative mean force \\(working flanks"):
        MotionModel(two_discs(force=-1.0), (k,), 1.0)
    with pytest.raises(RangeError, match="tolerance"):
        steady_state(model(0.5), tolerance=0.0)
    with pytest.raises(InputError, match="start"):
        simulate(model(0.5), 1e-3, start="running")
    with pytest.raises(InputError, match="direction"):
        speed_chart(model(0.5), [1.0], direction="sideways")


def test_sweep_runs_in_the_order_given():
    states = speed_sweep(model(1.0), [100.0, 90.0, 95.0])
    assert [s.model.speed for s in states] == [100.0, 90.0, 95.0]


def test_idling_gears_rattle_and_have_no_dynamic_factor():
    """No mean load: the transmission error throws the gears about; a factor would divide by zero."""
    state = steady_state(model(0.6, 4e-6, force=0.0, backlash=1e-5, zeta=0.1))
    assert state.largest[0] > 0.0
    assert state.apart[0] > 0.0
    with pytest.raises(RangeError, match="mean force"):
        _ = state.dynamic_factor


def test_springs_are_packed_without_loss():
    """Pieces re-expanded about finer break points over a longer period give what the periodic functions give."""
    rng = np.random.default_rng(7)
    parts = [
        Periodic(np.array([0.0, *np.sort(rng.random(n)), 1.0]), 1.0 + rng.random((n + 1, d)), pitches)
        for n, d, pitches in ((2, 9, 3), (3, 2, 2))
    ]
    packed = pack(MotionModel(two_discs(), (MeshExcitation((parts[0],), (parts[1],)),), 100.0))
    units = packed.force_unit / packed.length_unit, packed.length_unit
    for u in rng.random(40):
        piece = int(np.searchsorted(packed.cuts, u, side="right")) - 1
        low, high = packed.cuts[piece : piece + 2]
        v = (2 * u - low - high) / (high - low)
        got = [unit * np.polynomial.polynomial.polyval(v, packed.poly[piece, q]) for q, unit in enumerate(units)]
        assert got == pytest.approx([float(part(6 * u)) for part in parts], rel=1e-12)


def test_a_tooth_pair_bears_no_more_than_its_mesh_where_two_begin_to_bear_at_once():
    """Their loads are a difference of nothing for a moment, and the damping force of the impact is finite."""
    slide, mesh_of = np.array([[3.0, 0.0]]), np.array([0, 0])
    for loads in ([1e-18, -0.9e-18], [-0.9e-18, 1e-18], [1e-18, 1e-18], [0.0, 0.0], [2.0, 1.0]):
        force = np.array([[load, 0.0] for load in loads])
        total = largest_force(force, slide, 2, mesh_of, 0, -1, 1.0, 1.0)
        shares = [largest_force(force, slide, 2, mesh_of, 0, s, 1.0, 1.0) for s in (0, 1)]
        assert all(0.0 <= share <= total * (1.0 + 1e-15) for share in shares)
        assert sum(shares) == pytest.approx(total if any(loads) else 0.0)
    assert largest_force(np.array([[2.0, 0.0], [1.0, 0.0]]), slide, 2, mesh_of, 0, 0, 1.0, 1.0) == pytest.approx(4.0)


@pytest.mark.parametrize("length", [0.119, 0.12, 0.121])
def test_the_dynamic_factor_is_smooth_where_a_relief_lets_two_pairs_begin_to_bear_at_once(length):
    """It was 3.0 to 5.0 (6.0 and 8.1 with a chart's own speeds) between 1.8890 at .115 and 1.8884 at .125."""
    case = CASES / "sources" / "lin_townsend_oswald_fig9.toml"
    relief = {"tip": {"amount_over_delta": 0.25, "normalised_length": length}}
    changes = {"gear.a.relief": relief, "effects.relief": True, "dynamics.speeds": ["11300 rpm"]}
    found = fegear.run(case, changes, results="dynamic-factor", progress=False)
    table = found.tables["dynamic_factor_I"]
    assert table["dynamic_factor"][0] == pytest.approx(1.8887, abs=4e-4)
    assert table["dynamic_factor"][0] <= table["mesh_force_factor"][0]


@pytest.mark.last_bit
def test_forces_where_a_piece_of_a_stiffness_ends_are_those_before_or_behind_it():
    """At a moment when a tooth takes the number of the next one the force was zero or 600 N by the last bit."""
    # one tooth after the other: from .3 base pitches on in the first slot, then up to .3 in the second
    ends = [0.0, 0.3, 0.3, 1.0]
    bears = tuple(Periodic.through_points(ends, of) for of in ([0.0, 0.0, K, K], [K, K, 0.0, 0.0]))
    excitation = MeshExcitation(bears, (cosine(5e-8), cosine(5e-8)), slotted=True)
    found = simulate(MotionModel(two_discs(), (excitation,), 0.8 * NATURAL / 30), 40 * 2 * math.pi / NATURAL)
    knots, short = found.passage.times * found.packed.time_unit, 1e-7 / NATURAL
    forces, before, behind = (found.mesh_forces(knots[1:-1] + d)[:, 0] for d in (0.0, -short, short))
    assert np.minimum(np.abs(forces - before), np.abs(forces - behind)).max() < 1e-4 * 500.0


@pytest.mark.parametrize("tangents", [False, True])
def test_long_steps_over_a_vibration_that_has_died_lead_where_short_ones_do(tangents):
    """Nearly rigid shafts that damp well: steps that their vibration would not allow, to the same state and forces."""
    springs = MeshExcitation.from_mesh(Periodic.constant(jumping().mean), cosine(5e-8))
    train = four_inertia(1e12, shaft_ratio=0.9).train(jumping().mean)
    packed = pack(MotionModel(train, (springs,), 150.0))
    start = starting_state(packed, "rest")
    long, short = (
        propagate(packed, *start, packed.period, tolerance=1e-9, tangents=tangents, longest=longest)
        for longest in (math.inf, 1e9)
    )
    assert long.steps < 0.2 * short.steps
    np.testing.assert_allclose(long.x, short.x, atol=1e-9)
    np.testing.assert_allclose(long.v, short.v, atol=1e-9)
    for name in ("largest", "smallest", "tooth_force"):
        np.testing.assert_allclose(getattr(long, name), getattr(short, name), rtol=1e-6)
    if tangents:
        np.testing.assert_allclose(long.tangent, short.tangent, atol=1e-7)
