"""Descents to the least of a valley: of straight transmission errors the optimum of a linear programme, written out.

With two misalignments and two loads the value is the larger over loads of a mean of peak-to-peaks; the programme here
counts every pair of roll positions by itself.
"""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import linprog

from fegear.design.flanks.scatter import Scatter
from fegear.design.flanks.search import _Straight, descend

LOW = np.array([0.0, 2e-3, 0.0, 1e-3, 0.0, 0.0, -3e-6, 0.0, 0.0])
HIGH = np.array([9e-6, 6e-3, 9e-6, 5e-3, 0.0, 0.0, 3e-6, 0.0, 7e-6])
SCALE = np.maximum(HIGH, 1e-6)
FREE = np.flatnonzero(HIGH > LOW)


class Straight:
    """Transmission errors that are straight in the numbers, or bent a little, and a load over the face that is."""

    scatter, proportion = Scatter(np.zeros(2), np.array([0.3, 0.7])), np.array([1.0, 0.6])

    def __init__(self, bent=0.0):
        chance = np.random.default_rng(11)
        self.base, self.slope = chance.normal(size=(2, 7, 2)) * 1e-6, chance.normal(size=(2, 9, 7, 2)) * 1e-6
        self.over, self.over_slope = 1.2 + 0.1 * chance.random((2, 4, 2)), 0.2 * chance.normal(size=(2, 9, 4, 2))
        self.bent, self.asked, self.steps = bent, [], []

    def of_numbers(self, numbers, slope=False, near=None, step=None):
        assert (numbers >= LOW).all()
        assert (numbers <= HIGH).all()
        if near is not None:  # a step from what was taken before
            assert step == pytest.approx(numbers - near.numbers, abs=1e-15)
            self.steps.append(step)
        assert slope or near is None
        u = numbers / SCALE
        self.asked.append(numbers)
        square = self.bent * np.sum((u - 0.4) ** 2) * np.cos(np.arange(7))[None, :, None]
        grown = 2.0 * self.bent * np.multiply.outer((u - 0.4), np.cos(np.arange(7)))[None, :, :, None]
        te = self.base + np.einsum("skpl,k->spl", self.slope, u) + 1e-6 * square
        over = self.over + np.einsum("skcl,k->scl", self.over_slope, u)
        by = (self.slope + 1e-6 * grown) / SCALE[None, :, None, None]
        return SimpleNamespace(
            numbers=numbers,
            te=te,
            slope=by,
            peak_to_peak=np.ptp(te, axis=1),
            over_face=over,
            face_load_factor=over.max(axis=1),
            over_face_slope=self.over_slope / SCALE[None, :, None, None],
        )

    def value(self, peak_to_peak):
        return float((self.scatter.weights @ peak_to_peak * self.proportion).max())

    def least(self, most_factor=np.inf):
        """The optimum: unknowns are the numbers over their scales, a peak-to-peak of each case, and the value."""
        rows, bounds = [], []
        for s, load in product(range(2), range(2)):
            for p, q in product(range(7), range(7)):
                row = np.zeros(14)
                row[:9], row[9 + 2 * s + load] = self.slope[s, :, p, load] - self.slope[s, :, q, load], -1e-6
                rows.append(row * 1e6)
                bounds.append((self.base[s, q, load] - self.base[s, p, load]) * 1e6)
            for c in range(4):
                if np.isfinite(most_factor):
                    rows.append(np.append(self.over_slope[s, :, c, load], np.zeros(5)))
                    bounds.append(most_factor - self.over[s, c, load])
        for load in range(2):
            row = np.zeros(14)
            row[[9 + load, 11 + load, 13]] = *(np.array([0.3, 0.7]) * self.proportion[load]), -1.0
            rows.append(row)
            bounds.append(0.0)
        box = [*zip(LOW / SCALE, HIGH / SCALE, strict=True), *[(None, None)] * 5]
        found = linprog(np.eye(14)[13], A_ub=rows, b_ub=bounds, bounds=box)
        return found.fun * 1e-6, found.x[:9] * SCALE


def start():
    return 0.5 * (LOW + HIGH)


