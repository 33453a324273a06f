"""The transverse section of one tooth sector: nodes, their axes, and the section's share of the stiffness.

In the helicoid's own coordinates every section is alike (`fem.forms.turned_strains`): no coefficient depends on z. With
a function N of the section times a function P along the face, every strain is B0 P + B1 P', and a stiffness is a short
sum of products of section and face integrals.

An inclined web is a sheared straight one: its functions are those of the place z - s (r_rim - r) at which the inclined
line through a point meets the rim, s the tangent of the inclination. With them B1 gets slopes s N / r (xi, eta, 0), and
no volume changes. The hub has the functions of the places that the web leads to it.

The section of a helical rack is not turned but moved along the rack, X = (xi + slide zeta, eta): D is then
d/dz - slide d/dxi, and no component of a displacement turns.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.fem.plane.body import zones
from fegear.fem.plane.elasticity import lame
from fegear.fem.plane.elements import SectorElements, sector_elements
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.settings import Solver
from fegear.fem.solid.scikit_fem_solver import SectionMatrices, assembled_zones
from fegear.geometry.body_along import BodyAlong
from fegear.geometry.gear_body import GearBody

#: From where to where a disc fills the face: all of it.
_WHOLE_FACE = ((-math.inf, math.inf),)
#: Numbers of zones.
WEB, HUB = 1, 2


class AlongFace(Protocol):
    """Functions along the face, or those of a body joined with those of its teeth."""

    def products_over(
        self, low: float, high: float, stretched: Callable[[Array], Array] | None = None
    ) -> tuple[Array, Array, Array]:
        """Integrals of products of all functions from one break to another."""


@dataclass(frozen=True)
class Straight:
    """What the section of a rack has in place of base circle and twist.

    Parameters
    ----------
    pressure_angle : float
        alpha_t [rad].
    slide : float
        Way of the section along the rack per length along the face: -tan(beta) of a right hand.
    """

    pressure_angle: float
    slide: float


@dataclass(frozen=True)
class Section:
    """The section's matrices, element by element; E = 1.

    Unknown 3 i + c is component c of node i along the node's own axes: radial, tangential and axial on the sides;
    against the flank's normal (the port of a contact), along its tangent and axial on the loaded flank; x, y and z
    elsewhere.

    Parameters
    ----------
    stiffness : tuple of three ndarray, shape (M, 3 n, 3 n)
        Integrals of B0' C B0, B0' C B1 and B1' C B1.
    element_dofs : ndarray of int, shape (M, 3 n)
    centres : ndarray, shape (2, M)
        Where the elements lie [modules].
    axes : ndarray, shape (N, 3, 3)
        Columns are the axes of each node.
    places : ndarray, shape (2, N)
        [modules].
    edge_nodes : dict of str to ndarray of int, shape (order + 1, edges)
        Nodes along each boundary edge, from its first to its second vertex.
    edge_places : dict of str to ndarray, shape (2, 3 or 4, edges)
        Evenly spaced nodes of each boundary edge's own curve in that direction [modules].
    side_a, side_b : ndarray of int, shape (m,)
        Nodes of the sides from the bore outward.
    order : int
    tau : float
        Twist [rad/module]; 0 of a rack.
    poisson_ratio : float
    zone : ndarray of int, shape (M,)
        Rim and teeth (0), web (1) or hub (2) that each element belongs to.
    spans : tuple of (float, float)
        Along the face, from where to where each zone is material [modules]; the first has no ends but those of the
        face. Those of an inclined web and its hub are places of the rim that lead there.
    side : {1, -1}
        Of an external or an internal tooth.
    lean : ndarray, shape (M,), or None
        Tangent of the inclination of the web that each element belongs to; None if no web is inclined.
    along : BodyAlong or None
        Places in the hub under an inclined web.
    whole : tuple of SectionMatrices, optional
        The section's matrices of each zone, assembled by scikit-fem, which then eliminates too (`scikit_fem_solver`).
    straight : Straight, optional
        Of a rack's.
    """

    stiffness: tuple[Array, Array, Array]
    element_dofs: Index
    centres: Array
    axes: Array
    places: Array
    edge_nodes: dict[str, Index]
    edge_places: dict[str, Array]
    side_a: Index
    side_b: Index
    order: int
    tau: float
    poisson_ratio: float
    zone: Index
    spans: tuple[tuple[float, float], ...]
    side: int = 1
    lean: Array | None = None
    along: BodyAlong | None = None
    whole: tuple[SectionMatrices, ...] | None = None
    straight: Straight | None = None

    @property
    def size(self) -> int:
        """Number of unknowns of the section."""
        return 3 * self.places.shape[1]

    def nodes_of(self, *names: str) -> Index:
        """Nodes of boundaries, each once, ascending."""
        found = [self.edge_nodes[name].ravel() for name in names if name in self.edge_nodes]
        return np.unique(np.concatenate(found)) if found else np.zeros(0, dtype=np.int64)

    def products_along(self, face: AlongFace) -> list[tuple[Array, Array, Array]]:
        """Integrals of products of functions along the face over what each zone fills, as `FaceFunctions` has them."""
        hub = None if self.along is None else self.along.stretched
        return [face.products_over(*span, hub if zone == HUB else None) for zone, span in enumerate(self.spans)]


def upward(section: Section, name: str) -> tuple[Index, Array]:
    """Edges of a boundary that climbs the tooth, each from its end at the root to that at the tip, the lowest first.

    Returns
    -------
    nodes : ndarray of int, shape (order + 1, edges)
    places : ndarray, shape (2, 3 or 4, edges)
        [modules].
    """
    nodes, places = section.edge_nodes[name], section.edge_places[name]
    height = places[1] if section.straight is not None else section.side * np.hypot(*places)
    rising = height[0] < height[-1]
    # The curve's middle decides for edges whose ends lie on the root circle alike.
    order = np.argsort(height[1] + height[-2])
    return np.where(rising, nodes, nodes[::-1])[:, order], np.where(rising, places, places[:, ::-1])[:, :, order]


def flank_normals(tangent: Array, place: Array, tau: float, slide: float = 0.0) -> Array:
    """Unnormalised normals of the twisted flank out of the material, N = (n, tau t . x), shape (3, ...).

    Their length on an involute is 1 / cos(beta_b): a pressure p on the area of the flank is the force -p N ds dz, and
    -N . u is the approach along the transverse line of action.

    Parameters
    ----------
    tangent : ndarray, shape (2, ...)
        Unit tangents of the section's outline, counterclockwise round the material.
    place : ndarray, shape (2, ...)
        [modules].
    tau : float
    slide : float
        As of `Straight`.
    """
    return np.stack([tangent[1], -tangent[0], tau * (tangent * place).sum(axis=0) - slide * tangent[1]])


def make_section(
    mesh: SectorMesh,
    order: int,
    tau: float,
    poisson_ratio: float,
    base_radius: float,
    body: GearBody | None = None,
    *,
    side: int = 1,
    along: BodyAlong | None = None,
    polar: Sequence[str] = (),
    solver: Solver = "condensed",
    straight: Straight | None = None,
) -> Section:
    """Integrate the section's matrices.

    Parameters
    ----------
    mesh : SectorMesh
    order : {2, 3, 4}
        Order of the displacement in the section.
    tau : float
        [rad/module].
    poisson_ratio : float
    base_radius : float
        [modules].
    body : GearBody, optional
        Web and hub; without it the section is material over the whole face.
    side : {1, -1}
        Of an external or an internal tooth.
    along : BodyAlong, optional
        Where web and hub of the body lie along the face.
    polar : sequence of str
        Boundaries besides the sides whose nodes have polar axes.
    solver : {"condensed", "scikit-fem"}
        What assembles the sector and eliminates its inner unknowns.
    straight : Straight, optional
        Of a rack's section; base radius, twist, body and polar axes are a gear's, and scikit-fem assembles gears only.

    Returns
    -------
    Section

    Raises
    ------
    InputError
        If the sides do not match node by node.
    """
    elements = sector_elements(mesh, order)
    nodes, places = elements.element_nodes, elements.node_places()
    edge_nodes = {name: elements.nodes_along(edges) for name, edges in mesh.edges.items()}
    side_a, side_b = (_outward(edge_nodes[name], places, mesh) for name in ("side_a", "side_b"))
    _check_sides(side_a, side_b, places, mesh)
    count = nodes.shape[0]
    flank = np.unique(edge_nodes.get("flank", np.zeros(0, dtype=np.int64)))
    turned = np.unique(np.concatenate([side_a, side_b, *(edge_nodes[name].ravel() for name in polar)]))
    if straight is None:
        axes = _axes(places, turned, flank, (base_radius, side), tau)
    else:
        axes = _axes_of_rack(places, flank, straight)
    zone = np.zeros(count, dtype=np.int64) if body is None else zones(body, mesh.points, mesh.triangles[:3])
    lean = body.lean * (zone == WEB) if body is not None and body.lean else None
    return Section(
        stiffness=_stiffness(
            elements, axes[nodes], (tau, 0.0 if straight is None else straight.slide), poisson_ratio, lean
        ),
        element_dofs=(3 * nodes[:, :, None] + np.arange(3)).reshape(count, -1),
        centres=mesh.points[:, mesh.triangles[:3]].mean(axis=1),
        axes=axes,
        places=places,
        edge_nodes=edge_nodes,
        edge_places={name: elements.places_along(edges) + elements.tip for name, edges in mesh.edges.items()},
        side_a=side_a,
        side_b=side_b,
        order=order,
        tau=tau,
        poisson_ratio=poisson_ratio,
        zone=zone,
        spans=_WHOLE_FACE if along is None else along.spans,
        side=side,
        lean=lean,
        along=None if lean is None else along,
        whole=assembled_zones(elements, axes, tau, poisson_ratio, zone, lean) if solver == "scikit-fem" else None,
        straight=straight,
    )


def _outward(edges: Index, places: Array, mesh: SectorMesh) -> Index:
    nodes = np.unique(edges)
    return nodes[np.argsort(mesh.outward(places[:, nodes]))]


def _check_sides(side_a: Index, side_b: Index, places: Array, mesh: SectorMesh) -> None:
    if side_a.size == side_b.size:
        a, b = places[:, side_a], places[:, side_b]
        turn = 0.0 if mesh.pitch else 2.0 * np.pi / mesh.teeth
        a = a + np.array([[mesh.pitch], [0.0]])
        turned = np.stack([np.cos(turn) * a[0] + np.sin(turn) * a[1], np.cos(turn) * a[1] - np.sin(turn) * a[0]])
        if np.abs(turned - b).max() < 1e-6 * np.abs(b).max():
            return
    raise InputError(
        "mesh", "side_a, side_b", "have different nodes, so that sectors cannot be joined",
        "mesh side_b as side_a rotated by one pitch",
    )  # fmt: skip


def _axes(places: Array, sides: Index, flank: Index, base: tuple[float, int], tau: float) -> Array:
    """Axes of every node, shape (N, 3, 3); `base` is the base radius [modules] and the side of the tooth."""
    axes = np.tile(np.eye(3), (places.shape[1], 1, 1))
    x, y = places[:, sides] / np.hypot(*places[:, sides])
    axes[sides, :2, 0] = np.stack([x, y], axis=1)
    axes[sides, :2, 1] = np.stack([y, -x], axis=1)
    # On the involute: the normal touches the base circle, so the tangent is the point's direction turned by the
    # pressure angle toward an external tooth, away from an internal one.
    x, y = places[:, flank]
    r = np.hypot(x, y)
    base_radius, side = base
    cos = np.minimum(base_radius / r, 1.0)
    sin = side * np.sqrt(1.0 - cos * cos)
    tangent = np.stack([cos * x - sin * y, sin * x + cos * y]) / r
    _against_flank(axes, flank, tangent, flank_normals(tangent, places[:, flank], tau))
    return axes


def _axes_of_rack(places: Array, flank: Index, straight: Straight) -> Array:
    """The same of a rack, whose sides go on as they are: x, y and z everywhere but on the flank."""
    axes = np.tile(np.eye(3), (places.shape[1], 1, 1))
    upward = np.array([[-np.sin(straight.pressure_angle)], [np.cos(straight.pressure_angle)]])
    tangent = np.repeat(upward, flank.size, axis=1)
    _against_flank(axes, flank, tangent, flank_normals(tangent, places[:, flank], 0.0, straight.slide))
    return axes


def _against_flank(axes: Array, flank: Index, tangent: Array, normal: Array) -> None:
    """Give the flank's nodes their axes."""
    length = (normal * normal).sum(axis=0)
    # Unknowns a with u = sum of axes times a, the first of which is a_0 = -N . u.
    axes[flank, :, 0] = (-normal / length).T
    axes[flank, :2, 1] = tangent.T
    axes[flank, 2, 1] = 0.0
    second = np.cross(normal.T, axes[flank, :, 1])
    axes[flank, :, 2] = second / np.linalg.norm(second, axis=1)[:, None]


