"""Drawn responses reach every peak and every zero of functions whose peaks and zeros are known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.dynamics.train.resolved_response import BEND, SHORTEST, broken, resolved_grid


def oscillator(x, natural, zeta):
    return np.abs(1.0 / (natural**2 - x**2 + 2j * zeta * natural * x))[:, None]


@pytest.mark.parametrize("zeta", [0.1, 1e-2, 1e-3, 1e-4])
def test_a_peak_much_narrower_than_the_grid_is_drawn_to_its_top_and_true_between(zeta):
    natural, coarse = 0.7321, np.linspace(0.0, 2.0, 21)
    x = resolved_grid(lambda p: oscillator(p, natural, zeta), coarse, [natural])
    y = oscillator(x, natural, zeta)[:, 0]
    exact = 1.0 / (2.0 * zeta * np.sqrt(1.0 - zeta**2) * natural**2)
    assert y.max() == pytest.approx(exact, rel=0.02)
    between = np.linspace(0.0, 2.0, 40_001)
    drawn = np.exp(np.interp(between, x, np.log(y)))
    assert np.abs(np.log(drawn / oscillator(between, natural, zeta)[:, 0])).max() < 4.0 * BEND
    assert x.size < 600


@given(st.floats(0.05, 1.95), st.floats(0.05, 1.95))
def test_an_undamped_pole_parts_the_line_and_a_zero_goes_deep(pole, zero):
    grid = np.linspace(0.0, 2.0, 50)
    x = resolved_grid(lambda p: np.abs((p - zero) / (p - pole))[:, None], grid, undamped=[pole])
    assert pole not in x
    assert np.isfinite(x).all()
    assert (np.diff(x) > 0.0).all()
    y = np.abs((x - zero) / (x - pole))
    if abs(pole - zero) > 1e-3:
        assert y.max() > 1e3 * abs(pole - zero)
        assert y.min() < 1e-4 / abs(pole - zero)
    drawn_x, drawn_y = broken(x, y, [pole])
    (gap,) = np.flatnonzero(np.isnan(drawn_y))
    assert drawn_x[gap] == pole
    assert drawn_x[gap - 1] < pole < drawn_x[gap + 1]


def test_what_is_straight_or_only_round_off_costs_nothing():
    grid = np.linspace(1.0, 2.0, 30)
    noise = np.random.default_rng(1)

    def response(p):
        return np.stack([np.exp(3.0 * p), 1e-20 + 0.0 * p, np.zeros_like(p), 1e-13 * noise.random(p.size)], axis=1)

    assert resolved_grid(lambda p: response(p)[:, :3], grid).size == 2 * grid.size - 1
    assert resolved_grid(lambda p: np.stack([np.exp(p), np.where(p > 1.5, 1.0, 1e-14 * noise.random(p.size))], 1),
                         grid).size < 300  # fmt: skip


def test_poles_outside_or_upon_the_ends_do_no_harm():
    grid = np.linspace(0.0, 1.0, 11)
    x = resolved_grid(lambda p: 1.0 / np.abs(p + 1e-9)[:, None], grid, [5.0], [-1.0, 0.0, 2.0])
    assert np.isfinite(x).all()
    assert x[0] > 0.0
    assert broken(x, np.ones(x.size), [0.0, 7.0])[0].size == x.size
    three, places = np.array([0.0, 1.0, 2.0]), [1.7, 0.0, 0.2, 2.0]
    assert broken(three, three, places)[0].tolist() == [0.0, 0.2, 1.0, 1.7, 2.0]


@pytest.mark.parametrize("pole", [0.1, 0.9, 1.7])
def test_a_pole_is_approached_as_near_from_either_side(pole):
    """By a millionth of the range, also where the grid itself has a point upon it or nearer."""
    for low, high in ((0.0, 2.0), (-3.0, 2.0), (0.05, 1.75)):
        near = SHORTEST * (high - low)
        grid = np.sort(np.concatenate([np.linspace(low, high, 41), pole + near * np.array([-1.5, -0.4, 0.4])]))
        x = resolved_grid(lambda p: (1.0 / np.abs(p - pole))[:, None], grid, undamped=[pole])
        off = x - pole
        assert -off[off < 0.0].max() == pytest.approx(near, rel=1e-6)
        assert off[off > 0.0].min() == pytest.approx(near, rel=1e-6)
        assert (x[0], x[-1]) == (low, high)


def test_the_unit_of_an_amplitude_does_not_matter_nor_what_is_small_beside_others():
    """Down into a zero to a thousand millionth of the usual amplitude; below that, and below 1e-12 of others, not."""
    grid, noise = np.linspace(0.0, 2.0, 30), np.random.default_rng(3)

    def response(p, small):
        hit = np.where(p > 0.6, np.abs((p - 1.3217) / (p - 0.3)), 1e-11 * noise.random(p.size))
        return np.stack([hit, small * (2.0 + np.sin(300.0 * p))], axis=1)

    usual = resolved_grid(lambda p: response(p, 1e-14), grid)
    for unit in (1e-9, 1e9):
        np.testing.assert_array_equal(resolved_grid(lambda p, unit=unit: unit * response(p, 1e-14), grid), usual)
    assert usual.size < 500
    assert np.diff(usual).min() <= SHORTEST * 2.0
    assert resolved_grid(lambda p: response(p, 1e-11), grid).size > 1000


def test_intervals_beside_bends_are_looked_at_again_and_the_search_ends(monkeypatch):
    """A kink off the middle of a cell: its halves bend on and on, down to a millionth of the range, not beyond."""
    kink = 0.3217
    asked = []

    def response(p):
        asked.append(p.size)
        return np.exp(np.where(p > kink, 40.0 * (p - kink), 0.0))[:, None]

    x = resolved_grid(response, np.linspace(0.0, 1.0, 4))
    drawn = np.interp(np.linspace(0.0, 1.0, 5001), x, np.log(response(x)[:, 0]))
    exact = 40.0 * np.maximum(np.linspace(0.0, 1.0, 5001) - kink, 0.0)
    assert np.abs(drawn - exact).max() < 4.0 * BEND
    assert x.size < 70
    assert sum(asked[:-1]) < 120  # what is straight is looked at once
    jump = resolved_grid(lambda p: np.where(p > kink, 1.0, 2.0)[:, None], np.linspace(0.0, 1.0, 4))
    assert 0.5 * SHORTEST < np.diff(jump).min() <= SHORTEST
    monkeypatch.setattr("fegear.dynamics.train.resolved_response._MOST", 50)
    many = resolved_grid(lambda p: (2.0 + np.sin(1e5 * p))[:, None], np.linspace(0.0, 1.0, 40))
    assert 50 < many.size <= 100
