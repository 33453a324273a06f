"""Loads and deflections along the loaded flank as vectors over its unknowns.

A contact is a semi-elliptic pressure of half-width a, acting against the surface's normal. With s = a sin(theta) its
share of the load is (2/pi) cos^2(theta) dtheta, so that Gauss quadrature on each edge is exact to round-off in spite
of the square roots at the ends of the patch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.sparse import csr_array

    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.geometry.involute_side import InvoluteSide
    from fegear.geometry.tooth_side import ToothSide

_GAUSS = np.polynomial.legendre.leggauss(6)


def lagrange(order: int, xi: Array) -> Array:
    """Lagrange polynomials on equally spaced nodes of [0, 1], shape (order + 1, *xi.shape)."""
    nodes = np.linspace(0.0, 1.0, order + 1)
    off = np.stack([xi - node for node in nodes])
    values = np.empty_like(off)
    # All factors before each, then all behind it.
    below = np.full(np.shape(xi), order**order / math.factorial(order))
    for i in range(order + 1):
        values[i] = below
        below = below * off[i]
    above = np.ones(np.shape(xi))
    for i in reversed(range(order + 1)):
        values[i] *= (-1.0) ** (order - i) * math.comb(order, i) * above
        above = above * off[i]
    return values


def lagrange_slope(order: int, xi: Array) -> Array:
    """Derivatives of `lagrange` with respect to xi, same shape."""
    nodes = np.linspace(0.0, 1.0, order + 1)
    values = np.zeros((order + 1, *np.shape(xi)))
    for i in range(order + 1):
        for m in range(order + 1):
            if m == i:
                continue
            term = np.full(np.shape(xi), 1.0 / (nodes[i] - nodes[m]))
            for j in range(order + 1):
                if j not in (i, m):
                    term = term * (xi - nodes[j]) / (nodes[i] - nodes[j])
            values[i] += term
    return values


def quadratic_edge(points: Array, xi: Array) -> tuple[Array, Array]:
    """Positions and tangents dx/dxi on quadratic edges.

    Parameters
    ----------
    points : ndarray, shape (2, 3, n)
        First vertex, second vertex, middle node.
    xi : ndarray, shape (q,)

    Returns
    -------
    position, tangent : ndarray, shape (2, n, q)
    """
    shape = np.array([(1 - xi) * (1 - 2 * xi), xi * (2 * xi - 1), 4 * xi * (1 - xi)])
    slope = np.array([4 * xi - 3, 4 * xi - 1, 4 - 8 * xi])
    return np.einsum("cin,iq->cnq", points, shape), np.einsum("cin,iq->cnq", points, slope)


Scalar = TypeVar("Scalar", bound=np.generic)


@dataclass(frozen=True)
class LoadedFlank:
    """The run of edges on which a contact may press: the flank, and the fillet just below it.

    It runs from the fillet to the tip: outward on an external tooth, inward on an internal one, whose material then
    lies on the other side of the run.

    Parameters
    ----------
    dofs : ndarray of int, shape (2 n_nodes,)
        Unknowns of the run's nodes, all x first, then all y.
    points : ndarray, shape (2, 3, n)
        Quadratic edges, from the fillet to the tip.
    arc : ndarray, shape (n + 1,)
        Arc length at the edges' ends [modules].
    first_flank_edge, after_flank_edge : int
        The edges before the first belong to the fillet, those from the second on to the tip rounding.
    roll_squared : ndarray, shape (n_flank + 1,)
        Squared roll angles of the flank's vertices: on an involute the arc length is linear in them.
    base_radius : float
        [modules].
    order : int
    lower_corner, upper_corner : bool
        Whether the flank starts in a corner (undercut) instead of running smoothly into the fillet, and whether it
        ends in one instead of running smoothly into a tip rounding.
    side : {1, -1}
        Of an external or an internal tooth.
    """

    dofs: Index
    points: Array
    arc: Array
    first_flank_edge: int
    after_flank_edge: int
    roll_squared: Array
    base_radius: float
    order: int
    lower_corner: bool
    upper_corner: bool
    side: int = 1

    @property
    def flank_start(self) -> float:
        """Arc length at which the flank starts [modules]."""
        return float(self.arc[self.first_flank_edge])

    @property
    def flank_end(self) -> float:
        """Arc length at which the flank ends [modules]."""
        return float(self.arc[self.after_flank_edge])

    @property
    def beyond(self) -> float:
        """Length of the run beyond the flank's end, on a tip rounding [modules]; 0 at a corner."""
        return 0.0 if self.upper_corner else float(self.arc[-1]) - self.flank_end

    @cached_property
    def base_half_angle(self) -> float:
        """Angle from the tooth's centre line at which the involute leaves the base circle [rad]."""
        x, y = self.points[:, 1, self.after_flank_edge - 1]
        roll = math.sqrt(self.roll_squared[-1])
        return math.atan2(x, y) + self.side * roll - self.side * math.atan(roll)

    @property
    def nodes(self) -> int:
        """Number of Lagrange nodes along the run."""
        return self.dofs.size // 2

    @property
    def lowest_radius(self) -> float:
        """Radius at which the flank starts, or an internal one ends [modules]."""
        return float(self.base_radius * np.sqrt(1.0 + min(self.roll_squared[0], self.roll_squared[-1])))

    @property
    def highest_radius(self) -> float:
        """Radius at which the flank ends, or an internal one starts [modules]."""
        return float(self.base_radius * np.sqrt(1.0 + max(self.roll_squared[0], self.roll_squared[-1])))

    def arc_of_radius(self, radius: Array) -> Array:
        """Arc length along the run of flank points at `radius` [modules].

        Raises
        ------
        RangeError
            If a radius lies off the flank.
        """
        r = np.asarray(radius, dtype=float)
        low, high = self.lowest_radius, self.highest_radius
        slack = 1e-7 * high
        if r.size and not (r.min() >= low - slack and r.max() <= high + slack):
            off = r[~((r >= low - slack) & (r <= high + slack))][0]
            raise RangeError("radius", f"{off:.8g} modules", f"is outside the flank, {low:.8g} to {high:.8g}")
        roll_squared = np.maximum(r * r / self.base_radius**2 - 1.0, 0.0)
        run = self.arc[self.first_flank_edge : self.after_flank_edge + 1]
        return np.interp(self.side * roll_squared, self.side * self.roll_squared, run)

    def radius_of_arc(self, arc: Array) -> Array:
        """Radius of flank points, the reverse of `arc_of_radius` [modules]."""
        run = self.arc[self.first_flank_edge : self.after_flank_edge + 1]
        return np.asarray(self.base_radius * np.sqrt(1.0 + np.interp(arc, run, self.roll_squared)))

    def _normal(self, edge: Index, xi: Array) -> Array:
        """Unit vectors into the material at places of edges, shape (2, *xi.shape)."""
        on_flank = (edge >= self.first_flank_edge) & (edge < self.after_flank_edge)
        normal = np.empty((2, *xi.shape))
        normal[:, on_flank] = self._normal_on_flank(edge[on_flank] - self.first_flank_edge, xi[on_flank])
        if not on_flank.all():
            off = ~on_flank
            beside = xi[off]
            slope = np.stack([4 * beside - 3, 4 * beside - 1, 4 - 8 * beside])
            tangent = np.einsum("cin,in...->cn...", self.points[:, :, edge[off]], slope)
            normal[:, off] = self.side * np.stack([-tangent[1], tangent[0]]) / np.hypot(*tangent)
        return normal

    def _normal_on_flank(self, edge: Index, along: Array) -> Array:
        """The involute's: tangent to the base circle, so that a load's torque is exactly the base radius times it."""
        low, high = (self.roll_squared[i].reshape(-1, *[1] * (along.ndim - 1)) for i in (edge, edge + 1))
        phi = self.base_half_angle - self.side * np.sqrt(np.maximum(low + (high - low) * along, 0.0))
        return np.stack([-np.cos(phi), np.sin(phi)])

    @cached_property
    def _normal_at_end(self) -> Array:
        """Unit vector into the material at the end of the flank's last edge, shape (2, 1)."""
        return self._normal(np.array([self.after_flank_edge - 1]), np.array([1.0]))

    def patches(self, arc: Array, half_width: Array) -> Array:
        """Unknown-wise loads of unit contacts centred at `arc` with half-widths a.

        Parameters
        ----------
        arc, half_width : ndarray, shape (P,)
            [modules]; a patch that crosses an end of the run is cut off there and scaled to unit load.

        Returns
        -------
        ndarray, shape (2 nodes, P)
            Total force one, against the normals of fillet and flank, beyond the flank's end against the normal there
            (a patch that reaches over a tip rounding must not turn with it). As a left factor it is the
            pressure-weighted mean deflection.
        """
        edge, position, along = self._pushed(arc, half_width)
        count = np.size(arc)
        return np.concatenate([self._summed(edge, position, one, count) for one in along])

    def few_patches(self, arc: Array, half_width: Array) -> csr_array:
        """As `patches`, transposed and without its zeros: a contact presses on some seventeen of five hundred nodes.

        Parameters
        ----------
        arc, half_width : ndarray, shape (P,)

        Returns
        -------
        csr_array, shape (P, 2 nodes)
        """
        from scipy.sparse import csr_array

        edge, position, along = self._pushed(arc, half_width)
        node = edge[:, None] * self.order + np.arange(self.order + 1)
        column = np.stack([node, node + self.nodes])
        row = np.broadcast_to(position[:, None], column.shape)
        values = np.moveaxis(along, 1, 2)
        shape = (np.size(arc), 2 * self.nodes)
        return csr_array((values.ravel(), (row.ravel(), column.ravel())), shape=shape)

    def _pushed(self, arc: Array, half_width: Array) -> tuple[Index, Index, Array]:
        """Edges and contacts as of `_pressed`, and what they give the nodes, shape (2, order + 1, n)."""
        edge, position, xi, weight = self._pressed(arc, half_width)
        inward = self._normal(edge, xi)
        # of the flank's last edge: a small rounding may be a single edge, whose own tangent there is degrees off
        beyond = edge >= self.after_flank_edge
        if beyond.any():
            inward[:, beyond] = self._normal_at_end[:, :, None]
        shape = lagrange(self.order, xi) * weight
        return edge, position, np.matmul(shape.transpose(1, 0, 2), inward.transpose(1, 2, 0)).transpose(2, 1, 0)

    def normal_patches(self, arc: Array, half_width: Array) -> Array:
        """Shares of the run's nodes in unit contacts, shape (nodes, P): loads on unknowns against the flank's normal.

        Parameters
        ----------
        arc, half_width : ndarray, shape (P,)
            As for `patches`.
        """
        edge, position, xi, weight = self._pressed(arc, half_width)
        return self._summed(edge, position, (lagrange(self.order, xi) * weight).sum(axis=2), np.size(arc))

    def _pressed(self, arc: Array, half_width: Array) -> tuple[Index, Index, Array, Array]:
        """Gauss points of contacts' pressures on the edges under them.

        Returns
        -------
        edge, position : ndarray of int, shape (n,)
            Edge, and number of the contact.
        xi, weight : ndarray, shape (n, q)
            Places on the edge; shares of a load that is one in total.
        """
        s, a = np.atleast_1d(arc), np.broadcast_to(half_width, np.shape(np.atleast_1d(arc)))
        bounds = np.arcsin(np.clip((self.arc[:, None] - s) / a, -1.0, 1.0))  # (n + 1, P)
        half = 0.5 * (bounds[1:] - bounds[:-1])
        edge, position = np.nonzero(half > 0.0)
        h = half[edge, position][:, None]
        theta = 0.5 * (bounds[1:] + bounds[:-1])[edge, position][:, None] + h * _GAUSS[0]
        weight = h * _GAUSS[1] * (2.0 / np.pi) * np.cos(theta) ** 2
        length = np.diff(self.arc)[edge][:, None]
        xi = (s[position][:, None] + a[position][:, None] * np.sin(theta) - self.arc[edge][:, None]) / length
        total = np.bincount(position, weight.sum(axis=1), s.size)
        return edge, position, xi, weight / total[position][:, None]

    def _summed(self, edge: Index, position: Index, values: Array, count: int) -> Array:
        """Sum what the edges under contacts give their nodes, (order + 1, n), over contacts: shape (nodes, P)."""
        place = (edge * self.order + np.arange(self.order + 1)[:, None]) * count + position
        loads = np.bincount(place.ravel(), np.ascontiguousarray(values).ravel(), self.nodes * count)
        return np.asarray(loads.reshape(self.nodes, count), dtype=float)


