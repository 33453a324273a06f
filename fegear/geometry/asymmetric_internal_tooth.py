"""The internal tooth whose two flanks differ, normal module 1: what an asymmetric pinion-type cutter leaves standing.

Both flanks of the cutter are involutes of base circles of their own, and each generates the flank of its own kind. The
tooth's centre line is chosen so that the middle of a tooth space's root land lies half a pitch beside it, and that of
the cutter passes through the middle of its tip land, which cuts that root land.

Derivation. Cutter and gear roll on each other without backlash, at the distance a_0 of their axes, with a working
pressure angle for each flank, cos(alpha_w) = (r_b - r_b0) / a_0. On the rolling circles a tooth of the cutter fills the
space, so that each flank of the gear stands at

    psi_b = (pi - z_0 (psi_b0 - inv alpha_w)) / z - inv alpha_w

beside its centre line, psi_b0 that of the cutter. The tooth's thickness on the reference circle is pi / 2 + x_E times
the sum of both tan alpha, which decides the distance:

    (z - z_0) sum inv alpha_w = (z - z_0) sum inv alpha - 2 (x_E + x_0) sum tan alpha.

With equal flanks it is the generation of `InternalTooth` (ISO 21771).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.curves import Involute, PinionTipFillet
from fegear.geometry.internal_tooth import PinionCutter, leaving_margin
from fegear.geometry.involute import inv
from fegear.geometry.involute_side import FLANKS, Flank, check_given
from fegear.geometry.rack import transverse_angle
from fegear.geometry.two_flanks import OneOfTwoFlanks, TwoFlanks

#: As of `InternalTooth`: fewest teeth more than the cutter has, and places at which a fillet is looked at.
_FEWEST_MORE, _LOOKED_AT = 3, 129
#: Largest distance of the axes in generation, over the smallest.
_FARTHEST = 4.0


@dataclass(frozen=True)
class AsymmetricInternalTooth(TwoFlanks["AsymmetricInternalSide"]):
    """A tooth of an internal gear, spur or helical, with a flank for driving and another one for coasting.

    Parameters
    ----------
    teeth : int
        z, 10 to 1000, and at least three more than the cutter has.
    cutter : PinionCutter
        Its `tip_radius` is that of the rounding beside its drive flank.
    drive_angle, coast_angle : float
        Pressure angles of gear and cutter, in the normal section [rad].
    coast_tip_radius : float
        Rounding of the cutter's tip beside its coast flank [modules].
    profile_shift, thickness_allowance, tip_radius, tip_rounding, tip_chamfer : float
        As of `InternalTooth` [modules].
    helix_angle : float
        beta on the reference cylinder [rad].

    Raises
    ------
    GeometryError
        As of `InternalTooth`, for either flank.
    """

    teeth: int
    cutter: PinionCutter
    drive_angle: float
    coast_angle: float
    coast_tip_radius: float = 0.2
    profile_shift: float = 0.0
    thickness_allowance: float = 0.0
    tip_radius: float = math.nan
    tip_rounding: float = 0.0
    tip_chamfer: float = 0.0
    helix_angle: float = 0.0

    def __post_init__(self) -> None:
        """Fill in the tip radius and the cutter's addendum, and refuse teeth that cannot exist."""
        check_given(self)
        cutter = self.cutter
        if self.teeth - cutter.teeth < _FEWEST_MORE:
            raise GeometryError(
                "cutter.teeth", cutter.teeth, f"leaves a difference below {_FEWEST_MORE} to the {self.teeth} teeth of "
                "the gear", f"choose a cutter of at most {self.teeth - _FEWEST_MORE} teeth",
            )  # fmt: skip
        for key, angle in (("pressure_angle", self.drive_angle), ("coast_pressure_angle", self.coast_angle)):
            if not math.radians(5.0) <= angle <= math.radians(45.0):
                raise GeometryError(key, f"{math.degrees(angle):.6g} deg", "must be between 5 and 45 deg")
        if not (math.isfinite(self.coast_tip_radius) and self.coast_tip_radius >= 0.0):
            raise GeometryError("cutter.coast_tip_radius", self.coast_tip_radius, "must not be negative")
        if math.isnan(self.tip_radius):
            object.__setattr__(self, "tip_radius", self.pitch_radius - self.profile_shift - 1.0)
        distance = self.generating_distance
        if not math.isnan(cutter.root_radius):
            addendum = cutter.root_radius - distance - self.cutter_pitch - cutter.profile_shift
            object.__setattr__(self, "cutter", replace(cutter, addendum=addendum, root_radius=math.nan))
        self._check_cutter()
        for flank in FLANKS:
            self.side(flank).check()
        self._check_tip()

    # ---- the two sides ---------------------------------------------------------------------------------------------
    def _seen_from(self, flank: Flank) -> AsymmetricInternalSide:
        return AsymmetricInternalSide(self, flank)

    @property
    def reversed(self) -> AsymmetricInternalTooth:
        """The tooth with its flanks exchanged, as of a gear turned round on its shaft."""
        return replace(
            self, cutter=replace(self.cutter, tip_radius=self.coast_tip_radius), drive_angle=self.coast_angle,
            coast_angle=self.drive_angle, coast_tip_radius=self.cutter.tip_radius,
        )  # fmt: skip

    def angle(self, flank: Flank) -> float:
        """Pressure angle of a flank [rad]."""
        return self.drive_angle if flank == "drive" else self.coast_angle

    def rounding(self, flank: Flank) -> float:
        """Of the cutter's tip beside a flank [modules]."""
        return self.cutter.tip_radius if flank == "drive" else self.coast_tip_radius

    # ---- generation ------------------------------------------------------------------------------------------------
    @property
    def pitch_radius(self) -> float:
        """r = z / (2 cos(beta)) [modules]."""
        return self.teeth / 2 / math.cos(self.helix_angle)

    @property
    def cutter_pitch(self) -> float:
        """r_0, reference radius of the cutter [modules]."""
        return self.cutter.teeth / 2 / math.cos(self.helix_angle)

    def section_angle(self, flank: Flank) -> float:
        """alpha_t, pressure angle of a flank in the section across the axis [rad]."""
        return transverse_angle(self.angle(flank), self.helix_angle)

    def cutter_base(self, flank: Flank) -> float:
        """Base radius of the cutter's flank [modules]."""
        return self.cutter_pitch * math.cos(self.section_angle(flank))

    @cached_property
    def generating_distance(self) -> float:
        """a_0, centre distance of gear and cutter in generation [modules].

        Raises
        ------
        GeometryError
            If they have no working pressure angle.
        """
        from scipy.optimize import brentq

        more, angles = 0.5 * (self.teeth - self.cutter.teeth), [self.section_angle(flank) for flank in FLANKS]
        bases = [(self.pitch_radius - self.cutter_pitch) * math.cos(angle) for angle in angles]
        play = (self.generating_shift + self.cutter.profile_shift) * self._tangents / more
        wanted = sum(float(inv(angle)) for angle in angles) - play

        def off(distance: float) -> float:
            return sum(float(inv(math.acos(min(base / distance, 1.0)))) for base in bases) - wanted

        least = max(bases) * (1.0 + 1e-9)
        if off(least) > 0.0:
            most = (sum(float(inv(angle)) for angle in angles) - off(least) - wanted) * more
            most = most / self._tangents - self.cutter.profile_shift
            raise GeometryError(
                "profile_shift", self.profile_shift, "gives no working pressure angle of gear and cutter",
                f"choose a profile shift below {math.floor(most * 1e3) * 1e-3:.3f} or a cutter of fewer teeth",
            )  # fmt: skip
        if off(_FARTHEST * least) < 0.0:
            raise GeometryError(
                "profile_shift", self.profile_shift, "gives a working pressure angle of gear and cutter above "
                f"{math.degrees(math.acos(1.0 / _FARTHEST)):.0f} deg", "increase it, or the shift of the cutter",
            )  # fmt: skip
        found = float(brentq(off, least, _FARTHEST * least, xtol=1e-14, rtol=9e-16))
        for _ in range(2):  # to the last digits: inv'(alpha) = tan^2 alpha, d alpha / d a = 1 / (a tan alpha)
            slope = sum(math.tan(math.acos(base / found)) for base in bases) / found
            found -= off(found) / slope
        return found

    @property
    def cutter_tip(self) -> float:
        """Tip radius of the cutter [modules]."""
        return self.cutter_pitch + self.cutter.profile_shift + self.cutter.addendum

    @property
    def root_radius(self) -> float:
        """r_f [modules]: how far the cutter's tip reaches."""
        return self.generating_distance + self.cutter_tip

    def cutter_rounding(self, flank: Flank, share: float = 1.0) -> tuple[float, float, float]:
        """Roll length of the cutter's flank where its tip rounding starts; angles of its normal and of its centre.

        Angles are from the line about which its tooth is as thick toward either flank as a symmetric one of that
        flank's pressure angle [rad]; of a share of the rounding.
        """
        angle, radius, cutter = self.angle(flank), share * self.rounding(flank), self.cutter
        base, thickness = self.cutter_base(flank), math.pi / 2 + 2.0 * cutter.profile_shift * math.tan(angle)
        half = thickness / cutter.teeth + float(inv(self.section_angle(flank)))
        centre = self.cutter_tip - radius
        inner = math.sqrt(max(centre - base, 0.0) * (centre + base))
        normal = half - (radius + inner) / base
        return radius + inner, normal, normal + math.atan(inner / base)

    @cached_property
    def cutter_land(self) -> float:
        """Half the angle of the cutter's tip land between the centres of both roundings [rad]."""
        return self._land(1.0)

    def _land(self, share: float) -> float:
        """The same with a share of both roundings."""
        return 0.5 * sum(self.cutter_rounding(flank, share)[2] for flank in FLANKS)

    # ---- checks ----------------------------------------------------------------------------------------------------
    def _check_cutter(self) -> None:
        for flank in FLANKS:
            base = self.cutter_base(flank)
            if self.cutter_tip - self.rounding(flank) <= base:
                raise GeometryError(
                    "cutter.addendum", f"{self.cutter.addendum:.6g}",
                    f"places the cutter tip rounding inside its base circle of radius {base:.6g} modules",
                    "increase addendum or profile shift of the cutter, or reduce its tip radius",
                )  # fmt: skip
        if self.cutter_land >= -1e-12:
            return
        if self._land(0.0) < 0.0:
            raise GeometryError(
                "cutter.addendum", f"{self.cutter.addendum:.6g}", "gives a pointed cutter tooth",
                "choose a smaller addendum or profile shift of the cutter",
            )  # fmt: skip
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._land(middle) >= 0.0 else (low, middle)
        both = [math.floor(low * self.rounding(flank) * 1e4) * 1e-4 for flank in FLANKS]
        raise GeometryError(
            "cutter.tip_radius", f"{self.cutter.tip_radius:.6g} and {self.coast_tip_radius:.6g}",
            "do not fit side by side on the cutter tip", f"use at most {both[0]:.4f} and {both[1]:.4f} modules",
        )  # fmt: skip

    def _check_tip(self) -> None:
        tip, both = self.tip_radius, [self.side(flank) for flank in FLANKS]
        limit = max(side.limit_radius for side in both)
        base = max(side.base_radius for side in both)
        if not (tip > base and min(side.involute_tip_radius for side in both) >= limit):
            raise GeometryError(
                "tip_radius", f"{tip:.6g}",
                f"is inside {max(limit, base):.6g} modules, the limit of the involutes generated by a cutter of "
                f"{self.cutter.teeth} teeth", "increase the tip diameter, or choose a cutter with more teeth",
            )  # fmt: skip
        form = min(side.form_radius for side in both)
        if tip >= form:
            raise GeometryError(
                "tip_radius", f"{tip:.6g}", f"gives no involute (ends at {form:.6g} modules)",
                "reduce the tip diameter or the profile shift",
            )  # fmt: skip
        if float(self.drive.thickness_angle(tip)) <= 0.0:
            raise GeometryError(
                "tip_radius", f"{tip:.6g}", "exceeds the intersection of the flanks (pointed tooth)",
                "choose a larger tip diameter or a larger profile shift",
            )  # fmt: skip
        size, key = self.tip_rounding + self.tip_chamfer, "tip_rounding" if self.tip_rounding > 0.0 else "tip_chamfer"
        if size and any(not side.involute_tip_radius < side.form_radius for side in both):
            raise GeometryError(key, f"{size:.6g}", "removes the entire involute", "use a smaller one")
        if size and not sum(side.tip_half_angle for side in both) > 0.0:
            raise GeometryError(key, f"{size:.6g}", "is too large for the tip", "use a smaller one")
        for side in both:
            own = (self.cutter.teeth, self.cutter_tip, self.cutter_base(side.flank))
            if leaving_margin(own, (self.teeth, tip, side.base_radius), self.generating_distance) < 0.0:
                raise GeometryError(
                    "cutter.teeth", self.cutter.teeth, "are too many: the cutter trims the gear tips (tip "
                    "interference)", "choose a cutter with fewer teeth, or a larger tip diameter",
                )  # fmt: skip


