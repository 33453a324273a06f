"""When the region of an atlas is known well enough, and in what proportions rows differ; made-up gears."""

from __future__ import annotations

import math
from types import SimpleNamespace as Space

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval2d

from fegear.atlas import build
from fegear.atlas.build import Budget, _Region
from fegear.atlas.tables import _LOADS, _NEIGHBOUR, _OWN, _POINTS, Layout, shares_of_fillet, shares_of_flank

LAYOUT = Layout(1)


def row(own=1.0, stress=1.0):
    found = np.zeros(LAYOUT.size)
    LAYOUT.own(found)[...] = own
    for kernel in LAYOUT.kernels:
        LAYOUT.stress(found, kernel)[...] = stress if kernel[1] == "tension" else -stress
    return found


def test_own_compliance_differs_relatively_at_each_place():
    known, off = row(np.linspace(1.0, 3.0, _OWN)), np.zeros(LAYOUT.size)
    LAYOUT.own(off)[[0, -1]] = 0.1, -0.6
    assert LAYOUT.differences(known, off)[0] == pytest.approx(0.2)
    assert (LAYOUT.differences(known, off)[1:] == 0.0).all()


def test_neighbours_differ_over_the_smallest_own_compliance():
    known, off = row(np.linspace(0.5, 3.0, _OWN)), np.zeros(LAYOUT.size)
    coefficients = np.random.default_rng(1).normal(size=(_NEIGHBOUR, _NEIGHBOUR)) * 1e-3
    LAYOUT.neighbour(off, 1)[...] = coefficients
    at = np.linspace(-1.0, 1.0, _NEIGHBOUR)
    largest = np.abs(chebval2d(*np.meshgrid(at, at), coefficients)).max()
    assert LAYOUT.differences(known, off)[1] == pytest.approx(largest / 0.5, rel=1e-12)
    farther = Layout(2)
    known = np.zeros(farther.size)
    farther.own(known)[...], known[farther.compliances :] = 0.5, 1.0
    off = np.zeros(farther.size)
    farther.neighbour(off, 1)[0, 0], farther.neighbour(off, 2)[0, 0] = 0.1, -0.3
    assert farther.differences(known, off)[1] == pytest.approx(0.6)
    alone, none = Layout(0), np.ones(Layout(0).size)
    assert alone.differences(none, 0.5 * none)[1] == 0.0


@pytest.mark.parametrize("side", ["tension", "compression"])
def test_own_stress_differs_at_its_largest_value_and_a_neighbour_s_anywhere(side):
    known, off = row(), np.zeros(LAYOUT.size)
    sign = 1.0 if side == "tension" else -1.0
    own = LAYOUT.stress(known, (0, side))
    own[...] = sign * np.arange(_LOADS * _POINTS).reshape(_LOADS, _POINTS) / 100.0  # largest at the last point
    LAYOUT.stress(off, (0, side))[2] = 9.0
    LAYOUT.stress(off, (0, side))[2, -1] = -0.7
    LAYOUT.stress(off, (1, side))[3, 4] = -0.4
    found = dict(zip(LAYOUT.quantities, LAYOUT.differences(known, off), strict=True))
    largest = (_LOADS * _POINTS - 1) / 100.0
    assert found[f"{side} 0"] == pytest.approx(0.7 / largest)
    assert found[f"{side} 1"] == pytest.approx(0.4 / largest)
    assert found[f"{side} -1"] == 0.0


def test_what_a_body_turns_by_is_the_same_for_all_teeth():
    rows = np.stack([row(), row(2.0)])
    before = rows.copy()
    LAYOUT.turned(rows, np.array([0.25, -0.5]))
    np.testing.assert_allclose(LAYOUT.own(rows) - LAYOUT.own(before), [[0.25] * _OWN, [-0.5] * _OWN])
    moved = LAYOUT.neighbour(rows, 1) - LAYOUT.neighbour(before, 1)
    np.testing.assert_allclose(moved[:, 0, 0], [0.25, -0.5])
    moved[:, 0, 0] = 0.0
    assert not moved.any()
    np.testing.assert_array_equal(rows[:, LAYOUT.compliances :], before[:, LAYOUT.compliances :])


