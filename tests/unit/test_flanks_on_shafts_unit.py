"""Loaded flanks on shafts that they bend: one solution of two meshes, its limits, gaps of their own for each load."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.on_shafts import EvenForces, FlankForces, LoadedShafts, load_gearbox
from fegear.contact.wide.shaft_gaps import ShaftGaps
from fegear.design.flanks.trials import FlankTrials
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.shafts.loaded_shafts import _scales
from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import LooseBearing, stiff
from fegear.shafts.gearbox import Gearbox
from fegear.shafts.held import LoadedShaft, Seat
from fegear.shafts.mesh import MeshPlace
from fegear.shafts.section import Section

MODULE, WIDTH, LOAD = 3e-3, 12e-3, 4000.0
INF = math.inf


def _gear(hand):
    tooth = Tooth(20, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(15.0))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, hand=hand)


@pytest.fixture(scope="module")
def flanks():
    """Right on left and left on right, as the meshes of two stages."""
    gears = {hand: _gear(hand) for hand in ("right", "left")}
    settings = SolidSettings().scaled(1.7)
    solved = {
        hand: solve_solid(g.tooth, g.twist * MODULE, WIDTH / MODULE, 0.3, g.bore_radius / MODULE, settings, reach=2)
        for hand, g in gears.items()
    }
    found = []
    for one, other in (("right", "left"), ("left", "right")):
        pair = GearPair(gears[one], gears[other])
        found.append(FlankPair(pair, {"driver": solved[one], "driven": solved[other]}, positions=4))
    return found


SEATS = stiff(2e8, 2e8), stiff(1e8)


def _gearbox(flanks, e=206e9, seats=SEATS):
    pairs = [one.pair for one in flanks]
    meshes = (
        MeshPlace("I", ("in", "mid"), (0.03, 0.03), np.array([1.0, 0.0]), 1, pairs[0], LOAD),
        MeshPlace("II", ("mid", "out"), (0.07, 0.07), np.array([0.6, 0.8]), -1, pairs[1], LOAD),
    )
    shafts = tuple(
        LoadedShaft(Shaft((Section(0.1, d),), e, 0.3), (Seat(seats[0], 0.0), Seat(seats[1], 0.1)), np.empty(0),
                    np.empty((0, 6)), name)
        for name, d in (("in", 0.022), ("mid", 0.025), ("out", 0.028))
    )  # fmt: skip
    return Gearbox(shafts, (0.0, None, 0.1), meshes, np.zeros((30, 30)), ("in", "mid", "out"))


def _meshes(flanks, box):
    return [
        FlankForces(one, FlankGaps(), one.compliance(LOAD), mesh.heights)
        for one, mesh in zip(flanks, box.meshes, strict=True)
    ]


@pytest.mark.dear
def test_two_meshes_together_are_the_converged_iteration_of_their_parts(flanks):
    box = _gearbox(flanks)
    meshes = _meshes(flanks, box)
    (found,) = load_gearbox(box, meshes, [1.0])
    assert found.left < 1e-9
    gaps = [np.zeros_like(gap) for gap in found.gaps]
    for _ in range(60):
        forces = tuple(one.under(gap, LOAD)[0] for one, gap in zip(meshes, gaps, strict=True))
        moved = tuple(one.at(z) for one, z in zip(box.under(forces), box.places, strict=True))
        new = box.gaps(moved)
        change = max(float(np.abs(one - other)[0].max()) for one, other in zip(gaps, new, strict=True))
        gaps = [0.6 * one + 0.4 * other for one, other in zip(gaps, new, strict=True)]
        if change < 1e-14:
            break
    for one, other, force, by_hand in zip(gaps, found.gaps, forces, found.forces, strict=True):
        assert other == pytest.approx(one, rel=1e-6, abs=1e-13)
        assert by_hand[0] == pytest.approx(force[0], rel=1e-6)
        assert by_hand[0].sum() == pytest.approx(LOAD, rel=1e-9)
    assert all(one.balance.max() < 1e-9 for one in found.bent)


def test_rigid_shafts_on_rigid_bearings_change_no_bit(flanks):
    box = _gearbox(flanks, INF, (stiff(INF, INF), stiff(INF)))
    states = load_gearbox(box, _meshes(flanks, box), [0.5, 1.0])
    for one, mesh in zip(flanks, box.meshes, strict=True):
        gaps = FlankGaps(shafts=LoadedShafts(box, states, (True, True)).gaps_of(mesh.pair))
        known = one.compliance(LOAD)
        loads = [0.5 * LOAD, LOAD]
        assert (one.solve(loads, gaps, known).contact.force == one.solve(loads, None, known).contact.force).all()


@pytest.mark.dear
def test_stiffness_to_infinity_converges_with_order_one(flanks):
    one, off = flanks[0], []
    known = one.compliance(LOAD)
    perfect = one.solve([LOAD], None, known).line_load
    for more in (1e2, 1e3, 1e4):
        box = _gearbox(flanks, 206e9 * more, (stiff(2e8 * more, 2e8 * more), stiff(1e8 * more)))
        states = load_gearbox(box, _meshes(flanks, box), [1.0])
        gaps = FlankGaps(shafts=LoadedShafts(box, states, (True, True)).gaps_of("I"))
        off.append(float(np.abs(one.solve([LOAD], gaps, known).line_load - perfect).max()))
    assert off[0] > 0.0
    assert off[0] / off[1] == pytest.approx(10.0, rel=0.05)
    assert off[1] / off[2] == pytest.approx(10.0, rel=0.005)


def test_a_load_that_moves_gives_way_to_what_shafts_open(flanks):
    """The load leaves the side that opens; fed back it misaligns its mesh less than an even load does."""
    box = _gearbox(flanks)
    even = [EvenForces(mesh.even / mesh.load) for mesh in box.meshes]
    fed = _meshes(flanks, box)
    (stays,), (moves,) = load_gearbox(box, even, [1.0]), load_gearbox(box, fed, [1.0])
    for mesh, one, other in zip(box.meshes, stays.gaps, moves.gaps, strict=True):
        slope = [float(np.polyfit(mesh.heights, gap[0], 1)[0]) for gap in (one, other)]
        assert 0.0 < slope[1] / slope[0] < 1.0
    opened = moves.gaps[0][0]
    assert moves.forces[0][0][int(opened.argmin())] > moves.forces[0][0][int(opened.argmax())]


def test_each_load_has_its_own_gap(flanks):
    """With clearance in its bearings a lightly loaded shaft lies askew all the same."""
    seats = (replace(LooseBearing(2e8, 2e8), radial_clearance=20e-6), stiff(1e8, 1e8))
    box = _gearbox(flanks, seats=seats)
    states = load_gearbox(box, _meshes(flanks, box), [0.3, 1.0])
    shafts = LoadedShafts(box, states, (True, True)).gaps_of("I")
    light, full = shafts.gap[:, 0, -1]
    assert light != pytest.approx(0.3 * full, rel=0.1)
    one, loads = flanks[0], [0.3 * LOAD, LOAD]
    known = one.compliance(LOAD)
    together = one.solve(loads, FlankGaps(shafts=shafts), known)
    for i, load in enumerate(loads):
        alone = one.solve([load], FlankGaps(shafts=shafts).under(load), known)
        assert together.contact.force[:, :, i] == pytest.approx(alone.contact.force[:, :, 0], rel=1e-9, abs=1e-9)
    between = shafts.under(0.65 * LOAD).gap[0]
    assert between == pytest.approx(0.5 * (shafts.gap[0] + shafts.gap[1]), rel=1e-12)
    assert not ShaftGaps().given


def test_designs_try_modifications_at_the_gap_of_each_load(flanks):
    box = _gearbox(flanks, seats=(LooseBearing(2e8, 2e8, radial_clearance=20e-6), stiff(1e8, 1e8)))
    states = load_gearbox(box, [EvenForces(mesh.even / mesh.load) for mesh in box.meshes], [0.3, 1.0])
    gaps = FlankGaps(shafts=LoadedShafts(box, states, (False, False)).gaps_of("I"))
    one, loads = flanks[0], np.array([0.3 * LOAD, LOAD])
    known = one.compliance(LOAD)
    numbers = np.array([0.0, 0.0, 0.0, 0.0, 5e-6, 0.0, 0.0, 3e-6, 0.0])  # crowned, and sloped
    together = FlankTrials(one.pair, known, gaps.at(one.pair, known.lines, loads), loads).of_numbers(
        numbers, slope=True
    )
    for i, load in enumerate(loads):
        apart = gaps.under(load).at(one.pair, known.lines)
        alone = FlankTrials(one.pair, known, apart, loads[i : i + 1]).of_numbers(numbers, slope=True)
        assert together.te[..., i] == pytest.approx(alone.te[..., 0], rel=1e-9)
        assert together.face_load_factor[:, i] == pytest.approx(alone.face_load_factor[:, 0], rel=1e-9)
        assert together.slope[..., i] == pytest.approx(alone.slope[..., 0], rel=1e-6, abs=1e-9)


def test_shafts_are_loaded_at_every_load_of_a_pair_and_every_level_of_its_spectrum():
    """Over the nominal load, once each: a torque is one of the driver, and a level without a load asks for none."""
    level = SimpleNamespace
    part = SimpleNamespace(
        normal_load=lambda found: 500.0, all_loads=lambda found: (500.0, 200.0),
        operation=level(spectrum=[level(torque=50.0, load_factor=None), level(torque=None, load_factor=1.3),
                                  level(torque=None, load_factor=0.0), level(torque=5.0, load_factor=9.0)]),
    )  # fmt: skip
    pair = SimpleNamespace(driver=SimpleNamespace(base_radius=0.05), driven=SimpleNamespace(base_radius=0.2))
    scene = SimpleNamespace(case=SimpleNamespace(pair={"I": part}), pairs={"I": pair})
    assert sorted(_scales(scene, "I")) == pytest.approx([0.2, 0.4, 1.0, 1.3, 2.0])
    part.operation.spectrum = None
    assert sorted(_scales(scene, "I")) == pytest.approx([0.4, 1.0])
    part.normal_load = lambda found: None
    assert sorted(_scales(scene, "I")) == [200.0, 500.0]
