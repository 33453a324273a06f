"""Which variants none is better than, and in which order they stand: Pareto fronts and the rule for ties.

Costs are numbers of which each is better the smaller it is. A variant is dominated where another is no worse in any
cost and better in one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index, Mask

#: Costs that are compared at once with all of the front.
_BLOCK = 2000
#: Significant digits in which costs differ.
_DIGITS = 9


def rounded_costs(costs: Array, digits: int = _DIGITS) -> Array:
    """Costs to so many significant digits: what differs in the last bit is equal."""
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.where(costs == 0.0, 1.0, 10.0 ** (digits - 1 - np.floor(np.log10(np.abs(costs)))))
    return np.where(np.isfinite(costs), np.round(costs * size) / size, costs)


def _dominated(costs: Array, by: Array) -> Mask:
    """Which costs, shape (N, k), are dominated by any of `by`, shape (M, k)."""
    found = np.zeros(len(costs), dtype=bool)
    for one in by:
        found |= (costs >= one).all(axis=1) & (costs > one).any(axis=1)
    return found


def pareto_front(costs: Array) -> Index:
    """Places of the costs, shape (N, k), that none dominates, ascending."""
    costs = rounded_costs(np.asarray(costs, dtype=float))
    order = np.lexsort(costs.T[::-1])  # what dominates a cost stands before it
    front: list[int] = []
    for first in range(0, order.size, _BLOCK):
        block = order[first : first + _BLOCK]
        if front:
            block = block[~_dominated(costs[block], costs[front])]
        alive = list(block)
        while alive:
            one = alive.pop(0)
            front.append(int(one))
            rest = np.array(alive, dtype=int)
            alive = list(rest[~_dominated(costs[rest], costs[[one]])]) if rest.size else []
    return np.array(sorted(front), dtype=np.int64)


def best_by_fronts(costs: Array, count: int) -> Index:
    """Places of at least `count` costs, front after front; of a front that is larger than the rest, evenly along it.

    Along the first cost, and the others where it is equal; both ends are always among them.
    """
    left = np.arange(len(costs))
    chosen: list[int] = []
    while left.size and len(chosen) < count:
        front = left[pareto_front(costs[left])]
        left = np.setdiff1d(left, front)
        room = count - len(chosen)
        if front.size > room:
            along = front[np.lexsort(rounded_costs(costs[front]).T[::-1])]
            front = along[np.unique(np.linspace(0, front.size - 1, room).round().astype(int))]
        chosen += front.tolist()
    return np.array(sorted(chosen), dtype=np.int64)
