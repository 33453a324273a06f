"""The section of a web from hole to hole: a part of a ring with one hole in its middle, and the disc that fills it.

Round the hole the mesh is drawn outward in layers, from its edge to the edge of a cell as long as it is deep; what is
left of a long part beside the cell has layers like the ring's own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fegear.base.arrays import Array, Mask
from fegear.base.errors import InputError, RangeError
from fegear.fem.plane.elements import check_cubic_edges
from fegear.fem.plane.mesh import SectorMesh, with_middle_nodes

#: Half the angle of a cell, as a share of that under which the whole inside of the ring is seen from the middle of the
#: hole: as is wanted, and at most. The half length of a cell over its depth, its half angle over that of the hole at
#: least, and how many columns more are tried.
_SEEN, _MOST_SEEN, _LONG, _ROOM, _MORE = 0.7, 0.85, 0.9, 1.3, 60
#: Rings of elements in the disc that fills the hole, from its edge to its middle, as shares of its radius.
_FILL = (1.0, 0.55)
#: By how much each layer round the hole is deeper than the one inside it.
_DEEPER = 1.5
#: Edges of a cell over their distance from the hole's middle; how often they are shortened, and by what factor, where
#: elements turn inside out.
_TURN, _ATTEMPTS, _FINER = 0.5, 4, 0.6
_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class HoledRing:
    """One of several equal parts of a ring: the middle of its hole on +y, side B lies clockwise of side A.

    Parameters
    ----------
    mesh : SectorMesh
        Boundaries "outer", "inner", "side_a", "side_b" and "hole"; the elements of the disc that fills the hole come
        last.
    filled : ndarray of bool, shape (M,)
        Elements of that disc.
    """

    mesh: SectorMesh
    filled: Mask


def holed_ring(
    holes: int, radii: tuple[float, float], middle: float, hole: float, edge: float, layers: int
) -> HoledRing:
    """Draw one part of a ring with evenly spaced holes.

    Parameters
    ----------
    holes : int
    radii : (float, float)
        Inside and outside of the ring.
    middle, hole : float
        Radius of the circle of the holes' middles, and of the holes.
    edge : float
        Edges along the outside are no longer.
    layers : int
        Between hole and cell's edge.

    Raises
    ------
    RangeError
        If elements turn inside out however fine they are, as where a single hole all but surrounds a thin hub.
    """
    for attempt in range(_ATTEMPTS):
        try:
            return _drawn(holes, radii, middle, hole, edge, layers, _TURN * _FINER**attempt)
        except InputError:
            continue
    raise RangeError(
        "body.holes", holes, "cannot be meshed: inverted elements between hub, rim and holes",
        "reduce the hole diameter, or increase the hub radius",
    )  # fmt: skip


def _drawn(
    holes: int, radii: tuple[float, float], middle: float, hole: float, edge: float, layers: int, turn: float
) -> HoledRing:  # fmt: skip
    """The same, where no edge of the cell is longer than a share of its distance from the hole's middle."""
    inside, outside = radii
    half = math.pi / holes
    across, own = _columns(inside, outside, middle, hole, half, edge)
    step = 2.0 * half / across
    beside, cell = (across - own) // 2, 0.5 * own * step
    depths = _depths(inside, outside, middle, cell, 1.5 * edge, turn)
    deep = depths.size - 1
    angles = np.linspace(-half, half, across + 1)
    lengths = (step * outside / (outside - middle), step * inside / (middle - inside))
    finer = math.ceil(max(lengths) / turn - _ROUND_OFF)
    angles = np.concatenate([angles[:beside], np.linspace(-cell, cell, own * finer + 1), angles[beside + own + 1 :]])
    own *= finer
    across = angles.size - 1

    # Round the cell, clockwise from its upper left corner, which runs up the tooth's side A first.
    run = angles[beside : beside + own + 1]
    rim = [
        *((outside, a) for a in run[:-1]), *((r, cell) for r in depths[:-1]),
        *((inside, a) for a in run[:0:-1]), *((r, -cell) for r in depths[:0:-1]),
    ]  # fmt: skip
    border = np.array([(r * math.sin(a), r * math.cos(a)) for r, a in rim]).T
    centre = np.array([[0.0], [middle]])
    way = border - centre
    on_hole = centre + hole * way / np.hypot(*way)
    count = border.shape[1]
    steps = np.cumsum(np.concatenate([[0.0], _DEEPER ** np.arange(layers)]))
    shares = steps / steps[-1]
    rings = [on_hole + (border - on_hole) * s for s in shares]
    vertices = [*rings]
    number = np.arange((layers + 1) * count).reshape(layers + 1, count)
    triangles: list[tuple[int, int, int]] = []
    every = np.hstack(vertices)
    for low, high in pairwise(number):
        for i in range(count):
            j = (i + 1) % count
            triangles += _cut(low[i], high[i], high[j], low[j], every)
    total, layered = number.size, len(triangles)

    # Beside the cell, column by column outward from it; node (depth, column).
    grid = np.full((deep + 1, across + 1), -1)
    first, last = beside, beside + own
    around = number[-1]
    top, right = own, own + deep
    grid[0, first : last + 1] = around[: own + 1]
    grid[:, last] = around[top : right + 1]
    grid[deep, first : last + 1] = around[right : right + own + 1][::-1]
    grid[:, first] = np.append(around[right + own :], around[0])[::-1]
    for column in (*range(first - 1, -1, -1), *range(last + 1, across + 1)):
        a = angles[column]
        grid[:, column] = np.arange(total, total + deep + 1)
        vertices.append(np.stack([depths * math.sin(a), depths * math.cos(a)]))
        total += deep + 1
    every = np.hstack(vertices)
    for column in (*range(first), *range(last, across)):
        for row in range(deep):
            a, b, c, d = grid[row, column], grid[row + 1, column], grid[row + 1, column + 1], grid[row, column + 1]
            triangles += _cut(a, b, c, d, every)

    # The disc that fills the hole.
    whole = len(triangles)
    chain = number[0]
    for share in _FILL[1:]:
        inner = np.arange(total, total + count)
        vertices.append(centre + (on_hole - centre) * share)
        total += count
        every = np.hstack(vertices)
        for i in range(count):
            j = (i + 1) % count
            triangles += _cut(inner[i], chain[i], chain[j], inner[j], every)
        chain = inner
    vertices.append(centre)
    every = np.hstack(vertices)
    triangles += [(total, int(chain[(i + 1) % count]), int(chain[i])) for i in range(count)]

    chains = {
        "outer": grid[0, ::-1], "side_a": grid[:, 0], "inner": grid[deep], "side_b": grid[::-1, across],
        "hole": np.append(number[0], number[0, 0]),
    }  # fmt: skip
    centres = {"outer": np.zeros((2, 1)), "inner": np.zeros((2, 1)), "hole": centre}
    middles, bends = {}, {}
    for name, nodes in chains.items():
        middles[name], bends[name] = _arcs(every[:, nodes], centres.get(name))
    points, six, edges = with_middle_nodes(every, np.array(triangles, dtype=np.int64).T, chains, middles)
    # Layers bend as hole and border do: straight ones are thinner than the hole's arcs are high.
    half_border = np.array([_between(one, other) for one, other in pairwise([*rim, rim[0]])]).T
    ways = way / np.hypot(*way)
    half_ways = ways + np.roll(ways, -1, axis=1)
    borders, ways = np.stack([border, half_border]), np.stack([ways, half_ways / np.hypot(*half_ways)])
    layer, place = np.divmod(six[:3, :layered], count)
    for edge in range(3):
        one, other = place[edge], place[(edge + 1) % 3]
        mean = 0.5 * (shares[layer[edge]] + shares[layer[(edge + 1) % 3]])
        start = np.where(
            np.abs(one - other) > 1, np.maximum(one, other), np.minimum(one, other)
        )  # the last meets the first
        halfway = (one != other).astype(np.int64)
        inner = centre + hole * ways[halfway, :, start].T
        points[:, six[3 + edge, :layered]] = inner + (borders[halfway, :, start].T - inner) * mean
    # Beside the cell, too, edges run along circles.
    polar = np.zeros((2, every.shape[1]))
    polar[0, grid], polar[1, grid] = depths[:, None], angles
    beside_it = six[:, layered:whole]
    for edge in range(3):
        r, a = 0.5 * (polar[:, beside_it[edge]] + polar[:, beside_it[(edge + 1) % 3]])
        points[:, beside_it[3 + edge]] = r * np.sin(a), r * np.cos(a)
    mesh = SectorMesh(points, six, edges, holes, bends=bends)
    check_cubic_edges(mesh)
    return HoledRing(mesh, np.arange(len(triangles)) >= whole)


