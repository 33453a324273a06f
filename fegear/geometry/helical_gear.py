"""A helical gear and the relations between its design parameters (Litvin and others, NASA TM-107451, Appendix 2)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

from fegear.errors import GeometryError, InputError
from fegear.geometry.involute import inv
from fegear.geometry.plausible import refuse_size

Hand = Literal["left", "right", "spur"]


@dataclass(frozen=True)
class HelicalGear:
    """A helical gear without profile shift, cut by a rack with half-pitch tooth thickness (no backlash).

    Parameters
    ----------
    teeth : int
        N, at least 3.
    normal_module : float
        m_n = 1 / P_n [m].
    normal_pressure_angle : float
        alpha_n [rad].
    helix_angle : float
        beta on the pitch cylinder [rad], 0 for a spur gear; the lead angle is pi/2 - beta.
    face_width : float
        L [m]; the flank lies within abs(z) <= L/2.
    hand : {"left", "right", "spur"}
        Hand of the helix; "spur" if and only if the helix angle is zero.
    tip_radius : float
        Outside radius [m]; NaN, the default, is replaced by pitch radius plus one normal module.
    flank_depth : float
        Depth below the pitch line to which the cutter's working profile reaches [m]; it ends the flank at the
        form circle. NaN, the default, is one normal module.

    Raises
    ------
    GeometryError, InputError
        If a number breaks its rule or the tip lies below the form circle.
    """

    teeth: int
    normal_module: float
    normal_pressure_angle: float
    helix_angle: float
    face_width: float
    hand: Hand
    tip_radius: float = math.nan
    flank_depth: float = math.nan

    def __post_init__(self) -> None:
        """Fill in tip and depth and refuse what cannot be cut."""
        if int(self.teeth) != self.teeth or self.teeth < 3:
            raise InputError("teeth", self.teeth, "must be a whole number of at least 3")
        for key in ("normal_module", "face_width"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(key, value, "must be positive and finite")
        refuse_size(self.normal_module, self.face_width, "normal_module")
        if not math.radians(5.0) <= self.normal_pressure_angle <= math.radians(40.0):
            angle = f"{math.degrees(self.normal_pressure_angle):.6g} deg"
            raise InputError("normal_pressure_angle", angle, "must lie between 5 and 40 deg")
        if not 0.0 <= self.helix_angle <= math.radians(60.0):
            angle = f"{math.degrees(self.helix_angle):.6g} deg"
            raise InputError("helix_angle", angle, "must lie between 0 and 60 deg", "the hand carries the sign")
        if self.hand not in ("left", "right", "spur"):
            raise InputError("hand", self.hand, 'must be "left", "right" or "spur"')
        if (self.hand == "spur") != (self.helix_angle == 0.0):
            angle = f"{math.degrees(self.helix_angle):.6g} deg"
            raise InputError(
                "hand", f'"{self.hand}" at a helix angle of {angle}', "contradicts the helix angle",
                'give "left" or "right" for a helical gear and "spur" for a helix angle of zero',
            )  # fmt: skip
        self._complete()

    def _complete(self) -> None:
        """Put the defaults in place and refuse a tip that leaves no flank."""
        for key, default in (
            ("tip_radius", self.pitch_radius + self.normal_module),
            ("flank_depth", self.normal_module),
        ):
            if math.isnan(getattr(self, key)):
                object.__setattr__(self, key, default)
        if not math.isfinite(self.tip_radius) or self.tip_radius <= self.base_radius:
            raise GeometryError(
                "tip_radius", f"{self.tip_radius * 1e3:.6g} mm",
                f"lies below the base circle ({self.base_radius * 1e3:.6g} mm), where there is no involute",
                "raise the tip radius or the number of teeth",
            )  # fmt: skip
        if not (math.isfinite(self.flank_depth) and self.flank_depth > 0.0):
            raise InputError("flank_depth", self.flank_depth, "must be positive and finite")
        if self.tip_radius <= self.form_radius:
            raise GeometryError(
                "tip_radius", f"{self.tip_radius * 1e3:.6g} mm",
                f"lies below the form circle ({self.form_radius * 1e3:.6g} mm), where the flank starts",
            )  # fmt: skip
        if self.tip_thickness_angle <= 0.0:
            raise GeometryError(
                "tip_radius", f"{self.tip_radius * 1e3:.6g} mm", "lies beyond the point where the flanks meet",
                "lower the tip radius",
            )  # fmt: skip

    @property
    def lead_angle(self) -> float:
        """lambda_p on the pitch cylinder [rad]."""
        return 0.5 * math.pi - self.helix_angle

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_t [rad] (A.2.1)."""
        return math.atan(math.tan(self.normal_pressure_angle) / math.cos(self.helix_angle))

    @property
    def pitch_radius(self) -> float:
        """r_p [m] (A.2.5)."""
        return 0.5 * self.teeth * self.normal_module / math.cos(self.helix_angle)

    @property
    def base_radius(self) -> float:
        """r_b [m] (A.2.6)."""
        return self.pitch_radius * math.cos(self.transverse_pressure_angle)

    @property
    def base_helix_angle(self) -> float:
        """beta_b [rad], pi/2 minus the lead angle on the base cylinder (A.2.7)."""
        return math.atan(math.tan(self.helix_angle) * math.cos(self.transverse_pressure_angle))

    @property
    def twist(self) -> float:
        """Turn of the transverse section per unit of z [rad/m], positive for a right hand: +-1/p of (A.2.8)."""
        size = math.tan(self.helix_angle) / self.pitch_radius
        return -size if self.hand == "left" else size

    @property
    def angular_pitch(self) -> float:
        """2 pi / N [rad]."""
        return 2.0 * math.pi / self.teeth

    @property
    def half_base_space_angle(self) -> float:
        """mu, half the angle of a tooth space on the base cylinder [rad] (w_t = p_t/2)."""
        return 0.25 * self.angular_pitch - float(inv(self.transverse_pressure_angle))

    @property
    def half_base_tooth_angle(self) -> float:
        """eta, half the angle of a tooth on the base cylinder [rad] (s_t = p_t/2)."""
        return 0.25 * self.angular_pitch + float(inv(self.transverse_pressure_angle))

    @property
    def tip_thickness_angle(self) -> float:
        """Angle of the tooth on the tip circle [rad]."""
        return 2.0 * (self.half_base_tooth_angle - float(inv(math.acos(self.base_radius / self.tip_radius))))

    @cached_property
    def form_radius(self) -> float:
        """Radius at which the flank starts [m]; the base circle where the cutter reaches deeper than that."""
        sin, cos = math.sin(self.transverse_pressure_angle), math.cos(self.transverse_pressure_angle)
        tangent = self.base_radius * sin / cos - self.flank_depth / sin  # length of the base tangent at that depth
        return math.hypot(self.base_radius, max(tangent, 0.0))

    def with_errors(self, *, profile_angle: float = 0.0, lead_angle: float = 0.0) -> HelicalGear:
        """The gear as cut with errors of its normal profile angle and lead angle [rad].

        All relations are run again with the wrong angles (the pitch radius follows the lead angle, as in
        TM-107451); the blank keeps its outside radius. A lead error makes a spur gear slightly helical: it counts
        as the limit of a left-hand gear.
        """
        if profile_angle == 0.0 and lead_angle == 0.0:
            return self
        helix = self.helix_angle - lead_angle
        hand: Hand = self.hand
        if hand == "spur" and helix != 0.0:
            hand = "left" if helix > 0.0 else "right"
        elif helix < 0.0:
            hand = "left" if hand == "right" else "right"
        return replace(
            self,
            normal_pressure_angle=self.normal_pressure_angle + profile_angle,
            helix_angle=abs(helix),
            hand="spur" if helix == 0.0 else hand,
        )
