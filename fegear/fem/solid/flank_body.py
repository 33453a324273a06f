"""What contact over the flank asks of a gear: a solid ring, slices that are coupled along the face, or thin slices."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.fem.alike_teeth import AlikeTeeth, Teeth
from fegear.fem.plane.contact_width import curvature_slope
from fegear.fem.plane.trace import LoadedFlank
from fegear.fem.solid.bands import Bands
from fegear.fem.solid.settings import SolidSettings
from fegear.geometry.involute_side import InvoluteSide

if TYPE_CHECKING:
    from fegear.fem.plane.influence import Side
    from fegear.fem.solid.face import FaceFunctions
    from fegear.fem.solid.fillet import SolidFillet

#: A pressure is at least this share of the flank wide, however little room there is to its end.
_NARROWEST = 0.02
#: Radius of curvature at least, beside the base circle, where an involute's vanishes [modules].
_LEAST_RADIUS = 0.25
#: Mean distance of two points of a semi-elliptic pressure over its half-width.
_MEAN = 256.0 / (45.0 * np.pi**2)


class FlankLines(Protocol):
    """Contact lines on one gear's flank, many at a time; lengths in modules, E = 1.

    Bands of all lines stand one after the other; P is the number of those of one line.
    """

    @property
    def common(self) -> Sequence[Array]:
        """Of each line the integrals of products of its bands' profiles, (P, P) [1/module]."""

    def own(self) -> list[Array]:
        """c_0 of each line under contacts of half-width 1, less what `widened` gives, (P, P) [1/(E module)]."""

    def widened(self, half_width: Array) -> list[Array]:
        """What the contacts' half-widths, shape (all P,), change beside their logarithm, (P, P) for each line."""

    def between(self, i: int, j: int, pairs: Sequence[tuple[int, int]]) -> list[Array]:
        """c_ij between lines of pairs by their places: seen on the first, on tooth i, pressed on the second, on j."""


class FlankBody(Teeth, Protocol):
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

    @property
    def contact_slope(self) -> float:
        """What of a line load's approach goes with -2 ln b, b its half-width."""

    @property
    def usual(self) -> FlankBody:
        """The same gear, all its teeth alike: itself where they are."""

    def band_half_width(self, radius: ArrayLike) -> Array:
        """Half-width of a pressure that the section resolves, shape (P,) [modules]."""

    def line_slope(self, radius: ArrayLike) -> Array:
        """Arc up the flank per length along the face of the contact line through a radius, shape (P,)."""

    def pressed(self, line: Bands, spans: Sequence[slice], teeth: Sequence[int]) -> FlankLines:
        """Press contact lines on its teeth, by their numbers."""

    def differ(self, i: int, j: int) -> bool:
        """Whether forces on tooth j move tooth i otherwise than in the `usual` gear."""


class TwistedFlank(AlikeTeeth):
    """What the flank of a gear with a width is by its shape alone; lengths in modules."""

    tooth: InvoluteSide
    tau: float
    width: float
    poisson_ratio: float
    flank: LoadedFlank
    compliance: Mapping[int, Array]
    reach: int
    settings: SolidSettings

    @property
    def usual(self) -> Self:
        """Itself: all teeth are alike."""
        return self

    def differ(self, i: int, j: int) -> bool:  # noqa: ARG002  (all are alike)
        """Never."""
        return False

    def band_half_width(self, radius: ArrayLike) -> Array:
        """Half-width of a pressure that the section resolves, shape (P,) [modules]: less beside the flank's ends."""
        arc = self.flank.arc_of_radius(np.atleast_1d(np.asarray(radius, dtype=float)))
        room = np.minimum(arc - self.flank.flank_start, self.flank.flank_end - arc)
        length = self.flank.flank_end - self.flank.flank_start
        return np.clip(self.settings.room_share * room, _NARROWEST * length, self.settings.band_half_width)

    @property
    def base_twist(self) -> float:
        """tan(beta_b), positive for a right hand."""
        return self.tau * self.tooth.base_radius

    @property
    def normal_length(self) -> float:
        """1 / cos(beta_b): length of N, and of the contact line per length along the face."""
        return math.hypot(1.0, self.base_twist)

    @property
    def contact_slope(self) -> float:
        """What of a line load's approach goes with -2 ln b, b its half-width: (1 - nu^2) / (pi cos(beta_b)), E = 1."""
        return (1.0 - self.poisson_ratio**2) * self.normal_length / math.pi

    def curvature(self, radius: Array) -> Array:
        """Curvature of the flank in the transverse section, shape (P,) [1/module]; negative where it is hollow."""
        rb = self.tooth.base_radius
        return np.asarray(self.tooth.side / np.maximum(np.sqrt(np.maximum(radius**2 - rb**2, 0.0)), _LEAST_RADIUS))

    def bend(self, radius: Array) -> Array:
        """What the flank's curvature adds to the deflection near a contact per half-width, shape (P,) [1/module]."""
        return curvature_slope(self.poisson_ratio, "strain") * _MEAN * self.curvature(radius)

    def line_slope(self, radius: ArrayLike) -> Array:
        """Arc up the flank per length along the face of the contact line through a radius, shape (P,).

        The line is straight and stands square to the involute: its foot on the base circle turns with the helix. Up an
        internal tooth the roll length falls in size, and so it falls by the same length.
        """
        rb = self.tooth.base_radius
        r = np.atleast_1d(np.asarray(radius, dtype=float))
        return np.asarray(-self.tau * np.sqrt(np.maximum(r**2 - rb**2, 0.0)))


class SolidFlank(TwistedFlank):
    """What a solid ring has besides, for those who press its flank and look at its fillets."""

    plane_strain: bool
    face: FaceFunctions
    fillets: Mapping[Side, SolidFillet]
    displacement: Mapping[tuple[int, Side], Array]

    def flank_of(self, tooth: int) -> LoadedFlank:  # noqa: ARG002  (all are alike)
        """The loaded flank of a tooth."""
        return self.flank

    def coupling(self, i: int, j: int) -> Array:
        """Approach of the flank of tooth i under forces on that of tooth j, port by port, shape (n_i, n_j)."""
        return self.compliance[i - j]

    if TYPE_CHECKING:

        def root_end(self, k: int, side: Side, pressed: Bands) -> Array:
            """See `SolidSolution.root_end`."""
