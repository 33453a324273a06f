"""The fillet with the least root stress: limits are kept, starts and families agree, finer meshes say the same."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.maker import load_plane
from fegear.design.fillet.fillet_bench import FilletBench, search_settings
from fegear.design.fillet.fillet_design import SEARCHES, LoadedSolved, _start, design_fillet, full_rounded, moved
from fegear.design.fillet.fillet_limits import Limits
from fegear.design.fillet.fillet_search import search
from fegear.design.fillet.moved_ellipses import MovedEllipses
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear, solve_to_tolerance
from fegear.geometry.conjugate_rack import conjugate_rack
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import EllipseOnSpace
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tip_interference import interference, refuse_shaped

#: NASA's four-square test gear.
M, LOAD = 3.175e-3, 1615.0
TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25), tip_rounding=0.12)
GEAR = Gear(TOOTH, M, 0.5 * TOOTH.root_radius * M, 6.35e-3)
PAIR = GearPair(GEAR, GEAR)
SPEC = PairSpec(PAIR, (LOAD,), neighbour_coupling=True, corner_contact=True)


@pytest.fixture(scope="module")
def loaded():
    solved = solve_gear(GEAR, settings_at(-5.0), reach=2, estimate_error=False)
    return load_plane(SPEC, (solved, solved), estimates=False)


def bench_of(loaded, **more):
    return FilletBench(loaded.engagement, LOAD, "driver", **more)


def family(bench, count, basis="waves"):
    return MovedEllipses(bench.flank(TOOTH.root_radius), bench.active_roll, basis, count)


def test_without_heights_a_fillet_of_the_family_is_the_ellipse(loaded):
    bench = bench_of(loaded)
    for basis in ("waves", "bumps"):
        tooth = bench.tooth(family(bench, 4, basis).shape(np.zeros(5)))
        ellipse = with_fillet(TOOTH, EllipseOnSpace(tooth.form_radius, TOOTH.root_radius))
        u = np.linspace(0.0, 1.0, 20)
        assert np.hypot(*tooth.fillet.points(u * tooth.fillet.end)).max() == pytest.approx(tooth.form_radius)
        assert tooth.smallest_radius == pytest.approx(ellipse.smallest_radius, rel=2e-3)
        assert float(tooth.involute.start) == pytest.approx(bench.active_roll, rel=1e-9)


def test_room_is_that_of_the_pairs_own_check(loaded):
    """With no clearance asked, least room to the mating tip is the gap that pairs are refused by."""
    bench = bench_of(loaded, limits=Limits(0.0, 1e-6))
    tooth = with_fillet(TOOTH, EllipseOnSpace(TOOTH.form_radius + 0.02, TOOTH.root_radius + 0.1))
    gaps = bench.room(tooth).size // 2
    gap = interference(GearPair(replace(GEAR, tooth=tooth), GEAR), "driven", 6001).fillet_gap / M
    assert bench.room(tooth)[:gaps].min() == pytest.approx(gap, abs=1e-3)


def test_a_moved_fillet_lies_so_far_beside(loaded):
    bench = bench_of(loaded)
    shape = family(bench, 2).shape(np.array([0.2, 0.02, 0.0]))
    for by in (-0.01, 0.01):
        a, b = np.array(shape.points), np.array(moved(shape, by).points)
        off = np.hypot(*(a - b).T)
        assert off.max() == pytest.approx(abs(by), rel=2e-2)
        assert off[[0, -1]] == pytest.approx(0.0, abs=1e-12)
        assert math.copysign(1.0, np.hypot(*b[20]) - np.hypot(*a[20])) == math.copysign(1.0, by)


@pytest.mark.long
def test_a_search_keeps_its_limits_and_its_end_from_another_start(loaded):
    bench = bench_of(loaded, limits=Limits(0.02, 0.2))
    present, few = bench.largest(TOOTH), family(bench, 2)
    one = search(bench, few, present, np.zeros(3))
    other = search(bench, few, present, np.array([0.5, 0.03, 0.0]))
    assert one.stress == pytest.approx(other.stress, rel=1e-3)
    assert one.stress < 0.74 * present
    assert one.stress < 0.87 * bench.largest(full_rounded(TOOTH))
    tooth = bench.tooth(one.shape)
    assert bench.room(tooth).min() > -1e-3
    refuse_shaped(GearPair(replace(GEAR, tooth=tooth), GEAR))
    for off in (np.array([0.0, 0.004, 0.0]), np.array([0.0, -0.004, 0.0]), np.array([0.0, 0.0, 0.004])):
        assert bench.largest(bench.tooth(few.shape(one.numbers + off))) > 0.999 * one.stress
    fine = FilletBench(loaded.engagement, LOAD, "driver", settings=settings_at(-1.0))
    assert fine.largest(tooth) == pytest.approx(one.stress, rel=4e-3)


def test_the_mesh_of_a_search_follows_fillets():
    assert search_settings().root_edge_length == settings_at(-1.0).root_edge_length
    assert search_settings().flank_edge_length == settings_at(-5.0).flank_edge_length


@pytest.mark.long
@pytest.mark.parametrize("objective", ["tension", "alternating"])
def test_three_searches_agree_and_finer_solutions_confirm_the_gain(objective):
    solved = solve_to_tolerance(GEAR, 1e-2, reach=2)
    loaded = load_plane(SPEC, (solved, solved))
    design = design_fillet(LoadedSolved(loaded, SPEC, (solved, solved), "driver"), Limits(), objective)
    assert design.spread < 2e-3
    assert len(design.found) == 3
    gain, error = design.gain(design.present)
    assert 0.15 < gain < 0.35
    assert 0.0 < error < 0.02
    finer = solve_to_tolerance(replace(GEAR, tooth=design.best.tooth), 1e-3, reach=2)
    other = load_plane(replace(SPEC, pair=GearPair(finer.gear, GEAR)), (finer, solved), estimates=False)
    again = FilletBench(other.engagement, LOAD, "driver", objective=objective, settings=finer.settings)
    assert again.largest(design.best.tooth) == pytest.approx(design.best.stress, abs=1.5 * design.best.error)
    assert min(design.off) > 0.0


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.3])
def test_searches_for_a_hob_begin_within_its_reach_and_not_all_at_one_place(loaded, radius):
    bench = bench_of(loaded, limits=Limits(generated=True, smallest_tool_radius=radius))
    few = family(bench, 2)
    starts = [_start(bench, few, *SEARCHES[name][1:]) for name in ("waves", "waves, other start")]
    for numbers in starts:
        assert conjugate_rack(bench.tooth(few.shape(numbers))).room(radius).min() > 0.0
    assert not np.array_equal(*starts)
    # Any fillet may begin where it is asked to.
    free = bench_of(loaded)
    assert np.array_equal(_start(free, few, 0.4, 0.02)[:2], [0.4, 0.02])
