"""The whole gear by scikit-fem alone, which `fegear check` compares the condensed ring with.

All teeth are meshed, assembled from vector-valued elements, condensed at the bore and factored at once: nothing is
shared with `ring_closure` and `condensation`, of the mesh only the sectors. Tooth 0 has edges half as long, and still
shorter ones below the pressures, which are as wide as the contacts themselves: none is widened, no corner gets a wedge.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu
from skfem import (
    Basis,
    Dofs,
    ElementTriP4,
    ElementVector,
    LinearForm,
    MappingAffine,
    MappingIsoparametric,
    asm,
    condense,
    solve,
)
from skfem.helpers import dot
from skfem.models.elasticity import linear_elasticity  # the equation is not fegear's either

from fegear.base.arrays import Array, Index, Mask
from fegear.fem.plane.boundary import sector_boundary
from fegear.fem.plane.elasticity import lame
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.root_stress import CLEARANCE, search_end
from fegear.fem.plane.settings import MeshSettings, settings_at
from fegear.fem.plane.supported_section import bore_end, of_web, section_on
from fegear.fem.plane.tooth_meshing import mesh_inside, mesh_sector
from fegear.geometry.gear import Plane
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.outline import turned
from fegear.geometry.rim_support import RimSupport

#: Edges of tooth 0, as a share of those that the gear was solved with; those of other teeth are longer by as much, but
#: no longer than those of this level.
_FINER, _BODY = 0.5, -3
#: Degrees of the quadrature on straight elements of fourth order and on curved ones, whose integrands are rational.
_STRAIGHT_DEGREE, _CURVED_DEGREE = 6, 12
#: The reference triangle's edges: a point on each, and the direction along it.
_EDGES = (((0.0, 0.0), (1.0, 0.0)), ((1.0, 0.0), (-1.0, 1.0)), ((0.0, 0.0), (0.0, 1.0)))
_GAUSS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True)
class WholeGearAlone:
    """What P contacts on tooth 0 do, per unit line load; module 1, E = 1.

    Parameters
    ----------
    c_self : ndarray, shape (P,)
        Mean deflection weighted with the pressure, and a quarter of the half-plane's logarithm (`Influence`).
    c_next, c_prev : ndarray, shape (P,)
        Deflection at the same place of the teeth clockwise and counterclockwise.
    root_tension, root_compression : ndarray, shape (P,)
        Largest and smallest tangential stress along the fillets of tooth 0.
    unknowns : int
    """

    c_self: Array
    c_next: Array
    c_prev: Array
    root_tension: Array
    root_compression: Array
    unknowns: int


def solve_alone(
    tooth: InvoluteSide,
    bore_radius: float,
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    radius: Array,
    half_width: float,
    support: RimSupport | None = None,
) -> WholeGearAlone:
    """Mesh, assemble, condense and solve the whole gear.

    Parameters
    ----------
    tooth : InvoluteSide
    bore_radius : float
        [modules].
    poisson_ratio : float
    plane : {"strain", "stress"}
    settings : MeshSettings
        That the gear was solved with.
    radius : ndarray, shape (P,)
        Of contacts that lie on the flank with all of their width [modules].
    half_width : float
        [modules].
    support : RimSupport, optional
        Of the rim [modules]; without one the bore, or outer circle of an internal gear, is held.
    """
    arc = _flank_arc(tooth, radius)
    mesh = _whole_gear(tooth, bore_radius, settings.refined(_FINER), [(s, half_width) for s in arc], support)
    ring, kind = _Ring(mesh, tooth.side), "held" if support is None else support.kind
    constants = lame(poisson_ratio, plane)
    if support is None or kind != "web":
        stiffness = asm(linear_elasticity(*constants), ring.bases())
    else:
        web, thin = of_web(mesh), lame(poisson_ratio, "stress")
        stiffness = asm(linear_elasticity(*constants), ring.bases(~web))
        stiffness = stiffness + support.web * asm(linear_elasticity(*thin), ring.bases(web))
    own = [ring.pressure(tooth, s, half_width) for s in arc]
    at = {k: [ring.at_flank(k, r) for r in radius] for k in (-1, 0, 1)}
    loads = np.stack([*own, *at[0]], axis=1)
    if support is None or kind in ("web", "free_arc"):
        half = -1 if support is None or kind == "web" else support.free_teeth // 2
        first, last = -((tooth.teeth - 1) // 2), tooth.teeth // 2
        bores = [ring.facets(f"bore:{k}") for k in range(first, last + 1) if abs(k) > half]
        held = ring.dofs.get_facet_dofs(np.unique(np.concatenate(bores))).all()
        moved = solve(*condense(stiffness, loads, x=np.zeros_like(loads), D=held), solver=_factored)
    else:
        moved = _on_average(stiffness, ring.on_average(support), loads)
    by_pressure, by_point = np.hsplit(moved, 2)
    modulus = 1.0 / (1.0 - poisson_ratio**2) if plane == "strain" else 1.0
    place, tension = ring.along("fillet:0", by_pressure, modulus)
    _, compression = ring.along("back_fillet:0", by_pressure, modulus)
    ends = search_end(place[-1], arc, half_width, CLEARANCE)
    beside = [np.einsum("pi,ip->p", np.stack(at[k]), by_point) for k in (1, -1)]
    if kind == "free_arc":  # the middle tooth loaded, or watched: see `free_arc`
        beside = [0.5 * (beside[0] + beside[1])] * 2
    return WholeGearAlone(
        c_self=np.einsum("pi,ip->p", np.stack(own), by_pressure) + 0.5 / (np.pi * modulus),
        c_next=beside[0],
        c_prev=beside[1],
        root_tension=np.where(place[:, None] <= ends, tension, -np.inf).max(axis=0),
        root_compression=compression.min(axis=0),
        unknowns=int(ring.dofs.N),
    )


def _factored(matrix: Any, right: Array) -> Array:
    options = {"SymmetricMode": True}
    return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options).solve(right)


def _on_average(stiffness: Any, held: Array, loads: Array) -> Array:
    """Displacements whose means `held`, shape (N, C), are none.

    A stiffness that is lent to these means makes the matrix regular and vanishes with them; it is as large as others.
    """
    lent = csc_array(held * np.sqrt(stiffness.diagonal().mean()))
    both = _factored(csc_array(stiffness) + lent @ lent.T, np.hstack([loads, held]))
    free, by_support = np.hsplit(both, [loads.shape[1]])
    return np.asarray(free - by_support @ np.linalg.solve(held.T @ by_support, held.T @ free))


def _flank_arc(tooth: InvoluteSide, radius: Array) -> Array:
    """Arc length of radii from the start of the flank."""
    roll = tooth.roll(np.maximum(np.append(radius, tooth.form_radius), tooth.base_radius))
    arc = 0.5 * tooth.base_radius * np.asarray(roll) ** 2
    return np.asarray(tooth.side * (arc[:-1] - arc[-1]))


def _whole_gear(
    tooth: InvoluteSide,
    bore_radius: float,
    settings: MeshSettings,
    contacts: Sequence[tuple[float, float]],
    support: RimSupport | None = None,
) -> SectorMesh:
    """All sectors joined, boundaries by name and tooth: ``flank:1`` is that of the tooth clockwise of tooth 0."""
    coarse = min(settings_at(_BODY), settings.refined(_FINER**-2), key=lambda s: s.root_edge_length)
    end = _FINER * bore_end(settings, support)
    plain = mesh_sector(tooth, bore_radius, coarse, bore_end=end)
    outline = sector_boundary(tooth, bore_radius, coarse, bore_end=end)
    body = {c.name: c for c in outline if c.name in ("bore", "side_a", "side_b")}
    chains = [body.get(c.name, c) for c in sector_boundary(tooth, bore_radius, settings, contacts)]
    loaded = section_on(mesh_inside(chains, tooth.teeth, growth=settings.side_growth), settings, support)
    plain = section_on(plain, settings, support)
    z = tooth.teeth
    sectors = [loaded] + [plain] * (z - 1)
    points: list[Array] = []
    triangles: list[Index] = []
    number: list[Index] = []
    count = 0
    edges: dict[str, Index] = {}
    bends: dict[str, Array] = {}
    for k, mesh in enumerate(sectors):
        own = np.full(mesh.points.shape[1], -1)
        if k:
            own[_side(mesh, "side_a")] = number[-1][_side(sectors[k - 1], "side_b")]
        if k == z - 1:
            own[_side(mesh, "side_b")] = number[0][_side(loaded, "side_a")]
        new = np.flatnonzero(own < 0)
        own[new] = count + np.arange(new.size)
        count += new.size
        number.append(own)
        points.append(turned(mesh.points[:, new], 2.0 * np.pi * k / z))
        triangles.append(own[mesh.triangles])
        tooth_number = k if 2 * k <= z else k - z
        for name in mesh.edges.keys() - {"side_a", "side_b"}:
            edges[f"{name}:{tooth_number}"] = own[mesh.edges[name]]
            bend = mesh.bends[name]
            bends[f"{name}:{tooth_number}"] = turned(bend.reshape(2, -1), 2.0 * np.pi * k / z).reshape(bend.shape)
    every, six = np.hstack(points), np.hstack(triangles)
    rank = np.ones(count, dtype=bool)
    rank[six[:3]] = False
    order = np.argsort(rank, kind="stable")  # vertices first
    place = np.argsort(order)
    named = {name: place[e] for name, e in edges.items()}
    return SectorMesh(every[:, order], place[six], named, 1, loaded.origin, bends=bends)


def _side(mesh: SectorMesh, name: str) -> Index:
    nodes = np.unique(mesh.edges[name])
    return nodes[np.argsort(np.hypot(*mesh.points[:, nodes]))]


@dataclass(frozen=True)
class _Edges:
    """scikit-fem's functions at points on boundary edges that are the same edge of their triangles.

    Parameters
    ----------
    basis : skfem.Basis
    place, normal, tangent : ndarray, shape (2, m, q)
        From the centre; unit vectors, the normal out of the material.
    length : ndarray, shape (m, q)
        Derivative of the arc length along the reference edge.
    """

    basis: Any
    place: Array
    normal: Array
    tangent: Array
    length: Array

    def work(self, weight: Array) -> Array:
        """Nodal forces that press against the material with weights at the points, shape (m, q)."""
        return -self.along(self.normal, weight)

    def along(self, way: Array, weight: Array) -> Array:
        """Nodal forces along a way at each point, shape (2, m, q), with weights there, shape (m, q)."""
        share = weight / self.basis.dx
        pushed = LinearForm(lambda v, w: w.share * dot(w.way, v))
        return np.asarray(asm(pushed, self.basis, share=share, way=way))


def _wrapped(angle: Array) -> Array:
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)


def _angle_from(start: float, place: Array) -> Array:
    return _wrapped(np.arctan2(place[1], place[0]) - start)


class _Ring:
    """The whole gear's grid, numbering and functions."""

    def __init__(self, mesh: SectorMesh, side: int) -> None:
        self._elements, self._mesh, self._side = sector_elements(mesh, 4), mesh, side
        self._grid = self._elements.grid
        self._curves = MappingIsoparametric(self._grid, self._grid.elem())
        self._vector = ElementVector(ElementTriP4())
        self.dofs = Dofs(self._grid, self._vector)

    def _basis(self, mapping: Any, chosen: Index, **at: Any) -> Any:
        return Basis(self._grid, self._vector, mapping, elements=chosen, dofs=self.dofs, disable_doflocs=True, **at)

    def bases(self, of: Mask | None = None) -> list[Any]:
        """Functions on all elements, or on some, curved and straight."""
        curved = self._elements.curved
        some = np.ones_like(curved) if of is None else of
        return [
            self._basis(self._curves, np.flatnonzero(curved & some), intorder=_CURVED_DEGREE),
            self._basis(MappingAffine(self._grid), np.flatnonzero(~curved & some), intorder=_STRAIGHT_DEGREE),
        ]

    def facets(self, name: str) -> Index:
        """Facets of a boundary, of one tooth (``flank:1``) or of all."""
        found = [edges[2] for known, edges in self._mesh.edges.items() if name in (known, known.partition(":")[0])]
        return self._elements.edge_of_point[np.concatenate(found)]

    def edges(self, facets: Index, t: Array, weight: Array) -> Iterator[_Edges]:
        """Functions at places t of [0, 1] along facets, shape (q,)."""
        grid = self._grid
        owner = grid.f2t[0, facets]
        for number, (start, along) in enumerate(_EDGES):
            chosen = owner[grid.t2f[number, owner] == facets]
            if not chosen.size:
                continue
            direction = np.array(along)
            at = np.array(start)[:, None] + direction[:, None] * t
            basis = self._basis(self._curves, chosen, quadrature=(at, weight))
            tangent = np.einsum("ikmq,k->imq", self._curves.DF(at, tind=chosen), direction)
            length = np.hypot(*tangent)
            tangent = tangent / length
            place = self._curves.F(at, tind=chosen) + self._elements.tip
            normal = np.stack([tangent[1], -tangent[0]])
            inward = grid.p[:, grid.t[(2, 0, 1)[number], chosen]][:, :, None] + self._elements.tip - place
            normal = np.where((normal * inward).sum(axis=0) > 0.0, -normal, normal)
            yield _Edges(basis, place, normal, tangent, length)

    def pressure(self, tooth: InvoluteSide, arc: float, half_width: float) -> Array:
        """Nodal forces of a semi-elliptic pressure of unit load on tooth 0, exact below its ends inside an edge."""
        forces = np.zeros(self.dofs.N)
        for facet in self.facets("flank:0"):
            t, along = self._finely(facet, lambda place: _flank_arc(tooth, np.hypot(*place)))
            low, high = np.arcsin(np.clip((along[[0, -1]] - arc) / half_width, -1.0, 1.0))
            if low < high:
                # s = arc + b sin(theta) takes (2 / pi) cos^2(theta) dtheta of the load.
                theta = 0.5 * (low + high) + 0.5 * (high - low) * _GAUSS[0]
                share = 0.5 * (high - low) * _GAUSS[1] * (2.0 / np.pi) * np.cos(theta) ** 2
                forces += self._pressed(facet, np.interp(arc + half_width * np.sin(theta), along, t), share)
        return forces

    def on_average(self, support: RimSupport) -> Array:
        """Weights of the means that a rim's support holds, shape (N, C): over each pin, or over the whole circle.

        Rollers hold them along the radius, and the turn over the whole circle.
        """
        facets = self.facets("bore")
        if not support.pins:  # neither shift nor turn on average
            held = np.zeros((self.dofs.N, 3))
            for edges in self.edges(facets, 0.5 + 0.5 * _GAUSS[0], 0.5 * _GAUSS[1]):
                x, y = edges.place
                for c, field in enumerate(([1.0, 0.0], [0.0, 1.0], [-y, x])):
                    way = np.stack([np.broadcast_to(one, x.shape) for one in field])
                    held[:, c] += edges.along(way, edges.length * 0.5 * _GAUSS[1])
            return held
        ends = self._grid.p[:, self._grid.facets[:, facets]] + self._elements.tip
        radius, middles = float(np.hypot(*ends[:, 0, 0])), np.arctan2(ends[1].mean(axis=0), ends[0].mean(axis=0))
        half, held = 0.5 * support.width / radius, np.zeros((self.dofs.N, 2 * support.pins))
        longest = float(np.hypot(*np.diff(ends, axis=1)).max()) / radius
        # the centre line stands along y, and the loaded flank faces x
        for pin in range(support.pins):
            at = 0.5 * np.pi - support.angle - 2.0 * np.pi * pin / support.pins
            near = np.abs(_wrapped(middles - at)) < half + longest
            for facet in facets[near]:
                t, along = self._finely(facet, partial(_angle_from, at))
                low, high = np.clip(along[[0, -1]], -half, half)
                if low < high:
                    angle = 0.5 * (low + high) + 0.5 * (high - low) * _GAUSS[0]
                    share = 0.5 * (high - low) * _GAUSS[1] / (2.0 * half)
                    (edges,) = self.edges(np.array([facet]), np.interp(angle, along, t), np.ones(angle.size))
                    for c in range(2):
                        way = np.zeros((2, 1, angle.size))
                        way[c] = 1.0
                        held[:, 2 * pin + c] += edges.along(way, share[None])
        if not support.rollers:
            return held
        clockwise = support.angle + 2.0 * np.pi * np.arange(support.pins) / support.pins
        radial = held[:, ::2] * np.sin(clockwise) + held[:, 1::2] * np.cos(clockwise)
        return np.column_stack([radial, self.on_average(RimSupport())[:, 2]])

    def at_flank(self, number: int, radius: float) -> Array:
        """Nodal forces of a unit point load on the flank of a tooth: they read its deflection there, too."""
        facets = self.facets(f"flank:{number}")
        ends = self._grid.p[:, self._grid.facets[:, facets]] + self._elements.tip
        (facet,) = facets[[np.diff(np.hypot(*ends) > radius, axis=0)[0].argmax()]]
        t, along = self._finely(facet, lambda place: np.hypot(*place))
        return self._pressed(facet, np.array([np.interp(radius, along, t)]), np.ones(1))

    def _finely(self, facet: int, measure: Callable[[Array], Array]) -> tuple[Array, Array]:
        """Places of [0, 1] along a facet and what is measured there, which ascends."""
        t = np.linspace(0.0, 1.0, 2001)
        owner = self._grid.f2t[0, facet]
        number = int((self._grid.t2f[:, owner] == facet).argmax())
        start, along = (np.array(one)[:, None] for one in _EDGES[number])
        measured = measure(self._curves.F(start + along * t, tind=np.array([owner]))[:, 0] + self._elements.tip[:, 0])
        order = np.argsort(measured)
        return t[order], measured[order]

    def _pressed(self, facet: int, t: Array, share: Array) -> Array:
        (edges,) = self.edges(np.array([facet]), t, np.ones(t.size))
        return edges.work(share[None])

    def along(self, name: str, moved: Array, modulus: float) -> tuple[Array, Array]:
        """Arc length from the root and tangential stress along a fillet, shape (n,) and (n, P)."""
        t = np.linspace(0.0, 1.0, 13)
        places, stresses = [], []
        for edges in self.edges(self.facets(name), t, np.ones(t.size)):
            slopes = [edges.basis.interpolate(u).grad for u in moved.T]
            found = [modulus * np.einsum("imq,ijmq,jmq->mq", edges.tangent, g, edges.tangent) for g in slopes]
            places.append(edges.place.reshape(2, -1))
            stresses.append(np.stack(found, axis=-1).reshape(-1, len(found)))
        place, stress = np.hstack(places), np.vstack(stresses)
        order = np.argsort(self._side * np.hypot(*place), kind="stable")
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(place[:, order])))])
        return arc, stress[order]
