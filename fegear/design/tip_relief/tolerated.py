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
from fegear.design.tip_relief.tip_tolerance import NOTHING, TipTolerance
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
    each with each; which combination is the best and which are among the worst is found on one grid, what these leave
    with every kink.

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
    ends: list[list[Relief]] = [
        [allowed.off(gear, tip, *off) for off in product((-1, 0, 1), repeat=2)]
        if tip.amount > NOTHING else [UNMODIFIED]
        for gear, tip, allowed in zip(gears, tips, tolerances, strict=True)
    ]  # fmt: skip
    both = list(product(*ends))
    table = bench(engagement, order=6)
    removals = np.repeat(np.stack([table.removal(*each) for each in both], axis=2), w.size, axis=2)
    seen = table.errors(removals, np.tile(w, len(both))).peak_to_peak.reshape(-1, w.size)

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
