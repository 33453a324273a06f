"""Relief designs on teeth of one constant compliance, where every load sharing is a sum: charts, robustness, bounds."""

import itertools
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.contact.plane.closed_form_compliance import ConstantCompliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.charts import ReliefChart, harris_map, relief_chart, unit_amount, welbourn_amount
from fegear.design.excitation_relief import MinimumExcitationRelief
from fegear.design.held_relief import robustness
from fegear.design.loading import LoadingFunction, Ramp
from fegear.design.minimum_excitation import minimum_excitation, relief_nodes, relief_table
from fegear.design.oil_film import Coated, OilFilm
from fegear.design.quick_sharing import quick_sharing
from fegear.design.relief_bench import bench
from fegear.engine.sheet.seen import Seen
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import TabulatedRelief, normalised_tip_relief
from fegear.results.relief.harris import HarrisMap
from fegear.results.relief.relief_chart import ReliefChartData, _optimum_in_words

MODULE, FACE, SOFT = 3e-3, 10e-3, (4e-11, 6e-11)
EACH = sum(SOFT) / FACE  # of a pair of teeth [m/N]


def engaged(z1=23, z2=37, addendum=1.0, **more):
    rack = BasicRack(addendum, addendum + 0.25, 0.2)
    gears = [Gear(Tooth(z, rack), MODULE, 0.35 * MODULE * z, FACE) for z in (z1, z2)]
    compliance = PairCompliance(GearPair(*gears), *(ConstantCompliance(compliance=c) for c in SOFT), **more)
    return Engagement(compliance)


def shared(gaps, load):
    """Approach of springs side by side behind gaps: the least over all sets that carry the load together."""
    sets = (s for k in range(1, len(gaps) + 1) for s in itertools.combinations(gaps, k))
    return min((load * EACH + sum(s)) / len(s) for s in sets)


def errors_by_hand(pair, x, load, removal):
    """Transmission error at roll positions; removal(position on the line of action, number of the pair)."""
    found = []
    for at in x:
        first = math.ceil((pair.x_start - at) / pair.base_pitch - 1e-12)
        numbers = [k for k in range(first, first + 5) if at + k * pair.base_pitch <= pair.x_end]
        found.append(shared([removal(at + k * pair.base_pitch, k) for k in numbers], load))
    return np.array(found)


def tip_removal(pair, x, amount, length, unit, shape="linear"):
    """On both gears: from nothing, so far from the tip along the line of action, to the amount at the tip."""
    total = 0.0
    for far in (pair.x_end - x, x - pair.x_start):
        s = max(1.0 - far / (length * unit), 0.0)
        total += amount * (s if shape == "linear" else s * s)
    return total


@pytest.mark.parametrize("shape", ["linear", "parabolic"])
def test_a_chart_holds_what_springs_side_by_side_give(shape):
    engagement = engaged()
    pair = engagement.pair
    amounts, lengths, loads = [0.0, 5e-6, 20e-6], [0.5, 1.2], [500.0, 2000.0]
    found = relief_chart(engagement, amounts, lengths, loads, shape)
    assert found.unit_length == pytest.approx(pair.path_length - pair.base_pitch)
    points = bench(engagement).points
    for (i, a), (j, b), (k, w) in itertools.product(*map(enumerate, (amounts, lengths, loads))):
        te = errors_by_hand(
            pair, points.x, w, lambda x, _, a=a, b=b: tip_removal(pair, x, a, b, found.unit_length, shape)
        )
        assert found.peak_to_peak[i, j, k] == pytest.approx(np.ptp(te), rel=1e-6)
        wave = [2.0 * abs(np.sum(points.weights * te * np.exp(-2j * np.pi * n * points.x / points.period)))
                / points.period for n in range(1, 13)]  # fmt: skip
        assert found.effective_error[i, j, k] == pytest.approx(wave[0] + math.hypot(*wave), rel=1e-6)
    with pytest.raises(InputError, match="must be positive"):
        relief_chart(engagement, [1e-6], [0.0, 1.0], [500.0])
    with pytest.raises(InputError, match="must not be negative"):
        relief_chart(engagement, [1e-6, -1e-9], [1.0], [500.0])
    assert relief_chart(engagement, 0.0, 1.0, 500.0).peak_to_peak.shape == (1, 1, 1)


