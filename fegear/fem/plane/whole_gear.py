"""The mesh of the whole gear: one sector turned z times, sides merged, boundaries kept by name.

Displacement and stress of the whole gear under one contact, for pictures and exports; dimensionless.

The whole gear under one load on tooth 0: displacement and stress at every node, for pictures and other programs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.fem.plane.elasticity import assemble, lame
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.ring import close_ring
from fegear.fem.plane.sector import mesh_sector
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.trace import loaded_flank
from fegear.geometry.gear import Gear, Plane
from fegear.geometry.involute_tooth import InvoluteTooth
from fegear.geometry.outline import turned

#: Boundaries that vanish when the sectors are joined.
SIDES = ("side_a", "side_b")


@dataclass(frozen=True)
class WholeGear:
    """Six-node triangles of all sectors.

    Attributes
    ----------
    points : ndarray, shape (2, N)
        [modules].
    triangles : ndarray of int, shape (6, M)
        Sector after sector, clockwise from tooth 0 at +y.
    boundaries : mapping of str to ndarray of int, shape (3, n)
        Edges (vertex, vertex, middle) of each named boundary over all teeth, and of tooth 0 alone under ``<name>_0``.
    sector_nodes : ndarray of int, shape (z, n)
        Node of the whole gear for each node of the sector, tooth by tooth.
    """

    points: Array
    triangles: Index
    boundaries: Mapping[str, Index]
    sector_nodes: Index

    @property
    def outline(self) -> Index:
        """Edges that only one triangle has (vertex, middle, vertex), shape (3, n)."""
        t = self.triangles
        edges = np.hstack([t[[a, b, c]] for a, b, c in ((0, 3, 1), (1, 4, 2), (2, 5, 0))])
        _, first, count = np.unique(edges[1], return_index=True, return_counts=True)
        return edges[:, first[count == 1]]

    def node_set(self, name: str) -> Index:
        """Nodes of a boundary, each once, in ascending order."""
        return np.unique(self.boundaries[name])


def _side_nodes(mesh: SectorMesh, name: str) -> Index:
    """Nodes of a side from the bore outward."""
    nodes = np.unique(mesh.edges[name])
    return nodes[np.argsort(np.hypot(*mesh.points[:, nodes]))]


def whole_gear(mesh: SectorMesh) -> WholeGear:
    """Turn and join one sector into the whole gear.

    Parameters
    ----------
    mesh : SectorMesh

    Returns
    -------
    WholeGear

    Raises
    ------
    InputError
        If the sides of the sector do not fit each other.
    """
    z, count = mesh.teeth, mesh.points.shape[1]
    pitch = 2.0 * np.pi / z
    a, b = _side_nodes(mesh, "side_a"), _side_nodes(mesh, "side_b")
    # Sector k + 1 lies clockwise of sector k: the side at which x is larger meets the next one.
    if mesh.points[0, a].sum() > mesh.points[0, b].sum():
        a, b = b, a
    size = float(np.abs(mesh.points).max())
    if a.size != b.size or np.abs(turned(mesh.points[:, a], pitch) - mesh.points[:, b]).max() > 1e-9 * size:
        raise InputError("mesh", mesh.origin, "has sides whose nodes do not fit each other after one pitch's turn")
    own = np.setdiff1d(np.arange(count), a)
    nodes = np.empty((z, count), dtype=np.int64)
    nodes[:, own] = np.arange(own.size) + own.size * np.arange(z)[:, None]
    nodes[:, a] = np.roll(nodes[:, b], 1, axis=0)
    points = np.empty((2, own.size * z))
    for k in range(z):
        points[:, nodes[k, own]] = turned(mesh.points[:, own], k * pitch)
    triangles = nodes[:, mesh.triangles].transpose(1, 0, 2).reshape(6, -1)
    boundaries: dict[str, Index] = {}
    for name, edges in mesh.edges.items():
        if name not in SIDES:
            boundaries[name] = nodes[:, edges].transpose(1, 0, 2).reshape(3, -1)
            boundaries[f"{name}_0"] = nodes[0, edges]
    return WholeGear(points, triangles, boundaries, nodes)


@dataclass(frozen=True)
class GearField:
    """What a unit line load on tooth 0 does to the whole gear; module 1, Young's modulus 1.

    Attributes
    ----------
    mesh : SectorMesh
    displacement : ndarray, shape (z, 2, N)
        Of every node of every sector, each in its own frame (its tooth along +y), sectors clockwise from tooth 0.
    stress : ndarray, shape (z, 4, N)
        sigma_xx, sigma_yy, sigma_xy, sigma_zz in the same frames, averaged over the elements around a node.
    forces : ndarray, shape (2, N)
        The nodal forces on tooth 0 that the contact's pressure amounts to.
    """

    mesh: SectorMesh
    displacement: Array
    stress: Array
    forces: Array

    @property
    def von_mises(self) -> Array:
        """Equivalent stress, shape (z, N)."""
        xx, yy, xy, zz = (self.stress[:, i] for i in range(4))
        return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2)


def gear_field(
    tooth: InvoluteTooth, mesh: SectorMesh, poisson_ratio: float, plane: Plane, radius: float, half_width: float
) -> GearField:
    """Solve the whole gear under one semi-elliptic contact pressure on tooth 0.

    Parameters
    ----------
    tooth : InvoluteTooth
    mesh : SectorMesh
    poisson_ratio : float
    plane : {"strain", "stress"}
    radius, half_width : float
        Place and half-width of the contact [modules].

    Returns
    -------
    GearField
    """
    z = mesh.teeth
    elasticity = assemble(mesh, poisson_ratio, plane, order=2)
    flank = loaded_flank(mesh, elasticity, tooth, margin=0.15)
    ring = close_ring(mesh, elasticity, flank.dofs, reach=z // 2, expandable=True)
    forces = flank.patches(flank.arc_of_radius(np.array([radius])), np.array([half_width]))
    loads = np.zeros(ring.size)
    loads[flank.dofs] = forces[:, 0]
    sectors = [(k + z // 2) % z - z // 2 for k in range(z)]  # clockwise from tooth 0, within the reach
    response = ring.field(flank.dofs, forces, sectors)
    displacement = np.stack([response[k][:, 0][elasticity.node_dofs] for k in sectors])
    stress = _nodal_stress(mesh, displacement, poisson_ratio, plane)
    return GearField(mesh, displacement, stress, loads[elasticity.node_dofs])


def _nodal_stress(mesh: SectorMesh, displacement: Array, poisson_ratio: float, plane: Plane) -> Array:
    """Stress at the elements' own nodes, averaged where elements meet within a sector, shape (z, 4, N)."""
    from scipy.sparse import csr_array

    lam, mu = lame(poisson_ratio, plane)
    elements = sector_elements(mesh, order=2)
    points = np.argsort(elements.point_nodes)[elements.element_nodes]  # (M, 6)
    gradient = elements.gradients_at_nodes() / np.bincount(points.reshape(-1))[points][:, None, None]
    columns, rows = (np.broadcast_to(p, (*points.shape, 6)).reshape(-1) for p in (points[:, :, None], points[:, None]))
    by_x, by_y = (csr_array((gradient[:, :, d].reshape(-1), (rows, columns))) for d in range(2))
    u, v = displacement.transpose(1, 2, 0)
    xx, yy, shear = by_x @ u, by_y @ v, by_y @ u + by_x @ v
    trace = lam * (xx + yy)
    zz = trace if plane == "strain" else np.zeros_like(trace)
    return np.stack([trace + 2 * mu * xx, trace + 2 * mu * yy, mu * shear, zz]).transpose(2, 0, 1)


