"""The grid of tip reliefs that descents start from: for every two amounts the best lengths of either gear."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from fegear.design.flanks import valley_floors as floors

LOW, HIGH = np.array([0.0, 1e-3, 2e-6, 2e-3]), np.array([30e-6, 9e-3, 20e-6, 8e-3])
APART = np.array([[0.0], [1e-6]])


class Quick:
    """Contacts of which the transmission error is the gap itself, twice as much under the second load."""

    def __init__(self, load):
        self.load = load

    def contact(self, gap, load, at):
        assert load == self.load
        assert at == slice(2, None, 4)
        return (1.0 + (load == 2.0)) * gap.sum(axis=2), None, None


class Tips:
    """Every gap is a bilinear law of the four numbers, plus what there is besides."""

    positions = np.arange(11.0)

    def gaps(self, tips):
        a, la, b, lb = np.asarray(tips).T[:, :, None, None]
        x = self.positions[:, None]
        return (a * np.abs(x - 1e3 * la) ** 1.5 + b * (x - 1e3 * lb) ** 2) + 0.0 * np.zeros((1, 1, 2))

    def cases(self):
        for load in (1.0, 2.0):
            for one in APART:
                yield Quick(load), load, one * np.ones((11, 2))

    def left(self, te):
        assert te.shape[1:] == (3, 4)
        return np.ptp(te, axis=1).max(axis=1)


def test_of_every_two_amounts_the_best_lengths_of_either_gear_are_taken(monkeypatch):
    monkeypatch.setattr(floors, "_AMOUNTS", 3)
    monkeypatch.setattr(floors, "_LENGTHS", 4)
    tips = Tips()
    found = floors._scanned(tips, LOW, HIGH)
    amounts = np.geomspace(0.07 * 30e-6, 30e-6, 3), np.geomspace(2e-6, 20e-6, 3)
    lengths = np.geomspace(1e-3, 9e-3, 4), np.geomspace(2e-3, 8e-3, 4)
    expected = []
    for a, b in product(*amounts):
        left = {}
        for j, k in product(range(4), range(4)):
            gap = tips.gaps([[a, lengths[0][j], b, lengths[1][k]]])[0, 2::4].sum(axis=1)
            left[j, k] = 2.0 * np.ptp(gap)
        best = {min(product([j], range(4)), key=left.get) for j in range(4)}
        best |= {min(product(range(4), [k]), key=left.get) for k in range(4)}
        expected += [[a, lengths[0][j], b, lengths[1][k]] for j, k in sorted(best)]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_lengths_that_may_not_vary_are_tried_once(monkeypatch):
    monkeypatch.setattr(floors, "_AMOUNTS", 2)
    low, high = LOW.copy(), HIGH.copy()
    low[1] = high[1]
    found = floors._scanned(Tips(), low, high)
    assert np.unique(found[:, 1]) == pytest.approx([9e-3])
    assert np.unique(found[:, 0]) == pytest.approx([2.1e-6, 30e-6])
