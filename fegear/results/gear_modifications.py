"""What is ground off the flanks of a gear, for its gear data: the amounts that a drawing states."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.case.gear import GearPart

#: Amounts that a drawing states, in its order, with their symbols of ISO 21771.
MEANINGS = {
    "tip_relief": "tip relief C_αa",
    "root_relief": "root relief C_αf",
    "profile_crowning": "profile crowning C_α",
    "crowning": "crowning of the lead C_β",
    "helix_slope": "helix slope modification C_Hβ",
    "end_relief_I": "end relief at end I",
    "end_relief_II": "end relief at end II",
    "bias": "twist S_α",
}


def ground_off(part: GearPart) -> dict[str, float]:
    """Amounts that a case gives for a gear [m], by `MEANINGS`; tables, files and amounts in Delta have none."""
    found: dict[str, float] = {}

    def add(key: str, amount: float | None) -> None:
        if amount:
            found[key] = found.get(key, 0.0) + amount

    if part.relief is not None:
        for key, ends in (("tip_relief", part.relief.tip), ("root_relief", part.relief.root)):
            for end in ends:
                add(key, end.amount)
        for crown in part.relief.crowning:
            add("profile_crowning", crown.amount)
    if part.lead is not None:
        add("crowning", part.lead.crowning)
        add("helix_slope", part.lead.slope)
        for relief in part.lead.end_relief:
            for side in ("I", "II"):
                if relief.end in (side, "both"):
                    add(f"end_relief_{side}", relief.amount)
    if part.bias is not None:
        add("bias", part.bias.amount)
    return found


def modification_columns(amounts: Sequence[Mapping[str, float]]) -> tuple[Column, ...]:
    """A column for every modification that some of the gears have."""
    return tuple(
        Column(key, np.array([one.get(key, 0.0) for one in amounts]), "um", meaning)
        for key, meaning in MEANINGS.items()
        if any(key in one for one in amounts)
    )
