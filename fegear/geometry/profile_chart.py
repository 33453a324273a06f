"""The profile chart (K-chart) of a relieved flank: few points, and straight lines between them that stay close."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.arrays import Array
    from fegear.geometry.relief import Relief

#: Even places among which points are sought, and those between two kinks.
_PLACES, _BETWEEN = 2001, 401


def chart_points(relief: Relief, low: float, high: float, within: float, keep: Sequence[float] = ()) -> Array:
    """Roll angles of the points of a profile chart.

    Parameters
    ----------
    relief : Relief
    low, high : float
        Ends of the profile [rad]: the first and the last point.
    within : float
        How far the relief may lie from the straight lines between the points [m].
    keep : sequence of float
        Roll angles that are points in any case [rad], where they lie between the ends.

    Returns
    -------
    ndarray, shape (N,)
        [rad], rising.

    Notes
    -----
    Where a line misses the relief by more than `within`, a point is put to where it misses it most (Ramer, Douglas and
    Peucker), kinks of the relief among the places that are tried.
    """
    inside = [float(one) for one in (*relief.kinks, *keep) if low < one < high]
    corners = sorted({low, *inside, high})
    between = [np.linspace(*ends, _BETWEEN) for ends in pairwise(corners)]
    roll = np.unique(np.concatenate([np.linspace(low, high, _PLACES), *between]))
    removal = relief.removal(roll)
    fixed = np.searchsorted(roll, [low, high, *(one for one in keep if low < one < high)])
    points = sorted({int(one) for one in fixed})
    waiting = list(pairwise(points))
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        part = slice(first, last + 1)
        line = np.interp(roll[part], roll[[first, last]], removal[[first, last]])
        worst = first + int(np.argmax(np.abs(removal[part] - line)))
        if abs(removal[worst] - line[worst - first]) > within:
            points.append(worst)
            waiting += [(first, worst), (worst, last)]
    return np.asarray(roll[sorted(points)])
