"""Rules of thumb that a drawing is compared with first: tips, roots, clearances, contact ratio.

Whether a tip runs into the mating fillet, from the exact path of its corner past the trochoid (ISO 21771, 5.4.5).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.tooth import Tooth


@dataclass(frozen=True, slots=True)
class Interference:
    """What the tip corner of one gear does near the mating root.

    Parameters
    ----------
    tip_of : {"driver", "driven"}
        The gear whose tip is looked at.
    below_form_circle : bool
        Whether that tip would touch the mate below the start of its involute; the path of contact then ends early.
    fillet_gap : float
        Smallest distance between the tip corner's path and the mating fillet [m]; negative where it cuts into it. In an
        internal pair, where the tip touches the fillet only below the start of the involute, it is infinite.
    root_clearance : float
        Room between the tip circle and the mating root circle [m].
    """

    tip_of: Member
    below_form_circle: bool
    fillet_gap: float
    root_clearance: float

    @property
    def sentence(self) -> str:
        """What a designer should know, in one sentence; empty when all is well."""
        tip = f"the tip of the {self.tip_of} gear"
        if self.root_clearance <= 0.0:
            return f"{tip} cuts {-self.root_clearance * 1e3:.4g} mm into the mating root circle"
        if self.fillet_gap < 0.0:
            return f"{tip} cuts {-self.fillet_gap * 1e3:.4g} mm into the mating fillet"
        if self.below_form_circle:
            return f"{tip} reaches below the start of the mating involute; the path of contact ends there"
        return ""


def interference(pair: GearPair, tip_of: Member, samples: int = 721) -> Interference:
    """Follow the tip corner of one gear through the mating tooth space.

    Parameters
    ----------
    pair : GearPair
    tip_of : {"driver", "driven"}
        The gear whose tip corner is followed.
    samples : int
        Positions of the corner and points of the fillet.

    Returns
    -------
    Interference
    """
    gear = pair.gear(tip_of)
    mate_name: Member = "driven" if tip_of == "driver" else "driver"
    mate = pair.gear(mate_name)
    tip, form = gear.involute_tip_radius, mate.form_radius
    reach = float(pair.x_of_radius(tip, tip_of))
    limit = float(pair.x_of_radius(form, mate_name))
    below = reach > limit if tip_of == "driver" else reach < limit
    if pair.internal:
        return Interference(tip_of, below, math.inf, pair.tip_clearance(tip_of))

    # Mate below with its centre at the origin, gear above; the gear pushes the mate's right flank to the left. At
    # theta = 0 the flanks touch at the pitch point; the gear then turns clockwise, the mate counterclockwise.
    a, rb_g = pair.centre_distance, gear.base_radius
    roll_tip = math.sqrt((tip - rb_g) * (tip + rb_g)) / rb_g
    alpha_w = pair.working_pressure_angle
    # The corner lies behind the point of its flank on the pitch circle by the difference of the involutes' angles.
    corner0 = (roll_tip - math.atan(roll_tip)) - (math.tan(alpha_w) - alpha_w)
    theta = np.linspace(-0.75, 0.75, samples) * 2.0 * math.pi / gear.teeth * 1.5
    angle = corner0 - theta
    px, py = tip * np.sin(angle), a - tip * np.cos(angle)
    turn = theta * gear.teeth / mate.teeth
    # The mate's tooth centre line starts half a tooth to the left of the pitch point and turns further left.
    half = mate.tooth.base_half_angle - (math.tan(alpha_w) - alpha_w)
    s, c = np.sin(half + turn), np.cos(half + turn)
    x, y = c * px + s * py, c * py - s * px
    radius, polar = np.hypot(x, y) / mate.module, np.arctan2(x, y)
    fillet = mate.tooth.fillet
    beta = np.linspace(fillet.start, fillet.end, samples)
    fx, fy = fillet.points(beta)
    fillet_radius, fillet_polar = np.hypot(fx, fy), np.arctan2(fx, fy)
    inside = (radius > fillet_radius[0]) & (radius < fillet_radius[-1])
    if not inside.any():
        return Interference(tip_of, below, math.inf, pair.tip_clearance(tip_of))
    gap = (polar[inside] - np.interp(radius[inside], fillet_radius, fillet_polar)) * radius[inside]
    return Interference(tip_of, below, float(gap.min()) * mate.module, pair.tip_clearance(tip_of))


#: Least normal tooth thickness at the tip circle in modules; case-hardened teeth want 0.4.
LEAST_TIP_THICKNESS = 0.2
#: Least room between a tip circle and the mating root circle, in modules.
LEAST_TIP_CLEARANCE = 0.1
#: Least contact ratio, overlap included, that is usual for a quiet drive.
LEAST_CONTACT_RATIO = 1.2
#: Both profile shifts of a pair are printed with four digits at least: what that takes off their sum, in modules.
ROUNDED_SHIFTS = 1e-4
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
    slack : float
        By how much the value may lie below its limit, as rounded input makes it.
    finding : str
        What the value is where the rule is broken, said in place of value and limit.
    """

    of: str
    rule: str
    value: float
    limit: float
    unit: str
    remedy: str
    slack: float = 0.0
    finding: str = ""

    @property
    def holds(self) -> bool:
        """Whether the rule is kept."""
        return self.value >= self.limit - self.slack


