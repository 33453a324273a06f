"""The tip reliefs of both gears that leave the least transmission error in a percentile of drawn deviations.

All combinations of amounts and lengths on a grid are tried over the first draws of a common set with the straight laws
of `quick_sharing`, the best tenth of them over the whole set; the best of those, and the nominal optimum, are led on by
trying steps either way in each of the four numbers, ever smaller ones; those ends are solved exactly and the best of
them is taken. Common draws make differences between candidates far surer than either percentile is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from fegear.base.arrays import Array, Floats
from fegear.base.errors import FegearError, InputError
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.roll_grids import RollGrid
from fegear.design.quick_sharing import quick_sharing
from fegear.design.robustness.deviated_pair import Bench, deviated
from fegear.design.robustness.tolerance_draws import Deviations
from fegear.design.tip_relief.grindable import relief_over_path
from fegear.geometry.pair import MEMBERS, Member
from fegear.geometry.plausible_flanks import deepest_relief
from fegear.geometry.relief import UNMODIFIED, EndRelief, roll_of_radius

_Numbers = tuple[float, float, float, float]


#: Even roll positions over the base pitch; both sides of changes of pairs come in addition.
_POSITIONS = 60
#: Candidates of the grid that are led on, and halvings of the grid's steps on the way.
LED, _HALVINGS = 4, 4
#: Draws over which the whole grid is tried, and the share of its candidates that all draws then judge.
SCREENING, _KEPT = 64, 0.1
#: Forms of reliefs that are kept: a step in an amount leaves both lengths as they are.
_KNOWN = 2 * 9
#: Amounts tried without a wish, up to this many mean transmission errors; lengths over the path.
_DEEPEST, _AMOUNTS = 3.0, 8
_LENGTHS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)


@dataclass(frozen=True)
class RobustRelief:
    """Tip reliefs that leave the least in a percentile of draws, and what vouches for it.

    Parameters
    ----------
    driver, driven : EndRelief
    numbers : tuple of four floats
        Amount [m] and length over the path of contact, of driver, then driven gear.
    left : float
        The percentile of the peak-to-peak transmission error over the common draws [m], at the search's positions.
    nominal_left : float
        The same of the nominal optimum [m].
    candidates : int
        Combinations on the grid, all of them tried.
    on_grid : float
        The least of the grid by the straight laws [m].
    quick_error : float
        Largest difference of the straight laws' percentile from the exact one's among the ends [m].
    draws : int
    """

    driver: EndRelief
    driven: EndRelief
    numbers: tuple[float, float, float, float]
    left: float
    nominal_left: float
    candidates: int
    on_grid: float
    quick_error: float
    draws: int


@dataclass(frozen=True)
class _Trials:
    """Draws set up for trying tip reliefs: D draws at P positions, n pairs, S sets of neighbouring pairs.

    Parameters
    ----------
    base : ndarray, shape (S, D, P)
        Approach of each set with the deviations alone, infinite where not all its pairs are in reach [m].
    weight : ndarray, shape (S, n, D, P)
        Its derivative by the pairs' modifications.
    depth : ndarray, shape (2, n, D, P)
        Distance of the contacts from the tips of driver and driven gear over the path.
    states : tuple of (Engagement, RollGrid)
        The D draws, for exact load sharing.
    load : float
    power, percent : float
    """

    base: Floats
    weight: Floats
    depth: Floats
    states: tuple[tuple[Engagement, RollGrid], ...]
    load: float
    power: float
    percent: float
    known: dict[tuple[int, float], Floats] = field(default_factory=dict)

    def first(self, draws: int) -> _Trials:
        """The first of the draws alone."""
        base, weight, depth = (np.ascontiguousarray(a[..., :draws, :]) for a in (self.base, self.weight, self.depth))
        return _Trials(base, weight, depth, self.states[:draws], self.load, self.power, self.percent)

    def form(self, gear: int, length: float) -> Floats:
        """How far each set's approach moves by one gear's relief of unit amount and a length, shape (S, D, P)."""
        if (gear, length) not in self.known:
            if len(self.known) >= _KNOWN:
                self.known.pop(next(iter(self.known)))
            s = np.maximum(1.0 - self.depth[gear] / np.float32(length), np.float32(0.0))
            self.known[gear, length] = np.einsum("sjdp,jdp->sdp", self.weight, s if self.power == 1.0 else s * s)
        return self.known[gear, length]

    def left(self, moved: Floats) -> float:
        """The percentile of what approaches of the sets, shape (S, D, P), leave from peak to peak [m]."""
        te = moved.min(axis=0)
        return self._percentile(te.max(axis=1) - te.min(axis=1))

    def _percentile(self, peaks: Floats) -> float:
        return float(np.quantile(peaks.astype(float), self.percent / 100.0, method="median_unbiased"))

    def quick(self, p: Sequence[float]) -> float:
        """What a candidate leaves by the straight laws [m]."""
        moved = self.base + np.float32(p[0]) * self.form(0, p[1]) + np.float32(p[2]) * self.form(1, p[3])
        return self.left(moved)

    def exact(self, p: Sequence[float]) -> float:
        """What a candidate leaves by exact load sharing [m]."""
        peaks = []
        for engagement, grid in self.states:
            tips = _tips(engagement, p, self.power)
            own = engagement.modification(grid.contacts)
            m = own + sum(tip.removal(roll) for tip, roll in zip(tips, _rolls(grid), strict=True))
            c = grid.contacts
            e = np.where(c.present, c.gap + m + engagement.spacing(c, 0), np.inf)
            peaks.append(np.ptp(grid.matrices.share(e, [self.load]).transmission_error))
        return self._percentile(np.array(peaks))


def _rolls(grid: RollGrid) -> tuple[Array, Array]:
    return grid.contacts.roll_driver, grid.contacts.roll_driven


def _tips(engagement: Engagement, p: Sequence[float], power: float) -> tuple[EndRelief, EndRelief]:
    pair = engagement.pair
    first, second = (
        relief_over_path(pair.gear(member), pair.path_length, p[2 * i], p[2 * i + 1], power)
        for i, member in enumerate(MEMBERS)
    )
    return first, second


def _trials(bench: Bench, deviations: Deviations, power: float, percent: float) -> _Trials:
    """Set up the draws that have a result; tip reliefs keep the lengths that they have at the drawing's distance."""
    plain = replace(bench, engagement=replace(bench.engagement, driver_relief=UNMODIFIED, driven_relief=UNMODIFIED))
    states: list[tuple[Engagement, RollGrid]] = []
    for row in range(len(deviations)):
        try:
            e = deviated(plain, deviations, row)
            states.append((e, e.grid(_positions(e))))
        except FegearError:
            continue
    if not states:
        raise InputError("robustness.reliefs", "no sample", "gives a result for comparing reliefs")
    numbers = sorted({int(j) for _, grid in states for j in grid.contacts.number})
    sets = [(i, k) for i in range(len(numbers)) for k in range(i + 1, len(numbers) + 1)]
    shape = len(states), states[0][1].x.size
    base = np.full((len(sets), *shape), np.inf, dtype=np.float32)
    weight = np.zeros((len(sets), len(numbers), *shape), dtype=np.float32)
    depth = np.ones((2, len(numbers), *shape), dtype=np.float32)
    path = bench.engagement.pair.path_length
    for d, (e, grid) in enumerate(states):
        first = numbers.index(int(grid.contacts.number[0]))
        rows = slice(first, first + grid.contacts.number.size)
        off = e.modification(grid.contacts) + e.spacing(grid.contacts, 0)
        for one in quick_sharing(grid, np.array([bench.load])).sets:
            s = sets.index((first + one.pairs.start, first + one.pairs.stop))
            moved = (one.weight * off[one.pairs.start : one.pairs.stop, one.states]).sum(axis=0)
            base[s, d, one.states] = one.base + moved
            weight[s, first + one.pairs.start : first + one.pairs.stop, d, one.states] = one.weight
        for i, (member, roll) in enumerate(zip(MEMBERS, _rolls(grid), strict=True)):
            gear = e.pair.gear(member)
            tip = float(roll_of_radius(gear, gear.involute_tip_radius))
            depth[i, rows, d] = (tip - roll) * gear.base_radius / path
    used = np.isfinite(base).any(axis=(1, 2))
    return _Trials(base[used], weight[used], depth, tuple(states), bench.load, power, percent)


