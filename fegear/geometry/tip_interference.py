"""Whether a tip runs into the mating fillet, from the exact path of its corner past it (ISO 21771, 5.4.5)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fegear.base.errors import GeometryError
from fegear.geometry.pair import MEMBER_WORDS, MEMBERS, GearPair, Member
from fegear.geometry.shaped_side import ShapedSide

#: Less than this is no interference [m], as round-off and printed diameters leave it.
_MEETS = 1e-6
#: Positions of the corner where a pair may be refused: the gap is then right within 1e-5 modules.
_CLOSELY = 6001


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
        tip = f"the tip of the {MEMBER_WORDS[self.tip_of]}"
        if self.root_clearance <= 0.0:
            return f"{tip} interferes with the mating root circle by {-self.root_clearance * 1e3:.4g} mm"
        if self.fillet_gap < 0.0:
            return f"{tip} interferes with the mating fillet by {-self.fillet_gap * 1e3:.4g} mm"
        if self.below_form_circle:
            return below_form_sentence(self.tip_of)
        return ""


def below_form_sentence(tip_of: Member) -> str:
    """What is said of a tip that would touch the mate below the start of its involute, of geometry and under load."""
    return (
        f"the tip of the {MEMBER_WORDS[tip_of]} reaches below the root form circle of the mating gear (interference); "
        "the path of contact ends there, without corner contact at that end"
    )


#: The other gear of a pair.
_MATE: Mapping[Member, Member] = {"driver": "driven", "driven": "driver"}


def below_form_circle(pair: GearPair, tip_of: Member) -> bool:
    """Whether the involute's tip of one gear would touch the mating flank below the start of its involute.

    Parameters
    ----------
    pair : GearPair
    tip_of : {"driver", "driven"}
    """
    return below_form_by(pair, tip_of) > 0.0


def below_form_by(pair: GearPair, tip_of: Member) -> float:
    """How far the involute's tip of one gear would reach beyond the start of the mating involute.

    Along the line of action [m], negative where it does not.
    """
    reach = float(pair.x_of_radius(pair.gear(tip_of).involute_tip_radius, tip_of))
    return (reach - _limit(pair, tip_of)) * (1.0 if tip_of == "driver" else -1.0)


def clear_tip_radius(pair: GearPair, tip_of: Member) -> float:
    """Tip radius with which the involute of one gear ends where that of the mate starts [m]."""
    return float(pair.radius(_limit(pair, tip_of), tip_of))


def _limit(pair: GearPair, tip_of: Member) -> float:
    """Where on the line of action the involute of the mate starts [m]."""
    return float(pair.x_of_radius(pair.gear(_MATE[tip_of]).form_radius, _MATE[tip_of]))


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
    gear, mate = pair.gear(tip_of), pair.gear(_MATE[tip_of])
    tip, below = gear.involute_tip_radius, below_form_circle(pair, tip_of)
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


def refuse_shaped(pair: GearPair) -> None:
    """Refuse fillets of a user that begin above the active flank, or that the mating tip cuts into.

    Parameters
    ----------
    pair : GearPair

    Raises
    ------
    GeometryError
        With the limit.
    """
    for seen in (pair, pair.from_the_back) if pair.asymmetric else (pair,):
        for member in MEMBERS:
            tooth = seen.gear(member).tooth
            if isinstance(tooth, ShapedSide) and tooth.fillet_key is not None:
                _refuse_shaped(seen, member, tooth.fillet_key)


def _refuse_shaped(pair: GearPair, member: Member, key: str) -> None:
    """Refuse a fillet below a working flank."""
    gear, tip_of = pair.gear(member), MEMBERS[member == "driver"]
    mate = pair.gear(tip_of)
    reach = float(pair.radius(pair.x_of_radius(mate.involute_tip_radius, tip_of), member))
    if gear.tooth.side * (gear.form_radius - reach) > _MEETS:
        side = "above" if gear.tooth.side > 0 else "inside"
        raise GeometryError(
            f"{member}.{key}", f"root form diameter {2e3 * gear.form_radius:.6g} mm",
            f"is {side} the active root diameter of {2e3 * reach:.6g} mm, which the mating tip reaches",
            f"start the flank at {2e3 * reach:.6g} mm or closer to the root",
        )  # fmt: skip
    found = interference(pair, tip_of, _CLOSELY)
    if found.root_clearance <= 0.0 or found.fillet_gap < -_MEETS:
        deep = -min(found.root_clearance, found.fillet_gap)
        raise GeometryError(
            f"{member}.{key}", "the fillet", f"is cut by the path of the mating tip by {deep * 1e3:.4g} mm",
            "move it closer to the root circle, or reduce the mating tip diameter",
        )  # fmt: skip
