"""The search over a grid of ground reliefs: how many are loaded exactly, which the best is, what is proven of it.

With few candidates loaded exactly; valleys have a test of their own.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.design.flanks import families
from fegear.design.flanks.families import best_of_family, led_on
from fegear.design.flanks.forms import GroundRelief

LOW, HIGH = np.zeros(9), np.arange(1000.0, 1009.0)
GRID = SimpleNamespace(limits=lambda family: (LOW, HIGH), at_ends=lambda family, at: {})
GRID.widened = lambda family, at: GRID


def numbered(i):
    return np.full(9, float(i))


class Trials:
    """In place of trials: what the relief of a number leaves is that of a list, and so is its K_Hbeta."""

    def __init__(self, leaves, factors=None):
        self.leaves, self.factors, self.tried = leaves, factors, []
        self.known, self.cells = "known", "cells"

    def of_numbers(self, numbers, near=None):
        at = int(numbers[0])
        self.tried.append(at)
        factor = 1.0 if self.factors is None else self.factors[at]
        return SimpleNamespace(peak_to_peak=self.leaves[at], face_load_factor=np.array([0.9, factor]))

    def value(self, left):
        return float(left)

    relief = staticmethod(GroundRelief.of)


@pytest.fixture
def search(monkeypatch):
    """A search in which quick values are given, and no descent gains anything but that of one start."""
    calls = SimpleNamespace(descents=[], quick=None)

    def of(rough, leaves, factors=None, quick_factors=None, gains=None, kept=True, **how):
        rough, trials = np.asarray(rough, float), Trials(np.asarray(leaves, float), factors)
        numbers = np.array([numbered(i) for i in range(rough.size)])
        quick_factors = np.ones(rough.size) if quick_factors is None else np.asarray(quick_factors, float)
        monkeypatch.setattr(families, "quick_flanks", lambda *given: calls.__setattr__("quick", given) or "quick")
        monkeypatch.setattr(families, "quick_values", lambda *given: (numbers, rough, quick_factors))

        def descend(trials_, start, value, box, most=np.inf, *ended):
            calls.descents.append((int(start[0]), value, most))
            assert box[0] is LOW
            assert box[1] is HIGH
            return value - (gains or {}).get(int(start[0]), 0.0), start + 0.25

        def valleys(few, more, places, box, most, floors=(), ahead=None):
            assert few.tried is trials.tried
            reached = [descend(more, at, more.value(more.leaves[int(at[0])]), box, most) for at in places]
            return sorted(reached, key=lambda one: one[0])[:3] if kept else []

        monkeypatch.setattr(families, "descend", descend)
        monkeypatch.setattr(families, "deepest_valleys", valleys)
        monkeypatch.setattr(families, "_LEAST_EXACT", 24)
        monkeypatch.setattr(families, "_STARTS", 6)
        return best_of_family(trials, "lead", GRID, "force", **how), trials, calls

    return of


def test_few_are_all_loaded_exactly_and_the_largest_excess_of_the_quick_way_is_told(search):
    found, trials, calls = search([5.0, 3.0, 4.0, 6.0], [4.5, 3.5, 3.25, 6.5])
    assert trials.tried == [1, 2, 0, 3]
    assert (found.candidates, found.exact, found.quick_error, found.proven) == (4, 4, 0.75, True)
    assert (found.value_on_grid, found.on_grid.numbers[0]) == (3.25, 2)
    assert (found.value, found.relief.numbers[0]) == (3.25, 2.25)
    assert [one[:2] for one in calls.descents] == [(2, 3.25), (1, 3.5), (0, 4.5), (3, 6.5)]
    assert calls.quick == ("known", "force", 5, "cells")


def test_a_quick_way_that_is_never_too_high_has_no_error(search):
    assert search([1.0, 2.0], [1.5, 2.5])[0].quick_error == 0.0


def test_it_stops_where_no_error_seen_could_make_up_for_what_is_left(search):
    count = 60
    rough = 10.0 + np.arange(count)
    leaves = rough.copy()
    leaves[3] -= 30.0 - 0.5  # The quick way is 29.5 too high here: all up to 13 - 29.5 + 29.5 might be better.
    found, trials, _ = search(rough, leaves)
    assert (found.on_grid.numbers[0], found.value_on_grid, found.quick_error) == (3, -16.5, 29.5)
    assert (found.exact, found.proven) == (24, True)
    leaves = rough.copy()
    leaves[20] -= 5.0
    leaves[2] += 40.0
    found, trials, _ = search(rough, leaves)
    assert (found.value_on_grid, found.quick_error, found.exact, found.proven) == (10.0, 5.0, 24, True)
    leaves[0:15] += 40.0
    found, trials, _ = search(rough, leaves)
    assert found.on_grid.numbers[0] in (15, 20)
    assert (found.value_on_grid, found.quick_error, found.exact) == (25.0, 5.0, 24)
    leaves[0:30] += 80.0
    found, trials, _ = search(rough, leaves)
    # None too high: the first that is not raised stays the best, and the one after it is above it.
    assert (found.value_on_grid, found.quick_error, found.exact, found.proven) == (40.0, 0.0, 31, True)
    assert trials.tried == list(range(31))


def test_of_too_many_the_rest_is_not_proven(search):
    # The one that the quick way misses most has too large a factor: its error stays, it is not the best.
    rough = 10.0 + 1e-3 * np.arange(300)
    leaves, factors = rough.copy(), np.ones(300)
    leaves[0], factors[0] = 9.0, 2.0
    found, _, _ = search(rough, leaves, factors, most_factor=1.5)
    assert (found.candidates, found.exact, found.proven) == (300, 240, False)
    assert (found.quick_error, found.on_grid.numbers[0]) == (1.0, 1)


def test_descents_start_from_the_best_six_and_the_best_of_them_is_kept(search):
    leaves = [9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0]
    found, _, calls = search(np.arange(8.0), leaves, gains={5: 2.5, 3: 3.0})
    assert [start for start, _, _ in calls.descents] == [7, 6, 5, 4, 3, 2]
    assert (found.value, found.relief.numbers[0]) == (1.5, 5.25)
    assert (found.value_on_grid, found.on_grid.numbers[0]) == (2.0, 7)


def test_the_largest_factor_is_kept_to_and_the_quick_way_may_err_by_a_twentieth(search):
    rough, leaves = [1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 3.0, 4.0]
    found, trials, calls = search(rough, leaves, [1.25, 1.2, 1.1, 1.0], [1.27, 1.2599, 1.1, 1.0], most_factor=1.2)
    assert trials.tried == [1, 2, 3]
    assert (found.on_grid.numbers[0], found.exact, found.candidates) == (1, 3, 4)
    assert {most for _, _, most in calls.descents} == {1.2}
    # Loaded exactly, the first has too large a factor: the second is the best.
    assert search(rough, leaves, [1.21, 1.2, 1.1, 1.0], [1.2] * 4, most_factor=1.2)[0].on_grid.numbers[0] == 1
    with pytest.raises(RangeError, match=r"4 combinations of lead.* about 1\.3"):
        search(rough, leaves, [1.5] * 4, [1.4, 1.3, 1.5, 1.6], most_factor=1.2)


def test_further_starts_come_first_and_are_led_on_within_the_box(search):
    start = GroundRelief.of(numbered(5))
    found, trials, calls = search([1.0, 2.0], [6.0, 7.0, 8.0, 8.0, 8.0, 5.5], gains={5: 1.0}, starts=[start])
    assert [one[:2] for one in calls.descents] == [(5, 5.5), (0, 6.0), (1, 7.0)]
    assert (found.value, found.relief.numbers[0], found.value_on_grid) == (4.5, 5.25, 6.0)
    assert [one.numbers[0] for one in found.valleys] == [5.25, 0.25, 1.25]
    above = led_on(trials, found, GRID, GroundRelief.of(numbered(1)), np.inf)
    assert above is found  # What is not better is not taken.
    outside = GroundRelief.of(numbered(-3.0))
    led_on(trials, found, GRID, outside)
    assert calls.descents[-1][:2] == (0, 6.0)


def test_where_no_start_keeps_to_the_limit_at_more_positions_the_best_of_few_stays(search):
    found, _, _ = search([1.0, 2.0], [6.0, 5.0], kept=False)
    assert (found.value, found.relief.numbers[0], found.on_grid.numbers[0]) == (5.0, 1, 1)
    assert len(found.valleys) == 1


def test_a_start_whose_factor_is_too_large_is_left_out(search):
    factors = [1.0, 1.0, 1.3]
    found, trials, calls = search([1.0, 2.0], [6.0, 7.0, 1.0], factors, most_factor=1.2)
    before = len(calls.descents)
    assert led_on(trials, found, GRID, GroundRelief.of(numbered(2)), 1.2) is found
    assert len(calls.descents) == before
    assert led_on(trials, found, GRID, GroundRelief.of(numbered(2)), 1.3).value == 1.0


def test_the_search_goes_on_in_a_wider_box_as_long_as_that_gains(monkeypatch):
    """A relief that leaves 10 - amount + the amount beyond 4.5: its least is past the second widening."""
    boxes, least = [], [0.0]

    def box(most):
        grid = SimpleNamespace(reach={"driver_tip": (0.0, most)})
        grid.limits = lambda family: (np.zeros(9), np.full(9, most))
        grid.at_ends = lambda family, at: {"driver_tip": True} if at[0] >= most else {}
        grid.widened = lambda family, at: box(2.0 * most) if at[0] >= most else grid
        return grid

    def valleys(few, more, places, limits, most_factor, floors=(), ahead=None):
        boxes.append(limits[1][0])
        at = np.full(9, min(limits[1][0], least[0]))
        return [(10.0 - at[0], at)]

    monkeypatch.setattr(families, "quick_flanks", lambda *given: "quick")
    monkeypatch.setattr(families, "quick_values", lambda *given: (np.zeros((1, 9)), np.array([10.0]), np.ones(1)))
    monkeypatch.setattr(families, "deepest_valleys", valleys)
    for least[0], widest, value, ends in (
        (4.5, 8.0, 5.5, {}), (2.0, 2.0, 8.0, {}), (2.01, 2.0, 8.0, {}), (100.0, 8.0, 2.0, {"driver_tip": True})
    ):  # fmt: skip
        boxes.clear()
        found = best_of_family(Trials([10.0]), "lead", box(1.0), "force")
        assert (found.value, found.at_ends, found.grid.reach["driver_tip"][1]) == (value, ends, widest)
    assert boxes == [1.0, 2.0, 4.0, 8.0]
