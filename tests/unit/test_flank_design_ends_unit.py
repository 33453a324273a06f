"""Ends of the box in which modifications are searched: which lie there, how it is widened, what a note says."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.flanks.families import FamilyBest
from fegear.design.flanks.forms import GroundRelief
from fegear.design.flanks.grid import ReliefGrid, usual_grid
from fegear.results.relief.flank_design_ends import end_notes

DEPTH, PATH, FACE = 10e-6, 12e-3, 20e-3
USUAL = usual_grid(DEPTH, PATH, FACE, 9e-3)
GIVEN = ReliefGrid((5e-6, 9e-6), (3e-3, 12e-3), (2e-6,), (), (), (-3e-6, 3e-6), ())
PAIR = SimpleNamespace(path_length=PATH, face_width=FACE)


def numbers(**given):
    return GroundRelief(**given).numbers


def test_what_is_not_ground_lies_at_no_end():
    assert USUAL.at_ends("profile-lead-and-bias", np.zeros(9)) == {}
    tips = numbers(driver_tip=0.0, driver_tip_length=PATH, driven_tip=12e-6, driven_tip_length=5e-3)
    assert USUAL.at_ends("profile", tips) == {"driven_tip": True}
    assert USUAL.at_ends("lead", numbers(slope=-1e-6, crowning=1e-6)) == {"slope": False}


def test_the_box_is_widened_past_the_ends_at_which_something_lies_and_nowhere_else():
    family, at = "profile-and-lead", numbers(driven_tip=12e-6, driven_tip_length=PATH, slope=-1e-6)
    wide = USUAL.widened(family, at)
    (low, high), (wide_low, wide_high) = USUAL.limits(family), wide.limits(family)
    assert wide_high[2] == pytest.approx(2.0 * high[2])
    assert wide_low[7] == pytest.approx(low[7] - (high[7] - low[7]))
    same = [k for k in range(9) if k not in (2, 7)]  # a length ends with the path
    np.testing.assert_array_equal(wide_low[same], low[same])
    np.testing.assert_array_equal(wide_high[[*same, 7]], high[[*same, 7]])
    assert wide.widened(family, at).limits(family)[1][2] == wide_high[2]  # no longer at an end
    assert (wide.combinations(family) == USUAL.combinations(family)).all()  # the grid that is tried stays


def test_lengths_of_end_relief_end_with_half_the_face_and_given_ranges_stay():
    long = USUAL.widened("lead", numbers(end_relief=2e-6, end_relief_length=0.35 * FACE))
    assert long.limits("lead")[1][6] == pytest.approx(0.5 * FACE)
    again = long.widened("lead", numbers(end_relief=2e-6, end_relief_length=0.5 * FACE))
    assert again is long
    assert GIVEN.widened("profile", numbers(driver_tip=9e-6, driver_tip_length=3e-3)) is GIVEN


def test_notes_say_what_a_better_design_needs_or_that_there_is_none():
    relief = GroundRelief(driver_tip=9e-6, driver_tip_length=12e-3, slope=-3e-6)
    ends = GIVEN.at_ends("profile-and-lead", relief.numbers)
    best = FamilyBest("profile-and-lead", relief, relief, 1e-6, (), GIVEN, 1, 1, 1e-6, 0.0, True, ends)
    said = list(end_notes("Pair I, profile-and-lead", best, PAIR, {"driver": "pinion", "driven": "wheel"}))
    assert len(said) == 2
    assert said[0] == (
        "Pair I, profile-and-lead: tip relief of pinion (9 µm, maximum), helix slope modification (-3 µm, minimum) "
        "at the end of the range searched; a better design may lie beyond it. Set flank_design.grid with a wider range "
        "of tip_amounts, slopes."
    )
    assert said[1] == (
        "Pair I, profile-and-lead: length of the tip relief of pinion (12 mm, whole path of contact) at the geometric "
        "limit; a better design would need more."
    )
    assert {note.kind.words for note in said} == {"information"}
