"""Lead charts of what is ground: the nominal helix at all diameters and the band that the drawing allows, to print."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.results.relief.answer_numbers import with_limits
from fegear.results.relief.grinding import CROWNING, END, NOTHING, SLOPE
from fegear.results.relief.recommended import marked

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.design.flanks.flank_tolerance import LeadTolerance
    from fegear.design.flanks.forms import GroundRelief
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.pair import GearPair, Member

#: Places of a chart over the face.
_PLACES = 201
#: Part of the height of the band that is left free above and below.
_ROOM = 0.12


@dataclass(frozen=True)
class LeadChart:
    """Lead chart of one gear; arrays of shape (P,), material that is removed below zero.

    Parameters
    ----------
    gear : str
    words : str
        The modifications and their tolerances, in a line.
    recommended : bool
        Whether it is of the design to be ground.
    """

    gear: str
    words: str
    recommended: bool
    z: Array = shown("mm", "face position of the gear, from mid-face", label="face position z")
    lead: Array = shown("um", "deviation of the helix from that at mid-face", label="deviation from the helix")
    upper: Array = shown("um", "upper limit of the helix")
    lower: Array = shown("um", "lower limit of the helix")


def lead_chart(
    gear: str, relief: GroundRelief, pair: GearPair, member: Member, tolerance: LeadTolerance, *,
    recommended: bool = False,
) -> LeadChart | None:  # fmt: skip
    """The chart of the lead of the gear that has it; None where none is ground.

    Parameters
    ----------
    gear : str
        Its name.
    relief : GroundRelief
    pair : GearPair
    member : {"driver", "driven"}
    tolerance : LeadTolerance
    recommended : bool
        Whether it is of the design to be ground.
    """
    kinds = (
        ("crowning", CROWNING, tolerance.crowning), ("end_relief", END, tolerance.crowning),
        ("slope", SLOPE, tolerance.slope),
    )  # fmt: skip
    ground = [(key, word, getattr(relief, key), off) for key, word, off in kinds if abs(getattr(relief, key)) > NOTHING]
    if not ground:
        return None
    half = 0.5 * pair.face_width
    z = np.linspace(-half, half, _PLACES)
    alone = replace(relief, driver_tip=0.0, driven_tip=0.0, bias=0.0)

    def removed(*offs: float) -> Array:
        changed = {key: amount + off for (key, _, amount, _), off in zip(ground, offs, strict=True)}
        one = replace(alone, **changed)
        return np.asarray(one.removal(pair, 0.5 * (pair.x_start + pair.x_end), z) - 0.5 * abs(one.slope))

    band = [removed(*offs) for offs in product(*((-off, off) for *_, off in ground))]
    words = ", ".join(f"{word} {with_limits(amount, off)}" for _, word, amount, off in ground)
    return LeadChart(
        gear, words, recommended, z + pair.face_height(member), -removed(*(0.0 for _ in ground)), -np.min(band, axis=0),
        -np.max(band, axis=0),
    )  # fmt: skip


def _ordinate(seen: Seen) -> Axis:
    lowest, highest = float(seen.one.lower.min()) * 1e6, float(seen.one.upper.max()) * 1e6
    room = _ROOM * (highest - lowest)
    return Axis("deviation from the helix", "um", limits=(lowest - room, highest + room))


def lead_k_chart(of: str) -> Chart:
    """The figure of the charts of a pair, a view for each design.

    Parameters
    ----------
    of : str
        Mapping of designs to `LeadChart`.
    """
    plain = {"markers": False}
    return Chart(
        "lead_chart_{name}", "Lead charts of pair {name}",
        "Pair {name}: helix of the gear with the lead modifications over its face width, material removed below zero, "
        "relative to mid-face. Dashed: limits by the tolerances of helix slope, crowning and end relief.",
        (
            Over(
                "z",
                (
                    Line("lead", "nominal", "designed", look={**plain, "width": 2.4}),
                    Line("upper", "limits", "grey", look={**plain, "dash": "dash"}),
                    Line("lower", "limits", "grey", look={**plain, "dash": "dash"}),
                ),
                _ordinate,
                title=lambda seen: f"gear {marked(seen.one.gear, recommended=seen.one.recommended)}: {seen.one.words}",
            ),
        ),
        views=of, when=of, view=lambda seen: marked(seen.key, recommended=seen.one.recommended),
    )  # fmt: skip
