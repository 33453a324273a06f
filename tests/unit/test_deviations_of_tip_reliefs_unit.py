"""Tip reliefs off their depth on teeth off their pitch, over the face; and where breaks of many pairs lie."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.many import over_mesh
from fegear.contact.many.corners import END, PITCH, START
from fegear.contact.many.kernel import AMOUNT1, AMOUNT2, AT1, AT2, BEGIN1, BEGIN2, HIGH1, HIGH2, LOW1, LOW2
from fegear.design.flanks.tip_chart import tip_robustness


class Trials:
    """Pairs whose excitation is a function of the mean gaps of odd and even tooth pairs, other ones under each load."""

    def __init__(self):
        pair, present = np.array([[0, 1, 2, 3], [1, 2, 3, 3]]), np.array([[True] * 4, [True, True, True, False]])
        self.known = SimpleNamespace(lines=SimpleNamespace(pair=pair, present=present))
        self.asked = []

    def of_gap(self, gap):
        self.asked.append(gap)
        lines = self.known.lines
        odd, even = (gap[lines.present & (lines.pair % 2 == k)].mean() for k in (1, 0))
        return SimpleNamespace(peak_to_peak=np.array([[abs(3.0 * odd - even) * load for load in (1.0, 2.0, 4.0)]]))


def test_every_combination_is_tried_with_either_half_of_the_teeth_ahead():
    trials = Trials()
    removal = 1e-6 * np.array([[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 0.0]])
    loads, spacing, depth = [0.5, 1.0], [0.0, 4e-6, -3e-6], [-0.2, 0.0, 0.1, 0.3]
    found = tip_robustness(trials, removal, loads, spacing, depth)
    assert found.values.shape == (2, 3, 4)
    assert (found.load_factors.tolist(), found.spacing_errors.tolist()) == (loads, spacing)
    assert found.relief_errors.tolist() == depth
    lines = trials.known.lines
    odd, even = (removal[lines.present & (lines.pair % 2 == k)].mean() for k in (1, 0))
    for j, e in enumerate(spacing):
        for k, d in enumerate(depth):
            # Odd pairs, or even ones, have the deviation besides the relief.
            each = [
                abs(3.0 * (odd * (1.0 + d) + e) - even * (1.0 + d)),
                abs(3.0 * odd * (1.0 + d) - even * (1.0 + d) - e),
            ]
            expected = max(each) if e else each[0]
            for i, load in enumerate((1.0, 2.0)):
                assert found.values[i, j, k] == pytest.approx(load * expected)
    assert found.nominal == pytest.approx(4.0 * abs(3.0 * odd - even))
    assert all((gap[~lines.present] == 0.0).all() for gap in trials.asked[:-1])
    assert len(trials.asked) == 4 + 2 * 2 * 4 + 1


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    for name, one in list(vars(over_mesh).items()):
        if hasattr(one, "py_func"):
            monkeypatch.setattr(over_mesh, name, one.py_func)


def broken(more=(), end=9.5):
    """Places of breaks of a pair of base pitch 8."""
    n = np.zeros(95)
    n[START], n[END], n[PITCH] = -4.0, end, 8.0
    n[[AT1, AT2, LOW1, HIGH1, LOW2, HIGH2]] = 20.0, 30.0, 10.0, 32.0, 15.0, 36.0
    for number, value in more:
        n[number] = value
    places = np.full(6, math.nan)
    count = over_mesh.begun(n, places)
    return places[:count].tolist()


def first(begin):
    return [(AMOUNT1, 1e-6), (BEGIN1, begin)]


def second(begin):
    return [(AMOUNT2, 1e-6), (BEGIN2, begin)]


def test_breaks_are_the_ends_of_the_path_and_where_reliefs_begin_in_one_base_pitch():
    assert broken() == [-4.0, 1.5]  # 9.5 a base pitch back
    # The driver's relief begins at 10 + 0.6 * 22 of its flank, which is 3.2 beyond the pitch point.
    assert broken(first(0.6)) == pytest.approx([-4.0, 1.5, 3.2])
    # The driven gear's at 15 + 0.8 * 21, 1.8 before it; both.
    assert broken(second(0.8)) == pytest.approx([-4.0, -1.8, 1.5])
    assert broken([*first(0.6), *second(0.8)]) == pytest.approx([-4.0, -1.8, 1.5, 3.2])
    # Reliefs that begin beyond the path are no breaks; nor is what lies on another, or a whole base pitch on.
    assert broken([*first(0.95), *second(0.95)]) == [-4.0, 1.5]
    assert broken(first((1.5 + 20.0 - 10.0) / 22.0)) == pytest.approx([-4.0, 1.5])
    for whole in (4.0, 4.0 - 1e-14, 4.0 + 1e-14, 12.0):
        assert broken(end=whole) == [-4.0]
    assert broken(end=4.0 - 1e-3) == pytest.approx([-4.0, 4.0 - 1e-3])
