"""Mesh one tooth sector with gmsh: the boundary's nodes are given, gmsh fills the inside."""

from __future__ import annotations

import math
import time
from collections import Counter
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Index
from fegear.base.errors import FegearError, InputError
from fegear.fem.plane.boundary import Chain, sector_boundary
from fegear.fem.plane.drawing_grid import GRID, line_on_a_grid, on_a_grid, rounded
from fegear.fem.plane.elements import check_cubic_edges
from fegear.fem.plane.gmsh_session import gmsh_session, heard_below
from fegear.fem.plane.mesh import GENERATED, SectorMesh, with_middle_nodes
from fegear.fem.plane.settings import MeshSettings
from fegear.geometry.involute_side import InvoluteSide

#: A middle node this near to the middle of its edge, as a share of the edge, leaves the edge straight.
_STRAIGHT = 1e-12
#: So many times the square of its angle an edge's tangents differ in length from its arc at most; on a circle a 48th.
_FAR_FROM_ARC = 0.125
#: How fast edges inside grow with the distance from the boundary where no one says: level 0's `side_growth`.
_GROWTH = 0.4
#: Gmsh's frontal algorithm, whose triangles are the most even where they are few.
_FRONTAL = 6
#: Size of what is still drawn after a request to stop [modules]: large, so that little is.
_UNWANTED = 1.0
#: Flatter triangles (1 is equilateral, 0 flat) spoil what lies near them. Those of the usual settings are above .3.
_FLATTEST = 0.12
#: Boundary edges next to one so many times shorter (a tip rounding of a micrometre, say) make flat triangles.
_UNEVEN = 5.0
#: How often, and by which factor, edges are shortened when elements turn inside out.
_MOST_REFINEMENTS, _FINER = 4, 0.6


def mesh_sector(
    tooth: InvoluteSide, bore_radius: float, settings: MeshSettings, *, frontal: bool = False, bore_end: float = 0.0
) -> SectorMesh:
    """Mesh the sector of one tooth.

    Parameters
    ----------
    tooth : InvoluteSide
    bore_radius : float
        [modules].
    settings : MeshSettings
        Where they are too coarse for a sound mesh (a curved boundary may turn an element inside out), finer ones are
        taken.
    frontal : bool
        Whether to fill evenly from the boundary inward, which suits meshes of so few elements as solid teeth have.
    bore_end : float
        As of `sector_boundary`.

    Returns
    -------
    SectorMesh
        Side B's nodes are side A's, turned by one pitch.

    Raises
    ------
    RangeError
        If the bore lies too near the centre or the outline to be meshed.
    FegearError
        If gmsh fails, or no finer mesh is sound either.
    """
    started = time.perf_counter()
    for _ in range(_MOST_REFINEMENTS):
        try:
            return _mesh(tooth, bore_radius, settings, started, frontal, bore_end)
        except InputError as problem:
            if problem.key != "mesh":
                raise
            refused = problem
            finer = settings.scaled(_FINER)
            # twice as fast in the body: beside a small bore few teeth leave long edges next to short ones
            settings = replace(finer, body_fraction=finer.body_fraction * _FINER)
    raise FegearError(
        f"No valid mesh of the tooth sector: with edges of {settings.root_edge_length:.3g} modules along the fillet "
        f"it still {refused.rule}. Increase rim thickness or fillet radius."
    ) from refused


def _mesh(
    tooth: InvoluteSide, bore_radius: float, settings: MeshSettings, started: float, frontal: bool, bore_end: float
) -> SectorMesh:
    growth = None if frontal else settings.side_growth
    chains = sector_boundary(tooth, bore_radius, settings, bore_end=bore_end)
    mesh = mesh_inside(chains, tooth.teeth, started, growth)
    if settings.order > 2:
        check_cubic_edges(mesh)
    return mesh


