"""Descent from many tip reliefs at once to what leaves less, by linear problems within regions of trust."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Floats, Index
from fegear.design.tip_relief.cutting_planes import least_in_box
from fegear.design.tip_relief.trials import Trials, Tried

#: What a round may leave of its own linear problem's promise, and what it must promise to go on, over the value.
_GAP, _ENDED = 0.01, 3e-4
_ROUND_OFF = 1e-10
#: What leaving more than allowed costs, in mean transmission errors of removal, for each time the allowed.
_FINE = 1000.0


@dataclass(frozen=True, slots=True)
class Limits:
    """Box of the four numbers and their units, shape (4,): amounts [m] and lengths over the path.

    Parameters
    ----------
    low, high : ndarray
    unit : ndarray
        Mean transmission error of the unmodified pair [m], and one.
    """

    low: Floats
    high: Floats
    unit: Floats

    def around(self, p: Floats, trust: Floats) -> tuple[Floats, Floats, Floats]:
        """Reach of steps from candidates (C, 4), and the box of steps over it, see `least_in_box`."""
        reach = trust[:, None] * np.maximum(p, 0.2 * self.unit)
        return reach, np.maximum((self.low - p) / reach, -1.0), np.minimum((self.high - p) / reach, 1.0)


@dataclass(frozen=True, slots=True)
class Aim:
    """What is made small: what a relief leaves, or something else among all that leave no more than allowed.

    Parameters
    ----------
    along : ndarray, shape (C, 4), or None
        Of C candidates, by the four numbers in their units; None for what they leave.
    allowed : float
        [m].
    """

    along: Floats | None = None
    allowed: float = 1.0

    def of(self, chosen: Index) -> Aim:
        """That of some of the candidates."""
        return self if self.along is None else Aim(self.along[chosen], self.allowed)

    def like(self, other: Aim) -> bool:
        """Whether another is the same."""
        return self.along is None or other.along is None or bool((self.along == other.along).all())

    def value(self, at: Floats, left: Floats) -> Floats:
        """Of candidates (C, 4) in their units that leave so much, shape (C,)."""
        if self.along is None:
            return left
        return np.asarray((self.along * at).sum(axis=1) + _FINE * np.maximum(left / self.allowed - 1.0, 0.0))

    def slope(self, left: Floats, by_number: Floats) -> Floats:
        """Derivatives by the numbers in their units, shape (C, 4), from those of what is left."""
        if self.along is None:
            return by_number
        return np.asarray(self.along + np.where(left > self.allowed, _FINE / self.allowed, 0.0)[:, None] * by_number)


def _ahead(trials: Trials, tried: Tried, p: Floats, limits: Limits, trust: Floats, aim: Aim) -> tuple[Floats, Floats]:
    """Steps from candidates to the least of the aim, what is seen taken as linear, and that: shapes (C, 4), (C,)."""
    unit = limits.unit
    reach, low, high = limits.around(p, trust)

    def tangent(x: Floats) -> tuple[Floats, Floats]:
        left, slope = trials.tangent(tried, x * reach)
        return aim.value((p + x * reach) / unit, left), aim.slope(left, slope * unit) * (reach / unit)

    x, least, _ = least_in_box(tangent, low, high, _ROUND_OFF, share=_GAP)
    return x * reach, least


def descend(
    evaluate: Callable[[Floats], Tried],
    trials: Trials,
    starts: Floats,
    limits: Limits,
    trust: float,
    rounds: int,
    aim: Aim | None = None,
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
    trust : float
        Extent of the first regions over the starts.
    rounds : int
    aim : Aim, optional
        What is left by default.

    Returns
    -------
    best, values : ndarray, shapes (B, 4), (B,)
        Values of the aim.
    evaluations : int
        Candidates evaluated.
    """
    aim, unit = aim or Aim(), limits.unit
    p, trusted = np.clip(starts, limits.low, limits.high), np.full(starts.shape[0], trust)
    tried = evaluate(p)
    values, evaluations = aim.value(p / unit, trials.left(tried.seen, tried.low)), p.shape[0]
    size = np.abs(values) if aim.along is None else np.ones(values.size)
    active = np.arange(p.shape[0])
    for _ in range(rounds):
        own = aim.of(active)
        step, least = _ahead(trials, tried, p[active], limits, trusted[active], own)
        q = p[active]
        new = np.clip(q + step, limits.low, limits.high)
        new_tried = evaluate(new)
        evaluations += new.shape[0]
        old, new_values = values[active], own.value(new / unit, trials.left(new_tried.seen, new_tried.low))
        better = new_values < old
        trusted[active] *= np.where(old - new_values > 0.6 * (old - least), 1.5, np.where(better, 0.6, 0.3))
        p[active] = np.where(better[:, None], new, q)
        values[active] = np.where(better, new_values, old)
        goes_on = old - least > _ENDED * size[active]
        tried = new_tried.where(better, tried).of(goes_on)
        active = active[goes_on]
        if not active.size:
            break
    return p, values, evaluations
