"""The generated tooth of normal module 1: what the basic rack leaves standing, as exact curves (ISO 21771, 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from fegear.base.errors import GeometryError
from fegear.geometry.curves import Trochoid
from fegear.geometry.generated_fillet import (
    ProtuberanceFillet,
    RackFlankLine,
    check_trochoid,
    meeting,
    protuberance_fillet,
)
from fegear.geometry.involute import roll_of_polar_angle
from fegear.geometry.involute_side import check_given
from fegear.geometry.involute_tooth import InvoluteTooth
from fegear.geometry.rack import BasicRack, transverse_angle
from fegear.geometry.shift_of_thickness import ToothNumbers

#: Half the thickness of the thinnest neck that undercut may leave [modules].
THINNEST_NECK = 0.02


@dataclass(frozen=True)
class Tooth(InvoluteTooth):
    """A generated external tooth, spur or helical: its section across the gear's axis, exactly.

    Every length is in normal modules, so that one tooth serves every size. The rack is given in its normal section; the
    section across the axis is cut by the rack's transverse section, which is the normal one stretched along the rack by
    1 / cos(beta): heights stay, flanks stand under alpha_t, and the circle of the rack's tip becomes an ellipse. A
    solid gear is this section turned in proportion to the height along the axis (`Gear.twist`); all curves, radii and
    angles here are those of the section, and so are base pitch and tip edge. A helix angle of zero is a spur tooth.

    Parameters
    ----------
    teeth : int
        z, number of teeth of the gear, 5 to 1000.
    rack : BasicRack
        Basic rack tooth profile.
    profile_shift : float
        x, profile shift coefficient, in normal modules.
    thickness_allowance : float
        A_sn, reduction of the tooth's normal thickness at the reference circle [modules]; made, as on the machine, by
        feeding the rack deeper by A_sn / (2 tan alpha_n) (ISO 21771, generating profile shift coefficient x_E).
    tip_radius : float
        Radius of the tip circle [modules]; NaN, the default, is replaced by r + x + h_aP.
    tip_rounding : float
        Radius of the rounding between flank and tip circle, in the section [modules].
    tip_chamfer : float
        Height of a tip chamfer [modules]: a straight cut that takes as much off the tip's width as off its height.
    helix_angle : float
        beta on the reference cylinder [rad], from 0 to 60 deg; the hand is that of the gear.

    Raises
    ------
    GeometryError
        If the tooth cannot exist: pointed, cut off by undercut, tip below the form circle, negative root land, rounding
        too large.
    """

    teeth: int
    rack: BasicRack = field(default_factory=BasicRack)
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
        self._check_root()
        self._check_tip()

    def _check_root(self) -> None:
        if self.base_half_angle <= 0.0:
            raise GeometryError(
                "profile_shift", self.profile_shift, "gives zero tooth thickness", "increase the profile shift"
            )
        if self.root_radius <= 0.0:
            raise GeometryError("rack.dedendum", self.rack.dedendum, "extends to the centre of the gear")
        if self.root_land_half_angle > math.pi / self.teeth or self.root_land_half_angle < -1e-12:
            raise GeometryError("rack.tip_radius", self.rack.tip_radius, "gives a negative root land")
        check_trochoid(self._full_trochoid(), self.rack, self.profile_shift)

    def _check_tip(self) -> None:
        if self.tip_radius <= self.base_radius:
            raise GeometryError(
                "tip_radius",
                f"{self.tip_radius:.6g}",
                f"must exceed the base radius of {self.base_radius:.6g} modules",
                "increase the tip diameter",
            )
        pointed = self.base_radius * math.hypot(1.0, float(roll_of_polar_angle(self.base_half_angle)))
        if self.tip_radius >= pointed:
            raise GeometryError(
                "tip_radius",
                f"{self.tip_radius:.6g}",
                f"exceeds the intersection of the flanks at {pointed:.6g} modules (pointed tooth)",
                f"choose a tip diameter below {2 * pointed * (1.0 - 1e-6):.6g} modules or a smaller profile shift",
            )
        if self.tip_radius <= self.form_radius:
            raise GeometryError(
                "tip_radius",
                f"{self.tip_radius:.6g}",
                f"gives no involute (starts at {self.form_radius:.6g} modules)",
                "increase the tip diameter or the profile shift",
            )
        self._check_tip_edge()
        neck = float(self.fillet.points(np.linspace(self.fillet.start, self.fillet.end, 257))[0].min())
        if neck < THINNEST_NECK:
            raise GeometryError(
                "profile_shift",
                self.profile_shift,
                "causes undercut from both sides until "
                + ("the tooth is cut off" if neck <= 0.0 else f"a neck of {2.0 * neck:.2g} modules remains"),
                "increase the profile shift or the number of teeth",
            )

    # ---- circles and angles -------------------------------------------------------------------------------------
    @property
    def normal_pressure_angle(self) -> float:
        """alpha_n [rad], that of the rack."""
        return self.rack.pressure_angle

    @cached_property
    def pressure_angle(self) -> float:
        """alpha_t, the transverse pressure angle [rad]; for a spur tooth that of the rack, to the last bit."""
        return transverse_angle(self.rack.pressure_angle, self.helix_angle)

    @property
    def dedendum(self) -> float:
        """h_fP of the basic rack [modules]."""
        return self.rack.dedendum

    @property
    def root_radius(self) -> float:
        """r_f [modules]."""
        return self.pitch_radius + self.generating_shift - self.rack.dedendum

    @property
    def root_land_half_angle(self) -> float:
        """Half the angle of the root land between the two fillets of one tooth space [rad]."""
        return self.rack.tip_centre_offset / math.cos(self.helix_angle) / self.pitch_radius

    # ---- where fillet and involute meet -----------------------------------------------------------------------
    def _full_trochoid(self) -> Trochoid:
        angle = self.rack.protuberance_angle if self.rack.residual_undercut > 0.0 else self.rack.pressure_angle
        return Trochoid(
            pitch_radius=self.pitch_radius,
            rounding=self.rack.tip_radius,
            centre_offset=self.rack.tip_centre_offset / math.cos(self.helix_angle),
            centre_height=self.generating_shift - self.rack.tip_centre_depth,
            space_half_angle=math.pi / self.teeth,
            start=0.0,
            end=math.pi / 2 - angle,
            cos_helix=math.cos(self.helix_angle),
        )

    @cached_property
    def _flank_line(self) -> RackFlankLine:
        half_pitch, normal = 0.5 * math.pi / math.cos(self.helix_angle), self.rack.pressure_angle
        return RackFlankLine(
            self.pressure_angle, self.pitch_radius, 0.5 * half_pitch, half_pitch, self.generating_shift, normal
        )

    @property
    def least_profile_shift(self) -> float:
        """x_min, profile shift from which on the rack's tip cuts nothing off the involute (ISO 21771, 5.2)."""
        numbers = ToothNumbers(self.teeth, self.rack.pressure_angle, self.helix_angle)
        return numbers.least_shift(self.rack) + self.profile_shift - self.generating_shift

    @property
    def undercut(self) -> bool:
        """Whether the rack's tip, or its protuberance, cuts away part of the involute."""
        return self.rack.residual_undercut > 0.0 or self._flank_line.undercut_by(self.rack)

    @cached_property
    def _root(self) -> tuple[Trochoid | ProtuberanceFillet, float]:
        """The fillet, and the roll angle of the involute at its end."""
        whole = self._full_trochoid()
        if self.rack.residual_undercut > 0.0:
            return protuberance_fillet(whole, self.rack, self._flank_line, self.tip_radius, self.helix_angle)
        end, roll = meeting(whole, self._flank_line, self._flank_line.tangent_roll(self.rack))
        return replace(whole, end=end), roll

    @property
    def form_roll(self) -> float:
        """Roll angle of the involute where the fillet ends [rad]."""
        return self._root[1]

    # ---- curves ----------------------------------------------------------------------------------------------------
    @property
    def fillet(self) -> Trochoid | ProtuberanceFillet:
        """The right fillet, from the root circle to the involute."""
        return self._root[0]

    @property
    def trochoid(self) -> Trochoid:
        """The part of the right fillet that the rack's tip rounding cuts: all of it without protuberance."""
        fillet = self.fillet
        return fillet.trochoid if isinstance(fillet, ProtuberanceFillet) else fillet
