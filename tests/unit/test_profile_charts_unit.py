"""Profile charts of tip reliefs, and what reliefs leave when they are off by their tolerances."""

import math
from dataclasses import replace
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design.relief_design import _unrelieved_most
from fegear.design.tip_relief.grindable import relief_over_path
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.design.tip_relief.tolerated import decisive_tolerances, unrelieved_within, within_tolerances
from fegear.engine.figure.items import Mark
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import GearPair
from fegear.geometry.path_of_contact import active_profile
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import UNMODIFIED, EndRelief, roll_of_radius
from fegear.results.relief.answer_numbers import ground_microns, with_limits
from fegear.results.relief.grinding import tip_row
from fegear.results.relief.ground_tips import GroundTip
from fegear.results.relief.profile_charts import _abscissa, _apart, _ordinate, _tip_side, profile_chart
from fegear.results.relief.recommended import marked

LOAD = 6000.0
EXACT = TipTolerance(0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def engagement():
    gears = [Gear(Tooth(z, BasicRack()), 3e-3, 0.1 * z * 3e-3, 0.02) for z in (24, 36)]
    sources = [closed_form_compliance(gear, "weber-banaschek") for gear in gears]
    return Engagement(PairCompliance(GearPair(*gears), *sources, hertz="linear", nominal_load=LOAD))


@pytest.fixture(scope="module")
def tips(engagement):
    pair = engagement.pair
    return tuple(relief_over_path(gear, pair.path_length, 20e-6, 0.35, 1.0) for gear in (pair.driver, pair.driven))


def left(engagement, tips, load):
    return transmission_error(
        replace(engagement, driver_relief=tips[0], driven_relief=tips[1]), load, 12
    ).peak_to_peak  # fmt: skip


def test_without_relief_profile_slopes_within_the_tolerances_tilt_the_contact_of_every_pair(engagement):
    """Slopes of opposite sense add up: without load the envelope of straight gaps is a saw-tooth over a base pitch."""
    pair, both = engagement.pair, (TipTolerance(6e-6, None, 0.0), TipTolerance(4e-6, None, 0.0))
    loads = np.array([1e-3, LOAD])
    idle, loaded = unrelieved_within(engagement, both, loads)
    assert idle == pytest.approx(10e-6 * pair.base_pitch / pair.path_length, rel=1e-3)
    # Only the sum of both counts, whichever flank has it; equal senses make up for each other.
    ends = [float(pair.roll_angle(x, "driver")) for x in (pair.x_start, pair.x_end)]
    tilted = [
        transmission_error(replace(engagement, driver_relief=EndRelief(10e-6, *order, 1.0)), LOAD, 12).peak_to_peak
        for order in (ends, ends[::-1])
    ]
    assert loaded == pytest.approx(max(tilted), rel=1e-9)
    plain = [transmission_error(engagement, load, 12).peak_to_peak for load in loads]
    assert unrelieved_within(engagement, (EXACT, EXACT), loads) == pytest.approx(plain, rel=1e-12)
    assert loaded > 1.1 * plain[1]


def test_what_relief_is_compared_with_is_asked_for_only_where_it_leaves_more_than_an_exact_pair(engagement):
    tolerances = (TipTolerance(6e-6, None, 0.0),) * 2
    none = [transmission_error(engagement, load, 12) for load in (0.5 * LOAD, LOAD)]

    def most(*within, weights=(1.0, 1.0)):
        task = SimpleNamespace(tip_tolerances=tolerances, over_loads=(0.5 * LOAD, LOAD), over_weights=np.array(weights))
        found = np.array([[0.0, one.peak_to_peak * part] for one, part in zip(none, within, strict=True)])
        return _unrelieved_most(
            engagement,
            SimpleNamespace(
                task=task, within={"linear": found}, best_ground=("linear", None), over_range={"no relief": none}
            ),
        )

    assert most(0.9, 1.0) is None
    assert most(1.1, 0.9, weights=(0.0, 1.0)) is None
    assert most(1.1, 0.9) == pytest.approx(unrelieved_within(engagement, tolerances, [0.5 * LOAD, LOAD]))


def test_without_tolerances_a_relief_leaves_what_it_leaves(engagement, tips):
    found = within_tolerances(engagement, tips, (EXACT, EXACT), [0.5 * LOAD, LOAD])
    for (least, most), load in zip(found, (0.5 * LOAD, LOAD), strict=True):
        assert least == most == pytest.approx(left(engagement, tips, load), rel=1e-12)


def test_what_is_left_lies_between_the_ends_and_these_part_with_the_tolerance(engagement, tips):
    before = 0.0
    for size in (1e-6, 3e-6):
        allowed = TipTolerance(size, 0.2e-3, 0.0)
        ((least, most),) = within_tolerances(engagement, tips, (allowed, allowed), [LOAD])
        assert least <= left(engagement, tips, LOAD) <= most
        assert most >= before
        before = most
        gears = engagement.pair.driver, engagement.pair.driven
        for off in ((1, 1), (-1, 1), (-1, -1)):
            ends = [allowed.off(gear, tip, *off) for gear, tip in zip(gears, tips, strict=True)]
            assert least * 0.98 <= left(engagement, ends, LOAD) <= most * 1.02


def test_of_a_gear_without_relief_the_profile_slope_is_off(engagement, tips):
    """It was taken for exact: with relief on one gear only the pair looked more robust than with both."""
    pair, bare = engagement.pair, replace(tips[1], amount=0.0)
    found = within_tolerances(engagement, (tips[0], bare), (EXACT, TipTolerance(5e-6, None, 0.0)), [LOAD])
    ends = [float(pair.roll_angle(x, "driven")) for x in (pair.x_end, pair.x_start)]
    slopes = [UNMODIFIED, EndRelief(5e-6, *ends, 1.0), EndRelief(5e-6, *ends[::-1], 1.0)]
    own = [left(engagement, (tips[0], one), LOAD) for one in slopes]
    assert found[0] == pytest.approx([min(own), max(own)], rel=1e-9)
    assert max(own) > 1.1 * own[0]
    given = EXACT, TipTolerance(5e-6, None, 0.0)
    (decides,) = decisive_tolerances(engagement, (tips[0], bare), given, [LOAD], found[:, 1])
    halved = within_tolerances(engagement, (tips[0], bare), (EXACT, TipTolerance(2.5e-6, None, 0.0)), [LOAD])
    assert (decides.member, decides.number, decides.given) == ("driven", "profile_slope", 5e-6)
    assert decides.most == pytest.approx(halved[0, 1], rel=0.01)
    exact = within_tolerances(engagement, (tips[0], bare), (EXACT, EXACT), [LOAD])
    assert exact[0, 1] == pytest.approx(left(engagement, (tips[0], UNMODIFIED), LOAD), rel=1e-9)


def test_the_tolerance_that_decides_is_the_one_that_halved_reduces_the_maximum_most(engagement, tips):
    given = TipTolerance(4e-6, 0.3e-3, 0.0), TipTolerance(1e-6, 0.1e-3, 0.0)
    most = within_tolerances(engagement, tips, given, [LOAD])[:, 1]
    (decisive,) = decisive_tolerances(engagement, tips, given, [LOAD], most)
    halved = {}
    for member, number in product(("driver", "driven"), ("amount", "length")):
        i = ("driver", "driven").index(member)
        allowed = [given[0], given[1]]
        allowed[i] = replace(given[i], **{number: 0.5 * getattr(given[i], number)})
        ((_, halved[member, number]),) = within_tolerances(engagement, tips, tuple(allowed), [LOAD])
    assert (decisive.member, decisive.number) == min(halved, key=halved.get)
    assert decisive.most == pytest.approx(min(halved.values()), rel=0.01)
    assert decisive.most < most[0]
    assert decisive.given == getattr(given[("driver", "driven").index(decisive.member)], decisive.number)


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_the_band_of_a_profile_chart_has_the_tolerances_at_its_ends(engagement, tips, power):
    gear, tip = engagement.pair.driver, replace(tips[0], power=power)
    chart = profile_chart("p", gear, tip, TipTolerance(4e-6, 0.5e-3, 3e-6))
    assert (chart.lower <= chart.profile).all()
    assert (chart.profile <= chart.upper).all()
    assert (chart.profile[-1], chart.upper[-1], chart.lower[-1]) == pytest.approx((-20e-6, -16e-6, -24e-6), abs=1e-12)
    assert (chart.profile[0], chart.upper[0], chart.lower[0]) == pytest.approx((0.0, 0.0, 0.0), abs=1e-15)
    assert chart.with_form == pytest.approx(chart.lower - 3e-6, abs=1e-15)
    # Where relief begins within its length's tolerance.
    for limit, off in ((chart.upper, -0.5e-3), (chart.lower, 0.5e-3)):
        begins = chart.roll_length[np.flatnonzero(limit < -1e-12)[0]]
        assert begins == pytest.approx(gear.base_radius * tip.start - off, abs=1.1 * np.diff(chart.roll_length).max())
    assert chart.words.startswith(f"20 ± 4 µm, {'linear' if power == 1.0 else 'parabolic'} from d ")
    assert chart.words.endswith(" ± 0.500 mm long); f_{fα} 3 µm")


def test_points_of_single_contact_are_marked_and_words_stand_apart(engagement, tips):
    pair = engagement.pair
    active = active_profile(pair, "driver")
    chart = profile_chart("p", pair.driver, tips[0], TipTolerance(4e-6, None, 0.0), None, active, recommended=True)
    assert chart.with_form is None
    assert [mark.label for mark in chart.marks[:2]] == ["HPSTC", "LPSTC"]
    for mark, radius in zip(chart.marks, (active.highest_single, active.lowest_single), strict=False):
        assert mark.at * 1e-3 == pytest.approx(math.sqrt(radius**2 - pair.driver.base_radius**2), rel=1e-12)
    beside = replace(tips[0], start=chart.marks[0].at * 1e-3 / pair.driver.base_radius + 0.01)
    words = [mark.label for mark in profile_chart("p", pair.driver, beside, EXACT, None, active).marks]
    assert words == ["HPSTC", "LPSTC", ""]  # the line of the start stays
    close = [Mark("x", at, word) for at, word in ((5.0, "HPSTC"), (4.2, "LPSTC"), (5.9, "d 71.3"), (6.0, "d 71.3"))]
    assert [mark.label for mark in _apart(close, 10.0)] == ["HPSTC", "", "", "d 71.3"]
    axis = _abscissa(SimpleNamespace(one=chart))
    assert axis.second.value == pytest.approx(np.degrees(np.array(axis.second.at) * 1e-3 / pair.driver.base_radius))
    assert marked("a", recommended=chart.recommended) == "a (recommended)"


def test_a_tolerance_above_the_amount_is_said_by_its_limits(engagement, tips):
    gear, tip = engagement.pair.driver, replace(tips[0], amount=4.8e-6)
    chart = profile_chart("p", gear, tip, TipTolerance(5.5e-6, None, 0.0))
    assert chart.words.startswith("0 to 10.3 µm (nominal 4.8), linear from d ")
    assert (chart.upper[-1], chart.lower[-1]) == pytest.approx((0.0, -10.3e-6), abs=1e-12)
    assert with_limits(2e-6, 6e-6) == "-4 to 8 µm (nominal 2)"
    assert with_limits(-6e-6, 5e-6) == "-6 ± 5 µm"
    # The numbers of the grinding table, not two digits of them.
    assert with_limits(10.459e-6, 5.5e-6) == "10.5 ± 5.5 µm"
    assert [ground_microns(size) for size in (17.64e-6, 9.96e-6, 101.23e-6, 0.0574e-6, 1e-10)] == [
        "17.6", "10", "101.2", "0.057", "0",
    ]  # fmt: skip


def test_the_relief_of_a_ring_gear_is_off_by_its_tolerances_as_that_of_other_gears():
    """Roll angles of ring gears are negative, and grow towards the tip."""
    ring, tip = SimpleNamespace(base_radius=0.1), EndRelief(6e-6, -0.38, -0.31, 1.0)
    allowed = TipTolerance(2e-6, 1e-3, 0.0)
    assert allowed.off(ring, tip, 0, 0) == tip
    for amount, length in product((-1, 1), repeat=2):
        off = allowed.off(ring, tip, amount, length)
        assert (off.amount, off.start, off.end) == pytest.approx((6e-6 + 2e-6 * amount, -0.38 - 0.01 * length, -0.31))
    low, high = allowed.limits(ring, tip, [-0.45, -0.395, -0.31])
    assert low == pytest.approx([0.0, 0.0, 4e-6])
    assert high == pytest.approx([0.0, 0.0, 8e-6])
    assert (
        replace(allowed, length=8e-3).off(SimpleNamespace(base_radius=0.1), EndRelief(6e-6, 0.02, 0.07), 0, 1).start
        == 0
    )


def test_the_drawing_of_a_ring_gear_has_positive_roll_angles_and_lengths():
    cutter = PinionCutter(25, addendum=1.25, tip_radius=0.3)
    ring = Gear(InternalTooth(97, cutter), 2.25e-3, 0.125)
    root, top = (float(roll_of_radius(ring, r)) for r in (ring.form_radius, ring.involute_tip_radius))
    relief = EndRelief(6e-6, top - 0.05, top)
    chart = profile_chart("r", ring, relief, TipTolerance(2e-6, None, 0.0))
    assert chart.roll_length.min() == pytest.approx(-ring.base_radius * top)
    assert chart.roll_length.max() == pytest.approx(-ring.base_radius * root)
    deepest = chart.roll_length[np.argmin(chart.profile)]
    assert deepest == chart.roll_length.min()  # at the tip
    assert chart.marks[0].at == pytest.approx(ring.base_radius * (0.05 - top) * 1e3)
    assert _tip_side({"linear": (chart,)}) == "tip at right (of r at left)"
    tip = GroundTip(
        SimpleNamespace(driver=relief, driver_band=(relief, relief), undeviated=None),
        ring,
        None,
        None,
        "linear",
        "driver",
    )
    tip = replace(tip, ground=SimpleNamespace(**vars(tip.ground), error=np.array([1e-7, 1e-3, 0.0, 0.0])))
    row = tip_row(tip, "r", TipTolerance(2e-6, None, 0.0))
    assert row.start_roll_angle == tip.start == 0.05 - top > 0.0
    assert 0.5 * row.start_diameter == pytest.approx(ring.base_radius * np.hypot(1.0, tip.start))
    assert row.start_diameter_error > 0.0
    assert tip.equal_starts == f"{np.degrees(0.05 - top):.5g} to {np.degrees(0.05 - top):.5g} deg"


def test_a_gear_without_relief_has_a_level_chart_with_the_band_of_its_profile_slope(engagement, tips):
    chart = profile_chart("p", engagement.pair.driver, replace(tips[0], amount=0.0), TipTolerance(4e-6, None, 3e-6))
    assert not chart.profile.any()
    assert (chart.marks, chart.words) == ((), "no relief, profile slope ± 4 µm; f_{fα} 3 µm")
    assert (chart.lower[0], chart.upper[0], chart.with_form[0]) == pytest.approx((0.0, 0.0, -3e-6), abs=1e-12)
    assert (chart.lower[-1], chart.upper[-1], chart.with_form[-1]) == pytest.approx((-4e-6, 4e-6, -7e-6), abs=1e-12)
    assert chart.upper == pytest.approx(-chart.lower, abs=1e-15)
    axis = _ordinate(SimpleNamespace(one=chart))
    assert axis.limits[1] > 4.0
    exact = profile_chart("p", engagement.pair.driver, replace(tips[0], amount=0.0), TipTolerance(0.0, None, 3e-6))
    assert exact.words == "no relief; f_{fα} 3 µm"
