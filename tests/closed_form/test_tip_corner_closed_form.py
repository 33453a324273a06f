"""The gap of a tip corner off the path, found again from the tooth curves by turning gears until they touch."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

from fegear.contact.plane.corner import CornerContact
from fegear.contact.plane.edge_law import edge_law
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack


def pair_of(z1, z2, x1=0.0, x2=0.0, rounding=0.0):
    def gear(z, x):
        return Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25), x, tip_rounding=rounding), 2e-3, 5e-3)

    return GearPair(gear(z1, x1), gear(z2, x2))


def turned_until_touching(pair, u_driver):
    """Approach side: turn the driven gear until the corner of its tip lies on the driver's flank; return its u.

    Frame: driver at the origin, driven at (a, 0); the tooth contact lies at y > 0 and meshing runs toward y < 0.
    """
    a, r1, r2 = pair.centre_distance, pair.driver.base_radius, pair.driven.base_radius
    tip = pair.driven.involute_tip_radius
    rho0 = float(pair.radius(pair.x_start, "driver"))
    # At the start of the path: the contact point seen from both centres.
    at1 = math.acos((a * a + rho0**2 - tip**2) / (2 * a * rho0))
    at2 = math.acos((a * a + tip**2 - rho0**2) / (2 * a * tip))
    involute = pair.driver.tooth.involute
    m = pair.driver.module
    reference = float(involute.polar(rho0 / m))

    def misfit(u_driven):
        angle = at2 + u_driven / r2
        px, py = a - tip * math.cos(angle), tip * math.sin(angle)
        radius, polar = math.hypot(px, py), math.atan2(py, px)
        # the driver's flank thins outward: polar angle grows as the tooth's half angle falls
        flank = at1 + u_driver / r1 + reference - float(involute.polar(radius / m))
        return polar - flank

    return brentq(misfit, 0.5 * u_driver, 3.0 * u_driver, xtol=1e-18, rtol=1e-15)


@given(st.sampled_from([(28, 28), (17, 60), (45, 20), (12, 100)]), st.floats(0.02, 0.9))
@example((12, 100), 0.02)
def test_gap_equals_turning_the_gears_until_they_touch(teeth, where):
    pair = pair_of(*teeth, 0.3 if teeth[0] < 18 else 0.0)
    corner = CornerContact(pair, "driven")
    if not corner.exists:
        return
    u = where * min(corner.reach, 0.5 * pair.base_pitch)
    gap, _, tilt = corner.locate(u)
    u_driver = u - gap / 2  # the position is counted midway between both gears' rolled lengths
    assert turned_until_touching(pair, u_driver) - u_driver == pytest.approx(float(gap), rel=1e-7, abs=1e-15)
    assert tilt > 0


@given(st.integers(10, 80), st.integers(18, 80), st.floats(0.0, 1.0))
def test_the_reversed_pair_sees_the_mirror_image(z1, z2, where):
    pair = pair_of(z1, z2, 0.5 if z1 < 18 else 0.0)
    one, other = CornerContact(pair, "driven"), CornerContact(pair.reversed(), "driver")
    assert one.exists == other.exists
    if one.exists:
        u = where * one.reach
        for a, b in zip(one.locate(u), other.locate(u), strict=True):
            assert float(a) == pytest.approx(float(b), rel=1e-9, abs=1e-18)


@pytest.mark.parametrize("rounding", [0.0, 0.1])
def test_the_gap_starts_from_nothing_with_the_square_of_the_distance(rounding):
    pair = pair_of(28, 28, rounding=rounding)
    corner = CornerContact(pair, "driver")
    assert corner.exists
    gap, length, _ = corner.locate(np.array([0.0, 1e-5, 2e-5, 4e-5]))
    assert gap[0] == pytest.approx(0.0, abs=1e-15)
    np.testing.assert_allclose(gap[2:] / gap[1:-1], 4.0, rtol=0.02)
    assert length[0] == pytest.approx(float(pair.flank_curvature_radius(pair.x_end, "driven")), rel=1e-9)
    assert np.isinf(corner.locate(np.array([2 * corner.reach]))[0][0])


def pressure_integral(t, power):
    """Integrals of the edge contact's pressure over [0, c] with R = 1, E* = 2, b = 1: tilt t, width c."""
    c = 2.0 / (t + math.sqrt(t * t + 3.0))

    def p(s):
        return math.sqrt((c - s) / s) * (s + c / 2 + t)

    return quad(lambda q: p(q * q) * power(q * q) * 2 * q, 0.0, math.sqrt(c), limit=400, epsabs=1e-13)[0]


@pytest.mark.parametrize("t", [-0.999, -0.5, 0.0, 0.3, 2.0, 30.0])
def test_edge_law_is_the_logarithmic_potential_of_its_pressure(t):
    """Load pi/2 makes the Hertzian half-width 1; approach at the corner less that of Hertz, per kappa W."""
    load = pressure_integral(t, lambda s: 1.0)
    assert load == pytest.approx(math.pi / 2, rel=1e-9)
    mean_log = pressure_integral(t, math.log) / load
    hertz = math.log(0.5) - 0.5  # mean of ln|s| under a semi-ellipse of half-width 1, at its centre
    expected = -(mean_log - hertz) + (t * t if t < 0 else 0.0)
    psi, slope = edge_law(t)
    assert psi == pytest.approx(expected, rel=1e-7, abs=1e-9)
    h = 1e-5
    numeric = t * (edge_law(t + h)[0] - edge_law(t - h)[0]) / (2 * h)
    assert slope == pytest.approx(numeric, rel=1e-6, abs=1e-6)


def test_edge_law_joins_hertz_smoothly_and_is_safe_at_the_ends():
    psi, slope = edge_law(np.array([-np.inf, -1e10, -1.0, -1.0 + 1e-9]))
    np.testing.assert_allclose(psi, 0.0, atol=1e-12)
    np.testing.assert_allclose(slope, 0.0, atol=1e-7)
    psi, slope = edge_law(1e10)
    assert slope == pytest.approx(1.0, rel=1e-9)
    assert psi == pytest.approx(math.log(2e10) + 0.5, rel=1e-9)