def mesh_inside(
    chains: list[Chain],
    teeth: int,
    started: float | None = None,
    growth: float | None = _GROWTH,
    hole: Chain | None = None,
) -> SectorMesh:
    """Fill a closed boundary of one sector with curved triangles.

    Parameters
    ----------
    chains : list of Chain
        As `sector_boundary` makes them; sides of another mesh's boundary make sectors that fit each other.
    teeth : int
    started : float, optional
        When the work began [s], of `time.perf_counter`.
    growth : float, optional
        How fast edges inside grow with the distance from the boundary; None fills evenly from the boundary inward.
    hole : Chain, optional
        A closed chain inside, the body on its left.

    Raises
    ------
    InputError
        If an element is turned inside out or all but flat.
    FegearError
        If gmsh fails.
    """
    started = time.perf_counter() if started is None else started
    polygon = np.hstack([chain.vertices[:, :-1] for chain in chains])
    vertices, triangles, _ = fill(polygon, growth, hole=None if hole is None else hole.vertices[:, :-1])
    refuse_flat(vertices, triangles, polygon.shape[1])
    runs, middles, bends = named_runs(chains)
    if hole is not None:
        count = hole.middles.shape[1]
        runs[f"{hole.name}:0"] = polygon.shape[1] + np.arange(count + 1) % count
        middles[f"{hole.name}:0"], bends[hole.name] = hole.middles, _bends(hole)
    points, six, edges = with_middle_nodes(vertices, triangles, runs, middles)
    return SectorMesh(points, six, by_name(edges), teeth, GENERATED, time.perf_counter() - started, bends)


def named_runs(chains: list[Chain]) -> tuple[dict[str, Index], dict[str, Array], dict[str, Array]]:
    """Vertices and middle nodes of each chain of a closed boundary, and how the exact curves leave the edges' chords.

    Parameters
    ----------
    chains : list of Chain
        Several may have one name.

    Returns
    -------
    runs : dict of str to ndarray of int, shape (n + 1,)
        Vertices in order, of the chain ``name:i`` for the i-th of its name.
    middles : dict of str to ndarray, shape (2, n)
        Of the same chains.
    bends : dict of str to ndarray, shape (2, 2, n)
        By name: see `SectorMesh`.
    """
    starts = np.cumsum([0] + [chain.vertices.shape[1] - 1 for chain in chains])
    total = int(starts[-1])
    counted: Counter[str] = Counter()
    runs: dict[str, Index] = {}
    middles: dict[str, Array] = {}
    bends: dict[str, list[Array]] = {}
    for chain, start in zip(chains, starts, strict=False):
        key = f"{chain.name}:{counted[chain.name]}"
        counted[chain.name] += 1
        runs[key] = np.arange(start, start + chain.vertices.shape[1]) % total
        middles[key] = chain.middles
        bends.setdefault(chain.name, []).append(_bends(chain))
    return runs, middles, {name: np.concatenate(parts, axis=2) for name, parts in bends.items()}


def by_name(edges: dict[str, Index]) -> dict[str, Index]:
    """Edges of chains ``name:i`` together by name."""
    found: dict[str, list[Index]] = {}
    for key, part in edges.items():
        found.setdefault(key.rpartition(":")[0], []).append(part)
    return {name: np.hstack(parts) for name, parts in found.items()}


