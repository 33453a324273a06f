"""What a disc micrometer reads over several teeth (ISO 21771, 5.6: span W_k), and a gear tooth caliper on one."""

from __future__ import annotations

import math

from fegear.base.errors import GeometryError
from fegear.geometry.gear import Gear
from fegear.geometry.shift_of_thickness import ToothNumbers


def span(gear: Gear, teeth: int) -> float:
    """Base tangent length W_k over k teeth [m]: k - 1 base pitches and one tooth thickness on the base circle.

    On helical teeth the discs stand along the normal of the flanks, which lies in the plane tangent to the base
    cylinder and leans by beta_b: all of it is shortened by cos(beta_b), and the discs touch W_k sin(beta_b) apart along
    the axis. Thickness allowances count: it is what the drawing's nominal value becomes by its allowance.

    Parameters
    ----------
    gear : Gear
    teeth : int
        k >= 1, teeth between the discs.

    Raises
    ------
    GeometryError
        If the gear is internal, k is less than 1, the discs do not touch involutes, or the face is narrower than
        W_k sin(beta_b).
    """
    if gear.tooth.internal:
        raise GeometryError(
            "internal", "true", "cannot be measured over teeth (span)", "use the measurement between balls"
        )
    if teeth < 1:
        raise GeometryError("teeth", teeth, "must be at least 1")
    lean = math.cos(gear.base_helix_angle)
    length = ((teeth - 1) * gear.base_pitch + 2.0 * gear.base_radius * gear.symmetric_tooth.base_half_angle) * lean
    radius = math.hypot(gear.base_radius, 0.5 * length * lean)
    if not gear.form_radius <= radius <= gear.involute_tip_radius:
        raise GeometryError(
            "teeth",
            teeth,
            f"gives contact at radius {radius * 1e3:.6g} mm, outside the involute, {gear.form_radius * 1e3:.6g} mm "
            f"to {gear.involute_tip_radius * 1e3:.6g} mm",
            f"measure over {span_teeth(gear)} teeth",
        )
    apart = length * math.sin(gear.base_helix_angle)
    if apart > gear.face_width:
        raise GeometryError(
            "face_width",
            f"{gear.face_width * 1e3:.6g} mm",
            f"is too small for a span over {teeth} teeth (axial distance of the contact points {apart * 1e3:.6g} mm)",
            "measure over fewer teeth or over balls",
        )
    return length


def usual_span(gear: Gear) -> tuple[int, float] | None:
    """Number of teeth and base tangent length [m] of the measurement that `span_teeth` would take.

    A face too narrow for the lean of helical teeth takes fewer teeth; None where no number is left, and of internal
    gears and of asymmetric teeth: between planes on flanks of two base circles the distance depends on how they lie.
    """
    if gear.tooth.internal or gear.asymmetric:
        return None
    for teeth in range(span_teeth(gear), 0, -1):
        try:
            return teeth, span(gear, teeth)
        except GeometryError:
            continue
    return None


def span_teeth(gear: Gear) -> int:
    """Number of teeth whose measurement touches the flanks nearest to the middle of the involute."""
    middle = 0.5 * (gear.form_radius + gear.involute_tip_radius)
    half = math.sqrt(max(middle**2 - gear.base_radius**2, 0.0))
    base_thickness = 2.0 * gear.base_radius * gear.symmetric_tooth.base_half_angle
    across = 2.0 * half / math.cos(gear.base_helix_angle) ** 2
    return max(1, round((across - base_thickness) / gear.base_pitch) + 1)


def chord(gear: Gear) -> tuple[float, float]:
    """Chordal tooth thickness on the reference cylinder, normal to the helix, and its height from the tip circle [m].

    A helical tooth is that of its virtual spur gear in the normal section, as drawings have it. Not a number of
    internal gears, which no caliper reaches, of asymmetric teeth, whose flanks it would touch at two heights, and of
    teeth so thick that they have no such chord.
    """
    if gear.asymmetric or gear.tooth.internal:
        return math.nan, math.nan
    tooth = gear.symmetric_tooth
    numbers = ToothNumbers(tooth.teeth, tooth.normal_pressure_angle, tooth.helix_angle)
    thickness, drop = numbers.chord(tooth.generating_shift)
    return thickness * gear.module, (tooth.tip_radius - tooth.pitch_radius + drop) * gear.module
