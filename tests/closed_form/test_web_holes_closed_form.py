"""Laws of gears whose web has holes: what holes take from a web, and how its teeth differ."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import GeometryError, RangeError
from fegear.base.solution_cache import SolutionCache
from fegear.base.store import Store
from fegear.fem.plane.elements import check_cubic_edges, sector_elements
from fegear.fem.plane.holed_ring import holed_ring
from fegear.fem.solid.bands import bands
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.holed_web import Waves, lost_stiffness, wave_weights
from fegear.fem.solid.influence import solid_influence
from fegear.fem.solid.section import make_section
from fegear.fem.solid.sector import section_mesh
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.fem.solid.tooth_over_holes import as_if_all_were, tooth_over_holes
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear_body import GearBody, WebHoles
from fegear.geometry.rack import BasicRack

TOOTH, BORE, FACE = Tooth(12, BasicRack(1.0, 1.25, 0.25), 0.3), 1.2, 1.0
PITCH = 2.0 * math.pi / TOOTH.teeth
SETTINGS = SolidSettings().scaled(2.2)
#: The web fills the face, which takes few functions along it; gears whose web does not are those of CalculiX.
HOLES = WebHoles(8, 2.75, 0.6, 0.2)
BODY = GearBody(3.9, 1.7, (-0.5, 0.5), (-0.5, 0.5), holes=HOLES)
BAND = bands(6.3, 0.2, 0.4, 0.25, after=0.3)


def solved(holes, tau=0.0, mesh=None):
    body = replace(BODY, holes=holes)
    return solve_solid(TOOTH, tau, FACE, 0.3, BORE, SETTINGS, body=body, mesh=mesh, compared=BAND)


@pytest.fixture(scope="module")
def eight():
    """Twelve teeth over eight holes: three in a row differ."""
    return solved(HOLES)


def alike(one, other, tolerance):
    for k in one.compliance:
        size = np.abs(one.compliance[0]).max()
        np.testing.assert_allclose(other.compliance[k], one.compliance[k], atol=tolerance * size)
    for key, moved in one.displacement.items():
        np.testing.assert_allclose(other.displacement[key], moved, atol=tolerance * np.abs(moved).max())


def test_a_hole_that_cannot_be_meshed_is_refused_by_its_key():
    """One of 84 modules between a hub of ten and the teeth of a gear of 200 modules."""
    with pytest.raises(RangeError, match="cannot be meshed: inverted elements between") as found:
        holed_ring(1, (5.0275, 88.975), 47.00125, 41.85375, 14.74, 3)
    assert found.value.key == "body.holes"


def test_work_is_the_same_both_ways(eight):
    for tooth in range(3):
        there, back = tooth_over_holes(eight, tooth), tooth_over_holes(eight, tooth + 1)
        size = np.abs(there.compliance[0]).max()
        np.testing.assert_allclose(there.compliance[1].T, back.compliance[-1], atol=1e-9 * size)
        np.testing.assert_allclose(there.compliance[0].T, there.compliance[0], atol=1e-9 * size)


def test_a_gear_is_the_mean_of_its_teeth_and_they_come_again(eight):
    each = [tooth_over_holes(eight, tooth) for tooth in range(3)]
    for k, mean in eight.compliance.items():
        np.testing.assert_allclose(np.mean([one.compliance[k] for one in each], axis=0), mean, atol=1e-9)
    alike(each[1], tooth_over_holes(eight, 4), 1e-9)
    for tooth, one in enumerate(each):
        assert eight.uneven.deflection[tooth] == pytest.approx(one.deflection(0, BAND, BAND)[0, 0], rel=1e-9)
    assert np.ptp(eight.uneven.deflection) > 0.002 * eight.uneven.deflection.mean()


@pytest.mark.dear
def test_one_tooth_may_stand_for_all(eight):
    for tooth in range(3):
        alone, one = as_if_all_were(eight, tooth), tooth_over_holes(eight, tooth)
        np.testing.assert_allclose(alone.compliance[0], one.compliance[0], atol=1e-9)
        np.testing.assert_allclose(alone.compliance[1].T, alone.compliance[-1], atol=1e-12)
    last = replace(BODY, holes=replace(HOLES, tooth=2))
    known = solid_influence(TOOTH, 0.0, FACE, 0.3, BORE, SETTINGS, body=last, estimate_error=False).fine
    wanted = as_if_all_were(solve_solid(TOOTH, 0.0, FACE, 0.3, BORE, SETTINGS, body=BODY), 2)
    alike(wanted, known, 1e-12)


@pytest.mark.dear
def test_what_is_kept_on_disk_has_all_teeth(tmp_path):
    def found():
        cache = SolutionCache(Store(tmp_path))
        return solid_influence(TOOTH, 0.0, FACE, 0.3, BORE, SETTINGS, body=BODY, estimate_error=False, cache=cache).fine

    first, again = found(), found()
    assert again.seconds == first.seconds
    alike(tooth_over_holes(first, 2), tooth_over_holes(again, 2), 1e-12)


@pytest.mark.dear
def test_holes_turned_by_a_pitch_meet_the_next_tooth(eight):
    alike(tooth_over_holes(eight, 0), tooth_over_holes(solved(replace(HOLES, angle=HOLES.angle + PITCH)), 1), 1e-9)


@pytest.mark.dear
def test_a_hole_below_each_tooth_is_alike_to_all():
    solution = solved(WebHoles(TOOTH.teeth, 2.75, 0.3, 0.1))
    assert solution.uneven.deflection.size == 1
    alike(tooth_over_holes(solution, 0), tooth_over_holes(solution, 5), 1e-9)
    alike(solution, tooth_over_holes(solution, 0), 1e-9)


@pytest.mark.dear
def test_small_holes_leave_the_plain_web():
    """What a hole takes goes with its area."""
    mesh = section_mesh(TOOTH, BORE, SETTINGS.section, BODY, frontal=True)
    plain, small, twice = (
        solved(holes, mesh=mesh) for holes in (None, replace(HOLES, radius=0.03), replace(HOLES, radius=0.06))
    )
    off = [one.compliance[0] - plain.compliance[0] for one in (small, twice)]
    assert 0.0 < np.abs(off[0]).max() < 1e-3 * np.abs(plain.compliance[0]).max()
    np.testing.assert_allclose(off[1], 4.0 * off[0], atol=0.05 * np.abs(off[1]).max())


@pytest.mark.dear
def test_a_helical_gear_sees_straight_holes():
    """Turned with the helix by all that it turns along the face, holes of both ends of the face are as far apart."""
    tau = 0.12
    left, right = solved(HOLES, tau), solved(replace(HOLES, angle=HOLES.angle + PITCH), tau)
    alike(tooth_over_holes(left, 0), tooth_over_holes(right, 1), 1e-9)
    there, back = tooth_over_holes(left, 0), tooth_over_holes(left, 1)
    np.testing.assert_allclose(
        there.compliance[1].T, back.compliance[-1], atol=1e-9 * np.abs(there.compliance[0]).max()
    )


@pytest.mark.parametrize("tau", [0.0, 0.25])
def test_waves_are_straight_in_a_helical_gear(tau):
    """A radial motion cos(3 phi) and an axial one sin(phi) z of straight lines, seen by a section that turns with z."""
    section = make_section(section_mesh(TOOTH, BORE, SETTINGS.section, BODY), 3, tau, 0.3, TOOTH.base_radius, BODY)
    face, waves = FaceFunctions((-0.5, 0.5), (9,)), Waves((5, 5), FaceFunctions((-0.5, 0.5), (4,)))
    weights, circles = wave_weights(section, face, waves)
    nodes, (z, weight) = circles[::3] // 3, face.quadrature(least=20)
    values, own = face.values(z), waves.face.values(z)
    along = np.linalg.solve((values * weight) @ values.T, values * weight)
    x, y = section.places[:, nodes]
    phi, found = np.arctan2(x, y), np.zeros(waves.size, dtype=complex)
    for tooth in range(TOOTH.teeth):
        there = phi[:, None] + tooth * PITCH - tau * z
        radial = np.stack([np.sin(phi), np.cos(phi), 0.0 * phi])
        moved = radial[:, :, None] * np.cos(3.0 * there) + np.eye(3)[2][:, None, None] * np.sin(there) * z
        moved = np.linalg.solve(section.axes[nodes], np.einsum("cnq,fq->ncf", moved, along))
        found += np.exp(-1.0j * waves.orders * tooth * PITCH) * np.einsum(
            "wuf,uf->w", weights, moved.reshape(-1, values.shape[0])
        )
    wanted = np.zeros(waves.size, dtype=complex)
    line = np.linalg.lstsq(own.T, z, rcond=None)[0]
    for order in (3, -3):
        wanted[waves.number[:, 5 + order, 0, 0]] = 0.5
    for order in (1, -1):
        wanted[waves.number[:, 5 + order, 2]] = -0.5j * order * line
    np.testing.assert_allclose(found, wanted, atol=2e-3)


@pytest.mark.dear
def test_holes_take_stiffness_and_none_against_rigid_motions():
    waves = Waves((6, 7), FaceFunctions((-0.4, 0.4), (2,)))
    lost = lost_stiffness(WebHoles(3, 4.0, 0.8, 0.3), (2.5, 5.5), waves, 0.3, 3, 1.2)
    assert np.linalg.eigvalsh(lost)[-1] < 1e-9 * np.abs(lost).max()
    number = waves.number
    axial, turn, shift = np.zeros((3, waves.size), dtype=complex)
    one = 7 + 1
    axial[number[:, 7, 2, 0]] = 1.0  # the first function is one
    turn[number[:, 7, 1, 0]] = (2.5, 5.5)
    # Along y: radial cos(phi), clockwise -sin(phi).
    for order, sign in ((one, 1.0), (7 - 1, -1.0)):
        shift[number[:, order, 0, 0]] = 0.5
        shift[number[:, order, 1, 0]] = 0.5j * sign
    for motion in (axial, turn, shift):
        # Waves at the nodes of an element are as good as its edges are short.
        assert np.abs(lost @ motion).max() < 1e-4 * np.abs(lost).max()


@pytest.mark.parametrize(
    ("holes", "ring", "middle", "hole"),
    [
        (1, (3.2, 5.5), 4.3, 0.8),
        (2, (7.3, 16.5), 12.0, 3.5),
        (8, (7.3, 16.5), 12.0, 4.3),
        (30, (15.0, 19.0), 17.0, 1.5),
    ],
)
def test_a_part_of_a_ring_has_its_area(holes, ring, middle, hole):
    part = holed_ring(holes, ring, middle, hole, 0.25 * ring[1] / math.sqrt(holes), 3)
    check_cubic_edges(part.mesh)
    area = np.asarray(sector_elements(part.mesh, 3).basis().dx).sum(axis=1)
    whole = math.pi * (ring[1] ** 2 - ring[0] ** 2) / holes
    assert area.sum() == pytest.approx(whole, rel=1e-4)
    assert area[part.filled].sum() == pytest.approx(math.pi * hole**2, rel=2e-3)


def test_whatever_is_not_refused_is_drawn():
    """Random webs and holes; what is drawn inside out is refused by the mesh itself."""
    rng, drawn = np.random.default_rng(7), 0
    while drawn < 60:
        root = rng.uniform(6.0, 120.0)
        rim = root - rng.uniform(0.3, 4.0)
        hub = rng.uniform(0.1, 0.9) * rim
        radius = rng.uniform(0.02, 0.5) * (rim - hub)
        middle = rng.uniform(hub + radius, rim - radius)
        count = int(rng.integers(1, math.pi / math.asin(min(1.0, radius / middle)) + 1))
        holes = WebHoles(count, middle, radius)
        body = GearBody(rim, hub, (-1.0, 1.0), (-1.0, 1.0), holes=holes)
        try:
            holes.check(body, 1.0, root, None)
        except GeometryError:
            continue
        drawn += 1
        ring = body.holed_ring
        part = holed_ring(count, ring, middle, radius, rng.uniform(0.1, 0.4) * (ring[1] - ring[0]), 3)
        assert (part.mesh.jacobians > 0.0).all()


def test_open_rows_of_teeth_have_no_holes():
    with pytest.raises(RangeError, match="are available for full 3D gears only"):
        solve_solid(
            TOOTH, 0.0, FACE, 0.3, BORE, SETTINGS, body=BODY, sector_teeth=5
        )  # fmt: skip
