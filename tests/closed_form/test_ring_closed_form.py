"""The condensed ring against closed forms: Lame's annulus, torsion, plane strain as a plane stress, observed orders."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import FegearError
from fegear.fem.plane.condensation import condense
from fegear.fem.plane.contact_width import curvature_slope, log_slope
from fegear.fem.plane.elasticity import assemble
from fegear.fem.plane.mesh import SectorMesh, with_middle_nodes
from fegear.fem.plane.ring_closure import close_ring, coupling_by_doubling, coupling_by_harmonics
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

INNER, OUTER = 3.0, 5.0


def annulus(teeth, radial, around):
    """A sector of a plain ring, meshed by hand; its outer rim is called flank."""
    half = math.pi / teeth
    r, t = np.meshgrid(np.linspace(INNER, OUTER, radial + 1), np.linspace(-half, half, around + 1), indexing="ij")
    place = lambda rr, tt: np.stack([rr * np.sin(tt), rr * np.cos(tt)])  # noqa: E731
    number = np.arange(r.size).reshape(r.shape)
    a, b, c, d = (x.ravel() for x in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    triangles = np.hstack([np.stack([a, b, c]), np.stack([a, c, d])])
    angles, radii = np.linspace(-half, half, around + 1), np.linspace(INNER, OUTER, radial + 1)
    mid = lambda v: 0.5 * (v[1:] + v[:-1])  # noqa: E731
    chains = {"bore": number[0], "flank": number[-1, ::-1], "side_a": number[::-1, 0], "side_b": number[:, -1]}
    middles = {
        "bore": place(INNER, mid(angles)),
        "flank": place(OUTER, mid(angles[::-1])),
        "side_a": place(mid(radii[::-1]), -half),
        "side_b": place(mid(radii), half),
    }
    points, six, edges = with_middle_nodes(place(r.ravel(), t.ravel()), triangles, chains, middles)
    return SectorMesh(points, six, edges, teeth)


def rim_motion(teeth, radial, around, order, direction, nu=0.3):
    """Mean radial and tangential motion of the rim under a uniform traction of one on all sectors."""
    mesh = annulus(teeth, radial, around)
    elasticity = assemble(mesh, nu, "strain", order)
    dofs = elasticity.edge_dofs["flank"]
    ring = close_ring(mesh, elasticity, np.unique(dofs), teeth // 2, expandable=True)
    x, w = np.polynomial.legendre.leggauss(6)
    xi = 0.5 + 0.5 * x
    from fegear.fem.plane.trace import lagrange, quadratic_edge

    position, tangent = quadratic_edge(mesh.points[:, mesh.edges["flank"]], xi)
    out = position / np.hypot(*position)
    force = out if direction == "radial" else np.stack([out[1], -out[0]])
    values = np.einsum("iq,cnq,nq,q->cin", lagrange(order, xi), force, np.hypot(*tangent), 0.5 * w)
    loads = np.zeros(ring.size)
    np.add.at(loads, dofs, values)
    loaded = np.unique(dofs)
    sectors = range(-(teeth // 2), (teeth + 1) // 2)
    response = ring.field(loaded, loads[loaded, None], list(sectors))
    total = sum(response[k][:, 0] for k in sectors)
    middle = dofs[:, 0, around // 2]
    node = mesh.points[:, mesh.edges["flank"][0, around // 2]]
    radial_part = total[middle] @ node / np.hypot(*node)
    return radial_part, float(total[middle] @ (np.array([node[1], -node[0]]) / np.hypot(*node)))


@functools.cache
def four_square(order, factor, poisson=0.3, plane="strain"):
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    mesh = mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings().scaled(0.7 * factor))
    return solve_influence(tooth, mesh, poisson, plane, order=order, margin=0.3)


def energy(known):
    """Pressure-weighted deflection under one smooth load, and the neighbour's."""
    arc = known.flank.arc_of_radius(np.array([13.9]))
    load = known.flank.patches(arc, np.array([0.25]))
    return np.array([float((load.T @ known.compliance[k] @ load)[0, 0]) for k in (0, 1)])


