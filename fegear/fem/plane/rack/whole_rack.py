"""The mesh of a whole rack: one sector after the other, sides merged, boundaries kept by name and tooth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.fem.plane.elasticity import assemble
from fegear.fem.plane.gear_field import GearField, nodal_stress
from fegear.fem.plane.gear_section import Section, paired, uneven_settings
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.rack.rack_mesh import rack_boundary, rack_sector
from fegear.fem.plane.rack.straight_flank import straight_flank
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_inside
from fegear.fem.plane.whole_gear import SIDES, WholeGear
from fegear.geometry.toothed_rack import Rack

#: Nodes of facing sides are at one place to this [modules].
_SAME = 1e-9
#: How far below the flank a pressure may reach into the root rounding [modules].
_MARGIN = 0.15
#: Order of the elements that other programs read; edges meant for fourth order are so much shorter then.
_FIELD_ORDER, _SIX_NODE_EDGES = 2, 0.7


def middle_tooth(rack: Rack) -> int:
    """Number from 0 of the tooth that exports load: the middle one, of an even number the first of both."""
    return (rack.teeth - 1) // 2


def held_boundary(rack: Rack) -> str:
    """Name of the boundary at which the rack is held: all of its back, or the parts of it on pins."""
    return "back" if rack.pins is None else "pins"


def whole_rack(rack: Rack, settings: MeshSettings) -> tuple[WholeGear, SectorMesh]:
    """Six-node triangles of all teeth of a spur rack.

    Parameters
    ----------
    rack : Rack
    settings : MeshSettings
        Edges meant for a higher order are shortened.

    Returns
    -------
    whole : WholeGear
        Tooth 0 at x = 0, as in drawings; boundaries (``flank``, ``fillet``, ..., the held part of the back as
        `held_boundary`, ``end_a`` and ``end_b``) over all teeth, and of the `middle_tooth`, counted from 1, as
        ``flank_3``.
    mesh : SectorMesh
        The same as one sector about its loaded tooth, whose boundaries are those of that tooth, with all of the held
        back as ``bore``.
    """
    if settings.order > _FIELD_ORDER:
        settings = replace(settings.scaled(_SIX_NODE_EDGES), order=_FIELD_ORDER)
    one = rack_sector(rack.tooth, rack.body / rack.module, settings, _pin_width(rack))
    sectors, loaded = [one] * rack.teeth, middle_tooth(rack)
    points, numbers = _joined(sectors, one.pitch)
    triangles = np.hstack([number[one.triangles] for number in numbers])
    edges = _boundaries(rack, sectors, numbers)
    over_all = {name: np.hstack([e for (n, _), e in edges.items() if n == name]) for name, _ in edges}
    own = {name: e for (name, i), e in edges.items() if i == loaded}
    singled = {f"{name}_{loaded + 1}": e for name, e in own.items()}
    held = {"bore": over_all[held_boundary(rack)]}
    mesh = SectorMesh(points - [[loaded * one.pitch], [0.0]], triangles, own | held, 1, pitch=one.pitch)
    return WholeGear(points, triangles, over_all | singled, np.arange(points.shape[1])[None]), mesh


def rack_field(rack: Rack, mesh: SectorMesh, half_width: float) -> GearField:
    """Solve a whole spur rack under a unit line load on its middle tooth, by sparse elimination.

    Parameters
    ----------
    rack : Rack
    mesh : SectorMesh
        As of `whole_rack`.
    half_width : float
        Of the semi-elliptic pressure, at most [modules]. Its middle is on the reference line, or at the end of the
        flank nearest to it.

    Returns
    -------
    GearField
        Of one sector, which is the rack; module 1, Young's modulus 1.
    """
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import splu

    nu, tooth = rack.material.poisson_ratio, rack.tooth
    elasticity = assemble(mesh, nu, rack.plane, order=_FIELD_ORDER)
    flank = straight_flank(mesh, elasticity, tooth, _MARGIN)
    low, high = flank.heights
    height = min(max(0.0, low), high)
    place = flank.arc_of_radius(np.array([height]))
    room = min(height - low + _MARGIN * 0.5, high - height)
    force = np.zeros(elasticity.size)
    force[flank.dofs] = flank.patches(place, np.array([min(half_width, room)]))[:, 0]
    dofs, size = elasticity.element_dofs, elasticity.size
    rows, columns = (np.broadcast_to(d, elasticity.stiffness.shape).ravel() for d in (dofs[:, :, None], dofs[:, None]))
    stiffness = csc_array((elasticity.stiffness.ravel(), (rows, columns)), shape=(size, size))
    free = np.setdiff1d(np.arange(size), elasticity.edge_dofs["bore"])
    moved = np.zeros(size)
    moved[free] = splu(stiffness[free][:, free], "MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(force[free])
    displacement = moved[elasticity.node_dofs][None]
    stress = nodal_stress(mesh, displacement, nu, rack.plane)
    return GearField(mesh, displacement, stress, force[elasticity.node_dofs])


def rack_section(rack: Rack, coarseness: float) -> Section:
    """Section of a rack for one load: the middle tooth fine, its neighbours less so, the others coarse.

    Parameters
    ----------
    rack : Rack
    coarseness : float
        As of `uneven_section`.

    Returns
    -------
    Section
        Tooth 0 at x = 0; boundaries by the number of the tooth from 0, the held part of the back as `held_boundary`.
    """
    body, width = rack.body / rack.module, _pin_width(rack)
    settings = uneven_settings(coarseness)
    every = [rack_boundary(rack.tooth, body, kind, width) for kind in settings]
    own = ("bore", "back", *SIDES)  # neighbours fit: all have the sides and the back of the middle tooth
    kinds = [
        replace(
            mesh_inside(
                [first if first.name in own else chain for first, chain in zip(every[0], chains, strict=True)],
                1, growth=kind.side_growth,
            ),
            pitch=rack.tooth.pitch,
        )
        for chains, kind in zip(every, settings, strict=True)
    ]  # fmt: skip
    sectors = [kinds[min(abs(i - middle_tooth(rack)), 2)] for i in range(rack.teeth)]
    points, numbers = _joined(sectors, rack.tooth.pitch)
    both = {id(mesh): paired(mesh) for mesh in kinds}
    three, four = (
        np.hstack([number[both[id(mesh)][n]] for mesh, number in zip(sectors, numbers, strict=True)]) for n in (0, 1)
    )
    return Section(points, three, four, _boundaries(rack, sectors, numbers), rack.teeth, closed=False)


def _pin_width(rack: Rack) -> float:
    return 0.0 if rack.pins is None else rack.pins.width / rack.module


def _joined(sectors: Sequence[SectorMesh], pitch: float) -> tuple[Array, list[Index]]:
    """Points of sectors side by side, and for each sector the numbers of its nodes."""
    points: list[Array] = []
    numbers: list[Index] = []
    count, before = 0, np.zeros(0, dtype=np.int64)
    for i, mesh in enumerate(sectors):
        number = np.full(mesh.points.shape[1], -1)
        if i:
            left, right = _upward(mesh, "side_a"), _upward(sectors[i - 1], "side_b")
            apart = mesh.points[1, left] - sectors[i - 1].points[1, right] if left.size == right.size else np.ones(1)
            if np.abs(apart).max() > _SAME:
                raise InputError("mesh", "side_a, side_b", "have different nodes, so that sectors cannot be joined")
            number[left] = before
        new = number < 0
        number[new] = count + np.arange(int(new.sum()))
        count += int(new.sum())
        points.append(mesh.points[:, new] + [[i * pitch], [0.0]])
        numbers.append(number)
        before = number[_upward(mesh, "side_b")]
    every = np.hstack(points)
    vertices = np.unique(np.concatenate([n[m.triangles[:3]].ravel() for m, n in zip(sectors, numbers, strict=True)]))
    order = np.concatenate([vertices, np.setdiff1d(np.arange(count), vertices)])  # as `SectorMesh` wants them
    place = np.empty(count, dtype=np.int64)
    place[order] = np.arange(count)
    return every[:, order], [place[number] for number in numbers]


def _upward(mesh: SectorMesh, name: str) -> Index:
    """Nodes of a side from the back upward."""
    nodes = np.unique(mesh.edges[name])
    return nodes[np.argsort(mesh.points[1, nodes])]


def _boundaries(rack: Rack, sectors: Sequence[SectorMesh], numbers: Sequence[Index]) -> dict[tuple[str, int], Index]:
    """Edges by name and tooth; the ends of the rack at its first and last tooth."""
    found: dict[tuple[str, int], Index] = {}
    for i, (mesh, number) in enumerate(zip(sectors, numbers, strict=True)):
        for name, edges in mesh.edges.items():
            if name in SIDES:
                continue
            on_pin = rack.pins is not None and rack.pins.holds(i)
            real = ("pins" if on_pin else "back") if name == "bore" else name
            before = [found[real, i]] if (real, i) in found else []
            found[real, i] = np.hstack([*before, number[edges]])
    found["end_a", 0] = numbers[0][sectors[0].edges["side_a"]]
    found["end_b", rack.teeth - 1] = numbers[-1][sectors[-1].edges["side_b"]]
    return found