def test_the_boundary_of_a_chart_is_where_its_values_are_so_much_above_the_least():
    """Worst of two loads: 1 + |amount - 2| + 4 |length - 0.6|, linear between points but for the peak."""
    amounts, lengths = np.linspace(0.0, 4.0, 5), np.linspace(0.2, 1.0, 9)
    cone = 1.0 + np.abs(amounts - 2.0)[:, None] + 4.0 * np.abs(lengths - 0.6)
    chart = ReliefChart(
        amounts, lengths, np.array([5.0, 10.0]), 1.0, np.stack([0.5 * cone, 0.9 * cone], axis=2), np.zeros(())
    )
    assert chart.worst() == pytest.approx(cone)  # at half the load half of it counts twice
    assert chart.best() == pytest.approx((2.0, 0.6))
    fine = (chart.finer()[0][:, None], chart.finer()[1])
    assert fine[0].ravel() == pytest.approx(np.linspace(0.0, 4.0, 17))  # one beyond those that double it at most
    assert fine[1] == pytest.approx(np.linspace(0.3, 0.9, 25))
    cone = 1.0 + np.abs(fine[0] - 2.0) + 4.0 * np.abs(fine[1] - 0.6)
    finer = replace(
        chart, amounts=fine[0].ravel(), lengths=fine[1], effective_error=np.stack([0.5 * cone, cone], axis=2)
    )
    a, b = finer.boundary(0.3)
    assert np.abs(a - 2.0) + 4.0 * np.abs(b - 0.6) == pytest.approx(0.3)  # a closed rhombus: the cone is linear
    assert (a[0], b[0]) == (a[-1], b[-1])
    assert chart.boundary(1e3)[0].size == 0  # all of the chart
    weighted = replace(chart, weights=np.array([0.5, 1.0]))
    assert weighted.worst() == pytest.approx(0.9 * chart.worst())


def test_the_contour_of_a_bent_valley_has_no_point_off_its_level():
    """1 + 20 |length - valley(amount)| + |amount - 2|, the valley bent: all of the contour lies in it."""
    amounts, lengths = np.linspace(0.0, 4.0, 161), np.linspace(0.0, 1.0, 401)

    def field(amount, length):
        return 1.0 + 4.0 * np.abs(length - 0.4 - 0.1 * (amount - 2.0) ** 2) + 0.1 * np.abs(amount - 2.0)

    values = field(amounts[:, None], lengths)[:, :, None]
    chart = ReliefChart(amounts, lengths, np.array([5.0]), 1.0, values, np.zeros(()))
    a, b = chart.boundary(0.1)
    there = np.isfinite(a)
    level = 1.1 * chart.worst().min()
    assert np.ptp(a[there]) > 1.8
    assert field(a[there], b[there]) == pytest.approx(level, abs=0.01)  # of cells that the kink crosses
    middle = field(0.5 * (a[1:] + a[:-1]), 0.5 * (b[1:] + b[:-1]))
    assert middle[np.isfinite(middle)] == pytest.approx(level, abs=0.01)
    alone = replace(chart, amounts=amounts[:1], effective_error=values[:1])
    assert alone.boundary()[0].size == 0


