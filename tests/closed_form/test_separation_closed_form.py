"""Derivatives of the angle at which helical flanks meet, by differences of the angle itself; shafts far out of line."""

import math

import numpy as np
import pytest

from fegear.contact.unloaded.placement import Placement

#: Two crowned, helical flanks on shafts that cross at ten degrees: no cosine is nearly one.
PLACE = Placement(
    distance=0.12, cos=math.cos(0.17), sin=math.sin(0.17), twist_1=9.0, crown=60.0, twist_2=-7.0, base_1=0.045,
    base_2=0.06, tip_2=0.075, form_2=0.061, offset_2=0.03, pressure_angle=0.36, ratio=1.3, face_1=(-0.01, 0.01),
    face_2=(-0.01, 0.01),
)  # fmt: skip
W, DW = 0.048 + 0.006j, 0.3 - 0.2j  # a point of the flank, and how it moves along the profile


def angle(z, w):
    """Angle of the gear at which a pinion's point meets its flank, as the gradient has it: its own integral."""
    x2, y2, z2 = PLACE.in_gear_frame(PLACE.turned(w, z), z)
    rr = x2 * x2 + y2 * y2
    roll = np.sqrt(rr - PLACE.base_2**2) / PLACE.base_2
    return PLACE.offset_2 + PLACE.twist_2 * z2 - (roll - np.arctan(roll)) - np.arctan2(y2, x2)


def test_slopes_are_the_derivatives_of_the_angle():
    z = np.linspace(-0.008, 0.008, 5)
    assert PLACE.gear_angle(np.full(z.size, W), z) == pytest.approx(angle(z, W), rel=1e-12)
    first, second = PLACE.slope_along_helix(z, np.full(z.size, W))
    step = 1e-5
    low, here, high = (angle(z + s, W) for s in (-step, 0.0, step))
    sign = np.sign(first[2] * (high - low)[2])
    assert first == pytest.approx(sign * (high - low) / (2.0 * step), rel=1e-5)
    assert second == pytest.approx(sign * (high - 2.0 * here + low) / step**2, rel=2e-4, abs=2e-3)
    along = PLACE.slope_along_profile(z, np.full(z.size, W), np.full(z.size, DW))
    by_difference = (angle(z, W + 1e-6 * DW) - angle(z, W - 1e-6 * DW)) / 2e-6
    assert along == pytest.approx(sign * by_difference, rel=1e-6)
