"""Torque ripple by formula and by law: two discs, branched trains from their own matrices, series of a file."""

import math
from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
from fegear.dynamics.helical_pair.model import HelicalPairModel, RigidGear
from fegear.dynamics.helical_pair.transmissibility import Line, pair_forces
from fegear.dynamics.motion.motion import simulate
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.matrices import damping_matrix, elements, mass_matrix, static_forces, stiffness_matrix
from fegear.dynamics.train.modes import modes, ripple_critical
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.torque_response import ripple_spectrum, torque_response
from fegear.dynamics.train.torque_ripple import TorqueRipple, _exact, _whole_cycles, common_period, ripple_of_curve
from fegear.dynamics.train.train import Body, Damper, Mesh, Shaft, Torque, Train

R = 0.05
FREQUENCIES = 2.0 * math.pi * np.geomspace(1.0, 2e4, 200)


def branched(damping=1.0):
    """Motor, shaft, pinion; wheel with a fan on a branch, second stage, machine; two dampers that slip."""
    d = damping
    return Train(
        bodies=(Body("motor", 1e-2), Body("pinion", 1e-3), Body("wheel", 4e-3), Body("fan", 2e-3),
                Body("pinion 2", 1e-3), Body("wheel 2", 3e-2), Body("machine", 0.4)),
        shafts=(Shaft("input", "motor", "pinion", 2e4, d), Shaft("branch", "wheel", "fan", 5e3, 0.2 * d),
                Shaft("middle", "wheel", "pinion 2", 6e4, 2.0 * d),
                Shaft("output", "wheel 2", "machine", 9e4, 4.0 * d)),
        meshes=(Mesh("first", "pinion", "wheel", R, 2 * R, 20, 40, 2e8, 500.0 * d),
                Mesh("second", "pinion 2", "wheel 2", -R, -3 * R, 17, 51, 4e8, 900.0 * d)),
        dampers=(Damper("fan", None, 0.3 * d), Damper("pinion", "wheel", 0.1 * d)),
        torques=(Torque("motor", 10.0), Torque("machine", -60.0)),
    )  # fmt: skip


def assembled(train, omega, body):
    """Mesh forces and shaft torques per torque from the plain equation of the angles."""
    load = np.zeros(train.size)
    load[train.dof[body]] = 1.0
    forces, shafts = [], []
    for w in omega:
        angle = np.linalg.solve(
            -w * w * mass_matrix(train) + 1j * w * damping_matrix(train) + stiffness_matrix(train), load
        )
        forces.append([(m.stiffness + 1j * w * m.damping) * (row @ angle)
                       for m, row in zip(train.meshes, train.approach, strict=True)])  # fmt: skip
        shafts.append([(s.stiffness + 1j * w * s.damping) * (angle[train.dof[s.a]] - angle[train.dof[s.b]])
                       for s in train.elastic_shafts])  # fmt: skip
    return np.array(forces).T, np.array(shafts).T


def exact(train, w, body, digits=50):
    """Mesh forces per torque in many digits."""
    with mpmath.workdps(digits):
        mp, n = mpmath.mpf, train.size
        w = mp(float(w))
        matrix, load = mpmath.matrix(n, n), mpmath.matrix(n, 1)
        load[train.dof[body]] = mp(1)
        for i in range(n):
            matrix[i, i] = -w * w * mp(float(train.inertia[i]))
        for e in elements(train):
            y = mpmath.mpc(mp(e.stiffness), w * mp(e.damping))
            ends = [(e.a, mp(e.radius_a))] + ([(e.b, mp(e.radius_b))] if e.b >= 0 else [])
            for p, rp in ends:
                for q, rq in ends:
                    matrix[p, q] += y * rp * rq
        angle = mpmath.lu_solve(matrix, load)
        return np.array([
            complex(mpmath.mpc(mp(m.stiffness), w * mp(m.damping))
                    * (mp(m.radius_a) * angle[train.dof[m.a]] + mp(m.radius_b) * angle[train.dof[m.b]]))
            for m in train.meshes
        ])  # fmt: skip


