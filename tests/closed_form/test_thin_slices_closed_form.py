"""Thin slices against the plane pair and against slices taken one by one."""

import math

import numpy as np
import pytest

from fegear.contact.odd_flank import OddFlank, Pit
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.wide.flanks import missing_parts
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import base_twist
from fegear.contact.wide.loaded import FlankPair
from fegear.fem.plane.solution import solve_gear
from fegear.fem.solid.bands import bands
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slices import solve_thin_slices
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

RING = InternalTooth(42, PinionCutter(20, 0.1, 1.25, tip_radius=0.2), profile_shift=-0.2, tip_radius=20.4)
STEEL = Material(206.8e9, 0.3, 7850.0)
MODULE, WIDTH, LOAD = 3e-3, 24e-3, 4000.0
MISALIGNED = FlankGaps(face_position=np.array([-0.5, 0.5]) * WIDTH, line_gap=np.array([0.0, 12e-6]))


def gear(beta=0.0, hand="spur"):
    tooth = Tooth(20, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "strain", hand)


def thin(one, settings=None):
    m = one.module
    return solve_thin_slices(
        one.tooth, one.twist * m, one.face_width / m, 0.3, one.bore_radius / m, settings or SolidSettings()
    )


@pytest.fixture(scope="module")
def spur():
    one = gear()
    return one, thin(one)


def test_under_an_even_load_they_are_the_plane_pair(spur):
    one, body = spur
    plane = finite_element_compliance(solve_gear(one, reach=1))
    pair = GearPair(one, one)
    loads = np.array([400.0, LOAD])
    found = FlankPair(pair, {"driver": body, "driven": body}, panel=1.0, positions=4).solve(loads)
    engagement = Engagement(PairCompliance(pair, plane, plane))
    wanted = engagement.solve(engagement.grid(found.lines.roll), loads)
    np.testing.assert_allclose(found.transmission_error, wanted.transmission_error, rtol=1e-3)
    for p in range(found.lines.roll.size):
        for s in found.lines.at(p):
            of_line = found.line_load[p, s, 1]
            np.testing.assert_allclose(of_line, of_line.mean(), rtol=1e-9)


@pytest.mark.dear
def test_under_an_even_load_a_planet_and_its_ring_are_the_plane_pair():
    outside = Gear(RING, MODULE, (RING.root_radius + 2.5) * MODULE, WIDTH, STEEL)
    planet = Tooth(18, BasicRack(1.0, 1.25, 0.25), 0.2)
    inside = Gear(planet, MODULE, 0.5 * planet.root_radius * MODULE, WIDTH, STEEL)
    pair = GearPair(inside, outside)
    found = FlankPair(pair, {"driver": thin(inside), "driven": thin(outside)}, panel=1.0, positions=4).solve([LOAD])
    plane = [finite_element_compliance(solve_gear(one, reach=1)) for one in (inside, outside)]
    engagement = Engagement(PairCompliance(pair, *plane))
    wanted = engagement.solve(engagement.grid(found.lines.roll), np.array([LOAD]))
    np.testing.assert_allclose(found.transmission_error, wanted.transmission_error, rtol=1e-3)


@pytest.mark.dear
def test_what_the_pressed_width_leaves_on_a_hollow_flank_goes_with_its_square():
    """The flank's curvature is taken off with its sign: with the other one a first order is left."""
    settings = SolidSettings().scaled(0.3)
    body = solve_thin_slices(RING, 0.0, 1.0, 0.3, RING.root_radius + 2.5, settings, reach=0)
    at, left = np.array([21.3]), []
    for width in (np.array([0.4]), np.array([0.2]), np.array([0.1])):
        load = body.flank.normal_patches(body.flank.arc_of_radius(at), width)
        known = body.contact_slope * (0.5 + 2.0 * np.log(width)) - body.bend(at) * width
        left.append(((load * (body.compliance[0] @ load)).sum() + known).item())
    assert left[0] - left[1] == pytest.approx(4.0 * (left[1] - left[2]), rel=0.25)


def test_no_slice_knows_of_the_next(spur):
    """Without Hertz's nonlinearity each slice is a spring of its own: (zeta - gap) over the plane compliance."""
    one, body = spur
    flanks = FlankPair(GearPair(one, one), {"driver": body, "driven": body}, False, "none", 1.0, 4)
    even, found = flanks.solve([LOAD]), flanks.solve([40.0 * LOAD], MISALIGNED)
    for p in range(found.lines.roll.size):
        springs = even.pair_load[:, p, 0].sum() / even.transmission_error[p, 0] / WIDTH
        gap = 12e-6 * (found.lines.z[p] / WIDTH + 0.5)
        # all of the face bears: the sum over the pairs follows the gap
        zeta = 40.0 * LOAD / springs / WIDTH + 6e-6
        assert found.transmission_error[p, 0] == pytest.approx(zeta, rel=1e-9)
        total = np.zeros(found.lines.at(p)[0].stop)
        for s in found.lines.at(p):
            total += found.line_load[p, s, 0]
        np.testing.assert_allclose(total, springs * (zeta - gap[: total.size]), rtol=1e-9)


