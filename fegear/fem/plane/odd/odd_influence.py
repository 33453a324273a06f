"""Influence functions of a gear some of whose teeth differ: c_ij(p, q), root stress, and stress intensity as rows.

The teeth have numbers, rising clockwise (toward the side that the load comes from); compliances are no function of
i - j, and c_ij(p, q) = c_ji(q, p) alone is left of their symmetry.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import InputError
from fegear.base.one_thread import one_thread
from fegear.base.tally import tallied
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH
from fegear.fem.plane.elasticity import SectorElasticity, assemble, assemble_two_orders
from fegear.fem.plane.influence import SIDES, Influence, Side
from fegear.fem.plane.odd.cracked_sector import CrackedSector
from fegear.fem.plane.odd.odd_ring import OddRing, odd_ring
from fegear.fem.plane.odd.stress_intensity import RINGS, interaction
from fegear.fem.plane.root_stress import FilletCurve, FilletStrain, fillet_strain
from fegear.fem.plane.sector_sides import BetweenSides, between_sides, condensed_sector
from fegear.fem.plane.trace import LoadedFlank, loaded_flank

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_tooth import InvoluteTooth

#: How far below the flank a patch may reach into the fillet, but not down to a crack's mouth [modules]; the share of
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
class OddInfluence:
    """c_ij(p, q), root-stress and stress-intensity influence of one gear shape with odd teeth.

    Parameters
    ----------
    teeth : int
        z.
    reach : int
        R: teeth -R..R are known, among them the odd ones.
    loaded : mapping of int to Influence
        Of each of these teeth, loaded: its own flank and fillets, displacements of tooth i under ``compliance[i - j]``,
        stress of its fillets under ``stress[i - j, side]``.
    intensity : mapping of (int, int) to ndarray, shape (rings, 2, 2n)
        K_I and K_II of the crack of tooth i per force on the run of tooth j, by two rings of integration.
    mouths : mapping of int to (float, bool)
        Where the cracks of teeth start: arc length up the fillet [modules], and whether that is the one of the flank
        that is not loaded.
    seconds : mapping of str to float
    lower : OddInfluence, optional
        The same on the same meshes with elements one order lower, which shows the error.
    """

    teeth: int
    reach: int
    loaded: Mapping[int, Influence]
    intensity: Mapping[tuple[int, int], Array]
    mouths: Mapping[int, tuple[float, bool]]
    seconds: Mapping[str, float] = field(compare=False)
    lower: OddInfluence | None = None

    def own(self, i: int, radius: ArrayLike, patch: float, half_width: ArrayLike | None = None) -> Array:
        """c_ii(p, p): as `Influence.self_compliance`, shape (P,) [1/E]."""
        return self.loaded[i].self_compliance(radius, patch, half_width)

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike, patch: float) -> Array:
        """c_ij(p, q): deflection at p of tooth i per unit line load at q of tooth j, shape (P, Q) [1/E]."""
        there, here = self.loaded[i], self.loaded[j]
        return np.asarray(there.remote(radius_p, patch).T @ here.compliance[i - j] @ here.remote(radius_q, patch))

    def fillet_stress(
        self, i: int, j: int, side: Side, radius_q: ArrayLike, half_width: ArrayLike = REFERENCE_HALF_WIDTH
    ) -> Array:
        """Tangential stress along a fillet of tooth i per unit line load at q of tooth j, shape (points, Q) [1/module].

        Beside the mouth of a crack a fillet is free of stress.
        """
        return self.loaded[j].fillet_stress(i - j, side, radius_q, half_width)

    def largest_root_stress(
        self, i: int, j: int, side: Side, radius_q: ArrayLike, half_width: ArrayLike = REFERENCE_HALF_WIDTH
    ) -> tuple[Array, Array]:
        """Largest tension (or compression) of a fillet of tooth i, and the arc length where it sits, shape (Q,) each.

        Of a fillet in which a crack starts, on either side of its mouth.
        """
        here = self.loaded[j]
        _, above, width = here.fillet_loads(radius_q, half_width)
        if i != j or side == "compression":
            above = np.full(above.shape, np.inf)
        stress = self.fillet_stress(i, j, side, radius_q, half_width)
        sign = 1.0 if side == "tension" else -1.0
        best, place = np.full(above.shape, -np.inf), np.zeros(above.shape)
        for start, curve, points in self._pieces(i, side):
            value, at = curve.largest_below(stress[points], above, width)
            better = sign * value > best
            best, place = np.where(better, sign * value, best), np.where(better, at + start, place)
        return sign * best, place

    def _pieces(self, i: int, side: Side) -> list[tuple[float, FilletCurve, slice]]:
        """Start, curve and points of the pieces of a fillet: two where a crack starts in it."""
        whole = self.loaded[i].fillet_curve(side)
        mouth, back = self.mouths.get(i, (0.0, False))
        if i not in self.mouths or back != (side == "compression"):
            return [(0.0, whole, slice(None))]
        n = int(np.searchsorted(whole.arc, mouth))
        return [
            (0.0, replace(whole, arc=whole.arc[:n], length=mouth), slice(0, n)),
            (mouth, replace(whole, arc=whole.arc[n:] - mouth, length=whole.length - mouth), slice(n, None)),
        ]

    def stress_intensity(self, i: int, j: int, radius_q: ArrayLike, patch: float) -> tuple[Array, Array]:
        """K_I and K_II of the crack of tooth i per unit line load at q of tooth j, and their error, (2, Q) each.

        In 1/sqrt(module). The error is what the elements' last order changes, and another ring of integration.

        Raises
        ------
        InputError
            If the tooth has no crack.
        """
        if (i, j) not in self.intensity:
            raise InputError("tooth", i, f"has no crack; cracked: {', '.join(map(str, self.mouths)) or 'none'}")
        loads = self.loaded[j].remote(radius_q, patch)
        usual, other = (rows @ loads for rows in self.intensity[i, j])
        error = np.abs(usual - other)
        if self.lower is not None:
            below = self.lower.intensity[i, j][0] @ self.lower.loaded[j].remote(radius_q, patch)
            error = error + np.abs(usual - below)
        return usual, error if self.lower is not None else np.full(error.shape, np.nan)


class _Asked(NamedTuple):
    """What a ring is solved for, whatever its elements."""

    tooth: InvoluteTooth
    mesh: SectorMesh
    odd: Mapping[int, OddTooth]
    poisson_ratio: float
    plane: Plane
    reach: int
    corner_distance: float


class _Sector(NamedTuple):
    """One kind of sector, ready for the ring."""

    part: BetweenSides
    mesh: SectorMesh
    tooth: InvoluteTooth
    flank: LoadedFlank
    fillets: dict[Side, FilletStrain]
    rows: Array  # forces on the part's ports whose work is K_I, K_II: (rings, ports, 2)


@tallied("tooth shapes")
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
        Whose order and corner distance are taken, and who assembles.
    reach : int
        R: teeth -R..R are known; twice this and one at most z.
    two_orders : bool
        Whether to solve with elements one order lower as well (`OddInfluence.lower`).

    Raises
    ------
    InputError
        If an odd sector's sides are not the ordinary one's, or there are too few teeth for the reach.
    FegearError
        If a stiffness is not positive definite.
    """
    what = _Asked(tooth, mesh, odd, poisson_ratio, plane, reach, settings.corner_distance)
    meshes = [mesh, *(one.mesh for one in odd.values())]
    with one_thread():
        if not two_orders:
            solver = settings.solver
            return _solve(what, [assemble(each, poisson_ratio, plane, settings.order, solver) for each in meshes])
        pairs = [assemble_two_orders(each, poisson_ratio, plane, settings.order, settings.solver) for each in meshes]
        higher, lower = (_solve(what, list(each)) for each in zip(*pairs, strict=True))
        return replace(higher, lower=lower)