def test_two_discs_in_mesh():
    """x'' = R1 T/J1 - W (R1^2/J1 + R2^2/J2), W = (k + i w c) x: from 1e-3 Hz to far beyond the resonance."""
    one, two, k, c = 3e-3, 8e-3, 2e8, 1500.0
    train = Train(
        (Body("1", one), Body("2", two)), meshes=(Mesh("g", "1", "2", R, 2 * R, 20, 40, k, c),),
        torques=(Torque("1", 10.0), Torque("2", 20.0)),
    )  # fmt: skip
    w = 2.0 * math.pi * np.geomspace(1e-3, 1e5, 300)
    spring, per_mass = k + 1j * w * c, R**2 / one + 4.0 * R**2 / two
    found = torque_response(train, w, "1").forces[0]
    assert found == pytest.approx(spring * (R / one) / (spring * per_mass - w**2), rel=1e-12)
    other = torque_response(train, w, "2").forces[0]
    assert other == pytest.approx(spring * (2.0 * R / two) / (spring * per_mass - w**2), rel=1e-12)


def test_two_discs_on_a_damped_shaft():
    """Twist of the shaft (T/J1)/(K_s/J - w^2 + i w c/J), 1/J = 1/J1 + 1/J2, and the torque in it."""
    one, two, k, c = 2e-2, 5e-2, 3e4, 4.0
    train = Train((Body("1", one), Body("2", two)), shafts=(Shaft("s", "1", "2", k, c),))
    w = 2.0 * math.pi * np.geomspace(1e-3, 1e4, 300)
    spring = k + 1j * w * c
    twist = (1.0 / one) / (spring * (1.0 / one + 1.0 / two) - w**2)
    assert torque_response(train, w, "1").shafts[0] == pytest.approx(spring * twist, rel=1e-12)
    assert torque_response(train, w, "1").forces.shape == (0, 300)


@pytest.mark.parametrize("body", ["motor", "fan", "wheel", "machine"])
def test_a_branched_train_from_its_own_matrices(body):
    train = branched()
    forces, shafts = assembled(train, FREQUENCIES, body)
    found = torque_response(train, FREQUENCIES, body)
    assert np.max(np.abs(found.forces / forces - 1.0)) < 1e-9
    assert np.max(np.abs(found.shafts - shafts) / np.max(np.abs(shafts), axis=1)[:, None]) < 1e-9


@pytest.mark.parametrize("stiff", [2e4, 1e9, 1e14])
def test_slow_torque_and_stiff_shafts_keep_their_digits(stiff):
    """Against 50 digits, where angles are a billion times what springs yield."""
    train = branched(0.0 if stiff == 1e9 else 1.0)
    train = replace(train, shafts=(replace(train.shafts[0], stiffness=stiff), *train.shafts[1:]))
    for w in (1e-6, 1e-2, 7.0, 1e3, 3e4):
        for body in ("motor", "fan", "machine"):
            found, true = torque_response(train, w, body).forces, exact(train, w, body)
            assert np.max(np.abs(found / true - 1.0)) < 1e-12, (w, body)


def power_loop(damping):
    """Mark's four-square rig with a shaft between its right gears: two ways from each gear to every other."""
    d, r = damping, 0.0417693
    return Train(
        (Body("left", 4.112e-3), Body("test", 8.01e-4), Body("slave", 2.994e-3)),
        (Shaft("torque", "test", "slave", 3e4, 0.5 * d), Shaft("second", "slave", "test", 5e8, 0.1 * d)),
        (Mesh("I", "left", "test", r, r, 28, 28, 7.9e7), Mesh("II", "left", "slave", -r, -r, 35, 35, 4.75e8)),
        (Damper("left", None, 12.6 * d), Damper("test", "slave", 43.5 * d)),
        (Torque("test", 67.0), Torque("slave", -67.0)),
    )  # fmt: skip


@pytest.mark.parametrize("damping", [0.0, 1.0])
def test_closed_power_loops_keep_the_shares_of_their_ways(damping):
    """However slow the torque: what the springs of a loop yield is then far less than the train turns."""
    train = power_loop(damping)
    for w in (1e-6, 1.0, 1e3, 1e5):
        for body in ("left", "test"):
            assert torque_response(train, w, body).forces == pytest.approx(exact(train, w, body), rel=1e-12, abs=0.0), (
                w,
                body,
            )


