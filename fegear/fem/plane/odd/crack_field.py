"""Displacement and stress inside a cracked tooth under a load on its flank: what a picture of the open crack needs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.base.one_thread import one_thread
from fegear.fem.plane.elasticity import lame
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.odd.crack_faces import opening_rows
from fegear.fem.plane.odd.cracked_sector import FACES
from fegear.fem.plane.odd.odd_influence import OddInfluence
from fegear.fem.plane.odd.odd_ring import held_sectors
from fegear.fem.plane.rim import rigid_motions
from fegear.fem.plane.sector_sides import between_sides, bore_of_side, condensed_sector, ports_of
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.supported_section import assemble_section
from fegear.geometry.rim_support import RimSupport

#: Shown are the tooth and so much of the body below it [modules].
_BODY = 2.2
#: Stress is taken so far on the way from an element's points to its middle.
_INWARD = 1e-3


@dataclass(frozen=True)
class CrackField(ReadOnlyArrays):
    """A cracked tooth under one load; E = 1, module 1, in the tooth's own frame.

    Parameters
    ----------
    points : ndarray, shape (2, N)
    triangles : ndarray of int, shape (3, M)
        Between them.
    moved : ndarray, shape (2, N)
        Per unit line load [1/E].
    mises : ndarray, shape (N,)
        Von Mises stress per unit line load [1/modules]; at the crack's tip, where it has no bound, the largest beside.
    left, right : ndarray of int
        Points of the crack's faces, from the mouth to the tip.
    fillets : ndarray of int
        Points of both fillets.
    """

    points: Array
    triangles: Index
    moved: Array
    mises: Array
    left: Index
    right: Index
    fillets: Index


def crack_field(
    known: OddInfluence, i: int, radius: float, half_width: float, settings: MeshSettings, support: RimSupport | None
) -> CrackField:
    """Follow a load on a cracked tooth into its sector.

    Parameters
    ----------
    known : OddInfluence
    i : int
        The tooth.
    radius, half_width : float
        Of the load [modules].
    settings : MeshSettings
        As `known` was solved with.
    support : RimSupport, optional
        Likewise.
    """
    kind = known.kind(i)
    mesh, flank = kind.mesh, kind.flank
    with one_thread():
        elasticity = assemble_section(mesh, known.poisson_ratio, known.plane, settings.order, settings.solver, support)
        loads = known.tooth(i).remote(np.array([radius]), half_width)
        force, by_faces = loads, kind.flank_follows.T @ loads
        ports = flank.dofs
        if kind.faces is not None:
            face, rows, _ = opening_rows(mesh, elasticity)
            pressed = known.face_forces(i, i, loads)
            by_faces = by_faces + kind.faces.follows.T @ pressed
            ports = np.concatenate([flank.dofs, face])
            force = np.vstack([loads, rows.T @ pressed])
        arc = support is not None and support.kind == "free_arc"
        free = arc and abs(i) <= known.half
        motions = rigid_motions(elasticity) if free else None
        sector, side, turn, _ = condensed_sector(mesh, elasticity, np.unique(ports), expandable=True, motions=motions)
        part = between_sides(sector, side, turn)
        if arc and not free:
            part = held_sectors(0, bore_of_side(mesh, elasticity), part).part
        sides = known.ring.between(i, i) @ by_faces
        kept = np.hstack([part.follow_a, part.follow_b]) @ sides + part.own[:, ports_of(sector, ports)] @ force
        moved = sector.expand(kept)[:, 0]
    own = elasticity.node_dofs
    at_points = np.where(own < 0, np.nan, moved[own])
    return _shown(known, i, at_points, _mises(known, i, settings.order, moved))


def _mises(known: OddInfluence, i: int, order: int, moved: Array) -> Array:
    """Von Mises stress at the points of the tooth's mesh, the mean over the elements around each, shape (N,)."""
    mesh, elements = known.kind(i).mesh, sector_elements(known.kind(i).mesh, order)
    lam, mu = lame(known.poisson_ratio, known.plane)
    gradient, at = elements.gradients_at_points(_INWARD)
    nodes = elements.element_nodes
    u, v = (np.einsum("mndp,mn->dmp", gradient, moved[axis::2][nodes]) for axis in (0, 1))
    even, count = lam * (u[0] + v[1]), np.bincount(at.ravel())
    each = even + 2.0 * mu * u[0], even + 2.0 * mu * v[1], mu * (u[1] + v[0])
    a, b, shear = (np.bincount(at.ravel(), value.ravel()) / count for value in each)
    across = (known.poisson_ratio if known.plane == "strain" else 0.0) * (a + b)
    found = np.sqrt(0.5 * ((a - b) ** 2 + (b - across) ** 2 + (across - a) ** 2) + 3.0 * shear**2)
    around = np.setdiff1d(mesh.triangles[:, (mesh.triangles == mesh.tip).any(axis=0)], [mesh.tip])
    found[mesh.tip] = found[around].max()
    return np.asarray(found)


def _shown(known: OddInfluence, i: int, moved: Array, mises: Array) -> CrackField:
    """Of the tooth and the body close to it, its elements in four."""
    kind = known.kind(i)
    mesh, t = kind.mesh, kind.mesh.triangles
    for one, other, middle in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):  # where the elements have no node there
        off = t[middle][np.isnan(moved[0, t[middle]])]
        ends = np.isin(t[middle], off)
        moved[:, t[middle, ends]] = 0.5 * (moved[:, t[one, ends]] + moved[:, t[other, ends]])
    out = kind.tooth.side * np.hypot(*mesh.points)
    root = out[np.unique(mesh.edges["fillet"][:2])].min()
    t = t[:, (out[t] > root - _BODY).any(axis=0)]
    quarters = np.hstack([t[[a, b, c]] for a, b, c in ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))])
    used, triangles = np.unique(quarters, return_inverse=True)
    number = np.full(mesh.points.shape[1], -1)
    number[used] = np.arange(used.size)
    faces = []
    for name in FACES:
        first, second, middle = mesh.edges[name]
        line = np.append(np.stack([first, middle], axis=1).ravel(), second[-1])
        faces.append(number[line if line[-1] == mesh.tip else line[::-1]])
    left, right = faces
    fillets = np.unique(np.hstack([mesh.edges[name] for name in ("fillet", "back_fillet")]))
    return CrackField(
        mesh.points[:, used], triangles.reshape(3, -1), moved[:, used], mises[used], left, right, number[fillets]
    )
