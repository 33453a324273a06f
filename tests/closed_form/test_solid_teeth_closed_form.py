"""Teeth with a width against what is known exactly: plane strain, rigid motions, reciprocity, the mirror, orders."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

from fegear.base.errors import RangeError
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.trace import lagrange
from fegear.fem.solid.bands import bands, hats, loads_of
from fegear.fem.solid.dissection import _smallest
from fegear.fem.solid.face import face_functions
from fegear.fem.solid.fronts import Front
from fegear.fem.solid.influence import solid_influence
from fegear.fem.solid.section import make_section
from fegear.fem.solid.sector import flank_nodes
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25))
BORE = 0.7 * TOOTH.root_radius
#: And a ring.
RING = InternalTooth(36, PinionCutter(20, tip_radius=0.25), profile_shift=-0.1, tip_radius=17.3)
OUTSIDE = RING.root_radius + 3.0
TAU = math.tan(math.radians(20.0)) / 14.0
NU = 0.3
COARSE = SolidSettings().scaled(1.3)
#: Four functions along the face.
CUBIC = replace(COARSE, least_degree=3, waves_per_module=1e-3)


@functools.cache
def solved(tau, width=4.0, settings=COARSE, **how):
    return solve_solid(TOOTH, tau, width, NU, BORE, settings, **how)


@functools.cache
def meshed(tooth, held):
    return mesh_sector(tooth, held, COARSE.section)


@pytest.fixture
def mesh():
    return meshed(TOOTH, BORE)


@pytest.mark.parametrize(
    ("tooth", "held", "radius"),
    [(TOOTH, BORE, [13.3, 13.7, 14.0, 14.5]), (RING, OUTSIDE, [17.6, 18.0, 18.5, 18.8])],
    ids=["gear", "ring"],
)
def test_without_twist_and_axial_motion_it_is_plane_strain(tooth, held, radius):
    mesh = meshed(tooth, held)
    plane = solve_influence(tooth, mesh, NU, "strain", order=3, margin=0.0)
    solid = solve_solid(tooth, 0.0, 2.0, NU, held, CUBIC, mesh=mesh, plane_strain=True)
    radius, width = np.array(radius), np.full(4, 0.2)
    everywhere = bands(radius, 0.0, 1.0, width, profile="even")
    section = make_section(mesh, 3, 0.0, NU, tooth.base_radius, side=tooth.side)
    inward = section.axes[flank_nodes(section), :2, 0]
    up = plane.flank.normal_patches(plane.flank.arc_of_radius(radius), width)
    at_nodes = np.concatenate([up * inward[:, :1], up * inward[:, 1:]])
    exact = plane.flank.patches(plane.flank.arc_of_radius(radius), width)
    for k in (-1, 0, 1):
        found = 2.0 * solid.deflection(k, everywhere, everywhere)
        np.testing.assert_allclose(found, at_nodes.T @ plane.compliance[k] @ at_nodes, rtol=1e-9)
        # a single unknown against the normal at each node: what it leaves out is an interpolation's error
        np.testing.assert_allclose(found, exact.T @ plane.compliance[k] @ exact, rtol=2e-4)
        for side in ("tension", "compression"):
            stress = 2.0 * solid.fillet_stress(k, side, everywhere, [0.3])[:, :, 0]
            wanted = plane.stress[k, side] @ at_nodes
            np.testing.assert_allclose(stress[0], wanted, atol=1e-9 * np.abs(wanted).max())
            np.testing.assert_allclose(stress[1], NU * stress[0], atol=1e-9 * np.abs(wanted).max())


def rigid_motions(section, face, tau):
    """Three translations and three turns, shape (N, functions, 6, 3): v interpolated along the face."""
    z, weight = face.quadrature()
    values, _ = face.at(z)
    x, y = section.places
    c, s = np.cos(tau * z), np.sin(tau * z)
    back = np.zeros((z.size, 3, 3))
    back[:, 0, 0] = back[:, 1, 1] = c
    back[:, 0, 1], back[:, 1, 0], back[:, 2, 2] = s, -s, 1.0
    place = np.stack(
        [np.outer(x, c) - np.outer(y, s), np.outer(x, s) + np.outer(y, c), np.tile(z, (x.size, 1))], axis=2
    )
    moved = [np.broadcast_to(axis, place.shape) for axis in np.eye(3)]
    moved += [np.cross(axis, place) for axis in np.eye(3)]
    v = np.einsum("qab,mnqb->mnqa", back, np.stack(moved))
    # projection on the functions along the face
    coefficients = np.linalg.solve((values * weight) @ values.T, values * weight)
    return np.einsum("kq,mnqa->nkma", coefficients, v)


@pytest.mark.parametrize(("tooth", "held"), [(TOOTH, BORE), (RING, OUTSIDE)], ids=["gear", "ring"])
@pytest.mark.parametrize("tau", [0.0, TAU, -3 * TAU])
def test_rigid_motions_are_free_of_strain(tooth, held, tau):
    section = make_section(meshed(tooth, held), 3, tau, NU, tooth.base_radius, side=tooth.side)
    left = []
    for degree in (3, 5, 14):
        face = face_functions(4.0, degree)
        motion = rigid_motions(section, face, tau)
        local = np.linalg.solve(section.axes[:, None], motion.transpose(0, 1, 3, 2))  # in each node's own axes
        number = np.arange(section.size * face.count).reshape(section.size, -1)
        flat = local.transpose(0, 2, 1, 3).reshape(section.size * face.count, 6)
        force, size = np.zeros_like(flat), 0.0
        for element in range(0, section.centres.shape[1], 7):
            ids = number[np.unique(section.element_dofs[[element]])].ravel()
            front = Front(np.zeros((ids.size, ids.size), order="F"), np.zeros((0, ids.size)), np.zeros((0, 0)))
            _smallest(section, [face.products], number, np.array([element]), front)
            stiffness = np.tril(front.inner) + np.tril(front.inner, -1).T
            force[ids] += stiffness @ flat[ids]
            size = max(size, np.abs(stiffness).max())
        left.append(np.abs(force).max() / (size * np.abs(flat).max()))
    # a twisted motion is a cosine along the face: exact as soon as the degree is high enough
    assert left[-1] < 1e-12
    assert left[0] < 1e-12 if tau == 0.0 else left[0] > 20.0 * left[1] > 400.0 * left[2] > 0.0


@pytest.mark.dear("ring")
@pytest.mark.parametrize("tooth", [TOOTH, RING], ids=["gear", "ring"])
def test_what_acts_there_shows_here(tooth):
    high = tooth.pitch_radius
    one = hats(high, np.linspace(-2.0, 2.0, 6), 0.2, slope=0.1)
    other = bands([high - 0.3, high + 0.3], [-1.2, 0.9], 0.7, 0.15)
    known = solved(TAU) if tooth is TOOTH else solve_solid(RING, TAU, 4.0, NU, OUTSIDE, COARSE)
    for k in (-1, 0, 1):
        there, back = known.deflection(k, one, other), known.deflection(-k, other, one)
        np.testing.assert_allclose(there, back.T, rtol=1e-10)


def test_the_other_hand_is_the_mirror_image():
    left, right = solved(-TAU), solved(TAU)
    pressed = bands([13.4, 14.0, 14.4], [-1.3, 0.2, 1.5], 0.5, 0.2, slope=[0.1, -0.2, 0.3])
    mirrored = bands([13.4, 14.0, 14.4], [1.3, -0.2, -1.5], 0.5, 0.2, slope=[-0.1, 0.2, -0.3])
    for k in (-1, 0, 1):
        here = right.deflection(k, pressed, pressed)
        np.testing.assert_allclose(left.deflection(k, mirrored, mirrored), here, rtol=1e-10)
        for side in ("tension", "compression"):
            stress = right.fillet_stress(k, side, pressed, [-1.0, 0.5])
            image = left.fillet_stress(k, side, mirrored, [1.0, -0.5])
            image[2] *= -1.0
            np.testing.assert_allclose(image, stress, atol=1e-10 * np.abs(stress).max())


def explicit(tooth, settings, tau, width, bore, sectors, closed):
    """Sectors side by side, every unknown of them in one sparse matrix; solved for forces on the middle one."""
    mesh = mesh_sector(tooth, bore, settings.section, frontal=True)
    section = make_section(mesh, settings.section.order, tau, NU, tooth.base_radius)
    face = face_functions(width, settings.degree(width))
    m = face.count
    parts = []
    for a, product in zip(section.stiffness, face.products, strict=True):
        n = section.element_dofs.shape[1]
        rows = np.repeat(section.element_dofs, n, axis=1).ravel()
        columns = np.tile(section.element_dofs, (1, n)).ravel()
        parts.append(sparse.kron(sparse.coo_matrix((a.ravel(), (rows, columns)), (section.size,) * 2), product))
    one = (parts[0] + parts[1] + parts[1].T + parts[2]).tocsr()
    number = np.arange(sectors * section.size).reshape(sectors, -1)
    side = [(3 * nodes[:, None] + np.arange(3)).ravel() for nodes in (section.side_a, section.side_b)]
    for j in range(sectors - 1):
        number[j + 1, side[0]] = number[j, side[1]]
    if closed:
        number[-1, side[1]] = number[0, side[0]]
    every, number = np.unique(number, return_inverse=True)
    number = number.reshape(sectors, -1)
    whole = sparse.csc_matrix((every.size * m,) * 2)
    for j in range(sectors):
        spread = sparse.csr_matrix(
            (np.ones(section.size), (number[j], np.arange(section.size))), (every.size, section.size)
        )
        spread = sparse.kron(spread, sparse.identity(m), format="csr")
        whole = whole + spread @ one @ spread.T
    bore_dofs = number[:, (3 * section.nodes_of("bore")[:, None] + np.arange(3)).ravel()].ravel()
    free = np.setdiff1d(np.arange(every.size * m), (bore_dofs[:, None] * m + np.arange(m)).ravel())
    ports = 3 * flank_nodes(section)
    port = (number[:, ports, None] * m + np.arange(m)).reshape(sectors, -1)
    factor = splu(whole[free][:, free].tocsc())

    def answer(loads):
        right = np.zeros((every.size * m, loads.shape[1]))
        right[port[(sectors - 1) // 2]] = loads
        u = np.zeros_like(right)
        u[free] = factor.solve(right[free])
        return [loads.T @ u[port[j]] for j in range(sectors)]

    return answer


@pytest.mark.dear("16-3")
@pytest.mark.parametrize(("teeth", "row"), [pytest.param(5, 0, marks=pytest.mark.long), (16, 3)])
def test_the_ring_is_an_explicit_ring_of_sectors_and_a_row_an_explicit_row(teeth, row):
    tooth = Tooth(teeth, BasicRack(0.8, 1.25, 0.2), profile_shift=0.5 if teeth < 10 else 0.0)
    base = SolidSettings()
    settings = replace(
        base, section=replace(base.section.scaled(1.4), order=2), least_degree=3, waves_per_module=1e-3, wave_reach=1e6
    )
    bore, tau, width = 0.6 * tooth.root_radius, 0.06, 1.5
    known = solve_solid(tooth, tau, width, NU, bore, settings, sector_teeth=row, reach=1)
    pressed = bands(np.linspace(0.3, 0.9, 3) * (known.flank.highest_radius - known.flank.lowest_radius)
                    + known.flank.lowest_radius, [-0.4, 0.2, 0.5], 0.2, 0.2)  # fmt: skip
    sectors = row or teeth
    answer = explicit(tooth, settings, tau, width, bore, sectors, closed=not row)(
        loads_of(pressed, known.flank, known.face)
    )
    for k in (-1, 0, 1):
        found = known.deflection(k, pressed, pressed)
        np.testing.assert_allclose(found, answer[(sectors - 1) // 2 + k], rtol=1e-9, atol=1e-11 * np.abs(found).max())


@pytest.mark.parametrize(
    ("width", "twist", "held", "said"),
    [
        (0.01, 0.0, None, "face_width = 0.01 modules"),
        (math.nan, 0.0, None, "face_width"),
        (4.0, 0.2, None, "helix_angle = 71.5651 deg at the tip"),
        (4.0, math.nan, None, "helix_angle"),
        (4.0, 0.0, (-3.0, 1.0), "held"),
        (4.0, 0.0, (1.0, 1.0), "held"),
        (500.0, 0.0, None, "face_width = 500 modules"),
    ],
)
def test_what_cannot_be_solved_is_refused(width, twist, held, said):
    with pytest.raises(RangeError, match=said):
        solid_influence(TOOTH, twist, width, NU, BORE, held=held)
    with pytest.raises(RangeError, match="bore_radius"):
        solid_influence(TOOTH, 0.0, 4.0, NU, TOOTH.root_radius)


def test_a_wide_spur_gear_under_an_even_load_tends_to_plane_strain_in_the_middle():
    base = replace(SolidSettings().scaled(2.0), section=replace(SolidSettings().section.scaled(2.5), order=2))
    off = []
    for width, degree in ((4.0, 5), (16.0, 10)):
        settings = replace(base, least_degree=degree, waves_per_module=1e-3, wave_reach=1.0)
        even = bands(14.0, 0.0, 0.5 * width, 0.25, profile="even")
        middle = bands(14.0, 0.0, 0.125 * width, 0.25, profile="even")
        free, plane = (
            solve_solid(TOOTH, 0.0, width, NU, BORE, how, reach=0, plane_strain=plane)
            for how, plane in ((settings, False), (replace(settings, least_degree=3), True))
        )
        moved = [known.deflection(0, middle, even)[0, 0] for known in (free, plane)]
        stress = [known.largest_root_stress(0, "tension", even, [0.0])[0][0, 0] for known in (free, plane)]
        off.append((moved[0] / moved[1] - 1.0, stress[0] / stress[1] - 1.0))
    assert np.all(np.diff(off, axis=0) < 0.0)
    assert np.max(off[-1]) < 0.02


def test_a_hub_that_holds_less_lets_the_tooth_sink_more():
    at, widths = bands(14.0, [-0.6, 0.0, 0.6], 0.4, 0.25), [None, (-1.0, 1.0), (-0.5, 0.5), (-0.2, 0.2)]
    coarse = replace(SolidSettings().scaled(2.0), section=replace(SolidSettings().section.scaled(2.5), order=2))
    moved = [np.diagonal(solved(0.02, 2.0, coarse, held=held, reach=0).deflection(0, at, at)) for held in widths]
    np.testing.assert_allclose(moved[0], moved[1], rtol=1e-12)  # all of the bore
    assert np.all(np.diff(moved[1:], axis=0) > 0.0)


@pytest.mark.dear
def test_an_even_load_converges_along_the_face_faster_than_any_order():
    pressed = bands([13.6, 14.2], 0.0, 1.0, 0.25, profile="even")
    section = replace(SolidSettings().section.scaled(2.0), order=2)
    settings = replace(SolidSettings(), section=section, waves_per_module=1e-3)
    found = {
        n: solve_solid(TOOTH, TAU, 2.0, NU, BORE, replace(settings, least_degree=n, wave_reach=1e6)).deflection(
            0, pressed, pressed
        )
        for n in (3, 5, 7, 11)
    }
    error = [np.abs(found[n] - found[11]).max() for n in (3, 5, 7)]
    orders = np.diff(-np.log(error)) / np.diff(np.log([3, 5, 7]))
    assert orders[0] > 2.0
    assert orders[1] > orders[0]
    assert error[2] < 1e-3 * found[11].max()


@pytest.mark.dear
def test_order_of_convergence_in_the_section():
    """Shorter edges and higher orders both pay; what limits the order is the pressure, whose slope ends with a jump."""
    pressed = bands(14.1, 0.0, 0.75, 0.5, profile="even")
    base = SolidSettings().section

    def moved(order, factor):
        settings = replace(CUBIC, section=replace(base.scaled(factor), order=order))
        return solve_solid(TOOTH, 0.0, 1.5, NU, BORE, settings, reach=0).deflection(0, pressed, pressed)[0, 0]

    exact = moved(4, 0.8)
    error = {(order, factor): abs(moved(order, factor) / exact - 1.0) for order in (2, 3) for factor in (2.0, 1.0)}
    for order in (2, 3):
        assert math.log2(error[order, 2.0] / error[order, 1.0]) > 1.5
    for factor in (2.0, 1.0):
        assert error[3, factor] < 0.2 * error[2, factor]
    assert error[3, 1.0] < 3e-4


def test_bands_stay_on_the_face():
    known = solved(0.0, 2.0, CUBIC)
    with pytest.raises(RangeError, match="is the centre of a band extending beyond the"):
        known.deflection(0, bands(14.0, 0.9, 0.2, 0.2), bands(14.0, 0.0, 0.2, 0.2))
    with pytest.raises(RangeError, match="must be positive"):
        known.deflection(0, bands(14.0, 0.9, 0.0, 0.2), bands(14.0, 0.0, 0.2, 0.2))


def test_hats_add_up_to_an_even_load():
    known = solved(TAU)
    stations = np.linspace(-2.0, 2.0, 9)
    pressed, even = hats(14.0, stations, 0.2), bands(14.0, 0.0, 2.0, 0.2, profile="even")
    share = np.full(9, 0.5 / 4.0)
    share[[0, -1]] *= 0.5
    np.testing.assert_allclose(
        loads_of(pressed, known.flank, known.face) @ share, loads_of(even, known.flank, known.face)[:, 0], atol=1e-14
    )


def test_functions_along_the_face_are_lagrange_s_polynomials_in_other_words():
    face = face_functions(3.0, 6)
    nodes = np.linspace(-1.5, 1.5, 7)
    z = np.linspace(-1.5, 1.5, 50)
    coefficients = np.linalg.inv(face.at(nodes)[0])
    np.testing.assert_allclose(coefficients @ face.at(z)[0], lagrange(6, (z + 1.5) / 3.0), atol=1e-12)


@pytest.mark.dear
@pytest.mark.parametrize("tooth", [TOOTH, RING], ids=["external", "ring"])
def test_motions_that_mirror_at_the_middle_of_the_face_and_the_others_are_all_that_a_spur_disc_does(tooth):
    """Without a twist both are solved apart; with one of no size they are not."""
    bore, settings = (BORE, COARSE) if tooth is TOOTH else (OUTSIDE, COARSE)
    apart, whole = (solve_solid(tooth, tau, 4.0, NU, bore, settings, reach=1) for tau in (0.0, 1e-14))
    for k in (-1, 0, 1):
        assert np.allclose(apart.compliance[k], whole.compliance[k], rtol=0.0, atol=1e-10 * whole.compliance[0].max())
        for side in ("tension", "compression"):
            one, other = apart.displacement[k, side], whole.displacement[k, side]
            assert np.allclose(one, other, rtol=0.0, atol=1e-10 * np.abs(other).max())
