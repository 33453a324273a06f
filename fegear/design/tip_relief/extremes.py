"""Largest and least transmission errors between roll positions, found where they are: each tip relief has its own.

Pairs part and touch between positions, a straight relief starts there, and curves turn. At what lies between, all that
load sharing needs of a pair is taken from cubics through the four positions about it, and the load is shared exactly
by the pairs that bear there. How far a pair that is off lies from touching is a smooth function of the roll position:
Newton's method finds its root, of load and place at once.

Every extreme moves with the relief. A turn and a kink of pairs, from which the error falls to both sides, change as if
they stayed, with those weights of the pairs at which the error has no slope (envelope theorem); the start of a relief
takes its place along.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Floats, Index, Mask
from fegear.contact.plane.coupled_teeth import PairMatrices
from fegear.contact.plane.edge_law import EdgeContacts
from fegear.design.relief_bench import Bench
from fegear.design.tip_relief.between_positions import Bends, HandOver, Places, State, solved
from fegear.design.tip_relief.kinks import Kinks, Positions
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import roll_of_radius

#: Steps of Newton's method for loads at a place, for loads and the place where pairs part, and where a curve turns.
_STEPS, _STEPS_OF_PLACE, _STEPS_OF_TURN = 1, 3, 3
#: Share of the load at which a pair that only just bears is judged: its law has an infinite slope at none.
_JUST = 1e-4
#: A relief shallower than this, over its amount, has not begun.
_NONE = 1e-11
#: Tips farther than so many half-widths do not matter to a contact.
_FAR = -1e3


def removed(depths: Floats, p: Floats, power: float) -> tuple[Floats, Floats]:
    """Removal at depths, and its derivatives by the numbers.

    Parameters
    ----------
    depths : ndarray, shape (2, ...)
        Distance from the tips of driver and driven gear over the path.
    p : ndarray, shape (4, ...)
        Broadcast with the depths of one gear.
    power : float

    Returns
    -------
    removal, slope : ndarray, shapes (...), (4, ...)
    """
    total, slopes = 0.0, []
    for gear in (0, 1):
        amount, length = p[2 * gear], p[2 * gear + 1]
        depth = depths[gear] / length
        s = np.maximum(1.0 - depth, 0.0)
        form = s if power == 1.0 else s * s
        rise = np.where(s > _NONE, depth, 0.0) if power == 1.0 else 2.0 * s * depth
        slopes += [form, rise * (amount / length)]
        total = total + amount * form
    return np.asarray(total), np.stack(np.broadcast_arrays(*slopes))


@dataclass(frozen=True)
class Between:
    """A pair between the roll positions of a bench.

    Parameters
    ----------
    bench : Bench
    positions : Positions
    depths : ndarray, shape (2, n, P)
        Distance of the contacts from the tips of driver and driven gear over the path.
    totals : ndarray, shape (L,)
        Loads [N].
    power : float
        1 for straight, 2 for parabolic relief.
    """

    bench: Bench
    positions: Positions
    depths: Floats
    totals: Floats
    power: float

    @cached_property
    def _known(self) -> Array:
        """Compliances, gaps, depths and edges at the positions, shape (n n + 6 n, P)."""
        grid = self.bench.grid
        n = self.depths.shape[1]
        edges = grid.matrices.law.edges or EdgeContacts.none(self.depths.shape[1:])
        parts = [
            grid.matrices.compliance.reshape(n * n, -1),
            np.where(grid.contacts.present, grid.contacts.gap, 0.0),
            *self.depths,
            *(np.maximum(edges.tilt, _FAR), edges.wedge, edges.room),
        ]
        return np.concatenate(parts)

    @cached_property
    def _tips(self) -> list[float]:
        """Where driver and driven gear touch with their tips, maybe beyond the path [m]."""
        pair, found = self.bench.engagement.pair, []
        for member in MEMBERS:
            gear = pair.gear(member)
            found.append(float(pair.x_of_roll(roll_of_radius(gear, gear.involute_tip_radius), member)))
        return found

    @cached_property
    def _first(self) -> Index:
        """First of the four positions about every interval, shape (P - 1,); -1 where there are none."""
        breaks, x = self.bench.points.breaks, self.positions.x
        across = np.searchsorted(breaks, x[1:]) > np.searchsorted(breaks, x[:-1])
        ends = np.flatnonzero(np.append(across | ~self.positions.whole, True)) + 1
        starts = np.append(0, ends[:-1])
        first = np.full(self.positions.x.size - 1, -1)
        for start, end in zip(starts, ends, strict=True):
            if end - start >= 4:
                first[start : end - 1] = np.clip(np.arange(start, end - 1) - 1, start, end - 4)
        return first

    def _interpolated(self, at: Places) -> tuple[Array, Array]:
        """All that is known, and its slopes, at places: shape (R, K) each."""
        nodes = self._first[at.where[1], None] + np.arange(4)
        to = at.x[:, None] - self.positions.x[nodes]
        value, slope = np.ones(nodes.shape), np.zeros(nodes.shape)
        for k in range(4):
            for other in range(4):
                if other != k:
                    width = to[:, other] - to[:, k]
                    slope[:, k] = (slope[:, k] * to[:, other] + value[:, k]) / width
                    value[:, k] *= to[:, other] / width
        known = self._known[:, nodes]
        found: tuple[Array, Array] = np.einsum("rkq,kq->rk", known, value), np.einsum("rkq,kq->rk", known, slope)
        return found

    def _step(self, at: Places, p: Floats) -> State:
        """One step of Newton's method for the loads."""
        n, count = at.on.shape
        known, rising = self._interpolated(at)
        parts = [n * n, n * n + n, *(n * n + i * n for i in (3, 4, 5))]
        c, gap, depths, tilt, wedge, room = np.split(known, parts)
        c_rise, gap_rise, depth_rise, tilt_rise, _, room_rise = np.split(rising, parts)
        c, c_rise = c.reshape(n, n, count), c_rise.reshape(n, n, count)
        depths, depth_rise = depths.reshape(2, n, count), depth_rise.reshape(2, n, count)
        law = self.bench.grid.matrices.law
        number, _, load = at.where
        edges = EdgeContacts(tilt, wedge, room) if law.edges else None
        m = PairMatrices(c, replace(law.at(at.where[1]), edges=edges))
        numbers = p[number].T[:, None]
        removal, by_number = removed(depths, numbers, self.power)
        w = np.where(at.on, at.loads, 0.0)
        tangent, secant = m.tangent(w[..., None])[..., 0], m.at_load(w[..., None])[..., 0]
        e = gap + removal
        y, q = solved(tangent, at.on, np.ones_like(w), e + np.einsum("ijk,jk->ik", secant - tangent, w))
        error = (self.totals[load] + q.sum(axis=0)) / y.sum(axis=0)
        loads = error * y - q
        tangent = m.tangent(np.maximum(loads, np.where(at.on, 0.0, _JUST * self.totals[load]))[..., None])[..., 0]
        rises = np.einsum("ijk,jk->ik", c_rise, loads) + gap_rise
        if edges is not None:
            rises += m.law.rise(loads, tilt_rise, room_rise)
        slopes = np.array([
            -numbers[2 * g] / numbers[2 * g + 1] * depth_rise[g]
            * (np.where(1.0 - depths[g] / numbers[2 * g + 1] > _NONE, 1.0, 0.0) if self.power == 1.0
               else 2.0 * np.maximum(1.0 - depths[g] / numbers[2 * g + 1], 0.0))
            for g in (0, 1)
        ])  # fmt: skip
        rises += slopes.sum(axis=0)
        y, q = solved(tangent, at.on, np.ones_like(w), rises)
        weight = y / y.sum(axis=0)
        rise = (weight * rises).sum(axis=0)
        turned = rise * y - q
        off = np.einsum("ijk,jk->ik", c, loads) + e - error
        off_rise = np.einsum("ijk,jk->ik", c, turned) + rises - rise
        return State(loads, weight, error, rise, rises, by_number, off, off_rise, depth_rise, tangent)

    def state(self, at: Places, p: Floats) -> State:
        """Exact load sharing of the pairs that bear."""
        found = self._step(at, p)
        for _ in range(_STEPS):
            found = self._step(replace(at, loads=found.loads), p)
        return found

    def _handing_over(self, on: Mask, loads: Floats, p: Floats) -> HandOver:
        """Where pairs part or touch."""
        differs = (on[:, :, 1:] != on[:, :, :-1]) & (self._first >= 0)[:, None]
        j, *where = np.nonzero(differs)
        c, i, load = where
        both = on[:, c, i, load] & on[:, c, i + 1, load]
        some, k = both.any(axis=0), np.arange(j.size)
        if not some.all():
            j, both, where = j[some], both[:, some], [part[some] for part in where]
            (c, i, load), k = where, np.arange(j.size)
        low, high = self.positions.x[i], self.positions.x[i + 1]
        leaves = on[j, c, i, load]
        at = Places(0.5 * (low + high), np.array(where), both, np.where(both, loads[:, c, i, load], 0.0))
        for _ in range(_STEPS_OF_PLACE):
            found = self._step(at, p)
            off, rise = found.off[j, k], found.off_rise[j, k]
            to = at.x - off / np.where(rise == 0.0, 1.0, rise)
            at = replace(at, x=np.clip(to, low, high), loads=found.loads)
        found = self._step(at, p)
        just = at.on.copy()
        just[j, k] = True
        (y,) = solved(found.tangent, just, np.ones_like(found.loads))
        return HandOver(at, found, j, leaves, y / y.sum(axis=0))

    def _starting(
        self, on: Mask, loads: Floats, p: Floats, hand_over: Floats
    ) -> tuple[Places, State, Index, Floats, Bends]:
        """At starts of straight reliefs: places, load sharing there, gear, slopes by the numbers, and what bends."""
        pair = self.bench.engagement.pair
        count, loaded = p.shape[0], self.totals.size
        path = pair.path_length
        to = np.array(
            [tip + sign * p[:, k] * path for tip, sign, k in zip(self._tips, (-1.0, 1.0), (1, 3), strict=True)]
        )
        x = self.bench.engagement.meshing.reduced(to)
        i = np.clip(np.searchsorted(self.positions.x, x) - 1, 0, self.positions.x.size - 2)
        gear, c, load = (part.ravel() for part in np.indices((2, count, loaded)))
        number = np.round((to - x) / pair.base_pitch).astype(int) - self.bench.grid.contacts.number[0]
        x, i, j = x[gear, c], i[gear, c], number[gear, c]
        inside = (to >= pair.x_start) & (to <= pair.x_end)
        ok = (self._first[i] >= 0) & inside[gear, c] & (j >= 0) & (j < on.shape[0])
        gear, c, load, x, i, j = (part[ok] for part in (gear, c, load, x, i, j))
        side = i + (x > hand_over[c, i, load])
        at = Places(x, np.array([c, i, load]), on[:, c, side, load], loads[:, c, side, load])
        found, k = self.state(at, p), np.arange(x.size)
        slopes = found.slope()
        outward = np.where(gear == 0, -1.0, 1.0)
        slopes[k, 2 * gear + 1] += found.rise * outward * path
        by_amount = found.weight[j, k] * np.abs(found.depth_rise[gear, j, k]) / p[c, 2 * gear + 1]
        bend = by_amount * p[c, 2 * gear]
        moved, grown = np.zeros((x.size, 4)), np.zeros((x.size, 4))
        moved[k, 2 * gear + 1] = outward * path
        grown[k, 2 * gear], grown[k, 2 * gear + 1] = by_amount, -bend / p[c, 2 * gear + 1]
        return at, found, gear, slopes, Bends(x, bend, at.where, moved, grown)

    def _turning(
        self, te: Floats, on: Mask, loads: Floats, p: Floats, kinks: tuple[Mask, Mask], kinked: Mask
    ) -> tuple[Kinks, Mask]:
        """Where curves turn, and whether downward; where there is no peak, or trough, of the kinks."""
        rise = np.diff(te, axis=1)
        inside = ((self._first[1:] >= 0) & (self._first[:-1] >= 0))[:, None]
        before, after = rise[:, :-1], rise[:, 1:]
        down, up = (
            (sign * before > 0.0) & (sign * after < 0.0) & inside & ~one[:, :-1] & ~one[:, 1:]
            for sign, one in zip((1.0, -1.0), kinks, strict=True)
        )
        c, i, load = np.nonzero(down | up)
        sign = np.where(down[c, i, load], 1.0, -1.0)
        i += 1
        at = Places(self.positions.x[i], np.array([c, i, load]), on[:, c, i, load], loads[:, c, i, load])
        slope = self._step(at, p).rise
        ahead = sign * slope > 0.0
        # The curve bends as it does on that side on which it has no kink.
        width = self.positions.width
        own, other = np.where(ahead, i, i - 1), np.where(ahead, i - 1, i)
        of = np.where(kinked[c, own, load], other, own)
        h = np.where(of == i, width[of], -width[of])
        to = np.where(of == i, i + 1, i - 1)
        bend = (te[c, to, load] - te[c, i, load] - slope * h) / h**2
        smooth = (sign * bend < 0.0) & ~kinked[c, of, load]
        step = np.where(smooth, -0.5 * slope / np.where(smooth, bend, 1.0), 0.0)
        ends = np.sort([at.x, at.x + np.where(ahead, 1.0, -1.0) * width[own]], axis=0)
        last, its_rise = at.x, slope
        at = replace(at, x=np.clip(at.x + step, *ends), where=np.array([c, own, load]))
        found = self._step(at, p)
        for _ in range(_STEPS_OF_TURN):
            bend = (found.rise - its_rise) / np.where(at.x == last, 1.0, at.x - last)
            moved = at.x - np.where(sign * bend < 0.0, found.rise / np.where(bend == 0.0, 1.0, bend), 0.0)
            last, its_rise = at.x, found.rise
            at = replace(at, x=np.clip(moved, *ends), loads=found.loads)
            found = self._step(at, p)
        better = smooth & (sign * (found.error - te[c, i, load]) >= 0.0) & (found.loads >= 0.0).all(axis=0)
        return Kinks(at.where, found.error, found.slope()).of(better), sign[better] > 0.0

    def extremes(self, p: Floats, te: Floats, loads: Floats) -> tuple[Kinks, Kinks, Kinks, Floats, Floats]:
        """Peaks and troughs between positions, and what stands where straight reliefs start.

        Parameters
        ----------
        p : ndarray, shape (C, 4)
        te : ndarray, shape (C, P, L)
            Transmission errors at the positions [m].
        loads : ndarray, shape (n, C, P, L)
            Of the pairs [N].

        Returns
        -------
        peaks, troughs, kinks : Kinks
            Of the troughs those that are no start of a relief; the last are.
        starts, slopes : ndarray, shapes (C, 2, L), (C, 4, 2, L)
            Infinite where nothing is known, and without straight reliefs.
        """
        on = loads > 0.0
        count, positions, loaded = te.shape
        shape = (count, positions - 1, loaded)
        met = self._handing_over(on, loads, p)
        at, found = met.at, met.found
        peak, weight = met.peaks()
        peaked, kinked = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)
        peaked[tuple(at.where[:, peak])] = True
        kinked[tuple(at.where)] = True
        peaks = Kinks(at.where, found.error, found.slope(weight)).of(peak)
        starts, slopes = np.full((count, 2, loaded), np.inf), np.zeros((count, 4, 2, loaded))
        low = np.zeros(shape, dtype=bool)
        kinks = Kinks(np.zeros((3, 0), dtype=int), np.empty(0), np.empty((0, 4)))
        if self.power == 1.0:
            at, found, gear, by_number, bends = self._starting(on, loads, p, self._places(met, shape))
            c, _, load = at.where
            before = np.where(gear == 0, found.rise, found.rise - bends.jump)
            trough = (before < 0.0) & (before + bends.jump > 0.0)
            starts[c, gear, load], slopes[c, :, gear, load] = found.error, by_number
            kinks = Kinks(at.where, found.error, by_number).of(trough)
            low[tuple(kinks.where)] = True
            kinked[tuple(at.where)] = True
        turned, down = self._turning(te, on, loads, p, (peaked, low), kinked)
        troughs, turned = turned.of(~down), turned.of(down)
        peaks = Kinks(
            np.concatenate([peaks.where, turned.where], axis=1),
            np.concatenate([peaks.values, turned.values]),
            np.concatenate([peaks.slopes, turned.slopes]),
        )
        return peaks, troughs, kinks, starts, slopes

    @staticmethod
    def _places(met: HandOver, shape: tuple[int, ...]) -> Floats:
        """Where pairs part or touch in every interval, infinite where they do not."""
        hand_over = np.full(shape, np.inf)
        hand_over[tuple(met.at.where)] = met.at.x
        return hand_over

    def bends(self, p: Floats, loads: Floats) -> tuple[Bends, ...]:
        """Where the slope jumps within intervals: pairs part or touch, and straight reliefs start.

        Parameters
        ----------
        p : ndarray, shape (C, 4)
        loads : ndarray, shape (n, C, P, L)
            Of the pairs [N].
        """
        on = loads > 0.0
        met = self._handing_over(on, loads, p)
        if self.power != 1.0:
            return (met.bends(),)
        _, count, positions, loaded = loads.shape
        return met.bends(), self._starting(on, loads, p, self._places(met, (count, positions - 1, loaded)))[4]
