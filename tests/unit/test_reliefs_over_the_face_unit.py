"""Tip reliefs and lead corrections of teeth with a width: charts, readings and searches with contacts made up."""

from dataclasses import dataclass, replace
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.fourier import effective_error, fourier_series, panels
from fegear.design.charts import ReliefChart, unit_length
from fegear.design.flanks import flank_tolerance, lead_correction, tip_bench, tip_chart, tip_design, tip_search
from fegear.design.flanks.forms import FormsAt
from fegear.design.flanks.tip_bench import TipReader, TipTrials
from fegear.design.load_range import LoadRange
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.relief.relief_chart import at_edges
from fegear.results.relief.relief_over_face import misaligned

RACK = BasicRack(1.0, 1.25, 0.38)
GEAR = Gear(Tooth(24, RACK), 2e-3, 0.01, face_width=0.02)
PAIR = GearPair(GEAR, replace(GEAR, tooth=Tooth(37, RACK)))
LOADS = np.array([100.0, 300.0])
X = np.linspace(0.0, 1.0, 9)


@dataclass(frozen=True)
class Tried:
    """What a relief left: te of one relief, (1, P, L)."""

    te: np.ndarray
    found: tuple = ()

    @property
    def peak_to_peak(self):
        return np.ptp(self.te, axis=1)


@dataclass(frozen=True)
class Trials:
    """Flanks whose error is a wave as high as the mean gap, and as high as the load without."""

    loads: np.ndarray = None
    scale: float = 1.0
    tip_power: float = 1.0
    weights: tuple | None = None
    apart: object = None
    pair: object = PAIR
    cells: int = 5

    @property
    def known(self):
        lines = SimpleNamespace(x=np.zeros((9, 4)), pair=np.array([[0, 1, 2, 3]] * 9), present=np.ones((9, 4), bool))
        return SimpleNamespace(lines=lines)

    def gap(self, numbers):
        return np.full((9, 4), float(numbers[0] * (1.0 + numbers[1]) + 2.0 * numbers[2] * (1.0 + 3.0 * numbers[3])))

    def apart_under(self, i):
        return np.full((9, 4), 1e-6 * (i + 1))

    def of_gap(self, gap):
        high = np.abs(gap.mean(axis=1)[:, None] - 1e-8 * self.scale * self.loads) * self.tip_power
        contact = SimpleNamespace(force=np.zeros((9, 4, self.loads.size)) + self.loads)
        found = SimpleNamespace(contact=contact, mean_transmission_error=7e-8 * self.loads)
        return Tried((np.cos(2.0 * np.pi * X)[:, None] * high)[None], (found,))

    def of_numbers(self, numbers, near=None):
        return self.of_gap(self.gap(numbers))


# ---- charts ----------------------------------------------------------------------------------------------------------
def test_a_chart_has_each_amount_length_and_load_at_its_place(monkeypatch):
    points = panels([0.0], 1.0, 4)
    trials = Trials(LOADS, weights=(0.5, 1.0))

    class Quick:
        def __init__(self, number):
            self.number = number

        def gaps(self, gaps):
            return gaps.mean(axis=2)[..., None]  # one panel

        def solve(self, gaps, load):
            assert load == LOADS[self.number]
            high = gaps.mean(axis=(1, 2))
            return high[:, None] * np.cos(2.0 * np.pi * points.x), None

    monkeypatch.setattr(Trials, "gap", lambda one, n: np.full((points.x.size, 4), n[0] * n[1] + n[2] * n[3]))
    monkeypatch.setattr(Trials, "apart_under", lambda one, i: np.full((points.x.size, 4), 1e-6 * (i + 1)))
    amounts, lengths = np.array([0.0, 1e-5, 3e-5]), np.array([0.5, 1.0])
    chart = tip_chart.tip_chart(trials, [Quick(0), Quick(1)], points, amounts, lengths)
    unit = unit_length(PAIR)
    mean = 2.0 * amounts[:, None, None] * lengths[:, None] * unit + 1e-6 * np.array([1.0, 2.0])
    wave = np.cos(2.0 * np.pi * points.x)
    assert chart.peak_to_peak == pytest.approx(mean * np.ptp(wave))
    assert chart.effective_error == pytest.approx(mean * float(effective_error(fourier_series(points, wave, 12))))
    assert (chart.unit_length, chart.weights.tolist()) == (unit, [0.5, 1.0])
    np.testing.assert_array_equal(chart.loads, LOADS)