@pytest.mark.dear("2-factors0-2.6")
@pytest.mark.parametrize(
    ("order", "factors", "slope"),
    [(2, (2.8, 2.0, 1.4, 1.0), 2.6), (3, (4.0, 2.8, 2.0, 1.4), 3.6), (4, (4.8, 3.4, 2.4), 4.0)],
)
def test_observed_order_of_convergence_in_energy(order, factors, slope):
    # 2 p on smooth problems; the sharp tip corner and meshes drawn anew for each size cost some of it.
    reference = energy(four_square(4, 1.4))
    errors = np.array([np.abs(energy(four_square(order, f)) / reference - 1.0)[0] for f in factors])
    assert np.polyfit(np.log(factors), np.log(errors), 1)[0] > slope
    assert errors[-1] < {2: 2e-4, 3: 1e-4, 4: 1e-4}[order]


@pytest.mark.dear("2-factors0-2.0", "3-factors1-2.7", "4-factors2-3.0")
@pytest.mark.parametrize(
    ("order", "factors", "slope"),
    [(2, (4.0, 2.8, 2.0, 1.4, 1.0), 2.0), (3, (5.6, 4.0, 2.8, 2.0, 1.4), 2.7), (4, (4.0, 2.8, 2.0, 1.4), 3.0)],
)
def test_observed_order_of_convergence_of_the_root_stress(order, factors, slope):
    # p for a derivative; the surface's own strain at Gauss points does a little better on the average over positions.
    def stress(p, factor):
        known, radii = four_square(p, factor), np.linspace(13.5, 14.9, 15)
        return np.concatenate([known.largest_root_stress(0, s, radii)[0] for s in ("tension", "compression")])

    reference = stress(4, 0.8)
    errors = [np.sqrt(np.mean((stress(order, f) / reference - 1.0) ** 2)) for f in factors]
    assert np.polyfit(np.log(factors), np.log(errors), 1)[0] > slope
    assert errors[-1] < 2e-3


def test_plane_strain_is_plane_stress_with_changed_constants():
    # E' = E / (1 - nu^2), nu' = nu / (1 - nu).
    nu = 0.3
    strain, stress = four_square(2, 2.0, nu, "strain"), four_square(2, 2.0, nu / (1 - nu), "stress")
    for k in (0, 1):
        assert np.allclose(strain.compliance[k], stress.compliance[k] * (1 - nu**2), rtol=1e-9, atol=1e-12)


@pytest.mark.dear
def test_deflection_is_the_mean_over_the_contact_and_a_quarter_of_the_half_plane_s_logarithm():
    # The pressure of a wide contact itself, against mean deflections of wider and narrower ones and closed forms.
    known = four_square(4, 0.8)
    radii = np.linspace(13.4, 14.7, 9)
    assert np.allclose(known.self_compliance(radii, 0.12, 0.08), known.mean_compliance(radii, 0.08), rtol=1e-5)


def test_self_compliance_does_not_depend_on_the_patch_from_root_to_tip():
    known = four_square(4, 0.8)
    radii = np.sqrt(np.linspace(known.flank.lowest_radius**2, known.flank.highest_radius**2, 10))
    narrow, wide = (known.self_compliance(radii, a, 0.02) for a in (0.06, 0.12))
    assert np.abs(wide / narrow - 1.0).max() < 1e-4


def test_narrower_true_contacts_add_the_half_plane_s_logarithm():
    known = four_square(2, 1.0)
    by_formula = known.self_compliance([14.0], 0.1, 0.5e-4) - known.self_compliance([14.0], 0.1, 1e-4)
    assert by_formula == pytest.approx(2 * (1 - 0.09) / math.pi * math.log(2.0), rel=1e-4)


@pytest.mark.parametrize(("nu", "plane"), [(0.3, "strain"), (0.0, "strain"), (0.45, "strain"), (0.3, "stress")])
def test_deflection_on_a_curved_surface_departs_from_the_half_plane_s_in_closed_form(nu, plane):
    # The exact disc: pressure cos(n phi) moves its rim by m_n cos(n phi), m_n = (1/(n-1) + k/(n+1)) (1+nu)/2. Under a
    # semi-elliptic pressure of half-width a its coefficients are 2 J_1(n a) / (n a) / pi, and so is the mean's weight.
    from scipy.special import j1

    k = 3 - 4 * nu if plane == "strain" else (3 - nu) / (1 + nu)
    n = np.arange(2.0, 8e5)

    def mean(a):
        coefficient = 2.0 * j1(n * a) / (n * a)
        return float(np.sum(coefficient**2 * (1 / (n - 1) + k / (n + 1))) * 0.5 * (1 + nu) / math.pi)

    narrow, wide = 0.002, 0.004
    logarithm = log_slope(nu, plane) * math.log(wide / narrow)
    linear = curvature_slope(nu, plane) * 256 / (45 * math.pi**2) * (wide - narrow)
    left = mean(narrow) - mean(wide) - logarithm + linear
    # What is left goes with the square of the width and its logarithm.
    assert abs(left) < 1.5 * (wide**2 - narrow**2)


