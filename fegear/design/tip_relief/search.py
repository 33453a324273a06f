"""Global search for the tip reliefs of both gears that leave the least, and among the equally good ones for one.

Four numbers: amount and length of each gear's relief. What a candidate leaves is a landscape of many valleys, for the
largest and the smallest transmission error change places and pairs part and touch; a search from one start ends in the
valley where it began. So all combinations on a grid are scanned with `QuickSharing`; the best of them that lie apart
descend with it, and the best ends with the exact load sharing. The deepest valleys are followed to their ground.

Every other of the starts belongs to one search, those between to another: how far apart the least is that both find
says what a single one would be worth.

The ground is flat: reliefs of half and of twice the depth may leave the same within a hundredth, and which of them is
lowest hangs on the last digits of the load. So all that leave at most a hundredth more than the least count as equally
good. Of them the one with the least removal is taken, and of two such the longer; the others are stated as a band. Of
two like gears either may have either relief: the driver takes the deeper one, and both have the same band.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Floats, Mask
from fegear.base.solution_cache import fields_codec
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.relief_bench import Bench, bench
from fegear.design.tip_relief.descent import Aim, Limits, descend
from fegear.design.tip_relief.ground import refine
from fegear.design.tip_relief.relief_limits import ReliefLimits
from fegear.design.tip_relief.relief_scan import SAME, apart, box, even_bench, scan
from fegear.design.tip_relief.trials import Trials
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.relief import roll_of_radius

#: Reliefs that leave at most this much more than the least, over it, are equally good.
SHARE = 0.01
#: Even roll positions, or Gauss points (0), candidates followed from the stage before, regions of trust and rounds of
#: the three descents. The largest and smallest transmission errors sit on kinks, found between even positions; its
#: harmonics need good quadrature.
_STAGES = {
    "peak_to_peak": ((56, 64, 0.15, 8), (56, 12, 0.15, 6)),
    "effective_error": ((0, 48, 0.15, 10), (0, 16, 0.15, 7)),
}
#: Ends of the last descent that are led to the ground, and of the equally good those that are led to the end.
_GROUNDS, _CHOSEN = 3, 3
#: Valleys from which the least removal is looked for besides.
_VALLEYS = 6
#: Under several loads the ends of the band are led outward by descents, of first regions of trust and rounds, and to
#: their last digits no more than so many rounds: each would cost nine times as much, and the ends hang on each other's
#: loads so that it comes to none.
_OUTWARD, _LAST = (0.2, 15), 4
#: Ends that leave so many times the least are not led on; a penalty below this is none, and
#: ends of a band are known to this, in their units.
_HOPELESS, _WITHIN = 1.03, 1e-3
#: Starts that agree leave at most so much times the least.
_AGREED = 1.05
#: A whole path of contact more of relief is worth this much more removal, in mean transmission errors.
_LONGER = 0.01
#: The rule: least removal, then longest, by the four numbers in their units.
_RULE = np.array([1.0, -_LONGER, 1.0, -_LONGER])
#: Removals that differ by less, in mean transmission errors, are equal: then the driver's counts.
_EQUAL = 1e-6
#: Valleys lie apart by more, in their units, and regions of equally good reliefs.
_VALLEY, _REGION = 0.1, 0.3
#: Gears are alike whose sizes and compliances differ by less, over these.
_LIKE = 1e-9
#: States of all sets of pairs to a roll position up to which nothing is saved: three pairs under one load.
_WORK = 4.0


@dataclass(frozen=True, slots=True)
class Found:
    """Outcome of a search and what vouches for it.

    Parameters
    ----------
    best : ndarray, shape (4,)
        Amount [m] and length over the path of the driver's relief, then of the driven gear's: chosen among the equally
        good.
    left, least : float
        What it leaves, and what the best of all leave [m], by the search's own roll positions.
    spread : float
        How far the least of two independent searches are apart [m]: one from every other place of the scan, one from
        those between.
    band, band_error : ndarray, shape (2, 4)
        From where to where the numbers of equally good reliefs go, and how much farther that may be; nan where it was
        not looked for.
    candidates : int
        Combinations scanned.
    evaluations : int
        Load sharings over a base pitch solved exactly.
    starts : int
        Places of the scan that lie apart from which both went out.
    seconds : float
        CPU time of the search.
    """

    best: Floats
    left: float
    least: float
    spread: float
    band: Floats
    band_error: Floats
    candidates: int
    evaluations: int
    starts: int
    seconds: float


#: How a search is kept.
FOUND = fields_codec(Found)


def search(
    engagement: Engagement, loads: Floats, power: float, metric: str, weights: Floats | None = None,
    banded: bool = True, within: ReliefLimits | None = None,
) -> Found:  # fmt: skip
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
    weights : ndarray, shape (L,), optional
        What each load counts, positive; all the same by default.
    banded : bool
        Whether to look for the ends of the band of equally good reliefs, a third of the time.
    within : ReliefLimits, optional
        Limits besides those of the teeth.
    """
    begun, pair = time.process_time(), engagement.pair
    coarse = Trials(bench(engagement, 5, 6), loads, power, metric, weights)
    # Several loads and many sets of pairs cost as much as many candidates: fewer of these keep the time.
    work = sum(s.base.size for s in coarse.quick.sets) / coarse.bench.points.x.size
    thrift = 1.0 if work < _WORK else max(math.sqrt(2.6 / work), 0.4)
    scale, within = coarse.mean(), within or ReliefLimits()
    limits = box(pair, scale, within)
    like = within.alike and _are_like(pair, engagement.compliance)
    p, candidates = scan(coarse, limits, like=like)
    starts, solved = p.shape[0], 0
    values, of = np.arange(float(starts)), np.eye(2, dtype=bool)[np.arange(starts) % 2]
    valleys, trials, now = p, coarse, -1
    for step, (positions, followed, trust, rounds) in enumerate(_STAGES[metric]):
        if positions != now:
            now = positions
            trials = Trials(_set_up(engagement, positions, loads.size), loads, power, metric, weights)
        p, of = _followed(p, values, of, limits, math.ceil(followed * thrift))
        p, values, count = descend(trials.exact if step else trials.rough, trials, p, limits, trust, rounds)
        solved += count if step else 0
        valleys = valleys if step else p[values < _AGREED * values.min() + 1e-6 * scale]
    p, valleys = (_driver_deeper(p), _driver_deeper(valleys)) if like else (p, valleys)
    deep = [i for i in apart(p, values, limits, _GROUNDS) if values[i] < _HOPELESS * values.min()]
    deep += [i for i in (int(np.where(one, values, np.inf).argmin()) for one in of.T) if i not in deep]
    grounds, lefts, _, count = refine(trials, p[deep], limits)
    solved += count
    least = float(lefts.min())
    spread = float(np.ptp([lefts[one].min() for one in of[deep].T]))
    allowed = (1.0 + SHARE) * least
    p, values = np.concatenate([grounds, p]), np.append(lefts, values)
    best, count = _among_equals(trials, p[values <= allowed], valleys, allowed, limits, like, banded)
    return Found(
        best.chosen, best.left, least, spread, best.band, best.band_error, candidates, solved + count, starts,
        time.process_time() - begun,
    )  # fmt: skip