@pytest.mark.parametrize("seed", range(20))
def test_random_trees_over_many_decades(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 8))
    bodies = tuple(Body(str(i), 10.0 ** rng.uniform(-5.0, 0.5)) for i in range(count))
    shafts, meshes = [], []
    for i in range(1, count):
        other = str(rng.integers(0, i))
        if i == 1 or rng.random() < 0.5:
            z = rng.integers(12, 90, 2)
            module, k, c = 10.0 ** rng.uniform((-3.2, 6.0, 0.0), (-2.0, 9.5, 3.5))
            meshes.append(Mesh(f"m{i}", other, str(i), *(0.5 * module * z), *(int(n) for n in z), k, c))
        else:
            shafts.append(Shaft(f"s{i}", other, str(i), *(10.0 ** rng.uniform((2.0, -3.0), (8.0, 1.0)))))
    dampers = tuple(Damper(b.name, None, 10.0 ** rng.uniform(-4.0, 1.0)) for b in bodies if rng.random() < 0.5)
    train = Train(bodies, tuple(shafts), tuple(meshes), dampers)
    body = bodies[int(rng.integers(0, count))].name
    for w in 2.0 * np.pi * np.logspace(-2.0, 4.5, 4):
        assert torque_response(train, w, body).forces == pytest.approx(exact(train, w, body), rel=1e-12, abs=0.0), w


def test_slow_torque_without_damping_is_shared_by_inertia():
    """Each mesh carries what the static train carries under the torque and the inertia forces of its rigid motion."""
    train = branched(0.0)
    ratio = train.ratios
    total = float(train.inertia @ ratio**2)
    for name in ("motor", "fan", "machine"):
        swing = ratio[train.dof[name]] / total
        torques = [
            Torque(b.name, (b.name == name) - b.inertia * ratio[train.dof[b.name]] * swing) for b in train.bodies
        ]
        still = static_forces(replace(train, torques=tuple(torques)))
        assert torque_response(train, 1e-4, name).forces == pytest.approx(still.astype(complex), rel=1e-9)


def test_a_rigid_shaft_is_the_limit_of_stiff_ones():
    train = branched()
    rigid = replace(train, shafts=(Shaft("input", "motor", "pinion", math.inf), *train.shafts[1:]))
    stiff = replace(train, shafts=(Shaft("input", "motor", "pinion", 1e15), *train.shafts[1:]))
    for body in ("motor", "pinion", "machine"):
        one, other = (torque_response(t, FREQUENCIES, body).forces for t in (rigid, stiff))
        assert np.max(np.abs(one / other - 1.0)) < 1e-6


def test_larger_machines_of_one_shape_answer_alike():
    """Inertia, stiffness and damping 1000 times as large: the same share of the torque at every frequency."""
    train = branched()
    large = Train(
        tuple(replace(b, inertia=1e3 * b.inertia) for b in train.bodies),
        tuple(replace(s, stiffness=1e3 * s.stiffness, damping=1e3 * s.damping) for s in train.shafts),
        tuple(replace(m, stiffness=1e3 * m.stiffness, damping=1e3 * m.damping) for m in train.meshes),
        tuple(replace(d, damping=1e3 * d.damping) for d in train.dampers), train.torques,
    )  # fmt: skip
    one, other = (torque_response(t, FREQUENCIES, "motor").forces for t in (train, large))
    assert np.max(np.abs(one / other - 1.0)) < 1e-11


