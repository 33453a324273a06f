"""Cutting planes against scipy's linear programmes and a simplex search, and the slopes that they are fed with."""

import numpy as np
import pytest
from scipy.optimize import linprog, minimize

from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.relief_bench import bench
from fegear.design.tip_relief.cutting_planes import least_in_box
from fegear.design.tip_relief.trials import Trials
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair

RNG = np.random.default_rng(7)
BASE, SLOPE = RNG.normal(size=(6, 50)), RNG.normal(size=(6, 4, 50)) * np.array([0.1, 0.5, 1.0, 2.0])[:, None]
BOX = np.ones((6, 4))


def seen(x):
    return BASE + (x[:, None] @ SLOPE)[:, 0]


def extent(x):
    y, rows = seen(x), np.arange(6)
    high, low = y.argmax(axis=1), y.argmin(axis=1)
    return y[rows, high] - y[rows, low], SLOPE[rows, :, high] - SLOPE[rows, :, low]


def norm(x):
    y = seen(x)
    size = np.sqrt((y**2).sum(axis=1))
    return size, (SLOPE @ (y / size[:, None])[:, :, None])[..., 0]


def test_the_least_extent_is_that_of_a_linear_programme():
    x, found, bound = least_in_box(extent, -0.3 * BOX, 0.7 * BOX, 1e-12, 300)
    assert (x >= -0.3 - 1e-9).all()
    assert (x <= 0.7 + 1e-9).all()
    np.testing.assert_allclose(found, extent(x)[0], rtol=1e-14)
    for k in range(6):
        rows = np.block(
            [[SLOPE[k].T, -np.ones((50, 1)), np.zeros((50, 1))], [-SLOPE[k].T, np.zeros((50, 1)), np.ones((50, 1))]]
        )
        limits = [(-0.3, 0.7)] * 4 + [(None, None)] * 2
        programme = linprog([0.0] * 4 + [1.0, -1.0], rows, np.concatenate([-BASE[k], BASE[k]]), bounds=limits)
        assert found[k] == pytest.approx(programme.fun, rel=1e-9)
        assert bound[k] == pytest.approx(programme.fun, rel=1e-9)


def test_a_smooth_function_is_bounded_as_closely_as_asked():
    _, found, bound = least_in_box(norm, -BOX, BOX, 1e-5, 300)
    for k in range(6):
        one = minimize(
            lambda p, k=k: np.linalg.norm(BASE[k] + p @ SLOPE[k]), np.zeros(4), bounds=[(-1, 1)] * 4, tol=1e-12
        )
        assert bound[k] <= one.fun * (1.0 + 1e-9)
        assert found[k] == pytest.approx(one.fun, rel=1e-4)


def test_a_box_without_extent_keeps_its_point():
    x, found, _ = least_in_box(extent, np.zeros((6, 4)), np.zeros((6, 4)), 1e-9)
    np.testing.assert_allclose(x, 0.0, atol=1e-12)
    np.testing.assert_allclose(found, extent(x)[0])


@pytest.mark.parametrize("power", [1.0, 2.0])
@pytest.mark.parametrize("metric", ["peak_to_peak", "effective_error"])
def test_slopes_of_tip_reliefs_are_those_of_differences(metric, power):
    """Two loads; the starts of straight relief, and the pairs that hand over, move with the numbers."""
    gears = [Gear(Tooth(z), 3e-3, 0.05 * z * 3e-3, 0.03) for z in (28, 31)]
    sources = [closed_form_compliance(gear, "cornell") for gear in gears]
    pair = Engagement(PairCompliance(GearPair(*gears), *sources, hertz="linear", nominal_load=9000.0))
    trials = Trials(bench(pair, 5, 6), np.array([6000.0, 9000.0]), power, metric)
    p = np.random.default_rng(3).uniform([5e-6, 0.1, 5e-6, 0.1], [40e-6, 0.6, 40e-6, 0.6], (40, 4))
    for evaluate in (trials.rough, trials.exact):
        value, slope = trials.tangent(evaluate(p), np.zeros_like(p))
        low = None if metric == "effective_error" else evaluate(p).low
        np.testing.assert_allclose(value, trials.left(evaluate(p).seen, low), rtol=1e-13)
        for k in range(4):
            step = 1e-6 * p * (np.arange(4) == k)
            both = [trials.tangent(evaluate(p + sign * step), np.zeros_like(p))[0] for sign in (1.0, -1.0)]
            off = np.abs((both[0] - both[1]) / 2e-6 - slope[:, k] * p[:, k]) / value
            if metric == "effective_error" and evaluate == trials.exact:
                # How the jumps of kinks change is neglected in slopes, which lead the way; values, from whose
                # differences the end is found, count them.
                assert off.max() < 3e-3
                assert np.median(off) < 1e-4
                continue
            # A difference across a kink, or a set of pairs that the exact sharing loads a little otherwise.
            assert np.mean(off > 1e-4) <= (0.0 if evaluate == trials.rough else 0.1), (k, off.max())
