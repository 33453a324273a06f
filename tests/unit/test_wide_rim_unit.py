"""Ring gears with their width in a spline: their limits, laws and refusals."""

import math

import numpy as np
import pytest

import fegear
from fegear.base.errors import RangeError
from fegear.case.built.solid_influence import check_solid_gear
from fegear.case.reading import read_scene
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.solid.bands import bands
from fegear.fem.solid.face import face_functions, function_counts, solid_unknowns
from fegear.fem.solid.rim import solid_rim
from fegear.fem.solid.section import make_section
from fegear.fem.solid.sector import flank_nodes, section_mesh
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rack import BasicRack
from fegear.geometry.rim_support import RimSupport

NU, WIDTH = 0.3, 3.0
RING = InternalTooth(36, PinionCutter(20, tip_radius=0.25), profile_shift=-0.1, tip_radius=17.3)
COARSE = SolidSettings().scaled(1.6)
TAU = math.tan(math.radians(20.0)) / 18.0
PRESSED = bands([17.9, 18.3, 18.6], [-0.9, 0.2, 1.0], 0.4, 0.2)


def solved(tau=0.0, rim=1.0, settings=COARSE, **how):
    support = how.pop("support", RimSupport())
    return solve_solid(RING, tau, WIDTH, NU, RING.root_radius + rim, settings, support=support, **how)


@pytest.mark.parametrize("rim", [3.0, 0.4])
def test_without_axial_motion_it_is_the_plane_ring_in_a_spline(rim):
    mesh = mesh_sector(RING, RING.root_radius + rim, COARSE.section)
    plane = solve_influence(RING, mesh, NU, "strain", order=3, margin=0.0, support=RimSupport())
    solid = solved(rim=rim, mesh=mesh, plane_strain=True)
    radius, width = np.array([17.7, 18.2, 18.6]), np.full(3, 0.2)
    even = bands(radius, 0.0, 0.5 * WIDTH, width, profile="even")
    inward = make_section(mesh, 3, 0.0, NU, RING.base_radius, side=RING.side).axes[flank_nodes_of(mesh), :2, 0]
    up = plane.flank.normal_patches(plane.flank.arc_of_radius(radius), width)
    at_nodes = np.concatenate([up * inward[:, :1], up * inward[:, 1:]])
    for k in (-1, 0, 1):
        found = WIDTH * solid.deflection(k, even, even)
        np.testing.assert_allclose(found, at_nodes.T @ plane.compliance[k] @ at_nodes, rtol=1e-8)
        stress, wanted = solid.fillet_stress(k, "tension", even, [0.3])[0, :, 0], plane.stress[k, "tension"] @ at_nodes
        np.testing.assert_allclose(WIDTH * stress, wanted, atol=1e-8 * np.abs(wanted).max())


def flank_nodes_of(mesh):
    return flank_nodes(make_section(mesh, 3, 0.0, NU, RING.base_radius, side=RING.side))


@pytest.mark.parametrize("tau", [0.0, TAU])
def test_teeth_answer_each_other(tau):
    known = solved(tau)
    size = np.abs(known.deflection(0, PRESSED, PRESSED)).max()
    for k in (0, 1):
        there, back = (known.deflection(one, PRESSED, PRESSED) for one in (k, -k))
        np.testing.assert_allclose(there, back.T, atol=1e-10 * size)


def test_a_spur_ring_of_vanishing_twist_is_the_one_that_is_solved_in_two_halves():
    """Motions that mirror themselves and all others are solved apart for a spur ring, together for a twisted one."""
    apart, together = solved(), solved(1e-9)
    for k in (0, 1):
        one, other = (known.deflection(k, PRESSED, PRESSED) for known in (apart, together))
        np.testing.assert_allclose(other, one, rtol=1e-6)