_MM = 1e3


#: Six-node triangles are of this order, and want edges so much shorter than those of fourth order.
_FIELD_ORDER, _SIX_NODE_EDGES = 2, 0.7


def loaded_gear(
    gear: Gear, settings: MeshSettings, mesh: SectorMesh | None = None, radius: float | None = None
) -> tuple[WholeGear, GearField]:
    """Solve the whole gear under 1 N/mm on tooth 0.

    Parameters
    ----------
    gear : Gear
    settings : MeshSettings
        The field is solved on six-node triangles, which other programs read; edges meant for a higher order are
        shortened.
    mesh : SectorMesh, optional
        A user's own sector mesh.
    radius : float, optional
        Load radius [m]; by default the pitch radius, or the flank's end nearest to it.
    """
    if gear.support is not None:
        raise InputError(
            "rim_support", "pins or a spline", "is not known to fields of the whole gear, whose rim is held",
            'write rim_support = { kind = "held" }',
        )  # fmt: skip
    if settings.order > _FIELD_ORDER:
        settings = replace(settings.scaled(_SIX_NODE_EDGES), order=_FIELD_ORDER)
    shape = mesh or mesh_sector(gear.tooth, gear.bore_radius / gear.module, settings)
    low, high = gear.involute_radii
    place = min(max(gear.pitch_radius if radius is None else radius, low), high)
    room = min(place - low, high - place) / gear.module
    half_width = max(min(settings.patch_half_width, room), settings.corner_distance)
    nu, plane = gear.material.poisson_ratio, gear.plane_assumption
    return whole_gear(shape), gear_field(gear.tooth, shape, nu, plane, place / gear.module, half_width)


def nodal_fields(gear: Gear, whole: WholeGear, field: GearField, line_load: float) -> dict[str, Array]:
    """Displacement [mm] and von Mises stress [MPa] at the nodes of the whole gear.

    Parameters
    ----------
    gear : Gear
    whole : WholeGear
    field : GearField
    line_load : float
        [N/m].

    Returns
    -------
    dict
        ``displacement`` of shape (N, 3) and ``von_mises`` of shape (N,); on the seam of two sectors their mean.
    """
    count = whole.points.shape[1]
    displacement, stress, times = np.zeros((count, 3)), np.zeros(count), np.zeros(count)
    pitch, von_mises = 2.0 * np.pi / gear.teeth, field.von_mises
    for k, nodes in enumerate(whole.sector_nodes):
        displacement[nodes, :2] = turned(field.displacement[k], k * pitch).T
        stress[nodes] += von_mises[k]
        times[nodes] += 1.0
    return {
        "displacement": displacement * line_load / gear.material.young_modulus * _MM,
        "von_mises": stress / times * line_load / gear.module * 1e-6,
    }
