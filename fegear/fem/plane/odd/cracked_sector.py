"""Mesh the sector of a cracked tooth: its sides are those of the ordinary sector, so that both fit into one ring.

The crack is a line inside gmsh's surface whose vertices are doubled afterwards, all but its tip; seen from the mouth
to the tip its left face gets the new ones. Edges are short at the mouth and at the tip, around which triangles stand
as even rays. The middle nodes of the tip's edges lie at a quarter of them (Henshell and Shaw 1975; Barsoum 1976), so
that displacements hold the root of the distance from the tip.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from fegear.base.arrays import Array, Index
from fegear.base.errors import FegearError, InputError
from fegear.base.printed import percent
from fegear.fem.plane.boundary import Chain, fillet_chain, finer_bore, sector_boundary
from fegear.fem.plane.edge_sizes import front_sizes
from fegear.fem.plane.elements import check_cubic_edges
from fegear.fem.plane.mesh import GENERATED, SectorMesh, with_middle_nodes
from fegear.fem.plane.odd.crack import SHORTEST, Crack, fillet_length
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.supported_section import bore_end, section_on
from fegear.fem.plane.tooth_meshing import Slit, by_name, fill, named_runs, refuse_flat
from fegear.geometry.involute_tooth import InvoluteTooth
from fegear.geometry.rim_support import RimSupport

#: Names of the crack's faces, left and right as seen from its mouth.
FACES = ("crack_left", "crack_right")
#: Edges at the tip: at most so long [modules], and shares of the room around it.
_TIP_EDGE, _TIP_SHARE = 0.08, 0.15
#: Triangles around the tip.
_RAYS = 8
#: Edges at the mouth, as a share of the crack; how fast edges grow along it.
_MOUTH_SHARE, _GROWTH = 0.25, 0.35
#: Edges of its fillet from the root land to the mouth, or to this share of the fillet where the mouth is lower, as a
#: share of the ordinary tooth's: bending turns about the tip, so that the largest tension is at the root land, where an
#: ordinary fillet has none to speak of.
_BELOW_MOUTH, _LOWER_PART = 0.35, 0.5
#: A crack's tip keeps so far from every surface, its line from every other, as a share of its length.
_CLEAR = 0.02
#: How often, and by which factor, edges are shortened when elements turn inside out.
_MOST_REFINEMENTS, _FINER = 4, 0.7
#: Where that does not help edges inside grow more slowly by this factor, and edges of the bore are no longer than this
#: share of their distance from the crack.
_SLOWER, _OF_DISTANCE = 0.7, 2.0


@dataclass(frozen=True)
class CrackedSector:
    """The mesh of a cracked tooth's sector, and where its crack ends.

    Attributes
    ----------
    mesh : SectorMesh
        With the boundaries "crack_left" and "crack_right" from the mouth to the tip.
    tip, way : ndarray, shape (2,)
        Where the tip is [modules], and the unit vector in which the crack runs there.
    room : float
        How far from the tip nothing else lies but the last straight piece of the crack [modules].
    mouth : float
        Arc length of the mouth up its fillet [modules].
    back : bool
        Whether that is the fillet of the flank that is not loaded.
    closing : bool
        Whether its faces may press on each other.
    """

    mesh: SectorMesh
    tip: Array
    way: Array
    room: float
    mouth: float
    back: bool
    closing: bool = False


def cracked_sector(
    tooth: InvoluteTooth, bore_radius: float, settings: MeshSettings, crack: Crack, support: RimSupport | None = None
) -> CrackedSector:
    """Mesh the sector of a cracked tooth.

    Parameters
    ----------
    tooth : InvoluteTooth
    bore_radius : float
        [modules].
    settings : MeshSettings
        Those of the gear's ordinary sectors.
    crack : Crack
    support : RimSupport, optional
        Of the rim [modules].

    Raises
    ------
    InputError
        If the crack leaves the sector, crosses itself or comes too near a surface.
    FegearError
        If gmsh fails, or no finer mesh along the crack is sound.
    """
    started = time.perf_counter()
    chains = sector_boundary(tooth, bore_radius, settings, bore_end=bore_end(settings, support))
    found = crack_in(chains, tooth, settings, crack, started)
    return replace(found, mesh=section_on(found.mesh, settings, support))


def crack_in(
    chains: list[Chain], tooth: InvoluteTooth, settings: MeshSettings, crack: Crack, started: float
) -> CrackedSector:
    """Fill a closed boundary, in which the fillets of tooth 0 have their names, with a crack from one of them.

    Parameters and errors as of `cracked_sector`; when the work `started` [s], of `time.perf_counter`.
    """
    path, room = _checked(tooth, crack, np.hstack([chain.vertices[:, :-1] for chain in chains]))
    slower = replace(settings, side_growth=_SLOWER * settings.side_growth)
    finer = [finer_bore(one, _along(path, 64), _OF_DISTANCE) if one.name == "bore" else one for one in chains]
    for used, boundary in ((settings, chains), (slower, finer)):
        for n in range(_MOST_REFINEMENTS):
            try:
                mesh = _mesh(tooth, used, crack, boundary, path, room, _FINER**n, started)
            except InputError as problem:
                if problem.key != "mesh":
                    raise
                refused = problem
            else:
                return CrackedSector(mesh, path[:, -1], _way(path), room, crack.mouth, crack.back, crack.closing)
    raise FegearError(
        f"No valid mesh of the cracked tooth: it still {refused.rule}; change depth or angle of the crack a little."
    ) from refused


def _way(path: Array) -> Array:
    """Unit vector in which a crack runs at its tip."""
    way = path[:, -1] - path[:, -2]
    return np.asarray(way / np.hypot(*way))


def refuse_crack(tooth: InvoluteTooth, bore_radius: float, settings: MeshSettings, crack: Crack) -> None:
    """Refuse what `cracked_sector` refuses, without a mesh.

    Raises
    ------
    InputError
    """
    chains = sector_boundary(tooth, bore_radius, settings)
    _checked(tooth, crack, np.hstack([chain.vertices[:, :-1] for chain in chains]))


def _checked(tooth: InvoluteTooth, crack: Crack, outline: Array) -> tuple[Array, float]:
    """The crack's corners, and how far from its tip nothing else lies."""
    if not 0.0 < crack.mouth < fillet_length(tooth):
        raise InputError(
            "mouth", f"{crack.mouth:.6g} modules", f"must lie on the fillet, 0 to {fillet_length(tooth):.6g} modules"
        )
    path = crack.path(tooth)
    pieces = np.hypot(*np.diff(path))
    length = float(pieces.sum())
    if not (math.isfinite(length) and float(pieces.min()) >= (1.0 - 1e-9) * SHORTEST):
        raise InputError(
            "depth", f"{length:.6g} modules",
            f"has a straight piece of {pieces.min():.6g} modules; each must be at least {SHORTEST:g} modules",
        )  # fmt: skip
    closed = np.column_stack([outline, outline[:, 0]])
    mouth, tip = path[:, 0], path[:, -1]
    # The outline's own edges at the mouth are no limit: what counts there is that the crack runs into the material.
    away = np.hypot(*(0.5 * (closed[:, 1:] + closed[:, :-1]) - mouth[:, None])) > 0.5 * SHORTEST
    near = np.array([_distance(point, closed)[away].min() for point in _along(path, 64)[:, 8:].T])
    if not _inside(tip, closed) or _crosses(path, closed, away) or near.min() < _CLEAR * length or _folds(path):
        raise InputError(
            "depth", f"{length:.6g} modules",
            f"leads the crack out of its tooth or within {percent(_CLEAR, whole=True)} of its length of a surface",
            "reduce it, or change the crack's angle",
        )  # fmt: skip
    return path, min(float(near[-1]), float(pieces[-1]))


