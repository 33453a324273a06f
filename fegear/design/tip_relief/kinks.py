"""Largest and least transmission errors between roll positions: at kinks that move with the reliefs tried.

A peak-to-peak value sits on kinks: it is largest where pairs part and touch, least where straight relief starts. Seen
at fixed positions only, what a relief leaves has a tooth at every position, and a descent ends in the first. So between
two positions the lines through their outer neighbours are continued to where they meet. What they meet at passes into
the value at a position as a kink moves past it: it is a continuous function of the relief, and has its derivatives from
load sharing alone, whatever its law.

Harmonics of a curve with kinks by quadrature that knows nothing of them: what that is off, in closed form.

Quadrature of a function whose slope jumps between its points is off by the jump times what it is off for one ramp that
starts there: of a ramp both the sum over the points and the integral are known. That is a smooth function of the place
but where it passes a point, and there it mends the corner that the sum has: harmonics become smooth functions of what
moves the kink, to the next order of the distance between points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Floats, Index, Mask
from fegear.contact.fourier import Panels

#: Neighbouring positions that are closer, over the period, stand on both sides of a change of pairs.
_CHANGE = 1e-6
#: A kink bends so many times as much as the curve about it.
_SHARP = 3.0
#: Flanks of a kink are followed this far at most, over the period.
_REACH = 0.1
#: Curves bend from one interval to the next by this part of a kink at most: more is another kink.
_CURVED = 0.15


@dataclass(frozen=True)
class Kinks:
    """Extremes found, K of them.

    Parameters
    ----------
    where : ndarray of int, shape (3, K)
        Candidate, position before the extreme, and load of each.
    values, slopes : ndarray, shapes (K,), (K, 4)
        [m] and their derivatives by the four numbers of a candidate.
    """

    where: Index
    values: Floats
    slopes: Floats

    def of(self, chosen: Mask) -> Kinks:
        """Some of them."""
        return Kinks(self.where[:, chosen], self.values[chosen], self.slopes[chosen])


class Sides(NamedTuple):
    """What lies before an interval and behind it, shape (P - 1,) each.

    Parameters
    ----------
    before, before_that, after, after_that : ndarray of int
        The nearest intervals and the next; itself where there is none.
    on_before, on_after : ndarray
        How far its middle is from the nearest's, over how far that is from the next's.
    """

    before: Index
    before_that: Index
    after: Index
    after_that: Index
    on_before: Floats
    on_after: Floats


def _continued(rises: Sequence[Floats], on: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Rises that curves from both sides have within an interval.

    Without the curvature a kink that passes a position would be lost while both lines miss it.

    Parameters
    ----------
    rises : sequence of ndarray
        In the nearest interval before it, the one before that, and the same behind it.
    on : sequence of ndarray
        `on_before` and `on_after` of `Sides`.
    """
    before, before_that, after, after_that = rises
    most = _CURVED * np.abs(before - after)
    return (
        before + np.clip(on[0] * (before - before_that), -most, most),
        after + np.clip(on[1] * (after - after_that), -most, most),
    )


