"""Elements of order 2 to 4, bent or not, against 40-digit integration, exact polynomials and orders of convergence."""

import importlib.util
import math
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from fegear.base.errors import InputError
from fegear.fem.plane.elasticity import assemble
from fegear.fem.plane.gear_field import nodal_stress
from fegear.fem.plane.mesh import SectorMesh, with_middle_nodes
from fegear.fem.plane.ring_closure import close_ring
from fegear.fem.plane.settings import LEVEL_RATIO, MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

_spec = importlib.util.spec_from_file_location(
    "textbook_elements", Path(__file__).parents[1] / "other_codes" / "textbook_elements.py"
)
textbook = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(textbook)

NU = 0.3
INNER, OUTER, TEETH = 1.0, 2.0, 6
HALF = math.pi / TEETH


def _sector(n, edges):
    """A sector of a ring, n x n x 2 triangles; its rims are chords, parabolas or cubics, its vertices shuffled."""
    radii, angles = np.linspace(INNER, OUTER, n + 1), np.linspace(-HALF, HALF, n + 1)
    r, t = (x.ravel() for x in np.meshgrid(radii, angles, indexing="ij"))
    # In any order: scikit-fem's elements are wrong unless the corners of each ascend.
    shuffled = np.random.default_rng(n).permutation(r.size)
    number = shuffled.reshape(n + 1, n + 1)
    vertices = np.empty((2, r.size))
    vertices[:, shuffled] = r * np.sin(t), r * np.cos(t)
    a, b, c, d = (x.ravel() for x in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    triangles = np.hstack([np.stack([a, b, c]), np.stack([a, c, d])])
    chains = {"bore": number[0], "flank": number[-1, ::-1], "side_a": number[::-1, 0], "side_b": number[:, -1]}
    middles, bends = {}, {}
    for name, chain in chains.items():
        ends = vertices[:, chain]
        first, second = ends[:, :-1], ends[:, 1:]
        middles[name] = 0.5 * (first + second)
        if name in ("bore", "flank") and edges != "straight":
            middles[name] *= np.hypot(*first) / np.hypot(*middles[name])
            angle, turn = 2 * HALF / n, 1.0 if name == "bore" else -1.0
            # Hermite's cubic with the circle's tangents, as long as the arc's chord at both ends allows.
            tangent = turn * np.stack([ends[1], -ends[0]]) * 4.0 * math.tan(angle / 4.0)
            chord = second - first
            bends[name] = np.stack([tangent[:, :-1] - chord, chord - tangent[:, 1:]], axis=1)
    points, six, named = with_middle_nodes(vertices, triangles, chains, middles)
    return SectorMesh(points, six, named, TEETH, bends=bends if edges == "cubic" else {})


def _rim(mesh, name, order, s):
    """Points and tangents of a boundary's edges at s, shape (2, s, edges) each."""
    first, second, middle = (mesh.points[:, nodes] for nodes in mesh.edges[name])
    sag = middle - 0.5 * (first + second)
    bend = mesh.bends[name] if order > 2 and name in mesh.bends else np.stack([4 * sag, 4 * sag], axis=1)
    s = s[:, None]
    first, second, one, other = (x[:, None] for x in (first, second, bend[:, 0], bend[:, 1]))
    leaves = (1 - s) * one + s * other
    points = (1 - s) * first + s * second + s * (1 - s) * leaves
    return points, second - first + (1 - 2 * s) * leaves + s * (1 - s) * (other - one)


def _error_inside(mesh, order, field):
    """Root mean square error at the vertices when the boundary moves as a field in equilibrium does."""
    elasticity = assemble(mesh, NU, "strain", order)
    dofs, matrices = elasticity.element_dofs, elasticity.stiffness
    rows, columns = (np.broadcast_to(d, matrices.shape).ravel() for d in (dofs[:, :, None], dofs[:, None]))
    whole = coo_matrix((matrices.ravel(), (rows, columns))).tocsc()
    u = np.zeros(elasticity.size)
    held = np.unique(np.concatenate([along.ravel() for along in elasticity.edge_dofs.values()]))
    for name, along in elasticity.edge_dofs.items():
        u[along] = field(*_rim(mesh, name, order, np.linspace(0.0, 1.0, order + 1))[0])
    free = np.setdiff1d(np.arange(elasticity.size), held)
    u[free] = splu(whole[free][:, free]).solve(-whole[free][:, held] @ u[held])
    vertices = np.arange(mesh.vertex_count)
    exact = np.stack(field(*mesh.points[:, vertices]))
    return np.sqrt(np.mean((u[elasticity.node_dofs[:, vertices]] - exact) ** 2) / np.mean(exact**2))


@pytest.mark.parametrize("order", [2, 3, 4])
def test_polynomials_in_equilibrium_are_met_exactly(order):
    """The gradient of Re (x + iy)^(p + 1) needs no body force and has degree p."""

    def field(x, y):
        power = (order + 1) * (x + 1j * (y - 1.0)) ** order
        return power.real, -power.imag

    assert _error_inside(_sector(3, "straight"), order, field) < 1e-12


@pytest.mark.parametrize("edges", ["straight", "quadratic", "cubic"])
@pytest.mark.parametrize("order", [2, 3, 4])
def test_observed_order_on_straight_and_curved_meshes(order, edges):
    """u = grad(exp(2x) cos(2y)) needs no body force; displacements converge with order p + 1."""

    def field(x, y):
        return np.exp(2 * x) * np.cos(2 * y), -np.exp(2 * x) * np.sin(2 * y)

    coarse, fine = (_error_inside(_sector(n, edges), order, field) for n in ((8, 16) if order < 4 else (6, 12)))
    assert math.log2(coarse / fine) > order + 0.5
    assert fine < {2: 5e-5, 3: 5e-6, 4: 1e-7}[order]


def _lame_error(mesh, order):
    """Root mean square error at the vertices of a ring held inside under a uniform tension of one outside."""
    elasticity = assemble(mesh, NU, "strain", order)
    x, w = np.polynomial.legendre.leggauss(8)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    shape = np.vander(x, order + 1, increasing=True) @ np.linalg.inv(
        np.vander(np.linspace(0.0, 1.0, order + 1), increasing=True)
    )
    points, tangents = _rim(mesh, "flank", order, x)
    force = points / np.hypot(*points) * np.hypot(*tangents)
    dofs, loads = elasticity.edge_dofs["flank"], np.zeros(elasticity.size)
    np.add.at(loads, dofs, np.einsum("qi,cqn,q->cin", shape, force, w))
    loaded = np.unique(dofs)
    ring = close_ring(mesh, elasticity, loaded, TEETH // 2, expandable=True)
    sectors = list(range(-TEETH // 2, TEETH // 2))
    response = ring.field(loaded, loads[loaded, None], sectors)
    vertices = np.arange(mesh.vertex_count)
    u = sum(response[k][:, 0] for k in sectors)[elasticity.node_dofs[:, vertices]]
    # u_r = a (r - INNER^2 / r) with sigma_rr(OUTER) = 1 in plane strain (Timoshenko and Goodier, art. 28).
    lam, mu = NU / ((1 + NU) * (1 - 2 * NU)), 0.5 / (1 + NU)
    place = mesh.points[:, vertices]
    square = np.sum(place**2, axis=0)
    exact = place * (1.0 - INNER**2 / square) / (2 * (lam + mu) + 2 * mu * INNER**2 / OUTER**2)
    return np.sqrt(np.mean((u - exact) ** 2) / np.mean(exact**2))


@pytest.mark.parametrize(
    ("order", "edges", "least", "most"),
    [
        (2, "straight", 1.7, 2.3),
        (2, "quadratic", 3.0, 4.5),
        (3, "cubic", 3.4, 4.5),
        (4, "straight", 1.7, 2.3),
        (4, "quadratic", 3.6, 4.4),
        (4, "cubic", 5.0, 6.5),
    ],
)
def test_observed_order_on_lame_s_ring_is_that_of_elements_and_edges(order, edges, least, most):
    """Chords cost all but the second order, parabolas the fifth: why elements of fourth order have cubic edges."""
    coarse, fine = (_lame_error(_sector(n, edges), order) for n in (4, 8))
    assert least < math.log2(coarse / fine) < most


def _exact_matrix(mesh, order, element, digits, points):
    """Stiffness of one element for E = 1 in plane strain, integrated with many digits."""
    with mpmath.workdps(digits):
        corners, sags, leans = textbook.curved_edges(mesh, order, np.array([element]))
        mp = lambda pair: [mpmath.mpf(float(x)) for x in pair]  # noqa: E731
        x = [mp(mesh.points[:, corner]) for corner in corners[0]]
        bent = [(sags[s, 0], leans[s, :, 0]) for s in range(3)]
        nu = mpmath.mpf(3) / 10
        lam, mu = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
        indices = textbook.node_indices(order)
        rule = [((1 + t) / 2, w / 2) for t, w in _gauss(points)]
        n = len(indices)
        d = np.full((n, 2, n, 2), mpmath.mpf(0), dtype=object)
        for s, ws in rule:
            for t, wt in rule:
                areal = (1 - s, s * (1 - t), s * t)
                by = [[], [], []]
                for c in range(2):
                    moves = textbook.edge_moves(
                        areal, [mp(sag)[c] for sag, _ in bent], [(mp(a)[c], mp(b)[c]) for _, (a, b) in bent]
                    )[1]
                    for i in range(3):
                        by[i].append(x[i][c] + moves[i])
                a, b = ([by[k][c] - by[0][c] for c in range(2)] for k in (1, 2))
                det = a[0] * b[1] - a[1] * b[0]
                slopes = [textbook.silvester(order, index, areal)[1] for index in indices]
                u, v = (np.array([g[k] - g[0] for g in slopes], dtype=object) for k in (1, 2))
                g = np.stack([(u * b[1] - v * a[1]) / det, (v * a[0] - u * b[0]) / det], axis=1)
                d += np.multiply.outer(g, g) * (ws * wt * s * abs(det))
        k = np.empty_like(d)
        for p in range(2):
            q = 1 - p
            k[:, p, :, p] = (lam + 2 * mu) * d[:, p, :, p] + mu * d[:, q, :, q]
            k[:, p, :, q] = lam * d[:, p, :, q] + mu * d[:, q, :, p]
        return k.reshape(2 * n, 2 * n).astype(float)


def _gauss(points):
    legendre = lambda x: mpmath.legendre(points, x)  # noqa: E731
    roots = [mpmath.findroot(legendre, float(x)) for x in np.polynomial.legendre.leggauss(points)[0]]
    return [(x, 2 * (1 - x * x) / (points * mpmath.legendre(points - 1, x)) ** 2) for x in roots]


@pytest.mark.dear("4-True-9")
@pytest.mark.parametrize(
    ("order", "curved", "points"),
    [
        (2, False, 3),
        (3, False, 4),
        (4, False, 5),
        (2, True, 9),
        (4, True, 9),
        pytest.param(3, True, 9, marks=pytest.mark.long),
    ],
)
def test_element_matrices_against_integration_with_40_digits(order, curved, points):
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    mesh = mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings().scaled(2.0))
    on_fillet = np.flatnonzero(np.isin(mesh.triangles[3:], mesh.edges["fillet"][2]).any(axis=0))
    outline = np.concatenate([edges[2] for edges in mesh.edges.values()])
    inside = np.flatnonzero(~np.isin(mesh.triangles[3:], outline).any(axis=0))
    element = int(on_fillet[len(on_fillet) // 2] if curved else inside[0])
    found = assemble(mesh, NU, "strain", order).stiffness[element]
    exact = _exact_matrix(mesh, order, element, 40, points)
    assert np.abs(found - exact).max() < (1e-9 if curved else 1e-13) * np.abs(exact).max()


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_stress_at_the_nodes_of_quadratic_displacements_is_exact(plane):
    mesh = _sector(3, "straight")
    terms = np.random.default_rng(5).standard_normal((mesh.teeth, 2, 5))  # of x, y, x^2, x y, y^2
    x, y = mesh.points
    u = terms @ np.stack([x, y, x * x, x * y, y * y])
    by_x = terms @ np.stack([np.ones_like(x), 0 * x, 2 * x, y, 0 * x])
    by_y = terms @ np.stack([0 * x, np.ones_like(x), 0 * x, x, 2 * y])
    xx, yy, shear = by_x[:, 0], by_y[:, 1], by_y[:, 0] + by_x[:, 1]
    found = nodal_stress(mesh, u, NU, plane)
    # Hooke's law the other way round: strains of the stresses found.
    sx, sy, sxy, sz = found.transpose(1, 0, 2)
    assert np.abs(sx - NU * (sy + sz) - xx).max() < 1e-12
    assert np.abs(sy - NU * (sx + sz) - yy).max() < 1e-12
    assert np.abs(2 * (1 + NU) * sxy - shear).max() < 1e-12
    assert np.abs(sz - NU * (sx + sy) if plane == "strain" else sz).max() < 1e-12


def test_cubic_elements_that_turn_inside_out_are_refused():
    mesh = _sector(3, "cubic")
    wild = {"flank": mesh.bends["flank"] - 8.0 * mesh.points[:, None, mesh.edges["flank"][2]]}
    with pytest.raises(InputError, match="inverted curved elements"):
        assemble(replace(mesh, bends=wild), NU, "strain", 4)


def test_meshes_whose_cubic_edges_turn_an_element_inside_out_are_drawn_finer():
    """The quadratic elements of this coarse mesh are sound, a cubic one beside the small fillet was not.

    Meshes of plane teeth had none among 90 tried; those of solid teeth are frontal.
    """
    tooth = Tooth(105, BasicRack(1.0, 1.25, 0.0454), 0.076)
    rough = MeshSettings(root_fraction=0.2, junction_edge_length=0.003, tip_growth=0.22).scaled(LEVEL_RATIO**3)
    coarse, cubic = (replace(rough, order=order) for order in (2, 4))
    quadratic, finer = (
        mesh_sector(tooth, 0.1 * tooth.root_radius, settings, frontal=True) for settings in (coarse, cubic)
    )
    with pytest.raises(InputError, match="inverted curved elements"):
        assemble(quadratic, NU, "strain", 4)
    assert finer.triangles.shape[1] > quadratic.triangles.shape[1]
    assemble(finer, NU, "strain", 4)


def test_scikit_fem_has_nothing_to_remark(caplog):
    """Its remarks on the order of arrays would stand between the user's lines."""
    tooth = Tooth(28)
    mesh = mesh_sector(tooth, 0.1 * tooth.root_radius, MeshSettings().scaled(0.7))
    assert mesh.vertex_count > 800
    assemble(mesh, NU, "strain", 4)
    assert caplog.records == []
