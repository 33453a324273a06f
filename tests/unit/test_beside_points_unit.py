"""How far places lie beside the line through fitted points."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fegear.geometry.fitted_points import _beside


@pytest.mark.parametrize("turned", [0.0, 0.4, 1.2, 2.9])
def test_the_distance_beside_a_line_is_the_same_however_the_line_is_turned(turned):
    turn = np.array([[math.cos(turned), -math.sin(turned)], [math.sin(turned), math.cos(turned)]])
    along = np.stack([np.linspace(0.0, 3.0, 7), np.zeros(7)])
    off = np.stack([np.linspace(-1.0, 1.0, 7), np.array([0.3, -0.2, 0.0, 0.1, -0.4, 0.5, -0.6])], axis=1)
    assert _beside(off @ turn.T, turn @ along) == pytest.approx(np.abs(off[:, 1]), abs=1e-12)
