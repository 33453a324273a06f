"""The basic rack of teeth whose two flanks differ: two pressure angles, two tip roundings, in modules."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from fegear.base.errors import GeometryError
from fegear.geometry.involute_side import Flank


@dataclass(frozen=True, slots=True)
class RackFlank:
    """One flank of a rack's tooth, counted from the gear's side.

    Parameters
    ----------
    pressure_angle : float
        alpha_P [rad], 5 to 45 deg.
    tip_radius : float
        rho_fP, radius of the tool's tip rounding beside this flank [modules].
    """

    pressure_angle: float = math.radians(20.0)
    tip_radius: float = 0.25


@dataclass(frozen=True, slots=True)
class RackHalf:
    """The half of a rack's tooth beside one flank, from the middle of its thickness on the reference line.

    Parameters
    ----------
    pressure_angle, tip_radius : float
        As of `RackFlank`.
    dedendum : float
        h_fP [modules].
    """

    pressure_angle: float
    tip_radius: float
    dedendum: float

    @property
    def tip_centre_offset(self) -> float:
        """Distance of the tip rounding's centre from the middle of the tooth [modules]; may lie beyond it: negative."""
        a = self.pressure_angle
        flank = math.pi / 4 - self.dedendum * math.tan(a)
        return flank - self.tip_radius * (1.0 - math.sin(a)) / math.cos(a)

    @property
    def tip_centre_depth(self) -> float:
        """Depth of the tip rounding's centre below the reference line [modules]."""
        return self.dedendum - self.tip_radius


@dataclass(frozen=True, slots=True)
class AsymmetricRack:
    """Basic rack tooth profile with flanks of their own for driving and coasting, in its normal section.

    Tooth and space are equally wide on the reference line, as ISO 53 has it.

    Parameters
    ----------
    drive, coast : RackFlank
    addendum : float
        h_aP [modules].
    dedendum : float
        h_fP [modules].

    Raises
    ------
    GeometryError
        If a value lies outside its range or the two roundings do not fit side by side on the tool's tip.
    """

    drive: RackFlank = field(default_factory=RackFlank)
    coast: RackFlank = field(default_factory=RackFlank)
    addendum: float = 1.0
    dedendum: float = 1.25

    def __post_init__(self) -> None:
        """Refuse profiles that no tool can have."""
        for name, value in (("addendum", self.addendum), ("dedendum", self.dedendum)):
            if not (math.isfinite(value) and value > 0.0):
                raise GeometryError(f"rack.{name}", value, "must be positive and finite (in modules)")
        for key, flank in (("drive", self.drive), ("coast", self.coast)):
            if not math.radians(5.0) <= flank.pressure_angle <= math.radians(45.0):
                angle = f"{math.degrees(flank.pressure_angle):.6g} deg"
                raise GeometryError(f"rack.{key}.pressure_angle", angle, "must be between 5 and 45 deg")
            if not 0.0 <= flank.tip_radius <= self.dedendum:
                rule = f"must be between 0 and the dedendum of {self.dedendum:.6g} modules"
                raise GeometryError(f"rack.{key}.tip_radius", flank.tip_radius, rule)
        if self.tip_land < -1e-12:
            fits = self.full_fillet_radius
            if fits <= 0.0:
                tangents = math.tan(self.drive.pressure_angle) + math.tan(self.coast.pressure_angle)
                most = math.floor(0.5 * math.pi / tangents * 1e4) * 1e-4
                raise GeometryError(
                    "rack.dedendum", self.dedendum, "gives a pointed rack tooth", f"use at most {most:.4f} modules"
                )
            radii = f"{self.drive.tip_radius:.6g} and {self.coast.tip_radius:.6g}"
            fits = math.floor(fits * 1e6) * 1e-6  # never given as more than what is accepted
            raise GeometryError(
                "rack.tip_radius",
                radii,
                "do not fit side by side on the tip of the rack",
                f"choose both at most {fits:.6f} modules (full fillet) or a smaller dedendum",
            )

    def half(self, flank: Flank) -> RackHalf:
        """The half of the rack's tooth beside a flank."""
        one = self.drive if flank == "drive" else self.coast
        return RackHalf(one.pressure_angle, one.tip_radius, self.dedendum)

    @property
    def reversed(self) -> AsymmetricRack:
        """The rack with its flanks exchanged, as of a gear turned round on its shaft."""
        return AsymmetricRack(self.coast, self.drive, self.addendum, self.dedendum)

    @property
    def tip_land(self) -> float:
        """Length of the flat between the two tip roundings [modules], 0 of a full fillet."""
        return self.half("drive").tip_centre_offset + self.half("coast").tip_centre_offset

    @property
    def tip_shift(self) -> float:
        """By which the middle of that flat lies beside the middle of the tooth, toward the drive flank [modules]."""
        return 0.5 * (self.half("drive").tip_centre_offset - self.half("coast").tip_centre_offset)

    @property
    def full_fillet_radius(self) -> float:
        """Largest radius of two equal tip roundings [modules]: they are one arc."""
        angles = self.drive.pressure_angle, self.coast.pressure_angle
        room = sum(math.pi / 4 - self.dedendum * math.tan(a) for a in angles)
        return room / sum((1.0 - math.sin(a)) / math.cos(a) for a in angles)