class BoundaryUnknowns(Protocol):
    """Unknowns along named boundaries, as `SectorElasticity` has them."""

    @property
    def edge_dofs(self) -> dict[str, Index]:
        """Unknowns (x and y) of the nodes along each edge, from its first to its second vertex."""

    @property
    def order(self) -> int:
        """Order of the elements."""


@dataclass(frozen=True)
class LoadedRun:
    """The run of edges of a loaded flank, whatever curve the flank is; fields as of `LoadedFlank`."""

    dofs: Index
    points: Array
    arc: Array
    first_flank_edge: int
    after_flank_edge: int
    upper_corner: bool

    @property
    def vertices(self) -> Array:
        """Ends of the flank's edges from the fillet to the tip, shape (2, n_flank + 1) [modules]."""
        first, after = self.first_flank_edge, self.after_flank_edge
        return np.concatenate([self.points[:, :1, first], self.points[:, 1, first:after]], axis=1)


def loaded_run(mesh: SectorMesh, elasticity: BoundaryUnknowns, tooth: ToothSide, margin: float) -> LoadedRun:
    """Collect the right flank, and `margin` [modules] of a smooth fillet or tip rounding beside it."""

    def upward(name: str) -> tuple[Index, Index, Array]:
        edges, dofs = toward_tip(mesh, elasticity.edge_dofs[name], name, tooth.side)
        return edges, dofs, np.hypot(*(mesh.points[:, edges[1]] - mesh.points[:, edges[0]]))

    edges, dofs, _ = upward("flank")
    first, after = 0, edges.shape[1]
    if not tooth.undercut:
        more, more_dofs, lengths = upward("fillet")
        near = np.cumsum(lengths[::-1])[::-1] - lengths < margin
        edges, dofs = np.hstack([more[:, near], edges]), np.concatenate([more_dofs[:, :, near], dofs], axis=2)
        first = int(near.sum())
        after += first
    rounded = "tip_rounding" in mesh.edges
    if rounded:
        more, more_dofs, lengths = upward("tip_rounding")
        near = np.cumsum(lengths) - lengths < margin
        edges, dofs = np.hstack([edges, more[:, near]]), np.concatenate([dofs, more_dofs[:, :, near]], axis=2)
    points = mesh.points[:, edges]
    run = np.concatenate([dofs[:, :1, 0], dofs[:, 1:, :].transpose(0, 2, 1).reshape(2, -1)], axis=1)
    _, tangent = quadratic_edge(points, 0.5 + 0.5 * _GAUSS[0])
    lengths = (np.hypot(*tangent) * 0.5 * _GAUSS[1]).sum(axis=1)
    arc = np.concatenate([[0.0], np.cumsum(lengths)])
    return LoadedRun(run.reshape(-1), points, arc, first, after, upper_corner=not rounded)


