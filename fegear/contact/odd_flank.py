"""Flanks of single teeth that differ from the others: none at all, a lower tip, pits and spalls."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array


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
    """

    low: float
    high: float
    face_share: float = 1.0
    depth: float = 0.0

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
    """

    missing: bool = False
    tip_radius: float = math.nan
    pits: tuple[Pit, ...] = ()

    def gap(self, radius: Array) -> Array:
        """What pits over the whole face take off the flank at radii [m]."""
        whole = (np.where(pit.at(radius), pit.depth, 0.0) for pit in self.pits if pit.face_share >= 1.0)
        return np.max([np.zeros(radius.shape), *whole], axis=0)

    def bearing_share(self, radius: Array) -> Array:
        """Share of the face width that is left at radii."""
        part = (np.where(pit.at(radius), 1.0 - pit.face_share, 1.0) for pit in self.pits if pit.face_share < 1.0)
        return np.min([np.ones(radius.shape), *part], axis=0)
