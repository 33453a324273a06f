"""The generated tooth of normal module 1: what the basic rack leaves standing, as exact curves (ISO 21771, 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import GeometryError
from fegear.geometry.curves import Arc, Curve, Involute, Line, Trochoid
from fegear.geometry.fillet import ProtuberanceFillet, RackFlankLine, meeting, protuberance_fillet
from fegear.geometry.involute import inv, polar_angle, roll_of_polar_angle
from fegear.geometry.rack import BasicRack, transverse_angle

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array

#: Largest helix angle on the pitch cylinder [rad].
LARGEST_HELIX_ANGLE = math.radians(60.0)
#: Half the thickness of the thinnest neck that undercut may leave [modules].
_THINNEST_NECK = 0.02
#: A rack tip as sharp as this [modules] needs as much room below the pitch line to leave a fillet.
_SMALLEST_FILLET = 1e-6


@dataclass(frozen=True)
class Tooth:
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
        A_sn, reduction of the tooth's normal thickness at the pitch circle [modules]; made, as on the machine, by
        feeding the rack deeper by A_sn / (2 tan alpha_n) (ISO 21771, generating profile shift coefficient x_E).
    tip_radius : float
        Radius of the tip circle [modules]; NaN, the default, is replaced by r + x + h_aP.
    tip_rounding : float
        Radius of the rounding between flank and tip circle, in the section [modules].
    tip_chamfer : float
        Height of a tip chamfer [modules]: a straight cut that takes as much off the tip's width as off its height.
    helix_angle : float
        beta on the pitch cylinder [rad], from 0 to 60 deg; the hand is that of the gear.

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
        z = self.teeth
        if isinstance(z, bool) or int(z) != z:
            raise GeometryError("teeth", z, "must be a whole number")
        if not 0.0 <= self.helix_angle <= LARGEST_HELIX_ANGLE:
            angle = f"{math.degrees(self.helix_angle):.6g} deg"
            raise GeometryError("helix_angle", angle, "must lie between 0 and 60 deg", "the hand carries the sign")
        fewest = max(3, math.ceil(5.0 * math.cos(self.helix_angle) ** 3 - 1e-9))  # as many as five of a spur gear
        if not fewest <= z <= 1000:
            remedy = "model a rack as a gear with many teeth"
            raise GeometryError("teeth", z, f"must lie between {fewest} and 1000", remedy)
        object.__setattr__(self, "teeth", int(z))
        for name in ("profile_shift", "thickness_allowance", "tip_rounding", "tip_chamfer"):
            if not math.isfinite(getattr(self, name)):
                raise GeometryError(name, getattr(self, name), "must be finite")
        if math.isnan(self.tip_radius):
            object.__setattr__(self, "tip_radius", self.pitch_radius + self.profile_shift + self.rack.addendum)
        if math.isinf(self.tip_radius):
            raise GeometryError("tip_radius", self.tip_radius, "must be finite")
        for name in ("tip_rounding", "tip_chamfer"):
            if getattr(self, name) < 0.0:
                raise GeometryError(name, getattr(self, name), "must not be negative")
        if self.tip_rounding > 0.0 and self.tip_chamfer > 0.0:
            raise GeometryError(
                "tip_chamfer", self.tip_chamfer, "contradicts a tip rounding", "give either the rounding or the chamfer"
            )
        self._check_root()
        self._check_tip()

    def _check_root(self) -> None:
        if self.base_half_angle <= 0.0:
            raise GeometryError(
                "profile_shift", self.profile_shift, "leaves a tooth of no thickness", "raise the profile shift"
            )
        if self.root_radius <= 0.0:
            raise GeometryError("rack.dedendum", self.rack.dedendum, "cuts through the gear's centre")
        if self.root_land_half_angle > math.pi / self.teeth or self.root_land_half_angle < -1e-12:
            raise GeometryError("rack.tip_radius", self.rack.tip_radius, "leaves a negative root land")
        if max(self.rack.tip_radius, abs(self.rack.tip_centre_depth - self.profile_shift)) < _SMALLEST_FILLET:
            raise GeometryError(
                "rack.tip_radius",
                self.rack.tip_radius,
                "is a sharp corner that rolls on the pitch line itself: it generates a notch, no fillet",
                "give the rack a tip radius, or a profile shift unlike its dedendum",
            )
        fillet = self._full_trochoid()
        if np.min(fillet.speed(np.linspace(fillet.start, fillet.end, 65))) < 0.0:
            raise GeometryError(
                "profile_shift",
                self.profile_shift,
                "is so large that the rack's tip rounding loops over the pitch line",
                f"choose a profile shift below {self.rack.tip_centre_depth:.4f} or a larger rack tip radius",
            )

    def _check_tip(self) -> None:
        if self.tip_radius <= self.base_radius:
            raise GeometryError(
                "tip_radius",
                f"{self.tip_radius:.6g}",
                f"must exceed the base radius of {self.base_radius:.6g} modules",
                "raise the tip diameter",
            )
        pointed = self.base_radius * math.hypot(1.0, float(roll_of_polar_angle(self.base_half_angle)))
        if self.tip_radius >= pointed:
            raise GeometryError(
                "tip_radius",
                f"{self.tip_radius:.6g}",
                f"is beyond the point where the flanks meet, {pointed:.6g} modules: the tooth is pointed",
                f"choose a tip diameter below {2 * pointed * (1.0 - 1e-6):.6g} modules or a smaller profile shift",
            )
        if self.tip_radius <= self.form_radius:
            raise GeometryError(
                "tip_radius",
                f"{self.tip_radius:.6g}",
                f"leaves no involute: it starts at {self.form_radius:.6g} modules",
                "raise the tip diameter or the profile shift",
            )
        self._check_tip_edge()
        neck = float(self.fillet.points(np.linspace(self.fillet.start, self.fillet.end, 257))[0].min())
        if neck < _THINNEST_NECK:
            raise GeometryError(
                "profile_shift",
                self.profile_shift,
                "lets the rack undercut the tooth from both sides until "
                + ("it is cut off" if neck <= 0.0 else f"a neck of {2.0 * neck:.2g} modules is left"),
                "raise the profile shift or the number of teeth",
            )

    def _check_tip_edge(self) -> None:
        key = "tip_rounding" if self.tip_rounding > 0.0 else "tip_chamfer"
        size = self.tip_rounding + self.tip_chamfer
        if size == 0.0 or self._edge_fits(key, size):
            return
        end = self._involute_end(key, size)
        rule = "takes away the whole involute" if not end > self.form_radius else "is wider than the tip allows"
        low, high = 0.0, size
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._edge_fits(key, middle) else (low, middle)
        fits = math.floor(low * 1e4) * 1e-4
        raise GeometryError(key, f"{size:.6g}", rule, f"choose at most {fits:.4f} modules")

    def _edge_fits(self, key: str, size: float) -> bool:
        """Whether a rounding or chamfer of this size leaves some involute and some tip land."""
        end = self._involute_end(key, size)
        return end > self.form_radius and self._land_half_angle(key, size, end) > 0.0

    def _involute_end(self, key: str, size: float) -> float:
        """Radius at which a rounding or chamfer of this size ends the involute; NaN where it ends on none."""
        if key == "tip_chamfer" or size == 0.0:
            return self.tip_radius - size
        inner = self.tip_radius - size
        if inner <= self.base_radius:
            return math.nan
        # The rounding's centre lies on the parallel involute (same base circle, roll length less the rounding).
        length = size + math.sqrt((inner - self.base_radius) * (inner + self.base_radius))
        return math.hypot(self.base_radius, length)

    def _land_half_angle(self, key: str, size: float, end: float) -> float:
        """Half the angle of the tip land that an edge of this size leaves [rad]."""
        if key == "tip_chamfer":
            return float(self.half_thickness_angle(end)) - size / self.tip_radius
        roll = float(self.roll(end))
        phi = self.base_half_angle - roll
        flank = Involute(self.base_radius, self.base_half_angle, 0.0, roll)
        x, y = flank.points(roll) - size * np.array([math.cos(phi), -math.sin(phi)])
        return math.atan2(x, y)

    # ---- circles and angles -------------------------------------------------------------------------------------
    @property
    def pitch_radius(self) -> float:
        """Pitch radius r = z / (2 cos(beta)) [modules]."""
        return self.teeth / 2 / math.cos(self.helix_angle)

    @cached_property
    def pressure_angle(self) -> float:
        """alpha_t, the transverse pressure angle [rad]; for a spur tooth that of the rack, to the last bit."""
        return transverse_angle(self.rack.pressure_angle, self.helix_angle)

    @property
    def base_helix_angle(self) -> float:
        """beta_b on the base cylinder [rad], without the sign of the hand."""
        return math.atan(math.tan(self.helix_angle) * math.cos(self.pressure_angle))

    @property
    def twist(self) -> float:
        """tan(beta) / r, turn of the section per height along the axis [rad/module], without the sign of the hand."""
        return math.tan(self.helix_angle) / self.pitch_radius

    @cached_property
    def base_radius(self) -> float:
        """r_b = r cos(alpha_t) [modules]."""
        return self.pitch_radius * math.cos(self.pressure_angle)

    @property
    def base_pitch(self) -> float:
        """p_bt = pi cos(alpha_t) / cos(beta), across the axis [modules]."""
        return math.pi * math.cos(self.pressure_angle) / math.cos(self.helix_angle)

    @property
    def generating_shift(self) -> float:
        """x_E, generating profile shift coefficient: the shift less what the thickness allowance takes."""
        return self.profile_shift - self.thickness_allowance / (2.0 * math.tan(self.rack.pressure_angle))

    @property
    def root_radius(self) -> float:
        """r_f [modules]."""
        return self.pitch_radius + self.generating_shift - self.rack.dedendum

    @cached_property
    def base_half_angle(self) -> float:
        """psi_b, half the tooth's angle on the base circle [rad]."""
        thickness = math.pi / 2 + 2.0 * self.generating_shift * math.tan(self.rack.pressure_angle)
        return thickness / self.teeth + float(inv(self.pressure_angle))

    @property
    def root_land_half_angle(self) -> float:
        """Half the angle of the root land between the two fillets of one tooth space [rad]."""
        return self.rack.tip_centre_offset / math.cos(self.helix_angle) / self.pitch_radius

    def roll(self, radius: ArrayLike) -> Array:
        """Roll angle tan(alpha_r) [rad], in the section, of the involute at `radius` [modules] (>= base radius)."""
        r = np.asarray(radius, dtype=float)
        return np.sqrt((r - self.base_radius) * (r + self.base_radius)) / self.base_radius

    def radius_of_roll(self, roll: ArrayLike) -> Array:
        """Radius [modules] of the involute at a roll angle [rad]."""
        return self.base_radius * np.hypot(1.0, np.asarray(roll, dtype=float))

    def half_thickness_angle(self, radius: ArrayLike) -> Array:
        """Half the tooth's angle [rad] between its two involutes at `radius` [modules]."""
        return self.base_half_angle - polar_angle(self.roll(radius))

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
    def undercut(self) -> bool:
        """Whether the rack's tip, or its protuberance, cuts away part of the involute."""
        return self.rack.residual_undercut > 0.0 or self._flank_line.tangent_roll(self.rack) < 0.0

    @cached_property
    def _root(self) -> tuple[Trochoid | ProtuberanceFillet, float]:
        """The fillet, and the roll angle of the involute at its end."""
        whole = self._full_trochoid()
        if self.rack.residual_undercut > 0.0:
            return protuberance_fillet(whole, self.rack, self._flank_line, self.tip_radius, self.helix_angle)
        end, roll = meeting(whole, self._flank_line, self._flank_line.tangent_roll(self.rack))
        return replace(whole, end=end), roll

    @cached_property
    def form_radius(self) -> float:
        """r_Ff, where the involute starts on the generated flank [modules]."""
        return float(self.radius_of_roll(self._root[1]))

    # ---- where the involute ends ---------------------------------------------------------------------------------
    @cached_property
    def involute_tip_radius(self) -> float:
        """Radius at which the involute ends: the tip circle, or where its rounding or chamfer starts [modules]."""
        key = "tip_rounding" if self.tip_rounding > 0.0 else "tip_chamfer"
        return self._involute_end(key, self.tip_rounding + self.tip_chamfer)

    @cached_property
    def tip_half_angle(self) -> float:
        """Half the angle of the tip land that is left [rad]."""
        key = "tip_rounding" if self.tip_rounding > 0.0 else "tip_chamfer"
        return self._land_half_angle(key, self.tip_rounding + self.tip_chamfer, self.involute_tip_radius)

    # ---- curves ----------------------------------------------------------------------------------------------------
    @cached_property
    def involute(self) -> Involute:
        """The usable right flank, from form circle to tip (or its rounding, chamfer)."""
        end = float(self.roll(self.involute_tip_radius))
        return Involute(self.base_radius, self.base_half_angle, self._root[1], end)

    @property
    def fillet(self) -> Trochoid | ProtuberanceFillet:
        """The right fillet, from the root circle to the involute."""
        return self._root[0]

    @property
    def trochoid(self) -> Trochoid:
        """The part of the right fillet that the rack's tip rounding cuts: all of it without protuberance."""
        fillet = self.fillet
        return fillet.trochoid if isinstance(fillet, ProtuberanceFillet) else fillet

    @cached_property
    def root_land(self) -> Arc | None:
        """The right half of the root land, or None with a full fillet."""
        if self.root_land_half_angle <= 1e-12:
            return None
        middle = math.pi / self.teeth
        return Arc((0.0, 0.0), self.root_radius, middle, middle - self.root_land_half_angle)

    @cached_property
    def tip_edge(self) -> Arc | Line | None:
        """Rounding or chamfer between flank and tip circle, or None."""
        t = self.involute.end
        if self.tip_rounding > 0.0:
            phi = self.base_half_angle - t
            x, y = self.involute.points(t) - self.tip_rounding * np.array([math.cos(phi), -math.sin(phi)])
            return Arc((float(x), float(y)), self.tip_rounding, math.pi / 2 + phi, self.tip_half_angle)
        if self.tip_chamfer > 0.0:
            a, b = (
                self.involute.points(t),
                self.tip_radius * np.array([math.sin(self.tip_half_angle), math.cos(self.tip_half_angle)]),
            )
            return Line((float(a[0]), float(a[1])), (float(b[0]), float(b[1])))
        return None

    @cached_property
    def tip_land(self) -> Arc:
        """The right half of the tip circle's arc."""
        return Arc((0.0, 0.0), self.tip_radius, self.tip_half_angle, 0.0)

    @property
    def outline(self) -> dict[str, Curve]:
        """The right half of the outline from the middle of the tooth space to the tooth's centre line, by name."""
        pieces: dict[str, Curve | None] = {
            "root_land": self.root_land,
            "fillet": self.fillet,
            "flank": self.involute,
            "tip_edge": self.tip_edge,
            "tip_land": self.tip_land,
        }
        return {name: piece for name, piece in pieces.items() if piece is not None}
