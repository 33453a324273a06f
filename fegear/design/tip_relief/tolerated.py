"""What tip reliefs leave when amounts and lengths are off by what a drawing allows."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design.relief_bench import bench
from fegear.design.tip_relief.tip_tolerance import NOTHING, TIP_NUMBERS, Decisive, TipTolerance
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import UNMODIFIED, EndRelief, Relief

#: Combinations that are the worst by the grid and are looked at with every kink: lengths of a relief that is not in
#: contact change nothing, so that three are one. By the first only, the largest was up to 0.4 % too small.
_NEAREST = 6


def within_tolerances(
    engagement: Engagement, tips: tuple[EndRelief, EndRelief], tolerances: tuple[TipTolerance, TipTolerance],
    loads: ArrayLike,
) -> tuple[Array, tuple[Decisive | None, ...]]:  # fmt: skip
    """Least and largest peak-to-peak transmission error at each load, shape (L, 2) [m], and what decides at each.

    Amounts and lengths of both reliefs are at the lower end, in the middle and at the upper end of their tolerances,
    each with each; which combination is the best and which are among the worst is found on one grid, what these leave
    with every kink. What decides is by the grid, its values relative to the largest with every kink; None where nothing
    is ground.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs are replaced.
    tips : tuple of EndRelief
        Of driver and driven gear; one of no amount stays what it is.
    tolerances : tuple of TipTolerance
        Of driver and driven gear.
    loads : array_like, shape (L,)
        [N].
    """
    w = np.atleast_1d(np.asarray(loads, dtype=float))
    gears = engagement.pair.driver, engagement.pair.driven
    steps = list(product((-1, 0, 1), repeat=2))
    ends: list[list[Relief]] = [
        [allowed.off(gear, tip, *off) for off in steps]
        if tip.amount > NOTHING else [UNMODIFIED]
        for gear, tip, allowed in zip(gears, tips, tolerances, strict=True)
    ]  # fmt: skip
    both = list(product(*ends))
    offs = np.array(list(product(*(steps if len(each) > 1 else [(0, 0)] for each in ends)))).reshape(len(both), 4)
    table = bench(engagement, order=6)
    removals = np.repeat(np.stack([table.removal(*each) for each in both], axis=2), w.size, axis=2)
    seen = table.errors(removals, np.tile(w, len(both))).peak_to_peak.reshape(-1, w.size)

    def left(which: int, load: float) -> float:
        driver, driven = both[which]
        ground = replace(engagement, driver_relief=driver, driven_relief=driven)
        return transmission_error(ground, load, 12).peak_to_peak

    found = np.empty((w.size, 2))
    decisive: list[Decisive | None] = []
    for i, load in enumerate(w):
        order = np.argsort(seen[:, i])
        found[i, 0] = left(int(order[0]), float(load))
        found[i, 1] = max(left(int(at), float(load)) for at in order[-_NEAREST:])
        part = found[i, 1] / seen[:, i].max()
        without = {
            at: float(seen[offs[:, at] == 0, i].max()) * part for at in range(offs.shape[1]) if np.any(offs[:, at])
        }
        at = min(without, key=lambda one: without[one], default=None)
        decisive.append(None if at is None else Decisive(MEMBERS[at // 2], TIP_NUMBERS[at % 2], float(without[at])))
    return found, tuple(decisive)
