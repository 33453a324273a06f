"""Where searches for tip reliefs begin: the box of amounts and lengths, a grid in it, and the best that lie apart."""

from __future__ import annotations

import numpy as np

from fegear.base.arrays import Floats, Index
from fegear.contact.fourier import Panels
from fegear.contact.plane.engagement import Engagement
from fegear.design.relief_bench import Bench
from fegear.design.tip_relief.descent import Limits
from fegear.design.tip_relief.relief_limits import SHORTEST, ReliefLimits
from fegear.design.tip_relief.trials import Trials
from fegear.geometry.pair import GearPair
from fegear.geometry.plausible_flanks import deepest_relief
from fegear.geometry.relief import roll_of_radius

#: Longest relief over the path of contact.
LONGEST = 1.0
#: Deepest relief tried, in mean transmission errors of the unmodified pair.
_DEEPEST = 6.0
#: What a scan may cost, and how fine it may be: amounts, and lengths, of one gear.
_BUDGET = {"peak_to_peak": (1.2e7, 15), "effective_error": (2.4e7, 17)}
#: Best of the scan among which starts are looked for, starts, and steps of the grid that they are apart at least.
_BEST, _STARTS, _APART = 4000, 64, 2
#: Candidates closer than this in all numbers, in their units, are the same.
SAME = 0.01
#: Positions beside changes of pairs, over the distance of the even ones.
_BESIDE = (0.04, 0.14, 0.35)


def box(pair: GearPair, scale: float, within: ReliefLimits) -> Limits:
    """Amounts and lengths that are tried.

    Parameters
    ----------
    pair : GearPair
    scale : float
        Mean transmission error of the unmodified pair [m].
    within : ReliefLimits
        Limits besides those of the teeth.
    """
    deepest = [float(deepest_relief(g, roll_of_radius(g, g.involute_tip_radius))) for g in (pair.driver, pair.driven)]
    top = [min(_DEEPEST * scale, d, most) for d, most in zip(deepest, within.amounts, strict=True)]
    longest = [min(LONGEST, most) for most in within.lengths]
    return Limits(
        np.array([0.0, SHORTEST, 0.0, SHORTEST]), np.array([top[0], longest[0], top[1], longest[1]]),
        np.array([scale, 1.0, scale, 1.0]),
    )  # fmt: skip


def scan(trials: Trials, limits: Limits, *, like: bool = False) -> tuple[Floats, int]:
    """Try every combination of amounts and lengths on a grid; amounts go to four mean transmission errors.

    Parameters
    ----------
    trials : Trials
    limits : Limits
    like : bool
        Whether driver and driven gear may change places: of two combinations that are each other's mirror one counts.

    Returns
    -------
    starts : ndarray, shape (B, 4)
        The best of the grid that lie apart, best first.
    count : int
        Candidates tried.
    """
    quick = trials.quick
    work = sum(s.base.size for s in quick.sets)
    budget, finest = _BUDGET[trials.metric]
    side = int(np.clip((budget / work) ** 0.25, 7, finest))
    t = np.linspace(0.0, 1.0, side)
    axes = []
    for gear in (0, 1):
        top, longest = min(4.0 * limits.unit[0], limits.high[2 * gear]), limits.high[2 * gear + 1]
        if top == 0.0:
            axes += [np.zeros(1), np.full(1, longest)]
            continue
        axes += [
            top * (0.55 * t + 0.45 * t**3), np.minimum(np.maximum(longest * (0.6 * t + 0.4 * t**3), 0.03), longest)
        ]  # fmt: skip
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
    flat = (np.where(np.tri(values.shape[0], dtype=bool), values, np.inf) if like else values).ravel()
    best = np.argpartition(flat, min(_BEST, flat.size - 1))[:_BEST]
    best = best[np.argsort(flat[best], kind="stable")]
    places = np.stack(np.unravel_index(best, [axis.size for axis in axes]), axis=1)
    open_ = np.ones(best.size, dtype=bool)
    starts: list[Index] = []
    while open_.any() and len(starts) < _STARTS:
        starts.append(places[open_.argmax()])
        open_ &= np.abs(places - starts[-1]).max(axis=1) >= _APART
    return np.stack([axis[np.array(starts)[:, i]] for i, axis in enumerate(axes)], axis=1), flat.size


def apart(p: Floats, values: Floats, limits: Limits, most: int, distance: float = SAME) -> list[int]:
    """Which of some candidates are the best that lie apart, best first."""
    found: list[int] = []
    for i in np.argsort(values, kind="stable"):
        if all((np.abs(p[i] - p[j]) > distance * limits.unit).any() for j in found):
            found.append(int(i))
        if len(found) == most:
            break
    return found


def even_bench(engagement: Engagement, positions: int) -> Bench:
    """Set up at even roll positions, at both sides of every change of pairs, and closer by these.

    Where a relief starts beside such a change, one side of its kink is short.
    """
    pair = engagement.pair
    pitch, start = pair.base_pitch, pair.x_start
    breaks = engagement.meshing.reduced([pair.x_start, pair.x_end])
    beside = np.concatenate([[1e-9], np.array(_BESIDE) / positions])
    x = np.concatenate([
        start + pitch * (np.arange(positions) + 0.5) / positions,
        np.add.outer(breaks, pitch * np.concatenate([-beside, beside])).ravel(),
    ])  # fmt: skip
    x = np.unique(engagement.meshing.reduced(x))
    weights = 0.5 * (np.roll(x, -1) - np.roll(x, 1))
    weights[[0, -1]] += 0.5 * pitch
    points = Panels(x, weights, pitch, np.append(np.sort(breaks), start + pitch))
    return Bench(engagement, points, engagement.grid(x))
