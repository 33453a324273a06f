"""ISO 6336-1's face load factors: against a row of springs that a straight gap keeps apart, and the exponent's ends."""

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.formulas.iso6336.part1_face_load import face_load_factor, root_exponent

STIFFNESS, LOAD = 15e9, 300e3


def by_springs(gap, stiffness, line_load, count=200_001):
    """Largest over mean load of springs along the face, the approach found by bisection."""
    apart = np.linspace(0.0, abs(gap), count)
    low, high = 0.0, abs(gap) + 2.0 * line_load / stiffness
    for _ in range(200):
        middle = 0.5 * (low + high)
        pressed = stiffness * np.maximum(middle - apart, 0.0)
        low, high = (middle, high) if np.trapezoid(pressed, dx=1.0 / (count - 1)) < line_load else (low, middle)
    return pressed.max() / line_load


@pytest.mark.parametrize("gap", [0.0, 1e-6, -10e-6, 39.99e-6, 40.01e-6, 120e-6])
def test_the_factor_is_that_of_a_row_of_springs(gap):
    assert face_load_factor(gap, STIFFNESS, LOAD) == pytest.approx(by_springs(gap, STIFFNESS, LOAD), rel=1e-5)


def test_both_branches_meet_at_two():
    assert face_load_factor(2.0 * LOAD / STIFFNESS, STIFFNESS, LOAD) == pytest.approx(2.0, rel=1e-12)


def test_the_exponent_of_root_stress():
    assert root_exponent((1.0, 1.0), (1e-6, 1e-6)) == pytest.approx(1.0, abs=1e-5)
    # b/h = 3 at least: 9 / 13
    assert root_exponent((3.0, 3.0), (1.0, 1.0)) == pytest.approx(9.0 / 13.0, rel=1e-12)
    assert root_exponent((1.0, 9.0), (1.0, 1.0)) == root_exponent((3.0, 3.0), (1.0, 1.0))
    assert root_exponent((10.0, 8.0), (2.0, 2.0)) == pytest.approx(16.0 / 21.0, rel=1e-12)


def test_nonsense_is_refused():
    for bad in ((1e-6, 0.0, LOAD), (1e-6, STIFFNESS, -1.0)):
        with pytest.raises(RangeError, match="positive"):
            face_load_factor(*bad)
    with pytest.raises(RangeError, match="positive"):
        root_exponent((1.0, 1.0), (1.0, 0.0))
