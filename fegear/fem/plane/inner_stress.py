"""Stress inside a gear's teeth under a contact on one of them: what a picture of the stress field needs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.base.one_thread import one_thread
from fegear.fem.plane.elasticity import assemble, lame
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.ring_closure import close_ring

#: Places of the contact along the flank, evenly over its arc length: closer to each other than the pressure is wide.
_PLACES = 21
#: Half-width of the pressure, which the mesh resolves and a picture shows; narrowed where the flank ends [modules].
_WIDTH = 0.15
#: Shown are the teeth and so much of the body below them [modules].
_BODY = 2.2
#: Points that are shown stand so far apart at least [modules].
_APART = 0.05


@dataclass(frozen=True)
class InnerStress(ReadOnlyArrays):
    """Stress at points of teeth -K..K under unit line loads on tooth 0; module 1.

    Parameters
    ----------
    points : ndarray, shape (2, N)
        Of one tooth and the body below it, in the tooth's own frame (centre line along +y) [modules].
    triangles : ndarray of int, shape (3, M)
        Between them.
    fillet : ndarray of bool, shape (N,)
        Which of them lie on a fillet.
    radius : ndarray, shape (R,)
        Where the contacts stand, ascending [modules].
    stress : ndarray, shape (R, 2 K + 1, 3, N)
        sigma_xx, sigma_yy and sigma_xy in the frame of their own tooth [1/modules].
    half_width : float
        Of the pressure on the flank; narrower near its ends [modules].
    reach : int
        K; tooth k = +1 lies clockwise of the loaded one.
    across : float
        sigma_zz over sigma_xx + sigma_yy: Poisson's ratio in plane strain, 0 in plane stress.
    """

    points: Array
    triangles: Index
    fillet: NDArray[np.bool_]
    radius: Array
    stress: NDArray[np.float32]
    half_width: float
    reach: int
    across: float


def inner_stress(influence: Influence, reach: int) -> InnerStress:
    """Stress from the displacements of all nodes of a gear's solved mesh.

    Under contacts at a few places of the flank: stress is linear in the loads of the teeth, so that of any loads
    follows by superposition, and of any place by interpolation. At a node it is the mean over the elements around it.

    Parameters
    ----------
    influence : Influence
    reach : int
        K; at most (z - 1) // 2 are given.
    """
    if influence.support is not None:
        raise InputError(
            "rim_support", "pins or a spline", "is not available for the stress field (rim fixed)",
            "remove this result (root stress and deflections include the support)",
        )  # fmt: skip
    mesh, flank = influence.mesh, influence.flank
    reach = min(reach, (mesh.teeth - 1) // 2)
    arc = np.linspace(flank.flank_start, flank.flank_end, _PLACES)
    least = influence.corner_distance
    arc = np.clip(arc, flank.flank_start + least, flank.flank_end - least)
    room = np.minimum(arc - flank.flank_start, flank.flank_end - arc)
    forces = flank.patches(arc, np.clip(room, least, _WIDTH))
    points, triangles = _shown(mesh, influence.tooth.side)
    with one_thread():
        elasticity = assemble(mesh, influence.poisson_ratio, influence.plane, flank.order)
        ring = close_ring(mesh, elasticity, flank.dofs, reach, expandable=True)
        sectors = list(range(-reach, reach + 1))
        field = ring.field(flank.dofs, forces, sectors)
        displacement = np.stack([field[k] for k in sectors])
        stress = _nodal(influence, displacement, points)
    on_fillet = np.isin(points, np.hstack([mesh.edges[name] for name in ("fillet", "back_fillet")]))
    return InnerStress(
        mesh.points[:, points], triangles, on_fillet, flank.radius_of_arc(arc),
        stress.transpose(3, 0, 1, 2).astype(np.float32), _WIDTH, reach,
        influence.poisson_ratio if influence.plane == "strain" else 0.0,
    )  # fmt: skip


def _nodal(influence: Influence, displacement: Array, points: Index) -> Array:
    """Stress at the mesh's points as the mean over the elements around each, shape (T, 3, N, R) of (T, size, R)."""
    from scipy.sparse import csr_array

    elements = sector_elements(influence.mesh, influence.flank.order)
    nodes, (gradient, at) = elements.element_nodes, elements.gradients_at_points()
    gradient = gradient / np.bincount(at.reshape(-1))[at][:, None, None]
    shape = (*nodes.shape, at.shape[1])
    rows, columns = (np.broadcast_to(one, shape).reshape(-1) for one in (at[:, None, :], nodes[:, :, None]))
    by_x, by_y = (csr_array((gradient[:, :, d].reshape(-1), (rows, columns)))[points] for d in (0, 1))
    lam, mu = lame(influence.poisson_ratio, influence.plane)
    found = np.empty((displacement.shape[0], 3, points.size, displacement.shape[2]))
    for one, moved in zip(found, displacement, strict=True):
        u, v = moved[0::2], moved[1::2]
        xx, yy = by_x @ u, by_y @ v
        one[:] = lam * (xx + yy) + 2.0 * mu * xx, lam * (xx + yy) + 2.0 * mu * yy, mu * (by_y @ u + by_x @ v)
    return found


def _shown(mesh: SectorMesh, side: int) -> tuple[Index, Index]:
    """Points that are shown and the triangles between them, numbered among these; those that crowd are thinned out.

    Elements crowd in corners of the outline, where a picture shows nothing of them: their points go to the nearest
    that stays, and triangles that lose a side vanish.
    """
    radius = side * np.hypot(*mesh.points)  # rising from the body to the tip
    root = radius[np.unique(mesh.edges["fillet"][:2])].min()
    t = mesh.triangles[:, (radius[mesh.triangles] > root - _BODY).any(axis=0)]
    quarters = np.hstack([t[[a, b, c]] for a, b, c in ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))])
    every = np.unique(quarters)
    outer = np.concatenate([part[:2].reshape(-1) for name, part in mesh.edges.items() if name != "bore"])
    ends, times = np.unique(outer, return_counts=True)
    last = np.full(radius.size, 3)
    last[np.concatenate([part[2] for part in mesh.edges.values()])] = 2
    last[ends] = np.where(times == 1, 0, 1)  # ends of named parts stay first, then the outline and the sides
    kept: list[int] = []
    stands = np.full(radius.size, -1)
    for point in every[np.argsort(last[every], kind="stable")].tolist():
        off = np.hypot(*(mesh.points[:, kept] - mesh.points[:, [point]])) if kept else np.array([np.inf])
        nearest = int(off.argmin())
        stands[point] = nearest if off[nearest] < _APART else len(kept)
        if stands[point] == len(kept):
            kept.append(point)
    made = stands[quarters]
    whole = (made[0] != made[1]) & (made[1] != made[2]) & (made[2] != made[0])
    return np.array(kept), np.asarray(np.unique(made[:, whole], axis=1))
