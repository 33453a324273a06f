"""Which of several designs is to be ground where tolerances take part of their gain, and by how much finer ones pay.

A design with the least transmission error as drawn may leave more than another at the worst place within its
tolerances, and more than no relief at all. Inspection passes both, so that the worst place decides where it is clearly
another's; what is left as drawn decides among the others.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TypeVar

import numpy as np

from fegear.base.arrays import Array

#: Share of what the best as drawn leaves within its tolerances below which another is preferred.
CLEARLY = 0.95
#: Classes of ISO 1328 differ by this factor; so many finer ones are tried where no class is given.
CLASS_STEP, FINEST = math.sqrt(2.0), 8

Name = TypeVar("Name")


def preferred(drawn: Mapping[Name, float], within: Mapping[Name, float]) -> list[Name]:
    """Names of designs, the one to be ground first, the others by what they leave as drawn.

    Parameters
    ----------
    drawn : mapping of name to float
        What each leaves as drawn.
    within : mapping of name to float
        Most that it leaves within its tolerances; of none or of all designs.
    """
    order = sorted(drawn, key=lambda name: drawn[name])
    if not order or order[0] not in within:
        return order
    clear = [name for name in order if within.get(name, math.inf) < CLEARLY * within[order[0]]]
    if clear:
        first = min(clear, key=lambda name: within[name])
        order.remove(first)
        order.insert(0, first)
    return order


def classes_finer(most: Array, none: Array, finer: Callable[[int], Array], finest: int) -> int | None:
    """By how many classes tolerances would have to be finer for a design to pay under every load.

    Parameters
    ----------
    most, none : ndarray, shape (L,)
        What it leaves at most within its tolerances, and what no relief leaves [m].
    finer : callable
        The first with tolerances that are so many classes finer.
    finest : int
        Classes that there are below those given.

    Returns
    -------
    int or None
        0 where the tolerances do as they are, None where no class does.
    """
    if not np.any(most > none):
        return 0
    short, enough = 0, finest  # what finer tolerances contain is contained in coarser ones: halved
    if finest < 1 or np.any(finer(finest) > none):
        return None
    while enough - short > 1:
        middle = (short + enough) // 2
        short, enough = (middle, enough) if np.any(finer(middle) > none) else (short, middle)
    return enough
