"""Floors of the valleys of tip reliefs, found the quick way: places from which descents start.

What tip reliefs leave hangs on their lengths more than on their amounts: one per cent of a length changes it by as much
as ten of the amount, and its valleys are as narrow. Of a grid that combination leaves least that happens to stand on
the floor of its valley, whichever valley is deeper. So every two amounts first get the lengths that go with them, the
amounts held. Floors vary slowly with the amounts, and the deepest are led on in all four numbers.

A step leads to the least of the largest deviations of straight transmission errors within a region of trust, by
Lawson's reweighted least squares: not quite there, but some hundred reliefs at a time.

J. R. Rice, K. H. Usow, The Lawson algorithm and extensions, Math. Comp. 22 (1968).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from fegear.base.arrays import Array, Mask
from fegear.design.flanks.forms import NUMBERS
from fegear.design.flanks.quick import QuickFlanks
from fegear.design.flanks.trials import FlankTrials

#: Amounts of each gear that are tried, from this share of the largest on; lengths that go with every two of them,
#: tried at every fourth roll position.
_AMOUNTS, _FIRST, _LENGTHS, _EVERY = 7, 0.07, 9, 4
#: Steps with the amounts held, of which after the first only so many are led on; floors that are led on with none held,
#: and in how many steps; by what at least two of them differ in some number, over it.
_HELD_STEPS, _KEPT, _LED, _FREE_STEPS, _ALIKE = 3, 240, 80, 4, 0.02
#: Parts of an amount and of a length by which the first step may change them, and how these grow and shrink; the share
#: of the box below which amounts count as that.
_TRUST, _GROWS, _SHRINKS, _TINY = (0.5, 0.3), 1.3, 0.4, 0.02
#: Reweightings of a step; what keeps its equations regular, over their trace.
_REWEIGHTED, _REGULAR = 15, 1e-9
#: Numbers in the compliances of reliefs that are loaded at a time.
_HELD = 4_000_000
#: Tips: amount and length of driver and driven gear.
_TIPS = 4


@dataclass(frozen=True)
class _Straight:
    """Transmission errors of C tip reliefs at P roll positions under K loads and misalignments.

    Parameters
    ----------
    te : ndarray, shape (C, P, K)
        [m].
    slope : ndarray, shape (C, P, K, 4)
        Growth by each number.
    left : ndarray, shape (C,)
        See `FlankTrials.value` [m].
    force : ndarray, shape (C, K, P, m)
        [N].
    """

    te: Array
    slope: Array
    left: Array
    force: Array

    def put(self, which: Mask, other: _Straight) -> None:
        """Take over some of another's."""
        for own, new in zip(vars(self).values(), vars(other).values(), strict=True):
            own[which] = new[which]


