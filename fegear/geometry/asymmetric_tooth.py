"""The generated external tooth whose two flanks differ, normal module 1, as exact curves.

Both flanks are involutes, each of a base circle of its own, and both fillets trochoids; the rack's two halves generate
them independently of each other. The tooth's centre line is chosen so that the middle of a tooth space's root land lies
half a pitch beside it: a sector of one tooth then ends on root lands of equal length. The middle of the tip land lies
elsewhere (`InvoluteSide.tip_middle`).

Derivation. The rack's half beside a flank generates that flank as a symmetric rack of its pressure angle would, so base
circle, roll angles and fillet are those of ISO 21771 with the flank's own angle. On the reference line tooth and space
of the rack are pi/2 wide; fed out by x_E, each half loses x_E tan alpha of its own flank, which the gear's tooth gains:
its thickness is pi/2 + x_E (tan alpha_drive + tan alpha_coast), and a flank lies pi/4 + x_E tan alpha beside the line
that passes through the middle of the rack's space.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from fegear.base.errors import GeometryError
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackHalf
from fegear.geometry.curves import Trochoid
from fegear.geometry.external_tooth import THINNEST_NECK
from fegear.geometry.generated_fillet import RackFlankLine, check_trochoid, meeting
from fegear.geometry.involute import inv
from fegear.geometry.involute_side import FLANKS, Flank, check_given
from fegear.geometry.rack import transverse_angle
from fegear.geometry.two_flanks import OneOfTwoFlanks, TwoFlanks


@dataclass(frozen=True)
class AsymmetricTooth(TwoFlanks["AsymmetricSide"]):
    """A generated external tooth with a flank for driving and another one for coasting, spur or helical.

    Parameters
    ----------
    teeth : int
        z, 5 to 1000.
    rack : AsymmetricRack
        Basic rack tooth profile, in its normal section.
    profile_shift : float
        x, in normal modules.
    thickness_allowance : float
        A_sn, reduction of the tooth's normal thickness at the reference circle [modules], made by feeding the rack
        deeper by A_sn / (tan alpha_drive + tan alpha_coast).
    tip_radius : float
        Radius of the tip circle [modules]; NaN, the default, is replaced by r + x + h_aP.
    tip_rounding, tip_chamfer : float
        As of `Tooth`, on both flanks [modules].
    helix_angle : float
        beta on the reference cylinder [rad], from 0 to 60 deg.

    Raises
    ------
    GeometryError
        If the tooth cannot exist: pointed, cut off by undercut, tip below a form circle, rounding too large.
    """

    teeth: int
    rack: AsymmetricRack = field(default_factory=AsymmetricRack)
    profile_shift: float = 0.0
    thickness_allowance: float = 0.0
    tip_radius: float = math.nan
    tip_rounding: float = 0.0
    tip_chamfer: float = 0.0
    helix_angle: float = 0.0

    def __post_init__(self) -> None:
        """Fill in the tip radius and refuse teeth that cannot exist."""
        check_given(self)
        if math.isnan(self.tip_radius):
            object.__setattr__(self, "tip_radius", self.pitch_radius + self.profile_shift + self.rack.addendum)
        if self.root_radius <= 0.0:
            raise GeometryError("rack.dedendum", self.rack.dedendum, "extends to the centre of the gear")
        if self.thickness <= 0.0:
            raise GeometryError(
                "profile_shift", self.profile_shift, "gives zero tooth thickness", "increase the profile shift"
            )
        for flank in FLANKS:
            self.side(flank).check_root()
        self._check_tip()
        self._check_neck()

    # ---- the two sides ---------------------------------------------------------------------------------------------
    def _seen_from(self, flank: Flank) -> AsymmetricSide:
        return AsymmetricSide(self, flank)

    def angle(self, flank: Flank) -> float:
        """Pressure angle of a flank [rad]."""
        return self.rack.half(flank).pressure_angle

    @property
    def reversed(self) -> AsymmetricTooth:
        """The tooth with its flanks exchanged, as of a gear turned round on its shaft."""
        return replace(self, rack=self.rack.reversed)

    # ---- circles and thickness -------------------------------------------------------------------------------------
    @property
    def pitch_radius(self) -> float:
        """r = z / (2 cos(beta)) [modules]."""
        return self.teeth / 2 / math.cos(self.helix_angle)

    @property
    def root_radius(self) -> float:
        """r_f [modules]."""
        return self.pitch_radius + self.generating_shift - self.rack.dedendum

    @property
    def least_profile_shift(self) -> float:
        """x_min, profile shift from which on the rack's tip cuts nothing off either involute."""
        return max(self.side(flank).least_profile_shift for flank in FLANKS)

    @property
    def contact_radius(self) -> float:
        """Radius above which the tooth has both flanks [modules]."""
        return max(self.drive.base_radius, self.coast.base_radius)

    @property
    def tip_land_angle(self) -> float:
        """Angle of the tip land that is left between both flanks, roundings or chamfers [rad]."""
        return self.drive.tip_half_angle + self.coast.tip_half_angle

    # ---- checks ----------------------------------------------------------------------------------------------------
    def _check_tip(self) -> None:
        lowest = self.contact_radius
        if self.tip_radius <= lowest:
            rule = f"must exceed the larger base radius of {lowest:.6g} modules"
            raise GeometryError("tip_radius", f"{self.tip_radius:.6g}", rule, "increase the tip diameter")
        if float(self.drive.thickness_angle(self.tip_radius)) <= 0.0:
            low, high = lowest, self.tip_radius  # the angle falls from the larger base circle on
            for _ in range(80):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if float(self.drive.thickness_angle(middle)) > 0.0 else (low, middle)
            raise GeometryError(
                "tip_radius",
                f"{self.tip_radius:.6g}",
                f"exceeds the intersection of the flanks at {low:.6g} modules (pointed tooth)",
                f"choose a tip diameter below {2 * low * (1.0 - 1e-6):.6g} modules or a smaller profile shift",
            )
        for flank in FLANKS:
            form = self.side(flank).form_radius
            if self.tip_radius <= form:
                raise GeometryError(
                    "tip_radius",
                    f"{self.tip_radius:.6g}",
                    f"gives no involute on the {flank} flank (starts at {form:.6g} modules)",
                    "increase the tip diameter or the profile shift",
                )
        self._check_tip_edge()

    def _check_tip_edge(self) -> None:
        size, key = self.tip_rounding + self.tip_chamfer, "tip_rounding" if self.tip_rounding > 0.0 else "tip_chamfer"
        if size == 0.0:
            return
        sides = self.drive, self.coast
        if any(not side.involute_tip_radius > side.form_radius for side in sides):
            raise GeometryError(key, f"{size:.6g}", "removes the entire involute", "use a smaller one")
        if not self.tip_land_angle > 0.0:
            raise GeometryError(key, f"{size:.6g}", "is too large for the tip", "use a smaller one")

    def _check_neck(self) -> None:
        """Refuse teeth that undercut has cut off, or all but off."""
        radius = np.linspace(self.root_radius, self.tip_radius, 513)
        angle = sum(side.outline_angle(radius) for side in (self.drive, self.coast))
        neck = float(
            (2.0 * radius * np.sin(0.5 * angle))[radius <= max(self.drive.form_radius, self.coast.form_radius)].min()
        )
        if neck < 2.0 * THINNEST_NECK:
            raise GeometryError(
                "profile_shift",
                self.profile_shift,
                "causes undercut from both sides until "
                + ("the tooth is cut off" if neck <= 0.0 else f"a neck of {neck:.2g} modules remains"),
                "increase the profile shift or the number of teeth",
            )


