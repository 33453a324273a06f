"""Profile charts (K-charts) of tip reliefs: the nominal profile and the band that the drawing allows, to print."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.design.tip_relief.tip_tolerance import NOTHING, TipTolerance
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.geometry.relief import EndRelief, roll_in_drawing, roll_of_radius
from fegear.results.relief.answer_numbers import microns, with_limits

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.base.arrays import Array
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.gear import Gear
    from fegear.geometry.relief import Relief

#: Places of a chart over the involute.
_PLACES = 241
#: Share of the deepest removal that is left free above the involute.
_ROOM = 0.18
#: Limit toward more removal in the legend.
_LOWER = "the same and profile form f_{fα}"
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
    """

    gear: str
    words: str
    marks: tuple[Mark, ...]
    roll_length: Array = shown("mm", "roll length from the base circle, along the line of action", label="roll length")
    profile: Array = shown("um", "deviation of the profile from the involute", label="deviation from the involute")
    upper: Array = shown("um", "upper limit of the profile")
    lower: Array = shown("um", "lower limit of the profile")
    present: Array | None = shown("um", "profile with the relief of the case", default=None)


def profile_chart(
    name: str, gear: Gear, tip: EndRelief, tolerance: TipTolerance, present: Relief | None = None
) -> ProfileChart:
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
    """
    low, high = (float(roll_of_radius(gear, r)) for r in (gear.form_radius, gear.involute_tip_radius))
    roll = np.unique(np.concatenate([np.linspace(min(low, high), max(low, high), _PLACES), [tip.start]]))
    least, most = tolerance.limits(gear, tip, roll)
    length = gear.base_radius * (tip.end - tip.start)
    words, marks = "no relief", []
    if tip.amount > NOTHING:
        start = gear.base_radius * math.hypot(1.0, tip.start)
        amount = with_limits(tip.amount, tolerance.amount, least=0.0)
        words = (
            f"{amount}, {_SHAPES[tip.power]} from d {2e3 * start:.1f} mm "
            f"({figures(length * 1e3, 2)} ± {figures(tolerance.length_of(gear, tip) * 1e3, 2)} mm long)"
        )
        marks = [Mark("x", float(roll_in_drawing(gear, gear.base_radius * tip.start)) * 1e3, f"d {2e3 * start:.1f}")]
    if tolerance.form > NOTHING:
        words = f"{words}; f_{{fα}} {microns(tolerance.form)} µm"
    return ProfileChart(
        name, words, tuple(marks), roll_in_drawing(gear, gear.base_radius * roll), -tip.removal(roll), -least, -most,
        None if present is None else -present.removal(roll),
    )  # fmt: skip


def _ordinate(seen: Seen) -> Axis:
    """With room for the diameter above the profile."""
    deepest = -1e6 * min(
        float(seen.one.lower.min()), 0.0 if seen.one.present is None else float(seen.one.present.min())
    )
    return Axis("deviation from the involute", "um", limits=(-1.08 * deepest, _ROOM * deepest))


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
            "Pair {name}: profile of each gear over roll length, material removed below zero, "
            f"{_tip_side(seen.find(of))}. Dashed: limits by the tolerances of amount and length; the lower one "
            "(dash-dot) includes profile form f_fα (flank tolerance class), more removal."
        ),
        (
            Over(
                lambda seen: Axis(f"roll length of {seen.one.gear}", "mm"),  # an axis for each: they lie far apart
                (
                    Line("profile", "nominal", "designed", look={**plain, "width": 2.4}, x="roll_length"),
                    Line(
                        "upper", "limits of amount and length", "grey",
                        look={**plain, "dash": "dash"}, x="roll_length",
                    ),
                    Line("lower", lambda _: _LOWER, "grey", look={**plain, "dash": "dashdot"}, x="roll_length"),
                    Line("present", "present relief", "present relief", look=plain, x="roll_length"),
                ),
                _ordinate,
                title="{one.gear}: {one.words}", each=lambda seen: seen.one,
                marks=lambda seen: seen.one.marks,
            ),
        ),
        views=of, when=of, columns=1,
    )  # fmt: skip
