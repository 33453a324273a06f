"""The condensed ring against the same gear solved explicitly, all teeth, by scikit-fem alone."""

from dataclasses import replace

import numpy as np
import pytest
import skfem
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, sym_grad, trace

from fegear.fem.elasticity import assemble, lame
from fegear.fem.ring import close_ring
from fegear.fem.sector import mesh_sector
from fegear.fem.settings import MeshSettings
from fegear.fem.trace import loaded_flank
from fegear.fem.triangle import triangle
from fegear.geometry import BasicRack, Tooth
from fegear.output.whole_gear import whole_gear

NU = 0.3
RADII = np.array([13.4, 14.0, 14.9])


@pytest.fixture(scope="module")
def problem():
    """A coarse 28-tooth gear with three contact loads, solved as a ring."""
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    mesh = mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings().scaled(2.0))
    elasticity = assemble(mesh, NU, "strain", 2)
    flank = loaded_flank(mesh, elasticity, tooth, 0.15)
    patches = flank.patches(flank.arc_of_radius(RADII), np.full(RADII.size, 0.1))
    forces = np.zeros((elasticity.size, RADII.size))
    forces[flank.dofs] = patches

    def respond(sector_teeth):
        """Displacements of the nodes of sectors by their number: of the ring, or of a row with free sides."""
        if not sector_teeth:
            response = close_ring(mesh, elasticity, flank.dofs, 3, expandable=True).field(
                flank.dofs, patches, [-3, -1, 0, 1, 2]
            )
        else:
            reach = (sector_teeth - 1) // 2
            row = close_ring(mesh, elasticity, flank.dofs, reach, expandable=True, sector_teeth=sector_teeth)
            response = row.field(flank.dofs, patches, list(range(-reach, reach + 1)))
        return {k: u[elasticity.node_dofs] for k, u in response.items()}

    return whole_gear(mesh), forces[elasticity.node_dofs], respond


def _turn_back(u, k, teeth):
    angle = 2.0 * np.pi * k / teeth
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * u[0] - s * u[1], s * u[0] + c * u[1]])


def _sorted_elements(triangles):
    """Each element's vertices in ascending order, middle nodes along: scikit-fem needs it and does not do it."""
    order = np.argsort(triangles[:3], axis=0)
    vertices = np.take_along_axis(triangles[:3], order, axis=0)
    moved = np.take_along_axis(triangles[[4, 5, 3]], order, axis=0)  # opposite to vertices 0, 1, 2
    return np.ascontiguousarray(np.concatenate([vertices, moved[[2, 0, 1]]]))


def _whole_stiffness(grid, element, intorder):
    lam, mu = lame(NU, "strain")
    basis = skfem.Basis(grid, skfem.ElementVector(element), intorder=intorder)
    form = skfem.BilinearForm(
        lambda u, v, w: lam * trace(sym_grad(u)) * trace(sym_grad(v)) + 2 * mu * ddot(sym_grad(u), sym_grad(v))
    )
    return basis, form.assemble(basis)


def _mapped(places, nodes):
    """Where reference nodes lie in six-node triangles, shape (M, 2, n)."""
    u, v = nodes
    w = 1.0 - u - v
    shape = np.array([w * (2 * w - 1), u * (2 * u - 1), v * (2 * v - 1), 4 * u * w, 4 * u * v, 4 * v * w])
    return np.einsum("cim,in->mcn", places, shape)


