"""The stroke of a loaded rack and pinion, put together from its base pitches, plane or with their width.

Base pitches whose teeth stand alike are solved once. Extremes over the stroke stand between roll positions; they are
looked for where the curves' sides would meet, as over a revolution of two gears
(`fegear.contact.between_positions`), and what is left of them is stated.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fegear.contact.between_positions import JUMP, between_positions

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Mapping

    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Index
    from fegear.contact.plane.compliance import Side

#: Rounds of looking for extremes between positions, and intervals in each for every curve.
_ROUNDS, _INTERVALS = 3, 2
#: Extremes are looked for this share of a base pitch from known positions, at least.
_APART = 1e-3
#: What is taken for an error of what half of the positions change of a mean: jumps that they widen are not smooth.
_OF_MEAN = 1.0
#: Extremes that may be higher by this share of a curve's largest value are looked for.
_WORTH = 1e-4


@dataclass(frozen=True)
class OnPitch:
    """Some positions of a base pitch; arrays of shape (P,).

    Parameters
    ----------
    roll : ndarray
        Of pair 0, ascending [m].
    error : ndarray
        Transmission error along the rack [m].
    pairs : ndarray of int
        In contact.
    share : ndarray
        Largest share of the load on one pair.
    pinion : mapping of {"tension", "compression"} to ndarray
        Largest root stress of the pinion [Pa].
    teeth : mapping of {"tension", "compression"} to mapping of int to ndarray
        The same of teeth of the rack, by their number less that of pair 0 [Pa].
    """

    roll: Array
    error: Array
    pairs: Index
    share: Array
    pinion: Mapping[Side, Array]
    teeth: Mapping[Side, Mapping[int, Array]]

    def tooth(self, side: Side, number: int) -> Array:
        """Root stress of a tooth by its number less that of pair 0; none where it feels no load [Pa]."""
        return self.teeth[side].get(number, np.zeros(self.roll.size))

    def joined(self, other: OnPitch) -> OnPitch:
        """With other positions of the same base pitch."""
        order = np.argsort(np.concatenate([self.roll, other.roll]), kind="stable")

        def both(one: NDArray[Any], more: NDArray[Any]) -> NDArray[Any]:
            return np.concatenate([one, more])[order]

        return OnPitch(
            both(self.roll, other.roll), both(self.error, other.error), both(self.pairs, other.pairs),
            both(self.share, other.share), {side: both(self.pinion[side], other.pinion[side]) for side in self.pinion},
            {
                side: {k: both(self.tooth(side, k), other.tooth(side, k)) for k in {*teeth, *other.teeth[side]}}
                for side, teeth in self.teeth.items()
            },
        )  # fmt: skip


class Beyond(NamedTuple):
    """What positions leave open: by how much extremes may lie beyond those known, as far as the curves' slopes tell.

    Parameters
    ----------
    mean : float
        What half of the positions change of the mean transmission error in the middle of the rack [m].
    largest, peak_to_peak : float
        Of the transmission error over the stroke, and in the middle of the rack [m].
    pinion, middle, rack : float
        Of the root tension of the pinion, the tooth in the middle of the rack, and all its teeth [Pa].
    """

    mean: float
    largest: float
    peak_to_peak: float
    pinion: float
    middle: float
    rack: float


@dataclass(frozen=True)
class Stroke:
    """A loaded rack and pinion over the stroke, C base pitches of P positions at most; arrays of shape (C, P).

    Parameters
    ----------
    travel : ndarray
        Of the rack from the first contact of its first tooth, ascending [m]; NaN where there is no position.
    error : ndarray
        Transmission error: travel of the rack that the load costs [m].
    pairs : ndarray of int
        In contact.
    largest_share : ndarray
        Of the load on one pair.
    pinion_tension, pinion_compression : ndarray
        Largest root tension and most negative compression of the pinion [Pa].
    rack_tension, rack_compression : ndarray, shape (teeth,)
        The same of each tooth of the rack over the stroke [Pa].
    tooth : ndarray, shape (C,)
        Tooth of pair 0.
    pitch : float
        Travel of the rack over a base pitch [m].
    beyond : Beyond
    added : mapping of int to ndarray
        Positions of pair 0 at which extremes were looked for, by the base pitch [m].
    """

    travel: Array
    error: Array
    pairs: Index
    largest_share: Array
    pinion_tension: Array
    pinion_compression: Array
    rack_tension: Array
    rack_compression: Array
    tooth: Index
    pitch: float
    beyond: Beyond
    added: Mapping[int, Array] = field(default_factory=dict)

    @property
    def middle(self) -> int:
        """The base pitch farthest from both ends of the rack, in contact throughout."""
        return middle_of(self.tooth, self.rack_tension.size)

    @property
    def mean_in_middle(self) -> float:
        """Mean transmission error over the base pitch in the middle [m]."""
        return _mean(*self._in_middle)

    @property
    def peak_to_peak_in_middle(self) -> float:
        """Largest less smallest transmission error there [m]."""
        return float(np.ptp(self._in_middle[1]))

    @property
    def _in_middle(self) -> tuple[Array, Array]:
        """Travel and transmission error over the base pitch in the middle, both its ends included, shape (N,) [m]."""
        there = ~np.isnan(self.travel)
        travel, error = self.travel[there], self.error[there]
        start = self.pitch * int(self.tooth[self.middle])
        return _within(travel, error, (start, start + self.pitch))


def middle_of(tooth: Index, count: int) -> int:
    """The base pitch farthest from both ends of a rack of `count` teeth, in contact throughout."""
    first, last = int(tooth[0]), int(tooth[-1])
    return min((first + last + 1) // 2, count - 1) - first


@dataclass(frozen=True)
class BasePitches:
    """The base pitches of a stroke, and how they are solved.

    Parameters
    ----------
    kinds : tuple
        How the teeth of base pitch c stand, equal for base pitches that are alike, shape (C,).
    solve : callable
        Solves some roll positions [m] of base pitch c; those at which no tooth is in contact are left out.
    roll : ndarray
        Positions of pair 0, ascending within a base pitch [m].
    teeth : int
        Of the rack.
    start, pitch, cos : float
        Of the path of contact [m], along the line of action [m], and of the pressure angle.
    """

    kinds: tuple[Hashable, ...]
    solve: Callable[[int, Array], OnPitch]
    roll: Array
    teeth: int
    start: float
    pitch: float
    cos: float

    def stroke(self, added: Mapping[int, Array] | None = None, done: Callable[[float], None] | None = None) -> Stroke:
        """Solve them all, and where extremes may stand between their positions.

        Parameters
        ----------
        added : mapping of int to ndarray, optional
            Positions besides `roll`, by the base pitch, where extremes of another solution stand [m]. Default: they are
            looked for.
        done : callable, optional
            Receives the fraction that is done.
        """
        first = {kind: c for c, kind in reversed(tuple(enumerate(self.kinds)))}
        known: dict[Hashable, OnPitch] = {}
        for n, (kind, c) in enumerate(sorted(first.items(), key=lambda one: one[1])):
            more = np.empty(0) if added is None else added.get(c, np.empty(0))
            known[kind] = self.solve(c, np.union1d(self.roll, more))
            if done is not None:
                done((n + 1) / len(first))
        found = dict(added or {})
        for turn in range(_ROUNDS + 1):
            wanted, beyond = self._likely([known[kind] for kind in self.kinds])
            if turn == _ROUNDS or added is not None:
                break
            new: dict[int, list[float]] = {}
            for c, roll in wanted:
                at = first[self.kinds[c]]
                others = np.array([*known[self.kinds[c]].roll, *new.get(at, [])])
                if np.abs(others - roll).min(initial=np.inf) > _APART * self.pitch:
                    new.setdefault(at, []).append(roll)
            if not new:
                break
            for c, places in new.items():
                found[c] = np.union1d(found.get(c, np.empty(0)), places)
                known[self.kinds[c]] = known[self.kinds[c]].joined(self.solve(c, np.sort(places)))
        return self._joined([known[kind] for kind in self.kinds], beyond, found)

    def _likely(self, every: list[OnPitch]) -> tuple[list[tuple[int, float]], Beyond]:
        """Base pitches and roll positions at which extremes are likely, and what may lie beyond those known."""
        way = np.concatenate([c * self.pitch + one.roll - self.start for c, one in enumerate(every)])
        error = np.concatenate([one.error for one in every])
        pinion = np.concatenate([one.pinion["tension"] for one in every])
        tension = [
            np.concatenate([one.tooth("tension", t - c) for c, one in enumerate(every)]) for t in range(self.teeth)
        ]
        middle = self.pitch * middle_of(np.arange(len(every)), self.teeth)
        within, throughout = (middle, middle + self.pitch), (-np.inf, np.inf)
        worst = int(np.argmax([one.max() for one in tension]))
        curves = [
            (error, throughout), (error, within), (-error, within), (pinion, throughout),
            (tension[(self.teeth - 1) // 2], throughout), (tension[worst], throughout),
        ]  # fmt: skip
        wanted, beyond = [], []
        for values, ends in curves:
            places, height = _likely_within(way, values, self.pitch, ends)
            beyond.append(max(float(height.max(initial=0.0)), 0.0))
            for n in np.argsort(-height, kind="stable")[:_INTERVALS]:
                if height[n] > _WORTH * np.abs(values).max():
                    wanted += [divmod(float(one), self.pitch) for one in places[n]]
        last = len(every) - 1
        at = [(min(max(int(c), 0), last), float(rest) + self.start) for c, rest in wanted]
        mean = _mean_left(*_within(way, error, within))
        return at, Beyond(mean, beyond[0], beyond[1] + beyond[2], *beyond[3:])

    def _joined(self, every: list[OnPitch], beyond: Beyond, added: Mapping[int, Array]) -> Stroke:
        shape = (len(every), max(one.roll.size for one in every))
        travel, error, share, tension, compression = (np.full(shape, np.nan) for _ in range(5))
        pairs = np.zeros(shape, dtype=np.int64)
        of_rack = np.zeros((2, self.teeth))
        for c, one in enumerate(every):
            here = slice(one.roll.size)
            travel[c, here] = (c * self.pitch + one.roll - self.start) / self.cos
            error[c, here], share[c, here], pairs[c, here] = one.error, one.share, one.pairs
            tension[c, here], compression[c, here] = one.pinion["tension"], one.pinion["compression"]
            for t in range(self.teeth):
                of_rack[0, t] = one.tooth("tension", t - c).max(initial=of_rack[0, t])
                of_rack[1, t] = one.tooth("compression", t - c).min(initial=of_rack[1, t])
        return Stroke(
            travel, error, pairs, share, tension, compression, of_rack[0], of_rack[1], np.arange(len(every)),
            self.pitch / self.cos, beyond, added,
        )  # fmt: skip


def _within(x: Array, values: Array, ends: tuple[float, float]) -> tuple[Array, Array]:
    """A curve between two places, both included."""
    at = np.array([ends[0], *x[(x > ends[0]) & (x < ends[1])], ends[1]])
    return at, np.interp(at, x, values)


def _mean(x: Array, values: Array) -> float:
    return float(np.trapezoid(values, x) / np.ptp(x))


def _mean_left(x: Array, values: Array) -> float:
    """What every second position changes of a mean, both ends kept."""
    fewer = [np.unique([0, *range(first, x.size, 2), x.size - 1]) for first in (1, 2)]
    return _OF_MEAN * max(abs(_mean(x[kept], values[kept]) - _mean(x, values)) for kept in fewer)


def _likely_within(way: Array, values: Array, pitch: float, ends: tuple[float, float]) -> tuple[Array, Array]:
    """Where the largest of a curve may stand within a part of it, shape (Q, 2), and by how much above all there, (Q,).

    A stroke does not repeat itself: from its end to its start a curve jumps.
    """
    inside = (way > ends[0] - JUMP * pitch) & (way < ends[1] + JUMP * pitch)
    places, height = between_positions(way, values, float(np.ptp(way)) + 0.5 * JUMP * pitch, pitch)
    there = ((places > ends[0]) & (places < ends[1])).all(axis=(1, 2))
    return places[there, 0], height[there, 0] + float(values.max() - values[inside].max())
