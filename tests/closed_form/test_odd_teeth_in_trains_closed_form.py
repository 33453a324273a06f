"""Springs of a pair with odd teeth in a train: its load sharing over a revolution, motions by own integration."""

import functools
import itertools
import math

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from fegear.contact.odd_flank import OddFlank, Pit
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.odd_compliance import odd_compliance
from fegear.contact.plane.over_revolution import over_revolution
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train import mesh_excitation as springs
from fegear.dynamics.train.mesh_excitation import mesh_excitation
from fegear.dynamics.train.train import Body, Mesh, Torque, Train
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack

MODULE, WIDTH = 2e-3, 20e-3


def gear(teeth, addendum=1.0):
    tooth = Tooth(teeth, BasicRack(addendum, addendum + 0.25, 0.2))
    return Gear(tooth, MODULE, tooth.root_radius * 0.5 * MODULE, WIDTH, Material(206e9))


PAIR = GearPair(gear(17), gear(19))
LOAD = 30.0 / PAIR.driver.base_radius


@functools.cache
def ordinary(pair, member):
    return solve_gear(pair.gear(member), settings_at(-4), reach=2)


@functools.cache
def cracked(share=0.5):
    tooth = PAIR.driver.tooth
    crack = straight_crack(tooth, mouth_at_tangent(tooth, math.radians(30.0)), math.radians(70.0), share=share)
    return odd_compliance(solve_cracked_gear(ordinary(PAIR, "driver"), {0: crack}))


def engagement(driver=None, pair=PAIR, coupling=True, **more):
    sources = [finite_element_compliance(ordinary(pair, member)) for member in MEMBERS]
    compliance = PairCompliance(
        pair, driver or sources[0], sources[1], hertz="linear", nominal_load=LOAD, coupling=coupling
    )
    return Engagement(compliance, **more)


@functools.cache
def cracked_springs():
    return mesh_excitation(engagement(cracked()), LOAD)


@functools.cache
def over_cracked():
    return over_revolution(engagement(cracked()), LOAD, 40)


def static_errors(found, of, pair):
    """Transmission errors of the springs at the places of a revolution."""
    return of.approach(LOAD, found.along / pair.base_pitch)


@pytest.mark.dear
def test_springs_of_a_cracked_pair_carry_its_load_over_the_revolution():
    of, found = cracked_springs(), over_cracked()
    assert {k.pitches for k in of.stiffness} == {17}
    assert static_errors(found, of, PAIR) == pytest.approx(found.transmission_error, rel=1e-6)
    assert np.ptp(found.transmission_error.max(axis=1)) > 0.2 * found.transmission_error.max()
    turned = static_errors(found, of, PAIR)[::-1]  # counted the wrong way round
    assert np.abs(turned / found.transmission_error - 1.0).max() > 0.05


@pytest.mark.dear
def test_base_pitches_with_the_same_teeth_are_fitted_once(monkeypatch):
    fitted = []
    one_pitch = springs._one_pitch
    monkeypatch.setattr(springs, "_one_pitch", lambda *given: fitted.append(given[2]) or one_pitch(*given))
    mesh_excitation(engagement(driver_odd={0: OddFlank(pits=(Pit(0.0, 1.0, 1.0, 1e-6),))}), LOAD)
    assert 2 < len(fitted) < 8  # of 17


@pytest.mark.parametrize("coupling", [False, True])
def test_a_pit_is_in_the_springs(coupling):
    """Over the whole flank it is a pitch deviation, which springs that stand alone have as well."""
    depth, spacing = 2e-6, np.zeros(17)
    spacing[3] = depth
    pit = engagement(coupling=coupling, driver_odd={3: OddFlank(pits=(Pit(0.0, 1.0, 1.0, depth),))})
    spaced = engagement(coupling=coupling, driver_spacing=spacing)
    found = over_revolution(pit, LOAD, 16)
    for one in (pit, spaced):
        assert static_errors(found, mesh_excitation(one, LOAD), PAIR) == pytest.approx(
            found.transmission_error, rel=1e-6
        )


def test_teeth_that_meet_long_before_the_pitch_point_are_those_of_their_base_pitch():
    """A path of approach longer than the base pitch: load sharing counts one base pitch more there."""
    pair = GearPair(gear(40, 1.0), gear(60, 1.5))
    assert pair.x_start < -pair.base_pitch
    spacing = np.zeros(40)
    spacing[2] = 3e-6
    e = engagement(pair=pair, driver_spacing=spacing)
    found = over_revolution(e, LOAD, 16)
    assert static_errors(found, mesh_excitation(e, LOAD), pair) == pytest.approx(found.transmission_error, rel=1e-6)