def _along(path: Array, count: int) -> Array:
    """Points along a line of straight pieces, shape (2, count)."""
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path)))])
    at = np.linspace(0.0, s[-1], count)
    return np.stack([np.interp(at, s, coordinate) for coordinate in path])


def _distance(point: Array, line: Array) -> Array:
    """Distances of a point from the pieces of a line, shape (n - 1,)."""
    first, chord = line[:, :-1], np.diff(line)
    off = point[:, None] - first
    share = np.clip((off * chord).sum(axis=0) / np.maximum((chord**2).sum(axis=0), 1e-300), 0.0, 1.0)
    return np.asarray(np.hypot(*(off - share * chord)))


def _inside(point: Array, closed: Array) -> bool:
    """Whether a closed line goes round a point."""
    off = closed - point[:, None]
    turns = np.diff(np.unwrap(np.arctan2(off[1], off[0]))).sum()
    return bool(abs(turns) > math.pi)


def _meet(one: Array, other: Array) -> Array:
    """Which pieces of two lines meet, shape (n - 1, m - 1)."""
    a, d = one[:, :-1, None], np.diff(one)[:, :, None]
    b, e = other[:, None, :-1], np.diff(other)[:, None, :]
    cross = d[0] * e[1] - d[1] * e[0]
    off = b - a
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = (off[0] * e[1] - off[1] * e[0]) / cross, (off[0] * d[1] - off[1] * d[0]) / cross
    return np.asarray((s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0))


