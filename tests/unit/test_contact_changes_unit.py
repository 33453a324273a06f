"""When teeth begin and end to touch on a step: also where two of them do so at once, and where time stands still."""

import math

import numpy as np
import pytest

from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.dynamics.motion.kernel.polynomials import first_crossing
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.train.charts import FourInertia, speed_chart
from fegear.dynamics.train.mesh_excitation import mesh_excitation
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair


def crossing(start, slope, h, sign, moment):
    return first_crossing(np.array([start, slope, 0.0, 0.0]), h, sign, moment)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_is_clear_of_zero_changes_in_its_own_time_however_soon(sign):
    for start in (1e-3, 6.6e-6, 1e-9, 1e-15):
        assert crossing(sign * start, -sign * 1.9, 4.0, sign, 4e-6) == pytest.approx(start / 1.9, rel=1e-12, abs=0.0)
    assert crossing(sign * 6.6e-6, -sign * 1.9, 1e-6, sign, 4e-6) == -1.0  # not on this step


@pytest.mark.parametrize("h", [4.0, 1e-3, 1e-12, 1e-16])
def test_what_has_just_changed_does_not_change_back_by_its_last_digit_however_short_the_step(h):
    for off in (-2.8e-17, 0.0, 2.8e-17):
        assert crossing(off, 0.26, h, 1.0, 1e-6) == -1.0
    assert crossing(-2.8e-17, -0.26, h, 1.0, 1e-6) == 0.0  # it leaves at once


@pytest.mark.dear
@pytest.mark.parametrize("coupling", [True, False])
@pytest.mark.parametrize("rpm", [3884.4474736835004, 4000.0, 4251.247507579048])
def test_two_pairs_of_teeth_that_close_in_together_do_not_stop_time(coupling, rpm):
    """Teeth without relief touch within round-off of each other after every leap; at 4000 rpm they never went on."""
    pinion, wheel = (Gear(Tooth(z), 3e-3, bore, face_width=10e-3) for z, bore in ((23, 15e-3), (57, 40e-3)))
    pair, force = GearPair(pinion, wheel), 3000.0
    softness = (closed_form_compliance(gear, "weber-banaschek") for gear in (pinion, wheel))
    springs = mesh_excitation(Engagement(PairCompliance(pair, *softness, coupling=coupling)), force)
    drive = FourInertia(
        motor=0.01, gear_1=1e-3, gear_2=2e-2, load=0.1, shaft_1=5e4, shaft_2=2e5, base_radius_1=pinion.base_radius,
        base_radius_2=wheel.base_radius, teeth_1=23, teeth_2=57, force=force, mesh_ratio=0.07,
    )  # fmt: skip
    model = MotionModel(drive.train(1.0 / springs.mean_compliance()), (springs,), 1.0)
    chart = speed_chart(model, [rpm * math.pi / 30.0], direction="static", tolerance=2e-3)
    assert 1.0 < chart.dynamic_factor[0] < 5.0
    assert 0.0 <= chart.apart[0] < 0.7


@pytest.mark.parametrize("bottom", [0.3, 0.05, 0.031, 0.01])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_dips_below_zero_between_two_looks_is_seen_even_before_the_first(bottom, sign):
    """A parabola that is below zero for a hundredth of the step, which is looked at in sixteen places."""
    half = 0.004
    row = sign * np.array([bottom**2 - half**2, -2.0 * bottom, 1.0, 0.0])
    assert first_crossing(row, 1.0, sign, 1e-6) == pytest.approx(bottom - half, rel=1e-9)
