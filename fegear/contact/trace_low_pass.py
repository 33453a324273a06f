"""Whether a trace is what a low pass of first order makes of the computed curve: filter or bandwidth of an amplifier.

A time constant T at the rotation speed w is an angle w T, whatever the speed. The computed curve is filtered along the
rotation, with its first value before its beginning, or as one that repeats (a transmission error over a tooth pitch),
and the trace is fitted to it as to the curve itself; the shift takes up the delay, so that filters of higher order,
which delay more, have nearly the same shape.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fitted_curve import FittedCurve, NothingToCompareError, fit_curve
from fegear.contact.trace_alternatives import clearly_better, unexplained
from fegear.contact.turns import turns_along

if TYPE_CHECKING:
    from collections.abc import Collection

    from fegear.base.arrays import Array
    from fegear.contact.fitted_line import Fitted

#: Angles of the time constant that are looked at first, up to a good part of the contact of a tooth, or of a curve that
#: repeats with a full turn [rad].
_LAGS, _LAGS_OF_PERIOD = np.radians(np.geomspace(0.2, 20.0, 9)), np.geomspace(0.05, 5.0, 9)
#: Part of the variance left unexplained below which nothing is looked for; of a curve that repeats, the mean of many.
_EXPLAINED, _EXPLAINED_OF_PERIOD = 2e-3, 3e-4
#: Least correlation behind a low pass, noise included: a rounder curve fits nearly every wrong one better.
_FITS = 0.97
#: Samples that are fitted at most, and points of the filtered curve.
_MOST, _POINTS = 4000, 3000


@dataclass(frozen=True)
class LowPass:
    """A low pass of first order that explains a trace.

    Parameters
    ----------
    lag : float
        Rotation within its time constant [rad].
    fitted : FittedCurve
        The trace laid over the filtered curve.
    """

    lag: float
    fitted: FittedCurve


def filtered(angle: Array, curve: Array, lag: float, *, repeats: bool = False) -> tuple[Array, Array]:
    """The curve behind a low pass, over uniform angles.

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

    some = slice(None, None, -(-angle.size // _MOST))
    along = turns_along(angle)[some] * 2.0 * math.pi + angle[0]
    thinned = measured[some]

    def through(log_lag: float) -> FittedCurve | None:
        try:
            behind = filtered(curve_angle, curve, math.exp(log_lag), repeats=repeats)
            return fit_curve(along, thinned, *behind, {*fit, "scale"})
        except NothingToCompareError:
            return None

    def left(log_lag: float) -> float:
        one = through(log_lag)
        return 1.0 if one is None or one.gain <= 0.0 else 1.0 - one.correlation**2

    logs = np.log(_LAGS_OF_PERIOD if repeats else _LAGS)
    best = int(np.argmin([left(one) for one in logs]))
    ends = logs[max(best - 1, 0)], logs[min(best + 1, logs.size - 1)]
    at = float(minimize_scalar(left, bounds=ends, method="bounded", options={"xatol": 0.01}).x)
    one = through(at)
    if one is None or one.correlation < _FITS or not clearly_better(one, found):
        return None
    return LowPass(math.exp(at), one)
