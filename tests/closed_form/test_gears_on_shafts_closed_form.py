"""Bodies of gears on their shafts: long ones are a thicker shaft, rigid shafts stay rigid, finer ones change little."""

import math

import numpy as np
import pytest

from fegear.fem.revolved_body import RevolvedBody, condensed
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import stiff
from fegear.shafts.gear_on_shaft import GearOnShaft
from fegear.shafts.gearbox import Gearbox
from fegear.shafts.held import LoadedShaft, Seat
from fegear.shafts.mesh import MeshPlace
from fegear.shafts.section import Section

BORE, ROOT, E, NU = 0.02, 0.03, 206e9, 0.3


def _body(width, root=ROOT, rings=None, held=None):
    half = 0.5 * width
    return RevolvedBody(root, width, rings or ((BORE, -half, half),), held or (-half, half), NU)


def _shaft(width, e=E, at=0.15, **given):
    gear = GearOnShaft(_body(width, **given), at, E)
    return Shaft((Section(2.0 * at, 2.0 * BORE),), e, NU, (gear,))


@pytest.mark.parametrize(("way", "within"), [(5, 2e-3), (4, 0.02), (3, 0.02)])
def test_more_of_a_long_body_bends_and_twists_as_a_thicker_shaft(way, within):
    """Ends of the body have their own give: of two lengths what the longer one has more is that of a prism.

    Seats stay round, so bent bodies cannot contract across: that is 1.7 % of their stiffness.
    """
    found = []
    for width in (0.2, 0.24):
        shaft = _shaft(width)
        loads = np.zeros((1, 6))
        loads[0, way] = 1.0
        found.append(shaft.bent([shaft.length], np.array([shaft.length]), loads)[0, way])
    prisms = [1.0 / (E * math.pi / 4.0 * r**4) * (1.0 + NU if way == 5 else 1.0) for r in (ROOT, BORE)]
    assert found[1] - found[0] == pytest.approx(0.04 * (prisms[0] - prisms[1]), rel=within)


@pytest.mark.parametrize("rings", [None, ((0.055, -0.02, 0.02), (0.03, 0.004, 0.01), (BORE, -0.01, 0.015))])
def test_bodies_resist_no_motion_as_a_whole_and_carry_it_to_their_teeth(rings):
    gear = GearOnShaft(_body(0.04, 0.06, rings, None if rings is None else (-0.01, 0.015)), 0.15, E)
    motion = np.random.default_rng(1).normal(size=6)

    def moved(z):
        """The body as a whole, at places along the shaft."""
        found = np.tile(motion, (z.size, 1))
        found[:, 0] += motion[4] * (z - 0.15)
        found[:, 1] -= motion[3] * (z - 0.15)
        return found

    root = gear.root(0.3)
    forces = np.einsum("sam,sa->m", root, moved(gear.places))
    assert np.abs(forces).max() < 1e-9 * np.linalg.norm(root) * np.abs(motion).max()
    z = 0.15 + np.linspace(-0.02, 0.02, 17)
    carried = np.einsum("kapb,pb->ka", gear.carried(z, 0.3), moved(gear.places))
    assert carried == pytest.approx(moved(z), abs=1e-11)


def test_faces_beyond_the_end_of_a_shaft_are_carried_by_its_end():
    whole, short = _shaft(0.04), _shaft(0.04)
    short = Shaft((Section(0.15, 2.0 * BORE),), E, NU, short.gears)
    end = Shaft((Section(0.15, 2.0 * BORE),), math.inf, NU, short.gears)
    loads = np.array([[100.0, -50.0, 0.0, 3.0, 2.0, 5.0]])
    moved = [one.bent([0.1], np.array([0.1]), loads) for one in (whole, short)]
    assert moved[0] == pytest.approx(moved[1], rel=1e-9)  # what lies beyond a load moves no place before it
    assert end.bent([0.15], np.array([0.15]), loads) == pytest.approx(0.0, abs=1e-30)
    gear = short.gears[0]
    tilted = np.zeros((gear.places.size, 6))
    tilted[:, 0], tilted[:, 4] = 1e-3 * (np.clip(gear.places, 0.0, 0.15) - 0.15), 1e-3
    turned = np.einsum("kapb,pb->ka", gear.carried(np.array([0.165]), 0.15), tilted)
    assert turned[0, [0, 4]] == pytest.approx([1.5e-5, 1e-3], rel=1e-9)


