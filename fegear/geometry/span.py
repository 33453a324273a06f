"""Span measurement: what a disc micrometer reads over several teeth (ISO 21771, 5.6: base tangent length W_k)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.errors import GeometryError

if TYPE_CHECKING:
    from fegear.geometry.gear import Gear


def span(gear: Gear, teeth: int) -> float:
    """Base tangent length W_k over k teeth [m]: k - 1 base pitches and one tooth thickness on the base circle.

    Thickness allowances count: it is what the drawing's nominal value becomes by its allowance.

    Parameters
    ----------
    gear : Gear
    teeth : int
        k >= 1, teeth between the discs.

    Raises
    ------
    GeometryError
        If k is less than 1 or the discs do not touch involutes.
    """
    if teeth < 1:
        raise GeometryError("teeth", teeth, "must be at least 1")
    length = (teeth - 1) * gear.base_pitch + 2.0 * gear.base_radius * gear.tooth.base_half_angle
    radius = math.hypot(gear.base_radius, 0.5 * length)
    if not gear.form_radius <= radius <= gear.involute_tip_radius:
        raise GeometryError(
            "teeth",
            teeth,
            f"puts the discs at radius {radius * 1e3:.6g} mm, outside the involute from "
            f"{gear.form_radius * 1e3:.6g} mm to {gear.involute_tip_radius * 1e3:.6g} mm",
            f"measure over {span_teeth(gear)} teeth",
        )
    return length


def span_teeth(gear: Gear) -> int:
    """Number of teeth whose measurement touches the flanks nearest to the middle of the involute."""
    middle = 0.5 * (gear.form_radius + gear.involute_tip_radius)
    half = math.sqrt(max(middle**2 - gear.base_radius**2, 0.0))
    base_thickness = 2.0 * gear.base_radius * gear.tooth.base_half_angle
    return max(1, round((2.0 * half - base_thickness) / gear.base_pitch) + 1)
