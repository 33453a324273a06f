"""One sector of a solid ring before it is solved: its section, functions along the face, flank, fillets, unknowns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index, Mask
from fegear.base.errors import InputError
from fegear.fem.plane.body import with_body
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.trace import LoadedFlank, loaded_flank
from fegear.fem.solid.face import FaceFunctions, JoinedFunctions, face_functions, own_of_teeth, solid_unknowns
from fegear.fem.solid.fillet import SolidFillet, solid_fillet
from fegear.fem.solid.section import Section, make_section, upward

if TYPE_CHECKING:
    from fegear.fem.plane.influence import Side
    from fegear.fem.plane.settings import MeshSettings
    from fegear.fem.solid.settings import SolidSettings
    from fegear.fem.solid.unknowns import Unknowns
    from fegear.geometry.gear_body import GearBody
    from fegear.geometry.involute_side import InvoluteSide

#: Nodes of two sides this near to each other are the same [modules].
_SAME = 1e-9
FILLETS: dict[Side, str] = {"tension": "fillet", "compression": "back_fillet"}


@dataclass(frozen=True)
class SolidSector:
    """One sector of a solid ring.

    Parameters
    ----------
    section : Section
    body_face : FaceFunctions
        Along the face of web, hub and rim.
    face : FaceFunctions
        Of flank and fillets.
    joined : FaceFunctions or JoinedFunctions
        Of all together.
    known : Unknowns
    trace : LoadedFlank or None
        The loaded flank; None where the tooth is missing.
    fillets : dict of {"tension", "compression"} to SolidFillet
        Empty where the tooth is missing.
    symmetric : bool
        Whether motions that mirror themselves at the middle of the face are solved apart from all others.
    held : (float, float) or None
        Part of the width on which the bore is held.
    """

    section: Section
    body_face: FaceFunctions
    face: FaceFunctions
    joined: FaceFunctions | JoinedFunctions
    known: Unknowns
    trace: LoadedFlank | None
    fillets: dict[Side, SolidFillet]
    symmetric: bool
    held: tuple[float, float] | None

    @property
    def flank(self) -> LoadedFlank:
        """The loaded flank.

        Raises
        ------
        ValueError
            If the tooth is missing.
        """
        if self.trace is None:
            raise ValueError("the sector has no tooth")
        return self.trace

    @property
    def columns(self) -> slice:
        """Which of all functions flank and fillets have."""
        return slice(None) if self.face is self.body_face else slice(self.body_face.count, None)

    @property
    def sides(self) -> list[Index]:
        """Unknowns of the section on sides A and B, in one order."""
        return [_of_nodes(nodes) for nodes in (self.section.side_a, self.section.side_b)]

    @property
    def ports(self) -> Index:
        """Those that push against the loaded flank, from its lower end to the tip."""
        return 3 * flank_nodes(self.section) if self.trace is not None else np.zeros(0, dtype=np.int64)

    @property
    def seen(self) -> dict[Side, Index]:
        """Those of the fillets."""
        return {side: _of_nodes(fillet.nodes) for side, fillet in self.fillets.items()}

    def halves(self) -> tuple[Unknowns, ...]:
        """Unknowns that move by themselves: all, or an eighth of the work twice."""
        if not self.symmetric:
            return (self.known,)
        # A motion that mirrors itself at the middle of the face, shape (size of the section, functions).
        axial = np.arange(self.section.size) % 3 == 2
        mask: Mask = axial[:, None] == self.joined.odd
        return self.known.split(mask)

    def fillet_unknowns(self, alone: Unknowns) -> dict[Side, tuple[Index, Index]]:
        """Which unknown of a fillet and which function each of those is that `Unknowns.of` gives, one by one."""
        found: dict[Side, tuple[Index, Index]] = {}
        for side, part in self.seen.items():
            node, function = np.nonzero(alone.number[part][:, self.columns] >= 0)
            found[side] = node, function
        return found

    def in_space(self, side: Side, moved: Array) -> Array:
        """Displacements x, y, z of a fillet's nodes, (nodes, 3, functions, n), of its unknowns', (3 nodes, ..., n)."""
        of_nodes = moved.reshape(-1, 3, *moved.shape[1:])
        axes = self.section.axes[self.fillets[side].nodes]
        return np.asarray(np.einsum("ncd,ndkr->nckr", axes, of_nodes, optimize=True))


def _of_nodes(nodes: Index) -> Index:
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel())


def solid_sector(
    tooth: InvoluteSide,
    tau: float,
    width: float,
    poisson_ratio: float,
    mesh: SectorMesh,
    settings: SolidSettings,
    body: GearBody | None = None,
    held: tuple[float, float] | None = None,
    *,
    plane_strain: bool = False,
    bore_held: bool = True,
    beside: SolidSector | None = None,
) -> SolidSector:
    """Integrate a section, and choose which functions along the face its nodes have.

    Parameters
    ----------
    tooth : InvoluteSide
        The transverse section.
    tau, width, poisson_ratio, settings, body, held, plane_strain
        As of `solution.solve_solid`.
    mesh : SectorMesh
        Of the section.
    bore_held : bool
        Not the outer circle of a ring that has another support.
    beside : SolidSector, optional
        The ordinary one, next to which one whose tooth differs stands: with its functions at the sides.

    Raises
    ------
    InputError
        If its sides are not those of the ordinary one.
    """
    along = None if body is None else body.along(width)
    section = make_section(
        mesh, settings.section.order, tau, poisson_ratio, tooth.base_radius, body,
        side=tooth.side, along=along, solver=settings.section.solver,
    )  # fmt: skip
    if beside is not None:
        _refuse_other_sides(section, beside.section)
    held = held if along is None else along.hub
    cuts = (held or ()) if along is None else along.ends
    symmetric = tau == 0.0 and (held is None if body is None else body.even)
    face = face_functions(
        width, settings.degree(width), cuts, settings.least_piece_degree, settings.fewer_on_pieces, mirrored=symmetric
    )
    beyond = own_of_teeth(face, body, tooth.root_radius)
    own = face_functions(width, settings.degree(width)) if math.isfinite(beyond) else face
    known = solid_unknowns(
        section,
        face,
        settings,
        held,
        plane_strain=plane_strain,
        teeth=None if own is face else (own, beyond),
        bore_held=bore_held,
        beside=None if beside is None else beside.section,
    )
    there = "flank" in mesh.edges
    return SolidSector(
        section, face, own, face if own is face else JoinedFunctions(face, own), known,
        section_flank(mesh, section, tooth) if there else None,
        {side: solid_fillet(section, name) for side, name in FILLETS.items()} if there else {},
        symmetric, held,
    )  # fmt: skip


def _refuse_other_sides(section: Section, ordinary: Section) -> None:
    for name in ("side_a", "side_b"):
        here, there = (one.places[:, getattr(one, name)] for one in (section, ordinary))
        if here.shape != there.shape or np.abs(here - there).max() > _SAME:
            raise InputError("mesh", name, "of an odd sector has other nodes than the ordinary sector's")


def section_mesh(
    tooth: InvoluteSide,
    bore_radius: float,
    settings: MeshSettings,
    body: GearBody | None,
    *,
    frontal: bool = False,
    layer: float | None = None,
    fewest: int = 2,
) -> SectorMesh:
    """The section of one tooth, down to the bore, whose edges follow the circles of rim and hub if it has a body.

    `layer` is the largest share of web and hub that one layer of elements spans, by default the settings'; there are
    `fewest` at least.
    """
    if body is None:
        return mesh_sector(tooth, bore_radius, settings, frontal=frontal)
    rim = mesh_sector(tooth, body.rim_radius, settings, frontal=frontal)
    return with_body(rim, body, bore_radius, settings.rim_fraction if layer is None else layer, fewest)


def flank_nodes(section: Section) -> Index:
    """Nodes of the loaded flank from its lower end to the tip, shape (n,)."""
    line, _ = upward(section, "flank")
    return np.concatenate([line[0, :1], line[1:].T.ravel()])


def section_flank(mesh: SectorMesh, section: Section, tooth: InvoluteSide) -> LoadedFlank:
    """The loaded flank of a section; nothing presses on fillet or tip rounding."""
    return loaded_flank(mesh, PlaneUnknowns(section), tooth, margin=0.0)


@dataclass(frozen=True)
class PlaneUnknowns:
    """The section's boundary with plane unknowns, as the trace of the flank wants them."""

    section: Section

    @property
    def order(self) -> int:
        """Order of the elements."""
        return self.section.order

    @property
    def edge_dofs(self) -> dict[str, Index]:
        """Unknowns x and y of the nodes along each boundary edge, shape (2, order + 1, edges)."""
        return {name: 2 * nodes + np.array([0, 1])[:, None, None] for name, nodes in self.section.edge_nodes.items()}