class Region:
    """Gears without finite elements: so many products miss so much of c_0, c_1 and own stress."""

    grow = _Region.grow

    def __init__(self, misses, left=1000, known=(), whole=False):
        self.misses, self._whole, self._known, self.count = misses, whole, known, 0
        self._layout, self._left, self._rows = LAYOUT, [None] * left, []
        self._degrees, self.solved = np.zeros((4, 4), dtype=int), []
        self.rest, self._at = "rest", "at"

    def _solve(self, degrees, wanted, progress):
        assert progress == "progress"
        wanted = min(wanted, self.count + len(self._left))
        self._left = self._left[wanted - self.count :]
        self.count, self._rows = wanted, [row()] * wanted
        self.solved.append((len(degrees), wanted))

    def _missed(self, off):
        """Per gear and quantity: of a neighbour's stress, which does not count, a thousand times as much."""
        found = np.full((off.size, len(LAYOUT.quantities)), 1000.0)
        counted = [LAYOUT.quantities.index(one) for one in ("c_self", "c_neighbour", "tension 0", "compression 0")]
        found[:, counted] = 0.0
        found[:, counted[self.quantity]] = off
        return found

    def _off(self, degrees, counts):
        assert [LAYOUT.quantities[one] for one in counts] == ["c_self", "c_neighbour", "tension 0", "compression 0"]
        return self._missed(self.of(len(degrees)))[:, counts].max(axis=1)

    def of(self, products):
        """Nine tenths of the gears are missed by no more."""
        return np.where(np.arange(max(self.count, 100)) % 20 < 19, self.misses(products), 1e6)

    def _only_varying(self, degrees):
        return degrees


@pytest.fixture(params=range(4), ids=["c_self", "c_neighbour", "tension", "compression"])
def quantity(request, monkeypatch):
    monkeypatch.setattr(Region, "quantity", request.param, raising=False)
    steps = []

    def next_degrees(degrees, sizes, most, growth):
        assert (most, growth) == (build._HIGHEST, build._GROWTH)
        assert sizes.shape == (2,)
        np.testing.assert_allclose(sizes, 0.25)
        steps.append(len(degrees))
        return np.zeros((min(2 * len(degrees), 64), 4), dtype=int)

    def fitted(rest, given):
        assert rest == "rest"
        off = np.zeros(LAYOUT.size)
        LAYOUT.own(off)[...] = 0.25
        return np.stack([off, off]), given[1].of(given[0])

    region = Space(steps=steps, made=None)

    def make(*given, **more):
        region.made = Region(*given, **more)
        return region.made

    monkeypatch.setattr(build, "next_degrees", next_degrees)
    monkeypatch.setattr(build, "fitted", fitted)
    monkeypatch.setattr(build, "products", lambda degrees, at: (len(degrees), region.made))
    return make


def wanted(products, like=False):
    return math.ceil((1.6 if like else 1.4) * products) + 4


@pytest.mark.parametrize("like", [False, True])
def test_products_are_added_until_nine_tenths_of_the_gears_are_met(quantity, like):
    region = quantity(lambda count: 0.1 / count, known=("another",) if like else ())
    region.grow(Budget(0.1 / 16), "progress")
    assert region.solved == [(count, wanted(count, like)) for count in (4, 8, 16)]
    assert len(region._degrees) == 16


def test_of_gears_that_scatter_the_products_that_miss_least_stay(quantity):
    region = quantity(lambda count: {4: 0.5, 8: 0.2, 16: 0.3}[count])
    region.grow(Budget(0.01, gears=wanted(16)), "progress")
    assert region.solved == [(count, wanted(count)) for count in (4, 8, 16)]
    assert len(region._degrees) == 8
    few = quantity(lambda count: 1.0 / count, left=wanted(8))
    few.grow(Budget(0.01), "progress")
    assert [count for count, _ in few.solved] == [4, 8]


def test_a_region_whose_products_are_all_taken_or_that_another_atlas_has_is_left(quantity):
    region = quantity(lambda count: 1.0)
    region.grow(Budget(0.01), "progress")
    assert [count for count, _ in region.solved] == [4, 8, 16, 32, 64]
    whole = quantity(lambda count: 1.0, whole=True)
    whole.grow(Budget(0.01), "progress")
    assert whole.solved == []


def test_places_crowd_to_both_ends_of_a_fillet_and_to_the_start_of_a_flank():
    found = shares_of_fillet()
    np.testing.assert_allclose(np.sort(np.cos(np.pi * (np.arange(_POINTS) + 0.5) / _POINTS)), 2.0 * found - 1.0)
    flank = shares_of_flank()
    assert (flank.size, flank[0], flank[-1]) == (_LOADS, 0.0, 1.0)
    np.testing.assert_allclose(np.diff(np.log(flank[1:])) / np.diff(np.log(np.arange(1.0, _LOADS))), 1.7)
