"""Scatter of a measured trace beside a computed curve: what does not repeat at the same place is noise.

A residual has noise and a difference of shape. The difference is a smooth function of the place on the curve, noise is
what differs between samples of (nearly) one place: neighbours along the curve, or the same place in other turns. Only
noise makes a fitted number uncertain; a difference of shape must not widen the limit that it is judged by.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array

#: Normal deviation over its median absolute value.
_OF_MEDIAN = 1.4826
#: Deviations beyond this many of the usual ones count as that many.
_CUT = 5.0
#: Fewest turns whose gains tell how much a gain varies.
_TURNS = 3
#: Turns that a whole one may lack by rounding.
_ROUNDED = 1e-9
#: Part of the mean power of the curve that a turn needs to have a gain of its own.
_POWER = 0.5
#: Samples to each value from which on they are taken in steps, and part of a step that rounding may change a value by.
_EACH, _ROUNDING = 8, 0.02
#: Values nearer than this part of the range are one.
_SAME = 1e-9


def noise_of(place: Array, residual: Array) -> float:
    """Standard deviation of what does not repeat, by how far each sample lies off the line through those beside it.

    Parameters
    ----------
    place, residual : ndarray, shape (K,)
        On the curve, over any number of turns [rad], any unit.

    Returns
    -------
    float
        In the unit of the residual; single outliers do not count.
    """
    if place.size < 3:
        return 0.0
    order = np.argsort(place, kind="stable")
    at, of = place[order], residual[order]
    wide = at[2:] - at[:-2]
    share = np.where(wide > 0.0, (at[1:-1] - at[:-2]) / np.where(wide > 0.0, wide, 1.0), 0.5)
    off = of[1:-1] - (1.0 - share) * of[:-2] - share * of[2:]
    off /= np.sqrt(1.0 + share**2 + (1.0 - share) ** 2)  # that many times the noise of a single sample
    usual = _OF_MEDIAN * float(np.median(np.abs(off)))
    if usual == 0.0:  # of exact or coarsely rounded samples
        return float(np.sqrt(np.mean(off**2)))
    return float(np.sqrt(np.mean(np.clip(off, -_CUT * usual, _CUT * usual) ** 2)))


def step_of(measured: Array) -> float:
    """Step in which the samples of a trace were taken, of its amplifier or its file; zero where they have none.

    Parameters
    ----------
    measured : ndarray, shape (N,)
    """
    size = float(np.ptp(measured))
    if not size:
        return 0.0
    values = np.unique(np.round((measured - measured.min()) / (_SAME * size)))
    if values.size < 3 or values.size * _EACH > measured.size:
        return 0.0
    gaps = np.diff(values)
    step = float(gaps.min())
    whole = np.round(gaps / step)
    if np.abs(gaps / step - whole).max() > _ROUNDING:
        return 0.0
    return float((values[-1] - values[0]) / whole.sum()) * _SAME * size  # known by all values together


def gains_of_turns(turn: Array, curve: Array, rest: Array, scale: float, *, free: bool) -> Array:
    """Gain of each turn: it differs by torque that fluctuates, play that comes and goes.

    Parameters
    ----------
    turn, curve, rest : ndarray, shape (K,)
        Turns of the samples from the beginning, computed there, measured less what was fitted beside the gain.
    scale : float
        Gain over all turns.
    free : bool
        Whether the offset was fitted.

    Returns
    -------
    ndarray, shape (T,)
        Of turns that have most of the curve, in their order; empty of traces with fewer than three.
    """
    number = np.floor(turn - turn.min() + _ROUNDED).astype(int)
    count = np.bincount(number)
    mean = np.bincount(number, curve) / np.maximum(count, 1) if free else np.zeros(count.size)
    own = curve - mean[number]
    power = np.bincount(number, own**2)
    whole = power > _POWER * power.mean()
    if np.count_nonzero(whole) < _TURNS:
        return np.zeros(0)
    return np.asarray(scale + np.bincount(number, own * (rest - scale * curve))[whole] / power[whole])


def of_mean(gains: Array) -> float:
    """Standard error of the mean of gains of turns; zero of none."""
    return float(gains.std(ddof=1)) / math.sqrt(gains.size) if gains.size else 0.0