def _stiffness(
    elements: SectorElements, axes: Array, motion: tuple[float, float], poisson_ratio: float, lean: Array | None
) -> tuple[Array, Array, Array]:
    """The section's matrices for unknowns along axes of shape (M, n, 3, 3); `motion` is its twist and its slide."""
    from fegear.fem.forms import coefficients, element_matrices, products, shear, turn, turned_elasticity

    tau, slide = motion
    basis = elements.basis()
    place = basis.mapping.F(basis.X) + elements.tip
    turn(basis, place, tau, slide)
    # What changes along the face adds P' times the function itself to its D, and in an inclined web to its slopes.
    slots, along, gained = 4, [0], 3
    if lean is not None:
        shear(basis, place, lean)
        slots, along, gained = 6, [4, 5, 0], 1
    integrals = products(basis, tuple(range(slots)))
    lam, mu = lame(poisson_ratio, "strain")
    weights = coefficients(turned_elasticity, 3, 3, lam=lam, mu=mu, tau=tau)
    in_section = element_matrices(weights, integrals[:4, :4])
    mixed = element_matrices(weights[..., gained:], integrals[:4][:, along])
    along_face = element_matrices(weights[:, gained:, :, gained:], integrals[np.ix_(along, along)])
    return turned_matrices(in_section, axes), turned_matrices(mixed, axes), turned_matrices(along_face, axes)


def turned_matrices(matrices: Array, axes: Array) -> Array:
    """Element matrices, shape (M, 3 n, 3 n), for unknowns along axes of shape (M, n, 3, 3)."""
    count, n = axes.shape[:2]
    rows = (axes.transpose(0, 1, 3, 2) @ matrices.reshape(count, n, 3, 3 * n)).reshape(count, 3 * n, n, 3)
    return np.asarray(rows.transpose(0, 2, 1, 3) @ axes).transpose(0, 2, 1, 3).reshape(count, 3 * n, 3 * n)
