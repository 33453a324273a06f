"""Tip reliefs whose worst place within the tolerances leaves the least.

A relief is ground with amounts and lengths that are off by what a drawing allows. Here the largest transmission error
of all of these is made small, not that of the drawing. The ends of the tolerances are further loads, as it were: each
candidate is tried with amounts and lengths off, and the largest of all counts. Of the 81 combinations of both gears
the corners and the drawing are tried; others that leave more at the end are added, and the search goes on.

Of a gear that is not ground the profile slope is off by its tolerance in place of amount and length: reliefs of both
gears, of the driver and of the driven gear only are searched for apart, and the best of them is taken.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from typing import Literal

import numpy as np

from fegear.base.arrays import Array, Floats, Index
from fegear.base.solution_cache import fields_codec
from fegear.contact.plane.engagement import Engagement
from fegear.design.relief_bench import Bench, bench
from fegear.design.tip_relief.descent import Limits, descend
from fegear.design.tip_relief.relief_limits import SHORTEST, ReliefLimits
from fegear.design.tip_relief.relief_scan import LONGEST, apart, box, even_bench
from fegear.design.tip_relief.search import search
from fegear.design.tip_relief.tip_tolerance import NOTHING, OF_LENGTH, SHORTEST_LEFT, TipTolerance, profile_slopes
from fegear.design.tip_relief.trials import Trials, Tried
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import UNMODIFIED, Relief, roll_of_radius

#: Grid of amounts, over the mean transmission error, and lengths of each gear from which searches start.
_AMOUNTS, _LENGTHS = (0.1, 0.3, 0.6, 1.0, 1.5, 2.2), (0.1, 0.2, 0.33, 0.5, 0.7, 1.0)
#: Starts of the descents, of which the best go on exactly; candidates tried at a time.
_STARTS, _FOLLOWED, _BATCH = 12, 4, 64
#: Even roll positions, regions of trust and rounds of both descents.
_POSITIONS, _ROUGH, _EXACT = 56, (0.2, 10), (0.15, 10)
#: How often combinations are added at most, and over what is left from which one is.
_ADDITIONS, _MORE = 3, 1.002


def tolerance_ends(ground: tuple[bool, bool], amounts: Literal["corners", "every"]) -> Array:
    """Ends of both gears' tolerances, amount and length each, or profile slope and none of a gear that is not ground.

    Parameters
    ----------
    ground : tuple of bool
        Whether driver and driven gear have relief.
    amounts : {"corners", "every"}
        The drawing and the corners, or these and all between: 17 and 81 of two reliefs, 9 and 27 of one.

    Returns
    -------
    ndarray, shape (K, 4)
    """
    ends = (-1, 1) if amounts == "corners" else (-1, 0, 1)
    of_each = [product(ends, ends if one else (0,)) for one in ground]
    corners = [(*driver, *driven) for driver, driven in product(*of_each)]
    return np.array(corners if amounts == "every" else [(0, 0, 0, 0), *corners])


def _sloped(table: Bench, driver: Relief, driven: Relief) -> Bench:
    """The pair with flanks that keep these deviations besides what is tried."""
    contacts = table.grid.contacts
    gap = contacts.gap + np.where(contacts.present, table.removal(driver, driven), 0.0)
    return replace(table, grid=replace(table.grid, contacts=replace(contacts, gap=gap)))


@dataclass(frozen=True)
class ToleratedTrials(Trials):
    """Trials of reliefs that are off: every end of the tolerances is a further load of each candidate.

    Parameters
    ----------
    ends : ndarray, shape (K, 4)
        -1, 0 or 1 for amount and length of driver and driven gear, see `tolerance_ends`; the drawing only by default.
    amounts : tuple of float
        Tolerances of the amounts [m].
    lengths : tuple of float or None
        Of the lengths, over the path of contact; None: a tenth of the length.
    longest : tuple of float
        Lengths over the path at which reliefs reach the base circle.
    ground : tuple of bool
        Whether driver and driven gear have relief; the profile slope of one without is off by its amount's tolerance.
    """

    ends: Array = field(default_factory=lambda: np.zeros((1, 4)))
    amounts: tuple[float, float] = (0.0, 0.0)
    lengths: tuple[float | None, float | None] = (None, None)
    longest: tuple[float, float] = (np.inf, np.inf)
    ground: tuple[bool, bool] = (True, True)

    @cached_property
    def _by_slopes(self) -> tuple[tuple[Index, Trials], ...]:
        """Numbers of the ends with equal profile slopes, and trials of the pair with these."""
        pair = self.bench.engagement.pair
        sides = np.where(np.repeat(self.ground, 2), 0, self.ends)[:, ::2]
        found = []
        for at in np.unique(sides, axis=0).tolist():
            driver, driven = (
                UNMODIFIED if side == 0 else profile_slopes(pair, member, size)[int(side < 0)]
                for side, member, size in zip(at, MEMBERS, self.amounts, strict=True)
            )
            table = _sloped(self.bench, driver, driven)
            here = np.flatnonzero((sides == at).all(axis=1))
            found.append((here, Trials(table, self.loads, self.power, self.metric, self.weights)))
        return tuple(found)

    def off(self, p: Floats) -> tuple[Floats, Floats]:
        """Candidates (C, 4) at the ends of their tolerances, and by the numbers of the drawing, shapes (C, K, 4)."""
        q = np.repeat(p[:, None], len(self.ends), axis=1)
        by = np.ones_like(q)
        for gear in (0, 1):
            i, j = 2 * gear, 2 * gear + 1
            if not self.ground[gear]:
                by[:, :, i] = q[:, :, i] = 0.0
                continue
            amount = q[:, :, i] + self.ends[:, i] * self.amounts[gear]
            by[:, :, i] = np.where(amount > 0.0, 1.0, 0.0)
            q[:, :, i] = np.maximum(amount, 0.0)
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
        return _together([
            self._as_loads(trials.rough(q[:, here].reshape(-1, 4)), by[:, here]) for here, trials in self._by_slopes
        ])  # fmt: skip

    def exact(self, p: Floats) -> Tried:
        """By the exact load sharing, of candidates (C, 4)."""
        q, by = self.off(p)
        return _together([
            self._as_loads(trials.exact(q[:, here].reshape(-1, 4)), by[:, here]) for here, trials in self._by_slopes
        ])  # fmt: skip

    def exactly(self, p: Floats) -> Floats:
        """What a candidate (4,) leaves at each end of its tolerances, shape (K,) [m]."""
        (q,), _ = self.off(p[None])
        left = np.empty(len(self.ends))
        for here, trials in self._by_slopes:
            tried = trials.exact(q[here])
            left[here] = trials.left(tried.seen, tried.low)
        return left

    def each(self, p: Floats) -> Floats:
        """What candidates leave at each end of their tolerances, by the quick sharing, shape (C, K) [m]."""
        left = np.empty((len(p), len(self.ends)))
        for first in range(0, len(p), _BATCH):
            batch = slice(first, first + _BATCH)
            q, _ = self.off(p[batch])
            for here, trials in self._by_slopes:
                left[batch, here] = trials.least(q[:, here].reshape(-1, 4)).reshape(len(q), -1)
        return left


def _together(tried: list[Tried]) -> Tried:
    """What is seen of the ends of several profile slopes, as of further loads."""
    if len(tried) == 1:
        return tried[0]

    def joined(name: str, axis: int) -> Floats:
        return np.concatenate([getattr(one, name) for one in tried], axis=axis)

    return Tried(joined("seen", 1), joined("slope", 2), joined("low", 1), joined("low_slope", 2))


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
        bench(engagement, 5, 6), loads, power, "peak_to_peak", weights, amounts=(first.amount, second.amount),
        lengths=(over_path[0], over_path[1]), longest=(to_base[0], to_base[1]),
    )  # fmt: skip
    even = even_bench(engagement, _POSITIONS)
    scale = coarse.mean()
    nominal = search(engagement, loads, power, "peak_to_peak", weights, False, within)
    candidates, solved, starts = nominal.candidates, nominal.evaluations, 0
    found: list[tuple[float, Floats, float, Floats]] = []
    for ground in ((True, False), (False, True), (True, True)):
        amounts = [most if one else 0.0 for most, one in zip(within.amounts, ground, strict=True)]
        if any(one and most <= 0.0 for most, one in zip(within.amounts, ground, strict=True)):
            continue
        coarse = replace(coarse, ground=ground, ends=tolerance_ends(ground, "corners"))
        fine = replace(coarse, bench=even)
        limits = box(pair, scale, ReliefLimits((amounts[0], amounts[1]), within.lengths))
        grid = _grid(limits)
        left = coarse.each(grid).max(axis=1)
        candidates += left.size
        begin = np.concatenate([nominal.best[None], grid[apart(grid, left, limits, _STARTS - 1, 0.1)]])
        starts += len(begin)
        p, values, _ = descend(coarse.rough, coarse, begin, limits, *_ROUGH)
        chosen = apart(p, values, limits, _FOLLOWED)
        p, values, count = descend(fine.exact, fine, p[chosen], limits, *_EXACT)
        solved += count * len(fine.ends)
        order = np.argsort(values, kind="stable")
        led = [_led(fine, p[i], limits) for i in order[:2]]
        solved += sum(count for *_, count in led)
        (first_p, least, _), (second_p, other, _) = sorted((led[0], led[-1]), key=lambda one: one[1])
        if found and (first_p[::2] <= NOTHING).any():
            continue  # one gear only, whose other one has a profile slope
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
    """A relief led on until no combination of all leaves more than those that are tried: it, that, evaluations."""
    ends = tolerance_ends(trials.ground, "every")
    every, solved = replace(trials, ends=ends), 0
    best, least = p, np.inf
    for _ in range(_ADDITIONS + 1):
        of_each = every.exactly(p)
        solved += len(ends)
        if of_each.max() < least:
            best, least = p, float(of_each.max())
        tried = (ends[:, None] == trials.ends).all(axis=2).any(axis=1)
        more = ~tried & (of_each > _MORE * of_each[tried].max())
        if not more.any():
            break
        trials = replace(trials, ends=np.concatenate([trials.ends, ends[more]]))
        led, _, count = descend(trials.exact, trials, p[None], limits, *_EXACT)
        solved += count * len(trials.ends)
        p = led[0]
    return best, least, solved
