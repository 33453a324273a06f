"""Valleys of what ground reliefs leave: starts that lie apart, leaps beside a relief, the deepest of several."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.flanks import valleys
from fegear.design.flanks.scatter import NOMINAL
from fegear.design.flanks.search import descend
from fegear.design.flanks.valleys import deepest_valleys, leaps

LOW = np.array([0.0, 1e-3, 0.0, 1e-3, 0.0, 0.0, 0.0, 0.0, -4e-6])
HIGH = np.array([40e-6, 9e-3, 40e-6, 9e-3, 8e-6, 0.0, 0.0, 0.0, 4e-6])
BOX = LOW, HIGH


def relief(first=10e-6, length=4e-3, crowning=2e-6, bias=0.0):
    return np.array([first, length, 20e-6, 5e-3, crowning, 0.0, 0.0, 0.0, bias])


class Trials:
    """A pair whose transmission error at one of three positions is a function of its tip reliefs.

    Along a curved valley, on which amount times root of length is constant, it has several places of least.
    """

    scatter, proportion = NOMINAL, np.ones(1)

    def __init__(self, factor=lambda numbers: 1.0):
        self.factor, self.tried = factor, 0

    def left(self, numbers):
        """The deepest place is at 24 um; others are at 24 um times or over powers of exp(2 pi/20)."""
        across = np.log(numbers[0] / 24e-6) + 0.5 * np.log(numbers[1] / 3e-3)
        along = np.log(numbers[0] / 24e-6) - 0.5 * np.log(numbers[1] / 3e-3)
        other = (numbers[2] / 20e-6 - 1.0) ** 2 + (numbers[3] / 5e-3 - 1.0) ** 2
        return 1e-6 * (2.3 + 8.0 * across**2 - 0.3 * np.cos(10.0 * along) + 0.5 * along**2 + 20.0 * other)

    def of_numbers(self, numbers, slope=False, near=None, step=None):
        self.tried += 1
        value = self.left(numbers)
        te = np.array([value, 0.0, 0.0]).reshape(1, 3, 1)
        slopes = np.zeros((1, 9, 3, 1))
        for k in range(4):
            step = np.zeros(9)
            step[k] = 1e-6 * numbers[k]
            slopes[0, k, 0, 0] = (self.left(numbers + step) - self.left(numbers - step)) / (2.0 * step[k])
        return SimpleNamespace(
            te=te, slope=slopes, peak_to_peak=np.ptp(te, axis=1),
            face_load_factor=np.array([self.factor(numbers)]), over_face=np.full((1, 2, 1), self.factor(numbers)),
            over_face_slope=np.zeros((1, 9, 2, 1)),
        )  # fmt: skip

    def value(self, peak_to_peak):
        return float(peak_to_peak.max())


def test_starts_lie_apart_the_best_first_and_only_some_lead_on(monkeypatch):
    starts = [relief(), relief(first=10.5e-6), relief(first=30e-6), relief(bias=3e-6), relief(first=10e-6, length=9e-3)]
    begun = []

    def stays(trials, at, value, *box):
        begun.append(at)
        return value, at

    monkeypatch.setattr(valleys, "descend", stays)
    monkeypatch.setattr(valleys, "_ROUNDS", 0)
    values = [Trials().left(one) for one in starts]
    assert values[1] < values[0]  # and they are near to each other
    found = deepest_valleys(Trials(), Trials(), starts, BOX)
    order = sorted((1, 2, 3, 4), key=lambda k: values[k])
    assert [one.tolist() for one in begun[:-1]] == [starts[k].tolist() for k in order]
    assert [value for value, _ in found] == [values[k] for k in order[:3]]
    # What the family may not choose keeps none apart.
    other, begun[:] = relief(), []
    other[7] = 1.0
    deepest_valleys(Trials(), Trials(), [relief(), other], BOX)
    assert len(begun) == 2
    begun.clear()
    monkeypatch.setattr(valleys, "_DESCENTS", 2)
    deepest_valleys(Trials(), Trials(), starts, BOX)
    assert len(begun) == 3


def test_leaps_change_tips_along_and_across_their_valleys_and_each_other_number_to_either_side():
    tips, traded, others = leaps(relief(), BOX)
    assert (len(tips), len(traded), len(others)) == (16, 4, 4)
    assert all((one >= LOW).all() and (one <= HIGH).all() for one in (*tips, *traded, *others))
    assert [one[1] + one[3] for one in traded] == pytest.approx([9e-3] * 4)
    assert [one[1] for one in traded] == pytest.approx([3.2e-3, 3.6e-3, 4.4e-3, 4.8e-3])
    assert all((np.delete(one, [1, 3]) == np.delete(relief(), [1, 3])).all() for one in traded)
    assert not any(np.allclose(one[:4], relief()[:4]) for one in tips)
    larger = next(one for one in tips if one[0] > 10e-6 and one[1] < 4e-3 and one[2] == 20e-6)
    assert larger[:2] == pytest.approx([14e-6, 4e-3 * 1.4**-0.4])
    assert [one[4] for one in others if one[4] != 2e-6] == pytest.approx([0.8e-6, 3.2e-6])
    assert [one[8] for one in others if one[8] != 0.0] == pytest.approx([-1.2e-6, 1.2e-6])
    lead = np.where(np.arange(9) < 4, 0.0, LOW), np.where(np.arange(9) < 4, 0.0, HIGH)
    assert [len(some) for some in leaps(np.zeros(9), lead)] == [0, 0, 4]


def test_leaps_lead_from_a_descent_s_end_to_the_deepest_valley():
    start = relief(first=16e-6, length=6e-3)
    trials = Trials()
    alone, _ = descend(trials, start, trials.left(start), BOX)
    assert alone > 2.15e-6
    value, at = deepest_valleys(trials, Trials(), [start], BOX)[0]
    assert value == pytest.approx(2e-6, rel=1e-3)
    assert at[:2] == pytest.approx([24e-6, 3e-3], rel=0.02)


@pytest.mark.dear
def test_the_best_come_first_and_no_more_than_three():
    places = (8e-6, 8e-3), (24e-6, 3.1e-3), (38e-6, 1.2e-3), (14e-6, 8e-3)
    starts = [relief(amount, length) for amount, length in places]
    found = deepest_valleys(Trials(), Trials(), starts, BOX)
    values = [value for value, _ in found]
    assert len(found) == 3
    assert values == sorted(values)
    assert values[0] == pytest.approx(2e-6, rel=1e-5)


def test_from_every_floor_goes_a_descent_however_near_to_another_it_is(monkeypatch):
    begun = []
    monkeypatch.setattr(valleys, "descend", lambda trials, at, value, *box: begun.append(at[0]) or (value, at))
    monkeypatch.setattr(valleys, "_ROUNDS", 0)
    limited = Trials(lambda numbers: 1.0 if numbers[0] < 12e-6 else 2.0)
    floors = [relief(first=amount) for amount in (10e-6, 10.1e-6, 20e-6)]
    found = deepest_valleys(Trials(), limited, [relief(first=10.05e-6)], BOX, 1.5, floors)
    assert begun[:-1] == [10e-6, 10.1e-6, 10.05e-6]
    assert len(found) == 3
    assert deepest_valleys(Trials(), limited, [], BOX, 1.5, floors[2:]) == []


def test_starts_and_leaps_that_do_not_keep_to_the_limit_lead_nowhere():
    limited = Trials(lambda numbers: 1.0 if numbers[0] < 12e-6 else 2.0)
    found = deepest_valleys(Trials(), limited, [relief(first=20e-6), relief(first=8e-6, length=8e-3)], BOX, 1.5)
    assert found
    assert all(at[0] < 12e-6 for _, at in found)
    assert deepest_valleys(Trials(), limited, [relief(first=20e-6)], BOX, 1.5) == []
