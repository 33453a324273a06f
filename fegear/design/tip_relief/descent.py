"""Descent from many tip reliefs at once to what leaves less, by linear problems within regions of trust.

A tip relief led to the end: to the least that can be left nearby, or to the edge of what may be left.

What is seen at the roll positions is continued from a relief with slopes and curvatures, the latter from differences of
slopes. The least of the largest of these, or the least of a linear function where none exceeds what is allowed, is
found by sequential quadratic programming (Kraft's SLSQP). From one such problem to the next the digits that are right
double at least: the outcome depends on the pair and its load alone, and no longer on where the search came from.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.design.tip_relief.cutting_planes import least_in_box

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.arrays import Array, Floats, Index
    from fegear.design.tip_relief.trials import Trials, Tried


#: What a round may leave of its own linear problem's promise, and what it must promise to go on, over the value.
_GAP, _ENDED = 0.01, 3e-4


_ROUND_OFF = 1e-10


#: What leaving more than allowed costs, in mean transmission errors of removal, for each time the allowed.
_FINE = 1000.0


@dataclass(frozen=True, slots=True)
class Limits:
    """Box of the four numbers and their units, shape (4,): amounts [m] and lengths over the path.

    Parameters
    ----------
    low, high : ndarray
    unit : ndarray
        Mean transmission error of the unmodified pair [m], and one.
    """

    low: Floats
    high: Floats
    unit: Floats

    def around(self, p: Floats, trust: Floats) -> tuple[Floats, Floats, Floats]:
        """Reach of steps from candidates (C, 4), and the box of steps over it, see `least_in_box`."""
        reach = trust[:, None] * np.maximum(p, 0.2 * self.unit)
        return reach, np.maximum((self.low - p) / reach, -1.0), np.minimum((self.high - p) / reach, 1.0)


@dataclass(frozen=True, slots=True)
class Aim:
    """What is made small: what a relief leaves, or something else among all that leave no more than allowed.

    Parameters
    ----------
    along : ndarray, shape (C, 4), or None
        Of C candidates, by the four numbers in their units; None for what they leave.
    allowed : float
        [m].
    """

    along: Floats | None = None
    allowed: float = 1.0

    def of(self, chosen: Index) -> Aim:
        """That of some of the candidates."""
        return self if self.along is None else Aim(self.along[chosen], self.allowed)

    def value(self, at: Floats, left: Floats) -> Floats:
        """Of candidates (C, 4) in their units that leave so much, shape (C,)."""
        if self.along is None:
            return left
        return np.asarray((self.along * at).sum(axis=1) + _FINE * np.maximum(left / self.allowed - 1.0, 0.0))

    def slope(self, left: Floats, by_number: Floats) -> Floats:
        """Derivatives by the numbers in their units, shape (C, 4), from those of what is left."""
        if self.along is None:
            return by_number
        return np.asarray(self.along + np.where(left > self.allowed, _FINE / self.allowed, 0.0)[:, None] * by_number)


def _ahead(trials: Trials, tried: Tried, p: Floats, limits: Limits, trust: Floats, aim: Aim) -> tuple[Floats, Floats]:
    """Steps from candidates to the least of the aim, what is seen taken as linear, and that: shapes (C, 4), (C,)."""
    unit = limits.unit
    reach, low, high = limits.around(p, trust)

    def tangent(x: Floats) -> tuple[Floats, Floats]:
        left, slope = trials.tangent(tried, x * reach)
        return aim.value((p + x * reach) / unit, left), aim.slope(left, slope * unit) * (reach / unit)

    x, least, _ = least_in_box(tangent, low, high, _ROUND_OFF, share=_GAP)
    return x * reach, least


def room(trials: Trials, p: Floats, limits: Limits, trust: float, aim: Aim | None = None) -> Floats:
    """How much less of the aim may be near candidates, shape (C, 4): what they are off as ends of a search, shape (C,).

    What is seen is taken as linear within a region of that trust; it curves upward, so there is less in truth. Never
    below what ends a descent.
    """
    aim, tried = aim or Aim(), trials.exact(p)
    values = aim.value(p / limits.unit, trials.left(tried.seen, tried.low))
    _, least = _ahead(trials, tried, p, limits, np.full(p.shape[0], trust), aim)
    return np.asarray(np.maximum(values - least, _ENDED * (np.abs(values) if aim.along is None else 1.0)))


def descend(
    evaluate: Callable[[Floats], Tried],
    trials: Trials,
    starts: Floats,
    limits: Limits,
    trust: float,
    rounds: int,
    aim: Aim | None = None,
) -> tuple[Floats, Floats, int]:
    """Lead starts, shape (B, 4), to minima nearby; values never grow.

    In every round what is seen is taken as linear in the four numbers within a region of trust, the least there is
    found, and kept where it is lower indeed; regions grow where it is as low as said, and shrink where it is not.

    Parameters
    ----------
    evaluate : callable
        `trials.rough` or `trials.exact`.
    trials : Trials
    starts : ndarray, shape (B, 4)
    limits : Limits
    trust : float
        Extent of the first regions over the starts.
    rounds : int
    aim : Aim, optional
        What is left by default.

    Returns
    -------
    best, values : ndarray, shapes (B, 4), (B,)
        Values of the aim.
    evaluations : int
        Candidates evaluated.
    """
    aim, unit = aim or Aim(), limits.unit
    p, trusted = np.clip(starts, limits.low, limits.high), np.full(starts.shape[0], trust)
    tried = evaluate(p)
    values, evaluations = aim.value(p / unit, trials.left(tried.seen, tried.low)), p.shape[0]
    size = np.abs(values) if aim.along is None else np.ones(values.size)
    active = np.arange(p.shape[0])
    for _ in range(rounds):
        own = aim.of(active)
        step, least = _ahead(trials, tried, p[active], limits, trusted[active], own)
        q = p[active]
        new = np.clip(q + step, limits.low, limits.high)
        new_tried = evaluate(new)
        evaluations += new.shape[0]
        old, new_values = values[active], own.value(new / unit, trials.left(new_tried.seen, new_tried.low))
        better = new_values < old
        trusted[active] *= np.where(old - new_values > 0.6 * (old - least), 1.5, np.where(better, 0.6, 0.3))
        p[active] = np.where(better[:, None], new, q)
        values[active] = np.where(better, new_values, old)
        goes_on = old - least > _ENDED * size[active]
        tried = new_tried.where(better, tried).of(goes_on)
        active = active[goes_on]
        if not active.size:
            break
    return p, values, evaluations


#: Step of the differences, in the units of the numbers.
_STEP = 3e-6


#: What is seen this close to the extremes takes part, over what is left.
_NEAR = 0.12


#: Rounds at most, the step over the relief that ends them, and steps of each.
_ROUNDS, _END, _STEPS = 12, 1e-8, 60
#: A first harmonic below this, over what is left, is about to vanish.
_VANISHING = 0.1


#: First extent of trust.
_TRUST = 0.04


@dataclass(frozen=True)
class _Curved:
    """Values at K places as quadratic functions of the four numbers in their units.

    Parameters
    ----------
    value, slope, curve : ndarray, shapes (K,), (K, 4), (K, 4, 4)
    """

    value: Array
    slope: Array
    curve: Array

    def at(self, d: Array) -> Array:
        return np.asarray(self.value + self.slope @ d + 0.5 * (self.curve @ d) @ d)

    def slope_at(self, d: Array) -> Array:
        return np.asarray(self.slope + self.curve @ d)

    def of(self, chosen: Any) -> _Curved:
        return _Curved(self.value[chosen], self.slope[chosen], self.curve[chosen])


def _curved(values: Floats, slopes: Floats, unit: Floats) -> _Curved:
    """Of a relief and four on both sides of it: values, shape (9, K), and slopes, (9, 4, K)."""
    by_unit = slopes * unit[:, None]
    # A kink that a difference takes past a position is found at the next one: the other difference counts.
    sides = (by_unit[1:] - by_unit[0]) / _STEP
    sides = np.where(np.isfinite(values[1:])[:, None], sides, 0.0)
    up, down = sides[:4], -sides[4:]
    curve = np.where(((up**2).sum(axis=1) <= (down**2).sum(axis=1))[:, None], up, down)
    curve = np.moveaxis(0.5 * (curve + np.swapaxes(curve, 0, 1)), -1, 0)
    return _Curved(values[0], by_unit[0].T, curve)


@dataclass(frozen=True)
class _Problem:
    """Constraints of one relief under all loads: unknowns are a step d, what is left t, and each load's extremes."""

    high: tuple[_Curved, ...]
    low: tuple[_Curved, ...]
    harmonics: int

    @property
    def size(self) -> int:
        return 5 + (0 if self.harmonics else 2 * len(self.high))

    def values(self, y: Array) -> Array:
        """Not negative where allowed."""
        d, t = y[:4], y[4]
        if self.harmonics:
            return np.array([t - _effective(one.at(d), self.harmonics)[0] for one in self.high])
        parts = []
        for k, (high, low) in enumerate(zip(self.high, self.low, strict=True)):
            top, bottom = y[5 + 2 * k : 7 + 2 * k]
            parts += [top - high.at(d), low.at(d) - bottom, [t - top + bottom]]
        return np.concatenate(parts)

    def slopes(self, y: Array) -> Array:
        d = y[:4]
        if self.harmonics:
            rows = []
            for one in self.high:
                by_part = _effective(one.at(d), self.harmonics)[1]
                rows.append(np.append(-by_part @ one.slope_at(d), 1.0))
            return np.array(rows)
        parts = []
        for k, (high, low) in enumerate(zip(self.high, self.low, strict=True)):
            block = np.zeros((high.value.size + low.value.size + 1, self.size))
            block[: high.value.size, :4], block[: high.value.size, 5 + 2 * k] = -high.slope_at(d), 1.0
            block[high.value.size : -1, :4], block[high.value.size : -1, 6 + 2 * k] = low.slope_at(d), -1.0
            block[-1, 4], block[-1, 5 + 2 * k], block[-1, 6 + 2 * k] = 1.0, -1.0, 1.0
            parts.append(block)
        return np.concatenate(parts)

    def vanishing(self, d: Array) -> tuple[_Curved, ...]:
        """Cosine and sine parts of first harmonics that a step all but takes away, and with all their digits may.

        What is left has an edge there, to which a smooth problem comes slowly: it is sought on the edge by itself.
        """
        found = []
        for one in self.high if self.harmonics else ():
            parts = one.at(d)
            if np.hypot(*parts[:: self.harmonics]) < _VANISHING * _effective(parts, self.harmonics)[0]:
                found.append(one.of(slice(None, None, self.harmonics)))
        return tuple(found[:2])

    def start(self) -> Array:
        """No step."""
        if self.harmonics:
            return np.array([0.0] * 4 + [max(float(_effective(one.value, self.harmonics)[0]) for one in self.high)])
        ends = [(float(h.value.max()), float(low.value.min())) for h, low in zip(self.high, self.low, strict=True)]
        return np.array([0.0] * 4 + [max(top - bottom for top, bottom in ends)] + [v for both in ends for v in both])


