"""Assumed defaults: what a run assumes for keys that a case does not give and its answer depends on, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def bore_remarks(scene: Scene, gear: str) -> tuple[str, ...]:
    """Where the body of a gear is held fast, if the case does not say."""
    if scene.case.gear[gear].bore_radius is not None:
        return ()
    bore = scene.gears[gear].bore_radius * 1e3
    held = f"held at half the root radius, {bore:.6g} mm"
    return (f"Gear {gear}: no bore_radius was given; assumed default: the body is {held}.",)


def width_remarks(scene: Scene, gear: str) -> tuple[str, ...]:
    """On which width a gear carries its load, if the case does not say."""
    if scene.case.gear[gear].face_width is not None:
        return ()
    remedy = f"Give gear.{gear}.face_width."
    return (f"Gear {gear}: no face_width was given; assumed default: the load is carried on 1 mm. {remedy}",)
