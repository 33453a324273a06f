"""The mesh of one tooth sector: curved triangles and named boundary edges, whoever made them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError

#: Where fegear's own meshes come from.
GENERATED = "generated"


@dataclass(frozen=True)
class SectorMesh:
    """Six-node triangles of one tooth sector in modules, tooth centre line along +y, loaded flank at x > 0.

    Parameters
    ----------
    points : ndarray, shape (2, N)
        Vertices first, then the nodes in the middle of the edges [modules].
    triangles : ndarray of int, shape (6, M)
        Vertices 0 1 2, then the nodes between 0-1, 1-2 and 2-0; counterclockwise.
    edges : mapping of str to ndarray of int, shape (3, n)
        For each boundary its edges as (first vertex, second vertex, middle node), in counterclockwise order.
    teeth : int
        Number of sectors in the ring.
    origin : str
        Where the mesh came from, for the report.
    bends : mapping of str to ndarray, shape (2, 2, n)
        How the exact boundary leaves the chord of each edge at its first and second vertex (x and y of both), if
        known: dx/dxi at its ends is the chord + bends[:, 0] and the chord - bends[:, 1]. Elements of order 3 and 4
        follow these cubic edges, which have no kinks; the quadratic ones through the middle nodes have.
    tip : int
        Vertex at the tip of a crack, -1 without one. The middle nodes of its edges lie at a quarter of them, so that
        displacements hold the root of the distance from it, and the elements' determinants vanish there.
    pitch : float
        Of a rack's teeth, which stand side by side along x [modules]; 0 of a gear's, which stand about its axis.
    """

    points: Array
    triangles: Index
    edges: Mapping[str, Index]
    teeth: int
    origin: str = GENERATED
    seconds: float = field(default=0.0, compare=False)
    bends: Mapping[str, Array] = field(default_factory=dict)
    tip: int = -1
    pitch: float = 0.0

    def __post_init__(self) -> None:
        """Freeze the arrays and refuse inverted elements."""
        self.points.setflags(write=False)
        self.triangles.setflags(write=False)
        determinants = np.where(self.triangles == self.tip, np.inf, self.jacobians)  # at a crack's tip they vanish
        if float(determinants.min()) <= 0.0:
            raise InputError(
                "mesh",
                self.origin,
                f"has {int((determinants.min(axis=0) <= 0).sum())} inverted elements",
                "refine the mesh at curved boundaries, or check the node order of the elements",
            )

    @property
    def jacobians(self) -> Array:
        """Determinants of the elements' maps at their six nodes, shape (6, M); positive in a sound mesh."""
        u, v = np.array([0.0, 1.0, 0.0, 0.5, 0.5, 0.0]), np.array([0.0, 0.0, 1.0, 0.0, 0.5, 0.5])
        w = 1.0 - u - v
        du = np.array([1 - 4 * w, 4 * u - 1, 0 * u, 4 * (w - u), 4 * v, -4 * v])
        dv = np.array([1 - 4 * w, 0 * u, 4 * v - 1, -4 * u, 4 * u, 4 * (w - v)])
        nodes = self.points[:, self.triangles]
        a, b = np.einsum("cim,iq->cqm", nodes, du), np.einsum("cim,iq->cqm", nodes, dv)
        return a[0] * b[1] - a[1] * b[0]

    def outward(self, points: Array) -> Array:
        """How far out points are, shape (2, ...) to (...): from the axis, on a rack above its reference line."""
        return points[1] if self.pitch else np.hypot(*points)

    @property
    def vertex_count(self) -> int:
        """Number of vertices; they come first among the points."""
        return int(self.triangles[:3].max()) + 1


def with_middle_nodes(
    vertices: Array, triangles: Index, chains: Mapping[str, Index], middles: Mapping[str, Array]
) -> tuple[Array, Index, dict[str, Index]]:
    """Add a node in the middle of every edge: on the exact curve along the boundary, halfway inside.

    Parameters
    ----------
    vertices : ndarray, shape (2, N)
    triangles : ndarray of int, shape (3, M)
        Counterclockwise.
    chains : mapping of str to ndarray of int, shape (n + 1,)
        Vertices of each boundary in order.
    middles : mapping of str to ndarray, shape (2, n)
        Points of the exact curve in the middle of each boundary edge.

    Returns
    -------
    points, triangles, edges
        As `SectorMesh` wants them.
    """
    count = vertices.shape[1]
    pairs = np.sort(np.stack([triangles[[0, 1, 2]], triangles[[1, 2, 0]]]), axis=0).reshape(2, -1)
    keys, inverse = np.unique(pairs[0] * count + pairs[1], return_inverse=True)
    first, second = keys // count, keys % count
    middle_points = 0.5 * (vertices[:, first] + vertices[:, second])
    edges: dict[str, Index] = {}
    for name, chain in chains.items():
        key = np.minimum(chain[:-1], chain[1:]) * count + np.maximum(chain[:-1], chain[1:])
        where = np.searchsorted(keys, key)
        if (where >= keys.size).any() or (keys[np.minimum(where, keys.size - 1)] != key).any():
            raise InputError("mesh", name, "has boundary edges that belong to no element")
        middle_points[:, where] = middles[name]
        edges[name] = np.stack([chain[:-1], chain[1:], count + where])
    six = np.concatenate([triangles, count + inverse.reshape(3, -1)])
    return np.hstack([vertices, middle_points]), six, edges
