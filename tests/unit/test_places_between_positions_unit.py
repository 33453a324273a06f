"""Places where tooth pairs part or touch: peaks, bends and their slopes, against pairs with straight removals.

Pairs with compliances A, removals r_j = g_j x + b_j q and one load share it in closed form, wherever the place is.
"""

from __future__ import annotations

import numpy as np
import pytest

from fegear.design.tip_relief.between_positions import HandOver, Places, State, solved

A = np.array([[2.0, 0.3, 0.1], [0.3, 2.5, 0.4], [0.1, 0.4, 1.8]])
LOAD, STEP = 3.0, 1e-6
B = np.array([[0.3, -0.2, 0.1], [0.1, 0.4, -0.3], [-0.5, 0.2, 0.6], [0.2, 0.1, 0.9]])  # (numbers, pairs)


def shared(slopes, base, bears, x, q):
    """Loads, transmission error and weights where these pairs bear."""
    removal = base + slopes * x + q @ B
    some = np.flatnonzero(bears)
    flexible = np.linalg.inv(A[np.ix_(some, some)])
    weight = np.zeros(3)
    weight[some] = flexible.sum(axis=0) / flexible.sum()
    error = (LOAD + flexible.sum(axis=0) @ removal[some]) / flexible.sum()
    loads = np.zeros(3)
    loads[some] = flexible @ (error - removal[some])
    return loads, error, weight, removal


def off(slopes, base, bears, pair, x, q):
    """How far a pair that does not bear is from bearing."""
    loads, error, _, removal = shared(slopes, base, bears, x, q)
    return A[pair] @ loads + removal[pair] - error


def place(slopes, base, bears, pair, q):
    """Where it touches: the distance is straight in x."""
    first, second = (off(slopes, base, bears, pair, x, q) for x in (0.0, 1.0))
    return first / (first - second)


CASES = [  # slopes of the removals, pair, whether it parts, whether the error has a peak there
    (np.array([0.9, 0.7, -2.5]), 2, False, True), (np.array([-0.6, -0.8, 2.1]), 2, True, True),
    (np.array([0.9, 0.7, 0.2]), 2, False, False), (np.array([-0.6, -0.8, -0.4]), 2, True, False),
]  # fmt: skip
BASE = np.array([20.2, 20.0, 20.7])


def hand_over(beside=0.0):
    """All cases as places of one array."""
    parts = []
    for slopes, pair, leaves, _ in CASES:
        bears = np.arange(3) != pair
        x = place(slopes, BASE, bears, pair, np.zeros(4))
        loads, error, weight, _ = shared(slopes, BASE, bears, x, np.zeros(4))
        without = off(slopes, BASE, bears, pair, x, np.zeros(4))
        rise = (off(slopes, BASE, bears, pair, x + STEP, np.zeros(4)) - without) / STEP
        distance, slope = np.zeros(3), np.zeros(3)
        distance[pair], slope[pair] = without + beside, rise
        whole = shared(slopes, BASE, np.ones(3, bool), x, np.zeros(4))[2]
        parts.append((x, bears, loads, weight, error, weight @ slopes, slopes, distance, slope, pair, leaves, whole))
    x, on, loads, weight, error, rise, rises, distance, slope, pair, leaves, whole = map(
        np.array, zip(*parts, strict=True)
    )
    count = len(CASES)
    where = np.arange(3 * count).reshape(3, count)
    state = State(
        loads.T, weight.T, error, rise, rises.T, np.repeat(B[:, :, None], count, axis=2), distance.T, slope.T,
        np.zeros((2, 3, count)), np.repeat(A[:, :, None], count, axis=2),
    )  # fmt: skip
    return HandOver(Places(x, where, on.T, loads.T), state, pair, leaves, whole.T)


