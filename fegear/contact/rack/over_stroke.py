"""Loads, transmission error and root stress of a pinion that rolls along all of a rack.

In base pitch c of the stroke pair 0 is on tooth c of the rack and pair j, which came into contact before, on tooth
c - j; near the ends there are fewer pairs. Base pitches whose teeth stand alike are solved once.

A second solution with elements one order lower on the same meshes, at the same positions, shows the error of every
number; what extremes between positions leave open is added.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.root_stress import Felt, RootStress
from fegear.contact.rack.rack_flanks import RackFlanks
from fegear.contact.rack.stroke import BasePitches, OnPitch, Stroke

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array, Mask
    from fegear.contact.plane.compliance import Side
    from fegear.contact.plane.meshing import Contacts
    from fegear.contact.rack.rack_contacts import RackContacts
    from fegear.contact.rack.rack_teeth import RackCompliance

#: Roll positions to either side of a place where a pair enters or leaves [base pitches].
_BESIDE = 1e-6
#: Of root fillets.
SIDES: tuple[Side, ...] = ("tension", "compression")
#: No relief.
AS_GENERATED = RackFlanks()


@dataclass(frozen=True)
class BasePitch:
    """The teeth of one base pitch of the stroke.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Positions of pair 0 [m].
    contacts : Contacts
    loads : ndarray, shape (n, P)
        On the pairs, along the line of action [N].
    error : ndarray, shape (P,)
        Transmission error along the line of action [m].
    """

    x: Array
    contacts: Contacts
    loads: Array
    error: Array


def positions(found: RackContacts, count: int, flanks: RackFlanks = AS_GENERATED) -> Array:
    """Roll positions of one base pitch [m]: evenly, where pairs enter and leave, and where a relief has a kink."""
    pair = found.pair
    pitch, start = pair.rack.base_pitch, pair.x_start
    even = (np.arange(count) + 0.5) / count
    leaves = math.fmod((pair.x_end - start) / pitch, 1.0)
    marks = [_BESIDE, 1.0 - _BESIDE]
    marks += [leaves - _BESIDE, leaves + _BESIDE] if _BESIDE < leaves < 1.0 - _BESIDE else []
    kinks = np.mod((flanks.breaks(pair) - start) / pitch, 1.0)
    kinks = kinks[(kinks > _BESIDE) & (kinks < 1.0 - _BESIDE)]
    return np.asarray(start + pitch * np.unique(np.concatenate([even, marks, kinks])))


def base_pitch(
    compliance: RackCompliance, found: RackContacts, load: float, tooth: int, x: Array,
    flanks: RackFlanks = AS_GENERATED,
) -> BasePitch:  # fmt: skip
    """Share a load [N, along the line of action] at positions of pair 0 on a tooth of the rack.

    Positions at which no tooth is on the path any more are left out.
    """
    contacts = found.contacts(x, tooth)
    there = (contacts.gap == 0.0).any(axis=0)
    if not there.all():
        x, contacts = x[there], found.contacts(x[there], tooth)
    if not x.size:
        return BasePitch(x, contacts, np.zeros(contacts.x.shape), x)
    # The compliance numbers the rack's teeth as cycle - pair.
    matrices = compliance.matrices(contacts, tooth)
    shared = matrices.share(flanks.separation(contacts), load)
    return BasePitch(x, contacts, shared.loads[..., 0], shared.transmission_error[:, 0])


class UnitStress:
    """Root stress per unit line load at the positions of a base pitch: found once for all base pitches.

    Parameters
    ----------
    compliance : RackCompliance
    contacts : Contacts
        At all positions; teeth of the rack do not matter.
    side : {"tension", "compression"}
    """

    def __init__(self, compliance: RackCompliance, contacts: Contacts, side: Side) -> None:
        """Nothing is known yet."""
        self.compliance, self.contacts, self.side = compliance, contacts, side
        self.pinion = RootStress(compliance.driver, "driver", side)
        self.rack = RootStress(compliance.driven, "driven", side)
        self._rows: dict[tuple[object, ...], Array] = {}

    def of_pinion(self, i: int, row: int) -> Array:
        """Along the fillet of the tooth on pair i under a load on the pair of a row, (P, points) [1/m]."""
        key = "pinion", i, row
        if key not in self._rows:
            number, radius = int(self.contacts.number[row]), self.contacts.radius_driver[row]
            self._rows[key] = self.pinion.known_row(i, number, radius)
        return self._rows[key]

    def of_rack(self, t: int, s: int, row: int) -> Array:
        """Along the rounding of tooth t under a load on tooth s, which is on the pair of a row, (P, points) [1/m]."""
        key = "rack", self.compliance.driven.solved.alike[s], t - s, row
        if key not in self._rows:
            self._rows[key] = self.rack.known_row(t, s, self.contacts.radius_driven[row])
        return self._rows[key]


def root_stresses(unit: UnitStress, found: BasePitch, tooth: int, here: Mask) -> tuple[Array, dict[int, Array]]:
    """Largest root stress of the pinion, shape (P,), and of each tooth of the rack that feels a load [Pa].

    `here` says which of the positions of `unit` are those of the base pitch.
    """
    compliance, number = unit.compliance, found.contacts.number
    loads, rack = found.loads / compliance.face_width, compliance.driven
    sign = 1.0 if unit.side == "tension" else -1.0
    radius, height = found.contacts.radius_driver, found.contacts.radius_driven
    loaded = [r for r in range(number.size) if (loads[r] > 0.0).any()]
    size = found.x.size

    def largest(of: RootStress, i: int, rows: Iterable[tuple[Array, int]], touched: ArrayLike) -> Array:
        felt = [Felt(loads[r], row[here]) for row, r in rows]
        total = of.superposed(felt, (size, felt[0].row.shape[1]))
        return sign * of.largest(i, total, np.broadcast_to(touched, size))

    worst = np.full(size, -np.inf)
    for i in range(int(number[0]) - 1, int(number[-1]) + 2):
        rows = [(unit.of_pinion(i, r), r) for r in loaded if abs(i - int(number[r])) <= unit.pinion.reach]
        if rows:
            on = np.flatnonzero(number == i)
            touched = np.where(loads[on[0]] > 0.0, radius[on[0]], np.inf) if on.size else np.inf
            worst = np.maximum(worst, largest(unit.pinion, i, rows, touched))
    by_tooth = {tooth - int(number[r]): r for r in loaded}
    near = {s + k for s in by_tooth for k in range(-rack.reach, rack.reach + 1) if rack.exists(s + k)}
    teeth: dict[int, Array] = {}
    for t in sorted(near):
        rows = [(unit.of_rack(t, s, r), r) for s, r in by_tooth.items() if abs(t - s) <= rack.reach]
        own = by_tooth.get(t)
        touched = np.inf if own is None else np.where(loads[own] > 0.0, height[own], np.inf)
        teeth[t] = sign * largest(unit.rack, t, rows, touched)
    return sign * worst, teeth


def over_stroke(
    compliance: RackCompliance, found: RackContacts, force: float, count: int, flanks: RackFlanks = AS_GENERATED,
    added: Mapping[int, Array] | None = None,
) -> Stroke:  # fmt: skip
    """Roll the pinion along the rack.

    Parameters
    ----------
    compliance : RackCompliance
    found : RackContacts
    force : float
        Along the rack [N].
    count : int
        Even positions in a base pitch.
    flanks : RackFlanks
        Reliefs of both.
    added : mapping of int to ndarray, optional
        Positions besides, as in `BasePitches.stroke`.
    """
    pair = compliance.pair
    cos = math.cos(pair.rack.pressure_angle)
    x, pitch = positions(found, count, flanks), pair.rack.base_pitch
    units: dict[bytes, dict[Side, UnitStress]] = {}

    def solve(c: int, roll: Array) -> OnPitch:
        if roll.tobytes() not in units:
            every = found.contacts(roll, 0)
            units[roll.tobytes()] = {side: UnitStress(compliance, every, side) for side in SIDES}
        at = base_pitch(compliance, found, force / cos, c, roll, flanks)
        pinion: dict[Side, Array] = {}
        teeth: dict[Side, dict[int, Array]] = {}
        for side, unit in units[roll.tobytes()].items():
            pinion[side], of_rack = root_stresses(unit, at, c, np.isin(roll, at.x))
            teeth[side] = {t - c: values for t, values in of_rack.items()}
        share = at.loads.max(axis=0) / at.loads.sum(axis=0)
        return OnPitch(at.x, at.error / cos, (at.loads > 0.0).sum(axis=0), share, pinion, teeth)

    count_of = pair.rack.teeth + math.ceil(pair.contact_ratio) - 1
    kinds = tuple(tuple(_standing(compliance, found, c)) for c in range(count_of))
    return BasePitches(kinds, solve, x, pair.rack.teeth, pair.x_start, pitch, cos).stroke(added)


def _standing(compliance: RackCompliance, found: RackContacts, tooth: int) -> Iterator[int]:
    """How the teeth of a base pitch and those beside them stand; equal for base pitches that are alike."""
    rack = compliance.driven
    first, last = tooth - int(found.numbers[-1]) - rack.reach, tooth - int(found.numbers[0]) + rack.reach
    for t in range(first, last + 1):
        yield rack.solved.alike[t] if rack.exists(t) else -1
