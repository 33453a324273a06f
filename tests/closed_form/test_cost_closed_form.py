"""Pareto front, cheapest configuration and observed order on data whose answer is known."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.studies.cost.quantities import miss
from fegear.studies.cost.result import cheapest, observed_order, pareto_front

number = st.floats(1e-9, 1e3) | st.just(math.nan)
configurations = st.lists(st.tuples(number, number), min_size=1, max_size=40)


@given(configurations)
def test_nothing_beats_the_front_and_the_front_beats_all_else(pairs):
    t, e = np.array(pairs).T
    front = pareto_front(t, e)
    known = np.isfinite(t) & np.isfinite(e)
    assert (front.size == 0) == (not known.any())
    assert (np.diff(t[front]) > 0.0).all()
    assert (np.diff(e[front]) < 0.0).all()
    for i in range(t.size):
        beaten = (t[known] <= t[i]) & (e[known] <= e[i]) & ((t[known] < t[i]) | (e[known] < e[i]))
        if i in front:
            assert not beaten.any()
        elif known[i]:  # beaten, or the twin of one on the front
            assert beaten.any() or any((t[i], e[i]) == (t[j], e[j]) for j in front)


@given(configurations, st.floats(1e-9, 1e3))
def test_the_cheapest_configuration_is_the_first_on_the_front_within_the_tolerance(pairs, tolerance):
    t, e = np.array(pairs).T
    found = cheapest(tolerance, t, e)
    on_front = [i for i in pareto_front(t, e) if e[i] <= tolerance]
    if found is None:
        assert on_front == []
    else:
        assert t[found] == t[on_front[0]]
        assert e[found] <= tolerance


@given(st.floats(0.5, 8.0), st.floats(1e-6, 1e2), st.integers(3, 9))
def test_a_power_law_gives_its_power(p, factor, count):
    h = 2.0 ** -np.arange(count)
    order = observed_order(h, factor * h**p)
    assert order.slope == pytest.approx(p, rel=1e-9)
    assert order.used == count
    assert order.scatter == pytest.approx(1.0, abs=1e-9)
    assert f"{count} of {count} configurations" in order.words


@given(st.floats(1.0, 6.0), st.floats(0.3, 0.9))
def test_coarse_configurations_that_are_not_asymptotic_yet_are_dropped(p, wild):
    h = 2.0 ** -np.arange(8.0)
    error = h**p
    error[:2] *= wild * np.array([1e-3, 30.0])
    order = observed_order(h[::-1], error[::-1])  # in any sequence
    assert order.slope == pytest.approx(p, rel=0.1)
    assert order.used >= 6
    assert order.used < 8


def test_configurations_at_the_floor_say_nothing():
    h = 2.0 ** -np.arange(7.0)
    order = observed_order(h, h**2 + 1e-3, floor=1e-3)
    assert order.used == 5  # 1, 0.25, .. 2^-8 = 4e-3 lie above three floors
    assert 1.6 < order.slope < 2.0
    none = observed_order(h, np.full(7, 1e-3), floor=1e-3)
    assert math.isnan(none.slope)
    assert none.words == "none: only 0 of 7 configurations are above the error of the reference"


@pytest.mark.parametrize(
    ("error", "words"),
    [
        ([1e-2, 1e-2, 1e-2, 1e-2], "none: the error does not decrease with the"),
        ([1e-3, 1e-2, 1e-4, 1e-1], "no 3 adjacent configurations within 1.6 of a line"),
        ([1e-3, 1e-2, math.nan, math.nan], "only 2 of 4"),
        ([0.0, 0.0, 0.0, 0.0], "only 0 of 4"),
    ],
)
def test_no_order_is_reported_where_there_is_none(error, words):
    order = observed_order([1.0, 0.5, 0.25, 0.125], error)
    assert math.isnan(order.slope)
    assert order.words.startswith("none: ")
    assert words in order.words


def test_a_miss_counts_each_position_but_c_1_its_largest():
    reference = np.array([1.0, 2.0, -4.0])
    off = miss("c_0", np.array([1.1, 2.0, -4.2]), reference)
    assert (off.largest, off.answered) == (pytest.approx(0.1), 1.0)
    assert off.rms == pytest.approx(math.sqrt((0.1**2 + 0.05**2) / 3.0))
    assert miss("c_1", np.array([1.1, 2.0, -4.2]), reference).largest == pytest.approx(0.05)
    assert miss("c_1", np.zeros(3), reference).largest == 1.0
    part = miss("root-stress", np.array([math.nan, 2.2, math.nan]), reference)
    assert (part.largest, part.answered) == (pytest.approx(0.1), pytest.approx(1 / 3))
    assert math.isnan(miss("root-stress", np.full(3, math.nan), reference).largest)
