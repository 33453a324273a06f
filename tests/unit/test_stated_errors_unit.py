"""No stated error is below what another processor gives."""

from dataclasses import replace

import numpy as np
import pytest

from fegear.case.accuracy import AccuracyPart
from fegear.engine.inexact import is_inexact
from fegear.engine.least_errors import ROUND_OFF
from fegear.engine.outcome import Outcome
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.gear.stiffness import tolerance_remarks


def value(name, si, error, unit="um"):
    return Value(name, si, unit, error)


def test_an_error_below_the_digits_of_a_value_is_raised():
    (found,) = Outcome(values=(value("efficiency", 0.99, 2.1e-18, ""),)).values
    assert found.si_error == pytest.approx(ROUND_OFF * 0.99, rel=1e-6, abs=0.0)


def test_a_difference_of_larger_numbers_has_their_digits():
    """Peak to peak of a mean fifty times as large: what is subtracted counts, not what is left."""
    mean, swing = Outcome(values=(value("te_mean", 20e-6, 1e-9), value("te_peak_to_peak", 0.4e-6, 1e-20))).values
    assert swing.si_error == pytest.approx(ROUND_OFF * 20e-6, rel=1e-6, abs=0.0)
    assert mean.si_error == 1e-9


def test_what_is_exact_unknown_or_larger_stays():
    given = (value("a", 1.0, 0.0), value("b", 1.0, None), value("c", 1.0, 1e-3), value("d", np.nan, 1e-30))
    assert Outcome(values=given).values[:3] == given[:3]
    assert Outcome(values=given).values[3].si_error == pytest.approx(ROUND_OFF, rel=1e-6, abs=0.0)


def test_units_are_not_mixed_and_pure_numbers_stand_alone():
    found = Outcome(
        values=(value("n", 1e6, None, ""), value("share", 0.5, 1e-12, ""), value("x", 1e3, 1e-20, "N"))
    ).values
    assert found[1].si_error == pytest.approx(0.5 * ROUND_OFF, rel=1e-6, abs=0.0)
    assert found[2].si_error == pytest.approx(1e3 * ROUND_OFF, rel=1e-6, abs=0.0)


def test_a_value_that_is_zero_has_no_share_of_itself():
    """What a designed relief leaves is nothing but digits: its error is judged by what no relief leaves."""
    before, left = value("te_peak_to_peak.none", 20e-6, 4e-10), value("te_peak_to_peak.designed", 4e-20, 4e-10)
    share = value("surface_share", 0.0, 0.0025, "")
    assert Outcome(values=(before, left, share)).remarks == ()


def test_a_value_that_is_meant_to_be_zero_is_judged_by_those_beside_it():
    """0.03 of 20 um are left where tips touch early: no share of itself says whether the design is good."""
    before, left = value("te_peak_to_peak.none", 20e-6, 4e-10), value("te_peak_to_peak.designed", 3e-8, 8e-8)
    assert len(Outcome(values=(before, left)).remarks) == 1
    assert Outcome(values=(before, replace(left, zero=True))).remarks == ()
    assert len(Outcome(values=(before, replace(left, zero=True, si_error=5e-6))).remarks) == 1
    assert is_inexact(left, 1e-2)
    assert not is_inexact(replace(left, zero=True), 1e-2)


def test_the_error_of_a_choice_among_equally_good_ones_is_no_inaccuracy():
    amount = value("linear_tip_amount", 11.6e-6, 4e-6)
    assert is_inexact(amount, 1e-2)
    assert len(Outcome(values=(amount,)).remarks) == 1
    assert not is_inexact(replace(amount, choice=True), 1e-2)
    assert Outcome(values=(replace(amount, choice=True),)).remarks == ()


def test_a_large_error_of_a_value_beside_larger_ones_is_noted():
    swing, dead, small = value("swing", 1e-6, 0.3e-6), value("dead", 1e-15, 5e-6), value("small", 1e-9, 1e-9)
    (said,) = Outcome(values=(value("mean", 20e-6, 1e-9), swing, dead, small), sharper_by="increase n").remarks
    assert said == (
        "swing (1.00 +- 0.30 um), dead (0.0 +- 5.0 um), small (0.0010 +- 0.0010 um): estimated error above 20 % of "
        "the value; increase n."
    )


def test_columns_of_errors_count_the_largest_of_their_unit():
    x, stress = np.linspace(0.0, 1.0, 4), np.array([0.0, 1e8, 2.4e8, 0.0])
    columns = (
        Column("x", x, "mm"),
        Column("stress", stress, "MPa"),
        Column("stress_error", np.array([0.0, 1e5, 1e-2, np.nan]), "MPa", "estimated error of stress"),
    )
    (table,) = Outcome(tables=(Table("root", columns),)).tables
    least = ROUND_OFF * 2.4e8
    np.testing.assert_allclose(table.column("stress_error").si, [least, 1e5, least, np.nan])
    assert table.column("stress") is columns[1]


@pytest.mark.parametrize("errors", [[0.0, 0.0], [np.nan, np.nan], [1.0, 2.0]])
def test_exact_unknown_and_large_columns_stay(errors):
    columns = (Column("a", np.array([1.0, 3.0]), "N"), Column("a_error", np.array(errors), "N"))
    table = Table("t", columns)
    assert Outcome(tables=(table,)).tables[0] is table


@pytest.mark.parametrize("last_bits", [0.0, 3e-16, 1e-12])
def test_of_equal_errors_the_first_place_is_named_whatever_the_last_bits_say(last_bits):
    relative, radius = np.array([0.06, 0.06 + last_bits, 0.01]), np.array([19e-3, 20e-3, 21e-3])
    (said,) = tolerance_remarks("Gear a", "c_self", relative, radius, 0.02, "radii")
    assert "up to 6.0 % (tolerance 2 %) at radius 19 mm; within tolerance at 33 % of the radii" in said


def test_values_whose_error_exceeds_a_fifth_of_them_are_noted_once_with_a_key_that_exists():
    given = (value("exact", 7.0, 1.39, "N"), value("a", 7.0, 1.41, "N"), value("b", -1e-3, 1.0, "N"))
    outcome = Outcome(values=given, remarks=("Another.",))
    said = "a (7.0 +- 1.4 N), b (0.0 +- 1.0 N): estimated error above 20 % of the value; reduce accuracy.tolerance."
    assert outcome.remarks == ("Another.", said)
    assert replace(outcome).remarks == outcome.remarks
    assert "tolerance" in AccuracyPart.model_fields


def test_the_note_on_rough_values_names_three_of_them_and_the_remedy_of_the_result():
    given = tuple(value(f"v{i}", 1.0, 0.5, "") for i in range(5))
    (note,) = Outcome(values=given, sharper_by="increase planetary.P.harmonics").remarks
    assert note.startswith("v0 (1.00 +- 0.50), v1 (1.00 +- 0.50), v2 (1.00 +- 0.50) and 2 more: ")
    assert note.endswith("; increase planetary.P.harmonics.")


@pytest.mark.parametrize("error", [None, 0.0, np.nan, 1e-10])
def test_errors_that_are_unknown_or_digits_of_what_stands_beside_them_are_not_noted(error):
    assert Outcome(values=(value("a", 0.0, error), value("b", 1e-2, 1e-9))).remarks == ()
