"""Many candidates loaded at once: every set of stations in contact is tried, and approaches grow as by differences."""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.design.flanks.quick import QuickFlanks

POSITIONS, SIZE, LOAD = 3, 4, 1000.0
RNG = np.random.default_rng(8)
ROOT = RNG.normal(size=(POSITIONS, SIZE, SIZE)) * 0.2
MATRIX = (np.einsum("pij,pkj->pik", ROOT, ROOT) + np.eye(SIZE)) * 1e-8
CONSTANT = RNG.uniform(0.0, 1e-6, (POSITIONS, SIZE))
PRESENT = np.array([[True] * 4, [True, True, True, False], [False, True, True, True]])
BOTH = PRESENT[:, :, None] & PRESENT[:, None, :] | np.eye(SIZE, dtype=bool)
MATRIX = np.where(BOTH, MATRIX, 0.0)  # stations off the face are coupled to none
GAPS = RNG.uniform(0.0, 1.0, (6, POSITIONS, SIZE)) * np.array([0.0, 1e-6, 3e-6, 8e-6, 20e-6, 40e-6])[:, None, None]
FACE = RNG.uniform(0.1, 1.0, (POSITIONS, 5, SIZE))
QUICK = QuickFlanks(Space(), np.zeros((POSITIONS, 1, SIZE)), PRESENT, MATRIX, CONSTANT, FACE)


def alone(matrix, gap, present):
    """The one set of stations that neither pulls nor overlaps."""
    for on in product((True, False), repeat=SIZE):
        some = np.flatnonzero(on)
        if not some.size or not present[some].all():
            continue
        n = some.size
        whole = np.block([[matrix[np.ix_(some, some)], -np.ones((n, 1))], [np.ones((1, n)), np.zeros((1, 1))]])
        solved = np.linalg.solve(whole, [*-gap[some], LOAD])
        force = np.zeros(SIZE)
        force[some] = solved[:-1]
        apart = matrix @ force + gap - solved[-1]
        if (force >= 0.0).all() and (apart[present] >= -1e-15).all():
            return solved[-1], force
    raise AssertionError


def expected(gap, at=range(POSITIONS)):
    return [[alone(MATRIX[p], one[n] + CONSTANT[p], PRESENT[p]) for n, p in enumerate(at)] for one in gap]


@pytest.mark.parametrize("near", [None, "all", "none of two", "themselves"])
def test_forces_are_those_of_the_set_that_neither_pulls_nor_overlaps(near):
    wanted = expected(GAPS)
    forces = np.array([[force for _, force in each] for each in wanted])
    begun = {
        None: None, "all": np.ones_like(GAPS), "none of two": np.where(np.arange(SIZE) < 2, 0.0, 1.0) + 0.0 * GAPS,
        "themselves": forces,
    }[near]  # fmt: skip
    begun = None if begun is None else np.where(PRESENT, begun, 0.0)
    approach, force, growth = QUICK.contact(GAPS, LOAD, near=begun)
    np.testing.assert_allclose(approach, [[z for z, _ in each] for each in wanted], rtol=1e-10)
    np.testing.assert_allclose(force, forces, rtol=1e-9, atol=1e-9 * LOAD)
    np.testing.assert_allclose(force.sum(axis=2), LOAD, rtol=1e-10)
    assert (forces > 0.0).all(axis=2).any(), "some with all stations"
    assert ((forces == 0.0) & PRESENT).any(), "some without"
    step = 1e-12
    for station in range(SIZE):
        ahead = GAPS.copy()
        ahead[:, :, station] += step
        more = QUICK.contact(ahead, LOAD)[0]
        np.testing.assert_allclose((more - approach) / step, growth[:, :, station], atol=1e-5)


def test_some_positions_are_loaded_as_among_all():
    at = slice(1, None)
    approach, force, growth = QUICK.contact(GAPS[:, at], LOAD, at)
    for found, whole in zip((approach, force, growth), QUICK.contact(GAPS, LOAD), strict=True):
        np.testing.assert_allclose(found, whole[:, at], rtol=1e-12, atol=1e-20)


@pytest.mark.parametrize("batch", [1, 100, 10**6])
def test_candidates_are_solved_few_at_a_time_with_the_largest_part_of_the_face(monkeypatch, batch):
    monkeypatch.setattr("fegear.design.flanks.quick._BATCH", batch)
    approach, factor = QUICK.solve(GAPS, LOAD)
    whole, force, _ = QUICK.contact(GAPS, LOAD)
    np.testing.assert_allclose(approach, whole, rtol=1e-12)
    over = np.einsum("cpm,pfm->cf", force, FACE)
    np.testing.assert_allclose(factor, over.max(axis=1) * 5 / LOAD, rtol=1e-12)
