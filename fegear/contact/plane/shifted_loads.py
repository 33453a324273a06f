"""Estimated errors of what follows from load sharing: solved again with each compliance off by its own error.

`shifted` holds engagements whose compliances are off, one source each (`fegear.contact.plane.shifted_compliance`); the
changes that they make add up.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.error_over_pitch import TransmissionErrorShift, no_less_than_beside
from fegear.contact.fourier import EFFECTIVE_HARMONICS, FourierSeries, effective_error, fourier_series
from fegear.contact.plane.base_pitch import mean_secant_stiffness
from fegear.contact.plane.engagement import Engagement, solve_again
from fegear.contact.plane.independent_errors import independent_errors
from fegear.contact.plane.shifted_compliance import ShiftedCompliance
from fegear.contact.plane.transmission_error import TransmissionError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.contact.fourier import Panels
    from fegear.contact.plane.pair_history import PairHistory

#: Of what a tooth that is softer by its error changes of the mean, so much may be a wave from edge to edge of a flank.
#: Where teeth are many edges pass at even distances, so that all of it is in one harmonic: that of the edges, or, since
#: c_0 is asked for at places hardly closer than these, one below (of 37 pairs one had 1.6 and 2.3 times the error).
_ALTERNATING = 0.05
#: Places over the base pitch at which a change is compared with itself.
_PLACES = 60


def transmission_error_shift(te: TransmissionError, shifted: Sequence[Engagement]) -> TransmissionErrorShift | None:
    """Solve again at the same quadrature points with each compliance off by its error; None where none states one.

    What would cancel where a whole flank is softer alike is added: the same numbers with each error changing its sign
    along the flank, as far as one place's error is its own (`independent_errors`).
    """
    if not shifted:
        return None
    values = te.values
    pair = shifted[0].pair
    uneven = independent_errors(te.loaded, shifted, (pair.x_start, pair.x_end)).transmission_error
    amplitude = np.zeros_like(te.series.amplitude)
    alternating: list[tuple[float, int]] = []
    mean = peak_to_peak = usual = effective = stiffness = 0.0
    for engagement, along in zip(shifted, uneven, strict=True):
        other = solve_again(engagement, te.loaded)
        again = replace(te, loaded=other, series=_series(te, other.transmission_error[:, 0]))
        bent = _series(te, values + along[:, 0])
        mean += abs(again.mean - te.mean) + float(abs(bent.mean - te.mean))
        alternating.append((abs(again.mean - te.mean), _waves(engagement)))
        peak_to_peak += abs(again.peak_to_peak - te.peak_to_peak)
        peak_to_peak += abs(float(np.ptp(values + along[:, 0])) - te.peak_to_peak)
        for change in (other.transmission_error[:, 0] - values, along[:, 0]):
            usual += _between_two_places(te.points, change)
        effective += abs(again.effective_error - te.effective_error)
        effective += abs(float(effective_error(bent)) - te.effective_error)
        stiffness += abs(mean_secant_stiffness(again) - mean_secant_stiffness(te))
        # of the complex coefficient: an amplitude's own change passes through zero where its phase changes
        for series in (again.series, bent):
            amplitude += 2.0 * np.abs(series.coefficients - te.series.coefficients)[1:]
    amplitude = no_less_than_alternating(no_less_than_beside(amplitude), alternating)
    effective = max(effective, _of_effective(te.series.amplitude, amplitude))
    peak_to_peak = max(peak_to_peak, usual)
    return TransmissionErrorShift(mean, peak_to_peak, effective, amplitude, stiffness)


def no_less_than_alternating(amplitude: Array, changes: Sequence[tuple[float, int]]) -> Array:
    """Errors of harmonics, shape (N,), none below that of a compliance whose error alternates from edge to edge.

    Parameters
    ----------
    amplitude : ndarray, shape (N,)
    changes : sequence of (float, int)
        What each softer compliance changes of the mean, and how many harmonics alternate no faster than its edges.
    """
    least = np.zeros_like(amplitude)
    for change, waves in changes:
        least[:waves] += _ALTERNATING * change
    return np.maximum(amplitude, least)


def _waves(engagement: Engagement) -> int:
    """Harmonics over the base pitch that the error of either gear's c_0 may have, alternating from edge to edge."""
    compliance = engagement.compliance
    sources = [one for one in (compliance.driver, compliance.driven) if isinstance(one, ShiftedCompliance)]
    return math.ceil(max((one.waves(engagement.pair.base_pitch) for one in sources), default=0.0))


def _of_effective(amplitude: Array, error: Array) -> float:
    """Error of A_e by those of its amplitudes, as if each had its own: their changes may cancel in it by chance."""
    a, off = amplitude[:EFFECTIVE_HARMONICS], error[:EFFECTIVE_HARMONICS]
    size = float(np.sqrt(np.sum(a**2)))
    slope = a / size if size > 0.0 else np.zeros_like(a)
    slope[:1] += 1.0
    return float(np.sqrt(np.sum((slope * off) ** 2)))


def _between_two_places(points: Panels, change: Array) -> float:
    """By how much a change differs between two places of the base pitch: the median over all of both.

    Where it happens to be the same at the highest and at the lowest place it is not known any better there. What a
    contact at a tip leaves open concerns few places.
    """
    even = points.breaks[0] + points.period * (np.arange(_PLACES) + 0.5) / _PLACES
    there = np.interp(even, points.x, change, period=points.period)
    return float(np.median(np.abs(there[:, None] - there)))


def _series(te: TransmissionError, values: Array) -> FourierSeries:
    return fourier_series(te.points, values, te.series.amplitude.size)


def load_shift(history: PairHistory, other: PairHistory) -> Array:
    """How far the loads of a shifted solution are from the original's, shape of its loads [N]."""
    columns = [
        np.interp(history.x, other.x, other.load[:, i], left=0.0, right=0.0) for i in range(history.load.shape[1])
    ]
    difference = np.abs(np.stack(columns, axis=1) - history.load)
    # A jump of the load at an end of the path is in the same place in both; outside it one of them may have no point.
    inside = (history.x >= other.x[0]) & (history.x <= other.x[-1])
    return np.where(inside[:, None], difference, 0.0)
