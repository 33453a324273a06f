"""True errors of random gears, rings and pairs beside those that a tolerance states of them.

The truth has finer edges, narrower pressures and another growth of its edges (`helpers/true_errors.py`).
"""

import numpy as np
import pytest
from true_errors import TOLERANCES, both_answers, judged, possible, true_answers

#: Times the stated error that a true one may be.
BEYOND = 1.5
#: Columns and single values whose estimated errors are judged over cases.
FEW = {"gear": 3, "ring": 2, "pair": 2, "internal pair": 1}


def found(kind, seed, count):
    """Quantities judged, by tolerance."""
    every = {tolerance: [] for tolerance in TOLERANCES}
    for case in possible(kind, count, seed):
        truth = true_answers(kind, case)
        for tolerance in TOLERANCES:
            found, elements = both_answers(case, {"tolerance": tolerance})
            every[tolerance] += judged(found, truth, elements)
    return every


def covered(every):
    """No true error is beyond 1.5 times the stated one."""
    for tolerance, quantities in every.items():
        beyond = [(tolerance, one.what, one.name, one.worst) for one in quantities if one.worst > BEYOND]
        assert not beyond


@pytest.mark.dear
@pytest.mark.parametrize("kind", FEW)
def test_stated_errors_cover_the_true_ones(kind):
    """Loads were 31 to 558 times, root stresses 7 to 89 times the stated errors off, at up to 14 % of the places."""
    covered(found(kind, 1, FEW[kind]))


@pytest.mark.long
@pytest.mark.parametrize("kind", FEW)
def test_stated_errors_of_twenty_cases_cover_the_true_ones_and_are_not_far_above(kind):
    """Medians of neighbours' compliances were stated 17 to 30 times too large at 1e-2, of c_self 8 to 50."""
    every = found(kind, 20261128, 20)
    covered(every)
    for tolerance, quantities in every.items():
        by = {}
        for one in quantities:
            if not one.what.startswith("value") and np.isfinite(one.generous_rms):
                by.setdefault(one.what, []).append(one.generous_rms)
        generous = {what: float(np.median(several)) for what, several in by.items()}
        assert all(median <= 5.0 for median in generous.values()), (tolerance, generous)
