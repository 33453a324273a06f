"""Plane elasticity of one sector: the stiffness of every curved triangle, and the unknowns along named boundaries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.triangle import quadrature, triangle

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.fem.mesh import SectorMesh
    from fegear.geometry.gear import Plane

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

#: A middle node this near to the middle of its edge, as a share of the edge, leaves the edge straight.
_STRAIGHT = 1e-12


@dataclass(frozen=True)
class SectorElasticity:
    """The stiffness of one free sector, E = 1, element by element.

    Unknown 2 i + c is component c (x, y) of node i. Nodes: the mesh's vertices, then those inside its edges, then
    those inside its elements; with order 2 they are the mesh's points.

    Parameters
    ----------
    stiffness : ndarray, shape (M, 2 n, 2 n)
        Of every element.
    element_dofs : ndarray of int, shape (M, 2 n)
        The unknowns that its rows belong to.
    inside : int
        How many of an element's unknowns, the last ones, are its own.
    centres : ndarray, shape (2, M)
        Where the elements lie [modules].
    edge_dofs : dict of str to ndarray of int, shape (2, order + 1, edges)
        Unknowns (x and y) of the nodes along each boundary edge, from its first to its second vertex.
    node_dofs : ndarray of int, shape (2, N)
        Unknowns at the mesh's points (vertices; middle nodes too where the order is 2, else -1).
    order, size : int
        Order of the elements; number of unknowns.
    """

    stiffness: Array
    element_dofs: Index
    inside: int
    centres: Array
    edge_dofs: dict[str, Index]
    node_dofs: Index
    order: int
    size: int


def lame(poisson_ratio: float, plane: Plane) -> tuple[float, float]:
    """Lame's constants for E = 1; in plane stress lambda is 2 lambda mu / (lambda + 2 mu)."""
    nu = poisson_ratio
    mu = 0.5 / (1.0 + nu)
    if plane == "stress":
        return nu / (1.0 - nu * nu), mu
    return nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu


def assemble(mesh: SectorMesh, poisson_ratio: float, plane: Plane, order: int) -> SectorElasticity:
    """Stiffness of every element of a mesh of curved (isoparametric) triangles.

    Parameters
    ----------
    mesh : SectorMesh
    poisson_ratio : float
    plane : {"strain", "stress"}
    order : {2, 3, 4}
        Order of the displacement; the geometry is of order 2.

    Returns
    -------
    SectorElasticity
    """
    vertices, elements, per_edge = mesh.vertex_count, mesh.triangles.shape[1], order - 1
    per_element = (order - 1) * (order - 2) // 2
    edges = mesh.points.shape[1] - vertices

    def on_edge(first: Index, second: Index, middle: Index) -> Index:
        """Nodes inside edges from their first to their second vertex, shape (order - 1, edges)."""
        step = np.arange(per_edge)[:, None]
        # An edge numbers its nodes from its lower vertex to its higher.
        step = np.where(first < second, step, per_edge - 1 - step)
        return np.asarray(vertices + (middle - vertices) * per_edge + step)

    corners, middles = mesh.triangles[:3], mesh.triangles[3:]
    sides = [on_edge(corners[i], corners[(i + 1) % 3], middles[i]) for i in range(3)]
    first_inner = vertices + edges * per_edge
    own = first_inner + np.arange(elements) * per_element + np.arange(per_element)[:, None]
    nodes = np.concatenate([corners, *sides, own])
    node_dofs = np.full((2, mesh.points.shape[1]), -1, dtype=np.int64)
    known = mesh.points.shape[1] if order == 2 else vertices
    node_dofs[:, :known] = 2 * np.arange(known) + np.array([[0], [1]])
    edge_dofs = {
        name: 2 * np.concatenate([e[:1], on_edge(*e), e[1:2]]) + np.array([0, 1])[:, None, None]
        for name, e in mesh.edges.items()
    }
    return SectorElasticity(
        stiffness=_element_stiffness(mesh, *lame(poisson_ratio, plane), order),
        element_dofs=(2 * nodes.T[:, :, None] + np.array([0, 1])).reshape(elements, -1),
        inside=2 * per_element,
        centres=mesh.points[:, corners].mean(axis=1),
        edge_dofs=edge_dofs,
        node_dofs=node_dofs,
        order=order,
        size=2 * (first_inner + elements * per_element),
    )


def _element_stiffness(mesh: SectorMesh, lam: float, mu: float, order: int) -> Array:
    """Stiffness matrices of all elements, shape (M, 2 n, 2 n), unknowns x and y node by node."""
    # Coordinates centred on the tooth keep the digits of small elements far from the gear's axis.
    points = mesh.points - np.array([[0.0], [float(mesh.points[1].max())]])
    places = points[:, mesh.triangles]  # (2, 6, M)
    products = np.empty((mesh.triangles.shape[1], 2, 2, triangle(order).nodes.shape[1] ** 2))
    straight = _is_straight(places)
    products[straight] = _products_straight(places[:, :3, straight], order)
    bends = _element_bends(mesh) if order > 2 else np.zeros((2, 3, 2, straight.size))
    products[~straight] = _products_curved(places[:, :, ~straight], bends[..., ~straight], order)
    n = triangle(order).nodes.shape[1]
    d = products.reshape(-1, 2, 2, n, n)
    stiffness = np.empty((d.shape[0], n, 2, n, 2))
    for a in range(2):
        b = 1 - a
        stiffness[:, :, a, :, a] = (lam + 2.0 * mu) * d[:, a, a] + mu * d[:, b, b]
        stiffness[:, :, a, :, b] = lam * d[:, a, b] + mu * d[:, b, a]
    return stiffness.reshape(-1, 2 * n, 2 * n)