def _followed(p: Floats, values: Floats, of: Mask, limits: Limits, most: int) -> tuple[Floats, Mask]:
    """The best of candidates that lie apart, and of which of both searches each is: of both, where both came to it.

    Of each search the best is among them.
    """
    chosen = apart(p, values, limits, most)
    chosen += [i for i in (int(np.where(one, values, np.inf).argmin()) for one in of.T) if i not in chosen]
    beside = (np.abs(p[chosen][:, None] - p) <= SAME * limits.unit).all(axis=2)
    return p[chosen], np.asarray(beside @ of)


def _mirrored(p: Floats) -> Floats:
    """Reliefs with those of driver and driven gear exchanged."""
    return np.roll(p, 2, axis=-1)


def _driver_deeper(p: Floats) -> Floats:
    """Reliefs of like gears, those of driver and driven gear exchanged where the driven gear's is the deeper."""
    return np.where(p[:, :1] < p[:, 2:3], _mirrored(p), p)


def _are_like(pair: GearPair, compliance: PairCompliance) -> bool:
    """Whether driver and driven gear may change places: their flanks have the same place, size and compliance."""
    x = np.linspace(pair.x_start, pair.x_end, 9)
    sizes, soft = [], []
    for member, at in zip(MEMBERS, (x, x[::-1]), strict=True):
        gear = pair.gear(member)
        tip = roll_of_radius(gear, gear.involute_tip_radius)
        sizes.append(np.array([gear.base_radius, tip, float(gear.tooth.teeth)]))
        radius = np.asarray(pair.radius(at, member))
        soft.append(np.concatenate([radius, np.asarray(compliance.source(member).own(0, radius))]))
    return all(bool(np.allclose(one, other, rtol=_LIKE, atol=0.0)) for one, other in (sizes, soft))


