"""Teeth of several gauges of one trace: the shifts of two gauges on one gear differ by whole tooth pitches.

The rotation of a gauge is zero where its tooth is in contact at the pitch point, and the teeth are numbered in the
order of meshing: the shift of tooth n is that of tooth 1 and n - 1 pitches.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

#: How near to a whole number of pitches two shifts have to be [pitches].
_NEAR = 0.1
#: Gauges that are named at most.
_NAMED = 3


@dataclass(frozen=True)
class TraceZero:
    """Where the tooth of a gauge is in contact, by the angle of a trace.

    Parameters
    ----------
    on : tuple of str
        Pair, gear, member and file: what two gauges have in common whose shifts are compared.
    tooth : int
        In meshing order, the first is 0.
    teeth : int
        Of the gear.
    shift : float
        [rad].
    """

    on: tuple[str, ...]
    tooth: int
    teeth: int
    shift: float

    def pitches_after(self, other: TraceZero) -> float:
        """By how many tooth pitches it is in contact later, less than a turn."""
        turn = 2.0 * math.pi
        count = abs(self.teeth) * math.fmod(self.shift - other.shift + 2.0 * turn, turn) / turn
        return count if count <= abs(self.teeth) - _NEAR else count - abs(self.teeth)


def teeth_apart(gauges: Sequence[tuple[str, TraceZero | None]]) -> str:
    """Sentence on gauges whose shifts contradict their teeth, or say them; empty where all are as entered.

    Parameters
    ----------
    gauges : sequence of (str, TraceZero or None)
        By name.
    """
    first: dict[tuple[str, ...], tuple[str, TraceZero]] = {}
    said: list[str] = []
    for name, zero in gauges:
        if zero is None:
            continue
        known, reference = first.setdefault(zero.on, (name, zero))
        if known != name and (clause := _apart(known, reference, name, zero)):
            said.append(clause)
    if not said:
        return ""
    more = f"; {len(said) - _NAMED} more" if len(said) > _NAMED else ""
    return f"Shifts: {'; '.join(said[:_NAMED])}{more}."


def _apart(known: str, reference: TraceZero, name: str, zero: TraceZero) -> str:
    """What the shifts of two gauges say; empty where that is as entered."""
    count = zero.pitches_after(reference)
    shifts = [f"{math.degrees(one.shift):.1f}°" for one in (zero, reference)]
    start = f"those of gauges {name} ({shifts[0]}) and {known} ({shifts[1]}) are {count:.2f} tooth pitches apart"
    if abs(count - round(count)) > _NEAR:
        return f"{start}, not a whole number: check the angle for slip or lost pulses, and the gear of both"
    teeth = abs(zero.teeth)
    tooth = (reference.tooth + round(count)) % teeth
    if tooth == zero.tooth:
        return ""
    wrong = f", not {zero.tooth + 1}" if reference.tooth or zero.tooth else ""  # one that nobody entered is not wrong
    return f"{start}: gauge {name} is on tooth {tooth + 1}{wrong}, with {known} on tooth {reference.tooth + 1}"