def test_the_equal_reliefs_named_for_comparison_have_the_minimum_of_what_is_stated_of_them():
    """A_e is least at 2 um over 1 mm, the peak-to-peak value at 3 um over 2 mm, with 4 um at the larger load."""
    amounts, lengths = np.array([1e-6, 2e-6, 3e-6, 4e-6]), np.array([0.3, 0.5, 1.0, 1.2])
    loads = np.array([50.0, 100.0])
    effective, peaks = np.full((4, 4, 2), 9e-6), np.full((4, 4, 2), 8e-6)
    effective[1, 1], peaks[2, 2] = 1e-6, (1e-6, 4e-6)
    chart = ReliefChart(amounts, lengths, loads, 2e-3, effective, peaks)
    tip = SimpleNamespace(relief=SimpleNamespace(amount=1e-6), member="driver")
    pair = SimpleNamespace(pair=SimpleNamespace(driver=SimpleNamespace(base_radius=0.1)))
    asked = SimpleNamespace(said_by_relief=False, part=SimpleNamespace(shape="linear"), metric="peak_to_peak")
    data = SimpleNamespace(chart=chart, tips=[tip], pair=pair, left=lambda _metric: 2e-6)
    _, said = _optimum_in_words(Seen(data, asked, "I"))
    asked.said_by_relief = True  # the design states better ones, one for each gear
    assert list(_optimum_in_words(Seen(data, asked, "I"))) == []
    assert said == (
        "Pair I: for comparison, equal linear tip relief on both gears, 3 µm over 2 mm, gives 4 µm at 10 N m, 1 µm at "
        "5 N m, peak to peak."
    )
    data.chart = replace(chart, lengths=lengths[:2], effective_error=effective[:, :2], peak_to_peak=peaks[:, 1:3])
    (edge,) = _optimum_in_words(Seen(data, asked, "I"))
    assert edge == (
        "Pair I: equal tip relief with minimum A_e is at the edge of the chart (maximum length): extend "
        "design.chart.lengths."
    )
    asked.said_by_relief = False
    _, said = _optimum_in_words(Seen(data, asked, "I"))
    assert said.endswith("peak to peak; it is at the edge of the chart (maximum length): extend design.chart.lengths.")


def test_a_chart_marks_optimum_present_reliefs_and_the_worst_of_all_loads():
    engagement = engaged()
    pair = engagement.pair
    reliefs = {
        f"{member}_relief": normalised_tip_relief(pair, member, 6e-6, length)
        for member, length in (("driver", 0.8), ("driven", 3.0))
    }
    chart = relief_chart(engagement, np.linspace(2e-6, 20e-6, 4), np.linspace(0.4, 1.2, 5), [1000.0, 2000.0])
    loaded = SimpleNamespace(pair=pair, nominal=2000.0, engagement=replace(engagement, **reliefs))
    marked = ReliefChartData(loaded, chart, None, chart, 5e-6).marked
    assert (marked.best_amount[0], marked.best_length[0]) == chart.best()
    assert marked.present_amounts == pytest.approx([6e-6])  # that of the driven gear is off the chart
    assert marked.present_lengths == pytest.approx([0.8])
    assert marked.near_amounts[0] == marked.near_amounts[-1]
    labels = [one.label for one in ReliefChartData(loaded, chart, None, chart, 5e-6).loads]
    assert labels == ["2000 N (nominal)", "1000 N", "all loads, maximum relative to load"]


def test_a_map_has_the_band_between_the_ends_of_its_range():
    te = np.array([[1.0, 2.0], [3.0, 1.0], [5.0, 9.0]])
    harris = HarrisMap(None, np.zeros(2), np.array([100.0, 150.0, 300.0]), te, over=(150.0, 300.0))
    assert harris.band.transmission_error == pytest.approx([4.0, 5.0])
    assert harris.band.half == pytest.approx([1.0, 4.0])
    assert replace(harris, over=()).band is None


def test_the_unit_of_length_of_high_contact_ratios_is_beyond_the_innermost_pitch():
    engagement = engaged(40, 60, 1.3)
    pair = engagement.pair
    assert 2.0 < pair.contact_ratio < 3.0
    found = relief_chart(engagement, [1e-6], [1.0], [500.0])
    assert found.unit_length == pytest.approx(pair.path_length - 1.5 * pair.base_pitch)