def _effective(parts: Array, harmonics: int) -> tuple[float, Array]:
    """A_e of cosine and sine parts, and its derivatives."""
    square = parts[:harmonics] ** 2 + parts[harmonics:] ** 2
    first, whole = float(np.sqrt(square[0])), float(np.sqrt(square.sum()))
    by_part = parts / max(whole, 1e-300)
    by_part[::harmonics] += parts[::harmonics] / max(first, 1e-300)
    return first + whole, by_part


def _problem(trials: Trials, tried: Tried, left: float, unit: Floats) -> _Problem:
    """About the first of nine candidates, in multiples of what it leaves."""
    high, low = [], []
    for load in range(trials.loads.size):
        one = _curved(tried.seen[:, load] / left, tried.slope[:, :, load] / left, unit)
        if trials.metric != "peak_to_peak":
            # Those of the values themselves: what quadrature across kinks is off to next order belongs to these.
            parts = tried.seen[:, load] / left
            high.append(replace(one, slope=0.5 * (parts[1:5] - parts[5:]).T / _STEP))
            continue
        other = _curved(tried.low[:, load] / left, tried.low_slope[:, :, load] / left, unit)
        high.append(one.of(one.value > one.value.max() - _NEAR))
        low.append(other.of(other.value < other.value.min() + _NEAR))
    return _Problem(tuple(high), tuple(low), 0 if trials.metric == "peak_to_peak" else trials.harmonics)


