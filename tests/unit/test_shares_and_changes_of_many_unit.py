"""Load sharing of one of many pairs, how firmly each tooth pair bears, and where that changes: by other ways.

The functions run as plain Python: numba compiles them elsewhere.
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from scipy.optimize import brentq, root

from fegear.contact.many import changes, corners, kernel
from fegear.contact.many.corners import FACE, KAPPA1, KAPPA2, PITCH, START
from fegear.contact.many.kernel import DIAGONAL, GAP, HERE, MOST, NUMBERS, ROOM, TILT, WEDGE

LOAD, WIDTH, KAPPA = 3000.0, 0.02, 2e-12
HALF = 0.5 * KAPPA / WIDTH
COUPLED = np.array([[0.0, 3e-10, 1e-10], [3e-10, 0.0, 4e-10], [1e-10, 4e-10, 0.0]])


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    for module in (corners, kernel, changes):
        for name, one in list(vars(module).items()):
            if hasattr(one, "py_func"):
                monkeypatch.setattr(module, name, one.py_func)


def numbers_of_a_pair():
    n = np.zeros(95)
    n[FACE], n[KAPPA1], n[KAPPA2], n[PITCH], n[START] = WIDTH, 0.7 * KAPPA, 0.3 * KAPPA, 1.25, 10.0
    return n


def states(gaps, tilts=(-math.inf,) * 3, here=(1.0, 1.0, 1.0)):
    state = np.zeros((3, NUMBERS))
    state[:, HERE], state[:, GAP], state[:, TILT] = here, gaps, tilts
    state[:, DIAGONAL] = 2.1e-9, 1.7e-9, 1.9e-9
    state[:, WEDGE], state[:, ROOM] = (0.3, 0.5, 0.2), (0.4, 0.7, 0.5)
    return state


def approach(one, v):
    """Of a contact alone, over the load."""
    grown = math.log(v)
    if one[TILT] > -math.inf:
        grown -= 2.0 * kernel.edge_law(one[TILT] / math.sqrt(v), one[WEDGE], one[ROOM] / math.sqrt(v))[0]
    return (one[DIAGONAL] - HALF * grown) * v


def shared(state):
    """Shares and approach by trying every set of tooth pairs that may bear."""
    for bears in product((True, False), repeat=3):
        some = [i for i in range(3) if bears[i] and state[i, HERE] > 0.0]
        if not some:
            continue

        def missed(u, some=some):
            v, z = np.maximum(u[:-1], 1e-9), u[-1] * 1e-9
            of = [
                approach(state[i], w) + COUPLED[i, some] @ v + state[i, GAP] / LOAD - z
                for i, w in zip(some, v, strict=True)
            ]
            return np.append(np.array(of) * 1e9, u[:-1].sum() - 1.0)

        found = root(missed, [*[1.0 / len(some)] * len(some), 1.5], tol=1e-13)
        v = np.zeros(3)
        v[some] = found.x[:-1]
        z = found.x[-1] * 1e-9
        apart = state[:, GAP] / LOAD + COUPLED @ v - z
        others = [i for i in range(3) if i not in some and state[i, HERE] > 0.0]
        if np.abs(found.fun).max() < 1e-9 and (v[some] > 1e-8).all() and (apart[others] >= 0.0).all():
            return v, z
    raise AssertionError


SHARP, THERE = (-math.inf,) * 3, (1.0, 1.0, 1.0)
#: Gaps, distances from tip corners over half-widths, and which pairs are there.
CASES = [
    ((0.0, 0.0, 0.0), SHARP, THERE),
    ((0.0, 1e-6, 2e-6), SHARP, THERE),
    ((0.0, 1e-6, 40e-6), SHARP, THERE),
    ((2e-6, 1e-6, 0.0), (-0.6, 0.3, -4.0), THERE),
    ((0.0, 1e-6, 40e-6), (-0.6, 0.3, -4.0), THERE),
    ((5e-6, 0.0, 3e-6), (-math.inf, -0.2, 0.5), (1.0, 1.0, 0.0)),
    ((5e-6, 4.9e-6, 0.0), (0.0, -1.2, 0.1), (1.0, 0.0, 1.0)),
    ((3.2e-6, 0.0, 3.0e-6), SHARP, THERE),
]


@pytest.mark.parametrize(("gaps", "tilts", "here"), CASES)
def test_shares_are_those_of_the_set_that_neither_pulls_nor_overlaps(gaps, tilts, here):
    state = states(gaps, tilts, here)
    v, work = np.empty(3), np.empty((MOST, MOST + 2))
    coupled = COUPLED + 3e-9 * np.eye(3)  # a pair's own compliance is in its state, and is not read here
    z, nearest, good = kernel.share(HALF, LOAD, 3, state, coupled, v, work)
    assert good
    assert nearest == min(gap for gap, there in zip(gaps, here, strict=True) if there)
    expected, whole = shared(state)
    assert v == pytest.approx(expected, abs=2e-7)
    assert nearest + z * LOAD == pytest.approx(whole * LOAD, rel=1e-6)
    # How firmly each is in contact: its share, or how far it is apart over the largest deflection of those that bear.
    near = np.empty(3)
    n = numbers_of_a_pair()
    changes.nearness(n, LOAD, 3, nearest + z * LOAD, state, coupled, v, near)
    bears = v > 1e-12
    deflection = max(LOAD * (approach(state[i], v[i]) + COUPLED[i] @ v) for i in range(3) if bears[i])
    for i in range(3):
        if not here[i]:
            assert near[i] == -math.inf
        elif bears[i]:
            assert near[i] == pytest.approx(v[i] - 1e-9, rel=1e-12)
        else:
            apart = LOAD * (COUPLED[i] @ v) + gaps[i] - (nearest + z * LOAD)
            assert near[i] == pytest.approx(-apart / deflection, rel=1e-9)
            assert near[i] < 0.0


def test_no_tooth_pair_shares_nothing():
    state = states((0.0,) * 3, here=(0.0,) * 3)
    z, nearest, good = kernel.share(HALF, LOAD, 3, state, COUPLED, np.empty(3), np.empty((MOST, MOST + 2)))
    assert math.isnan(z)
    assert (nearest, good) == (math.inf, False)


@pytest.mark.parametrize("tilt", [-math.inf, -3.0, -0.5, 0.4])
@pytest.mark.parametrize("v", [0.02, 0.4, 0.9])
def test_the_straight_line_touches_the_approach_of_a_contact(tilt, v):
    one = states((0.0,) * 3, (tilt,) * 3)[1]
    slope, height = kernel.linearised(one, HALF, v)
    assert slope * v + height == pytest.approx(approach(one, v), rel=1e-12)
    step = 1e-6 * v
    assert slope == pytest.approx((approach(one, v + step) - approach(one, v - step)) / (2.0 * step), rel=1e-6)


def test_places_are_put_in_order_as_far_as_there_is_room():
    places, count = np.zeros(4), 0
    for x in (3.0, 1.0, 2.0, 5.0, 0.5):
        count = changes.inserted(places, count, x)
    assert count == 4
    assert places.tolist() == [1.0, 2.0, 3.0, 5.0]


def test_nearness_that_goes_on_as_steeply_as_beside_may_reach_zero():
    x = np.array([0.0, 1.0, 3.0, 4.0])

    def turn(*values, k=1):
        return changes.turns(np.array(values)[:, None], x, k, 0)

    def slope(*values, k=0):
        return changes.slope_of(np.array(values)[:, None], x, k, 0)

    assert slope(5.0, 3.0, 9.0, 9.0) == 2.0
    assert slope(5.0, 3.0, 9.0, 9.0, k=1) == 3.0
    assert slope(-5.0, -3.0, 1.0, 1.0, k=1) == 0.0  # the sign changes
    assert slope(5.0, 3.0, 9.0, 9.0, k=-1) == slope(5.0, 3.0, 9.0, 9.0, k=3) == 0.0
    assert slope(-math.inf, -3.0, -1.0, -1.0) == 0.0
    # Down by 2 a unit from 3 on is below zero after two units; from 5 on it is not.
    assert turn(5.0, 3.0, 3.0, 3.0)
    assert not turn(7.0, 5.0, 5.0, 5.0)
    assert turn(-3.0, -3.0, -3.0, -5.0)
    assert not turn(3.0, 3.0, -3.0, -5.0)
    assert not turn(5.0, 3.0, 3.0, 3.0, k=2)
    values = np.array([5.0, 3.0, 3.0, 3.0])[:, None]
    assert changes.dips(values, x, 1, np.array([2.9]), False)
    assert not changes.dips(values, x, 1, np.array([3.1]), False)
    risen = np.array([5.0, 3.0, 4.0, 4.0])[:, None]
    assert changes.dips(risen, x, 1, np.array([3.9]), True)
    assert not changes.dips(risen, x, 1, np.array([4.1]), True)
    assert not changes.dips(values + 4.0, x, 1, np.array([1.0]), False)


#: Curves over a base pitch from 10 to 11.25; a kink or a dip within a cell among them.
CURVES = {
    "one change": (lambda x: 0.3 * (x - 10.41), lambda x: 1.0),
    "one steep change": (lambda x: (x - 10.0) ** 9 - 0.81**9, lambda x: 1.0),
    "two pairs": (lambda x: 0.3 * (x - 10.41), lambda x: -0.2 * (x - 10.7773)),
    "both in one cell": (lambda x: 0.3 * (x - 10.41), lambda x: -0.2 * (x - 10.413)),
    "a dip between samples": (lambda x: (x - 10.5) ** 2 - 1e-5, lambda x: 1.0),
    "a touch that comes and goes": (lambda x: 1e-5 - (x - 10.55) ** 2, lambda x: math.sin(40.0 * x)),
    "none": (lambda x: 1.0 + 0.1 * x, lambda x: -2.0),
    "never there": (lambda x: 0.2 * (x - 10.3), lambda x: -math.inf),
}


@pytest.mark.parametrize("which", CURVES)
@pytest.mark.parametrize("edges", [[10.0], [10.0, 10.352, 10.3520000001]])
def test_changes_are_all_places_at_which_a_curve_passes_through_zero(which, edges, monkeypatch):
    curves, asked = CURVES[which], []

    def solved(*given):
        assert given[6:9] == (LOAD, 2, 0)
        asked.append(given[9])
        return given[9], True

    def nearness(n, load, numbers, error, state, c, v, out):
        assert n is pair_numbers
        assert (load, numbers) == (LOAD, 2)
        out[:2] = [curve(error) for curve in curves]

    monkeypatch.setattr(changes, "solved", solved)
    monkeypatch.setattr(changes, "nearness", nearness)
    found, pair_numbers = np.zeros(40), numbers_of_a_pair()
    count = changes.changes(
        pair_numbers, *[None] * 4, True, LOAD, 2, 0, 16, np.array(edges), len(edges), *[None] * 4, found
    )  # fmt: skip
    fine = np.linspace(10.0, 11.25, 20001)
    exact = []
    for curve in curves:
        values = np.array([curve(x) for x in fine])
        for k in np.flatnonzero((values[1:] > 0.0) != (values[:-1] > 0.0)):
            exact.append(brentq(curve, fine[k], fine[k + 1]))
    assert found[:count] == pytest.approx(np.sort(exact), abs=1e-6)
    # Within the base pitch, and beside its cuts.
    assert min(asked) == pytest.approx(10.0 + 1.25e-9, abs=1e-12)
    assert max(asked) == pytest.approx(11.25 - 1.25e-9, abs=1e-12)
    if which.startswith("one"):
        assert len(asked) < 16 + 16 + 6 * len(edges)
