"""Loads of planets over the mesh cycle: closed forms, enumeration of contact states, and what phasing cancels."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import ConvergenceError
from fegear.dynamics.planetary.one_sided import equilibrium
from fegear.dynamics.planetary.phases import phasing
from fegear.dynamics.planetary.planet_loads import force_on, planet_loads
from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.verify.planetary_sets import constant, jumping, meshed, unshifted
from fegear.verify.rolled import enumerated

SUN, RING, PIN = 3.0e8, 4.1e8, 2.2e8


def model(found, *, sun=0.0, ring=math.inf, carrier=math.inf, pin=PIN, mirrored=False):
    bodies = (CentralBody(bearing=bearing) for bearing in (sun, ring, carrier))
    return SetModel(found, *bodies, PlanetBody(pin=pin), mirrored)


def displaced(planets, n, tangential, radial=0.0):
    errors = np.zeros((2, planets))
    errors[:, n] = radial, tangential
    return errors


def test_a_mirrored_set_has_its_planets_on_the_other_side():
    found = unshifted(20, 20, 4)
    one, other = model(found), model(found, mirrored=True)
    np.testing.assert_array_equal(one.angles, found.angles)
    np.testing.assert_array_equal(other.angles, -found.angles)
    # the motion of the planets, and what it does at the meshes, is the mirror image
    assert np.sort(np.abs(one.mesh_rows), axis=None) == pytest.approx(np.sort(np.abs(other.mesh_rows), axis=None))


@pytest.mark.parametrize("planets", [3, 4, 5, 6])
@pytest.mark.parametrize("floating", [True, False])
@pytest.mark.parametrize("pin", [PIN, math.inf])
def test_a_pin_error_takes_load_as_the_closed_form_says(planets, floating, pin):
    """F_1 = F_0 - 2 cos a k e (1 - 3/N) with a floating sun, (1 - 1/N) with a held one."""
    found = unshifted(20, 20, planets, ring=60 if 80 % planets == 0 else 58) if planets < 6 else unshifted(30, 18, 6)
    made = model(found, sun=0.0 if floating else math.inf, pin=pin)
    run = meshed(made, constant(SUN), constant(RING))
    e = 1.5e-6
    loads = planet_loads(run, displaced(planets, 0, e))
    sun, ring = math.cos(found.sun_angle), math.cos(found.ring_angle)
    k = 1.0 / (1.0 / SUN + 1.0 / RING + (sun + ring) ** 2 / pin)
    if sun == ring:  # else the radial force of the pin takes its part as well
        asked = run.mean_force - (sun + ring) * k * e * (1.0 - (3.0 if floating else 1.0) / planets)
        assert np.allclose(loads.mesh_force[:, 0], asked, rtol=1e-10)
    assert np.allclose(loads.mesh_force.sum(axis=1), planets * run.mean_force, rtol=1e-12)
    assert np.allclose(loads.mesh_force[0], loads.mesh_force[1], rtol=1e-10)


def test_three_planets_and_a_floating_sun_share_whatever_the_pins_do():
    run = meshed(model(unshifted(24, 30, 3)), constant(SUN), constant(RING))
    loads = planet_loads(run, np.array([[3e-6, -9e-6, 0.0], [30e-6, -20e-6, 55e-6]]))
    assert np.allclose(loads.shares, 1.0, atol=1e-10)
    assert loads.mesh_load_factor == pytest.approx(1.0, abs=1e-10)


@pytest.mark.parametrize("error", [100e-6, 301e-6, 1e-3])
def test_of_four_planets_the_opposite_one_lifts_too(error):
    """Nothing holds the sun then in the direction of the two that lift; it stays where it is."""
    run = meshed(model(unshifted(24, 30, 4)), constant(SUN), constant(RING))
    loads = planet_loads(run, displaced(4, 0, error))
    k = 1.0 / (1.0 / SUN + 1.0 / RING + 4.0 * math.cos(math.radians(20.0)) ** 2 / PIN)
    left = max(0.0, 1.0 - 2.0 * math.cos(math.radians(20.0)) * k * error / 4.0 / run.mean_force)
    assert np.allclose(loads.shares, [left, 2.0 - left, left, 2.0 - left], atol=1e-10)
    assert np.all((loads.lifted > 0.5) == (np.array([True, False, True, False]) & (left == 0.0)))


def test_contact_states_are_those_of_an_enumeration():
    """Random pin errors, supports and stiffnesses; most of the sets lift one planet or several."""
    rng = np.random.default_rng(7)
    lifted = 0
    for _ in range(40):
        planets = int(rng.integers(2, 5))
        angles = np.sort(rng.choice(108, planets, replace=False)) * math.tau / 108
        found = unshifted(24, 30, angles - angles[0], addendum=-15.0)
        made = model(found, sun=10.0 ** rng.uniform(5, 9), ring=10.0 ** rng.uniform(7, 10))
        one, other = (10.0 ** rng.uniform(8, 9) for _ in range(2))
        run = meshed(made, constant(one), constant(other), torque=300.0)
        errors = rng.normal(0.0, 40e-6, (2, planets))
        loads = planet_loads(run, errors)
        free = made.freed(("ring", "carrier"))
        rows = made.mesh_rows.reshape(-1, made.size) @ free
        load = (made.torque_load(300.0) - PIN * errors.ravel() @ made.pin_rows.reshape(-1, made.size)) @ free
        k = np.repeat([one, other], planets)
        asked = enumerated(free.T @ made.held_stiffness() @ free, rows, k, np.zeros(len(rows)), load)
        assert asked is not None
        assert np.allclose(loads.mesh_force[..., 0].ravel(), asked, atol=1e-7 * run.mean_force)
        lifted += bool(np.any(asked == 0.0))
    assert lifted > 10


@pytest.mark.parametrize("other", ["stiffness", "separation", "load"])
def test_positions_that_are_alike_are_found_as_beside_one_that_differs(other):
    """Given stiffness makes all positions one, which is solved once."""
    rng = np.random.default_rng(11)
    held, rows = rng.normal(size=(4, 4)), rng.normal(size=(6, 4))
    each = {"stiffness": rng.uniform(0.5, 2.0, 6), "separation": rng.normal(size=6), "load": rng.normal(size=4)}
    alike = {key: np.tile(one, (5, 1)) for key, one in each.items()}
    differing = alike | {other: np.vstack([alike[other], 1.5 * each[other]])}
    differing = {key: one if key == other else np.vstack([one, one[:1]]) for key, one in differing.items()}
    found, beside = (equilibrium(held @ held.T, rows, **given) for given in (alike, differing))
    assert found.shape == (5, 4)
    assert found == pytest.approx(beside[:5], rel=1e-10)
    assert not np.allclose(beside[5], beside[4], rtol=1e-3)


def test_tooth_pairs_that_stand_apart_are_springs_of_their_own():
    """Two slots of one mesh with different separations, and a relief that takes contact from one of them."""
    ramp = Periodic.through_points([0.0, 1.0], [0.0, 30e-6])
    teeth = MeshExcitation((Periodic.constant(SUN), Periodic.constant(0.5 * SUN)), (Periodic.constant(0.0), ramp))
    run = meshed(model(unshifted(24, 30, 3), sun=1e8), teeth, constant(RING))
    loads = planet_loads(run)
    assert np.allclose(loads.shares, 1.0, atol=1e-9)  # all meshes in phase
    own = teeth.approach(run.mean_force, loads.s) + run.mean_force / RING
    pins = run.mean_force * 4.0 * math.cos(math.radians(20.0)) ** 2 / PIN
    assert np.allclose(loads.te, own + pins, rtol=1e-10)


@pytest.mark.parametrize(
    ("sun", "planet", "ring", "planets"), [(24, 30, 84, 3), (25, 29, 83, 3), (27, 31, 89, 4), (26, 29, 84, 5)]
)
def test_phases_cancel_what_the_rule_says(sun, planet, ring, planets):
    """Forces on supported members and the transmission error of the set, with real jumps of stiffness."""
    found = unshifted(sun, planet, planets, ring=ring)
    made = model(found, sun=8e7, ring=2e8, carrier=3e8)
    run = meshed(made, jumping(2.1e8, 3.3e8, 0.57), jumping(2.9e8, 3.8e8, 0.83))
    loads, orders = planet_loads(run), np.arange(1, 13)
    rule = phasing(found, 12)
    te = np.abs(loads.harmonics(loads.te, orders)) * 1e8
    assert np.all(te[rule.torque == 0.0] < 1e-9 * run.mean_force)
    assert np.all(te[rule.torque > 0.5][:3] > 1e-6 * run.mean_force)
    for member in ("sun", "ring", "carrier"):
        force = np.abs(loads.harmonics(force_on(loads, member), orders)).max(axis=0) / run.mean_force
        assert np.all(force[rule.force == 0.0] < 1e-9)
        assert np.any(force > 1e-4) == bool(np.any(rule.force > 0.0))
    whole = (orders * sun) % planets
    assert np.array_equal(rule.torque > 0.0, whole == 0)
    assert np.array_equal(rule.force > 0.0, (whole == 1) | (whole == planets - 1))


def test_a_set_of_one_planet_is_its_two_pairs_one_after_the_other():
    teeth = jumping(2.1e8, 3.3e8, 0.57), jumping(2.9e8, 3.8e8, 0.83)
    run = meshed(model(unshifted(24, 30, 1), sun=math.inf, pin=math.inf), *teeth)
    loads = planet_loads(run)
    assert loads.mesh_load_factor == pytest.approx(1.0, abs=1e-12)
    both = sum(
        one.approach(run.mean_force, loads.s - delay) for one, delay in zip(teeth, run.delays[:, 0], strict=True)
    )
    assert np.allclose(loads.te, both, rtol=1e-12)


def test_a_mirrored_set_is_the_same_set_seen_from_behind():
    angles = np.array([0, 30, 71]) * math.tau / 108
    found = unshifted(24, 30, angles)
    other = replace(found, angles=np.sort(math.tau - angles) - (math.tau - angles[2]))
    errors = np.array([[1e-6, 2e-6, -3e-6], [8e-6, -5e-6, 4e-6]])
    supports = {"sun": 1e8, "ring": 2e8, "carrier": 3e8}
    one = planet_loads(meshed(model(found, **supports), constant(SUN), constant(RING)), errors)
    turned = errors[:, ::-1] * [[1.0], [-1.0]]
    two = planet_loads(meshed(model(other, **supports, mirrored=True), constant(SUN), constant(RING)), turned)
    assert np.allclose(two.shares, one.shares[::-1], rtol=1e-9)


def test_the_same_loads_whichever_member_is_driven():
    """What is held does not matter without a support against turning; the transmission error is another one."""
    made = model(unshifted(25, 29, 3, ring=83), sun=8e7, ring=2e8, carrier=3e8)
    teeth = jumping(2.1e8, 3.3e8, 0.57), jumping(2.9e8, 3.8e8, 0.83)
    errors = displaced(3, 1, 12e-6, 5e-6)
    loads = [planet_loads(meshed(made, *teeth, driving=one), errors) for one in ("sun", "ring", "carrier")]
    for one in loads[1:]:
        assert np.allclose(one.mesh_force, loads[0].mesh_force, rtol=1e-8)


def test_stiff_pins_become_rigid_ones():
    teeth = jumping(2.1e8, 3.3e8, 0.57), jumping(2.9e8, 3.8e8, 0.83)
    errors = displaced(4, 2, 7e-6, -4e-6)
    found = unshifted(27, 31, 4, ring=89)
    stiff, rigid = (planet_loads(meshed(model(found, sun=1e8, pin=pin), *teeth), errors) for pin in (1e15, math.inf))
    assert np.allclose(stiff.mesh_force, rigid.mesh_force, rtol=1e-5)


def test_a_load_without_anything_to_bear_on_is_refused():
    with pytest.raises(ConvergenceError, match="No equilibrium of the planets found"):
        equilibrium(np.zeros((1, 1)), np.ones((1, 1)), np.ones((1, 1)), np.zeros((1, 1)), np.array([-1.0]))


@pytest.mark.parametrize("planets", [3, 5, 6])
def test_contact_states_of_more_planets_with_any_member_floating(planets):
    """Unequal places, pins of unequal error, and each of sun, ring and carrier floating, held or on a bearing."""
    rng = np.random.default_rng(20 + planets)
    lifted, balanced, supports = 0, 0, [0.0, math.inf, None]
    for _ in range(9 if planets < 6 else 4):
        angles = np.sort(rng.choice(108, planets, replace=False)) * math.tau / 108
        found = unshifted(24, 30, angles - angles[0], addendum=-15.0)
        held = [supports[int(rng.integers(3))] for _ in range(3)]
        sun, ring, carrier = (10.0 ** rng.uniform(7, 9) if one is None else one for one in held)
        if not (sun or ring or carrier):
            sun = math.inf  # one of them must know where the set is
        made = model(found, sun=sun, ring=ring, carrier=carrier, pin=10.0 ** rng.uniform(7.5, 9))
        one, other = (10.0 ** rng.uniform(8, 9) for _ in range(2))
        driving = ("sun", "ring", "carrier")[int(rng.integers(3))]
        run = meshed(made, constant(one), constant(other), torque=300.0, driving=driving)
        errors = rng.normal(0.0, 25e-6, (2, planets))
        free = made.freed([name for name in ("sun", "ring", "carrier") if name != driving])
        rows = made.mesh_rows.reshape(-1, made.size) @ free
        pins = made.pin_rows.reshape(-1, made.size)
        load = (made.torque_load(300.0) - made.planet.pin * errors.ravel() @ pins) @ free
        k, linear = np.repeat([one, other], planets), free.T @ made.held_stiffness() @ free
        asked = enumerated(linear, rows, k, np.zeros(len(rows)), load)
        if asked is None:  # planets on one side of members that float: nothing holds them
            with pytest.raises(ConvergenceError, match="No equilibrium of the planets found"):
                planet_loads(run, errors)
            continue
        balanced += 1
        assert np.allclose(planet_loads(run, errors).mesh_force[..., 0].ravel(), asked, atol=1e-6 * run.mean_force)
        lifted += bool(np.any(asked == 0.0))
    assert balanced > 2
    assert lifted > 0
