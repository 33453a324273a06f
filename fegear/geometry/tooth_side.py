"""What a mesh and its loads ask of one side of a tooth, be it of a gear or of a rack: exact curves, nothing of circles.

`InvoluteSide` and `RackTooth` are both; what takes a gear's tooth takes neither of them for the other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from fegear.geometry.curves import Arc, Curve, Line


class ToothSide(Protocol):
    """One side of a tooth seen from its loaded flank on the right, centre line along +y; lengths in modules."""

    @property
    def side(self) -> int:
        """1 where the tooth's material lies on the left of its curves, -1 on an internal tooth."""

    @property
    def back(self) -> ToothSide:
        """The tooth seen from its other flank."""

    @property
    def tip_rounding(self) -> float:
        """Radius of the rounding between flank and tip [modules]."""

    @property
    def undercut(self) -> bool:
        """Whether the flank starts in a corner."""

    @property
    def fillet(self) -> Curve:
        """From the root land to the flank."""

    @property
    def involute(self) -> Curve:
        """The usable flank."""

    @property
    def tip_edge(self) -> Arc | Line | None:
        """Rounding or chamfer between flank and tip land."""

    @property
    def root_land(self) -> Arc | Line | None:
        """Up to the middle of the tooth space; None with a full fillet."""

    @property
    def root_land_length(self) -> float:
        """Length of it [modules]."""

    @property
    def space_middle(self) -> tuple[float, float]:
        """Bottom of the middle of the tooth space on the right [modules]."""

    @property
    def tip_land(self) -> Curve:
        """Half of the tip, on this side."""

    @property
    def outline(self) -> dict[str, Curve]:
        """Half of the outline from the middle of the tooth space to the middle of the tip land, by name."""


def outline_of(tooth: ToothSide) -> dict[str, Curve]:
    """Half of the outline from the middle of the tooth space to the middle of the tip land, by name: what there is."""
    pieces: dict[str, Curve | None] = {
        "root_land": tooth.root_land,
        "fillet": tooth.fillet,
        "flank": tooth.involute,
        "tip_edge": tooth.tip_edge,
        "tip_land": tooth.tip_land,
    }
    return {name: piece for name, piece in pieces.items() if piece is not None}
