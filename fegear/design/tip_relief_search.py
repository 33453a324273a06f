"""Global search for the tip reliefs of both gears that leave the least: a scan of all, then many starts made exact.

Four numbers: amount and length of each gear's relief. What a candidate leaves is a landscape of many valleys, for the
largest and the smallest transmission error change places and pairs part and touch; a search from one start ends in the
valley where it began. So all combinations on a grid are scanned with `QuickSharing`, every local minimum of the grid
starts a simplex search, and each search is led to the exact load sharing's own minimum by correcting the quick one to
first order at its present best. Starts that end at the same value vouch for it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fourier import Panels
from fegear.contact.load_sharing import share_load
from fegear.design.evaluation import Bench, bench
from fegear.design.evolution import evolve
from fegear.design.quick_sharing import QuickSharing, quick_sharing
from fegear.design.relief_bound import deepest_relief
from fegear.geometry.relief import roll_of_radius

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.arrays import Floats
    from fegear.contact.engagement import Engagement

    #: Of double precision, or of single where the quick sharing is at work.

#: Lengths of relief over the path of contact.
SHORTEST, LONGEST = 0.02, 1.0
_HARMONICS = 12
#: Deepest relief tried, in mean transmission errors of the unmodified pair.
_DEEPEST = 6.0
#: Minima of the scan that are followed, those that are led to the exact load sharing's, and in how many rounds.
_SCANNED, _STARTS, _ROUNDS = 40, 16, 3
#: How the best are led on: even roll positions, whether more crowd at kinks, how many of the best, starts about each,
#: and how far about them. The largest and smallest transmission errors sit on kinks, which only many positions catch;
#: its harmonics do not mind. The first of these steps is still one for each start.
_CLOSER = {
    "peak_to_peak": (
        (240, False, 8, 1, 0.15),
        (400, False, 3, 2, 0.06),
        (200, True, 2, 2, 0.02),
        (200, True, 1, 4, 0.006),
    ),
    "effective_error": ((0, False, 8, 1, 0.15), (0, False, 2, 3, 0.04)),
}  # fmt: skip
_AGREED = 1.05
#: What a scan may cost and how fine it may be, see `scan`: harmonics need less time afterwards.
_BUDGET = {"peak_to_peak": (1.2e7, 15), "effective_error": (2.4e7, 17)}
#: States of all sets of pairs to a roll position up to which nothing is saved: three pairs under one load.
_WORK = 4.0
#: Corners and middle of a first population about its start, in units of its spread.
_CLOUD = np.concatenate([np.zeros((1, 4)), np.random.default_rng(2).uniform(-1.0, 1.0, (11, 4))])


@dataclass(frozen=True)
class Stand:
    """A pair set up for trying tip reliefs under several loads.

    Parameters
    ----------
    bench : Bench
    loads : ndarray, shape (L,)
        [N].
    power : float
        1 for straight, 2 for parabolic relief.
    metric : str
        `effective_error` or `peak_to_peak`.
    """

    bench: Bench
    loads: Floats
    power: float
    metric: str

    @cached_property
    def quick(self) -> QuickSharing:
        """For searching."""
        return quick_sharing(self.bench.grid, self.loads)

    @cached_property
    def _depths(self) -> Floats:
        """Distance of each contact from the tips of both gears over the path, shape (2, n, P)."""
        pair, contacts = self.bench.engagement.pair, self.bench.grid.contacts
        found = []
        for gear, roll in ((pair.driver, contacts.roll_driver), (pair.driven, contacts.roll_driven)):
            tip = float(roll_of_radius(gear, gear.involute_tip_radius))
            found.append((tip - roll) * gear.base_radius / pair.path_length)
        return np.array(found)

    @cached_property
    def _rough_depths(self) -> NDArray[np.float32]:
        return self._depths.astype(np.float32)

    def one_gear(self, gear: int, amount: Floats, length: Floats) -> Floats:
        """Removal by one gear's relief [m], shape (..., n, N), in the precision of amount and length."""
        depth = self._depths if length.dtype == np.float64 else self._rough_depths
        s = depth[gear] * (-1.0 / length)[..., None, None]
        s += 1.0
        np.maximum(s, 0.0, out=s)
        if self.power == 2.0:
            s *= s
        s *= amount[..., None, None]
        return s if self.loads.size == 1 else np.repeat(s, self.loads.size, axis=-1)

    def removal(self, p: Floats) -> Floats:
        """Removal of candidates p = (amount, length, amount, length) in [m] and paths, shape (..., n, N) [m]."""
        first = self.one_gear(0, p[..., 0], p[..., 1])
        first += self.one_gear(1, p[..., 2], p[..., 3])
        return first

    @cached_property
    def _kernel(self) -> Floats:
        n, x = np.arange(1, _HARMONICS + 1), self.bench.points.x
        phase = 2.0 * math.pi / self.bench.points.period * np.multiply.outer(x, n)
        weighed = 2.0 * self.bench.points.weights[:, None] / self.bench.points.period
        return np.concatenate([weighed * np.cos(phase), weighed * np.sin(phase)], axis=1)

    def left(self, zeta: Floats) -> Floats:
        """Worst metric over the loads, each in proportion to its load, of approaches (..., N): shape (...) [m]."""
        te = np.ascontiguousarray(np.moveaxis(zeta.reshape(*zeta.shape[:-1], -1, self.loads.size), -1, -2))
        if self.metric == "peak_to_peak":
            values = te.max(axis=-1) - te.min(axis=-1)
        else:
            parts = te @ self._kernel.astype(te.dtype)
            square = parts[..., :_HARMONICS] ** 2 + parts[..., _HARMONICS:] ** 2
            values = np.sqrt(square[..., 0]) + np.sqrt(square.sum(axis=-1))
        return np.asarray((values * (self.loads.max() / self.loads)).max(axis=-1))

    def exact(self, p: Floats) -> tuple[Floats, Floats]:
        """Approach, shape (C, N) [m], and its derivatives by the removals, (C, n, N), of candidates (C, 4)."""
        contacts, m = self.bench.grid.contacts, self.bench.grid.matrices
        n, positions = contacts.x.shape
        shape = (n, positions, p.shape[0] * self.loads.size)
        removal = self.removal(p).reshape(p.shape[0], n, positions, -1)
        added = np.moveaxis(removal, 0, 2).reshape(shape)
        e = np.where(contacts.present, contacts.gap, np.inf)[:, :, None] + added
        shared = share_load(
            m.compliance, e, np.tile(self.loads, p.shape[0]), m.log_slope, m.reference_load, m.tilt, m.power
        )
        active = shared.loads > 0.0
        tangent = np.where(active[:, None] & active, m.tangent(shared.loads), np.eye(n)[:, :, None, None])
        right = np.moveaxis(active.astype(float), 0, -1)[..., None]
        y = np.moveaxis(np.linalg.solve(np.moveaxis(tangent, (0, 1), (-2, -1)), right)[..., 0], -1, 0)
        weight = (y / y.sum(axis=0)).reshape(n, positions, p.shape[0], -1)
        zeta = shared.transmission_error.reshape(positions, p.shape[0], -1)
        return (
            np.moveaxis(zeta, 1, 0).reshape(p.shape[0], -1),
            np.moveaxis(weight, 2, 0).reshape(p.shape[0], n, -1),
        )


