"""What a drawing of a helical gear carries, against planes, balls and flanks in space, and printed numbers."""

import math

import numpy as np
import pytest
from helical_gears import helical_gear
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from fegear.base.errors import GeometryError
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.tooth_contact import mesh_cycle
from fegear.geometry.gear import Gear
from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.geometry.inspection import span, span_teeth, usual_span
from fegear.geometry.over_balls import over_balls, touching_ball, usual_ball
from fegear.geometry.pair import GearPair

DEG = math.pi / 180.0


def gear(teeth, beta, shift=0.0, module=3e-3, width=0.2, hand="left", **more):
    return helical_gear(
        teeth, module, 20.0 * DEG, beta * DEG, width, hand if beta else "spur", profile_shift=shift, **more
    )


def other(one: Gear, teeth: int, shift: float = 0.0) -> Gear:
    hand = {"left": "right", "right": "left", "spur": "spur"}[one.hand]
    return gear(teeth, one.helix_angle / DEG, shift, one.module, one.face_width, hand)


gears = st.builds(
    gear, st.sampled_from([15, 21, 24, 57]), st.sampled_from([0.0, 8.0, 20.0, 32.0]), st.sampled_from([-0.1, 0.0, 0.4]),
    hand=st.sampled_from(["left", "right"]),
)  # fmt: skip


def test_printed_numbers():
    # KHK, Gear technical data: over pins of a helical gear (normal system), m_n = 1, z = 20, beta = 15 deg, x = 0.4
    assert over_balls(gear(20, 15.0, 0.4, 1e-3), 2e-3).dimension == pytest.approx(24.5696e-3, abs=1e-7)
    # ISO/TR 6336-30, example 1: m_n = 8, 17/103 teeth, beta = 15.8 deg, x = 0.145 and 0, b = 100, a = 500
    pinion = gear(17, 15.8, 0.145, 8e-3, 0.1)
    pair = GearPair(pinion, other(pinion, 103))
    assert pair.centre_distance == pytest.approx(0.5, abs=2e-6)
    assert 2.0 * pinion.tip_radius == pytest.approx(159.66e-3, abs=5e-6)
    assert pair.overlap_ratio == pytest.approx(0.1 * math.sin(15.8 * DEG) / (math.pi * 8e-3), rel=1e-12)


@settings(max_examples=20)
@given(gears)
def test_a_span_is_the_distance_of_parallel_planes_that_touch_both_flanks(one):
    count, length = usual_span(one)
    flank = InvoluteHelicoid.of(one, "tooth")
    # The normal at (t, z) depends on the direction offset + twist z - t / r_b alone. The opposite flank is the mirror
    # image in the tooth's centre plane with the hand turned; it belongs to the tooth count - 1 pitches on.
    turn = (count - 1) * one.angular_pitch
    mirror = InvoluteHelicoid(flank.base_radius, -flank.twist, flank.offset)

    def touching(other_flank, direction, sign):
        z = 0.0
        t = (other_flank.offset + other_flank.twist * z - direction) * other_flank.base_radius
        return other_flank.points(t, z) * np.array([1.0, sign, 1.0]), other_flank.normals(t, z) * np.array([1, sign, 1])

    direction = -0.5 * turn
    point, normal = touching(flank, direction, 1.0)
    back, against = touching(mirror, direction, -1.0)
    c, s = math.cos(turn), math.sin(turn)
    back, against = (np.array([c * v[0] + s * v[1], c * v[1] - s * v[0], v[2]]) for v in (back, against))
    assert against == pytest.approx(-normal, abs=1e-12)
    assert (point - back) @ normal == pytest.approx(length, rel=1e-12)
    # where the line between the points of contact is the normal itself, their radius is that of the refusals
    radius = math.hypot(one.base_radius, 0.5 * length * math.cos(one.base_helix_angle))
    assert one.form_radius <= radius <= one.involute_tip_radius
    assert span_teeth(one) == count


@settings(max_examples=20)
@given(gears)
def test_the_ball_touches_both_flanks_and_cuts_into_none(one):
    size = usual_ball(one)
    found = over_balls(one, size)
    across = 0.5 * (found.dimension - size)
    centre = across if one.teeth % 2 == 0 else across / math.cos(0.5 * math.pi / one.teeth)
    flank = InvoluteHelicoid.of(one, "tooth")
    half = 0.5 * one.angular_pitch
    place = np.array([centre * math.cos(half), centre * math.sin(half), 0.0])
    t, z = np.meshgrid(np.linspace(0.0, 0.8, 161) * one.base_radius, np.linspace(-1.0, 1.0, 161) * size)
    low = (0.0, -size)
    step = (0.8 * one.base_radius / 160, 2.0 * size / 160)
    for _ in range(12):
        away = np.linalg.norm(flank.points(t, z) - place[:, None, None], axis=0)
        i = np.unravel_index(np.argmin(away), away.shape)
        step = (0.25 * step[0], 0.25 * step[1])
        low = (t[i] - 8 * step[0], z[i] - 8 * step[1])
        nearest = float(away[i]), float(t[i])
        t, z = np.meshgrid(low[0] + step[0] * np.arange(17), low[1] + step[1] * np.arange(17))
    assert nearest[0] == pytest.approx(0.5 * size, rel=1e-9)
    assert math.hypot(one.base_radius, nearest[1]) == pytest.approx(found.contact_radius, rel=1e-6)
    at = over_balls(one, touching_ball(one))
    assert at.contact_radius == pytest.approx(one.pitch_radius + one.tooth.profile_shift * one.module, rel=1e-9)


