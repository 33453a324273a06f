"""Where tables of profile, lead and flank end before the active flank does: what they hold from there on, in notes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import assuming
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.pair_spec import FlankSpec, PairSpec
    from fegear.geometry.pair import GearPair, Member

#: Share of the active profile or face that a table may leave out without a note: what rounding its places takes.
_UNCOVERED = 1e-3


def table_end_notes(spec: PairSpec) -> tuple[str, ...]:
    """Name each end of a table that lies before the end of the active flank, and what is held beyond.

    Of profiles, and for teeth with a width of topographies and leads too, if the effect `relief` counts them.
    """
    if not spec.relief:
        return ()
    found = (
        note
        for member, flank in zip(MEMBERS, spec.both, strict=True)
        for note in (*_profile_notes(spec.placed, member, flank), *_face_notes(spec.placed, member, flank))
    )
    return tuple(dict.fromkeys(found))


def _profile_notes(pair: GearPair, member: Member, flank: FlankSpec) -> Iterator[str]:
    what = "measured profile" if flank.measured else "relief table"
    for table in flank.relief.tables if flank.relief else ():
        yield from _ends_of_profile(pair, member, flank.gear, what, table.roll, (table.values[0], table.values[-1]))


def _face_notes(pair: GearPair, member: Member, flank: FlankSpec) -> Iterator[str]:
    if not flank.face:
        return
    from fegear.geometry.flank_modification import LeadTable, Topography  # late: most flanks have none over the face

    for part in flank.face:
        if isinstance(part, Topography):
            ends = part.values.mean(axis=1)
            yield from _ends_of_profile(pair, member, flank.gear, "topography", part.roll, (ends[0], ends[-1]))
            yield from _ends_of_face(pair, member, flank.gear, "topography", part.z)
        elif isinstance(part, LeadTable):
            yield from _ends_of_face(pair, member, flank.gear, "lead table", part.z)


def _ends_of_profile(
    pair: GearPair, member: Member, name: str, what: str, roll: Array, held: Sequence[float]
) -> Iterator[str]:
    """Roll angles rise from root to tip, of a ring gear from tip to root."""
    gear = pair.gear(member)
    low, high = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
    least = _UNCOVERED * (high - low)
    sides = ("tip", "root") if gear.tooth.internal else ("root", "tip")
    for side, short, at, end, value in (
        (sides[0], float(roll[0]) - low, roll[0], low, held[0]),
        (sides[1], high - float(roll[-1]), roll[-1], high, held[1]),
    ):
        if short <= least or value == 0.0:  # nothing held is the unmodified flank, as a drawing means it
            continue
        here, there = (float(gear.tooth.radius_of_roll(t)) * gear.module * 1e3 for t in (at, end))
        yield (
            assuming(
                f"Gear {name}: {what} ends at radius {here:.6g} mm, before the {side} end of the active profile at "
                f"{there:.6g} mm; last value {value * 1e6:.4g} um used beyond it. Extend the table to the end of the "
                "profile."
            )
        )


def _ends_of_face(pair: GearPair, member: Member, name: str, what: str, z: Array) -> Iterator[str]:
    """Heights rise from end I to end II."""
    width = pair.gear(member).face_width
    for end, at, there in (("I", float(np.min(z)), -0.5 * width), ("II", float(np.max(z)), 0.5 * width)):
        if abs(there) - abs(at) <= _UNCOVERED * width or abs(at) > abs(there):
            continue
        yield (
            assuming(
                f"Gear {name}: {what} ends at z = {at * 1e3:.6g} mm, before end {end} of the face at {there * 1e3:.6g} "
                "mm; last values used beyond it. Extend the table to the end of the face."
            )
        )