def _crosses(path: Array, closed: Array, away: Array) -> bool:
    """Whether a crack meets the outline elsewhere than at its mouth."""
    return bool(_meet(path, closed)[:, away].any())


def _folds(path: Array) -> bool:
    """Whether a crack meets itself, or turns back by more than a right angle."""
    pieces = np.diff(path)
    if (np.einsum("ci,ci->i", pieces[:, :-1], pieces[:, 1:]) <= 0.0).any():
        return True
    met = _meet(path, path)
    i, j = np.nonzero(met)
    return bool((np.abs(i - j) > 1).any())


def _mesh(
    tooth: InvoluteTooth,
    settings: MeshSettings,
    crack: Crack,
    chains: list[Chain],
    path: Array,
    room: float,
    scale: float,
    started: float,
) -> SectorMesh:
    length, name = float(np.hypot(*np.diff(path)).sum()), "back_fillet" if crack.back else "fillet"
    usual = front_sizes(tooth, settings)["fillet"]
    at_mouth = scale * min(float(usual(np.array([crack.mouth]))[0]), _MOUTH_SHARE * length)
    tip_edge = scale * min(_TIP_EDGE, _TIP_SHARE * room)

    low = max(crack.mouth, _LOWER_PART * fillet_length(tooth))

    def size(s: Array) -> Array:
        below = _BELOW_MOUTH * usual(np.minimum(s, low)) + settings.growth * np.maximum(s - low, 0.0)
        return np.minimum(np.minimum(usual(s), below), at_mouth + settings.growth * np.abs(s - crack.mouth))

    split, mouth = _split(chains, tooth, name, crack.mouth, size)
    polygon = np.hstack([chain.vertices[:, :-1] for chain in split])
    line = crack_line(path, at_mouth, tip_edge, settings.back_edge_length)
    tip, way = path[:, -1], path[:, -2] - path[:, -1]
    rays = math.atan2(way[1], way[0]) + 2.0 * math.pi * np.arange(1, _RAYS) / _RAYS
    around = tip[:, None] + tip_edge * np.stack([np.cos(rays), np.sin(rays)])
    vertices, triangles, numbers = fill(polygon, settings.side_growth, Slit(mouth, line, around))
    refuse_flat(vertices, triangles, polygon.shape[1])
    vertices, triangles, left = opened(vertices, triangles, numbers)
    runs, middles, bends = named_runs(split)
    # Counterclockwise round the sector the boundary comes to the mouth along the crack's left face.
    before = next(key for key, run in runs.items() if key.startswith(f"{name}:") and run[-1] == mouth)
    runs[before] = np.append(runs[before][:-1], left[0])
    half = 0.5 * (vertices[:, numbers[1:]] + vertices[:, numbers[:-1]])
    for face, run in zip(FACES, (left, numbers), strict=True):
        runs[f"{face}:0"], middles[f"{face}:0"] = run, half
    points, six, edges = with_middle_nodes(vertices, triangles, runs, middles)
    vertex = int(numbers[-1])
    mesh = SectorMesh(
        quartered(points, six, vertex), six, by_name(edges), tooth.teeth, GENERATED,
        time.perf_counter() - started, bends, vertex,
    )  # fmt: skip
    if settings.order > 2:
        check_cubic_edges(mesh)
    return mesh


