"""How far the teeth of a mesh approach under any force, at places of the base pitch, and how exactly that is known.

The law is solved load sharing: with contact loss of every tooth pair, coupled teeth, corners and Hertzian contact at
the force that a planet really carries. Between forces at which it is solved it is straight: springs that only push.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from fegear.contact.plane.engagement import solve_again
from fegear.contact.plane.transmission_error import contact_changes
from fegear.fem.alike_teeth import together

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement
    from fegear.dynamics.train.excitation import MeshExcitation

#: Forces at which a law is solved, over that of an equal share; those above the number of planets are not needed.
_LEVELS = (0.001, 0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0, 1.15, 1.35, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0, 7.0, 10.0, 20.0)
#: A spring that adds less than this share of the stiffness of all is none.
_NOTHING = 1e-12
#: What springs have at every place.
_OF_PLACES = ("stiffness", "separation", "bent")


class MeshSprings(NamedTuple):
    """One-sided springs of a mesh at Q places of its base pitch, L of them.

    Attributes
    ----------
    stiffness, separation : ndarray, shape (Q, L)
        [N/m], [m]
    level : ndarray, shape (L,)
        Force at which each spring begins to bear, where all places have one [N]; else infinite after the first.
    off : ndarray, shape (K, Q)
        How far the approach under the mean force is off by each of K errors [m].
    bent : ndarray, shape (Q, L)
        How far the law is off half-way between the force at which a spring begins to bear and that of the next [m].
    """

    stiffness: Array
    separation: Array
    level: Array
    off: Array
    bent: Array


class MeshTeeth(Protocol):
    """Teeth of a mesh as springs over the base pitch."""

    @property
    def cycles(self) -> int:
        """Base pitches after which teeth that differ meet again; 1 where all are alike."""

    @property
    def breaks(self) -> Array:
        """Places of jumps and kinks [base pitches]."""

    def at(self, place: Array) -> MeshSprings:
        """Springs at places [base pitches from the pitch point], shape (Q,)."""


@dataclass(frozen=True)
class SlotSprings:
    """Teeth whose springs are functions of the place: those of `MeshExcitation`, taken as exact."""

    teeth: MeshExcitation

    @property
    def cycles(self) -> int:
        """All base pitches are the same."""
        return 1

    @property
    def breaks(self) -> Array:
        """Places of jumps and kinks [base pitches]."""
        parts = (*self.teeth.stiffness, *self.teeth.separation)
        return np.asarray(np.concatenate([part.breaks for part in parts]) - self.teeth.phase)

    def at(self, place: Array) -> MeshSprings:
        """Springs at places [base pitches from the pitch point], shape (Q,)."""
        s = place + self.teeth.phase
        stiffness, separation = (
            np.array([part(s) for part in parts]).T for parts in (self.teeth.stiffness, self.teeth.separation)
        )
        level = np.where(np.arange(stiffness.shape[1]) == 0, 0.0, np.inf)
        return MeshSprings(stiffness, separation, level, np.zeros((0, place.size)), np.zeros_like(stiffness))


@dataclass(frozen=True)
class LawSprings:
    """Teeth whose load sharing is solved at every place and for forces up to that of all planets together.

    Parameters
    ----------
    engagement : Engagement
    shifted : tuple of Engagement
        The same with one compliance each off by its estimated error.
    load : float
        Mean mesh force: that of an equal share [N].
    planets : int
        Which may all come to rest on one.
    """

    engagement: Engagement
    shifted: tuple[Engagement, ...]
    load: float
    planets: int

    @property
    def cycles(self) -> int:
        """Base pitches after which teeth that differ meet again; 1 where all are alike."""
        return self.engagement.cycles

    @property
    def breaks(self) -> Array:
        """Places where tooth pairs enter, leave, come to bear or let go under the mean force [base pitches].

        In any base pitch: teeth that differ may do so in theirs only.
        """
        pitch = self.engagement.pair.base_pitch
        number = self.engagement.grid([self.engagement.pair.x_start]).contacts.number
        alike = together(self.engagement.teeth_in(number, cycle) for cycle in range(self.cycles))
        changes = [x for cycles in alike for x in contact_changes(self.engagement, self.load, int(cycles[0]))]
        return np.array([*self.engagement.breaks, *changes]) / pitch

    def at(self, place: Array) -> MeshSprings:
        """Springs at places [base pitches from the pitch point], shape (Q,); teeth 0 are there at place 0."""
        engagement, pitch = self.engagement, self.engagement.pair.base_pitch
        x = np.asarray(place) * pitch
        if self.cycles == 1:
            return self._in_cycle(x, 0)
        cycle = np.rint((x - engagement.meshing.reduced(x)) / pitch).astype(int)
        number = engagement.grid(x[:1]).contacts.number
        # base pitches with the same teeth, or with teeth that answer alike, are solved once
        seen, own = np.unique(cycle, return_inverse=True)
        alike = together(engagement.teeth_in(number, int(one)) for one in seen)
        parts: list[MeshSprings] = []
        order = np.empty(x.size, dtype=np.intp)
        done = 0
        for which in alike:
            at = np.flatnonzero(np.isin(own, which))
            inside, back = np.unique(np.round(x[at] / pitch - cycle[at], 12), return_inverse=True)
            parts.append(self._in_cycle(inside * pitch, int(seen[which[0]])))
            order[at] = done + back
            done += inside.size
        found = {key: np.concatenate([getattr(one, key) for one in parts]) for key in _OF_PLACES}
        off = np.concatenate([one.off for one in parts], axis=1)[:, order]
        return MeshSprings(level=parts[0].level, off=off, **{key: one[order] for key, one in found.items()})

    def _in_cycle(self, x: Array, cycle: int) -> MeshSprings:
        """Springs at roll positions [m] by the teeth of one base pitch."""
        force, at_mean = forces(self.load, self.planets)
        grid = self.engagement.grid(x, again=False)
        state = self.engagement.solve(grid, force, cycle)
        mean = state.transmission_error[:, at_mean]
        alone = self.engagement.solve(grid, force[at_mean : at_mean + 1], cycle)
        off = [solve_again(other, alone).transmission_error[:, 0] - mean for other in self.shifted]
        changes = np.array(off).reshape(len(self.shifted), x.size)
        return springs(force, state.transmission_error, state.local_stiffness[:, 0], changes)


@dataclass(frozen=True)
class WidenedSprings:
    """Teeth so many times as wide, under forces so many times as large: both halves of double helical gears.

    Parameters
    ----------
    teeth : MeshTeeth
        Of one half.
    ratio : float
    """

    teeth: MeshTeeth
    ratio: float

    @property
    def cycles(self) -> int:
        """Those of one half."""
        return self.teeth.cycles

    @property
    def breaks(self) -> Array:
        """Those of one half."""
        return self.teeth.breaks

    def at(self, place: Array) -> MeshSprings:
        """Springs at places [base pitches from the pitch point], shape (Q,)."""
        found = self.teeth.at(place)
        return found._replace(stiffness=self.ratio * found.stiffness, level=self.ratio * found.level)


def forces(load: float, planets: int) -> tuple[Array, int]:
    """Mesh forces at which a law is solved [N], ascending, and which of them is that of an equal share."""
    few = [one for one in _LEVELS if one <= planets] + [one for one in _LEVELS if one > planets][:1]
    return load * np.array(few), few.index(1.0)


def springs(force: Array, approach: Array, stiffness: Array, off: Array) -> MeshSprings:
    """Springs that together follow a law at Q places of the base pitch.

    Parameters
    ----------
    force : ndarray, shape (L,)
        At which the law is known [N], ascending.
    approach : ndarray, shape (Q, L)
        [m].
    stiffness : ndarray, shape (Q,)
        Slope of the law at the least force [N/m].
    off : ndarray, shape (K, Q)
        See `MeshSprings`.
    """
    first = approach[:, :1] - force[0] / stiffness[:, None]
    approach, force = np.hstack([first, approach]), np.append(0.0, force)
    slope = np.diff(force) / np.diff(approach, axis=1)
    added = np.diff(slope, axis=1, prepend=0.0)
    added = np.where(added > _NOTHING * slope[:, -1:], added, 0.0)  # teeth never soften: less is round-off
    return MeshSprings(added, approach[:, :-1], force[:-1], off, _bent(force, approach))


def _bent(force: Array, approach: Array) -> Array:
    """A law's miss between its forces: a quarter of that of the law with every other force, shape (Q, L)."""
    low, at, high = force[:-2], force[1:-1], force[2:]
    share = (at - low) / (high - low)
    chord = approach[:, :-2] * (1.0 - share) + approach[:, 2:] * share
    # of a parabola the miss goes with the square of the length of the chord
    curve = np.abs(approach[:, 1:-1] - chord) / ((at - low) * (high - at))
    length = 0.25 * np.diff(force) ** 2
    # a tooth pair that comes to bear between two forces bends the law at one end alone: both ends are added
    own = np.pad(curve, ((0, 0), (1, 0)), mode="edge") + np.pad(curve, ((0, 0), (0, 1)), mode="edge")
    return np.asarray(own * length)
