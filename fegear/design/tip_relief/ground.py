"""A tip relief led to the end: to the least that can be left nearby, or to the edge of what may be left.

What is seen at the roll positions is continued from a relief with slopes and curvatures, the latter from differences of
slopes. The least of the largest of these, or the least of a linear function where none exceeds what is allowed, is
found by sequential quadratic programming (Kraft's SLSQP). From one such problem to the next the digits that are right
double at least: the outcome depends on the pair and its load alone, and no longer on where the search came from.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fegear.base.arrays import Array, Floats, Mask
from fegear.design.tip_relief.clouds import NEAR, STEP, tried_clouds
from fegear.design.tip_relief.descent import Aim, Limits
from fegear.design.tip_relief.trials import Trials, Tried

#: Rounds at most, the step over the relief that ends them, for the next would be of its square, the region of trust
#: that does, steps of each, and reliefs nearer than this, in their units, that have met.
_ROUNDS, _END, _END_OF_TRUST, _STEPS, _MET = 12, 3e-9, 1e-9, 60, 1e-4
#: To what the problem of a round is solved, on the way and where steps are below the last of these.
_ON_THE_WAY, _AT_THE_END, _NEAR_THE_END = 1e-8, 1e-12, 3e-3
#: Steps after which a smooth problem that has not ended is taken to go toward an edge: there another goes on.
_STEPS_TO_EDGE = 18
#: A first harmonic below this, over what is left, is about to vanish.
_VANISHING = 0.1
#: First extent of trust.
_TRUST = 0.04
#: A curvature, or a harmonic, below this is round-off.
_FLATTEST = 1e-3


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
    """Of a relief and four on one side of it, or on both: values, shape (5 or 9, K), and slopes, (5 or 9, 4, K)."""
    by_unit = slopes * unit[:, None]
    sides = np.where(np.isfinite(values[1:])[:, None], (by_unit[1:] - by_unit[0]) / STEP, 0.0)
    up, down = sides[:4], -sides[4:]
    # A kink that a difference takes past a position is found at the next one: the other difference counts.
    curve = np.where(((up**2).sum(axis=1) <= (down**2).sum(axis=1))[:, None], up, down) if down.size else up
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

    def rounded(self) -> Array:
        """Steps, columns (4, 4), along which what is left curves by one, as quasi-Newton methods take it at first.

        Kraft's begins with a curvature of one in every direction and learns another in some twenty steps. Of extremes,
        which are all but flat, it learns nothing: they keep their numbers.
        """
        if not self.harmonics:
            return np.eye(4)
        one = max(self.high, key=lambda each: float(_effective(each.value, self.harmonics)[0]))
        bent = np.tensordot(_effective(one.value, self.harmonics)[1], one.curve, axes=1)
        for chosen in (slice(None), slice(None, None, self.harmonics)):
            v, by = one.value[chosen], one.slope[chosen]
            size = max(float(np.sqrt(v @ v)), _FLATTEST)
            along = v @ by / size
            bent += (by.T @ by - np.outer(along, along)) / size
        curves, ways = np.linalg.eigh(bent)
        return np.asarray(ways / np.sqrt(np.maximum(np.abs(curves), _FLATTEST)))

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
    """About the first of five candidates, or nine, in multiples of what it leaves."""
    high, low = [], []
    for load in range(trials.loads.size):
        one = _curved(tried.seen[:, load] / left, tried.slope[:, :, load] / left, unit)
        if trials.metric != "peak_to_peak":
            # Those of the values themselves: what quadrature across kinks is off to next order belongs to these.
            parts = tried.seen[:, load] / left
            high.append(replace(one, slope=0.5 * (parts[1:5] - parts[5:]).T / STEP))
            continue
        other = _curved(tried.low[:, load] / left, tried.low_slope[:, :, load] / left, unit)
        high.append(one.of(one.value > one.value.max() - NEAR))
        low.append(other.of(other.value < other.value.min() + NEAR))
    return _Problem(tuple(high), tuple(low), 0 if trials.metric == "peak_to_peak" else trials.harmonics)


def _best_step(
    problem: _Problem, low: Array, high: Array, aim: Aim, left: float, close: float, on_edge: bool
) -> tuple[Array, bool]:
    """Step, in the units of the numbers, to the least of the aim within a box, shape (4,), and whether on an edge.

    Solved to `close`. From an edge only the same is tried, which takes an eighth of the time.
    """
    from scipy.optimize import minimize

    towards, top = np.zeros(problem.size), np.inf
    if aim.along is None:
        towards[4] = 1.0
    else:
        towards[:4], top = aim.along[0], aim.allowed / left
    bounds = [(-np.inf, np.inf)] * 4 + [(-np.inf, top)] + [(-np.inf, np.inf)] * (problem.size - 5)
    most, steps = _STEPS, _STEPS_TO_EDGE if problem.harmonics else _STEPS
    ways = np.eye(problem.size)
    ways[:4, :4] = problem.rounded()
    box = np.concatenate([ways[:4], -ways[:4]])

    def solved(edges: tuple[_Curved, ...]) -> tuple[Array, float]:
        zero = {
            "type": "eq", "fun": lambda z: np.concatenate([one.at((ways @ z)[:4]) for one in edges]),
            "jac": lambda z: np.concatenate([one.slope_at((ways @ z)[:4]) for one in edges]) @ ways[:4],
        }  # fmt: skip
        inside = {
            "type": "ineq", "fun": lambda z: np.concatenate([problem.values(y := ways @ z), y[:4] - low, high - y[:4]]),
            "jac": lambda z: np.concatenate([problem.slopes(ways @ z) @ ways, box]),
        }  # fmt: skip
        found = minimize(
            lambda z: float(towards @ ways @ z), problem.start(), jac=lambda _: towards @ ways, method="SLSQP",
            bounds=bounds, options={"ftol": close, "maxiter": most if edges else steps},
            constraints=[inside, *([zero] if edges else [])],
        )  # fmt: skip
        d = np.clip((ways @ found.x)[:4], low, high)
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


@dataclass
class _Led:
    """One of the reliefs led to the end."""

    p: Floats
    tried: Tried
    left: float
    value: float
    aim: Aim
    kinked: bool
    step: float = _TRUST
    close: float = _ON_THE_WAY
    trust: float = _TRUST
    on_edge: bool = False
    released: bool = False
    joins: _Led | None = None

    @property
    def end(self) -> _Led:
        """Itself, or where another came that it came up with."""
        return self if self.joins is None else self.joins.end


def refine(
    trials: Trials, starts: Floats, limits: Limits, aim: Aim | None = None, rounds: int = _ROUNDS
) -> tuple[Floats, Floats, Mask, int]:
    """Lead reliefs to the minima nearby, to all digits that matter.

    All go on together, for trying many costs little more than trying one; of two that meet the lower goes on.

    Parameters
    ----------
    trials : Trials
    starts : ndarray, shape (B, 4)
    limits : Limits
    aim : Aim, optional
        What is left by default.
    rounds : int
        At most.

    Returns
    -------
    best : ndarray, shape (B, 4)
    left : ndarray, shape (B,)
        What they leave [m].
    ended : ndarray of bool, shape (B,)
        Whether they came to an end.
    evaluations : int
    """
    aim, unit, evaluations = aim or Aim(), limits.unit, 0

    def tried_at(some: list[tuple[Floats, Aim, bool]]) -> list[_Led]:
        nonlocal evaluations
        places, kinked = (np.array([one[k] for one in some]) for k in (0, 2))
        clouds, count = tried_clouds(trials, places, unit, kinked)
        evaluations += count
        return [
            _Led(
                p, one.tried, one.left, float(own.value((p / unit)[None], np.array([one.left]))[0]), own, one.kinked
            )
            for (p, own, _), one in zip(some, clouds, strict=True)
        ]  # fmt: skip

    starts = np.clip(starts, limits.low, limits.high)
    every = tried_at([(p, aim.of(np.array([i])), False) for i, p in enumerate(starts)])
    active = [one for one in every if one.left > 0.0]
    for _ in range(rounds):
        new = [_next(trials, one, limits) for one in active]
        to = [(p, one.aim, one.kinked) for one, p in zip(active, new, strict=True) if p is not None]
        reached = iter(tried_at(to) if to else [])
        active = [
            one for one, p in zip(active, new, strict=True)
            if p is not None and _goes_on(one, next(reached), unit) and one.left > 0.0
        ]  # fmt: skip
        for one in active:
            met = [
                other for other in every
                if other.value < one.value and one.aim.like(other.aim) and (np.abs(other.p - one.p) < _MET * unit).all()
            ]  # fmt: skip
            one.joins = min(met, key=lambda other: other.value, default=None)
        active = [one for one in active if one.joins is None]
        if not active:
            break
    found = [one.end for one in every]
    ended = np.array([all(one is not other for other in active) for one in found])
    left = np.array([one.left for one in found])
    return np.array([one.p for one in found]), left, ended, evaluations


def _next(trials: Trials, one: _Led, limits: Limits) -> Floats | None:
    """Where the problem about a relief has its least, None where it ends on an edge for the second time."""
    unit, p = limits.unit, one.p
    one.close = _AT_THE_END if one.step < _NEAR_THE_END else _ON_THE_WAY
    reach = one.trust * np.maximum(p, 0.2 * unit)
    low, high = np.maximum(limits.low - p, -reach) / unit, np.minimum(limits.high - p, reach) / unit
    problem = _problem(trials, one.tried, one.left, unit)
    d, one.on_edge = _best_step(problem, low, high, one.aim, one.left, one.close, one.on_edge)
    return None if one.released and one.on_edge else np.clip(p + d * unit, limits.low, limits.high)


def _goes_on(one: _Led, new: _Led, unit: Floats) -> bool:
    """Take a step where it does not make it worse; whether there is more to come."""
    step = float(np.abs((new.p - one.p) / np.maximum(one.p, 0.2 * unit)).max())
    one.step = step
    if new.value > one.value + 1e-12 * max(abs(one.value), one.left):
        one.trust = 0.25 * min(one.trust, step)
        return one.trust >= _END_OF_TRUST
    one.p, one.tried, one.left, one.value, one.kinked = new.p, new.tried, new.left, new.value, new.kinked
    one.trust = min(2.0 * one.trust, 0.3) if step > 0.5 * one.trust else one.trust
    if step < _END and one.close == _AT_THE_END:
        # On an edge: once more with leave to come off it.
        again = one.on_edge and not one.released
        one.on_edge, one.released = False, True
        return again
    return True
