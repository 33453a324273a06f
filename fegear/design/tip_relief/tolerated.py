"""What tip reliefs leave when amounts and lengths are off by what a drawing allows.

The profile slope of a flank without relief is off by the same tolerance: a gear that is not ground is not exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design.relief_bench import Bench, bench
from fegear.design.tip_relief.tip_tolerance import (
    NOTHING,
    TIP_NUMBERS,
    Decisive,
    TipTolerance,
    profile_slopes,
)
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import UNMODIFIED, EndRelief, Relief

#: Combinations that are the worst by the grid and are looked at with every kink: lengths of a relief that is not in
#: contact change nothing, so that three are one. By the first only, the largest was up to 0.4 % too small.
_NEAREST = 6


def within_tolerances(
    engagement: Engagement, tips: tuple[EndRelief, EndRelief], tolerances: tuple[TipTolerance, TipTolerance],
    loads: ArrayLike,
) -> Array:  # fmt: skip
    """Least and largest peak-to-peak transmission error at each load, shape (L, 2) [m].

    Amounts and lengths of both reliefs are at the lower end, in the middle and at the upper end of their tolerances,
    each with each, and so is the profile slope of a flank without relief; which combination is the best and which are
    among the worst is found on one grid, what these leave with every kink.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs are replaced.
    tips : tuple of EndRelief
        Of driver and driven gear; one of no amount is none.
    tolerances : tuple of TipTolerance
        Of driver and driven gear.
    loads : array_like, shape (L,)
        [N].
    """
    w = np.atleast_1d(np.asarray(loads, dtype=float))
    both = _combinations(engagement, tips, tolerances)
    seen = _on_grid(bench(engagement, order=6), both, w)

    def left(which: int, load: float) -> float:
        driver, driven = both[which]
        ground = replace(engagement, driver_relief=driver, driven_relief=driven)
        return transmission_error(ground, load, 12).peak_to_peak

    found = np.empty((w.size, 2))
    for i, load in enumerate(w):
        order = np.argsort(seen[:, i])
        found[i, 0] = left(int(order[0]), float(load))
        found[i, 1] = max(left(int(at), float(load)) for at in order[-_NEAREST:])
    return found


def unrelieved_within(
    engagement: Engagement, tolerances: tuple[TipTolerance, TipTolerance], loads: ArrayLike
) -> Array:  # fmt: skip
    """Largest peak-to-peak transmission error without relief at each load, shape (L,) [m].

    What relief is compared with within its tolerances: the profile slopes of both flanks are off by the tolerances of
    the amounts, straight over the path of contact, to either side each.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs are replaced.
    tolerances : tuple of TipTolerance
        Of driver and driven gear.
    loads : array_like, shape (L,)
        [N].
    """
    both = _combinations(engagement, (UNMODIFIED, UNMODIFIED), tolerances)
    flanks = [replace(engagement, driver_relief=driver, driven_relief=driven) for driver, driven in both]
    w = np.atleast_1d(np.asarray(loads, dtype=float))
    return np.array([max(transmission_error(one, float(load), 12).peak_to_peak for one in flanks) for load in w])


def decisive_tolerances(
    engagement: Engagement, tips: tuple[EndRelief, EndRelief], tolerances: tuple[TipTolerance, TipTolerance],
    loads: ArrayLike, most: Array,
) -> tuple[Decisive | None, ...]:  # fmt: skip
    """Which tolerance, once halved, reduces the largest transmission error most at each load; None: nothing is ground.

    By the grid of `within_tolerances`, in proportion to what that has found with every kink.

    Parameters
    ----------
    engagement, tips, tolerances, loads
        As in `within_tolerances`.
    most : ndarray, shape (L,)
        Largest peak-to-peak transmission error within all tolerances [m].
    """
    w = np.atleast_1d(np.asarray(loads, dtype=float))
    table = bench(engagement, order=6)

    def worst(allowed: tuple[TipTolerance, TipTolerance]) -> Array:
        return np.asarray(_on_grid(table, _combinations(engagement, tips, allowed), w).max(axis=0))

    part = most / worst(tolerances)
    found: list[Decisive | None] = [None] * w.size
    for k, number in product(range(2), TIP_NUMBERS):
        gear, tip = engagement.pair.gear(MEMBERS[k]), tips[k]
        given = tolerances[k].amount if number == "amount" else tolerances[k].length_of(gear, tip)
        ground = tip.amount > NOTHING
        if given <= 0.0 or not (ground or number == "amount"):
            continue
        tighter = tolerances[k].halved(number, gear, tip)
        then = part * worst((tighter, tolerances[1]) if k == 0 else (tolerances[0], tighter))
        for i, least in enumerate(found):
            if least is None or then[i] < least.most:
                found[i] = Decisive(MEMBERS[k], number if ground else "profile_slope", float(then[i]), given)
    return tuple(found)


def _combinations(
    engagement: Engagement, tips: tuple[Relief, Relief], tolerances: tuple[TipTolerance, TipTolerance]
) -> list[tuple[Relief, ...]]:
    """Reliefs, or profile slopes without one, at the ends and in the middle of their tolerances, each with each."""
    pair = engagement.pair
    ends: list[list[Relief]] = [
        [allowed.off(pair.gear(member), tip, *off) for off in product((-1, 0, 1), repeat=2)]
        if isinstance(tip, EndRelief) and tip.amount > NOTHING
        else [UNMODIFIED, *profile_slopes(pair, member, allowed.amount)]
        for member, tip, allowed in zip(MEMBERS, tips, tolerances, strict=True)
    ]
    return list(product(*ends))


def _on_grid(table: Bench, reliefs: Sequence[tuple[Relief, ...]], loads: Array) -> Array:
    """Peak-to-peak values that pairs of reliefs leave on a grid at each load, shape (C, L) [m]."""
    removals = np.repeat(np.stack([table.removal(*each) for each in reliefs], axis=2), loads.size, axis=2)
    return np.asarray(table.errors(removals, np.tile(loads, len(reliefs))).peak_to_peak.reshape(-1, loads.size))
