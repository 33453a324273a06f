"""Vibration of a planetary set against scipy: equations written anew from where teeth touch, integrated in time."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fegear.dynamics.motion.motion import simulate
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.planetary.planet_loads import planet_loads
from fegear.dynamics.planetary.set_motion import SetMotion
from fegear.dynamics.planetary.set_response import forced_response, linear_set
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.modes import modes
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Mesh, Train
from fegear.verify.planetary_sets import jumping, lin_parker, meshed

STEADY = 5.0e8


def contact_rows(model):
    """Approach of the teeth from rigid motions: where the line of action touches, velocities along its normal.

    Coordinates as the model's: x, y, u of sun, ring, carrier; zeta, eta, u of the planets.
    """
    found = model.found
    rows = np.zeros((2, found.count, model.size))
    radius = {name: found.base_radius(name) for name in ("sun", "planet", "ring")}
    for n, psi in enumerate(found.angles):
        out, along = np.array([math.cos(psi), math.sin(psi)]), np.array([-math.sin(psi), math.cos(psi)])
        for mesh, (sign, angle) in enumerate(((1.0, found.sun_angle), (-1.0, found.ring_angle))):
            push = sign * math.sin(angle) * out + math.cos(angle) * along  # on the planet
            if mesh == 1:
                push = -math.sin(angle) * out + math.cos(angle) * along
            central = ("sun", "ring")[mesh]
            pitch_point = found.centre_distance * out - sign * radius["planet"] / math.cos(angle) * out
            own = pitch_point - found.centre_distance * out
            turn = lambda arm: np.array([-arm[1], arm[0]])  # noqa: E731 - velocity of a point per unit rotation
            rows[mesh, n, 3 * mesh : 3 * mesh + 2] = push
            rows[mesh, n, 3 * mesh + 2] = push @ turn(pitch_point) / radius[central]
            p = 9 + 3 * n
            rows[mesh, n, p : p + 3] = -push @ out, -push @ along, -push @ turn(own) / radius["planet"]
    return rows


def test_the_rows_of_the_meshes_are_those_of_rigid_motions():
    model = lin_parker(4)
    assert np.allclose(model.mesh_rows, contact_rows(model), atol=1e-12)


def ripple(depth, phase=0.0):
    return Periodic.fit(lambda s: STEADY * (1.0 + depth * np.cos(2.0 * np.pi * (s - phase))))


def forces(run, rows, errors, q, s_sun):
    """Forces on all coordinates with the meshes at a place of the cycle."""
    model = run.model
    total = -model.held_stiffness() @ q + model.torque_load(run.sun_torque)
    total = total - model.planet.pin * np.tensordot(errors, model.pin_rows, axes=2)
    for mesh, one in enumerate(run.teeth):
        for n in range(model.count):
            s = s_sun - run.delays[mesh, n]
            for k, gap in zip(one.stiffness, one.separation, strict=True):
                total -= rows[mesh, n] * k(s) * max(rows[mesh, n] @ q - float(gap(s)), 0.0)
    return total


@pytest.mark.dear
@pytest.mark.parametrize("torque", [2000.0, 20.0])
def test_motion_with_contact_loss_is_that_of_scipy(torque):
    """From rest, on which the torque strikes: teeth part at once and often; pins stand off."""
    teeth = MeshExcitation((ripple(0.3),), (Periodic.fit(lambda s: 2e-6 * np.cos(2 * np.pi * s)),))
    run = meshed(lin_parker(3), teeth, MeshExcitation.from_mesh(ripple(0.2, 0.3)), torque)
    linear = linear_set(run, 0.04, 4)
    errors = np.array([[1e-6, 0.0, -1e-6], [3e-6, -2e-6, 0.0]])
    frequency, duration = 1500.0, 0.8e-3
    found = simulate(SetMotion(linear, frequency, errors), duration, start="rest")
    shapes = linear.modes.shapes[:, 1:]
    damp = 4.0 * math.pi * linear.damping_ratio * linear.modes.frequency[1:]

    def rate(t, y):
        x, v = np.split(y, 2)
        push = forces(run, rows, errors, shapes @ x, frequency * t)
        return np.concatenate([v, shapes.T @ push - damp * v])

    n, rows = shapes.shape[1], contact_rows(run.model)
    asked = solve_ivp(rate, (0.0, duration), np.zeros(2 * n), method="DOP853", rtol=1e-8, atol=1e-13)
    q = shapes @ asked.y[:n, -1]
    assert found.passage.changes >= 6
    assert np.max(np.abs(found.angles(duration) - q)) < 1e-5 * np.max(np.abs(q))


def test_a_small_excitation_moves_the_set_as_the_linear_answer_says():
    """Nothing parts; the engine integrates varying stiffness, the answer has its transmission error."""
    run = meshed(lin_parker(4), *(MeshExcitation.from_mesh(ripple(1e-5)) for _ in range(2)))
    linear = linear_set(run, 0.03, 3)
    for frequency in (1400.0, 1536.5, 1893.0):
        state = steady_state(SetMotion(linear, frequency), tolerance=1e-8)
        answer = forced_response(linear, frequency)
        most = state.largest - run.mean_force
        assert np.allclose(most[:4], answer.sun_force[0], rtol=2e-4)
        assert np.allclose(most[4:], answer.ring_force[0], rtol=2e-4)


def test_forced_response_is_that_of_a_dense_solve():
    """Unequal angles: every coordinate of (K - w^2 M + i w C) q = f, and forces of the meshes."""
    model = lin_parker(3)
    angles = np.array([0, 33, 77]) * math.tau / 108
    model = replace(model, found=replace(model.found, angles=angles))
    run = meshed(model, jumping(4e8, 5.5e8, 0.6), jumping(4.5e8, 5.8e8, 0.7))
    linear = linear_set(run, 0.02, 5)
    answer = forced_response(linear, [700.0, 1234.5])
    series = linear.series(5)
    rows, mass = contact_rows(model), np.diag(model.masses)
    stiffness = model.held_stiffness() + sum(k * r.T @ r for k, r in zip(linear.stiffness, rows, strict=True))
    whole = mass @ linear.modes.shapes
    damping = whole @ np.diag(4.0 * math.pi * 0.02 * linear.modes.frequency) @ whole.T
    for at, frequency in enumerate((700.0, 1234.5)):
        for n in range(5):
            w = 2.0 * math.pi * frequency * (n + 1)
            force = sum(k * e[:, n] @ r for k, e, r in zip(linear.stiffness, series, rows, strict=True))
            q = np.linalg.solve(stiffness - w**2 * mass + 1j * w * damping, force)
            assert np.allclose(answer.coordinate[at, n], q, rtol=1e-6, atol=1e-9 * np.max(np.abs(q)))
            dynamic = [k * (r @ q - e[:, n]) for k, e, r in zip(linear.stiffness, series, rows, strict=True)]
            assert np.allclose(answer.dynamic[at, n], dynamic, rtol=1e-6, atol=1e-6 * np.max(np.abs(dynamic)))


def test_phases_excite_only_the_modes_that_the_rule_names():
    """24/84 teeth and three planets in phase: rotational modes alone answer, the others nowhere."""
    run = meshed(lin_parker(3), jumping(4e8, 5.5e8, 0.6), jumping(4.5e8, 5.8e8, 0.7))
    linear = linear_set(run, 0.02, 6)
    answer = forced_response(linear, np.array([743.2, 1102.4, 1475.7]))
    across = np.abs(answer.coordinate[:, :, [0, 1, 3, 4, 6, 7]])
    assert np.max(across) < 1e-11 * np.max(np.abs(answer.coordinate))
    of_six = np.abs(answer.dynamic[:, :, 0]).sum(axis=1).max(axis=1)  # higher harmonics meet the mode at lower speeds
    assert of_six[2] > 3.0 * of_six[0]


def test_a_set_of_one_planet_vibrates_as_a_train_of_two_pairs():
    """Bearings held and the carrier at rest: sun, idler and ring, as the train of the same inertias."""
    model = lin_parker(1)
    bodies = {name: replace(getattr(model, name), bearing=math.inf) for name in ("sun", "ring", "carrier")}
    bodies["carrier"] = replace(bodies["carrier"], turning=math.inf)
    bodies["ring"] = replace(bodies["ring"], turning=0.0)
    model = replace(model, **bodies, planet=replace(model.planet, pin=math.inf))
    run = meshed(model, MeshExcitation.from_mesh(ripple(0.2)), MeshExcitation.from_mesh(ripple(0.1)))
    linear = linear_set(run, 0.05, 4)
    found = model.found
    r = [found.base_radius(name) for name in ("sun", "planet", "ring")]
    parts = [Body(name, getattr(model, name).inertia) for name in ("sun", "planet", "ring")]
    train = Train(
        tuple(parts), (),
        (Mesh("s", "sun", "planet", r[0], r[1], 24, 30, linear.stiffness[0]),
         Mesh("r", "planet", "ring", -r[1], r[2], 30, 84, linear.stiffness[1])),
    )  # fmt: skip
    assert np.allclose(linear.modes.frequency, modes(train).frequencies, rtol=1e-10)
    assert planet_loads(run).mesh_load_factor == pytest.approx(1.0, abs=1e-12)
