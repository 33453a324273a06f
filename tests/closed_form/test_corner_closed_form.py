"""How a load beside a corner sinks: against the exact wedge, and contacts that no flank holds."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from fegear.base.errors import RangeError
from fegear.fem.plane.contact_width import corner_angles, wedge_slope
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.table import stiffness_table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material


@given(st.floats(0.3, 3.1))
def test_wedge_slope_is_the_energy_of_a_force_at_the_apex(angle):
    """Strain energy of the radial stress between two radii, by quadrature: half the force times what it gains."""
    alpha = 0.5 * angle
    normal = 0.5 * math.pi - alpha  # between the load, which is normal to a face, and the bisector
    along, across = math.cos(normal), math.sin(normal)

    def stress(theta):
        one = along * math.cos(theta) / (alpha + 0.5 * math.sin(angle))
        other = across * math.sin(theta) / (alpha - 0.5 * math.sin(angle))
        return one + other  # times 1/r

    # The stress balances the force: along the bisector and across it.
    assert quad(lambda t: stress(t) * math.cos(t), -alpha, alpha)[0] == pytest.approx(along, rel=1e-8, abs=1e-12)
    assert quad(lambda t: stress(t) * math.sin(t), -alpha, alpha)[0] == pytest.approx(across, rel=1e-8, abs=1e-12)
    energy = 0.5 * quad(lambda t: stress(t) ** 2, -alpha, alpha)[0]  # times ln(far / near)
    assert wedge_slope(angle) == pytest.approx(2.0 * energy, rel=1e-8)


def test_half_plane_and_corners_of_a_tooth():
    assert wedge_slope(math.pi) == pytest.approx(2.0 / math.pi, rel=1e-14)
    lower, upper = corner_angles(Tooth(28))
    assert lower == math.pi
    assert math.degrees(upper) == pytest.approx(90.0 + math.degrees(math.atan(float(Tooth(28).roll(15.0)))), abs=1e-9)
    assert math.pi / 2 < corner_angles(Tooth(8))[0] < math.pi


def test_a_contact_that_nears_the_tip_corner_sinks_by_the_wedge_s_logarithm():
    tooth = Tooth(28)
    known = solve_gear(Gear(tooth, 1.0, 6.4, material=Material(1.0)), MeshSettings(), estimate_error=False)
    distance = np.array([1e-5, 1e-4, 1e-3])
    radii = np.sqrt(tooth.tip_radius**2 - 2.0 * tooth.base_radius * distance)
    c = known.fine.self_compliance(radii, 0.13, 0.5 * distance)
    slope = wedge_slope(corner_angles(tooth)[1]) * 0.91
    assert -np.diff(c)[0] / math.log(10.0) == pytest.approx(slope, rel=2e-3)
    assert -np.diff(c)[1] / math.log(10.0) == pytest.approx(slope, rel=2e-2)


@pytest.mark.parametrize(
    ("radius", "half_width", "rule"),
    [
        (14.0, 0.6, "exceeds half a module"),
        (14.9, 0.4, "extends more than a tenth of a module beyond"),
        (14.0, 0.0, "positive"),
    ],
)
def test_half_widths_that_no_flank_holds_are_refused(radius, half_width, rule):
    gear = Gear(Tooth(28), 2e-3, 12.8e-3)
    with pytest.raises(RangeError, match=rule) as refused:
        stiffness_table(gear, [radius * 2e-3], half_width * 2e-3)
    assert f"{half_width * 2:.6g} mm" in str(refused.value)
    known = solve_gear(gear, MeshSettings().scaled(4.0), estimate_error=False)
    with pytest.raises(RangeError, match=rule):
        known.self_compliance([radius * 2e-3], half_width * 2e-3)
