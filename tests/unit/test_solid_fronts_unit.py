"""Parts of a solid sector eliminated in shared memory: what is left is the Schur complement of the whole."""

import numpy as np
import pytest

from fegear.base.errors import FegearError
from fegear.fem.plane.condensation import Condensed
from fegear.fem.solid import fronts
from fegear.fem.solid.dissection import _groups
from fegear.fem.solid.fronts import Node, eliminated, joined

#: Unknowns of five smallest parts; numbers below 12 go in them, below 20 where two join, below 26 where all do.
LEAVES = [(0, 1, 2, 13, 14, 21, 26, 27, 30), (3, 4, 13, 15, 20, 21, 28), (5, 6, 7, 16, 17, 22, 23, 29, 30),
          (16, 18, 19, 24, 22), (8, 9, 10, 11, 12, 25, 24, 26, 31)]  # fmt: skip
SIZE, KEPT = 32, 26


def stiffness(leaf):
    square = np.random.default_rng(leaf).normal(size=(len(LEAVES[leaf]) + 2, len(LEAVES[leaf])))
    return square.T @ square + np.eye(len(LEAVES[leaf]))


def smallest(elements, front):
    (leaf,) = elements
    order, n = np.argsort(LEAVES[leaf]), front.inner.shape[0]
    matrix = stiffness(leaf)[np.ix_(order, order)]
    front.inner[...], front.border[...], front.rest[...] = matrix[:n, :n], matrix[n:, :n], matrix[n:, n:]


def tree():
    leaves = []
    for i, ids in enumerate(LEAVES):
        own = np.sort(ids)
        leaves.append(Node(own, int(np.searchsorted(own, 12)), (), np.array([i])))
    pairs = [joined((leaves[1], leaves[0]), 20), joined((leaves[2], leaves[3]), 20)]
    return joined((joined((pairs[1], pairs[0]), 22), joined((leaves[4],), 20)), KEPT)


def whole():
    matrix = np.zeros((SIZE, SIZE))
    for i, ids in enumerate(LEAVES):
        matrix[np.ix_(ids, ids)] += stiffness(i)
    return matrix


@pytest.mark.parametrize("block", [2, 256])
@pytest.mark.parametrize("with_steps", [False, True])
def test_what_is_left_is_the_schur_complement(monkeypatch, block, with_steps):
    monkeypatch.setattr(fronts, "_BLOCK", block)
    steps = [] if with_steps else None
    found = np.tril(eliminated(tree(), smallest, np.arange(SIZE), steps))
    k = whole()
    exact = k[KEPT:, KEPT:] - k[KEPT:, :KEPT] @ np.linalg.solve(k[:KEPT, :KEPT], k[:KEPT, KEPT:])
    np.testing.assert_allclose(found, np.tril(exact), atol=1e-12 * np.abs(exact).max())
    if steps is None:
        return
    # What went follows from what is left.
    moved = np.random.default_rng(3).normal(size=(SIZE - KEPT, 2))
    expanded = Condensed(np.arange(KEPT, SIZE), exact, SIZE, tuple(steps)).expand(moved)
    np.testing.assert_allclose(expanded[KEPT:], moved)
    np.testing.assert_allclose((k @ expanded)[:KEPT], 0.0, atol=1e-10 * np.abs(k @ expanded).max())


def test_an_indefinite_part_is_refused():
    node = Node(np.array([0, 1]), 1, (), np.array([0]))
    with pytest.raises(FegearError, match="not positive definite"):
        eliminated(node, lambda _, front: front.inner.fill(-1.0), np.arange(2), None)


@pytest.mark.parametrize("first_left", [0, 2, 4, 11, 17])
def test_groups_of_unknowns_repeat_their_functions(first_left):
    """x and y with even functions, z with odd ones, a node with fewer, single components; split where some go."""
    even, odd, few = [True, False, True, False], [False, True, False, True], [True, False, False, False]
    has = np.array([even, even, odd] * 3 + [few, few, few] + [odd, odd, even, odd, even])
    starts = np.concatenate([[0], np.cumsum(has.sum(axis=1))])
    number, place, gone = [], 0, int(starts[first_left])
    for group in _groups(has, gone):
        assert group.places.start == place
        place = group.places.stop
        assert not group.places.start < gone < group.places.stop
        size = (group.places.stop - group.places.start) // group.repeated
        for unknown, at, functions in group.unknowns:
            for i, u in enumerate(range(*unknown.indices(has.shape[0]))):
                np.testing.assert_array_equal(np.flatnonzero(has[u]), functions)
                assert group.places.start + i * size + at.start == starts[u]
                assert at.stop - at.start == functions.size
                number.append(u)
            assert i + 1 == group.repeated
    assert place == starts[-1]
    assert sorted(number) == list(range(has.shape[0]))
    if first_left == 0:  # nine of three nodes in one group, three equal ones in another
        assert len(_groups(has, 0)) <= 5
