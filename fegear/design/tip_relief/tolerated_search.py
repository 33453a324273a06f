"""Tip reliefs whose worst place within the tolerances leaves the least.

A relief is ground with amounts and lengths that are off by what a drawing allows. Here the largest transmission error
of all of these is made small, not that of the drawing. The ends of the tolerances are further loads, as it were: each
candidate is tried with amounts and lengths off, and the largest of all counts. Of the 81 combinations of both gears
the corners and the drawing are tried; others that leave more at the end are added, and the search goes on.

A gear that has no relief has none that is off: reliefs of both gears, of the driver and of the driven gear only are
searched for apart, and the best of them is taken.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product

import numpy as np

from fegear.base.arrays import Array, Floats
from fegear.base.solution_cache import fields_codec
from fegear.contact.plane.engagement import Engagement
from fegear.design.relief_bench import bench
from fegear.design.tip_relief.descent import Limits, descend
from fegear.design.tip_relief.relief_limits import SHORTEST, ReliefLimits
from fegear.design.tip_relief.relief_scan import LONGEST, apart, box, even_bench
from fegear.design.tip_relief.search import search
from fegear.design.tip_relief.tip_tolerance import NOTHING, OF_LENGTH, SHORTEST_LEFT, TipTolerance
from fegear.design.tip_relief.trials import Trials, Tried
from fegear.geometry.relief import roll_of_radius

#: Ends of both gears' tolerances, amount and length each: the drawing and the corners, and all 81.
_CORNERS = np.array([(0, 0, 0, 0), *product((-1, 1), repeat=4)])
_EVERY = np.array(list(product((-1, 0, 1), repeat=4)))
#: Grid of amounts, over the mean transmission error, and lengths of each gear from which searches start.
_AMOUNTS, _LENGTHS = (0.1, 0.3, 0.6, 1.0, 1.5, 2.2), (0.1, 0.2, 0.33, 0.5, 0.7, 1.0)
#: Starts of the descents, of which the best go on exactly; candidates tried at a time.
_STARTS, _FOLLOWED, _BATCH = 12, 4, 64
#: Even roll positions, regions of trust and rounds of both descents.
_POSITIONS, _ROUGH, _EXACT = 56, (0.2, 10), (0.15, 10)
#: How often combinations are added at most, and over what is left from which one is.
_ADDITIONS, _MORE = 3, 1.002


@dataclass(frozen=True)
class ToleratedTrials(Trials):
    """Trials of reliefs that are off: every end of the tolerances is a further load of each candidate.

    Parameters
    ----------
    ends : ndarray, shape (K, 4)
        -1, 0 or 1 for amount and length of driver and driven gear; the drawing only by default.
    amounts : tuple of float
        Tolerances of the amounts [m].
    lengths : tuple of float or None
        Of the lengths, over the path of contact; None: a tenth of the length.
    longest : tuple of float
        Lengths over the path at which reliefs reach the base circle.
    """

    ends: Array = field(default_factory=lambda: np.zeros((1, 4)))
    amounts: tuple[float, float] = (0.0, 0.0)
    lengths: tuple[float | None, float | None] = (None, None)
    longest: tuple[float, float] = (np.inf, np.inf)

    @cached_property
    def _plain(self) -> Trials:
        return Trials(self.bench, self.loads, self.power, self.metric, self.weights)

    def off(self, p: Floats) -> tuple[Floats, Floats]:
        """Candidates (C, 4) at the ends of their tolerances, and by the numbers of the drawing, shapes (C, K, 4)."""
        q = np.repeat(p[:, None], len(self.ends), axis=1)
        by = np.ones_like(q)
        for gear in (0, 1):
            i, j = 2 * gear, 2 * gear + 1
            ground = p[:, None, i] > NOTHING
            amount = q[:, :, i] + self.ends[:, i] * self.amounts[gear]
            by[:, :, i] = np.where(ground & (amount > 0.0), 1.0, 0.0)
            q[:, :, i] = np.where(ground, np.maximum(amount, 0.0), 0.0)
            whole, given = q[:, :, j].copy(), self.lengths[gear]
            step = OF_LENGTH * whole if given is None else given
            length = whole + self.ends[:, j] * step
            slope = 1.0 + (self.ends[:, j] * OF_LENGTH if given is None else 0.0)
            short, long = length < SHORTEST_LEFT * whole, length > self.longest[gear]
            by[:, :, j] = np.where(short, SHORTEST_LEFT, np.where(long, 0.0, slope))
            q[:, :, j] = np.where(short, SHORTEST_LEFT * whole, np.minimum(length, self.longest[gear]))
        return q, by

    def _as_loads(self, tried: Tried, by: Floats) -> Tried:
        """What is seen of all ends as of further loads, shape (C, K L, M), and slopes, (C, 4, K L, M)."""
        count, ends = by.shape[:2]

        def values(one: Floats) -> Floats:
            return one.reshape(count, ends * one.shape[1], -1)

        def slopes(one: Floats) -> Floats:
            each = one.reshape(count, ends, 4, *one.shape[2:]) * by[..., None, None]
            return np.moveaxis(each, 2, 1).reshape(count, 4, ends * one.shape[2], -1)

        return Tried(values(tried.seen), slopes(tried.slope), values(tried.low), slopes(tried.low_slope))

    def rough(self, p: Floats) -> Tried:
        """By the quick sharing, of candidates (C, 4)."""
        q, by = self.off(p)
        return self._as_loads(self._plain.rough(q.reshape(-1, 4)), by)

    def exact(self, p: Floats) -> Tried:
        """By the exact load sharing, of candidates (C, 4)."""
        q, by = self.off(p)
        return self._as_loads(self._plain.exact(q.reshape(-1, 4)), by)

    def exactly(self, p: Floats) -> Floats:
        """What a candidate (4,) leaves at each end of its tolerances, shape (K,) [m]."""
        tried = self.exact(p[None])
        left = (tried.seen.max(axis=-1) - tried.low.min(axis=-1)).reshape(len(self.ends), -1)
        return np.asarray(left.max(axis=1))

    def each(self, p: Floats) -> Floats:
        """What candidates leave at each end of their tolerances, by the quick sharing, shape (C, K) [m]."""
        found = []
        for first in range(0, len(p), _BATCH):
            q, _ = self.off(p[first : first + _BATCH])
            removal, _ = self._removed(q.reshape(-1, 4))
            zeta = self._by_set(removal).min(axis=1)
            seen = self.seen(zeta)
            found.append(self._plain.left(seen).reshape(q.shape[:2]))
        return np.concatenate(found)


@dataclass(frozen=True)
class ToleratedFound:
    """The relief whose worst place within the tolerances leaves the least.

    Parameters
    ----------
    best, undeviated : ndarray, shape (4,)
        As that of `search`; and its own, which leaves the least without deviations.
    most : float
        What it leaves at most, in proportion at the largest load [m].
    error : ndarray, shape (4,)
        How far apart the numbers of two searches are, each from every other start.
    spread : float
        How far apart what these leave at most is [m].
    candidates, evaluations, starts : int
    seconds : float
        CPU time.
    """

    best: Floats
    undeviated: Floats
    most: float
    error: Floats
    spread: float
    candidates: int
    evaluations: int
    starts: int
    seconds: float


#: How a search is kept.
TOLERATED = fields_codec(ToleratedFound)


def tolerated_search(
    engagement: Engagement, loads: Floats, power: float, tolerances: tuple[TipTolerance, TipTolerance],
    weights: Floats | None = None, within: ReliefLimits | None = None,
) -> ToleratedFound:  # fmt: skip
    """Find the tip reliefs that leave the least at the worst place within their tolerances.

    Parameters
    ----------
    engagement, loads, power, weights, within
        As those of `search`; what is left is the peak-to-peak value.
    tolerances : tuple of TipTolerance
        Of driver and driven gear.
    """
    begun, within = time.process_time(), within or ReliefLimits()
    pair = engagement.pair
    gears = pair.driver, pair.driven
    rolls = [float(roll_of_radius(gear, gear.involute_tip_radius)) for gear in gears]
    first, second = tolerances
    over_path = tuple(None if one.length is None else one.length / pair.path_length for one in tolerances)
    to_base = [
        roll * gear.base_radius / pair.path_length if roll > 0.0 else np.inf
        for gear, roll in zip(gears, rolls, strict=True)
    ]
    coarse = ToleratedTrials(
        bench(engagement, 5, 6), loads, power, "peak_to_peak", weights, _CORNERS, (first.amount, second.amount),
        (over_path[0], over_path[1]), (to_base[0], to_base[1]),
    )  # fmt: skip
    fine = replace(coarse, bench=even_bench(engagement, _POSITIONS))
    scale = coarse.mean()
    nominal = search(engagement, loads, power, "peak_to_peak", weights, False, within)
    candidates, solved, starts = nominal.candidates, nominal.evaluations, 0
    found: list[tuple[float, Floats, float, Floats]] = []
    for relieved in ((True, True), (True, False), (False, True)):
        amounts = [most if one else 0.0 for most, one in zip(within.amounts, relieved, strict=True)]
        if any(one and most <= 0.0 for most, one in zip(within.amounts, relieved, strict=True)):
            continue
        limits = box(pair, scale, ReliefLimits((amounts[0], amounts[1]), within.lengths))
        grid = _grid(limits)
        left = coarse.each(grid).max(axis=1)
        candidates += left.size
        begin = np.concatenate([nominal.best[None], grid[apart(grid, left, limits, _STARTS - 1, 0.1)]])
        starts += len(begin)
        p, values, _ = descend(coarse.rough, coarse, begin, limits, *_ROUGH)
        chosen = apart(p, values, limits, _FOLLOWED)
        p, values, count = descend(fine.exact, fine, p[chosen], limits, *_EXACT)
        solved += count * len(_CORNERS)
        order = np.argsort(values, kind="stable")
        led = [_led(fine, p[i], limits) for i in order[:2]]
        solved += sum(count for *_, count in led)
        (first_p, least, _), (second_p, other, _) = sorted((led[0], led[-1]), key=lambda one: one[1])
        found.append((least, first_p, other - least, np.abs(second_p - first_p)))
    most, best, spread, error = min(found, key=lambda one: one[0])
    return ToleratedFound(
        best, nominal.best, most, error, spread, candidates, solved, starts, time.process_time() - begun
    )  # fmt: skip


def _grid(limits: Limits) -> Floats:
    """Candidates of all amounts and lengths, shape (C, 4); one only of a gear that has no relief."""
    axes: list[Floats] = []
    for gear in (0, 1):
        most, longest = limits.high[2 * gear : 2 * gear + 2]
        none = most == 0.0
        amounts = np.zeros(1) if none else np.unique(np.minimum(limits.unit[0] * np.array(_AMOUNTS), most))
        lengths = np.full(1, longest) if none else np.unique(np.minimum(np.array(_LENGTHS) * LONGEST, longest))
        axes += [amounts, np.maximum(lengths, SHORTEST)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 4)


def _led(trials: ToleratedTrials, p: Floats, limits: Limits) -> tuple[Floats, float, int]:
    """A relief led on until no combination of the 81 leaves more than those that are tried: it, that, evaluations."""
    every, solved = replace(trials, ends=_EVERY), 0
    best, least = p, np.inf
    for _ in range(_ADDITIONS + 1):
        of_each = every.exactly(p)
        solved += len(_EVERY)
        if of_each.max() < least:
            best, least = p, float(of_each.max())
        tried = (_EVERY[:, None] == trials.ends).all(axis=2).any(axis=1)
        more = ~tried & (of_each > _MORE * of_each[tried].max())
        if not more.any():
            break
        trials = replace(trials, ends=np.concatenate([trials.ends, _EVERY[more]]))
        led, _, count = descend(trials.exact, trials, p[None], limits, *_EXACT)
        solved += count * len(trials.ends)
        p = led[0]
    return best, least, solved