def _solve(what: _Asked, elasticity: list[SectorElasticity]) -> OddInfluence:
    started = time.perf_counter()
    usual = _sector(what, what.tooth, what.mesh, elasticity[0])
    kinds = {
        number: _sector(what, one.tooth, one.sector, found)
        for (number, one), found in zip(what.odd.items(), elasticity[1:], strict=True)
    }
    condensed = time.perf_counter()
    parts = {number: kind.part for number, kind in kinds.items()}
    ring = odd_ring(usual.part, parts, what.tooth.teeth, what.reach)
    closed = time.perf_counter()
    every = range(-what.reach, what.reach + 1)
    loaded = {j: _loaded(what, ring, kinds, usual, j) for j in every}
    intensity = {
        (i, j): np.stack([
            ring.respond(j, kinds.get(j, usual).flank.dofs, i, kind.part.sector.kept, rows).T for rows in kind.rows
        ])
        for i, kind in kinds.items() if kind.rows.size
        for j in every
    }  # fmt: skip
    mouths = {
        number: (one.sector.mouth, one.sector.back)
        for number, one in what.odd.items()
        if isinstance(one.sector, CrackedSector)
    }
    seconds = {
        "mesh": what.mesh.seconds + sum(kind.mesh.seconds for kind in kinds.values()),
        "condensation": condensed - started,
        "ring": closed - condensed,
        "influence": time.perf_counter() - closed,
    }
    return OddInfluence(what.tooth.teeth, what.reach, loaded, intensity, mouths, seconds)


