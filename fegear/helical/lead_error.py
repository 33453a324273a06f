"""From an error of the pinion's lead, as a machine leaves it, to that of its lead angle (NASA TM-107451, Eq. 18)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.errors import InputError, RangeError

if TYPE_CHECKING:
    from fegear.geometry.gear import Gear

#: A lead that is off by more than this share is another design.
_LARGEST_SHARE = 0.2


def lead_angle_error(pinion: Gear, lead_error: float) -> float:
    """Delta lambda_p1 = sin(2 lambda_p1) Delta H_1 / (2 H_1) [rad], on the pitch cylinder of the design (Eq. 18).

    Parameters
    ----------
    pinion : Gear
        As designed.
    lead_error : float
        Delta H_1 [m], positive where the lead is too long.

    Raises
    ------
    InputError
        For a spur gear, whose lead is infinite.
    RangeError
        If the lead is off by more than a fifth.
    """
    _refuse(pinion, lead_error)
    return 0.5 * math.sin(2.0 * pinion.helix_angle) * lead_error / pinion.lead


def lead_error_as_cut(pinion: Gear, lead_angle: float) -> float:
    """Delta H_1 [m] of the pinion that Appendix 2 makes of a lead angle error [rad], without cancellation.

    Appendix 2 lets the pitch radius follow the lead angle, so that H = pi N m_n / cos(lambda_p); Eq. 18 holds the
    radius. To first order this is sin(lambda_p)^2 times the Delta H_1 that Eq. 18 takes.
    """
    wrong = pinion.helix_angle - lead_angle
    rise = 2.0 * math.cos(pinion.helix_angle - 0.5 * lead_angle) * math.sin(0.5 * lead_angle)
    return math.pi * pinion.teeth * pinion.module * rise / (math.sin(pinion.helix_angle) * math.sin(wrong))


def lead_angle_error_of_cut(pinion: Gear, lead_error: float) -> float:
    """Lead angle error [rad] at which the pinion of Appendix 2 has a lead that is off by `lead_error` [m].

    The inverse of `lead_error_as_cut`; raises as `lead_angle_error` does.
    """
    _refuse(pinion, lead_error)
    sine = math.sin(pinion.helix_angle)
    wrong = sine / (1.0 + lead_error / pinion.lead)
    if wrong >= 1.0:
        raise RangeError("lead", f"{lead_error * 1e3:.6g} mm", "leaves no lead angle", "give a smaller error")
    # sin(beta) - sin(beta') over cos(beta) + cos(beta') is the tangent of half the difference of the angles.
    change = sine * lead_error / (pinion.lead + lead_error)
    return 2.0 * math.atan(change / (math.cos(pinion.helix_angle) + math.sqrt((1.0 - wrong) * (1.0 + wrong))))


def _refuse(pinion: Gear, lead_error: float) -> None:
    shown = f"{lead_error * 1e3:.6g} mm"
    if pinion.helix_angle == 0.0:
        raise InputError("lead", shown, "has no meaning for a spur gear, whose lead is infinite", "give lead_angle")
    if not abs(lead_error) <= _LARGEST_SHARE * pinion.lead:
        raise RangeError(
            "lead", shown, f"is no small error of a lead of {pinion.lead * 1e3:.6g} mm",
            f"keep it within {_LARGEST_SHARE:.0%} of it",
        )  # fmt: skip
