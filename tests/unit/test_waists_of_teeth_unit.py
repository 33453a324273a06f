"""How many Gauss nodes a thin waist takes: poles of 1/x^3 beside the fillet, of parabolas and straight lines."""

from __future__ import annotations

import math
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.formulas.beam import _LOG_RHO, _MOST_TIMES, _nodes_for_waist


def tooth(x, end=1.0):
    return Space(fillet=Space(end=end, points=lambda u: (x(u), 0.0 * u)))


def rho(pole, start, end):
    """Sum of half axes of the ellipse about an interval with a pole on it."""
    z = (pole - 0.5 * (start + end)) / (0.5 * (end - start))
    return max(abs(z + sign * np.sqrt(z * z - 1.0 + 0j)) for sign in (1.0, -1.0))


def nodes(found, pole, start, end):
    times = math.ceil(_LOG_RHO / math.log(rho(pole, start, end)))
    assert found == 16 * min(max(times, 1), _MOST_TIMES)
    return found // 16


@pytest.mark.parametrize(("start", "end"), [(-3.0, 1.0), (1.0, -3.0), (-1.0, 1.0)])
@pytest.mark.parametrize(("waist", "times"), [(1e-9, 32), (2e-3, None), (0.02, None), (0.5, 1), (5.0, 1)])
def test_below_a_waist_inside_the_pole_lies_where_the_parabola_vanishes(start, end, waist, times):
    middle = 0.5 * (start + end)  # 0.3 u^2 + waist = 0 at u = i sqrt(waist / 0.3)
    found = _nodes_for_waist(tooth(lambda u: waist + 0.3 * (u - middle) ** 2, end), start, 16)
    assert nodes(found, middle + 1j * math.sqrt(waist / 0.3), start, end) == (times or found // 16)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("waist", [1e-9, 0.01, 0.1, 3.0])
def test_at_an_end_the_pole_lies_where_the_straight_tooth_vanishes(sense, waist):
    found = _nodes_for_waist(tooth(lambda u: waist + 0.4 * (1.0 - sense * u) / 2.0, 1.0), -1.0, 16)
    nodes(found, sense * (1.0 + waist / 0.2), -1.0, 1.0)


def test_a_tooth_of_even_width_takes_what_is_asked_for():
    assert _nodes_for_waist(tooth(lambda u: 0.8 + 0.0 * u), -1.0, 12) == 12
