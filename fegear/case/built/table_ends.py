"""Where tables of profile, lead and flank end before the active flank does: what they hold from there on, in notes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.geometry.flank_modification import LeadTable, Topography

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.base.arrays import Array
    from fegear.geometry.flank_modification import FlankModification
    from fegear.geometry.pair import GearPair, Member
    from fegear.geometry.relief import TabulatedRelief

#: Share of the active profile or face that a table may leave out without a note: what rounding its places takes.
_UNCOVERED = 1e-3


def relief_table_notes(
    pair: GearPair, member: Member, name: str, tables: tuple[TabulatedRelief, ...], *, measured: bool = False
) -> tuple[str, ...]:
    """Name each end of a gear's relief tables that lies before that of its active profile, and what is held beyond.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    name : str
        Of the gear.
    tables : tuple of TabulatedRelief
    measured : bool
        Whether they are traces of a measured flank.
    """
    what = "measured profile" if measured else "relief table"
    return tuple(
        said
        for table in tables
        for said in _ends_of_profile(pair, member, name, what, table.roll, (table.values[0], table.values[-1]))
    )


def face_table_notes(
    pair: GearPair, member: Member, name: str, parts: tuple[FlankModification, ...]
) -> tuple[str, ...]:
    """Do the same for a gear's topographies, over profile and face, and for its lead tables."""
    notes: list[str] = []
    for part in parts:
        if isinstance(part, Topography):
            ends = part.values.mean(axis=1)
            notes += _ends_of_profile(pair, member, name, "topography", part.roll, (ends[0], ends[-1]))
            notes += _ends_of_face(pair, member, name, "topography", part.z)
        elif isinstance(part, LeadTable):
            notes += _ends_of_face(pair, member, name, "lead table", part.z)
    return tuple(notes)


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
            f"Gear {name}: {what} ends at radius {here:.6g} mm, before the {side} end of the active profile at "
            f"{there:.6g} mm; last value {value * 1e6:.4g} um used beyond it. Extend the table to the end of the "
            "profile."
        )


def _ends_of_face(pair: GearPair, member: Member, name: str, what: str, z: Array) -> Iterator[str]:
    """Heights rise from end I to end II."""
    width = pair.gear(member).face_width
    for end, at, there in (("I", float(np.min(z)), -0.5 * width), ("II", float(np.max(z)), 0.5 * width)):
        if abs(there) - abs(at) <= _UNCOVERED * width or abs(at) > abs(there):
            continue
        yield (
            f"Gear {name}: {what} ends at z = {at * 1e3:.6g} mm, before end {end} of the face at {there * 1e3:.6g} "
            "mm; last values used beyond it. Extend the table to the end of the face."
        )
