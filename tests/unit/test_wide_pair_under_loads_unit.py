"""A pair with a width under loads that are asked for later: what was solved before is taken, the rest is solved."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane.tooth_stress import LargestBetween, ToothStress
from fegear.contact.wide.largest_root_stress import _largest_between, no_less_than_usual
from fegear.contact.wide.loaded_pair import LoadedWidePair


def test_only_the_nominal_load_alone_was_solved_before():
    solved = []

    def solve(loads, gaps, known):
        solved.append((loads.tolist(), gaps, known))
        return SimpleNamespace(lines="lines", load=loads, transmission_error=np.outer([5.0, 6.0], loads))

    found = SimpleNamespace(
        lines=SimpleNamespace(roll=np.array([0.1, 0.2])), load=np.array([500.0, 900.0]),
        transmission_error=np.array([[1.0, 2.0], [3.0, 4.0]]),
    )  # fmt: skip
    fresh = SimpleNamespace(roll="roll")
    pair = SimpleNamespace(
        found=found, gaps="gaps", known="known", at=1, nominal=900.0,
        flanks=SimpleNamespace(solve=lambda *given: SimpleNamespace(**{**vars(solve(*given)), "lines": fresh})),
    )  # fmt: skip
    roll, load, te = LoadedWidePair.error_under(pair, [900.0], 3)
    assert (roll.tolist(), load.tolist(), te.tolist(), solved) == ([0.1, 0.2], [900.0], [[2.0], [4.0]], [])
    roll, load, te = LoadedWidePair.error_under(pair, 900.0, 3)
    assert (te.tolist(), solved) == ([[2.0], [4.0]], [])
    roll, load, te = LoadedWidePair.error_under(pair, [450.0], 3)
    assert (roll, load.tolist(), te.tolist()) == ("roll", [450.0], [[2250.0], [2700.0]])
    assert solved == [([450.0], "gaps", "known")]
    LoadedWidePair.error_under(pair, [900.0, 450.0], 3)
    assert solved[1][0] == [900.0, 450.0]


def test_no_position_of_a_tooth_errs_by_less_than_a_part_of_what_all_do():
    """On a tooth that only a neighbour's load stresses both solutions agreed: 1.7 times the stated error was true."""
    even = np.full(8, 3.0)
    assert no_less_than_usual(even).tolist() == even.tolist()
    error = np.array([0.0, 0.1, 5.0, 12.0])
    least = 0.25 * np.sqrt(np.mean(error**2))
    assert no_less_than_usual(error) == pytest.approx([least, least, 5.0, 12.0])
    assert no_less_than_usual(7.0 * error) == pytest.approx(7.0 * no_less_than_usual(error))
    assert no_less_than_usual(np.zeros(3)).tolist() == [0.0, 0.0, 0.0]


def test_what_gears_and_positions_leave_of_the_largest_root_stress_knows_nothing_of_each_other(monkeypatch):
    """Three positions of one tooth under two loads, of which positions leave 0.3 and 0.4, 0.8 and 0.6 MPa."""
    left = {1.0: np.array([0.3, 0.4]), -1.0: np.array([0.8, 0.6])}
    stress = {"tension": np.array([[5.0, 7.0], [9.0, 8.0], [4.0, 11.0]]), "compression": -np.arange(6.0).reshape(3, 2)}

    def left_of_largest(values, position, count):
        assert (position.tolist(), count) == ([0, 1, 2], 48)
        if (values == -stress["tension"]).all():
            return np.array([0.03, 0.05])
        return left[1.0 if (values == stress["tension"]).all() else -1.0]

    def felt(side, force, _z):
        case = int(force[0, 0])
        return SimpleNamespace(largest=lambda _sign: (stress[side][:, case], np.array([0.1, 0.2, 0.3]), None))

    monkeypatch.setattr("fegear.contact.wide.load_factors.left_of_largest", left_of_largest)
    many = SimpleNamespace(
        load=np.array([1.0, 2.0]), contact=SimpleNamespace(force=np.arange(2.0) * np.ones((1, 1, 2))),
        lines=SimpleNamespace(roll=np.zeros(48)),
    )  # fmt: skip
    rooted = SimpleNamespace(x=np.array([1.0, 2.0, 3.0]), teeth=np.array([[0, 0], [1, 0], [2, 0]]), stress=felt)
    pair = SimpleNamespace(over=SimpleNamespace(found=many), places_along="z", rooted=lambda *_asked: rooted)
    off = {"tension": [0.4, 0.3], "compression": [0.6, 0.8]}
    found = _largest_between(pair, "driver", "solution", off)
    assert (found.tension.tolist(), found.tension_x.tolist(), found.tension_z.tolist()) == (
        [9.0, 11.0],
        [2.0, 3.0],
        [0.2, 0.3],
    )
    assert found.compression.tolist() == [-4.0, -5.0]
    assert found.tension_error == pytest.approx([0.5, 0.5])
    assert found.compression_error == pytest.approx([1.0, 1.0])
    assert (found.least_tension.tolist(), found.least_left.tolist()) == ([4.0, 7.0], [0.03, 0.05])


def test_the_least_tension_of_a_range_is_looked_for_at_as_many_positions_as_the_largest():
    """The table's 16 positions missed 8 of 37 MPa of it: the range of a helical pair was 1.5 times its error off."""
    two = np.array([2.0, 3.0])
    between = LargestBetween(
        np.array([9.0, 11.0]),
        -two,
        two,
        two,
        two,
        np.array([0.5, 0.6]),
        two,
        np.array([1.0, 2.5]),
        np.array([0.3, 0.4]),
    )
    table = np.array([[1.5, 3.0], [8.0, 10.0]])
    error = np.array([[0.4, 0.3], [0.9, 0.8]])
    found = ToothStress(np.array([0.0, 1.0]), table, None, error, None, between)
    assert found.tension_range.tolist() == [8.0, 8.5]
    assert [found.range_off(i) for i in (0, 1)] == pytest.approx([0.5 + 0.5, 0.6 + 0.5])
    alone = replace(found, between=None)
    assert alone.tension_range.tolist() == [6.5, 7.0]
    assert [alone.range_off(i) for i in (0, 1)] == pytest.approx([0.9 + 0.4, 0.8 + 0.3])
