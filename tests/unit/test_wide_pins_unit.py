"""Ring gears with their width on pins: compared with the whole ring solved at once, the plane, and their laws."""

import math

import numpy as np
import pytest
from scipy.sparse import block_array, csc_array
from scipy.sparse.linalg import splu

import fegear
from fegear.base.errors import InputError, RangeError
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.tooth_on_pins import tooth_on_pins
from fegear.fem.solid.bands import bands, loads_of
from fegear.fem.solid.dissection import condense_solid
from fegear.fem.solid.face import face_functions, function_counts, solid_unknowns
from fegear.fem.solid.pinned_rim import pins_on
from fegear.fem.solid.rim import solid_rim
from fegear.fem.solid.section import make_section
from fegear.fem.solid.sector import flank_nodes, section_mesh
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slices import solve_slices
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rack import BasicRack
from fegear.geometry.rim_support import RimSupport

NU, TEETH, WIDTH = 0.3, 24, 2.0
TOOTH = InternalTooth(TEETH, PinionCutter(12, 0.0, 1.2, tip_radius=0.2), profile_shift=0.0, tip_radius=11.5)
COARSE = SolidSettings().scaled(1.8)
TAU = math.tan(math.radians(20.0)) / 12.0
PRESSED = bands([11.8, 12.2, 12.5], [-0.5, 0.1, 0.6], 0.35, 0.25)
ONE = bands(12.2, 0.1, 0.35, 0.25)
FIVE = RimSupport(5, 2.0, 0.3)


def solved(support, tau=TAU, rim=1.0, width=WIDTH, settings=COARSE, **how):
    return solve_solid(TOOTH, tau, width, NU, TOOTH.root_radius + rim, settings, support=support, **how)


@pytest.mark.parametrize(
    ("support", "rim"),
    [
        (FIVE, 1.0),
        pytest.param(RimSupport(9, 1.0, 0.1), 0.5, marks=pytest.mark.long),
        pytest.param(RimSupport(24, 1.5), 2.0, marks=pytest.mark.long),
    ],
)
def test_without_axial_motion_it_is_the_plane_ring_on_pins(support, rim):
    mesh = mesh_sector(TOOTH, TOOTH.root_radius + rim, COARSE.section)
    plane = solve_influence(TOOTH, mesh, NU, "strain", order=3, margin=0.0, support=support)
    radius, width = np.array([11.8, 12.2, 12.5]), np.full(3, 0.25)
    even = bands(radius, 0.0, 0.5 * WIDTH, width, profile="even")
    middle = bands(12.2, 0.0, 0.5 * WIDTH, 0.25, profile="even")
    solid = solved(support, 0.0, rim, mesh=mesh, plane_strain=True, compared=middle)
    section = make_section(mesh, 3, 0.0, NU, TOOTH.base_radius, side=TOOTH.side)
    inward = section.axes[flank_nodes(section), :2, 0]
    up = plane.flank.normal_patches(plane.flank.arc_of_radius(radius), width)
    loads = np.concatenate([up * inward[:, :1], up * inward[:, 1:]])
    size = np.abs(loads.T @ plane.compliance[0] @ loads).max()
    for k in (-1, 0, 1):
        wanted = loads.T @ plane.compliance[k] @ loads
        np.testing.assert_allclose(WIDTH * solid.deflection(k, even, even), wanted, atol=1e-7 * size)
        stress, wanted = solid.fillet_stress(k, "tension", even, [0.3])[0, :, 0], plane.stress[k, "tension"] @ loads
        np.testing.assert_allclose(WIDTH * stress, wanted, atol=1e-7 * np.abs(wanted).max())
    each = [tooth_on_pins(plane, tooth) for tooth in range(plane.pins.teeth)]
    wanted = [(loads.T @ one.compliance[0] @ loads)[1, 1] for one in each]
    np.testing.assert_allclose(WIDTH * solid.uneven.deflection, wanted, atol=1e-7 * size)
    wanted = [(one.stress[0, "compression"] @ loads[:, 1]).min() for one in each]
    np.testing.assert_allclose(WIDTH * solid.uneven.root_compression, wanted, rtol=0.02)  # of points, and between them


def parts(tau, support, width=WIDTH, rim=1.0, settings=COARSE):
    """Section, functions along the face, unknowns and what pins hold."""
    mesh = section_mesh(TOOTH, TOOTH.root_radius + rim, settings.section, None, frontal=True)
    section = make_section(mesh, 3, tau, NU, TOOTH.base_radius, side=TOOTH.side)
    face = face_functions(width, settings.degree(width))
    known = solid_unknowns(section, face, settings, bore_held=False)
    return section, face, known, pins_on(section, face, function_counts(section, face, settings), support, TEETH)


