"""Geometry of rack and pinion: limits of gears with many teeth, hand formulas, and own rolling of both outlines."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from fegear.base.errors import FegearError
from fegear.contact.rack.rack_contacts import RackContacts
from fegear.geometry.curves import Involute
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_and_pinion import RackAndPinion, distance_of_backlash
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.toothed_rack import Rack, RackPins

RACKS = {
    "C": (BasicRack(), {}),
    "sharp angle": (BasicRack(0.9, 1.2, 0.3, math.radians(25.0)), {"thickness_allowance": 0.03}),
    "rounded": (BasicRack(1.0, 1.25, 0.38), {"tip_rounding": 0.1}),
    "chamfered": (BasicRack(), {"tip_chamfer": 0.08}),
    "full": (BasicRack.full_fillet(), {}),
}


def pair_of(teeth=20, shift=0.2, rack=None, module=2e-3, backlash=40e-6, count=11, tip_pinion=0.0, **more):
    """A pinion on a rack."""
    basic = rack or BasicRack()
    tooth = Tooth(teeth, basic, profile_shift=shift, thickness_allowance=0.01, tip_rounding=tip_pinion)
    pinion = Gear(tooth, module, 0.3 * teeth * module, 0.01)
    straight = Rack(RackTooth(basic, **more), module, count, 6.0 * module, 0.01)
    return RackAndPinion(pinion, straight, distance_of_backlash(pinion, straight, backlash))


@pytest.mark.parametrize("name", RACKS)
def test_outline_is_the_limit_of_gears(name):
    """Every point of every piece; twice the teeth, half the distance."""
    basic, more = RACKS[name]
    tooth, off = RackTooth(basic, **more), []
    for one, other in pairwise(tooth.outline.values()):
        assert np.abs(one.points(one.end) - other.points(other.start)).max() < 1e-12
    for z in (500, 1000):
        gear, far = Tooth(z, basic, **more), 0.0
        assert list(gear.outline) == list(tooth.outline)
        for piece, curve in tooth.outline.items():
            whole = gear.outline[piece]
            for share in (0.0, 1.0):
                at = whole.points(np.array([whole.start + share * (whole.end - whole.start)]))[:, 0]
                wanted = curve.points(np.array([curve.start + share * (curve.end - curve.start)]))[:, 0]
                far = max(far, float(np.hypot(*(at - (0.0, gear.pitch_radius) - wanted))))
        off.append(far)
    assert off[1] < 2e-2
    assert off[1] == pytest.approx(0.5 * off[0], rel=0.02)


def test_contact_ratio_by_hand():
    """ISO 21771 with z2 -> infinity: the rack's addendum less the rolling line over sin(alpha)."""
    pair = pair_of(backlash=0.0)
    m, alpha = 2e-3, math.radians(20.0)
    height = pair.rolling_height
    assert height == pytest.approx((0.2 - 0.01 / 2.0 / math.tan(alpha)) * m, rel=1e-12)
    tip, rb = pair.pinion.tip_radius, 20e-3 * math.cos(alpha)
    by_hand = math.sqrt(tip**2 - rb**2) - 20e-3 * math.sin(alpha) + (m - height) / math.sin(alpha)
    assert pair.contact_ratio == pytest.approx(by_hand / (math.pi * m * math.cos(alpha)), rel=1e-12)
    assert pair.backlash == pytest.approx(0.0, abs=1e-15)
    assert pair.travel_per_turn == pytest.approx(20 * math.pi * m)
    assert pair.rack.height == pytest.approx(7.0 * m)


def _touch(pair, turn):
    """Where a pinion's flank, turned counter-clockwise, is nearest to the rack: along its normal, height, length."""
    tooth, m, alpha = pair.pinion.tooth, pair.pinion.module, pair.rack.pressure_angle
    flank = Involute(tooth.base_radius, tooth.base_half_angle, 0.0, 2.0)
    s, c = math.sin(math.pi + turn), math.cos(math.pi + turn)  # the tooth points down, its right flank to the left

    def place(roll):
        x, y = flank.points(roll) * m
        return x * c - y * s, x * s + y * c + pair.distance

    def along(roll):
        x, y = place(roll)
        return x * math.cos(alpha) + y * math.sin(alpha)

    found = minimize_scalar(along, bounds=(1e-3, 1.5), method="bounded", options={"xatol": 1e-10})
    return found.fun, place(found.x)[1], found.x * tooth.base_radius * m


@pytest.mark.parametrize("shift", [0.0, 0.4])
def test_own_rolling_touches_at_the_height_and_radius_that_are_stated(shift):
    """The rack keeps pace: its flank moves by r_b for each radian, and the contact as the equations say."""
    pair = pair_of(shift=shift, backlash=0.0)
    rb, first = pair.pinion.base_radius, _touch(pair, 0.0)
    start = first[2] - float(pair.roll_length(0.0))  # the contact's place on the line of action
    for turn in (-0.05, 0.02, 0.1):
        place, height, length = _touch(pair, -turn)
        x = start + turn * rb
        assert first[0] - place == pytest.approx(turn * rb, abs=1e-9 * rb)
        assert height == pytest.approx(float(pair.height(x)), abs=1e-6 * rb)
        assert length == pytest.approx(float(pair.roll_length(x)), abs=1e-6 * rb)