def tip_thickness(gear: Gear) -> float:
    """Normal tooth thickness on the circle where the involute ends [m]."""
    return gear.normal_thickness(gear.involute_tip_radius)


def backup_ratio(gear: Gear) -> float:
    """Rim between the root circle and bore, web or outer circle over the depth of a tooth (m_B of AGMA 2101)."""
    inside = gear.bore_radius if gear.body is None else gear.body.rim_radius
    return (gear.root_radius - inside) / (gear.tip_radius - gear.root_radius)


def gear_checks(name: str, gear: Gear, *, assumed_rim: bool = False) -> tuple[Check, ...]:
    """Rules for one gear.

    Parameters
    ----------
    name : str
    gear : Gear
    assumed_rim : bool
        Whether nobody gave its bore or outer circle, so that its rim is not compared with anything.
    """
    tooth, m = gear.tooth, gear.module
    depth = tooth.side * (tooth.tip_radius - tooth.root_radius) * m
    hole = "take a larger outer radius" if tooth.internal else "take a smaller bore"
    checks = [
        Check(name, "tooth thickness at the tip", tip_thickness(gear), LEAST_TIP_THICKNESS * m, "mm",
              "take less profile shift or a smaller tip diameter"),
    ]  # fmt: skip
    if not assumed_rim:
        checks.append(Check(name, "rim below the teeth", backup_ratio(gear) * depth, LEAST_RIM * depth, "mm", hole))
    if isinstance(tooth, Tooth):
        checks.append(_undercut(name, tooth, m))
    return tuple(checks)


def _undercut(name: str, tooth: Tooth, module: float) -> Check:
    """How much of the involute the rack's tip cuts away, and the profile shift from which on it cuts nothing."""
    least, lost = tooth.least_profile_shift, 0.0
    if tooth.profile_shift < least - ROUNDED_SHIFTS:
        lost = (tooth.form_radius - tooth.base_radius) * module
    enough = math.ceil(least * 1e4) * 1e-4
    return Check(
        name, "undercut", 0.0 - lost, 0.0, "mm",
        f"increase profile_shift to at least {enough:.4f}, or the number of teeth",
        finding=f"{lost * 1e3:.4g} mm of the involute above the base circle at profile_shift = {tooth.profile_shift:g}",
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
              "widen the centre distance or thin the teeth",
              2.0 * ROUNDED_SHIFTS * pair.driver.module * math.sin(pair.driver.normal_pressure_angle)),
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
        for one in (check.of_pinion for check in pair.internal_checks)
        if math.isfinite(one.margin)
    ]
    return tuple(checks)