def test_moments_and_forces_of_every_patch_are_exact():
    flank = four_square(2, 1.0).flank
    arc = np.linspace(flank.flank_start, flank.arc[-1], 17)
    loads = flank.patches(arc, np.full(17, 0.01))
    assert (flank.few_patches(arc, np.full(17, 0.01)).toarray() == loads.T).all()
    normal = four_square(2, 1.0).tooth.involute
    roll = np.sqrt(normal.start**2 + 2.0 * (arc - flank.flank_start) / normal.base_radius)
    total = loads.reshape(2, -1, 17).sum(axis=1)
    # The patch follows the flank's curvature, and is cut off at its ends.
    assert np.abs(total + normal.normals(roll))[:, 1:-1].max() < 5e-3
    assert np.hypot(*total) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("teeth", [8, 9, 30])
def test_lame_annulus_under_uniform_tension(teeth):
    # u_r = A r + B / r with u(INNER) = 0 and sigma_rr(OUTER) = 1 in plane strain.
    nu = 0.3
    lam, mu = nu / ((1 + nu) * (1 - 2 * nu)), 0.5 / (1 + nu)
    a = 1.0 / (2 * (lam + mu) + 2 * mu * INNER**2 / OUTER**2)
    exact = a * (OUTER - INNER**2 / OUTER)
    errors = []
    for n in (1, 2, 4):
        found, sideways = rim_motion(teeth, 3 * n, 2 * n, 2, "radial")
        errors.append(max(abs(found / exact - 1.0), abs(sideways / exact)))
    assert errors[-1] < 1e-4
    assert math.log2(errors[0] / errors[-1]) / 2 > 2.7


def test_torsion_of_the_annulus():
    # tau = OUTER^2 / r^2, u_theta = (OUTER^2 / 2 mu) (r / INNER^2 - 1 / r).
    mu = 0.5 / 1.3
    exact = OUTER**2 / (2 * mu) * (OUTER / INNER**2 - 1.0 / OUTER)
    found, outward = rim_motion(12, 8, 4, 2, "tangential")[::-1]
    assert found == pytest.approx(exact, rel=1e-4)
    assert abs(outward) < 1e-4 * exact


@pytest.mark.parametrize(
    ("teeth", "shift", "bore", "nu"),
    [
        (8, 0.0, 0.5, 0.3),
        (8, 0.5, 0.3, 0.3),
        (12, 0.0, 0.95, 0.3),
        (28, 0.0, 0.5, 0.49),
        (28, 0.0, 0.5, -0.5),
        (500, 0.0, 0.95, 0.3),
        (200, -0.5, 0.5, 0.3),
    ],
)
def test_hard_gears_give_finite_monotone_answers(teeth, shift, bore, nu):
    tooth = Tooth(teeth, BasicRack.named("A"), shift)
    known = solve_influence(tooth, mesh_sector(tooth, bore * tooth.root_radius, MeshSettings()), nu, "strain")
    radii = np.linspace(known.flank.lowest_radius, known.flank.highest_radius, 30)
    c = known.self_compliance(radii, 0.08, 0.02)
    assert np.isfinite(c).all()
    # From a tenth of the flank up a tooth is softer the higher it is loaded.
    assert (np.diff(c[3:]) > 0.0).all()
    coupling = np.abs(np.diagonal(known.neighbour(1, radii, radii, 0.08)))
    assert (coupling < c).all()
    assert np.array_equal(
        known.neighbour(1, radii, radii, 0.08), known.neighbour(-1, radii, radii, 0.08).T
    ) or np.allclose(
        known.neighbour(1, radii, radii, 0.08), known.neighbour(-1, radii, radii, 0.08).T, rtol=1e-9, atol=1e-12
    )
    tension = known.largest_root_stress(0, "tension", radii[5:])[0]
    assert (tension > 0.0).all()
    assert (known.largest_root_stress(0, "compression", radii)[0] < 0.0).all()


