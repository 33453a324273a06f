"""Roll positions that a moving picture of the stress in mesh needs."""

import numpy as np
import pytest

from fegear.results.pair.stress_in_mesh import _moments, picture_positions


def test_both_sides_of_every_jump_the_ends_and_the_one_asked_for_are_kept():
    roll = np.array([0.0, 1e-7, 0.001, 0.002, 0.003, 0.3, 0.3 + 1e-7, 0.301, 0.9, 0.9 + 1e-7])
    assert picture_positions(roll, 1.0, 0.002).tolist() == [0, 1, 3, 5, 6, 8, 9]
    assert picture_positions(roll, 1.0, 9.0).tolist() == [0, 1, 5, 6, 8, 9]


def test_even_positions_are_thinned_to_the_step():
    roll = np.linspace(0.0, 1.0, 1001)
    chosen = picture_positions(roll, 1.0, -1.0)
    assert (chosen[0], chosen[-1]) == (0, 1000)
    gaps = np.diff(chosen)
    assert set(gaps[:-1]) == {19, 20}  # 0.019 of a pitch, or one more where that rounds up


@pytest.mark.parametrize("start", [-3.7, 0.0, 0.35, 2.0])
def test_a_picture_shows_a_whole_pitch_with_both_its_ends_enclosed(start):
    roll, pitch = np.linspace(0.0, 0.9, 10), 1.0
    found = _moments(roll, start, pitch)
    assert (np.diff(found.roll) > 0.0).all()
    assert found.roll == pytest.approx(roll[found.position] + found.on * pitch)
    assert start - 0.1 < found.roll[0] + 1e-12
    assert found.roll[0] <= start
    assert start + pitch <= found.roll[-1]
    assert found.roll[-1] < start + pitch + 0.1
