"""Places that an even grid and given places share: one each, whatever the last digit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.arrays import distinct

pytestmark = pytest.mark.last_bit


@given(st.integers(0, 10**6), st.floats(1e-6, 1e6), st.integers(2, 60))
def test_the_number_of_places_does_not_hang_on_the_last_digits(seed, length, count):
    """A deflection line of a shaft had 138 or 139 places for 1e-12 of its lengths."""
    rng = np.random.default_rng(seed)
    grid = np.linspace(0.0, length, count)
    met = rng.choice(grid, 3)
    noise = 1.0 + 1e-12 * rng.uniform(-1.0, 1.0, 3)
    exact, moved = distinct(met, grid), distinct(met * noise, grid * (1.0 - 1e-12))
    assert exact.size == moved.size == count
    np.testing.assert_allclose(exact, moved, rtol=0, atol=1e-11 * length)


def test_of_the_same_places_the_first_given_stays():
    given_first, grid = np.array([0.1 + 1e-13, 0.7]), np.array([0.0, 0.1, 0.7 - 1e-12, 1.0])
    assert distinct(given_first, grid).tolist() == [0.0, 0.1 + 1e-13, 0.7, 1.0]
    assert distinct([2.0]).tolist() == [2.0]
    assert distinct([1.0, 1.0, 1.0]).tolist() == [1.0]
