"""Rules of quadrature that are written out: their places and weights by what they integrate exactly."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.fourier import panels
from fegear.dynamics.planetary import cycle_extremes, planet_loads, set_cycle
from fegear.dynamics.planetary.cycle_extremes import _highest


@pytest.mark.parametrize(
    ("rule", "degree", "lower"), [(set_cycle._FIVE, 7, 3), (set_cycle._THREE, 3, 1)], ids=["five", "three"]
)
def test_lobatto_s_rules_integrate_what_they_can(rule, degree, lower):
    """And the rule on every other point integrates what that one can."""
    places, weights, fewer = rule
    assert places[0] == -places[-1] == -1.0
    for n in range(degree + 1):
        exact = (1.0 - (-1.0) ** (n + 1)) / (n + 1)
        assert weights @ places**n == pytest.approx(exact, abs=1e-14)
        if n <= lower:
            assert fewer @ places**n == pytest.approx(exact, abs=1e-14)
    assert abs(weights @ places ** (degree + 1) - 2.0 / (degree + 2)) > 1e-3
    assert (fewer[1::2] == 0.0).all()


def test_a_kink_between_points_is_no_top_of_a_parabola():
    points = panels(0.0, 1.0, [0.3], waves=12, ends=True)
    kinked = replace(points, kinks=True)
    for top in np.linspace(0.4, 0.9, 41):
        kink = 2.0 - np.where(points.x > top, 1.5 * (points.x - top), top - points.x)
        assert kink.max() <= kinked.highest(kink) <= 2.0 + 1e-12
        wave = np.cos(5.0 * (points.x - top))
        assert kinked.highest(wave) == points.highest(wave) == pytest.approx(1.0, abs=1e-5)
    steep = [2.0 - np.where(points.x > at, 20.0 * (points.x - at), at - points.x) for at in np.linspace(0.4, 0.9, 41)]
    assert max(map(points.highest, steep)) > 2.01  # what is prevented
    assert max(map(kinked.highest, steep)) <= 2.0 + 1e-12
    jump = np.where(points.x > 0.3, 1.0 - points.x, points.x)
    assert kinked.highest(jump) == points.highest(jump)
    flat = np.zeros_like(points.x)
    assert kinked.highest(flat) == 0.0


def test_loads_of_planets_lie_on_the_same_places():
    np.testing.assert_allclose(planet_loads._LOBATTO, set_cycle._FIVE[0], atol=1e-15)


def test_points_of_a_part_carry_its_polynomial_and_its_mean():
    points, shares = cycle_extremes._POINTS, cycle_extremes._SHARES
    assert points[[0, -1]].tolist() == [-1.0, 1.0]
    for n in range(10):
        mean = 0.5 * (1.0 - (-1.0) ** (n + 1)) / (n + 1)
        assert shares @ points**n == pytest.approx(mean, abs=1e-14)
        assert points**n @ cycle_extremes._COARSE.T == pytest.approx(cycle_extremes._LOOKED_AT**n, abs=1e-12)
    looked = cycle_extremes._LOOKED_AT
    assert looked[[0, -1]].tolist() == [-1.0, 1.0]
    assert np.diff(looked) == pytest.approx(np.full(looked.size - 1, 2.0 / (looked.size - 1)))


def test_the_highest_of_a_polynomial_at_an_end_in_the_middle_and_beside_an_end():
    points = cycle_extremes._POINTS
    for top in (-1.0, -0.98, 0.0, 0.3, 0.99, 1.0):
        wave = 5.0 - (points - top) ** 2
        value, part, place = _highest(np.array([[np.zeros_like(points), wave]]))
        assert value == pytest.approx([5.0], abs=1e-12)
        assert part.tolist() == [1]
        assert place == pytest.approx([top], abs=1e-9)
    rising = np.exp(points)
    value, _, place = _highest(np.array([[rising], [-rising]]))
    assert value == pytest.approx([math.e, -1.0 / math.e], rel=1e-8)
    assert place == pytest.approx([1.0, -1.0])
