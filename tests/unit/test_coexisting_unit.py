"""Motions that exist beside one that does not repeat, and how long such a one is followed: with motions made up."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import ConvergenceError, RangeError
from fegear.dynamics.motion import coexisting
from fegear.dynamics.motion.coexisting import Window, drifting, follow, growth, recurrences, stable_motions


def orbit(*points, stable=True):
    """A motion whose states after each period are given, the last being where it begins."""
    made = [np.array(point, dtype=float) for point in points]
    return SimpleNamespace(periods=len(made), points=made, state=made[-1], stable=stable, x=made[-1], v=-made[-1])


@pytest.fixture
def points(monkeypatch):
    monkeypatch.setattr(coexisting, "_points", lambda one, step: one.points)


def test_motions_are_one_where_they_meet_in_some_period_and_have_as_many(points):
    two = orbit([1.0, 0.0], [0.0, 2.0])
    assert coexisting._same(two, two, 1e-6)
    assert coexisting._same(two, orbit([0.0, 2.0], [1.0, 0.0]), 1e-6)  # begun a period later
    assert not coexisting._same(two, orbit([0.0, 2.0]), 1e-6)
    assert not coexisting._same(orbit([0.0, 2.0]), two, 1e-6)
    assert not coexisting._same(two, orbit([1.0, 0.0], [0.0, 2.1]), 1e-6)
    assert coexisting._same(two, orbit([1.0, 0.0], [0.0, 2.00009]), 1e-6)
    assert not coexisting._same(two, orbit([1.0, 0.0], [0.0, 2.00011]), 1e-6)


def test_a_motion_that_is_back_before_its_periods_are_over_closes_sooner(points):
    assert not coexisting._closes_sooner(orbit([1.0, 0.0], [0.0, 2.0]), 1e-6)
    assert coexisting._closes_sooner(orbit([1.0, 0.0], [1.0, 5e-5]), 1e-6)
    assert not coexisting._closes_sooner(orbit([1.0, 0.0]), 1e-6)


def test_damping_is_taken_away_in_four_steps_of_a_third_until_the_train_s_own_is_left(points, monkeypatch):
    seen = []

    def close(packed, x, v, multiple, step):
        seen.append((packed, float(x[0]), multiple, step))
        return orbit(*([[10.0 * len(seen) + k] for k in range(multiple)]))

    monkeypatch.setattr(coexisting, "pack", lambda model: model)
    monkeypatch.setattr(coexisting, "close", close)
    model = SimpleNamespace(more_damped=lambda factor: factor)
    found = coexisting._continued(model, 3.0, (np.array([7.0]), np.array([0.0])), 2, 1e-5)
    factors = [one[0] for one in seen]
    assert factors == pytest.approx([3.0, 3.0**0.75, 3.0**0.5, 3.0**0.25, 1.0])
    assert [one[1] for one in seen] == [7.0, 11.0, 21.0, 31.0, 41.0]  # each from the one before
    assert {one[2:] for one in seen} == {(2, 1e-5)}
    assert found.points[-1] == [51.0]
    monkeypatch.setattr(coexisting, "close", lambda *given: orbit([1.0], stable=False))
    assert coexisting._continued(model, 3.0, (np.zeros(1), np.zeros(1)), 1, 1e-5) is None
    monkeypatch.setattr(coexisting, "close", lambda *given: None)
    assert coexisting._continued(model, 3.0, (np.zeros(1), np.zeros(1)), 1, 1e-5) is None

    def refuse(*given):
        raise RangeError("damping", "0", "is none")

    monkeypatch.setattr(coexisting, "close", refuse)
    assert coexisting._continued(model, 3.0, (np.zeros(1), np.zeros(1)), 1, 1e-5) is None


def test_motions_of_one_to_three_periods_are_found_from_two_dampings_each_once(points, monkeypatch):
    asked = []

    def continued(model, factor, state, multiple, step):
        asked.append((factor, multiple))
        return orbit(*([[1.0 * k] for k in range(multiple)])) if multiple != 2 or factor == 9.0 else None

    monkeypatch.setattr(coexisting, "_continued", continued)
    monkeypatch.setattr(coexisting, "_settled", lambda model, step: (np.zeros(1), np.zeros(1)))
    found = stable_motions(SimpleNamespace(more_damped=lambda factor: factor), 1e-5)
    assert asked == [(3.0, 1), (3.0, 2), (3.0, 3), (9.0, 1), (9.0, 2), (9.0, 3)]
    assert [one.periods for one in found] == [1, 3, 2]
    monkeypatch.setattr(coexisting, "_settled", lambda model, step: None)
    assert stable_motions(SimpleNamespace(more_damped=lambda factor: factor), 1e-5) == ()


@pytest.fixture
def moved(monkeypatch):
    """Propagation of a map: x -> x/2 + 1, and v stays; two of the states move."""
    calls = []
    packed = SimpleNamespace(period=0.25, size=3)

    def propagate(of, x, v, duration, *, tolerance, peaks, tangents=False):
        calls.append((duration, tolerance, peaks, tangents))
        return SimpleNamespace(x=0.5 * x + 1.0, v=v, steps=11, tangent=np.diag([3.0, 9.0, 0.5, 1.0]))

    monkeypatch.setattr(coexisting, "propagate", propagate)
    monkeypatch.setattr(coexisting, "pack", lambda model: packed)
    monkeypatch.setattr(coexisting, "starting_state", lambda of, how: (np.zeros(2), np.ones(2)))
    monkeypatch.setattr(coexisting, "moving", lambda of: np.array([True, False, True, False]))
    return SimpleNamespace(calls=calls, packed=packed)


def test_a_more_damped_motion_settles_over_sixty_periods(moved, monkeypatch):
    x, v = coexisting._settled("model", 1e-5)
    assert (x.tolist(), v.tolist()) == ([1.0, 1.0], [1.0, 1.0])
    assert moved.calls == [(60 * 0.25, 1e-5, False, False)]

    def refuse(*given, **how):
        raise ConvergenceError("no end")

    monkeypatch.setattr(coexisting, "propagate", refuse)
    assert coexisting._settled("model", 1e-5) is None


def test_a_window_keeps_what_moves_after_each_period_and_counts_what_it_took(moved):
    spent = []
    found = follow(moved.packed, np.zeros(2), np.ones(2), 3, 1e-5, peaks=True,
                   effort=SimpleNamespace(spend=spent.append))  # fmt: skip
    np.testing.assert_allclose(found.states, [[1.0, 1.0], [1.5, 1.0], [1.75, 1.0]])
    assert (len(found.passages), found.x.tolist(), spent) == (3, [1.75, 1.75], [33, 33, 33])
    assert follow(moved.packed, np.zeros(2), np.ones(2), 2, 1e-5, peaks=False).passages == ()
    assert [call[0] for call in moved.calls] == [0.25] * 5
    assert found.spread == pytest.approx(np.std([1.0, 1.5, 1.75]))
    np.testing.assert_allclose(found.middle, [4.25 / 3.0, 1.0])


def test_growth_is_that_of_the_direction_that_grows_most(moved):
    """Of 3 and 0.5 a period the first; of 300 periods the first fifth only turns the direction."""
    assert growth(moved.packed, np.zeros(2), np.ones(2), 1e-5, 250) == pytest.approx(math.log(3.0), rel=1e-9)
    assert len(moved.calls) == 300
    assert all(call[3] for call in moved.calls)
    assert growth(moved.packed, np.zeros(2), np.ones(2), 1e-5, 5) == pytest.approx(math.log(3.0), rel=0.05)


def window(*states):
    return Window(np.array(states, dtype=float), (), np.zeros(1), np.zeros(1))


def test_a_motion_drifts_while_its_spread_or_its_middle_changes():
    before, after = window([0.0], [2.0]), window([0.0], [2.05])
    assert not drifting(before, after)
    assert drifting(before, window([0.0], [2.2]))
    assert not drifting(before, window([0.0], [2.2]), chaotic=True)
    assert drifting(before, window([0.1], [2.1]))
    assert not drifting(before, window([0.1], [2.1]), chaotic=True)
    assert drifting(before, window([0.6], [2.6]), chaotic=True)
    assert not drifting(window([1.0], [1.0]), window([1.0], [1.0]))


def test_periods_after_which_a_state_comes_again_are_the_near_ones_and_one_and_two():
    states = np.array([[0.0], [0.31], [0.7], [0.02], [0.3], [0.72], [0.0]])
    assert recurrences(states, 10, 0.05) == [1, 2, 3, 6]
    assert recurrences(states, 4, 0.05) == [1, 2, 3]
    assert recurrences(states, 10, 0.0) == [1, 2, 6]
    assert recurrences(np.zeros((30, 1)), 20, 0.1) == [1, 2, 3, 4, 5, 6, 7, 8]
    assert recurrences(states[:2], 10, 0.0) == [1]
