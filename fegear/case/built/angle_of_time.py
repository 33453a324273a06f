"""Rotation of a gear from the time of a trace, at a constant speed that the period of the trace refines.

A speed is known to a percent or so; over twenty turns that is a fifth of a turn. What a gauge measures repeats with
every turn of its gear: at the true speed samples of one place of the gear differ least (phase dispersion). The speed is
found over a few turns first, about the liveliest one, then over twice as many, and so on.

Stellingwerf, R. F.: Period determination using phase dispersion minimization. Astrophysical Journal 224 (1978) 953-960.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.trace_levels import over_pitch

if TYPE_CHECKING:
    from fegear.base.arrays import Array

#: Relative deviation from the stated speed within which the period is looked for.
REACH = 0.05
#: Turns with which the search begins, and fewest turns that show a period.
_FIRST, FEWEST_TURNS = 4.0, 2.0
#: Part of a turn by which neighbours of a search differ over its turns.
_STEP = 0.004
#: Places of a turn in which samples are compared, and samples a place that they need.
_PLACES, _EACH = 720, 2
#: Part of the variance within places above which a trace has no period.
_NO_PERIOD = 0.8
#: Most harmonics of a turn, and most samples, by which the speed is refined.
_HARMONICS, _SAMPLES = 40, 20_000
#: Most stretches that are compared with the mean turn, how far their shift is looked for [turns], part of the places
#: that they have to have, and correlation below which they have no signal.
_STRETCHES, _FARTHEST, _COVERED, _ALIKE = 12, 0.05, 0.9, 0.5
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class SteadyTurning:
    """Rotation over time at one speed.

    Parameters
    ----------
    speed : float
        [rad/s].
    found : bool
        Whether the period of the trace gave it.
    wander : float
        Largest deviation of a stretch of the trace from the rotation at this speed [rad].
    """

    speed: float
    found: bool
    wander: float = 0.0


def steady_turning(time: Array, signal: Array, stated: float) -> SteadyTurning:
    """The constant speed of a trace, by its period near a stated one; the stated one where it has no period.

    Parameters
    ----------
    time, signal : ndarray, shape (N,)
        [s], ascending.
    stated : float
        [rad/s].
    """
    time = time - time[0]
    turns = time * stated / _TURN
    if turns[-1] < FEWEST_TURNS * (1.0 + REACH):
        return SteadyTurning(stated, found=False)
    places = int(min(_PLACES, max(signal.size / turns[-1] / _EACH, 8.0)))
    clipped = np.clip(signal, *np.percentile(signal, [0.1, 99.9]))  # a spike is no part of a period
    middle, span, factor, reach = _liveliest(turns, clipped), min(_FIRST, float(turns[-1])), 1.0, REACH
    while True:
        first = min(max(middle - 0.5 * span, 0.0), float(turns[-1]) - span)
        some = (turns >= first) & (turns <= first + span)
        tried = factor + np.arange(-reach, reach + _STEP / span, _STEP / span)
        left = np.array([_within_places(turns[some] * one, clipped[some], places) for one in tried])
        k = int(np.argmin(left))
        factor = float(tried[k]) + _between(left, k) * _STEP / span
        if span >= turns[-1]:
            break
        reach, span = 3.0 * _STEP / span, min(2.0 * span, float(turns[-1]))
    if left[k] > _NO_PERIOD or abs(factor - 1.0) > REACH:
        return SteadyTurning(stated, found=False)
    factor = _by_harmonics(turns, clipped, factor, 2.0 * _STEP / span)
    return SteadyTurning(stated * factor, found=True, wander=_wander(turns * factor, clipped))


def mesh_turning(time: Array, error: Array, stated: float, teeth: int) -> SteadyTurning:
    """The constant speed of a shaft by the mesh period of a transmission error near a stated speed.

    What varies more slowly than a tooth pitch (runout) is taken off first: it does not repeat with the pitch.

    Parameters
    ----------
    time, error : ndarray, shape (N,)
        [s], ascending; [m].
    stated : float
        [rad/s].
    teeth : int
        Of the gear on the shaft.
    """
    fast = error - over_pitch(error, stated * (time - time[0]), _TURN / teeth)
    found = steady_turning(time, fast, stated * teeth)
    return SteadyTurning(found.speed / teeth, found.found, found.wander / teeth)


def _liveliest(turns: Array, signal: Array) -> float:
    """Middle of the whole turn with the largest range of the signal."""
    whole = turns.astype(int)
    last = int(turns[-1])
    ranges = [float(np.ptp(signal[whole == one])) if (whole == one).any() else 0.0 for one in range(last)]
    return float(np.argmax(ranges)) + 0.5


def _by_harmonics(turns: Array, signal: Array, factor: float, reach: float) -> float:
    """The factor with which harmonics of the turn are largest together: no width of places limits it."""
    from scipy.optimize import minimize_scalar

    block = max(turns.size // _SAMPLES, 1)
    kept = turns.size // block * block
    some, values = (one[:kept].reshape(-1, block).mean(axis=1) for one in (turns, signal - signal.mean()))
    harmonics = int(min(_HARMONICS, max(some.size / turns[-1] / 4.0, 1.0)))

    def power(tried: float) -> float:
        once = np.exp(2j * math.pi * tried * some)
        wave, total = values.astype(complex), 0.0
        for _ in range(harmonics):
            wave *= once
            total += abs(complex(wave.sum())) ** 2
        return -total

    ends = factor - reach, factor + reach
    return float(minimize_scalar(power, bounds=ends, method="bounded", options={"xatol": 1e-3 * reach}).x)


def _place(turns: Array, places: int) -> Array:
    return (np.mod(turns, 1.0) * places).astype(int) % places


def _within_places(turns: Array, signal: Array, places: int) -> float:
    """Variance of the samples about the means of their places, over that about the mean of all."""
    place = _place(turns, places)
    mean = _means(place, signal, places)
    total = float(((signal - signal.mean()) ** 2).sum())
    return float(((signal - mean[place]) ** 2).sum()) / total if total else 1.0


def _between(values: Array, k: int) -> float:
    """Where a parabola through a minimum and its neighbours has its own [steps from it]."""
    if not 0 < k < values.size - 1:
        return 0.0
    below, at, above = values[k - 1 : k + 2]
    bend = below - 2.0 * at + above
    return float(0.5 * (below - above) / bend) if bend > 0.0 else 0.0


def _wander(turns: Array, signal: Array) -> float:
    """Largest shift of a stretch of the trace against the mean turn [rad]; those without a signal do not count."""
    stretches = int(min(turns[-1], _STRETCHES))
    places = int(min(_PLACES // 4, max(signal.size / stretches / 4.0, 8.0)))
    place, stretch = _place(turns, places), np.minimum((turns / turns[-1] * stretches).astype(int), stretches - 1)
    mean = _means(place, signal, places)
    mean, largest = mean - mean.mean(), 0.0
    grid, tried = (np.arange(places) + 0.5) / places, np.linspace(-_FARTHEST, _FARTHEST, 101)
    shifted = np.stack([np.interp(grid - one, grid, mean, period=1.0) for one in tried])
    size = np.sqrt((shifted**2).sum(axis=1))
    for one in range(stretches):
        inside = stretch == one
        known = np.bincount(place[inside], minlength=places) > 0
        if np.count_nonzero(known) < _COVERED * places:
            continue
        own = _means(place[inside], signal[inside], places)
        own = np.where(known, own - own[known].mean(), 0.0)
        alike = shifted @ own / size
        if alike.max() > _ALIKE * math.sqrt(float(own @ own)):
            largest = max(largest, abs(float(tried[int(np.argmax(alike))])))
    return largest * _TURN


def _means(place: Array, signal: Array, places: int) -> Array:
    """Mean of the samples at each place; zero where there are none."""
    return np.bincount(place, signal, places) / np.maximum(np.bincount(place, minlength=places), 1)
