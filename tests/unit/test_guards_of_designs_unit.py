"""Guards that ordinary cases pass by: bounds but for round-off, slopes of nothing, remedies that can be followed."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import GeometryError, InputError, RangeError
from fegear.design.flanks.topography import _CHORD, _end_slopes
from fegear.design.loading import LoadingFunction, Ramp, refuse_beyond_path
from fegear.design.preferred import preferred
from fegear.design.root_stress_loading import Allowed, least_root_stress
from fegear.design.sizing import by_atlas
from fegear.design.tip_relief import robust
from fegear.formulas.iso6336.pair_geometry import of_pair
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import EllipseOnSpace
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_and_pinion import RackAndPinion, distance_of_backlash
from fegear.geometry.rack_cutter import RackFlank as CutFlank
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.rim_support import RimSupport
from fegear.geometry.toothed_rack import Rack

RACK = BasicRack(1.0, 1.25, 0.38)


def gear_of(tooth, bore=0.01):
    return Gear(tooth, 2e-3, bore, 0.02)


PAIR = GearPair(gear_of(Tooth(24, RACK, 0.2)), gear_of(Tooth(37, RACK, -0.2)))


# ---- design zones ----------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("end", [-1.0, 1.0])
def test_a_zone_may_end_where_the_path_does_but_for_round_off(end):
    middle = 0.5 * (PAIR.x_start + PAIR.x_end)
    for beyond, fits in ((0.0, True), (1e-10, True), (1e-7, False), (0.1, False)):
        # A zone of 1.2 base pitches whose one end lies so much beyond that of the path.
        half = 0.6 * PAIR.base_pitch
        centre = middle + end * (0.5 * PAIR.path_length - half + beyond * PAIR.base_pitch)
        zone = LoadingFunction(2.0 * half, PAIR.base_pitch, centre)
        if fits:
            refuse_beyond_path(zone, PAIR)
        else:
            with pytest.raises(RangeError, match="extends beyond the path of contact"):
                refuse_beyond_path(zone, PAIR)


def test_beyond_its_zone_a_relief_goes_on_as_it_ends_and_never_falls():
    """Two ends whose stations lie on lines; one distance only, and none at all, say nothing about a slope."""
    loading = SimpleNamespace(over_path=SimpleNamespace(
        x_start=2.0, x_end=12.0, length=10.0, terms=((0.0, 0.0, 1.0),)))  # fmt: skip
    x = np.linspace(0.0, 10.0, 201)

    def slopes(relief, present=True):
        lines = SimpleNamespace(x=2.0 + x, present=np.broadcast_to(present, x.shape))
        return _end_slopes(lines, relief, loading)

    falling, rising = 0.3 * np.maximum(1.0 - x, 0.0), 0.2 * np.maximum(x - 9.0, 0.0)
    assert slopes(falling + rising) == pytest.approx((0.3, 0.2), rel=1e-9)
    assert slopes(-falling - rising) == (0.0, 0.0)
    assert slopes(falling + rising, x == 5.0) == (0.0, 0.0)
    assert slopes(falling + rising, (x == 0.0) | (x == 10.0)) == (0.0, 0.0)
    # As far as a share of the ramp, and of a short ramp as of one of a twentieth of the zone.
    for ramp, counts in ((2.0, 2.0), (0.1, 0.5)):
        loading.over_path.terms = ((0.0, 0.0, ramp),)
        reach = _CHORD * counts
        x = np.concatenate([np.linspace(0.0, reach, 41), np.linspace(1.01 * reach, 10.0, 101)])
        assert slopes(np.maximum(reach - x, 0.0))[0] == pytest.approx(1.0, rel=1e-9)
        assert slopes(np.maximum(0.9 * reach - x, 0.0))[0] < 0.999


# ---- remedies --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("internal", [False, True])
def test_a_bore_that_cannot_be_is_refused_with_one_that_can(internal):
    tooth = InternalTooth(60, PinionCutter(20), tip_radius=29.2) if internal else Tooth(24, RACK)
    root = tooth.root_radius * 2e-3
    with pytest.raises(GeometryError, match="bore_radius") as refused:
        gear_of(tooth, root)
    usual = float(re.search(r"([0-9.]+) mm", refused.value.remedy)[1]) * 1e-3
    # A rim of 3.5 modules of an internal gear, else half the root radius.
    assert usual == pytest.approx(root + 3.5 * 2e-3 if internal else 0.5 * root, rel=1e-3)
    assert gear_of(tooth, usual).bore_radius == usual


# ---- ratings ---------------------------------------------------------------------------------------------------------
def test_a_rating_takes_the_tool_of_shaped_teeth_and_refuses_uneven_ones():
    tooth = PAIR.driver.tooth
    shaped = replace(PAIR.driver, tooth=with_fillet(tooth, EllipseOnSpace(tooth.form_radius + 0.02)))
    found, plain = (of_pair(GearPair(one, PAIR.driven)) for one in (shaped, PAIR.driver))
    assert found.gears[0].formed == shaped.tooth
    assert plain.gears[0].formed is None
    for name in ("teeth", "profile_shift", "generating_shift", "tip_radius", "tip_diameter", "residual_undercut"):
        assert getattr(found.gears[0], name) == getattr(plain.gears[0], name)
    assert found.gears[0].dedendum == pytest.approx(shaped.symmetric_tooth.dedendum)
    uneven = AsymmetricRack(RackFlank(math.radians(25.0), 0.2), RackFlank(math.radians(18.0), 0.3))
    gears = [gear_of(AsymmetricTooth(z, uneven).drive) for z in (24, 37)]
    with pytest.raises(GeometryError):
        of_pair(GearPair(*gears))


# ---- searches --------------------------------------------------------------------------------------------------------
def test_by_golden_section_each_place_is_the_least_of_all_that_were_looked_at():
    rng = np.random.default_rng(2)
    low, high = rng.uniform(0.0, 1.0, 30), rng.uniform(2.0, 3.0, 30)
    least = rng.uniform(low, high)
    least[:2] = low[0], high[1]
    seen = []

    def of(x):
        seen.append(x)
        return np.where(x < least, 2.0, 1.0) * np.abs(x - least)

    found = by_atlas._golden(of, low, high)
    every = np.array(seen)
    values = np.where(every < least, 2.0, 1.0) * np.abs(every - least)
    np.testing.assert_array_equal(found, every[values.argmin(axis=0), np.arange(30)])
    assert ((every >= low) & (every <= high)).all()
    part = 0.5 * (math.sqrt(5.0) - 1.0)
    assert (np.abs(found - least) <= part ** len(seen[2:]) * (high - low)).all()


def test_steps_lead_to_the_least_within_what_amounts_and_lengths_may_be():
    """Of a function with a kink in each number; an amount and a length whose least lies outside end where they may."""
    least, steps, deepest = np.array([12e-6, 0.4, 50e-6, 1.7]), (8e-6, 0.1), 30e-6
    asked = []

    def quick(p):
        asked.append(tuple(p))
        return 1.0 + float(np.abs((np.array(p) - least) / [1e-6, 0.05, 1e-6, 0.05]).sum())

    value, found = robust._led(SimpleNamespace(quick=quick), (2e-6, 0.9, 5e-6, 0.3), steps, deepest)
    smallest = np.array([steps[0], steps[1]] * 2) * 0.5**robust._HALVINGS
    wanted = np.array([12e-6, 0.4, deepest, 1.0])
    assert (np.abs(np.array(found) - wanted) <= smallest).all()
    assert value == quick(found)
    every = np.array(asked)
    assert (every >= [0.0, 0.02, 0.0, 0.02]).all()
    assert (every <= [deepest, 1.0, deepest, 1.0]).all()
    low = np.array([-5e-6, 0.001, -5e-6, 0.001])
    _, found = robust._led(
        SimpleNamespace(quick=lambda p: 1.0 + float(np.abs(np.array(p) - low).sum())), found, steps, deepest
    )
    assert found == pytest.approx((0.0, 0.02, 0.0, 0.02), abs=1e-12)


class Stress:
    """Tensions and pressures that are least at a peak of their own for each exponent."""

    def __init__(self, least):
        self.least = least

    def worst(self, loading):
        height, at = self.least[loading.ramp.exponent]
        assert loading.inner_ramp == Ramp(1.0, loading.ramp.exponent)
        return height + abs(loading.peak - at)

    def pressure(self, loading):
        return 4.0 - loading.peak


def test_the_loading_of_least_root_stress_is_that_of_all_exponents_that_allow_its_slope():
    least = {None: (2.0, 0.7), 3: (1.5, 0.8), 5: (1.0, 0.61), 7: (1.2, 0.9), 9: (1.3, 0.95)}
    pitch = PAIR.base_pitch

    def found(slope, allowed=None, length=2.5, exponents=(None, 3, 5, 7, 9)):
        start = Ramp(min(slope, 9.0), 9)
        zone = LoadingFunction(length * pitch, pitch, 0.0, start)
        return least_root_stress(Stress(least), zone, exponents, allowed)

    for slope, tried in ((1.0, [None, 3, 5, 7, 9]), (2.0, [None, 3, 5, 7, 9]), (2.1, [3, 5, 7, 9]), (3.0, [3, 5, 7, 9]),
                         (5.1, [7, 9])):  # fmt: skip
        one = found(slope)
        assert [r for r, *_ in one.candidates] == tried
        best = min(tried, key=lambda r: least[r][0])
        assert one.loading.ramp == Ramp(slope, best)
        assert one.loading.peak == pytest.approx(least[best][1], abs=1e-4)
        assert one.stress == pytest.approx(least[best][0], abs=1e-4)
        assert one.pressure == pytest.approx(4.0 - least[best][1], abs=1e-4)
        for r, peak, stress, pressure in one.candidates:
            assert (peak, stress) == pytest.approx((least[r][1], least[r][0]), abs=1e-4)
            assert pressure == pytest.approx(4.0 - peak)
    # Where pressure counts more than tension the largest peak is chosen, 1 at a contact ratio of 2.5: it lowers that.
    pressed = found(1.0, Allowed(100.0, 1.0, 4.0))
    assert pressed.loading.peak == pytest.approx(1.0, abs=1e-4)
    assert Allowed(100.0, 1.0, 4.0).used(30.0, 0.1) == pytest.approx(1.2)
    assert Allowed(100.0, 1.0, 4.0).used(3.0, 0.7) == pytest.approx(1.4)
    with pytest.raises(InputError, match=r"design\.peak"):
        found(1.0, length=1.9)
    with pytest.raises(InputError, match=r"design\.exponent"):
        found(6.0, exponents=(None, 3, 5))


@pytest.mark.parametrize("parabola", [-0.5, 0.0, 1.0])
@pytest.mark.parametrize("shaped", [False, True])
def test_a_cut_flank_goes_from_the_form_circle_to_the_tip(parabola, shaped):
    """The parameters of its ends are those of points on both circles, however the cutter's profile is bent."""
    gear = PAIR.driver
    if shaped:
        gear = replace(gear, tooth=with_fillet(gear.tooth, EllipseOnSpace(gear.tooth.form_radius + 0.05)))
    flank = CutFlank(gear, parabola)
    at_form, at_tip = (abs(flank.profile(s)[0]) for s in (flank.s_form, flank.s_tip))
    assert at_tip == pytest.approx(gear.involute_tip_radius, rel=1e-12)
    if shaped or parabola == 0.0:
        assert at_form == pytest.approx(gear.form_radius, rel=1e-12)
    assert flank.s_form < 0.0 < flank.s_tip


