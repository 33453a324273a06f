"""Undercut flanks begin where trochoid and involute meet by their own points, slight undercut to its last digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack
from fegear.geometry.undercut import undercut_meeting

mp = mpmath.mp.clone()
mp.dps = 40


def _exact(teeth: int, shift: float, rack: BasicRack) -> float:
    """Roll angle where the trochoid of the rack's rounding comes out of the involute, by bisection in 40 digits."""
    z, x, depth, rho = (mp.mpf(value) for value in (teeth, shift, rack.dedendum, rack.tip_radius))
    alpha = mp.mpf(rack.pressure_angle)
    r, height = z / 2, x - depth + rho
    base = r * mp.cos(alpha)
    beside = mp.pi / 4 - depth * mp.tan(alpha) - rho * (1 - mp.sin(alpha)) / mp.cos(alpha)
    half = (mp.pi / 4 + x * mp.tan(alpha)) / r + mp.tan(alpha) - alpha

    def point(b):
        away = rho - height / mp.cos(b)
        polar = mp.pi / z - (height * mp.tan(b) + beside) / r - mp.atan2(away * mp.sin(b), r - away * mp.cos(b))
        return polar, away**2 + r**2 - 2 * r * away * mp.cos(b) - base**2

    def outside(b):
        polar, squared = point(b)
        roll = mp.sqrt(max(squared, mp.mpf(0))) / base
        return polar - half + roll - mp.atan(roll)

    def between(function, low, high):
        for _ in range(130):
            middle = (low + high) / 2
            low, high = (middle, high) if function(middle) < 0 else (low, middle)
        return high

    end = mp.pi / 2 - alpha
    low = mp.mpf(0)
    if point(low)[1] < 0:
        low = between(lambda b: point(b)[1], low, end)
    assert outside(low) < 0 <= outside(end)
    return float(mp.sqrt(point(between(outside, low, end))[1]) / base)


@pytest.mark.parametrize("below", [3e-6, 4e-4, 2e-2, 0.35])
@pytest.mark.parametrize(("teeth", "rounding"), [(9, 0.38), (26, 0.2)])
def test_the_flank_begins_where_the_trochoid_meets_it(teeth, rounding, below):
    rack = BasicRack(1.0, 1.25, rounding)
    least = Tooth(40, rack).least_profile_shift + 0.5 * (40 - teeth) * math.sin(rack.pressure_angle) ** 2
    tooth = Tooth(teeth, rack, least - below)
    assert tooth.undercut
    # the shift itself has 1e-16 of a module, of which a slight undercut is that much less
    assert tooth.form_roll == pytest.approx(_exact(teeth, tooth.profile_shift, rack), rel=1e-13 + 1e-16 / below)
    at = tooth.fillet.points(np.array([tooth.fillet.end]))[:, 0]
    assert math.hypot(*at) == pytest.approx(tooth.form_radius, rel=1e-12)


def test_one_gear_has_the_digits_of_many():
    slight, rounding = np.geomspace(1e-9, 0.3, 40), np.linspace(0.01, 0.08, 40)
    before, roll = undercut_meeting(slight, rounding, 0.35)
    each = [undercut_meeting([s], k, 0.35) for s, k in zip(slight, rounding, strict=True)]
    np.testing.assert_allclose(before, np.concatenate([one[0] for one in each]), rtol=1e-14)
    np.testing.assert_allclose(roll, np.concatenate([one[1] for one in each]), rtol=1e-14)
    # a slight one begins at half the roll angle by which the rack cuts past the base circle: 2 x^3 + 3 x^2 = 1
    np.testing.assert_allclose(roll[:5] / slight[:5], 0.5, rtol=1e-6)
    line = undercut_meeting([3e-17, 1e-11], 0.06, 0.35)
    np.testing.assert_allclose(line[1], [1.5e-17, 5e-12], rtol=1e-9)
    assert line[0].tolist() == [0.0, 0.0]
