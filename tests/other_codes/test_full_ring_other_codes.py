"""The condensed ring against the same gear solved explicitly, all teeth, by scikit-fem alone."""

import numpy as np
import pytest
import skfem
from skfem.helpers import ddot, sym_grad, trace

from fegear.fem.elasticity import _sorted_elements, assemble, lame
from fegear.fem.ring import close_ring
from fegear.fem.sector import mesh_sector
from fegear.fem.settings import MeshSettings
from fegear.fem.trace import loaded_flank
from fegear.geometry import BasicRack, Tooth
from fegear.show.whole_gear import whole_gear

NU = 0.3
RADII = np.array([13.4, 14.0, 14.9])


@pytest.fixture(scope="module")
def problem():
    """A coarse 28-tooth gear with three contact loads, solved as a ring."""
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    mesh = mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings().scaled(2.0))
    elasticity = assemble(mesh, NU, "strain", 2)
    flank = loaded_flank(mesh, elasticity, tooth, 0.15)
    loads = np.zeros((elasticity.stiffness.shape[0], RADII.size))
    loads[flank.dofs] = flank.patches(flank.arc_of_radius(RADII), np.full(RADII.size, 0.1))
    response = close_ring(mesh, elasticity, reach=3).respond(loads, elasticity.node_dofs.reshape(-1))
    forces = np.stack([loads[d] for d in elasticity.node_dofs])  # (2, nodes, loads)
    return whole_gear(mesh), forces, {k: u.reshape(2, -1, RADII.size) for k, u in response.items()}


def _turn_back(u, k, teeth):
    angle = 2.0 * np.pi * k / teeth
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * u[0] - s * u[1], s * u[0] + c * u[1]])


def test_explicit_solution_of_all_teeth_by_scikit_fem_agrees_to_1e_8(problem):
    gear, forces, response = problem
    lam, mu = lame(NU, "strain")
    grid = skfem.MeshTri2(np.ascontiguousarray(gear.points), _sorted_elements(gear.triangles), sort_t=False)
    basis = skfem.Basis(grid, skfem.ElementVector(skfem.ElementTriP2()), intorder=4)
    stiffness = skfem.BilinearForm(
        lambda u, v, w: lam * trace(sym_grad(u)) * trace(sym_grad(v)) + 2 * mu * ddot(sym_grad(u), sym_grad(v))
    ).assemble(basis)
    # Match scikit-fem's unknowns to the gear's nodes by their place, not by fegear's numbering.
    place = {tuple(np.round(p, 7) + 0.0): i for i, p in enumerate(gear.points.T)}
    node = np.array([place[tuple(np.round(p, 7) + 0.0)] for p in basis.doflocs.T])
    component = np.arange(basis.N) % 2
    dof = np.empty((2, gear.points.shape[1]), dtype=int)
    dof[component, node] = np.arange(basis.N)
    right = np.zeros((basis.N, RADII.size))
    for c in range(2):
        right[dof[c, gear.sector_nodes[0]]] = forces[c]
    fixed = dof[:, gear.node_set("bore")].reshape(-1)
    free = np.setdiff1d(np.arange(basis.N), fixed)
    from scipy.sparse.linalg import splu

    u = np.zeros_like(right)
    u[free] = splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A").solve(right[free])
    for k, found in response.items():
        explicit = _turn_back(np.stack([u[dof[c, gear.sector_nodes[k % 28]]] for c in range(2)]), k, 28)
        assert np.abs(explicit - found).max() < 1e-8 * np.abs(response[0]).max()
