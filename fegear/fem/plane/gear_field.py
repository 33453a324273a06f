"""Displacement and stress of the whole gear under one contact, for pictures and exports; dimensionless."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.plane.elasticity import assemble, lame
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.ring_closure import close_ring
from fegear.fem.plane.trace import loaded_flank
from fegear.geometry.gear import Plane
from fegear.geometry.involute_side import InvoluteSide


@dataclass(frozen=True)
class GearField:
    """What a unit line load on tooth 0 does to the whole gear; module 1, Young's modulus 1.

    Attributes
    ----------
    mesh : SectorMesh
    displacement : ndarray, shape (z, 2, N)
        Of every node of every sector, each in its own frame (its tooth along +y), sectors clockwise from tooth 0.
    stress : ndarray, shape (z, 4, N)
        sigma_xx, sigma_yy, sigma_xy, sigma_zz in the same frames, averaged over the elements around a node.
    forces : ndarray, shape (2, N)
        The nodal forces on tooth 0 that the contact's pressure amounts to.
    """

    mesh: SectorMesh
    displacement: Array
    stress: Array
    forces: Array

    @property
    def von_mises(self) -> Array:
        """Equivalent stress, shape (z, N)."""
        xx, yy, xy, zz = (self.stress[:, i] for i in range(4))
        return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * xy**2)


def gear_field(
    tooth: InvoluteSide, mesh: SectorMesh, poisson_ratio: float, plane: Plane, radius: float, half_width: float
) -> GearField:
    """Solve the whole gear under one semi-elliptic contact pressure on tooth 0.

    Parameters
    ----------
    tooth : InvoluteSide
    mesh : SectorMesh
    poisson_ratio : float
    plane : {"strain", "stress"}
    radius, half_width : float
        Place and half-width of the contact [modules].

    Returns
    -------
    GearField
    """
    z = mesh.teeth
    elasticity = assemble(mesh, poisson_ratio, plane, order=2)
    flank = loaded_flank(mesh, elasticity, tooth, margin=0.15)
    ring = close_ring(mesh, elasticity, flank.dofs, reach=z // 2, expandable=True)
    forces = flank.patches(flank.arc_of_radius(np.array([radius])), np.array([half_width]))
    loads = np.zeros(ring.size)
    loads[flank.dofs] = forces[:, 0]
    sectors = [(k + z // 2) % z - z // 2 for k in range(z)]  # clockwise from tooth 0, within the reach
    response = ring.field(flank.dofs, forces, sectors)
    displacement = np.stack([response[k][:, 0][elasticity.node_dofs] for k in sectors])
    stress = nodal_stress(mesh, displacement, poisson_ratio, plane)
    return GearField(mesh, displacement, stress, loads[elasticity.node_dofs])


def nodal_stress(mesh: SectorMesh, displacement: Array, poisson_ratio: float, plane: Plane) -> Array:
    """Stress at the elements' own nodes, averaged where elements meet within a sector, shape (z, 4, N).

    Parameters
    ----------
    mesh : SectorMesh
    displacement : ndarray, shape (z, 2, N)
    poisson_ratio : float
    plane : {"strain", "stress"}
    """
    from scipy.sparse import csr_array

    lam, mu = lame(poisson_ratio, plane)
    elements = sector_elements(mesh, order=2)
    points = np.argsort(elements.point_nodes)[elements.element_nodes]  # (M, 6)
    gradient = elements.gradients_at_nodes() / np.bincount(points.reshape(-1))[points][:, None, None]
    columns, rows = (np.broadcast_to(p, (*points.shape, 6)).reshape(-1) for p in (points[:, :, None], points[:, None]))
    by_x, by_y = (csr_array((gradient[:, :, d].reshape(-1), (rows, columns))) for d in range(2))
    u, v = displacement.transpose(1, 2, 0)
    xx, yy, shear = by_x @ u, by_y @ v, by_y @ u + by_x @ v
    trace = lam * (xx + yy)
    zz = trace if plane == "strain" else np.zeros_like(trace)
    return np.stack([trace + 2 * mu * xx, trace + 2 * mu * yy, mu * shear, zz]).transpose(2, 0, 1)
