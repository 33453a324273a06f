"""A pair with a width under loads that are asked for later: what was solved before is taken, the rest is solved."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.wide.loaded_pair import LoadedWidePair, no_less_than_usual


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
