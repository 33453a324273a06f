"""Limits of the tip reliefs that a case asks to find: ``[design]`` ``relieve`` and ``limits``."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError
from fegear.design.tip_relief.relief_limits import SHORTEST, ReliefLimits
from fegear.geometry.pair import MEMBERS
from fegear.geometry.plausible_flanks import DEEPEST_RELIEF
from fegear.geometry.relief import roll_of_radius

if TYPE_CHECKING:
    from fegear.case.design import DesignPart, LimitsPart
    from fegear.geometry.pair import GearPair, Member


def relief_limits(part: DesignPart, pair: GearPair) -> ReliefLimits | None:
    """What the tip reliefs of a pair may be; None where nothing is limited.

    Raises
    ------
    RangeError
        If a limit leaves no room for a relief.
    """
    asked = part.limits
    if part.relieve == "both" and asked is None:
        return None
    amount = math.inf if asked is None or asked.amount is None else asked.amount
    deepest = DEEPEST_RELIEF * max(pair.gear(member).module for member in MEMBERS)
    if math.isfinite(amount) and amount > deepest:
        meant = f'did you mean "{amount * 1e3:.6g} um"?' if amount * 1e-3 <= deepest else "check the unit:"
        raise RangeError(
            "design.limits.amount", f"{amount * 1e3:.6g} mm",
            f"is above {deepest * 1e3:.6g} mm, the maximum of {DEEPEST_RELIEF:g} module that a tooth can lose",
            f"{meant} Reliefs are some tens of micrometres",
        )  # fmt: skip
    relieved = [part.relieve in ("both", member) for member in MEMBERS]
    driver, driven = (math.inf if asked is None else _longest(asked, pair, member) for member in MEMBERS)
    amounts = [amount if one else 0.0 for one in relieved]
    return ReliefLimits((amounts[0], amounts[1]), (driver, driven))


def _longest(asked: LimitsPart, pair: GearPair, member: Member) -> float:
    """Largest length over the path of contact, by length and start diameter."""
    found, gear = [math.inf], pair.gear(member)
    if asked.length is not None:
        if asked.length < SHORTEST * pair.path_length:
            raise RangeError(
                "design.limits.length", f"{asked.length * 1e3:.6g} mm",
                f"must be at least {SHORTEST * pair.path_length * 1e3:.3g} mm, 2 % of the path of contact",
            )  # fmt: skip
        found.append(asked.length / pair.path_length)
    start = asked.driver_start_diameter if member == "driver" else asked.driven_start_diameter
    if start is not None:
        tip = float(roll_of_radius(gear, gear.involute_tip_radius))
        ends = sorted(2.0 * float(pair.radius(x, member)) for x in (pair.x_start, pair.x_end))
        if not ends[0] <= start <= ends[1]:
            raise _outside(member, start, ends)
        length = gear.base_radius * abs(tip - float(roll_of_radius(gear, 0.5 * start))) / pair.path_length
        if length < SHORTEST:
            raise _outside(member, start, ends)
        found.append(length)
    return min(found)


def _outside(member: Member, start: float, ends: list[float]) -> RangeError:
    return RangeError(
        f"design.limits.{member}_start_diameter", f"{start * 1e3:.6g} mm",
        f"is outside the active profile, {ends[0] * 1e3:.6g} to {ends[1] * 1e3:.6g} mm, or too close to the tip",
    )  # fmt: skip
