"""The deepest valleys of what reliefs of loaded flanks leave: descents from places far apart, and leaps between them.

What is left over amounts and lengths has valleys that are curved and narrow, along which an amount grows as its length
shrinks; a descent ends where two of them cross. So descents start from many places that are far apart, and from the
best of what they reach go leaps along and across the valleys, each followed by a descent, until none gains any more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.design.flanks.search import descend
from fegear.design.flanks.trials import Tries

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.design.flanks.trials import FlankTrials, Tried

#: Valleys from which leaps go, leaps of tips and of other numbers from each that are followed by a descent, rounds, and
#: the least gain of a round.
_LEAPERS, _FOLLOWED, _ROUNDS, _GAIN = 3, 2, 6, 2e-3
#: By what a leap multiplies amounts, and the power of that by which the lengths that go with them shrink.
_LEAPS, _SHRINKS = (0.7, 1.0, 1.4), 0.4
#: Parts of the shorter length by which one tip relief becomes longer and the other shorter in a leap.
_TRADED = (-0.2, -0.1, 0.1, 0.2)
#: By what parts of the box a leap changes each other number.
_ASIDE = (-0.15, 0.15)
#: Promised gains, over the value, that end descents: they tell valleys apart, the best is led on.
_SCOUTED, _SETTLED = 2e-3, 1e-5
#: Descents from starts at most, and how far apart these are in at least one number, over the box.
_DESCENTS, _APART = 24, 0.1
#: Part of the progress for the descents from starts.
_DESCENDED = 0.6
#: Tips: amount and length of driver and driven gear.
_TIPS = 4


def keeps(tried: Tried, most_factor: float) -> bool:
    """Whether K_Hbeta is nowhere above a limit."""
    return most_factor == np.inf or float(tried.face_load_factor.max()) <= most_factor


class _Start(NamedTuple):
    """What is left at the start of a descent [m], its nine numbers, and what was found there."""

    value: float
    at: Array
    tried: Tried


def _left(one: tuple[float, Array] | _Start) -> float:
    return one[0]


def _far_apart(starts: Iterable[_Start], box: tuple[Array, Array]) -> Iterator[_Start]:
    """Those of starts, the best first, that are far from all before them; small amounts count more."""
    low, high = box
    span = np.where(high > low, high - low, np.inf)
    seen: list[Array] = []
    for start in starts:
        place = np.sqrt(np.clip((start.at - low) / span, 0.0, 1.0))
        if len(seen) < _DESCENTS and all(np.abs(place - other).max() > _APART for other in seen):
            seen.append(place)
            yield start


def leaps(numbers: Array, box: tuple[Array, Array]) -> tuple[list[Array], list[Array], list[Array]]:
    """Reliefs beside one: tips larger or smaller, one longer as the other is shorter; each other number either way."""
    low, high = box
    free = high > low
    tips, traded, others = [], [], []
    if free[:_TIPS].any():
        for first, second, shrinks in product(_LEAPS, _LEAPS, (0.0, _SHRINKS)):
            if first != 1.0 or second != 1.0:
                one = numbers.copy()
                one[:_TIPS] *= first, first**-shrinks, second, second**-shrinks
                tips.append(np.clip(one, low, high))
        for part in _TRADED:
            one = numbers.copy()
            one[1:_TIPS:2] += np.array([part, -part]) * numbers[1:_TIPS:2].min()
            traded.append(np.clip(one, low, high))
    for k in np.flatnonzero(free):
        for part in _ASIDE if k >= _TIPS else ():
            one = numbers.copy()
            one[k] += part * (high[k] - low[k])
            others.append(np.clip(one, low, high))
    return tips, traded, others


def deepest_valleys(
    few: FlankTrials, more: FlankTrials, starts: Iterable[Array], box: tuple[Array, Array],
    most_factor: float = np.inf, floors: Iterable[Array] = (), progress: Callable[[float], None] | None = None,
) -> list[tuple[float, Array]]:  # fmt: skip
    """Descend from every start, and leap on from the best of what is reached.

    Parameters
    ----------
    few, more : FlankTrials
        At few roll positions, by which leaps are chosen, and at those that count.
    starts : iterable of ndarray, shape (9,)
        Numbers of ground reliefs.
    box : tuple of ndarray, shape (9,)
        Least and largest numbers.
    most_factor : float
        Largest K_Hbeta that is allowed, at all loads and misalignments.
    floors : iterable of ndarray, shape (9,)
        Further starts, each in a valley of its own: from all of them goes a descent.
    progress : callable, optional
        Of the whole: first of the descents, then of the rounds of leaps, of which there may be fewer.

    Returns
    -------
    list of (float, ndarray)
        What is left [m] and where, the best first; empty where no start keeps to the largest K_Hbeta.
    """
    report = progress or (lambda _fraction: None)

    tries = Tries(more, box[1] - box[0])

    def begun(at: Array, near: Tried | None = None) -> _Start | None:
        tried = tries.of(at) if near is None else more.of_numbers(at, near=near)
        return _Start(more.value(tried.peak_to_peak), at, tried) if keeps(tried, most_factor) else None

    def led(start: _Start) -> tuple[float, Array]:
        return descend(more, start.at, start.value, box, most_factor, _SCOUTED, start.tried)

    def quickly(at: Array, near: Tried) -> float:
        return few.value(few.of_numbers(at, near=near).peak_to_peak)

    known = sorted((one for one in map(begun, starts) if one is not None), key=_left)
    apart = [*(one for one in map(begun, floors) if one is not None), *_far_apart(known, box)]
    if not apart:
        return []
    reached = []
    for number, start in enumerate(apart):
        reached.append(led(start))
        report(_DESCENDED * (number + 1) / len(apart))
    reached = sorted(reached, key=_left)[:_LEAPERS]
    for turn in range(_ROUNDS):
        before = reached[0][0]
        for k, (value, at) in enumerate(reached):
            report(1.0 - (1.0 - _DESCENDED) * 0.5 ** (turn + k / len(reached)))
            here, rough = more.of_numbers(at), few.of_numbers(at)
            ordered = (sorted(some, key=partial(quickly, near=rough)) for some in leaps(at, box))
            beside = [begun(one, here) for some in ordered for one in some[:_FOLLOWED]]
            reached[k] = min([(value, at), *(led(one) for one in beside if one is not None)], key=_left)
        reached.sort(key=_left)
        if reached[0][0] > (1.0 - _GAIN) * before:
            break
    value, at = reached[0]
    return [descend(more, at, value, box, most_factor, _SETTLED), *reached[1:]]
