"""Global search for the tip reliefs of both gears that leave the least: a scan of all, then many starts made exact.

Four numbers: amount and length of each gear's relief. What a candidate leaves is a landscape of many valleys, for the
largest and the smallest transmission error change places and pairs part and touch; a search from one start ends in the
valley where it began. So all combinations on a grid are scanned with `QuickSharing`, the best local minima of the grid
descend with it, and the best of those with the exact load sharing. Starts that end at the same value vouch for it:
those of the scan, and others put around the best.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fourier import Panels
from fegear.design.evaluation import Bench, bench
from fegear.design.relief_descent import Limits, descend
from fegear.design.relief_trials import Trials
from fegear.geometry.plausible import deepest_relief
from fegear.geometry.relief import roll_of_radius

if TYPE_CHECKING:
    from fegear.arrays import Floats
    from fegear.contact.engagement import Engagement

#: Lengths of relief over the path of contact.
SHORTEST, LONGEST = 0.02, 1.0
#: Deepest relief tried, in mean transmission errors of the unmodified pair.
_DEEPEST = 6.0
#: Minima of the scan that are followed, and those that are led to the exact load sharing's.
_STARTS = {"peak_to_peak": (60, 32), "effective_error": (40, 16)}
#: Rounds from minima of the scan, and then by exact load sharing; extent of the first region of trust of the former.
_ROUNDS, _EXACT_ROUNDS, _TRUST = 12, 8, 0.15
#: How the best are led on: even roll positions, whether more crowd at kinks, how many of the best, starts about each,
#: and how far about them. The largest and smallest transmission errors sit on kinks, which only many positions catch;
#: its harmonics do not mind. With fewer of the best it hangs on the last digits in which valley a search ends: loads
#: that differ by 1e-10 then left from 0.707 to 0.778 um, and so many leave 0.706 to 0.724.
_CLOSER = {
    "peak_to_peak": (
        (240, False, 16, 2, 0.15),
        (400, False, 8, 3, 0.06),
        (200, True, 4, 2, 0.02),
        (200, True, 1, 4, 0.006),
    ),
    "effective_error": ((0, False, 6, 1, 0.04), (0, False, 2, 3, 0.04)),
}  # fmt: skip
#: Starts that agree leave at most so much times the least; how far about the best further starts are put, over it.
_AGREED, _FAR = 1.05, 0.15
#: What a scan may cost and how fine it may be, see `scan`: harmonics need less time afterwards.
_BUDGET = {"peak_to_peak": (1.2e7, 15), "effective_error": (2.4e7, 17)}
#: States of all sets of pairs to a roll position up to which nothing is saved: three pairs under one load.
_WORK = 4.0
#: Corners and middle of a first population about its start, in units of its spread.
_CLOUD = np.concatenate([np.zeros((1, 4)), np.random.default_rng(2).uniform(-1.0, 1.0, (11, 4))])


def scan(trials: Trials, scale: float, limits: Limits, budget: float, finest: int) -> tuple[Floats, int]:
    """Try every combination of amounts and lengths on a grid.

    Parameters
    ----------
    trials : Trials
    scale : float
        Mean transmission error of the unmodified pair [m]; amounts go to four times that.
    limits : Limits
    budget : float
        States times sets of pairs times candidates that the grid may cost.
    finest : int
        Most amounts, and lengths, of one gear.

    Returns
    -------
    starts : ndarray, shape (B, 4)
        Local minima of the grid, best first.
    count : int
        Candidates tried.
    """
    from scipy.ndimage import minimum_filter

    quick = trials.quick
    work = sum(s.base.size for s in quick.sets)
    side = int(np.clip((budget / work) ** 0.25, 7, finest))
    t = np.linspace(0.0, 1.0, side)
    axes = []
    for gear in (0, 1):
        top = min(4.0 * scale, limits.high[2 * gear])
        axes += [top * (0.55 * t + 0.45 * t**3), np.maximum(0.6 * t + 0.4 * t**3, 0.03)]
    single = [np.stack(np.meshgrid(*axes[2 * g : 2 * g + 2], indexing="ij"), axis=-1).reshape(-1, 2) for g in (0, 1)]
    count = trials.loads.size
    parts = [
        np.repeat(s[:, 0, None, None] * trials.form(g, s[:, 1]), count, axis=-1).astype(np.float32)
        for g, s in enumerate(single)
    ]
    by_set = []
    for s in quick.sets:
        held = [part[:, s.pairs, s.states] for part in parts]
        by_set.append([np.einsum("jn,cjn->cn", s.weight, part) for part in held])
    values = np.empty((single[0].shape[0], single[1].shape[0]), dtype=np.float32)
    step = max(1, 150_000 // (single[1].shape[0] * quick.size))
    for first in range(0, values.shape[0], step):
        part = slice(first, first + step)
        least = np.full((values[part].shape[0], values.shape[1], quick.size), np.inf, dtype=np.float32)
        for s, (one, two) in zip(quick.sets, by_set, strict=True):
            there = least[..., s.states]
            np.minimum(there, (one[part] + s.base)[:, None] + two, out=there)
        values[part] = trials.left(trials.seen(least.reshape(*least.shape[:2], -1, count)))
    grid = values.reshape(side, side, side, side)
    lowest = np.argwhere(grid == minimum_filter(grid, size=3, mode="nearest"))
    order = np.argsort(grid[tuple(lowest.T)], kind="stable")
    lowest = lowest[order]
    return np.stack([axis[lowest[:, i]] for i, axis in enumerate(axes)], axis=1), grid.size


@dataclass(frozen=True, slots=True)
class Found:
    """Outcome of a search and what vouches for it.

    Parameters
    ----------
    best : ndarray, shape (4,)
        Amount [m] and length over the path of the driver's relief, then of the driven gear's.
    left : float
        What it leaves [m], by the search's own quadrature points.
    candidates : int
        Combinations scanned.
    evaluations : int
        Load sharings over a base pitch solved exactly.
    starts, agreeing : int
        Searches from different minima of the scan and from places up to 15 % about the best, and those of them that
        come within 5 % of the lowest.
    runner_up : float
        The least that the others leave [m]; the most that any leaves where all agree.
    """

    best: Floats
    left: float
    candidates: int
    evaluations: int
    starts: int
    agreeing: int
    runner_up: float


def search(engagement: Engagement, loads: Floats, power: float, metric: str) -> Found:
    """Find the tip reliefs of both gears that leave the least over all amounts and lengths.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs do not count.
    loads : ndarray, shape (L,)
        [N]; the worst of them counts, each in proportion to its load.
    power : float
        1 for straight, 2 for parabolic relief.
    metric : str
        `effective_error` or `peak_to_peak`.
    """
    pair = engagement.pair
    coarse = Trials(bench(engagement, 5, 6), loads, power, metric)
    fine = Trials(bench(engagement) if loads.size == 1 else bench(engagement, 8, 10), loads, power, metric)
    # Several loads and many sets of pairs cost as much as many positions: fewer of these, and of starts, keep the time.
    work = sum(s.base.size for s in fine.quick.sets) / fine.bench.points.x.size
    thrift = 1.0 if work < _WORK else max(math.sqrt(2.6 / work), 0.4)
    scale = fine.mean()
    deepest = [float(deepest_relief(g, roll_of_radius(g, g.involute_tip_radius))) for g in (pair.driver, pair.driven)]
    top = [min(_DEEPEST * scale, d) for d in deepest]
    limits = Limits(np.array([0.0, SHORTEST, 0.0, SHORTEST]), np.array([top[0], LONGEST, top[1], LONGEST]))
    starts, candidates = scan(coarse, scale, limits, *_BUDGET[metric])
    scanned, led = _STARTS[metric]
    followed = starts[: math.ceil(scanned * thrift)]
    settled, values, _ = descend(fine.rough, fine, followed, limits, scale, _TRUST, _ROUNDS)
    ahead = np.argsort(values)[: math.ceil(led * thrift)]
    ends, values, solved = descend(fine.exact, fine, settled[ahead], limits, scale, 0.2, _EXACT_ROUNDS)
    final, of_starts = fine, values
    for step, (positions, crowded, leading, each, spread) in enumerate(_CLOSER[metric]):
        ahead = np.argsort(values)[: math.ceil(leading * thrift)]
        if positions:
            kinks = _kinks(final, ends[ahead]) if crowded else np.empty(0)
            final = Trials(_even(engagement, math.ceil(positions * thrift), kinks), loads, power, metric)
        around = (ends[ahead][:, None] * (1.0 + spread * _CLOUD[:each])).reshape(-1, 4)
        if step == 0:
            around = np.concatenate([around, ends[ahead[0]] * (1.0 + _FAR * _CLOUD[1:9])])
        ends, values, count = descend(final.exact, final, around, limits, scale, spread, _EXACT_ROUNDS)
        solved += count
        if step == 0:
            of_starts = np.concatenate([values, np.delete(of_starts, ahead)])
    best = int(values.argmin())
    agree = of_starts < _AGREED * of_starts.min() + 1e-6 * scale
    return Found(
        ends[best], float(values[best]), candidates, solved, of_starts.size, int(agree.sum()),
        float(of_starts.max() if agree.all() else of_starts[~agree].min()),
    )  # fmt: skip


def _even(engagement: Engagement, positions: int, kinks: Floats) -> Bench:
    """Set up at even roll positions, at both sides of every change of pairs, and crowded about given places."""
    pair = engagement.pair
    pitch, start = pair.base_pitch, pair.x_start
    breaks = engagement.meshing.reduced([pair.x_start, pair.x_end])
    near = pitch * 10.0 ** -np.linspace(2.4, 4.4, 5)
    x = np.concatenate([
        start + pitch * (np.arange(positions) + 0.5) / positions,
        np.add.outer(breaks, [-1e-9 * pitch, 1e-9 * pitch]).ravel(),
        np.add.outer(kinks, np.concatenate([-near, [0.0], near])).ravel(),
    ])  # fmt: skip
    x = np.unique(engagement.meshing.reduced(x))
    weights = 0.5 * (np.roll(x, -1) - np.roll(x, 1))
    weights[[0, -1]] += 0.5 * pitch
    points = Panels(x, weights, pitch, np.append(np.sort(breaks), start + pitch))
    return Bench(engagement, points, engagement.grid(x))


def _kinks(trials: Trials, p: Floats) -> Floats:
    """Roll positions [m] where the reliefs of candidates (C, 4) start and, under a single load, where pairs part."""
    pair, points = trials.bench.engagement.pair, trials.bench.points
    places = [pair.x_end - p[:, 1] * pair.path_length, pair.x_start + p[:, 3] * pair.path_length]
    if trials.loads.size == 1:
        touching = trials.touching(p)
        changed = (touching[:, 1:] != touching[:, :-1]).any(axis=(0, 2))
        places.append(0.5 * (points.x[1:] + points.x[:-1])[changed])
    found = np.sort(trials.bench.engagement.meshing.reduced(np.concatenate(places)))
    return np.asarray(found[np.diff(found, append=np.inf) > 1e-3 * points.period])
