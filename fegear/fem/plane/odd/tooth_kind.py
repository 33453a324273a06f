"""One kind of sector of a ring with odd teeth: condensed, and how its flank, fillets and crack follow its sides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.elasticity import SectorElasticity
from fegear.fem.plane.influence import SIDES, Influence, Side
from fegear.fem.plane.odd.crack_faces import CrackFaces, opening_rows
from fegear.fem.plane.odd.cracked_sector import CrackedSector
from fegear.fem.plane.odd.odd_ring import held_sectors
from fegear.fem.plane.odd.stress_intensity import RINGS, by_faces, interaction
from fegear.fem.plane.rim import rigid_motions
from fegear.fem.plane.root_stress import FilletCurve, FilletStrain, fillet_strain
from fegear.fem.plane.sector_rows import sector_rows, stress_modulus
from fegear.fem.plane.sector_sides import BetweenSides, between_sides, condensed_sector, ports_of
from fegear.fem.plane.trace import LoadedFlank, loaded_flank
from fegear.geometry.involute_tooth import InvoluteTooth

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Mask
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.geometry.gear import Plane

#: How far below the flank a patch may reach into the fillet [modules], and how near to a crack's mouth, as a share of
#: the way there.
MARGIN, _ABOVE_MOUTH = 0.15, 0.97
FILLETS: dict[Side, str] = {"tension": "fillet", "compression": "back_fillet"}


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
    faces : CrackFaces, optional
        Those of a crack that may close.
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
    faces: CrackFaces | None = None

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


def tooth_kind(
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
    fillets = {side: fillet_strain(mesh, elasticity, name, tooth.side) for side, name in FILLETS.items()}
    margin, mouth, back = MARGIN, 0.0, False
    if isinstance(odd.sector, CrackedSector):
        mouth, back = odd.sector.mouth, odd.sector.back
        margin = margin if back else min(margin, _ABOVE_MOUTH * (fillets["tension"].length - mouth))
    flank = loaded_flank(mesh, elasticity, tooth, margin)
    closing = isinstance(odd.sector, CrackedSector) and odd.sector.closing
    face, opening, at_face = flank.dofs[:0], np.zeros((0, 0)), np.zeros((2, 0))
    if closing:
        face, opening, at_face = opening_rows(mesh, elasticity)
    ports = np.unique(np.concatenate([flank.dofs, face, *(fillets[side].dofs for side in SIDES)]))
    motions = rigid_motions(elasticity) if free else None
    condensed, side_size, turn, _ = condensed_sector(mesh, elasticity, ports, expandable=cracked, motions=motions)
    part = between_sides(condensed, side_size, turn)
    if bore is not None:
        part = held_sectors(0, bore, part).part
    follow = np.hstack([part.follow_a, part.follow_b])
    run, rows = ports_of(condensed, flank.dofs), sector_rows(part, flank, fillets, poisson_ratio, plane)
    intensity_follows, intensity_own = np.zeros((0, 2, follow.shape[1])), np.zeros((0, 2, run.size))
    if isinstance(odd.sector, CrackedSector):
        each = [interaction(odd.sector, poisson_ratio, plane, elasticity.elements, ring) for ring in RINGS]
        forces = condensed.collect(np.hstack(each)).T
        intensity_follows = (forces @ follow).reshape(len(RINGS), 2, -1)
        intensity_own = (forces @ part.own[:, run]).reshape(len(RINGS), 2, -1)
    faces = None
    if isinstance(odd.sector, CrackedSector) and closing:
        on, modulus = ports_of(condensed, face), stress_modulus(poisson_ratio, plane)
        pushed = part.own[:, on] @ opening.T
        faces = CrackFaces(
            follows=opening @ follow[on],
            by_flank=pushed[run].T,
            own=opening @ pushed[on],
            stress={
                side: modulus * (fillets[side].strain @ pushed[ports_of(condensed, fillets[side].dofs)])
                for side in SIDES
            },
            intensity=(forces @ pushed).reshape(len(RINGS), 2, -1)
            + np.stack([by_faces(odd.sector, at_face, ring) for ring in RINGS]),
        )
    kind = ToothKind(
        tooth=tooth,
        mesh=mesh,
        flank=flank,
        fillets=fillets,
        flank_follows=rows.flank_follows,
        flank_own=rows.flank_own,
        stress_follows=rows.stress_follows,
        stress_own=rows.stress_own,
        intensity_follows=intensity_follows,
        intensity_own=intensity_own,
        mouth=mouth,
        back=back,
        unknowns=condensed.size,
        faces=faces,
    )
    return kind, part


def ordinary_kind(known: Influence) -> ToothKind | None:
    """That of a solved ring's own sector; None where it does not know it by itself."""
    rows = known.rows
    if rows is None or not isinstance(known.tooth, InvoluteTooth):
        return None
    none = np.zeros((0, 2, 0))
    return ToothKind(
        known.tooth, known.mesh, known.flank, known.fillets, rows.flank_follows, rows.flank_own, rows.stress_follows,
        rows.stress_own, none, none, 0.0, False, known.unknowns,
    )  # fmt: skip
