"""What a run takes for keys that a case leaves out and that its answer depends on, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def bore_remarks(scene: Scene, gear: str) -> tuple[str, ...]:
    """Where the body of a gear is held fast, if the case does not say."""
    if scene.case.gear[gear].bore_radius is not None:
        return ()
    bore = scene.gears[gear].bore_radius * 1e3
    return (f"Gear {gear}: no bore_radius was given; the body is held at half the root radius, {bore:.6g} mm.",)


def width_remarks(scene: Scene, gear: str) -> tuple[str, ...]:
    """On which width a gear carries its load, if the case does not say."""
    if scene.case.gear[gear].face_width is not None:
        return ()
    return (f"Gear {gear}: no face_width was given; the load is carried on 1 mm. Give gear.{gear}.face_width.",)
