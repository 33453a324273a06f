"""Judging designed flanks: on roll positions, panels, gears and misalignments that no search has seen.

A search leaves the least at the places that it looks at, and more between them. So what is stated of a relief is found
at four times as many roll positions and misalignments, and its error from as many positions as the search had, panels
of a fourth of their length, and the gears' coarser solutions. Misalignment scatters normally, and is one number: what
it leaves is followed over that number, which gives means and percentiles without drawing any.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.one_thread import one_thread
from fegear.base.shown import shown
from fegear.contact.wide.compliance import flank_compliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import ContactLines, contact_lines
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.roll_points import roll_points
from fegear.contact.wide.tip_edges import edge_reach
from fegear.design.flanks.scatter import NOMINAL, Scatter
from fegear.design.flanks.trials import FlankTrials, Tried
from fegear.fem.solid.flank_body import FlankBody
from fegear.geometry.pair import Member

#: Roll positions that a search may look at, and those that it is judged at.
SEARCHED, JUDGED = 48, 192
#: Panels of the search to one of those whose change counts as an error.
_FINER = 4
#: Misalignments that are followed, in standard deviations, and places between them for percentiles.
_LEVELS = np.linspace(-3.5, 3.5, 15)
_BETWEEN = 100
#: Misalignments at which positions, panels and gears are changed, in standard deviations, and their weights.
_CHANGED, _WEIGHTS = np.array([-1.0, 0.0, 1.0]), np.array([0.3, 0.4, 0.3])
#: Part of misalignments that leave no more than what is stated.
PERCENTILE = 0.95
#: What is taken for an error of a change by four times fewer positions or longer panels, or by half of the levels.
_OF_FEWER = 0.5


class Number(NamedTuple):
    """A number and its estimated error."""

    value: float
    error: float


@dataclass(frozen=True)
class Judged:
    """What a relief leaves at the design load; what holds "over the scatter" is `PERCENTILE` of the misalignments."""

    peak_to_peak: Number = shown("um", "peak-to-peak transmission error at the design load", name="te_peak_to_peak")
    face_load_factor: Number = shown("", "at the design load", name="K_Hbeta")
    pressure: Number = shown("MPa", "maximum, excluding tip and form circles", name="hertz_pressure")
    mean_over_scatter: Number = shown(
        "um", "peak to peak, mean over the scatter of misalignment", name="te_mean_over_scatter"
    )
    most_over_scatter: Number = shown(
        "um", "peak to peak, 95th percentile over the misalignments", name="te_p95_over_scatter"
    )
    factor_over_scatter: Number = shown(
        "", "K_Hbeta, 95th percentile over the misalignments", name="K_Hbeta_p95_over_scatter"
    )


@dataclass(frozen=True)
class FlankJudge:
    """A pair set up for judging reliefs.

    Parameters
    ----------
    dense, plain : FlankTrials
        At `JUDGED` and at `SEARCHED` roll positions.
    thin, soft : FlankTrials
        At those of `plain` with shorter panels, and of the gears' coarser solutions.
    deviation : float
        Standard deviation of the misalignment over the face [m].
    """

    dense: FlankTrials
    plain: FlankTrials
    thin: FlankTrials
    soft: FlankTrials
    deviation: float

    def under(self, loads: Array, apart: FlankGaps) -> FlankJudge:
        """The same under other loads [N], aligned as `apart` says."""
        dense, plain, thin, soft = (
            replace(one, loads=loads, apart=apart.at(one.pair, one.known.lines, loads))
            for one in (self.dense, self.plain, self.thin, self.soft)
        )
        return FlankJudge(dense, plain, thin, soft, self.deviation)

    def left(self, gap: Callable[[ContactLines], Array]) -> tuple[Array, Array]:
        """Transmission error aligned as given, shape (`JUDGED`, L), and the error of its peak-to-peak value, (L,) [m].

        Parameters
        ----------
        gap : callable
            As that of `judge`.
        """
        dense, plain, thin, soft = (
            replace(one, scatter=NOMINAL).of_gap(gap(one.known.lines)).te[0]
            for one in (self.dense, self.plain, self.thin, self.soft)
        )
        return dense, _off(*(np.ptp(te, axis=0) for te in (dense, plain, thin, soft)))

    def judge(self, gap: Callable[[ContactLines], Array]) -> Judged:
        """Judge a relief, given by the gap that it leaves at the stations of contact lines [m]."""
        levels = Scatter(self.deviation * _CHANGED, _WEIGHTS) if self.deviation else NOMINAL
        dense, plain, thin, soft = (
            _numbers(replace(one, scatter=levels).of_gap(gap(one.known.lines)))
            for one in (self.dense, self.plain, self.thin, self.soft)
        )  # fmt: skip
        off = _off(dense, plain, thin, soft)
        middle = levels.over_face.size // 2
        ripple, factor, pressure = (
            Number(float(v), float(e)) for v, e in zip(dense[:, middle], off[:, middle], strict=True)
        )
        if not self.deviation:
            return Judged(ripple, factor, pressure, ripple, ripple, factor)
        every = Scatter(self.deviation * _LEVELS, np.full(_LEVELS.size, 1.0 / _LEVELS.size))
        over, factors, _ = _numbers(replace(self.dense, scatter=every).of_gap(gap(self.dense.known.lines)))
        return Judged(
            ripple, factor, pressure, over_scatter(over, None, float(_WEIGHTS @ off[0])),
            over_scatter(over, PERCENTILE, float(off[0].max())), over_scatter(factors, PERCENTILE, float(off[1].max())),
        )  # fmt: skip


def _off(dense: Array, plain: Array, thin: Array, soft: Array) -> Array:
    """Errors of what is found on `FlankJudge.dense`."""
    return _OF_FEWER * np.abs(dense - plain) + _OF_FEWER * np.abs(thin - plain) + np.abs(soft - plain)


def _numbers(tried: Tried) -> Array:
    """Peak to peak, K_Hbeta and pressure at every misalignment, shape (3, S)."""
    return np.stack([tried.peak_to_peak[:, 0], tried.face_load_factor[:, 0], tried.pressure[:, 0]])


def over_scatter(values: Array, percentile: float | None, off: float) -> Number:
    """Mean, or a percentile, of what is known at `_LEVELS` of a normal distribution and straight between them.

    Parameters
    ----------
    values : ndarray, shape (levels,)
    percentile : float or None
        Part of the distribution; None for the mean.
    off : float
        Error of the values.
    """
    place = np.linspace(_LEVELS[0], _LEVELS[-1], _BETWEEN * (_LEVELS.size - 1) + 1)
    weight = np.exp(-0.5 * place**2)
    weight /= weight.sum()

    def found(some: slice) -> float:
        curve = np.interp(place, _LEVELS[some], values[some])
        if percentile is None:
            return float(weight @ curve)
        order = np.argsort(curve, kind="stable")
        return float(np.interp(percentile, np.cumsum(weight[order]), curve[order]))

    whole = found(slice(None))
    return Number(whole, _OF_FEWER * abs(found(slice(None, None, 2)) - whole) + off)


def mean_over_scatter(trials: FlankTrials, gap: Array, deviation: float) -> Array:
    """Mean peak-to-peak value over normally scattered misalignment, shape (L,) [m].

    Parameters
    ----------
    trials : FlankTrials
    gap : ndarray, shape (P, M)
        That a relief leaves [m].
    deviation : float
        Standard deviation of the misalignment over the face [m].
    """
    every = Scatter(deviation * _LEVELS, np.full(_LEVELS.size, 1.0 / _LEVELS.size))
    left = replace(trials, scatter=every).of_gap(gap).peak_to_peak
    return np.array([over_scatter(values, None, 0.0).value for values in left.T])


def flank_judge(
    flanks: FlankPair, coarse: Mapping[Member, FlankBody], apart: FlankGaps, load: float, deviation: float
) -> FlankJudge:
    """Set up a pair for judging reliefs.

    Parameters
    ----------
    flanks : FlankPair
        As it is searched, along tip edges as far as its own lines go on.
    coarse : mapping of {"driver", "driven"} to FlankBody
    apart : FlankGaps
        What keeps the flanks apart besides the relief.
    load : float
        Design load [N].
    deviation : float
        Standard deviation of the misalignment over the face [m].
    """
    pair, panel = flanks.pair, flanks.panel * flanks.pair.driver.module
    beyond = edge_reach(pair, flanks.most_gap)

    def trials(positions: int, panel: float, gears: Mapping[Member, FlankBody]) -> FlankTrials:
        points = roll_points(pair, positions, beyond)
        lines = contact_lines(pair, points.x, panel, points.weights / points.period, flanks.most_gap)
        with one_thread():
            known = flank_compliance(pair, gears, lines, load, coupling=flanks.coupling, hertz=flanks.hertz,
                                     cache=flanks.cache)  # fmt: skip
        return FlankTrials(pair, known, apart.at(pair, lines), np.array([load]))

    return FlankJudge(
        trials(JUDGED, panel, flanks.gears), trials(SEARCHED, panel, flanks.gears),
        trials(SEARCHED, panel / _FINER, flanks.gears), trials(SEARCHED, panel, coarse), deviation,
    )  # fmt: skip
