"""Extreme values between roll positions: kinks, jumps and what is smooth."""

import numpy as np
import pytest

from fegear.contact.between_positions import between_positions

PERIOD, COUNT = 4.0, 24


def curve(x, jump, slope=0.0):
    """Rises to a place between positions and falls from there: by a kink, and by a jump."""
    x = np.mod(x, PERIOD)
    return np.where(x < jump, x, jump - slope - 3.0 * (x - jump))


def searched(values, rounds=4):
    """Largest value at the positions that are looked at one after the other, and what is stated to be left."""
    x = np.linspace(0.0, PERIOD, COUNT, endpoint=False)
    for _ in range(rounds):
        places, height = between_positions(x, values(x), PERIOD, 1.0)
        if height.max() <= 0.0:
            break
        x = np.unique(np.append(x, places[int(height[:, 0].argmax())].ravel()))
    return float(values(x).max()), max(float(between_positions(x, values(x), PERIOD, 1.0)[1].max()), 0.0), x


@pytest.mark.parametrize("slope", [0.0, 2.0])
@pytest.mark.parametrize("jump", [1.03, 1.1, 2.57, 3.9])
def test_the_largest_of_a_curve_with_a_kink_or_a_jump_is_found_or_stated(jump, slope):
    def values(x):
        return curve(x, jump, slope)

    coarse = float(values(np.linspace(0.0, PERIOD, COUNT, endpoint=False)).max())
    best, left, _ = searched(values)
    assert best >= coarse
    assert jump - best <= 1.05 * left + 1e-9
    assert jump - best < 0.02


def test_smooth_curves_are_left_alone_but_for_their_tops():
    best, left, x = searched(lambda x: np.sin(2.0 * np.pi * x / PERIOD))
    assert best == pytest.approx(1.0, abs=1e-3)
    assert left < 0.02
    assert x.size < COUNT + 12


def test_positions_on_both_sides_of_a_place_are_one_where_nothing_jumps():
    """Line breaks have two; the kink stands beside them."""
    x = np.sort(np.append(np.linspace(0.0, PERIOD, COUNT, endpoint=False), [1.0 - 1e-8, 1.0 + 1e-8]))
    x = x[np.abs(x - 1.0) > 1e-12]
    values = curve(x, 1.05)
    places, height = between_positions(x, values, PERIOD, 1.0)
    best = int(height[:, 0].argmax())
    assert 1.05 - values.max() <= height[best, 0] * (1.0 + 1e-6) < 0.1
    assert places[best, 0, 0] == pytest.approx(1.05, abs=1e-6)