def _is_straight(places: Array) -> NDArray[np.bool_]:
    corners = places[:, :3]
    ends = corners[:, [1, 2, 0]]
    off = np.abs(places[:, 3:] - 0.5 * (corners + ends)).max(axis=(0, 1))
    return np.asarray(off <= _STRAIGHT * np.abs(ends - corners).max(axis=(0, 1)))


def _products_straight(corners: Array, order: int) -> Array:
    """Integrals of dN_i/dx_a dN_j/dx_b on straight elements, from those on the reference triangle, (M, 2, 2, n n)."""
    u, v, weight = quadrature(order)
    slope = triangle(order).slopes(u, v)
    reference = np.einsum("kqi,lqj,q->klij", slope, slope, weight)
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    determinant = a[0] * b[1] - a[1] * b[0]
    inverse = np.array([[b[1], -b[0]], [-a[1], a[0]]]) / determinant  # d(u, v) / d(x, y)
    metric = np.einsum("kam,lbm,m->mabkl", inverse, inverse, determinant)
    count, n = determinant.size, slope.shape[2]
    return np.asarray(metric.reshape(count * 4, 4) @ reference.reshape(4, n * n)).reshape(count, 2, 2, n * n)


def _element_bends(mesh: SectorMesh) -> Array:
    """What cubic edges add to each element's quadratic ones, shape (2, 3 sides, 2 ends, M).

    Side i from corner i to i + 1 moves by l0 l1 (l0 c0 + l1 c1) with the corners' areal coordinates l; the quadratic
    edge through the middle node, l0 l1 4 d, is taken off.
    """
    count = mesh.triangles.shape[1]
    found = np.zeros((2, 3, 2, count))
    side_of_middle = np.full(mesh.points.shape[1], -1, dtype=np.int64)
    side_of_middle[mesh.triangles[3:].reshape(-1)] = np.arange(3 * count)  # a boundary edge has one element
    for name, bends in mesh.bends.items():
        first, second, middle = mesh.edges[name]
        side, element = np.divmod(side_of_middle[middle], count)
        off = mesh.points[:, middle] - 0.5 * (mesh.points[:, first] + mesh.points[:, second])
        along = mesh.triangles[side, element] == first
        # Against the element's own direction the ends change places.
        ends = np.where(along, bends, bends[:, ::-1])
        found[:, side, :, element] = (ends - 4.0 * off[:, None]).transpose(2, 0, 1)
    return found


def _products_curved(places: Array, bends: Array, order: int) -> Array:
    """The same on elements with curved edges, by quadrature of degree 2 order + 1."""
    u, v, weight = quadrature(order + 1)
    geometry = triangle(2).slopes(u, v)
    a, b = (np.einsum("cim,qi->cmq", places, along) for along in geometry)
    if bends.any():
        more_a, more_b = (np.einsum("csem,seq->cmq", bends, along) for along in _bend_slopes(u, v))
        a, b = a + more_a, b + more_b
    determinant = a[0] * b[1] - a[1] * b[0]
    inverse = np.array([[b[1], -b[0]], [-a[1], a[0]]]) / determinant  # (uv, xy, M, q)
    slope = triangle(order).slopes(u, v)
    gradient = np.einsum("kamq,kqi->maqi", inverse, slope)  # (M, 2, q, n)
    weighted = gradient * (weight * determinant)[:, None, :, None]
    count, n = determinant.shape[0], slope.shape[2]
    flat = np.matmul(gradient.transpose(0, 1, 3, 2)[:, :, None], weighted[:, None])
    return np.asarray(flat).reshape(count, 2, 2, n * n)


def _bend_slopes(u: Array, v: Array) -> tuple[Array, Array]:
    """Derivatives of l0 l1 l0 and l0 l1 l1 of each side along u and v, shape (3 sides, 2 ends, points) each."""
    areal = np.array([1.0 - u - v, u, v])
    by_u, by_v = np.array([-1.0, 1.0, 0.0]), np.array([-1.0, 0.0, 1.0])
    slopes: tuple[list[list[Array]], list[list[Array]]] = ([], [])
    for i in range(3):
        j = (i + 1) % 3
        p, q = areal[i], areal[j]
        for result, d in zip(slopes, (by_u, by_v), strict=True):
            result.append([2 * p * q * d[i] + p * p * d[j], q * q * d[i] + 2 * p * q * d[j]])
    return np.array(slopes[0]), np.array(slopes[1])