def test_the_best_length_is_the_vertex_of_the_parabola_through_the_lowest_three():
    lengths = np.array([0.5, 0.8, 1.0, 1.5])

    def chart(*rows):
        values = np.array(rows)[:, :, None]
        return ReliefChart(
            np.arange(len(rows)) * 1e-6, lengths[: values.shape[1]], np.array([1.0]), 1e-3, values, 2.0 * values
        )

    found = chart(3.0 + (lengths - 0.9) ** 2, lengths, -lengths, [2.0, 1.0, 1.0, 1.0])
    assert found.length_effective[:3, 0] == pytest.approx([0.9, 0.5, 1.5])
    # f = 2, 1, 1 at 0.5, 0.8, 1.0: slopes -10/3 and 0.
    left, bend = -1.0 / 0.3, (0.0 + 1.0 / 0.3) / 0.5
    assert found.length_effective[3, 0] == pytest.approx(0.65 - left / (2.0 * bend))
    np.testing.assert_allclose(found.length_peak_to_peak, found.length_effective)
    assert (
        replace(found, lengths=lengths[:2], effective_error=np.array([[[1.0], [0.5]]])).optimum_lengths()[0, 0] == 0.8
    )
    many = ReliefChart(np.array([1e-6, 2e-6]), lengths[:2], np.array([10.0, 20.0]), 1e-3,
                       np.array([[[1.0, 1.0], [3.0, 9.0]], [[0.5, 3.0], [0.9, 1.9]]]),
                       np.array([[[9.0, 1.0], [1.0, 1.0]], [[5.0, 3.0], [0.9, 1.9]]]))  # fmt: skip
    assert many.best() == (2e-6, 0.8)  # 0.095 of the load at most; 0.1 and 0.15 of the next
    assert many.best("peak_to_peak") == (2e-6, 0.8)


def test_a_map_of_loads_stands_between_the_changes_of_pairs():
    engagement = engaged()
    pair = engagement.pair
    found = harris_map(engagement, [100.0, 400.0], 8)
    np.testing.assert_allclose(found.x, pair.x_start + pair.base_pitch * (np.arange(8) + 0.5) / 8.0)
    te = [errors_by_hand(pair, found.x, w, lambda x, k: 0.0) for w in (100.0, 400.0)]
    np.testing.assert_allclose(found.transmission_error.T, te, rtol=1e-9)


def test_welbourn_s_delta_is_the_deflection_of_one_pair_and_twice_the_spacing_error():
    """At the highest point of single contact one pair carries everything."""
    engagement = engaged()
    assert welbourn_amount(engagement, 900.0) == pytest.approx(900.0 * EACH)
    assert welbourn_amount(engagement, 900.0, 3e-6) == pytest.approx(900.0 * EACH + 6e-6)
    relieved = replace(engagement, driver_relief=TabulatedRelief(np.array([0.0, 1.0]), np.array([5e-6, 5e-6])))
    assert welbourn_amount(relieved, 900.0) == pytest.approx(900.0 * EACH)
    assert unit_amount(relieved, 900.0) == pytest.approx(900.0 * EACH)
    high = engaged(40, 60, 1.3)
    assert unit_amount(high, 900.0) == pytest.approx(900.0 * EACH / 2.0, rel=1e-6)  # two of two or three pairs
    with pytest.raises(InputError, match="no highest point of single tooth contact"):
        welbourn_amount(high, 900.0)


def test_every_combination_of_deviations_is_tried():
    engagement = engaged()
    pair = engagement.pair
    rolls = pair.roll_angle(np.array([pair.x_start, pair.x_hpstc, pair.x_end]), "driver")
    relief = TabulatedRelief(rolls, np.array([0.0, 0.0, 12e-6]))
    factors, spacings, depths, load = (0.5, 1.3), (0.0, 4e-6), (-0.2, 0.0, 0.3), 1500.0
    with_relief = replace(engagement, driver_relief=relief)
    found = robustness(with_relief, load, factors, spacings, depths)
    x = bench(with_relief, waves=48, breaks=with_relief.breaks).points.x

    def peak(factor, spacing, depth, odd):
        def removal(at, number):
            own = np.interp(at, [pair.x_start, pair.x_hpstc, pair.x_end], [0.0, 0.0, 12e-6])
            return own * (1.0 + depth) + spacing * (number % 2 == odd)

        return np.ptp(errors_by_hand(pair, x, load * factor, removal))

    for (i, w), (j, e), (k, d) in itertools.product(*map(enumerate, (factors, spacings, depths))):
        assert found.values[i, j, k] == pytest.approx(max(peak(w, e, d, odd) for odd in (0, 1)), rel=1e-6)
    assert found.nominal == pytest.approx(peak(1.0, 0.0, 0.0, 0), rel=1e-6)
    assert found.worst == found.values.max()
    at = np.unravel_index(found.values.argmax(), found.values.shape)
    assert found.worst_case == (factors[at[0]], spacings[at[1]], depths[at[2]])
    with pytest.raises(InputError, match="must be positive"):
        robustness(engagement, load, (1.0, 0.0))