def _split(
    chains: list[Chain], tooth: InvoluteTooth, name: str, mouth: float, size: Callable[[Array], Array]
) -> tuple[list[Chain], int]:
    """The boundary with a fillet's chain in two at the mouth, and the mouth's number among the polygon's corners."""
    place = next(i for i, chain in enumerate(chains) if chain.name == name)
    usual = chains[place]
    chain, vertex = fillet_chain(tooth, name, size, mouth)
    vertices = chain.vertices.copy()
    vertices[:, 0], vertices[:, -1] = usual.vertices[:, 0], usual.vertices[:, -1]
    first = Chain(name, vertices[:, : vertex + 1], chain.middles[:, :vertex], chain.tangents[:, : vertex + 1])
    second = Chain(name, vertices[:, vertex:], chain.middles[:, vertex:], chain.tangents[:, vertex:])
    split = [*chains[:place], first, second, *chains[place + 1 :]]
    return split, sum(chain.vertices.shape[1] - 1 for chain in split[: place + 1])


def crack_line(path: Array, at_mouth: float, tip_edge: float, longest: float) -> Array:
    """Vertices along a crack without its mouth: short edges at both ends, the last one as long as the rays."""
    corner = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path)))])
    end = corner[-1] - tip_edge

    def size(s: Array) -> Array:
        to_tip = tip_edge + _GROWTH * np.maximum(end - s, 0.0)
        return np.minimum(np.minimum(at_mouth + _GROWTH * s, to_tip), longest)

    found = [np.zeros(1)]
    for low, high in zip(corner[:-1], np.append(corner[1:-1], end), strict=True):
        s = np.linspace(low, high, 513)
        count = np.concatenate([[0.0], np.cumsum(np.diff(s) * 0.5 * (1.0 / size(s[1:]) + 1.0 / size(s[:-1])))])
        edges = max(1, round(float(count[-1])))
        found.append(np.interp(np.linspace(0.0, count[-1], edges + 1), count, s)[1:])
    at = np.append(np.concatenate(found), corner[-1])[1:]
    points = np.stack([np.interp(at, corner, coordinate) for coordinate in path])
    points[:, -1] = path[:, -1]
    return points


def opened(vertices: Array, triangles: Index, line: Index) -> tuple[Array, Index, Index]:
    """Part a mesh along a line of its vertices from the boundary to inside: all but the last of them are doubled.

    Parameters
    ----------
    vertices : ndarray, shape (2, N)
    triangles : ndarray of int, shape (3, M)
        Counterclockwise.
    line : ndarray of int, shape (n,)

    Returns
    -------
    vertices : ndarray, shape (2, N + n - 1)
    triangles : ndarray of int, shape (3, M)
        Those on the left of the line have the new vertices.
    left : ndarray of int, shape (n,)
        The line's vertices on its left.
    """
    count, body = vertices.shape[1], line[:-1]
    new = np.arange(count)
    new[body] = count + np.arange(body.size)
    touching = np.flatnonzero(np.isin(triangles, body).any(axis=0))
    ends = np.stack([triangles[:, touching], np.roll(triangles[:, touching], -1, axis=0)])  # (2, 3, t)
    step = np.full(count, -1)
    step[body] = line[1:]
    ahead, backward = step[ends[0]] == ends[1], step[ends[1]] == ends[0]
    whose = np.broadcast_to(np.arange(touching.size), ends.shape[1:])
    joining = (np.isin(ends, body).any(axis=0)) & ~(ahead | backward)
    low, high = ends.min(axis=0)[joining], ends.max(axis=0)[joining]
    _, edge = np.unique(low.astype(np.int64) * count + high, return_inverse=True)
    # Triangles and edges as one graph: triangles that share an edge which is not the line's are on one side.
    size = touching.size + (int(edge.max()) + 1 if edge.size else 0)
    links = coo_array((np.ones(edge.size), (whose[joining], touching.size + edge)), shape=(size, size))
    _, part = connected_components(links, directed=False)
    on_left = np.unique(part[whose[ahead]])
    if np.isin(part[whose[backward]], on_left).any():
        raise InputError("mesh", GENERATED, "has a crack whose two sides are joined")
    moved = triangles.copy()
    chosen = touching[np.isin(part[: touching.size], on_left)]
    moved[:, chosen] = new[triangles[:, chosen]]
    return np.hstack([vertices, vertices[:, body]]), moved, np.append(new[body], line[-1])


def quartered(points: Array, triangles: Index, tip: int) -> Array:
    """Middle nodes of the edges at the tip moved to a quarter of them."""
    found = points.copy()
    for one, other, middle in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
        for start, end in ((one, other), (other, one)):
            at = triangles[start] == tip
            found[:, triangles[middle, at]] = 0.75 * points[:, [tip]] + 0.25 * points[:, triangles[end, at]]
    return found
