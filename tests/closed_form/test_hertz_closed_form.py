"""Hertzian line contact against the elasticity it comes from."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from fegear.base.errors import RangeError
from fegear.formulas import hertz, palmgren

E, NU = 206.8e9, 0.3
E_STAR = hertz.contact_modulus(E, NU, E, NU)


def pressure_integral(a: float, p0: float) -> float:
    return quad(lambda x: p0 * math.sqrt(1.0 - (x / a) ** 2), -a, a)[0]


@given(st.floats(1.0, 1e8), st.floats(1e-2, 1e4))
def test_pressure_carries_the_load_and_closes_the_gap(load, kappa):
    if 2.0 * math.sqrt(load * kappa / (math.pi * E_STAR)) > 0.3:
        with pytest.raises(RangeError, match="too wide"):
            hertz.line_contact(load, kappa, E_STAR)
        return
    c = hertz.line_contact(load, kappa, E_STAR)
    a, p0 = float(c.half_width), float(c.peak_pressure)
    assert pressure_integral(a, p0) == pytest.approx(load, rel=1e-9)
    # a semi-elliptic pressure makes a parabola of curvature 2 p0 / (a E*) (Johnson, Eq. 4.42); it must equal kappa
    assert p0 == pytest.approx(0.5 * a * kappa * E_STAR, rel=1e-12)


def test_greatest_shear_is_the_textbook_value():
    # Johnson, section 4.2(c): 0.30 p0 at 0.78 a; here to more digits from his stresses
    c = hertz.line_contact(1e5, 100.0, E_STAR)
    s = np.linspace(0.0, 3.0, 300001)
    shear = s - s * s / np.sqrt(1.0 + s * s)
    assert float(c.greatest_shear / c.peak_pressure) == pytest.approx(shear.max(), rel=1e-9)
    assert s[shear.argmax()] == pytest.approx(0.7861514, abs=2e-5)


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("depth_ratio", [0.1, 1.0, 7.0, 1e3])
def test_approach_is_the_integral_of_johnsons_stresses(plane, depth_ratio):
    a, w = 8e-5, 2e5
    p0 = 2.0 * w / (math.pi * a)

    def strain(z: float) -> float:  # Johnson Eqs. 4.46, Hooke
        root = math.hypot(a, z)
        sigma_z, sigma_x = -p0 * a / root, -p0 * ((a * a + 2 * z * z) / root - 2 * z) / a
        if plane == "strain":
            return -(1.0 - NU**2) / E * (sigma_z - NU / (1.0 - NU) * sigma_x)
        return -(sigma_z - NU * sigma_x) / E

    d = depth_ratio * a
    edges = [x for x in (0.0, a, 10 * a, 100 * a) if x < d] + [d]
    expected = sum(quad(strain, lo, hi, epsrel=1e-12)[0] for lo, hi in itertools.pairwise(edges))
    assert float(hertz.approach(w, a, d, E, NU, plane)) == pytest.approx(expected, rel=1e-9, abs=0.0)


def test_deep_approach_is_webers_logarithm():
    a, d, w = 1e-5, 1e-2, 1e5
    textbook = 2 * w * (1 - NU**2) / (math.pi * E) * (math.log(2 * d / a) - NU / (2 * (1 - NU)))
    assert float(hertz.approach(w, a, d, E, NU)) == pytest.approx(textbook, rel=1e-6)


@given(st.floats(1e-300, 1e6), st.floats(1e-12, 1e-3), st.floats(0.0, 1.0))
def test_approach_is_finite_and_grows_with_depth(load, a, d):
    one, two = hertz.approach(load, a, np.array([d, 2 * d]), E, NU)
    assert 0.0 <= one <= two
    assert math.isfinite(two)


def test_no_load_gives_no_deflection_even_without_a_width():
    assert float(hertz.approach(0.0, 0.0, 1e-3, E, NU)) == 0.0
    c = hertz.line_contact(0.0, 50.0, E_STAR)
    assert float(c.half_width) == float(c.peak_pressure) == 0.0


def test_approach_tends_to_zero_with_the_load():
    loads = np.logspace(3, -250, 40)
    a = hertz.line_contact(loads, 100.0, E_STAR).half_width
    delta = hertz.approach(loads, a, 1e-3, E, NU)
    assert np.all(np.diff(delta) < 0.0)
    assert delta[-1] > 0.0


def test_flat_against_round_and_flat_against_flat():
    assert float(hertz.relative_curvature(math.inf, 0.02)) == 50.0
    with pytest.raises(RangeError, match="must be positive"):
        hertz.line_contact(1e5, hertz.relative_curvature(math.inf, math.inf), E_STAR)


@given(st.floats(1e-3, 1e3), st.integers(4, 45))
def test_nearly_conforming_flanks_keep_their_digits(radius, bits):
    # 1/R - 1/(R + d) = d / (R (R + d)): d is exact in floats, the difference of reciprocals is not
    concave = -(radius + radius * 2.0**-bits)
    gap = -(radius + concave)
    expected = gap / radius / -concave
    assert float(hertz.relative_curvature(radius, concave)) == pytest.approx(expected, rel=1e-14, abs=0.0)


def test_curvature_of_extreme_radii_neither_overflows_nor_vanishes():
    assert float(hertz.relative_curvature(1e200, 1e200)) == pytest.approx(2e-200, rel=1e-14, abs=0.0)
    assert float(hertz.relative_curvature(1e-200, 1e-200)) == pytest.approx(2e200, rel=1e-14)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: hertz.line_contact(-1.0, 10.0, E_STAR), "must not be negative"),
        (lambda: hertz.line_contact(1.0, -10.0, E_STAR), "must be positive"),
        (lambda: hertz.line_contact(1.0, math.nan, E_STAR), "must be positive"),
        (lambda: hertz.line_contact(1e9, 1e4, E_STAR), "too wide"),
        (lambda: hertz.line_contact(1.0, 1.0, 0.0), "must be positive"),
        (lambda: hertz.approach(1.0, 0.0, 1e-3, E, NU), "infinite deflection"),
        (lambda: hertz.approach(1.0, 1e-5, -1e-3, E, NU), "must not be negative"),
        (lambda: hertz.approach(1.0, 1e-5, 1e-3, -E, NU), "must be positive"),
        (lambda: hertz.approach(1.0, 1e-5, 1e-3, E, 0.5), "inside"),
        (lambda: hertz.relative_curvature(0.0, 1.0), "must not be zero"),
        (lambda: palmgren.approach(-1.0, 0.01, E), "must not be negative"),
        (lambda: palmgren.approach(1.0, 0.0, E), "must be positive"),
    ],
)
def test_out_of_range_says_why(call, words):
    with pytest.raises(RangeError, match=words):
        call()


def test_palmgren_is_homogeneous_of_degree_nine_tenths():
    one, ten = palmgren.approach([1e5, 1e6], 0.02, E)
    assert ten / one == pytest.approx(10**0.9, rel=1e-13)
