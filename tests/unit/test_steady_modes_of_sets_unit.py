"""Steady motion of modes under forces that are polynomial in pieces: against another integrator over a period."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from fegear.base.errors import RangeError
from fegear.dynamics.planetary.steady_modes import on_common_pieces, steady_modes
from fegear.dynamics.train.periodic import Periodic

NATURAL = np.array([5.0, 37.0])
WIDTHS = np.array([0.3, 0.5, 0.2])
FORCES = np.array([
    [[1.0, 0.4, -0.3], [-0.8, 0.2, 0.5], [0.1, -1.2, 0.0]], [[-0.5, 0.0, 0.7], [0.6, 0.9, 0.0], [2.0, 0.3, -0.4]],
])  # fmt: skip


def swung(natural, damping_ratio, period, rows):
    """Displacements at five places of every piece, by the state that comes back after a period."""
    matrix = np.array([[0.0, 1.0], [-(natural**2), -2.0 * damping_ratio * natural]])

    def over(state, places):
        found = []
        for width, row in zip(WIDTHS * period, rows, strict=True):

            def slope(t, y, row=row, width=width):
                return matrix @ y + np.array([0.0, np.polynomial.polynomial.polyval(2.0 * t / width - 1.0, row)])

            run = solve_ivp(
                slope, (0.0, width), state, "DOP853", t_eval=0.5 * width * (places + 1.0), rtol=1e-9, atol=1e-13
            )  # fmt: skip
            found.append(run.y[0])
            state = run.y[:, -1]
        return state, np.array(found)

    places = np.linspace(-1.0, 1.0, 5)
    from_rest, _ = over(np.zeros(2), places)
    start = np.linalg.solve(np.eye(2) - expm(matrix * period), from_rest)
    after, found = over(start, places)
    assert after == pytest.approx(start, rel=1e-6, abs=1e-9)
    return places, found


@pytest.mark.parametrize("damping_ratio", [0.0, 0.04])
def test_modes_swing_as_another_integrator_has_them(damping_ratio):
    periods = np.array([0.11, 0.9])  # pieces short beside a vibration, and long
    modes = steady_modes(NATURAL, damping_ratio, periods, WIDTHS, FORCES)
    assert len(modes) == 2
    for period, found in zip(periods, modes, strict=True):
        for j, natural in enumerate(NATURAL):
            v, expected = swung(natural, damping_ratio, period, FORCES[j])
            at = found.at(np.arange(3), np.tile(v, (3, 1)))
            assert at.shape == (2, 3, 5)
            assert at[j] == pytest.approx(expected, abs=2e-7 * np.abs(expected).max())


def test_a_constant_force_is_its_static_deflection_at_every_period():
    forces = np.zeros((2, 3, 3))
    forces[:, :, 0] = np.array([[2.0], [-3.0]])
    for one in steady_modes(NATURAL, 0.1, np.array([1e-3, 0.4, 200.0]), WIDTHS, forces):
        found = one.at(np.arange(3), np.tile([-1.0, 0.2, 1.0], (3, 1)))
        assert found[0] == pytest.approx(2.0 / 25.0)
        assert found[1] == pytest.approx(-3.0 / 37.0**2)


def test_a_harmonic_at_a_natural_frequency_is_refused_without_damping_only():
    for harmonic in (1, 7):
        period = np.array([0.3, 2.0 * math.pi * harmonic / 5.0])
        with pytest.raises(RangeError, match="natural frequency of the undamped"):
            steady_modes(NATURAL, 0.0, period, WIDTHS, FORCES)
        assert len(steady_modes(NATURAL, 0.0, period * (1.0 + 1e-6), WIDTHS, FORCES)) == 2
        assert len(steady_modes(NATURAL, 1e-3, period, WIDTHS, FORCES)) == 2
    # Far below its first harmonic a mode has none to meet.
    assert len(steady_modes(NATURAL, 0.0, np.array([1e-14]), WIDTHS, FORCES)) == 1


def saw(breaks, rise):
    """A jump at every break point but the first."""
    return Periodic.fit(lambda s: np.searchsorted(breaks[1:-1], s % 1.0) + rise * (s % 1.0) ** 2, np.array(breaks))


def test_functions_on_common_pieces_are_what_they_are_each_behind_by_its_delay():
    functions = saw([0.0, 0.35, 1.0], 0.5), saw([0.0, 0.2, 0.6, 1.0], -1.0)
    delays = np.array([0.1, 0.75])
    pieces = on_common_pieces(functions, delays)
    # 0.1 and 0.45 of the first; 0.75, 0.95 and 1.35 of the second.
    assert pieces.starts == pytest.approx([0.1, 0.35, 0.45, 0.75, 0.95])
    assert pieces.widths == pytest.approx([0.25, 0.1, 0.3, 0.2, 0.15])
    v = np.tile([-0.97, -0.3, 0.5, 0.99], (5, 1))
    place = pieces.starts[:, None] + 0.5 * pieces.widths[:, None] * (v + 1.0)
    for found, one, late in zip(pieces.at(np.arange(5), v), functions, delays, strict=True):
        assert found == pytest.approx(one(place - late) - one.mean, abs=1e-9)


def test_break_points_that_differ_by_round_off_are_one():
    one = saw([0.0, 0.35, 1.0], 0.5)
    pieces = on_common_pieces((one, one), np.array([0.0, 1.0 - 1e-11]))
    assert pieces.starts == pytest.approx([0.0, 0.35], abs=1e-9)
    assert pieces.widths == pytest.approx([0.35, 0.65], abs=1e-9)