def own_motion(of, mass, damping, frequency, turns, steps=30):
    """Times, approach [m] and its rate of two discs over the last revolution, by Runge and Kutta's method.

    m d'' + c d' + sum of k_j max(d - e_j, 0) = W, with springs of load sharing; no step goes over a change of pairs.
    """
    ends = (PAIR.x_start / PAIR.base_pitch % 1.0, PAIR.x_end / PAIR.base_pitch % 1.0)
    edges = np.unique([0.0, *ends, 1.0])
    pitch = np.concatenate([np.linspace(a, b, steps, endpoint=False) for a, b in itertools.pairwise(edges)])
    start = (np.arange(17)[:, None] + pitch).ravel()
    stop = np.append(start[1:], 17.0)
    at = np.stack([start + 1e-9, 0.5 * (start + stop), stop - 1e-9])
    k, e = (np.moveaxis(np.array([one(at) for one in of_all]), 0, -1) for of_all in (of.stiffness, of.separation))
    tables = np.moveaxis(np.stack([k, e]), 2, 0).tolist()  # step, (k, e), (start, middle, end), spring
    widths = ((stop - start) / frequency).tolist()
    d, v, last = float(of.approach(LOAD, 0.0)), 0.0, []

    def acceleration(k, e, d, v):
        force = sum(stiffness * (d - apart) for stiffness, apart in zip(k, e, strict=True) if d > apart)
        return (LOAD - damping * v - force) / mass

    for turn in range(turns):
        for (k, e), h in zip(tables, widths, strict=True):
            if turn == turns - 1:
                last.append((d, v))
            a1 = acceleration(k[0], e[0], d, v)
            d2, v2 = d + 0.5 * h * v, v + 0.5 * h * a1
            a2 = acceleration(k[1], e[1], d2, v2)
            d3, v3 = d + 0.5 * h * v2, v + 0.5 * h * a2
            a3 = acceleration(k[1], e[1], d3, v3)
            d4, v4 = d + h * v3, v + h * a3
            a4 = acceleration(k[2], e[2], d4, v4)
            d += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4)
            v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    return np.append(start, 17.0) / frequency, *np.array([*last, (d, v)]).T


@pytest.mark.dear
def test_a_cracked_pair_in_a_two_disc_rig_moves_as_an_own_integration_says():
    """Residual and sidebands of the dynamic transmission error, near a resonance of the second mesh harmonic."""
    of, inertia, speed = cracked_springs(), 1e-3, 2.0 * math.pi * 60.0
    r1, r2 = PAIR.driver.base_radius, PAIR.driven.base_radius
    stiffness = 1.0 / of.mean_compliance()
    mass = 1.0 / (r1**2 / inertia + r2**2 / inertia)
    damping = 0.3 * math.sqrt(stiffness * mass)
    mesh = Mesh("I", "in", "out", r1, r2, 17, 19, stiffness, damping)
    torques = (Torque("in", LOAD * r1), Torque("out", LOAD * r2))
    train = Train((Body("in", inertia), Body("out", inertia)), (), (mesh,), torques=torques)
    state = steady_state(MotionModel(train, (of,), speed), tolerance=1e-6)
    assert state.kind == "periodic"
    frequency = 17 * speed / (2.0 * math.pi)
    own_times, own, rate = own_motion(of, mass, damping, frequency, 3)
    times = np.arange(17 * 128) / (128 * frequency)
    own = CubicHermiteSpline(own_times, own, rate)(times)
    found = state.trajectory(1).approach(times)[:, 0]
    assert found == pytest.approx(own, abs=1e-4 * np.ptp(own))
    lines, other = (np.abs(np.fft.rfft(one)) * 2.0 / one.size for one in (found, own))
    assert lines[1:200] == pytest.approx(other[1:200], abs=2e-4 * other[17])
    assert lines[16] > 0.01 * lines[17]  # sidebands are there
    healthy = np.median(found.reshape(17, -1), axis=0)
    assert np.abs(found.reshape(17, -1) - healthy).max() > 0.2 * np.ptp(healthy)