def test_a_straight_valley_s_floor_is_the_optimum_of_the_whole_programme():
    trials = Straight()
    at = start()
    value, found = descend(trials, at, trials.value(trials.of_numbers(at).peak_to_peak), (LOW, HIGH))
    least, numbers = trials.least()
    assert value == pytest.approx(least, rel=1e-9)
    assert found[FREE] == pytest.approx(numbers[FREE], rel=1e-6, abs=1e-12)
    assert trials.value(trials.of_numbers(found).peak_to_peak) == pytest.approx(value, rel=1e-12)
    # The region of trust is a tenth of the box at first, and 1.6 times as large after every step as promised.
    for k, step in enumerate(trials.steps):
        size = np.abs(step[FREE] / (HIGH - LOW)[FREE]).max()
        assert size <= 0.1 * 1.6**k * (1.0 + 1e-12)
        assert size == pytest.approx(0.1 * 1.6**k) or k == len(trials.steps) - 1
    assert len(trials.steps) <= 5


@pytest.mark.parametrize("share", [0.3, 0.7])
def test_a_limit_of_the_load_over_the_face_is_a_bound_of_the_programme(share):
    trials = Straight()
    free, numbers = trials.least()
    many = np.random.default_rng(3).uniform(LOW, HIGH, (300, 9))
    factors = np.array([trials.of_numbers(one).face_load_factor.max() for one in many])
    there = trials.of_numbers(numbers).face_load_factor.max()
    limit = there - share * (there - factors.min())
    bound, _ = trials.least(limit)
    assert bound > 1.001 * free  # it tells
    at = many[np.argmin(factors)]
    value, found = descend(trials, at, trials.value(trials.of_numbers(at).peak_to_peak), (LOW, HIGH), limit)
    assert value == pytest.approx(bound, rel=1e-6)
    assert trials.of_numbers(found).face_load_factor.max() <= limit * (1.0 + 1e-9)


@pytest.mark.parametrize(("bent", "steps"), [(0.4, 6), (2.0, 60)])
def test_a_bent_valley_s_floor_is_lower_than_all_about_it(bent, steps):
    trials = Straight(bent)
    at = start()
    first = trials.value(trials.of_numbers(at).peak_to_peak)
    value, found = descend(trials, at, first, (LOW, HIGH), ended=1e-9)
    assert value < first
    assert len(trials.steps) <= steps
    chance = np.random.default_rng(5)
    for size in (1e-4, 1e-2):
        for _ in range(100):
            beside = np.clip(found + size * chance.normal(size=9) * (HIGH - LOW), LOW, HIGH)
            assert trials.value(trials.of_numbers(beside).peak_to_peak) >= value * (1.0 - 1e-7)


def test_without_a_free_number_or_anything_left_the_start_stays():
    trials = Straight()
    at = start()
    fixed = descend(trials, at, 3e-6, (at, at))
    assert fixed[0] == 3e-6
    assert fixed[1] is at
    assert descend(trials, at, 0.0, (LOW, HIGH)) == (0.0, at)
    assert trials.asked == []


def test_a_length_without_an_amount_starts_in_the_middle_of_its_box():
    trials = Straight()
    at = start()
    at[1] = 0.0  # a length whose box begins above zero
    descend(trials, at, 9e-6, (LOW, HIGH))
    assert trials.asked[0][1] == pytest.approx(4e-3)
    assert trials.asked[0][[0, 2, 3]] == pytest.approx(at[[0, 2, 3]])


@pytest.mark.parametrize("limit", [None, 1.4])
def test_a_step_that_bends_away_is_made_again_through_what_it_has_found(limit):
    trials = Straight(bent=2.0)
    at = start()
    here = _Straight.of(trials, trials.of_numbers(at), FREE, limit)
    step = 0.1 * (HIGH - LOW)[FREE] * np.array([1.0, -1.0, 0.5, 0.2, -0.4, 0.8])
    ahead = at.copy()
    ahead[FREE] += step
    found = trials.of_numbers(ahead)
    again = here.corrected(found, step)
    reached = again.te + np.einsum("skpl,k->spl", here.tried.slope[:, FREE], step)
    assert reached == pytest.approx(found.te, abs=1e-18)
    assert again.tried is here.tried
    assert again.limit == limit
    assert (again.over_face is None) == (limit is None)
    if limit:
        over = again.over_face + np.einsum("skcl,k->scl", here.tried.over_face_slope[:, FREE], step)
        assert over == pytest.approx(found.over_face, abs=1e-12)