def test_backlash_is_what_lets_the_rack_move():
    """Both thicknesses on the rolling line make up the pitch but for the backlash."""
    pair = pair_of(backlash=73e-6, thickness_allowance=0.02)
    line = pair.rolling_height / pair.rack.module
    on_rack = 2.0 * float(pair.rack.tooth.half_thickness(line)) * pair.rack.module
    tooth = pair.pinion.tooth
    on_pinion = 2.0 * float(tooth.half_thickness_angle(tooth.pitch_radius)) * pair.pinion.pitch_radius
    assert pair.rack.pitch - on_rack - on_pinion == pytest.approx(73e-6, rel=1e-9)
    assert pair.backlash == pytest.approx(73e-6, rel=1e-9)


def test_corners_part_by_the_square_and_vanish_on_the_path():
    """The gap beyond either end begins flat and grows with the curvature there; both teeth at an end of the rack."""
    pair = pair_of()
    found = RackContacts(pair)
    for end, sign in ((pair.x_start, -1.0), (pair.x_end, 1.0)):
        step = 1e-3 * pair.rack.base_pitch
        gap = [float(found.touching(np.array([end + sign * n * step]))[0][0]) for n in (1.0, 2.0)]
        assert gap[1] / gap[0] == pytest.approx(4.0, rel=0.02)
    contacts = found.contacts([0.5 * (pair.x_start + pair.x_end)], 0)
    assert not contacts.present[contacts.number > 0].any()  # no teeth before the first
    assert contacts.present[contacts.number == 0].all()


def test_corner_of_the_pinion_by_own_turning():
    """A point on the pinion's tip circle against a straight flank that keeps pace."""
    pair = pair_of()
    found, rb = RackContacts(pair), pair.pinion.base_radius
    beyond = 0.13 * pair.rack.base_pitch
    ra, along = pair.pinion.tip_radius, float(pair.roll_length(pair.x_end))
    angle = math.atan2(along, rb) + beyond / rb
    gap, _, height, *_ = found.touching(np.array([pair.x_end + beyond]))
    assert gap[0] == pytest.approx(along + beyond - ra * math.sin(angle), rel=1e-9)
    assert height[0] == pytest.approx(pair.distance - ra * math.cos(angle - pair.rack.pressure_angle), rel=1e-9)


def test_rounded_corner_of_the_pinion_by_the_farthest_point_of_its_arc():
    """All points of the rounding, turned with the pinion: the one that reaches farthest along the rack's normal."""
    pair = pair_of(tip_pinion=0.15)
    found, rb, r = RackContacts(pair), pair.pinion.base_radius, 0.15 * pair.pinion.module
    last, beyond = float(pair.roll_length(pair.x_end)), 0.13 * pair.rack.base_pitch
    around = np.linspace(-math.pi, math.pi, 200001)
    along, across, turn = last - r + r * np.cos(around), rb + r * np.sin(around), beyond / rb
    reach = along * math.cos(turn) + across * math.sin(turn)
    farthest = int(np.argmax(reach))
    at = across[farthest] * math.cos(turn) - along[farthest] * math.sin(turn)
    alpha = pair.rack.pressure_angle
    gap, _, height, curvature, edge = (one[0] for one in found.touching(np.array([pair.x_end + beyond])))
    assert gap == pytest.approx(last + beyond - reach[farthest], rel=1e-6)
    assert height == pytest.approx(
        pair.distance - reach[farthest] * math.sin(alpha) - at * math.cos(alpha), abs=1e-4 * r
    )
    assert curvature == pytest.approx(1.0 / r)
    assert edge == -np.inf  # no sharp edge


@pytest.mark.parametrize("rounding", [0.0, 0.1])
def test_corner_of_the_rack_by_its_distance_from_the_involute(rounding):
    """The middle of a rounding (or the corner) moves with the rack; an involute that turns moves along its normals."""
    pair = pair_of(tip_rounding=rounding)
    found, alpha = RackContacts(pair), pair.rack.pressure_angle
    rb, rp = pair.pinion.base_radius, pair.pinion.pitch_radius
    assert found.starts_at_tip
    first, beyond, r = float(pair.roll_length(pair.x_start)), -0.11 * pair.rack.base_pitch, rounding * pair.rack.module
    # d: along the line of action; n: from the pinion's middle to where that line touches the base circle
    d, n = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    turn = beyond / rb
    middle = rb * n + (first + r) * d + rp * turn * (math.cos(alpha) * d - math.sin(alpha) * n)
    theta = np.linspace(-1.0, (first + beyond) / rb, 400001)
    tangent = np.cos(theta) * n[:, None] + np.sin(theta) * d[:, None]
    string = np.cos(theta) * d[:, None] - np.sin(theta) * n[:, None]
    flank = rb * tangent + (first + beyond - rb * theta) * string
    away = np.hypot(*(flank - middle[:, None]))
    nearest = int(np.argmin(away))
    gap, length, _, curvature, _ = (one[0] for one in found.touching(np.array([pair.x_start + beyond])))
    assert gap == pytest.approx(away[nearest] - r, rel=1e-6)
    at_touch = first + beyond - rb * theta[nearest] + gap  # of the point that touches once the gap is closed
    assert length == pytest.approx(at_touch, rel=1e-5)
    assert curvature == pytest.approx(1.0 / length + (1.0 / r if r else 0.0))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"module": 0.0}, "must be positive"), ({"teeth": 0}, "between 1 and 1000"), ({"teeth": 1001}, "1 and 1000"),
        ({"reference_height": 2e-3}, "must exceed the dedendum"), ({"plane": "strain"}, None),
        ({"pins": RackPins(0, 0, 1e-3)}, "between 1 and 1000 teeth"), ({"pins": RackPins(3, 11, 1e-3)}, "first_pin"),
        ({"pins": RackPins(3, 0, 1.0)}, "pin_width"),
    ],
)  # fmt: skip
def test_racks_that_cannot_be_are_refused(change, words):
    given = {"tooth": RackTooth(), "module": 2e-3, "teeth": 11, "reference_height": 0.012, "face_width": 0.01} | change
    if words is None:
        assert Rack(**given).body == pytest.approx(0.012 - 2.5e-3)
        return
    with pytest.raises(FegearError, match=words):
        Rack(**given)


