"""The Lagrange triangle of order 2 to 4: its nodes, shape functions and quadrature on the reference triangle."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class Triangle:
    """Lagrange polynomials on equally spaced nodes of the triangle (0, 0), (1, 0), (0, 1).

    Nodes: the three vertices; then those inside the edges 0-1, 1-2 and 2-0, in that direction; then those inside.

    Attributes
    ----------
    order : int
    nodes : ndarray, shape (2, n)
    coefficients : ndarray, shape (n, n)
        Of the monomials u^a v^b (rows) in each shape function (columns).
    powers : ndarray of int, shape (n, 2)
    """

    order: int
    nodes: Array
    coefficients: Array
    powers: NDArray[np.int64]

    def slopes(self, u: Array, v: Array) -> Array:
        """Derivatives of the shape functions along u and v at points, shape (2, points, n)."""
        a, b = self.powers[:, 0], self.powers[:, 1]
        along_u = a * u[:, None] ** np.maximum(a - 1, 0) * v[:, None] ** b
        along_v = b * u[:, None] ** a * v[:, None] ** np.maximum(b - 1, 0)
        return np.stack([along_u @ self.coefficients, along_v @ self.coefficients])


@functools.cache
def triangle(order: int) -> Triangle:
    """Return the Lagrange triangle of an order."""
    steps = range(1, order)
    nodes = [(0, 0), (order, 0), (0, order)]
    nodes += [(i, 0) for i in steps] + [(order - i, i) for i in steps] + [(0, order - i) for i in steps]
    nodes += [(i, j) for j in steps for i in steps if i + j < order]
    places = np.array(nodes, dtype=float).T / order
    powers = np.array([(a, b) for a in range(order + 1) for b in range(order + 1 - a)])
    monomials = places[0][:, None] ** powers[:, 0] * places[1][:, None] ** powers[:, 1]
    return Triangle(order, places, np.linalg.inv(monomials), powers)


@functools.cache
def quadrature(points: int) -> tuple[Array, Array, Array]:
    """Gauss points u, v and weights on the reference triangle, exact to degree 2 points - 1.

    The square's rule folded onto the triangle (Stroud, Approximate Calculation of Multiple Integrals, 1971, 2.4):
    Gauss-Jacobi toward the vertex where the sides meet, Gauss-Legendre across.
    """
    across, across_weight = np.polynomial.legendre.leggauss(points)
    # Gauss points for the weight (1 - s) on [0, 1] (Golub and Welsch: Jacobi polynomials with alpha = 1, beta = 0).
    k = np.arange(points, dtype=float)
    diagonal = -1.0 / ((2 * k + 1) * (2 * k + 3))
    j = k[1:]
    off = np.sqrt(j * (j + 1.0)) / (2 * j + 1)
    toward, vectors = np.linalg.eigh(np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1))
    s, s_weight = 0.5 * (toward + 1.0), 0.5 * vectors[0] ** 2
    t, t_weight = 0.5 * (across + 1.0), 0.5 * across_weight
    u, v = np.repeat(s, points), np.outer(1.0 - s, t).reshape(-1)
    return u, v, np.outer(s_weight, t_weight).reshape(-1)
