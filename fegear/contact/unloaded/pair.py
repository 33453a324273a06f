"""A helical pinion and gear as they stand to each other: errors of alignment and manufacture, working data."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

from fegear.base.errors import GeometryError, InputError, RangeError
from fegear.contact.unloaded.manufacture import as_cut
from fegear.geometry.gear import Gear
from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.geometry.pair import GearPair
from fegear.geometry.rack_cutter import RackFlank

#: Largest error angle for which the contact analysis is meant [rad]; beyond it a drive is a crossed-axis drive.
LARGEST_ERROR = math.radians(3.0)


@dataclass(frozen=True, slots=True)
class Misalignment:
    """Errors of a helical pair, all zero for the aligned drive (NASA TM-107451, section 2).

    Parameters
    ----------
    shaft_angle : float
        Delta gamma [rad]: turn of the gear's axis about the line of centres.
    lead_angle : float
        Delta lambda_p1 [rad] on the pinion's pitch cylinder.
    profile_angle : float
        Delta alpha_n1 [rad], error of the normal profile angle of the pinion's cutter.
    centre_distance : float
        Delta E [m].
    """

    shaft_angle: float = 0.0
    lead_angle: float = 0.0
    profile_angle: float = 0.0
    centre_distance: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what is no small error."""
        for key in ("shaft_angle", "lead_angle", "profile_angle"):
            value = getattr(self, key)
            if not abs(value) <= LARGEST_ERROR:
                angle = f"{math.degrees(value):.6g} deg"
                raise RangeError(key, angle, "is not small", "keep it within 3 deg")
        if not math.isfinite(self.centre_distance):
            raise InputError("centre_distance", self.centre_distance, "must be finite")

    @property
    def aligned(self) -> bool:
        """Whether the axes are parallel and the flanks conjugate: a wrong centre distance alone changes neither."""
        return self.shaft_angle == 0.0 and self.lead_angle == 0.0 and self.profile_angle == 0.0


