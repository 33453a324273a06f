"""The tip reliefs of teeth with a width that leave the least: a grid, descents from places far apart, and leaps.

What is left over two amounts and two lengths has valleys that are curved and narrow, along which an amount grows as its
length shrinks; a descent ends where two of them cross. So descents start from many places of the grid that are far
apart, and from the best of what they reach go leaps along and across the valleys, each followed by a descent, until
none gains any more.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from fegear.base.arrays import Array
from fegear.design.flanks.families import FamilyBest, quick_values
from fegear.design.flanks.grid import ReliefGrid
from fegear.design.flanks.quick import quick_flanks
from fegear.design.flanks.search import descend
from fegear.design.flanks.tip_bench import TipTrials
from fegear.geometry.pair import GearPair

#: Amounts that are tried, over the mean transmission error, and lengths over the path of contact.
_AMOUNTS, _LENGTHS = (0.15, 0.4, 0.8, 1.5, 3.0, 6.0), (0.1, 0.17, 0.27, 0.4, 0.55, 0.75, 1.0)
#: What a tip may lose at most [modules].
_DEEPEST = 0.1
#: Coarse panels of the quick way; reliefs loaded exactly; descents, and how far apart their starts are, over the box.
_PANELS, _EXACT, _DESCENTS, _APART = 5, 160, 24, 0.1
#: Places from which leaps go, leaps of each that are followed by a descent, rounds, and the least gain of a round.
_LEAPERS, _FOLLOWED, _ROUNDS, _GAIN = 3, 2, 6, 2e-3
#: By what a leap multiplies amounts, and the power of that by which the lengths that go with them shrink.
_LEAPS, _SHRINKS = (0.7, 1.0, 1.4), 0.4
#: Promised gains that end descents.
_SCOUTED, _SETTLED = 2e-3, 1e-5


def tip_grid(pair: GearPair, mean: float) -> ReliefGrid:
    """Amounts and lengths that are tried; what is found lies between their ends.

    Parameters
    ----------
    pair : GearPair
    mean : float
        Transmission error at the largest load [m].
    """
    deepest = _DEEPEST * pair.driver.module
    amounts = tuple(min(mean * share, deepest) for share in _AMOUNTS)
    return ReliefGrid(amounts, tuple(pair.path_length * share for share in _LENGTHS), (), (), (), (), ())


def _far_apart(starts: Array, box: tuple[Array, Array]) -> Iterator[Array]:
    """Those of starts, the best first, that are far from all before them; small amounts count more."""
    low, high = box
    span = np.where(high > low, high - low, 1.0)
    seen: list[Array] = []
    for one in starts:
        place = np.sqrt((one - low)[:4] / span[:4])
        if all(np.abs(place - other).max() > _APART for other in seen):
            seen.append(place)
            yield one


def _leaps(numbers: Array, box: tuple[Array, Array]) -> Iterator[Array]:
    """Reliefs beside one: amounts of one gear or both larger or smaller, lengths with them or as they are."""
    low, high = box
    for first, second, shrinks in product(_LEAPS, _LEAPS, (0.0, _SHRINKS)):
        if first != 1.0 or second != 1.0:
            one = numbers.copy()
            one[:4] *= first, first**-shrinks, second, second**-shrinks
            yield np.clip(one, low, high)


def best_tips(trials: TipTrials) -> FamilyBest:
    """The tip reliefs of both gears that leave the least, of the shape of the trials.

    Parameters
    ----------
    trials : TipTrials
        Under the loads that count.
    """
    few, more = trials.few, trials.more
    plain = few.of_gap(np.zeros(few.known.lines.x.shape)).found[0]
    grid = tip_grid(few.pair, float(plain.mean_transmission_error[-1]))
    quick = quick_flanks(few.known, plain.contact.force[:, :, -1], _PANELS, few.cells)
    numbers, rough, _ = quick_values(quick, few, "profile", grid)
    order = np.argsort(rough, kind="stable")
    tried = order[:_EXACT]
    exact = np.array([few.value(few.of_numbers(numbers[i]).peak_to_peak) for i in tried])
    error = max(float((rough[tried] - exact).max()), 0.0)
    proven = tried.size == order.size or float(rough[order[tried.size]]) - error > exact.min()
    box = grid.limits("profile")

    def left(at: Array) -> float:
        return more.value(more.of_numbers(at).peak_to_peak)

    starts = numbers[tried[np.argsort(exact, kind="stable")]]
    chosen = [one for one, _ in zip(_far_apart(starts, box), range(_DESCENTS), strict=False)]
    reached = [descend(more, one, left(one), box, np.inf, _SCOUTED) for one in chosen]
    reached.sort(key=lambda one: one[0])
    leapers = reached[:_LEAPERS]
    for _ in range(_ROUNDS):
        before = leapers[0][0]
        for k, (value, at) in enumerate(leapers):
            every = list(_leaps(at, box))
            order = np.argsort([few.value(few.of_numbers(one).peak_to_peak) for one in every], kind="stable")
            beside = [every[i] for i in order[:_FOLLOWED]]
            found = [descend(more, one, left(one), box, np.inf, _SCOUTED) for one in beside]
            leapers[k] = min([(value, at), *found], key=lambda one: one[0])
        leapers.sort(key=lambda one: one[0])
        if leapers[0][0] > (1.0 - _GAIN) * before:
            break
    value, at = descend(more, leapers[0][1], leapers[0][0], box, np.inf, _SETTLED)
    on_grid = int(tried[int(exact.argmin())])
    return FamilyBest(
        "profile", few.relief(numbers[on_grid]), few.relief(at), value, len(numbers), int(tried.size),
        float(exact.min()), error, proven,
    )  # fmt: skip
