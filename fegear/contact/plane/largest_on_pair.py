"""Largest load on a tooth pair and largest pressure of smooth flanks: between the positions of a table, too.

A pair bears most where the next one comes into contact, a kink, or where curves turn; neither is at a position. Two
solutions at the same positions miss a peak alike, so no comparison of them shows by how much.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.loaded_teeth import Largest
from fegear.contact.plane.independent_errors import independent_errors
from fegear.contact.plane.pair_history import PairHistory, followed
from fegear.contact.plane.peaks import LACKS, LEFT, PASSES, refined_peaks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.contact.plane.engagement import Engagement

#: Of a value, what is left of its digits where nothing else is uncertain.
_DIGITS = 1e-9
#: Of a share: the whole load is one.
_ROUND_OFF = 1e-13
#: Peaks of each curve that are followed.
_FOLLOWED = 3
#: Where the shifted solutions are looked at beside a peak, in distances of two positions, and how often what brackets
#: theirs is narrowed: a kink moves with the shift, and is found to some per cent of its way however short that is.
_BESIDE, _NARROWED = (0.0, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 2.0), 2


def largest_on_pair(
    e: Engagement, shifted: Sequence[Engagement], load: float, history: PairHistory, at: int, passes: int = PASSES
) -> Largest | None:
    """Look for the largest values of a pair between its positions, and again with each compliance off by its error.

    Parameters
    ----------
    e : Engagement
    shifted : sequence of Engagement
        The same with one compliance each off by its error; without any no error is known (NaN).
    load : float
        Whole load [N].
    history : PairHistory
        The pair at the positions of its table.
    at : int
        Number of that load in it.
    passes : int
        How often what brackets a peak is narrowed.

    Returns
    -------
    Largest or None
        None of a pair that bears nothing.
    """
    if not history.load[:, at].any():
        return None
    x, sampled = history.x, np.stack([history.share[:, at], _smooth(e, history.x, history.hertz_pressure[:, at])])
    where, value = refined_peaks(lambda to: sampled if to is x else _curves(e, load, to), x, LACKS, _FOLLOWED, passes)
    error = np.full(2, np.nan)
    if shifted:
        error = _own_errors(e, shifted, load, where) * value
        beside = _beside(x, where)
        changes = [
            refined_peaks(partial(_curves, other, load), beside, LACKS, _FOLLOWED, _NARROWED)[1] for other in shifted
        ]
        error = np.maximum(error, np.abs(np.array(changes) - value).sum(axis=0))
        error += [_left_of_kink(x, curve, *peak) for curve, *peak in zip(sampled, where, value, strict=True)]
        # a whole load is exact; of a pressure digits are always left
        error[0] = error[0] if error[0] > _ROUND_OFF else 0.0
        error[1] = max(error[1], _DIGITS * value[1])
    return Largest(
        float(value[0]), float(error[0]), float(value[1]), float(error[1]), f"at x = {where[1] * 1e3:.5g} mm"
    )


def _curves(e: Engagement, load: float, x: Array) -> Array:
    """Share of the load, and pressure on smooth flanks [Pa], shape (2, P): none at corners."""
    found, _ = followed(e, [load], x, again=False)
    return np.stack([found.share[:, 0], _smooth(e, x, found.hertz_pressure[:, 0])])


def _smooth(e: Engagement, x: Array, pressure: Array) -> Array:
    return np.where((x < e.pair.x_start) | (x > e.pair.x_end), 0.0, pressure)


def _beside(x: Array, peaks: Array) -> Array:
    """Positions about peaks, ever denser towards them, ascending."""
    cell = float(np.diff(x).max())
    steps = cell * np.array([-step for step in _BESIDE[:0:-1]] + list(_BESIDE))
    return np.unique(np.clip(peaks[:, None] + steps, x[0], x[-1]))


def _left_of_kink(x: Array, samples: Array, at: float, value: float) -> float:
    """How far a curve may rise above a peak that was found: at a kink, by the gentler of both slopes."""
    below, above = np.flatnonzero(x < at), np.flatnonzero(x > at)
    if not (below.size and above.size):
        return 0.0
    ends = below[-1], above[0]
    slope = min((value - float(samples[end])) / abs(float(x[end]) - at) for end in ends)
    return max(slope, 0.0) * float(x[ends[1]] - x[ends[0]]) * LEFT


def _own_errors(e: Engagement, shifted: Sequence[Engagement], load: float, x: Array) -> Array:
    """What errors of single pairs change of the share and of the pressure, each at its place, shape (2,), relatively.

    A pressure grows with the root of the load.
    """
    path = e.pair.x_start, e.pair.x_end
    found, apart = followed(e, [load], x, more=lambda state: independent_errors(state, shifted, path).load, again=False)
    return np.array([1.0, 0.5]) * apart[:, 0] / found.load[:, 0]
