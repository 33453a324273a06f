"""Which gear of a case is driver or driven of a pair."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.geometry.pair import Member


def gear_name(scene: Scene, pair: str, member: Member) -> str:
    """Name of the driver or the driven gear of a pair."""
    part = scene.case.pair[pair]
    return part.driver if member == "driver" else part.driven