@pytest.mark.parametrize("short_by", [1e-9, 1e-6, 1e-4, 1e-3])
def test_racks_that_are_all_but_full_lead_to_the_full_fillet(short_by):
    """A root land of a millionth of a module once cost millions of elements, or turned one inside out."""

    def answers(rack):
        tooth = Tooth(28, rack)
        known = solve_influence(tooth, mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings()), 0.3, "strain")
        radii = np.array([14.0, 14.8])
        assert known.mesh.triangles.shape[1] < 4000
        return known.self_compliance(radii, 0.08), known.largest_root_stress(0, "tension", radii)[0]

    full = BasicRack.full_fillet()
    nearly = answers(BasicRack(tip_radius=full.tip_radius - short_by, addendum=1.0, dedendum=1.25))
    for found, limit in zip(nearly, answers(full), strict=True):
        assert found == pytest.approx(limit, rel=5e-4 + 2.0 * short_by)


def test_a_rounded_tip_carries_load_without_a_kink_at_the_end_of_the_flank():
    tooth = Tooth(28, tip_rounding=0.12)
    known = solve_influence(tooth, mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings()), 0.3, "strain")
    assert not known.flank.upper_corner
    assert known.flank.flank_end < known.flank.arc[-1]
    radii = np.sqrt(np.linspace(tooth.form_radius**2, tooth.involute_tip_radius**2, 60))
    c = known.self_compliance(radii, 0.08, 0.02)
    assert (np.diff(c[-10:], 2) > 0.0).all()


@pytest.mark.parametrize(("teeth", "reach"), [(9, 2), (28, 3), (101, 1), (500, 2)])
def test_joining_sectors_two_and_two_is_summing_harmonics(teeth, reach):
    # A random stiff sector: its sides tied to each other and, softly, to the ground.
    links = np.random.default_rng(1).standard_normal((30, 6))
    sector = links.T @ links + 1e-3 * np.eye(6)
    by_joining, by_harmonics = (f(sector, teeth, reach) for f in (coupling_by_doubling, coupling_by_harmonics))
    largest = np.abs(by_harmonics[0]).max()
    for k in range(-reach, reach + 1):
        assert np.abs(by_joining[k] - by_harmonics[k]).max() < 1e-11 * largest


def test_condensation_of_a_sector_is_the_schur_complement_and_expands_to_the_whole_solution():
    tooth = Tooth(12)
    mesh = mesh_sector(tooth, 0.5 * tooth.root_radius, MeshSettings().scaled(5.0))
    for order in (2, 3, 4):
        elasticity = assemble(mesh, 0.3, "strain", order)
        whole = np.zeros((elasticity.size, elasticity.size))
        for dofs, matrix in zip(elasticity.element_dofs, elasticity.stiffness, strict=True):
            whole[np.ix_(dofs, dofs)] += matrix
        held, kept = np.unique(elasticity.edge_dofs["bore"]), np.unique(elasticity.edge_dofs["flank"])[::-1]
        gone = np.setdiff1d(np.arange(elasticity.size), np.concatenate([held, kept]))
        inner = np.linalg.solve(whole[np.ix_(gone, gone)], whole[np.ix_(gone, kept)])
        schur = whole[np.ix_(kept, kept)] - whole[np.ix_(kept, gone)] @ inner
        found = condense(elasticity, kept, held, expandable=True)
        assert np.abs(found.stiffness - schur).max() < 1e-10 * np.abs(schur).max()
        given = np.random.default_rng(2).standard_normal((kept.size, 2))
        u = found.expand(given)
        assert np.abs(u[gone] + inner @ given).max() < 1e-10 * np.abs(u).max()
        assert (u[held] == 0.0).all()
        assert (u[kept] == given).all()


def test_a_sector_that_nothing_holds_is_refused():
    mesh = annulus(12, 2, 2)
    elasticity = assemble(mesh, 0.3, "strain", 2)
    loose = replace(elasticity, stiffness=np.zeros_like(elasticity.stiffness))
    with pytest.raises(FegearError, match="not positive definite"):
        close_ring(mesh, loose, np.unique(elasticity.edge_dofs["flank"]))
