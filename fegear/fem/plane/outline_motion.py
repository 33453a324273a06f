"""How the outline of a gear's teeth moves under a contact on one of them: what a picture of deformed teeth needs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Index
from fegear.base.one_thread import one_thread
from fegear.fem.plane.free_arc import free_arc_response
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.rim import supported_response
from fegear.fem.plane.ring_closure import close_ring
from fegear.fem.plane.supported_section import assemble_section

#: Boundaries of a sector that are no outline of a tooth.
_INNER = ("side_a", "side_b", "bore")
#: Vertices of the outline stand so far apart at least, corners excepted [modules].
_APART = 0.04
#: Points between them, at most so far apart: on the loaded flank, where dents are narrow, and elsewhere [modules].
_DENTS, _ELSEWHERE = 0.04, 0.15
#: The pressure that loads the mesh takes this share of the room to the nearest end of the flank.
_ROOM_SHARE = 0.7


@dataclass(frozen=True)
class OutlineMotion:
    """Displacements of the outline of teeth -K..K under contacts on tooth 0; module 1, Young's modulus 1.

    Parameters
    ----------
    influence : Influence
        Of the same gear, on the same mesh.
    points : ndarray, shape (2, N)
        The outline of a tooth in its own frame (centre line along +y), from the middle of its left space to the right.
    place : ndarray, shape (N,)
        Of the points in the row of the V vertices: 3.25 is a quarter of the way from vertex 3 to vertex 4.
    response : ndarray, shape (2 n, 2 K + 1, 2 V)
        Under forces on the unknowns of tooth 0's flank: x of all vertices, then y, in the frame of their own tooth.
    reach : int
        K.
    """

    influence: Influence
    points: Array
    place: Array
    response: NDArray[np.float32]
    reach: int

    def displacement(self, radius: Array, patch: float, half_width: Array) -> dict[int, Array]:
        """Move the outline under unit line loads.

        Parameters
        ----------
        radius : ndarray, shape (P,)
            Where the contacts stand [modules].
        patch : float
            Half-width of the pressure that loads the mesh, narrowed where the flank ends [modules].
        half_width : ndarray, shape (P,)
            Of the true contacts [modules].

        Returns
        -------
        dict of int to ndarray, shape (2, N, P)
            By tooth k = -K..K; k = +1 lies clockwise of the loaded one.

        Notes
        -----
        The mesh resolves a pressure of half-width a; the dent of the true one, of half-width b, differs from that by
        `log_slope` times the difference of the half-planes' own (`half_plane_dent`), which dies out with the square of
        the distance: so the surfaces of two gears under their Hertzian pressure fit each other. Few vertices stand on a
        flank: between them runs what they move by apart from the dent, which is known in every point.
        """
        from scipy.sparse import csr_array

        flank = self.influence.flank
        arc, least = flank.arc_of_radius(radius), self.influence.corner_distance
        arc = np.clip(arc, flank.flank_start + least, flank.flank_end - least)
        room = np.minimum(arc - flank.flank_start, flank.flank_end - arc)
        width = np.minimum(half_width, np.maximum(room, least))  # a picture of a corner needs no law of its own
        wide = np.maximum(np.maximum(np.minimum(patch, _ROOM_SHARE * room), least), width)
        forces = csr_array(flank.patches(arc, wide).T.astype(np.float32))  # a contact presses on few of the nodes
        found = (forces @ self.response.reshape(forces.shape[1], -1)).reshape(arc.size, 2 * self.reach + 1, 2, -1)
        moved = {k: found[:, k + self.reach].transpose(1, 2, 0) for k in range(-self.reach, self.reach + 1)}
        at, inward = self._contact(arc)
        distance = np.hypot(*(self.points[:, :, None] - at[:, None]))
        into = self.influence.log_slope * inward[:, None]
        vertices = distance[np.searchsorted(self.place, np.arange(found.shape[-1]))]
        moved[0] = moved[0] - half_plane_dent(vertices, wide) * into
        moved = {k: self._between(one) for k, one in moved.items()}
        moved[0] = moved[0] + half_plane_dent(distance, width) * into
        return moved

    def _between(self, moved: Array) -> Array:
        """Displacements of the points from those of the vertices, shape (2, V, P)."""
        low = np.minimum(self.place.astype(int), moved.shape[1] - 2)
        share = (self.place - low)[:, None]
        return moved[:, low] * (1.0 - share) + moved[:, low + 1] * share

    def _contact(self, arc: Array) -> tuple[Array, Array]:
        """Places of contacts and the directions into the tooth there, shape (2, P) each."""
        flank, tooth = self.influence.flank, self.influence.tooth
        radius = flank.radius_of_arc(arc)
        half = tooth.flank_angle(radius)
        lean = flank.base_half_angle - flank.side * np.sqrt(np.maximum((radius / flank.base_radius) ** 2 - 1.0, 0.0))
        place = radius * np.stack([np.sin(half), np.cos(half)])
        return place, np.stack([-np.cos(lean), np.sin(lean)])


def half_plane_dent(distance: Array, half_width: Array) -> Array:
    """How deep a half-plane is pressed at a distance from a semi-elliptic pressure's centre, over `log_slope`.

    Minus the mean of ln|s - t| over the pressure: 1/2 - ln(a/2) - (s/a)^2 beneath it (Hertz's parabola; Johnson,
    Contact Mechanics, 4.2), minus the logarithm of the distance far from it.
    """
    ratio = np.maximum(distance / half_width, 1.0)
    root = np.sqrt(ratio * ratio - 1.0)
    # (s/a)^2 - (s/a) sqrt((s/a)^2 - 1) without the cancellation of large numbers
    outside = ratio / (ratio + root) + np.log(ratio + root)
    inside = (distance / half_width) ** 2
    return 0.5 - np.log(0.5 * half_width) - np.where(distance < half_width, inside, outside)


def outline_motion(influence: Influence, reach: int) -> OutlineMotion:
    """Solve the ring of a gear once more for the motion of its teeth's outline.

    Parameters
    ----------
    influence : Influence
    reach : int
        K; at most (z - 1) // 2 are given.
    """
    mesh = influence.mesh
    chain = _outline(mesh)
    with one_thread():
        support, order = influence.support, influence.flank.order
        elasticity = assemble_section(mesh, influence.poisson_ratio, influence.plane, order, "condensed", support)
        watch = elasticity.node_dofs[:, chain].reshape(-1)
        reach = min(reach, (mesh.teeth - 1) // 2)
        flank = influence.flank.dofs
        if support is None or support.kind == "web":
            response = close_ring(mesh, elasticity, np.union1d(flank, watch), reach).respond(flank, watch)
        else:
            ports = np.append(flank, watch)
            moved: Mapping[int, Array]
            if support.kind == "free_arc":
                moved, _ = free_arc_response(mesh, elasticity, support.free_teeth, ports, flank.size, reach)
            else:
                moved, _, _ = supported_response(mesh, elasticity, support, ports, flank.size, reach)
            response = {k: u[flank.size :] for k, u in moved.items()}
    stacked = np.stack([response[k].T for k in range(-reach, reach + 1)], axis=1).astype(np.float32)
    return OutlineMotion(influence, *_between(mesh, chain), stacked, reach)


def _between(mesh: SectorMesh, chain: Index) -> tuple[Array, Array]:
    """Points of the outline, shape (2, N), and their places in the row of its vertices: along the mesh's edges."""
    middles = {frozenset(edge): middle for part in mesh.edges.values() for *edge, middle in part.T.tolist()}
    flank = set(mesh.edges["flank"][:2].ravel().tolist())
    points, places = [], []
    for i, edge in enumerate(zip(chain.tolist(), chain[1:].tolist(), strict=False)):
        a, b = mesh.points[:, edge].T
        middle = middles.get(frozenset(edge))
        bend = 0.0 * a if middle is None else 2.0 * mesh.points[:, middle] - a - b
        count = int(np.ceil(np.hypot(*(b - a)) / (_DENTS if flank.issuperset(edge) else _ELSEWHERE)))
        share = np.arange(count) / count
        points.append(np.outer(a, 1.0 - share) + np.outer(b, share) + np.outer(bend, 2.0 * share * (1.0 - share)))
        places.append(i + share)
    points.append(mesh.points[:, chain[-1:]])
    return np.hstack(points), np.append(np.hstack(places), chain.size - 1.0)


