"""Plane elasticity of one sector by scikit-fem: stiffness matrix and the unknowns along named boundaries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.fem.mesh import SectorMesh
    from fegear.geometry.gear import Plane

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]


@dataclass(frozen=True)
class SectorElasticity:
    """The stiffness of one free sector, E = 1.

    Parameters
    ----------
    stiffness : scipy sparse matrix, shape (n, n)
    edge_dofs : dict of str to ndarray of int, shape (2, order + 1, edges)
        Unknowns (x and y) of the Lagrange nodes along each boundary edge, from its first to its second vertex.
    node_dofs : ndarray of int, shape (2, N)
        Unknowns at the mesh's points (vertices; middle nodes too where the order is 2, else -1).
    order : int
    """

    stiffness: Any
    edge_dofs: dict[str, Index]
    node_dofs: Index
    order: int


def lame(poisson_ratio: float, plane: Plane) -> tuple[float, float]:
    """Lame's constants for E = 1; in plane stress lambda is 2 lambda mu / (lambda + 2 mu)."""
    nu = poisson_ratio
    mu = 0.5 / (1.0 + nu)
    if plane == "stress":
        return nu / (1.0 - nu * nu), mu
    return nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu


def assemble(mesh: SectorMesh, poisson_ratio: float, plane: Plane, order: int) -> SectorElasticity:
    """Assemble the stiffness matrix on curved (isoparametric) triangles.

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
    import skfem
    from skfem.helpers import ddot, sym_grad, trace

    lam, mu = lame(poisson_ratio, plane)
    six = _sorted_elements(mesh.triangles)
    # Coordinates centred on the tooth: the inverse maps of scikit-fem work with absolute tolerances.
    centre = np.array([[0.0], [float(mesh.points[1].max())]])
    grid = skfem.MeshTri2(np.ascontiguousarray(mesh.points - centre), six, sort_t=False, validate=False)
    element = {2: skfem.ElementTriP2, 3: skfem.ElementTriP3, 4: skfem.ElementTriP4}[order]()
    basis = skfem.Basis(grid, skfem.ElementVector(element), intorder=2 * order)

    @skfem.BilinearForm
    def energy(u: Any, v: Any, _w: Any) -> Any:
        strain, test = sym_grad(u), sym_grad(v)
        return lam * trace(strain) * trace(test) + 2.0 * mu * ddot(strain, test)

    stiffness = energy.assemble(basis)
    facets = {tuple(pair): i for i, pair in enumerate(grid.facets.T.tolist())}
    edge_dofs: dict[str, Index] = {}
    for name, edges in mesh.edges.items():
        found = np.array([facets[min(a, b), max(a, b)] for a, b in edges[:2].T.tolist()])
        first, second = basis.nodal_dofs[:, edges[0]], basis.nodal_dofs[:, edges[1]]
        inner = basis.facet_dofs[:, found].reshape(order - 1, 2, -1).transpose(1, 0, 2)
        # Facet unknowns run from the lower vertex number to the higher (the elements' vertices are sorted).
        inner = np.where(edges[0] < edges[1], inner, inner[:, ::-1])
        edge_dofs[name] = np.concatenate([first[:, None], inner, second[:, None]], axis=1).astype(np.int64)
    node_dofs = np.full((2, mesh.points.shape[1]), -1, dtype=np.int64)
    node_dofs[:, : mesh.vertex_count] = basis.nodal_dofs[:, : mesh.vertex_count]
    if order == 2:
        middle = np.zeros(grid.nfacets, dtype=np.int64)
        middle[grid.t2f] = six[3:]
        node_dofs[:, middle] = basis.facet_dofs
    return SectorElasticity(stiffness.tocsc(), edge_dofs, node_dofs, order)


def _sorted_elements(triangles: Index) -> Index:
    """Sort each element's vertices and carry the middle nodes along (scikit-fem does not for curved triangles)."""
    order = np.argsort(triangles[:3], axis=0)
    vertices = np.take_along_axis(triangles[:3], order, axis=0)
    # The middle node opposite to vertex i of the old numbering: 1-2, 2-0, 0-1.
    opposite = triangles[[4, 5, 3]]
    moved = np.take_along_axis(opposite, order, axis=0)
    return np.ascontiguousarray(np.concatenate([vertices, moved[[2, 0, 1]]]))
