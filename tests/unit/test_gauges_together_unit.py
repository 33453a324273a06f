"""What several gauges say together: one factor is told from one gauge that is off."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.engine.answered import Answered
from fegear.engine.run_answer import joined
from fegear.results.pair.gauge_teeth import TraceZero, teeth_apart
from fegear.results.pair.gauges_together import GaugeGain, common_factor, of_all_gauges


def gauges(*gains, limit=0.04, **more):
    return [
        GaugeGain(f"g{i}", gain, limit, limit, 0.01, abs(gain - 1.0) <= limit, **{"alike": gain > 0.0, **more})
        for i, gain in enumerate(gains)
    ]


def test_gauges_that_agree_have_a_mean_with_its_standard_error():
    said = of_all_gauges(gauges(0.979, 1.017, 0.986, 0.999, 1.002))
    error = np.std([0.979, 1.017, 0.986, 0.999, 1.002], ddof=1) / 5**0.5
    assert said == (
        "All five gauges agree with the computed strain: measured / computed 0.979 to 1.017, mean 0.997 (standard "
        f"error {error:.2g})."
    )


def test_gauges_that_agree_on_one_side_point_at_the_torque():
    one_side = of_all_gauges(gauges(0.968, 0.972, 0.966, 0.975, 0.97))
    assert one_side.endswith("a torque or gauge factor 3.0 % lower is more likely than five displaced grids.")
    assert "more likely" not in of_all_gauges(gauges(0.968, 0.972, 0.966, 1.001, 0.97))
    assert "more likely" not in of_all_gauges(gauges(0.991, 0.992, 0.993, 0.992, 0.991))  # within the load tolerance


@pytest.mark.parametrize("factor", [0.94, 1.09, 3.0])
def test_one_factor_explains_all(factor):
    spread = np.array([0.979, 1.017, 1.0, 0.999, 1.002])
    measured = gauges(*factor * spread)
    assert common_factor(measured) == pytest.approx(factor, rel=2e-3)
    said = of_all_gauges(measured)
    assert said.startswith("One cause explains all five gauges: measured strain is ")
    assert ("lower" if factor < 1.0 else "higher") in said
    assert of_all_gauges(measured[::-1]) == said


def test_a_known_factor_has_its_reason():
    said = of_all_gauges(gauges(0.489, 0.508, 0.493, 0.499, 0.501))
    assert "as of half the torque, or a quarter bridge evaluated as a half bridge; check torque and bridge" in said


def test_one_gauge_that_agrees_agrees():
    said = of_all_gauges(gauges(1.0, 1.3, 0.7, 1.9, 0.5))
    assert said.startswith("One of five gauges agrees with the computed strain; no common factor")


def test_gauges_whose_traces_are_described_otherwise_are_not_to_be_glued_again():
    good, wrong = gauges(1.0, 1.01), replace(gauges(0.3, alike=False)[0], name="w", explained=True)
    assert of_all_gauges([*good, wrong]) == (
        "Two of three gauges agree with the computed strain; the trace of w has a cause: see below."
    )
    said = of_all_gauges([*good, wrong, replace(wrong, name="v")])
    assert said.endswith("; the traces of w and v have causes: see below.")
    said = of_all_gauges([*good, wrong, replace(wrong, name="v"), replace(wrong, name="u", explained=False)])
    assert said.endswith("; the traces of w and v have causes; check u.")


def test_one_gauge_that_is_off_is_named_and_the_torque_is_confirmed():
    said = of_all_gauges(gauges(1.01, 0.99, 1.15, 1.0))
    assert said == (
        "Three of four gauges agree with the computed strain, g2 does not: check its bridge, bond and position before "
        "the torque, which the others confirm."
    )
    both = of_all_gauges(gauges(0.94, 0.93, 0.95, 1.2))  # a common factor, and one gauge beside it
    assert both.startswith("One cause explains three of four gauges (not g3): measured strain is 0.94 times")
    signs = of_all_gauges(gauges(0.94, 0.93, 0.95, -1.0))
    assert "three of four gauges (not g3)" in signs


def test_what_no_factor_explains_is_said():
    assert of_all_gauges(gauges(0.5, 1.3, 2.0, 0.8)).startswith("None of four gauges agrees with the computed strain")
    assert of_all_gauges(gauges(0.5, 1.3, 1.0, 1.0)) == (
        "Two of four gauges agree with the computed strain; no common factor explains the others: check each of them."
    )
    other_shapes = gauges(0.9, 0.9, 0.9, alike=False)
    assert of_all_gauges(other_shapes).startswith("None of three gauges agrees")


def test_fewer_than_three_measured_gauges_say_nothing_together():
    assert of_all_gauges([*gauges(0.9, 0.9), None, None]) == of_all_gauges([]) == ""


def zeros(*shifts, teeth=23, entered=(), on=("p", "pinion", "driver", "f.csv")):
    entered = entered or [1] * len(shifts)
    return [
        ("ABC"[i], TraceZero(on, tooth - 1, teeth, math.radians(shift)))
        for i, (shift, tooth) in enumerate(zip(shifts, entered, strict=True))
    ]


def test_shifts_of_gauges_on_one_gear_are_whole_pitches():
    pitch = 360.0 / 23.0
    assert teeth_apart(zeros(118.6, 118.6 + 8.0 * pitch, entered=(1, 9))) == ""
    assert teeth_apart(zeros(118.6, 118.6 + 8.0 * pitch, entered=(1, 3))) == (
        "Shifts: those of gauges B (243.8°) and A (118.6°) are 8.00 tooth pitches apart: gauge B is on tooth 9, not 3, "
        "with A on tooth 1."
    )
    assert teeth_apart(zeros(118.6, 118.6 + 8.0 * pitch)).endswith(": gauge B is on tooth 9, with A on tooth 1.")
    over_zero = zeros(-20.0, 340.0 - 3.0 * pitch + 0.01, entered=(5, 2))
    assert teeth_apart(over_zero) == ""
    assert teeth_apart(zeros(10.0, 9.9)) == teeth_apart(zeros(9.9, 10.0)) == ""
    assert "are 7.40 tooth pitches apart, not a whole number: check the angle for slip" in teeth_apart(
        zeros(0.0, 7.4 * pitch, 0.0)
    )
    other = [*zeros(0.0), *zeros(7.4 * pitch, on=("p", "wheel", "driven", "f.csv"))]
    assert teeth_apart(other) == teeth_apart([("A", None), *zeros(0.0)]) == teeth_apart([]) == ""


def test_the_teeth_are_said_behind_the_ratios():
    three = [replace(one, zero=zero) for one, (_, zero) in zip(gauges(1.0, 0.99, 1.01), zeros(0.0, 90.0, 0.0, teeth=20),
                                                               strict=True)]  # fmt: skip
    assert of_all_gauges(three).startswith("All three gauges agree")
    assert of_all_gauges(three).endswith("and g0 (0.0°) are 5.00 tooth pitches apart: gauge g1 is on tooth 6, with "
                                         "g0 on tooth 1.")  # fmt: skip
    assert of_all_gauges(three[:2]).startswith("Shifts: those of gauges g1 (90.0°)")


def test_the_common_sentence_is_first():
    def of(name, fact):
        return Answered((f"{name}.",), fact=fact, common=lambda facts: f"{sum(facts)} in all.", rank=-fact)

    assert joined([of("a", 1), of("b", 2), of("c", 3)]).sentences == ("6 in all.", "c.", "b.", "a.")
    assert joined([of("a", 1)]).sentences == ("a.",)
    nothing = [replace(of(name, 1), common=lambda _: "") for name in "ab"]
    assert joined(nothing).sentences == ("a.", "b.")


def test_exchanged_traces_of_both_fillets_are_named():
    place = ("I", "pinion", 1)
    t, c = (
        replace(gauges(0.4, alike=False)[0], name=name, explained=True, fits=(*place, side))
        for name, side in (("t", "compression"), ("c", "tension"))
    )
    said = "The traces of t and c are exchanged, each fits the fillet of the other: check channels (strain_column) and "
    assert of_all_gauges([t, c]) == f"{said}leads."
    assert of_all_gauges([*gauges(1.0), t, c]) == f"{said}leads."
    assert "exchanged" not in of_all_gauges([*gauges(1.0), t, replace(c, fits=(*place, "compression"))])
    assert "exchanged" not in of_all_gauges([*gauges(1.0), t, replace(c, fits=("I", "pinion", 2, "tension"))])
    assert of_all_gauges([t]) == ""