def test_removals_of_both_gears_add_up_and_batches_change_nothing(monkeypatch):
    engagement = engaged()
    table = bench(engagement, order=4, waves=4)
    pair = engagement.pair
    ends = np.array([pair.x_start, pair.x_end])
    driver, driven = (
        TabulatedRelief(np.sort(pair.roll_angle(ends, m)), np.array(a))
        for m, a in (("driver", [0.0, 8e-6]), ("driven", [0.0, 2e-6]))
    )
    removal = table.removal(driver, driven)
    x = table.grid.contacts.x
    there = table.grid.contacts.present
    share = (x - pair.x_start) / pair.path_length
    np.testing.assert_allclose(removal[there], (8e-6 * share + 2e-6 * (1.0 - share))[there], atol=1e-12)
    cases = np.stack([removal * s for s in (0.0, 0.5, 1.0, 2.0, 3.0)], axis=2)
    loads = np.array([100.0, 200.0, 300.0, 400.0, 500.0])
    whole = table.errors(cases, loads)
    monkeypatch.setattr("fegear.design.relief_bench._BATCH", 2 * table.points.x.size)
    parts = table.errors(cases, loads)
    np.testing.assert_array_equal(parts.transmission_error, whole.transmission_error)
    for i, w in enumerate(loads):
        alone = table.errors(cases[:, :, [i]], w)
        assert alone.peak_to_peak[0] == pytest.approx(whole.peak_to_peak[i], rel=1e-12)
        assert whole.mean[i] == pytest.approx(
            np.sum(table.points.weights * whole.transmission_error[:, i]) / pair.base_pitch, rel=1e-9
        )
    np.testing.assert_array_equal(whole.of("effective_error"), whole.effective_error)
    np.testing.assert_array_equal(whole.of("peak_to_peak"), np.ptp(whole.transmission_error, axis=0))


def test_quick_sharing_is_exact_for_straight_laws():
    engagement = engaged(40, 60, 1.3)
    pair = engagement.pair
    grid = engagement.grid(pair.x_start + pair.base_pitch * (np.arange(9) + 0.5) / 9.0)
    loads = np.array([300.0, 1500.0])
    quick = quick_sharing(grid, loads)
    n = grid.contacts.x.shape[0]
    assert quick.size == 18
    rng = np.random.default_rng(5)
    m = rng.uniform(0.0, 6e-6, (3, n, 18))
    zeta = quick.by_set(m)
    assert zeta.shape == (3, len(quick.sets), 18)
    for case in range(3):
        for state in range(18):
            position, load = state // 2, loads[state % 2]
            rows = np.flatnonzero(grid.contacts.present[:, position])
            neighbours = [rows[i:k] for i in range(rows.size) for k in range(i + 1, rows.size + 1)]
            least = min((load * EACH + m[case, s, state].sum()) / s.size for s in neighbours)
            assert zeta[case, :, state].min() == pytest.approx(least, rel=1e-5)
    for one in quick.sets:
        np.testing.assert_allclose(one.weight[:, np.isfinite(one.base)], 1.0 / len(one.pairs), rtol=1e-6)


# ---- minimum excitation --------------------------------------------------------------------------------------------
def designed(share=1.5, load=1200.0, film=None, ramp=Ramp()):  # noqa: B008  (frozen)
    engagement = engaged()
    pair = engagement.pair
    loading = LoadingFunction(share * pair.base_pitch, pair.base_pitch, 0.5 * (pair.x_start + pair.x_end), ramp)
    return minimum_excitation(engagement, loading, load, film=film), loading


