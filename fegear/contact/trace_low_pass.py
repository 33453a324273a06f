"""Whether a trace is what a low pass makes of the computed curve: filter or bandwidth of an amplifier.

A time constant T at the rotation speed w is an angle w T, whatever the speed. The computed curve is filtered along the
rotation, with its first value before its beginning, or as one that repeats (a transmission error over a tooth pitch),
and the trace is fitted to it as to the curve itself; the shift takes up the delay. Behind a low pass of first order it
stays skewed; what amplifiers have are mostly Butterworth and Bessel filters of higher order, which delay more, and of
which the first ring. They are looked for where that of first order leaves something.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.contact.curve_fit import NothingToCompareError, fit_curve
from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.trace_alternatives import clearly_better, unexplained
from fegear.contact.turns import turns_along

if TYPE_CHECKING:
    from collections.abc import Collection

    from fegear.base.arrays import Array
    from fegear.contact.fitted_line import Fitted

Kind = Literal["", "Butterworth", "Bessel", "moving average"]

#: Angles of the time constant that are looked at first, up to a good part of the contact of a tooth, or of a curve that
#: repeats with a full turn [rad].
_LAGS, _LAGS_OF_PERIOD = np.radians(np.geomspace(0.2, 20.0, 9)), np.geomspace(0.05, 5.0, 9)
#: Part of the variance left unexplained below which nothing is looked for; of a curve that repeats, the mean of many.
_EXPLAINED, _EXPLAINED_OF_PERIOD = 2e-3, 3e-4
#: Least correlation behind a low pass, noise included: a rounder curve fits nearly every wrong one better.
_FITS = 0.97
#: Kinds of filters of higher order that are looked for, and their orders.
HIGHER: tuple[tuple[Kind, int], ...] = (
    ("Butterworth", 2), ("Butterworth", 4), ("Butterworth", 8), ("Bessel", 4), ("moving average", 1),
)  # fmt: skip
#: Width of a moving average over one over its limiting angular frequency (-3 dB): twice the root of sin x = x / sqrt 2.
WIDTH_OF_AVERAGE = 2.783115
#: Part of a curve over which a moving average is taken at most: a wider one leaves of any curve the same.
MOST_OF_CURVE = 0.4
#: Times less that a filter of higher order has to leave unexplained than that of first order.
_LESS = 2.0
#: Time constants after which all of them have settled.
_SETTLED = 25.0
#: Samples that are fitted at most, and to choose among filters of higher order; points of the filtered curve.
_MOST, _MOST_RANKED, _POINTS = 4000, 1000, 3000
#: How close a logarithm of the time constant is found.
_CLOSE = {"xatol": 0.01}


@dataclass(frozen=True)
class LowPass:
    """A low pass that explains a trace.

    Parameters
    ----------
    lag : float
        Rotation within its time constant, one over the limiting angular frequency (-3 dB) [rad].
    fitted : FittedCurve
        The trace laid over the filtered curve.
    kind : {"", "Butterworth", "Bessel", "moving average"}
        Empty for first order.
    order : int
        Of a moving average 1.
    """

    lag: float
    fitted: FittedCurve
    kind: Kind = ""
    order: int = 1

    @property
    def width(self) -> float:
        """Rotation over which a moving average is taken [rad]."""
        return WIDTH_OF_AVERAGE * self.lag


def filtered_higher(
    angle: Array, curve: Array, lag: float, kind: Kind, order: int, *, repeats: bool = False
) -> tuple[Array, Array]:  # fmt: skip
    """The curve behind a low pass of higher order, over uniform angles, by its transfer function.

    Parameters
    ----------
    angle, curve : ndarray, shape (Q,)
        Ascending [rad], any unit.
    lag : float
        Rotation within one over the limiting angular frequency (-3 dB) [rad].
    kind : {"Butterworth", "Bessel", "moving average"}
    order : int
    repeats : bool
        Whether the curve begins again where it ends; else it had its first value before.
    """
    at = np.linspace(angle[0], angle[-1], _POINTS)
    values = np.interp(at, angle, curve)
    step = at[1] - at[0]
    before = 0 if repeats else math.ceil(_SETTLED * lag / step)
    # of a curve that repeats the last point is the first one
    before_it = np.concatenate([np.full(before, values[0]), values[:-1] if repeats else values]) - values[0]
    frequency = 2.0 * math.pi * np.fft.rfftfreq(before_it.size, step)
    output = np.fft.irfft(np.fft.rfft(before_it) * _transfer(kind, order, frequency * lag), before_it.size)
    if repeats:
        return at, np.append(output, output[0]) + values[0]
    return at, output[before:] + values[0]


def _transfer(kind: Kind, order: int, frequency: Array) -> Array:
    """Of a filter whose limiting angular frequency is one."""
    if kind == "moving average":  # of the samples before: the mean of exp(-i w t) over its width
        half = 0.5 * WIDTH_OF_AVERAGE * frequency
        return np.asarray(np.exp(-1j * half) * np.sinc(half / math.pi))
    from scipy.signal import bessel, butter, freqs_zpk

    made = butter(order, 1.0, analog=True, output="zpk") if kind == "Butterworth" else bessel(
        order, 1.0, analog=True, output="zpk", norm="mag"
    )  # fmt: skip
    found: Array = freqs_zpk(*made, worN=frequency)[1]
    return found


def delay(kind: Kind, order: int) -> float:
    """Of what is slow, over one over the limiting angular frequency."""
    if not kind:
        return 1.0
    slow = 1e-4
    return -float(np.angle(_transfer(kind, order, np.array([slow]))[0])) / slow


def filtered(angle: Array, curve: Array, lag: float, *, repeats: bool = False) -> tuple[Array, Array]:
    """The curve behind a low pass of first order, over uniform angles.

    Parameters
    ----------
    angle, curve : ndarray, shape (Q,)
        Ascending [rad], any unit.
    lag : float
        Rotation within the time constant [rad].
    repeats : bool
        Whether the curve begins again where it ends; else it had its first value before.
    """
    at = np.linspace(angle[0], angle[-1], _POINTS)
    step = (at[1] - at[0]) / lag
    kept = math.exp(-step)
    # exact for a curve that is linear between the points: y' = (x - y) / lag
    new, old = 1.0 - (1.0 - kept) / step, (1.0 - kept) / step - kept
    values = np.interp(at, angle, curve)
    entering = (new * values[1:] + old * values[:-1]).tolist()

    def behind(first: float) -> Array:
        return np.array(list(accumulate(entering, lambda before, into: kept * before + into, initial=first)))

    found = behind(float(values[0]))
    if not repeats:
        return at, found
    # begun otherwise by d it ends otherwise by d exp(-length / lag)
    return at, behind(float(values[0] + (found[-1] - values[0]) / -math.expm1(-(at[-1] - at[0]) / lag)))


def low_pass(
    found: FittedCurve, angle: Array, measured: Array, curve_angle: Array, curve: Array, fit: Collection[Fitted], *,
    repeats: bool = False,
) -> LowPass | None:  # fmt: skip
    """The low pass with which a trace fits clearly better; None where there is none.

    Parameters
    ----------
    found : FittedCurve
        The trace as it is described.
    angle, measured : ndarray, shape (N,)
        In the order of the trace [rad], any unit.
    curve_angle, curve : ndarray, shape (Q,)
        Computed, ascending [rad].
    fit : collection of str
        What was asked for.
    repeats : bool
        Whether the curve is one turn that repeats.
    """
    explained = _EXPLAINED_OF_PERIOD if repeats else _EXPLAINED
    if unexplained(found) < explained or float(np.median(np.diff(np.unwrap(angle)))) <= 0.0:
        return None  # it fits, or time goes against the angle
    from scipy.optimize import minimize_scalar

    turned = turns_along(angle) * 2.0 * math.pi + angle[0]

    def through(log_lag: float, kind: Kind, order: int, most: int) -> FittedCurve | None:
        lag, some = math.exp(log_lag), slice(None, None, -(-angle.size // most))
        try:
            behind = (
                filtered_higher(curve_angle, curve, lag, kind, order, repeats=repeats) if kind else
                filtered(curve_angle, curve, lag, repeats=repeats)
            )  # fmt: skip
            return fit_curve(turned[some], measured[some], *behind, {*fit, "scale"})
        except NothingToCompareError:
            return None

    def left(log_lag: float, kind: Kind, order: int, most: int) -> float:
        return _left(through(log_lag, kind, order, most))

    logs = np.log(_LAGS_OF_PERIOD if repeats else _LAGS)

    longest = math.log(MOST_OF_CURVE * float(curve_angle[-1] - curve_angle[0]) / WIDTH_OF_AVERAGE)

    def nearest(kind: Kind, order: int, most: int) -> tuple[float, float]:
        """What the best lag of a kind leaves unexplained, and its logarithm."""
        some = logs[: np.searchsorted(logs, longest)] if kind == "moving average" else logs
        best = int(np.argmin([left(one, kind, order, most) for one in some]))
        ends = some[max(best - 1, 0)], some[min(best + 1, some.size - 1)]
        found = minimize_scalar(left, bounds=ends, args=(kind, order, most), method="bounded", options=_CLOSE)
        return float(found.fun), float(found.x)

    def laid(log_lag: float, kind: Kind, order: int) -> LowPass | None:
        fitted = through(log_lag, kind, order, _MOST)
        return None if fitted is None else LowPass(math.exp(log_lag), fitted, kind, order)

    best = laid(nearest("", 1, _MOST)[1], "", 1)
    if best is None or unexplained(best.fitted) > explained:
        (_, log_lag), which = min((nearest(*one, _MOST_RANKED), one) for one in HIGHER)
        higher = laid(log_lag, *which)
        if higher is not None and _LESS * _left(higher.fitted) < _left(None if best is None else best.fitted):
            best = higher
    if best is None or best.fitted.correlation < _FITS or not clearly_better(best.fitted, found):
        return None
    return best


def _left(found: FittedCurve | None) -> float:
    """Part of the variance of a trace that its curve leaves, with the noise."""
    return 1.0 if found is None or found.gain <= 0.0 else 1.0 - found.correlation**2
