"""What a drawing of gears and pairs would carry, for its numbers and its figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class Drawing:
    """Everything that a drawing would carry.

    Parameters
    ----------
    gears : mapping of str to Gear
    pairs : mapping of str to GearPair
    members : mapping of str to (str, str)
        Names of the driver and the driven gear of each pair.
    balls : mapping of str to float
        Diameters of the measuring balls or pins that the case names, by gear [m].
    spans : mapping of str to int
        Teeth of the spans that the case names, by gear.
    ground : mapping of str to mapping of str to float
        What is ground off the flanks [m], by gear and by `gear_modifications.MEANINGS`.
    assumed : tuple of str
        Sentences on bores and face widths that mass and inertia take for granted.
    """

    gears: Mapping[str, Gear]
    pairs: Mapping[str, GearPair]
    members: Mapping[str, tuple[str, str]]
    balls: Mapping[str, float]
    spans: Mapping[str, int]
    ground: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    assumed: tuple[str, ...] = ()
