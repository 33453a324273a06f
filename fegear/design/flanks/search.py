"""From one ground relief down to the least of its valley: linear programmes within a region of trust.

What a relief leaves is the largest of many smooth functions: differences of transmission errors at two roll positions.
At its least several of them are equal, as many as there are free numbers or nearly, so that the least of the linear
programme of all of them leads there by Newton's order, and last digits of the input stay last digits of the relief: a
step that is solved loosely, or ended early, multiplies them by what is left of the way. The largest K_Hbeta is a set of
rows of the same programme, without which a step along its limit ends where it was cut off. Where a step misses what
its slopes promised, it is corrected once by what it has found (second-order correction), by which curved valleys are
followed.

R. Fletcher, Practical Methods of Optimization, 2nd ed. (1987), sections 14.4 and 14.5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.design.flanks.trials import FlankTrials, Tried

#: Extent of the first region of trust over the box and the one that ends a descent; its growth and its shrinking.
_TRUST, _NO_TRUST, _GROWS, _SHRINKS = 0.1, 1e-7, 1.6, 0.3
#: Rounds; parts of the promised gain: with less a step is refused, with more the region of trust grows.
_ROUNDS, _LEAST_GAIN, _GOOD_GAIN = 40, 0.1, 0.6
#: What round-off may add to a K_Hbeta that stands at its limit; micrometres, in which the programme counts.
_AT_LIMIT, _UNIT = 1e-9, 1e-6


def descend(
    trials: FlankTrials,
    start: Array,
    value: float,
    box: tuple[Array, Array],
    most_factor: float = np.inf,
    ended: float = 1e-5,
    near: Tried | None = None,
) -> tuple[float, Array]:
    """Lead a relief to the least nearby.

    Parameters
    ----------
    trials : FlankTrials
    start : ndarray, shape (9,)
        Numbers of a ground relief.
    value : float
        What it leaves, see `FlankTrials.value` [m].
    box : tuple of ndarray, shape (9,)
        Least and largest numbers.
    most_factor : float
        Largest K_Hbeta that is allowed, at all loads and misalignments.
    ended : float
        Gain, over the value, of which no more is promised at the end.
    near : Tried, optional
        What was found at the start.

    Returns
    -------
    value : float
        [m].
    numbers : ndarray, shape (9,)
    """
    low, high = box
    free = np.flatnonzero(high > low)
    if not free.size or value == 0.0:
        return value, start
    # Lengths of what has no amount are those of the box, so that an amount can grow.
    p = np.where((start == 0.0) & (low > 0.0), 0.5 * (low + high), start)
    here = _Straight.of(trials, trials.of_numbers(p, slope=True, near=near), free, limit=None)
    trust, span = _TRUST, (high - low)[free]
    for _ in range(_ROUNDS):
        below = np.minimum(np.maximum((low - p)[free], -trust * span), 0.0)
        above = np.maximum(np.minimum((high - p)[free], trust * span), 0.0)
        step, promised = here.least(below, above)
        if value - promised <= ended * value:
            break
        for corrected in (False, True):
            new = p.copy()
            new[free] = np.clip(p[free] + step, low[free], high[free])
            tried = trials.of_numbers(new, slope=True, near=here.tried, step=new - p)
            keeps = most_factor == np.inf or tried.face_load_factor.max() <= most_factor * (1.0 + _AT_LIMIT)
            gain = value - trials.value(tried.peak_to_peak)
            if (keeps and gain > _LEAST_GAIN * (value - promised)) or corrected:
                break
            if not keeps and here.limit is None:  # K_Hbeta is asked only of a descent that comes near its limit
                here = _Straight.of(trials, here.tried, free, most_factor)
                step, promised = here.least(below, above)
            else:
                step, _ = here.corrected(tried, step).least(below, above)
        if keeps and gain > _LEAST_GAIN * (value - promised):
            trust *= _GROWS if gain > _GOOD_GAIN * (value - promised) else 1.0
            p, value, here = new, value - gain, _Straight.of(trials, tried, free, here.limit)
        else:
            trust *= _SHRINKS
            if trust < _NO_TRUST:
                break
    return value, p


@dataclass(frozen=True)
class _Straight:
    """Transmission errors and loads over the face about a tried relief, taken as straight in its free numbers."""

    trials: FlankTrials
    tried: Tried
    free: Index
    limit: float | None
    te: Array
    over_face: Array | None

    @classmethod
    def of(cls, trials: FlankTrials, tried: Tried, free: Index, limit: float | None) -> _Straight:
        return cls(trials, tried, free, limit, tried.te, None if limit is None else tried.over_face)

    def corrected(self, ahead: Tried, step: Array) -> _Straight:
        """The same slopes through what was found a step ahead."""
        te = ahead.te - np.einsum("skpl,k->spl", self.tried.slope[:, self.free], step)
        over = self.over_face
        if over is not None:
            over = ahead.over_face - np.einsum("skcl,k->scl", self.tried.over_face_slope[:, self.free], step)
        return _Straight(self.trials, self.tried, self.free, self.limit, te, over)

    def least(self, below: Array, above: Array) -> tuple[Array, float]:
        """The step within bounds, shape (free,) each, that leaves the least, and what that is [m].

        The unknowns are the step, the highest and the lowest transmission error of every misalignment and load, and
        the value, which is none of the loads' below. Where no step keeps to the largest K_Hbeta, none is made.
        """
        from scipy.optimize import linprog

        trials, n = self.trials, self.free.size
        scatters, _, positions, loads = self.tried.slope.shape
        cases = scatters * loads
        reach = np.maximum(np.maximum(above, -below), np.finfo(float).tiny)
        slope = np.moveaxis(self.tried.slope[:, self.free], 1, 3) * (reach / _UNIT)  # (S, P, L, n)
        te = self.te / _UNIT
        of_case = np.broadcast_to(np.eye(cases).reshape(scatters, 1, loads, cases), (scatters, positions, loads, cases))
        none, value = np.zeros_like(of_case), np.zeros((scatters * positions * loads, 1))

        def flat(*parts: Array) -> Array:
            return np.concatenate(parts, axis=3).reshape(-1, n + 2 * cases)

        mean = np.kron(trials.scatter.weights, np.diag(trials.proportion))  # (L, cases)
        rows = [
            np.hstack([flat(slope, -of_case, none), value]),
            np.hstack([flat(-slope, none, of_case), value]),
            np.hstack([np.zeros((loads, n)), mean, -mean, -np.ones((loads, 1))]),
        ]
        bounds = [-te.ravel(), te.ravel(), np.zeros(loads)]
        if self.over_face is not None and self.limit is not None:
            growth = np.moveaxis(self.tried.over_face_slope[:, self.free], 1, 3).reshape(-1, n) * reach
            rows.append(np.hstack([growth, np.zeros((len(growth), 2 * cases + 1))]))
            bounds.append(self.limit - self.over_face.ravel())
        within = np.full((n + 2 * cases + 1, 2), [-np.inf, np.inf])
        within[:n] = np.stack([below / reach, above / reach], axis=1)
        cost = np.zeros(len(within))
        cost[-1] = 1.0
        found = linprog(cost, A_ub=np.vstack(rows), b_ub=np.concatenate(bounds), bounds=within, method="highs")
        if found.x is None:
            return np.zeros(n), trials.value(self.tried.peak_to_peak)
        return found.x[:n] * reach, float(found.fun) * _UNIT
