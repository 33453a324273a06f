"""A measured transmission error: order spectrum of its trace, the curve over one tooth pitch, and both beside computed.

A trace of two encoders has everything that turns with the shafts: eccentricity, pitch deviations, couplings. Over whole
turns its harmonics stand at whole orders of the shaft; those of the mesh are the multiples of the number of teeth, and
the first ones of the mating gear, which stand between, are fitted. What stands beside a computed transmission error is
the curve of the mesh: the trace less its mean over a tooth pitch to either side of each sample, which takes slow parts
away and nothing of the mesh, averaged over all teeth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.base.shown import shown, shows
from fegear.contact.curve_fit import fit_curve
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.trace_alternatives import alternatives
from fegear.contact.trace_low_pass import low_pass
from fegear.contact.trace_outliers import suspected
from fegear.contact.turns import going_on

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.contact.fitted_line import Fitted
    from fegear.contact.trace_alternatives import Alternative
    from fegear.contact.trace_low_pass import LowPass

#: Fewest samples and most places of the averaged curve to a tooth pitch; fewest tooth pitches of a trace.
FEWEST_A_TOOTH, _MOST_A_TOOTH, FEWEST_PITCHES = 16, 360, 3
#: Part of a tooth pitch over which a trace may have no sample, or run back (an encoder that trembles).
_GAP = 0.25
#: Part of a turn that a trace may lack of a whole one: the last of evenly spaced samples.
_SLACK = 1e-3
#: Harmonics of the mesh that are compared at most.
_HARMONICS = 12
#: Largest part of the samples that are spikes; groups of teeth whose gains are compared, and fewest of them.
_MOST_SPIKES, _GROUPS, _FEW_GROUPS = 0.1, 24, 3
#: Logarithm of measured / computed up to which a trace may be at another torque.
_OF_CURVE = math.log(1.15)
#: Fewest turns whose means have a scatter.
_TURNS = 3
#: Orders of each gear that are fitted together, and periods over the trace that tell two of them apart.
_LINES, _APART = 3, 0.35
_TURN = 2.0 * math.pi


class ShortTraceError(ValueError):
    """A trace covers too few tooth pitches, or has too few samples on each."""

    def __init__(self, pitches: float, samples: float) -> None:
        super().__init__(f"{pitches:.3g} tooth pitches, {samples:.3g} samples on each")
        self.pitches, self.samples = pitches, samples


class UnevenTraceError(ValueError):
    """A trace runs back, or has a stretch without samples; the text is a rule on the trace."""


@dataclass(frozen=True)
class OrderLine:
    """One order of a trace: amplitude cos(order angle - phase) [m], [rad]."""

    order: float
    amplitude: float
    phase: float

    def at(self, angle: Array) -> Array:
        """[m]."""
        return np.asarray(self.amplitude * np.cos(self.order * angle - self.phase))


@dataclass(frozen=True)
class OrderSpectrum(ReadOnlyArrays):
    """Orders of a trace over whole turns of the shaft, or over whole tooth pitches where it has no whole turn.

    Parameters
    ----------
    turns : float
        That it is taken over.
    order, amplitude : ndarray, shape (N,)
        Per turn of the shaft, from the first above zero; 0-peak [m].
    phase : ndarray, shape (N,)
        Of cos(order angle - phase) [rad].
    """

    turns: float
    phase: Array = shown("deg", "phase: order times the rotation of the shaft at the maximum")
    order: Array = shown("", "order per revolution of the shaft of the angle", label="order")
    amplitude: Array = shown("um", "amplitude of the measured transmission error", label="amplitude")

    def line(self, order: float) -> OrderLine | None:
        """An order that it has; None of a trace without a whole turn."""
        at = int(np.abs(self.order - order).argmin())
        if self.turns < 1.0 or abs(self.order[at] - order) > 1e-6:
            return None
        return OrderLine(order, float(self.amplitude[at]), float(self.phase[at]))

    def beside(self, lines: Sequence[OrderLine]) -> OrderSpectrum:
        """With further lines, in the place of any of the same order."""
        if not lines:
            return self
        added = np.array([one.order for one in lines])
        kept = np.abs(self.order[:, None] - added).min(axis=1) > 1e-9
        orders = np.concatenate([self.order[kept], added])
        ascending = np.argsort(orders, kind="stable")
        phase, amplitude = (
            np.concatenate([known[kept], more])[ascending]
            for known, more in (
                (self.phase, [one.phase for one in lines]), (self.amplitude, [one.amplitude for one in lines])
            )
        )  # fmt: skip
        return OrderSpectrum(self.turns, phase, orders[ascending], amplitude)


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


@dataclass(frozen=True)
class FittedError(FittedCurve):
    """A measured curve of the mesh over the computed one; angles are those of the shaft."""

    offset: float = shown("um", "offset of the measured transmission error", name="measured_offset")
    scale: float = shown("", "scale of the measured transmission error (measured / computed)", name="measured_scale")
    gain: float = shown(
        "", "measured / computed transmission error by least squares at this offset and shift", name="measured_gain"
    )
    angle: Array = shown(
        "deg", "rotation of the shaft within one tooth pitch, measured angle less the shift",
        label="rotation of the shaft",
    )  # fmt: skip
    measured: Array = shown(
        "um", "measured transmission error, mean of all teeth, less the offset and divided by the scale",
        label="transmission error",
    )  # fmt: skip
    computed: Array = shown("um", "computed transmission error at this angle")

    @property
    @shows("um", "measured transmission error less the computed one", label="residual")
    def residual(self) -> Array:
        """Shape (K,)."""
        return self.measured - self.computed

    @property
    @shows("um", "measured transmission error, mean of all teeth, less the offset, not divided by the scale",
           label="transmission error")  # fmt: skip
    def as_measured(self) -> Array:
        """Shape (K,)."""
        return super().as_measured

    @property
    @shows("um", "computed transmission error times the scale", label="transmission error")
    def fitted(self) -> Array:
        """Shape (K,)."""
        return super().fitted

    @property
    @shows("um", "measured transmission error less the computed one times the scale", label="residual")
    def left_by_fit(self) -> Array:
        """Shape (K,)."""
        return super().left_by_fit

    @property
    @shows("um", "standard error of measured_offset", name="measured_offset_standard_error")
    def offset_error(self) -> float:
        """Zero where it was not fitted."""
        return self.errors["offset"]

    @property
    @shows("um", "root mean square of the residual", name="residual_rms")
    def rms(self) -> float:
        """Over one tooth pitch."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    @shows("", "correlation coefficient of measured and computed transmission error")
    def correlation(self) -> float:
        """Of Pearson."""
        return super().correlation


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
    from scipy.interpolate import CubicSpline

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
    places = min(round(samples), _MOST_A_TOOTH)
    # Evenly spaced and from a whole number of pitches on, so that phases count from angle zero.
    first = math.ceil(turned[0] / pitch - _SLACK) if turned[0] + (cycles + 1) * pitch <= turned[-1] else None
    start = turned[0] if first is None else first * pitch
    even = start + pitch / places * np.arange(cycles * places)
    values = CubicSpline(turned, te)(np.minimum(even, turned[-1]))
    mate = _of_mate(values, even, cycles / teeth, teeth / mate_teeth if mate_teeth else 0.0)
    less_mate = values - sum(one.at(even) for one in mate) if mate else values
    spectrum = _spectrum(less_mate, cycles / teeth, start)
    by_tooth = _over_pitch(values, places)
    mean, mean_error = _mean_of_turns(less_mate, values, places, teeth)
    curve, spread, averaged = by_tooth.mean(axis=0) + mean, float(by_tooth.std(axis=0).mean()), len(by_tooth)
    groups = np.array_split(by_tooth, min(averaged, _GROUPS))
    n = 1 + np.arange(min(_HARMONICS, places // 2 - 1))
    at = n * cycles - 1  # the record has `cycles` tooth pitches: harmonic n of the mesh is its n-th multiple
    at = at[at < spectrum.order.size]
    return MeasuredError(
        teeth, spectrum.beside(mate), np.mod(even[:places], pitch), curve, spread, averaged, n[: at.size],
        spectrum.amplitude[at], spectrum.phase[at], np.stack([one.mean(axis=0) for one in groups]),
        int(np.count_nonzero(spikes)), mate[0].order if mate else 0.0, mean_error,
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


def _spectrum(values: Array, turns: float, start: float) -> OrderSpectrum:
    found = np.fft.rfft(values - values.mean()) * 2.0 / values.size
    if values.size % 2 == 0:
        found[-1] *= 0.5
    order = np.arange(1, found.size) / turns
    return OrderSpectrum(turns, np.mod(order * start - np.angle(found[1:]), _TURN), order, np.abs(found[1:]))


def _of_mate(values: Array, angle: Array, turns: float, ratio: float) -> tuple[OrderLine, ...]:
    """Lines of the mating gear, which a spectrum over whole turns of the shaft would spread over its neighbours.

    By least squares together with the first orders of the shaft. Lines that stand too near to whole orders are left to
    those.

    Parameters
    ----------
    values, angle : ndarray, shape (N,)
    turns : float
        That these are over.
    ratio : float
        Order of one revolution of the mating gear; 0 for none.
    """
    if turns < 1.0 or ratio * turns < 1.0:
        return ()
    own, orders = np.arange(1.0, _LINES + 1.0), ratio * np.arange(1, _LINES + 1)
    orders = orders[np.abs(orders - np.round(orders)) * turns >= _APART]
    if not orders.size or orders[0] != ratio:
        return ()
    both = np.multiply.outer(angle, np.concatenate([own, orders]))
    found = np.linalg.lstsq(np.hstack([np.cos(both), np.sin(both), np.ones((angle.size, 1))]), values, rcond=None)[0]
    cosine, sine = found[: both.shape[1]][own.size :], found[both.shape[1] : -1][own.size :]
    return tuple(
        OrderLine(float(order), math.hypot(c, s), math.atan2(s, c) % _TURN)
        for order, c, s in zip(orders, cosine.tolist(), sine.tolist(), strict=True)
    )


def _over_pitch(values: Array, places: int) -> Array:
    """Curve over one tooth pitch of each tooth, from the first value on and without slow parts, shape (teeth, B)."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    mean = (total[places:] - total[:-places]) / places  # of each run of one pitch
    half = places // 2
    slow = mean if places % 2 else 0.5 * (mean[1:] + mean[:-1])
    quick = values[half : half + slow.size] - slow
    whole = quick.size // places
    return np.roll(quick[: whole * places].reshape(whole, places), half, axis=1)


def beside_computed(
    found: MeasuredError, x: Array, te: Array, base_pitch: float, fit: Collection[Fitted]
) -> FittedError:  # fmt: skip
    """Lay a measured curve of the mesh over a computed one.

    Parameters
    ----------
    found : MeasuredError
    x, te : ndarray, shape (P,)
        Computed transmission error over one base pitch [m].
    base_pitch : float
        [m].
    fit : collection of {"offset", "scale", "shift"}
        A shift is within half a tooth pitch to either side.
    """
    over = _Over(x, base_pitch)
    curve = over.closed(te)
    one = fit_curve(found.teeth * found.angle, found.te, over.angle, curve, fit)
    turn = 1.0 / found.teeth
    angle = np.mod(one.angle * turn, _TURN * turn)
    order = np.argsort(angle, kind="stable")
    return FittedError(
        one.fit, _errors_of_shaft(one, turn, found.mean_error), one.outside, one.offset, one.scale,
        one.shift * turn, one.gain, one.gain_error, angle[order], one.measured[order], one.computed[order],
        gain_scatter=_of_gain(found, one, over, curve), noise=one.noise,
    )  # fmt: skip


def _errors_of_shaft(one: FittedCurve, turn: float, mean_error: float) -> dict[Fitted, float]:
    """Standard errors of a curve over one tooth pitch in angles of the shaft, that of the offset with slow parts."""
    offset = math.hypot(one.errors["offset"], mean_error) if "offset" in one.fit else 0.0
    return {**one.errors, "shift": one.errors["shift"] * turn, "offset": offset}


def better_described(
    found: MeasuredError, fitted: FittedError, x: Array, curves: Mapping[str, Array], base_pitch: float,
    fit: Collection[Fitted],
) -> tuple[Alternative, ...]:  # fmt: skip
    """Descriptions of a trace that fit clearly better, shifts in angles of the shaft.

    Parameters
    ----------
    found : MeasuredError
    fitted : FittedError
        As it is described.
    x : ndarray, shape (P,)
    curves : mapping of str to ndarray, shape (P,)
        Computed transmission error: under the empty name that beside which it is, and others, which have to fit in
        size as well.
    base_pitch : float
    fit : collection of {"offset", "scale", "shift"}
    """
    over = _Over(x, base_pitch)
    asked = {name: over.closed(te) for name, te in curves.items()}
    described = partial(alternatives, fitted, found.teeth * found.angle, found.te, over.angle)
    better = described(asked, fit)
    wrong = {one.curve for one in better if one.curve and abs(math.log(one.fitted.gain)) > _OF_CURVE}
    if wrong:  # another shape of the size of none of them
        better = described({name: te for name, te in asked.items() if name not in wrong}, fit)
    return tuple(replace(one, fitted=replace(one.fitted, shift=one.fitted.shift / found.teeth)) for one in better)


def behind_low_pass(
    found: MeasuredError, fitted: FittedError, x: Array, te: Array, base_pitch: float, fit: Collection[Fitted]
) -> LowPass | None:  # fmt: skip
    """The low pass with which a trace fits clearly better, its time constant as an angle of the shaft; None for none.

    Parameters
    ----------
    found : MeasuredError
        Of a trace along which the shaft turns forward.
    fitted : FittedError
        As it is described.
    x, te : ndarray, shape (P,)
        Computed transmission error over one base pitch [m].
    base_pitch : float
    fit : collection of {"offset", "scale", "shift"}
    """
    over = _Over(x, base_pitch)
    behind = low_pass(fitted, found.teeth * found.angle, found.te, over.angle, over.closed(te), fit, repeats=True)
    return behind and replace(behind, lag=behind.lag / found.teeth)


class _Over:
    """One base pitch as a turn: the computed curve over the number of teeth times the angle."""

    def __init__(self, x: Array, base_pitch: float) -> None:
        phase = _TURN * (x - x[0]) / base_pitch
        self._inside = phase < _TURN
        # Zero of both angles is where a tooth pair is at the pitch point.
        self.angle = _TURN * x[0] / base_pitch + np.append(phase[self._inside], _TURN)

    def closed(self, te: Array) -> Array:
        """Transmission error over these angles."""
        return np.append(te[self._inside], te[0])


def _of_gain(found: MeasuredError, one: FittedCurve, over: _Over, curve: Array) -> float:
    """Standard error of the gain by how it differs between groups of teeth; of one group, by the noise of the curve."""
    if len(found.by_teeth) < _FEW_GROUPS:
        return one.gain_scatter
    begin = over.angle[0]
    at = np.interp(np.mod(found.teeth * found.angle - one.shift - begin, _TURN) + begin, over.angle, curve)
    own = at - at.mean()
    gains = found.by_teeth @ own / (own @ own)
    return float(gains.std(ddof=1)) / math.sqrt(gains.size)
