"""Where a modification that was found lies at an end of what was searched, and what a better one would need."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from fegear.base.notes import Note
from fegear.base.printed import figures

if TYPE_CHECKING:
    from fegear.design.flanks.families import FamilyBest
    from fegear.geometry.pair import GearPair, Member

#: What the numbers of a ground relief are called, and the list of `flank_design.grid` with their values.
_WORDS = {
    "driver_tip": ("tip relief of {driver}", "tip_amounts"),
    "driver_tip_length": ("length of the tip relief of {driver}", "tip_lengths"),
    "driven_tip": ("tip relief of {driven}", "tip_amounts"),
    "driven_tip_length": ("length of the tip relief of {driven}", "tip_lengths"),
    "crowning": ("lead crowning", "crownings"),
    "end_relief": ("end relief", "end_amounts"),
    "end_relief_length": ("length of the end relief", "end_lengths"),
    "slope": ("helix slope modification", "slopes"),
    "bias": ("flank twist", "biases"),
}
#: As good as a length that cannot be exceeded.
_WHOLE = 1.0 - 1e-3


def end_notes(label: str, best: FamilyBest, pair: GearPair, gears: Mapping[Member, str]) -> Iterator[Note]:
    """Notes on the numbers of a modification that lie at ends: those that may go on, those that cannot.

    Parameters
    ----------
    label : str
        Of the modification.
    best : FamilyBest
    pair : GearPair
    gears : mapping of str to str
        Names of driver and driven.
    """
    longest = {
        **dict.fromkeys(("driver_tip_length", "driven_tip_length"), (pair.path_length, "whole path of contact")),
        "end_relief_length": (0.5 * pair.face_width, "half the face width"),
    }
    limited, open_ended, keys = [], [], []
    for name, upper in best.at_ends.items():
        words, key = _WORDS[name]
        size, (most, whole) = getattr(best.relief, name), longest.get(name, (math.inf, ""))
        printed = f"{figures(size * 1e3, 3)} mm" if name.endswith("_length") else f"{figures(size * 1e6, 3)} µm"
        said = f"{words.format(driver=gears['driver'], driven=gears['driven'])} ({printed}, "
        if upper and size >= _WHOLE * most:
            limited.append(f"{said}{whole})")
        else:
            open_ended.append(f"{said}{'maximum' if upper else 'minimum'})")
            keys.append(key)
    if open_ended:
        yield Note(
            f"{label}: {', '.join(open_ended)} at the end of the range searched; a better design may lie beyond it. "
            f"Set flank_design.grid with a wider range of {', '.join(dict.fromkeys(keys))}."
        )
    if limited:
        yield Note(f"{label}: {', '.join(limited)} at the geometric limit; a better design would need more.")