def loaded_flank(mesh: SectorMesh, elasticity: BoundaryUnknowns, tooth: InvoluteSide, margin: float) -> LoadedFlank:
    """Collect the loaded run of a gear's tooth, as `loaded_run`."""
    run, rb = loaded_run(mesh, elasticity, tooth, margin), tooth.base_radius
    return LoadedFlank(
        dofs=run.dofs,
        points=run.points,
        arc=run.arc,
        first_flank_edge=run.first_flank_edge,
        after_flank_edge=run.after_flank_edge,
        roll_squared=np.maximum(np.hypot(*run.vertices) ** 2 / rb**2 - 1.0, 0.0),
        base_radius=rb,
        order=elasticity.order,
        lower_corner=tooth.undercut,
        upper_corner=run.upper_corner,
        side=tooth.side,
    )


def toward_tip(mesh: SectorMesh, along: NDArray[Scalar], name: str, side: int) -> tuple[Index, NDArray[Scalar]]:
    """Edges of a boundary from the root to the tip, and what is known along them, (c, nodes, n), in the same order."""
    edges = mesh.edges[name]
    first, second, middle = (side * mesh.outward(mesh.points[:, ends]) for ends in edges)
    # The middle node decides for edges whose ends lie on the root circle alike.
    onward, order = first < second, np.argsort(middle)
    edges = np.where(onward, edges, edges[[1, 0, 2]])[:, order]
    return edges, np.where(onward, along, along[:, ::-1])[:, :, order]
