"""Flanks of single teeth that differ from the others: none at all, a lower tip, pits and spalls, another profile."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.geometry.relief import UNMODIFIED, Relief

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.geometry.pair import GearPair, Member
    from fegear.geometry.relief_spec import ReliefSpec


#: A part of a face as far below the rest as this share of its radius is out of reach of any load.
_DEEP = 1e-3


@dataclass(frozen=True)
class Pit:
    """Material that is gone from a flank between two radii.

    Parameters
    ----------
    low, high : float
        Radii [m].
    face_share : float
        Share of the face width over which it is gone, 0 to 1.
    depth : float
        Normal to the flank [m].
    face_position : float
        Of its middle, from the middle of the gear's face [m]: of teeth with a width.
    """

    low: float
    high: float
    face_share: float = 1.0
    depth: float = 0.0
    face_position: float = 0.0

    def at(self, radius: Array) -> Array:
        """Whether contacts at radii lie in it."""
        return np.asarray((radius >= self.low) & (radius <= self.high))


@dataclass(frozen=True)
class OddFlank:
    """The flank of one tooth.

    Parameters
    ----------
    missing : bool
        Whether there is none.
    tip_radius : float
        Where it ends [m]; NaN for the gear's tip circle.
    pits : tuple of Pit
    relief : Relief, optional
        Its profile modification in place of that of the gear.
    deviation : Relief
        Its profile deviation beside either.
    """

    missing: bool = False
    tip_radius: float = math.nan
    pits: tuple[Pit, ...] = ()
    relief: Relief | None = None
    deviation: Relief = UNMODIFIED

    @property
    def profiled(self) -> bool:
        """Whether its profile is another one."""
        return self.relief is not None or self.deviation != UNMODIFIED

    @property
    def kinks(self) -> tuple[float, ...]:
        """Roll angles at which its own profile has kinks [rad]."""
        return (*(() if self.relief is None else self.relief.kinks), *self.deviation.kinks)

    def as_the_others(self) -> OddFlank:
        """The same with the gear's profile."""
        return replace(self, relief=None, deviation=UNMODIFIED)

    def gap(self, radius: Array) -> Array:
        """What pits over the whole face take off the flank at radii [m]."""
        whole = (np.where(pit.at(radius), pit.depth, 0.0) for pit in self.pits if pit.face_share >= 1.0)
        return np.max([np.zeros(radius.shape), *whole], axis=0)

    def gap_over_face(self, radius: Array, z: Array, face_width: float) -> Array:
        """What is missing of the flank normal to it at radii and heights on the gear's own face [m].

        Infinite where nothing carries: of a missing tooth, and at pits over a part of the face that have no depth or
        one that no load closes.
        """
        if self.missing:
            return np.full(radius.shape, np.inf)
        found = np.zeros(radius.shape)
        for pit in self.pits:
            shallow = pit.face_share >= 1.0 or 0.0 < pit.depth < _DEEP * 0.5 * (pit.low + pit.high)
            depth = pit.depth if shallow else np.inf
            inside = np.abs(z - pit.face_position) <= 0.5 * pit.face_share * face_width * (1.0 + 1e-9)
            found = np.where(np.logical_and(pit.at(radius), inside), np.maximum(found, depth), found)
        return found

    def bearing_share(self, radius: Array) -> Array:
        """Share of the face width that is left at radii."""
        part = (np.where(pit.at(radius), 1.0 - pit.face_share, 1.0) for pit in self.pits if pit.face_share < 1.0)
        return np.min([np.ones(radius.shape), *part], axis=0)


@dataclass(frozen=True)
class ToothProfile:
    """The profile of one tooth as drawn or measured, which becomes curves in a pair.

    Parameters
    ----------
    relief : ReliefSpec, optional
        In place of that of the gear.
    deviation : ReliefSpec, optional
        Beside either.
    prefix : str
        Of keys in messages.
    """

    relief: ReliefSpec | None = None
    deviation: ReliefSpec | None = None
    prefix: str = ""

    @property
    def wants_delta(self) -> bool:
        """Whether an amount is given in Welbourn's Delta."""
        return self.relief is not None and self.relief.wants_delta

    def built_on(self, flank: OddFlank, pair: GearPair, member: Member, delta: float = math.nan) -> OddFlank:
        """A flank with this profile, of a gear of a pair; `delta` is Welbourn's [m].

        Raises
        ------
        InputError
            If it does not fit the gear.
        """
        found = []
        for key, spec in (("relief", self.relief), ("deviation", self.deviation)):
            try:
                found.append(None if spec is None else spec.built(pair, member, delta))
            except InputError as error:
                inside, point, rest = error.key.partition(".")
                named = key + point + rest if inside == "relief" else error.key
                raise error.under(self.prefix, {error.key: named}) from None
        relief, deviation = found
        return replace(flank, relief=relief, deviation=UNMODIFIED if deviation is None else deviation)


def odd_flanks(
    odd: Iterable[tuple[int, OddFlank]],
    profiles: Iterable[tuple[int, ToothProfile]],
    pair: GearPair,
    member: Member,
    delta: float = math.nan,
) -> dict[int, OddFlank]:
    """Flanks of single teeth of a gear of a pair with their profiles, by the number of the tooth in meshing order.

    Raises
    ------
    InputError
        If a profile does not fit the gear.
    """
    found = dict(odd)
    for tooth, profile in profiles:
        found[tooth] = profile.built_on(found.get(tooth, OddFlank()), pair, member, delta)
    return found