def _sector(
    what: _Asked, tooth: InvoluteTooth, sector: SectorMesh | CrackedSector, elasticity: SectorElasticity
) -> _Sector:
    mesh = sector.mesh if isinstance(sector, CrackedSector) else sector
    margin = _MARGIN
    fillets = {side: fillet_strain(mesh, elasticity, name, tooth.side) for side, name in _FILLETS.items()}
    if isinstance(sector, CrackedSector) and not sector.back:
        margin = min(margin, _ABOVE_MOUTH * (fillets["tension"].length - sector.mouth))
    flank = loaded_flank(mesh, elasticity, tooth, margin)
    ports = np.concatenate([flank.dofs, *(fillets[side].dofs for side in SIDES)])
    cracked = isinstance(sector, CrackedSector)
    condensed, side, turn, _ = condensed_sector(mesh, elasticity, np.unique(ports), expandable=cracked)
    part = between_sides(condensed, side, turn)
    rows = np.zeros((0, 0, 0))
    if isinstance(sector, CrackedSector):
        order = elasticity.order
        each = [interaction(sector, what.poisson_ratio, what.plane, order, ring) for ring in RINGS]
        rows = np.stack(np.hsplit(condensed.collect(np.hstack(each)), len(RINGS)))
    return _Sector(part, mesh, tooth, flank, fillets, rows)


def _loaded(what: _Asked, ring: OddRing, kinds: Mapping[int, _Sector], usual: _Sector, j: int) -> Influence:
    here = kinds.get(j, usual)
    modulus = 1.0 / (1.0 - what.poisson_ratio**2) if what.plane == "strain" else 1.0
    compliance: dict[int, Array] = {}
    stress: dict[tuple[int, Side], Array] = {}
    for i in range(-what.reach, what.reach + 1):
        there = kinds.get(i, usual)
        watch = np.concatenate([there.flank.dofs, *(there.fillets[side].dofs for side in SIDES)])
        moved = ring.respond(i, watch, j, here.flank.dofs)
        n, t = there.flank.dofs.size, there.fillets["tension"].dofs.size
        compliance[i - j] = np.ascontiguousarray(moved[:n])
        stress[i - j, "tension"] = modulus * (there.fillets["tension"].strain @ moved[n : n + t])
        stress[i - j, "compression"] = modulus * (there.fillets["compression"].strain @ moved[n + t :])
    return Influence(
        here.tooth, what.poisson_ratio, what.plane, here.mesh, here.flank, compliance, here.fillets, stress,
        what.corner_distance, what.reach, here.part.sector.size, {},
    )  # fmt: skip
