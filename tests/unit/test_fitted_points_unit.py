"""Splines through points and beside them: they pass through, keep ends and directions, and take the fewest pieces."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import BSpline

from fegear.base.errors import GeometryError
from fegear.geometry.fillet_curves import DEGREE
from fegear.geometry.fitted_points import interpolated, smoothed


def arc(count, uneven=1.0, noise=0.0):
    """Points of a quarter of a circle of radius 2."""
    t = 0.5 * math.pi * np.linspace(0.0, 1.0, count) ** uneven
    r = 2.0 + noise * np.random.default_rng(2).uniform(-1.0, 1.0, count) * (t > 0.0) * (t < 0.5 * math.pi)
    return np.stack([r * np.cos(t), r * np.sin(t)])


def spline(found):
    return BSpline(np.array(found.knots), np.array(found.control), found.degree)


ENDS = [(None, None), (np.array([0.0, 3.0]), None), (None, np.array([-2.0, 0.0])), (np.array([0.0, 1.0]),
        np.array([-1.0, 0.0]))]  # fmt: skip


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize(("count", "degree"), [(6, 3), (9, 3), (10, DEGREE), (25, DEGREE)])
@pytest.mark.parametrize("uneven", [1.0, 1.4])
def test_a_curve_passes_through_its_points_over_the_length_along_itself(count, degree, uneven, ends):
    points = arc(count, uneven)
    found = interpolated(points, ends)
    assert found.degree == degree
    curve = spline(found)
    u = np.linspace(found.knots[0], found.knots[-1], 4001)
    drawn = curve(u)
    for point in points.T:
        assert np.hypot(*(drawn - point).T).min() < 2e-3
    np.testing.assert_allclose(np.hypot(*drawn.T), 2.0, atol=6e-3 if count > 6 else 2e-2)
    assert found.knots[-1] - found.knots[0] == pytest.approx(math.pi, rel=2e-3)  # its length
    np.testing.assert_allclose(np.hypot(*curve(u, 1).T), 1.0, atol=0.05)
    for end, leg, at in zip(ends, found.end_directions, (u[0], u[-1]), strict=True):
        slope = curve(at, 1)
        assert np.cross([*leg, 0.0], [*slope, 0.0])[2] == pytest.approx(0.0, abs=1e-9)
        if end is not None:
            np.testing.assert_allclose(slope, end / np.hypot(*end), atol=1e-9)
    np.testing.assert_allclose(drawn[[0, -1]], points.T[[0, -1]], atol=1e-12)


@pytest.mark.parametrize("ends", ENDS)
def test_a_smoothed_curve_keeps_ends_and_directions_and_stays_within_the_scatter(ends):
    points, scatter = arc(40, noise=0.01), 0.015
    found = smoothed(points, ends, scatter)
    u = np.linspace(found.knots[0], found.knots[-1], 8001)
    drawn = spline(found)(u)
    assert max(np.hypot(*(drawn - point).T).min() for point in points.T) <= scatter * 1.001
    np.testing.assert_allclose(drawn[[0, -1]], points.T[[0, -1]], atol=1e-9)
    for end, leg in zip(ends, found.end_directions, strict=True):
        if end is not None:
            assert np.cross([*end, 0.0], [*leg, 0.0])[2] == pytest.approx(0.0, abs=1e-9)


def test_the_fewer_the_pieces_the_wider_the_scatter_and_none_is_enough_for_too_small_a_one():
    points = arc(30, noise=0.01)
    wide, narrow = smoothed(points, (None, None), 0.02), smoothed(points, (None, None), 0.006)
    assert len(set(wide.knots)) == 2  # one piece
    assert len(set(narrow.knots)) > 3
    assert {round(step, 9) for step in np.diff(sorted(set(narrow.knots)))}.__len__() == 1  # of even length
    with pytest.raises(GeometryError, match=r"fillet.scatter"):
        smoothed(points, (None, None), 1e-9)
    few = smoothed(arc(3), (None, None), 1.0)  # of few points the degree is lower
    assert few.degree == 2


def test_a_smoothed_curve_misses_its_points_least_of_all_with_its_knots():
    points = arc(40, noise=0.01)
    found = smoothed(points, (None, None), 0.02)
    control, knots = np.array(found.control), np.array(found.knots)
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points)))])

    def missed(moved):
        return float(((BSpline(knots, moved, found.degree)(at) - points.T) ** 2).sum())

    least = missed(control)
    for i in range(1, len(control) - 1):  # the ends are kept
        for axis in (0, 1):
            for step in (1e-4, -1e-4):
                moved = control.copy()
                moved[i, axis] += step
                assert missed(moved) > least
