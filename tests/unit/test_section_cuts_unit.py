"""Cuts of a section: every element has its part, what they cost is what elimination takes, and it is little."""

from __future__ import annotations

import numpy as np
import pytest

from fegear.fem.plane.condensation import numbered, symmetric
from fegear.fem.solid import cuts
from fegear.fem.solid.cuts import halves, products_of


def grid(columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Centres and nodes of squares, four nodes and one inside each."""
    x, y = (one.ravel() for one in np.meshgrid(np.arange(columns), np.arange(rows)))
    corner = y * (columns + 1) + x
    inner = (columns + 1) * (rows + 1) + np.arange(x.size)
    nodes = np.stack([corner, corner + 1, corner + columns + 1, corner + columns + 2, inner], axis=1)
    return np.stack([x, y]) + 0.5, nodes


def eliminated(found: cuts.Halves, nodes: np.ndarray, free: np.ndarray, carried: np.ndarray) -> float:
    """Products of eliminating part by part, counted by the sets of nodes themselves."""
    kept = np.flatnonzero(carried > 0.0)
    order, starts, old = numbered(nodes, found.part, found.depth, free.size, kept, np.zeros(0, dtype=int))
    weight, total = (free + carried)[old], 0.0

    def part(level: int, i: int) -> set[int]:
        nonlocal total
        if not (found.part >> level == i).any():
            return set()
        if level == 0:
            there = set(order[nodes[found.part == i]].ravel().tolist())
        else:
            there = part(level - 1, 2 * i) | part(level - 1, 2 * i + 1)
        gone = [one for one in there if one < starts[level + 1]]
        rest = there - set(gone)
        if gone:
            total += float(products_of(weight[gone].sum(), weight[list(rest)].sum()))
        return rest

    assert {int(old[one]) for one in part(found.depth, 0)} == set(kept.tolist())
    return total


@pytest.mark.parametrize("columns", [3, 12])
def test_what_cuts_cost_is_what_elimination_takes(monkeypatch, columns):
    monkeypatch.setattr(cuts, "_MOVED", 0.0)
    centres, nodes = grid(columns, 6)
    count = int(nodes.max()) + 1
    free, carried = np.random.default_rng(3).integers(3, 9, count).astype(float), np.zeros(count)
    ports = np.flatnonzero(np.arange(count) % (columns + 1) == 0)[:7]  # the nodes of one side
    free[ports], carried[ports] = 0.0, 5.0
    found = halves(centres, nodes, free, carried)
    assert found.part.shape == (centres.shape[1],)
    assert 0 <= found.part.min() <= found.part.max() < 1 << found.depth
    assert eliminated(found, nodes, free, carried) == pytest.approx(found.cost)
    whole = float(products_of(free.sum(), carried.sum()))
    assert found.cost < (0.8 if columns == 3 else 0.15) * whole


def test_heavy_ports_stay_on_one_side_of_the_first_cut():
    """What stays to the end is carried through every elimination above it: the rest is worked off without it."""
    centres, nodes = grid(16, 4)
    free = np.full(int(nodes.max()) + 1, 2.0)
    carried = np.zeros_like(free)
    ports = np.flatnonzero(np.isin(np.arange(free.size) % 17, (0, 1, 2)) & (np.arange(free.size) < 17 * 5))
    free[ports], carried[ports] = 0.0, 30.0
    found = halves(centres, nodes, free, carried)
    first = found.part >> (found.depth - 1)
    with_ports = np.isin(nodes, ports).any(axis=1)
    assert len(set(first[with_ports].tolist())) == 1
    assert len(set(first.tolist())) == 2


def test_halves_may_be_many_deep():
    """Numbers of parts are too many to list then: of a plain grid some 2^32, of which 128 have elements."""
    centres, nodes = grid(20, 10)
    free, carried = np.full(int(nodes.max()) + 1, 30.0), np.zeros(int(nodes.max()) + 1)
    found = halves(centres, nodes, free, carried)
    assert 20 < found.depth <= 48
    assert eliminated(found, nodes, free, carried) > 0.0
    assert np.unique(found.part).size > 50


def test_a_part_that_nothing_cheapens_stays_whole():
    found = halves(np.zeros((2, 1)), np.array([[0, 1, 2]]), np.ones(3), np.zeros(3))
    assert found.part.tolist() == [0]
    assert found.depth == 0
    heavy = halves(*grid(2, 1), np.zeros(8), np.ones(8))  # nothing to eliminate
    assert heavy.part.tolist() == [0, 0]


def test_a_matrix_is_filled_from_its_lower_triangle():
    whole = np.random.default_rng(1).normal(size=(600, 600))
    whole += whole.T
    found = symmetric(np.tril(whole) + np.triu(np.full_like(whole, np.nan), 1))
    np.testing.assert_array_equal(found, whole)
