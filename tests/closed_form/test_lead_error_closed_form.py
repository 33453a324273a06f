"""Lead errors: Eq. 18 of TM-107451 against the derivative that it states, and the pinion that Appendix 2 makes."""

import math

import pytest
from helical_gears import helical_gear
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import InputError, RangeError
from fegear.contact.unloaded.manufacture import as_cut, lead_angle_error, lead_angle_error_of_cut, lead_error_as_cut

DEG = math.pi / 180.0


def gear(beta=30.0, hand="left", teeth=30):
    return helical_gear(teeth, 5.08e-3, 20.0 * DEG, beta * DEG, 0.04, hand)


@pytest.mark.parametrize("hand", ["left", "right"])
@given(beta=st.floats(0.5, 50.0), teeth=st.integers(12, 200))
def test_equation_18_is_the_derivative_at_a_fixed_pitch_radius(hand, beta, teeth):
    pinion = gear(beta, hand, teeth)
    assert pinion.lead == pytest.approx(2.0 * math.pi / abs(pinion.twist), rel=1e-12)
    step = 1e-6 * pinion.lead
    angles = [math.atan((pinion.lead + sign * step) / (2.0 * math.pi * pinion.pitch_radius)) for sign in (-1, 1)]
    assert lead_angle_error(pinion, 2.0 * step) == pytest.approx(angles[1] - angles[0], rel=1e-8)


@pytest.mark.parametrize("hand", ["left", "right"])
@given(beta=st.floats(2.0, 50.0), minutes=st.floats(-60.0, 60.0))
def test_the_lead_as_cut_is_that_of_appendix_2(hand, beta, minutes):
    pinion, angle = gear(beta, hand), minutes * DEG / 60.0
    cut = as_cut(pinion, lead_angle=angle)
    by_hand = 2.0 * math.pi * (1.0 / abs(cut.twist) - 1.0 / abs(pinion.twist))
    found = lead_error_as_cut(pinion, angle)
    assert found == pytest.approx(by_hand, abs=1e-12 * pinion.lead / math.sin(pinion.helix_angle))
    if abs(found) < 0.2 * pinion.lead:
        assert lead_angle_error_of_cut(pinion, found) == pytest.approx(angle, rel=1e-9, abs=1e-15)


@pytest.mark.parametrize("change", [1e-15, -1e-9, 1e-6])
def test_small_errors_keep_their_digits_and_the_readings_differ_by_the_sine_squared(change):
    pinion = gear(30.0)
    angle = lead_angle_error(pinion, change)
    assert lead_error_as_cut(pinion, angle) / change == pytest.approx(0.75, rel=1e-5)
    assert lead_angle_error_of_cut(pinion, change) / angle == pytest.approx(4.0 / 3.0, rel=1e-5)


def test_leads_that_mean_nothing_are_refused():
    with pytest.raises(InputError, match="spur gear, whose lead is infinite"):
        lead_angle_error(helical_gear(30, 5e-3, 0.35, 0.0, 0.04, "spur"), 1e-3)
    for change in (0.5, -0.5, math.nan, math.inf):
        with pytest.raises(RangeError, match="is not small relative to the lead of 957"):
            lead_angle_error(gear(), change)
    assert lead_angle_error_of_cut(gear(50.0), 0.1) > 0.0
