"""Numbers with a bound of their round-off: each bound is that of the true derivatives, and of the operation itself."""

import numpy as np
import pytest

from fegear.dynamics.train.segments import Rounded, beside_zero, in_series, share

STEP = 1e-7
ONE = Rounded(np.array([3.0 + 4.0j, -0.2, 1e3]), np.array([2.0, 0.5, 7.0]))
OTHER = Rounded(np.array([1.0 - 2.0j, 5.0, -40.0]), np.array([0.25, 3.0, 11.0]))
REST = np.array([0.5 + 0.5j, 2.0, 300.0])


def bound(function, own, *given):
    """Sum of the inputs' errors times the sizes of the derivatives, and so many units of the value."""
    values = [one.value for one in given]
    found = own * np.abs(function(*values))
    for k, one in enumerate(given):
        moved = list(values)
        step = STEP * np.abs(one.value)
        moved[k] = one.value + step
        found = found + np.abs(function(*moved) - function(*values)) / step * one.error
    return function(*values), found


@pytest.mark.parametrize(
    ("name", "own"), [("__add__", 1.0), ("__sub__", 1.0), ("__mul__", 2.0), ("__truediv__", 3.0)]
)  # fmt: skip
def test_sums_and_products(name, own):
    found = getattr(ONE, name)(OTHER)
    value, error = bound(lambda a, b: getattr(a, name)(b), own, ONE, OTHER)
    np.testing.assert_allclose(found.value, value, rtol=1e-15)
    np.testing.assert_allclose(found.error, error, rtol=1e-6)


def test_numbers_alone():
    given = Rounded.given(ONE.value)
    np.testing.assert_array_equal(given.error, [5.0, 0.2, 1e3])
    zero = Rounded.zero(ONE.value)
    assert (zero.value.tolist(), zero.error.tolist()) == ([0.0] * 3, [0.0] * 3)
    assert zero.error.dtype == float
    less = -ONE
    np.testing.assert_array_equal(less.value + ONE.value, 0.0)
    np.testing.assert_array_equal(less.error, ONE.error)
    twice = ONE.times(-2.5)
    value, error = bound(lambda a: -2.5 * a, 1.0, ONE)
    np.testing.assert_allclose(twice.value, value)
    np.testing.assert_allclose(twice.error, error, rtol=1e-6)


def test_a_share_of_a_whole():
    found = share(ONE, OTHER)
    value, error = bound(lambda a, b: a / (a + b), 3.0, ONE, OTHER)
    np.testing.assert_allclose(found.value, value)
    np.testing.assert_allclose(found.error, error, rtol=1e-5)
    again = share(ONE, OTHER, ONE.value + OTHER.value)
    np.testing.assert_array_equal(again.error, found.error)
    assert (share(ONE, OTHER, 2.0 * (ONE.value + OTHER.value)).value == 0.5 * found.value).all()


def test_two_in_series_among_others():
    found = in_series(ONE, OTHER, ONE.value + OTHER.value + REST)
    value, error = bound(lambda a, b: a * b / (a + b + REST), 3.0, ONE, OTHER)
    np.testing.assert_allclose(found.value, value)
    np.testing.assert_allclose(found.error, error, rtol=1e-5)
    others = Rounded(REST, np.array([4.0, 5.0, 6.0]))
    uncertain = in_series(ONE, OTHER, ONE.value + OTHER.value + REST, others.error)
    _, more = bound(lambda a, b, c: a * b / (a + b + c), 3.0, ONE, OTHER, others)
    np.testing.assert_allclose(uncertain.error, more, rtol=1e-5)


@pytest.mark.parametrize("kind", [float, np.longdouble, complex])
def test_what_cancels_altogether_is_a_unit_of_its_last_place(kind):
    a = Rounded.given(np.array([3.0, -5.0, 0.0, 1e-200], dtype=kind))
    b = Rounded.given(np.array([-3.0, 5.0, 0.0, 1e-200], dtype=kind))
    eps = np.finfo(np.abs(a.value).dtype).eps
    np.testing.assert_array_equal(beside_zero(a, b), np.array([6.0 * eps, 10.0 * eps, 1.0, 2e-200], dtype=kind))
