"""Which single number that is otherwise than stated makes the computed curve the measured one: value, error, share.

For each number that may be otherwise the computed curve is that of the changed pair, laid over the measured one with
offset and shift as they are fitted, and with a scale that is one within what load and encoders, or load and place of
a gauge, are uncertain by: a relief must not make up for a torque. The number with the least sum of squares is found by
solving again; its standard error is by the curvature of that sum and by what it leaves, whose neighbours do not differ
independently. Numbers that leave about as little cannot be distinguished apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.possible_flanks import Possible

    CurvesOf = Callable[[Possible, float], Sequence[tuple[Array, Array]]]

#: Values of a number that are looked at first, shifts to either side, and how close the best is found over its range.
_VALUES, _SHIFTS, _CLOSE = 9, 48, 1e-3
#: Step over the range of a number by which the curvature is taken.
_STEP = 0.02
#: Part of the range of a curve that the computation, or the average of a trace, may be off anywhere.
_OFF = 2e-3
#: Part of the variance beside the stated curve that a cause leaves at most; times that of the best which is as good.
_LEAVES, _AS_GOOD = 0.25, 2.0
#: Gain as chi squared, and residual beside the stated curve over its range and over the noise, from which on one is.
_CERTAIN, _LARGE, _OF_NOISE = 50.0, 0.01, 2.0
#: Standard errors by which a number differs from the stated one, and tolerances by which the scale may.
_DIFFERS = 2.0
#: Least part of the residual that a cause is named for which is not the best one.
_SOME = 0.1


@dataclass(frozen=True)
class Traced:
    """A measured curve at places of the computed one.

    Parameters
    ----------
    places, values : ndarray, shape (P,)
        [rad], any unit.
    noise : float
        Standard error of each value.
    offset : bool
        Whether its zero is anywhere.
    shift : float
        Largest shift to either side [rad]; 0 where it is known.
    tolerance : float
        Of the scale, relative.
    period : float or None
        Of the computed curve [rad]; None of one that does not repeat.
    load_tolerance : float
        Relative.
    """

    places: Array
    values: Array
    noise: float
    offset: bool
    shift: float
    tolerance: float
    period: float | None = None
    load_tolerance: float = 0.0


@dataclass(frozen=True)
class Cause:
    """One number otherwise than stated.

    Parameters
    ----------
    of : Possible
    value, error : float
        And its standard error.
    explained : float
        Part of the sum of squares beside the stated curves that it explains.
    rms : float
        That is left of the last trace, in its unit.
    """

    of: Possible
    value: float
    error: float
    explained: float
    rms: float


@dataclass(frozen=True)
class Causes:
    """What may be otherwise than stated, the likeliest first.

    Parameters
    ----------
    causes : tuple of Cause
        All that explain some of the residual.
    alike : int
        How many of the first cannot be distinguished apart; 0 where none explains the traces.
    rms : float
        Of the last trace beside the stated curve.
    """

    causes: tuple[Cause, ...] = ()
    alike: int = 0
    rms: float = 0.0

    @property
    def best(self) -> Cause | None:
        """The likeliest; None where none explains the traces."""
        return self.causes[0] if self.alike else None


def likeliest_causes(
    traces: Sequence[Traced], possible: Sequence[Possible], curves_of: CurvesOf,
    within: Callable[[Cause], bool] = lambda _cause: False,
) -> Causes:  # fmt: skip
    """Causes of what traces differ by from the stated curves; none where they do not differ.

    Parameters
    ----------
    traces : sequence of Traced
        One, or several that have all stated numbers in common.
    possible : sequence of Possible
        The first as stated is the stated curve.
    curves_of : callable
        Angle [rad] and curve beside each trace, with a value of one of them.
    within : callable
        Whether a cause is within its own tolerance, so that nothing is otherwise than stated.
    """
    as_stated = curves_of(possible[0], possible[0].stated)
    least = [
        math.hypot(one.noise, _OFF * float(np.ptp(curve))) for one, (_, curve) in zip(traces, as_stated, strict=True)
    ]
    stated = _Beside(traces, as_stated, least)
    if not any(rms >= _LARGE * float(np.ptp(curve)) for rms, (_, curve) in zip(stated.rms, as_stated, strict=True)):
        return Causes(rms=stated.rms[-1])
    sought = (_cause(traces, one, curves_of, stated) for one in possible)
    found = sorted((one for one in sought if one is not None), key=lambda one: -one[0].explained)
    some = tuple(one for one, _ in found if one.explained > _SOME)
    if not some:
        return Causes(rms=stated.rms[-1])
    count, best = stated.count, found[0][1]
    if best > _LEAVES * stated.squares or stated.squares - best < _CERTAIN * max(best / count, 1.0):
        return Causes(some, 0, stated.rms[-1])
    alike = [one for one, left in found if one.explained > _SOME and left <= _AS_GOOD * max(best, count)]
    if any(within(one) for one in alike):
        return Causes(rms=stated.rms[-1])
    return Causes(some, len(alike), stated.rms[-1])


class _Beside:
    """Traces beside computed curves: the best shift of each, and what is left as chi squared."""

    def __init__(self, traces: Sequence[Traced], curves: Sequence[tuple[Array, Array]], least: Sequence[float]) -> None:
        each = [_Laid(trace, *curve, one) for trace, curve, one in zip(traces, curves, least, strict=True)]
        self.least = least
        self.count = sum(trace.values.size for trace in traces)
        self.squares = sum(laid.squares / one**2 for laid, one in zip(each, least, strict=True))
        self.rms = [math.sqrt(laid.squares / trace.values.size) for laid, trace in zip(each, traces, strict=True)]
        self._each = each

    @property
    def alike(self) -> float:
        """How many neighbours in a residual differ alike, by their correlation."""
        rest = [laid.residual for laid in self._each]
        size = sum(float(one @ one) for one in rest)
        of_next = sum(float(one[1:] @ one[:-1]) for one in rest) / size if size else 0.0
        most = 0.25 * min(one.size for one in rest)
        return min((1.0 + of_next) / max(1.0 - of_next, 1e-3), most) if of_next > 0.0 else 1.0


class _Laid:
    """A trace over one computed curve, at its best shift."""

    def __init__(self, trace: Traced, angle: Array, curve: Array, least: float) -> None:
        self._trace, self._angle, self._curve = trace, angle, curve
        self._known = (least / max(trace.tolerance, 1e-6)) ** 2
        self._shift, self.squares = 0.0, float(self._left(np.zeros(1))[0])
        if trace.shift:
            self._shifted()

    def _shifted(self) -> None:
        from scipy.optimize import minimize_scalar

        grid = np.linspace(-self._trace.shift, self._trace.shift, 2 * _SHIFTS + 1)
        at, step = grid[int(self._left(grid).argmin())], grid[1] - grid[0]
        found = minimize_scalar(
            lambda one: float(self._left(np.array([one]))[0]), bounds=(at - step, at + step), method="bounded",
            options={"xatol": 1e-3 * step},
        )  # fmt: skip
        self._shift, self.squares = float(found.x), float(found.fun)

    @property
    def residual(self) -> Array:
        """At the best shift, shape (P,)."""
        return np.asarray(self._residuals(np.array([self._shift]))[0][0])

    def _left(self, shifts: Array) -> Array:
        rest, scale = self._residuals(shifts)
        return np.asarray((rest**2).sum(axis=1) + self._known * (scale - 1.0) ** 2)

    def _residuals(self, shifts: Array) -> tuple[Array, Array]:
        trace = self._trace
        at = trace.places[None] - shifts[:, None]
        if trace.period is not None:
            at = np.mod(at - self._angle[0], trace.period) + self._angle[0]
        curve, values = np.interp(at, self._angle, self._curve), trace.values
        if trace.offset:
            curve, values = curve - curve.mean(axis=1, keepdims=True), values - values.mean()
        scale = (curve @ values + self._known) / ((curve**2).sum(axis=1) + self._known)
        most = _DIFFERS * trace.tolerance
        scale = np.clip(scale, 1.0 - most, 1.0 + most)
        return values - scale[:, None] * curve, scale


def _cause(traces: Sequence[Traced], of: Possible, curves_of: CurvesOf, stated: _Beside) -> tuple[Cause, float] | None:
    """The best value of a number, and what it leaves; None where it is the stated one, or at an end."""
    from scipy.optimize import minimize_scalar

    def beside(value: float) -> _Beside:
        return _Beside(traces, curves_of(of, value), stated.least)

    values = np.linspace(of.low, of.high, _VALUES)
    k, span = int(np.argmin([beside(one).squares for one in values])), of.high - of.low
    ends = values[max(k - 1, 0)], values[min(k + 1, _VALUES - 1)]
    found = minimize_scalar(
        lambda one: beside(one).squares, bounds=ends, method="bounded", options={"xatol": _CLOSE * span}
    )
    value, step = float(found.x), _STEP * span
    if (of.low != 0.0 and value - of.low < step) or of.high - value < step:
        return None  # it goes on beyond
    best, (below, above) = beside(value), (beside(value + side * step).squares for side in (-1.0, 1.0))
    curved = 0.5 * (below + above - 2.0 * best.squares) / step**2
    if curved <= 0.0:
        return None
    error = math.sqrt(max(best.squares / best.count, 1.0) * best.alike / curved)
    if of.kind == "tip relief":  # deflections are in proportion to the load, and with them what a relief makes up for
        error = math.hypot(error, value * traces[-1].load_tolerance)
    if best.squares >= stated.squares or abs(value - of.stated) < _DIFFERS * error:
        return None
    return Cause(of, value, error, 1.0 - best.squares / stated.squares, best.rms[-1]), best.squares
