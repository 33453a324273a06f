"""Flanks and loads other than stated that a measured trace may come from: one number each, and the pair that it makes.

Amount and start of the tip relief of either gear and of both, a relief where none is stated, the load, the pitch of a
single tooth. Contacts and compliances stay those of the pair, so that each is a matter of milliseconds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import CombinedRelief, EndRelief

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.contact.plane.engagement import Engagement
    from fegear.geometry.pair import Member
    from fegear.geometry.relief import Relief

Kind = Literal["tip relief", "start", "load", "pitch", "place", "scale", "filter", "bridge"]
#: Amounts that are looked at: times the stated one, and modules more.
_TIMES, _MODULES = 2.5, 0.01
#: Load over the stated one.
_LOADS = (0.5, 2.0)
#: Scales of a trace.
_SCALES = (0.2, 5.0)
#: Pitch deviations [modules].
_PITCH = 0.01
#: By how much an amount is known, as a part of it and in modules; a pitch in modules; a start, as a part of the way
#: from the pitch point to the tip.
_AMOUNT_KNOWN, _KNOWN, _PITCH_KNOWN, _START_KNOWN = 0.2, 1e-3, 1e-3, 0.1
#: A start is between this share of the way from the pitch point to the tip, and that.
_START = (0.0, 0.95)
#: Where a relief starts that is not stated, on that way, of pairs without a highest point of single contact.
_MIDDLE = 0.5


@dataclass(frozen=True)
class Possible:
    """One number of flanks or load that may be otherwise than stated.

    Parameters
    ----------
    kind : {"tip relief", "start", "load", "pitch", "place", "scale", "filter", "bridge"}
        The last four, place of a gauge, scale of the trace, low pass and wiring, leave the pair as it is.
    of : tuple of {"driver", "driven"}
        Gears whose flanks it is of; of a start the first one's roll angle is the number, the other's is displaced as
        much along the line of action.
    stated : float
        [m], of starts [rad], of loads 1.
    low, high : float
        Between which it is looked for.
    made : callable
        A value to the engagement and the factor of the load.
    added : bool
        Whether there is no relief as stated.
    tooth : int
        Of a pitch: which one, counted in meshing order from that of the gauge.
    tolerance : float
        By which it may well be off; zero where nothing is known of it.
    unlikely : float
        Where nothing is known of it, as many tolerances as make it as likely.
    called : str
        Kind of a filter, or arms of a bridge.
    order : int
        Of a filter.
    """

    kind: Kind
    of: tuple[Member, ...]
    stated: float
    low: float
    high: float
    made: Callable[[float], tuple[Engagement, float]]
    added: bool = False
    tooth: int = 0
    tolerance: float = 0.0
    unlikely: float = 2.0
    called: str = ""
    order: int = 1


def possible_flanks(e: Engagement, load_tolerance: float = 0.01) -> tuple[Possible, ...]:
    """Reliefs and loads that a trace of a pair may come from, the load known to a relative tolerance."""
    tips: dict[Member, EndRelief | None] = {member: _tip(_relief(e, member)) for member in MEMBERS}
    found = [
        Possible("load", (), 1.0, *_LOADS, lambda factor: (e, factor), tolerance=load_tolerance),
        Possible("scale", (), 1.0, *_SCALES, lambda _scale: (e, 1.0), tolerance=load_tolerance),
    ]
    more, known = _MODULES * e.pair.driver.module, _KNOWN * e.pair.driver.module
    for member, tip in tips.items():
        start = _usual(e, member) if tip is None else tip
        if start is None:
            continue
        made = partial(_with_amounts, e, {member: start})
        found.append(
            Possible(
                "tip relief", (member,), start.amount, 0.0, _TIMES * start.amount + more, made, tip is None,
                tolerance=math.hypot(known, _AMOUNT_KNOWN * start.amount),
            )
        )  # fmt: skip
        if tip is not None and tip.amount > 0.0:
            found.append(_starts(e, {member: tip}))
    both = {member: tip for member, tip in tips.items() if tip is not None and tip.amount > 0.0}
    if len(both) == len(MEMBERS):
        stated = both["driver"].amount
        high = _TIMES * stated + more
        off = math.hypot(known, _AMOUNT_KNOWN * stated)
        made = partial(_with_amounts, e, both)
        found.append(Possible("tip relief", MEMBERS, stated, 0.0, high, made, tolerance=off))
        found.append(_starts(e, both))
    return tuple(found)


def possible_pitches(e: Engagement, member: Member, tooth: int) -> tuple[Possible, ...]:
    """Deviations of the place of the tooth of a gauge, and of those before and after it.

    Parameters
    ----------
    e : Engagement
    member : {"driver", "driven"}
        Gear that has the gauge.
    tooth : int
        That has it, in meshing order.
    """
    teeth = abs(e.pair.gear(member).teeth)
    given = e.driver_spacing if member == "driver" else e.driven_spacing
    spacing = given if given.size else np.zeros(teeth)

    def made(other: int, value: float) -> tuple[Engagement, float]:
        changed = spacing.copy()
        changed[(tooth + other) % teeth] += value
        return (replace(e, driver_spacing=changed) if member == "driver" else replace(e, driven_spacing=changed)), 1.0

    most, known = _PITCH * e.pair.driver.module, _PITCH_KNOWN * e.pair.driver.module
    return tuple(
        Possible("pitch", (member,), 0.0, -most, most, partial(made, other), tooth=other, tolerance=known)
        for other in (0, -1, 1)
    )


def _relief(e: Engagement, member: Member) -> Relief:
    return e.driver_relief if member == "driver" else e.driven_relief


def _tip(relief: Relief) -> EndRelief | None:
    """The tip relief of a flank that has one; None where it has none, or several."""
    parts = relief.parts if isinstance(relief, CombinedRelief) else (relief,)
    tips = [one for one in parts if isinstance(one, EndRelief) and one.end > one.start]
    return tips[0] if len(tips) == 1 else None


def _ends(e: Engagement, member: Member) -> tuple[float, float]:
    """Roll angles of the pitch point and of the end of the active profile towards the tip."""
    pair = e.pair
    x = pair.x_end if member == "driver" else pair.x_start
    return float(pair.roll_angle(0.0, member)), float(pair.roll_angle(x, member))


def _usual(e: Engagement, member: Member) -> EndRelief | None:
    """A linear relief of no amount from the highest point of single contact of a gear; None of a flank with several."""
    relief, pair = _relief(e, member), e.pair
    parts = relief.parts if isinstance(relief, CombinedRelief) else (relief,)
    pitch, tip = _ends(e, member)
    if any(isinstance(one, EndRelief) and one.end > one.start for one in parts) or not tip > pitch:
        return None
    start = pitch + _MIDDLE * (tip - pitch)
    if 1.0 < pair.contact_ratio < 2.0:
        x = pair.x_start + pair.base_pitch if member == "driver" else pair.x_end - pair.base_pitch
        start = float(pair.roll_angle(x, member))
    return EndRelief(0.0, start, tip) if start < tip else None


def _with_amounts(e: Engagement, tips: dict[Member, EndRelief], amount: float) -> tuple[Engagement, float]:
    """With another amount of the first of some reliefs, and of the others in proportion."""
    first = next(iter(tips.values()))
    for member, tip in tips.items():
        own = amount * (tip.amount / first.amount) if len(tips) > 1 else amount
        e = _with_tip(e, member, tip, replace(tip, amount=own))
    return e, 1.0


def _starts(e: Engagement, tips: dict[Member, EndRelief]) -> Possible:
    """With another start of the first of some reliefs, and of the others by as much along the line of action."""
    first, tip = next(iter(tips.items()))
    pitch, end = _ends(e, first)
    low, high = (pitch + share * (end - pitch) for share in _START)

    def made(start: float) -> tuple[Engagement, float]:
        changed = e
        for member, one in tips.items():
            radii = e.pair.gear(first).base_radius / e.pair.gear(member).base_radius
            begins = min(one.start + (start - tip.start) * radii, one.end - (1.0 - _START[1]) * (one.end - one.start))
            changed = _with_tip(changed, member, one, replace(one, start=begins))
        return changed, 1.0

    return Possible("start", tuple(tips), tip.start, low, high, made, tolerance=_START_KNOWN * (end - pitch))


def _with_tip(e: Engagement, member: Member, tip: EndRelief, other: EndRelief) -> Engagement:
    """With a tip relief in the place of another one, or besides what the flank has."""
    relief = _relief(e, member)
    parts = relief.parts if isinstance(relief, CombinedRelief) else (relief,)
    kept = tuple(one for one in parts if one != tip)
    changed = CombinedRelief((*kept, other))
    return replace(e, driver_relief=changed) if member == "driver" else replace(e, driven_relief=changed)
