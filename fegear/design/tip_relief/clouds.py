"""Reliefs tried together with others just beside them: differences of their slopes are curvatures.

Extremes have curvatures by a step of each number upward. Where one of them goes past a kink, a step downward is tried,
too, and the smaller curvature counts; where it did so once it is taken to do so again.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fegear.base.arrays import Floats, Mask
from fegear.design.tip_relief.trials import Trials, Tried

#: Step of the differences, in the units of the numbers.
STEP = 3e-6
#: What is seen this close to the extremes takes part, over what is left.
NEAR = 0.12
#: A curvature above this, in the units of the numbers and over what is left, is a kink that a difference went past.
_KINKED = 3e3


@dataclass(frozen=True, slots=True)
class Cloud:
    """A relief and those beside it.

    Parameters
    ----------
    tried : Tried
        Of five candidates, itself and above in each number; or of nine, below in each at last.
    left : float
        What it leaves [m].
    kinked : bool
        Whether a step upward goes past a kink.
    """

    tried: Tried
    left: float
    kinked: bool


def tried_clouds(
    trials: Trials, places: Floats, unit: Floats, kinked: Mask
) -> tuple[list[Cloud], int]:  # fmt: skip
    """Try reliefs and those beside them.

    Parameters
    ----------
    trials : Trials
    places : ndarray, shape (B, 4)
    unit : ndarray, shape (4,)
    kinked : ndarray of bool, shape (B,)
        Whether steps upward are known to go past a kink.

    Returns
    -------
    clouds : list of Cloud
    evaluations : int
    """
    both = trials.metric != "peak_to_peak"  # harmonics have slopes by differences, too: of both sides
    steps = STEP * np.diag(unit)
    rows = [
        np.concatenate([p[None], p + steps, *([p - steps] if both or below else [])])
        for p, below in zip(places, kinked, strict=True)
    ]  # fmt: skip
    parts, count = _each(trials.exact(np.concatenate(rows)), [len(one) for one in rows]), sum(map(len, rows))
    left = trials.left(*(np.stack([getattr(part, name)[0] for part in parts]) for name in ("seen", "low")))
    if both:
        return [Cloud(part, float(at), kinked=False) for part, at in zip(parts, left, strict=True)], count
    missing = [
        i for i, (part, at) in enumerate(zip(parts, left, strict=True))
        if not kinked[i] and at > 0.0 and _past_a_kink(part, float(at), unit)
    ]  # fmt: skip
    if missing:
        more = _each(trials.exact((places[missing][:, None] - steps).reshape(-1, 4)), [4] * len(missing))
        for i, below in zip(missing, more, strict=True):
            parts[i] = _behind(parts[i], below)
    clouds = [
        Cloud(part, float(at), bool(one) or i in missing)
        for i, (part, at, one) in enumerate(zip(parts, left, kinked, strict=True))
    ]
    return clouds, count + 4 * len(missing)


def _each(tried: Tried, counts: list[int]) -> list[Tried]:
    """Of candidates in a row those that belong together."""
    ends = np.cumsum([0, *counts]).tolist()
    return [tried.of(slice(a, b)) for a, b in pairwise(ends)]


def _past_a_kink(tried: Tried, left: float, unit: Floats) -> bool:
    """Whether a step upward goes past a kink somewhere near the extremes."""
    for values, slopes, sign in ((tried.seen, tried.slope, 1.0), (tried.low, tried.low_slope, -1.0)):
        v = sign * values / left
        near = v[0] > v[0].max(axis=-1, keepdims=True) - NEAR
        change = np.abs(slopes[1:, :, near] - slopes[:1, :, near]).max(axis=2, initial=0.0) * unit / left
        if not np.isfinite(v[1:, near]).all() or change.max() > _KINKED * STEP:
            return True
    return False


def _behind(first: Tried, others: Tried) -> Tried:
    """Candidates and others behind them."""
    return Tried(
        np.concatenate([first.seen, others.seen]), np.concatenate([first.slope, others.slope]),
        np.concatenate([first.low, others.low]), np.concatenate([first.low_slope, others.low_slope]),
    )  # fmt: skip
