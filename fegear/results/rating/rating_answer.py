"""What a rating comes to: the weaker of pitting and tooth breakage first, with its gear and the required safety."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from fegear.base.printed import figures
from fegear.engine.sheet.answer import Answer

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.sheet.seen import Seen

_PARTS = {"contact": ("S_H", "pitting"), "bending": ("S_F", "tooth breakage")}


class Weakest(NamedTuple):
    """The lower safety factor of both gears of a pair.

    Attributes
    ----------
    ratio : float
        Safety over the required one.
    part : str
        ``contact`` or ``bending``.
    safety, required : float
    gear : str
        With its member in brackets.
    """

    ratio: float
    part: str
    safety: float
    required: float
    gear: str


def _weakest(seen: Seen, ending: str) -> list[Weakest]:
    """Of flanks and roots by one method, the weaker first; those that the method does not give are left out."""
    found = []
    for part, required in zip(_PARTS, seen.asked.asked.conditions.required, strict=True):
        known = [
            (getattr(one, f"{part}_safety"), gear.label)
            for gear in seen.data.gears.values()
            for one in gear.methods
            if one.by.ending == ending and math.isfinite(getattr(one, f"{part}_safety"))
        ]
        if known:
            safety, label = min(known)
            found.append(Weakest(safety / required, part, safety, required, label))
    return sorted(found)


def _governing(seen: Seen) -> list[Weakest]:
    """By ISO 6336, under the load spectrum where there is one."""
    spectrum = seen.data.found.spectrum is not None
    return _weakest(seen, "_spectrum" if spectrum else "")


def _safeties(seen: Seen) -> Iterator[str]:
    for one in _governing(seen):
        symbol, what = _PARTS[one.part]
        verdict = "below" if one.ratio < 1.0 else "above"
        yield (
            f"Pair {seen.name}: {symbol} {one.safety:.2f}, {what} of gear {one.gear}, {verdict} the minimum of "
            f"{figures(one.required)}."
        )


def _by_elements(seen: Seen) -> Iterator[str]:
    """The same with computed load distribution and root stress."""
    ending = "_spectrum_computed" if seen.data.found.spectrum_computed is not None else "_computed"
    found = [f"{_PARTS[one.part][0]} {one.safety:.2f}" for one in _weakest(seen, ending)]
    if found:
        yield f"Pair {seen.name}: with finite elements {' and '.join(found)}."


def _rank(seen: Seen) -> float | None:
    found = _governing(seen)
    return found[0].ratio if found else None


RATING_ANSWER = Answer(
    _safeties,
    _by_elements,
    "Pair {name}: at the minimum safety factors it transmits {v[transmittable_power]}.",
    figure="rating_{name}",
    rank=_rank,
    among="the weakest of {count} pairs",
)
