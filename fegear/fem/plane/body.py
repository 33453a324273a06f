"""The section of a gear whose teeth stand on rim, web and hub: drawn inward from the rim, in layers of triangles.

Rim, web and hub meet along circles, so that every element lies in one of them.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.fem.plane.mesh import SectorMesh
from fegear.geometry.gear_body import GearBody

#: How near to a circle a vertex lies on it, as a share of the radius.
_NEAR = 1e-9
#: Layers through web and hub at least; by how many times more through a slender web at most.
_FEWEST, _SLENDER = 2, 2
#: How deep a web's layers at rim and hub are at most, as a share of its thickness and of what a layer may span: where
#: it is clamped its stress changes over a part of its thickness.
_CLAMPED = 0.65
_ROUND_OFF = 1e-9
#: Names of the circles inside and outside of the part of a web that holes lie in.
RING = ("holes_inside", "holes_outside")


def zones(body: GearBody, points: Array, corners: Index) -> Index:
    """Whether each element of a section lies in rim and teeth (0), web (1) or hub (2), shape (M,).

    Parameters
    ----------
    body : GearBody
    points : ndarray, shape (2, N)
    corners : ndarray of int, shape (c, M)
    """
    outermost = np.hypot(*points[:, corners]).max(axis=0) * (1.0 - _NEAR)
    return np.asarray((outermost < body.rim_radius).astype(np.int64) + (outermost < body.hub_radius))


def with_body(rim: SectorMesh, body: GearBody, bore_radius: float, share: float, fewest: int = _FEWEST) -> SectorMesh:
    """The section of rim and teeth, drawn on through web and hub down to the bore.

    Parameters
    ----------
    rim : SectorMesh
        Its bore is the inside of the rim.
    body : GearBody
        [modules].
    bore_radius : float
        [modules].
    share : float
        A layer of web or hub is at most this share of it deep; those at both ends of a slender web are less deep.
    fewest : int
        Layers through web and through hub at least.
    """
    fewest = max(fewest, math.ceil(1.0 / share))
    clamped = _CLAMPED * share * (body.web[1] - body.web[0]) / (body.rim_radius - body.hub_radius)
    slender = math.ceil(math.pi / math.acos(1.0 - 2.0 * min(clamped, 1.0)) - _ROUND_OFF)
    web = min(max(slender, fewest), _SLENDER * fewest)
    parts = [(body.rim_radius, body.hub_radius, web), (body.hub_radius, bore_radius, fewest)]
    if body.holed_ring is not None:
        inner, outer = body.holed_ring
        parts = [
            (body.rim_radius, outer, 1), (outer, inner, max(web - 2, fewest)), (inner, body.hub_radius, 1), parts[-1],
        ]  # fmt: skip
    radii = [body.rim_radius]
    for outside, inside, count in parts:
        if outside - inside > _NEAR * outside:
            # Fine at both circles, where the body's thickness jumps and its stress has no bound.
            depths = 0.5 * (1.0 - np.cos(np.pi * np.arange(1, count + 1) / count))
            radii += [float(outside + (inside - outside) * s) for s in depths]
    return _drawn_inward(rim, np.array(radii), body.holed_ring)


def _drawn_inward(mesh: SectorMesh, radii: Array, ring: tuple[float, float] | None = None) -> SectorMesh:
    """A section with layers of triangles inside its bore, at circles of descending radii, the first its own.

    Two of them may be the inside and the outside of a ring that has names of its own.
    """
    layers, count = radii.size - 1, mesh.vertex_count
    order = _in_line(mesh.edges["bore"])
    first, second, middle = mesh.edges["bore"][:, order]
    n, scale = first.size, radii[1:] / radii[0]
    # Vertex j of circle l, the outermost of which is there; new vertices come behind the old ones, middles behind all.
    chain, shift = np.append(first, second[-1]), layers * (n + 1)
    at = np.vstack([chain, count + np.arange(shift).reshape(layers, n + 1)])
    start = mesh.points.shape[1] + shift
    arcs = np.vstack([middle + shift, start + np.arange(layers * n).reshape(layers, n)])
    radial = start + layers * n + np.arange(shift).reshape(layers, n + 1)
    slants = start + layers * n + shift + np.arange(layers * n).reshape(layers, n)
    vertices = np.hstack([mesh.points[:, :count], *(mesh.points[:, chain] * s for s in scale)])
    # Slants bend halfway as the arcs do: a straight one leaves a layer thinner than the arc is high.
    middles = [mesh.points[:, middle] * s for s in (1.0, *scale)]
    between = [
        *middles[1:],
        0.5 * (vertices[:, at[:-1].ravel()] + vertices[:, at[1:].ravel()]),
        *(0.5 * (one + other) for one, other in pairwise(middles)),
    ]
    # Two triangles a cell, to the right of the bore's edges, which run round the material of the rim.
    right, left, below, beyond = at[:-1, 1:], at[:-1, :-1], at[1:, :-1], at[1:, 1:]
    upper = np.stack([right, left, below, arcs[:-1], radial[:, :-1], slants]).reshape(6, -1)
    lower = np.stack([right, below, beyond, slants, arcs[1:], radial[:, 1:]]).reshape(6, -1)
    known = np.where(mesh.triangles >= count, mesh.triangles + shift, mesh.triangles)
    edges = {name: np.vstack([run[:2], run[2:] + shift]) for name, run in mesh.edges.items()}
    bends = dict(mesh.bends)
    edges["rim_inside"] = edges["bore"][:, order]
    edges["bore"] = np.stack([at[-1, :-1], at[-1, 1:], arcs[-1]])
    if "bore" in bends:
        bends |= {"rim_inside": bends["bore"][:, :, order], "bore": bends["bore"][:, :, order] * scale[-1]}
    for name, radius in zip(RING, ring or (), strict=False):
        layer = int(np.abs(radii - radius).argmin())
        edges[name] = np.stack([at[layer, :-1], at[layer, 1:], arcs[layer]])
        if "bore" in bends:
            bends[name] = bends["rim_inside"] * (radii[layer] / radii[0])
    for column, way in ((0, 1), (-1, -1)):  # the outline comes down the side on which the bore begins
        name = next(key for key in ("side_a", "side_b") if chain[column] in mesh.edges[key][:2])
        edges[name] = np.hstack([edges[name], np.stack([*(at[:-1, column], at[1:, column])[::way], radial[:, column]])])
        if name in bends:  # sides are straight
            bends[name] = np.concatenate([bends[name], np.zeros((2, 2, layers))], axis=2)
    return SectorMesh(
        np.hstack([vertices, mesh.points[:, count:], *between]), np.hstack([known, upper, lower]), edges, mesh.teeth,
        mesh.origin, mesh.seconds, bends, mesh.tip,
    )  # fmt: skip


def _in_line(edges: Index) -> Index:
    """Order in which edges, each from its first to its second vertex, follow each other."""
    by_start = {int(vertex): i for i, vertex in enumerate(edges[0])}
    vertex = next(iter(set(edges[0].tolist()) - set(edges[1].tolist())))
    order = []
    while vertex in by_start:
        order.append(by_start[vertex])
        vertex = int(edges[1, order[-1]])
    return np.array(order)