def _bends(chain: Chain) -> NDArray[np.float64]:
    """How the exact curve leaves each edge's chord at its ends, shape (2, 2, n): see `SectorMesh`.

    Both tangents are so long that the cubic meets the middle node: beside that of a circle it then lies by the sixth
    power of the edge's angle, beside others' by the fifth of its length; with the arc's own length by the fourth.
    """
    chord = np.diff(chain.vertices)
    # Twice the way over the middle node, less what the chord is shorter: the arc's length to fourth order.
    halves = np.hypot(*(chain.middles - chain.vertices[:, :-1])) + np.hypot(*(chain.vertices[:, 1:] - chain.middles))
    arc = (4.0 * halves - np.hypot(*chord)) / 3.0
    sag = chain.middles - 0.5 * (chain.vertices[:, 1:] + chain.vertices[:, :-1])
    # The middle of a cubic is off the chord's by an eighth of its tangents' difference. Where an edge hardly turns, or
    # turns back, that tells nothing, and tangents keep to the arc's length about.
    turn = -np.diff(chain.tangents)
    square = (turn**2).sum(axis=0)
    wanted = 8.0 * (sag * turn).sum(axis=0) / np.maximum(square, _STRAIGHT)
    length = np.clip(wanted, arc * (1.0 - _FAR_FROM_ARC * square), arc * (1.0 + _FAR_FROM_ARC * square))
    bends = np.stack([length * chain.tangents[:, :-1] - chord, chord - length * chain.tangents[:, 1:]], axis=1)
    return np.where(np.hypot(*sag) > _STRAIGHT * np.hypot(*chord), bends, 0.0)


@dataclass(frozen=True)
class Slit:
    """A line inside a polygon that edges of triangles follow, from one of the polygon's corners, and single vertices.

    Parameters
    ----------
    corner : int
        Number of the corner that it starts from.
    line : ndarray, shape (2, n)
        The vertices that follow [modules].
    around : ndarray, shape (2, p)
        Single vertices [modules].
    """

    corner: int
    line: Array
    around: Array


def fill(
    polygon: Array, growth: float | None, slit: Slit | None = None, hole: Array | None = None
) -> tuple[Array, Index, Index]:
    """Triangulate the inside of a closed polygon whose corners stay the only boundary nodes.

    Two processors whose mathematical functions differ in the last bit draw the same triangles.

    Parameters
    ----------
    polygon : ndarray, shape (2, n)
        Counterclockwise [modules].
    growth : float or None
        As for `mesh_inside`.
    slit : Slit, optional
    hole : ndarray, shape (2, h), optional
        Corners of a closed polygon inside, clockwise, within which there is nothing [modules].

    Returns
    -------
    vertices : ndarray, shape (2, N)
        The polygon's first, then the hole's.
    triangles : ndarray of int, shape (3, M)
        Counterclockwise.
    line : ndarray of int
        Vertices along the slit, its corner first.

    Raises
    ------
    FegearError
        If gmsh fails.
    """
    n = polygon.shape[1]
    drawn, length = on_a_grid(polygon)
    middle = 0.5 * (drawn + np.roll(drawn, -1, axis=1))
    line = around = np.zeros((2, 0))
    if slit is not None:
        line, steps = line_on_a_grid(np.column_stack([polygon[:, slit.corner], slit.line]))
        around = rounded(slit.around, GRID * steps[-1])
        between = 0.5 * (np.column_stack([drawn[:, slit.corner], line[:, :-1]]) + line)
        middle, length = np.hstack([middle, between]), np.concatenate([length, steps])
    inner = np.zeros((2, 0))
    if hole is not None:
        inner, steps = on_a_grid(hole)
        middle = np.hstack([middle, 0.5 * (inner + np.roll(inner, -1, axis=1))])
        length = np.concatenate([length, steps])
    x_middle, y_middle = middle

    stopped: list[BaseException] = []

    def size(_dim: int, _tag: int, x: float, y: float, _z: float, _lc: float) -> float:
        if stopped:
            return _UNWANTED
        return float((length + (growth or 0.0) * np.sqrt((x_middle - x) ** 2 + (y_middle - y) ** 2)).min())

    with gmsh_session("fegear sector") as gmsh, heard_below(stopped):
        try:
            along = _draw(gmsh, drawn, inner, None if slit is None else slit.corner, line, around)
            if growth is None:
                gmsh.option.setNumber("Mesh.Algorithm", _FRONTAL)
                gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
            else:
                gmsh.model.mesh.setSizeCallback(size)
            gmsh.model.mesh.generate(2)
            tags, coordinates, _ = gmsh.model.mesh.getNodes()
            _, _, connectivity = gmsh.model.mesh.getElements(2)
        except Exception as problem:
            if not stopped:
                raise FegearError(f"gmsh could not mesh the sector: {problem}") from problem
        finally:
            gmsh.model.mesh.removeSizeCallback()
    if stopped:
        raise stopped[0]
    position = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    order = np.argsort(tags)  # boundary corners carry the lowest tags, in the polygon's order
    position[tags[order].astype(np.int64)] = np.arange(tags.size)
    vertices = coordinates.reshape(-1, 3)[order, :2].T.copy()
    vertices[:, :n] = polygon
    if hole is not None:
        vertices[:, n : n + hole.shape[1]] = hole
    numbers = position[np.array(along, dtype=np.int64)]
    if slit is not None:
        vertices[:, numbers[1:]] = slit.line
    triangles = position[connectivity[0].astype(np.int64)].reshape(-1, 3).T.copy()
    flipped = areas(vertices, triangles) < 0.0
    triangles[1:, flipped] = triangles[:0:-1, flipped]
    return vertices, triangles, numbers