@pytest.mark.parametrize("tau", [0.0, TAU])
def test_rigid_motions_are_those_of_a_body_and_tractions_are_as_even(tau):
    outer = RING.root_radius + 1.0
    mesh = section_mesh(RING, outer, COARSE.section, None, frontal=True)
    section = make_section(mesh, 3, tau, NU, RING.base_radius, side=RING.side)
    face = face_functions(WIDTH, COARSE.degree(WIDTH))
    known = solid_unknowns(section, face, COARSE, bore_held=False)
    rim = solid_rim(section, face, function_counts(section, face, COARSE))
    assert (known.number[3 * section.nodes_of("bore")] >= 0).any()
    z = np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 5)
    moved = np.einsum("nca,nakd,kz->nczd", section.axes, rim.motions.reshape(-1, 3, face.count, 6), face.values(z))
    x, y = section.places[:, :, None]
    c, s = np.cos(tau * z), np.sin(tau * z)
    place = np.stack(np.broadcast_arrays(c * x - s * y, s * x + c * y, z))  # in space
    space = np.stack([
        c[:, None] * moved[:, 0] - s[:, None] * moved[:, 1], s[:, None] * moved[:, 0] + c[:, None] * moved[:, 1],
        moved[:, 2],
    ])  # fmt: skip
    for i in range(3):
        unit = np.eye(3)[i]
        np.testing.assert_allclose(space[..., i], np.broadcast_to(unit[:, None, None], place.shape), atol=1e-6)
        np.testing.assert_allclose(space[..., 3 + i], np.cross(unit, place, axis=0), atol=1e-6 * outer)
    # Work of the tractions on the motions: the area, and the moments of inertia of all sectors' cylinder.
    work = np.einsum("nkd,nke->de", rim.motions, rim.tractions)
    turns = np.stack([rim.turned(2.0 * math.pi * k / RING.teeth) for k in range(RING.teeth)])
    area = 2.0 * math.pi * outer * WIDTH
    tilt = 0.5 * outer**2 + WIDTH**2 / 12.0
    wanted = area * np.diag([1.0, 1.0, 1.0, tilt, tilt, outer**2])
    found = np.einsum("kab,ac,kcd->bd", turns, work, turns)
    np.testing.assert_allclose(found, wanted, atol=1e-6 * np.abs(wanted).max())


def test_a_thick_rim_is_held_less_than_one_whose_outside_is_fixed():
    free, held = solved(rim=8.0), solved(rim=8.0, support=None)
    one, other = (np.diag(known.deflection(0, PRESSED, PRESSED)) for known in (free, held))
    assert (one > other).all()
    stress, fixed = (known.largest_root_stress(0, "compression", PRESSED, [0.0])[0] for known in (free, held))
    assert np.abs(stress).max() > np.abs(fixed).max()


@pytest.mark.dear
def test_far_outside_it_matters_little_how_a_spur_rim_is_held():
    """Stress that tractions far outside leave at the teeth falls with their distance, as in the plane."""
    free, held = solved(rim=100.0), solved(rim=100.0, support=None)
    in_the_middle = bands([17.9, 18.6], 0.0, 0.4, 0.2)
    for side in ("tension", "compression"):
        one, other = (known.largest_root_stress(0, side, in_the_middle, [0.0])[0] for known in (free, held))
        np.testing.assert_allclose(one, other, rtol=0.01)


@pytest.mark.long
def test_the_other_hand_is_its_mirror_image():
    one, other = solved(TAU, rim=0.4), solved(-TAU, rim=0.4)
    mirrored = bands([17.9, 18.3, 18.6], [0.9, -0.2, -1.0], 0.4, 0.2)
    for k in (0, 1):
        found, wanted = other.deflection(k, mirrored, mirrored), one.deflection(k, PRESSED, PRESSED)
        np.testing.assert_allclose(found, wanted, atol=1e-8 * np.abs(wanted).max())


def test_supports_that_solid_rings_do_not_have_are_refused():
    with pytest.raises(RangeError, match="is available for complete internal rings only,"):
        solve_solid(Tooth(20, BasicRack(), 0.0), 0.0, WIDTH, NU, 4.0, COARSE, support=RimSupport())
    with pytest.raises(RangeError, match="is available for complete internal rings only,"):
        solved(sector_teeth=5)


CASE = """
results = ["stiffness"]
stiffness = { face_positions = 1, positions = 3 }
accuracy = { tolerance = 0.1 }
[gear.r]
internal = true
teeth = 60
module = "4 mm"
face_width = "4 mm"
profile_shift = 0.2
cutter = { teeth = 20, profile_shift = 0.1, addendum = 1.25, tip_radius = 0.25 }
rim_thickness = "12 mm"
rim_support = SUPPORT
"""


@pytest.mark.dear
def test_cases_take_splines_with_a_width(tmp_path):
    path = tmp_path / "ring.toml"
    path.write_text(CASE.replace("SUPPORT", '{ kind = "splined" }'))
    check_solid_gear(read_scene(path), "r")
    assert any(
        ": flexible ring rim; each planet-ring mesh is computed separately, rim deflection at one planet due "
        "to the others is neglected." in remark
        for remark in fegear.run(path).remarks
    )