def _best_step(problem: _Problem, low: Array, high: Array, aim: Aim, left: float, on_edge: bool) -> tuple[Array, bool]:
    """Step, in the units of the numbers, to the least of the aim within a box, shape (4,), and whether on an edge.

    From an edge only the same is tried, which takes an eighth of the time.
    """
    from scipy.optimize import minimize

    towards, top = np.zeros(problem.size), np.inf
    if aim.along is None:
        towards[4] = 1.0
    else:
        towards[:4], top = aim.along[0], aim.allowed / left
    bounds = [*zip(low, high, strict=True), (-np.inf, top), *[(-np.inf, np.inf)] * (problem.size - 5)]

    def solved(edges: tuple[_Curved, ...]) -> tuple[Array, float]:
        zero = {
            "type": "eq", "fun": lambda y: np.concatenate([one.at(y[:4]) for one in edges]),
            "jac": lambda y: np.pad(np.concatenate([one.slope_at(y[:4]) for one in edges]), ((0, 0), (0, 1))),
        }  # fmt: skip
        found = minimize(
            lambda y: float(towards @ y), problem.start(), jac=lambda _: towards, method="SLSQP", bounds=bounds,
            options={"ftol": 1e-12, "maxiter": _STEPS},
            constraints=[{"type": "ineq", "fun": problem.values, "jac": problem.slopes}, *([zero] if edges else [])],
        )  # fmt: skip
        d = np.clip(found.x[:4], low, high)
        if not problem.harmonics:
            return d, 0.0
        would = left * max(_effective(one.at(d), problem.harmonics)[0] for one in problem.high)
        return d, float(aim.value(d[None], np.array([would]))[0])

    edges = problem.vanishing(np.zeros(4)) if on_edge else ()
    if edges:
        return solved(edges)[0], True
    d, value = solved(())
    edges = problem.vanishing(d)
    other, its_value = solved(edges) if edges else (d, np.inf)
    return (other, True) if its_value <= value else (d, False)


