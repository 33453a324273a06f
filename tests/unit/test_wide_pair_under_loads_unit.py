"""A pair with a width under loads that are asked for later: what was solved before is taken, the rest is solved."""

from types import SimpleNamespace

import numpy as np

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
