"""Loads that a relief is designed for together; light, for the plan of a case has it too."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Floats

#: Loads of a spectrum that a design counts apart at most: each costs a search as much as a torque of a range.
MOST_LEVELS = 8

#: Loads closer than this are one [relative].
_SAME = 1e-9

#: Excitation of equally good reliefs of a chart above the least, over it: what can be read from a chart.
NEAR = 0.1


@dataclass(frozen=True)
class LoadRange:
    """Loads that a relief is designed for together.

    Parameters
    ----------
    loads : tuple of float
        [N], ascending.
    weights : tuple of float, optional
        What each counts, over the largest; all the same by default.
    shares : tuple of float, optional
        Of the time, where the loads are those of a spectrum.
    """

    loads: tuple[float, ...]
    weights: tuple[float, ...] | None = None
    shares: tuple[float, ...] | None = None


def of_spectrum(loads: Sequence[float], shares: Sequence[float]) -> LoadRange | None:
    """Loads of a spectrum, weighted by their shares of time; None where nothing is loaded at any time.

    Bins without load or without time do not count. Bins of one load are one; of more than `MOST_LEVELS` the two
    neighbours with the smallest ratio are combined, again and again, to their mean over the time. That also keeps the
    weight of a load from depending on into how many bins it was divided.

    Parameters
    ----------
    loads : sequence of float
        Of the bins [N].
    shares : sequence of float
        Of the time, or times [s].
    """
    total = math.fsum(shares)
    levels = sorted((load, share / total) for load, share in zip(loads, shares, strict=True) if load > 0 and share > 0)
    while len(levels) > 1:
        ratios = [above[0] / below[0] for below, above in pairwise(levels)]
        i = ratios.index(min(ratios))
        if len(levels) <= MOST_LEVELS and ratios[i] > 1.0 + _SAME:
            break
        share = levels[i][1] + levels[i + 1][1]
        mean = (levels[i][0] * levels[i][1] + levels[i + 1][0] * levels[i + 1][1]) / share
        levels[i : i + 2] = [(levels[i][0] if ratios[i] <= 1.0 + _SAME else mean, share)]
    if not levels:
        return None
    combined, times = zip(*levels, strict=True)
    alike = max(times) - min(times) <= _SAME
    return LoadRange(combined, None if alike else times, times)


def proportions(loads: Floats, weights: Floats | None = None) -> Floats:
    """By what the excitation at each load is multiplied before the worst is taken, shape (L,).

    In proportion to the load, at the largest; and to its weight, over the largest weight.
    """
    part = loads.max() / loads
    return np.asarray(part if weights is None else part * (weights / weights.max()))
