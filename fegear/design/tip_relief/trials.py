"""A pair set up for trying tip reliefs: what four numbers leave, exactly or quickly, and how it changes with them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Floats, Index, Mask
from fegear.contact.plane.load_sharing import SharedLoad
from fegear.design.load_range import proportions
from fegear.design.quick_sharing import QuickSharing, quick_sharing
from fegear.design.relief_bench import Bench
from fegear.design.tip_relief.between_positions import Bends
from fegear.design.tip_relief.extremes import Between, removed
from fegear.design.tip_relief.kinks import KinkQuadrature, Positions
from fegear.geometry.relief import roll_of_radius

_HARMONICS = 12


@dataclass(frozen=True, slots=True)
class Tried:
    """What excites, of C candidates at each of L loads, and its derivatives by the four numbers.

    Parameters
    ----------
    seen : ndarray, shape (C, L, M)
        Transmission errors at and between roll positions, or cosine and sine parts of its harmonics [m], in
        proportion to the load at the largest.
    slope : ndarray, shape (C, 4, L, M)
        By amount and length of the driver's relief, then of the driven gear's.
    low : ndarray, shape (C, L, K)
        Approaches of every set of loaded pairs at the positions, and transmission errors where reliefs start [m]: a
        set that is hardly above the least now may be it a step further. Empty for harmonics.
    low_slope : ndarray, shape (C, 4, L, K)
    """

    seen: Floats
    slope: Floats
    low: Floats
    low_slope: Floats

    def of(self, chosen: Mask | slice) -> Tried:
        """Some of the candidates."""
        return Tried(self.seen[chosen], self.slope[chosen], self.low[chosen], self.low_slope[chosen])

    def where(self, better: Mask, other: Tried) -> Tried:
        """These where they are better, of others elsewhere."""
        c, k = better[:, None, None], better[:, None, None, None]
        return Tried(
            np.where(c, self.seen, other.seen), np.where(k, self.slope, other.slope),
            np.where(c, self.low, other.low), np.where(k, self.low_slope, other.low_slope),
        )  # fmt: skip

    def ahead(self, step: Floats) -> tuple[Floats, Floats]:
        """`seen` and `low` as linear functions at steps, shape (C, 4)."""
        out = []
        for base, slope in ((self.seen, self.slope), (self.low, self.low_slope)):
            out.append(base + (step[:, None] @ slope.reshape(*slope.shape[:2], -1)).reshape(base.shape))
        return out[0], out[1]


@dataclass(frozen=True)
class Trials:
    """A pair set up for trying tip reliefs under several loads.

    Candidates are p = (amount, length, amount, length): driver, then driven gear; amounts in [m], lengths over the
    path of contact.

    Parameters
    ----------
    bench : Bench
    loads : ndarray, shape (L,)
        [N].
    power : float
        1 for straight, 2 for parabolic relief.
    metric : str
        `effective_error` or `peak_to_peak`.
    weights : ndarray, shape (L,), optional
        What each load counts, positive; all the same by default.
    """

    bench: Bench
    loads: Floats
    power: float
    metric: str
    weights: Floats | None = None

    @cached_property
    def _counts(self) -> Floats:
        return proportions(self.loads, self.weights)

    @property
    def harmonics(self) -> int:
        """That the effective error is made of."""
        return _HARMONICS

    @cached_property
    def quick(self) -> QuickSharing:
        """For searching."""
        return quick_sharing(self.bench.grid, self.loads)

    @cached_property
    def _set_of(self) -> Index:
        """Number of the set from one pair to another, shape (n, n)."""
        n = self.bench.grid.contacts.x.shape[0]
        found = np.zeros((n, n), dtype=np.int64)
        for number, s in enumerate(self.quick.sets):
            found[s.pairs.start, s.pairs.stop - 1] = number
        return found

    @cached_property
    def _positions(self) -> Positions:
        points = self.bench.points
        return Positions(points.x, points.period, self.bench.grid.contacts.present.sum(axis=0))

    @cached_property
    def _between(self) -> Between:
        return Between(self.bench, self._positions, self._depths, self.loads, self.power)

    @cached_property
    def _depths(self) -> Floats:
        """Distance of each contact from the tips of both gears over the path, shape (2, n, P)."""
        pair, contacts = self.bench.engagement.pair, self.bench.grid.contacts
        found = []
        for gear, roll in ((pair.driver, contacts.roll_driver), (pair.driven, contacts.roll_driven)):
            tip = float(roll_of_radius(gear, gear.involute_tip_radius))
            found.append((tip - roll) * gear.base_radius / pair.path_length)
        return np.array(found)

    def form(self, gear: int, length: Floats) -> Floats:
        """Removal over its amount by one gear's relief of given lengths, shape (..., n, P)."""
        s = np.maximum(1.0 - self._depths[gear] / length[..., None, None], 0.0)
        return s if self.power == 1.0 else np.square(s, out=s)

    def _removed(self, p: Floats) -> tuple[Floats, Floats]:
        """Removal of candidates, shape (C, n, P) [m], and by the four numbers, (C, 4, n, P)."""
        total, slope = removed(self._depths[:, None], p.T[..., None, None], self.power)
        return total, np.moveaxis(slope, 0, 1)

    @cached_property
    def _kernel(self) -> Floats:
        n, x = np.arange(1, _HARMONICS + 1), self.bench.points.x
        phase = 2.0 * math.pi / self.bench.points.period * np.multiply.outer(x, n)
        weighed = 2.0 * self.bench.points.weights[:, None] / self.bench.points.period
        return np.concatenate([weighed * np.cos(phase), weighed * np.sin(phase)], axis=1)

    def seen(self, zeta: Floats) -> Floats:
        """What the metric looks at, shape (..., L, M), of approaches (..., P, L) [m] in proportion to their loads."""
        te = np.ascontiguousarray(np.moveaxis(zeta, -1, -2))
        te = te @ self._kernel.astype(te.dtype) if self.metric == "effective_error" else te
        return te if self.loads.size == 1 else np.asarray(te * self._counts[:, None].astype(te.dtype))

    @cached_property
    def _of_kinks(self) -> KinkQuadrature:
        return KinkQuadrature(self.bench.points, self._kernel)

    def _corrected(self, parts: Floats, slopes: Floats, bends: Bends) -> None:
        """Take from harmonics, and their derivatives, what quadrature across kinks adds to them."""
        c, _, load = bends.where
        more, rise = self._of_kinks.errors(bends.x)
        moved = (
            bends.moved[:, :, None] * (bends.jump[:, None] * rise)[:, None] + bends.grown[:, :, None] * more[:, None]
        )
        part = self._counts[load]
        np.subtract.at(parts, (c, load), (part * bends.jump)[:, None] * more)
        np.subtract.at(np.moveaxis(slopes, 2, 1), (c, load), part[:, None, None] * moved)

    def left(self, seen: Floats, low: Floats | None = None) -> Floats:
        """Worst metric over the loads, shape (...) [m], of what it looks at, see `Tried`."""
        if self.metric == "peak_to_peak":
            values = seen.max(axis=-1) - (seen if low is None else low).min(axis=-1)
        else:
            square = seen[..., :_HARMONICS] ** 2 + seen[..., _HARMONICS:] ** 2
            values = np.sqrt(square[..., 0]) + np.sqrt(square.sum(axis=-1))
        return np.asarray(values.max(axis=-1))

    def tangent(self, tried: Tried, step: Floats) -> tuple[Floats, Floats]:
        """Worst metric over the loads steps, shape (C, 4), ahead, and its gradient: shapes (C,), (C, 4)."""
        seen, below = tried.ahead(step)
        slope, rows = tried.slope, np.arange(seen.shape[0])
        if self.metric == "peak_to_peak":
            high, low = seen.argmax(axis=-1), below.argmin(axis=-1)
            loads = np.arange(seen.shape[1])
            values = seen[rows[:, None], loads, high] - below[rows[:, None], loads, low]
            worst = values.argmax(axis=1)
            by_high = slope[rows, :, worst, high[rows, worst]]
            return values[rows, worst], by_high - tried.low_slope[rows, :, worst, low[rows, worst]]
        square = seen[..., :_HARMONICS] ** 2 + seen[..., _HARMONICS:] ** 2
        first, whole = np.sqrt(square[..., 0]), np.sqrt(square.sum(axis=-1))
        worst = (first + whole).argmax(axis=1)
        first, whole, parts = first[rows, worst], whole[rows, worst], seen[rows, worst]
        by_part = parts / np.maximum(whole, 1e-300)[:, None]
        by_part[:, ::_HARMONICS] += parts[:, ::_HARMONICS] / np.maximum(first, 1e-300)[:, None]
        return first + whole, (slope[rows, :, worst] @ by_part[:, :, None])[..., 0]

    def _by_set(self, removal: Floats) -> Floats:
        """Approach of every set of pairs by the quick sharing, shape (C, S, P, L), of removals (C, n, P)."""
        base, weight = self.quick.every_set
        states = np.repeat(removal, self.loads.size, axis=-1)
        found = base + np.einsum("sjn,cjn->csn", weight, states)
        return np.asarray(found.reshape(*found.shape[:2], -1, self.loads.size))

    def least(self, p: Floats) -> Floats:
        """What candidates (C, 4) leave by the quick sharing at the roll positions, shape (C,) [m]."""
        removal, _ = self._removed(p)
        return self.left(self.seen(self._by_set(removal).min(axis=1)))

    def rough(self, p: Floats) -> Tried:
        """By the quick sharing, of candidates (C, 4)."""
        removal, by_number = self._removed(p)
        by_set = self._by_set(removal)
        least = by_set.argmin(axis=1)
        zeta = np.take_along_axis(by_set, least[:, None], axis=1)[:, 0]
        states = np.arange(zeta[0].size).reshape(zeta.shape[1:])
        weight = np.moveaxis(self.quick.every_set[1][least, :, states], -1, 1)
        return self._tried(p, zeta, weight, by_number, by_set, least)

    def _tried(
        self, p: Floats, zeta: Floats, weight: Floats, by_number: Floats, by_set: Floats, loaded: Index,
        pairs: Floats | None = None,
    ) -> Tried:  # fmt: skip
        """Of approaches (C, P, L), slopes by removals (C, n, P, L) and by the numbers, all sets' and the loaded."""
        slope = np.einsum("cjpl,ckjp->ckpl", weight, by_number)
        if self.metric == "effective_error":
            parts, by_number = self.seen(zeta), self.seen(slope)
            if pairs is not None:
                for bends in self._between.bends(p, pairs):
                    self._corrected(parts, by_number, bends)
            return Tried(parts, by_number, parts[..., :0], by_number[..., :0])
        count, positions, loads = zeta.shape
        v = self.quick.every_set[1].reshape(by_set.shape[1], -1, positions, loads)
        slopes = np.einsum("sjpl,ckjp->ckspl", v, by_number)
        # The loaded set is made what was found. Another that would approach less by the straight laws is about to take
        # over: it counts from there on.
        least = loaded[:, None]
        by_set = zeta[:, None] + np.maximum(by_set - np.take_along_axis(by_set, least, axis=1), 0.0)
        np.put_along_axis(slopes, least[:, None], slope[:, :, None], axis=2)
        starts, by_start = zeta[:, :0], slope[:, :, :0]
        if pairs is None:
            peaks, troughs = self._positions.kinks(zeta, slope)
            sharp = troughs
        else:
            peaks, troughs, sharp, starts, by_start = self._between.extremes(p, zeta, pairs)
        high, by_high = zeta.copy(), slope.copy()
        high[self._positions.flanks(zeta, peaks, with_changes=True)] = -np.inf
        beside = self._positions.flanks(zeta, sharp, with_changes=False)
        by_set[np.broadcast_to(beside[:, None], by_set.shape)] = np.inf
        for found in (self._positions.entering(zeta, slope), peaks):
            c, i, load = found.where
            high[c, i, load], by_high[c, :, i, load] = found.values, found.slopes
        c, i, load = troughs.where
        s = least[c, 0, i, load]
        by_set[c, s, i, load], slopes[c, :, s, i, load] = troughs.values, troughs.slopes
        if self.power == 1.0:
            other, by_other = self._starting(p, zeta, slope, weight)
            high, by_high = np.concatenate([high, other], axis=1), np.concatenate([by_high, by_other], axis=2)
        low = np.concatenate([by_set.reshape(count, -1, loads), starts], axis=1)
        by_low = np.concatenate([slopes.reshape(count, 4, -1, loads), by_start], axis=2)
        return Tried(*(self.seen(part) for part in (high, by_high, low, by_low)))

    def _starting(self, p: Floats, zeta: Floats, slope: Floats, weight: Floats) -> tuple[Floats, Floats]:
        """Errors outside changes of pairs, shape (C, K, L), were a straight relief that starts there longer or shorter.

        Classic reliefs start where single contact begins, where the error is largest. On one side of that the relief
        does not count and on the other it does: both count, and a descent follows the ridge between them.
        """
        values, slopes = [zeta[:, :0]], [slope[:, :, :0]]
        present = self.bench.grid.contacts.present
        for at in {outside for outside, _, _ in self._positions.changes}:
            for gear in (0, 1):
                amount, length = p[:, 2 * gear], p[:, 2 * gear + 1]
                part = 1.0 - self._depths[gear, :, at] / length[:, None]
                j = np.where(present[:, at], np.abs(part), np.inf).argmin(axis=1)
                rows = np.arange(p.shape[0])
                part, share = part[rows, j], weight[rows, j, at]
                by = slope[:, :, at].copy()
                for number, change in (
                    (2 * gear, np.abs(part)),
                    (2 * gear + 1, np.sign(part) * amount * (1.0 - part) / length),
                ):
                    by[:, number] -= share * change[:, None]
                values.append((zeta[:, at] - share * (amount * np.abs(part))[:, None])[:, None])
                slopes.append(by[:, :, None])
        return np.concatenate(values, axis=1), np.concatenate(slopes, axis=2)

    def _shared(self, removal: Floats) -> SharedLoad:
        """Exact load sharing of removals (C, n, P), cases C times L."""
        contacts = self.bench.grid.contacts
        n, positions = contacts.x.shape
        shape = (n, positions, removal.shape[0], self.loads.size)
        added = np.broadcast_to(np.moveaxis(removal, 0, 2)[..., None], shape).reshape(n, positions, -1)
        e = np.where(contacts.present, contacts.gap, np.inf)[:, :, None] + added
        loads = np.tile(self.loads, removal.shape[0])
        return self.bench.grid.matrices.share(e, loads)

    def mean(self) -> float:
        """Mean transmission error of the unmodified pair over all loads, in proportion at the largest [m]."""
        zeta = self._shared(np.zeros((1, *self._depths.shape[1:]))).transmission_error
        return float((zeta / self.loads).mean() * self.loads.max())

    def exact(self, p: Floats) -> Tried:
        """By the exact load sharing, of candidates (C, 4)."""
        removal, by_number = self._removed(p)
        shared, m = self._shared(removal), self.bench.grid.matrices
        n, positions = shared.loads.shape[:2]
        active = shared.loads > 0.0
        tangent = np.where(active[:, None] & active, m.tangent(shared.loads), np.eye(n)[:, :, None, None])
        right = np.moveaxis(active.astype(float), 0, -1)[..., None]
        y = np.moveaxis(np.linalg.solve(np.moveaxis(tangent, (0, 1), (-2, -1)), right)[..., 0], -1, 0)
        weight = np.moveaxis((y / y.sum(axis=0)).reshape(n, positions, p.shape[0], -1), 2, 0)
        zeta = np.moveaxis(shared.transmission_error.reshape(positions, p.shape[0], -1), 1, 0)
        first, last = active.argmax(axis=0), n - 1 - active[::-1].argmax(axis=0)
        loaded = self._set_of[first, last].reshape(positions, p.shape[0], -1)
        by_set = self._by_set(removal)
        pairs = np.moveaxis(shared.loads.reshape(n, positions, p.shape[0], -1), 2, 1)
        return self._tried(p, zeta, weight, by_number, by_set, np.moveaxis(loaded, 1, 0), pairs)