@pytest.mark.long
@pytest.mark.parametrize("tau", [0.0, TAU])
def test_whole_rings_on_pins_solved_at_once_answer_alike(tau):
    """All 24 sectors and the pins in one system: no harmonics, and tooth by tooth."""
    solid = solved(FIVE, tau, compared=ONE)
    section, face, known, pins = parts(tau, FIVE)
    every = np.arange(3)
    one, other = (known.of((3 * n[:, None] + every).ravel()) for n in (section.side_a, section.side_b))
    outer = known.number[pins.unknowns]
    ports = 3 * flank_nodes(section)
    flank = known.of(ports)
    kept = np.unique(np.concatenate([section_unknowns.ravel() for section_unknowns in (
        3 * section.side_a[:, None] + every, 3 * section.side_b[:, None] + every, pins.unknowns, ports)]))  # fmt: skip
    sector = condense_solid(section, face, known, kept)
    inner = np.setdiff1d(sector.kept, one)
    number = np.full((TEETH, known.size), -1)
    for k in range(TEETH):
        number[k, inner] = k * inner.size + np.arange(inner.size)
    for k in range(TEETH):
        number[k, one] = number[k - 1, other]
    at = number[:, sector.kept]
    n, count = sector.kept.size, TEETH * inner.size
    entries = np.tile(sector.stiffness.ravel(), TEETH)
    place = np.repeat(at, n, axis=1).ravel(), np.tile(at, (1, n)).ravel()
    matrix = csc_array((entries, place), (count, count))
    columns = next(iter(pins.weights.values())).shape[2]
    held = np.zeros((count, FIVE.pins * columns))
    there = outer >= 0
    for (pin, k), weight in pins.weights.items():
        np.add.at(held[:, pin * columns : (pin + 1) * columns], number[k % TEETH][outer[there]], weight[there])
    assert pins.first == FIVE.pins
    system = splu(block_array([[matrix, csc_array(held)], [csc_array(held.T), None]]).tocsc())
    load, bands_load = loads_of(ONE, solid.flank, face)[:, 0], loads_of(PRESSED, solid.flank, face)
    mean = {k: np.zeros((3, 3)) for k in (-1, 0, 1)}
    for tooth in range(TEETH):
        force = np.zeros((count + held.shape[1], 4))
        force[number[tooth, flank]] = np.column_stack([load, bands_load])
        moved = system.solve(force)
        alone = load @ moved[number[tooth, flank], 0]
        assert alone == pytest.approx(solid.uneven.deflection[tooth], rel=1e-7)
        for k in mean:
            mean[k] += bands_load.T @ moved[number[(tooth + k) % TEETH, flank]][:, 1:] / TEETH
    for k, wanted in mean.items():
        found = solid.deflection(k, PRESSED, PRESSED)
        np.testing.assert_allclose(found, wanted, atol=1e-7 * np.abs(mean[0]).max())


@pytest.mark.parametrize("tau", [0.0, TAU, -2.0 * TAU])
def test_what_a_pin_holds_of_a_moving_body_is_known(tau):
    """Means over the arc of a straight pin in space, of translations and turns; twisted sectors lie aslant to it."""
    support, outer = RimSupport(3, 2.5, 0.7), TOOTH.root_radius + 1.0
    settings = SolidSettings()
    section, face, _, pins = parts(tau, support, 4.0, settings=settings)
    rim = solid_rim(section, face, function_counts(section, face, settings))
    motions = rim.motions[pins.unknowns]
    half = 0.5 * support.width / outer
    for pin in range(pins.first):
        a = support.angle + 2.0 * math.pi * pin / 3
        found = 0.0
        for (which, k), weight in pins.weights.items():
            if which == pin:
                turned = motions @ rim.turned(2.0 * math.pi * k / TEETH)
                found += np.einsum("nfj,nfd->jd", weight, turned)
        full = (found.shape[0] - 1) // 2
        s, c, near = (
            math.sin(a),
            math.cos(a),
            outer * math.sin(half) / half,
        )  # near: mean reach to the pin
        wanted = np.zeros((2 * full + 1, 6))
        wanted[0, :2], wanted[full, :2] = (s, c), (c, -s)
        wanted[full, 5] = -near  # a turn is counterclockwise
        # Tilts: at a height z the body moves by z across; P_1 = 2 z / width has the mean 1/3 with itself.
        wanted[1, 3:5], wanted[full + 1, 3:5] = 4.0 / 6.0 * np.array([-c, s]), 4.0 / 6.0 * np.array([s, c])
        wanted[-1, 2], wanted[-1, 3:5] = 1.0, (near * c, -near * s)
        np.testing.assert_allclose(found, wanted, atol=2e-4 * outer)