# ---- pairs and racks by hand -----------------------------------------------------------------------------------------
@pytest.mark.parametrize("widths", [(20e-3, 14e-3), (14e-3, 20e-3)])
def test_a_helical_rack_overlaps_over_the_smaller_face(widths):
    beta, module, basic, count = math.radians(15.0), 2e-3, BasicRack(), 11
    tooth = Tooth(20, basic, profile_shift=0.2, thickness_allowance=0.01, helix_angle=beta)
    pinion = Gear(tooth, module, 0.012, widths[0], hand="right")
    rack = Rack(RackTooth(basic, helix_angle=beta), module, count, 6.0 * module, widths[1], hand="left")
    pair = RackAndPinion(pinion, rack, distance_of_backlash(pinion, rack, 40e-6))
    assert pair.face_width == 14e-3
    overlap = 14e-3 * math.sin(beta) / (math.pi * module)
    assert pair.overlap_ratio == pytest.approx(overlap, rel=1e-12)
    assert pair.total_contact_ratio == pytest.approx(pair.contact_ratio + overlap, rel=1e-12)
    diameter = 20 * module / math.cos(beta)
    assert pair.travel_per_turn == pytest.approx(math.pi * diameter, rel=1e-12)
    # By hand from both tips along the line of action, whose angle is that of the section across the axis.
    alpha = math.atan(math.tan(math.radians(20.0)) / math.cos(beta))
    tip = 0.5 * diameter + (1.0 + 0.2) * module
    far = math.sqrt(tip**2 - (0.5 * diameter * math.cos(alpha)) ** 2) - 0.5 * diameter * math.sin(alpha)
    near = (module - (pair.distance - 0.5 * diameter)) / math.sin(alpha)
    pitch = math.pi * module / math.cos(beta) * math.cos(alpha)
    assert pair.contact_ratio == pytest.approx((far + near) / pitch, rel=1e-9)
    assert pair.stroke == pytest.approx(((count - 1) * pitch + far + near) / math.cos(alpha), rel=1e-9)
    assert pair.backlash == pytest.approx(40e-6, rel=1e-9)
    # Neither tip reaches the end of the mate's flank: the rack's ends at its root rounding of 0.25 modules.
    depth = 1.25 - 0.25 * (1.0 - math.sin(math.radians(20.0)))
    flank = (pair.distance - 0.5 * diameter + depth * module) / math.sin(alpha)
    base, at_pitch_point = 0.5 * diameter * math.cos(alpha), 0.5 * diameter * math.sin(alpha)
    start = math.sqrt(pinion.form_radius**2 - base**2) - at_pitch_point
    assert pair.interference == pytest.approx((start + near, far - flank), rel=1e-9)
    assert max(pair.interference) < 0.0


