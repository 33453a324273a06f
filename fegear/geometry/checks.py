"""Rules of thumb that a drawing is compared with first: tips, roots, clearances, contact ratio."""

from __future__ import annotations

import math
from typing import NamedTuple

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.tip_interference import interference

#: Least normal tooth thickness at the tip circle in modules; case-hardened teeth want 0.4.
LEAST_TIP_THICKNESS = 0.2
#: Least room between a tip circle and the mating root circle, in modules.
LEAST_TIP_CLEARANCE = 0.1
#: Least contact ratio, overlap included, that is usual for a quiet drive.
LEAST_CONTACT_RATIO = 1.2
#: Both profile shifts of a pair are printed with four digits at least: what that takes off their sum, in modules.
ROUNDED_SHIFTS = 1e-4
#: By how much a margin that is searched for may lie below zero where curves just touch [modules]: below any tolerance.
TOUCHING = 1e-5
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

    @property
    def rank(self) -> tuple[int, float]:
        """How bad a broken rule is, the smallest the worst: what cannot run, what is cut away, what is unusual."""
        ratio = self.rule.endswith("contact ratio")
        if self.value < 1.0 if ratio else (self.limit == 0.0 and self.rule != "undercut"):
            return 0, 0.0 if ratio else 1.0
        if self.rule == "undercut":
            return 1, 0.0
        return 2, self.value / self.limit if self.limit else 0.0


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
    hole = "increase the outer radius" if tooth.internal else "reduce the bore"
    checks = [
        Check(name, "tooth thickness at the tip", tip_thickness(gear), LEAST_TIP_THICKNESS * m, "mm",
              "reduce the profile shift or the tip diameter"),
    ]  # fmt: skip
    if not assumed_rim:
        checks.append(Check(name, "rim below the teeth", backup_ratio(gear) * depth, LEAST_RIM * depth, "mm", hole))
    if (undercut := undercut_of(gear)) is not None:
        checks.append(_undercut(name, undercut))
    return tuple(checks)


class Undercut(NamedTuple):
    """What the rack's tip cuts off the involute.

    Attributes
    ----------
    lost : float
        Above the base circle [m]; zero for none.
    profile_shift : float
    enough : float
        Profile shift from which on nothing is cut away, rounded up to four digits.
    straight : float or None
        Depth h of the rack's straight flank below its reference line [normal modules], where
        x_min = h - z sin(alpha_t)^2 / (2 cos(beta)): gears whose thickness is that of their profile shift.
    """

    lost: float
    profile_shift: float
    enough: float
    straight: float | None = None


def undercut_of(gear: Gear) -> Undercut | None:
    """How much of the involute the rack's tip cuts away; None of teeth that no rack generates."""
    tooth = gear.tooth
    if not isinstance(tooth, Tooth):
        return None
    least, lost = tooth.least_profile_shift, 0.0
    if tooth.profile_shift < least - ROUNDED_SHIFTS:
        lost = (tooth.form_radius - tooth.base_radius) * gear.module
    straight = tooth.rack.tip_centre_depth + tooth.rack.tip_radius * math.sin(tooth.rack.pressure_angle)
    by_rule = straight - 0.5 * tooth.teeth * math.sin(gear.transverse_pressure_angle) ** 2 / math.cos(gear.helix_angle)
    holds = abs(by_rule - least) < ROUNDED_SHIFTS
    return Undercut(lost, tooth.profile_shift, math.ceil(least * 1e4) * 1e-4, straight if holds else None)


def _undercut(name: str, found: Undercut) -> Check:
    return Check(
        name, "undercut", 0.0 - found.lost, 0.0, "mm",
        f"increase profile_shift to at least {found.enough:.4f}, or the number of teeth",
        finding=f"{found.lost * 1e3:.4g} mm of the involute above the base circle at profile_shift = "
        f"{found.profile_shift:g}",
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
              pair.total_contact_ratio, LEAST_CONTACT_RATIO, "", "increase tooth depth or number of teeth"),
        Check(name, "backlash along the line of action", pair.normal_backlash, 0.0, "mm",
              "increase the centre distance or reduce the tooth thickness",
              2.0 * ROUNDED_SHIFTS * pair.driver.module * math.sin(pair.driver.normal_pressure_angle)),
    ]  # fmt: skip
    module = pair.driver.module
    for member in MEMBERS:
        found = interference(pair, member)
        checks.append(
            Check(name, f"tip clearance of the {member}", pair.tip_clearance(member), LEAST_TIP_CLEARANCE * module,
                  "mm", "increase the mating dedendum or reduce this tip diameter")
        )  # fmt: skip
        if math.isfinite(found.fillet_gap):
            checks.append(
                Check(name, f"clearance of the {member} tip to the mating fillet", found.fillet_gap, 0.0, "mm",
                      "reduce this tip diameter or the rack tip radius of the mating gear")
            )  # fmt: skip
    checks += [
        Check(name, one.name, one.margin * module, 0.0, "mm", one.trouble, TOUCHING * module)
        for one in (check.of_pinion for check in pair.internal_checks)
        if math.isfinite(one.margin)
    ]
    return tuple(checks)