@pytest.mark.parametrize(
    ("place", "edges"),
    [
        ((1, 1), ""), ((0, 1), "minimum amount): extend design.chart.amounts"),
        ((2, 1), "maximum amount): extend design.chart.amounts"),
        ((1, 2), "maximum length): extend design.chart.lengths"),
        ((2, 0), "maximum amount, minimum length): extend design.chart.amounts and design.chart.lengths"),
    ],
)  # fmt: skip
def test_the_best_of_a_chart_at_its_edge_says_so(place, edges):
    """It stood beside the optimum of the design as if it were one."""
    values = np.ones((3, 3, 1))
    values[(*place, 0)] = 0.5
    found = at_edges(ReliefChart(np.arange(3.0), np.arange(3.0), np.ones(1), 1.0, values, values))
    assert found == (f"is at the edge of the chart ({edges}" if edges else "")
    one = ReliefChart(np.ones(1), np.ones(1), np.ones(1), 1.0, values[:1, :1], values[:1, :1])
    assert at_edges(one) == ""  # a single amount is no edge


def test_a_quick_way_is_straight_about_each_load(monkeypatch):
    monkeypatch.setattr(tip_chart, "quick_flanks", lambda known, force, count, cells: (force[0, 0], count, cells))
    assert tip_chart.quick_at_loads(Trials(LOADS)) == [(100.0, 12, 5), (300.0, 12, 5)]


def test_a_chart_errs_by_the_largest_of_some_reliefs_over_its_own_largest():
    trials, amounts, lengths = Trials(LOADS), np.arange(1.0, 5.0) * 1e-6, np.array([0.3, 0.6, 0.9])
    unit = unit_length(PAIR)
    exact = np.stack([
        [trials.of_numbers(tip_chart._numbers(a, b * unit)).peak_to_peak[0] for b in lengths] for a in amounts
    ])  # fmt: skip
    known = ReliefChart(amounts, lengths, LOADS, unit, exact, exact)
    assert tip_chart.chart_error(known, trials) == pytest.approx(0.0, abs=1e-12)
    for i, j in {((3 * k + 1) % 4, (5 * k + 2) % 3) for k in range(8)}:
        off = exact.copy()
        off[i, j, 1] += 1e-6
        changed = ReliefChart(amounts, lengths, LOADS, unit, off, off)
        assert tip_chart.chart_error(changed, trials) == pytest.approx(1e-6 / off.max())


def test_a_relief_holds_up_under_every_load_pitch_and_depth():
    """Every second pair stands back by the error: the mean of the gap by half of it, whichever pairs they are."""
    trials, removal = Trials(np.array([70.0, 130.0, 100.0])), np.full((9, 4), 4e-6)
    found = tip_chart.tip_robustness(trials, removal, [0.7, 1.3], [0.0, 2e-6], [-0.5, 0.0, 0.5])

    def left(load, gap):
        return 2.0 * abs(gap - 1e-8 * load)

    for i, load in enumerate((70.0, 130.0)):
        for j, error in enumerate((0.0, 2e-6)):
            for k, depth in enumerate((0.5, 1.0, 1.5)):
                assert found.values[i, j, k] == pytest.approx(left(load, 4e-6 * depth + 0.5 * error))
    assert found.nominal == pytest.approx(left(100.0, 4e-6))


# ---- search and tolerances -------------------------------------------------------------------------------------------
def test_a_grid_ends_at_what_a_tip_may_lose_and_at_the_path():
    grid = tip_search.tip_grid(PAIR, 1e-5)
    assert list(grid.tip_amounts) == pytest.approx([min(1e-5 * one, 0.1 * 2e-3) for one in tip_search.TIP_AMOUNTS])
    assert list(grid.tip_lengths) == pytest.approx(
        [PAIR.path_length * one for one in (0.1, 0.17, 0.27, 0.4, 0.55, 0.75, 1.0)]
    )
    assert max(tip_search.tip_grid(PAIR, 1e-2).tip_amounts) == pytest.approx(2e-4)


def test_tips_are_searched_about_the_forces_under_the_largest_load(monkeypatch):
    asked = []
    monkeypatch.setattr(
        tip_search,
        "best_of_family",
        lambda more, family, grid, force, *, scan: asked.append((more, family, grid, force, scan)),
    )
    few, more = Trials(LOADS), Trials(LOADS, 2.0)
    tip_search.best_tips(TipTrials(None, few, more))
    ((given, family, grid, force, scan),) = asked
    assert (given, family, scan) == (more, "profile", few)
    assert (force == 300.0).all()
    assert grid == tip_search.tip_grid(PAIR, 7e-8 * 300.0)


