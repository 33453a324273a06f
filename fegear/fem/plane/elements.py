"""The curved triangles of a sector in scikit-fem's terms: numbering of nodes, shape functions, quadrature and map."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.fem.plane.mesh import SectorMesh

#: An edge that leaves its chord by no more than this share of it is straight.
_STRAIGHT = 1e-12
#: Degree of the quadrature on curved elements, whose integrands are rational.
_CURVED_DEGREE = 12


@dataclass(frozen=True)
class SectorElements:
    """Elements of one order on a sector mesh.

    scikit-fem numbers the vertices first, then the nodes inside the edges (from an edge's lower vertex to its higher),
    then those inside the elements. It takes for granted, without a check, that the corners of every element ascend:
    only then do neighbours agree on the direction of their common edge.

    Attributes
    ----------
    order : {2, 3, 4}
    grid : skfem.MeshTri1
        Corners ascending; `doflocs` are the nodes of quadratic (order 2) or cubic edges, the tip at y = 0 [modules].
    dofs : skfem.Dofs
        Numbers of the nodes.
    curved : ndarray of bool, shape (M,)
        Which elements have curved edges.
    edge_of_point : ndarray of int, shape (N,)
        The grid's number of the edge whose middle node a point of the mesh is; -1 at vertices.
    tip : ndarray, shape (2, 1, 1)
        The grid's origin in the gear's coordinates [modules].
    origin : str
        Where the mesh came from.
    """

    order: int
    grid: Any
    dofs: Any
    curved: NDArray[np.bool_]
    edge_of_point: Index
    tip: Array
    origin: str

    def one_order_lower(self) -> SectorElements:
        """Elements of the same shape whose displacements are one order lower."""
        from skfem import Dofs

        order = self.order - 1
        return replace(self, order=order, dofs=Dofs(self.grid, _element(order)))

    @property
    def element_nodes(self) -> Index:
        """Nodes of each element, those inside it last, shape (M, n)."""
        return self.dofs.element_dofs.T.astype(np.int64)

    @property
    def point_nodes(self) -> Index:
        """Node at each of the mesh's points, shape (N,); -1 at middle nodes where elements of this order have none."""
        nodes = np.arange(self.edge_of_point.size)
        middle = self.edge_of_point >= 0
        nodes[middle] = self.dofs.facet_dofs[0, self.edge_of_point[middle]] if self.order == 2 else -1
        return nodes

    def nodes_along(self, edges: Index) -> Index:
        """Nodes of edges (first vertex, second vertex, middle node) in that direction, shape (order + 1, edges)."""
        return self._along(self.dofs, edges)

    def places_along(self, edges: Index) -> Array:
        """Evenly spaced nodes of the edges' own curves, shape (2, 3 or 4, edges), the tip at y = 0 [modules]."""
        return np.asarray(self.grid.doflocs[:, self._along(self.grid.dofs, edges)])

    def _along(self, dofs: Any, edges: Index) -> Index:
        first, second, middle = edges
        if not dofs.facet_dofs.size:  # linear elements have no nodes inside their edges
            return np.stack([first, second])
        inside = dofs.facet_dofs[:, self.edge_of_point[middle]]
        return np.concatenate([first[None], np.where(first < second, inside, inside[::-1]), second[None]])

    def affine_maps(self, chosen: Index) -> tuple[Array, Array, Array]:
        """Maps of elements with straight edges.

        Returns
        -------
        matrix : ndarray, shape (2, 2, m)
            Derivatives of x and y along the reference coordinates [modules].
        inverse : ndarray, shape (2, 2, m)
            Derivatives of the reference coordinates along x and y [1/modules].
        determinant : ndarray, shape (m,)
            Of the maps, positive [modules^2].
        """
        from skfem import MappingAffine

        mapping = MappingAffine(self.grid, tind=chosen)
        return mapping.A, mapping.invA, np.abs(mapping.detA)

    def basis(self, chosen: Index | None = None, degree: int = _CURVED_DEGREE) -> Any:
        """scikit-fem's basis of the shape functions on elements, by default all, for integrals over curved ones.

        Raises
        ------
        InputError
            If an element is turned inside out.
        """
        basis = self._basis(intorder=degree, elements=chosen)
        _refuse_inverted(basis.mapping.detDF(basis.X, tind=chosen), self.origin)
        return basis

    def vector_basis(self, components: int = 2, chosen: Index | None = None, degree: int = _CURVED_DEGREE) -> Any:
        """scikit-fem's basis of vector-valued functions on elements, by default all.

        With n components unknown n i + c is component c of node i.

        Raises
        ------
        InputError
            If an element is turned inside out.
        """
        from skfem import Basis, ElementVector

        from fegear.fem.plane.curved_map import CurvedMap

        element, mapping = ElementVector(_element(self.order), components), CurvedMap(self.grid)
        basis = Basis(self.grid, element, mapping, intorder=degree, elements=chosen, disable_doflocs=True)
        _refuse_inverted(mapping.detDF(basis.X, tind=chosen), self.origin)
        return basis

    def node_places(self) -> Array:
        """Where the nodes lie, shape (2, N) [modules from the gear's centre]."""
        from fegear.fem.plane.curved_map import CurvedMap

        at = CurvedMap(self.grid).F(_element(self.order).doflocs.T)
        places = np.empty((2, int(self.dofs.N)))
        places[:, self.element_nodes] = at
        return places + self.tip[:, :, 0]

    def gradients_at_nodes(self) -> Array:
        """Gradients of the shape functions of every element at its own nodes, shape (M, n, 2, n) [1/modules]."""
        return self._gradients_at(_element(self.order).doflocs.T)

    def gradients_at_points(self, inward: float = 0.0) -> tuple[Array, Index]:
        """Gradients of the shape functions at the mesh's six points of every element.

        Parameters
        ----------
        inward : float
            So far on the way from there to the element's middle: at a crack's tip they have no bound.

        Returns
        -------
        gradients : ndarray, shape (M, n, 2, 6)
            [1/modules].
        points : ndarray of int, shape (M, 6)
            Which of the mesh's points those are: corners, ascending, then the middle nodes between them.
        """
        middle = np.flatnonzero(self.edge_of_point >= 0)
        point_of_edge = np.empty(middle.size, dtype=np.int64)
        point_of_edge[self.edge_of_point[middle]] = middle
        places = np.array([[0.0, 1.0, 0.0, 0.5, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0, 0.5, 0.5]])
        places = places + inward * (1.0 / 3.0 - places)
        return self._gradients_at(places), np.hstack([self.element_nodes[:, :3], point_of_edge[self.grid.t2f.T]])

    def _gradients_at(self, places: Array) -> Array:
        return _gradients(self._basis(quadrature=(places, np.ones(places.shape[1]))))

    def _basis(self, **at: Any) -> Any:
        from skfem import Basis

        from fegear.fem.plane.curved_map import CurvedMap

        mapping = CurvedMap(self.grid)
        return Basis(self.grid, _element(self.order), mapping, dofs=self.dofs, disable_doflocs=True, **at)


def _gradients(basis: Any) -> Array:
    """Gradients of the shape functions, shape (m, n, 2, q)."""
    return np.stack([shape.grad for (shape,) in basis.basis]).transpose(2, 0, 1, 3)


def sector_elements(mesh: SectorMesh, order: int) -> SectorElements:
    """Number the nodes of elements of an order, and curve their edges.

    Parameters
    ----------
    mesh : SectorMesh
    order : {2, 3, 4}
        Elements of order 2 follow the quadratic edges through the middle nodes; those of order 3 and 4 the cubic ones
        where the mesh knows them (`SectorMesh.bends`).
    """
    from skfem import Dofs, ElementTriP2, ElementTriP3, MeshTri1

    # Coordinates centred on the tooth keep the digits of small elements far from the gear's axis.
    tip = np.array([[0.0], [float(mesh.points[1].max())]])
    points = mesh.points - tip
    vertices = np.ascontiguousarray(points[:, : mesh.vertex_count])  # scikit-fem warns of any other order
    rank = np.argsort(mesh.triangles[:3], axis=0)
    corners = np.take_along_axis(mesh.triangles[:3], rank, axis=0)
    grid = MeshTri1(vertices, corners, elem=ElementTriP2 if order == 2 else ElementTriP3, affine=False)
    edge_of_point = np.full(points.shape[1], -1, dtype=np.int64)
    # Sorted corners 0 1, 1 2 and 0 2 are edges 0, 1 and 2; the node between own corners i and i + 1 is number 3 + i.
    for edge, (one, other) in enumerate(((0, 1), (1, 2), (0, 2))):
        opposite = 3 - rank[one] - rank[other]
        between = np.take_along_axis(mesh.triangles[3:], ((opposite + 1) % 3)[None], axis=0)[0]
        edge_of_point[between] = grid.t2f[edge]
    chord, sag, lean = _bends(mesh, points, grid.facets, edge_of_point, cubic=order > 2)
    if order == 2:
        inner = vertices[:, grid.facets].mean(axis=1) + sag
    else:
        inner = _cubic_nodes(vertices, corners, grid, chord, sag, lean)
    grid.doflocs = np.hstack([vertices, inner])
    off = np.maximum(np.abs(sag), 0.25 * np.abs(lean).max(axis=1)).max(axis=0)
    curved = (off > _STRAIGHT * np.abs(chord).max(axis=0))[grid.t2f].any(axis=0)
    return SectorElements(order, grid, Dofs(grid, _element(order)), curved, edge_of_point, tip[:, :, None], mesh.origin)


def check_cubic_edges(mesh: SectorMesh) -> None:
    """Refuse a mesh some of whose elements are turned inside out by their cubic edges.

    Raises
    ------
    InputError
    """
    from skfem.quadrature import get_quadrature_tri

    from fegear.fem.plane.curved_map import CurvedMap

    elements = sector_elements(mesh, order=3)
    chosen = np.flatnonzero(elements.curved)
    if chosen.size:
        # Not at the corners: where two smooth edges of one element meet the determinant is zero as it should be.
        places, _ = get_quadrature_tri(_CURVED_DEGREE)
        mapping = CurvedMap(elements.grid)
        _refuse_inverted(mapping.detDF(places, tind=chosen), mesh.origin)


def _refuse_inverted(determinant: Array, origin: str) -> None:
    """Elements with sorted corners run either way round, but each the same way everywhere."""
    inverted = (determinant.min(axis=1) < 0.0) & (determinant.max(axis=1) > 0.0)
    if inverted.any():
        raise InputError(
            "mesh",
            origin,
            f"has {int(inverted.sum())} inverted curved elements",
            "refine the mesh at curved boundaries",
        )


def line_functions(degree: int, places: Array) -> tuple[Array, Array]:
    """Functions of one line element on [0, 1]: two that are linear, then integrated Legendre polynomials.

    Parameters
    ----------
    degree : int
        At least 3.
    places : ndarray, shape (q,)

    Returns
    -------
    values, slopes : ndarray, shape (degree + 1, q)
        From the third on they vanish at both ends; their slopes are orthogonal to each other.
    """
    from skfem import ElementLinePp

    # A new element for every set of places: it keeps what it evaluated and looks at their number only.
    element = ElementLinePp(degree)
    found = [element.lbasis(places[None], i) for i in range(degree + 1)]
    return np.stack([value for value, _ in found]), np.stack([slope[0] for _, slope in found])


def _element(order: int) -> Any:
    from skfem import ElementTriP1, ElementTriP2, ElementTriP3, ElementTriP4

    return {1: ElementTriP1, 2: ElementTriP2, 3: ElementTriP3, 4: ElementTriP4}[order]()


@lru_cache
def one_order_higher(order: int) -> Array:
    """Shape functions of an order at the nodes of the next, which has them all, shape (its nodes, functions)."""
    element, places = _element(order), _element(order + 1).doflocs.T
    return np.stack([element.lbasis(places, i)[0] for i in range(element.doflocs.shape[0])], axis=1)


def _bends(
    mesh: SectorMesh, points: Array, ends: Index, edge_of_point: Index, *, cubic: bool
) -> tuple[Array, Array, Array]:
    """How every edge, from its lower to its higher vertex, leaves its chord.

    Returns
    -------
    chord, sag : ndarray, shape (2, edges)
        From the lower vertex to the higher; from the chord's middle to the edge's middle node.
    lean : ndarray, shape (2, 2 ends, edges)
        What the exact boundary's tangents at the ends add to the quadratic edge's; 0 where they are not known.
    """
    first, second = points[:, ends[0]], points[:, ends[1]]
    middle = np.flatnonzero(edge_of_point >= 0)
    sag = np.empty_like(first)
    sag[:, edge_of_point[middle]] = points[:, middle]
    sag -= 0.5 * (first + second)
    lean = np.zeros((2, 2, ends.shape[1]))
    for name, bends in mesh.bends.items() if cubic else ():
        one, other, middle = mesh.edges[name]
        number = edge_of_point[middle]
        lean[:, :, number] = np.where(one < other, bends, bends[:, ::-1]) - 4.0 * sag[:, None, number]
    return second - first, sag, lean


def _cubic_nodes(vertices: Array, corners: Index, grid: Any, chord: Array, sag: Array, lean: Array) -> Array:
    """Nodes at a third and two thirds of every edge, then in the middle of every element, shape (2, n).

    With its ends' areal coordinates l an edge moves an element by l0 l1 (4 sag + l0 lean0 + l1 lean1).
    """
    start = vertices[:, grid.facets[0]]
    third, two_thirds = (
        start + s * chord + s * (1.0 - s) * (4.0 * sag + (1.0 - s) * lean[:, 0] + s * lean[:, 1])
        for s in (1.0 / 3.0, 2.0 / 3.0)
    )
    bulge = (12.0 * sag + lean.sum(axis=1)) / 27.0
    centre = vertices[:, corners].mean(axis=1) + bulge[:, grid.t2f].sum(axis=1)
    return np.hstack([np.stack([third, two_thirds], axis=2).reshape(2, -1), centre])