def test_a_ring_turned_under_its_pins_is_the_next_tooth():
    pitch = 2.0 * math.pi / TEETH
    one, other = solved(FIVE, compared=ONE), solved(RimSupport(5, 2.0, 0.3 - pitch), compared=ONE)
    for name in ("deflection", "root_tension", "root_compression"):
        there, here = getattr(one.uneven, name), getattr(other.uneven, name)
        np.testing.assert_allclose(np.roll(there, -1), here, rtol=1e-8)
    size = np.abs(one.compliance[0]).max()
    assert one.uneven.deflection.mean() == pytest.approx(one.deflection(0, ONE, ONE)[0, 0], rel=1e-9)
    for k in (0, 1):
        np.testing.assert_allclose(one.compliance[k], other.compliance[k], atol=1e-9 * size)
        np.testing.assert_allclose(one.compliance[k], one.compliance[-k].T, atol=1e-9 * size)


@pytest.mark.long
def test_the_other_hand_is_its_mirror_image():
    support, mirrored = RimSupport(6, 1.0, 0.2), bands([11.8, 12.2, 12.5], [0.5, -0.1, -0.6], 0.35, 0.25)
    one, other = solved(support, compared=ONE), solved(support, -TAU, compared=bands(12.2, -0.1, 0.35, 0.25))
    for k in (0, 1):
        found, wanted = other.deflection(k, mirrored, mirrored), one.deflection(k, PRESSED, PRESSED)
        np.testing.assert_allclose(found, wanted, atol=1e-8 * np.abs(wanted).max())
    np.testing.assert_allclose(one.uneven.root_tension, other.uneven.root_tension, rtol=1e-7)


@pytest.mark.long
def test_a_spur_ring_of_vanishing_twist_is_the_one_that_is_solved_in_two_halves():
    apart, together = (solved(RimSupport(2, 2.0, 0.3), tau, compared=ONE) for tau in (0.0, 1e-9))
    for k in (0, 1):
        one, other = (known.deflection(k, PRESSED, PRESSED) for known in (apart, together))
        np.testing.assert_allclose(other, one, rtol=1e-5)
    np.testing.assert_allclose(apart.uneven.root_tension, together.uneven.root_tension, rtol=1e-5)


@pytest.mark.long
def test_pins_all_over_the_circle_are_the_held_circle():
    radius = TOOTH.root_radius + 4.0
    held = solved(None, rim=4.0)
    size, last = np.abs(held.deflection(0, PRESSED, PRESSED)).max(), math.inf
    for pins in (6, 12, 24):
        every = solved(RimSupport(pins, 2.0 * math.pi * radius / pins), rim=4.0)
        apart = np.abs(every.deflection(0, PRESSED, PRESSED) - held.deflection(0, PRESSED, PRESSED)).max() / size
        assert apart < 0.7 * last
        last = apart
    assert last < 0.02
    assert every.uneven.deflection.size == 1


def test_supports_that_only_whole_rings_have_are_refused_of_others():
    with pytest.raises(RangeError, match="is available for complete internal rings only,"):
        solve_solid(Tooth(20, BasicRack(), 0.0), 0.0, WIDTH, NU, 4.0, COARSE, support=FIVE)
    with pytest.raises(RangeError, match="is available for complete internal rings only,"):
        solved(FIVE, sector_teeth=5)
    with pytest.raises(RangeError, match="is not available with width ="):
        solve_slices(Tooth(20, BasicRack(), 0.0), 0.0, WIDTH, NU, 4.0, COARSE, support=FIVE)


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
rim_support = { kind = "pins", pins = 6, width = "12 mm" }
"""


@pytest.mark.dear
def test_a_case_says_how_far_teeth_on_pins_differ(tmp_path):
    path = tmp_path / "ring.toml"
    path.write_text(CASE)
    remarks = " ".join(fegear.run(path).remarks)
    assert "compliance varies over 10 consecutive teeth because of its 6 pins" in remarks
    assert (
        ": flexible ring rim; each planet-ring mesh is computed separately, rim deflection at one planet due to "
        "the others is neglected."
    ) in remarks
    path.write_text(CASE.replace("positions = 3", 'positions = 3, source = "slices"'))
    with pytest.raises(InputError, match="is not available with width ="):
        fegear.run(path)