def _draw(gmsh: Any, polygon: Array, hole: Array, corner: int | None, line: Array, around: Array) -> list[int]:
    """Draw a polygon with a hole, and a line from one of its corners and points inside: tags of the line's points."""
    geo, before = gmsh.model.geo, 0
    loops: list[int] = []
    for closed in (polygon, hole):
        n = closed.shape[1]
        for tag, (x, y) in enumerate(closed.T, start=before + 1):
            geo.addPoint(x, y, 0.0, tag=tag)
        for tag in range(1, n + 1):
            geo.addLine(before + tag, before + tag % n + 1, before + tag)
            geo.mesh.setTransfiniteCurve(before + tag, 2)
        if n:
            loops.append(geo.addCurveLoop(list(range(before + 1, before + n + 1)), len(loops) + 1))
        before += n
    geo.addPlaneSurface(loops, 1)
    along = [] if corner is None else [corner + 1, *(geo.addPoint(x, y, 0.0) for x, y in line.T)]
    curves = [geo.addLine(*ends) for ends in pairwise(along)]
    single = [geo.addPoint(x, y, 0.0) for x, y in around.T]
    for curve in curves:
        geo.mesh.setTransfiniteCurve(curve, 2)
    geo.synchronize()
    for dimension, embedded in ((1, curves), (0, single)):
        if embedded:
            gmsh.model.mesh.embed(dimension, embedded, 2, 1)
    return along


def refuse_flat(vertices: Array, triangles: Index, boundary: int) -> None:
    """Refuse flat triangles, but for those at boundary edges much shorter than their neighbours, which must be flat."""
    length = np.hypot(*(np.roll(vertices[:, :boundary], -1, axis=1) - vertices[:, :boundary]))
    before = np.roll(length, 1)
    forced = np.zeros(vertices.shape[1], dtype=bool)
    forced[:boundary] = np.maximum(length, before) > _UNEVEN * np.minimum(length, before)
    triangles = triangles[:, ~forced[triangles].any(axis=0)]
    corners = [vertices[:, corner] for corner in triangles]
    sides = sum(((one - other) ** 2).sum(axis=0) for one, other in zip(corners, corners[1:] + corners[:1], strict=True))
    flattest = float((2.0 * math.sqrt(3.0) * areas(vertices, triangles) / sides).min(initial=1.0))
    if flattest < _FLATTEST:
        raise InputError(
            "mesh", GENERATED, f"has a triangle of quality {flattest:.2g} (1: equilateral, minimum {_FLATTEST:g})",
            "reduce the edge length",
        )  # fmt: skip


def areas(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Twice the area of each triangle, negative if its corners run clockwise."""
    a, b, c = (vertices[:, corner] for corner in triangles)
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
