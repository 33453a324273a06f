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
from fegear.fem.plane.elasticity import SectorElasticity
from fegear.fem.plane.influence import SIDES, Influence, Side
from fegear.fem.plane.odd.cracked_sector import CrackedSector
from fegear.fem.plane.odd.odd_ring import Held, OddRing, held_sectors, odd_ring
from fegear.fem.plane.odd.stress_intensity import RINGS, interaction
from fegear.fem.plane.rim import rigid_motions
from fegear.fem.plane.root_stress import FilletCurve, FilletStrain, fillet_strain
from fegear.fem.plane.sector_sides import (
    BetweenSides,
    between_sides,
    bore_of_side,
    condensed_sector,
    ports_of,
)
from fegear.fem.plane.supported_section import assemble_section, assemble_section_two_orders
from fegear.fem.plane.trace import LoadedFlank, loaded_flank

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array, Mask
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_tooth import InvoluteTooth
    from fegear.geometry.rim_support import RimSupport

#: How far below the flank a patch may reach into the fillet [modules], and how near to a crack's mouth, as a share of
#: the way there.
_MARGIN, _ABOVE_MOUTH = 0.15, 0.97
_FILLETS: dict[Side, str] = {"tension": "fillet", "compression": "back_fillet"}


@dataclass(frozen=True)
class OddTooth:
    """What stands in a sector instead of the ordinary tooth.

    Parameters
    ----------
    tooth : InvoluteTooth
        Its outline.
    sector : SectorMesh or CrackedSector
        Its mesh; sides as the ordinary sector's.
    """

    tooth: InvoluteTooth
    sector: SectorMesh | CrackedSector

    @property
    def mesh(self) -> SectorMesh:
        """Of its sector."""
        return self.sector.mesh if isinstance(self.sector, CrackedSector) else self.sector


