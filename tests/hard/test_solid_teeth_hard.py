"""Solid gears asked for what makes no sense, and the laws that random ones keep."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fegear.base.errors import InputError, RangeError
from fegear.fem.solid.bands import hats
from fegear.fem.solid.influence import solid_influence
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

pytestmark = pytest.mark.last_bit

RACK = BasicRack(1.0, 1.25, 0.25)
ROUGH = replace(
    SolidSettings().scaled(2.0), section=replace(SolidSettings().section.scaled(2.0), order=2), least_degree=4
)
STATIONS = np.linspace(-1.0, 1.0, 5)


@pytest.fixture(scope="module")
def known():
    tooth = Tooth(19, RACK, 0.1)
    return solid_influence(tooth, 0.02, 2.0, 0.3, 0.6 * tooth.root_radius, ROUGH, estimate_error=False)


@pytest.mark.parametrize("half_width", [0.0, -0.1, math.nan, math.inf, 5.0])
def test_contacts_without_a_width_or_wider_than_the_flank_are_refused(known, half_width):
    with pytest.raises(RangeError, match=r"half_width = .* modules: must be positive and at most 0\.911"):
        known.contact_compliance(np.full(5, 9.8), STATIONS, half_width)
    with pytest.raises(RangeError, match="half_width"):
        known.deflection(0, hats(9.8, STATIONS, half_width), hats(9.8, STATIONS, 0.2))


@pytest.mark.parametrize("radius", [5.0, 20.0, math.nan, math.inf])
def test_places_off_the_flank_are_refused(known, radius):
    with pytest.raises(RangeError, match="is outside the flank,"):
        known.contact_compliance(np.full(5, radius), STATIONS, 0.02)
    with pytest.raises(RangeError, match="is outside the flank,"):
        known.deflection(1, hats(radius, STATIONS, 0.2), hats(9.8, STATIONS, 0.2))


def test_teeth_places_and_slopes_that_are_not_known_are_refused(known):
    line = hats(9.8, STATIONS, 0.2)
    for k in (2, -5):
        with pytest.raises(RangeError, match="must be a whole number from -1 to 1"):
            known.deflection(k, line, line)
        with pytest.raises(RangeError, match="must be a whole number from -1 to 1"):
            known.fillet_stress(k, "tension", line, [0.0])
    for zeta in (1.1, -3.0, math.nan):
        with pytest.raises(RangeError, match="is outside the face width, -1 to 1 modules"):
            known.fillet_stress(0, "tension", line, [0.0, zeta])
    with pytest.raises(RangeError, match="slope"):
        known.deflection(0, hats(9.8, STATIONS, 0.2, slope=math.nan), line)
    with pytest.raises(RangeError, match="reach = -1"):
        solid_influence(known.fine.tooth, 0.0, 2.0, 0.3, 5.0, ROUGH, reach=-1)
    with pytest.raises(InputError, match="fewest_waves"):
        replace(ROUGH, fewest_waves=0.5)
    with pytest.raises(InputError, match="room_share"):
        replace(ROUGH, room_share=1.5)


@pytest.mark.dear
@settings(max_examples=3, deadline=None, derandomize=True)
@given(
    teeth=st.integers(12, 90),
    angle=st.floats(0.0, 35.0),
    width=st.floats(0.5, 2.5),
    bore=st.floats(0.3, 0.93),
    nu=st.floats(0.0, 0.4),
)
def test_random_solid_gears_are_reciprocal_and_mirror_images_of_the_other_hand(teeth, angle, width, bore, nu):
    tooth = Tooth(teeth, RACK, 0.2, helix_angle=math.radians(angle))
    right, left = (
        solve_solid(tooth, hand * tooth.twist, width, nu, bore * tooth.root_radius, ROUGH) for hand in (1.0, -1.0)
    )
    stations = 0.5 * width * np.array([-1.0, -0.4, 0.1, 1.0])
    low, high = right.flank.lowest_radius, right.flank.highest_radius
    radius = low + (high - low) * np.array([0.3, 0.55, 0.4, 0.75])
    line = hats(radius, stations, 0.2, slope=right.line_slope(radius))
    image = hats(radius[::-1], -stations[::-1], 0.2, slope=left.line_slope(radius[::-1]))
    for k in (-1, 0, 1):
        found = right.deflection(k, line, line)
        size = right.deflection(0, line, line).max()
        np.testing.assert_allclose(found, right.deflection(-k, line, line).T, atol=1e-10 * size)
        np.testing.assert_allclose(found, left.deflection(k, image, image)[::-1, ::-1], atol=1e-8 * size)
    assert np.linalg.eigvalsh(right.deflection(0, line, line)).min() > 0.0
