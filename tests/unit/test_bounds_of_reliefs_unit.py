"""Reliefs deeper than teeth and what would do instead; tolerances of tip reliefs, and which of them decides."""

import math
import re
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design import relief_bench, relief_bound
from fegear.design.charts import ReliefChart, unit_length
from fegear.design.fillet.fillet_search import Found
from fegear.design.loading import LoadingFunction
from fegear.design.tip_relief import tolerated
from fegear.design.tip_relief.tip_tolerance import OF_LENGTH, TipTolerance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import UNMODIFIED, EndRelief

PITCH = 6e-3


# ---- reliefs deeper than teeth ---------------------------------------------------------------------------------------
@dataclass(frozen=True)
class Relief:
    """Half as deep again on the driven gear; deeper under more load, for shorter zones and beside the middle."""

    member: str
    loading: LoadingFunction
    load: float
    compliance: object
    centre: float

    def at(self, x):
        ratio = self.loading.length / PITCH
        away = abs(self.loading.centre - self.centre) / PITCH
        part = 1.0 if self.member == "driver" else 1.5
        # Largest in the middle of the places that are looked at.
        shape = 1.0 - ((x - x.mean()) / np.ptp(x)) ** 2
        return part * 1e-5 * self.load * (3.0 - ratio + 4.0 * away) * shape


def reliefs(load, ratio, off=0.0, path=1.8 * PITCH):
    pair = SimpleNamespace(
        x_start=-0.4 * path, x_end=0.6 * path, path_length=path, driver=SimpleNamespace(base_radius=0.05),
        gear=lambda member: member, roll_angle=lambda x, member: x,
    )  # fmt: skip
    middle = 0.1 * path
    compliance = SimpleNamespace(pair=pair, face_width=0.02)
    zone = LoadingFunction(ratio * PITCH, PITCH, middle + off)
    return [Relief(member, zone, load, compliance, middle) for member in ("driver", "driven")]


@pytest.fixture(autouse=True)
def room(monkeypatch):
    """A millimetre of every tooth may go."""
    monkeypatch.setattr(relief_bound, "deepest_relief", lambda gear, roll: np.full(np.shape(roll), 1e-3))


def refused(*given):
    with pytest.raises(RangeError) as error:
        relief_bound.refuse_deeper_than_the_tooth(*given)
    return error.value


def test_reliefs_within_their_teeth_are_none_to_be_refused():
    relief_bound.refuse_deeper_than_the_tooth(*reliefs(40.0, 1.4))


def test_the_shortest_zone_that_does_is_named():
    """1.5 (3 - a) 10 um for each N: at 50 N the driven gear's tooth has room from a = 3 - 1e-3 / 750e-6 on."""
    error = refused(*reliefs(50.0, 1.4))
    assert (error.key, error.value) == ("design.contact_ratio", "1.4")
    least, length = (float(one) for one in re.findall(r"[0-9]+[.]?[0-9]*", error.remedy)[:2])
    assert least == pytest.approx(3.0 - 4.0 / 3.0, abs=1e-3)
    assert least >= 3.0 - 4.0 / 3.0
    assert length == pytest.approx(least * 6.0, rel=1e-4)
    assert "1200 um on the driven, 1.2 times" in error.rule
    relief_bound.refuse_deeper_than_the_tooth(*reliefs(50.0, least))


def test_where_no_zone_about_that_centre_does_the_middle_of_the_path_is_named():
    """0.2 pitches aside a zone of 1.4 may be as long, at most, as it is."""
    error = refused(*reliefs(50.0, 1.4, 0.2 * PITCH))
    assert error.key == "design.centre"
    assert f"the middle of the path, {0.18 * 6.0:.6g} mm" in error.remedy
    assert f"up to {1.8 * 6.0:.6g} mm" in error.remedy


def test_else_the_largest_load_that_does_is_named_in_all_its_units():
    error = refused(*reliefs(90.0, 1.4))
    assert error.key == "design.load"
    assert error.value == "90 N (4.5 N m on the driver)"
    limit, torque, line = (float(one) for one in re.findall(r"([0-9.]+) N", error.remedy))
    exact = 1e-3 / (1.5e-5 * 1.2)  # with the whole path of 1.8 pitches
    assert 0.9 * exact < limit < exact * 1.001
    assert torque == pytest.approx(limit * 0.05, rel=5e-3)
    assert line == pytest.approx(limit / 20.0, rel=5e-3)
    relief_bound.refuse_deeper_than_the_tooth(*reliefs(limit * 0.999, 1.8))