def test_rigid_shafts_stay_rigid_to_the_last_bit_and_others_answer_alike_both_ways():
    assert not _shaft(0.04, math.inf).compliance([0.1, 0.15, 0.3]).any()
    shaft = _shaft(0.04)
    found = shaft.compliance([0.1, 0.14, 0.3])
    assert found == pytest.approx(np.transpose(found, (2, 3, 0, 1)), rel=1e-9, abs=1e-20)
    loads = np.random.default_rng(2).normal(size=(1, 6)) * 100.0
    assert shaft.bent([0.1, 0.14, 0.3], np.array([0.14]), loads) == pytest.approx(found[:, :, 1] @ loads[0], rel=1e-9)


def test_finer_elements_change_the_body_by_little():
    coarse, fine = (condensed(_body(0.04, 0.06), n) for n in (1, 3))
    for one, other, count in zip((coarse.torsion, coarse.bending), (fine.torsion, fine.bending), (1, 2), strict=True):
        energy = []
        for known, root in ((coarse, one), (fine, other)):
            z = known.seat
            motion = z if count == 1 else np.concatenate([0.5 * z**2, z])
            energy.append(float(np.sum((root.T @ motion) ** 2)))
        assert energy[0] == pytest.approx(energy[1], rel=0.02)
        assert energy[0] > energy[1]


def test_a_web_and_a_short_seat_stiffen_less():
    thick, web = _body(0.04, 0.06), _body(0.04, 0.06, ((0.055, -0.02, 0.02), (BORE, -0.004, 0.004)), (-0.004, 0.004))
    twists = []
    for body in (thick, _body(0.04, 0.06, None, (-0.01, 0.01)), web):
        shaft = Shaft((Section(0.3, 2.0 * BORE),), E, NU, (GearOnShaft(body, 0.15, E),))
        twists.append(shaft.bent([0.3], np.array([0.3]), np.array([[0, 0, 0, 0, 0, 1.0]]))[0, 5])
    bare = 0.3 * (1.0 + NU) / (E * math.pi / 4.0 * BORE**4)
    assert twists[0] < twists[1] < twists[2] < bare


def test_gaps_fall_with_the_stiffness_and_none_is_left_of_rigid_shafts():
    """With order one; to the last bit where shafts and bearings are rigid, whatever the bodies on them are."""

    def gap(e):
        tooth = Tooth(20, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(15.0))
        gears = [Gear(tooth, 3e-3, BORE, 0.03, hand=hand) for hand in ("right", "left")]
        pair = GearPair(*gears)
        body = _body(0.03, gears[0].root_radius)
        bodies = tuple(GearOnShaft(body, at, E if math.isinf(e) else e) for at in (0.04, 0.06))
        mesh = MeshPlace("I", ("a", "b"), (0.04, 0.06), np.array([0.6, 0.8]), 1, pair, 5e3, bodies)
        seats = Seat(stiff(math.inf, math.inf), 0.0), Seat(stiff(math.inf), 0.1)
        shafts = tuple(
            LoadedShaft(Shaft((Section(0.1, 2.0 * BORE),), e, NU, (one,)), seats, np.empty(0), np.empty((0, 6)), name)
            for name, one in zip("ab", bodies, strict=True)
        )
        box = Gearbox(shafts, (0.0, 0.1), (mesh,), np.zeros((20, 20)), ("a", "b"))
        return box.gaps(tuple(one.at(z) for one, z in zip(box.under(box.even), box.places, strict=True)))[0]

    assert 10.0 * gap(1e13) == pytest.approx(gap(1e12), rel=1e-8, abs=1e-18)
    assert not gap(math.inf).any()