def _columns(inside: float, outside: float, middle: float, hole: float, half: float, edge: float) -> tuple[int, int]:
    """Columns of a part and of its cell: even, for a node stands above the hole; more where so few show the inside."""
    seen, least = math.acos(inside / middle), _ROOM * math.asin(hole / middle)
    wanted = min(max(_LONG * (outside - inside) / (2.0 * middle), least), max(_SEEN * seen, least))
    fewest = max(4, 2 * math.ceil(half * outside / edge))
    for across in range(fewest, fewest + _MORE, 2):
        own = min(across, 2 * math.ceil(wanted * across / (2.0 * half)))
        if own * half <= _MOST_SEEN * seen * across:
            return across, own
    return fewest, min(fewest, 2 * math.ceil(wanted * fewest / (2.0 * half)))


def _depths(inside: float, outside: float, middle: float, cell: float, longest: float, turn: float) -> Array:
    """Radii of a cell's nodes on its sides, descending: closer where a side passes the hole."""
    r = np.linspace(outside, inside, 257)
    off, along = middle * math.sin(cell), r - middle * math.cos(cell)
    density = np.maximum(1.0 / longest, off / (turn * (off**2 + along**2)))
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * -np.diff(r))])
    deep = max(2, math.ceil(count[-1] - _ROUND_OFF))
    found = np.interp(np.linspace(0.0, count[-1], deep + 1), count, r)
    found[[0, -1]] = outside, inside
    return np.asarray(found)


