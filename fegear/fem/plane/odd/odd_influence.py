"""Influence functions of a gear some of whose teeth differ: c_ij(p, q), root stress, and stress intensity as rows.

The teeth have numbers, rising clockwise (toward the side that the load comes from); compliances are no function of
i - j, and c_ij(p, q) = c_ji(q, p) alone is left of their symmetry. Nothing is formed for all pairs of teeth: of each
kind of sector is kept how its flank, fillets and crack follow its sides, and of the ring how the sides move.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.one_thread import one_thread
from fegear.base.tally import tallied
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.influence import SIDES, Influence, Side
from fegear.fem.plane.odd.crack_faces import CrackFaces, pressed
from fegear.fem.plane.odd.odd_ring import Held, OddRing, held_sectors, odd_ring
from fegear.fem.plane.odd.tooth_kind import OddTooth, ToothKind, ordinary_kind, tooth_kind
from fegear.fem.plane.rim import rigid_motions
from fegear.fem.plane.sector_sides import between_sides, bore_of_side, condensed_sector
from fegear.fem.plane.supported_section import assemble_sections

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.odd.patch_kinds import Patch
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_tooth import InvoluteTooth
    from fegear.geometry.rim_support import RimSupport


@dataclass(frozen=True)
class OddInfluence:
    """c_ij(p, q), root-stress and stress-intensity influence of one gear shape with odd teeth; E = 1, module 1.

    Parameters
    ----------
    poisson_ratio : float
    plane : {"strain", "stress"}
    corner_distance : float
        As of `Influence`.
    ordinary : ToothKind
    odd : mapping of int to ToothKind
        By the tooth's number, -reach to reach.
    ring : OddRing
        How the sectors' sides move.
    seconds : mapping of str to float
    lower : OddInfluence, optional
        The same on the same meshes with elements one order lower, which shows the error.
    missing : tuple of int
        Sectors without a tooth, -reach to reach.
    held : ToothKind, optional
        Ordinary teeth beyond the free arc of a bore, which `half` teeth on either side of tooth 0 are above.
    half : int
    patch : Patch, optional
        Teeth whose sectors are meshed as one.
    """

    poisson_ratio: float
    plane: Plane
    corner_distance: float
    ordinary: ToothKind
    odd: Mapping[int, ToothKind]
    ring: OddRing
    seconds: Mapping[str, float] = field(compare=False)
    lower: OddInfluence | None = None
    missing: tuple[int, ...] = ()
    held: ToothKind | None = None
    half: int = 0
    patch: Patch | None = None

    @property
    def unlike(self) -> tuple[int, ...]:
        """Numbers of the teeth that are not ordinary, or missing."""
        return tuple(sorted((*self.odd, *self.missing)))

    @property
    def reach(self) -> int:
        """R: teeth -R..R are known, among them the odd ones."""
        return self.ring.reach

    def kind(self, i: int) -> ToothKind:
        """Of what kind a tooth is.

        Raises
        ------
        InputError
            If there is none.
        """
        if i in self.missing:
            raise InputError("tooth", i, "is missing")
        usual = self.ordinary if self.held is None or abs(i) <= self.half else self.held
        return self.odd.get(i, usual)

    @cached_property
    def _teeth(self) -> dict[int, Influence]:
        return {}

    def tooth(self, i: int) -> Influence:
        """A tooth under loads on itself; its neighbours are of its own kind.

        Such neighbours stand for none that there are: they show what of its deflection the tooth shares with others,
        where the gear turns on its bore (`Influence`).
        """
        if i not in self._teeth:
            kind = self.kind(i)
            sides = self.ring.between(i, i)
            compliance = {0: kind.flank_own + kind.flank_follows @ sides @ kind.flank_follows.T}
            if self.reach:
                beside = self.ring.between(i + 1, i) if i < self.reach else self.ring.between(i, i - 1)
                compliance[1] = kind.flank_follows @ beside @ kind.flank_follows.T
                compliance[-1] = compliance[1].T
            stress = {
                (0, side): kind.stress_own[side] + kind.stress_follows[side] @ sides @ kind.flank_follows.T
                for side in SIDES
            }
            self._teeth[i] = Influence(
                kind.tooth, self.poisson_ratio, self.plane, kind.mesh, kind.flank, compliance, kind.fillets,
                stress, self.corner_distance, min(self.reach, 1), kind.unknowns, {},
            )  # fmt: skip
        return self._teeth[i]

    def own(self, i: int, radius: ArrayLike, patch: float, half_width: ArrayLike | None = None) -> Array:
        """c_ii(p, p): as `Influence.self_compliance`, shape (P,) [1/E]."""
        found = self.tooth(i).self_compliance(radius, patch, half_width)
        return found + self.by_closing(i, radius, patch) if self.closing else found

    @property
    def closing(self) -> tuple[int, ...]:
        """Teeth with a crack whose faces may press on each other."""
        return tuple(number for number, kind in self.odd.items() if kind.faces is not None)

    def by_closing(self, i: int, radius: ArrayLike, patch: float) -> Array:
        """What faces of cracks take away of c_ii(p, p) by pressing on each other, shape (P,) [1/E]."""
        opening = self.openings(i, self.tooth(i).remote(radius, patch))
        return np.asarray((opening * pressed(self.faces_compliance, opening)).sum(axis=0))

    @cached_property
    def faces_at(self) -> dict[int, slice]:
        """Which of the nodes of all cracks that may close, one after the other, are of which tooth."""
        ends = np.cumsum([0, *(self._faces(k).own.shape[0] for k in self.closing)]).tolist()
        return {k: slice(*ends[n : n + 2]) for n, k in enumerate(self.closing)}

    @cached_property
    def faces_compliance(self) -> Array:
        """Opening of all cracks that may close under pairs of forces on their faces, shape (N, N) [1/E]."""
        each = [
            [
                self.face_compliance(k)
                if k == other
                else self._faces(k).follows @ self.ring.between(k, other) @ self._faces(other).follows.T
                for other in self.closing
            ]
            for k in self.closing
        ]
        return np.asarray(np.block(each))

    def openings(self, j: int, loads: Array) -> Array:
        """Opening of all cracks that may close under loads on the flank of tooth j, faces free, shape (N, P)."""
        return np.concatenate([self.opening(k, j, loads) for k in self.closing])

    def stress_by_faces(self, i: int, side: Side) -> Array:
        """Stress along a fillet of tooth i under pairs of forces on the faces of all cracks, shape (points, N)."""
        found = []
        for k in self.closing:
            faces = self._faces(k)
            by_sides = self.kind(i).stress_follows[side] @ self.ring.between(i, k) @ faces.follows.T
            found.append(by_sides + faces.stress[side] if i == k else by_sides)
        return np.hstack(found)

    def opening(self, i: int, j: int, loads: Array) -> Array:
        """Opening of the crack of tooth i under loads on the flank of tooth j, its faces free, shape (N, P).

        Of a crack that may close.
        """
        faces = self._faces(i)
        found = faces.follows @ self._sides(i, j, loads)
        return np.asarray(found + faces.by_flank @ loads if i == j else found)

    def face_compliance(self, i: int) -> Array:
        """Opening of the crack of tooth i under pairs of forces on its faces, shape (N, N)."""
        faces = self._faces(i)
        found = faces.own + faces.follows @ self.ring.between(i, i) @ faces.follows.T
        return np.asarray(0.5 * (found + found.T))

    def face_forces(self, i: int, j: int, loads: Array) -> Array:
        """Forces between the faces of the crack of tooth i that loads on the flank of tooth j make, shape (N, P).

        By loads on tooth i itself where its faces press. Loads on other teeth find them as a load on the middle of
        its flank does, shut or open: with it they come to the forces of all of them, and stay linear.
        """
        opening = self.opening(i, j, loads)
        return pressed(self.face_compliance(i), opening) if i == j else -self._shut(i) @ opening

    def _shut(self, i: int) -> Array:
        """Forces per opening at the nodes that a load on the middle of the flank shuts, zero elsewhere, (N, N)."""
        if i not in self._sets:
            flank, compliance = self.kind(i).flank, self.face_compliance(i)
            middle = np.array([0.5 * (flank.lowest_radius + flank.highest_radius)])
            forces = self.face_forces(i, i, self.tooth(i).remote(middle, REFERENCE_HALF_WIDTH))
            at = np.flatnonzero(forces[:, 0] > 0.0)
            found = np.zeros_like(compliance)
            found[np.ix_(at, at)] = np.linalg.inv(compliance[np.ix_(at, at)])
            self._sets[i] = found
        return self._sets[i]

    def shut_tooth(self, i: int) -> Influence:
        """As `tooth`, the faces of cracks shut where a load on the middle of their own flanks shuts them."""
        usual = self.tooth(i)
        found, each = usual.compliance[0], np.eye(usual.compliance[0].shape[0])
        for k in self.closing:
            opening = self.opening(k, i, each)
            found = found - opening.T @ self._shut(k) @ opening
        return replace(usual, compliance={**usual.compliance, 0: found}) if self.closing else usual

    @cached_property
    def _sets(self) -> dict[int, Array]:
        return {}

    def faces_under(self, loads: Mapping[int, tuple[Array, Array]], patch: float) -> Array:
        """Forces between the faces of all cracks that may close under loads on several teeth at once, shape (N, P).

        Parameters
        ----------
        loads : mapping of int to (ndarray, ndarray), shape (P,) each
            Radii [modules] and line loads, by tooth.
        patch : float
        """
        each = [self.openings(j, self.tooth(j).remote(radius, patch) * load) for j, (radius, load) in loads.items()]
        return pressed(self.faces_compliance, np.sum(each, axis=0))

    def _faces(self, i: int) -> CrackFaces:
        found = self.kind(i).faces
        if found is None:
            raise InputError("tooth", i, "has no crack whose faces may close")
        return found

    def _sides(self, i: int, j: int, loads: Array) -> Array:
        """Motion of the sides of sector i under loads on the flank of tooth j, shape (2 m, P)."""
        return self.ring.between(i, j) @ (self.kind(j).flank_follows.T @ loads)

    def between(
        self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike, patch: float, *, free: bool = False
    ) -> Array:
        """c_ij(p, q): deflection at p of tooth i per unit line load at q of tooth j, shape (P, Q) [1/E].

        Cracks that may close do so by `face_forces`: c_ij(p, q) = c_ji(q, p) stays; or their faces are `free`.
        """
        there, here = self.tooth(i).remote(radius_p, patch), self.tooth(j).remote(radius_q, patch)
        found = (there.T @ self.kind(i).flank_follows) @ self._sides(i, j, here)
        if i == j:
            found = found + there.T @ self.kind(i).flank_own @ here
        elif self.patch is not None and (i, j) in self.patch.flank:
            found = found + there.T @ self.patch.flank[i, j] @ here
        for k in () if free else self.closing:
            if k == i != j:
                found = found + self.face_forces(k, i, there).T @ self.opening(k, j, here)
            else:
                found = found + self.opening(k, i, there).T @ self.face_forces(k, j, here)
        return found

    def fillet_stress(
        self,
        i: int,
        j: int,
        side: Side,
        radius_q: ArrayLike,
        half_width: ArrayLike = REFERENCE_HALF_WIDTH,
        *,
        free: bool = False,
    ) -> Array:
        """Tangential stress along a fillet of tooth i per unit line load at q of tooth j, shape (points, Q) [1/module].

        Beside the mouth of a crack a fillet is free of stress. Cracks that may close do so by `face_forces`, or their
        faces are `free`.
        """
        if i == j:
            found = self.tooth(i).fillet_stress(0, side, radius_q, half_width)
        else:
            loads = self.tooth(j).fillet_loads(radius_q, half_width)[0].T.toarray()
            found = self.kind(i).stress_follows[side] @ self._sides(i, j, loads)
            if self.patch is not None and (i, j) in self.patch.flank:
                found = found + self.patch.stress[i, j, side] @ loads
        for k in () if free else self.closing:
            faces = self._faces(k)
            forces = self.face_forces(k, j, self.tooth(j).remote(radius_q, REFERENCE_HALF_WIDTH))
            pushed = self.kind(i).stress_follows[side] @ (self.ring.between(i, k) @ (faces.follows.T @ forces))
            found = found + pushed + (faces.stress[side] @ forces if i == k else 0.0)
        return np.asarray(found)

    def largest_root_stress(
        self, i: int, j: int, side: Side, radius_q: ArrayLike, half_width: ArrayLike = REFERENCE_HALF_WIDTH
    ) -> tuple[Array, Array]:
        """Largest tension (or compression) of a fillet of tooth i, and the arc length where it sits, shape (Q,) each.

        Of a fillet in which a crack starts, on either side of its mouth.
        """
        _, above, width = self.tooth(j).fillet_loads(radius_q, half_width)
        if i != j or side == "compression":
            above = np.full(above.shape, np.inf)
        stress = self.fillet_stress(i, j, side, radius_q, half_width)
        sign = 1.0 if side == "tension" else -1.0
        best, place = np.full(above.shape, -np.inf), np.zeros(above.shape)
        for start, curve, points in self.kind(i).pieces(side):
            value, at = curve.largest_below(stress[points], above, width)
            better = sign * value > best
            best, place = np.where(better, sign * value, best), np.where(better, at + start, place)
        return sign * best, place

    def by_ring(self, i: int, j: int, radius_q: ArrayLike, patch: float) -> Array:
        """K_I and K_II by each ring of integration, shape (rings, 2, Q)."""
        kind = self.kind(i)
        if not kind.cracked:
            cracked = ", ".join(str(number) for number, one in self.odd.items() if one.cracked)
            raise InputError("tooth", i, f"has no crack; cracked: {cracked or 'none'}")
        loads = self.tooth(j).remote(radius_q, patch)
        found = kind.intensity_follows @ self._sides(i, j, loads)
        return np.asarray(found + kind.intensity_own @ loads if i == j else found)

    def closed_intensity(self, i: int, forces: Array) -> Array:
        """K_I and K_II of the crack of tooth i by forces between the faces of all cracks, shape (rings, 2, P)."""
        sides = sum(
            self.ring.between(i, k) @ (self._faces(k).follows.T @ forces[at]) for k, at in self.faces_at.items()
        )
        own = self._faces(i).intensity @ forces[self.faces_at[i]]
        return np.asarray(self.kind(i).intensity_follows @ sides + own)

    def stress_intensity(self, i: int, j: int, radius_q: ArrayLike, patch: float) -> tuple[Array, Array]:
        """K_I and K_II of the crack of tooth i per unit line load at q of tooth j, and their error, (2, Q) each.

        In 1/sqrt(module). The error is what the elements' last order changes, and another ring of integration; no
        number without a solution of lower order.

        Raises
        ------
        InputError
            If the tooth has no crack.
        """
        usual, other = self.by_ring(i, j, radius_q, patch)
        if self.lower is None:
            return usual, np.full(usual.shape, np.nan)
        below = self.lower.by_ring(i, j, radius_q, patch)[0]
        return usual, np.abs(usual - other) + np.abs(usual - below)


@tallied("tooth shapes")
@tallied("odd sectors")
def solve_odd_influence(
    tooth: InvoluteTooth,
    mesh: SectorMesh,
    odd: Mapping[int, OddTooth],
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    *,
    reach: int = 2,
    two_orders: bool = False,
    missing: Mapping[int, SectorMesh] | None = None,
    support: RimSupport | None = None,
    known: Influence | None = None,
) -> OddInfluence:
    """Solve one ring with odd teeth for all that can be asked of its teeth.

    Parameters
    ----------
    tooth : InvoluteTooth
        The ordinary one.
    mesh : SectorMesh
        Of its sector.
    odd : mapping of int to OddTooth
        By number, -reach to reach.
    poisson_ratio : float
    plane : {"strain", "stress"}
    settings : MeshSettings
        Whose order, solver and corner distance are taken.
    reach : int
        R: teeth -R..R are known; twice this and one at most z.
    two_orders : bool
        Whether to solve with elements one order lower as well (`OddInfluence.lower`).
    missing : mapping of int to SectorMesh, optional
        Meshes of the sectors without a tooth, by number.
    support : RimSupport, optional
        A free arc of the bore, whose middle is below tooth 0, or a web [modules]; by default the bore is held.
    known : Influence, optional
        The ring of ordinary teeth on that mesh: where it knows its sector by itself that is not solved again.

    Raises
    ------
    InputError
        If an odd sector's sides are not the ordinary one's, or there are too few teeth for the reach.
    FegearError
        If a stiffness is not positive definite.
    """
    half = support.free_teeth // 2 if support is not None and support.kind == "free_arc" else None
    solved = solved_already(known, two_orders) if half is None else []
    ordinary, bare = [] if solved else [OddTooth(tooth, mesh)], missing or {}
    every = [*ordinary, *odd.values()]
    meshes = [*(one.mesh for one in every), *bare.values()]
    with one_thread():
        orders = assemble_sections(meshes, poisson_ratio, plane, settings, support, two_orders=two_orders)
        found = []
        for n, elasticity in enumerate(orders):
            started = time.perf_counter()
            if solved:
                usual, between = solved[n]
            else:
                usual, part = tooth_kind(ordinary[0], elasticity[0], poisson_ratio, plane, free=half is not None)
                between = part.held
            far, held, bore = None, None, None
            if half is not None:
                bore = bore_of_side(mesh, elasticity[0])
                far, beyond = tooth_kind(ordinary[0], elasticity[0], poisson_ratio, plane, bore=bore)
                held = Held(half, ~bore, beyond)
            others = []
            for number, one, each in zip(odd, odd.values(), elasticity[len(ordinary) : len(every)], strict=True):
                free = half is not None and abs(number) <= half
                others.append(tooth_kind(one, each, poisson_ratio, plane, free=free, bore=None if free else bore))
            kinds = {number: kind for number, (kind, _) in zip(odd, others, strict=True)}
            parts = {number: each for number, (_, each) in zip(odd, others, strict=True)}
            for number, empty, each in zip(bare, bare.values(), elasticity[len(every) :], strict=True):
                free = half is not None and abs(number) <= half
                motions = rigid_motions(each) if free else None
                condensed_bare, side_size, turn, _ = condensed_sector(
                    empty, each, np.zeros(0, dtype=np.intp), motions=motions
                )
                gap = between_sides(condensed_bare, side_size, turn)
                parts[number] = gap if free or bore is None else held_sectors(0, bore, gap).part
            condensed = time.perf_counter()
            ring = odd_ring(between, parts, tooth.teeth, reach, held)
            seconds = {
                "mesh": sum(mesh.seconds for mesh in meshes),
                "condensation": condensed - started,
                "ring": time.perf_counter() - condensed,
            }
            distance, empty_sectors = settings.corner_distance, tuple(bare)
            found.append(
                OddInfluence(
                    poisson_ratio, plane, distance, usual, kinds, ring, seconds, None, empty_sectors, far, half or 0
                )
            )
    return replace(found[0], lower=found[1]) if two_orders else found[0]


def solved_already(known: Influence | None, two_orders: bool) -> list[tuple[ToothKind, Array]]:
    """Ordinary teeth of each order, and the stiffness between their sides; of none where one is not known."""
    orders = [] if known is None else [known, known.lower] if two_orders else [known]
    found = [
        (kind, one.rows.held)
        for one in orders
        if one is not None and one.rows is not None and (kind := ordinary_kind(one)) is not None
    ]
    return found if len(found) == len(orders) else []