@pytest.mark.parametrize("helix", [0.0, 0.3])
def test_a_pin_holds_from_a_tenth_of_a_module_to_a_pitch_less_as_much(helix):
    pitch = 2e-3 * math.pi / math.cos(helix)
    given = {"tooth": RackTooth(helix_angle=helix), "module": 2e-3, "teeth": 11, "reference_height": 0.012,
             "face_width": 0.01, "hand": "right" if helix else "spur"}  # fmt: skip
    assert Rack(**given).pitch == pytest.approx(pitch, rel=1e-12)
    assert Rack(**given, pins=RackPins(1, 0, 1e-3)).pins.every == 1
    for width, good in ((0.2e-3, True), (pitch - 0.2e-3, True), (0.2e-3, False), (pitch - 0.2e-3, False)):
        off = 1e-9 * (1.0 if (width < 1e-3) == good else -1.0)
        pins = RackPins(1000, 10, width + off)
        if good:
            assert Rack(**given, pins=pins).pins is pins
        else:
            with pytest.raises(FegearError, match="pin_width"):
                Rack(**given, pins=pins)


def test_pins_hold_every_so_many_teeth_from_the_first_on():
    assert [k for k in range(12) if RackPins(3, 2, 1e-3).holds(k)] == [2, 5, 8, 11]
    assert [k for k in range(4) if RackPins(1, 0, 1e-3).holds(k)] == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"tip_rounding": -1.0}, "negative"), ({"tip_rounding": 2.0}, "too large"), ({"tip_chamfer": 0.9}, "too large"),
        ({"tip_rounding": 0.1, "tip_chamfer": 0.1}, "contradicts"), ({"rack": BasicRack(2.2)}, "pointed"),
        ({"rack": BasicRack(1.0, 1.25, 0.0)}, "sharp corner"), ({"thickness_allowance": 1.6}, "pointed"),
        ({"rack": BasicRack(1.0, 1.4, 0.4, protuberance=0.1)}, "not available for racks"),
        ({"thickness_allowance": -2.0}, "no straight flank"),
    ],
)  # fmt: skip
def test_teeth_that_cannot_be_are_refused(change, words):
    with pytest.raises(FegearError, match=words):
        RackTooth(**change)


@pytest.mark.parametrize(
    ("distance", "words"),
    [(-0.1, "negative backlash"), (-0.5, "places the tip .* below the root"), (1.2, "contact is interrupted")],
)
def test_distances_that_cannot_be_are_refused(distance, words):
    pair = pair_of()
    with pytest.raises(FegearError, match=words):
        RackAndPinion(pair.pinion, pair.rack, pair.distance + distance * pair.rack.module)


def test_a_rack_of_long_teeth_interferes_with_a_small_pinion():
    """Its tip reaches below the pinion's form circle, which an equal tool has not relieved."""
    tool, long = BasicRack(1.0, 1.5, 0.2), BasicRack(1.4, 1.5, 0.2)
    pinion = Gear(Tooth(25, tool, profile_shift=0.1), 2e-3, 1e-2, 1e-2)
    rack = Rack(RackTooth(long), 2e-3, 11, 12e-3, 1e-2)
    with pytest.raises(FegearError, match="tip interference"):
        RackAndPinion(pinion, rack, distance_of_backlash(pinion, rack, 0.0))


def test_undercut_shortens_the_path():
    """Where a pinion has no flank left the rack's tip finds none: the path starts where the flank does."""
    pair = pair_of(teeth=10, shift=0.0)
    assert pair.pinion.tooth.undercut
    assert float(pair.radius(pair.x_start)) == pytest.approx(pair.pinion.form_radius)
    assert pair.x_start > pair.x_of_height(pair.rack.tooth.flank_end * pair.rack.module)
    assert not RackContacts(pair).starts_at_tip