@dataclass(frozen=True)
class AsymmetricInternalSide(OneOfTwoFlanks[AsymmetricInternalTooth]):
    """An asymmetric internal tooth seen from one of its flanks.

    Parameters
    ----------
    tooth : AsymmetricInternalTooth
    flank : {"drive", "coast"}
    """

    side: ClassVar[int] = -1

    @property
    def pressure_angle(self) -> float:
        """alpha_t of this flank [rad]."""
        return self.tooth.section_angle(self.flank)

    @property
    def root_radius(self) -> float:
        """r_f [modules]."""
        return self.tooth.root_radius

    @cached_property
    def generating_angle(self) -> float:
        """alpha_w0 of this flank, working pressure angle of the generation [rad]."""
        more = (self.pitch_radius - self.tooth.cutter_pitch) * math.cos(self.pressure_angle)
        return math.acos(min(more / self.tooth.generating_distance, 1.0))

    @cached_property
    def _cutter(self) -> tuple[float, float, float]:
        """As `cutter_rounding`, with half the angle at the base circle in the place of the centre's.

        Angles are from the middle of the cutter's tip land.
        """
        length, normal, centre = self.tooth.cutter_rounding(self.flank)
        beside, cutter = self.tooth.cutter_land - centre, self.tooth.cutter
        thickness = math.pi / 2 + 2.0 * cutter.profile_shift * math.tan(self.normal_pressure_angle)
        half = thickness / cutter.teeth + float(inv(self.pressure_angle))
        return length, normal + beside, half + beside

    @cached_property
    def base_half_angle(self) -> float:
        """psi_b, angle from the centre line at which the involute leaves the base circle [rad]; may be negative."""
        working = float(inv(self.generating_angle))
        return (math.pi - self.tooth.cutter.teeth * (self._cutter[2] - working)) / self.teeth - working

    @property
    def limit_radius(self) -> float:
        """Radius inside which the cutter makes no involute on this side [modules]."""
        return math.hypot(self.base_radius, self.tooth.generating_distance * math.sin(self.generating_angle))

    @property
    def root_land_half_angle(self) -> float:
        """Half the angle of the root land between the two fillets of one tooth space [rad]."""
        return self.fillet.start * self.tooth.cutter.teeth / self.teeth

    @property
    def undercut(self) -> bool:
        """Whether the involute starts in a corner: never, for the cutter's rounding joins its flank smoothly."""
        return False

    @cached_property
    def form_roll(self) -> float:
        """Roll angle of the involute where it starts near the root circle [rad]."""
        length = self.tooth.generating_distance * math.sin(self.generating_angle) + self._cutter[0]
        return -length / self.base_radius

    @cached_property
    def fillet(self) -> PinionTipFillet:
        """The fillet beside this flank, from the root circle to the involute."""
        tooth, ratio = self.tooth, self.tooth.cutter.teeth / self.teeth
        land = max(tooth.cutter_land, 0.0)
        return PinionTipFillet(
            rolling_radius=tooth.generating_distance * ratio / (1.0 - ratio),
            centre_distance=tooth.generating_distance,
            centre_radius=tooth.cutter_tip - tooth.rounding(self.flank),
            centre_angle=land,
            rounding=tooth.rounding(self.flank),
            ratio=ratio,
            space_half_angle=math.pi / self.teeth,
            start=land,
            end=0.5 * math.pi + self._cutter[1],
        )

    def check(self) -> None:
        """Refuse a cutter that leaves no fillet on this side."""
        if self.root_land_half_angle > math.pi / self.teeth:
            raise GeometryError(
                "cutter.profile_shift", self.tooth.cutter.profile_shift, "gives no tooth at the root circle"
            )
        fillet = self.fillet
        if np.min(fillet.speed(np.linspace(fillet.start, fillet.end, _LOOKED_AT))) <= 0.0:
            key = "tip_radius" if self.flank == "drive" else "coast_tip_radius"
            raise GeometryError(
                f"cutter.{key}", self.tooth.rounding(self.flank), "generates a fillet with a loop or cusp",
                "choose a larger addendum of the cutter, or another tip radius",
            )  # fmt: skip

    def cutter_tooth(self, count: int = 25) -> Array:
        """Outline of the cutter's tooth in its own frame, +y through the middle of its tip land [modules], (2, N).

        From the foot of its right flank over the tip to the left one, which cuts this side.
        """
        right, left = self.back.cutter_half(count), self.cutter_half(count)
        return np.hstack([right, left[:, ::-1] * np.array([[-1.0], [1.0]])])

    def cutter_half(self, count: int) -> Array:
        """Half of it, of the flank that cuts this side, on the right [modules], (2, 2 count + 1)."""
        tooth, base = self.tooth, self.tooth.cutter_base(self.flank)
        length, normal, half = self._cutter
        rho = tooth.rounding(self.flank)
        b = np.linspace(0.5 * math.pi + normal, max(tooth.cutter_land, 0.0), count)
        at, centre = tooth.cutter_tip - rho, max(tooth.cutter_land, 0.0)
        rounding = at * np.array([[math.sin(centre)], [math.cos(centre)]]) + rho * np.stack([np.sin(b), np.cos(b)])
        roll = np.linspace(0.0, length / base, count)
        flank = Involute(base, half, 0.0, float(roll[-1])).points(roll)
        foot = flank[:, :1] * max(math.sqrt(max(1.0 - 2.0 / base, 0.0)), 1e-3)
        return np.hstack([foot, flank, rounding])