def test_reliefs_end_at_the_tips_and_begin_a_length_before():
    driver, driven = flank_tolerance.end_reliefs(np.array([5e-6, 2e-3, 8e-6, 3e-3, 0, 0, 0, 0, 0.0]), PAIR, 2.0)
    for one, gear, amount, length in ((driver, GEAR, 5e-6, 2e-3), (driven, PAIR.driven, 8e-6, 3e-3)):
        assert (one.amount, one.power) == (amount, 2.0)
        tip = np.sqrt((gear.involute_tip_radius / gear.base_radius) ** 2 - 1.0)
        assert one.end == pytest.approx(tip, rel=1e-9)
        assert gear.base_radius * (one.end - one.start) == pytest.approx(length)
    none, _ = flank_tolerance.end_reliefs(np.array([0.0, 2e-3, 8e-6, 3e-3, 0, 0, 0, 0, 0.0]), PAIR, 1.0)
    assert GEAR.base_radius * (none.end - none.start) == pytest.approx(0.5 * PAIR.path_length)


def test_the_worst_within_tolerances_is_of_all_ends_of_both_gears():
    class Allowed:
        def __init__(self, amount, length):
            self.amount, self.length = amount, length

        def off(self, gear, tip, a, b):
            return replace(
                tip, amount=tip.amount + a * self.amount, start=tip.start - b * self.length / gear.base_radius
            )

    numbers = np.array([5e-6, 1e-3, 8e-6, 2e-3, 0, 0, 0, 0, 9.0])
    # the higher the gap the more is left under the first load; under the second, too heavy for all, the less
    found = flank_tolerance.within_tolerances(
        Trials(np.array([1.0, 1e6])),
        PAIR,
        numbers,
        flank_tolerance.FlankTolerance((Allowed(1e-6, 1e-4), Allowed(2e-6, 3e-4))),
    )
    assert found[0] == pytest.approx([6e-6, 1.1e-3, 10e-6, 2.3e-3, 0, 0, 0, 0, 9.0])
    assert found[1] == pytest.approx([4e-6, 0.9e-3, 6e-6, 1.7e-3, 0, 0, 0, 0, 9.0])
    bare = flank_tolerance.within_tolerances(
        Trials(np.array([1.0])),
        PAIR,
        numbers * [0, 1, 1, 1, 1, 1, 1, 1, 1],
        flank_tolerance.FlankTolerance((Allowed(1e-6, 1e-4), Allowed(0.0, 0.0))),
    )
    assert bare[0, :2] == pytest.approx([1e-6, PAIR.path_length])  # its profile slope


@pytest.mark.parametrize(("driven", "decides"), [(2e-6, ("driven", "amount")), (1e-9, ("driver", "amount"))])
def test_the_tolerance_of_flanks_that_decides_is_the_one_that_halved_leaves_least_at_most(driven, decides):
    numbers = np.array([5e-6, 1e-3, 8e-6, 2e-3, 0, 0, 0, 0, 0])
    tips = TipTolerance(1e-6, 1e-4, 0.0), TipTolerance(driven, 3e-4, 0.0)
    high = [6e-6, 1.1e-3, 8e-6 + driven, 2.3e-3]
    given = flank_tolerance.FlankTolerance(tips)

    def left(n):
        return 2.0 * (n[0] * (1.0 + n[1]) + 2.0 * n[2] * (1.0 + 3.0 * n[3]) - 1e-8)

    (one,) = flank_tolerance.decisive_tolerances(Trials(np.array([1.0])), PAIR, numbers, given, np.array([left(high)]))
    halved = [left([*high[:i], 0.5 * (numbers[i] + high[i]), *high[i + 1 :]]) for i in range(4)]
    assert (one.member, one.number) == decides
    assert one.most == pytest.approx(min(halved))
    assert one.given == tips[["driver", "driven"].index(one.member)].amount
    bare = 0.0 * numbers
    (slope,) = flank_tolerance.decisive_tolerances(Trials(np.array([1.0])), PAIR, bare, given, np.ones(1))
    assert (slope.member, slope.number) == (decides[0], "profile_slope")
    lead = replace(given, lead=flank_tolerance.LeadTolerance(0.0, 0.0, 0.0))
    none = flank_tolerance.decisive_tolerances(Trials(np.array([1.0])), PAIR, bare, lead, np.ones(1))
    assert none == (None,)


