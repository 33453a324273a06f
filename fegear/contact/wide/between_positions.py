"""Where extreme values of a pair over its base pitches may stand between roll positions.

Transmission errors have kinks where tip edges come into contact (`over_pitch.likely_peaks`); secant stiffness jumps
there, at a place that only the loads know.
"""

from __future__ import annotations

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.wide.over_pitch import JUMP, likely_peaks

#: What a curve changes between positions on both sides of a place, as a share of its range, where it does not jump.
_STEADY = 1e-3
#: Places in different base pitches that are the same, as a share of a base pitch.
_SAME = 1e-4
#: How much steeper than the curve on its higher side an interval is that may hide a jump.
_STEEPER = 3.0


def between_positions(x: Array, values: Array, period: float, pitch: float) -> tuple[Array, Array]:
    """Where the largest of a curve may stand between positions, and by how much above all that are known.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Ascending within a period.
    values : ndarray, shape (P,)
    period : float
    pitch : float
        Base pitch.

    Returns
    -------
    places : ndarray, shape (Q, 1, 2)
        Where to look.
    height : ndarray, shape (Q, 1)
        Negative where nothing is expected.
    """
    same = np.abs(np.diff(values)) < _STEADY * np.ptp(values)
    kept = np.append(True, ~(same & (np.diff(x) < JUMP * pitch)))
    x, values = x[kept], values[kept]
    places, height = likely_peaks(x, values[:, None], period, JUMP * pitch)
    step = np.diff(x, append=x[0] + period)
    rise = (np.roll(values, -1) - values) / step
    jump = step < JUMP * pitch
    ahead = np.where(np.roll(jump, 1), 0.0, np.roll(rise, 1))
    behind = np.where(np.roll(jump, -1), 0.0, np.roll(rise, -1))
    # An interval that is much steeper than the curve on its higher side may hide a jump, up to which that side goes on:
    # no steeper than over its last two intervals, of which one may hide a jump itself.
    falls, rises = -rise > _STEEPER * np.abs(ahead), rise > _STEEPER * np.abs(behind)
    before, after = np.roll(ahead, 1), np.roll(behind, -1)
    up, down = np.maximum(np.minimum(ahead, before), 0.0), np.maximum(np.minimum(-behind, -after), 0.0)
    higher = np.where(falls, values + up * step, -np.inf)
    higher = np.where(rises, np.roll(values, -1) + down * step, higher) - values.max()
    higher = np.where(jump, -np.inf, higher)[:, None]
    halfway = (x + 0.5 * step)[:, None, None]
    return np.where((higher > height)[..., None], halfway, places), np.maximum(height, higher)


def folded(places: Array, height: Array, start: float, pitch: float) -> tuple[Array, Array]:
    """The same of all base pitches within one from `start` on: where they look at the same place, the highest only."""
    at = np.mod(places - start, pitch)
    order = np.argsort(-height[:, 0], kind="stable")
    _, first = np.unique(np.round(at[order, 0, 0] / (_SAME * pitch)), return_index=True)
    kept = order[first]
    return at[kept] + start, height[kept]
