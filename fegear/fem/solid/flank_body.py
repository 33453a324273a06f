"""What contact over the flank asks of a gear: a solid ring, slices that are coupled along the face, or thin slices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.fem.solid.bands import Bands
    from fegear.fem.solid.settings import SolidSettings
    from fegear.fem.trace import LoadedFlank


class FlankLines(Protocol):
    """Contact lines on one gear's flank, many at a time; lengths in modules, E = 1.

    Bands of all lines stand one after the other; P is the number of those of one line.
    """

    @property
    def common(self) -> Sequence[Array]:
        """Of each line the integrals of products of its bands' profiles, (P, P) [1/module]."""

    @property
    def slope(self) -> float:
        """What of a line load's approach goes with -2 ln b, b its half-width."""

    def own(self) -> list[Array]:
        """c_0 of each line under contacts of half-width 1, less what `widened` gives, (P, P) [1/(E module)]."""

    def widened(self, half_width: Array) -> list[Array]:
        """What the contacts' half-widths, shape (all P,), change beside their logarithm, (P, P) for each line."""

    def between(self, k: int, pairs: Sequence[tuple[int, int]]) -> list[Array]:
        """c_k between lines on different teeth, by their numbers: seen on the first, pressed on the second."""


class FlankBody(Protocol):
    """A gear whose flank can be pressed along contact lines."""

    @property
    def flank(self) -> LoadedFlank:
        """The loaded flank of its section."""

    @property
    def settings(self) -> SolidSettings:
        """Of its section's mesh and of the pressed bands."""

    @property
    def reach(self) -> int:
        """K: neighbours -K..K are known."""

    def band_half_width(self, radius: ArrayLike) -> Array:
        """Half-width of a pressure that the section resolves, shape (P,) [modules]."""

    def line_slope(self, radius: ArrayLike) -> Array:
        """Arc up the flank per length along the face of the contact line through a radius, shape (P,)."""

    def pressed(self, line: Bands, spans: Sequence[slice]) -> FlankLines:
        """Press contact lines on it."""