@dataclass(frozen=True)
class AsymmetricSide(OneOfTwoFlanks[AsymmetricTooth]):
    """An asymmetric tooth seen from one of its flanks.

    Parameters
    ----------
    tooth : AsymmetricTooth
    flank : {"drive", "coast"}
    """

    @property
    def rack(self) -> RackHalf:
        """What generates this side."""
        return self.tooth.rack.half(self.flank)

    @cached_property
    def pressure_angle(self) -> float:
        """alpha_t of this flank [rad]."""
        return transverse_angle(self.rack.pressure_angle, self.helix_angle)

    @property
    def root_radius(self) -> float:
        """r_f [modules]."""
        return self.tooth.root_radius

    @property
    def beside(self) -> float:
        """How far the middle of the rack's tip lies beside the middle of its tooth, toward this flank [modules]."""
        shift = self.tooth.rack.tip_shift if self.flank == "drive" else -self.tooth.rack.tip_shift
        return shift / math.cos(self.helix_angle)

    @cached_property
    def base_half_angle(self) -> float:
        """psi_b, angle from the centre line at which the involute leaves the base circle [rad]."""
        thickness = math.pi / 2 + 2.0 * self.tooth.generating_shift * math.tan(self.rack.pressure_angle)
        return thickness / self.teeth + float(inv(self.pressure_angle)) + self.beside / self.pitch_radius

    @property
    def root_land_half_angle(self) -> float:
        """Half the angle of the root land between the two fillets of one tooth space [rad]."""
        return 0.5 * self.tooth.rack.tip_land / math.cos(self.helix_angle) / self.pitch_radius

    # ---- where fillet and involute meet ----------------------------------------------------------------------------
    def _full_trochoid(self) -> Trochoid:
        return Trochoid(
            pitch_radius=self.pitch_radius,
            rounding=self.rack.tip_radius,
            centre_offset=0.5 * self.tooth.rack.tip_land / math.cos(self.helix_angle),
            centre_height=self.tooth.generating_shift - self.rack.tip_centre_depth,
            space_half_angle=math.pi / self.teeth,
            start=0.0,
            end=math.pi / 2 - self.rack.pressure_angle,
            cos_helix=math.cos(self.helix_angle),
        )

    def check_root(self) -> None:
        """Refuse a rack whose tip rounding leaves no fillet on this side."""
        if self.root_land_half_angle > math.pi / self.teeth:
            raise GeometryError("rack.tip_radius", self.rack.tip_radius, "gives a negative root land")
        check_trochoid(self._full_trochoid(), self.rack, self.tooth.profile_shift, f"rack.{self.flank}.tip_radius")

    @cached_property
    def _flank_line(self) -> RackFlankLine:
        half_pitch, shift = 0.5 * math.pi / math.cos(self.helix_angle), self.tooth.generating_shift
        half_space = 0.5 * half_pitch - self.beside
        normal = self.rack.pressure_angle
        return RackFlankLine(self.pressure_angle, self.pitch_radius, half_space, half_pitch, shift, normal)

    @property
    def undercut(self) -> bool:
        """Whether the rack's tip cuts away part of this involute."""
        return self._flank_line.undercut_by(self.rack)

    @property
    def least_profile_shift(self) -> float:
        """Profile shift from which on the rack's tip cuts nothing off this involute."""
        line = self._flank_line
        spare = line.tangent_roll(self.rack) * line.base_radius * math.sin(self.pressure_angle)
        return self.tooth.profile_shift - spare

    @cached_property
    def _root(self) -> tuple[Trochoid, float]:
        """The fillet, and the roll angle of the involute at its end."""
        whole = self._full_trochoid()
        end, roll = meeting(whole, self._flank_line, self._flank_line.tangent_roll(self.rack))
        return replace(whole, end=end), roll

    @property
    def form_roll(self) -> float:
        """Roll angle of the involute where the fillet ends [rad]."""
        return self._root[1]

    # ---- curves ----------------------------------------------------------------------------------------------------
    @property
    def fillet(self) -> Trochoid:
        """The fillet below this flank, from the root circle to the involute."""
        return self._root[0]

    def outline_angle(self, radius: np.ndarray) -> np.ndarray:
        """Angle from the centre line [rad] of fillet or involute at radii from root to tip [modules]."""
        x, y = self.fillet.points(np.linspace(self.fillet.start, self.fillet.end, 513))
        below = np.interp(radius, np.hypot(x, y), np.arctan2(x, y))
        return np.where(radius <= self.form_radius, below, self.flank_angle(np.maximum(radius, self.form_radius)))
