"""Planet and ring with their width: helicoids in space, tilted axes, exchanged gears, the spur limit."""

import math
from functools import cache

import numpy as np
import pytest

from fegear.contact.wide.compliance import flank_compliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import base_twist, contact_lines
from fegear.contact.wide.load_sharing import solve_contact
from fegear.contact.wide.rigid_flanks import beside_the_lines, touching_gaps, unloaded_error
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.formulas.flank_speeds import flank_speeds
from fegear.formulas.friction import computed
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.shaft_tilt import ShaftTilt

M, FACE, STEEL = 3e-3, 9e-3, Material(206.8e9, 0.3)
COARSE = SolidSettings().scaled(1.8)


def geared(degrees=12.0, *, ring_drives=False, face=FACE, hand="right"):
    """A planet of 18 teeth in a ring of 42; a spur pair has no hand."""
    beta = math.radians(degrees)
    planet = Tooth(18, BasicRack(1.0, 1.25, 0.25), 0.2, helix_angle=beta)
    cutter = PinionCutter(20, 0.1, 1.25, tip_radius=0.2)
    tip = 21.0 / math.cos(beta) - 0.6
    ring = InternalTooth(42, cutter, profile_shift=-0.2, tip_radius=tip, helix_angle=beta, thickness_allowance=0.02)
    hand = hand if degrees else "spur"
    inside = Gear(planet, M, 0.5 * planet.root_radius * M, face, STEEL, hand=hand)
    outside = Gear(ring, M, (ring.root_radius + 2.5) * M, face, STEEL, hand=hand)
    return GearPair(outside, inside) if ring_drives else GearPair(inside, outside)


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * points[0] - s * points[1], s * points[0] + c * points[1]])


@pytest.mark.parametrize("hand", ["left", "right"])
@pytest.mark.parametrize("ring_drives", [False, True])
def test_the_contact_line_lies_on_both_helicoids_in_space(hand, ring_drives):
    """Both flanks as they are cut, twisted by their own hands and put on their axes, hold every point of it."""
    pair, x0 = geared(ring_drives=ring_drives, hand=hand), 0.3e-3
    z = np.linspace(-0.5, 0.5, 9) * FACE
    x = np.append(x0, x0 - base_twist(pair) * z)
    # The planet's axis is the origin, its tooth points up, and its right flank touches the right flank of a tooth of
    # the ring, whose axis lies below, as one sees it with that tooth's tip up. x points toward the driver's tip.
    planet = "driven" if ring_drives else "driver"
    alpha, way = pair.working_pressure_angle, (-x0 if ring_drives else x0)
    pitch = pair.gear(planet).base_radius / math.cos(alpha)
    place = np.array([way * math.cos(alpha), pitch + way * math.sin(alpha)])
    placed = []
    for member in MEMBERS:
        gear, below = pair.gear(member), np.array([0.0, 0.0 if member == planet else pair.centre_distance])
        flank = gear.tooth.involute.points(pair.roll_angle(x, member)) * gear.module
        flank *= [[gear.tooth.side], [1.0]]  # drawn with its tip down, the ring's is the left one
        wanted = place + below
        assert np.hypot(*wanted) == pytest.approx(np.hypot(*flank[:, 0]), rel=1e-12)
        start = math.atan2(wanted[1], wanted[0]) - math.atan2(flank[1, 0], flank[0, 0])
        placed.append(turned(flank[:, 1:], start + gear.twist * z) - below[:, None])
    np.testing.assert_allclose(placed[0], placed[1], atol=1e-14)


@pytest.mark.parametrize("ring_drives", [False, True])
def test_unmodified_flanks_touch_and_tilted_ones_part_as_rigid_bodies_do(ring_drives):
    pair = geared(ring_drives=ring_drives)
    lines = contact_lines(pair, pair.x_start + pair.base_pitch * np.array([0.1, 0.5]), 0.5 * M)
    on = lines.present
    assert np.abs(touching_gaps(pair, FlankGaps(), lines)[on]).max() < 1e-14
    assert np.abs(unloaded_error(pair, FlankGaps(), lines.roll)).max() < 1e-14
    twist, alpha = base_twist(pair), pair.working_pressure_angle
    normal = np.array([math.cos(alpha), math.sin(alpha), twist])
    for tilt, motion in (
        # Axes that move apart toward +z: the driven one lies on the driver's side of the pitch point.
        (ShaftTilt(in_plane=1e-5), lambda p: np.cross([1e-5, 0.0, 0.0], p)),
        (ShaftTilt(out_of_plane=1e-5), lambda p: np.cross([0.0, 1e-5, 0.0], p)),
    ):
        p = np.stack([lines.x * math.cos(alpha), lines.x * math.sin(alpha), lines.z], axis=-1)
        wanted = motion(p) @ normal
        gap = FlankGaps(tilt=tilt).at(pair, lines)
        np.testing.assert_allclose(gap[on], wanted[on], atol=1e-18)
        # The least gap up the flank, and whatever the whole gear's shift along its axis adds.
        exact = touching_gaps(pair, FlankGaps(tilt=tilt), lines)
        apart = (exact - gap)[on & np.isfinite(exact)]
        assert np.ptp(apart) < 2e-3 * np.ptp(gap[on])


