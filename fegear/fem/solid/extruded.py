"""The solid gear as wedges and hexahedra: a section drawn along the face and turned with the helix.

The coordinates are those of the twisted gear (X = R(tau zeta) (xi, eta), Z = zeta), zeta = 0 in the middle of the face:
a spur gear has tau = 0, a right hand a positive one. The section of a rack slides instead: X = xi + slide zeta.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fegear.base.arrays import Array, Index, Mask
from fegear.base.errors import InputError, RangeError
from fegear.fem.plane.body import zones
from fegear.fem.plane.gear_section import Section
from fegear.geometry.body_along import BodyAlong
from fegear.geometry.gear_body import GearBody
from fegear.geometry.involute_side import InvoluteSide

#: How near to a circle a point lies on it, as a share of its radius.
_NEAR = 1e-9
_GAUSS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True)
class SolidMesh:
    """Quadratic wedges (15 nodes) and hexahedra (20 nodes), numbered as Abaqus, CalculiX and VTK do.

    Parameters
    ----------
    section : Section
    stations : ndarray, shape (L + 1,)
        Places along the face between the layers, ascending [modules].
    twist : float
        tau, the turn per length along the face [rad/module].
    points : ndarray, shape (3, P)
        [modules]; plane after plane: all nodes of the section at a station, its vertices in the middle of a layer.
    wedges : ndarray of int, shape (15, L M)
    hexahedra : ndarray of int, shape (20, L K)
    slide : float
        Way of the section along x per length along the face: of a rack.
    """

    section: Section
    stations: Array
    twist: float
    points: Array
    wedges: Index
    hexahedra: Index
    slide: float = 0.0

    @property
    def layers(self) -> int:
        """Number of layers."""
        return self.stations.size - 1

    def at_station(self, nodes: Index, station: int | Index) -> Index:
        """Solid nodes of section nodes at a station."""
        return _plane(self.section, station) + nodes

    def faces(self, edges: Index) -> Index:
        """Quadrilaterals over edges of the section, shape (8, L, n).

        Corners: first and second vertex at the lower station, second and first at the upper; then the middles between
        them.
        """
        low = np.arange(self.layers)[:, None]
        first, second, middle = (self.at_station(e[None], low) for e in edges)
        step = _plane(self.section, 1)
        up = _rank(self.section)
        rise = [step * low + self.section.points.shape[1] + up[e][None] for e in edges[:2]]
        return np.stack([first, second, second + step, first + step, middle, rise[1], middle + step, rise[0]])

    def nodes_of(self, edges: Index) -> Index:
        """Solid nodes on the surface over edges of the section, ascending."""
        return np.unique(self.faces(edges))


def _corners(section: Section) -> Index:
    return np.unique(np.concatenate([section.triangles[:3].reshape(-1), section.quadrilaterals[:4].reshape(-1)]))


def _rank(section: Section) -> Index:
    """Number of each vertex among the vertices; -1 at middle nodes."""
    corners = _corners(section)
    rank = np.full(section.points.shape[1], -1)
    rank[corners] = np.arange(corners.size)
    return rank


def _plane(section: Section, station: int | Index) -> Index:
    """Number of the first solid node at a station."""
    return np.asarray(station) * (section.points.shape[1] + _corners(section).size)


def extruded(
    section: Section, stations: Sequence[float] | Array, twist: float, body: GearBody | None = None, slide: float = 0.0
) -> SolidMesh:
    """Draw a section along the face.

    Parameters
    ----------
    section : Section
    stations : array_like, shape (L + 1,)
        [modules], ascending; under the rim they follow an inclined web.
    twist : float
        [rad/module], positive for a right hand.
    body : GearBody, optional
        Whose web and hub are all that is left of the layers inside the rim [modules].
    slide : float
        Way of the section along x per length along the face: of a rack.

    Returns
    -------
    SolidMesh

    Raises
    ------
    InputError
        If the stations do not ascend, or web or hub end inside a layer (`GearBody.along` says where).
    """
    z = np.asarray(stations, dtype=float)
    if z.ndim != 1 or z.size < 2 or not (np.diff(z) > 0.0).all():
        raise InputError("stations", str(stations), "must ascend", "specify at least the two ends of the face")
    corners, size = _corners(section), section.points.shape[1]
    along = None if body is None else body.along(float(z[-1] - z[0]))
    heights = _heights(section.points, body, along)
    planes = []
    for i, place in enumerate(z):
        planes.append(_turned_up(section.points, heights(place), twist, slide))
        if i < z.size - 1:
            between = heights(0.5 * (place + z[i + 1]))[corners]
            planes.append(_turned_up(section.points[:, corners], between, twist, slide))
    rank, step = _rank(section), size + corners.size
    low = step * np.arange(z.size - 1)

    def solid(elements: Index, n: int) -> Index:
        """Corners below, above, middles below, above, then those that rise."""
        bottom, middle, rise = elements[:n], elements[n:], size + rank[elements[:n]]
        one = np.concatenate([bottom, bottom + step, middle, middle + step, rise])
        drawn = one[:, None] + low[:, None]
        if body is None or along is None:
            return drawn.reshape(one.shape[0], -1)
        return drawn[:, _filled(along, zones(body, section.points, bottom), z)]

    return SolidMesh(
        section, z, twist, np.hstack(planes), solid(section.triangles, 3), solid(section.quadrilaterals, 4), slide
    )


def _heights(points: Array, body: GearBody | None, along: BodyAlong | None) -> Callable[[float], Array]:
    """What a place of the rim is along the face at each point of the section, shape (N,): more where a web leans."""
    none = np.zeros(points.shape[1])
    if body is None or along is None or not along.inclined:
        return lambda place: none + place
    radius = np.hypot(*points)
    rise, hub = body.lean * np.maximum(body.rim_radius - radius, 0.0), radius <= body.hub_radius * (1.0 + _NEAR)
    return lambda place: np.where(hub, along.in_hub(np.asarray(place)), place + rise)


def _filled(along: BodyAlong, zone: Index, stations: Array) -> Mask:
    """Which elements of each layer are material, shape (L, M)."""
    if np.abs(np.subtract.outer(along.ends, stations)).min(axis=1).max() > 1e-9 * np.ptp(stations):
        raise InputError("stations", str(stations), "must include the end positions of web and hub")
    middle = 0.5 * (stations[1:] + stations[:-1])
    there = np.array([(middle > low) & (middle < high) for low, high in along.spans])
    return np.asarray(there[zone].T)


def planes_of(mesh: SolidMesh) -> list[tuple[float, Index]]:
    """Plane after plane its place along the face and the section's nodes in it, in the order of the solid's nodes."""
    every, corners = np.arange(mesh.section.points.shape[1]), _corners(mesh.section)
    found: list[tuple[float, Index]] = []
    for low, high in pairwise(mesh.stations.tolist()):
        found += [(low, every), (0.5 * (low + high), corners)]
    return [*found, (float(mesh.stations[-1]), every)]


def _turned_up(points: Array, height: Array, twist: float, slide: float) -> Array:
    s, c = np.sin(twist * height), np.cos(twist * height)
    return np.stack([c * points[0] - s * points[1] + slide * height, s * points[0] + c * points[1], height])


def with_stations(stations: Array, more: Sequence[float]) -> Array:
    """Stations along the face, ascending, in the place of those that come too near to some more that are wanted."""
    wanted = np.unique(more)
    room = 0.25 * float(np.diff(stations).min())
    kept = stations[(np.abs(stations[:, None] - wanted) > room).all(axis=1)]
    return np.union1d(kept, wanted[(wanted > stations[0] - room) & (wanted < stations[-1] + room)])


def graded_stations(face_width: float, through: Sequence[float], finest: float, growth: float, largest: float) -> Array:
    """Stations along the face, fine at both ends and at given places, shape (L + 1,).

    Parameters
    ----------
    face_width : float
        [modules].
    through : sequence of float
        Places that are stations, such as the ends of a pressed band [modules].
    finest, largest : float
        Layers at the ends of the face, and the thickest [modules].
    growth : float
        By how much a layer grows per length from the nearer end.
    """
    half = 0.5 * face_width
    wanted = np.unique(np.round([-half, half, *(place for place in through if -half < place < half)], 12))
    wanted[0], wanted[-1] = -half, half
    stations = [wanted[:1]]
    for a, b in pairwise(wanted):
        s = np.linspace(a, b, 257)
        density = 1.0 / np.minimum(finest + growth * (half - np.abs(s)), largest)
        count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(s))])
        layers = max(1, round(float(count[-1])))
        stations.append(np.interp(np.linspace(0.0, count[-1], layers + 1), count, s)[1:])
    return np.concatenate(stations)


def pressed_band(
    mesh: SolidMesh,
    tooth: InvoluteSide,
    radius: float,
    half_width: float,
    hat: tuple[float, float, float],
    number: int = 0,
) -> Array:
    """Nodal forces of a band that presses on the right flank of a tooth.

    Parameters
    ----------
    mesh : SolidMesh
        With stations at the hat's ends and its top.
    tooth : InvoluteSide
        The transverse section.
    radius, half_width : float
        The middle of the band up the flank, and the half-width of its semi-elliptic pressure along the flank
        [modules].
    hat : (float, float, float)
        Along the face the pressure rises linearly from the first place to the second and falls to the third
        [modules]; two equal ones make half a hat, as at an end of the face.
    number : int
        Of the tooth.

    Returns
    -------
    ndarray, shape (3, P)
        Consistent forces of a pressure normal to the flank, whose part along the transverse line of action is one.
        The forces' work is the band's mean deflection along that line.

    Raises
    ------
    RangeError
        If the band reaches past an end of the flank or of the face, or its pressure has a kink inside a layer.
    """
    flank = mesh.section.boundaries["flank", number]
    edges = flank[:, np.argsort(np.hypot(*mesh.section.points[:, flank[2]]))]
    vertices = np.hypot(*np.hstack([mesh.section.points[:, edges[0]], mesh.section.points[:, edges[1, -1:]]]))
    rb = tooth.base_radius
    arc = 0.5 * rb * tooth.roll(np.maximum(vertices, rb)) ** 2
    place = 0.5 * rb * float(tooth.roll(radius)) ** 2

    def inward(along: Array, zeta: Array) -> Array:
        angle = tooth.base_half_angle - tooth.side * np.sqrt(2.0 * along / rb)
        turn = mesh.twist * zeta - 2.0 * np.pi * number / mesh.section.teeth
        a = angle[None, :, :, None] - turn[:, None, None, :]  # the section's frame turns counterclockwise
        return np.stack([-np.cos(a), np.sin(a), np.full(a.shape, -mesh.twist * rb)])

    return band_forces(mesh, edges, arc, place, half_width, hat, inward)


def band_forces(
    mesh: SolidMesh,
    edges: Index,
    arc: Array,
    place: float,
    half_width: float,
    hat: tuple[float, float, float],
    inward: Callable[[Array, Array], Array],
) -> Array:
    """Nodal forces of a band of pressure on a flank, as `pressed_band`.

    Parameters
    ----------
    mesh : SolidMesh
    edges : ndarray of int, shape (3, n)
        Of the flank, one after the other, each from its lower arc length to its upper one.
    arc : ndarray, shape (n + 1,)
        Arc lengths up the flank at their ends [modules].
    place, half_width, hat : float
        Arc length at the middle of the band; the rest as of `pressed_band` [modules].
    inward : callable
        Of arc lengths, shape (n, q), and places along the face, shape (L, q'): normal into the material whose part
        along the transverse line of action is one, shape (3, L, n, q, q').

    Raises
    ------
    RangeError
        As of `pressed_band`.
    """
    low, top, high = hat
    half = 0.5 * (mesh.stations[-1] - mesh.stations[0])
    if place - half_width < arc[0] - 1e-9 or place + half_width > arc[-1] + 1e-9:
        raise RangeError("half_width", f"{half_width:.6g} modules", "extends beyond an end of the flank")
    if not (mesh.stations[0] - 1e-9 <= low <= top <= high <= mesh.stations[-1] + 1e-9) or low == high:
        raise RangeError(
            "hat", str(hat), f"must be increasing within the face width, {-half:.6g} to {half:.6g} modules"
        )
    if np.abs(mesh.stations[:, None] - np.array(hat)).min(axis=0).max() > 1e-9:
        raise RangeError("hat", str(hat), "must coincide with mesh stations")
    # Along the flank: s = place + a sin(theta), (2 / pi) cos^2(theta) dtheta of the load; on each edge Gauss points.
    bounds = np.arcsin(np.clip((arc - place) / half_width, -1.0, 1.0))
    width = 0.5 * np.diff(bounds)
    theta = 0.5 * (bounds[1:] + bounds[:-1])[:, None] + width[:, None] * _GAUSS[0]  # (n, q)
    share = width[:, None] * _GAUSS[1] * (2.0 / np.pi) * np.cos(theta) ** 2
    s = place + half_width * np.sin(theta)
    xi = (s - arc[:-1, None]) / np.diff(arc)[:, None]
    # Along the face, layer by layer; the hat's kinks are stations.
    zeta = 0.5 * (mesh.stations[1:] + mesh.stations[:-1])[:, None] + 0.5 * np.diff(mesh.stations)[:, None] * _GAUSS[0]
    height = np.ones_like(zeta)
    if low < top:
        height = np.minimum(height, (zeta - low) / (top - low))
    if top < high:
        height = np.minimum(height, (high - zeta) / (high - top))
    height = np.maximum(height, 0.0)
    height = height * 0.5 * np.diff(mesh.stations)[:, None] * _GAUSS[1] * 2.0 / (high - low)
    eta = np.broadcast_to(0.5 + 0.5 * _GAUSS[0], zeta.shape)
    shapes = serendipity(xi[None, :, :, None], eta[:, None, None, :])  # (8, L, n, q, q')
    values = np.einsum("klnqp,clnqp,nq,lp->kcln", shapes, inward(s, zeta), share, height, optimize=True)
    nodes = mesh.faces(edges)
    forces = np.zeros((3, mesh.points.shape[1]))
    for c in range(3):
        np.add.at(forces[c], nodes, values[:, c])
    return forces


def serendipity(xi: Array, eta: Array) -> Array:
    """Shape functions of the eight-node quadrilateral of `SolidMesh.faces` on [0, 1]^2, shape (8, ...)."""
    u, v = 2.0 * xi - 1.0, 2.0 * eta - 1.0
    corner = [0.25 * (1 + a * u) * (1 + b * v) * (a * u + b * v - 1) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return np.stack(
        [
            *corner,
            0.5 * (1 - u * u) * (1 - v),
            0.5 * (1 + u) * (1 - v * v),
            0.5 * (1 - u * u) * (1 + v),
            0.5 * (1 - u) * (1 - v * v),
        ]
    )
