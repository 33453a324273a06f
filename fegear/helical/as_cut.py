"""A helical gear as a wrongly set machine cuts it (Litvin and others, NASA TM-107451, Appendix 2 run again)."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.geometry.gear import Gear, Hand


def as_cut(gear: Gear, *, profile_angle: float = 0.0, lead_angle: float = 0.0) -> Gear:
    """The gear as cut with errors of its normal profile angle and lead angle [rad].

    All relations are run again with the wrong angles (the pitch radius follows the lead angle, as in TM-107451); the
    blank keeps its outside radius, the rack its distance from the pitch circle. Where the tip rounding of the rack no
    longer fits between its flanks, it becomes a full one. A lead error makes a spur gear slightly helical: it counts as
    the limit of a left-hand gear.

    Parameters
    ----------
    gear : Gear
    profile_angle, lead_angle : float
        [rad].

    Returns
    -------
    Gear
        The gear itself without errors.

    Raises
    ------
    GeometryError
        If the wrong cut leaves no tooth.
    """
    if profile_angle == 0.0 and lead_angle == 0.0:
        return gear
    helix = gear.helix_angle - lead_angle
    hand: Hand = gear.hand
    if hand == "spur" and helix != 0.0:
        hand = "left" if helix > 0.0 else "right"
    elif helix < 0.0:
        hand = "left" if hand == "right" else "right"
    tooth, rack = gear.tooth, gear.tooth.rack
    angle = rack.pressure_angle + profile_angle
    sharp = replace(rack, tip_radius=0.0, protuberance=0.0, grinding_allowance=0.0, pressure_angle=angle)
    room = sharp.full_fillet_radius + rack.residual_undercut / (1.0 - math.sin(angle))
    cut = replace(rack, pressure_angle=angle, tip_radius=min(rack.tip_radius, room))
    made = replace(
        tooth,
        rack=cut,
        helix_angle=abs(helix),
        thickness_allowance=tooth.thickness_allowance * math.tan(angle) / math.tan(rack.pressure_angle),
    )
    return replace(gear, tooth=made, hand="spur" if helix == 0.0 else hand)
