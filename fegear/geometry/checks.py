"""Rules of thumb that a drawing is compared with first: tips, roots, clearances, contact ratio."""

from __future__ import annotations

import math
from typing import NamedTuple

from fegear.geometry.gear import Gear
from fegear.geometry.interference import interference
from fegear.geometry.pair import MEMBERS, GearPair

#: Least normal tooth thickness at the tip circle in modules; case-hardened teeth want 0.4.
LEAST_TIP_THICKNESS = 0.2
#: Least room between a tip circle and the mating root circle, in modules.
LEAST_TIP_CLEARANCE = 0.1
#: Least contact ratio, overlap included, that is usual for a quiet drive.
LEAST_CONTACT_RATIO = 1.2
#: Least rim below the root circle, in depths of a tooth: thinner rims bend with their teeth (Y_B of ISO 6336-3 is 1).
LEAST_RIM = 1.2


class Check(NamedTuple):
    """One rule and what the drawing has.

    Attributes
    ----------
    of : str
        The gear or the pair, by its name.
    rule : str
    value, limit : float
        SI; the value must not be below the limit.
    unit : str
        In which both are read; empty for ratios.
    remedy : str
        What a designer would change.
    """

    of: str
    rule: str
    value: float
    limit: float
    unit: str
    remedy: str

    @property
    def holds(self) -> bool:
        """Whether the rule is kept."""
        return self.value >= self.limit


def tip_thickness(gear: Gear) -> float:
    """Normal tooth thickness on the circle where the involute ends [m]."""
    return gear.normal_thickness(gear.involute_tip_radius)


def gear_checks(name: str, gear: Gear) -> tuple[Check, ...]:
    """Rules for one gear.

    Parameters
    ----------
    name : str
    gear : Gear
    """
    tooth, m = gear.tooth, gear.module
    depth = tooth.side * (tooth.tip_radius - tooth.root_radius) * m
    rim = tooth.side * (gear.root_radius - gear.bore_radius)
    hole = "take a larger outer radius" if tooth.internal else "take a smaller bore"
    return (
        Check(name, "tooth thickness at the tip", tip_thickness(gear), LEAST_TIP_THICKNESS * m, "mm",
              "take less profile shift or a smaller tip diameter"),
        Check(name, "rim below the teeth", rim, LEAST_RIM * depth, "mm", hole),
        Check(name, "undercut", -float(tooth.undercut), 0.0, "", "take more profile shift or more teeth"),
    )  # fmt: skip


def pair_checks(name: str, pair: GearPair) -> tuple[Check, ...]:
    """Rules for two gears in mesh.

    Parameters
    ----------
    name : str
    pair : GearPair
    """
    checks = [
        Check(name, "transverse contact ratio" if pair.overlap_ratio == 0.0 else "total contact ratio",
              pair.total_contact_ratio, LEAST_CONTACT_RATIO, "", "lengthen the teeth or raise their number"),
        Check(name, "backlash along the line of action", pair.normal_backlash, 0.0, "mm",
              "widen the centre distance or thin the teeth"),
    ]  # fmt: skip
    module = pair.driver.module
    for member in MEMBERS:
        found = interference(pair, member)
        checks.append(
            Check(name, f"tip clearance of the {member}", pair.tip_clearance(member), LEAST_TIP_CLEARANCE * module,
                  "mm", "deepen the mating root or shorten this tip")
        )  # fmt: skip
        if math.isfinite(found.fillet_gap):
            checks.append(
                Check(name, f"gap of the {member}'s tip to the mating fillet", found.fillet_gap, 0.0, "mm",
                      "shorten this tip or take a smaller rack tip radius on the mate")
            )  # fmt: skip
    checks += [
        Check(name, one.name, one.margin * module, 0.0, "mm", one.trouble)
        for one in pair.internal_checks
        if math.isfinite(one.margin)
    ]
    return tuple(checks)
