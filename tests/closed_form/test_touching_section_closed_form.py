"""The section where a Lewis parabola touches the trochoid, beside the parabola of least width over all its points."""

import math

import numpy as np
import pytest

from fegear.formulas.root_section import lewis_section, load_line, touching_section
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack


def narrowest(tooth, apex):
    """Half thickness and height where x^2 / (apex - y) is least along the trochoid, from the root circle on.

    It goes on beyond the start of the involute, up to where its parameter is a right angle; the first minimum counts.
    """
    beta = np.linspace(tooth.fillet.start, 0.5 * math.pi - 2e-3, 40_001)
    x, y = tooth.trochoid.points(beta)
    width = np.where(apex > y, x**2 / np.maximum(apex - y, 1e-9), np.inf)
    at = 1 + int(np.flatnonzero((width[1:-1] <= width[:-2]) & (width[1:-1] < width[2:]))[0])
    return float(x[at]), float(y[at])


@pytest.mark.parametrize("share", [0.2, 0.6, 1.0])
@pytest.mark.parametrize(
    ("teeth", "shift", "rounding"),
    [(12, 0.0, 0.25), (12, 0.5, 0.3), (17, 0.8, 0.2), (28, 0.0, 0.3), (60, 0.0, 0.25), (200, 0.0, 0.25)],
)
def test_no_parabola_from_the_load_s_apex_is_narrower(teeth, shift, rounding, share):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, rounding), shift)
    radius = tooth.form_radius + share * (tooth.involute_tip_radius - tooth.form_radius)
    section, load = lewis_section(tooth, radius)
    x, y = narrowest(tooth, float(load_line(tooth, radius).apex[0]))
    assert float(load.apex[0]) == float(load_line(tooth, radius).apex[0])
    assert section.half_thickness == pytest.approx(x, abs=2e-3)
    assert section.height == pytest.approx(y, abs=2e-3)
    # The parabola from there is no wider than the tooth anywhere: of second order, so closer than the points are.
    apex = float(load.apex[0])
    width = section.half_thickness**2 / (apex - section.height)
    assert width == pytest.approx(x**2 / (apex - y), rel=1e-6)


@pytest.mark.parametrize(("teeth", "shift"), [(20, 0.0), (200, 0.0), (500, 0.5)])
def test_from_far_away_the_parabola_touches_where_the_trochoid_is_narrowest(teeth, shift):
    """Its sides are parallel there; of many teeth that lies far beyond the start of the involute."""
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), shift)
    section = touching_section(tooth, 1e6)
    assert section.half_thickness == pytest.approx(narrowest(tooth, 1e9)[0], rel=1e-6)
    assert section.tangent_angle == pytest.approx(0.0, abs=1e-5)
    beyond = float(tooth.trochoid.points(tooth.fillet.end)[1])
    assert (section.height > beyond) == (teeth > 20)
