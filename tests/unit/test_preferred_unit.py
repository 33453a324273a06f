"""Which design is to be ground where tolerances take part of the gain, and by how much finer ones pay."""

import numpy as np
import pytest

from fegear.design.flanks.flank_tolerance import FlankTolerance, LeadTolerance
from fegear.design.preferred import classes_finer, preferred
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.formulas.iso1328 import flank_tolerances

DRAWN = {"a": 2.4, "b": 2.5, "c": 3.0}


@pytest.mark.parametrize(
    ("within", "order"),
    [
        ({"a": 4.5, "b": 3.7, "c": 3.6}, ["c", "a", "b"]),  # the least of those that are clearly less
        ({"a": 4.5, "b": 4.4, "c": 4.3}, ["a", "b", "c"]),  # by less than 5 %: as drawn
        ({"a": 4.5, "b": 3.7, "c": 9.0}, ["b", "a", "c"]),
        ({}, ["a", "b", "c"]),
    ],
)
def test_the_worst_within_tolerances_decides_where_it_is_clearly_less(within, order):
    assert preferred(DRAWN, within) == order


def test_of_no_designs_there_is_no_order():
    assert preferred({}, {}) == []


@pytest.mark.parametrize("needed", [0.0, 0.9, 1.0, 2.0, 3.9, 6.1, 8.0, 9.0])
def test_as_many_classes_as_are_needed_are_found_by_halving(needed):
    """What is left falls by a factor of 1.1 from class to class, and has to fall by so many classes at one load."""
    none, asked = np.array([5.0, 3.0]), []

    def finer(classes):
        asked.append(classes)
        return np.array([4.0, 3.0 * 1.1 ** (needed - classes)]) * (1.0 - 1e-12)

    expected = int(np.ceil(needed)) if needed <= 8.0 else None
    assert classes_finer(finer(0), none, finer, 8) == expected
    assert len(asked) <= 5
    assert classes_finer(np.array([6.0, 1.0]), none, finer, 0) is None


def test_a_finer_class_has_finer_amounts_of_all_that_is_ground():
    tip = TipTolerance(6e-6, 0.4e-3, 5e-6, "f_Hα of class 6, assumed", 6)
    assert (tip.finest, TipTolerance(3e-6, None, 0.0).finest) == (5, 8)
    finer = tip.finer(2)
    assert finer.amount == pytest.approx(3e-6)
    assert (finer.length, finer.form, finer.origin, finer.grade) == (0.4e-3, 5e-6, "f_Hα of class 4", 4)
    assert TipTolerance(3e-6, None, 0.0).finer(2).origin == ""
    both = FlankTolerance((tip, TipTolerance(3e-6, None, 0.0)), LeadTolerance(8e-6, 4e-6, 2e-6))
    assert both.finest == 5
    np.testing.assert_allclose(both.finer(2).amounts, 0.5 * both.amounts)
    assert FlankTolerance((tip, tip)).finer(1).lead is None


def test_a_finer_class_is_rounded_from_its_own_tolerance_not_from_the_rounded_one_of_a_coarser_class():
    """22 teeth of 2.25 mm: class 3 of 4.9495 um is 2.4747, rounded 2.5 um; 4.9 um halved is 2.45."""
    allowed = flank_tolerances(5, 49.5e-3, 2.25e-3, 27e-3)
    tip = TipTolerance(allowed.rounded.profile_slope, None, 6e-6, "f_Hα of class 5", 5, allowed.profile_slope)
    assert tip.amount == pytest.approx(4.9e-6)
    lead = LeadTolerance(
        allowed.rounded.helix_slope, 4e-6, tip.amount, (allowed.helix_slope, None, allowed.profile_slope)
    )
    both = FlankTolerance((tip, tip), lead)
    for classes in range(5):
        own = flank_tolerances(5 - classes, 49.5e-3, 2.25e-3, 27e-3).rounded
        finer = both.finer(classes)
        assert finer.tips[0].amount == pytest.approx(own.profile_slope, rel=1e-12)
        assert finer.lead.slope == pytest.approx(own.helix_slope, rel=1e-12)
        assert finer.lead.twist == finer.tips[0].amount
        assert finer.lead.crowning == pytest.approx(4e-6 * 0.5 ** (0.5 * classes))  # as the case gives it
    assert both.finer(1).finer(1) == both.finer(2)
    assert tip.finer(2).amount == pytest.approx(2.5e-6)
