"""A measured transmission error: order spectrum of its trace, and the curve of the mesh over one tooth pitch.

A trace of two encoders has everything that turns with the shafts: eccentricity, pitch deviations, couplings. Over whole
turns its harmonics stand at whole orders of the shaft; those of the mesh are the multiples of the number of teeth, and
the first ones of the mating gear, which stand between, are fitted. What stands beside a computed transmission error is
the curve of the mesh: the trace less its mean over a tooth pitch to either side of each sample, which takes slow parts
away and nothing of the mesh, averaged over all teeth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.contact.order_spectrum import lines_of_mate, order_spectrum
from fegear.contact.pulse_steps import PulseStep, pulse_steps
from fegear.contact.trace_outliers import suspected
from fegear.contact.turns import going_on

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.contact.order_spectrum import OrderSpectrum

#: Fewest samples of a tooth pitch, which resolve the first mesh harmonic, fewest of a curve with all that is compared,
#: and most places of the averaged one; fewest tooth pitches of a trace.
FEWEST_A_TOOTH, _WHOLE, _MOST_A_TOOTH, FEWEST_PITCHES = 5, 16, 360, 3
#: Part of the samples of a tooth pitch up to which harmonics are resolved, and degree of the spline of few samples.
_RESOLVED, _DEGREE = 0.4, 7
#: Part of a tooth pitch over which a trace may have no sample, or run back (an encoder that trembles).
_GAP = 0.25
#: Part of a turn that a trace may lack of a whole one: the last of evenly spaced samples.
_SLACK = 1e-3
#: Harmonics of the mesh that are compared at most.
_HARMONICS = 12
#: Largest part of the samples that are spikes; groups of teeth whose gains are compared.
_MOST_SPIKES, _GROUPS = 0.1, 24
#: Fewest turns whose means have a scatter.
_TURNS = 3
_TURN = 2.0 * math.pi


class ShortTraceError(ValueError):
    """A trace covers too few tooth pitches, or has too few samples on each."""

    def __init__(self, pitches: float, samples: float) -> None:
        super().__init__(f"{pitches:.3g} tooth pitches, {samples:.3g} samples on each")
        self.pitches, self.samples = pitches, samples


class UnevenTraceError(ValueError):
    """A trace runs back, or has a stretch without samples; the text is a rule on the trace."""


@dataclass(frozen=True)
class MeasuredError(ReadOnlyArrays):
    """What a trace says of the mesh.

    Parameters
    ----------
    teeth : int
        Of the gear on the shaft of the angle.
    spectrum : OrderSpectrum
    angle, te : ndarray, shape (B,)
        Of the curve averaged over all teeth, over one tooth pitch of the shaft [rad], with the mean of the trace [m].
    spread : float
        Standard deviation between teeth, mean over the curve [m].
    pitches : int
        Tooth pitches averaged.
    n : ndarray of int, shape (H,)
        Harmonics of the mesh.
    amplitude, phase : ndarray, shape (H,)
        Of these [m], [rad].
    by_teeth : ndarray, shape (G, B)
        The same curve of groups of neighbouring teeth, each less its mean.
    spikes : int
        Samples that stick out of those around them, left out.
    mate_order : float
        Order of one revolution of the mating gear, with its multiples a part of the spectrum; 0 where the trace is too
        short to tell it from those of the shaft.
    mean_error : float
        Standard error of the mean of the trace by what varies slowly [m].
    steps : tuple of PulseStep
        Where an encoder may have lost pulses.
    resolved : int or None
        Mesh harmonics that the samples of a tooth pitch resolve where these are few; None of a trace with enough.
    samples : float
        Of a tooth pitch.
    """

    teeth: int
    spectrum: OrderSpectrum
    angle: Array
    te: Array
    spread: float
    pitches: int
    n: NDArray[np.int64]
    amplitude: Array
    phase: Array
    by_teeth: Array
    spikes: int = 0
    mate_order: float = 0.0
    mean_error: float = 0.0
    steps: tuple[PulseStep, ...] = ()
    resolved: int | None = None
    samples: float = math.inf


def measured_error(angle: Array, te: Array, teeth: int, mate_teeth: int = 0) -> MeasuredError:
    """Orders of a trace and its curve over one tooth pitch.

    Parameters
    ----------
    angle, te : ndarray, shape (N,)
        Rotation of a shaft, counted on or from zero in each turn [rad], and transmission error [m].
    teeth : int
        Of the gear on this shaft.
    mate_teeth : int
        Of the other one, whose eccentricity stands between whole orders of the shaft; 0 to look for none.

    Raises
    ------
    ShortTraceError
    UnevenTraceError
    """
    from scipy.interpolate import make_interp_spline

    pitch = _TURN / teeth
    spikes = suspected(te)[0]
    if spikes.mean() > _MOST_SPIKES:
        spikes[:] = False
    angle, te = angle[~spikes], te[~spikes]
    turned, te = _one_way(going_on(angle), te, _GAP * pitch)
    length = float(turned[-1] - turned[0])
    samples = turned.size * pitch / length if length else 0.0
    step = length / max(turned.size - 1, 1)  # the last sample stands for as much as each
    if samples < FEWEST_A_TOOTH or length + step < FEWEST_PITCHES * pitch * (1.0 - _SLACK):
        raise ShortTraceError(length / pitch, samples)
    wide = np.diff(turned)
    if wide.max() > _GAP * pitch:
        k = int(wide.argmax())
        raise UnevenTraceError(
            f"has no sample over {math.degrees(wide[k]):.3g} deg after {math.degrees(turned[k]):.5g} deg (limit "
            f"{math.degrees(_GAP * pitch):.3g} deg, {_GAP:g} tooth pitches)"
        )
    turns = math.floor((length + step) / _TURN + _SLACK)
    cycles = teeth * turns if turns else math.floor((length + step) / pitch + _SLACK)
    places = min(max(round(samples), _WHOLE), _MOST_A_TOOTH)
    # Evenly spaced and from a whole number of pitches on, so that phases count from angle zero.
    first = math.ceil(turned[0] / pitch - _SLACK) if turned[0] + (cycles + 1) * pitch <= turned[-1] else None
    start = turned[0] if first is None else first * pitch
    even = start + pitch / places * np.arange(cycles * places)
    few = samples < _WHOLE - 0.5  # a cubic spline rounds what few samples resolve
    values = make_interp_spline(turned, te, k=_DEGREE if few else 3)(np.minimum(even, turned[-1]))
    mate = lines_of_mate(values, even, cycles / teeth, teeth / mate_teeth if mate_teeth else 0.0)
    less_mate = values - sum(one.at(even) for one in mate) if mate else values
    spectrum = order_spectrum(less_mate, cycles / teeth, start)
    by_tooth = _over_pitch(values, places)
    mean, mean_error = _mean_of_turns(less_mate, values, places, teeth)
    curve, spread, averaged = by_tooth.mean(axis=0) + mean, float(by_tooth.std(axis=0).mean()), len(by_tooth)
    groups = np.array_split(by_tooth, min(averaged, _GROUPS))
    resolved = max(math.floor(_RESOLVED * samples), 1) if few else None
    n = 1 + np.arange(min(_HARMONICS, resolved or (places - 1) // 2))
    at = n * cycles - 1  # the record has `cycles` tooth pitches: harmonic n of the mesh is its n-th multiple
    at = at[at < spectrum.order.size]
    return MeasuredError(
        teeth, spectrum.beside(mate), np.mod(even[:places], pitch), curve, spread, averaged, n[: at.size],
        spectrum.amplitude[at], spectrum.phase[at], np.stack([one.mean(axis=0) for one in groups]),
        int(np.count_nonzero(spikes)), mate[0].order if mate else 0.0, mean_error,
        pulse_steps(values, even, places, teeth, teeth / mate_teeth if mate_teeth else 0.0), resolved, samples,
    )  # fmt: skip


def _mean_of_turns(less_mate: Array, values: Array, places: int, teeth: int) -> tuple[float, float]:
    """Mean of a trace less the orders of the mating gear, which it does not have whole, and its standard error.

    By the scatter of the means of turns from three on; of fewer by what the orders of the mate changed; where these are
    not known by what varies slowly.

    Parameters
    ----------
    less_mate, values : ndarray, shape (N,)
        Without and with these orders [m].
    places, teeth : int
        Samples of a tooth pitch, and pitches of a turn of the shaft.
    """
    turn = places * teeth
    mean, turns = float(less_mate.mean()), values.size // turn
    if turns >= _TURNS:
        scatter = less_mate[: turns * turn].reshape(turns, turn).mean(axis=1).std(ddof=1) / math.sqrt(turns)
        return mean, float(scatter)
    if turns and less_mate is not values:
        return mean, abs(float(values.mean()) - mean)
    return mean, float(values.reshape(-1, places).mean(axis=1).std())


def _one_way(angle: Array, te: Array, back: float) -> tuple[Array, Array]:
    """A trace by ascending angle; samples nearer than half of the mean step are averaged, lest noise be a slope."""
    run = angle if angle[-1] >= angle[0] else -angle
    behind = np.maximum.accumulate(run) - run
    if behind.max() > back:
        k = int(behind.argmax())
        raise UnevenTraceError(
            f"runs back by {math.degrees(behind[k]):.3g} deg to an angle of {math.degrees(angle[k]):.5g} deg (limit "
            f"{math.degrees(back):.3g} deg, {_GAP:g} tooth pitches)"
        )
    order = np.argsort(angle, kind="stable")
    turned, te = angle[order], te[order]
    cell = 0.5 * float(turned[-1] - turned[0]) / max(turned.size - 1, 1)
    if not cell > 0.0:
        return turned[:1], te[:1]
    turned, te = _averaged(turned, te, np.floor((turned - turned[0]) / cell))
    # Of three cells in a row the outer two are a cell apart: what is nearer is a pair on both sides of a border.
    return _averaged(turned, te, np.cumsum(np.append(True, np.diff(turned) >= 0.5 * cell)))


def _averaged(turned: Array, te: Array, group: Array) -> tuple[Array, Array]:
    """Mean angle and transmission error of samples of one group, ascending."""
    first = np.flatnonzero(np.append(True, np.diff(group) > 0))
    count = np.diff(np.append(first, group.size))
    return np.add.reduceat(turned, first) / count, np.add.reduceat(te, first) / count


def _over_pitch(values: Array, places: int) -> Array:
    """Curve over one tooth pitch of each tooth, from the first value on and without slow parts, shape (teeth, B)."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    mean = (total[places:] - total[:-places]) / places  # of each run of one pitch
    half = places // 2
    slow = mean if places % 2 else 0.5 * (mean[1:] + mean[:-1])
    quick = values[half : half + slow.size] - slow
    whole = quick.size // places
    return np.roll(quick[: whole * places].reshape(whole, places), half, axis=1)
