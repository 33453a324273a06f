"""Plane elasticity of one sector: the stiffness of every curved triangle, and the unknowns along named boundaries.

Shape functions, quadrature, numbering and maps are scikit-fem's, and it integrates the weak form of `fem.forms`. With
the solver "scikit-fem" it assembles the whole sector as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.fem.plane.elements import SectorElements, one_order_higher, sector_elements
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.scikit_fem_solver import assembled
from fegear.fem.plane.settings import Solver
from fegear.geometry.gear import Plane


@dataclass(frozen=True)
class SectorElasticity:
    """The stiffness of one free sector, E = 1, element by element, or as a whole.

    Unknown 2 i + c is component c (x, y) of node i. Nodes: the mesh's vertices, then those inside its edges, then
    those inside its elements; with order 2 they are the mesh's points.

    Parameters
    ----------
    stiffness : ndarray, shape (M, 2 n, 2 n)
        Of every element; of none where the whole is assembled.
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
    elements : SectorElements
        What they are made of.
    whole : scipy.sparse.csr_matrix, shape (size, size), optional
        Of the whole sector, assembled by scikit-fem, which then eliminates too (`scikit_fem_solver`).
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
    elements: SectorElements
    whole: Any = None


def lame(poisson_ratio: float, plane: Plane) -> tuple[float, float]:
    """Lame's constants for E = 1; in plane stress lambda is 2 lambda mu / (lambda + 2 mu)."""
    nu = poisson_ratio
    mu = 0.5 / (1.0 + nu)
    if plane == "stress":
        return nu / (1.0 - nu * nu), mu
    return nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu


def assemble(
    mesh: SectorMesh, poisson_ratio: float, plane: Plane, order: int, solver: Solver = "condensed"
) -> SectorElasticity:
    """Stiffness of every element of a mesh of curved (isoparametric) triangles.

    Parameters
    ----------
    mesh : SectorMesh
    poisson_ratio : float
    plane : {"strain", "stress"}
    order : {2, 3, 4}
        Order of the displacement; the geometry's is 2, or 3 where the boundary's tangents are known.
    solver : {"condensed", "scikit-fem"}
        Which assembles, and eliminates afterwards.

    Returns
    -------
    SectorElasticity
    """
    elements = sector_elements(mesh, order)
    constants = lame(poisson_ratio, plane)
    if solver == "scikit-fem":
        return _elasticity(mesh, elements, whole=assembled(elements, *constants))
    return _elasticity(mesh, elements, _stiffness(elements, *constants))


def assemble_two_orders(
    mesh: SectorMesh, poisson_ratio: float, plane: Plane, order: int, solver: Solver = "condensed"
) -> tuple[SectorElasticity, SectorElasticity]:
    """As `assemble`, and the same elements with displacements one order lower.

    These are among the displacements of the higher order, whose integrals therefore serve both.
    """
    elements, constants = sector_elements(mesh, order), lame(poisson_ratio, plane)
    if solver == "scikit-fem":
        both = elements, elements.one_order_lower()
        first, second = (_elasticity(mesh, each, whole=assembled(each, *constants)) for each in both)
        return first, second
    higher = _elasticity(mesh, elements, _stiffness(elements, *constants))
    lower = np.kron(one_order_higher(order - 1), np.eye(2))
    return higher, _elasticity(mesh, elements.one_order_lower(), np.asarray(lower.T @ (higher.stiffness @ lower)))


def _elasticity(
    mesh: SectorMesh, elements: SectorElements, stiffness: Array | None = None, *, whole: Any = None
) -> SectorElasticity:
    nodes, points = elements.element_nodes, elements.point_nodes
    return SectorElasticity(
        stiffness=np.zeros((0, 0, 0)) if stiffness is None else stiffness,
        element_dofs=(2 * nodes[:, :, None] + np.array([0, 1])).reshape(nodes.shape[0], -1),
        inside=2 * int(elements.dofs.interior_dofs.shape[0]),
        centres=mesh.points[:, mesh.triangles[:3]].mean(axis=1),
        edge_dofs={
            name: 2 * elements.nodes_along(edges) + np.array([0, 1])[:, None, None]
            for name, edges in mesh.edges.items()
        },
        edge_places={name: elements.places_along(edges) + elements.tip for name, edges in mesh.edges.items()},
        node_dofs=np.where(points < 0, -1, 2 * points + np.array([[0], [1]])),
        order=elements.order,
        size=2 * int(elements.dofs.N),
        elements=elements,
        whole=whole,
    )


def _stiffness(elements: SectorElements, lam: float, mu: float) -> Array:
    """Stiffness of every element, shape (M, 2 n, 2 n).

    scikit-fem integrates over the curved elements and one straight one; the other straight ones are its affine images.
    """
    from fegear.fem.forms import coefficients, element_matrices, plane_elasticity, products

    curved, straight = np.flatnonzero(elements.curved), np.flatnonzero(~elements.curved)
    weights = coefficients(plane_elasticity, 2, 2, lam=lam, mu=mu)[:, 1:, :, 1:]
    matrix, inverse, area = elements.affine_maps(straight)
    model = area.argsort()[-1:]
    integrals = products(elements.basis(np.concatenate([curved, straight[model]])), (1, 2))
    nodes = integrals.shape[-1]
    found = np.empty((elements.curved.size, 2 * nodes, 2 * nodes))
    found[curved] = element_matrices(weights, integrals[:, :, : curved.size])
    if straight.size:
        # Slopes on an image are those on the model times this matrix.
        image = np.einsum("pr,rkm->pkm", matrix[:, :, model[0]], inverse)
        tensor = np.einsum("akbl,pkm,qlm,m->mabpq", weights, image, image, area / area[model], optimize=True)
        # One product for all elements, with the components x and y in their places already.
        spread = np.zeros((2, 2, 2, 2, nodes, 2, nodes, 2))
        for a in range(2):
            for b in range(2):
                spread[a, b, :, :, :, a, :, b] = integrals[:, :, -1]
        found[straight] = (tensor.reshape(-1, 16) @ spread.reshape(16, -1)).reshape(-1, 2 * nodes, 2 * nodes)
    return found
