"""The plane section of a gear, or of a row of its teeth, as quadrilaterals and triangles for solid meshes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.fem.plane.body import with_body
from fegear.fem.plane.boundary import sector_boundary
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_inside
from fegear.fem.plane.whole_gear import SIDES
from fegear.geometry.gear_body import GearBody
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.outline import turned

#: Two triangles become a quadrilateral whose corners are at least so square: the sine of its most oblique angle.
_SQUAREST = 0.55
#: Nodes of neighbouring sectors this near to each other, as a share of the gear's size, are one.
_SAME = 1e-9
#: Edges along the fillets, along the flank and at its ends [modules], and how fast they grow: of the loaded tooth, its
#: neighbours, the others.
_EDGES = ((0.055, 0.055, 0.05, 0.3), (0.11, 0.11, 0.1, 0.45), (0.2, 0.3, 0.2, 0.6))
_SHARED = ("bore", *SIDES)


@dataclass(frozen=True)
class Section:
    """Quadratic elements of several sectors; module 1, tooth 0 along +y, sectors clockwise.

    Parameters
    ----------
    points : ndarray, shape (2, N)
        [modules].
    triangles : ndarray of int, shape (6, M)
        Vertices 0 1 2, then the nodes between 0-1, 1-2 and 2-0; counterclockwise.
    quadrilaterals : ndarray of int, shape (8, K)
        Vertices 0 1 2 3, then the nodes between 0-1, 1-2, 2-3 and 3-0; counterclockwise.
    boundaries : mapping of (str, int) to ndarray of int, shape (3, n)
        Edges (first vertex, second vertex, middle node) of each named boundary of each tooth, counterclockwise.
    teeth : int
        Of the whole gear.
    closed : bool
        Whether all teeth are there, or a row with free sides.
    """

    points: Array
    triangles: Index
    quadrilaterals: Index
    boundaries: Mapping[tuple[str, int], Index]
    teeth: int
    closed: bool

    def edges(self, name: str) -> Index:
        """Edges of a boundary over all teeth, shape (3, n)."""
        return np.hstack([edges for (known, _), edges in self.boundaries.items() if known == name])

    @property
    def names(self) -> list[str]:
        """Names of the boundaries."""
        return list(dict.fromkeys(name for name, _ in self.boundaries))


def gear_section(sectors: Mapping[int, SectorMesh]) -> Section:
    """Join the meshes of single teeth.

    Parameters
    ----------
    sectors : mapping of int to SectorMesh
        By the tooth's number, neighbours one apart; as many as the gear has teeth close the ring. Their meshes may
        differ; their sides must not.

    Returns
    -------
    Section

    Raises
    ------
    InputError
        If the sides of neighbours do not fit, or numbers are missing.
    """
    row = sorted(sectors)
    teeth = sectors[row[0]].teeth
    closed = len(row) == teeth
    if row != list(range(row[0], row[0] + len(row))) or len(row) > teeth:
        raise InputError("sectors", str(row), f"must be consecutive numbers, at most {teeth}")
    points, triangles, quadrilaterals = [], [], []
    places: dict[tuple[str, int], Index] = {}
    count = 0
    for k in row:
        mesh = sectors[k]
        three, four = paired(mesh)
        points.append(turned(mesh.points, 2.0 * np.pi * k / teeth))
        triangles.append(three + count)
        quadrilaterals.append(four + count)
        places |= {(name, k): edges + count for name, edges in mesh.edges.items()}
        count += mesh.points.shape[1]
    every = np.hstack(points)
    merged = np.arange(count)
    for k in row if closed else row[:-1]:
        after = k + 1 if k + 1 in sectors else row[0]
        a, b = _side(every, places[_facing(sectors[k])[1], k]), _side(every, places[_facing(sectors[after])[0], after])
        if a.size != b.size or np.abs(every[:, a] - every[:, b]).max() > _SAME * np.abs(every).max():
            raise InputError(
                "mesh", sectors[after].origin, "has sides whose nodes do not match after rotation by one pitch"
            )
        merged[b] = a
    triangles_, quadrilaterals_ = merged[np.hstack(triangles)], merged[np.hstack(quadrilaterals)]
    used = np.unique(np.concatenate([triangles_.reshape(-1), quadrilaterals_.reshape(-1)]))
    number = np.full(count, -1)
    number[used] = np.arange(used.size)
    kept = {key: number[merged[edges]] for key, edges in places.items() if key[0] not in SIDES}
    return Section(every[:, used], number[triangles_], number[quadrilaterals_], kept, teeth, closed)


def uneven_section(
    tooth: InvoluteSide, bore_radius: float, coarseness: float = 1.0, others: float | None = None,
    body: GearBody | None = None, row: int = 0,
) -> Section:  # fmt: skip
    """All teeth of a gear for one load: tooth 0 fine, its neighbours less so, the others coarse.

    Parameters
    ----------
    tooth : InvoluteSide
    bore_radius : float
        [modules].
    coarseness : float
        Edge lengths as a multiple of the usual ones, .055 modules along fillet and flank of tooth 0.
    others : float, optional
        The same for all other teeth, whose usual edges are two and four times as long.
    body : GearBody, optional
        Whose rim, web and hub meet along edges of the section [modules].
    row : int
        Number of teeth in a row with free sides, instead of all.

    Returns
    -------
    Section
    """
    settings = uneven_settings(coarseness, others)
    inside = bore_radius if body is None else body.rim_radius
    boundaries = [sector_boundary(tooth, inside, kind) for kind in settings]
    # Neighbours fit: all have the sides and the bore of tooth 0.
    shared = {chain.name: chain for chain in boundaries[0] if chain.name in _SHARED}
    kinds = [
        mesh_inside([shared.get(c.name, c) for c in chains], tooth.teeth, growth=kind.side_growth)
        for chains, kind in zip(boundaries, settings, strict=True)
    ]
    if body is not None:
        kinds = [with_body(kind, body, bore_radius, settings[0].rim_fraction) for kind in kinds]
    count = row or tooth.teeth
    first = -((count - 1) // 2)
    return gear_section({k: kinds[min(abs(k), 2)] for k in range(first, first + count)})


def uneven_settings(coarseness: float, others: float | None = None) -> list[MeshSettings]:
    """Settings of the loaded tooth, its neighbours and the others; as of `uneven_section`."""
    multiples = (coarseness, *(others or coarseness,) * (len(_EDGES) - 1))
    return [_settings(f, *edges) for f, edges in zip(multiples, _EDGES, strict=True)]


def _settings(f: float, root: float, flank: float, end: float, growth: float) -> MeshSettings:
    return MeshSettings(
        root_edge_length=root * f,
        root_fraction=4.0 * root * f,
        flank_edge_length=flank * f,
        tip_edge_length=end * f,
        junction_edge_length=end * f,
        back_edge_length=0.36 * f,
        growth=growth,
        tip_growth=growth,
        side_growth=0.45,
        body_fraction=1.0,
        rim_fraction=0.35 * f,
        order=2,
    )


def _facing(mesh: SectorMesh) -> tuple[str, str]:
    """Names of the sides that face the tooth before and the tooth after."""
    a, b = SIDES
    return (a, b) if mesh.points[0, mesh.edges[a][2]].sum() < mesh.points[0, mesh.edges[b][2]].sum() else (b, a)


def _side(points: Array, edges: Index) -> Index:
    """Nodes of a side from the bore outward."""
    nodes = np.unique(edges)
    return nodes[np.argsort(np.hypot(*points[:, nodes]))]


def paired(mesh: SectorMesh) -> tuple[Index, Index]:
    """Join triangles two by two into quadrilaterals, the squarest first.

    Parameters
    ----------
    mesh : SectorMesh

    Returns
    -------
    triangles : ndarray of int, shape (6, M)
        Those that are left over.
    quadrilaterals : ndarray of int, shape (8, K)
    """
    t, count = mesh.triangles, mesh.triangles.shape[1]
    # Edge i of a triangle runs from its corner i to i + 1 and has the middle node 3 + i; two have it at most.
    middle = t[3:].reshape(-1)
    order = np.argsort(middle, kind="stable")
    twice = np.flatnonzero(middle[order][1:] == middle[order][:-1])
    one, other = order[twice], order[twice + 1]
    (i, first), (j, second) = np.divmod(one, count), np.divmod(other, count)
    # From the corner opposite to the common edge of the first, round to that of the second.
    corner = [t[(i + 2) % 3, first], t[i, first], t[(j + 2) % 3, second], t[(i + 1) % 3, first]]
    between = [
        t[3 + (i + 2) % 3, first],
        t[3 + (j + 1) % 3, second],
        t[3 + (j + 2) % 3, second],
        t[3 + (i + 1) % 3, first],
    ]
    four = np.stack(corner + between)
    quality = _squareness(mesh.points, four)
    free = np.ones(count, dtype=bool)
    taken = []
    for n in np.argsort(-quality, kind="stable"):
        if quality[n] < _SQUAREST:
            break
        if free[first[n]] and free[second[n]]:
            free[[first[n], second[n]]] = False
            taken.append(n)
    return t[:, free], four[:, np.array(taken, dtype=np.int64)]


def _squareness(points: Array, four: Index) -> Array:
    """Sine of the most oblique corner, between the curved edges themselves; negative where one is turned over."""
    worst = np.full(four.shape[1], np.inf)
    for c in range(4):
        corner = points[:, four[c]]
        # Twice the tangent of the quadratic edges at this corner, toward the next and toward the last.
        ahead = 4.0 * points[:, four[4 + c]] - 3.0 * corner - points[:, four[(c + 1) % 4]]
        back = 4.0 * points[:, four[4 + (c + 3) % 4]] - 3.0 * corner - points[:, four[(c + 3) % 4]]
        cross = ahead[0] * back[1] - ahead[1] * back[0]
        worst = np.minimum(worst, cross / (np.hypot(*ahead) * np.hypot(*back)))
    return worst