@dataclass(frozen=True, slots=True)
class Limits:
    """Box of the four numbers, shape (4,): amounts [m] and lengths over the path."""

    low: Floats
    high: Floats


def scan(stand: Stand, scale: float, limits: Limits, budget: float, finest: int) -> tuple[Floats, int]:
    """Try every combination of amounts and lengths on a grid.

    Parameters
    ----------
    stand : Stand
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

    quick = stand.quick
    work = sum(s.base.size for s in quick.sets)
    side = int(np.clip((budget / work) ** 0.25, 7, finest))
    t = np.linspace(0.0, 1.0, side)
    axes = []
    for gear in (0, 1):
        top = min(4.0 * scale, limits.high[2 * gear])
        axes += [top * (0.55 * t + 0.45 * t**3), np.maximum(0.6 * t + 0.4 * t**3, 0.03)]
    single = [np.stack(np.meshgrid(*axes[2 * g : 2 * g + 2], indexing="ij"), axis=-1).reshape(-1, 2) for g in (0, 1)]
    parts = [stand.one_gear(g, s[:, 0], s[:, 1]) for g, s in enumerate(single)]
    by_set = []
    for s in quick.sets:
        held = [part[:, s.pairs, s.states].astype(np.float32) for part in parts]
        by_set.append([np.einsum("jn,cjn->cn", s.weight, part) for part in held])
    values = np.empty((single[0].shape[0], single[1].shape[0]), dtype=np.float32)
    step = max(1, 150_000 // (single[1].shape[0] * quick.size))
    for first in range(0, values.shape[0], step):
        part = slice(first, first + step)
        least = np.full((values[part].shape[0], values.shape[1], quick.size), np.inf, dtype=np.float32)
        for s, (one, two) in zip(quick.sets, by_set, strict=True):
            there = least[..., s.states]
            np.minimum(there, (one[part] + s.base)[:, None] + two, out=there)
        values[part] = stand.left(least)
    grid = values.reshape(side, side, side, side)
    lowest = np.argwhere(grid == minimum_filter(grid, size=3, mode="nearest"))
    order = np.argsort(grid[tuple(lowest.T)], kind="stable")
    lowest = lowest[order]
    return np.stack([axis[lowest[:, i]] for i, axis in enumerate(axes)], axis=1), grid.size


def settle(stand: Stand, starts: Floats, limits: Limits, scale: float, generations: int = 60) -> tuple[Floats, Floats]:
    """Lead starts, shape (B, 4), to minima of the quick sharing: best, values."""
    unit = np.array([scale, 1.0, scale, 1.0])
    spread = 0.3 * np.maximum(starts, 0.3 * unit)
    first = starts[:, None] + spread[:, None] * _CLOUD

    def left(p: Floats) -> Floats:
        return stand.left(stand.quick.approach(stand.removal(p.astype(np.float32))))

    return evolve(left, first, limits.low, limits.high, generations)


def descend(
    stand: Stand, starts: Floats, limits: Limits, scale: float, trust: float = 0.2, generations: int = 28
) -> tuple[Floats, Floats]:
    """Lead starts, shape (B, 4), to minima of the exact load sharing; values never grow.

    In every round the quick sharing is corrected to first order at each search's present best, searched within a region
    of trust, and the outcome kept where the exact sharing agrees that it is better.

    Returns
    -------
    best, values : ndarray, shapes (B, 4), (B,)
    """
    unit = np.array([scale, 1.0, scale, 1.0])
    p, trusted = np.clip(starts, limits.low, limits.high), np.full(starts.shape[0], trust)
    zeta, weight = stand.exact(p)
    values = stand.left(zeta)
    for _ in range(_ROUNDS):
        m = stand.removal(p)
        off = (zeta - stand.quick.approach(m))[:, None]
        slope = weight - stand.quick.weights(m)

        constant = (off[:, 0] - (m * slope).sum(axis=-2))[:, None].astype(np.float32)
        slopes = slope[:, None].astype(np.float32)

        def model(trial: Floats, constant: Floats = constant, slopes: Floats = slopes) -> Floats:
            tried = stand.removal(trial.astype(np.float32))
            total = stand.quick.approach(tried)
            total += constant
            for j in range(slopes.shape[2]):
                total += slopes[:, :, j] * tried[:, :, j]
            return stand.left(total)

        reach = trusted[:, None] * np.maximum(p, 0.2 * unit)
        low, high = np.maximum(limits.low, p - reach)[:, None], np.minimum(limits.high, p + reach)[:, None]
        new, _ = evolve(model, p[:, None] + reach[:, None] * _CLOUD, low, high, generations)
        new_zeta, new_weight = stand.exact(new)
        new_values = stand.left(new_zeta)
        better = new_values < values
        trusted = np.where(better, 0.6 * trusted, 0.25 * trusted)
        p, values = np.where(better[:, None], new, p), np.where(better, new_values, values)
        zeta = np.where(better[:, None], new_zeta, zeta)
        weight = np.where(better[:, None, None], new_weight, weight)
    return p, values


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
        Searches from different minima of the scan, and those of them that come within 5 % of the lowest.
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
    coarse = Stand(bench(engagement, 5, 6), loads, power, metric)
    fine = Stand(bench(engagement) if loads.size == 1 else bench(engagement, 8, 10), loads, power, metric)
    # Several loads and many sets of pairs cost as much as many positions: fewer of these, and of starts, keep the time.
    work = sum(s.base.size for s in fine.quick.sets) / fine.bench.points.x.size
    thrift = 1.0 if work < _WORK else max(math.sqrt(2.6 / work), 0.4)
    scale = float((fine.exact(np.array([[0.0, 0.5, 0.0, 0.5]]))[0] / np.tile(loads, fine.bench.points.x.size)).mean())
    scale *= float(loads.max())
    deepest = [float(deepest_relief(g, roll_of_radius(g, g.involute_tip_radius))) for g in (pair.driver, pair.driven)]
    top = [min(_DEEPEST * scale, d) for d in deepest]
    limits = Limits(np.array([0.0, SHORTEST, 0.0, SHORTEST]), np.array([top[0], LONGEST, top[1], LONGEST]))
    starts, candidates = scan(coarse, scale, limits, *_BUDGET[metric])
    settled, values = settle(fine, starts[: math.ceil(_SCANNED * thrift)], limits, scale)
    ends, values = descend(fine, settled[np.argsort(values)[: math.ceil(_STARTS * thrift)]], limits, scale)
    final, solved, of_starts = fine, ends.shape[0] * (_ROUNDS + 2), values
    for step, (positions, crowded, leading, each, spread) in enumerate(_CLOSER[metric]):
        ahead = np.argsort(values)[: math.ceil(leading * thrift)]
        if positions:
            kinks = _kinks(final, ends[ahead]) if crowded else np.empty(0)
            final = Stand(_even(engagement, math.ceil(positions * thrift), kinks), loads, power, metric)
        around = ends[ahead][:, None] * (1.0 + spread * _CLOUD[:each])
        ends, values = descend(final, around.reshape(-1, 4), limits, scale, trust=spread)
        solved += ends.shape[0] * (_ROUNDS + 2)
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


def _kinks(stand: Stand, p: Floats) -> Floats:
    """Roll positions [m] where the reliefs of candidates (C, 4) start and, under a single load, where pairs part."""
    pair, points = stand.bench.engagement.pair, stand.bench.points
    places = [pair.x_end - p[:, 1] * pair.path_length, pair.x_start + p[:, 3] * pair.path_length]
    if stand.loads.size == 1:
        touching = stand.exact(p)[1] != 0.0
        changed = (touching[..., 1:] != touching[..., :-1]).any(axis=(0, 1))
        places.append(0.5 * (points.x[1:] + points.x[:-1])[changed])
    found = np.sort(stand.bench.engagement.meshing.reduced(np.concatenate(places)))
    return np.asarray(found[np.diff(found, append=np.inf) > 1e-3 * points.period])
