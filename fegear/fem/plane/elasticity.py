"""Plane elasticity of one sector: the stiffness of every curved triangle, and the unknowns along named boundaries.

Shape functions, quadrature, numbering and the map of the curved elements are scikit-fem's; element matrices are formed
here, all at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.elements import sector_elements

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.geometry.gear import Plane


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
    edge_places : dict of str to ndarray, shape (2, 3 or 4, edges)
        Evenly spaced nodes of each boundary edge's own curve, quadratic or cubic, in that direction [modules].
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
    edge_places: dict[str, Array]
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
        Order of the displacement; the geometry's is 2, or 3 where the boundary's tangents are known.

    Returns
    -------
    SectorElasticity
    """
    elements = sector_elements(mesh, order)
    nodes, points = elements.element_nodes, elements.point_nodes
    count, n = nodes.shape
    stiffness = np.empty((count, 2 * n, 2 * n))
    constants = lame(poisson_ratio, plane)
    stiffness[~elements.curved] = _straight_stiffness(*elements.straight(), *constants)
    if elements.curved.any():
        stiffness[elements.curved] = _curved_stiffness(*elements.bent(), *constants)
    return SectorElasticity(
        stiffness=stiffness,
        element_dofs=(2 * nodes[:, :, None] + np.array([0, 1])).reshape(count, -1),
        inside=2 * int(elements.dofs.interior_dofs.shape[0]),
        centres=mesh.points[:, mesh.triangles[:3]].mean(axis=1),
        edge_dofs={
            name: 2 * elements.nodes_along(edges) + np.array([0, 1])[:, None, None]
            for name, edges in mesh.edges.items()
        },
        edge_places={name: elements.places_along(edges) + elements.tip for name, edges in mesh.edges.items()},
        node_dofs=np.where(points < 0, -1, 2 * points + np.array([[0], [1]])),
        order=order,
        size=2 * int(elements.dofs.N),
    )


def _straight_stiffness(
    slope: Array, weight: Array, inverse: Array, determinant: Array, lam: float, mu: float
) -> Array:
    """Stiffness of straight elements, shape (m, 2 n, 2 n): their maps times integrals on the reference triangle."""
    n = slope.shape[0]
    reference = np.einsum("ikq,jlq,q->klij", slope, slope, weight)
    metric = np.einsum("kam,lbm,m->mabkl", inverse, inverse, determinant)
    trace = mu * (metric[:, 0, 0] + metric[:, 1, 1])
    tensor = lam * metric + mu * metric.transpose(0, 2, 1, 3, 4)
    tensor[:, 0, 0] += trace
    tensor[:, 1, 1] += trace
    # One product for all elements, with the components x and y in their places already.
    spread = np.zeros((2, 2, 2, 2, n, 2, n, 2))
    for a in range(2):
        for b in range(2):
            spread[a, b, :, :, :, a, :, b] = reference
    return np.asarray(tensor.reshape(-1, 16) @ spread.reshape(16, -1)).reshape(-1, 2 * n, 2 * n)


def _curved_stiffness(gradient: Array, area: Array, lam: float, mu: float) -> Array:
    """Stiffness of curved elements, shape (m, 2 n, 2 n), from the gradients at their quadrature points."""
    count, n, _, points = gradient.shape
    flat = gradient.reshape(count, 2 * n, points)
    d = ((flat * area[:, None]) @ flat.transpose(0, 2, 1)).reshape(count, n, 2, n, 2)
    stiffness = lam * d + mu * d.transpose(0, 1, 4, 3, 2)
    trace = mu * (d[:, :, 0, :, 0] + d[:, :, 1, :, 1])
    stiffness[:, :, 0, :, 0] += trace
    stiffness[:, :, 1, :, 1] += trace
    return stiffness.reshape(count, 2 * n, 2 * n)