def _continued_slopes(rises: Sequence[Floats], on: Sequence[Floats], turned: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Derivatives of `_continued`, shape (K, 4), of K rises and their derivatives, (K, 4)."""
    most = _CURVED * np.abs(rises[0] - rises[2])
    by_most = (_CURVED * np.sign(rises[0] - rises[2]))[:, None] * (turned[0] - turned[2])
    found = []
    for near, far, part in ((0, 1, on[0]), (2, 3, on[1])):
        bend = (part * (rises[near] - rises[far]))[:, None]
        straight = part[:, None] * (turned[near] - turned[far])
        found.append(turned[near] + np.where(np.abs(bend) <= most[:, None], straight, np.sign(bend) * by_most))
    return found[0], found[1]


@dataclass(frozen=True)
class Positions:
    """Roll positions at which the transmission error is known, with both sides of every change of pairs.

    Parameters
    ----------
    x : ndarray, shape (P,)
        In ascending order [m].
    period : float
        [m].
    pairs : ndarray of int, shape (P,)
        Pairs in reach.
    """

    x: Floats
    period: float
    pairs: Index

    @cached_property
    def width(self) -> Floats:
        """Of the intervals between positions, shape (P - 1,) [m]."""
        return np.diff(self.x)

    @cached_property
    def whole(self) -> Mask:
        """Which of the intervals are none between both sides of a change, shape (P - 1,)."""
        return np.asarray(self.width > _CHANGE * self.period)

    @cached_property
    def changes(self) -> tuple[tuple[int, int, int], ...]:
        """Position outside, position inside a change of pairs, where one more is in reach, and the way inward, +-1."""
        gaps = np.append(self.width, self.x[0] + self.period - self.x[-1])
        found = []
        for i in np.flatnonzero(gaps < _CHANGE * self.period):
            other = (int(i) + 1) % self.x.size
            if self.pairs[other] > self.pairs[i]:
                found.append((int(i), other, 1))
            elif self.pairs[other] < self.pairs[i]:
                found.append((other, int(i), -1))
        return tuple(found)

    @cached_property
    def _neighbours(self) -> tuple[Sides, Sides]:
        """Intervals on both sides of each: of troughs; of peaks, also across a change where a pair more comes in."""
        own = np.arange(self.width.size)
        last = int(own[-1])
        whole = self.whole
        before = np.where(whole & np.roll(whole, 1) & (own > 0), own - 1, own)
        after = np.where(whole & np.roll(whole, -1) & (own < last), own + 1, own)
        across_before, across_after = before.copy(), after.copy()
        for outside, inside, way in self.changes:
            if way > 0 and inside <= last:  # no interval begins at the last position, none ends at the first
                across_before[inside] = (outside - 1) % (last + 1)
            elif way < 0 and inside > 0:
                across_after[inside - 1] = outside % (last + 1)
        troughs, peaks = (
            self._sides(
                left, np.where(left == own, own, before[left]), right, np.where(right == own, own, after[right])
            )
            for left, right in ((before, after), (across_before, across_after))
        )
        return troughs, peaks

    def _sides(self, before: Index, before_that: Index, after: Index, after_that: Index) -> Sides:
        middle = 0.5 * (self.x[1:] + self.x[:-1])
        parts = []
        for near, far in ((before, before_that), (after, after_that)):
            one, two = middle - middle[near], middle[near] - middle[far]
            one, two = (d - self.period * np.round(d / self.period) for d in (one, two))
            parts.append(one / np.where(far == near, np.inf, two))
        return Sides(before, before_that, after, after_that, *parts)

    def kinks(self, te: Floats, slope: Floats) -> tuple[Kinks, Kinks]:
        """Peaks and troughs between positions, where the curves continued from both sides meet.

        Parameters
        ----------
        te : ndarray, shape (C, P, L)
            Transmission errors of C candidates [m].
        slope : ndarray, shape (C, 4, P, L)
        """
        rise = np.diff(te, axis=1) / self.width[:, None]
        of_troughs, of_peaks = self._neighbours
        a, c = _continued([rise[:, at] for at in of_peaks[:4]], [part[:, None] for part in of_peaks[4:]])
        peaks = (a > 0.0) & (c < 0.0) & (a > rise) & (rise > c)
        a, c = _continued([rise[:, at] for at in of_troughs[:4]], [part[:, None] for part in of_troughs[4:]])
        troughs = (a < 0.0) & (c > 0.0) & (a < rise) & (rise < c)
        return (
            self._met(te, slope, rise, np.array(np.nonzero(peaks)), of_peaks),
            self._met(te, slope, rise, np.array(np.nonzero(troughs)), of_troughs),
        )

    def _met(self, te: Floats, slope: Floats, rise: Floats, where: Index, sides: Sides) -> Kinks:
        candidate, i, load = where
        around = [rise[candidate, at[i], load] for at in sides[:4]]
        turned = [self._turned(slope, candidate, at[i], load) for at in sides[:4]]
        on = [part[i] for part in sides[4:]]
        (a, c), (by_a, by_c) = _continued(around, on), _continued_slopes(around, on, turned)
        b, by_b = rise[candidate, i, load], self._turned(slope, candidate, i, load)
        part = (b - c) / (a - c)
        by_part = (by_b - by_c - part[:, None] * (by_a - by_c)) / (a - c)[:, None]
        moved = self.width[i, None] * (part[:, None] * by_a + a[:, None] * by_part)
        values = te[candidate, i, load] + self.width[i] * a * part
        return Kinks(where, values, slope[candidate, :, i, load] + moved)

    def _turned(self, slope: Floats, candidate: Index, at: Index, load: Index) -> Floats:
        """Derivatives of the rise in intervals, shape (K, 4)."""
        return np.asarray((slope[candidate, :, at + 1, load] - slope[candidate, :, at, load]) / self.width[at, None])

    def entering(self, te: Floats, slope: Floats) -> Kinks:
        """Peaks beyond changes of pairs, where the pair that comes in bears at once.

        Inside, such a peak would stand where that pair touches first. Beyond the change there is none, but a relief a
        little deeper brings it in: it must not be overlooked.
        """
        found = []
        for o, i, way in self.changes:
            spans = [(o - way, o), (o - 2 * way, o - way), (i, i + way), (i + way, i + 2 * way)]
            widths = [abs(self.x[j] - self.x[k]) for k, j in spans]
            around = [(te[:, j] - te[:, k]) / h for (k, j), h in zip(spans, widths, strict=True)]
            on = [np.array(widths[k] / (widths[k] + widths[k + 1])) for k in (0, 2)]
            a, b = _continued(around, on)
            step = te[:, i] - te[:, o]
            c, load = np.nonzero((a > 0.0) & (b < 0.0) & (step < 0.0))
            around = [one[c, load] for one in around]
            turned = [
                (slope[c, :, j, load] - slope[c, :, k, load]) / h for (k, j), h in zip(spans, widths, strict=True)
            ]
            on = [np.full(c.size, part) for part in on]
            (a, b), (by_a, by_b) = _continued(around, on), _continued_slopes(around, on, turned)
            step = step[c, load]
            by_step = slope[c, :, i, load] - slope[c, :, o, load]
            at = step / (a - b)
            by_at = (by_step - at[:, None] * (by_a - by_b)) / (a - b)[:, None]
            slopes = slope[c, :, o, load] + at[:, None] * by_a + a[:, None] * by_at
            found.append(Kinks(np.array([c, np.full_like(c, i), load]), te[c, o, load] + a * at, slopes))
        return Kinks(
            np.concatenate([np.zeros((3, 0), dtype=np.int64), *(one.where for one in found)], axis=1),
            np.concatenate([np.empty(0), *(one.values for one in found)]),
            np.concatenate([np.empty((0, 4)), *(one.slopes for one in found)]),
        )

    def flanks(self, te: Floats, kinks: Kinks, *, with_changes: bool) -> Mask:
        """Positions on the flanks of sharp kinks, shape (C, P, L): what they say ends where the kink moves past them.

        Of a peak the lower of two lines counts, and each goes on above the peak: a linear problem that holds the lines
        down there does not let the peak move farther than to the next position.

        Parameters
        ----------
        te : ndarray, shape (C, P, L)
        kinks : Kinks
            All of them peaks or all of them troughs.
        with_changes : bool
            Whether the inner sides of changes of pairs count too: the error there is never above that outside, and a
            peak may stand on the change.
        """
        count, positions, loads = te.shape
        rise = np.diff(te, axis=1)
        last = positions - 2
        candidate, i, load = kinks.where
        slopes = rise / self.width[:, None]
        outer = [slopes[candidate, np.clip(i + k, 0, last), load] for k in (-2, -1, 1, 2)]
        others = np.abs(outer[0] - outer[1]) + np.abs(outer[2] - outer[3])
        candidate, i, load = kinks.where[:, np.abs(outer[1] - outer[2]) > _SHARP * others]
        # The ends of the monotone run to both sides of every position.
        way = np.where(self.whole[:, None], np.sign(rise), 0.0)
        turns = np.ones((count, positions, loads), dtype=bool)
        turns[:, 1:-1] = way[:, 1:] != way[:, :-1]
        places = np.arange(positions)[:, None]
        right = np.minimum.accumulate(np.where(turns, places, positions)[:, ::-1], axis=1)[:, ::-1]
        left = np.maximum.accumulate(np.where(turns, places, -1), axis=1)
        far = round(_REACH * positions)
        edges = np.zeros((count, positions + 1, loads), dtype=np.int16)
        np.add.at(edges, (candidate, np.maximum(left[candidate, np.maximum(i - 1, 0), load], i - far), load), 1)
        ahead = np.minimum(i + 2, positions - 1)
        np.add.at(edges, (candidate, np.minimum(right[candidate, ahead, load], i + 1 + far) + 1, load), -1)
        for _, at, inward in self.changes if with_changes else ():
            if inward > 0:
                stop = np.where(way[:, at] < 0.0, np.minimum(right[:, at + 1], at + far), at)
                begin = np.full_like(stop, at)
            else:
                begin = np.where(way[:, at - 1] > 0.0, np.maximum(left[:, at - 1], at - far), at)
                stop = np.full_like(begin, at)
            c, j = np.indices(stop.shape)
            np.add.at(edges, (c, begin, j), 1)
            np.add.at(edges, (c, stop + 1, j), -1)
        return np.asarray(np.cumsum(edges, axis=1)[:, :-1] > 0)


@dataclass(frozen=True)
class KinkQuadrature:
    """Quadrature of cosine and sine parts of N harmonics.

    Parameters
    ----------
    points : Panels
        Points in ascending order over one period.
    kernel : ndarray, shape (P, 2 N)
        Weights that make the parts of values at the points: first those of cosines, then of sines.
    """

    points: Panels
    kernel: Floats

    @cached_property
    def _behind(self) -> tuple[Floats, Floats]:
        """Sums of weights, and of weights times place, over the points from each on, shape (P + 1, 2 N)."""
        end = np.zeros((1, self.kernel.shape[1]))
        from_end = self.points.x[:, None] - self.points.breaks[-1]
        sums = [np.cumsum(part[::-1], axis=0)[::-1] for part in (self.kernel, self.kernel * from_end)]
        return np.concatenate([sums[0], end]), np.concatenate([sums[1], end])

    def errors(self, x: Floats) -> tuple[Floats, Floats]:
        """What the parts of a ramp of slope one, from each place to the end of the period, are too large.

        Parameters
        ----------
        x : ndarray, shape (K,)
            Places of kinks within the period [m].

        Returns
        -------
        error, slope : ndarray, shape (K, 2 N)
            [m], and its derivative by the place.
        """
        period, end = self.points.period, self.points.breaks[-1]
        wave = 2.0 * math.pi / period * np.arange(1, self.kernel.shape[1] // 2 + 1)
        ramp = (end - x)[:, None]
        first, last = np.multiply.outer(x, wave), end * wave
        after = np.searchsorted(self.points.x, x)
        sums, moments = (part[after] for part in self._behind)
        # Integrals over the ramp of (x' - x) and of one, times cosine and sine of the waves.
        cosine = ramp * np.sin(last) / wave + (np.cos(last) - np.cos(first)) / wave**2
        sine = -ramp * np.cos(last) / wave + (np.sin(last) - np.sin(first)) / wave**2
        level = [(np.sin(last) - np.sin(first)) / wave, (np.cos(first) - np.cos(last)) / wave]
        exact, its_slope = (2.0 / period * np.concatenate(parts, axis=1) for parts in ([cosine, sine], level))
        return moments + sums * ramp - exact, its_slope - sums