@pytest.mark.parametrize(("radius_b", "inertia_b"), [(R, 1.0), (2.0 * R, 4.0), (-R, 1.0), (-3.0 * R, 9.0)])
def test_a_mode_in_which_damped_teeth_roll_without_force_has_no_damping(radius_b, inertia_b):
    """Disc, shaft, gear on either side, one the other's image: they roll as one, and only the shafts are strained."""
    turns = (R / radius_b) ** 2
    train = Train(
        bodies=(
            Body("disc", 4e-2), Body("gear", 1e-2), Body("mate", 1e-2 * inertia_b), Body("other", 4e-2 * inertia_b),
        ),
        shafts=(Shaft("a", "disc", "gear", 1e4), Shaft("b", "mate", "other", 1e4 * inertia_b)),
        meshes=(Mesh("m", "gear", "mate", R, radius_b, 20, round(20 * abs(radius_b) / R), 3e8, 700.0),),
    )  # fmt: skip
    assert turns * inertia_b == pytest.approx(1.0)
    omega = math.sqrt(1e4 * (1.0 / 4e-2 + 1.0 / 1e-2))
    natural = 2.0 * math.pi * modes(train).frequencies
    assert np.abs(natural / omega - 1.0).min() < 1e-12
    met = natural[np.abs(natural / omega - 1.0).argmin()]
    with pytest.raises(RangeError, match="is a natural frequency of the undamped train:"):
        torque_response(train, met, "disc")
    assert np.isfinite(torque_response(train, 1.01 * met, "disc").forces).all()
    # A mode that strains the teeth is damped: a resonance, but not without bound.
    others = [one for one in natural[1:] if abs(one / omega - 1.0) > 1e-6]
    assert np.isfinite(torque_response(train, np.array(others), "disc").forces).all()


def test_resonance_without_damping_is_refused_and_with_it_not():
    train = branched(0.0)
    natural = 2.0 * math.pi * modes(train).frequencies[2]
    with pytest.raises(RangeError, match="is a natural frequency of the undamped train:"):
        torque_response(train, [1.0, natural], "motor")
    assert np.all(np.isfinite(torque_response(branched(), natural, "motor").forces))
    for w in (0.0, math.inf, -1.0):
        with pytest.raises(RangeError, match="positive and finite"):
            torque_response(train, w, "motor")
    with pytest.raises(InputError, match="not a body"):
        torque_response(train, 1.0, "engine")


def test_a_spectrum_is_response_times_torque_at_orders_and_at_fixed_frequencies():
    train, speed = branched(), 200.0
    of_order = TorqueRipple("a", "motor", (3.0, 0.0, 2.0), (0.4, 0.0, 1.0), (5, 2))
    fixed = TorqueRipple("b", "fan", (1.0,), (0.0,), frequency=77.0)
    found = ripple_spectrum(train, (of_order, fixed), [speed, 2.0 * speed])
    assert found.of == (0, 0, 1)
    assert found.harmonics.tolist() == [1, 3, 1]
    base = 2.5 * speed / (2.0 * math.pi)
    assert found.frequencies == pytest.approx(np.array([[base, 2 * base], [3 * base, 6 * base], [77.0, 77.0]]))
    w = 2.0 * math.pi * 3.0 * base
    expected = 2.0 * np.exp(1j) * assembled(train, [w], "motor")[0][:, 0]
    assert found.forces[:, 1, 0] == pytest.approx(expected, rel=1e-9)
    assert np.array_equal(found.forces[:, 2, 0], found.forces[:, 2, 1])
    # a whole turn of phase is none
    turned = replace(of_order, phases=tuple(p + 2.0 * math.pi for p in of_order.phases))
    assert ripple_spectrum(train, (turned,), [speed]).forces == pytest.approx(found.forces[:, :2, :1], rel=1e-14)
    critical = ripple_critical(of_order, np.array([100.0]))
    assert of_order.frequencies(critical[1, 0])[1] == pytest.approx(100.0)