def test_a_relief_that_is_no_number_is_deeper_than_any_tooth():
    one, other = reliefs(40.0, 1.4)
    wrong = SimpleNamespace(**vars(one) | {"at": lambda x: np.where(x > x.mean(), np.nan, 1e-6)})
    assert relief_bound._depth(wrong) == float("inf")
    assert relief_bound._depth(other) == pytest.approx(1.5 * 40.0 * 1.6e-5 / 1e-3, rel=1e-3)


def test_the_least_in_thousandths_is_the_first_that_fits_or_the_highest():
    for bound in (1.2345, 1.9, 1.2001):
        found = relief_bound._least(lambda a, bound=bound: a >= bound, 1.2, 1.9)
        assert found >= bound
        assert found - bound < 1e-3 or found == 1.9
    assert relief_bound._least(lambda a: True, 1.2, 1.9) == pytest.approx(1.201)
    assert relief_bound._least(lambda a: False, 1.2, 1.9) == 1.9
    assert relief_bound._least(lambda a: False, 1.2, 1.2004) == 1.2004


# ---- tolerances ------------------------------------------------------------------------------------------------------
GEAR, TIP = SimpleNamespace(base_radius=0.04), EndRelief(20e-6, 0.3, 0.4)
ALLOWED = TipTolerance(5e-6, 0.8e-3, 2e-6)


def test_reliefs_are_off_in_amount_and_in_length_from_the_tip_on():
    for amount in (-1, 0, 1):
        for length in (-1, 0, 1):
            found = ALLOWED.off(GEAR, TIP, amount, length)
            assert found.amount == pytest.approx(20e-6 + amount * 5e-6)
            assert found.end == 0.4
            assert (found.end - found.start) * 0.04 == pytest.approx(4e-3 + length * 0.8e-3)
    assert ALLOWED.length_of(GEAR, TIP) == 0.8e-3
    free = replace(ALLOWED, length=None)
    assert free.length_of(GEAR, TIP) == pytest.approx(OF_LENGTH * 4e-3)
    # None is less than nothing, shorter than a fiftieth, or begins below the base circle of an external gear.
    assert replace(ALLOWED, amount=30e-6).off(GEAR, TIP, -1, 0).amount == 0.0
    short = replace(ALLOWED, length=5e-3).off(GEAR, TIP, 0, -1)
    assert short.end - short.start == pytest.approx(0.02 * 0.1)
    assert replace(ALLOWED, length=20e-3).off(GEAR, TIP, 0, 1).start == 0.0
    ring = EndRelief(20e-6, -0.4, -0.3)
    assert replace(ALLOWED, length=20e-3).off(GEAR, ring, 0, 1).start == pytest.approx(-0.9)


def test_a_chart_allows_all_that_lies_between_the_ends_and_the_form_besides():
    roll = np.linspace(0.25, 0.4, 40)
    low, high = ALLOWED.limits(GEAR, TIP, roll)
    each = [ALLOWED.off(GEAR, TIP, a, b).removal(roll) for a in (-1, 1) for b in (-1, 1)]
    np.testing.assert_allclose(low, np.min(each, axis=0), atol=1e-18)
    np.testing.assert_allclose(high, np.max(each, axis=0) + 2e-6, atol=1e-18)
    assert (low[-1], high[-1]) == pytest.approx((15e-6, 27e-6))
    # Without a relief the profile slope is off, straight up to the tip.
    slope = 5e-6 * (roll - 0.25) / 0.15
    nothing = ALLOWED.limits(GEAR, replace(TIP, amount=0.0), roll)
    np.testing.assert_allclose(nothing, (-slope, slope + 2e-6), atol=1e-18)