@pytest.mark.parametrize("curved", [False, True])
@pytest.mark.parametrize(
    ("order", "element"), [(2, skfem.ElementTriP2), (3, skfem.ElementTriP3), (4, skfem.ElementTriP4)]
)
def test_stiffness_of_one_sector_is_that_of_scikit_fem(order, element, curved):
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    mesh = mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings())
    mesh = replace(mesh, bends={})  # cubic edges are fegear's own
    if not curved:
        points, (first, second, third) = mesh.points.copy(), mesh.triangles[:3]
        for middle, a, b in zip(mesh.triangles[3:], (first, second, third), (second, third, first), strict=True):
            points[:, middle] = 0.5 * (points[:, a] + points[:, b])
        mesh = replace(mesh, points=points)
    elasticity = assemble(mesh, NU, "strain", order)
    centred = mesh.points - np.array([[0.0], [float(mesh.points[1].max())]])
    grid = skfem.MeshTri2(np.ascontiguousarray(centred), _sorted_elements(mesh.triangles), sort_t=False)
    basis, theirs = _whole_stiffness(grid, element(), 2 * order + 6)
    dofs, matrices = elasticity.element_dofs, elasticity.stiffness
    rows, columns = (np.broadcast_to(d, matrices.shape).reshape(-1) for d in (dofs[:, :, None], dofs[:, None]))
    ours = coo_matrix((matrices.reshape(-1), (rows, columns)), shape=2 * (elasticity.size,)).tocsr()
    # Unknowns are matched by the place of their node, as isoparametric elements map it.
    nodes = triangle(order).nodes
    place = np.empty((2, elasticity.size))
    for own, where in zip(dofs, _mapped(centred[:, mesh.triangles], nodes), strict=True):
        place[:, own] = np.repeat(where, 2, axis=1)
    numbers = {tuple(np.round(p, 7) + 0.0): i // 2 for i, p in enumerate(place.T)}
    node = np.array([numbers[tuple(np.round(p, 7) + 0.0)] for p in basis.doflocs.T])
    match = 2 * node + np.arange(basis.N) % 2
    assert np.unique(match).size == elasticity.size == basis.N
    difference = ours[match][:, match] - theirs
    # On curved elements the integrand is rational and no quadrature exact.
    assert np.abs(difference).max() < (1e-6 if curved else 1e-12) * np.abs(theirs).max()


def _explicit(gear, sectors, forces):
    """Displacements (2, nodes, loads) of the sectors named, meshed as one body with the bore held, by scikit-fem."""
    inside = np.isin(gear.triangles, gear.sector_nodes[sectors]).all(axis=0)
    used = np.unique(gear.triangles[:, inside])
    number = np.full(gear.points.shape[1], -1)
    number[used] = np.arange(used.size)
    points, triangles = gear.points[:, used], number[gear.triangles[:, inside]]
    grid = skfem.MeshTri2(np.ascontiguousarray(points), _sorted_elements(triangles), sort_t=False)
    basis, stiffness = _whole_stiffness(grid, skfem.ElementTriP2(), 6)
    # Match scikit-fem's unknowns to the gear's nodes by their place, not by fegear's numbering.
    place = {tuple(np.round(p, 7) + 0.0): i for i, p in zip(used, gear.points[:, used].T, strict=True)}
    node = np.array([place[tuple(np.round(p, 7) + 0.0)] for p in basis.doflocs.T])
    component = np.arange(basis.N) % 2
    dof = np.full((2, gear.points.shape[1]), -1)
    dof[component, node] = np.arange(basis.N)
    right = np.zeros((basis.N, RADII.size))
    for c in range(2):
        right[dof[c, gear.sector_nodes[0]]] = forces[c]
    fixed = dof[:, np.intersect1d(gear.node_set("bore"), used)].reshape(-1)
    free = np.setdiff1d(np.arange(basis.N), fixed)
    u = np.zeros_like(right)
    u[free] = splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A").solve(right[free])
    return u[dof]


@pytest.mark.parametrize("sector_teeth", [0, 3, 4])
def test_explicit_solution_by_scikit_fem_agrees_to_1e_8(problem, sector_teeth):
    """All teeth of the gear, or a sector of a few with free sides: loaded in the middle, one after it if even."""
    gear, forces, respond = problem
    before = (sector_teeth - 1) // 2
    row = np.arange(-before, sector_teeth - before) if sector_teeth else np.arange(28)
    u = _explicit(gear, row % 28, forces)
    response = respond(sector_teeth)
    for k, found in response.items():
        explicit = _turn_back(u[:, gear.sector_nodes[k % 28]], k, 28)
        assert np.abs(explicit - found).max() < 1e-8 * np.abs(response[0]).max()
