"""Loads and deflections along the loaded flank as vectors over its unknowns.

A contact is a semi-elliptic pressure of half-width a, acting against the surface's normal. With s = a sin(theta) its
share of the load is (2/pi) cos^2(theta) dtheta, so that Gauss quadrature on each edge is exact to round-off in spite of
the square roots at the ends of the patch.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.fem.elasticity import SectorElasticity
    from fegear.fem.mesh import SectorMesh
    from fegear.geometry.tooth import Tooth

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

_GAUSS = np.polynomial.legendre.leggauss(6)


def lagrange(order: int, xi: Array) -> Array:
    """Lagrange polynomials on equally spaced nodes of [0, 1], shape (order + 1, *xi.shape)."""
    nodes = np.linspace(0.0, 1.0, order + 1)
    values = np.ones((order + 1, *np.shape(xi)))
    for i in range(order + 1):
        for j in range(order + 1):
            if i != j:
                values[i] *= (xi - nodes[j]) / (nodes[i] - nodes[j])
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


@dataclass(frozen=True)
class LoadedFlank:
    """The run of edges on which a contact may press: the flank, and the fillet just below it.

    Parameters
    ----------
    dofs : ndarray of int, shape (2 n_nodes,)
        Unknowns of the run's nodes, all x first, then all y.
    points : ndarray, shape (2, 3, n)
        Quadratic edges, from the fillet to the tip.
    arc : ndarray, shape (n + 1,)
        Arc length at the edges' ends [modules].
    first_flank_edge : int
        The edges before it belong to the fillet.
    roll_squared : ndarray, shape (n_flank + 1,)
        Squared roll angles of the flank's vertices: on an involute the arc length is linear in them.
    base_radius : float
        [modules].
    order : int
    lower_corner : bool
        Whether the flank starts in a corner (undercut) instead of running smoothly into the fillet.
    """

    dofs: Index
    points: Array
    arc: Array
    first_flank_edge: int
    roll_squared: Array
    base_radius: float
    order: int
    lower_corner: bool

    @property
    def flank_start(self) -> float:
        """Arc length at which the flank starts [modules]."""
        return float(self.arc[self.first_flank_edge])

    @property
    def nodes(self) -> int:
        """Number of Lagrange nodes along the run."""
        return self.dofs.size // 2

    @property
    def lowest_radius(self) -> float:
        """Radius at which the flank starts [modules]."""
        return float(self.base_radius * np.sqrt(1.0 + self.roll_squared[0]))

    @property
    def highest_radius(self) -> float:
        """Radius at which the flank ends [modules]."""
        return float(self.base_radius * np.sqrt(1.0 + self.roll_squared[-1]))

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
        if r.size and (r.min() < low - slack or r.max() > high + slack):
            off = r[(r < low - slack) | (r > high + slack)][0]
            raise RangeError(
                "radius", f"{off:.8g} modules", f"lies off the flank, which runs from {low:.8g} to {high:.8g}"
            )
        roll_squared = np.maximum(r * r / self.base_radius**2 - 1.0, 0.0)
        return np.interp(roll_squared, self.roll_squared, self.arc[self.first_flank_edge :])

    def patches(self, arc: Array, half_width: Array) -> Array:
        """Unknown-wise loads of unit contacts centred at `arc` with half-widths a.

        Parameters
        ----------
        arc, half_width : ndarray, shape (P,)
            [modules]; a patch that crosses an end of the run is cut off there and scaled to unit load.

        Returns
        -------
        ndarray, shape (2 nodes, P)
            Total force one along minus the normal; as a left factor it is the pressure-weighted mean deflection.
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
        slope = np.stack([4 * xi - 3, 4 * xi - 1, 4 - 8 * xi])
        tangent = np.einsum("cin,inq->cnq", self.points[:, :, edge], slope)
        inward = np.stack([-tangent[1], tangent[0]]) / np.hypot(*tangent)
        shape = lagrange(self.order, xi)  # (order + 1, pairs, q)
        values = np.einsum("inq,cnq,nq->cni", shape, inward, weight)
        loads = np.zeros((2, self.nodes, s.size))
        node = edge[:, None] * self.order + np.arange(self.order + 1)
        for c in range(2):
            np.add.at(loads[c], (node, position[:, None]), values[c])
        total = np.zeros(s.size)
        np.add.at(total, position, weight.sum(axis=1))
        return loads.reshape(2 * self.nodes, -1) / total

    def deflections_at(self, arc: Array) -> Array:
        """Vectors that pick the deflection against the normal at points of the run, shape (2 nodes, P)."""
        s = np.atleast_1d(arc)
        edge = np.clip(np.searchsorted(self.arc, s, side="right") - 1, 0, self.arc.size - 2)
        xi = (s - self.arc[edge]) / np.diff(self.arc)[edge]
        slope = np.stack([4 * xi - 3, 4 * xi - 1, 4 - 8 * xi])
        tangent = np.einsum("cin,in->cn", self.points[:, :, edge], slope)
        inward = np.stack([-tangent[1], tangent[0]]) / np.hypot(*tangent)
        shape = lagrange(self.order, xi)
        picks = np.zeros((2, self.nodes, s.size))
        node = edge * self.order + np.arange(self.order + 1)[:, None]
        for c in range(2):
            picks[c, node, np.arange(s.size)] = shape * inward[c]
        return picks.reshape(2 * self.nodes, -1)


def loaded_flank(mesh: SectorMesh, elasticity: SectorElasticity, tooth: Tooth, margin: float) -> LoadedFlank:
    """Collect the loaded run: the right flank, and `margin` [modules] of the fillet below it where that is smooth."""
    flank_order = np.argsort(np.hypot(*mesh.points[:, mesh.edges["flank"][2]]))
    pieces = [(mesh.edges["flank"][:, flank_order], elasticity.edge_dofs["flank"][:, :, flank_order])]
    if not tooth.undercut:
        fillet = mesh.edges["fillet"]
        order = np.argsort(np.hypot(*mesh.points[:, fillet[2]]))
        lengths = np.hypot(*(mesh.points[:, fillet[1]] - mesh.points[:, fillet[0]]))[order]
        below = np.cumsum(lengths[::-1])[::-1] - lengths < margin
        pieces.insert(0, (fillet[:, order[below]], elasticity.edge_dofs["fillet"][:, :, order[below]]))
    edges = np.hstack([piece[0] for piece in pieces])
    dofs = np.concatenate([piece[1] for piece in pieces], axis=2)
    points = mesh.points[:, edges]
    run = np.concatenate([dofs[:, :1, 0], dofs[:, 1:, :].transpose(0, 2, 1).reshape(2, -1)], axis=1)
    _, tangent = quadratic_edge(points, 0.5 + 0.5 * _GAUSS[0])
    lengths = (np.hypot(*tangent) * 0.5 * _GAUSS[1]).sum(axis=1)
    first = pieces[0][0].shape[1] if len(pieces) > 1 else 0
    vertices = np.hypot(*np.concatenate([points[:, :1, first], points[:, 1, first:]], axis=1))
    rb = tooth.base_radius
    return LoadedFlank(
        dofs=run.reshape(-1),
        points=points,
        arc=np.concatenate([[0.0], np.cumsum(lengths)]),
        first_flank_edge=first,
        roll_squared=np.maximum(vertices**2 / rb**2 - 1.0, 0.0),
        base_radius=rb,
        order=elasticity.order,
        lower_corner=tooth.undercut,
    )
