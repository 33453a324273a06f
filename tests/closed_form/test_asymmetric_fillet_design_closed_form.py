"""Fillet design of asymmetric teeth: equal flanks, mirror images, room on either flank, tools, both fillets."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.maker import load_plane
from fegear.design.fillet.fillet_bench import FilletBench, Judged
from fegear.design.fillet.fillet_design import LoadedSolved, _start, family_of, full_rounded, moved
from fegear.design.fillet.fillet_limits import Limits
from fegear.design.fillet.fillet_search import _merit, search
from fegear.design.fillet.shared_bottom import BothFillets, BothSides
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.conjugate_rack import conjugate_rack
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tip_interference import interference

M, COARSE = 3e-3, settings_at(-6.0)


def rack(drive, coast, tips):
    return AsymmetricRack(*(RackFlank(math.radians(a), tip) for a, tip in zip((drive, coast), tips, strict=True)))


UNEVEN, EVEN = rack(30.0, 20.0, (0.15, 0.25)), rack(20.0, 20.0, (0.25, 0.25))


def gear_of(tooth):
    return Gear(tooth, M, 0.5 * tooth.root_radius * M, 20e-3)


def loaded(gears, load, member="driver"):
    spec = PairSpec(GearPair(*gears), (load,), neighbour_coupling=True)
    solved = tuple(solve_gear(gear, COARSE, reach=1, estimate_error=False) for gear in gears)
    return LoadedSolved(load_plane(spec, solved, estimates=False), spec, solved, member)


def two(made, loads=(4e3, 2.5e3), flank="drive"):
    """A pair on one flank, and the same gears with driver and driven exchanged on the other one."""
    gears = [gear_of(AsymmetricTooth(z, made, 0.0, 0.02).side(flank)) for z in (22, 41)]
    return loaded(gears, loads[0]), loaded([gear.from_the_back for gear in gears[::-1]], loads[1], "driven")


def bench_of(pair, other=None, objective="tension", **limits):
    def one(of, beside):
        e, kept = of.loaded.engagement, Limits(**limits)
        return FilletBench(e, of.loaded.nominal, of.member, kept, objective, COARSE, beside)

    return one(pair, None if other is None else one(other, None))


@pytest.fixture(scope="module")
def uneven():
    return two(UNEVEN)


@pytest.fixture(scope="module")
def even():
    return two(EVEN, (4e3, 4e3))


@pytest.fixture(scope="module")
def symmetric():
    """Driving and driven."""
    gears = [gear_of(Tooth(z, BasicRack(1.0, 1.25, 0.25), 0.0, 0.02)) for z in (22, 41)]
    return loaded(gears, 4e3), loaded(gears[::-1], 4e3, "driven")


def test_equal_flanks_are_judged_as_symmetric_teeth(even, symmetric):
    bench = bench_of(*even)
    numbers = np.array([0.1, 0.02, -0.01])
    family = family_of(bench, "waves", 2)
    assert isinstance(family, BothSides)
    judged = bench.judged(bench.tooth(family.shape(np.concatenate([numbers, numbers, [0.0]]))))
    assert judged.fillets == 2
    for pair, stress, room in zip(symmetric, np.split(judged.stress, 2), np.split(judged.room, 2), strict=True):
        usual = bench_of(pair)
        wanted = usual.judged(usual.tooth(family_of(usual, "waves", 2).shape(numbers)))
        assert stress == pytest.approx(wanted.stress, rel=1e-8)
        assert room == pytest.approx(wanted.room, abs=1e-9)


def test_alternating_stress_is_that_of_symmetric_teeth_in_two_meshes(even, symmetric):
    bench, usual = (bench_of(*pairs, objective="alternating") for pairs in (even, symmetric))
    assert bench.largest(bench.gear.tooth) == pytest.approx(usual.largest(usual.gear.tooth), rel=1e-8)
    assert np.maximum(*np.split(bench.along(bench.gear.tooth), 2)) == pytest.approx(
        usual.along(usual.gear.tooth), rel=1e-8
    )


@pytest.mark.long
def test_the_design_of_equal_flanks_is_that_of_symmetric_teeth(even, symmetric):
    """Led on from the symmetric optimum both fillets stay: their largest stress falls no farther."""
    usual, bench = (bench_of(*pairs) for pairs in (symmetric, even))
    present = usual.largest(usual.gear.tooth)
    found = search(usual, family_of(usual, "waves", 1), present, np.zeros(2))
    assert found.kept
    again = search(bench, family_of(bench, "waves", 1), present, np.concatenate([found.numbers, found.numbers, [0.0]]))
    assert again.stress == pytest.approx(found.stress, rel=3e-3)
    assert again.numbers[-1] == pytest.approx(0.0, abs=0.02)


def test_a_mirrored_tooth_gets_the_mirrored_fillet(uneven):
    """The same pairs from gears turned round on their shafts, whose flanks have each other's names."""
    benches = bench_of(*uneven), bench_of(*two(UNEVEN.reversed, flank="coast"))
    numbers = np.array([0.1, 0.02, 0.05, -0.01, 0.04])
    shapes = [family_of(bench, "waves", 1).shape(numbers) for bench in benches]
    for one, other in zip(*shapes, strict=True):
        assert np.array(one.points) == pytest.approx(np.array(other.points), abs=1e-12)
    teeth = [bench.tooth(shape) for bench, shape in zip(benches, shapes, strict=True)]
    assert teeth[0].tooth.drive_fillet == shapes[0].own
    assert teeth[1].tooth.coast_fillet == shapes[1].own
    one, other = (bench.judged(tooth) for bench, tooth in zip(benches, teeth, strict=True))
    assert one.stress == pytest.approx(other.stress, rel=1e-9)
    assert one.room == pytest.approx(other.room, abs=1e-9)


