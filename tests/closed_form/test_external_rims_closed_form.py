"""Rims of external plane gears: a web's torsion and full disc, free arcs, whole gears by scikit-fem alone, cracks.

The backup ratio is the rim's thickness over the depth of the teeth.
"""

import functools
import math

import numpy as np
import pytest

from fegear.base.printed import percent
from fegear.case.built.tooth_influence import rollers_that_pull
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.scikit_fem_alone import solve_alone
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import influence_of_shape, solve_gear
from fegear.fem.plane.tooth_on_pins import pulled_share, tooth_on_pins
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack
from fegear.geometry.rim_support import RimSupport

NU, COARSE = 0.3, settings_at(-4)
PATCH, WIDTH = COARSE.patch_half_width, 0.05
SMALL, NASA = Tooth(13, profile_shift=0.3), Tooth(28)
DEPTH = NASA.tip_radius - NASA.root_radius


@functools.cache
def solved(tooth, bore, support=None, plane="stress", reach=1):
    return influence_of_shape(tooth, bore, NU, plane, COARSE, reach, support=support)


def root_stress(found, radius=14.2):
    return float(found.largest_root_stress(0, "tension", [radius], WIDTH)[0][0])


def test_a_web_as_thick_as_the_face_is_the_disc():
    bore = SMALL.root_radius - 0.8
    web = solved(SMALL, bore, RimSupport(web=1.0, inner_radius=2.0))
    disc = solved(SMALL, 2.0)
    r = np.array([SMALL.pitch_radius])
    assert web.self_compliance(r, PATCH, WIDTH) == pytest.approx(disc.self_compliance(r, PATCH, WIDTH), rel=1e-4)
    for side in SIDES:
        one, other = (each.largest_root_stress(0, side, r, WIDTH)[0] for each in (web, disc))
        assert one == pytest.approx(other, rel=2e-3)


def test_a_web_turns_as_a_disc_between_two_circles():
    """Equal loads on all teeth turn it by T / (4 pi G t) (1 / r_1^2 - 1 / r_2^2) more on a smaller hub."""
    bore, share, r, shear = SMALL.root_radius - 0.8, 0.2, np.array([SMALL.pitch_radius]), 0.5 / (1.0 + NU)

    def together(radius):
        found = solved(SMALL, bore, RimSupport(web=share, inner_radius=radius), reach=6)
        return sum(found.neighbour(k, r, r, PATCH)[0, 0] for k in range(-6, 7))

    torque = SMALL.teeth * SMALL.base_radius
    turn = torque / (4.0 * math.pi * shear * share) * (1.0 / 0.5**2 - 1.0 / 0.8**2)
    assert together(0.5) - together(0.8) == pytest.approx(SMALL.base_radius * turn, rel=2e-3)


def test_thin_rims_get_more_root_stress_on_a_web_and_less_on_a_held_bore():
    held, web = (
        [root_stress(solved(NASA, NASA.root_radius - backup * DEPTH, support, "strain")) for backup in (1.0, 0.3)]
        for support in (None, RimSupport(web=0.3, inner_radius=4.0))
    )
    assert held[1] < 0.92 * held[0]
    assert web[1] > 1.15 * web[0]
    assert web[0] == pytest.approx(held[0], rel=0.01)


def test_a_free_arc_of_no_odd_tooth_is_the_ordinary_ring_and_gives_way_the_more_the_longer():
    bore, r = NASA.root_radius - 0.5 * DEPTH, np.array([14.2])
    c = [solved(NASA, bore).self_compliance(r, PATCH, WIDTH)[0]]
    for teeth in (1, 11, 25):
        found = solved(NASA, bore, RimSupport(free_teeth=teeth), reach=2)
        c.append(found.self_compliance(r, PATCH, WIDTH)[0])
        for k in (1, 2):
            ahead, back = found.neighbour(k, r, r + 0.3, PATCH), found.neighbour(-k, r + 0.3, r, PATCH)
            assert ahead == pytest.approx(back.T, rel=1e-9)
    assert c == sorted(c)
    assert c[1] < 1.2 * c[0]
    assert c[-1] > 50.0 * c[0]