@pytest.mark.parametrize("beta", [0.0, 20.0])
def test_slices_of_a_pit_carry_nothing_and_all_others_what_they_did(beta):
    """Without neighbours and Hertz's nonlinearity: the springs that are left, whatever the panels are."""
    one = gear(beta, "right" if beta else "spur")
    other = gear(beta, "left" if beta else "spur")
    coarse = SolidSettings().scaled(2.5)
    body = {"driver": thin(one, coarse), "driven": thin(other, coarse)}
    pair = GearPair(one, other)
    whole = OddFlank(pits=(Pit(0.0, 1.0, 0.37, 0.0, 0.11 * WIDTH),))
    in_part = OddFlank(pits=(Pit(one.pitch_radius, one.pitch_radius + 0.4 * MODULE, 0.37, 0.0, 0.11 * WIDTH),))
    for odd, panel in ((whole, 2.0), (in_part, 1.1)):
        gaps = FlankGaps(driver_odd=tuple((tooth, odd) for tooth in range(20)))
        parts = tuple(missing_parts(odd, pair, "driver"))
        flanks = FlankPair(pair, body, False, "none", panel, 3, missing=parts)
        even, found = flanks.solve([LOAD]), flanks.solve([LOAD], gaps)
        for p in range(found.lines.roll.size):
            springs = left = 0.0
            for s in found.lines.at(p):
                z = np.linspace(found.lines.z[p, s][0], found.lines.z[p, s][-1], 20001)
                spring = np.interp(z, even.lines.z[p, s], even.line_load[p, s, 0]) / even.transmission_error[p, 0]
                x = found.lines.roll[p] + found.lines.pair[p, s.start] * pair.base_pitch - base_twist(pair) * z
                low, high = parts[0].x
                gone = (np.abs(z - 0.11 * WIDTH) < 0.5 * 0.37 * WIDTH) & (x > low) & (x < high)
                springs += np.trapezoid(spring, z)
                left += np.trapezoid(np.where(gone, 0.0, spring), z)
            assert springs * even.transmission_error[p, 0] == pytest.approx(LOAD, rel=1e-3)
            assert LOAD / found.transmission_error[p, 0] == pytest.approx(left, rel=2e-3)


def test_neighbours_answer_where_both_lines_pass():
    """A helical pair's coupling of two lines, against a plain sum over narrow slices."""
    one = gear(20.0, "right")
    body = thin(one, SolidSettings().scaled(1.7))
    rb, middle = one.tooth.base_radius, one.pitch_radius / MODULE
    z = [np.linspace(-2.0, 3.0, 6), np.linspace(0.5, 3.5, 4)]
    rolled = [math.sqrt(middle**2 - rb**2) + shift - body.tau * rb * x for shift, x in zip((0.0, 1.1), z, strict=True)]
    radius = np.hypot(rb, np.concatenate(rolled))
    before, after = (np.concatenate([f(x) for x in z]) for f in (
        lambda x: np.append(0.0, np.diff(x)), lambda x: np.append(np.diff(x), 0.0)))  # fmt: skip
    line = bands(radius, np.concatenate(z), before, 0.2, after=after, slope=body.line_slope(radius))
    block = body.pressed(line, [slice(0, 6), slice(6, 10)], [1, 0]).between(1, 0, [(0, 1)])[0]
    edges = np.linspace(0.5, 3.0, 4001)
    fine = 0.5 * (edges[1:] + edges[:-1])
    at = [np.hypot(rb, np.interp(fine, x, r)) for x, r in zip(z, rolled, strict=True)]
    up = [body.flank.normal_patches(body.flank.arc_of_radius(r), body.band_half_width(r)) for r in at]
    answer = np.einsum("np,np->p", up[0], body.compliance[1] @ up[1]) * (edges[1] - edges[0])
    hats = [np.array([np.interp(fine, x, row) for row in np.eye(x.size)]) for x in z]
    first, second = (h * 2.0 / (np.append(0, np.diff(x)) + np.append(np.diff(x), 0))[:, None]
                     for h, x in zip(hats, z, strict=True))  # fmt: skip
    np.testing.assert_allclose(block, (first * answer) @ second.T, atol=1e-5 * np.abs(block).max())