def test_room_is_that_of_the_pairs_own_check_on_either_flank(uneven):
    bench = bench_of(*uneven, clearance=0.0, smallest_radius=1e-6)
    family = family_of(bench, "waves", 1)
    for beside in (-0.05, 0.08):  # the lowest line turns the centre line of the tooth
        tooth = bench.tooth(family.shape(np.array([0.02, 0.05, 0.02, 0.03, beside])))
        assert tooth.turn != 0.0
        pair = GearPair(replace(bench.gear, tooth=tooth), bench.engagement.pair.driven)
        half = bench.room(tooth).size // 2
        for n, seen in enumerate((pair, pair.from_the_back)):
            gap = interference(seen, "driven", 6001).fillet_gap / M
            assert bench.room(tooth)[n * half : (n + 1) * half][:192].min() == pytest.approx(gap, abs=1e-3)


def test_one_fillet_goes_on_to_where_the_kept_one_ends(uneven):
    bench = bench_of(uneven[0])
    tooth = bench.tooth(family_of(bench, "waves", 1).shape(np.zeros(2)))
    kept = bench.gear.tooth
    assert tooth.root_land_half_angle == 0.0
    assert tooth.fillet_key == "fillet"
    assert tooth.back.fillet_key is None
    assert tooth.turn == pytest.approx(-kept.root_land_half_angle, rel=1e-9)
    assert tooth.back.form_roll == kept.back.form_roll
    assert not bench.both
    # With the designed tooth in the place of the present one the same fillet is judged alike.
    again = replace(bench, engagement=uneven[0].with_gear(replace(bench.gear, tooth=tooth), uneven[0].solved[0]))
    assert again.room(tooth) == pytest.approx(bench.room(tooth), abs=1e-9)


def test_both_fillets_begin_at_one_line_and_searches_at_different_places(uneven):
    bench = bench_of(*uneven)
    family = family_of(bench, "waves", 2)
    shape = family.shape(np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1]))
    own, back = (np.array(one.points[0]) for one in shape)
    half = math.pi / 22
    radius = math.hypot(*own)
    assert math.hypot(*back) == pytest.approx(radius, rel=1e-12)
    assert math.atan2(*own) - half == pytest.approx(0.1 / radius, rel=1e-9)
    assert math.atan2(*back) - half == pytest.approx(-0.1 / radius, rel=1e-9)
    starts = [_start(bench, family, *at) for at in ((0.0, 0.0), (0.4, 0.02))]
    assert starts[0][-1] == 0.0
    assert starts[1][-1] > 0.0
    deeper = BothFillets(*(moved(one, -0.01) for one in shape))
    for n in range(2):
        assert np.hypot(*deeper[n].points[20]) < np.hypot(*shape[n].points[20])


@pytest.mark.parametrize("flank", ["drive", "coast"])
def test_the_tool_of_a_generated_side_is_its_rack(flank):
    side = AsymmetricTooth(22, UNEVEN, 0.1, 0.02).side(flank)
    tip, half = conjugate_rack(side), UNEVEN.half(flank)
    assert tip.exists
    assert tip.height[0] == pytest.approx(1.25, abs=1e-9)
    assert tip.smallest_radius == pytest.approx(half.tip_radius, rel=1e-3)
    width = tip.half_width + side.beside  # from the middle of the rack's tooth
    assert width[-1] == pytest.approx(math.pi / 4 - tip.height[-1] * math.tan(half.pressure_angle), abs=1e-9)
    assert width[0] == pytest.approx(half.tip_centre_offset, abs=1e-9)


def test_the_full_fillet_of_an_asymmetric_rack_is_one_arc(uneven):
    bench = bench_of(uneven[0])
    tooth = bench.tooth(family_of(bench, "waves", 1).shape(np.zeros(2)))
    for one in (bench.gear.tooth, tooth):
        full = full_rounded(one)
        assert full.rack.tip_radius == full.back.rack.tip_radius == UNEVEN.full_fillet_radius
        assert full.root_land_half_angle == pytest.approx(0.0, abs=1e-12)
        assert full.root_radius == pytest.approx(bench.gear.tooth.root_radius, rel=1e-13)


def test_of_two_fillets_the_more_stressed_one_counts_and_then_the_other():
    room = np.ones(2)
    one, less, more = (
        _merit(Judged(np.array(stress), room, 2), 100.0)
        for stress in ([90.0, 100.0, 60.0, 70.0], [90.0, 100.0, 60.0, 65.0], [90.0, 100.5, 60.0, 65.0])
    )
    assert less < one < more
    assert _merit(Judged(np.array([90.0, 100.0]), room), 100.0) == 1.0
