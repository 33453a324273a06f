"""Forces of an excited pair against integration in time, against Newton's law, and against limits."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fegear.base.errors import InputError, RangeError
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters, partial_face_mu
from fegear.dynamics.helical_pair.model import HelicalPairModel, P, ReducedPairModel, RigidGear
from fegear.dynamics.helical_pair.transmissibility import (
    Line,
    compliance,
    joined_lines,
    pair_forces,
    reduced_transmissibility,
    resonant_speeds,
)


def gear(mass, a, b, torsion=0.0):
    K = np.diag([6e8, 1.5e8, 2e5, 4e5, torsion])
    return RigidGear(mass, (0.4 * mass * a**2, 0.5 * mass * a**2, 0.6 * mass * a**2), a, b, K, 6e-5 * K)


def unequal(torsion=1e5):
    mesh = MeshParameters(3e8, 0.3, partial_face_mu(0.3), math.radians(25.0))
    return HelicalPairModel(gear(2.0, 0.05, 0.02, torsion), gear(5.0, 0.09, 0.02, torsion), mesh, 6e-5)


LINES = (
    Line(20.0, error=(1e-6, 2e-7j, 0.0, 0.0, 0.0), source="transmission error"),
    Line(40.0, error=(-3e-7j, 0.0, 1e-7, 0.0, 0.0), source="transmission error"),
    Line(20.0, on_driver=(50.0, 0.0, 0.0, 0.0, 12.0j), source="torque"),
    Line(30.0, on_driven=(0.0, 80.0, 0.0, 3.0, 0.0), source="axial force"),
)


def test_against_integration_of_the_equations_of_motion_in_time():
    """Eqs. 1, 9, 10 and 11 as they stand, run into their steady state; then the Fourier lines of the mesh force."""
    model, speed = unequal(), 240.0
    K, C, M = model.stiffness, model.damping, model.mass
    k, c = model.mesh_stiffness_matrix, model.mesh_damping_matrix
    size_i, size_j = 1.0 / model.driver.scale, 1.0 / model.driven.scale

    w = np.array([line.order * speed for line in LINES])
    error = np.array([line.error for line in LINES])
    drive = np.array([
        np.concatenate([k @ e + 1j * n * c @ e, P @ (k @ e + 1j * n * c @ e)])
        + np.concatenate([line.on_driver / size_i, line.on_driven / size_j])
        for n, e, line in zip(w, error, LINES, strict=True)
    ])  # fmt: skip
    system = np.block([[np.zeros((10, 10)), np.eye(10)], [-K / M[:, None], -C / M[:, None]]])

    def right(t, state):
        rate = system @ state
        rate[10:] += (np.exp(1j * w * t) @ drive).real / M
        return rate

    period = 2.0 * math.pi / (10.0 * speed)  # all orders are multiples of ten
    found = solve_ivp(right, (0.0, 21.0 * period), np.zeros(20), method="DOP853", rtol=1e-8, atol=1e-14,
                      t_eval=20.0 * period + period * np.arange(64) / 64)  # fmt: skip
    q, v = found.y[:10], found.y[10:]
    mesh, bearing = [], []
    for n, t in enumerate(found.t):
        delta, rate = (np.exp(1j * w * t) @ error).real, (1j * w * np.exp(1j * w * t) @ error).real
        apart, speed_apart = q[:5, n] + P @ q[5:, n] - delta, v[:5, n] + P @ v[5:, n] - rate
        mesh.append(size_i * -(k @ apart + c @ speed_apart))
        i = model.driver
        bearing.append(size_i * -(i.in_q(i.bearing_stiffness) @ q[:5, n] + i.in_q(i.bearing_damping) @ v[:5, n]))
    lines = 2.0 * np.fft.fft(mesh, axis=0) / 64
    of_bearing = 2.0 * np.fft.fft(bearing, axis=0) / 64
    forces = pair_forces(model, LINES, [speed])
    orders = [line.order for line in forces.lines]
    assert orders == [20.0, 30.0, 40.0]
    for number, order in enumerate(orders):
        at = round(order / 10.0)
        assert forces.mesh[number, 0] == pytest.approx(lines[at], rel=2e-5, abs=2e-6 * np.abs(lines).max())
        assert forces.bearing_driver[number, 0] == pytest.approx(
            of_bearing[at], rel=2e-5, abs=2e-6 * np.abs(lines).max()
        )


def test_lines_of_one_frequency_add_up_and_all_is_linear():
    model, speeds = unequal(), [100.0, 333.0]
    together = pair_forces(model, LINES, speeds)
    assert together.lines[0].source == "transmission error + torque"
    alone = [pair_forces(model, [LINES[n]], speeds).mesh[0] for n in (0, 2)]
    assert together.mesh[0] == pytest.approx(alone[0] + alone[1], rel=1e-12)
    assert len(joined_lines([Line(0.1 + 0.2), Line(0.3)])) == 1
    assert together.frequency[2] == pytest.approx(40.0 * np.array(speeds))


def test_a_force_of_a_fixed_frequency_does_not_know_the_speed():
    model = unequal()
    forces = pair_forces(model, [Line(0.0, 3000.0, on_driver=(1.0, 0.0, 0.0, 0.0, 0.0))], [10.0, 500.0])
    same = pair_forces(model, [Line(1.0, on_driver=(1.0, 0.0, 0.0, 0.0, 0.0))], [3000.0])
    assert forces.mesh[0] == pytest.approx(np.repeat(same.mesh[0], 2, axis=0), rel=1e-12)


def test_the_mesh_force_is_a_normal_force_and_a_moment_about_x():
    """Section 3.3: the mesh carries a force along eta and a moment about X, nothing else."""
    model = unequal()
    forces = pair_forces(model, LINES, np.linspace(50.0, 600.0, 40))
    c, s, a = math.cos(model.mesh.base_helix_angle), math.sin(model.mesh.base_helix_angle), model.driver.base_radius
    for component, factor in ((0, c), (1, s), (3, -s * a), (4, c * a)):
        assert forces.mesh[:, :, component] == pytest.approx(factor * forces.normal, rel=1e-10, abs=1e-9)


def test_twenty_and_ten_coordinates_agree_for_equal_gears():
    mesh = MeshParameters(3e8, 0.5, 1.0 / 3.0, math.radians(30.0))
    small = ReducedPairModel.from_ratios(
        mesh, mass=2.882, aspect_ratio=0.3, alpha_y=2.0, alpha_z=0.5, alpha_theta=0.4, modal_damping=0.04
    )
    a, b = 0.07048, 0.021144
    big = small.both_gears(a, b)
    assert big.symmetric
    assert big.natural_frequency == pytest.approx(small.natural_frequency, rel=1e-12)
    speeds = small.natural_frequency * np.linspace(0.1, 2.0, 20)
    forces = pair_forces(big, [Line(1.0, error=(1e-6, 0.0, 0.0, 0.0, 0.0))], speeds)
    reduced = reduced_transmissibility(small, speeds)
    size = np.array([1.0, 1.0, b, a, a])
    assert forces.mesh[0] == pytest.approx(1e-6 * reduced.G[:, :, 0] * size, rel=1e-9, abs=1e-9)
    assert forces.bearing_driver[0] == pytest.approx(-1e-6 * reduced.G_B[:, :, 0] * size, rel=1e-9, abs=1e-9)
    # The driven gear's bearing feels the same, mirrored.
    mirror = np.diag(P)
    assert forces.bearing_driven[0] == pytest.approx(mirror * forces.bearing_driver[0], rel=1e-9, abs=1e-9)


def test_slow_gears_that_turn_freely_carry_no_force_of_a_transmission_error():
    forces = pair_forces(unequal(0.0), [Line(1.0, error=(1e-6, 0.0, 0.0, 0.0, 0.0))], [0.0001, 1.0, 10.0])
    # The inertia of the gears is all that resists: force in proportion to frequency squared, down to round-off.
    assert np.abs(forces.normal[0, 2]) == pytest.approx(1e2 * np.abs(forces.normal[0, 1]), rel=1e-3)
    assert np.abs(forces.normal[0, 0]) < 1e-9 * 300.0


def test_resonances_without_damping_are_refused_and_told():
    model = unequal()
    bare = HelicalPairModel(
        *(RigidGear(g.mass, g.inertia, g.base_radius, g.half_face_width, g.bearing_stiffness) for g in
          (model.driver, model.driven)), model.mesh)  # fmt: skip
    at, undamped = resonant_speeds(bare, LINES)
    assert at.size == undamped.size == 3 * 10
    for speed in at[[0, 7, -1]]:
        with pytest.raises(RangeError, match="is an undamped resonance: unbounded response"):
            pair_forces(bare, LINES, [10.0, speed])
    assert np.isfinite(pair_forces(bare, LINES, at * (1.0 + 1e-6)).mesh).all()
    assert resonant_speeds(bare, [Line(0.0, 100.0)])[0].size == 0
    assert resonant_speeds(model, LINES)[1].size == 0


def test_one_mode_without_damping_among_damped_ones_is_refused_at_its_resonance():
    """A spur pair whose driven gear alone moves along its axis, undamped: the other modes are damped."""
    C = np.diag([1e3, 1e3, 5.0, 5.0, 5.0])
    held = RigidGear(2.0, (0.002, 0.0025, 0.003), 0.05, 0.02, np.diag([6e8, 1e8, 2e5, 4e5, 1e5]), C)
    free = RigidGear(5.0, (0.02, 0.025, 0.03), 0.09, 0.02, np.diag([6e8, 1.5e8, 2e5, 4e5, 1e5]), C * [1, 0, 1, 1, 1])
    model = HelicalPairModel(held, free, MeshParameters(3e8), 1e-6)
    every, undamped = resonant_speeds(model, [Line(1.0)])
    assert every.size == 10
    assert undamped == pytest.approx([math.sqrt(1.5e8 / 5.0)], rel=1e-12)
    for method in ("direct", "modal", "state-space"):
        with pytest.raises(RangeError, match="is an undamped resonance: unbounded response"):
            compliance(model, undamped, method)
    assert np.isfinite(compliance(model, every[every != undamped[0]])).all()


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: Line(0.0, 0.0), "greater than zero"),
        (lambda: Line(-1.0), "greater than zero"),
        (lambda: Line(math.nan), "greater than zero"),
        (lambda: Line(1.0, error=(math.inf, 0, 0, 0, 0)), "finite"),
        (lambda: pair_forces(unequal(), LINES, [0.0]), "greater than zero"),
        (lambda: pair_forces(unequal(), [], [1.0]), "at least one"),
    ],
)
def test_nonsense_is_refused(build, words):
    with pytest.raises(InputError, match=words):
        build()
