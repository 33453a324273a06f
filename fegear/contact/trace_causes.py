"""Which single number that is otherwise than stated makes the computed curve the measured one: value, error, share.

For each number that may be otherwise the computed curve is that of the changed pair, laid over the measured one with
offset and shift as they are fitted, and with a scale that is one within what load and encoders, or load and place of
a gauge, are uncertain by: a relief must not make up for a torque. The number with the least sum of squares is found by
solving again; its standard error is by the curvature of that sum and by what it leaves, whose neighbours do not differ
independently.

Causes are ranked by one measure: what each leaves against the noise of the trace, and by how many of its tolerances the
number is off, with a distribution that allows for mistakes. Causes that are about as likely cannot be distinguished.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.possible_flanks import Possible

    CurvesOf = Callable[[Possible, float], Sequence[tuple[Array, Array]]]

#: Values of a number that are looked at first, shifts to either side, and how close the best is found over its range.
_VALUES, _SHIFTS, _CLOSE = 9, 48, 1e-3
#: Times what the best one leaves above which a parabola through three values tells enough of a number.
_HOPELESS = 4.0
#: Step over the range of a number by which the curvature is taken.
_STEP = 0.02
#: Part of the range of a curve that the computation, or the average of a trace, may be off anywhere.
_OFF = 2e-3
#: Part of the variance beside the stated curve that a cause leaves at most.
_LEAVES = 0.25
#: Neighbours among the values of a trace that are wrong alike where the computed curve is.
_TOGETHER = 8.0
#: Difference of the measure, twice a logarithm of the likelihood, within which causes cannot be distinguished.
_AS_LIKELY = 4.0
#: Gain as chi squared, and residual beside the stated curve over its range and over the noise, from which on one is.
_CERTAIN, _LARGE, _OF_NOISE = 50.0, 0.006, 2.0
#: Residual over the range of the curve from which on it is said what explains most of it where nothing explains it.
_UNEXPLAINED = 0.01
#: Standard errors by which a number differs from the stated one.
_DIFFERS = 2.0
#: Tolerances by which the scale may differ.
_SCALE_OFF = 1.25
#: Kinds of causes that change the size of a trace themselves; of these, those beside which the load may be another.
SIZES, _PLACES = ("load", "scale", "place", "bridge"), ("place", "bridge")
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
    tolerances : float
        By how many of its tolerances the number is off; zero of one that has none.
    unlikely : float
        The measure by which causes are ranked: the smaller, the likelier.
    """

    of: Possible
    value: float
    error: float
    explained: float
    rms: float
    tolerances: float = 0.0
    unlikely: float = 0.0


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
    within : bool
        Whether one of those is within its own tolerance, so that nothing has to be otherwise than stated.
    curves : sequence of (ndarray, ndarray)
        Angle and curve beside each trace with the first cause.
    """

    causes: tuple[Cause, ...] = ()
    alike: int = 0
    rms: float = 0.0
    within: bool = False
    curves: Sequence[tuple[Array, Array]] = ()

    @property
    def best(self) -> Cause | None:
        """The likeliest; None where none explains the traces, or one that is within its tolerance does."""
        return self.causes[0] if self.alike and not self.within else None


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
    sizes = [float(np.ptp(curve)) for _, curve in as_stated]
    if not any(
        rms >= max(_LARGE * size, _OF_NOISE * one.noise)
        for rms, size, one in zip(stated.rms, sizes, traces, strict=True)
    ):
        return Causes(rms=stated.rms[-1])
    found = _ranked([one for one in _sought(traces, possible, curves_of, stated) if one.explained > _SOME])
    if not found:
        return Causes(rms=stated.rms[-1])
    count, best = stated.count, (1.0 - found[0].explained) * stated.squares
    if best > _LEAVES * stated.squares or stated.squares - best < _CERTAIN * max(best / count, 1.0):
        if all(rms < _UNEXPLAINED * size for rms, size in zip(stated.rms, sizes, strict=True)):
            return Causes(rms=stated.rms[-1])
        return Causes(tuple(sorted(found, key=lambda one: -one.explained)), 0, stated.rms[-1])
    alike = [
        one for one in found
        if one.unlikely <= found[0].unlikely + _AS_LIKELY and 1.0 - one.explained <= _LEAVES
    ]  # fmt: skip
    rest = [one for one in found if one not in alike]
    return Causes(
        (*alike, *rest), len(alike), stated.rms[-1], any(within(one) for one in alike),
        curves_of(alike[0].of, alike[0].value),
    )  # fmt: skip


def _ranked(found: list[Cause]) -> list[Cause]:
    """The likeliest first, of filters the likeliest only."""
    found = sorted(found, key=lambda one: one.unlikely)
    filters = [one for one in found if one.of.kind == "filter"]
    return [one for one in found if one not in filters[1:]]


class _Beside:
    """Traces beside computed curves: the best shift of each, and what is left as chi squared."""

    def __init__(self, traces: Sequence[Traced], curves: Sequence[tuple[Array, Array]], least: Sequence[float]) -> None:
        each = [_Laid(trace, *curve, one) for trace, curve, one in zip(traces, curves, least, strict=True)]
        self.least = least
        self.count = sum(trace.values.size for trace in traces)
        self.squares = sum(laid.squares / one**2 for laid, one in zip(each, least, strict=True))
        self.scale_off = max(laid.scale_off for laid in each)
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

    @property
    def scale_off(self) -> float:
        """By how many tolerances the scale differs from one."""
        scale = float(self._residuals(np.array([self._shift]))[1][0])
        return abs(scale - 1.0) / self._trace.tolerance if self._trace.tolerance else 0.0

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
        most = _SCALE_OFF * trace.tolerance
        scale = np.clip(scale, 1.0 - most, 1.0 + most)
        return values - scale[:, None] * curve, scale


class _Number:
    """A number that may be otherwise: what its values leave, the best of them sought as far as it is worth it."""

    def __init__(
        self, traces: Sequence[Traced], of: Possible, curves_of: CurvesOf, stated: _Beside
    ) -> None:  # fmt: skip
        if of.kind in SIZES:  # what else scales a trace is a tolerance of its own, or none
            traces = [replace(one, tolerance=one.load_tolerance if of.kind in _PLACES else 0.0) for one in traces]
        self._traces, self.of, self._curves_of, self._stated = traces, of, curves_of, stated
        self._known: dict[float, _Beside] = {}
        self.values = np.linspace(of.low, of.high, _VALUES) if of.high > of.low else np.array([of.low])
        left = [self.beside(one).squares for one in self.values.tolist()]
        self._k = int(np.argmin(left))
        self.about, self.least = self._parabola(left)

    def beside(self, value: float) -> _Beside:
        """What a value leaves."""
        if value not in self._known:
            self._known[value] = _Beside(self._traces, self._curves_of(self.of, value), self._stated.least)
        return self._known[value]

    def _parabola(self, left: Sequence[float]) -> tuple[float, float]:
        """About the best value, and what it may leave at least."""
        k = self._k
        if not 0 < k < self.values.size - 1:
            return float(self.values[k]), min(left)
        below, middle, above = left[k - 1 : k + 2]
        curved, slope = below + above - 2.0 * middle, 0.5 * (above - below)
        move = -slope / curved if curved > 0.0 else 0.0
        return float(self.values[k] + move * (self.values[1] - self.values[0])), max(middle + 0.5 * slope * move, 0.0)

    def best(self, *, close: bool) -> float:
        """The best value, by a few more of them or by the parabola."""
        if not close or self.values.size == 1:
            return self.about
        from scipy.optimize import minimize_scalar

        ends = self.values[max(self._k - 1, 0)], self.values[min(self._k + 1, _VALUES - 1)]
        close_by = {"xatol": _CLOSE * (self.of.high - self.of.low)}
        found = minimize_scalar(lambda one: self.beside(float(one)).squares, bounds=ends, method="bounded",
                                options=close_by)  # fmt: skip
        return float(found.x)

    def cause(self, value: float) -> Cause | None:
        """With its error and how likely it is; None where it is the stated one, or at an end."""
        of, stated, best = self.of, self._stated, self.beside(value)
        if best.squares >= stated.squares:
            return None
        error = 0.0
        if of.high > of.low:
            step = _STEP * (of.high - of.low)
            if (of.low != 0.0 and value - of.low < step) or of.high - value < step:
                return None  # it goes on beyond
            below, above = (self.beside(value + side * step).squares for side in (-1.0, 1.0))
            curved = 0.5 * (below + above - 2.0 * best.squares) / step**2
            if curved <= 0.0:
                return None
            error = math.sqrt(max(best.squares / best.count, 1.0) * best.alike / curved)
            if of.kind == "tip relief":  # deflections are in proportion to the load, and what a relief makes up for
                error = math.hypot(error, value * self._traces[-1].load_tolerance)
            if abs(value - of.stated) < _DIFFERS * error:
                return None
        off = abs(value - of.stated) / of.tolerance if of.tolerance else of.unlikely
        unlikely = best.count / _TOGETHER * math.log(max(best.squares / best.count, 1.0))
        unlikely += 2.0 * math.log1p(off**2 + best.scale_off**2)
        return Cause(
            of, value, error, 1.0 - best.squares / stated.squares, best.rms[-1], off if of.tolerance else 0.0, unlikely
        )  # fmt: skip


def _sought(
    traces: Sequence[Traced], possible: Sequence[Possible], curves_of: CurvesOf, stated: _Beside
) -> list[Cause]:  # fmt: skip
    """The best value of each number, found closely where it may be the likeliest."""
    numbers = sorted((_Number(traces, one, curves_of, stated) for one in possible), key=lambda one: one.least)
    found, best = [], math.inf
    for one in numbers:
        close = one.least <= _HOPELESS * max(best, stated.count)
        cause = one.cause(one.best(close=close))
        if cause is not None:
            found.append(cause)
            best = min(best, (1.0 - cause.explained) * stated.squares)
    return found
