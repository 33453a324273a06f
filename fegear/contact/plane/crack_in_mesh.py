"""Stress intensity of a cracked tooth on its way through the mesh, under the loads that the teeth share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown
from fegear.contact.plane.tooth_in_mesh import ToothInMesh
from fegear.geometry.pair import Member

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.over_revolution import OverRevolution
    from fegear.fem.plane.odd.odd_gear import OddGearInfluence


@dataclass(frozen=True)
class CrackInMesh:
    """K_I and K_II of a crack, position by position; faces that may close do so under all loads together.

    Base pitches count from that in which pair 0 is on the cracked tooth.
    """

    tooth: int
    member: Member
    base_pitch: Index = shown("", "base pitch, from that in which the cracked tooth is on pair 0", table="crack")
    gear_angle: Array = shown(
        "deg",
        "rotation of the gear, zero with the cracked tooth in contact at the pitch point",
        label="rotation of the gear",
        table="crack",
    )
    load: Array = shown("N", "load on the cracked tooth", table="crack")
    k_1: Array = shown(
        "MPa.m^(1/2)",
        "stress intensity factor K_I (opening; negative: the crack closes)",
        name="K_I",
        label="stress intensity",
        table="crack",
    )
    k_2: Array = shown("MPa.m^(1/2)", "stress intensity factor K_II (shear)", name="K_II", table="crack")
    k_1_error: Array | None = None
    k_2_error: Array | None = None

    @property
    def largest(self) -> int:
        """Row of the largest K_I."""
        return int(np.argmax(self.k_1))

    @property
    def least(self) -> int:
        """Row of the least K_I."""
        return int(np.argmin(self.k_1))


def crack_in_mesh(
    engagement: Engagement, found: OverRevolution, member: Member, influence: OddGearInfluence, tooth: int
) -> CrackInMesh:
    """Follow a crack while all loaded teeth are known by number to its gear's solution.

    Parameters
    ----------
    engagement : Engagement
    found : OverRevolution
        Its loads.
    member : {"driver", "driven"}
        The gear that has the crack.
    influence : OddGearInfluence
        Of this gear.
    tooth : int
        The cracked tooth by its own number.
    """
    gear, way = influence.gear, ToothInMesh(engagement, found, member, influence, tooth)
    near = influence.from_middle(tooth)
    closing = near in influence.fine.closing
    pitches, parts = [], []
    for pitch in range(int(found.number[0]) - gear.teeth // 2, int(found.number[-1]) + gear.teeth // 2 + 1):
        loads, teeth = way.in_pitch(pitch)
        bears = [bool((load > 0.0).any()) for load in loads]
        known = [influence.from_middle(one) in influence.known for one in teeth]
        if not all(one for one, loaded in zip(known, bears, strict=True) if loaded):
            continue
        k, error, own = np.zeros((2, found.x.size)), np.zeros((2, found.x.size)), np.zeros(found.x.size)
        here = {}
        for row, (other, loaded) in enumerate(zip(teeth, bears, strict=True)):
            if not loaded:
                continue
            at = np.flatnonzero(loads[row] > 0.0)
            value, off = influence.stress_intensity(tooth, other, way.radius[row, at])
            k[:, at] += value * loads[row, at] / way.width
            error[:, at] += off * loads[row, at] / way.width
            here[other] = way.radius[row], loads[row] / way.width
            if (other - tooth) % gear.teeth == 0:
                own = loads[row]
        if closing and here:
            k, error = _closed(influence, tooth, here, k, error)
        pitches.append(pitch)
        parts.append((k, error, own))
    k, error, own = (np.concatenate([part[n] for part in parts], axis=-1) for n in range(3))
    along = np.concatenate([found.x + found.pitch * pitch for pitch in pitches])
    # Roll positions rise toward the driver's tip: so does the way that either gear has turned.
    stated = bool(np.isfinite(error).all())
    return CrackInMesh(
        way.order, member, np.repeat(pitches, found.x.size), along / gear.base_radius, own, k[0], k[1],
        error[0] if stated else None, error[1] if stated else None,
    )  # fmt: skip


def _closed(
    influence: OddGearInfluence, tooth: int, loads: dict[int, tuple[Array, Array]], k: Array, error: Array
) -> tuple[Array, Array]:
    """K of faces that press on each other under these loads together, and its error, shape (2, P) each.

    A tip that is pressed together has no K_I: what nodes leave of it, below zero, is an error.
    """
    on_tooth = next((one for one in loads if (one - tooth) % influence.gear.teeth == 0), tooth)
    nothing = next(iter(loads.values()))[0]
    every = {on_tooth: (nothing, np.zeros(nothing.size))} | loads
    change, off = influence.closed_intensity(on_tooth, every)
    k, error = k + change, error + off
    left = np.minimum(k[0], 0.0)
    return np.stack([k[0] - left, k[1]]), error + np.abs(left)
