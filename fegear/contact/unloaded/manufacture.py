"""A helical gear as a wrongly set machine cuts it (Litvin and others, NASA TM-107451, Appendix 2 run again).

What a wrongly set or modified cutter takes off a pinion's designed flank, over roll angle and face (TM-107451).

From an error of the pinion's lead, as a machine leaves it, to that of its lead angle (NASA TM-107451, Eq. 18), and
from one of its normal profile angle to what the flank's equations contain (Eqs. 15 to 17).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from fegear.base.arrays import Array
from fegear.base.errors import InputError, RangeError
from fegear.geometry.gear import Gear, Hand
from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.geometry.involute import polar_angle
from fegear.geometry.rack_cutter import RackFlank


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
    tooth = gear.external_tooth
    rack = tooth.rack
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


@dataclass(frozen=True, slots=True)
class ProfileAngleEffects:
    """What an error of the normal profile angle changes in a pinion (TM-107451, Eqs. 15 to 17).

    Parameters
    ----------
    transverse_angle : float
        Delta alpha_t1, of the transverse profile angle [rad].
    base_lead_angle : float
        Delta lambda_b1, of the lead angle on the base cylinder [rad].
    base_radius : float
        Delta r_b1 [m].
    """

    transverse_angle: float
    base_lead_angle: float
    base_radius: float

    @classmethod
    def by_equations(cls, gear: Gear, error: float) -> ProfileAngleEffects:
        """Eqs. 15 to 17 as printed, which are linear in the error [rad]."""
        alpha_t, lambda_b = gear.transverse_pressure_angle, 0.5 * math.pi - gear.base_helix_angle
        turn = math.sin(2.0 * alpha_t) / math.sin(2.0 * gear.normal_pressure_angle) * error
        rise = 0.5 * math.sin(2.0 * lambda_b) * math.tan(alpha_t) * turn
        return cls(turn, rise, -gear.pitch_radius * math.sin(alpha_t) * turn)

    @classmethod
    def as_cut(cls, gear: Gear, error: float) -> ProfileAngleEffects:
        """Appendix 2 run again with the wrong angle, less the design: no linearisation."""
        cut = as_cut(gear, profile_angle=error)
        return cls(
            cut.transverse_pressure_angle - gear.transverse_pressure_angle,
            gear.base_helix_angle - cut.base_helix_angle,
            cut.base_radius - gear.base_radius,
        )


#: Places over the height of the flank between which the profile's deviation is smooth.
_PLACES = 129


@dataclass(frozen=True)
class CutRemoval:
    """Removal from the designed pinion by its cutter: errors of profile and lead angle, parabola, lengthwise crown.

    The flank as cut is one section turned by twist z - crown z^2, so that the removal is a function of the roll angle
    plus one of the height. It counts from the pitch point in the middle of the face: the pinion's pitch radius follows
    its lead angle (Appendix 2), and the centre distance with it.

    Parameters
    ----------
    gear : Gear
        The pinion as designed.
    profile_angle, lead_angle : float
        Errors of the normal profile angle and the lead angle [rad].
    parabola, crown : float
        See `RackFlank`; the crown in [rad/m^2].

    Raises
    ------
    GeometryError
        If the cut leaves no tooth or no regular flank.
    """

    gear: Gear
    profile_angle: float = 0.0
    lead_angle: float = 0.0
    parabola: float = 0.0
    crown: float = 0.0

    @cached_property
    def _cut(self) -> RackFlank:
        cut = as_cut(self.gear, profile_angle=self.profile_angle, lead_angle=self.lead_angle)
        return RackFlank(cut, self.parabola, self.crown)

    @cached_property
    def _profile(self) -> CubicSpline:
        """Azimuth of the section as cut ahead of the designed one [rad], over the designed roll angle."""
        flank, base = self._cut, self.gear.base_radius
        section, _ = flank.profile(np.linspace(flank.s_form, flank.s_tip, _PLACES))
        section = section[np.abs(section) > base]
        radius = np.abs(section)
        roll = np.sqrt((radius - base) * (radius + base)) / base
        offset = InvoluteHelicoid.of(self.gear, "space").offset
        return CubicSpline(roll, np.angle(section) - (offset - polar_angle(roll)))

    @property
    def face_kinks(self) -> tuple[float, ...]:
        """None."""
        return ()

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Material removed [m] at roll angles [rad] and heights [m]; heights are those of `flank_modification`."""
        up = -np.asarray(z, dtype=float)  # the paper's pinion turns counter-clockwise
        turn = (self._cut.gear.twist - self.gear.twist) * up - self.crown * up**2
        pitch = np.sqrt((self.gear.pitch_radius / self.gear.base_radius) ** 2 - 1.0)
        return np.asarray(-self.gear.base_radius * (self._profile(roll) - self._profile(pitch) + turn))


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
        raise RangeError("lead", f"{lead_error * 1e3:.6g} mm", "gives no lead angle", "specify a smaller error")
    # sin(beta) - sin(beta') over cos(beta) + cos(beta') is the tangent of half the difference of the angles.
    change = sine * lead_error / (pinion.lead + lead_error)
    return 2.0 * math.atan(change / (math.cos(pinion.helix_angle) + math.sqrt((1.0 - wrong) * (1.0 + wrong))))


def _refuse(pinion: Gear, lead_error: float) -> None:
    shown = f"{lead_error * 1e3:.6g} mm"
    if pinion.helix_angle == 0.0:
        raise InputError("lead", shown, "is not used for a spur gear, whose lead is infinite", "specify lead_angle")
    if not abs(lead_error) <= _LARGEST_SHARE * pinion.lead:
        raise RangeError(
            "lead", shown, f"is not small relative to the lead of {pinion.lead * 1e3:.6g} mm",
            f"keep it within {100.0 * _LARGEST_SHARE:g} % of it",
        )  # fmt: skip
