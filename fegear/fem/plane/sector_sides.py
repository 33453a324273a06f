"""A sector between its two sides: condensed onto them and its ports, which are then free.

Whatever the sector is made of, its neighbours see the 2 m x 2 m stiffness between its sides alone. Sectors of unlike
insides fit together as long as the nodes of their sides are the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from fegear.base.arrays import Array, Index, Mask
from fegear.base.errors import InputError
from fegear.fem.plane.chain import factored
from fegear.fem.plane.condensation import Condensed, condense, symmetric
from fegear.fem.plane.elasticity import SectorElasticity
from fegear.fem.plane.mesh import SectorMesh


@dataclass(frozen=True)
class BetweenSides:
    """A condensed sector between its sides, its ports free: u = A a + B b + G f of its ports.

    Parameters
    ----------
    sector : Condensed
        Its `kept` are the ports, the sides first.
    follow_a, follow_b : ndarray, shape (ports, m)
        A and B: how a port follows the motions a and b of sides A and B, in components that agree between neighbours.
    own : ndarray, shape (ports, ports)
        G, ports' motion under forces on ports with the sides held; symmetric, zero for the sides.
    held : ndarray, shape (2 m, 2 m)
        Stiffness between the sides.
    """

    sector: Condensed
    follow_a: Array
    follow_b: Array
    own: Array
    held: Array


def ports_of(sector: Condensed, unknowns: Index) -> Index:
    """Where unknowns stand among the ports of a condensed sector."""
    order = np.argsort(sector.kept)
    place = np.minimum(np.searchsorted(sector.kept, unknowns, sorter=order), order.size - 1)
    found = order[place]
    if (sector.kept[found] != unknowns).any():
        raise ValueError("loads and displacements are possible at ports of the ring only")
    return found


def condensed_sector(
    mesh: SectorMesh,
    elasticity: SectorElasticity,
    ports: Index,
    *,
    expandable: bool = False,
    motions: Array | None = None,
    sectors: int = 1,
) -> tuple[Condensed, int, Array, Array]:
    """Condense a sector onto its sides and ports.

    Parameters
    ----------
    mesh, elasticity, ports, expandable, motions
        As for `close_ring`.
    sectors : int
        So many of the ring's in one mesh.

    Returns
    -------
    sector : Condensed
    side : int
        m, unknowns of one side that are not held.
    turn : ndarray, shape (2 m, 2 m)
        From polar components, which agree between neighbours, to the sector's own.
    radius : ndarray
        Of a side's nodes [modules].

    Raises
    ------
    InputError
        If the sides do not match node by node.
    """
    side_a, side_b, angle_a, radius = _matching_sides(mesh, elasticity, sectors)
    bore = np.unique(elasticity.edge_dofs["bore"]) if motions is None else np.zeros(0, dtype=np.int64)
    free = ~np.isin(side_a, bore)
    side_a, side_b, angle_a = side_a[free], side_b[free], angle_a[free[::2]]
    sides = np.concatenate([side_a, side_b])
    inner = np.setdiff1d(ports, np.concatenate([bore, sides]))
    sector = condense(elasticity, np.concatenate([sides, inner]), bore, expandable=expandable)
    if motions is not None:
        q = np.linalg.qr(motions[sector.kept])[0]
        off = sector.stiffness @ q
        stiffness = sector.stiffness - off @ q.T - q @ off.T + q @ (q.T @ off) @ q.T
        sector = replace(sector, stiffness=0.5 * (stiffness + stiffness.T))
    m, n = side_a.size, sides.size
    turn = np.zeros((n, n))
    turn[:m, :m], turn[m:, m:] = _polar(angle_a), _polar(angle_a + 2.0 * np.pi * sectors / mesh.teeth)
    return sector, m, turn, radius


def bore_of_side(mesh: SectorMesh, elasticity: SectorElasticity) -> Mask:
    """Which unknowns of a side, in the order of a condensed sector whose bore is free, are on the bore."""
    side_a = _matching_sides(mesh, elasticity)[0]
    return np.isin(side_a, np.unique(elasticity.edge_dofs["bore"]))


def between_sides(sector: Condensed, side: int, turn: Array | None) -> BetweenSides:
    """Free the ports of a condensed sector.

    Parameters
    ----------
    sector, side, turn
        As for `closed_ring`.

    Raises
    ------
    FegearError
        If the stiffness is not positive definite.
    """
    from scipy.linalg import lapack

    m, n = side, 2 * side
    S = sector.stiffness
    own = np.zeros(S.shape)  # of which the rows of sides are never touched
    if n < S.shape[0]:
        own[n:, n:] = symmetric(cast("Array", lapack.dpotri(factored(S[n:, n:]), lower=1, overwrite_c=1)[0]))
    turned = S[:, :n] if turn is None else S[:, :n] @ turn
    follow = np.vstack([np.eye(n) if turn is None else turn, -own[n:, n:] @ turned[n:]])
    held = turned[:n] + S[:n, n:] @ follow[n:]
    if turn is not None:
        held = turn.T @ held
    return BetweenSides(sector, follow[:, :m], follow[:, m:], own, 0.5 * (held + held.T))


def _polar(angle: Array) -> Array:
    """Matrix from polar components (radial, clockwise tangential) of nodes at clockwise angles to x and y, (2n, 2n)."""
    n = angle.size
    matrix = np.zeros((2 * n, 2 * n))
    i = 2 * np.arange(n)
    s, c = np.sin(angle), np.cos(angle)
    matrix[i, i], matrix[i, i + 1] = s, c
    matrix[i + 1, i], matrix[i + 1, i + 1] = c, -s
    return matrix


def _matching_sides(
    mesh: SectorMesh, elasticity: SectorElasticity, sectors: int = 1
) -> tuple[Index, Index, Array, Array]:
    """Unknowns of both sides, ascending from the axis, and the clockwise angles and radii of side A's nodes."""
    both = []
    for name in ("side_a", "side_b"):
        edges, dofs = mesh.edges[name], elasticity.edge_dofs[name]
        radius = np.hypot(*mesh.points[:, edges[:2]])
        outward = radius[0] < radius[1]
        dofs = np.where(outward, dofs, dofs[:, ::-1])
        lower = np.where(outward, radius[0], radius[1])
        sequence = np.argsort(lower)
        dofs = dofs[:, :, sequence]
        run = np.concatenate([dofs[:, :1, 0], dofs[:, 1:, :].transpose(0, 2, 1).reshape(2, -1)], axis=1)
        ends = np.sort(radius.min(axis=0)), np.sort(radius.max(axis=0))
        if not np.allclose(ends[0][1:], ends[1][:-1], rtol=1e-6):
            raise InputError("mesh", name, "is not one unbroken line from the bore to the outline")
        angles = np.arctan2(*mesh.points[:, edges[:2]])
        both.append((run.T.reshape(-1), ends, float(angles.mean())))
    (dofs_a, ends_a, angle_a), (dofs_b, ends_b, angle_b) = both
    if dofs_a.size != dofs_b.size or not np.allclose(ends_a, ends_b, rtol=1e-6):
        raise InputError(
            "mesh",
            "side_a, side_b",
            "have different nodes, so that sectors cannot be joined",
            "mesh side_b as side_a rotated by one pitch",
        )
    pitch = 2.0 * np.pi * sectors / mesh.teeth
    if abs(angle_b - angle_a - pitch) > 1e-6:
        raise InputError(
            "mesh", f"{angle_b - angle_a:.8g} rad between the sides", f"must be one pitch, {pitch:.8g} rad"
        )
    low, high = ends_a
    steps = np.arange(1, elasticity.order + 1) / elasticity.order
    radius = np.append(low[0], (low[:, None] + (high - low)[:, None] * steps).ravel())
    return dofs_a, dofs_b, np.full(dofs_a.size // 2, angle_a), radius
