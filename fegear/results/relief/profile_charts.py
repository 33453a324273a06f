"""Profile charts (K-charts) of tip reliefs: the nominal profile and the band that the drawing allows, to print."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown
from fegear.design.tip_relief.tip_tolerance import NOTHING, TipTolerance
from fegear.engine.figure.axis import Axis, Scale
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.geometry.relief import EndRelief, roll_in_drawing, roll_of_radius
from fegear.results.relief.answer_numbers import microns, with_limits
from fegear.results.relief.recommended import marked

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.base.arrays import Array
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.gear import Gear
    from fegear.geometry.path_of_contact import ActiveProfile
    from fegear.geometry.relief import Relief

#: Places of a chart over the involute.
_PLACES = 241
#: Share of the deepest removal that is left free above the involute.
_ROOM = 0.18
#: Shares of the abscissa that a letter beside a mark takes, and the room beside a word.
_LETTER, _MARGIN = 0.017, 0.01
#: Limit toward more removal with profile form in the legend.
_FORM = "lower limit with profile form f_{fα}"
_SHAPES = {1.0: "linear", 2.0: "parabolic"}


@dataclass(frozen=True)
class ProfileChart:
    """Profile chart of one gear; arrays of shape (P,), material that is removed below zero.

    Parameters
    ----------
    gear : str
    words : str
        The relief and its tolerances, in a line.
    marks : tuple of Mark
        Points of single contact, and the start of the relief.
    base_radius : float
        [m].
    recommended : bool
        Whether it is of the design to be ground.
    """

    gear: str
    words: str
    marks: tuple[Mark, ...]
    base_radius: float
    recommended: bool
    roll_length: Array = shown("mm", "roll length from the base circle, along the line of action", label="roll length")
    profile: Array = shown("um", "deviation of the profile from the involute", label="deviation from the involute")
    upper: Array = shown("um", "upper limit of the profile by the tolerances of amount and length")
    lower: Array = shown("um", "lower limit of the profile by the tolerances of amount and length")
    with_form: Array | None = shown("um", "lower limit of the profile with profile form", default=None)
    present: Array | None = shown("um", "profile with the relief of the case", default=None)


def profile_chart(
    name: str, gear: Gear, tip: EndRelief, tolerance: TipTolerance, present: Relief | None = None,
    active: ActiveProfile | None = None, *, recommended: bool = False,
) -> ProfileChart:  # fmt: skip
    """The chart of a tip relief over the involute of a gear.

    Parameters
    ----------
    name : str
        Of the gear.
    gear : Gear
    tip : EndRelief
    tolerance : TipTolerance
    present : Relief, optional
        That the gear has now.
    active : ActiveProfile, optional
        Where the mate touches the gear.
    recommended : bool
        Whether it is of the design to be ground.
    """
    low, high = (float(roll_of_radius(gear, r)) for r in (gear.form_radius, gear.involute_tip_radius))
    roll = np.unique(np.concatenate([np.linspace(min(low, high), max(low, high), _PLACES), [tip.start]]))
    least, most = tolerance.limits(gear, tip, roll)
    length = gear.base_radius * (tip.end - tip.start)
    slope = f", profile slope ± {microns(tolerance.amount)} µm" if tolerance.amount > NOTHING else ""
    words, marks = f"no relief{slope}", _single_contact(gear, active)
    if tip.amount > NOTHING:
        start = gear.base_radius * math.hypot(1.0, tip.start)
        amount = with_limits(tip.amount, tolerance.amount, least=0.0)
        words = (
            f"{amount}, {_SHAPES[tip.power]} from d {2e3 * start:.3f} mm "
            f"({length * 1e3:.3f} ± {tolerance.length_of(gear, tip) * 1e3:.3f} mm long)"
        )
        marks.append(Mark("x", _drawn_length(gear, tip.start), f"d {2e3 * start:.1f}"))
    drawn, form = roll_in_drawing(gear, gear.base_radius * roll), None
    if tolerance.form > NOTHING:
        words, form = f"{words}; f_{{fα}} {microns(tolerance.form)} µm", -most
    return ProfileChart(
        name, words, _apart(marks, float(np.ptp(drawn)) * 1e3), gear.base_radius, recommended, drawn,
        -tip.removal(roll), -least, tolerance.form - most, form, None if present is None else -present.removal(roll),
    )  # fmt: skip


def _apart(marks: Sequence[Mark], span: float) -> tuple[Mark, ...]:
    """Marks of an axis that spans so much, without words that would lie on one before; lines stay."""

    def room(mark: Mark) -> float:
        return (_MARGIN + _LETTER * len(mark.label)) * span

    kept: list[Mark] = []
    for mark in marks:
        free = all(
            one.at - mark.at >= room(mark) or mark.at - one.at >= room(one) for one in kept if one.label
        )  # a word stands at the right of its line
        kept.append(mark if free else Mark(mark.axis, mark.at))
    return tuple(kept)


def _drawn_length(gear: Gear, roll: float) -> float:
    """Roll length of a roll angle as an abscissa [mm]."""
    return float(roll_in_drawing(gear, gear.base_radius * roll)) * 1e3


def _single_contact(gear: Gear, active: ActiveProfile | None) -> list[Mark]:
    """Highest and lowest point of single tooth contact, where there is one: a start is compared with the highest."""
    if active is None or math.isnan(active.lowest_single):
        return []
    ends = (("HPSTC", active.highest_single), ("LPSTC", active.lowest_single))
    return [Mark("x", _drawn_length(gear, float(roll_of_radius(gear, radius))), word) for word, radius in ends]


def _abscissa(seen: Seen) -> Axis:
    """An axis for each gear, as they lie far apart; roll angles at the other side."""
    length = np.array([seen.one.roll_length.min(), seen.one.roll_length.max()])
    angle = Scale("roll angle", "deg", length * 1e3, np.degrees(length / seen.one.base_radius))
    return Axis(f"roll length of {seen.one.gear}", "mm", second=angle)


def _ordinate(seen: Seen) -> Axis:
    """With room for the diameter above the profile."""
    curves = (seen.one.lower, seen.one.with_form, seen.one.present)
    deepest = -1e6 * min(0.0, *(float(one.min()) for one in curves if one is not None))
    highest = 1e6 * max(0.0, float(seen.one.upper.max()))
    return Axis("deviation from the involute", "um", limits=(-1.08 * deepest, highest + _ROOM * deepest))


def _tip_side(charts: Mapping[str, Sequence[ProfileChart]]) -> str:
    """On which side of the figure the tips are: rolls of an internal gear are smaller at its tip."""
    hollow = dict.fromkeys(
        one.gear for each in charts.values() for one in each if one.roll_length[-1] < one.roll_length[0]
    )
    return f"tip at right (of {', '.join(hollow)} at left)" if hollow else "tip at right"


def k_chart(of: str) -> Chart:
    """The figure of the charts of a pair, a view for each design.

    Parameters
    ----------
    of : str
        Mapping of designs to sequences of `ProfileChart`.
    """
    plain = {"markers": False}
    return Chart(
        "k_chart_{name}", "Profile charts (K-charts) of pair {name}",
        lambda seen: (
            f"Pair {seen.name}: profile of each gear over roll length, material removed below zero, "
            f"{_tip_side(seen.find(of))}. Dashed: upper and lower limit by the tolerances of amount and length, "
            "without relief of the profile slope; "
            "dotted: the lower one with profile form f_fα (flank tolerance class). LPSTC, HPSTC: lowest and highest "
            "point of single tooth contact; d: start of the relief."
        ),
        (
            Over(
                _abscissa,
                (
                    Line("profile", "nominal", "designed", look={**plain, "width": 2.4}, x="roll_length"),
                    Line(
                        "upper", "limits of amount and length", "red",
                        look={**plain, "dash": "dash", "width": 1.4}, x="roll_length",
                    ),
                    Line(
                        "lower", "limits of amount and length", "red",
                        look={**plain, "dash": "dash", "width": 1.4}, x="roll_length",
                    ),
                    Line(
                        "with_form", lambda _: _FORM, "grey", look={**plain, "dash": "dot", "width": 1.2},
                        x="roll_length",
                    ),
                    Line("present", "present relief", "present relief", look=plain, x="roll_length"),
                ),
                _ordinate,
                title=lambda seen: f"{marked(seen.one.gear, recommended=seen.one.recommended)}: {seen.one.words}",
                each=lambda seen: seen.one,
                marks=lambda seen: seen.one.marks,
            ),
        ),
        views=of, when=of, columns=1,
        view=lambda seen: marked(seen.key, recommended=seen.one[0].recommended),
    )  # fmt: skip
