"""Flank modifications as they are ground, as keys of the gears of a case."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.design.flanks.flank_tolerance import LeadTolerance
from fegear.design.flanks.forms import lead_bearer
from fegear.design.tip_relief.tip_tolerance import OF_LENGTH
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.relief import roll_in_drawing
from fegear.results.relief.grinding import BIAS, CROWNING, END, NOTHING, SLOPE, TIP, Grinding

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.design.flanks.flank_tolerance import FlankTolerance
    from fegear.design.flanks.forms import GroundRelief


def keys_of(relief: GroundRelief, pair: GearPair, gears: Mapping[Member, str], *, on_one: bool = False) -> list[str]:
    """The relief as keys of both gears; lead and bias are those of the first whose face is the common one.

    Where both faces reach beyond the common one, lead and bias are given for the driver all the same, and count over
    the common face.

    Parameters
    ----------
    relief : GroundRelief
    pair : GearPair
    gears : mapping of str to str
        Names of driver and driven.
    on_one : bool
        All on the gear that has the lead: a root relief of it, over the same part of the path, in place of the tip
        relief of its mate. Gaps, and so transmission errors and loads, are the same.
    """
    lines = []
    tips: tuple[tuple[Member, float, float, float], ...] = (
        ("driver", relief.driver_tip, pair.x_end, pair.x_end - relief.driver_tip_length),
        ("driven", relief.driven_tip, pair.x_start, pair.x_start + relief.driven_tip_length),
    )
    by_gear: dict[str, list[str]] = {gear: [] for gear in gears.values()}
    shape = "" if relief.tip_power == 1.0 else ', shape = "parabolic"'
    bearer = lead_bearer(pair)
    flanks: dict[Member, list[str]] = {member: [] for member in MEMBERS}
    for member, amount, end, start in tips:
        if abs(amount) > NOTHING:
            on = bearer if on_one else member
            place, at = ("tip", "at_radius") if on == member else ("root", "end_radius")
            radii = [float(pair.radius(x, on)) for x in (start, end)]
            flanks[on].append(
                f'{place} = {{ amount = "{_um(amount)}", start_radius = "{_mm(radii[0])}", '
                f'{at} = "{_mm(radii[1])}"{shape} }}'
            )
    for member, ends in flanks.items():
        if ends:
            by_gear[gears[member]].append(f"relief = {{ {', '.join(ends)} }}")
    lead = [
        f'{key} = "{_um(value)}"'
        for key, value in (("crowning", relief.crowning), ("slope", relief.slope))
        if abs(value) > NOTHING  # a step of a grid that is none but for round-off
    ]
    if abs(relief.end_relief) > NOTHING:
        face_ends = f'amount = "{_um(relief.end_relief)}", length = "{_mm(relief.end_relief_length)}"'
        lead.append(f"end_relief = {{ {face_ends} }}")
    if lead:
        by_gear[gears[bearer]].append(f"lead = {{ {', '.join(lead)} }}")
    if abs(relief.bias) > NOTHING:
        # The driven gear's tip is where the driver's root is.
        bias = relief.bias if bearer == "driver" else -relief.bias
        by_gear[gears[bearer]].append(f'bias = "{_um(bias)}"')
    for gear, keys in by_gear.items():
        lines += [f"gear.{gear}.{key}" for key in keys]
    return lines


def ground_rows(
    relief: GroundRelief, pair: GearPair, gears: Mapping[Member, str], design: str,
    tolerance: FlankTolerance,
) -> list[Grinding]:  # fmt: skip
    """The relief as rows of the grinding table; lead and twist are those of the gear that `keys_of` gives them to."""
    bearer = lead_bearer(pair)
    own = tolerance.lead or LeadTolerance(math.nan, math.nan, math.nan)
    shape = "linear" if relief.tip_power == 1.0 else "parabolic"

    def tip(member: Member, amount: float, end: float, start: float) -> Grinding:
        allowed, length = tolerance.tips[MEMBERS.index(member)], abs(end - start)
        top, foot = (2.0 * float(pair.radius(at, member)) for at in (end, start))
        roll = roll_in_drawing(pair.gear(member), pair.roll_angle(start, member))
        return Grinding(
            gears[member], member, design, TIP, shape, amount, amount_tolerance=allowed.amount,
            start_diameter=foot, end_diameter=top, start_roll_angle=float(roll),
            length=length, length_tolerance=OF_LENGTH * length if allowed.length is None else allowed.length,
        )  # fmt: skip

    def lead(kind: str, shape: str, amount: float, allowed: float, length: float = math.nan) -> Grinding:
        return Grinding(
            gears[bearer], bearer, design, kind, shape, amount, face_length=length,
            amount_tolerance=allowed,
        )  # fmt: skip

    bias = relief.bias if bearer == "driver" else -relief.bias
    rows = [
        tip("driver", relief.driver_tip, pair.x_end, pair.x_end - relief.driver_tip_length),
        tip("driven", relief.driven_tip, pair.x_start, pair.x_start + relief.driven_tip_length),
        lead(CROWNING, "parabolic", relief.crowning, own.crowning),
        lead(END, "linear", relief.end_relief, own.crowning, relief.end_relief_length),
        lead(SLOPE, "linear", relief.slope, own.slope), lead(BIAS, "linear", bias, own.twist),
    ]  # fmt: skip
    return [row for row in rows if abs(row.amount) > NOTHING]


def _um(value: float) -> str:
    return f"{value * 1e6:.5g} um"


def _mm(value: float) -> str:
    return f"{value * 1e3:.7g} mm"