def test_a_narrow_face_takes_fewer_teeth_or_none():
    wide = gear(57, 20.0)
    count = span_teeth(wide)
    lean = span(wide, count) * math.sin(wide.base_helix_angle)
    narrow = gear(57, 20.0, width=0.999 * lean)
    with pytest.raises(GeometryError, match="teeth \\(axial distance of the contact points"):
        span(narrow, count)
    assert usual_span(narrow)[0] == count - 1
    assert usual_span(gear(57, 20.0, width=2e-3)) is None


@settings(max_examples=20)
@given(gears, st.sampled_from([19, 40]), st.sampled_from([-0.1, 0.2]), st.floats(0.0, 0.3))
def test_backlash_is_the_gap_between_the_back_flanks(one, teeth, shift, apart):
    mate = other(one, teeth, shift)
    try:
        tight = GearPair(one, mate)
        pair = GearPair(one, mate, tight.centre_distance + apart * one.module)
    except GeometryError:
        assume(False)
    # Tooth and space on the working pitch circles; what is left over of the pitch is the backlash there.
    radii = [g.base_radius / math.cos(pair.working_pressure_angle) for g in (one, mate)]
    arcs = [
        2.0 * r * float(g.tooth.half_thickness_angle(r / g.module)) for g, r in zip((one, mate), radii, strict=True)
    ]
    left = radii[0] * one.angular_pitch - sum(arcs)
    assert pair.circumferential_backlash == pytest.approx(left, abs=1e-15)
    assert tight.normal_backlash == pytest.approx(0.0, abs=1e-15)
    beta_w = math.atan(one.lead and 2.0 * math.pi * radii[0] / one.lead)
    assert pair.working_helix_angle == pytest.approx(beta_w, abs=1e-15)
    # normal backlash, from the normal pressure angle of the working rack: tan(alpha_wn) = tan(alpha_wt) cos(beta_w)
    alpha = math.atan(math.tan(pair.working_pressure_angle) * math.cos(beta_w))
    assert pair.normal_backlash == pytest.approx(left * math.cos(beta_w) * math.cos(alpha), abs=1e-15)


@pytest.mark.dear
@settings(max_examples=8)
@given(gears, st.sampled_from([19, 40]), st.sampled_from([-0.1, 0.3]))
def test_shifted_flanks_touch_without_error_at_the_tight_distance_and_lag_by_the_backlash_beyond_it(one, teeth, shift):
    mate = other(one, teeth, shift)
    pair = HelicalPair(one, mate)
    assert pair.centre_distance == pair.design.centre_distance
    assert pair.transverse_contact_ratio == pytest.approx(pair.design.contact_ratio, rel=1e-12)
    assert pair.overlap_ratio == pytest.approx(pair.design.overlap_ratio, rel=1e-12)
    found = mesh_cycle(pair, 5)
    assert np.abs(found.error).max() < 1e-13
    wide = pair.design.centre_distance + 0.1 * one.module
    play = HelicalPair(one, mate, design_distance=wide)
    lag = mesh_cycle(play, 5).error
    assert np.ptp(lag) < 1e-13
    # Half the play: the gear's tooth stood in the middle of the pinion's space.
    working = mate.base_radius / math.cos(play.working_pressure_angle)
    assert lag[0] == pytest.approx(-0.5 * play.design.circumferential_backlash / working, rel=1e-9)
    moved = HelicalPair(one, mate, Misalignment(centre_distance=0.1 * one.module))
    assert mesh_cycle(moved, 5).error == pytest.approx(lag, rel=1e-9)


def test_a_pair_of_different_hands_helices_or_modules_is_refused():
    one = gear(21, 20.0)
    for mate, words in (
        (gear(40, 20.0), "opposite hands"),
        (gear(40, 19.0, hand="right"), "helix_angle.*equal by design"),
        (gear(40, 20.0, module=4e-3, hand="right"), "normal_module.*equal by design"),
        (gear(40, 0.0), "opposite hands"),
    ):
        with pytest.raises(GeometryError, match=words):
            GearPair(one, mate)


def test_the_ball_of_a_spur_gear_is_the_limit_of_a_vanishing_helix():
    spur, nearly = gear(21, 0.0, 0.2), gear(21, 1e-4, 0.2)
    assert touching_ball(nearly) == pytest.approx(touching_ball(spur), rel=1e-9)
    exact = brentq(lambda d: over_balls(spur, d).contact_radius - spur.pitch_radius - 0.2 * spur.module, 5e-3, 6e-3)
    assert touching_ball(spur) == pytest.approx(exact, rel=1e-9)
