"""The reliefs that a design of flanks tries where the case names none, and positions with both sides of a change."""

import numpy as np
import pytest

from fegear.design.flanks.grid import usual_grid
from fegear.design.tip_relief.kinks import Positions


def test_amounts_are_parts_of_the_deepest_relief_and_lengths_of_path_and_face():
    grid = usual_grid(10.0, 16.0, 20.0, 9.0)
    assert grid.tip_amounts == pytest.approx((5.0, 8.5, 12.0))
    assert grid.tip_lengths == pytest.approx((7.0, 8.0))  # half the path, and what two pairs share of it
    assert grid.crownings == pytest.approx((1.0, 2.5))
    assert grid.end_amounts == pytest.approx((1.5, 4.0))
    assert grid.end_lengths == pytest.approx((3.0, 7.0))
    assert grid.slopes == pytest.approx((-1.0, 1.0))
    assert grid.biases == pytest.approx((-10.0, -4.0, 4.0, 10.0))
    assert usual_grid(10.0, 16.0, 20.0, 15.9).tip_lengths == pytest.approx((1.6, 8.0))  # no shorter than a tenth
    assert usual_grid(10.0, 16.0, 20.0, 1.0).tip_lengths == pytest.approx((8.0, 14.4))  # no longer than nine


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_an_interval_between_both_sides_of_a_change_is_known_by_its_part_of_the_period(scale):
    x = scale * np.array([0.0, 1.0, 1.0 + 1e-7, 3.0, 3.0 + 2e-5, 4.0])
    assert Positions(x, 9.0 * scale, np.full(6, 2)).whole.tolist() == [True, False, True, True, True]