def refine(trials: Trials, start: Floats, limits: Limits, aim: Aim | None = None) -> tuple[Floats, float, int]:
    """Lead one relief to the minimum nearby, to all digits that matter.

    Parameters
    ----------
    trials : Trials
    start : ndarray, shape (4,)
    limits : Limits
    aim : Aim, optional
        Of this one, `along` of shape (1, 4); by default what is left.

    Returns
    -------
    best : ndarray, shape (4,)
    left : float
        What it leaves [m].
    evaluations : int
    """
    aim, unit = aim or Aim(), limits.unit
    cloud = np.concatenate([np.zeros((1, 4)), _STEP * np.diag(unit), -_STEP * np.diag(unit)])

    def tried_at(p: Floats) -> tuple[Tried, float, float]:
        tried = trials.exact(p + cloud)
        left = float(trials.left(tried.seen[:1], tried.low[:1])[0])
        return tried, left, float(aim.value((p / unit)[None], np.array([left]))[0])

    p, trust, evaluations = np.clip(start, limits.low, limits.high), _TRUST, 9
    on_edge, released = False, False
    tried, left, value = tried_at(p)
    for _ in range(_ROUNDS):
        if not left > 0.0:
            break
        problem = _problem(trials, tried, left, unit)
        reach = trust * np.maximum(p, 0.2 * unit)
        low, high = np.maximum(limits.low - p, -reach) / unit, np.minimum(limits.high - p, reach) / unit
        d, on_edge = _best_step(problem, low, high, aim, left, on_edge)
        if released and on_edge:
            break
        new = np.clip(p + d * unit, limits.low, limits.high)
        new_tried, new_left, new_value = tried_at(new)
        evaluations += 9
        step = float(np.abs((new - p) / np.maximum(p, 0.2 * unit)).max())
        worse = new_value > value + 1e-12 * max(abs(value), left)
        if not worse:
            p, tried, left, value = new, new_tried, new_left, new_value
            trust = min(2.0 * trust, 0.3) if step > 0.5 * trust else trust
            if step < _END:
                if not on_edge or released:
                    break
                # On an edge: once more with leave to come off it.
                on_edge, released = False, True
        else:
            trust = 0.25 * min(trust, step)
            if trust < _END:
                break
    return p, left, evaluations
