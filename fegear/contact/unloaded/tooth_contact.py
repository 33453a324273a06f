"""Tooth contact analysis: transmission error and contact of the gear set over a pitch (NASA TM-107451)."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.contact.unloaded.earliest import Earliest, earliest_contact
from fegear.contact.unloaded.extremes import Extreme, extremes
from fegear.contact.unloaded.pair import HelicalPair
from fegear.contact.unloaded.pair_contact import PairContact, describe, pair_contact, slope_of_error
from fegear.contact.unloaded.placement import Placement
from fegear.contact.unloaded.reach import Bound

#: Difference of transmission errors that counts as none [rad].
_TOGETHER = 1e-13


@dataclass(frozen=True, slots=True)
class MeshCycle(ReadOnlyArrays):
    """Transmission error of a helical drive over one cycle of meshing, and the contact that leads at each angle.

    Parameters
    ----------
    pair : HelicalPair
        The drive, with its errors and modification.
    phi_1 : ndarray, shape (n,)
        Pinion angles over one pitch [rad].
    error : ndarray, shape (n,)
        Transmission error of the gear set [rad]: that of the tooth pair that touches first.
    leader : ndarray of int, shape (n,)
        Number of that pair; pair k meets k pitches after pair 0.
    mesh : PairContact
        Contact of the leading pair at each angle (its phi_1 is the pair's own).
    """

    pair: HelicalPair
    phi_1: Array
    error: Array
    leader: NDArray[np.int_]
    mesh: PairContact

    def pieces(self) -> list[tuple[float, float, int, str, float]]:
        """Pieces of the cycle with one leading pair and one kind of contact.

        Returns
        -------
        list of (first phi_1, last phi_1, pair, kind, mean slope)
            Angles in rad, at grid points; the slope is the mean of the exact slopes.
        """
        kind, leader = self.mesh.kind, self.leader
        cuts = np.flatnonzero((kind[1:] != kind[:-1]) | (leader[1:] != leader[:-1])) + 1
        return [
            (
                float(self.phi_1[part[0]]), float(self.phi_1[part[-1]]), int(leader[part[0]]), str(kind[part[0]]),
                float(self.mesh.slope[part].mean()),
            )
            for part in np.split(np.arange(self.phi_1.size), cuts)
        ]  # fmt: skip


@dataclass(frozen=True, slots=True)
class ToothContact(MeshCycle):
    """A cycle of meshing with its extremes, and one tooth pair followed alone.

    Parameters
    ----------
    single : PairContact
        Contact of one pair alone, over the whole angle in which it can be in contact in the aligned drive.
    maximum, minimum : Extreme
        Extremes of the gear set's transmission error over the cycle, located independently of the grid.
    seconds : float
        Wall-clock time of the analysis.
    """

    single: PairContact
    maximum: Extreme
    minimum: Extreme
    seconds: float

    @property
    def peak_to_peak(self) -> float:
        """Variation of the gear set's transmission error over a cycle [rad]."""
        return self.maximum.value - self.minimum.value


def mesh_cycle(pair: HelicalPair, positions: int = 400, start: float | None = None) -> MeshCycle:
    """Transmission error at angles over one cycle of meshing: all tooth pairs in reach, the earliest contact wins.

    Parameters
    ----------
    pair : HelicalPair
    positions : int
        Pinion angles per cycle, at least 2.
    start : float, optional
        First pinion angle [rad]; by default the cycle is centred on the engagement of pair 0.

    Returns
    -------
    MeshCycle
    """
    if int(positions) != positions or positions < 2:
        raise InputError("positions", positions, "must be a whole number of at least 2")
    p = Placement.of(pair)
    pitch = pair.pinion.angular_pitch
    first = 0.5 * (sum(pair.engagement) - pitch) if start is None else float(start)
    phi_1 = first + pitch * np.arange(positions) / positions
    error, _, leader, found = _gear_set(pair, p, phi_1)
    return MeshCycle(pair, phi_1, error, leader, describe(pair, p, phi_1 - leader * pitch, found))


def tooth_contact(pair: HelicalPair, positions: int = 400, start: float | None = None) -> ToothContact:
    """Tooth contact analysis: `mesh_cycle`, its extremes, on which the positions have no influence, and one pair alone.

    Parameters
    ----------
    pair, positions, start
        As of `mesh_cycle`.

    Returns
    -------
    ToothContact
    """
    began = time.perf_counter()
    cycle = mesh_cycle(pair, positions, start)
    p, pitch = Placement.of(pair), pair.pinion.angular_pitch

    def evaluate(angle: Array) -> tuple[Array, ...]:
        value, slope, number, contact = _gear_set(pair, p, angle)
        first, second = contact.bounds.astype(float)
        return value, slope, (number * len(Bound) + first) * len(Bound) + second

    lowest, highest = extremes(evaluate, 0.5 * (sum(pair.engagement) - pitch), pitch)
    lo, hi = pair.engagement
    single = pair_contact(pair, np.linspace(lo, hi, positions))
    seconds = time.perf_counter() - began
    return ToothContact(
        pair, cycle.phi_1, cycle.error, cycle.leader, cycle.mesh, single, highest, lowest, seconds
    )  # fmt: skip


def _gear_set(pair: HelicalPair, p: Placement, phi_1: Array) -> tuple[Array, Array, NDArray[np.int_], Earliest]:
    """Transmission error, its slope, number of the leading pair and its contact at each angle."""
    pitch = pair.pinion.angular_pitch
    lo, hi = pair.engagement
    # Misalignment and modification let a pair touch somewhat before and after its nominal engagement.
    margin = 0.5 * pitch
    last = np.floor((phi_1 - lo + margin) / pitch).astype(int)
    count = math.floor((hi - lo + 2.0 * margin) / pitch) + 1
    numbers = last[None, :] - np.arange(count)[:, None]
    own = (phi_1[None, :] - numbers * pitch).ravel()
    found = earliest_contact(p, pair.flank, own)
    error = (found.phi_2 - p.ratio * own).reshape(numbers.shape)
    # Pairs that touch together (aligned drives) differ by round-off only: name the one that is furthest from its ends.
    middle = np.abs(own.reshape(numbers.shape) - 0.5 * (lo + hi))
    best = np.argmin(np.where(error >= error.max(axis=0) - _TOGETHER, middle, np.inf), axis=0)
    column = np.arange(phi_1.size)
    index = best * phi_1.size + column
    chosen = Earliest(found.phi_2[index], found.s[index], found.z[index], found.bounds[:, index])
    slope = slope_of_error(p, pair, own[index], chosen)
    return error[best, column], slope, numbers[best, column], chosen
