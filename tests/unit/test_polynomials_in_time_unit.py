"""Polynomials of one step of a motion, uncompiled: against numpy's values, roots and dense samples."""

import numpy as np
import pytest
from numpy.polynomial import polynomial

from fegear.dynamics.motion.kernel.polynomials import (
    _load,
    _root,
    first_crossing,
    largest_force,
    shift_in_time,
    slope_at,
    value_at,
)

SEEDS = range(12)


@pytest.mark.parametrize("seed", SEEDS)
def test_values_slopes_and_shifts_are_those_of_the_polynomial(seed):
    chance = np.random.default_rng(seed)
    row, t, v, scale = chance.normal(size=5), *chance.uniform(0.2, 2.0, 3)
    assert value_at(row, t) == pytest.approx(polynomial.polyval(t, row))
    assert slope_at(row, t) == pytest.approx(polynomial.polyval(t, polynomial.polyder(row)))
    shift_in_time(row, v, scale, out := np.empty(5))
    assert polynomial.polyval(t, out) == pytest.approx(polynomial.polyval(v + scale * t, row))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("seed", SEEDS)
def test_a_root_is_where_the_polynomial_falls_through_zero(seed, sign):
    chance = np.random.default_rng(seed)
    root = chance.uniform(0.2, 0.8)
    steep = polynomial.polymul([1.0, *chance.uniform(0.1, 2.0, 2)], [root, -1.0])
    found = _root(sign * steep, 0.0, 1.0, sign)
    assert found == pytest.approx(root, rel=1e-13)
    assert sign * value_at(sign * steep, found) <= 0.0  # not a last digit before it: what closes there is closed


def test_a_root_that_steps_of_newton_leave_is_the_one_of_the_interval():
    """Flat in the middle: the steps lead out of the interval, where other roots are; halving stays inside."""
    chance = np.random.default_rng(5)
    for _ in range(60):
        low, high = chance.uniform(0.5, 0.6), chance.uniform(0.7, 0.8)
        root, below = chance.uniform(low, high), chance.uniform(0.1, 0.45, 2)
        flat = 0.5 * (low + high) + 1e-3 * chance.normal()
        row = polynomial.polymul(polynomial.polyfromroots([root, *below]), [flat**2 + 1e-5, -2.0 * flat, 1.0])
        sign = 1.0 if value_at(row, low) > 0.0 else -1.0
        assert _root(row, low, high, sign) == pytest.approx(root, rel=1e-9)


def wanted(row, h, sign, moment):
    """The first real root in (0, h] at which sign * row falls, by numpy."""
    roots = polynomial.polyroots(row)
    real = np.sort(roots.real[np.abs(roots.imag) < 1e-9])
    falls = [t for t in real if moment < t <= h and sign * slope_at(row, t) < 0.0]
    return falls[0] if falls else -1.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("seed", range(40))
def test_the_first_crossing_is_the_first_falling_root(seed, sign):
    chance = np.random.default_rng(seed)
    row = sign * polynomial.polyfromroots(chance.uniform(-0.5, 2.0, 4))
    row = row if sign * row[0] > 0.0 else -row
    h = chance.uniform(0.3, 1.5)
    assert first_crossing(row, h, sign, 1e-6) == pytest.approx(wanted(row, h, sign, 1e-6), rel=1e-9)


def test_a_dip_between_samples_is_found_and_what_only_comes_near_is_none():
    for depth, crosses in ((1e-4, True), (-1e-4, False)):
        for bottom in (0.021, 0.53):  # in the first interval, and between later samples
            row = np.array([bottom**2 - depth, -2.0 * bottom, 1.0])
            found = first_crossing(row, 1.0, 1.0, 1e-6)
            assert found == pytest.approx(bottom - depth**0.5 if crosses else -1.0, rel=1e-9)


def test_what_stands_at_zero_is_looked_at_a_moment_later():
    assert first_crossing(np.array([-1e-15, 1.0]), 1.0, 1.0, 1e-6) == -1.0  # opens
    assert first_crossing(np.array([1e-15, -1.0]), 1.0, 1.0, 1e-6) == pytest.approx(1e-15)  # closes in its own time
    assert first_crossing(np.array([-1e-15, -1.0]), 1.0, 1.0, 1e-6) == 0.0
    assert first_crossing(np.array([5e-7, -1.0]), 1e-7, 1.0, 1e-6) == -1.0  # after the end of the step
    assert first_crossing(np.array([2e-6, -1.0]), 1e-6, 1.0, 1e-6) == -1.0
    assert first_crossing(np.array([3.0, -1.0, -1.0]), 1.0, 1.0, 1e-6) == -1.0  # can not reach zero
    assert first_crossing(np.array([2.0, -1.0, -1.0]), 1.0, 1.0, 1e-6) == pytest.approx(1.0)


def test_a_spring_carries_its_part_of_the_force_with_damping():
    force, slide = np.array([[3.0, 1.0], [1.0, -2.0], [9.0, 0.0]]), np.array([[0.0, 0.0], [2.0, 1.0]])
    mesh_of = np.array([1, 1, 0])
    assert _load(force, slide, 3, mesh_of, 1, -1, 0.25, 1.0) == pytest.approx(3.25 + 0.5 + 2.25)
    assert _load(force, slide, 3, mesh_of, 1, 0, 0.25, 1.0) == pytest.approx(3.25 / 3.75 * 6.0)
    assert _load(force, slide, 3, mesh_of, 1, 1, 1.0, 1.0) == 0.0  # it pulls
    assert _load(force, slide, 3, mesh_of, 1, 1, 1.0, -1.0) == pytest.approx(6.0)  # on the other flank it alone pushes
    assert _load(force, slide, 3, mesh_of, 0, 1, 1.0, 1.0) == 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("seed", SEEDS)
def test_the_largest_force_over_a_step_is_that_of_dense_samples(seed, sign):
    chance = np.random.default_rng(seed)
    force, slide, h = chance.normal(size=(2, 4)), chance.normal(size=(1, 4)), chance.uniform(0.5, 1.5)
    of = np.zeros(2, dtype=int)
    dense = max(sign * _load(force, slide, 2, of, 0, -1, t, sign) for t in np.linspace(0.0, h, 2001))
    found = largest_force(force, slide, 2, of, 0, -1, h, sign)
    assert dense - 1e-12 <= found <= dense + 1e-5