def test_series_of_a_triangle_and_what_is_left_out():
    """|A_n| = 8/(pi n)^2 for odd n; Parseval counts the rest; the first angle only shifts the phase."""
    angle = np.array([0.0, 90.0, 180.0]) / 360.0
    ripple, mean = ripple_of_curve("t", "m", angle, [1.0, -1.0, 1.0], 5, Fraction(3))
    assert ripple.order == (6, 1)
    assert mean == pytest.approx(0.0, abs=1e-15)
    assert ripple.harmonics.tolist() == [1, 3, 5]
    assert np.abs(ripple.torques) == pytest.approx([8.0 / (math.pi * n) ** 2 for n in (1, 3, 5)], rel=1e-13)
    assert ripple.torques.imag == pytest.approx([0.0] * 3, abs=1e-15)
    known = sum(0.5 * (8.0 / (math.pi * n) ** 2) ** 2 for n in (1, 3, 5))
    assert ripple.left_out == pytest.approx(math.sqrt(1.0 / 3.0 - known), rel=1e-9)
    late, lifted = ripple_of_curve("t", "m", angle + 0.125, [4.0, 2.0, 4.0], 5, Fraction(3))
    assert lifted == pytest.approx(3.0)
    assert late.torques == pytest.approx(
        ripple.torques * np.exp(-2j * math.pi * 0.25 * ripple.harmonics), rel=1e-12, abs=0.0
    )
    timed, _ = ripple_of_curve("t", "m", [0.0, 0.01, 0.02], [1.0, -1.0, 1.0], 5)
    assert (timed.order, timed.frequency) == (None, pytest.approx(50.0))
    low, high = ripple.extremes(ripple.torques)
    assert high == pytest.approx(float(np.abs(ripple.torques).sum()), rel=1e-12)
    assert low == pytest.approx(-high, rel=1e-12)


def test_the_common_period_is_exact_where_there_is_one():
    def of(*ripple, speed=100.0 * math.pi):
        return common_period(Fraction(1, 21), Fraction(21), speed, ripple)

    def line(order=None, frequency=0.0):
        return TorqueRipple("r", "m", (1.0,), (0.0,), order, frequency)

    assert of(line((2, 1))) == of(line((1, 1))) == of(line(frequency=50.0))
    assert of(line((2, 1))).count == 21
    assert of(line((3, 1))) == of(line(frequency=150.0))
    assert of(line((3, 1))).count == 7
    assert of(line((21, 1))).count == of(line((42, 1))).count == 1
    assert of(line((1, 2)), line((3, 7))).count == 14 * 21
    assert of(line((2, 1))).stretch == (1.0,)
    # none: a circle's number of periods in a turn; shifted by at most a ten-thousandth
    shifted = of(line(frequency=50.0 * math.pi))
    assert 0.0 < abs(shifted.stretch[0] - 1.0) <= 1e-4
    cycles = shifted.count / 21 * math.pi * shifted.stretch[0]
    assert cycles == pytest.approx(round(cycles), abs=1e-9)
    with pytest.raises(RangeError, match="is too low: the motion does not repeat within"):
        of(line(frequency=0.01))


def two_discs():
    k, c = 2e8, 1500.0
    return Train(
        (Body("1", 3e-3), Body("2", 8e-3)), meshes=(Mesh("g", "1", "2", R, 2 * R, 20, 40, k, c),),
        torques=(Torque("1", 50.0), Torque("2", 100.0)),
    )  # fmt: skip


@pytest.mark.parametrize("train", [two_discs(), branched()], ids=["two discs", "branched"])
def test_motion_of_constant_springs_is_the_linear_response(train):
    """Mesh forces over the common period are the mean and every line, to 1e-9 of the mean, the train turning freely or
    held by a damper to ground."""
    springs = tuple(
        replace(MeshExcitation.from_mesh(Periodic.constant(m.stiffness)), parting=False) for m in train.meshes
    )
    first, last = train.bodies[0].name, train.bodies[-1].name
    ripple = (
        TorqueRipple("a", first, (12.0, 4.0), (0.7, 0.2), (3, 2)),
        TorqueRipple("b", last, (20.0,), (1.0,), frequency=50.0),
    )
    free = MotionModel(train, springs, 50.0 * math.pi, ripple=ripple)
    state = steady_state(free, tolerance=1e-10)
    assert state.kind == "periodic"
    time = np.linspace(0.0, free.period, 4001)
    found = state.trajectory().mesh_forces(time)
    lines = ripple_spectrum(train, ripple, [50.0 * math.pi])
    expected = free.static + np.real(
        np.exp(2j * math.pi * np.outer(time, lines.frequencies[:, 0])) @ lines.forces[:, :, 0].T
    )
    assert np.max(np.abs(found - expected)) < 1e-9 * float(free.static.max())
    assert state.largest == pytest.approx(expected.max(axis=0), rel=1e-5)


