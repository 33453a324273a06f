"""Dynamic factor foretold from the effective error: lines through known points, and where there is none."""

import math

import numpy as np
import pytest

from fegear.dynamics.train.dynamic_factor import factor_between, factor_line

ERROR = np.array([[1e-6, 4e-6], [9e-6, 15e-6]])


def test_points_on_a_line_are_told_wholly():
    line = factor_line(ERROR, 0.9 + 8e4 * ERROR)
    assert (line.constant, line.slope) == pytest.approx((0.9, 8e4))
    assert line.scatter < 1e-12
    assert line.correlation == pytest.approx(1.0)
    assert line(5e-6) == pytest.approx(1.3)


def test_least_squares_against_numpy():
    rng = np.random.default_rng(3)
    error = rng.uniform(1e-6, 2e-5, 40)
    factor = 1.0 + 7e4 * error + 0.05 * rng.standard_normal(40)
    line = factor_line(error, factor)
    slope, constant = np.polyfit(error, factor, 1)
    assert (line.constant, line.slope) == pytest.approx((constant, slope))
    assert line.correlation == pytest.approx(np.corrcoef(error, factor)[0, 1])
    assert line.scatter == pytest.approx(np.sqrt(np.mean((factor - np.polyval([slope, constant], error)) ** 2)))
    # a point without a result counts for nothing
    with_gap = factor_line([*error, np.nan, 1e-5], [*factor, 1.2, np.nan])
    assert with_gap == line


def test_what_cannot_be_told_is_not_told():
    assert factor_line([1e-6, 2e-6], [1.1, 1.2]) is None
    assert factor_line([3e-6] * 4, [1.1, 1.2, 1.3, 1.4]) is None
    assert factor_line(ERROR, np.full(4, 1.5).reshape(2, 2)).correlation == 0.0
    assert math.isnan(factor_between(5e-6, (5e-6, 5e-6), (1.2, 1.4)))


def test_between_two_known_factors():
    assert factor_between(6e-6, (5e-6, 9e-6), (1.2, 1.6)) == pytest.approx(1.3)
    assert factor_between(5e-6, (5e-6, 9e-6), (1.2, 1.6)) == 1.2
    assert factor_between(6e-6, (9e-6, 5e-6), (1.6, 1.2)) == pytest.approx(1.3)
