"""Loading functions and their spectra against quadrature and 40-digit arithmetic."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import InputError, RangeError
from fegear.design.loading import LoadingFunction, Ramp, cosine_moment, sinusoidal_factor, slope_trade_off

A = 9.3730e-3

ramps = st.one_of(
    st.builds(Ramp, st.floats(0.0, 2.0)),
    st.integers(1, 15).flatmap(lambda k: st.builds(Ramp, st.floats(0.0, 2.0 * k + 1.0), st.just(2 * k + 1))),
)


@st.composite
def functions(draw):
    ratio = draw(st.one_of(st.floats(1.0, 4.2), st.sampled_from([1.0, 2.0, 3.0, 1.312])))
    probe = LoadingFunction(ratio * A, A)
    low, high = probe.peak_range
    peak = low + (high - low) * draw(st.floats(0.0, 1.0))
    return LoadingFunction(ratio * A, A, draw(st.floats(-3e-3, 3e-3)), draw(ramps), draw(ramps), peak)


def by_quadrature(f, g):
    """Composite Gauss quadrature between the kinks, enough panels for the waves."""
    t, w = np.polynomial.legendre.leggauss(48)
    total = 0.0
    for a, b in zip(f.kinks[:-1], f.kinks[1:], strict=True):
        if b - a < 1e-15:
            continue
        edges = np.linspace(a, b, 2 + int(abs(g) * (b - a) / 3))
        half = np.diff(edges) / 2
        x = (edges[:-1] + half)[:, None] + half[:, None] * t
        total += (f.fraction(x) * np.exp(-2j * math.pi * g * x) * w * half[:, None]).sum()
    return total


@given(functions(), st.one_of(st.floats(0.0, 40.0), st.sampled_from([0.0, 1e-9, 1e-4, 1.0])))
def test_spectrum_equals_quadrature(f, order):
    assert abs(f.spectrum(order / A) - by_quadrature(f, order / A)) <= 1e-12 * A


@given(functions(), st.floats(-1.0, 1.0))
def test_the_loads_of_all_pairs_add_up(f, where):
    x = f.centre + where * A + np.arange(-6, 7) * A
    # at the jumps of a path with vertical ends both neighbours may count
    if any(w > 0 and width <= 1e-9 for w, _, width, _ in f.terms):
        x = x + 1.234e-7 * A
    assert f.fraction(x).sum() == pytest.approx(1.0, abs=1e-9 if f.length < A * 1.0001 else 1e-12)


@given(functions())
def test_loading_is_symmetric_monotone_and_peaks_at_F(f):
    x = f.centre - f.length * np.linspace(0.5, 0.0, 501)[1:]
    if any(width == 0.0 for _, _, width, _ in f.terms):
        x = x + 1.7e-9 * A  # beside the jumps
    w = f.fraction(x)
    np.testing.assert_allclose(f.fraction(2 * f.centre - x), w, atol=1e-12)
    assert (np.diff(w) >= -1e-12).all()
    assert f.fraction(f.centre) == pytest.approx(f.peak, abs=1e-12)


@pytest.mark.parametrize("s", [0.0, 1.0, 2.0])
def test_removable_singularities_of_the_sinusoidal_family(s):
    assert sinusoidal_factor(0.0, s) == 1.0
    assert sinusoidal_factor(1.0, s) == pytest.approx((1.0 - s) / 2.0, abs=1e-15)
    for q in (1.0 - 1e-12, 1.0 + 1e-12, 1.0 - 1e-6, 0.5, 1e-30):
        with mpmath.workdps(40):
            m = mpmath.mpf(q)
            exact = mpmath.sincpi(m) * (1 - s * m**2) / (1 - m**2)
        assert sinusoidal_factor(q, s) == pytest.approx(float(exact), abs=2e-15)


@pytest.mark.parametrize("p", [2, 4, 6, 20, 40])
def test_cosine_moment_against_forty_digits(p):
    a = np.array([0.0, 1e-8, 1e-3, 0.5, 3.0, 10.0, 39.9, 40.1, 79.9, 80.1, 200.0, 1e4])
    got = cosine_moment(a, p)
    with mpmath.workdps(60):
        for value, x in zip(got, a, strict=True):
            m = mpmath.mpf(float(x))
            exact = mpmath.hyp1f2((p + 1) / mpmath.mpf(2), mpmath.mpf(1) / 2, (p + 3) / mpmath.mpf(2), -m * m / 4)
            assert abs(value - float(exact / (p + 1))) < 4e-15


def test_asymptote_and_its_envelope():
    """(4.20): the spectrum's difference from the asymptote falls with the fourth power against the second."""
    for ramp in (Ramp(1.5), Ramp(4.0, 7)):
        f = LoadingFunction(1.312 * A, A, ramp=ramp)
        ratio = []
        for order in (200.0, 2000.0):
            g = np.linspace(order, order + 10, 400) / A
            ratio.append(np.abs(f.spectrum(g) - f.asymptote(g)).max() / np.abs(f.asymptote(g)).max())
            np.testing.assert_allclose(f.envelope(g), f.initial_slope() / (np.pi * g) ** 2, rtol=1e-12)  # (4.22)
            assert (np.abs(f.spectrum(g)) <= 1.2 * f.envelope(g)).all()
        assert ratio[1] < 0.11 * ratio[0]


