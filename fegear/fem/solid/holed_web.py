"""Holes in a web: what they take from its stiffness, and how a ring of teeth answers with less.

The holes repeat another time round the gear than its teeth. So the gear is solved tooth by tooth with a web that has
none, and the part of the web in which they lie, a ring between two circles, is solved hole by hole. There waves
exp(i m phi) round the circles times polynomials over the web's thickness meet: on the ring waves whose m differ by a
multiple of the number of holes, on the gear those whose m differ by a multiple of the number of teeth. With D (< 0) the
stiffness of the ring with holes less that of the ring without, both condensed onto waves of its circles, and C what
these waves do under forces of their own on the gear without holes, forces f move the gear by

    u = G f - P X P' f,   X = D (1 + C D)^-1,

P what the waves' forces do elsewhere, G the gear's answer without holes. D is smooth: wave m of a circle at radius r
reaches a hole's edge at radius s as (s / r)^m, so few waves do, and without holes nothing is left of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fegear.fem.plane.body import RING
from fegear.fem.plane.holed_ring import holed_ring
from fegear.fem.plane.ring_closure import harmonic_stiffness
from fegear.fem.plane.trace import lagrange
from fegear.fem.solid.dissection import condense_solid
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.holed_teeth import HoledHalf, HoledRing
from fegear.fem.solid.section import make_section
from fegear.fem.solid.settings import SolidSettings, whole
from fegear.fem.solid.unknowns import unknowns

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.ring_closure import Ring
    from fegear.fem.solid.section import Section
    from fegear.fem.solid.unknowns import Unknowns
    from fegear.geometry.gear_body import GearBody, WebHoles

_GAUSS = np.polynomial.legendre.leggauss(12)
#: Waves round the circles: as many as it takes for what a tooth feels of the last to fall by so many decades.
_DECADES = 5.0
#: Degree over the web's thickness: at least, and per module of it.
_LEAST_DEGREE, _PER_MODULE = 4, 1.0
#: Edges round the ring, as a share of its depth, at most, and for each of the shortest waves.
_OF_DEPTH, _PER_WAVE = 0.33, 2.0
#: Layers round a hole, and the share of the ring's depth below which each half of a radius takes one more.
_ROUND_HOLE, _SMALL_HOLE = 3, 0.3
#: Waves that unknowns take part in by less than this share of the largest are round-off.
_NONE = 1e-9
_CIRCLES = ("inner", "outer")


@dataclass(frozen=True)
class Waves:
    """Waves round both circles of the ring that holes lie in: unknown (circle, order m, direction, function).

    Parameters
    ----------
    most : (int, int)
        Waves round the inner and the outer circle, -most..most.
    face : FaceFunctions
        Over the web's thickness.
    """

    most: tuple[int, int]
    face: FaceFunctions

    @property
    def every(self) -> Index:
        """Orders of the circle that has more of them, ascending."""
        return np.arange(-max(self.most), max(self.most) + 1)

    @cached_property
    def number(self) -> Index:
        """Numbers of the unknowns, -1 where there is none, shape (2, orders, 3, functions)."""
        there = np.abs(self.every) <= np.array(self.most)[:, None]
        known = np.broadcast_to(there[:, :, None, None], (2, self.every.size, 3, self.face.count))
        found = np.full(known.shape, -1)
        found[known] = np.arange(np.count_nonzero(known))
        return found

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return int(self.number.max()) + 1

    @property
    def orders(self) -> Index:
        """m of each unknown, shape (size,)."""
        m = np.broadcast_to(self.every[None, :, None, None], self.number.shape)
        return np.asarray(m[self.number >= 0])

    @property
    def mirrored(self) -> Index:
        """The unknown of order -m for each, shape (size,)."""
        return np.asarray(self.number[:, ::-1][self.number >= 0])


def lost_stiffness(
    holes: WebHoles, ring: tuple[float, float], waves: Waves, poisson_ratio: float, order: int, edge: float
) -> NDArray[np.complex128]:
    """D: stiffness of the ring with holes less that of the ring without, shape (size, size) [E module].

    Parameters
    ----------
    holes : WebHoles
        [modules].
    ring : (float, float)
        Inside and outside of the ring that they lie in [modules].
    waves : Waves
    poisson_ratio : float
    order : {2, 3, 4}
        Of the elements.
    edge : float
        Longest edges round the outside [modules].
    """
    small = math.ceil(math.log2(max(_SMALL_HOLE * (ring[1] - ring[0]) / holes.radius, 1.0)))
    part = holed_ring(holes.count, ring, holes.circle_radius, holes.radius, edge, _ROUND_HOLE + small)
    section = make_section(part.mesh, order, 0.0, poisson_ratio, 1.0, polar=_CIRCLES)
    kept = np.flatnonzero(~part.filled)
    holed = replace(
        section, stiffness=(section.stiffness[0][kept], section.stiffness[1][kept], section.stiffness[2][kept]),
        element_dofs=section.element_dofs[kept], centres=section.centres[:, kept], zone=section.zone[kept],
    )  # fmt: skip
    lost = np.zeros((waves.size, waves.size), dtype=complex)
    for even in (True, False):
        for one, sign in ((holed, 1.0), (section, -1.0)):
            lost += sign * _on_waves(one, holes.count, waves, even)
    turn = np.exp(-1.0j * waves.orders * holes.angle)
    return turn[:, None] * lost * turn.conj()


def _on_waves(section: Section, holes: int, waves: Waves, even: bool) -> NDArray[np.complex128]:
    """Stiffness of a ring of equal parts on waves of its circles; motions that mirror at the web's middle or others."""
    face, count = waves.face, section.places.shape[1]
    used = np.zeros(count, dtype=bool)
    used[section.element_dofs[:, ::3] // 3] = True
    mirrored = (np.arange(3)[:, None] == 2) == face.odd  # (3, functions)
    own = mirrored if even else ~mirrored
    known = unknowns((used[:, None, None] & own).reshape(3 * count, face.count))
    circles = [section.nodes_of(name) for name in _CIRCLES]
    on_circles = np.concatenate(circles)
    free = ~np.isin(section.side_a, on_circles)
    sides = [section.side_a[free], section.side_b[free]]
    every = np.concatenate([*sides, on_circles])
    found = condense_solid(section, face, known, (3 * every[:, None] + np.arange(3)).ravel()).stiffness
    n, per = sides[0].size, int(own.sum())
    m = n * per
    direction, function = np.nonzero(own)
    x, y = section.places[:, on_circles]
    phi = np.arctan2(x, y)
    lost = np.zeros((waves.size, waves.size), dtype=complex)
    orders = waves.every
    circle = np.repeat(np.arange(2), [nodes.size for nodes in circles])
    a_circle, b_circle, inside = found[:m, 2 * m :], found[m : 2 * m, 2 * m :], found[2 * m :, 2 * m :]
    diagonal, ahead = found[:m, :m] + found[m : 2 * m, m : 2 * m], found[:m, m : 2 * m]
    for s in range(holes // 2 + 1):
        mine = np.flatnonzero((orders - s) % holes == 0)
        if not mine.size:
            continue
        at, mirrored = (
            number[:, mine][:, :, direction, function].ravel() for number in (waves.number, waves.number[:, ::-1])
        )
        e, there = np.exp(2.0j * math.pi * s / holes), at >= 0
        at, mirrored = at[there], mirrored[there]
        # Motion of the circles' nodes, by (node, own) and (circle, wave, own).
        nodal = np.zeros((on_circles.size, 2, mine.size), dtype=complex)
        nodal[np.arange(on_circles.size), circle] = np.exp(1.0j * np.multiply.outer(phi, orders[mine]))
        shape = np.kron(nodal.reshape(on_circles.size, -1), np.eye(per))[:, there]
        border = (a_circle + np.conj(e) * b_circle) @ shape
        stiffness = diagonal + e * ahead + np.conj(e) * ahead.T
        part = shape.conj().T @ (inside @ shape) - border.conj().T @ np.linalg.solve(stiffness, border)
        part = 0.5 * holes * (part + part.conj().T)
        lost[np.ix_(at, at)] = part
        if 2 * s % holes:
            lost[np.ix_(mirrored, mirrored)] = part.conj()
    return lost


def wave_weights(section: Section, face: FaceFunctions, waves: Waves) -> tuple[NDArray[np.complex128], Index]:
    """What of each wave a sector's unknowns on both circles are, shape (size, unknowns, functions), and the unknowns.

    Those of the section, whose motion is weighted so that motion on the circle is the sum of waves times what is found.
    """
    z, weight = face.quadrature(waves.face.breaks[0], waves.face.breaks[-1], least=2 * max(face.degrees) + 8)
    values, own = face.values(z), waves.face.values(z)
    gram = (own * weight) @ own.T
    orders = waves.every
    turn = np.exp(1.0j * section.tau * np.multiply.outer(orders, z))
    along = np.einsum("kq,mq,fq->mkf", np.linalg.solve(gram, own * weight), turn, values)  # (orders, own, functions)
    nodes = section.nodes_of(*RING)
    found = np.zeros((2, orders.size, 3, nodes.size, 3), dtype=complex)
    p = section.order
    for circle, name in enumerate(RING):
        places, edges = section.edge_places[name], section.edge_nodes[name]
        start, end = np.arctan2(*places[:, 0]), np.arctan2(*places[:, -1])
        xi, share = 0.5 + 0.5 * _GAUSS[0], 0.5 * _GAUSS[1]
        phi = start[:, None] + (end - start)[:, None] * xi  # (edges, q)
        part = np.abs(end - start)[:, None] * share / (2.0 * math.pi)
        wave = np.exp(-1.0j * orders[:, None, None] * phi) * part
        shape = lagrange(p, xi)
        out, none = np.stack([np.sin(phi), np.cos(phi)]), np.zeros_like(phi)
        ways = np.array([[out[0], out[1], none], [out[1], -out[0], none], [none, none, none + 1.0]])
        of_edge = np.einsum("mnq,iq,dcnq->mdinc", wave, shape, ways, optimize=True)
        for i in range(p + 1):
            at = np.searchsorted(nodes, edges[i])
            for edge in range(edges.shape[1]):
                found[circle, :, :, at[edge]] += of_edge[:, :, i, edge]
    found = np.einsum("omdnc,nce->omdne", found, section.axes[nodes])
    whole = np.einsum("omdne,mkf->omdknef", found, along, optimize=True)
    dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
    return whole[waves.number >= 0].reshape(waves.size, dofs.size, face.count), dofs


@dataclass(frozen=True)
class Holes:
    """What holes take from a web, and which unknowns of the gear's section feel it."""

    waves: Waves
    lost: NDArray[np.complex128]
    weights: NDArray[np.complex128]
    circles: Index
    count: int

    def closed(
        self, ring: Ring, known: Unknowns, watch: Index, flank: Index, fillets: Sequence[tuple[Index, ...]]
    ) -> HoledHalf:
        """Close a ring, both of whose circles are ports, with a web that has holes.

        Parameters
        ----------
        ring : Ring
            Without holes.
        known : Unknowns
        watch : ndarray of int
            Unknowns of flank and fillets; ports.
        flank, fillets
            As of `HoledHalf`.
        """
        return HoledHalf(_holed_ring(ring, known, self, watch), flank, fillets)


def holes_of(
    body: GearBody | None, section: Section, face: FaceFunctions, settings: SolidSettings, root_radius: float, nu: float
) -> Holes | None:
    """What the holes of a body take from its web; None if it has none.

    Parameters
    ----------
    body : GearBody or None
        [modules].
    section : Section
        Of the gear, with both circles of the body's ring.
    face : FaceFunctions
        Of what lies inside the teeth.
    settings : SolidSettings
        Coarser ones have fewer waves and longer edges.
    root_radius : float
        [modules].
    nu : float
    """
    if body is None or body.holes is None or body.holed_ring is None:
        return None
    holes, ring = body.holes, body.holed_ring
    fine = settings.wave_reach / SolidSettings().wave_reach
    edges = holes.circle_radius - holes.radius, holes.circle_radius + holes.radius
    least = fine * _DECADES * math.log(10.0) / 2.0
    inner, outer = (math.ceil(least / math.log(root_radius / edge)) for edge in edges)
    thickness = body.web[1] - body.web[0]
    degree = min(face.degree_on(*body.web), max(_LEAST_DEGREE, whole(_PER_MODULE * thickness, up=True)))
    edge = min(_OF_DEPTH * (ring[1] - ring[0]), 2.0 * math.pi * ring[1] / (_PER_WAVE * outer)) / fine
    waves = Waves((inner, outer), FaceFunctions(body.web, (degree,)))
    lost = lost_stiffness(holes, ring, waves, nu, settings.section.order, edge)
    weights, circles = wave_weights(section, face, waves)
    return Holes(waves, lost, weights, circles, holes.count)


def _holed_ring(ring: Ring, known: Unknowns, holes: Holes, watch: Index) -> HoledRing:
    from scipy.linalg import cho_factor, cho_solve

    sector, z, waves, weights = ring.sector, ring.teeth, holes.waves, holes.weights
    m = ring.follow_a.shape[1]
    place = np.full(known.size, -1)
    place[sector.kept] = np.arange(sector.kept.size)
    number = known.number[holes.circles, : weights.shape[2]]
    there = number >= 0
    own, ports, rows = weights[:, there], place[number[there]], place[watch]
    sides = sector.stiffness[: 2 * m] @ np.hstack([ring.follow_a, ring.follow_b])
    # Half of the waves belong to the other half of a split.
    size = np.abs(own).max(axis=1)
    some = np.flatnonzero(size > _NONE * size.max())
    renumbered = np.full(waves.size, -1)
    renumbered[some] = np.arange(some.size)
    own, orders, mirrored = own[some], waves.orders[some], renumbered[waves.mirrored[some]]
    compliance = np.zeros((some.size, some.size), dtype=complex)
    follow = np.zeros((rows.size, some.size), dtype=complex)
    for n in range(z // 2 + 1):
        mine = np.flatnonzero((orders - n) % z == 0)
        if not mine.size:
            continue
        e = np.exp(2.0j * math.pi * n / z)
        load = own[mine].conj().T
        drive = (ring.follow_a[ports] + e * ring.follow_b[ports]).conj().T @ load
        moved = cho_solve(cho_factor(harmonic_stiffness(sides, n, z, None), lower=True), drive)
        part = z * (drive.conj().T @ moved + load.conj().T @ (ring.own[np.ix_(ports, ports)] @ load))
        seen = (ring.follow_a[rows] + e * ring.follow_b[rows]) @ moved + ring.own[np.ix_(rows, ports)] @ load
        compliance[np.ix_(mine, mine)], follow[:, mine] = part, seen
        if 2 * n % z:
            at = mirrored[mine]
            compliance[np.ix_(at, at)], follow[:, at] = part.conj(), seen.conj()
    c, d = (_real(matrix, orders, mirrored) for matrix in (compliance, holes.lost[np.ix_(some, some)]))
    x = np.linalg.solve(np.eye(some.size) + d @ c, d)
    seen = math.sqrt(2.0) * np.where(orders < 0, -follow.imag, follow.real)
    seen[:, orders == 0] /= math.sqrt(2.0)
    return HoledRing(seen, 0.5 * (x + x.T), orders, mirrored, z, holes.count).without_small()


def _real(matrix: NDArray[np.complex128], orders: Index, mirrored: Index) -> Array:
    """A Hermitian matrix between waves, conjugate to itself where all orders change sign, between cosines and sines."""
    root = math.sqrt(0.5)
    positive, negative = orders > 0, orders < 0

    # New columns: cosine at m > 0, sine at m < 0, of the waves m and -m.
    def columns(a: NDArray[np.complex128]) -> NDArray[np.complex128]:
        b = a[:, mirrored]
        found = a.copy()
        found[:, positive] = root * (a + b)[:, positive]
        found[:, negative] = -1.0j * root * (b - a)[:, negative]
        return found

    return np.asarray(columns(columns(matrix).conj().T).conj().T.real)
