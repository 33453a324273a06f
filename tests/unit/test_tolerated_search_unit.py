"""Tip reliefs whose worst place within the tolerances leaves the least: held against brute force and differences."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design.load_range import LoadRange
from fegear.design.tip_relief.grindable import grindable, relief_over_path, tolerated
from fegear.design.tip_relief.relief_limits import ReliefLimits
from fegear.design.tip_relief.relief_scan import even_bench
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.design.tip_relief.tolerated import within_tolerances
from fegear.design.tip_relief.tolerated_search import ToleratedTrials, tolerance_ends
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import UNMODIFIED, EndRelief, roll_of_radius

GEARS = [Gear(Tooth(z, BasicRack()), 3e-3, 0.1 * z * 3e-3, 0.02) for z in (24, 36)]
PAIR = GearPair(*GEARS)
OVER = LoadRange((3000.0, 6000.0))
LOADS = np.array(OVER.loads)
EVERY = tolerance_ends((True, True), "every")
TOLERANCES = TipTolerance(6e-6, None, 0.0), TipTolerance(5e-6, 0.6e-3, 0.0)


@pytest.fixture(scope="module")
def engagement():
    sources = [closed_form_compliance(gear, "weber-banaschek") for gear in GEARS]
    return Engagement(PairCompliance(PAIR, *sources, hertz="linear", nominal_load=6000.0))


@pytest.fixture(scope="module")
def trials(engagement):
    rolls = [float(roll_of_radius(gear, gear.involute_tip_radius)) * gear.base_radius for gear in GEARS]
    return ToleratedTrials(
        even_bench(engagement, 20), LOADS, 1.0, "peak_to_peak", None, EVERY, (6e-6, 5e-6),
        (None, 0.6e-3 / PAIR.path_length), (rolls[0] / PAIR.path_length, rolls[1] / PAIR.path_length),
    )  # fmt: skip


def tips(p, power=1.0):
    return tuple(relief_over_path(gear, PAIR.path_length, *p[2 * i : 2 * i + 2], power) for i, gear in enumerate(GEARS))


def most(engagement, p, tolerances=TOLERANCES):
    """At the worst of both loads, in proportion [m]."""
    return float((within_tolerances(engagement, tips(p), tolerances, LOADS)[:, 1] * [2.0, 1.0]).max())


@pytest.mark.parametrize(
    "p",
    [(20e-6, 0.4, 15e-6, 0.5), (3e-6, 0.9, 2e-6, 0.05), (0.0, 0.3, 9e-6, 1.0), (8e-6, 1.0, 0.0, 0.3)],
)  # fmt: skip
def test_reliefs_are_off_as_a_drawing_allows(trials, p):
    """Amounts are not negative, lengths not nothing and not beyond the base circle; at no amount there is no step."""
    q, _ = trials.off(np.array([p]))
    for off, found in zip(EVERY.tolist(), q[0], strict=True):
        for i, (gear, tip, allowed) in enumerate(zip(GEARS, tips(p), TOLERANCES, strict=True)):
            expected = allowed.off(gear, tip, *off[2 * i : 2 * i + 2])
            assert found[2 * i] == pytest.approx(expected.amount, abs=1e-15)
            length = gear.base_radius * (expected.end - expected.start) / PAIR.path_length
            assert found[2 * i + 1] == pytest.approx(length, rel=1e-9)


@pytest.mark.parametrize("power", [1.0, 2.0])
@pytest.mark.parametrize(
    ("ground", "p"), [((True, False), (20e-6, 0.4, 0.0, 0.3)), ((False, True), (0.0, 0.3, 15e-6, 0.5))]
)  # fmt: skip
def test_the_profile_slope_of_a_gear_that_is_not_ground_is_off(engagement, trials, ground, p, power):
    """Against every combination written out: straight removal over the path, growing to the tip or to the root."""
    ends = tolerance_ends(ground, "every")
    assert len(ends) == 27
    one = replace(trials, bench=even_bench(engagement, 56), power=power, ends=ends, ground=ground)
    bare = ground.index(False)
    root, tip = (PAIR.x_start, PAIR.x_end) if bare == 0 else (PAIR.x_end, PAIR.x_start)
    roll = [float(PAIR.roll_angle(x, ("driver", "driven")[bare])) for x in (root, tip)]
    sloped = {
        0: UNMODIFIED,
        1: EndRelief(TOLERANCES[bare].amount, *roll, 1.0),
        -1: EndRelief(TOLERANCES[bare].amount, *roll[::-1], 1.0),
    }
    own = np.empty((27, 2))
    for row, off in enumerate(ends.tolist()):
        flanks = [
            sloped[off[2 * i]] if i == bare else TOLERANCES[i].off(GEARS[i], tips(p, power)[i], *off[2 * i : 2 * i + 2])
            for i in (0, 1)
        ]
        ground_pair = replace(engagement, driver_relief=flanks[0], driven_relief=flanks[1])
        own[row] = [transmission_error(ground_pair, load, 12).peak_to_peak for load in LOADS]
    worst = (own * [2.0, 1.0]).max(axis=1)
    assert one.exactly(np.array(p)) == pytest.approx(worst, rel=2e-3)
    assert one.each(np.array([p]))[0] == pytest.approx(worst, rel=0.1)
    tried = one.exact(np.array([p]))
    assert one.left(tried.seen, tried.low)[0] == pytest.approx(worst.max(), rel=2e-3)
    found = within_tolerances(engagement, tips(p, power), TOLERANCES, LOADS)
    assert found[:, 1] == pytest.approx(own.max(axis=0), rel=1e-3)
    assert found[:, 0] == pytest.approx(own.min(axis=0), rel=0.05)
    assert worst.max() > 1.1 * worst[ends[:, 2 * bare] == 0].max()  # what counting the ground gear only would say


@pytest.mark.parametrize("way", ["rough", "exact"])
def test_what_is_left_at_most_changes_with_the_numbers_as_its_slopes_say(trials, way):
    p = np.array([[20e-6, 0.4, 15e-6, 0.55], [9e-6, 0.3, 12e-6, 0.45]])
    evaluate = getattr(trials, way)
    tried = evaluate(p)
    value, slope = trials.tangent(tried, np.zeros_like(p))
    assert value == pytest.approx(trials.left(tried.seen, tried.low))
    for k, step in enumerate((1e-10, 1e-6, 1e-10, 1e-6)):
        ends = []
        for sign in (1.0, -1.0):
            moved = p.copy()
            moved[:, k] += sign * step
            tried = evaluate(moved)
            ends.append(trials.left(tried.seen, tried.low))
        change = (ends[0] - ends[1]) / (2.0 * step)
        assert slope[:, k] == pytest.approx(change, rel=2e-2, abs=2e-3 * np.abs(slope[:, k]).max())


def test_the_largest_of_all_ends_is_what_is_left(trials, engagement):
    p = np.array([15e-6, 0.35, 12e-6, 0.4])
    tried = trials.exact(p[None])
    fine = replace(trials, bench=even_bench(engagement, 56))
    assert trials.left(tried.seen, tried.low)[0] == pytest.approx(most(engagement, p), rel=5e-3)
    tried = fine.exact(p[None])
    assert fine.left(tried.seen, tried.low)[0] == pytest.approx(most(engagement, p), rel=1e-3)
    assert fine.each(p[None]).max() == pytest.approx(most(engagement, p), rel=5e-2)


def numbers(found):
    p = []
    for gear, tip in zip(GEARS, (found.driver, found.driven), strict=True):
        p += [tip.amount, (tip.end - tip.start) * gear.base_radius / PAIR.path_length]
    return np.array(p)


@pytest.mark.dear
def test_no_relief_leaves_less_within_its_tolerances_by_brute_force(engagement, trials):
    """Some 5000 reliefs of a grid of its own, with all ends of their tolerances, the best 12 of them with all kinks."""
    found = tolerated(engagement, OVER, "linear", TOLERANCES)
    drawn = grindable(engagement, OVER, "linear", banded=False)
    own = most(engagement, numbers(found))
    axes = np.linspace(0.0, 48e-6, 9), np.linspace(0.1, 1.0, 8)
    grid = np.array(list(product(*axes, *axes)))
    values = trials.each(grid).max(axis=1)
    least = min(most(engagement, grid[i]) for i in np.argsort(values)[:12])
    assert own < 1.002 * least
    assert own < 0.5 * most(engagement, numbers(drawn))  # 6.9 for 17.6 um
    assert found.objective > drawn.objective  # which it pays for as drawn
    # The relief that leaves the least as drawn goes with it.
    for one, other in zip(found.undeviated, (drawn.driver, drawn.driven), strict=True):
        assert one.amount == pytest.approx(other.amount, rel=1e-3)


@pytest.mark.dear
@pytest.mark.parametrize("bare", [0, 1])
def test_no_relief_of_one_gear_leaves_less_within_its_tolerances_by_brute_force(engagement, trials, bare):
    """360 reliefs of one gear with the profile slope of the other, which a relief of both cannot hide from."""
    most_amounts = [0.0 if gear == bare else math.inf for gear in (0, 1)]
    found = tolerated(engagement, OVER, "linear", TOLERANCES, limits=ReliefLimits(tuple(most_amounts)))
    own, ground = most(engagement, numbers(found)), (bare == 1, bare == 0)
    one = replace(trials, ends=tolerance_ends(ground, "every"), ground=ground)
    grid = np.zeros((360, 4))
    grid[:, [1, 3]] = 0.3
    kept = 2 * (1 - bare)
    grid[:, kept : kept + 2] = list(product(np.linspace(2e-6, 40e-6, 20), np.linspace(0.1, 1.0, 18)))
    values = one.each(grid).max(axis=1)
    least = min(most(engagement, grid[i]) for i in np.argsort(values)[:12])
    assert own < 1.002 * least
    both = tolerated(engagement, OVER, "linear", TOLERANCES)
    assert most(engagement, numbers(both)) < 1.001 * own


@pytest.mark.dear
def test_without_tolerances_the_least_at_most_is_the_least_as_drawn(engagement):
    exact = (TipTolerance(0.0, 0.0, 0.0),) * 2
    found = tolerated(engagement, OVER, "linear", exact, limits=ReliefLimits((10e-6, 10e-6)))
    drawn = grindable(engagement, OVER, "linear", banded=False, limits=ReliefLimits((10e-6, 10e-6)))
    assert found.objective <= (1.0 + 2e-3) * drawn.objective
    assert max(found.driver.amount, found.driven.amount) <= 10e-6 * (1.0 + 1e-9)
    one = tolerated(engagement, OVER, "linear", exact, limits=ReliefLimits((0.0, math.inf)))
    assert one.driver.amount == 0.0 < one.driven.amount
