"""Fronts of random costs with many ties, beside comparing everything with everything."""

from __future__ import annotations

import numpy as np
import pytest

from fegear.design.sizing.front import best_by_ranks, pareto_front, rounded_costs


def by_comparing(costs: np.ndarray) -> list[int]:
    costs = rounded_costs(costs)
    return [i for i, one in enumerate(costs) if not ((costs <= one).all(axis=1) & (costs < one).any(axis=1)).any()]


@pytest.mark.parametrize("kind", ["different", "whole", "two values", "repeated", "on a plane"])
def test_fronts_of_random_costs_are_those_of_comparing_all(kind):
    rng = np.random.default_rng(sum(map(ord, kind)))
    for columns in range(1, 7):
        for count in (0, 1, 2, 65, 700):
            costs = rng.normal(size=(count, columns))
            if kind == "whole":
                costs = np.round(2.0 * costs)
            elif kind == "two values":
                costs[:, :-1] = costs[:, :-1] > 0.0
            elif kind == "repeated" and count:
                costs = costs[rng.integers(0, count, count)]
            elif kind == "on a plane":
                costs[:, 0] = -costs[:, 1:].sum(axis=1)
            assert pareto_front(costs).tolist() == by_comparing(costs)


def test_numbers_that_are_unknown_are_compared_with_none_and_infinite_ones_are_the_worst():
    costs = np.array([[1.0, 2.0], [np.nan, 0.0], [np.inf, 1.0], [2.0, 3.0], [1.0, np.inf], [-np.inf, np.inf]])
    assert pareto_front(costs).tolist() == [0, 1, 2, 5]


def test_a_large_front_on_a_plane_keeps_all_and_loses_what_is_behind_it():
    rng = np.random.default_rng(3)
    costs = rng.random((9_000, 4))
    costs[:, 3] = 3.0 - costs[:, :3].sum(axis=1)
    behind = rng.permutation(9_000)[:3_000]
    ahead = np.setdiff1d(np.arange(9_000), behind)
    costs[behind] = costs[ahead[:3_000]] + rng.integers(0, 2, (3_000, 4)) * 0.1  # some of them equal
    alive = (costs[behind] == costs[ahead[:3_000]]).all(axis=1)
    assert pareto_front(costs).tolist() == sorted([*ahead, *behind[alive]])


def test_the_least_sums_of_ranks_are_kept_in_order():
    costs = np.array([[3.0, 30.0], [1.0, 20.0], [2.0, 10.0], [1.0, 10.0]])
    assert best_by_ranks(costs, 2).tolist() == [1, 3]  # of two that are equal the first
    assert best_by_ranks(costs, 9).tolist() == [0, 1, 2, 3]