@dataclass(frozen=True)
class _QuickTips:
    """Tip reliefs by four numbers, many at a time; `at_loads`: the quick way about the forces of each load."""

    at_loads: Sequence[QuickFlanks]
    trials: FlankTrials

    def averaged(self, gap: Array) -> Array:
        """See `QuickFlanks.gaps`, which are alike under all loads."""
        return self.at_loads[0].gaps(gap)

    def cases(self) -> Iterator[tuple[QuickFlanks, float, Array]]:
        """Every load [N] and what there is besides under each misalignment, shape (P, m) [m]."""
        for i, (quick, load) in enumerate(zip(self.at_loads, self.trials.loads.tolist(), strict=True)):
            for one in self.averaged(self.trials.apart_under(i) + self.trials.deviations):
                yield quick, load, one

    def left(self, te: Array) -> Array:
        """What transmission errors of shape (C, P, K) leave, shape (C,) [m]."""
        ripple = np.ptp(te, axis=1).reshape(len(te), self.trials.loads.size, -1)
        return np.asarray((ripple @ self.trials.scatter.weights * self.trials.proportion).max(axis=1))

    def scale(self) -> Array:
        """By what the cases count beside each other, shape (K,)."""
        return np.repeat(self.trials.proportion, self.trials.scatter.weights.size)

    def gaps(self, tips: Array) -> Array:
        """Gaps by numbers of shape (C, 4), shape (C, P, m) [m]."""
        return np.stack([self.averaged(self.trials.gap(_nine(one))) for one in tips])

    def straight(self, tips: Array, near: _Straight | None = None) -> _Straight:
        """Transmission errors and their slopes by numbers of shape (C, 4); `near`: those of reliefs like these."""
        positions, stations = self.at_loads[0].present.shape
        step = max(1, _HELD // (positions * stations**2))
        parts = [slice(first, first + step) for first in range(0, len(tips), step)]
        some = [self._straight(tips[part], None if near is None else near.force[part]) for part in parts]
        return _Straight(
            *(np.concatenate(arrays) for arrays in zip(*(vars(one).values() for one in some), strict=True))
        )

    def _straight(self, tips: Array, near: Array | None) -> _Straight:
        present, forms = self.trials.known.lines.present, self.trials.forms
        grown = np.stack([
            self.averaged(np.where(present, forms.slopes(_nine(one))[:_TIPS], 0.0)) for one in tips
        ])  # fmt: skip
        gap = self.gaps(tips)
        errors, slopes, forces = [], [], []
        for k, (quick, load, apart) in enumerate(self.cases()):
            begun = None if near is None else near[:, k]
            approach, force, growth = quick.contact(gap + apart, load, near=begun)
            errors.append(approach)
            forces.append(force)
            slopes.append(np.einsum("cpm,cnpm->cpn", growth, grown))
        te = np.stack(errors, axis=2)
        return _Straight(te, np.stack(slopes, axis=2), self.left(te), np.stack(forces, axis=1))


def valley_floors(at_loads: Sequence[QuickFlanks], trials: FlankTrials, box: tuple[Array, Array]) -> list[Array]:
    """Tip reliefs on floors of valleys, those that leave least by the quick way first.

    Parameters
    ----------
    at_loads : sequence of QuickFlanks
        At the roll positions of `trials`, about the forces of each of its loads.
    trials : FlankTrials
    box : tuple of ndarray, shape (9,)
        Least and largest numbers.

    Returns
    -------
    list of ndarray, shape (9,)
    """
    low, high = (one[:_TIPS] for one in box)
    tips = _QuickTips(at_loads, trials)
    found, left = _led(tips, _scanned(tips, low, high), low, high, 1, held=True)
    found, left = _led(tips, found[np.argsort(left, kind="stable")[:_KEPT]], low, high, _HELD_STEPS - 1, held=True)
    found, left = _led(tips, _unlike(found, left, low, high)[:_LED], low, high, _FREE_STEPS)
    return [_nine(one) for one in _unlike(found, left, low, high)]


def _unlike(tips: Array, left: Array, low: Array, high: Array) -> Array:
    """Those of reliefs of shape (C, 4), the best first, that are not like one before them."""
    found: list[Array] = []
    places: list[Array] = []
    for i in np.argsort(left, kind="stable"):
        place = np.log(np.maximum(tips[i], _TINY * (high - low)))
        if all(np.abs(place - other).max() > _ALIKE for other in places):
            places.append(place)
            found.append(tips[i])
    return np.array(found)


def _nine(tips: Array) -> Array:
    """The nine numbers of tip reliefs only."""
    return np.append(tips, np.zeros(len(NUMBERS) - _TIPS))


def _scanned(tips: _QuickTips, low: Array, high: Array) -> Array:
    """For every two amounts and every length of either gear the best of the other's, on a grid, shape (C, 4)."""
    at = slice(_EVERY // 2, None, _EVERY)
    amounts = [np.geomspace(max(_FIRST * high[k], low[k]), high[k], _AMOUNTS) for k in (0, 2)]
    lengths = [np.geomspace(low[k], high[k], _LENGTHS if low[k] < high[k] else 1) for k in (1, 3)]
    first = tips.gaps(np.array([[1.0, one, 0.0, one] for one in lengths[0]]))[:, at]
    second = tips.gaps(np.array([[0.0, one, 1.0, one] for one in lengths[1]]))[:, at]
    cases = [(quick, load, apart[at]) for quick, load, apart in tips.cases()]
    found = []
    for a, b in product(*amounts):
        gap = (a * first[:, None] + b * second).reshape(-1, *first.shape[1:])
        te = np.stack([quick.contact(gap + apart, load, at)[0] for quick, load, apart in cases], axis=2)
        left = tips.left(te).reshape(len(first), len(second))
        best = {*enumerate(left.argmin(axis=1).tolist()), *((j, k) for k, j in enumerate(left.argmin(axis=0).tolist()))}
        found += [[a, lengths[0][j], b, lengths[1][k]] for j, k in sorted(best)]
    return np.array(found)


def _led(
    tips: _QuickTips, starts: Array, low: Array, high: Array, steps: int, *, held: bool = False
) -> tuple[Array, Array]:  # fmt: skip
    """Lead reliefs of shape (C, 4) down some steps, with their amounts held or not; these and what they leave."""
    at, here = starts.copy(), tips.straight(starts)
    trust = np.ones((len(at), 1))
    for _ in range(steps):
        new = _stepped(tips, here, at, trust, low, high, held=held)
        ahead = tips.straight(new, here)
        if not held:  # valleys are curved: back to the floor
            new = _stepped(tips, ahead, new, trust, low, high, held=True)
            ahead = tips.straight(new, ahead)
        better = ahead.left < here.left
        at[better] = new[better]
        here.put(better, ahead)
        trust = np.where(better[:, None], np.minimum(_GROWS * trust, 2.0), _SHRINKS * trust)
    return at, here.left


def _stepped(
    tips: _QuickTips, here: _Straight, at: Array, trust: Array, low: Array, high: Array, *, held: bool
) -> Array:  # fmt: skip
    """Reliefs a step ahead, shape (C, 4)."""
    part = np.array([0.0 if held else _TRUST[0], _TRUST[1]] * 2)
    size = trust * part * np.maximum(at, _TINY * (high - low))
    below, above = np.minimum(np.maximum(low - at, -size), 0.0), np.maximum(np.minimum(high - at, size), 0.0)
    return np.clip(at + _least(here, tips.scale(), below, above), low, high)


def _least(here: _Straight, scale: Array, below: Array, above: Array) -> Array:
    """Steps within bounds of shape (C, 4) that make the largest deviations of transmission errors least, nearly."""
    count, positions, cases = here.te.shape
    reach = np.maximum(np.maximum(above, -below), np.finfo(float).tiny)
    middle = 0.5 * (here.te.max(axis=1, keepdims=True) + here.te.min(axis=1, keepdims=True))
    off = (here.te - middle) * scale
    unit = np.abs(off).max(axis=(1, 2), keepdims=True) + np.finfo(float).tiny
    off = off / unit
    slope = here.slope * (scale[:, None] / unit[..., None]) * reach[:, None, None]
    low, high = below / reach, above / reach
    weight = np.full(off.shape, 1.0 / (positions * cases))
    least, found = np.full(count, np.inf), np.zeros((count, _TIPS))
    at = np.arange(_TIPS)
    for _ in range(_REWEIGHTED):
        total = weight.sum(axis=1, keepdims=True) + np.finfo(float).tiny
        r = off - (weight * off).sum(axis=1, keepdims=True) / total
        a = slope - (weight[..., None] * slope).sum(axis=1, keepdims=True) / total[..., None]
        flat = a.reshape(count, -1, _TIPS)
        heavy = (weight[..., None] * a).reshape(count, -1, _TIPS)
        normal = np.swapaxes(flat, 1, 2) @ heavy
        right = -np.einsum("cki,ck->ci", heavy, r.reshape(count, -1))
        normal[:, at, at] += _REGULAR * np.trace(normal, axis1=1, axis2=2)[:, None] + np.finfo(float).tiny
        step = _bounded(normal, right, low, high)
        deviation = off + np.einsum("cpkn,cn->cpk", slope, step)
        deviation = np.abs(deviation - (weight * deviation).sum(axis=1, keepdims=True) / total)
        largest = deviation.max(axis=(1, 2))
        better = largest < least
        least[better], found[better] = largest[better], step[better]
        weight = weight * deviation
        weight /= weight.sum(axis=(1, 2), keepdims=True) + np.finfo(float).tiny
    return found * reach


def _bounded(normal: Array, right: Array, low: Array, high: Array) -> Array:
    """Solutions of equations of shape (C, 4, 4) within bounds: what exceeds one stays there, and the rest goes on."""
    step = np.linalg.solve(normal, right[..., None])[..., 0]
    clipped = np.clip(step, low, high)
    stays = clipped != step
    if not stays.any():
        return np.asarray(step, dtype=float)
    free = np.where(stays[:, :, None] | stays[:, None, :], 0.0, normal)
    at = np.arange(normal.shape[1])
    free[:, at, at] += stays
    pushed = right - np.einsum("cij,cj->ci", normal, np.where(stays, clipped, 0.0))
    solved = np.linalg.solve(free, np.where(stays, clipped, pushed)[..., None])[..., 0]
    return np.asarray(np.clip(solved, low, high))
