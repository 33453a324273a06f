"""The spline against what splines reproduce, their order, and scipy's."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from fegear.contact.plane.spline import spline


@given(st.integers(4, 40), st.integers(0, 10**6))
def test_equals_scipys_not_a_knot(n, seed):
    rng = np.random.default_rng(seed)
    x = np.cumsum(0.05 + rng.random(n))
    y = rng.standard_normal(n)
    at = np.linspace(x[0] - 0.1, x[-1] + 0.1, 101)
    ours, theirs = spline(x, y)(at), CubicSpline(x, y)(at)
    np.testing.assert_allclose(ours, theirs, atol=1e-8 * np.abs(theirs).max())


def test_cubics_are_exact_and_smooth_functions_converge_with_the_fourth_power():
    x = np.linspace(-1, 1, 9)
    at = np.linspace(-1, 1, 77)
    np.testing.assert_allclose(spline(x, x**3 - x)(at), at**3 - at, atol=1e-14)
    errors = [
        np.abs(spline(g, np.exp(g))(at) - np.exp(at)).max() for g in (np.linspace(-1, 1, 20), np.linspace(-1, 1, 39))
    ]
    assert 3.5 < np.log2(errors[0] / errors[1]) < 4.6
