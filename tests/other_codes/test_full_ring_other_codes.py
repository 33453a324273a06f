"""One sector and the condensed ring against elements from the textbook: the same gear solved explicitly, all teeth."""

import importlib.util
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest
import skfem
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from fegear.fem.plane.elasticity import assemble
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.ring_closure import close_ring
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.trace import loaded_flank
from fegear.fem.plane.whole_gear import whole_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

_spec = importlib.util.spec_from_file_location("textbook_elements", Path(__file__).with_name("textbook_elements.py"))
textbook = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(textbook)

NU = 0.3
TEETH = 20
RADII = np.array([9.6, 10.0, 10.8])


@pytest.fixture(scope="module")
def problem():
    """A coarse gear with three contact loads, solved as a ring."""
    tooth = Tooth(TEETH, BasicRack(1.0, 1.25, 0.25))
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


@dataclass
class _Body:
    points: np.ndarray
    triangles: np.ndarray
    bends: dict = field(default_factory=dict)


def _straightened(mesh):
    points, corners = mesh.points.copy(), mesh.triangles[:3]
    for i in range(3):
        points[:, mesh.triangles[3 + i]] = 0.5 * (points[:, corners[i]] + points[:, corners[(i + 1) % 3]])
    return replace(mesh, points=points, bends={})


def _by_place(places, wanted):
    """Number of the node at each wanted place; nodes that share a place or have none are an error."""
    numbers = {tuple(np.round(p, 7) + 0.0): i for i, p in enumerate(places.T)}
    assert len(numbers) == places.shape[1]
    return np.array([numbers[tuple(np.round(p, 7) + 0.0)] for p in wanted.T])


@pytest.mark.dear("4-quadratic", "4-cubic", "4-straight", "3-quadratic")
@pytest.mark.parametrize("edges", ["straight", "quadratic", "cubic"])
@pytest.mark.parametrize("order", [2, 3, 4])
def test_stiffness_of_one_sector_is_the_textbook_s(order, edges):
    """Every node is matched by its place: elements whose corners are not sorted put neighbours' nodes in two places."""
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    mesh = mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings().scaled(1.5))
    mesh = {"straight": _straightened(mesh), "quadratic": replace(mesh, bends={}), "cubic": mesh}[edges]
    elasticity, elements = assemble(mesh, NU, "strain", order), sector_elements(mesh, order)
    dofs, matrices = elasticity.element_dofs, elasticity.stiffness
    rows, columns = (np.broadcast_to(d, matrices.shape).reshape(-1) for d in (dofs[:, :, None], dofs[:, None]))
    ours = coo_matrix((matrices.reshape(-1), (rows, columns)), shape=2 * (elasticity.size,)).tocsr()
    theirs, places = textbook.assembled(mesh, order, NU, points=order if edges == "straight" else 9)
    kind = {2: skfem.ElementTriP2, 3: skfem.ElementTriP3, 4: skfem.ElementTriP4}[order]()
    curves = skfem.MappingIsoparametric(elements.grid, elements.grid.elem())
    node = _by_place(places, skfem.Basis(elements.grid, kind, curves, intorder=1, dofs=elements.dofs).doflocs)
    match = 2 * np.repeat(node, 2) + np.tile([0, 1], node.size)
    assert np.unique(match).size == elasticity.size == theirs.shape[0]
    difference = ours - theirs[match][:, match]
    # On curved elements the integrand is rational and no quadrature exact.
    assert np.abs(difference).max() < (1e-13 if edges == "straight" else 1e-9) * np.abs(theirs).max()


def _explicit(gear, sectors, forces):
    """Displacements (2, nodes, loads) of the sectors named, meshed as one body with the bore held."""
    inside = np.isin(gear.triangles, gear.sector_nodes[sectors]).all(axis=0)
    used = np.unique(gear.triangles[:, inside])
    number = np.full(gear.points.shape[1], -1)
    number[used] = np.arange(used.size)
    body = _Body(gear.points[:, used], number[gear.triangles[:, inside]])
    stiffness, places = textbook.assembled(body, 2, NU, points=5)
    node = used[_by_place(gear.points[:, used], places + np.array([[0.0], [body.points[1].max()]]))]
    dof = np.full((2, gear.points.shape[1]), -1)
    dof[:, node] = 2 * np.arange(node.size) + np.array([[0], [1]])
    right = np.zeros((stiffness.shape[0], RADII.size))
    for c in range(2):
        right[dof[c, gear.sector_nodes[0]]] = forces[c]
    fixed = dof[:, np.intersect1d(gear.node_set("bore"), used)].reshape(-1)
    free = np.setdiff1d(np.arange(stiffness.shape[0]), fixed)
    u = np.zeros_like(right)
    u[free] = splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A").solve(right[free])
    return u[dof]


@pytest.mark.dear("0")
@pytest.mark.parametrize("sector_teeth", [0, 3, 4])
def test_explicit_solution_of_all_teeth_agrees_to_1e_8(problem, sector_teeth):
    """All teeth of the gear, or a sector of a few with free sides: loaded in the middle, one after it if even."""
    gear, forces, respond = problem
    before = (sector_teeth - 1) // 2
    row = np.arange(-before, sector_teeth - before) if sector_teeth else np.arange(TEETH)
    u = _explicit(gear, row % TEETH, forces)
    response = respond(sector_teeth)
    for k, found in response.items():
        explicit = _turn_back(u[:, gear.sector_nodes[k % TEETH]], k, TEETH)
        assert np.abs(explicit - found).max() < 1e-8 * np.abs(response[0]).max()
