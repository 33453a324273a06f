"""Where the nodes of the sector's boundary lie: graded toward the fillets, the loaded flank and its corners.

The sector of one tooth runs from side A (clockwise angle -pi/z from the tooth's centre line) to side B (+pi/z), from
the bore to the outline. Side B's nodes are side A's turned by one pitch, so that the sectors fit together exactly. The
right flank is the loaded one. A ring gear is held at its outer circle, which is called bore here as well.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.plane.bore import check_bore
from fegear.fem.plane.edge_sizes import (
    SHORT_FILLET,
    Law,
    back_sizes,
    fewest_edges,
    fillet_size,
    front_sizes,
    graded,
    land_size,
    length_of,
)
from fegear.fem.plane.settings import MeshSettings
from fegear.geometry.curves import Curve, arc_length
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.outline import turned
from fegear.geometry.tooth_side import ToothSide

#: Edges of a bore beside a crack are not halved for distances below this [modules].
SHORTEST_BORE_EDGE = 1e-3
#: Root lands shorter than this [modules], or than this share of the fillet's edge beside them (a rack tip all but
#: full), are dropped: the fillets meet on the sector's side. Fillet and root circle are tangent there, so the outline
#: moves by the square of it; the sides' edges would start as short as the land.
_SHORTEST_LAND, _LEAST_LAND = 2e-4, 0.04
#: Widest angle of an edge on the bore [rad].
_WIDEST_BORE_EDGE = 0.15
#: A bore that is longer over a sector than this share of the body's depth has two edges at least: what a thin rim does
#: between its sides a single edge does not follow (next teeth of four of 48 gears and rings were 20 to 1000 times as
#: far off; half a hundred unknowns more).
_LONG_BORE = 0.45
#: An edge on a tip rounding that turns by more than this [rad] is shorter than what matters there and stays straight:
#: gmsh draws triangles over two such edges, whose corner between two tangents would be flat.
_SHARPEST_TURN = 0.26


@dataclass(frozen=True)
class Chain:
    """A run of boundary edges: vertices in order, with the points in the middle of each edge on the exact curve.

    Parameters
    ----------
    name : str
        One of bore, side_a, side_b, root_land, fillet, flank, tip_rounding, tip, back_flank, back_fillet.
    vertices : ndarray, shape (2, n + 1)
        [modules], in counterclockwise order round the sector.
    middles : ndarray, shape (2, n)
        [modules].
    tangents : ndarray, shape (2, n + 1)
        Unit tangents of the exact curve at the vertices.
    """

    name: str
    vertices: Array
    middles: Array
    tangents: Array


def _on_curve(name: str, curve: Curve, size: Law, fewest: int = 1, *, dense: bool = False, side: int = 1) -> Chain:
    """Edges along a curve; where `dense`, the law is sampled more and more densely toward the start.

    The material lies on the left of an external tooth's curves (side 1), on the right of an internal one's (-1).
    """
    end = length_of(curve)
    at = np.union1d(np.linspace(0.0, end, 513), np.geomspace(1e-6 * end, end, 257)) if dense else None
    return _at_nodes(name, curve, graded(end, size, fewest=fewest, at=at), side)


def _at_nodes(name: str, curve: Curve, nodes: Array, side: int) -> Chain:
    """Edges along a curve between given arc lengths, from its start to its end."""
    parameter, length = arc_length(curve)
    halves = np.sort(np.concatenate([nodes, 0.5 * (nodes[1:] + nodes[:-1])]))
    points = curve.points(np.interp(halves, length, parameter))
    points[:, 0], points[:, -1] = curve.points(curve.start), curve.points(curve.end)
    normals = curve.normals(np.interp(nodes, length, parameter))
    vertices, middles, tangents = points[:, ::2], points[:, 1::2], side * np.stack([-normals[1], normals[0]])
    if name == "tip_rounding":
        sharp = (tangents[:, 1:] * tangents[:, :-1]).sum(axis=0) < math.cos(_SHARPEST_TURN)
        middles = np.where(sharp, 0.5 * (vertices[:, 1:] + vertices[:, :-1]), middles)
    return Chain(name, vertices, middles, tangents)


def fillet_chain(tooth: InvoluteSide, name: str, size: Law, through: float) -> tuple[Chain, int]:
    """Edges along a fillet with a vertex at a given place, in their order round the sector.

    Parameters
    ----------
    tooth : InvoluteSide
    name : {"fillet", "back_fillet"}
    size : callable
        Edge length over the arc length up the fillet [modules].
    through : float
        Arc length at which there is a vertex [modules].

    Returns
    -------
    chain : Chain
    vertex : int
        Number of that vertex among the chain's.
    """
    side, back = tooth.side, name == "back_fillet"
    fillet = (tooth.back if back else tooth).fillet
    end = length_of(fillet)
    lower, upper = graded(through, size), through + graded(end - through, lambda s: size(s + through))
    nodes, vertex = np.concatenate([lower, upper[1:]]), lower.size - 1
    chain = _at_nodes(name, fillet, nodes, side)
    if back:
        chain = _mirrored(chain, name)
    if side < 0:
        chain = _reversed(chain)
    return chain, vertex if back == (side < 0) else nodes.size - 1 - vertex


def _mirrored(chain: Chain, name: str) -> Chain:
    flip = np.array([[-1.0], [1.0]])
    vertices, middles = (flip * chain.vertices)[:, ::-1], (flip * chain.middles)[:, ::-1]
    return Chain(name, vertices, middles, (-flip * chain.tangents)[:, ::-1])


def sector_boundary(
    tooth: InvoluteSide,
    bore_radius: float,
    settings: MeshSettings,
    contacts: Sequence[tuple[float, float]] = (),
    bore_end: float = 0.0,
) -> list[Chain]:
    """Discretise the closed boundary of one sector, counterclockwise from the bore on side A.

    Parameters
    ----------
    tooth : InvoluteSide
    bore_radius : float
        Radius at which the body is held: of the bore, or of the outer circle of a ring gear [modules].
    settings : MeshSettings
        Edge lengths in modules.
    contacts : sequence of (float, float)
        Place (arc length from the start of the flank) and half-width of pressures that the loaded flank's edges are to
        resolve [modules].
    bore_end : float
        Edges are so short where the bore meets the sides: between a held and a free bore stress has no bound
        [modules]; 0 for those of the body.

    Returns
    -------
    list of Chain
        Consecutive chains share their end points exactly.

    Raises
    ------
    RangeError
        If the bore lies so near the centre or the outline that elements cannot resolve what is left.
    """
    check_bore(tooth, bore_radius)
    side = tooth.side
    pitch_angle = 2.0 * math.pi / tooth.teeth
    above, back = tooth_chains(tooth, settings, contacts)
    top = above[0].vertices
    first = float(np.hypot(*(top[:, 1] - top[:, 0])))
    outer = float(np.hypot(*top[:, 0]))

    def body_size(depth: Array) -> Array:
        width = settings.body_fraction * pitch_angle * (outer - side * depth)
        rim = settings.rim_fraction * side * (outer - bore_radius)
        found = np.minimum(first + settings.side_growth * depth, np.minimum(width, rim))
        if not bore_end:
            return found
        return np.minimum(found, bore_end + settings.growth * np.abs(side * (outer - bore_radius) - depth))

    side_b = _side(top[:, 0], bore_radius, body_size, first, bore_end)
    vertices, middles, tangents = (
        turned(part, -pitch_angle)[:, ::-1] for part in (side_b.vertices, side_b.middles, -side_b.tangents)
    )
    side_a = Chain("side_a", vertices, middles, tangents)
    if bore_end:
        bore = _graded_bore(side_b.vertices[:, 0], bore_radius, bore_end, settings, pitch_angle)
    else:
        by_size = round(pitch_angle * bore_radius / float(body_size(np.array(side * (outer - bore_radius)))))
        fewest = 2 if pitch_angle * bore_radius > _LONG_BORE * side * (outer - bore_radius) else 1
        bore_edges = max(fewest, by_size, math.ceil(pitch_angle / _WIDEST_BORE_EDGE))
        bore = _bore(side_b.vertices[:, 0], bore_radius, bore_edges, pitch_angle)
    chains = [bore, side_b, *above, *back, side_a]
    # Round the sector of a ring gear, which lies outside its outline, this runs clockwise.
    return chains if side > 0 else [_reversed(chain) for chain in reversed(chains)]


def tooth_chains(
    tooth: ToothSide, settings: MeshSettings, contacts: Sequence[tuple[float, float]] = ()
) -> tuple[list[Chain], list[Chain]]:
    """Edges from the middle of the right tooth space up to the middle of the tip land, and down to the left space."""
    pieces, side = tooth.outline, tooth.side
    beside = max(float(fillet_size(one, settings)(np.zeros(1))[0]) for one in (tooth, tooth.back))
    short = tooth.root_land_length < max(_SHORTEST_LAND, _LEAST_LAND * beside)
    land = (
        []
        if tooth.root_land is None or short
        else [_on_curve("root_land", tooth.root_land, land_size(tooth, settings), side=side)]
    )
    front_laws = front_sizes(tooth, settings, contacts)
    fewest = fewest_edges(tooth, settings)
    short_fillet = length_of(tooth.fillet) < SHORT_FILLET
    front = [
        _on_curve(
            _boundary(piece, tooth),
            pieces[piece],
            law,
            fewest if piece == "fillet" else 1,
            dense=short_fillet and piece == "flank",
            side=side,
        )
        for piece, law in front_laws.items()
        if piece in pieces
    ]
    if not land:
        front[0] = _from_the_side(front[0], tooth)
    return land + front, _back(tooth, settings, short=not land)


def _back(tooth: ToothSide, settings: MeshSettings, *, short: bool) -> list[Chain]:
    """The other side of the sector from the middle of the tip land to that of the tooth space, whose land is short."""
    back, laws = tooth.back, back_sizes(tooth, settings)
    pieces, side = back.outline, tooth.side
    tip = [
        _mirrored(_on_curve(_boundary(piece, back), pieces[piece], law, side=side), "tip")
        for piece, law in reversed(laws.items())
        if piece in pieces and piece != "flank"
    ]
    flank = _mirrored(_on_curve("flank", back.involute, laws["flank"], side=side), "back_flank")
    fewest = fewest_edges(back, settings)
    fillet = _on_curve("fillet", back.fillet, fillet_size(back, settings), fewest, side=side)
    fillet = _mirrored(_from_the_side(fillet, back) if short else fillet, "back_fillet")
    if short or back.root_land is None:
        return [*tip, flank, fillet]
    land = _on_curve("root_land", back.root_land, land_size(back, settings), side=side)
    return [*tip, flank, fillet, _mirrored(land, "root_land")]


def _reversed(chain: Chain) -> Chain:
    return Chain(chain.name, chain.vertices[:, ::-1], chain.middles[:, ::-1], -chain.tangents[:, ::-1])


def _from_the_side(fillet: Chain, tooth: ToothSide) -> Chain:
    """Fillet that starts in the middle of the tooth space, on the side of the sector."""
    vertices = fillet.vertices.copy()
    vertices[:, 0] = tooth.space_middle
    return Chain(fillet.name, vertices, fillet.middles, fillet.tangents)


def _boundary(piece: str, tooth: ToothSide) -> str:
    """Name of the boundary that a piece of the outline belongs to; a rounding carries load as the flank does."""
    if piece == "tip_edge" and tooth.tip_rounding > 0.0:
        return "tip_rounding"
    return "tip" if piece.startswith("tip") else piece


def _side(top: Array, bore_radius: float, size: Law, first: float, last: float = 0.0) -> Chain:
    """Nodes from bore to outline, where the edges are as long as the `first` along it, or the `last` at the bore."""
    outer = float(np.hypot(*top))
    side = 1.0 if outer > bore_radius else -1.0
    total = side * (outer - bore_radius)
    # Evenly in depth down to the bore, and evenly in the logarithm of the radius for bores near the centre.
    depths = side * (outer - np.geomspace(outer, bore_radius, 513))
    depths[0], depths[-1] = 0.0, total
    at = np.union1d(np.linspace(0.0, total, 513), np.clip(depths, 0.0, total))
    if at[1] > first:  # short edges at the outline of a deep body: sampled evenly they would go on below
        at = np.union1d(at, np.geomspace(0.1 * first, at[1], 65))
    if last:
        at = np.union1d(at, total - np.geomspace(0.1 * last, 0.5 * total, 129))
    radii = outer - side * graded(total, size, at=at)[::-1]
    direction = top / outer
    middles = np.multiply.outer(direction, 0.5 * (radii[1:] + radii[:-1]))
    tangents = np.repeat(side * direction[:, None], radii.size, axis=1)
    return Chain("side_b", np.multiply.outer(direction, radii), middles, tangents)


def _bore(right: Array, bore_radius: float, edges: int, pitch_angle: float) -> Chain:
    half = math.atan2(right[0], right[1])
    return _along_bore(right, bore_radius, np.linspace(-half, half, 2 * edges + 1), pitch_angle)


def _graded_bore(right: Array, bore_radius: float, end: float, settings: MeshSettings, pitch_angle: float) -> Chain:
    """Edges along the bore, the shorter the nearer to its ends."""
    half = 0.5 * pitch_angle * bore_radius
    longest = min(_WIDEST_BORE_EDGE * bore_radius, settings.body_fraction * half)
    at = np.union1d(np.linspace(0.0, half, 257), np.geomspace(0.1 * end, half, 129))
    nodes = graded(half, lambda s: np.minimum(end + settings.growth * s, longest), fewest=2, at=at) / half
    vertices = math.atan2(right[0], right[1]) * np.concatenate([nodes - 1.0, 1.0 - nodes[-2::-1]])
    angle = np.sort(np.concatenate([vertices, 0.5 * (vertices[1:] + vertices[:-1])]))
    return _along_bore(right, bore_radius, angle, pitch_angle)


def _along_bore(right: Array, bore_radius: float, angle: Array, pitch_angle: float) -> Chain:
    """Edges along the bore with vertices and middle nodes at angles."""
    points = bore_radius * np.stack([np.sin(angle), np.cos(angle)])
    points[:, -1] = right
    points[:, 0] = turned(right, -pitch_angle)
    tangents = np.stack([np.cos(angle), -np.sin(angle)])[:, ::2]
    return Chain("bore", points[:, ::2], points[:, 1::2], tangents)


def finer_bore(bore: Chain, points: Array, share: float) -> Chain:
    """The bore with its edges halved until none is longer than a share of its distance from every one of some points.

    Parameters
    ----------
    bore : Chain
        Along a circle about the centre.
    points : ndarray, shape (2, n)
        Inside the sector [modules].
    share : float
    """
    radius = float(np.hypot(*bore.vertices[:, 0]))
    vertices, middles, tangents = bore.vertices, bore.middles, bore.tangents
    while True:
        length = np.hypot(*np.diff(vertices))
        away = np.hypot(*(middles[:, :, None] - points[:, None])).min(axis=1)
        long = length > share * np.maximum(away, SHORTEST_BORE_EDGE)
        if not long.any():
            return Chain(bore.name, vertices, middles, tangents)
        at = np.flatnonzero(long) + 1
        new = middles[:, long]
        halves = [0.5 * (end + new) for end in (vertices[:, :-1][:, long], vertices[:, 1:][:, long])]
        halves = [radius * half / np.hypot(*half) for half in halves]
        way = tangents[:, :-1][:, long] + tangents[:, 1:][:, long]
        middles = np.insert(middles, at, halves[1], axis=1)
        middles[:, np.flatnonzero(long) + np.arange(at.size)] = halves[0]
        vertices = np.insert(vertices, at, new, axis=1)
        tangents = np.insert(tangents, at, way / np.hypot(*way), axis=1)