def test_pairs_that_bear_share_and_the_others_are_zero():
    on = np.array([[True, True], [False, True], [True, True]])
    right = np.array([[[1.0, 2.0], [5.0, 3.0], [4.0, -1.0]], [[0.5, 0.1], [7.0, 0.2], [0.3, 0.4]]])
    tangent = np.stack([A, 2.0 * A + np.eye(3)], axis=2)
    found = solved(tangent, on, *right)
    assert found.shape == (2, 3, 2)
    for s in range(2):
        assert found[s, [0, 2], 0] == pytest.approx(np.linalg.solve(A[np.ix_([0, 2], [0, 2])], right[s, [0, 2], 0]))
        assert found[s, 1, 0] == 0.0
        assert found[s, :, 1] == pytest.approx(np.linalg.solve(2.0 * A + np.eye(3), right[s, :, 1]))


def test_slopes_of_the_error_are_those_of_the_shared_load():
    over = hand_over()
    for k, (slopes, pair, _, _) in enumerate(CASES):
        bears = np.arange(3) != pair
        for q in range(4):
            step = STEP * np.eye(4)[q]
            ends = [shared(slopes, BASE, bears, over.at.x[k], one)[1] for one in (step, -step)]
            assert over.found.slope()[k, q] == pytest.approx((ends[0] - ends[1]) / (2.0 * STEP), abs=1e-7)
            ends = [shared(slopes, BASE, np.ones(3, bool), over.at.x[k], one)[1] for one in (step, -step)]
            assert over.found.slope(over.weight)[k, q] == pytest.approx((ends[0] - ends[1]) / (2.0 * STEP), abs=1e-7)
        ends = [shared(slopes, BASE, np.ones(3, bool), over.at.x[k] + h, np.zeros(4))[1] for h in (STEP, -STEP)]
        assert over.together[k] == pytest.approx((ends[0] - ends[1]) / (2.0 * STEP), abs=1e-7)


def test_a_peak_rises_with_the_numbers_as_its_moving_place_does():
    over = hand_over()
    peak, weight = over.peaks()
    assert over.met.all()
    assert peak.tolist() == [one[3] for one in CASES]
    for k, (slopes, pair, _, is_peak) in enumerate(CASES):
        bears = np.arange(3) != pair
        for q in range(4):
            step = STEP * np.eye(4)[q]
            at = [place(slopes, BASE, bears, pair, one) if is_peak else over.at.x[k] for one in (step, -step)]
            top = [shared(slopes, BASE, bears, x, one)[1] for x, one in zip(at, (step, -step), strict=True)]
            assert over.found.slope(weight)[k, q] == pytest.approx((top[0] - top[1]) / (2.0 * STEP), abs=1e-7)


def test_a_bend_moves_with_the_numbers_and_is_the_jump_of_the_slope():
    over = hand_over()
    bends = over.bends()
    for k, (slopes, pair, leaves, _) in enumerate(CASES):
        bears = np.arange(3) != pair
        for q in range(4):
            step = STEP * np.eye(4)[q]
            moved = [place(slopes, BASE, bears, pair, one) for one in (step, -step)]
            assert bends.moved[k, q] == pytest.approx((moved[0] - moved[1]) / (2.0 * STEP), abs=1e-6)
        before, after = (np.ones(3, bool), bears)[:: 1 if leaves else -1]
        x = over.at.x[k]
        slope = [
            (shared(slopes, BASE, on, x + STEP, np.zeros(4))[1] - shared(slopes, BASE, on, x, np.zeros(4))[1]) / STEP
            for on in (before, after)
        ]
        assert bends.jump[k] == pytest.approx(slope[1] - slope[0], abs=1e-6)
    assert bends.x is over.at.x
    assert bends.where is over.at.where
    assert not bends.grown.any()
    assert bends.grown.shape == (len(CASES), 4)


def test_places_that_were_not_found_are_no_peaks_and_have_no_jump():
    over = hand_over(1e-4)
    peak, weight = over.peaks()
    assert not over.met.any()
    assert not peak.any()
    assert weight == pytest.approx(over.found.weight)
    assert not over.bends().jump.any()
    # Found is what lies within a millionth of the transmission error.
    assert hand_over(0.9e-6 * over.found.error.min()).met.all()
    assert not hand_over(1.1e-6 * over.found.error.max()).met.any()
