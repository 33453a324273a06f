"""Descent from many tip reliefs at once to what leaves less, by linear problems within regions of trust."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.design.cutting_planes import least_in_box

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.arrays import Floats
    from fegear.design.relief_trials import Trials, Tried

#: What a round may leave of its own linear problem, and what it must promise to go on, over the value.
_GAP, _ENDED = 0.01, 1e-3


@dataclass(frozen=True, slots=True)
class Limits:
    """Box of the four numbers, shape (4,): amounts [m] and lengths over the path."""

    low: Floats
    high: Floats


def descend(
    evaluate: Callable[[Floats], Tried],
    trials: Trials,
    starts: Floats,
    limits: Limits,
    scale: float,
    trust: float,
    rounds: int,
) -> tuple[Floats, Floats, int]:
    """Lead starts, shape (B, 4), to minima nearby; values never grow.

    In every round what is seen is taken as linear in the four numbers within a region of trust, the least there is
    found, and kept where it is lower indeed; regions grow where it is as low as said, and shrink where it is not.

    Parameters
    ----------
    evaluate : callable
        `trials.rough` or `trials.exact`.
    trials : Trials
    starts : ndarray, shape (B, 4)
    limits : Limits
    scale : float
        Mean transmission error of the unmodified pair [m].
    trust : float
        Extent of the first regions over the starts.
    rounds : int

    Returns
    -------
    best, values : ndarray, shapes (B, 4), (B,)
    evaluations : int
        Candidates evaluated.
    """
    unit = np.array([scale, 1.0, scale, 1.0])
    p, trusted = np.clip(starts, limits.low, limits.high), np.full(starts.shape[0], trust)
    tried = evaluate(p)
    values, evaluations = trials.left(tried.seen, tried.low), p.shape[0]
    active = np.arange(p.shape[0])
    for _ in range(rounds):
        q = p[active]
        reach = trusted[active][:, None] * np.maximum(q, 0.2 * unit)
        low, high = np.maximum((limits.low - q) / reach, -1.0), np.minimum((limits.high - q) / reach, 1.0)

        def tangent(x: Floats, tried: Tried = tried, reach: Floats = reach) -> tuple[Floats, Floats]:
            value, slope = trials.tangent(tried, x * reach)
            return value, slope * reach

        x, least, _ = least_in_box(tangent, low, high, _GAP)
        new = np.clip(q + x * reach, limits.low, limits.high)
        new_tried = evaluate(new)
        evaluations += new.shape[0]
        old, new_values = values[active], trials.left(new_tried.seen, new_tried.low)
        better = new_values < old
        trusted[active] *= np.where(old - new_values > 0.6 * (old - least), 1.5, np.where(better, 0.6, 0.3))
        p[active] = np.where(better[:, None], new, q)
        values[active] = np.where(better, new_values, old)
        goes_on = old - least > _ENDED * old
        tried = new_tried.where(better, tried).of(goes_on)
        active = active[goes_on]
        if not active.size:
            break
    return p, values, evaluations
