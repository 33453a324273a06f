"""Faces of a crack that may press on each other, without friction; E = 1, lengths in modules.

The opening w of opposite nodes follows the loads as any displacement does, w_0, and the pairs of forces p that push
the faces apart: w = w_0 + C p >= 0, p >= 0, p w = 0. The answer is the least of p'C p / 2 + w_0'p over p >= 0, one and
only, and of degree one in the loads: twice the loads, twice the forces, on the same nodes. A load's own deflection
changes by w_0'p, never upward. Which nodes press depends on where the loads are and on their ratios.

Forces act at the nodes of the elements, whose shares of an even pressure are positive up to the fourth order. The tip
belongs to both faces.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.odd.cracked_sector import FACES

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index, Mask
    from fegear.fem.plane.elasticity import SectorElasticity
    from fegear.fem.plane.influence import Side
    from fegear.fem.plane.mesh import SectorMesh

#: Sets of pressed nodes that are tried one from the other, before nodes are taken one by one.
_MOST_SETS = 40
#: An opening, or a force, so small beside the largest one is none.
_NONE = 1e-12


@dataclass(frozen=True)
class CrackFaces:
    """How opposite nodes of a crack's faces open, of one kind of sector, from the mouth to the tip.

    Parameters
    ----------
    follows : ndarray, shape (N, 2m)
        Opening under motions of the sector's sides.
    by_flank : ndarray, shape (N, 2n)
        Under forces on the unknowns of its flank, the sides held.
    own : ndarray, shape (N, N)
        Under pairs of forces on the faces, the sides held.
    stress : mapping of side to ndarray, shape (points, N)
        Stress of its fillets under such pairs, the sides held.
    intensity : ndarray, shape (rings, 2, N)
        K_I and K_II of the crack under such pairs, the sides held, by each ring of integration.
    """

    follows: Array
    by_flank: Array
    own: Array
    stress: Mapping[Side, Array]
    intensity: Array


def opening_rows(mesh: SectorMesh, elasticity: SectorElasticity) -> tuple[Index, Array, Array]:
    """Opening of opposite nodes of a crack as rows of its sector's displacement.

    Returns
    -------
    unknowns : ndarray of int, shape (F,)
        Of the faces.
    rows : ndarray, shape (N, F)
        Opening per displacement of these; as a right factor, what a pair of unit forces does to them.
    places : ndarray, shape (2, N)
        Of the nodes [modules].
    """
    (_, left), (edges, right) = ((mesh.edges[name], elasticity.edge_dofs[name]) for name in FACES)
    way = mesh.points[:, edges[1]] - mesh.points[:, edges[0]]
    nodes, first = np.unique(_along(right)[0], return_index=True)
    pairs = np.stack([_along(left)[:, first], _along(right)[:, first]])  # (2 faces, 2, N + 1)
    normal = np.zeros((2, nodes.size))
    # At a bend, and at every node between two edges, the mean of both, by their lengths.
    each = np.searchsorted(nodes, right[0]).ravel()
    for component, part in enumerate((-way[1], way[0])):
        normal[component] = np.bincount(each, np.broadcast_to(part, right[0].shape).ravel(), nodes.size)
    normal /= np.hypot(*normal)
    apart = pairs[0, 0] != pairs[1, 0]
    order = np.argsort(first[apart], kind="stable")
    pairs, normal = pairs[:, :, apart][:, :, order], normal[:, apart][:, order]
    unknowns = np.unique(pairs)
    rows, each = np.zeros((normal.shape[1], unknowns.size)), np.arange(normal.shape[1])
    for sign, face in zip((1.0, -1.0), pairs, strict=True):
        for component in range(2):
            rows[each, np.searchsorted(unknowns, face[component])] = sign * normal[component]
    places = _places(mesh, elasticity.order)[:, first][:, apart][:, order]
    return unknowns, rows, places


def _places(mesh: SectorMesh, order: int) -> Array:
    """Places of the nodes of the right face's edges one after the other, shape (2, nodes) [modules]."""
    s = np.linspace(0.0, 1.0, order + 1)
    start, end, middle = mesh.points[:, mesh.edges[FACES[1]]].transpose(1, 0, 2)[:, :, :, None]
    along = start * (1.0 - s) * (1.0 - 2.0 * s) + end * s * (2.0 * s - 1.0) + 4.0 * middle * s * (1.0 - s)
    return np.asarray(along.reshape(2, -1))


def _along(unknowns: Index) -> Index:
    """Unknowns (x and y) of the nodes of edges one after the other, shape (2, nodes)."""
    return unknowns.transpose(0, 2, 1).reshape(2, -1)


def pressed(compliance: Array, opening: Array) -> Array:
    """Forces with which the faces of a crack press on each other, shape (N, P).

    Parameters
    ----------
    compliance : ndarray, shape (N, N)
        C, opening under pairs of forces; symmetric, positive definite.
    opening : ndarray, shape (N, P)
        w_0 of faces that do not feel each other, by load.
    """
    found = np.zeros(opening.shape)
    # Nodes near the tip open little: in units of their own compliance all count alike.
    unit = 1.0 / np.sqrt(np.diagonal(compliance))
    scaled = compliance * unit * unit[:, None]
    w = opening * unit[:, None]
    size = np.abs(w).max(axis=0, initial=0.0)
    todo = np.flatnonzero((w < -_NONE * size).any(axis=0))
    w = w[:, todo] / size[todo]
    closed = w < 0.0
    for _ in range(_MOST_SETS):
        if not todo.size:
            return found
        force = shut_by(scaled, closed, -w)
        gap = w + scaled @ force
        slack = _NONE * np.maximum(1.0, np.abs(force).max(axis=0))
        after = np.where(closed, force > slack, gap < -_NONE)
        left = (after != closed).any(axis=0)
        found[:, todo[~left]] = size[todo[~left]] * unit[:, None] * force[:, ~left]
        todo, w, closed = todo[left], w[:, left], after[:, left]
    for load, opened in zip(todo, w.T, strict=True):
        found[:, load] = size[load] * unit * _one_by_one(scaled, opened)
    return found


def _one_by_one(compliance: Array, opening: Array) -> Array:
    """Forces of one load whose largest opening is one, nodes taken one by one."""
    from scipy.optimize import nnls

    factor = np.linalg.cholesky(compliance)
    closed = nnls(factor.T, -np.linalg.solve(factor, opening))[0] > 0.0
    return np.asarray(np.maximum(shut_by(compliance, closed[:, None], -opening[:, None])[:, 0], 0.0))


def shut_by(compliance: Array, closed: Mask, opened: Array) -> Array:
    """Forces at closed nodes, of either sign, that open them by so much; zero at the others.

    Parameters
    ----------
    compliance : ndarray, shape (N, N)
    closed : ndarray of bool, shape (N, P)
    opened : ndarray, shape (N, ..., P)

    Returns
    -------
    ndarray, shape (N, ..., P)
    """
    found = np.zeros(opened.shape)
    _, which = np.unique(np.packbits(closed, axis=0), axis=1, return_inverse=True)
    which = which.ravel()
    order = np.argsort(which, kind="stable")
    for alike in np.split(order, np.flatnonzero(np.diff(which[order])) + 1) if order.size else ():
        at = np.flatnonzero(closed[:, alike[0]])
        if at.size:
            right = opened[at][..., alike]
            forces = np.linalg.solve(compliance[np.ix_(at, at)], right.reshape(at.size, -1))
            found[np.ix_(at, *(np.arange(n) for n in opened.shape[1:-1]), alike)] = forces.reshape(right.shape)
    return found