WHOLE = (RimSupport(7, 0.8, 0.1, rollers=True), RimSupport(free_teeth=5), RimSupport(web=0.25, inner_radius=2.0))


@pytest.mark.long
@pytest.mark.parametrize("support", WHOLE)
def test_rims_are_those_of_whole_gears_by_scikit_fem(support):
    bore, r = SMALL.root_radius - 0.9, np.array([SMALL.pitch_radius])
    found = tooth_on_pins(solved(SMALL, bore, support, "strain"), 0)
    alone = solve_alone(SMALL, bore, NU, "strain", COARSE, r, WIDTH, support)
    own = found.self_compliance(r, PATCH, WIDTH)
    assert own == pytest.approx(alone.c_self, rel=1e-3)
    for k, whole in ((1, alone.c_next), (-1, alone.c_prev)):
        assert found.neighbour(k, r, r, PATCH)[0] == pytest.approx(whole, abs=1e-3 * own[0])
    for side, whole in (("tension", alone.root_tension), ("compression", alone.root_compression)):
        assert found.largest_root_stress(0, side, r, WIDTH)[0] == pytest.approx(whole, rel=1e-2)


@pytest.mark.parametrize(("backup", "ratio"), [(3.3, -0.08), (1.0, -0.36), (0.5, -1.2), (0.3, -3.1)])
def test_thinner_rims_close_a_crack_the_more_under_the_next_tooth(backup, ratio):
    """K_I under the next tooth's load over that under its own, as rims over a slot have it (NASA TM-107147)."""
    arc, steel = RimSupport(free_teeth=11), Material(1.0, NU, 1.0)
    gear = Gear(NASA, 1.0, NASA.root_radius - backup * DEPTH, 1.0, steel, "stress", support=arc)
    ordinary = solve_gear(gear, COARSE, reach=1, estimate_error=False)
    crack = straight_crack(NASA, mouth_at_tangent(NASA, math.radians(30.0)), math.radians(60.0), depth=0.3)
    found = solve_cracked_gear(ordinary, {0: crack})
    own, beside = (found.stress_intensity(0, j, [14.5])[0][0, 0] for j in (0, 1))
    assert beside / own == pytest.approx(ratio, rel=0.15)


@pytest.mark.parametrize("count", [3, 12])
def test_rollers_that_pull_are_said_with_their_size(count):
    """Three rollers balance a load on one tooth by forces of both senses; pins and a held bore have no such note."""
    tooth = Tooth(25, BasicRack(1.0, 1.25, 0.25))
    bore = tooth.root_radius - 0.5
    found = {}
    for rollers in (True, False):
        support = RimSupport(pins=count, width=0.2, rollers=rollers)
        gear = Gear(tooth, 1.0, bore, 10.0, Material(1.0), support=support)
        found[rollers] = solve_gear(gear, settings_at(-5), reach=1, estimate_error=False)
    known = found[True].fine
    share = pulled_share(known)
    assert pulled_share(found[False].fine) == 0.0
    assert 0.1 < share <= 1.0
    said = rollers_that_pull("g", found[True])
    assert len(said) == 1
    assert percent(share) in said[0]
    pins, load = known.pins, known.remote(np.array([tooth.pitch_radius]), 0.1)[:, 0]
    moved = pins.by_tooth[pins.reach]
    forces = (pins.inverse @ (moved[:, : load.size] @ load))[:count]
    angle = 2.0 * math.pi * np.arange(count) / count
    # a unit load: what the rollers carry across the axis balances it
    assert np.hypot(forces @ np.sin(angle), forces @ np.cos(angle)) == pytest.approx(1.0, rel=1e-3)
    assert min(-forces.min(), forces.max()) / np.abs(forces).max() <= share + 0.01  # of another place of the load
