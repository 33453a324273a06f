"""Which variants none is better than, and in which order they stand: Pareto fronts and the rule for ties.

Costs are numbers of which each is better the smaller it is. A variant is dominated where another is no worse in any
cost and better in one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index, Mask

#: Variants of the least sum of ranks, by which all others are thinned first, in rounds of so many, and the share that
#: must be left at most of a round for another to pay.
_ROUNDS, _PAYS = (8, 64, 256), 0.8
#: Parts that are compared one with the other.
_FEW = 64
#: Comparisons that are made at once.
_AT_ONCE = 16_384
#: Significant digits in which costs differ.
_DIGITS = 9


def rounded_costs(costs: Array, digits: int = _DIGITS) -> Array:
    """Costs to so many significant digits: what differs in the last bit is equal."""
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.where(costs == 0.0, 1.0, 10.0 ** (digits - 1 - np.floor(np.log10(np.abs(costs)))))
        return np.where(np.isfinite(costs), np.round(costs * size) / size, costs)


def pareto_front(costs: Array) -> Index:
    """Places of the costs, shape (N, k), that none dominates, ascending; what has a NaN is compared with none.

    Equal costs count once. In their lexical order nothing dominates what stands before it, so a front is that of the
    first half and what this leaves of the front of the second, by one cost less (Kung, Luccio, Preparata).
    """
    costs = rounded_costs(np.asarray(costs, dtype=float))
    if not costs.size:
        return np.arange(len(costs))
    known = np.flatnonzero(~np.isnan(costs).any(axis=1))
    ranks, group = _ranks(costs[known])
    on = np.zeros(len(ranks), dtype=bool)
    on[_front(ranks, _thinned(ranks))] = True
    alive = np.ones(len(costs), dtype=bool)
    alive[known] = on[group]
    return np.flatnonzero(alive)


def _ranks(costs: Array) -> tuple[Index, Index]:
    """Costs that differ, as whole numbers in lexical order, and which of them each is."""
    ranks = np.stack([np.unique(column, return_inverse=True)[1].reshape(-1) for column in costs.T], axis=1)
    order = np.lexsort(ranks.T[::-1])
    rising = ranks[order]
    new = np.ones(len(costs), dtype=bool)
    new[1:] = (rising[1:] != rising[:-1]).any(axis=1)
    group = np.empty(len(costs), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    return rising[new], group


def _thinned(ranks: Index) -> Index:
    """Places of what none of those with the least sums of ranks dominates."""
    places = np.arange(len(ranks))
    total = ranks.sum(axis=1)
    before = 2 * places.size
    for count in _ROUNDS:
        if places.size < 4 * count or places.size > _PAYS * before:
            break
        before = places.size
        best = places[np.argpartition(total[places], count)[:count]]
        for one in best.tolist():
            worse = (ranks[places] >= ranks[one]).all(axis=1)
            places = places[~worse | (places == one)]
    return places


def _front(ranks: Index, places: Index) -> Index:
    """Of places in lexical order, those that none dominates."""
    if places.size <= _FEW:
        return places[~_covered(ranks[places, 1:], ranks[places, 1:], before=True)]
    half = places.size // 2
    first, second = _front(ranks, places[:half]), _front(ranks, places[half:])
    return np.concatenate([first, second[~_beaten(ranks[first, 1:], ranks[second, 1:])]])


def _covered(first: Index, second: Index, *, before: bool = False) -> Mask:
    """Which of the second have one of the first that is no worse in any column; `before`: of those before it only."""
    found = np.ones((len(second), len(first)), dtype=bool)
    for k in range(first.shape[1]):
        found &= first[:, k] <= second[:, k, None]
    return np.asarray((np.tril(found, -1) if before else found).any(axis=1))


def _beaten(first: Index, second: Index) -> Mask:
    """The same of many, in halves by the last column until one or two columns are left."""
    beaten = np.zeros(len(second), dtype=bool)
    if not (len(first) and len(second)):
        return beaten
    columns = first.shape[1]
    if columns == 0:
        return ~beaten
    if columns == 1:
        return np.asarray(first[:, 0].min() <= second[:, 0])
    if len(first) * len(second) <= _AT_ONCE:
        return _covered(first, second)
    if columns == 2:
        order = np.argsort(first[:, 0], kind="stable")
        least = np.minimum.accumulate(first[order, 1])
        at = np.searchsorted(first[order, 0], second[:, 0], side="right") - 1
        return np.asarray((at >= 0) & (least[np.maximum(at, 0)] <= second[:, 1]))
    own, other = first[:, -1], second[:, -1]
    if own.max() <= other.min():
        return _beaten(first[:, :-1], second[:, :-1])
    both = np.concatenate([own, other])
    middle = np.partition(both, both.size // 2)[both.size // 2]
    if middle == both.max():
        middle = both[both < middle].max()
    low, near = own <= middle, other <= middle
    beaten[near] = _beaten(first[low], second[near])
    far = np.flatnonzero(~near)
    beaten[far] = _beaten(first[low][:, :-1], second[far][:, :-1])
    left = far[~beaten[far]]
    beaten[left] = _beaten(first[~low], second[left])
    return beaten


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


def best_by_ranks(costs: Array, count: int) -> Index:
    """Places of the costs with the least sums of ranks, `count` at most, ascending; where fronts take too long."""
    if len(costs) <= count:
        return np.arange(len(costs))
    ranks = [np.unique(column, return_inverse=True)[1].reshape(-1) for column in rounded_costs(costs).T]
    shares = np.sum([rank / max(int(rank.max()), 1) for rank in ranks], axis=0)
    return np.sort(np.argsort(shares, kind="stable")[:count])
