"""Where the trochoid of an undercut helical tooth meets its involute: both pass through one point, at any depth."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.generated_fillet import _SLIGHT_UNDERCUT, meeting
from fegear.geometry.rack import BasicRack

RACK = BasicRack(1.0, 1.25, 0.3)


def undercut(slight, teeth=12, helix=25.0):
    """A tooth whose straight flank ends so far below the base tangent point, as a roll angle [rad]."""
    plain = Tooth(teeth, RACK, 0.0, helix_angle=math.radians(helix))
    line = plain._flank_line
    shift = -(line.tangent_roll(RACK) + slight) * line.base_radius * math.sin(line.pressure_angle)
    return Tooth(teeth, RACK, shift, helix_angle=math.radians(helix), tip_radius=plain.tip_radius + shift)


def met(tooth):
    line = tooth._flank_line
    return line, tooth.fillet, float(tooth.roll(tooth.form_radius))


@pytest.mark.parametrize("slight", [1e-3, 1e-2, 3e-2])
@pytest.mark.parametrize("helix", [0.0, 10.0, 25.0])
def test_the_trochoid_ends_on_the_involute(slight, helix):
    line, fillet, roll = met(undercut(slight, helix=helix))
    assert line.tangent_roll(RACK) == pytest.approx(-slight, rel=1e-9)
    x, y = (float(one) for one in fillet.points(fillet.end))
    assert math.hypot(x, y) == pytest.approx(line.base_radius * math.hypot(1.0, roll), rel=1e-12)
    assert math.atan2(x, y) == pytest.approx(line.half_angle - (roll - math.atan(roll)), abs=1e-13)
    # below it the trochoid is cut into the involute's continuation, and nowhere beyond
    inside = np.linspace(fillet.start, fillet.end, 400)[1:-1]
    for point in fillet.points(inside).T:
        radius = math.hypot(*point)
        if radius > line.base_radius:
            assert math.atan2(*point) < line.polar(radius)


@pytest.mark.parametrize("helix", [10.0, 25.0])
def test_a_slight_undercut_begins_the_involute_at_half_its_roll_angle(helix):
    """On either side of where the roots drown in round-off: 2 x^3 + 3 x^2 = 1 at x = 1/2."""
    for slight, off in ((0.999 * _SLIGHT_UNDERCUT, 1e-6), (1.001 * _SLIGHT_UNDERCUT, 2e-2), (1e-6, 1e-3)):
        line, fillet, roll = met(undercut(slight, helix=helix))
        assert roll == pytest.approx(0.5 * slight, rel=off)
        assert math.hypot(*fillet.points(fillet.end)) == pytest.approx(
            line.base_radius * math.hypot(1.0, roll), rel=1e-13
        )


def test_where_the_trochoid_does_not_reach_the_involute_it_ends_at_its_end():
    tooth = undercut(1e-5)
    line = tooth._flank_line
    whole = replace(tooth.fillet, end=0.5 * math.pi - math.radians(20.0))
    beta, roll = meeting(whole, line, 0.0)
    assert (beta, roll) == (whole.end, 0.0)
    assert meeting(whole, line, 0.3) == (whole.end, 0.3)
    low = replace(whole, end=0.3)  # cut off below the base circle
    assert meeting(low, line, -1e-5) == (0.3, 5e-6)
    late = replace(whole, start=whole.end - 4e-11)  # begins beyond it
    assert meeting(late, line, -1e-5) == (late.end, 5e-6)