def test_a_designed_relief_is_the_largest_deflection_less_the_deflection_and_goes_on_straight():
    engagement, loading = designed()
    pair = engagement.pair
    x = np.linspace(pair.x_start, pair.x_end, 401)
    inside = (x >= loading.x_start) & (x <= loading.x_end)
    for member, soft in zip(("driver", "driven"), SOFT, strict=True):
        relief = getattr(engagement, f"{member}_relief")
        assert isinstance(relief, MinimumExcitationRelief)
        deflection = 1200.0 * loading.fraction(x) * soft / FACE
        np.testing.assert_allclose(relief.deflection(x), deflection, atol=1e-15)
        np.testing.assert_allclose(
            relief.at(x)[inside], (1200.0 * soft / FACE - deflection)[inside], rtol=1e-9, atol=1e-14
        )
        # Beyond: the straight line through the end of the zone and a twentieth of the ramp inside it.
        ramp = loading.length - pair.base_pitch
        slope = 1200.0 * soft / FACE * float(loading.fraction(loading.x_start + 0.05 * ramp)) / (0.05 * ramp)
        before, after = x < loading.x_start, x > loading.x_end
        np.testing.assert_allclose(
            relief.at(x)[before], 1200.0 * soft / FACE + slope * (loading.x_start - x[before]), rtol=1e-9
        )
        np.testing.assert_allclose(
            relief.at(x)[after], 1200.0 * soft / FACE + slope * (x[after] - loading.x_end), rtol=1e-9
        )
        np.testing.assert_allclose(relief.removal(pair.roll_angle(x, member)), relief.at(x), rtol=1e-9, atol=1e-14)
    te = engagement.solve(engagement.grid(pair.x_start + pair.base_pitch * np.linspace(0.0, 0.99, 67)), [1200.0])
    np.testing.assert_allclose(te.transmission_error, 1200.0 * EACH, rtol=1e-9)
    for load in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(InputError, match="must be positive and finite"):
            replace(engagement.driver_relief, load=load)


def test_half_of_a_film_is_removed_from_each_flank_and_the_film_holds_them_apart():
    bare, loading = designed()
    pair = bare.pair
    film = OilFilm((pair.x_start, pair.x_end), (1e-6, 3e-6))
    coated, _ = designed(film=film)
    x = np.linspace(loading.x_start, loading.x_end, 101)
    thick = np.interp(x, film.x, film.thickness)
    np.testing.assert_allclose(film.half(x), 0.5 * thick)
    assert film.half(pair.x_end + 1.0) == 1.5e-6
    for member in ("driver", "driven"):
        relief, plain = (getattr(one, f"{member}_relief") for one in (coated, bare))
        # Where it is zero, the deflection exceeds half the film by most.
        fine = np.linspace(loading.x_start, loading.x_end, 4001)
        assert relief.offset == pytest.approx((plain.deflection(fine) - film.half(fine)).max(), rel=1e-4)
        np.testing.assert_allclose(relief.at(x), relief.offset - plain.deflection(x) + 0.5 * thick, atol=1e-13)
        assert {round(one, 9) for one in relief.kinks} >= {
            round(float(pair.roll_angle(place, member)), 9) for place in film.x
        }
    meeting = film.between(coated)
    assert isinstance(meeting.driver_relief, Coated)
    roll = pair.roll_angle(x, "driver")
    np.testing.assert_allclose(
        meeting.driver_relief.removal(roll), coated.driver_relief.removal(roll) - 0.5 * thick, atol=1e-15
    )
    te = meeting.solve(meeting.grid(pair.x_start + pair.base_pitch * np.linspace(0.01, 0.99, 50)), [1200.0])
    assert np.ptp(te.transmission_error) < 1e-12


def test_a_designed_relief_is_tabulated_to_its_tolerance_from_end_to_end():
    engagement, loading = designed(ramp=Ramp(0.4))
    pair, reliefs = engagement.pair, (engagement.driver_relief, engagement.driven_relief)
    x = relief_nodes(*reliefs)
    assert (x[0], x[-1]) == (pair.x_start, pair.x_end)
    assert (np.diff(x) > 0.0).all()
    for place in loading.kinks:
        assert np.abs(x - place).min() < 1e-12
    rough = relief_nodes(*reliefs, tolerance=1e-8)
    fine = np.linspace(pair.x_start, pair.x_end, 20_011)
    for nodes, bound in ((x, 1e-6 * sum(one.offset for one in reliefs)), (rough, 1e-8)):
        off = max(np.abs(np.interp(fine, nodes, one.at(nodes)) - one.at(fine)).max() for one in reliefs)
        assert 0.05 * bound < off < 1.1 * bound
    assert 10 < rough.size < x.size < 2000
    table = relief_table(reliefs[1], 5)
    np.testing.assert_allclose(table.x, np.linspace(pair.x_start, pair.x_end, 5))
    np.testing.assert_allclose(table.radius, pair.radius(table.x, "driven"))
    np.testing.assert_allclose(table.load, 1200.0 * loading.fraction(table.x))
    np.testing.assert_allclose(table.relief, reliefs[1].at(table.x))
    np.testing.assert_allclose(table.deflection, reliefs[1].deflection(table.x))
    again = table.relieved()
    np.testing.assert_allclose(again.removal(table.roll_angle), table.relief, atol=1e-15)
    np.testing.assert_allclose(relief_table(reliefs[0], [0.0, 1e-3]).x, [0.0, 1e-3])