@dataclass(frozen=True)
class ToothKind:
    """How flank, fillets and crack of one kind of sector follow its sides, and a load on its flank.

    Parameters
    ----------
    tooth : InvoluteTooth
    mesh : SectorMesh
    flank : LoadedFlank
    fillets : mapping of {"tension", "compression"} to FilletStrain
    flank_follows : ndarray, shape (2n, 2m)
        Motion of the unknowns of the loaded run under that of sides A and B.
    flank_own : ndarray, shape (2n, 2n)
        The same under forces on itself, the sides held.
    stress_follows, stress_own : mapping of side to ndarray, shape (points, 2m) and (points, 2n)
        Tangential stress of the fillets likewise.
    intensity_follows, intensity_own : ndarray, shape (rings, 2, 2m) and (rings, 2, 2n)
        K_I and K_II of its crack likewise, by each ring of integration; of none without a crack.
    mouth : float
        Where its crack starts, arc length up the fillet [modules].
    back : bool
        Whether that is the fillet of the flank that is not loaded.
    unknowns : int
        Size of the sector's system.
    """

    tooth: InvoluteTooth
    mesh: SectorMesh
    flank: LoadedFlank
    fillets: Mapping[Side, FilletStrain]
    flank_follows: Array
    flank_own: Array
    stress_follows: Mapping[Side, Array]
    stress_own: Mapping[Side, Array]
    intensity_follows: Array
    intensity_own: Array
    mouth: float
    back: bool
    unknowns: int

    @property
    def cracked(self) -> bool:
        """Whether it has a crack."""
        return self.intensity_own.size > 0

    def pieces(self, side: Side) -> list[tuple[float, FilletCurve, slice]]:
        """Start, curve and points of the pieces of a fillet: two where a crack starts in it."""
        fillet, flank = self.fillets[side], self.flank
        ends = float(flank.roll_squared[0]), float(flank.roll_squared[-1])
        whole = FilletCurve(side, fillet.arc, fillet.length, flank.base_radius, ends)
        if not self.cracked or self.back != (side == "compression"):
            return [(0.0, whole, slice(None))]
        n = int(np.searchsorted(whole.arc, self.mouth))
        return [
            (0.0, replace(whole, arc=whole.arc[:n], length=self.mouth), slice(0, n)),
            (
                self.mouth,
                replace(whole, arc=whole.arc[n:] - self.mouth, length=whole.length - self.mouth),
                slice(n, None),
            ),
        ]


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
        return self.tooth(i).self_compliance(radius, patch, half_width)

    def _sides(self, i: int, j: int, loads: Array) -> Array:
        """Motion of the sides of sector i under loads on the flank of tooth j, shape (2 m, P)."""
        return self.ring.between(i, j) @ (self.kind(j).flank_follows.T @ loads)

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike, patch: float) -> Array:
        """c_ij(p, q): deflection at p of tooth i per unit line load at q of tooth j, shape (P, Q) [1/E]."""
        there, here = self.tooth(i).remote(radius_p, patch), self.tooth(j).remote(radius_q, patch)
        found = (there.T @ self.kind(i).flank_follows) @ self._sides(i, j, here)
        return found + there.T @ self.kind(i).flank_own @ here if i == j else found

    def fillet_stress(
        self, i: int, j: int, side: Side, radius_q: ArrayLike, half_width: ArrayLike = REFERENCE_HALF_WIDTH
    ) -> Array:
        """Tangential stress along a fillet of tooth i per unit line load at q of tooth j, shape (points, Q) [1/module].

        Beside the mouth of a crack a fillet is free of stress.
        """
        if i == j:
            return self.tooth(i).fillet_stress(0, side, radius_q, half_width)
        loads = self.tooth(j).fillet_loads(radius_q, half_width)[0].T
        return self.kind(i).stress_follows[side] @ self._sides(i, j, loads.toarray())

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

    Raises
    ------
    InputError
        If an odd sector's sides are not the ordinary one's, or there are too few teeth for the reach.
    FegearError
        If a stiffness is not positive definite.
    """
    ordinary = OddTooth(tooth, mesh)
    every, bare = [ordinary, *odd.values()], missing or {}
    meshes = [*(one.mesh for one in every), *bare.values()]
    half = support.free_teeth // 2 if support is not None and support.kind == "free_arc" else None
    with one_thread():
        order, solver = settings.order, settings.solver
        if two_orders:
            pairs = [assemble_section_two_orders(one, poisson_ratio, plane, order, solver, support) for one in meshes]
            orders = [list(each) for each in zip(*pairs, strict=True)]
        else:
            orders = [[assemble_section(one, poisson_ratio, plane, order, solver, support) for one in meshes]]
        found = []
        for elasticity in orders:
            started = time.perf_counter()
            usual, part = _kind(ordinary, elasticity[0], poisson_ratio, plane, free=half is not None)
            far, held, bore = None, None, None
            if half is not None:
                bore = bore_of_side(mesh, elasticity[0])
                far, beyond = _kind(ordinary, elasticity[0], poisson_ratio, plane, bore=bore)
                held = Held(half, ~bore, beyond)
            others = []
            for number, one, each in zip(odd, odd.values(), elasticity[1 : len(every)], strict=True):
                free = half is not None and abs(number) <= half
                others.append(_kind(one, each, poisson_ratio, plane, free=free, bore=None if free else bore))
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
            ring = odd_ring(part, parts, tooth.teeth, reach, held)
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


def _kind(
    odd: OddTooth,
    elasticity: SectorElasticity,
    poisson_ratio: float,
    plane: Plane,
    *,
    free: bool = False,
    bore: Mask | None = None,
) -> tuple[ToothKind, BetweenSides]:
    """Condense a sector, and gather what of it is loaded and looked at; its condensed part for the ring.

    Its bore may be `free`; or it is held, in terms of free sectors, of whose sides `bore` says what is on it.
    """
    tooth, mesh, cracked = odd.tooth, odd.mesh, isinstance(odd.sector, CrackedSector)
    fillets = {side: fillet_strain(mesh, elasticity, name, tooth.side) for side, name in _FILLETS.items()}
    margin, mouth, back = _MARGIN, 0.0, False
    if isinstance(odd.sector, CrackedSector):
        mouth, back = odd.sector.mouth, odd.sector.back
        margin = margin if back else min(margin, _ABOVE_MOUTH * (fillets["tension"].length - mouth))
    flank = loaded_flank(mesh, elasticity, tooth, margin)
    ports = np.unique(np.concatenate([flank.dofs, *(fillets[side].dofs for side in SIDES)]))
    motions = rigid_motions(elasticity) if free else None
    condensed, side_size, turn, _ = condensed_sector(mesh, elasticity, ports, expandable=cracked, motions=motions)
    part = between_sides(condensed, side_size, turn)
    if bore is not None:
        part = held_sectors(0, bore, part).part
    follow = np.hstack([part.follow_a, part.follow_b])
    run = ports_of(condensed, flank.dofs)
    modulus = 1.0 / (1.0 - poisson_ratio**2) if plane == "strain" else 1.0
    rows = {side: ports_of(condensed, fillet.dofs) for side, fillet in fillets.items()}
    intensity_follows, intensity_own = np.zeros((0, 2, follow.shape[1])), np.zeros((0, 2, run.size))
    if isinstance(odd.sector, CrackedSector):
        each = [interaction(odd.sector, poisson_ratio, plane, elasticity.order, ring) for ring in RINGS]
        forces = condensed.collect(np.hstack(each)).T
        intensity_follows = (forces @ follow).reshape(len(RINGS), 2, -1)
        intensity_own = (forces @ part.own[:, run]).reshape(len(RINGS), 2, -1)
    kind = ToothKind(
        tooth=tooth,
        mesh=mesh,
        flank=flank,
        fillets=fillets,
        flank_follows=follow[run],
        flank_own=part.own[np.ix_(run, run)],
        stress_follows={side: modulus * (fillets[side].strain @ follow[rows[side]]) for side in SIDES},
        stress_own={side: modulus * (fillets[side].strain @ part.own[np.ix_(rows[side], run)]) for side in SIDES},
        intensity_follows=intensity_follows,
        intensity_own=intensity_own,
        mouth=mouth,
        back=back,
        unknowns=condensed.size,
    )
    return kind, part
