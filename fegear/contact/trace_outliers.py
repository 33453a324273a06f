"""Samples of a trace that are no measurement: spikes, dropouts of the transmission, an amplifier at its end.

A first look needs no computed curve: a sample that sticks out of those around it, a run of equal values between two
jumps, a run at the highest or lowest value. Beside a fitted curve the look is sharper: a sample is out where its
residual differs from those of the samples beside it on the curve (in this turn and in others), so that a difference of
shape, which they share, is none; values at the end of a range are saturated where the curve goes on beyond them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.trace_scatter import noise_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Mask

#: Samples about each that a first look compares with, and how far one sticks out: times their middle half and noise.
_AROUND, _OF_HALF, _OF_NOISE = 9, 3.0, 8.0
#: Fewest equal samples that are no chance; part of the trace's range that a dropout jumps by at least.
_RUN, _JUMPS = 3, 0.5
#: Beside a curve: times the noise and the median deviation of the samples about it, and part of the range of the curve,
#: that a sample is off at least.
_OFF_NOISE, _OF_SPREAD, _OFF_RANGE = 6.0, 8.0, 0.03
#: Largest part of the samples that are spikes and dropouts: with more of them something else is wrong.
_MOST = 0.1
#: Largest part of a trace that is suspected at the ends of its range: more of it is its rest between two contacts.
_MOST_AT_ENDS = 0.3
#: Range of the bulk of a trace, in per cent of its samples.
_BULK = (1.0, 99.0)


@dataclass(frozen=True)
class Beside:
    """A trace beside a fitted curve, samples in the order of the trace.

    Parameters
    ----------
    place : ndarray, shape (N,)
        On the curve [rad].
    inside : ndarray of bool, shape (N,)
        Where the curve is known.
    fitted : ndarray, shape (N,)
        Curve with the fitted scale, offset and drift, as it would be measured.
    steep : ndarray, shape (N,)
        Change of the fitted curve within the uncertainty of a place.
    size : float
        Range of the fitted curve.
    turns : float
        Of the trace.
    """

    place: Array
    inside: Mask
    fitted: Array
    steep: Array
    size: float
    turns: float


def suspected(measured: Array) -> tuple[Mask, Mask]:
    """Spikes and dropouts, and what may be saturated, by the trace alone; bool, shape (N,) each."""
    from scipy.ndimage import percentile_filter

    if measured.size < _AROUND:
        return np.zeros(measured.size, dtype=bool), np.zeros(measured.size, dtype=bool)
    low, middle, high = (
        percentile_filter(measured, of, size=_AROUND, mode="mirror") for of in (25.0, 50.0, 75.0)
    )  # fmt: skip
    noise = noise_of(np.arange(measured.size, dtype=float), measured)
    spikes = np.abs(measured - middle) > _OF_HALF * (high - low) + _OF_NOISE * noise
    bulk = float(np.ptp(np.percentile(measured, _BULK)))
    start, stop = _runs(measured)
    drops = np.zeros(measured.size, dtype=bool)
    if start.size and bulk:
        before, after = _edges(measured, start, stop)
        jump = np.where(before * after > 0.0, np.minimum(np.abs(before), np.abs(after)), 0.0)
        drops = _filled(measured.size, start, stop, jump > _JUMPS * bulk)
    ends = _at_ends(measured) & ~spikes & ~drops
    return spikes | drops, ends if ends.mean() <= _MOST_AT_ENDS else np.zeros(measured.size, dtype=bool)


def outliers(measured: Array, beside: Beside) -> tuple[Mask, Mask]:
    """Spikes and dropouts, and saturated samples, beside a fitted curve; bool, shape (N,) each.

    Parameters
    ----------
    measured : ndarray, shape (N,)
        In the order of the trace.
    beside : Beside
    """
    from scipy.ndimage import median_filter

    none, inside = np.zeros(measured.size, dtype=bool), beside.inside
    residual = measured - beside.fitted
    order = np.flatnonzero(inside)[np.argsort(beside.place[inside], kind="stable")]
    noise = noise_of(beside.place[order], residual[order])
    # as many samples about each that those of one turn are fewer than half of them
    around = max(_AROUND, 2 * round(beside.turns) + 1)
    middle = median_filter(residual[order], size=around, mode="mirror")
    spread = median_filter(np.abs(residual[order] - middle), size=around, mode="mirror")
    limit = np.maximum(_OFF_NOISE * noise, _OFF_RANGE * beside.size) + beside.steep
    limit[order] = np.maximum(limit[order], _OF_SPREAD * spread + beside.steep[order])
    off = none.copy()
    off[order] = np.abs(residual[order] - middle) > limit[order]
    off &= _sticking_out(measured, off)
    start, stop = _runs(measured)
    if start.size:
        before, after = _edges(measured, start, stop)
        jump = np.minimum(np.abs(before), np.abs(after))
        least = np.minimum.reduceat(np.append(np.abs(residual), np.inf), np.column_stack([start, stop]).ravel())[::2]
        off |= _filled(measured.size, start, stop, (jump > limit[start]) & (least > limit[start])) & inside
    if np.count_nonzero(off) > _MOST * max(order.size, 1):
        off = none
    saturated = none.copy()
    ends = _at_ends(measured) & inside
    for end, sense in ((measured.max(), 1.0), (measured.min(), -1.0)):
        here = ends & (measured == end)
        beyond = -sense * residual[here]
        if here.any() and float(np.median(beyond)) > 0.0 and (beyond > limit[here]).any():
            saturated |= here
    return off & ~saturated, saturated


def _sticking_out(measured: Array, off: Mask) -> Mask:
    """Which samples lie beyond those before and after them that are not off: samples on a slope do not, shape (N,)."""
    at, kept = np.arange(measured.size), np.flatnonzero(~off)
    if not kept.size:
        return np.zeros(measured.size, dtype=bool)
    after = np.searchsorted(kept, at)
    edges = measured[kept[np.maximum(after - 1, 0)]], measured[kept[np.minimum(after, kept.size - 1)]]
    return np.asarray((measured < np.minimum(*edges)) | (measured > np.maximum(*edges)))


def _runs(measured: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First samples of runs of at least three equal ones, and the samples after their last."""
    new = np.flatnonzero(np.diff(measured) != 0.0) + 1
    start, stop = np.append(0, new), np.append(new, measured.size)
    long = stop - start >= _RUN
    return start[long], stop[long]


def _edges(measured: Array, start: NDArray[np.int64], stop: NDArray[np.int64]) -> tuple[Array, Array]:
    """By how much runs lie above the samples before and after them; above nothing at the ends of the trace."""
    before = measured[start] - measured[np.maximum(start - 1, 0)]
    after = measured[start] - measured[np.minimum(stop, measured.size - 1)]
    return np.where(start > 0, before, after), np.where(stop < measured.size, after, before)


def _filled(size: int, start: NDArray[np.int64], stop: NDArray[np.int64], chosen: Mask) -> Mask:
    """The samples of some runs, shape (N,)."""
    edge = np.zeros(size + 1, dtype=int)
    np.add.at(edge, start[chosen], 1)
    np.add.at(edge, stop[chosen], -1)
    return np.asarray(np.cumsum(edge[:-1]) > 0)


def _at_ends(measured: Array) -> Mask:
    """Samples at the highest or the lowest value where that is there in a run."""
    of_runs = measured[_runs(measured)[0]]
    found = np.zeros(measured.size, dtype=bool)
    for end in (measured.max(), measured.min()):
        if (of_runs == end).any():
            found |= measured == end
    return found