def test_two_ramps_and_jumps_have_asymptotes_too():
    """Contact ratio 2 to 3 as a sum over its ramps; a whole contact ratio starts with a jump and falls like 1/g."""
    high = LoadingFunction(2.3 * A, A, ramp=Ramp(1.5), inner_ramp=Ramp(0.5), peak=0.7)
    jump = LoadingFunction(A, A, ramp=Ramp(1.5))
    for f, order in ((high, 3), (jump, 1)):
        off, size = [], []
        for where in (100.0, 1000.0):
            g = np.linspace(where, where + 10.0, 2001) / A
            off.append(np.abs(f.spectrum(g) - f.asymptote(g)).max())
            size.append(np.abs(f.asymptote(g)).max())
            assert (np.abs(f.asymptote(g)) <= f.envelope(g) * (1.0 + 1e-9)).all()
        if f is jump:
            assert max(off) == 0.0
            assert size[1] == pytest.approx(0.1 * size[0], rel=0.15)
        else:
            assert off[1] < 10.0 ** (0.1 - order) * off[0]
            assert size[1] == pytest.approx(0.01 * size[0], rel=0.15)
    assert math.isinf(jump.initial_slope())


@pytest.mark.dear
@pytest.mark.parametrize(
    "ramp",
    [Ramp(0.0), Ramp(1.0), Ramp(2.0), Ramp(0.0, 3), Ramp(3.0, 3), Ramp(0.0, 7), Ramp(3.0, 7), Ramp(7.0, 7)],
    ids=str,
)
def test_spectrum_factor_is_the_transform_of_the_ramps_slope(ramp):
    """(4.15b), (4.16) from 30-digit quadrature of (4.12), (4.14), at the removable places and at s = 0, s = r."""
    s, r = mpmath.mpf(ramp.slope), ramp.exponent
    with mpmath.workdps(30):
        for q in (0.0, 1e-9, 0.5, 1.0, 1.0 + 1e-9, 2.0, 7.25, 40.0):

            def wave(t, q=q):
                slope = 1 + (1 - s) * mpmath.cospi(t) if r is None else ((r - s) + (s - 1) * r * t ** (r - 1)) / (r - 1)
                return slope * mpmath.cospi(q * t)

            exact = mpmath.quad(wave, mpmath.linspace(0, 1, 2 + int(q)))
            assert float(ramp.spectrum_factor(q)) == pytest.approx(float(exact), abs=3e-15)
    if ramp.exponent is None:
        assert float(ramp.spectrum_factor(1.0)) == pytest.approx((1.0 - ramp.slope) / 2.0, abs=1e-15)


def test_slope_zero_leaves_no_second_order_content():
    f0, f1 = (LoadingFunction(1.312 * A, A, ramp=Ramp(s)) for s in (0.0, 1.0))
    g = np.linspace(300, 310, 400) / A
    assert np.abs(f0.spectrum(g)).max() < 1e-3 * np.abs(f1.spectrum(g)).max()
    assert f0.initial_slope() == 0.0


def test_trade_off_rises_on_one_side_and_falls_on_the_other():
    t = slope_trade_off([LoadingFunction(1.312 * A, A, ramp=Ramp(s, 7)) for s in (0.5, 1.0, 2.0, 5.0)], above=20.0)
    assert (np.diff(t.high_frequency_content) > 0).all()
    assert (np.diff(t.length_per_load) < 0).all()


def test_contact_ratio_two_to_three_is_the_papers_figure_8():
    F, L = 0.7, 2.2 * A
    f, a = LoadingFunction(L, A, L / 2, peak=F), L - 2 * A
    np.testing.assert_allclose(f.fraction([0.0, a / 2, a, A, A + a, L]), [0, (1 - F) / 2, 1 - F, F, F, 0], atol=1e-12)


def test_impossible_loadings_are_refused():
    with pytest.raises(InputError, match=r"design\.slope"):
        Ramp(2.1)
    with pytest.raises(InputError, match=r"design\.exponent"):
        Ramp(1.0, 4)
    with pytest.raises(RangeError, match="base pitches; must be at least 1"):
        LoadingFunction(0.9 * A, A)
    with pytest.raises(RangeError, match=r"design\.peak"):
        LoadingFunction(2.2 * A, A, peak=0.4)