@dataclass(frozen=True, slots=True)
class _Choice:
    """One of the equally good reliefs, and from where to where they go, see `Found`."""

    chosen: Floats
    left: float
    band: Floats
    band_error: Floats


def _among_equals(
    trials: Trials, equals: Floats, valleys: Floats, allowed: float, limits: Limits, like: bool, banded: bool
) -> tuple[_Choice, int]:
    """Choose one of the reliefs that leave no more than allowed, and find from where to where they go.

    The least removal is a search of its own: the valley with the least removal need not be among the deepest. It and
    the ends of the band are led to all their digits: they have the same place wherever the search came from. The ends
    are looked for twice, from halves of what is known, and how far both are apart is part of their error: equally good
    reliefs may lie apart, and no search of one end tells of another.

    Parameters
    ----------
    trials : Trials
    equals : ndarray, shape (B, 4)
        Some of them.
    valleys : ndarray, shape (V, 4)
        Grounds of valleys, by the quick sharing, of which some may be as deep.
    allowed : float
        [m].
    limits : Limits
    like : bool
        Whether driver and driven gear may change places.
    banded : bool
        Whether the ends are looked for.

    Returns
    -------
    choice : _Choice
    evaluations : int
    """
    unit = limits.unit
    starts = np.concatenate([
        some[apart(some, some / unit @ _RULE, limits, most, distance)]
        for some, most, distance in ((equals, _CHOSEN, SAME), (valleys, _VALLEYS, _VALLEY))
    ])  # fmt: skip
    aim = Aim(np.tile(_RULE, (starts.shape[0], 1)), allowed)
    p, values, solved = descend(trials.exact, trials, starts, limits, 0.1, 7, aim)
    held = values - p / unit @ _RULE < _WITHIN
    # The ends are looked for twice, from every other of what is known each time.
    each = [np.concatenate([p[i::2][held[i::2]], equals[i::2]]) for i in (0, 1)]
    each = [_driver_deeper(some) if like else some for some in each]
    known = np.concatenate(each)
    fewest = known[apart(known, known / unit @ _RULE, limits, _CHOSEN)]
    if not banded:
        p, left, _, count = refine(trials, fewest, limits, Aim(np.tile(_RULE, (fewest.shape[0], 1)), allowed))
        p, left, best, more = _fewest(trials, p, left, allowed, limits, like)
        nothing = np.full((2, 4), np.nan)
        return _Choice(p[best], float(left[best]), nothing, nothing), solved + count + more
    # The band is looked for from what lies farthest out already.
    outward = np.concatenate([-np.eye(4), np.eye(4)])
    begun = []
    for some in (one if one.size else known for one in each):
        both = np.concatenate([some, _mirrored(some)]) if like else some
        begun.append(both[(both / unit @ outward.T).argmax(axis=0)])
    begun = _of_every_region(begun, np.concatenate([known, _mirrored(known)]) if like else known, outward, unit)
    p, left, ends, ended, count = _ends_of(trials, fewest, begun, outward, allowed, limits)
    solved += count
    # An end that was still on its way may go on by twice as far again.
    own = np.arange(8), np.tile(np.arange(4), 2)
    moved = np.array([2.0 * np.abs(one - first)[own] for one, first in zip(ends, begun, strict=True)])
    doubt = np.maximum(np.where(ended, 0.0, moved).max(axis=0).reshape(2, 4), _WITHIN * unit)
    p, left, best, count = _fewest(trials, p, left, allowed, limits, like)
    solved += count
    each = [np.concatenate([one, p[[best]]]) for one in ends]
    each = [np.concatenate([some, _mirrored(some)]) if like else some for some in each]
    low, high = (np.array([of(some, axis=0) for some in each]) for of in (np.min, np.max))
    differ = np.array([np.ptp(low, axis=0), np.ptp(high, axis=0)])
    error = np.maximum(np.maximum(doubt, _mirrored(doubt)) if like else doubt, differ)
    return _Choice(p[best], float(left[best]), np.array([low.min(axis=0), high.max(axis=0)]), error), solved


