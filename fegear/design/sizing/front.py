"""Which variants none is better than, and in which order they stand: Pareto fronts and the rule for ties.

Costs are numbers of which each is better the smaller it is. A variant is dominated where another is no worse in any
cost and better in one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index

#: Costs of one part, and the share that must be left of all for another round of parts not to pay.
_BLOCK, _HELPS = 4000, 0.7
#: Significant digits in which costs differ.
_DIGITS = 9


def rounded_costs(costs: Array, digits: int = _DIGITS) -> Array:
    """Costs to so many significant digits: what differs in the last bit is equal."""
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.where(costs == 0.0, 1.0, 10.0 ** (digits - 1 - np.floor(np.log10(np.abs(costs)))))
    return np.where(np.isfinite(costs), np.round(costs * size) / size, costs)


def _front_of_few(costs: Array) -> Index:
    """Places of the costs that none dominates, each compared with those that live."""
    alive = np.lexsort(costs.T[::-1])  # what dominates a cost stands before it
    front: list[int] = []
    while alive.size:
        one, rest = costs[alive[0]], costs[alive[1:]]
        front.append(int(alive[0]))
        alive = alive[1:][~((rest >= one).all(axis=1) & (rest > one).any(axis=1))]
    return np.array(front, dtype=np.int64)


def pareto_front(costs: Array) -> Index:
    """Places of the costs, shape (N, k), that none dominates, ascending.

    The front of many is that of the fronts of their parts: parts are thinned until that helps no more.
    """
    costs = rounded_costs(np.asarray(costs, dtype=float))
    places = np.arange(len(costs))
    while places.size > _BLOCK:
        parts = [places[first : first + _BLOCK] for first in range(0, places.size, _BLOCK)]
        left = np.concatenate([np.sort(part[_front_of_few(costs[part])]) for part in parts])
        if left.size > _HELPS * places.size:
            places = left
            break
        places = left
    return np.sort(places[_front_of_few(costs[places])])


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