def test_the_profile_slope_of_a_gear_without_tip_relief_is_straight_whatever_the_shape_of_the_other():
    numbers = np.array([5e-6, 1e-3, 0.0, 0.0, 0, 0, 0, 0, 0])
    assert flank_tolerance.powers_with_slopes(numbers, 2.0) == (2.0, 1.0)
    assert flank_tolerance.powers_with_slopes(numbers[[2, 3, 0, 1, 4, 5, 6, 7, 8]], 2.0) == (1.0, 2.0)
    assert flank_tolerance.powers_with_slopes(np.array([5e-6, 1e-3, 1e-6, 1e-3]), 2.0) == 2.0
    x = np.linspace(PAIR.x_start, PAIR.x_end, 5)
    off = np.array([5e-6, 1e-3, 4e-6, PAIR.path_length, 0, 0, 0, 0, 0])
    for power, sign in product((1.0, 2.0), (1.0, -1.0)):
        at = FormsAt.over(PAIR, x, 0.0 * x, flank_tolerance.powers_with_slopes(numbers, power))
        tip = np.maximum(1.0 - (PAIR.x_end - x) / 1e-3, 0.0) ** power
        slope = (PAIR.x_end - x) / PAIR.path_length
        given = off * [1, 1, sign, 1, 1, 1, 1, 1, 1]
        assert at.removed(given) == pytest.approx(5e-6 * tip + sign * 4e-6 * slope, abs=1e-15)
        assert at.slopes(given)[[0, 2]] == pytest.approx(np.array([tip, slope]), abs=1e-12)


# ---- readings --------------------------------------------------------------------------------------------------------
class Apart:
    """Gaps that say what they were asked."""

    def at(self, pair, lines, loads):
        return (pair is PAIR, lines.x.shape, loads.tolist())


def test_what_is_read_errs_by_fewer_positions_shorter_panels_and_coarser_gears():
    points = SimpleNamespace()
    trials = [Trials(LOADS, scale) for scale in (1.0, 1.3, 1.7, 2.6)]
    reader = TipReader(points, *trials)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tip_bench, "fourier_series", lambda given, te, count: (given, te.shape, count))
        found = reader.read(np.array([1e-6, 0.0, 0.0, 0.0]))
        plain = reader.read()
    left = [2.0 * np.abs(1e-6 - 1e-8 * scale * LOADS) for scale in (1.0, 1.3, 1.7, 2.6)]
    assert found.peak_to_peak == pytest.approx(left[0], abs=1e-15)
    known = 0.5 * abs(left[0] - left[1]) + 0.5 * abs(left[2] - left[1]) + abs(left[3] - left[1])
    assert found.error == pytest.approx(known, abs=1e-15)
    assert found.series == (points, (9, 2), 12)
    assert plain.peak_to_peak == pytest.approx(2e-8 * LOADS)
    other = reader.under(np.array([50.0]), Apart())
    for one in (other.dense, other.plain, other.thin, other.soft):
        assert one.apart == (True, (9, 4), [50.0])
        assert one.loads.tolist() == [50.0]
    assert [one.tip_power for one in vars(reader.shaped(2.0)).values() if isinstance(one, Trials)] == [2.0] * 4
    assert [one.scale for one in (other.dense, other.plain, other.thin, other.soft)] == [1.0, 1.3, 1.7, 2.6]
    over = TipTrials(points, *trials[:2]).over(LoadRange((50.0, 60.0), (0.5, 1.0)), 2.0, Apart())
    for one, scale in ((over.few, 1.0), (over.more, 1.3)):
        assert (one.loads.tolist(), one.weights, one.tip_power, one.scale) == ([50.0, 60.0], (0.5, 1.0), 2.0, scale)
        assert one.apart == (True, (9, 4), [50.0, 60.0])


def test_all_loads_of_a_task_are_read():
    task = tip_design.TipDesignTask(
        200.0, LoadRange((100.0, 300.0)), ("linear", "parabolic"), (None, None), (50.0, 300.0)
    )
    assert task.loads == (50.0, 100.0, 200.0, 300.0)
    assert task.one_load == LoadRange((200.0,))
    assert replace(task, over=None, map_loads=()).loads == (200.0,)


