"""How the outline of a gear's teeth moves under a contact on one of them: what a picture of deformed teeth needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.elasticity import assemble
from fegear.fem.ring import close_ring
from fegear.one_thread import one_thread

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.arrays import Array, Index
    from fegear.fem.influence import Influence
    from fegear.fem.mesh import SectorMesh

#: Boundaries of a sector that are no outline of a tooth.
_INNER = ("side_a", "side_b", "bore")
#: Points of the outline stand so far apart at least, corners excepted [modules].
_APART = 0.04
#: The pressure that loads the mesh takes this share of the room to the nearest end of the flank.
_ROOM_SHARE = 0.7


@dataclass(frozen=True)
class OutlineMotion:
    """Displacements of the outline of teeth -K..K under contacts on tooth 0; module 1, Young's modulus 1.

    Parameters
    ----------
    influence : Influence
        Of the same gear, on the same mesh.
    points : ndarray, shape (2, N)
        The outline of a tooth in its own frame (centre line along +y), from the middle of its left space to the right.
    response : ndarray, shape (2 n, 2 K + 1, 2 N)
        Under forces on the unknowns of tooth 0's flank: x of all points, then y, in the frame of their own tooth.
    reach : int
        K.
    """

    influence: Influence
    points: Array
    response: NDArray[np.float32]
    reach: int

    def displacement(self, radius: Array, patch: float, half_width: Array) -> dict[int, Array]:
        """Move the outline under unit line loads.

        Parameters
        ----------
        radius : ndarray, shape (P,)
            Where the contacts stand [modules].
        patch : float
            Half-width of the pressure that loads the mesh, narrowed where the flank ends [modules].
        half_width : ndarray, shape (P,)
            Of the true contacts [modules].

        Returns
        -------
        dict of int to ndarray, shape (2, N, P)
            By tooth k = -K..K; k = +1 lies clockwise of the loaded one.

        Notes
        -----
        The mesh resolves a pressure of half-width a; the dent of the true one, of half-width b, differs from that by
        `log_slope` times the difference of the half-planes' own (`half_plane_dent`), which dies out with the square of
        the distance: so the surfaces of two gears under their Hertzian pressure fit each other.
        """
        from scipy.sparse import csr_array

        flank = self.influence.flank
        arc, width = self.influence.place(radius, half_width)
        room = np.minimum(arc - flank.flank_start, flank.flank_end - arc)
        wide = np.maximum(np.minimum(patch, _ROOM_SHARE * room), self.influence.corner_distance)
        wide = np.maximum(wide, width)
        forces = csr_array(flank.patches(arc, wide).T.astype(np.float32))  # a contact presses on few of the nodes
        found = (forces @ self.response.reshape(forces.shape[1], -1)).reshape(arc.size, 2 * self.reach + 1, 2, -1)
        moved = {k: found[:, k + self.reach].transpose(1, 2, 0) for k in range(-self.reach, self.reach + 1)}
        place, inward = self._contact(arc)
        distance = np.hypot(*(self.points[:, :, None] - place[:, None]))
        dent = half_plane_dent(distance, width) - half_plane_dent(distance, wide)
        moved[0] = moved[0] + self.influence.log_slope * dent * inward[:, None]
        return moved

    def _contact(self, arc: Array) -> tuple[Array, Array]:
        """Places of contacts and the directions into the tooth there, shape (2, P) each."""
        flank, tooth = self.influence.flank, self.influence.tooth
        radius = flank.radius_of_arc(arc)
        half = tooth.half_thickness_angle(radius)
        lean = flank.base_half_angle - np.sqrt(np.maximum((radius / flank.base_radius) ** 2 - 1.0, 0.0))
        place = radius * np.stack([np.sin(half), np.cos(half)])
        return place, np.stack([-np.cos(lean), np.sin(lean)])


def half_plane_dent(distance: Array, half_width: Array) -> Array:
    """How deep a half-plane is pressed at a distance from a semi-elliptic pressure's centre, over `log_slope`.

    Minus the mean of ln|s - t| over the pressure: 1/2 - ln(a/2) - (s/a)^2 beneath it (Hertz's parabola; Johnson,
    Contact Mechanics, 4.2), minus the logarithm of the distance far from it.
    """
    ratio = np.maximum(distance / half_width, 1.0)
    root = np.sqrt(ratio * ratio - 1.0)
    # (s/a)^2 - (s/a) sqrt((s/a)^2 - 1) without the cancellation of large numbers
    outside = ratio / (ratio + root) + np.log(ratio + root)
    inside = (distance / half_width) ** 2
    return 0.5 - np.log(0.5 * half_width) - np.where(distance < half_width, inside, outside)


def outline_motion(influence: Influence, reach: int) -> OutlineMotion:
    """Solve the ring of a gear once more for the motion of its teeth's outline.

    Parameters
    ----------
    influence : Influence
    reach : int
        K; at most (z - 1) // 2 are given.
    """
    mesh = influence.mesh
    chain = _outline(mesh)
    with one_thread():
        elasticity = assemble(mesh, influence.poisson_ratio, influence.plane, influence.flank.order)
        watch = elasticity.node_dofs[:, chain].reshape(-1)
        reach = min(reach, (mesh.teeth - 1) // 2)
        ring = close_ring(mesh, elasticity, np.union1d(influence.flank.dofs, watch), reach)
        response = ring.respond(influence.flank.dofs, watch)
    stacked = np.stack([response[k].T for k in range(-reach, reach + 1)], axis=1).astype(np.float32)
    return OutlineMotion(influence, mesh.points[:, chain], stacked, reach)


def _outline(mesh: SectorMesh) -> Index:
    """Vertices of a tooth's outline from left to right, those that crowd at its corners thinned out."""
    parts = [edges[:2] for name, edges in mesh.edges.items() if name not in _INNER]
    following = dict(np.hstack(parts).T.tolist())
    (at,) = set(following) - set(following.values())
    corners = {int(vertex) for part in parts for vertex in np.setxor1d(part[0], part[1])}
    chain = [at]
    while at in following:
        at = following[at]
        if at in corners or np.hypot(*(mesh.points[:, at] - mesh.points[:, chain[-1]])) >= _APART:
            chain.append(at)
    return np.array(chain[::-1])