def _fewest(
    trials: Trials, p: Floats, left: Floats, allowed: float, limits: Limits, like: bool
) -> tuple[Floats, Floats, int, int]:  # fmt: skip
    """Of reliefs led to the least removal, and what they leave, that with the least: its number; and evaluations."""
    count, removal = 0, p / limits.unit @ _RULE
    if (removal < removal.min() + _EQUAL).sum() == 1:
        # Once more from the best, with a new region of trust: where two extremes change places a first ends too early.
        more, its_left, _, count = refine(trials, p[[removal.argmin()]], limits, Aim(_RULE[None], allowed))
        p, left = np.concatenate([p, more]), np.append(left, its_left)
        removal = p / limits.unit @ _RULE
    p = _driver_deeper(p) if like else p
    return p, left, int(np.where(removal < removal.min() + _EQUAL, p[:, 0], -np.inf).argmax()), count


def _of_every_region(begun: list[Floats], known: Floats, outward: Floats, unit: Floats) -> list[Floats]:
    """Let both searches of an end begin in a region of equals that lies far out, though one half has missed it.

    What the halves differ by is doubt about how far a region goes; whether a region was in both is chance, which
    round-off decides. Where others are known there, the one that had missed it begins from another of them.

    Parameters
    ----------
    begun : list of two ndarray, shapes (8, 4)
        Farthest out of either half, by direction.
    known : ndarray, shape (B, 4)
        Of both halves.
    outward : ndarray, shape (8, 4)
    unit : ndarray, shape (4,)
    """
    far = known / unit @ outward.T
    reached = [np.einsum("dk,dk->d", one / unit, outward) for one in begun]
    mended = [one.copy() for one in begun]
    for direction in np.flatnonzero(np.abs(reached[0] - reached[1]) > _REGION):
        behind = int(reached[0][direction] > reached[1][direction])
        in_front = reached[1 - behind][direction]
        there = np.flatnonzero(far[:, direction] > in_front - 0.5 * _REGION)
        mended[behind][direction] = known[there[far[there, direction].argmin()]]
    return mended


def _ends_of(
    trials: Trials, fewest: Floats, begun: list[Floats], outward: Floats, allowed: float, limits: Limits
) -> tuple[Floats, Floats, Floats, Mask, int]:
    """Lead reliefs to the least removal, and others outward.

    Returns
    -------
    p, left : ndarray, shapes (B, 4), (B,)
        Of those with the least removal, and what they leave [m].
    ends, ended : ndarray, shapes (2, 8, 4), (2, 8)
        Of both halves of the others, and whether they came to an end.
    evaluations : int
    """
    several, solved, many = trials.loads.size > 1, 0, fewest.shape[0]
    inward, away = np.tile(_RULE, (many, 1)), np.concatenate([-outward, -outward])
    ends = np.concatenate(begun)
    if not several:
        p, left, ended, solved = refine(
            trials, np.concatenate([fewest, ends]), limits, Aim(np.concatenate([inward, away]), allowed)
        )
        return p[:many], left[:many], p[many:].reshape(2, 8, 4), ended[many:].reshape(2, 8), solved
    p, left, _, solved = refine(trials, fewest, limits, Aim(inward, allowed))
    ends, _, count = descend(trials.exact, trials, ends, limits, *_OUTWARD, Aim(away, allowed))
    ends, _, ended, last = refine(trials, ends, limits, Aim(away, allowed), _LAST)
    return p, left, ends.reshape(2, 8, 4), ended.reshape(2, 8), solved + count + last


def _set_up(engagement: Engagement, positions: int, loads: int) -> Bench:
    """Set up at even positions, or at Gauss points, fewer of these for several loads."""
    if positions:
        return even_bench(engagement, positions)
    return bench(engagement) if loads == 1 else bench(engagement, 8, 10)