def test_a_mate_that_begins_beside_the_end_of_a_line_is_not_taken_for_where_flanks_touch():
    """At the end of a tilted face, just before the pitch point: 24 um were said for less than a nanometre."""
    pair = geared()
    half = 0.5 * FACE * base_twist(pair)
    lines = contact_lines(pair, [-half - 0.05e-3, half - 0.05e-3], 0.5 * M)  # at x = -.05 mm on either end
    gaps = FlankGaps(tilt=ShaftTilt(out_of_plane=3e-4))
    assert beside_the_lines(pair, gaps, lines) < 5e-9


@pytest.mark.parametrize("ring_drives", [False, True])
def test_flanks_slide_by_the_difference_of_both_speeds(ring_drives):
    """Both gears turn the same way; the power that a coefficient of one takes goes with that difference, too."""
    pair, speed, x = geared(ring_drives=ring_drives), 50.0, np.array([-2e-3, -0.4e-3, 0.0, 1e-3])
    slow = speed * pair.driver.teeth / pair.driven.teeth
    at = flank_speeds(pair, x, speed)
    np.testing.assert_allclose(at.sliding, abs(speed - slow) * x, atol=1e-12)
    np.testing.assert_allclose(at.sum, speed * abs(at.radius_driver) + slow * abs(at.radius_driven))
    assert (at.relative_radius > 0.0).all()
    lost = 3e-3 * abs(speed - slow) / (speed * pair.driver.base_radius)
    assert computed(pair, 3e-3) == pytest.approx(lost / math.cos(pair.driver.base_helix_angle))


@cache
def bodies(degrees, *, face=FACE):
    solved = {}
    for gear in (geared(degrees, face=face).driver, geared(degrees, face=face).driven):
        at = gear.flank_twist * M, face / M, 0.3, gear.bore_radius / M
        solved[gear.tooth.internal] = solve_solid(gear.tooth, *at, COARSE, reach=2)
    return solved


def loaded(degrees, *, ring_drives=False, load=900.0):
    """Contact lines and contact at two roll positions, counted toward the planet's tip."""
    pair, known = geared(degrees, ring_drives=ring_drives), bodies(degrees)
    gears = {member: known[pair.gear(member).tooth.internal] for member in MEMBERS}
    path = sorted((-pair.x_end, -pair.x_start)) if ring_drives else (pair.x_start, pair.x_end)
    roll = path[0] + pair.base_pitch * np.array([0.15, 0.6])
    lines = contact_lines(pair, -roll if ring_drives else roll, 0.5 * M)
    return lines, solve_contact(flank_compliance(pair, gears, lines, load), np.zeros(lines.x.shape), np.array([load]))


def test_exchanged_gears_answer_alike():
    """Of a helical pair the ring may drive: the same flanks touch, and roll positions run the other way."""
    (lines, one), (others, other) = loaded(12.0), loaded(12.0, ring_drives=True)
    np.testing.assert_allclose(other.approach, one.approach, rtol=1e-9)
    for p in range(2):
        here, there = ({round(float(x) * 1e9): f for x, f in zip(lines_.x[p] * way, force.force[p, :, 0], strict=True)}
                       for lines_, force, way in ((lines, one, 1.0), (others, other, -1.0)))  # fmt: skip
        assert {x: f for x, f in here.items() if f} == pytest.approx({x: f for x, f in there.items() if f}, rel=1e-8)


@pytest.mark.dear
def test_a_helix_that_vanishes_leaves_the_spur_pair():
    (_, spur), (_, nearly) = loaded(0.0), loaded(0.002)
    np.testing.assert_allclose(nearly.approach, spur.approach, rtol=1e-3)
