"""Generated flanks of a helical pair as they are shown: design parameters, cutters' sections, places on the flanks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.shown import shown, shows
from fegear.contact.unloaded.manufacture import ProfileAngleEffects

if TYPE_CHECKING:
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.geometry.gear import Gear
    from fegear.geometry.rack_cutter import RackCutter

#: Places across a flank at which its generation is followed.
PLACES = 41


@dataclass(frozen=True, slots=True)
class GeneratedFlank(ReadOnlyArrays):
    """A flank as its cutter leaves it.

    Parameters
    ----------
    cutter : RackCutter
    u, along, psi : ndarray, shape (heights, places)
        Parameters u and l of the cutter surface [m] and roll angle [rad] at which it generates there.
    points, normals : ndarray, shape (3, heights, places)
        Of the flank, in the gear's frame [m]; normals as of `RackCutter.normals`.
    """

    cutter: RackCutter
    u: Array
    along: Array
    psi: Array
    points: Array
    normals: Array


@dataclass(frozen=True, slots=True)
class FlankGenerationData:
    """Both flanks, and how far they lie from those of tooth contact analysis [m]."""

    pair: HelicalPair
    flanks: tuple[GeneratedFlank, GeneratedFlank]
    apart: float


@dataclass(frozen=True)
class DesignedGear:
    """Appendix 2 for one gear; without what is infinite for a spur gear (None)."""

    gear: str = shown("", "name")
    teeth: int = shown("", "N")
    alpha_n: float = shown("deg", "normal profile angle")
    alpha_t: float = shown("deg", "transverse profile angle (A.2.1)")
    lambda_p: float = shown("deg", "lead angle at the reference cylinder")
    lambda_b: float = shown("deg", "lead angle at the base cylinder (A.2.7)")
    p_t: float = shown("mm", "transverse pitch (A.2.2)")
    s_t: float = shown("mm", "tooth thickness (A.2.4)")
    w_t: float = shown("mm", "width of space (A.2.3)")
    r_p: float = shown("mm", "reference radius (A.2.5)")
    r_b: float = shown("mm", "base radius (A.2.6)")
    mu: float = shown("deg", "half the space width at the base cylinder (A.1.1)")
    eta: float = shown("deg", "half the tooth thickness at the base cylinder (A.1.3)")
    p: float | None = shown("mm", "screw parameter (A.2.8)")
    lead: float | None = shown("mm", "lead (A.2.9)", name="H")

    @classmethod
    def of(cls, name: str, gear: Gear, *, helical: bool) -> DesignedGear:
        """Of a gear; whether all gears of the table are helical."""
        pitch = gear.pitch_radius * gear.angular_pitch
        thickness = 2.0 * gear.pitch_radius * float(gear.symmetric_tooth.half_thickness_angle(gear.tooth.pitch_radius))
        screw = (1.0 / abs(gear.twist), gear.lead) if helical else (None, None)
        return cls(
            name, gear.teeth, gear.normal_pressure_angle, gear.transverse_pressure_angle, gear.lead_angle,
            0.5 * math.pi - gear.base_helix_angle, pitch, thickness, pitch - thickness, gear.pitch_radius,
            gear.base_radius, gear.half_base_space_angle, gear.half_base_tooth_angle, *screw,
        )  # fmt: skip


@dataclass(frozen=True)
class ProfileAngleChange:
    """What the wrong profile angle changes, by one of two ways, and their difference."""

    by: str = shown("", "linear equations, design formulas with the incorrect angle, and their difference")
    transverse_angle: float = shown("arcsec", "change of the transverse profile angle", name="alpha_t")
    base_lead_angle: float = shown("arcsec", "change of the base lead angle", name="lambda_b")
    base_radius: float = shown("um", "change of the base radius", name="r_b")


@dataclass(frozen=True)
class CutterSections:
    """Normal sections of both cutters over the u that both flanks need."""

    u: Array = shown("mm", "along the straight profile from the reference line towards the pinion's root")
    x_pinion: Array = shown("mm", "pinion cutter, cutter coordinates (A.5.6)")
    y_pinion: Array = shown("mm", "second coordinate")
    x_gear: Array = shown("mm", "gear cutter, cutter coordinates (A.5.1)")
    y_gear: Array = shown("mm", "second coordinate")
    departure: Array = shown("um", "departure of the pinion cutter from the straight profile")


@dataclass(frozen=True)
class FlankRows:
    """Every place at which the generation of a flank is followed."""

    u: Array = shown("mm", "position across the cutter surface")
    along: Array = shown("mm", "position along the cutter surface", name="l")
    psi: Array = shown("deg", "roll angle at which this point generates the flank (A.5.14, A.5.15)")
    x: Array = shown("mm", "coordinate of the flank")
    y: Array = shown("mm", "coordinate of the flank")
    z: Array = shown("mm", "coordinate of the flank")
    r: Array = shown("mm", "radius")
    nx: Array = shown("", "unit normal")
    ny: Array = shown("", "unit normal")
    nz: Array = shown("", "unit normal")

    @classmethod
    def of(cls, flank: GeneratedFlank) -> FlankRows:
        """Of a flank."""
        (x, y, z), (nx, ny, nz) = flank.points, flank.normals
        rows = (flank.u, flank.along, flank.psi, x, y, z, np.hypot(x, y), nx, ny, nz)
        return cls(*(one.ravel() for one in rows))


@dataclass(frozen=True)
class ShownFlank:
    """A flank with the name of its gear."""

    gear: str
    rows: FlankRows


@dataclass(frozen=True)
class ShownGeneration:
    """Both flanks with the names of their gears."""

    data: FlankGenerationData
    gears: tuple[str, str]

    @property
    def pair(self) -> HelicalPair:
        """Of the flanks."""
        return self.data.pair

    @property
    def designed(self) -> list[DesignedGear]:
        """Pinion, gear, and the pinion as it is cut where it is cut otherwise."""
        pair, (pinion, gear) = self.pair, self.gears
        rows = [(pinion, pair.pinion), (gear, pair.gear)]
        if pair.cut_pinion != pair.pinion:
            rows.append((f"{pinion} as cut", pair.cut_pinion))
        helical = all(one.twist for _, one in rows)
        return [DesignedGear.of(name, one, helical=helical) for name, one in rows]

    @property
    def error_minutes(self) -> float:
        """Error of the profile angle [arcmin]."""
        return math.degrees(self.pair.errors.profile_angle) * 60.0

    @property
    def by_profile_angle(self) -> list[ProfileAngleChange] | None:
        """By Eqs. 15 to 17 and by Appendix 2; a lead error does not count here. None without an error."""
        if not (error := self.pair.errors.profile_angle):
            return None
        pinion = self.pair.pinion
        found = ProfileAngleEffects.by_equations(pinion, error), ProfileAngleEffects.as_cut(pinion, error)
        first, second = ((one.transverse_angle, one.base_lead_angle, one.base_radius) for one in found)
        apart = [one - other for one, other in zip(first, second, strict=True)]
        return [
            ProfileAngleChange("Eqs. 15 to 17", *first), ProfileAngleChange("Appendix 2 as cut", *second),
            ProfileAngleChange("difference", *apart),
        ]  # fmt: skip

    @property
    def sections(self) -> CutterSections:
        """Of both cutters."""
        ends = np.concatenate([flank.u.ravel() for flank in self.data.flanks])
        u = np.linspace(ends.min(), ends.max(), 2 * PLACES - 1)
        (x1, y1), (x2, y2) = (flank.cutter.normal_profile(u) for flank in self.data.flanks)
        return CutterSections(u, x1, y1, x2, y2, self.pair.parabola * u**2)

    @property
    def flanks(self) -> list[ShownFlank]:
        """Of both gears."""
        both = zip(self.gears, self.data.flanks, strict=True)
        return [ShownFlank(gear, FlankRows.of(flank)) for gear, flank in both]

    @property
    @shows("mm", "a_m, half the cutter thickness at u = 0")
    def rack_half_width(self) -> float:
        """[m]."""
        return self.data.flanks[0].cutter.half_width

    @property
    @shows("um", "maximum departure of the pinion cutter from the straight profile over the flank")
    def largest_departure(self) -> float:
        """[m]."""
        return self.pair.parabola * float(np.max(self.data.flanks[0].u ** 2))

    @property
    @shows("um", "maximum distance between the generated flanks and those of tooth contact analysis")
    def generated_apart(self) -> float:
        """[m]."""
        return self.data.apart