def test_what_carries_a_rim_is_the_same_in_modules():
    tooth, spread = Tooth(40, RACK), RimSupport(pins=6, width=5e-3, angle=0.1)
    gear = Gear(tooth, 2e-3, 0.03, 0.02, support=spread)
    assert gear.support_in_modules == replace(spread, width=pytest.approx(2.5))
    web = replace(gear, support=RimSupport(web=0.3, inner_radius=0.015))
    assert web.support_in_modules == RimSupport(web=0.3, inner_radius=pytest.approx(7.5))
    assert replace(gear, support=None).support_in_modules is None


@pytest.mark.parametrize("ratio", [2.5, 3.2])
def test_peaks_at_the_ends_of_their_range_are_taken_but_for_round_off(ratio):
    low, high = 1.0 / math.floor(ratio), 1.0 / (math.floor(ratio) - 1.0)
    for peak in (low * (1.0 - 1e-13), low, high, high * (1.0 + 1e-13)):
        assert LoadingFunction(ratio, 1.0, peak=peak).peak == peak
    for peak in (low - 1e-9, high + 1e-9):
        with pytest.raises(RangeError, match=r"design\.peak"):
            LoadingFunction(ratio, 1.0, peak=peak)
    assert LoadingFunction(ratio, 1.0).peak == pytest.approx(0.5 * (low + high))


def test_a_single_design_is_the_one_to_be_ground():
    assert preferred({"a": 1.0}, {}) == ["a"]
    assert preferred({"a": 1.0}, {"a": 2.0}) == ["a"]
    assert preferred({"a": 2.0, "b": 1.0}, {}) == ["b", "a"]