# ---- lead corrections ------------------------------------------------------------------------------------------------
class Flanks:
    """K_Hbeta rises with the distance of the ground slope and crowning from what the shafts want."""

    pair = PAIR
    positions = 48

    def __init__(self, slope, crowning):
        self.wanted = slope, crowning

    def solve(self, loads, gaps, known):
        slope, crowning = (
            sum(one.amount for one in gaps.driver_flank if type(one).__name__ == name)
            for name in ("HelixSlope", "LeadCrowning")
        )
        off = np.hypot(slope - self.wanted[0], 2.0 * (crowning - self.wanted[1]))
        return SimpleNamespace(face_load_factor=1.0 + 1e5 * off * np.ones(loads.size))


@dataclass(frozen=True)
class Mesh:
    """Flanks of a mesh and what is between them."""

    flanks: object
    gaps: object
    known: object = None


@dataclass(frozen=True)
class Gaps:
    """Only what corrections change."""

    driver_flank: tuple = ()
    shafts: object = None


def _shafts(tilt, sag=0.0):
    """Opening towards end II by the tilt, and towards both by the sag."""
    gap = tilt * np.array([-0.5, 0.0, 0.5]) + sag * np.array([1.0, 0.0, 1.0])
    at = SimpleNamespace(given=True, height=np.array([-0.01, 0.0, 0.01]), gap=gap[None, None])
    return SimpleNamespace(under=lambda load: at)


@pytest.mark.parametrize(("slope", "crowning"), [(-12e-6, 4e-6), (9e-6, 0.0), (-0.0, 6e-6)])
def test_a_correction_is_what_the_shafts_want_in_whole_graduations(slope, crowning):
    mesh = Mesh(Flanks(slope, crowning), Gaps())
    found = lead_correction._searched(mesh, _shafts(-slope), (0.5, 1.0), 200.0, (0.0, 0.0))
    assert found == pytest.approx((slope, crowning), abs=0.51e-6)
    for one in found:
        assert one / 0.5e-6 == pytest.approx(round(one / 0.5e-6), abs=1e-9)
    again = lead_correction._searched(mesh, _shafts(-slope), (0.5, 1.0), 200.0, (0.0, 0.0), (5e-6, 2e-6))
    assert again == found
    present = (1.3e-6, 9.7e-6)  # no graduations: what is there counts to the total, and crowning may become less
    has = lead_correction.lead_modifications(*present, 0.02)
    mesh = replace(mesh, gaps=Gaps(has))
    assert lead_correction._searched(mesh, _shafts(-slope), (0.5, 1.0), 200.0, present) == found


def test_nothing_is_ground_where_nothing_is_better():
    mesh = Mesh(Flanks(0.0, 0.0), Gaps())
    assert lead_correction._searched(mesh, _shafts(1e-6), (1.0,), 200.0, (0.0, 0.0)) == (0.0, 0.0)
    present = (0.9e-6, 1.3e-6)
    mesh = Mesh(Flanks(*present), Gaps(lead_correction.lead_modifications(*present, 0.02)))
    assert lead_correction._searched(mesh, _shafts(1e-6), (1.0,), 200.0, present) == present


@pytest.mark.parametrize("first", [(0, 0), (-30, 0), (11, 25)])
@pytest.mark.parametrize("wanted", [(0.0, 0.0), (-13.3, 0.4), (7.6, 4.5), (3.0, -2.0)])
def test_the_minimum_of_the_grid_is_that_of_all_its_places(wanted, first):
    """A largest value of several, as K_Hbeta is: its valley has a sharp floor askew to both directions."""

    def value(k, n):
        x, y = k - wanted[0], n - wanted[1]
        return max(x + 0.6 * y, -x + 0.7 * y, -1.1 * y, 0.5 * x - y)

    asked = []
    found = lead_correction.least_of_grid(lambda k, n: asked.append((k, n)) or value(k, n), first, 8)
    assert value(*found) == min(value(k, n) for k in range(-40, 41) for n in range(41))
    assert len(asked) == len(set(asked)) < 200
    assert all(n >= 0 for _, n in asked)