def _outline(mesh: SectorMesh) -> Index:
    """Vertices of a tooth's outline from left to right, those that crowd thinned out."""
    t = mesh.triangles
    edges = np.hstack([t[[a, b, c]] for a, b, c in ((0, 3, 1), (1, 4, 2), (2, 5, 0))])
    _, first, count = np.unique(edges[1], return_index=True, return_counts=True)
    inner = np.concatenate([mesh.edges[name][2] for name in _INNER])
    outer = edges[:, first[count == 1]]
    outer = outer[[0, 2]][:, ~np.isin(outer[1], inner)]
    beside: dict[int, list[int]] = {}
    for one, other in outer.T.tolist():
        beside.setdefault(one, []).append(other)
        beside.setdefault(other, []).append(one)
    ends = [vertex for vertex, others in beside.items() if len(others) == 1]
    chain = [min(ends, key=lambda vertex: float(mesh.points[0, vertex]))]
    while len(beside[chain[-1]]) > len(chain[-2:-1]):
        chain.append(next(other for other in beside[chain[-1]] if other not in chain[-2:-1]))
    named = {int(vertex) for name, part in mesh.edges.items() if name not in _INNER for vertex in _ends(part[:2])}
    kept = chain[:1]
    for vertex in chain[1:]:
        apart = np.hypot(*(mesh.points[:, vertex] - mesh.points[:, kept[-1]]))
        if vertex in named or vertex == chain[-1] or apart >= _APART:
            kept.append(vertex)
    return np.array(kept)


def _ends(edges: Index) -> Index:
    """Vertices that one edge alone has."""
    vertices, count = np.unique(edges, return_counts=True)
    return vertices[count == 1]