def _positions(engagement: Engagement) -> Array:
    """Evenly over the base pitch, and on both sides of every change of pairs [m]; as many for every draw."""
    pair = engagement.pair
    even = pair.x_start + pair.base_pitch * (np.arange(_POSITIONS) + 0.5) / _POSITIONS
    changes = engagement.meshing.reduced([pair.x_start, pair.x_end])
    beside = np.add.outer(changes, np.array([-1e-7, 1e-7]) * pair.base_pitch).ravel()
    return np.sort(engagement.meshing.reduced(np.concatenate([even, beside])))


def robust_tip_relief(
    bench: Bench,
    deviations: Deviations,
    nominal: tuple[float, float, float, float],
    *,
    amounts: Sequence[float] | None = None,
    lengths: Sequence[float] | None = None,
    power: float = 1.0,
    percent: float = 95.0,
) -> RobustRelief:
    """Find the tip reliefs whose peak-to-peak transmission error is least in a percentile of draws.

    Parameters
    ----------
    bench : Bench
        Its own reliefs are replaced.
    deviations : Deviations
        The common draws.
    nominal : four floats
        Amount [m] and length over the path of driver and driven gear that are best without deviations: a start.
    amounts : sequence of float, optional
        To be tried on each gear [m], besides none; by default eight up to three mean transmission errors.
    lengths : sequence of float, optional
        Over the path of contact.
    power : float
        1 for straight, 2 for parabolic relief.
    percent : float
    """
    trials = _trials(bench, deviations, power, percent)
    mean = float(np.where(np.isfinite(trials.base), trials.base, np.inf).min(axis=0).mean())
    deepest = min(_room(bench, member) for member in MEMBERS)
    tried = np.array(amounts) if amounts else np.linspace(0.0, _DEEPEST * mean, _AMOUNTS + 1)[1:]
    tried = np.minimum(tried, deepest)
    long = tuple(lengths) if lengths else _LENGTHS
    screen = trials.first(SCREENING)
    forms = [{n: screen.form(gear, n) for n in long} for gear in (0, 1)]
    each = [(0.0, long[0]), *product(map(float, np.unique(tried)), long)]
    rough: list[tuple[float, _Numbers]] = []
    for a, n in each:
        one = screen.base + np.float32(a) * forms[0][n]
        rough += [(screen.left(one + np.float32(b) * forms[1][k]), (a, n, b, k)) for b, k in each]
    ahead = sorted(rough)[: max(LED, round(_KEPT * len(rough)))]
    # In the order of their lengths, whose forms are kept then.
    found = sorted((trials.quick(p), p) for _, p in sorted(ahead, key=lambda one: (one[1][1], one[1][3])))
    steps = float(np.diff(np.append(0.0, np.unique(tried))).max()), float(np.max(np.diff(np.append(0.0, long))))
    starts = [p for _, p in found[:LED]] + [nominal]
    ends = [_led(trials, p, steps, deepest) for p in starts]
    exact = [(trials.exact(p), p, value) for value, p in ends]
    left, best, _ = min(exact)
    tips = _tips(bench.engagement, best, power)
    return RobustRelief(
        *tips, best, left, trials.exact(nominal), len(rough), found[0][0],
        max(abs(truth - value) for truth, _, value in exact), len(trials.states),
    )  # fmt: skip


def _room(bench: Bench, member: Member) -> float:
    """Deepest relief that a gear's tooth can take at its tip [m]."""
    gear = bench.engagement.pair.gear(member)
    tip = roll_of_radius(gear, gear.involute_tip_radius)
    return float(deepest_relief(gear, np.atleast_1d(tip)).min())


def _led(
    trials: _Trials, start: tuple[float, float, float, float], steps: tuple[float, float], deepest: float
) -> tuple[float, tuple[float, float, float, float]]:
    """Try a step either way in each number, again while that helps, then steps of half the size."""
    best, at = trials.quick(start), start
    low, high = (0.0, 0.02, 0.0, 0.02), (deepest, 1.0, deepest, 1.0)
    for halving in range(1, _HALVINGS + 1):
        better = True
        while better:
            better = False
            for i, sign in product(range(4), (1.0, -1.0)):
                moved = list(at)
                moved[i] = min(max(at[i] + sign * steps[i % 2] * 0.5**halving, low[i]), high[i])
                value = trials.quick(moved)
                if value < best * (1.0 - 1e-6):
                    best, at, better = value, (moved[0], moved[1], moved[2], moved[3]), True
    return best, at