@dataclass(frozen=True)
class HelicalPair:
    """A pair of helical or spur gears with parallel axes by design, and the rigid flanks that touch.

    The fixed frame has its z axis along the pinion's axis and its x axis toward the gear. The pinion turns
    counter-clockwise by phi_1 and drives; the gear turns clockwise by phi_2. At phi_1 = phi_2 = 0 the middle of a
    pinion space and of a gear tooth lie on the line of centres in the plane z = 0.

    Parameters
    ----------
    pinion, gear : Gear
        As designed: what `GearPair` takes.
    errors : Misalignment
    parabola : float
        a_c of the pinion's cutter [1/m] (see `RackFlank`).
    crown : float
        Lengthwise crown of the pinion [rad/m^2] (see `RackFlank`).
    axial_offset : float
        Height of the gear's mid face above the pinion's [m].
    design_distance : float
        Centre distance by design [m]; NaN, the default, is the one that the profile shifts give without backlash.

    Raises
    ------
    GeometryError
        If hands, angles or modules contradict each other or the gears do not reach each other.
    """

    pinion: Gear
    gear: Gear
    errors: Misalignment = field(default_factory=Misalignment)
    parabola: float = 0.0
    crown: float = 0.0
    axial_offset: float = 0.0
    design_distance: float = math.nan

    def __post_init__(self) -> None:
        """Refuse gears that cannot mesh."""
        a, b = self.pinion, self.gear
        _ = self.design  # refuses gears that do not mesh
        reach = 0.5 * (a.face_width + b.face_width) - abs(self.axial_offset)
        if not (math.isfinite(self.axial_offset) and reach > 1e-3 * min(a.face_width, b.face_width)):
            raise GeometryError(
                "axial_offset", f"{self.axial_offset * 1e3:.6g} mm", "leaves no common face width",
                f"reduce it below {0.5e3 * (a.face_width + b.face_width):.6g} mm",
            )  # fmt: skip
        _ = self.flank  # refuses a modification that leaves no flank
        if not self.centre_distance > 0.0 or self.path_end <= self.path_start:
            raise GeometryError(
                "centre_distance", f"{self.centre_distance * 1e3:.6g} mm",
                "gives no path of contact between the tip circles", "reduce it or increase the tip radii",
            )  # fmt: skip

    @cached_property
    def design(self) -> GearPair:
        """The pair without errors."""
        return GearPair(self.pinion, self.gear, self.design_distance)

    @cached_property
    def cut_pinion(self) -> Gear:
        """The pinion with its errors of manufacture."""
        return as_cut(self.pinion, profile_angle=self.errors.profile_angle, lead_angle=self.errors.lead_angle)

    @cached_property
    def flank(self) -> RackFlank:
        """The pinion's flank."""
        return RackFlank(self.cut_pinion, self.parabola, self.crown)

    @cached_property
    def mating_flank(self) -> InvoluteHelicoid:
        """The gear's flank."""
        return InvoluteHelicoid.of(self.gear, "tooth")

    @cached_property
    def centre_distance(self) -> float:
        """E [m]: that of the design, plus what the pinion's pitch radius grows as cut, plus its own error."""
        grown = self.cut_pinion.pitch_radius - self.pinion.pitch_radius
        return self.design.centre_distance + grown + self.errors.centre_distance

    @property
    def ratio(self) -> float:
        """m_21 = N_1 / N_2, turn of the gear per turn of the pinion."""
        return self.pinion.teeth / self.gear.teeth

    @cached_property
    def working_pressure_angle(self) -> float:
        """alpha_w in the transverse plane [rad]."""
        cosine = (self.cut_pinion.base_radius + self.gear.base_radius) / self.centre_distance
        if cosine > 1.0:
            raise GeometryError(
                "centre_distance", f"{self.centre_distance * 1e3:.6g} mm",
                "is smaller than the sum of the base radii: no line of action", "increase it",
            )  # fmt: skip
        return math.acos(cosine)

    @property
    def interferes(self) -> tuple[bool, bool]:
        """Whether the mate's tip reaches below the form circle of the pinion, and of the gear.

        The flanks end there; what the tip does to the fillet is not part of this analysis.
        """
        a, b = self.cut_pinion, self.gear
        line = self.centre_distance * math.sin(self.working_pressure_angle)

        def tangent(radius: float, base: float) -> float:
            return math.sqrt(max(radius**2 - base**2, 0.0))

        slack = 1e-9 * line
        return (
            line - tangent(b.involute_tip_radius, b.base_radius) < tangent(a.form_radius, a.base_radius) - slack,
            line - tangent(a.involute_tip_radius, a.base_radius) < tangent(b.form_radius, b.base_radius) - slack,
        )

    @property
    def path_start(self) -> float:
        """Base tangent length of the pinion [m] where the gear's tip, or the pinion's form circle, starts contact."""
        rb, E = self.gear.base_radius, self.centre_distance
        by_tip = E * math.sin(self.working_pressure_angle) - math.sqrt(self.gear.involute_tip_radius**2 - rb**2)
        form = self.cut_pinion.form_radius
        return max(by_tip, math.sqrt(max(form**2 - self.cut_pinion.base_radius**2, 0.0)))

    @property
    def path_end(self) -> float:
        """Base tangent length of the pinion [m] where its tip, or the gear's form circle, ends contact."""
        rb, E = self.cut_pinion.base_radius, self.centre_distance
        by_tip = math.sqrt(self.cut_pinion.involute_tip_radius**2 - rb**2)
        form = math.sqrt(max(self.gear.form_radius**2 - self.gear.base_radius**2, 0.0))
        return min(by_tip, E * math.sin(self.working_pressure_angle) - form)

    @property
    def transverse_contact_ratio(self) -> float:
        """epsilon_alpha of the aligned drive."""
        return (self.path_end - self.path_start) / (self.cut_pinion.base_radius * self.pinion.angular_pitch)

    @property
    def overlap(self) -> tuple[float, float]:
        """Lower and upper end of the common face [m]."""
        half_1, half_2, h = 0.5 * self.pinion.face_width, 0.5 * self.gear.face_width, self.axial_offset
        return max(-half_1, h - half_2), min(half_1, h + half_2)

    @property
    def overlap_ratio(self) -> float:
        """epsilon_beta: common face width over the axial pitch."""
        lo, hi = self.overlap
        return (hi - lo) * abs(self.cut_pinion.twist) / self.pinion.angular_pitch

    def pinion_angle(self, tangent_length: float, z: float) -> float:
        """phi_1 [rad] at which the aligned pair touches at a base tangent length and height [m] (A.3.6)."""
        rb = self.cut_pinion.base_radius
        roll = tangent_length / rb
        azimuth = -self.cut_pinion.half_base_space_angle + self.cut_pinion.twist * z - roll
        return -self.working_pressure_angle - azimuth

    @cached_property
    def engagement(self) -> tuple[float, float]:
        """First and last phi_1 [rad] of one aligned tooth pair, over path of contact and face."""
        corners = [self.pinion_angle(t, z) for t in (self.path_start, self.path_end) for z in self.overlap]
        return min(corners), max(corners)

    def with_errors(self, errors: Misalignment) -> HelicalPair:
        """The same drive with other errors."""
        return replace(self, errors=errors)

    def with_modification(self, *, parabola: float, crown: float = 0.0) -> HelicalPair:
        """The same drive with another modification of the pinion."""
        return replace(self, parabola=parabola, crown=crown)
