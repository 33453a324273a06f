"""A measured curve laid over a computed one: offset, scale, shift and drift by least squares, with standard errors.

measured = offset + drift * turns + scale * computed(angle - shift) + residual, where only what is asked for is fitted;
else offset, drift and shift are zero and the scale is one. Angles count modulo one turn: a trace of many revolutions is
one engagement many times. Turns count along the trace, from its middle. Where the computed
curve ends there is nothing to compare with; while the shift is searched for the tooth counts as unstrained there.
Spikes, dropouts and saturated samples (`fegear.contact.trace_outliers`) are left out and counted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fitted_curve import FittedCurve
from fegear.contact.fitted_line import FITTED, Fitted, FittedLine, linear, squares_left, standard_errors
from fegear.contact.trace_outliers import Beside, outliers, suspected
from fegear.contact.trace_scatter import gains_of_turns, noise_of, of_mean, step_of
from fegear.contact.turns import turns_along

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from fegear.base.arrays import Array, Mask

#: Fewest turns of a trace that tell a drift from the curve: each of its places is there twice.
DRIFT_TURNS = 2.0
#: Fewest samples within the computed curve, beside those that the fit takes.
FEWEST = 8
_TURN = 2.0 * math.pi
#: Steps of the first search over the length of the computed curve.
_STEPS = 400
#: Steps by which a refined shift differs from the first one at most.
_BEYOND = 3
#: Share of the curve's length over which its slope is taken: at a jump it has none.
_SLOPE = 1.0 / 500.0
#: A jump: points of the curve nearer than this share of its length, and values farther apart than this of its range.
_JUMP_WITHIN, _JUMP_OF = 1e-5, 0.02
#: Fits at most, each without what is an outlier beside the last.
_ROUNDS = 5
#: Least uncertainty of a place, over the length of the curve; half of the step of the samples if that is more.
_PLACE = 1.0 / 500.0


class NothingToCompareError(ValueError):
    """A trace has too few samples where the computed curve is known."""


def fit_curve(
    angle: Array, measured: Array, curve_angle: Array, curve: Array, fit: Collection[Fitted] = (),
    resolution: float | None = None,
) -> FittedCurve:  # fmt: skip
    """Lay a measured curve over a computed one.

    Parameters
    ----------
    angle, measured : ndarray, shape (N,)
        Samples in the order of the trace [rad, any unit].
    curve_angle, curve : ndarray, shape (Q,)
        Computed, ascending [rad, the same unit]; less than a turn.
    fit : collection of {"offset", "scale", "shift", "drift"}
        A drift goes with an offset.
    resolution : float, optional
        Step in which the samples were taken. Default: found from their values.

    Raises
    ------
    NothingToCompareError
        If fewer than `FEWEST` samples, beside the fitted numbers, lie within the computed curve.
    """
    known, turns = _Computed(curve_angle, curve), turns_along(angle)
    asked: tuple[Fitted, ...] = tuple(one for one in FITTED if one in fit)
    spikes, saturated = suspected(measured)
    found = known.fitted(angle, measured, turns, asked, ~(spikes | saturated))
    for _ in range(_ROUNDS):
        again = outliers(measured, known.beside(found, angle, turns))
        if np.array_equal(again[0], spikes) and np.array_equal(again[1], saturated):
            break
        spikes, saturated = again
        found = known.fitted(angle, measured, turns, asked, ~(spikes | saturated))
    step = step_of(measured) if resolution is None else resolution
    made = known.described(found, angle, measured, turns, asked, step)
    inside = found.inside
    spikes, saturated = spikes & inside, saturated & inside
    out = spikes | saturated
    return replace(
        made, outside=int(angle.size - np.count_nonzero(inside)), spikes=int(np.count_nonzero(spikes)),
        saturated=int(np.count_nonzero(saturated)), left_out_angle=known.within(found.shift, angle[out]),
        left_out=found.line.less(measured[out], turns[out] - found.middle_turn) / (found.line.scale or 1.0),
        saturated_at=float(np.median(measured[saturated])) if saturated.any() else None,
    )  # fmt: skip


@dataclass(frozen=True)
class _Fit:
    """Shift [rad] and line of a fit, the turns that its drift counts from, samples on the curve, and those that count.

    Parameters
    ----------
    inside, used : ndarray of bool, shape (N,)
    """

    shift: float
    line: FittedLine
    middle_turn: float
    inside: Mask
    used: Mask


class _Computed:
    """A computed curve over its places, ascending [rad], that traces are laid over."""

    def __init__(self, angle: Array, curve: Array) -> None:
        self._angle, self._curve = angle, curve
        self._middle, self._half = 0.5 * (angle[0] + angle[-1]), 0.5 * (angle[-1] - angle[0])

    def within(self, shift: float, of: Array) -> Array:
        """Places of samples on the curve, one turn about its middle [rad]."""
        return np.asarray(np.mod(of - shift - self._middle + math.pi, _TURN) - math.pi + self._middle)

    def at(self, places: Array) -> Array:
        """The curve there."""
        return np.interp(places, self._angle, self._curve)

    def fitted(self, angle: Array, measured: Array, turns: Array, asked: tuple[Fitted, ...], kept: Mask) -> _Fit:
        """Least squares over the samples that are kept.

        Raises
        ------
        NothingToCompareError
        """
        shift = 0.0
        if "shift" in asked:
            a, y, along = angle[kept], measured[kept], turns[kept]
            steady = y - _drift_by_places(a, along, y) * along if "drift" in asked else y
            shift = _searched(a, steady, self.at, self._half, self._middle, asked)
        used = kept & (np.abs(self.within(shift, angle) - self._middle) <= self._half)
        if np.count_nonzero(used) < FEWEST + len(asked):
            raise NothingToCompareError
        a, y, turn = angle[used], measured[used], turns[used]
        middle_turn = float(turn.mean())
        turn = turn - middle_turn
        if "shift" in asked:
            step = 2.0 * self._half / _STEPS
            shift = _refined(lambda at: squares_left(self.at(self.within(at, a)), y, turn, asked), shift, step)
        line = linear(self.at(self.within(shift, a)), y, turn, asked)
        inside = np.abs(self.within(shift, angle) - self._middle) <= self._half
        return _Fit(shift, line, middle_turn, inside, used)

    def beside(self, found: _Fit, angle: Array, turns: Array) -> Beside:
        """All samples beside what was fitted to some of them."""
        place, line = self.within(found.shift, angle), found.line
        step = float(np.median(np.abs(np.diff(turns)))) * _TURN if turns.size > 1 else 0.0
        reach = max(0.5 * step, 2.0 * self._half * _PLACE)
        around = np.stack([self.at(place - reach), self.at(place), self.at(place + reach)])
        fitted = line.scale * around[1] + line.offset + line.drift * (turns - found.middle_turn)
        # samples that the search counted in, before its shift was refined, may lie a little beyond the ends
        near = np.abs(place - self._middle) <= self._half * (1.0 + 2.0 * _BEYOND / _STEPS)
        return Beside(
            place, near, fitted, abs(line.scale) * np.ptp(around, axis=0),
            abs(line.scale) * float(np.ptp(self._curve)), float(np.ptp(turns)),
        )  # fmt: skip

    def described(
        self, fit: _Fit, angle: Array, measured: Array, turns: Array, asked: tuple[Fitted, ...], step: float
    ) -> FittedCurve:
        """A fit with its standard errors and its scatter, of samples taken in a step."""
        used, shift, line = fit.used, fit.shift, fit.line
        y, turn = measured[used], turns[used]
        spanned, turn = float(np.ptp(turn)), turn - fit.middle_turn
        # of least squares the mean of the turns is zero; a reader looks for the offset half-way through the trace
        beyond = 0.5 * float(turns.min() + turns.max()) - fit.middle_turn
        places = self.within(shift, angle[used])
        found = self.at(places)
        reach = 2.0 * self._half * _SLOPE
        slope = (self.at(places + reach) - self.at(places - reach)) / (2.0 * reach)

        def with_errors(*more: Fitted, noise: float | None = None) -> tuple[FittedLine, dict[Fitted, float]]:
            these: tuple[Fitted, ...] = tuple(one for one in FITTED if one in asked or one in more)
            fitted = linear(found, y, turn, these)
            residual = fitted.less(y, turn) - fitted.scale * found
            return fitted, standard_errors(found, slope, fitted.scale, residual, these, turn - beyond, noise)

        errors = with_errors()[1]
        if "shift" in asked and _jumps(self._angle, self._curve):  # between two samples the jump may be anywhere
            spacing = float(np.median(np.diff(np.sort(places))))
            errors["shift"] = math.hypot(errors["shift"], spacing / math.sqrt(12.0))
        gain, of_gain = with_errors("scale")
        rest = gain.less(y, turn)
        # within a step samples do not differ, and are none the better for it
        noise = max(noise_of(places, rest - gain.scale * found), step / math.sqrt(12.0))
        of_turns = gains_of_turns(turn, found, rest, gain.scale, free="offset" in asked)
        by_noise = with_errors("scale", noise=noise)[1]["scale"]
        scatter = max(by_noise, of_mean(of_turns))
        drifting = with_errors("offset", "drift") if spanned > 1.0 else None
        return FittedCurve(
            asked, {one: errors.get(one, 0.0) for one in FITTED}, 0, line.offset + line.drift * beyond, line.scale,
            float(np.mod(shift + math.pi, _TURN) - math.pi), gain.scale, of_gain["scale"], places,
            line.less(y, turn) / (line.scale or 1.0), found, line.drift, drifting and drifting[0].drift,
            drifting and drifting[1]["drift"], spanned, scatter, noise / abs(line.scale) if line.scale else 0.0,
            turn_gains=of_turns, gain_noise=by_noise, step=step,
        )  # fmt: skip


def _drift_by_places(angle: Array, turns: Array, measured: Array) -> float:
    """Drift by how samples of one place differ from turn to turn, whatever curve and shift are; of short traces 0."""
    cell = np.floor(np.mod(angle, _TURN) / _TURN * _STEPS).astype(int) % _STEPS
    count = np.maximum(np.bincount(cell, minlength=_STEPS), 1)
    own = turns - (np.bincount(cell, turns, _STEPS) / count)[cell]
    many = float(np.ptp(turns)) > 1.0
    return float(own @ (measured - measured.mean()) / (own @ own)) if many else 0.0


def _jumps(angle: Array, curve: Array) -> bool:
    """Whether the curve has a step that its slope says nothing about."""
    steep = np.diff(angle) < _JUMP_WITHIN * (angle[-1] - angle[0])
    return bool((np.abs(np.diff(curve))[steep] > _JUMP_OF * np.ptp(curve)).any())


def _searched(
    angle: Array, measured: Array, computed: Callable[[Array], Array], half: float, middle: float,
    asked: tuple[Fitted, ...],
) -> float:  # fmt: skip
    """The best shift of a grid over one turn; a measured curve upside down is none.

    Samples are counted in the cells of the grid: sums over products with the displaced curve are circular correlations.
    """
    cells = math.ceil(_TURN / (2.0 * half) * _STEPS)
    step = _TURN / cells
    cell = np.floor(np.mod(angle, _TURN) / step).astype(int) % cells
    count = np.bincount(cell, minlength=cells).astype(float)
    total = np.bincount(cell, measured, cells)
    centre = np.mod((np.arange(cells) + 0.5) * step - middle + math.pi, _TURN) - math.pi + middle
    curve = np.where(np.abs(centre - middle) <= half, computed(centre), 0.0)

    def correlated(of: Array, with_curve: Array) -> Array:
        product = np.fft.rfft(of) * np.conj(np.fft.rfft(with_curve))
        return np.asarray(np.fft.irfft(product, cells))

    n, mean = measured.size, measured.mean() if "offset" in asked else 0.0
    curves, squares, products = (
        correlated(count, curve), correlated(count, curve**2), correlated(total - mean * count, curve)
    )  # fmt: skip
    size = squares - curves**2 / n if "offset" in asked else squares
    likely = size > 1e-6 * size.max()
    scale = np.where(likely, products / np.where(likely, size, 1.0), 0.0)
    if "scale" not in asked:
        scale = np.ones(cells)
    gained = np.where(likely & (scale > 0.0), scale * (2.0 * products - scale * size), -np.inf)
    return float(int(np.argmax(gained)) * step)


def _refined(squares: Callable[[float], float], shift: float, step: float) -> float:
    from scipy.optimize import minimize_scalar

    ends = shift - 2.0 * step, shift + 2.0 * step
    return float(minimize_scalar(squares, bounds=ends, method="bounded", options={"xatol": 1e-6 * step}).x)
