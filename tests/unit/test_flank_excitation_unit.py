"""Springs of gears with a width: the flanks they come from, roles exchanged, spur gears and a helix that vanishes."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import life_of_contact
from fegear.contact.wide.loaded import FlankPair
from fegear.dynamics.train.flank_excitation import _Life, flank_excitation
from fegear.dynamics.train.mesh_excitation import mesh_excitation, tooth_pair_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

STEEL = Material(206.8e9, 0.3, 7850.0)
MODULE, WIDTH, LOAD = 3e-3, 9e-3, 2000.0
COARSE = SolidSettings().scaled(2.5)


def gear(beta=15.0, hand="right", teeth=20):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "strain", hand if beta else "spur")


def solid(one, settings=COARSE, reach=2, plane_strain=False):
    m = one.module
    return solve_solid(
        one.tooth, one.twist * m, one.face_width / m, 0.3, one.bore_radius / m, settings, reach=reach,
        plane_strain=plane_strain,
    )  # fmt: skip


def flanks_of(first, second, solids, **how):
    return FlankPair(GearPair(first, second), dict(zip(("driver", "driven"), solids, strict=True)), **how)


@pytest.fixture(scope="module")
def solved():
    gears = gear(hand="right"), gear(hand="left", teeth=26)
    return gears, tuple(solid(one) for one in gears)


@pytest.fixture(scope="module")
def flanks(solved):
    gears, solids = solved
    return flanks_of(*gears, solids, positions=24)


@pytest.fixture(scope="module")
def known(flanks):
    return flanks.compliance(LOAD)


LIFTED = FlankGaps(face_position=np.array([-0.5, 0.5]) * WIDTH, line_gap=np.array([0.0, 40e-6]))


@pytest.mark.parametrize("gaps", [FlankGaps(), LIFTED], ids=["aligned", "lifted"])
def test_springs_give_back_the_flanks_at_their_roll_positions(flanks, known, gaps):
    found = flanks.solve([LOAD], gaps, known)
    springs = flank_excitation(flanks, found)
    pitch = flanks.pair.base_pitch
    s = np.mod(found.lines.roll / pitch, 1.0)  # the outermost ones stand just beside the ends of their piece
    np.testing.assert_allclose(springs.approach(LOAD, s), found.transmission_error[:, 0], rtol=1e-6)
    np.testing.assert_allclose(springs.total_stiffness()(s), found.contact.stiffness[:, 0], rtol=1e-6)
    # forces on tooth pairs
    total = np.zeros(s.size)
    for slot in range(len(springs.stiffness)):
        place = springs.place(slot, s) * pitch
        force = springs.tooth_force(slot, s, springs.approach(LOAD, s))
        total += force
        for p, x in enumerate(place):
            j = round((x - found.lines.roll[p]) / pitch)
            on = (found.lines.pair[p] == j) & found.lines.present[p]
            assert force[p] == pytest.approx(found.contact.force[p, on, 0].sum(), abs=2e-3 * LOAD)
    np.testing.assert_allclose(total, LOAD, rtol=1e-9)
    # one tooth pair has no jump from slot to slot, and none at the ends of its life
    start, end = life_of_contact(flanks.pair)
    x = np.arange(math.ceil(start / pitch), math.floor(end / pitch) + 1) * pitch
    before, after = (tooth_pair_at(springs, x + side * 1e-6 * pitch, pitch)[0] for side in (-1, 1))
    np.testing.assert_allclose(after, before, rtol=1e-3, atol=1e-3 * springs.total_stiffness().mean)
    beyond = tooth_pair_at(springs, np.array([start - 0.01 * pitch, end + 0.01 * pitch]), pitch)[0]
    np.testing.assert_array_equal(beyond, 0.0)


def test_more_roll_positions_change_little(solved, flanks, known):
    gears, solids = solved
    springs = flank_excitation(flanks, flanks.solve([LOAD], None, known))
    other = flanks_of(*gears, solids, positions=45)
    again = flank_excitation(other, other.solve([LOAD]))
    s = np.linspace(0.003, 0.997, 211)
    te, wanted = springs.approach(LOAD, s), again.approach(LOAD, s)
    assert np.abs(te - wanted).max() < 0.02 * np.ptp(wanted)
    assert springs.mean_compliance() == pytest.approx(again.mean_compliance(), rel=2e-3)


@pytest.mark.parametrize("positions", [5, 7])
def test_few_even_positions_are_joined_by_straight_lines(solved, positions):
    gears, solids = solved
    few = flanks_of(*gears, solids, positions=positions)
    found = few.solve([LOAD])
    springs = flank_excitation(few, found)
    s = np.mod(found.lines.roll / few.pair.base_pitch, 1.0)
    np.testing.assert_allclose(springs.approach(LOAD, s), found.transmission_error[:, 0], rtol=1e-6)
    s = np.linspace(0.003, 0.997, 211)
    places = np.mod(found.lines.roll / few.pair.base_pitch, 1.0)
    straight = np.interp(s, places[np.argsort(places)], found.transmission_error[np.argsort(places), 0], period=1.0)
    np.testing.assert_allclose(springs.approach(LOAD, s), straight, rtol=1e-6)


def test_the_driven_gear_may_drive(solved, flanks, known):
    """Roles exchanged: the same springs as of the pair described the other way round, solved on its own."""
    gears, solids = solved
    springs = flank_excitation(flanks, flanks.solve([LOAD], None, known), forward=False)
    # seen from the other side the same flanks meet: hands stay, x changes its sign
    other = flanks_of(*gears[::-1], solids[::-1], positions=24)
    again = flank_excitation(other, other.solve([LOAD]))
    s = np.linspace(0.013, 0.987, 83)
    np.testing.assert_allclose(springs.approach(LOAD, s), again.approach(LOAD, s), rtol=2e-3)
    np.testing.assert_allclose(springs.total_stiffness()(s), again.total_stiffness()(s), rtol=2e-2)
    assert springs.first_slot == again.first_slot


@pytest.mark.long
def test_plane_strain_over_the_face_is_the_plane_pair():
    """A spur pair that cannot move along its axis: springs of plane teeth with coupled neighbours."""
    one = gear(0.0)
    plane = finite_element_compliance(solve_gear(one, reach=1))
    solution = solid(one, SolidSettings().scaled(1.7), reach=1, plane_strain=True)
    flanks = flanks_of(one, one, (solution, solution), panel=1.0, positions=16)
    springs = flank_excitation(flanks, flanks.solve([LOAD]))
    wanted = mesh_excitation(Engagement(PairCompliance(flanks.pair, plane, plane)), LOAD)
    s = np.linspace(0.003, 0.997, 101)
    inner = np.min(np.abs(np.mod(s[:, None] - np.mod([flanks.pair.x_start / flanks.pair.base_pitch,
                   flanks.pair.x_end / flanks.pair.base_pitch], 1.0) + 0.5, 1.0) - 0.5), axis=1) > 0.02  # fmt: skip
    assert inner.sum() > 80
    te, plane_te = springs.approach(LOAD, s)[inner], wanted.approach(LOAD, s)[inner]
    np.testing.assert_allclose(te, plane_te, rtol=1.5e-2)  # a coarse solid near the ends of the path
    assert np.median(np.abs(te / plane_te - 1.0)) < 3e-3
    np.testing.assert_allclose(springs.total_stiffness()(s)[inner], wanted.total_stiffness()(s)[inner], rtol=4e-2)
    assert springs.first_slot == wanted.first_slot


@pytest.mark.long
def test_a_helix_that_goes_to_zero_is_a_spur_pair():
    found = []
    for beta in (0.0, 1e-5):
        gears = [gear(beta, hand) for hand in ("right", "left")]
        flanks = flanks_of(*gears, [solid(one) for one in gears], positions=12)
        found.append(flank_excitation(flanks, flanks.solve([LOAD])))
    s = np.linspace(0.023, 0.977, 41)
    spur, helical = (one.approach(LOAD, s) for one in found)
    far = np.abs(helical / spur - 1.0) < 1e-3
    assert far.mean() > 0.9  # but where a pair comes or goes within the width of the looking
    np.testing.assert_allclose(found[1].mean_compliance(), found[0].mean_compliance(), rtol=5e-3)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_phases_belong_to_roll_positions_of_the_base_pitch_that_the_points_begin(direction):
    points = SimpleNamespace(period=2.0, breaks=np.array([1.0, 1.4, 2.2]))
    life = _Life(points, 0, np.empty((0, 0)), np.empty((0, 0)), np.empty(0), direction)
    s = np.array([0.0, 0.1, 0.49, 0.5, 0.74, 1.3, -0.7])
    x, number = life.places(s)
    assert ((x >= 1.0) & (x < 3.0)).all()
    np.testing.assert_allclose(x + 2.0 * number, 2.0 * direction * s, atol=1e-12)