def test_a_single_slope_is_as_many_tilts_as_still_gain(monkeypatch):
    monkeypatch.setattr(
        lead_correction, "face_load_factors",
        lambda mesh, _shafts, loads, _load: mesh.flanks.solve(loads, mesh.gaps, None).face_load_factor,
    )  # fmt: skip

    def level(wanted, tilt):
        return lead_correction.level_lead(Mesh(Flanks(wanted, 0.0), Gaps()), _shafts(-tilt), 200.0)

    once, twice = level(4e-6, 4e-6), level(8.4e-6, 4e-6)
    assert (once.slope, once.before, once.after) == pytest.approx((4e-6, 1.4, 1.0))
    assert (twice.slope, twice.before, twice.after) == pytest.approx((8e-6, 1.84, 1.04))
    assert level(-4e-6, 4e-6) is None  # against what the flanks want
    assert level(4e-6, 0.2e-6) is None  # below what is ground


def test_crowning_joins_the_slope_where_shafts_sag(monkeypatch):
    """K_Hbeta 1 + |slope - wanted| + |crowning - wanted| per 10 um: the slope alone leaves what the sag makes."""
    monkeypatch.setattr(
        lead_correction, "face_load_factors",
        lambda mesh, _shafts, loads, _load: mesh.flanks.solve(loads, mesh.gaps, None).face_load_factor,
    )  # fmt: skip

    def level(slope, crowning, tilt, sag):
        return lead_correction.level_lead(Mesh(Flanks(slope, crowning), Gaps()), _shafts(-tilt, -sag), 200.0)

    both = level(4e-6, 6e-6, 4e-6, 6e-6)
    assert (both.slope, both.crowning, both.after) == pytest.approx((4e-6, 6e-6, 1.0))
    only = level(0.0, 6e-6, 0.0, 6e-6)
    assert (only.slope, only.crowning, only.after) == pytest.approx((0.0, 6e-6, 1.0))
    assert level(4e-6, 0.0, 4e-6, 6e-6).crowning == 0.0  # the flanks want none
    assert level(4e-6, 0.2e-6, 4e-6, 0.6e-6).crowning == 0.0  # not worth its words
    assert level(4e-6, 0.0, 4e-6, -6e-6).crowning == 0.0  # a hollow flank is not ground


def test_corrections_come_on_top_of_what_the_driver_has():
    (own,) = lead_correction.lead_modifications(0.0, 3e-6, 0.02)
    mesh = Mesh(None, Gaps(("present",)))
    mesh = replace(mesh, flanks=SimpleNamespace(pair=PAIR))
    ground = lead_correction._ground(mesh, 5e-6, 3e-6)
    assert ground.driver_flank[0] == "present"
    assert {type(one).__name__: one.amount for one in ground.driver_flank[1:]} == {
        "LeadCrowning": 3e-6,
        "HelixSlope": 5e-6,
    }
    assert own == ground.driver_flank[1]
    assert lead_correction._ground(mesh, 0.0, 0.0).driver_flank == ("present",)


@pytest.mark.parametrize("lengths", [(0.2, 0.5, 0.9), (0.1, 0.35, 0.8, 1.0), (0.3, 0.9), (0.4,)])
def test_the_length_of_least_excitation_is_the_vertex_of_the_lowest_three_and_of_fewer_the_lowest(lengths):
    """A parabola over the lengths, another for every amount and load, one of them lowest at an end."""
    lengths, tops = np.array(lengths), np.array([[0.45, 0.6], [0.3, 5.0]])
    values = 1.0 + (lengths[None, :, None] - tops[:, None, :]) ** 2
    none = np.zeros((2, lengths.size, 2))
    chart = ReliefChart(np.ones(2), lengths, np.ones(2), 1.0, none, none)
    nearest = lengths[np.abs(lengths[None, :, None] - tops[:, None, :]).argmin(axis=1)]
    inside = (lengths[0] < nearest) & (nearest < lengths[-1])
    assert chart.lowest(values) == pytest.approx(np.where(inside, tops, nearest))


@pytest.mark.parametrize(
    ("on", "gap", "said"),
    [(True, 4e-6, "pair.I.line_error.over_face = +4 um"), (True, -4e-6, "= -4 um"), (False, 4e-6, ""), (True, 0.0, "")],
)
def test_a_design_names_the_misalignment_whose_sign_it_takes_as_given(on, gap, said):
    line_error = SimpleNamespace(over_face=gap, file=None)
    pair = SimpleNamespace(line_error=line_error, misalignment=None)
    case = SimpleNamespace(pair={"I": pair}, effects=SimpleNamespace(misalignment=on))
    found = misaligned(SimpleNamespace(case=case), "I")
    assert found.endswith(said)
    assert bool(found) == bool(said)