def _between(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    """Place halfway between two of the border, on its arc or its straight side; both as radius and angle."""
    r, a = 0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])
    return r * math.sin(a), r * math.cos(a)


def _cut(a: int, b: int, c: int, d: int, points: Array) -> list[tuple[int, int, int]]:
    """Two counterclockwise triangles of a quadrilateral, along its shorter diagonal."""
    p = points[:, [a, b, c, d]]
    if np.hypot(*(p[:, 0] - p[:, 2])) <= np.hypot(*(p[:, 1] - p[:, 3])):
        both = [(a, b, c), (a, c, d)]
    else:
        both = [(a, b, d), (b, c, d)]
    found = []
    for i, j, k in both:
        u, v = points[:, j] - points[:, i], points[:, k] - points[:, i]
        found.append((int(i), int(j), int(k)) if u[0] * v[1] > u[1] * v[0] else (int(i), int(k), int(j)))
    return found


def _arcs(places: Array, centre: Array | None) -> tuple[Array, Array]:
    """Middles of edges along a chain of vertices, on a circle or straight, and how their ends leave the chords."""
    one, other = places[:, :-1], places[:, 1:]
    chord = other - one
    if centre is None:
        return 0.5 * (one + other), np.zeros((2, 2, chord.shape[1]))
    r = np.hypot(*(one - centre))
    turn = np.sign((one[0] - centre[0]) * chord[1] - (one[1] - centre[1]) * chord[0])
    length = 2.0 * r * np.arcsin(np.minimum(0.5 * np.hypot(*chord) / r, 1.0))
    between = 0.5 * (one + other) - centre
    middle = centre + between * r / np.hypot(*between)
    ends = [turn * np.stack([-(p - centre)[1], (p - centre)[0]]) / r * length for p in (one, other)]
    return middle, np.stack([ends[0] - chord, chord - ends[1]], axis=1)
