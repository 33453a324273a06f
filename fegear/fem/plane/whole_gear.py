"""The mesh of the whole gear: one sector turned z times, sides merged, boundaries kept by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.fem.plane.mesh import SectorMesh
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
        raise InputError("mesh", mesh.origin, "has sides whose nodes do not match after rotation by one pitch")
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