def test_no_amplitude_changes_no_bit_and_a_period_later_all_is_the_same():
    train = two_discs()
    swing = Periodic.fit(lambda s: 2e8 * (1.0 + 0.2 * np.cos(2.0 * np.pi * s)), degree=10, tolerance=1e-12)
    plain = MotionModel(train, (MeshExcitation.from_mesh(swing),), 300.0)
    silent = replace(plain, ripple=(TorqueRipple("r", "1", (0.0,), (0.3,), (20, 1)),))
    one, other = (simulate(m, 0.004, tolerance=1e-10) for m in (plain, silent))
    for key in ("x", "v", "times", "polynomials"):
        assert np.array_equal(getattr(one.passage, key), getattr(other.passage, key)), key
    loud = replace(plain, ripple=(TorqueRipple("r", "1", (15.0,), (0.3,), (7, 1)),))
    state = steady_state(loud, tolerance=1e-9)
    ahead = simulate(loud, 2.0 * loud.period, start=(state.x, state.v), tolerance=1e-12)
    time = np.linspace(0.0, loud.period, 101)
    before, after = (ahead.mesh_forces(t) for t in (time, time + loud.period))
    assert np.max(np.abs(before - after)) < 1e-7 * float(loud.static[0])


def test_two_discs_carry_the_external_torque_of_the_helical_pair():
    """Blankenship and Singh, (10) and (20): an external moment on the driver of a pair whose bearings do not yield."""
    bearing, stiffness = np.diag([1e16, 1e16, 1e14, 1e14, 0.0]), 3e8
    gears = [RigidGear(2.9, (8e-3, 8e-3, j), r, 0.02, bearing) for j, r in ((3e-3, R), (2e-2, 2 * R))]
    pair = HelicalPairModel(*gears, MeshParameters(stiffness, 0.0, 1.0 / 3.0, 0.0))
    train = Train(
        (Body("1", 3e-3), Body("2", 2e-2)), meshes=(Mesh("g", "1", "2", R, 2 * R, 20, 40, stiffness),),
        torques=(Torque("1", 10.0), Torque("2", 20.0)),
    )  # fmt: skip
    for frequency in (10.0, 500.0, 3000.0, 9000.0):
        w = 2.0 * math.pi * frequency
        moment = Line(0.0, w, on_driver=(0.0, 0.0, 0.0, 0.0, 1.0))
        force = abs(pair_forces(pair, [moment], [100.0]).mesh[0, 0, 0])
        assert abs(torque_response(train, w, "1").forces[0]) == pytest.approx(force, rel=1e-6)


@pytest.mark.parametrize("cycles", [7.0 / 3.0, 1501.0 / 3.0, 0.01])
def test_a_frequency_means_a_ratio_of_whole_numbers_to_the_digits_of_a_double(cycles):
    ripple = TorqueRipple("pump", "1", (1.0,), (0.0,), None, 5.0)
    meant = Fraction(cycles).limit_denominator(1000)
    for off, found in ((0.0, meant), (3e-12, meant), (-3e-12, meant), (3e-11, None), (-3e-11, None)):
        assert _whole_cycles(ripple, Fraction(1, 21), cycles * (1.0 + off), 2000) == found
    assert _whole_cycles(ripple, Fraction(1, 21), math.pi, 2000) is None
    of_order = TorqueRipple("pump", "1", (1.0,), (0.0,), (5, 2))
    assert _whole_cycles(of_order, Fraction(1, 21), math.nan, 1) == Fraction(5, 42)


def test_a_span_is_the_ratio_that_its_digits_mean():
    for span, ratio in ((0.33333333, Fraction(1, 3)), (2.0, Fraction(2)), (0.0416666667, Fraction(1, 24))):
        assert _exact(span) == ratio
    assert _exact(0.33333) == Fraction(33333, 100000)  # too few digits for a third: it is what is written
    assert _exact(1e-4) == Fraction(1, 10000)
