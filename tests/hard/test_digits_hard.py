"""Where digits could be lost to cancellation or bad conditioning: against fifty digits, or against the limit."""

import math

import mpmath
import numpy as np
import pytest

from fegear.contact.fourier import panels
from fegear.contact.plane.mark_series import reciprocal_series
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair

pytestmark = pytest.mark.last_bit

FAST = MeshSettings().scaled(2.0)


@pytest.mark.parametrize("swing", [0.5, 0.9, 0.99])
def test_marks_series_is_nested_and_loses_nothing_where_its_binomials_overflow(swing):
    """200 terms with stiffness down to a hundredth of the mean: the binomial form adds terms of 1e59 to find 1e2."""
    points = panels(0.0, 1.0, [], waves=8)
    k = 1.0 + swing * np.cos(2.0 * np.pi * points.x)
    found = reciprocal_series(points, k, 4, [200])
    assert found.converges
    with mpmath.workdps(50):
        exact = []
        for n in range(5):
            total = mpmath.mpf(0)
            for x, w, value in zip(points.x, points.weights, k, strict=True):
                m = mpmath.mpf(float(value)) / mpmath.mpf(float(k @ points.weights))
                series = (1 - (1 - m) ** 201) / m
                total += mpmath.mpf(float(w)) * series * mpmath.cos(2 * mpmath.pi * n * mpmath.mpf(float(x)))
            exact.append(float(total / mpmath.mpf(float(k @ points.weights))))
    assert found.pointwise[0].coefficients.real == pytest.approx(exact, rel=1e-12, abs=1e-12)
    assert not reciprocal_series(points, np.where(points.x < 0.1, 10.0, 1.0), 4, [5]).converges


def test_a_body_that_turns_about_a_small_bore_leaves_the_teeth_their_digits():
    """c_0 grows to thousands of times the tooth's own, as R^2 / (4 pi G r^2) of a twisted disc; root stress stays."""
    tooth, radii = Tooth(28), np.array([13.6, 14.0, 15.0])
    shear = 0.5 / 1.3

    def solved(bore):
        return solve_gear(Gear(tooth, 1.0, bore, 10.0, Material(1.0, 0.3)), FAST, estimate_error=False)

    bores = (0.8, 0.08, 0.008)
    known = [solved(b) for b in bores]
    c = np.array([k.self_compliance(radii, 0.02) for k in known])
    stress = np.array([k.largest_root_stress(0, "tension", radii)[0] for k in known])
    for i in (1, 2):
        twist = tooth.base_radius**2 / (4.0 * math.pi * shear) * (bores[i] ** -2 - bores[i - 1] ** -2)
        assert c[i] - c[i - 1] == pytest.approx(np.full(3, twist), rel=0.04)
        assert stress[i] == pytest.approx(stress[0], rel=4e-3)
    # Differences along the flank are the tooth's own, at 2e5 / 13 beside the whole as at 2.
    assert np.diff(c[2]) == pytest.approx(np.diff(c[0]), rel=0.3)


@pytest.mark.parametrize("teeth", [(12, 13), (20, 1000), (1000, 1000)])
@pytest.mark.parametrize("wider", [0.0, 1e-9, 1e-3])
def test_pairs_of_large_radii_and_small_differences_keep_their_digits(teeth, wider):
    """Contact ratio, ends of contact and backlash: differences of lengths a thousand times their size."""
    gears = [Gear(Tooth(z, profile_shift=0.3 if z < 20 else 0.0), 1e-3, 0.3e-3 * z) for z in teeth]
    tight = GearPair(*gears).centre_distance
    pair = GearPair(*gears, tight * (1.0 + wider))
    with mpmath.workdps(50):
        m = mpmath.mpf
        rb, ra = [m(g.base_radius) for g in gears], [m(g.tip_radius) for g in gears]
        a = m(pair.centre_distance)
        line = mpmath.sqrt(a**2 - (rb[0] + rb[1]) ** 2)
        ends = [mpmath.sqrt(r**2 - b**2) for r, b in zip(ra, rb, strict=True)]
        at_pitch = rb[0] * line / (rb[0] + rb[1])
        x_start, x_end = (line - ends[1]) - at_pitch, ends[0] - at_pitch
        alpha = [
            mpmath.acos(min((rb[0] + rb[1]) / m(d), 1)) for d in (pair.centre_distance, pair.tight_centre_distance)
        ]
        backlash = 2 * (rb[0] + rb[1]) * ((mpmath.tan(alpha[0]) - alpha[0]) - (mpmath.tan(alpha[1]) - alpha[1]))
    size = float(line)
    if teeth != (12, 13):  # there the form circle may end the contact first
        assert pair.x_start == pytest.approx(float(x_start), abs=1e-14 * size)
        assert pair.x_end == pytest.approx(float(x_end), abs=1e-14 * size)
        assert pair.contact_ratio == pytest.approx(float((x_end - x_start) / m(pair.base_pitch)), rel=2e-12)
    assert pair.normal_backlash == pytest.approx(float(backlash), abs=4e-15 * float(a))


def test_a_contact_of_vanishing_width_follows_the_logarithm_to_the_last_digit():
    known = solve_gear(Gear(Tooth(28), 1.0, 6.4, 10.0, Material(1.0, 0.3)), FAST, estimate_error=False)
    widths = np.logspace(-18.0, -300.0, 14)  # wider ones feel the flank's curvature too
    c = np.array([known.self_compliance([14.0], b)[0] for b in widths])
    assert np.isfinite(c).all()
    assert np.diff(c) == pytest.approx(-known.log_slope * np.diff(np.log(widths)), rel=1e-12)
