"""Loads that a relief is designed for together; light, for the plan of a case has it too."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Floats

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
    """

    loads: tuple[float, ...]
    weights: tuple[float, ...] | None = None


def proportions(loads: Floats, weights: Floats | None = None) -> Floats:
    """By what the excitation at each load is multiplied before the worst is taken, shape (L,).

    In proportion to the load, at the largest; and to its weight, over the largest weight.
    """
    part = loads.max() / loads
    return np.asarray(part if weights is None else part * (weights / weights.max()))
