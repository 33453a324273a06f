"""A solid gear some of whose teeth differ: what pairs ask of its flanks and fillets, tooth by tooth; E = 1, module 1.

Odd teeth far from each other are in rings of their own: a tooth more than two teeth away from every odd one answers as
an ordinary one does (a crack half of the way through changes it by less than 5e-4).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.fem.solid.bands import Bands, loads_of
from fegear.fem.solid.contact import PressedLines
from fegear.fem.solid.fillet import SolidFillet, surface_stress
from fegear.fem.solid.flank_body import SolidFlank
from fegear.fem.solid.odd.front_intensity import DERIVATIVES, MODES
from fegear.fem.solid.odd.odd_window import OddWindow
from fegear.fem.solid.solution import SolidSolution

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Side
    from fegear.fem.plane.trace import LoadedFlank
    from fegear.fem.solid.face import FaceFunctions
    from fegear.fem.solid.settings import SolidSettings
    from fegear.geometry.involute_side import InvoluteSide


@dataclass(frozen=True)
class OddSolid(SolidFlank):
    """A solid gear with odd teeth.

    Parameters
    ----------
    ordinary : SolidSolution
        The same gear, all its teeth alike.
    windows : tuple of OddWindow
        Around its odd teeth, which have the numbers of the gear.
    seconds : mapping of str to float
    """

    ordinary: SolidSolution
    windows: tuple[OddWindow, ...]
    seconds: Mapping[str, float] = field(compare=False)

    @property
    def tooth(self) -> InvoluteSide:  # type: ignore[override]  # as of every flank, read-only
        """The ordinary transverse section."""
        return self.ordinary.tooth

    @property
    def tau(self) -> float:  # type: ignore[override]  # read-only
        """Twist [rad/module]."""
        return self.ordinary.tau

    @property
    def width(self) -> float:  # type: ignore[override]  # read-only
        """[modules]."""
        return self.ordinary.width

    @property
    def poisson_ratio(self) -> float:  # type: ignore[override]  # read-only
        """Of the material."""
        return self.ordinary.poisson_ratio

    @property
    def plane_strain(self) -> bool:  # type: ignore[override]  # read-only
        """Whether nothing moves along the axis."""
        return self.ordinary.plane_strain

    @property
    def flank(self) -> LoadedFlank:  # type: ignore[override]  # read-only
        """The loaded flank of ordinary teeth."""
        return self.ordinary.flank

    @property
    def face(self) -> FaceFunctions:  # type: ignore[override]  # read-only
        """Functions along the face."""
        return self.ordinary.face

    @property
    def fillets(self) -> Mapping[Side, SolidFillet]:  # type: ignore[override]  # read-only
        """Of ordinary teeth."""
        return self.ordinary.fillets

    @property
    def compliance(self) -> Mapping[int, Array]:  # type: ignore[override]  # read-only
        """Of ordinary teeth."""
        return self.ordinary.compliance

    @property
    def displacement(self) -> Mapping[tuple[int, Side], Array]:  # type: ignore[override]  # read-only
        """Of ordinary teeth."""
        return self.ordinary.displacement

    @property
    def settings(self) -> SolidSettings:  # type: ignore[override]  # read-only
        """Of its section's mesh and of the pressed bands."""
        return self.ordinary.settings

    @property
    def reach(self) -> int:  # type: ignore[override]  # read-only
        """K: neighbours -K..K are known."""
        return self.ordinary.reach

    @property
    def usual(self) -> SolidSolution:  # type: ignore[override]  # read-only
        """The same gear, all its teeth alike."""
        return self.ordinary

    def differ(self, i: int, j: int) -> bool:
        """Whether forces on tooth j move tooth i otherwise than in the `usual` gear."""
        found = self._window(i, j)
        return found is not None and not {found[1], found[2]} & set(found[0].missing)

    @property
    def period(self) -> int:  # type: ignore[override]  # read-only
        """The gear's teeth."""
        return self.tooth.teeth

    def same_as(self, first: int, count: int) -> int:
        """Those from `first` on by themselves where one of them answers otherwise than ordinary teeth."""
        if self._any_touched(first, count):
            return first % self.period
        if count not in self._ordinary_runs:
            runs = (tooth for tooth in range(self.period) if not self._any_touched(tooth, count))
            self._ordinary_runs[count] = next(runs)
        return self._ordinary_runs[count]

    @cached_property
    def _ordinary_runs(self) -> dict[int, int]:
        """First tooth of the first run of so many teeth that all answer as ordinary ones, by how many."""
        return {}

    def _any_touched(self, first: int, count: int) -> bool:
        return any(self._touched(first + n) is not None for n in range(min(count, self.period)))

    def _touched(self, tooth: int) -> OddWindow | None:
        return next((window for window in self.windows if window.near(tooth) in window.touched), None)

    def _window(self, i: int, j: int) -> tuple[OddWindow, int, int] | None:
        """Where two teeth are known by number and one of them is touched, or one between them."""
        for window in self.windows:
            near = window.near(i)
            other = near + j - i
            if not window.known(near):
                other = window.near(j)
                near = other + i - j
            low, high = min(near, other), max(near, other)
            touched = window.touched
            if window.known(near) and window.known(other) and low <= touched[-1] and high >= touched[0]:
                return window, near, other
        return None

    def kind_of(self, tooth: int) -> tuple[LoadedFlank, Mapping[Side, SolidFillet]]:
        """Flank and fillets of a tooth."""
        found = self._window(tooth, tooth)
        if found is None:
            return self.ordinary.flank, self.ordinary.fillets
        kind = found[0].kind(found[1])
        return kind.flank, kind.fillets

    def flank_of(self, tooth: int) -> LoadedFlank:
        """The loaded flank of a tooth."""
        return self.kind_of(tooth)[0]

    def coupling(self, i: int, j: int) -> Array:
        """Approach of the flank of tooth i under forces on that of tooth j, port by port, shape (n_i, n_j)."""
        found = self._window(i, j)
        if found is None:
            return self.ordinary.compliance[i - j]
        window, near, other = found
        if near in window.missing or other in window.missing:  # nothing loads it: its answers must only be sound
            return self.ordinary.compliance[i - j]
        return window.coupling(near, other)

    def deflection(self, i: int, j: int, watched: Bands, pressed: Bands) -> Array:
        """c_ij: mean approach of bands on tooth i under a unit force on bands of tooth j, (P, Q) [1/(E module)].

        c_ij(p, q) = c_ji(q, p) exactly.
        """
        there, here = (
            loads_of(one, self.flank_of(k), self.face) for one, k in ((watched, i), (pressed, j))
        )  # fmt: skip
        return np.asarray(there.T @ self.coupling(i, j) @ here)

    def pressed(self, line: Bands, spans: Sequence[slice], teeth: Sequence[int]) -> PressedLines:
        """Press contact lines on its teeth, by their numbers: see `contact.PressedLines`."""
        return PressedLines(self, line, spans, teeth)

    def root_end(self, k: int, side: Side, pressed: Bands) -> Array:
        """As of ordinary teeth."""
        return self.ordinary.root_end(k, side, pressed)

    def fillet_stress(self, i: int, j: int, side: Side, pressed: Bands, zeta: ArrayLike) -> Array:
        """Surface stress of a fillet of tooth i per unit force on bands of tooth j, (3, points, Z, P) [1/module^2].

        As of `SolidSolution.fillet_stress`.

        Raises
        ------
        RangeError
            If a place lies off the face, or tooth i is missing.
        """
        for tooth in (i, j):
            if self.is_missing(tooth):
                raise RangeError("tooth", tooth, "is missing")
        moved = self.moved(i, j, side, loads_of(pressed, self.flank_of(j), self.face))
        return self.surface_stress(i, side, moved, zeta)

    def stress_intensity(self, i: int, j: int, pressed: Bands, zeta: ArrayLike) -> tuple[Array, Array]:
        """K_I, K_II and K_III along the front of the crack of tooth i per unit force on bands of tooth j.

        Parameters
        ----------
        i, j : int
        pressed : Bands
            P of them.
        zeta : array_like, shape (Z,)
            Places along the face [modules].

        Returns
        -------
        value, error : ndarray, shape (3, Z, P)
            [1/module^1.5]; the error is what another ring of integration changes. K_III is positive where the left
            face of the crack, seen from the mouth, moves along z. At the ends of the front there is no such K.

        Raises
        ------
        RangeError
            If a place lies off the face; if the tooth has no crack, or its rows were not asked for.
        """
        z, found = self._on_face(zeta), self._window(i, j)
        rows = np.zeros((0, 1)) if found is None else found[0].front(
            *found[1:], loads_of(pressed, self.flank_of(j), self.face)
        )  # fmt: skip
        if not rows.size:
            raise RangeError("tooth", i, "has no crack whose stress intensity was asked for (intensity=True)")
        along = np.stack([self.face.values(z), *(self.face.derivatives(z, order) for order in (1, 2))])
        by = rows.reshape(-1, MODES, DERIVATIVES, self.face.count, rows.shape[1])
        usual, other = np.einsum("rmdkp,dkz->rmzp", by, along)
        return usual, np.abs(usual - other)

    def _on_face(self, zeta: ArrayLike) -> Array:
        z, half = np.atleast_1d(np.asarray(zeta, dtype=float)), 0.5 * self.width
        if (off := z[~(np.abs(z) <= half * (1.0 + 1e-9))]).size:
            raise RangeError("zeta", f"{off[0]:.6g} modules", f"is outside the face width, {-half:.6g} to {half:.6g}")
        return z

    def is_missing(self, tooth: int) -> bool:
        """Whether there is no such tooth."""
        found = self._window(tooth, tooth)
        return found is not None and found[1] in found[0].missing

    def moved(self, i: int, j: int, side: Side, loads: Array) -> Array:
        """Displacements of a fillet of tooth i under loads on the flank of tooth j, (nodes, 3, functions, P).

        Parameters and errors as of `SolidSolution.moved`; loads on a missing tooth must be none.
        """
        found = self._window(i, j)
        return self.ordinary.moved(i - j, side, loads) if found is None else found[0].moved(*found[1:], side, loads)

    def surface_stress(self, tooth: int, side: Side, moved: Array, zeta: ArrayLike) -> Array:
        """Surface stress of a fillet of a tooth by such displacements; see `SolidSolution.surface_stress`.

        Raises
        ------
        RangeError
            If a place lies off the face.
        """
        z = self._on_face(zeta)
        fillet = self.kind_of(tooth)[1][side]
        return surface_stress(fillet, self.tau, self.poisson_ratio, moved, *self.face.at(z))

    def largest_root_stress(self, i: int, j: int, side: Side, pressed: Bands, zeta: ArrayLike) -> tuple[Array, Array]:
        """Largest tension (or compression) up a fillet of tooth i at places along the face, shape (Z, P) each.

        On either side of the mouth of a crack; value [1/module^2] and arc [modules].
        """
        stress = self.fillet_stress(i, j, side, pressed, zeta)[0]
        shape, sign = stress.shape[1:], 1.0 if side == "tension" else -1.0
        end = np.tile(self.root_end(i - j, side, pressed), shape[0])
        value, arc = self.kind_of(i)[1][side].largest(stress.reshape(stress.shape[0], -1), sign, end)
        return value.reshape(shape), arc.reshape(shape)


@dataclass(frozen=True)
class SolidTooth:
    """One tooth of a gear with odd teeth, as a tooth of a gear whose teeth are all alike answers.

    Parameters
    ----------
    gear : OddSolid
    number : int
        Of the tooth.
    """

    gear: OddSolid
    number: int

    @property
    def tau(self) -> float:
        """Twist [rad/module]."""
        return self.gear.tau

    @property
    def reach(self) -> int:
        """K: teeth -K..K beside it are known."""
        return self.gear.reach

    @property
    def fillets(self) -> Mapping[Side, SolidFillet]:
        """Its fillets."""
        return self.gear.kind_of(self.number)[1]

    def moved(self, k: int, side: Side, loads: Array) -> Array:
        """Displacements of a fillet under loads on the flank of the tooth of which this one is tooth k."""
        return self.gear.moved(self.number, self.number - k, side, loads)

    def surface_stress(self, side: Side, moved: Array, zeta: ArrayLike) -> Array:
        """Stress by such displacements."""
        return self.gear.surface_stress(self.number, side, moved, zeta)

    def root_end(self, k: int, side: Side, pressed: Bands) -> Array:
        """Arc length up to which root stress is looked for."""
        return self.gear.root_end(k, side, pressed)
