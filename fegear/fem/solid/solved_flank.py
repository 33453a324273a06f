"""What a solved solid tooth and its neighbours answer: deflections and fillet stress under bands on the flank."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.fem.plane.root_stress import search_end
from fegear.fem.solid.bands import loads_of
from fegear.fem.solid.contact import PressedLines
from fegear.fem.solid.fillet import surface_stress
from fegear.fem.solid.flank_body import SolidFlank

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Side
    from fegear.fem.solid.bands import Bands

#: How far below the edge of a pressed band root tension begins [modules].
_CLEARANCE = 0.25


class SolvedFlank(SolidFlank):
    """A flank of teeth that are all alike, with what forces on it do to flanks and fillets; lengths in modules, E = 1.

    `slide` is the way of the section along the row per length along the face: zero of gears, whose section turns.
    """

    slide: float

    def deflection(self, k: int, watched: Bands, pressed: Bands) -> Array:
        """c_k: mean approach of bands on tooth k under a unit force on bands of tooth 0, shape (P, Q) [1/(E module)].

        Along the transverse line of action, weighted with the pressure of the watched band, so that
        c_k(p, q) = c_-k(q, p) to round-off.

        Raises
        ------
        RangeError
            If tooth k is beyond reach, or a band does not lie on flank and face.
        """
        self._check_tooth(k)
        loads = loads_of(pressed, self.flank, self.face)
        own = loads if watched is pressed else loads_of(watched, self.flank, self.face)
        return np.asarray(own.T @ self.compliance[k] @ loads)

    def pressed(self, line: Bands, spans: Sequence[slice], teeth: Sequence[int]) -> PressedLines:
        """Contact lines on the flank, one after the other: see `contact.PressedLines`."""
        return PressedLines(self, line, spans, teeth)

    def _check_tooth(self, k: int) -> None:
        if k not in self.compliance:
            raise RangeError(
                "k", k, f"must be a whole number from {-self.reach} to {self.reach}",
                "increase reach",
            )  # fmt: skip

    def largest_root_stress(self, k: int, side: Side, pressed: Bands, zeta: ArrayLike) -> tuple[Array, Array]:
        """Largest tension (or compression) up a fillet of tooth k at places along the face, shape (Z, P) each.

        Returns
        -------
        value, arc : ndarray
            Tangential stress in the transverse section [1/module^2] and where it sits [modules], as far up as
            `root_end` says.
        """
        stress = self.fillet_stress(k, side, pressed, zeta)[0]
        sign = 1.0 if side == "tension" else -1.0
        end = np.tile(self.root_end(k, side, pressed), stress.shape[1])
        value, place = self.fillets[side].largest(stress.reshape(stress.shape[0], -1), sign, end)
        return value.reshape(stress.shape[1:]), place.reshape(stress.shape[1:])

    def root_end(self, k: int, side: Side, pressed: Bands) -> Array:
        """Arc length up to which root stress is looked for, shape (P,) [modules]: beside a contact near the fillet.

        As in the plane (`search_end`), but farther from the contact, whose pressed band is as wide as a coarser section
        resolves.
        """
        length = self.fillets[side].length
        if k != 0 or side != "tension":
            return np.full(pressed.count, length)
        above = self.flank.arc_of_radius(pressed.radius) - self.flank.flank_start
        return search_end(length, above, pressed.half_width, _CLEARANCE)

    def fillet_stress(self, k: int, side: Side, pressed: Bands, zeta: ArrayLike) -> Array:
        """Surface stress of a fillet of tooth k per unit force on bands of tooth 0 [1/module^2].

        Parameters
        ----------
        k : int
        side : {"tension", "compression"}
            Below the loaded flank, or on the other side of the tooth.
        pressed : Bands
        zeta : array_like, shape (Z,)
            Where along the face [modules].

        Returns
        -------
        ndarray, shape (3, points, Z, P)
            Along the fillet in the transverse section, across it (all but axial), and the shear between both.

        Raises
        ------
        RangeError
            If tooth k is beyond reach, a place lies off the face, or a band off flank or face.
        """
        return self.surface_stress(side, self.moved(k, side, loads_of(pressed, self.flank, self.face)), zeta)

    def moved(self, k: int, side: Side, loads: Array) -> Array:
        """Displacements of a fillet of tooth k under loads on tooth 0's flank, shape (nodes, 3, functions, P).

        Parameters
        ----------
        k : int
        side : {"tension", "compression"}
        loads : ndarray, shape (n, P)
            On the flank's ports, as `loads_of` gives them for bands.

        Raises
        ------
        RangeError
            If tooth k is beyond reach.
        """
        self._check_tooth(k)
        felt = self.displacement[k, side]
        # As one product: that of a stack goes matrix by matrix, small ones on several threads.
        return np.asarray(felt.reshape(-1, felt.shape[3]) @ loads).reshape(*felt.shape[:3], -1)

    def surface_stress(self, side: Side, moved: Array, zeta: ArrayLike) -> Array:
        """What `fillet_stress` gives, of displacements that `moved` gives, or of a sum of such.

        Raises
        ------
        RangeError
            If a place lies off the face.
        """
        z, half = np.atleast_1d(np.asarray(zeta, dtype=float)), 0.5 * self.width
        if (off := z[~(np.abs(z) <= half * (1.0 + 1e-9))]).size:
            raise RangeError(
                "zeta", f"{off[0]:.6g} modules", f"is outside the face width, {-half:.6g} to {half:.6g} modules"
            )
        values, slopes = self.face.at(z)
        return surface_stress(self.fillets[side], self.tau, self.poisson_ratio, moved, values, slopes, self.slide)