@pytest.mark.parametrize(("share", "load"), [(1.0003, 3e4), (1.0001, 1e4)])
def test_a_relief_deeper_than_the_tooth_is_refused_with_the_shortest_zone_that_does(share, load):
    with pytest.raises(RangeError, match="times the maximum of") as refused:
        designed(share, load)
    words = str(refused.value)
    assert words.startswith(f"design.contact_ratio = {share:.6g}")
    assert " um on the driven, " in words  # whose teeth are softer
    least = float(words.split("choose at least ")[1].split(" ", maxsplit=1)[0])
    length = float(words.split("(design.length ")[1].split(" mm", maxsplit=1)[0]) * 1e-3
    assert length == pytest.approx(least * engaged().pair.base_pitch, rel=1e-3)
    designed(least, load)
    with pytest.raises(RangeError, match="times the maximum of"):
        designed(least - 2e-3 if least > share + 2e-3 else share, load)


def test_one_relief_that_is_too_deep_is_enough():
    """A tenth of a module is 300 um: of the softer gear 6 for 4 um of the other."""
    engagement = engaged()
    pair = engagement.pair
    loading = LoadingFunction(1.2 * pair.base_pitch, pair.base_pitch, 0.5 * (pair.x_start + pair.x_end))
    reliefs = [MinimumExcitationRelief(engagement.compliance, m, loading, 1.0) for m in ("driver", "driven")]
    deepest = [float(one.at(np.linspace(pair.x_start, pair.x_end, 241)).max()) for one in reliefs]
    load = 0.1 * MODULE / (0.5 * (deepest[0] + deepest[1]))
    with pytest.raises(RangeError, match="times the maximum of") as refused:
        designed(1.2, load)
    depth = float(str(refused.value).split("on the driven, ")[1].split(" times")[0])
    assert depth >= 1.0
    assert deepest[1] * load > 0.1 * MODULE > deepest[0] * load


def test_where_no_zone_does_the_largest_load_is_named():
    with pytest.raises(RangeError, match="times the maximum of") as refused:
        designed(1.2, 1e9)
    words = str(refused.value)
    assert words.startswith("design.load = 1e+09 N")
    allowed = float(words.split("limit is ")[1].split(" N", maxsplit=1)[0])
    per_face = float(words.split("limit is ")[1].split(" N/mm", maxsplit=1)[0].rsplit(" ", 1)[-1])
    assert per_face == pytest.approx(allowed / 10.0, rel=0.01)
    longest = engaged().pair.contact_ratio * (1.0 - 1e-12)
    designed(longest, 0.99 * allowed)
    with pytest.raises(RangeError, match="times the maximum of"):
        designed(longest, 1.3 * allowed)


def test_where_only_the_place_of_the_zone_is_wrong_the_middle_is_named():
    engagement = engaged()
    pair = engagement.pair
    middle = 0.5 * (pair.x_start + pair.x_end)
    off = pair.x_start + 0.5002 * pair.base_pitch
    loading = LoadingFunction(1.0003 * pair.base_pitch, pair.base_pitch, off)
    with pytest.raises(RangeError, match="times the maximum of") as refused:
        minimum_excitation(engagement, loading, 2e4)
    words = str(refused.value)
    assert words.startswith(f"design.centre = {off * 1e3:.6g} mm")
    assert f"choose the middle of the path, {middle * 1e3:.6g} mm, and a design length up to" in words
    assert f"{pair.path_length * 1e3:.6g} mm" in words
    whole = LoadingFunction(pair.path_length * (1.0 - 1e-12), pair.base_pitch, middle)
    minimum_excitation(engagement, whole, 2e4)
