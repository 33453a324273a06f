"""What a source of tooth compliance must answer, whether finite elements, a closed form or a measured table.

Every quantity belongs to one gear, per unit face width, in SI. The Hertzian contact is left to the pair: a source
states the compliance under the load at a reference half-width b_ref and the slope kappa of its logarithm, so that with
the pair's Hertzian half-width b(W)

    c_0(W) = own(tooth, radius) + kappa ln(b_ref / b(W)).

Every tooth has a number (`fegear.fem.alike_teeth`). Where all teeth are alike an answer depends on the difference of
two numbers only, and everything that is made of answers is kept once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.fem.alike_teeth import AlikeTeeth, Teeth

if TYPE_CHECKING:
    from fegear.fem.plane.root_stress import CutFillet, FilletCurve

Side = Literal["tension", "compression"]


class RootStressInfluence(Teeth, Protocol):
    """Root stress of one gear's teeth per unit line load, whether from finite elements or from a formula."""

    @property
    def reach(self) -> int:
        """K: neighbours k = -K..K are coupled; 0 when the source knows only the loaded tooth."""

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the source says of its own values; empty when nothing."""

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """Stress along a fillet of tooth i per unit line load at q of tooth j, (points, Q) [1/m]; None if unknown."""

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | CutFillet | None:
        """How the largest stress of tooth i is found between the points of a fillet; None if they are all."""

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:
        """Estimated error of the largest stress of a fillet of tooth i, loads on j, (Q,) [1/m]; NaN if unknown."""


class GearCompliance(RootStressInfluence, Protocol):
    """Influence functions of one gear's teeth; their reach serves deflections and root stress."""

    @property
    def log_slope(self) -> float:
        """kappa = 2 (1 - nu^2)/(pi E) in plane strain [m^2/N]; 0 when the source has a fixed contact compliance."""

    @property
    def power(self) -> float:
        """q of a further contact deflection q w^0.9 under a line load w (Palmgren) [m (m/N)^0.9]; 0 in general."""

    @property
    def tip_wedge(self) -> tuple[float, float]:
        """How much softer than a half-plane the tip is, sigma - 1, and the half-width that `own` has there [m].

        Zeros where `own` takes no notice of the tip; see `edge_law`.
        """

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii [m] at which `own` has a kink (knots of a linear table); empty for smooth sources."""

    def own(self, i: int, radius: ArrayLike) -> Array:
        """Deflection of tooth i under the load's own centre per unit line load at b_ref, shape (P,) [m^2/N]."""

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """b_ref, shape (P,) [m]."""

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_ij(p, q) = c_ji(q, p) [m^2/N]: deflection at p of tooth i per unit line load at q of another tooth j.

        Radii are broadcast.
        """

    def describe(self) -> str:
        """Return one sentence: what this source includes and what not."""


class OneTooth(AlikeTeeth):
    """Base of compliance sources that know one tooth: neither its neighbours nor its root stress."""

    __slots__ = ()
    remarks = ()
    tip_wedge = (0.0, 0.0)

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:  # noqa: ARG002  (all alike)
        """Zero."""
        return np.zeros(np.broadcast_shapes(np.shape(radius_p), np.shape(radius_q)))

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:  # noqa: ARG002  (all alike)
        """Unknown."""
        return None

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | CutFillet | None:  # noqa: ARG002  (the interface)
        """Unknown."""
        return None

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:  # noqa: ARG002  (all alike)
        """Unknown."""
        return np.full(np.shape(radius_q), np.nan)


@dataclass(frozen=True, slots=True)
class Rigid(OneTooth):
    """A gear that does not deflect: for pairs whose whole compliance is given on the other gear."""

    reach: int = 0
    log_slope: float = 0.0
    power: float = 0.0
    kinks: tuple[float, ...] = ()

    def own(self, i: int, radius: ArrayLike) -> Array:  # noqa: ARG002  (the interface)
        """Zero."""
        return np.zeros(np.shape(radius))

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """One: it never matters, since the logarithm's slope is zero."""
        return np.ones(np.shape(radius))

    def describe(self) -> str:
        """Return what it is."""
        return "no deflection"
