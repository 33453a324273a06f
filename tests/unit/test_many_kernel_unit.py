"""Machine code of many pairs: coupling between any number of tooth pairs, and answers that do not settle; plain Python.

Couplings are Chebyshev series of both places: numpy's own sum is the other way.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval2d

from fegear.contact.many import corners, kernel
from fegear.contact.many.corners import FACE, HIGH1, HIGH2, LOW1, LOW2
from fegear.contact.many.kernel import DIAGONAL, GAP, HERE, LENGTH1, LENGTH2, MOST, NUMBERS, TILT

WIDTH = 0.02


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    for module in (corners, kernel):
        for name, one in list(vars(module).items()):
            if hasattr(one, "py_func"):
                monkeypatch.setattr(module, name, one.py_func)


def pair():
    n = np.zeros(95)
    n[FACE], n[LOW1], n[HIGH1], n[LOW2], n[HIGH2] = WIDTH, 1.0, 4.0, 2.0, 7.0
    return n


def states(count):
    state = np.zeros((count, NUMBERS))
    state[:, HERE], state[:, TILT] = 1.0, -math.inf
    state[:, LENGTH1], state[:, LENGTH2] = np.linspace(1.1, 3.7, count), np.linspace(6.8, 2.4, count)
    return state


@pytest.mark.parametrize("reach", [1, 2, 3])
@pytest.mark.parametrize("size", [2, 5])
def test_tooth_pairs_within_the_reach_are_coupled_and_none_beyond_it(reach, size):
    rng, count = np.random.default_rng(reach), 5
    beside1, beside2 = rng.normal(size=(2, reach, size, size)) * 1e-11
    state, c = states(count), np.full((MOST, MOST), 7.0)
    state[3, HERE] = 0.0
    n = pair()
    kernel.couple(n, beside1, beside2, count, state, c)
    p1 = 2.0 * (state[:, LENGTH1] - n[LOW1]) / (n[HIGH1] - n[LOW1]) - 1.0
    p2 = 2.0 * (state[:, LENGTH2] - n[LOW2]) / (n[HIGH2] - n[LOW2]) - 1.0
    for i in range(count):
        for j in range(i + 1, count):
            k = j - i
            expected = 0.0
            if k <= reach and 3 not in (i, j):  # of the driven gear the next pair's tooth is the one before
                expected = (chebval2d(p1[j], p1[i], beside1[k - 1]) + chebval2d(p2[i], p2[j], beside2[k - 1])) / WIDTH
            assert c[i, j] == pytest.approx(expected, rel=1e-12, abs=1e-25)
            assert c[j, i] == c[i, j]
    assert (np.diag(c)[:count] == 7.0).all()  # a pair's own is elsewhere
    assert (c[count:] == 7.0).all()


def test_a_series_of_two_places_is_numpys():
    rng = np.random.default_rng(0)
    for size in (1, 2, 3, 8):
        coefficients = rng.normal(size=(size, size))
        for p, q in rng.uniform(-1.0, 1.0, (5, 2)):
            assert kernel.beside_at(coefficients, p, q) == pytest.approx(chebval2d(p, q, coefficients), abs=1e-12)


@pytest.mark.parametrize(("steps", "settles"), [(1, False), (2, True), (40, True)])
def test_shares_that_have_not_settled_after_all_steps_are_said_to_be_bad(monkeypatch, steps, settles):
    """Two pairs whose laws are straight lines: the first step finds the answer, the second that it stays."""
    monkeypatch.setattr(kernel, "_STEPS", steps)
    state = states(2)
    state[:, DIAGONAL], state[:, GAP] = (2e-9, 3e-9), (1e-6, 1.5e-6)
    v, load = np.zeros(2), 3000.0
    z, nearest, good = kernel.share(0.0, load, 2, state, np.zeros((2, 2)), v, np.zeros((MOST, MOST + 2)))
    assert (nearest, good) == (1e-6, settles)
    force = (1.0 + 0.5e-6 / load / 3e-9) / (1.0 / 2e-9 + 1.0 / 3e-9)  # springs side by side, the second 0.5 um off
    assert z == pytest.approx(force, rel=1e-12)
    if settles:
        assert v == pytest.approx([force / 2e-9, (force - 0.5e-6 / load) / 3e-9], rel=1e-12)
        assert v.sum() == pytest.approx(1.0, rel=1e-12)


def test_a_pair_that_gapes_beyond_what_the_load_closes_carries_nothing():
    """Pairs nearer than the deflection of the nearest begin in contact, one that pulls leaves it."""
    load, state = 1000.0, states(3)
    state[:, DIAGONAL], state[:, GAP] = 1e-9, (0.0, 0.9e-6, 5e-6)
    v = np.zeros(3)
    z, nearest, good = kernel.share(0.0, load, 3, state, np.zeros((3, 3)), v, np.zeros((MOST, MOST + 2)))
    assert (nearest, good) == (0.0, True)
    assert z * load == pytest.approx(0.5 * (1e-6 + 0.9e-6))
    assert v == pytest.approx([0.95, 0.05, 0.0], abs=1e-12)


def test_a_pair_that_others_push_away_stays_apart():
    """Two alike, the third 0.4 um farther: alone they come 0.5 um nearer, and push the third as far as coupled."""
    load, state = 1000.0, states(3)
    state[:, DIAGONAL], state[:, GAP] = 1e-9, (0.0, 0.0, 0.4e-6)
    for coupled, bears in ((0.0, True), (0.09e-9, True), (0.11e-9, False)):
        c, v = np.zeros((3, 3)), np.zeros(3)
        c[2, :2] = c[:2, 2] = coupled  # the third closes where 0.5 um less what it is pushed exceed its gap
        z, _, good = kernel.share(0.0, load, 3, state, c, v, np.zeros((MOST, MOST + 2)))
        assert good
        assert bool(v[2] > 1e-12) is bears
        apart = 1e-9 * v + c @ v + state[:, GAP] / load - z
        np.testing.assert_allclose(apart[:2], 0.0, atol=1e-15)
        assert (abs(apart[2]) < 1e-15) if bears else apart[2] > 0.0
