"""Relief of loaded flanks: the exact topography, what can be ground, the search over its grid, and their laws."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from fegear.base.errors import RangeError
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.wide.compliance import flank_compliance
from fegear.contact.wide.load_sharing import growth_by_gaps, hat_averages, solve_contact
from fegear.contact.wide.loaded import FlankPair
from fegear.design.flanks import families, valleys
from fegear.design.flanks.families import best_of_family, quick_values
from fegear.design.flanks.forms import LENGTHS, NUMBERS, FormsAt, GroundRelief
from fegear.design.flanks.grid import FAMILIES, ReliefGrid, held_by
from fegear.design.flanks.quick import quick_flanks
from fegear.design.flanks.scatter import NOMINAL, normal_scatter
from fegear.design.flanks.search import descend
from fegear.design.flanks.topography import (
    FlankLoading,
    design_lines,
    station_relief,
    table_nodes,
    tabulated,
    topography,
)
from fegear.design.flanks.trials import FlankTrials
from fegear.design.loading import LoadingFunction, Ramp
from fegear.design.minimum_excitation import minimum_excitation
from fegear.fem.plane.solution import solve_gear
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

STEEL = Material(206.8e9, 0.3, 7850.0)
COARSE = SolidSettings().scaled(2.0)
MODULE, WIDTH, LOAD = 3e-3, 7.5e-3, 2250.0


def gear(beta=15.0, hand="right", teeth=20):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "strain", hand if beta else "spur")


def solid(one, **how):
    m = one.module
    return solve_solid(one.tooth, one.twist * m, one.face_width / m, 0.3, one.bore_radius / m, COARSE, reach=2, **how)


@pytest.fixture(scope="module")
def flanks():
    """A right-handed driver and its left-handed mate."""
    first, second = gear(), gear(hand="left")
    return FlankPair(GearPair(first, second), {"driver": solid(first), "driven": solid(second)}, panel=0.5, positions=9)


@pytest.fixture(scope="module")
def check(flanks):
    """Compliances at roll positions that no design has seen."""
    return flanks.compliance(LOAD)


def loading(pair, slope=0.0, ends=0.0, length=None):
    path = LoadingFunction(length or pair.path_length, pair.base_pitch, 0.5 * (pair.x_start + pair.x_end), Ramp(slope))
    return FlankLoading(path, pair.face_width, ends)


def designed(flanks, positions, share):
    pair = flanks.pair
    lines = design_lines(pair, share, positions, flanks.panel * MODULE)
    known = flank_compliance(pair, flanks.gears, lines, LOAD)
    return known, station_relief(known, np.zeros(lines.x.shape), share, LOAD)


@pytest.fixture(scope="module")
def exact(flanks):
    return designed(flanks, 16, loading(flanks.pair))


@pytest.fixture(scope="module")
def trials(flanks, exact):
    known, _ = exact
    return FlankTrials(flanks.pair, known, np.zeros(known.lines.x.shape), np.array([LOAD]))


def table_of(flanks, found):
    x, z = table_nodes(found, flanks.pair)
    removal = tabulated(found, flanks.pair, x, z)
    return topography(flanks.pair, "driver", x, z, removal), removal


def ripple(known, gap, load=LOAD):
    return float(np.ptp(solve_contact(known, gap, np.array([load])).approach))


def gap_of(flanks, known, table):
    lines = known.lines
    removal = table.removal(flanks.pair.roll_angle(lines.x, "driver"), lines.z)
    return np.where(lines.present, removal, 0.0)


@pytest.mark.parametrize(("slope", "ends", "ratio"), [(0.0, 0.0, None), (1.0, 2e-3, 1.2), (0.5, 3.75e-3, 1.0)])
def test_all_pairs_together_carry_the_load_at_every_height_and_roll_position(flanks, slope, ends, ratio):
    pair = flanks.pair
    share = loading(pair, slope, ends, ratio and ratio * pair.base_pitch)
    z = np.linspace(-0.5, 0.5, 4001) * WIDTH
    twist = pair.driver.twist * pair.driver.base_radius
    for roll in np.random.default_rng(1).uniform(0.0, pair.base_pitch, 5):
        pairs = roll + pair.base_pitch * np.arange(-4, 5)[:, None] - twist * z
        total = share.line_load(pairs, z).sum(axis=0)
        np.testing.assert_allclose(total, share.over_face(z), rtol=1e-9)
        assert np.trapezoid(total, z) == pytest.approx(1.0, abs=1e-6)
    assert share.over_face(z).max() * WIDTH == pytest.approx(share.face_load_factor, rel=1e-6)


def test_ends_that_meet_are_refused(flanks):
    with pytest.raises(RangeError, match="end_length"):
        loading(flanks.pair, ends=0.51 * WIDTH)


@pytest.mark.last_bit
def test_no_last_digit_chooses_the_stations_of_a_node(flanks, exact):
    """Of stations at one distance it did: 3e-4 of the removal."""
    _, found = exact
    x, z = table_nodes(found, flanks.pair)
    removal = tabulated(found, flanks.pair, x, z)
    for seed in range(3):
        noise = 1.0 + 1e-13 * np.random.default_rng(seed).uniform(-1.0, 1.0, found.lines.x.shape)
        moved = replace(found, lines=replace(found.lines, x=found.lines.x * noise))
        np.testing.assert_allclose(tabulated(moved, flanks.pair, x, z), removal, rtol=0, atol=1e-9 * np.ptp(removal))


def test_the_exact_topography_leaves_no_transmission_error(flanks, check, exact):
    """Less than 1 % at positions that it has not seen, and half the step leaves a third or less."""
    bare = ripple(check, np.zeros(check.lines.x.shape))
    known, found = exact
    # where it was designed every station touches and bears its design load
    contact = solve_contact(known, found.relief, np.array([LOAD]))
    assert np.ptp(contact.approach) < 5e-3 * bare
    left = []
    for _, one in (designed(flanks, 8, loading(flanks.pair)), (known, found)):
        table, removal = table_of(flanks, one)
        assert removal.min() == 0.0
        left.append(ripple(check, gap_of(flanks, check, table)))
    assert left[1] < 0.01 * bare
    assert left[1] < left[0] / 3.0


def test_off_the_design_load_it_leaves_the_more_the_farther(flanks, check, exact):
    gap = gap_of(flanks, check, table_of(flanks, exact[1])[0])
    left = [ripple(check, gap, f * LOAD) for f in (0.25, 0.6, 1.0, 1.3, 1.8)]
    assert left[0] > left[1] > left[2] < left[3] < left[4]


def test_a_short_design_zone_and_a_known_misalignment_leave_nothing_either(flanks, check):
    pair = flanks.pair
    share = loading(pair, 0.0, 1.5e-3, 1.2 * pair.base_pitch)
    lines = design_lines(pair, share, 16, flanks.panel * MODULE)
    known = flank_compliance(pair, flanks.gears, lines, LOAD)
    askew = normal_scatter(6e-6, 2)  # levels of plus and minus one deviation
    found = station_relief(known, askew.gaps(lines)[1], share, LOAD)
    gap = gap_of(flanks, check, table_of(flanks, found)[0])
    bare = ripple(check, askew.gaps(check.lines)[1])
    assert ripple(check, gap + askew.gaps(check.lines)[1]) < 0.025 * bare
    zone = share.over_path
    beyond = lines.present & ((lines.x < zone.x_start - 0.05 * MODULE) | (lines.x > zone.x_end + 0.05 * MODULE))
    assert beyond.any()
    assert (found.force[beyond] == 0.0).all()
    contact = solve_contact(known, found.relief + askew.gaps(lines)[1], np.array([LOAD]))
    assert contact.force[beyond].max() < 1e-3 * LOAD


@pytest.mark.long
def test_a_spur_pair_that_cannot_move_along_the_axis_gets_the_relief_of_the_plane():
    one = gear(0.0)
    pair = GearPair(one, one)
    solution = solve_solid(one.tooth, 0.0, WIDTH / MODULE, 0.3, one.bore_radius / MODULE, SolidSettings(), reach=1,
                           plane_strain=True)  # fmt: skip
    flanks = FlankPair(pair, {"driver": solution, "driven": solution}, panel=1.0, positions=4)
    share = loading(pair, slope=1.0)
    _, found = designed(flanks, 8, share)
    plane = finite_element_compliance(solve_gear(one, reach=1))
    wanted = minimum_excitation(Engagement(PairCompliance(pair, plane, plane)), share.over_path, LOAD)
    x = found.lines.x
    relief = wanted.driver_relief.at(x) + wanted.driven_relief.at(x)
    on = found.lines.present
    shift = (found.relief - relief)[on]
    assert np.ptp(shift) < 2e-3 * np.ptp(relief[on])


def test_forms_and_their_slopes(flanks):
    pair = flanks.pair
    rng = np.random.default_rng(3)
    x, z = rng.uniform(pair.x_start, pair.x_end, 200), rng.uniform(-0.5, 0.5, 200) * WIDTH
    forms = FormsAt.over(pair, x, z)
    at = np.array([12e-6, 4.1e-3, 9e-6, 3.3e-3, 5e-6, 7e-6, 2.1e-3, -3e-6, 8e-6])
    slopes = forms.slopes(at)
    for k, step in enumerate(1e-6 * np.maximum(np.abs(at), 1e-6)):
        more, less = at.copy(), at.copy()
        more[k] += step
        less[k] -= step
        found = (forms.removed(more) - forms.removed(less)) / (2.0 * step)
        np.testing.assert_allclose(slopes[k], found, atol=1e-6 * max(1e-3, np.abs(found).max()))
    assert GroundRelief.of(at).removal(pair, x, z).min() >= 0.0
    assert (GroundRelief().removal(pair, x, z) == 0.0).all()
    assert GroundRelief.of(at).numbers.tolist() == at.tolist()
    nothing = at.copy()
    nothing[NUMBERS.index("end_relief")] = 0.0
    assert GroundRelief.of(nothing).end_relief_length == 0.0
    assert set(LENGTHS) | set(LENGTHS.values()) < set(NUMBERS)


def test_approach_and_forces_follow_gaps_as_said(trials):
    known, lines = trials.known, trials.known.lines
    gap = trials.gap(GroundRelief(18e-6, 4e-3, 18e-6, 4e-3, 6e-6).numbers)
    rng = np.random.default_rng(5)
    change = np.where(lines.present, rng.uniform(0.0, 1e-10, lines.x.shape), 0.0)
    first, second = (solve_contact(known, g, np.array([LOAD])) for g in (gap, gap + change))
    even = np.ones(lines.x.shape)
    approach, force = growth_by_gaps(known, first.force[:, :, 0], np.stack([hat_averages(lines, change), even]))
    np.testing.assert_allclose(approach[1], 1.0, rtol=1e-12)
    np.testing.assert_allclose(force[1], 0.0, atol=1e-6 * np.abs(force[0]).max() / 1e-10)
    np.testing.assert_allclose((second.approach - first.approach)[:, 0], approach[0], rtol=1e-4)
    np.testing.assert_allclose(force.sum(axis=2)[0], 0.0, atol=1e-9 * np.abs(force[0]).max())
    moved = (second.force - first.force)[:, :, 0]
    np.testing.assert_allclose(moved, force[0], atol=2e-4 * np.abs(moved).max())


def test_the_quick_way_is_the_exact_one_where_nothing_is_pressed_together(flanks, exact):
    """Contacts of a fixed width, and as many coarse stations as fine ones."""
    known = flank_compliance(flanks.pair, flanks.gears, exact[0].lines, LOAD, hertz="linear")
    quick = quick_flanks(known, exact[1].force, 400, 5)
    trials = FlankTrials(flanks.pair, known, np.zeros(known.lines.x.shape), np.array([LOAD]))
    numbers = [GroundRelief(), GroundRelief(25e-6, 5e-3, 15e-6, 3e-3), GroundRelief(0, 0, 0, 0, 40e-6, 0, 0, 9e-6)]
    gaps = np.stack([trials.gap(one.numbers) for one in numbers])
    approach, factor = quick.solve(quick.gaps(gaps), LOAD)
    for gap, z, k in zip(gaps, approach, factor, strict=True):
        contact = solve_contact(known, gap, np.array([LOAD]))
        np.testing.assert_allclose(z, contact.approach[:, 0], rtol=1e-9)
        assert k == pytest.approx(float(trials.of_gap(gap).face_load_factor[0, 0]), rel=0.1)


GRID = ReliefGrid(
    tip_amounts=(10e-6, 20e-6), tip_lengths=(4e-3,), crownings=(4e-6,), end_amounts=(6e-6,), end_lengths=(2e-3,),
    slopes=(3e-6,), biases=(-6e-6, 6e-6),
)  # fmt: skip


@pytest.fixture(scope="module")
def found(trials, exact):
    """The best of a family by few descents, looked for when it is first asked for."""

    @functools.cache
    def best(family):
        starts = [best(held).relief for held in held_by(family)]
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(valleys, "_DESCENTS", 6)
            patch.setattr(families, "_FLOORS", 4)
            patch.setattr(valleys, "_ROUNDS", 1)
            return best_of_family(trials, family, GRID, exact[1].force, starts=starts)

    return best


@pytest.mark.dear
def test_the_best_of_the_grid_is_that_of_brute_force(trials, found):
    for family in ("profile", "lead"):
        numbers = GRID.numbers(family, GRID.combinations(family))
        values = [trials.value(trials.of_numbers(one).peak_to_peak) for one in numbers]
        best = found(family)
        assert best.candidates == len(values)
        assert best.proven
        assert best.value_on_grid == pytest.approx(min(values), rel=1e-12)
        assert best.on_grid.numbers.tolist() == numbers[int(np.argmin(values))].tolist()


@pytest.mark.dear
def test_more_freedom_never_leaves_more_and_descents_stay_in_the_box(trials, found):
    for family in FAMILIES:
        best = found(family)
        assert best.value <= best.value_on_grid
        assert trials.value(trials.of_numbers(best.relief.numbers).peak_to_peak) == pytest.approx(best.value, rel=1e-6)
        low, high = GRID.limits(family)
        at = best.relief.numbers
        assert ((at >= low) | (at == 0.0)).all()
        assert (at <= high * (1.0 + 1e-12)).all()  # but for rounding
        for held in held_by(family):
            assert best.value <= found(held).value
            assert best.value_on_grid <= found(held).value_on_grid
    assert held_by("profile-lead-and-bias") == tuple(f for f in FAMILIES if f != "profile-lead-and-bias")
    assert found("profile").value < 0.2 * trials.value(trials.of_numbers(np.zeros(9)).peak_to_peak)


@pytest.mark.last_bit
@pytest.mark.parametrize("family", ["profile", "profile-lead-and-bias"])
def test_last_digits_of_a_start_stay_last_digits_of_where_it_leads(trials, family):
    """Steps solved to a hundredth and descents that ended early led starts 1e-14 apart to .306 or .602 um."""
    low, high = GRID.limits(family)
    start = GRID.numbers(family, GRID.combinations(family))[-1]
    noise = 1.0 + 1e-12 * np.random.default_rng(3).uniform(-1.0, 1.0, start.size)
    found = [descend(trials, at, trials.value(trials.of_numbers(at).peak_to_peak), (low, high)) for at in
             (start, np.clip(start * noise, low, high))]  # fmt: skip
    assert found[0][0] == pytest.approx(found[1][0], rel=1e-9)
    np.testing.assert_allclose(found[0][1], found[1][1], atol=1e-8 * np.abs(high).max(), rtol=0.0)
    # at the least nothing nearby leaves less
    rng = np.random.default_rng(4)
    for _ in range(20):
        near = np.clip(found[0][1] + 1e-4 * rng.uniform(-1.0, 1.0, 9) * (high - low), low, high)
        assert trials.value(trials.of_numbers(near).peak_to_peak) >= found[0][0] * (1.0 - 1e-5)


WIDE = ReliefGrid((3e-6, 10e-6, 25e-6), (1.5e-3, 3e-3, 6e-3), (), (), (), (), ())


def beside_evolution(trials, family, grid, force, generations, popsize=8):
    """What an own differential evolution and a descent from its end leave, over what the search finds."""
    best = best_of_family(trials, family, grid, force)
    low, high = box = grid.limits(family)
    free = np.flatnonzero(high > low)

    def left(x):
        at = low.copy()
        at[free] = x
        return trials.value(trials.of_numbers(at).peak_to_peak) * 1e6

    bounds = list(zip(low[free], high[free], strict=True))
    found = differential_evolution(left, bounds, rng=1, popsize=popsize, maxiter=generations, tol=1e-6, polish=False)
    at = low.copy()
    at[free] = found.x
    return min(found.fun * 1e-6, descend(trials, at, found.fun * 1e-6, box)[0]) / best.value


@pytest.mark.dear
def test_a_short_evolution_finds_no_better_relief(trials, exact, monkeypatch):
    monkeypatch.setattr(valleys, "_DESCENTS", 4)
    monkeypatch.setattr(families, "_FLOORS", 8)
    assert beside_evolution(trials, "profile", WIDE, exact[1].force, 2, popsize=4) >= 0.99


@pytest.mark.long
@pytest.mark.parametrize("family", ["profile", "lead", "profile-and-lead"])
def test_evolution_finds_no_better_relief(trials, exact, family):
    grid = replace(GRID, tip_amounts=WIDE.tip_amounts, tip_lengths=WIDE.tip_lengths)
    assert beside_evolution(trials, family, grid, exact[1].force, 60) >= 0.99


def test_scatter_of_nothing_is_the_nominal_pair(trials):
    assert normal_scatter(0.0, 3) is NOMINAL
    scatter = normal_scatter(5e-6, 3)
    moments = [float(scatter.weights @ (scatter.over_face / 5e-6) ** n) for n in range(6)]
    np.testing.assert_allclose(moments, [1.0, 0.0, 1.0, 0.0, 3.0, 0.0], atol=1e-12)
    numbers = GroundRelief(18e-6, 4e-3, 18e-6, 4e-3, 5e-6).numbers
    small = replace(trials, scatter=normal_scatter(1e-14, 3)).of_numbers(numbers)
    still = trials.of_numbers(numbers)
    np.testing.assert_allclose(small.te, np.broadcast_to(still.te, small.te.shape), rtol=1e-7)
    # an aligned pair of mirrored gears with symmetric relief does not know which way its shafts stand askew
    askew = replace(trials, scatter=scatter).of_numbers(numbers).peak_to_peak[:, 0]
    assert askew[0] == pytest.approx(askew[2], rel=0.05)


def test_slopes_of_errors_and_of_loads_over_the_face_are_those_of_differences(trials):
    scattered = replace(trials, scatter=normal_scatter(5e-6, 3), loads=np.array([0.6 * LOAD, LOAD]))
    at = GroundRelief(18e-6, 4e-3, 17e-6, 3.8e-3, 5e-6, 4e-6, 2e-3, 2e-6, 5e-6).numbers
    tried = scattered.of_numbers(at, slope=True)
    for k in (0, 3, 4, 7):
        step = np.zeros(9)
        step[k] = 1e-5 * abs(at[k])
        ahead, behind = scattered.of_numbers(at + step), scattered.of_numbers(at - step)
        for found, of in ((tried.slope[:, k], "te"), (tried.over_face_slope[:, k], "over_face")):
            difference = (getattr(ahead, of) - getattr(behind, of)) / (2.0 * step[k])
            np.testing.assert_allclose(found, difference, atol=3e-3 * np.abs(difference).max())


def test_the_largest_face_load_factor_is_kept_or_refused(trials, exact):
    force = exact[1].force
    askew = replace(trials, apart=normal_scatter(9e-6, 2).gaps(trials.known.lines)[1])
    _, _, factor = quick_values(quick_flanks(askew.known, force, 5, askew.cells), askew, "lead", GRID)
    most = float(np.sort(factor)[len(factor) // 2])
    best = best_of_family(askew, "lead", GRID, force, most)
    assert float(askew.of_numbers(best.relief.numbers).face_load_factor.max()) <= most
    with pytest.raises(RangeError, match="largest_face_load_factor"):
        best_of_family(askew, "lead", GRID, force, 1.0001)


def test_a_face_load_factor_that_few_combinations_keep_to_is_not_refused(trials, exact, monkeypatch):
    """Only what leaves least was loaded exactly: where all of it was just above the limit, the rest was refused too."""
    force = exact[1].force
    askew = replace(trials, apart=normal_scatter(9e-6, 2).gaps(trials.known.lines)[1])
    numbers, value, factor = quick_values(quick_flanks(askew.known, force, 5, askew.cells), askew, "lead", GRID)
    exactly = np.array([float(askew.of_numbers(one).face_load_factor.max()) for one in numbers])
    most = float(np.sort(exactly)[1]) * (1.0 + 1e-9)
    turned = np.where(exactly <= most, value + value.max(), value)  # those that keep to it come last
    monkeypatch.setattr(families, "quick_values", lambda *_: (numbers, turned, factor))
    monkeypatch.setattr(families, "_FACTOR_SLACK", 10.0)
    monkeypatch.setattr(families, "_MOST_EXACT", 1)
    best = best_of_family(askew, "lead", GRID, force, most)
    assert float(askew.of_numbers(best.relief.numbers).face_load_factor.max()) <= most
    assert (best.exact, best.proven) == (best.candidates, True)