def test_half_of_a_tolerance_is_that_of_its_number():
    for number, amount, length in (("amount", 2.5e-6, 0.8e-3), ("length", 5e-6, 0.4e-3)):
        found = ALLOWED.halved(number, GEAR, TIP)
        assert (found.amount, found.length, found.form) == pytest.approx((amount, length, 2e-6))
    assert replace(ALLOWED, length=None).halved("length", GEAR, TIP).length == pytest.approx(0.5 * OF_LENGTH * 4e-3)


@pytest.mark.parametrize("ground", [(True, True), (True, False), (False, False)])
def test_the_tolerance_decides_by_which_halved_least_is_left_under_each_load(monkeypatch, ground):
    """Errors made up, straight in all deviations: at the first load amounts of the driver count most, then lengths.

    Of a gear that is not ground the profile slope counts as an amount does, to either side, and no length.
    """
    weights = np.array([[3.0, 1.0, 2.0, 1.0], [1.0, 2.0, 1.0, 6.0]])
    tips = tuple(TIP if one else replace(TIP, amount=0.0) for one in ground)
    gears = SimpleNamespace(
        driver=GEAR, driven=GEAR, gear=lambda member: GEAR, x_start=-5e-3, x_end=5e-3,
        roll_angle=lambda x, member: 0.3 + (x if member == "driver" else -x) / GEAR.base_radius,
    )  # fmt: skip
    engagement = SimpleNamespace(pair=gears)

    def deviations(one, is_ground):
        if one is UNMODIFIED:
            return [0.0, 0.0]
        if not is_ground:
            assert sorted((one.start, one.end)) == pytest.approx([0.3 - 0.125, 0.3 + 0.125])
            return [math.copysign(one.amount, one.end - one.start) / 20e-6, 0.0]
        return [one.amount / 20e-6 - 1.0, (one.end - one.start) / 0.1 - 1.0]

    def on_grid(table, both, loads):
        assert table == ("table", 6)
        found = []
        for pair in both:
            off = [each for one, of_one in zip(pair, ground, strict=True) for each in deviations(one, of_one)]
            found.append(1e-6 * (5.0 + weights @ np.array(off)))
        return np.array(found)

    monkeypatch.setattr(tolerated, "bench", lambda engagement, order: ("table", order))
    monkeypatch.setattr(tolerated, "_on_grid", on_grid)
    most = np.array([9e-6, 8e-6])
    allowed = ALLOWED, replace(ALLOWED, length=0.4e-3)
    found = tolerated.decisive_tolerances(engagement, tips, allowed, (100.0, 200.0), most)
    parts = np.array([0.25, 0.2 * ground[0], 0.25, 0.1 * ground[1]])
    whole = 5.0 + weights @ parts
    half = whole[:, None] - 0.5 * weights * parts
    for load, one in enumerate(found):
        choices = [k for k in range(4) if ground[k // 2] or k % 2 == 0]
        best = min(choices, key=lambda k, load=load: half[load, k])
        numbers = ("amount", "length") if ground[best // 2] else ("profile_slope",)
        assert (one.member, one.number) == (("driver", "driven")[best // 2], numbers[best % 2])
        assert one.most == pytest.approx(most[load] * half[load, best] / whole[load], rel=1e-9)
        assert one.given == (5e-6, (0.8e-3, 0.4e-3)[best // 2])[best % 2]


# ---- charts and benches ----------------------------------------------------------------------------------------------
def chart_of(worst, amounts, lengths, loads=(100.0,)):
    values = np.repeat(np.asarray(worst)[:, :, None], len(loads), axis=2)
    return ReliefChart(np.asarray(amounts), np.asarray(lengths), np.asarray(loads), 1e-3, values, values)


def test_a_boundary_is_where_so_much_more_is_left_and_parts_of_it_are_apart():
    """Two cones of one depth: circles about both, with a gap between them."""
    amounts, lengths = np.linspace(0.0, 4.0, 81), np.linspace(0.0, 8.0, 161)
    a, b = np.meshgrid(amounts, lengths, indexing="ij")
    cones = np.minimum(np.hypot(a - 2.0, b - 2.0), np.hypot(a - 2.0, b - 6.0)) + 10.0
    chart = chart_of(cones, amounts, lengths)
    found_a, found_b = chart.boundary(0.1)
    apart = np.isnan(found_a)
    assert apart.sum() == 1
    assert (apart == np.isnan(found_b)).all()
    away = np.minimum(np.hypot(found_a - 2.0, found_b - 2.0), np.hypot(found_a - 2.0, found_b - 6.0))[~apart]
    assert away == pytest.approx(1.0, abs=2e-3)
    assert (found_b[~apart] < 4.0).sum() == pytest.approx(0.5 * away.size, abs=1)
    assert chart.boundary(-0.1)[0].size == 0
    one = chart_of(cones[:1], amounts[:1], lengths)
    assert one.boundary(0.1)[0].size == one.boundary(0.1)[1].size == 0


@pytest.mark.parametrize("loads", [(100.0,), (100.0, 100.0, 100.0)])
def test_a_finer_chart_divides_all_cells_about_what_leaves_at_most_twice_the_least(loads):
    amounts, lengths = np.array([0.0, 1.0, 2.0, 4.0, 7.0]), np.array([0.1, 0.3, 0.5, 0.8])
    worst = np.full((5, 4), 5.0)
    worst[1, 2], worst[2, 2], worst[2, 1] = 1.0, 1.9, 2.0
    chart = chart_of(worst, amounts, lengths, loads)
    finer_a, finer_b = chart.finer()
    assert finer_a == pytest.approx(np.concatenate([np.linspace(0.0, 2.0, 9), np.linspace(2.5, 4.0, 4)]))
    assert finer_b == pytest.approx(np.concatenate([np.linspace(0.1, 0.5, 9), np.linspace(0.575, 0.8, 4)]), abs=1e-12)
    # Many cells are divided by less, so that no more than some 5000 points are tried.
    many = chart_of(np.ones((41, 41)), np.arange(41.0), np.arange(41.0), loads)
    a, b = many.finer()
    parts = max(int((5000 / (1600 * len(loads))) ** 0.5), 1)
    assert (a.size, b.size) == (40 * parts + 1, 40 * parts + 1)
    assert (a[0], a[-1], b[0], b[-1]) == (0.0, 40.0, 0.0, 40.0)


def test_the_unit_of_lengths_is_what_lies_beyond_the_base_pitches_in_single_contact():
    def unit(ratio):
        return unit_length(SimpleNamespace(contact_ratio=ratio, path_length=ratio * PITCH, base_pitch=PITCH)) / PITCH

    # To the highest point of single contact; beyond the innermost pitch, half on each side.
    assert [unit(one) for one in (1.4, 1.999, 2.0, 2.6, 3.0, 3.3)] == pytest.approx([0.4, 0.999, 0.5, 1.1, 0.5, 0.8])


def test_cases_of_a_bench_are_loaded_alike_in_parts_and_at_once(monkeypatch):
    rack = BasicRack(1.0, 1.25, 0.2)
    gears = [Gear(Tooth(z, rack), 3e-3, 0.01, 0.03) for z in (24, 36)]
    engagement = Engagement(
        PairCompliance(GearPair(*gears), *(closed_form_compliance(one, "cornell") for one in gears))
    )
    table = relief_bench.bench(engagement, order=3, waves=2)
    cases = 1e-6 * np.arange(5) * np.ones((*table.grid.contacts.x.shape, 1))
    cases[0] *= 0.0
    loads = np.linspace(1000.0, 5000.0, 5)
    whole = table.errors(cases, loads)
    for size in (1, 2 * table.points.x.size, 3 * table.points.x.size):
        monkeypatch.setattr(relief_bench, "_BATCH", size)
        parts = table.errors(cases, loads)
        for name in ("effective_error", "peak_to_peak", "mean", "transmission_error"):
            np.testing.assert_allclose(getattr(parts, name), getattr(whole, name), rtol=1e-12)
    assert whole.of("effective_error") is whole.effective_error
    assert whole.of("peak_to_peak") == pytest.approx(np.ptp(whole.transmission_error, axis=0))


def test_limits_that_are_broken_by_a_thousandth_are_kept():
    assert Found(np.zeros(1), None, 1.0, 1, -0.95e-3).kept
    assert not Found(np.zeros(1), None, 1.0, 1, -1.05e-3).kept
