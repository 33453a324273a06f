"""Roll positions of loaded flanks, and loads averaged over them: closed forms."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.wide.along_lines import _loads_below, load_below, swept_mean
from fegear.contact.wide.lines import contact_lines, shortest_line
from fegear.contact.wide.over_pitch import every_second
from fegear.contact.wide.roll_points import _shared, line_breaks, roll_points
from fegear.contact.wide.transmission_error import (
    FlankTransmissionError,
    curve_through,
    flank_transmission_error_shift,
    from_half,
    no_less_than_shown_by_half,
    series_over_pitch,
)
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.pair.mesh_stiffness_data import loaded_harmonics

STEEL = Material(206.8e9, 0.3, 7850.0)


def pair(beta, teeth=(23, 57), width=30e-3, module=3e-3):
    gears = []
    for z, hand in zip(teeth, ("right", "left"), strict=True):
        tooth = Tooth(z, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
        bore = 0.5 * tooth.root_radius * module
        gears.append(Gear(tooth, module, bore, width, STEEL, "strain", hand if beta else "spur"))
    return GearPair(*gears)


@pytest.mark.parametrize("beta", [0.0, 1e-6, 0.1, 3.0, 20.0, 35.0])
@pytest.mark.parametrize("count", [1, 5, 16, 33])
def test_positions_are_as_many_as_asked_and_stand_for_one_base_pitch(beta, count):
    gears = pair(beta)
    points = roll_points(gears, count)
    assert points.x.size == count
    assert points.weights.sum() == pytest.approx(gears.base_pitch, rel=1e-12)
    assert points.weights.min() > 0.0
    assert np.all(np.diff(points.x) > 0.0)
    assert np.ptp(points.x) < gears.base_pitch
    # what is straight between the breaks is integrated exactly
    wanted = gears.base_pitch * (points.breaks[0] + 0.5 * gears.base_pitch)
    if count >= 16:
        assert points.weights @ points.x == pytest.approx(wanted, rel=1e-9, abs=1e-3 * gears.base_pitch**2)


@pytest.mark.parametrize("beta", [0.0, 20.0])
def test_pairs_come_and_go_only_at_breaks(beta):
    gears = pair(beta)
    points = roll_points(gears, 24)
    for a, b in zip(points.breaks, points.breaks[1:], strict=False):
        inside = contact_lines(gears, a + (b - a) * np.array([1e-6, 0.3, 0.7, 1.0 - 1e-6]), 1e-3)
        pairs = [tuple(np.unique(inside.pair[p, inside.present[p]])) for p in range(4)]
        assert b - a < 1e-9 or len(set(pairs)) == 1
    # both sides of each are among the positions
    for place in line_breaks(gears):
        away = np.mod(points.x - place + 0.5 * gears.base_pitch, gears.base_pitch) - 0.5 * gears.base_pitch
        assert 0.0 < away[away > 0.0].min() < 6e-3 * gears.base_pitch
        assert 0.0 < (-away[away < 0.0]).min() < 6e-3 * gears.base_pitch


@pytest.mark.parametrize(("beta", "slack"), [(0.0, 1e-6), (3.0, 4e-3), (20.0, 4e-3), (35.0, 4e-3)])
def test_an_even_line_load_bears_the_path_length_over_the_pitch_everywhere(beta, slack):
    gears = pair(beta)
    points = roll_points(gears, 24)
    lines = contact_lines(gears, points.x, 1e-3, points.weights / points.period)
    # heights that short lines in the corners do not reach
    ends = np.linspace(lines.low + 2.0 * shortest_line(gears), lines.high - 2.0 * shortest_line(gears), 14)
    even = np.ones((*lines.x.shape, 2)) * np.array([1.0, 3.0])
    found = swept_mean(lines, even, ends, gears.base_pitch) / np.diff(ends)[:, None]
    wanted = gears.contact_ratio * np.array([1.0, 3.0])
    np.testing.assert_allclose(found, np.broadcast_to(wanted, found.shape), rtol=slack)


def test_a_load_at_the_ends_of_the_lines_is_spread_over_what_they_sweep():
    """A narrow peak at the tip end of every line passes each place of the face once a base pitch."""
    gears = pair(20.0)
    points = roll_points(gears, 16)
    lines = contact_lines(gears, points.x, 1e-3, points.weights / points.period)
    peak = np.where(lines.at_edge & lines.present & (lines.x > 0.0), 1.0 / np.maximum(lines.support, 1e-12), 0.0)
    ends = np.linspace(0.7 * lines.low, 0.7 * lines.high, 9)
    found = swept_mean(lines, peak[:, :, None], ends, gears.base_pitch)[:, 0]
    # a unit force that moves along the face by a pitch over the slope while the gears turn by a pitch
    wanted = np.diff(ends) * abs(gears.driver.twist * gears.driver.base_radius) / gears.base_pitch
    np.testing.assert_allclose(found, wanted, rtol=0.015)


def test_integrals_of_straight_pieces():
    rng = np.random.default_rng(3)
    z = np.sort(rng.uniform(-1.0, 1.0, 9))
    load = rng.uniform(0.0, 1.0, (9, 3))
    ends = np.array([-2.0, -0.3, 0.1, 0.77, 2.0])
    x = np.linspace(z[0], z[-1], 200_001)
    x = 0.5 * (x[1:] + x[:-1])
    for i in range(3):
        values = np.interp(x, z, load[:, i])
        wanted = [(values * (x < end)).sum() * np.ptp(z) / 200_000 for end in ends]
        np.testing.assert_allclose(load_below(z, load, ends)[:, i], wanted, atol=2e-5)


def test_stations_are_one_place_on_both_flanks():
    """So both gears feel the same forces at the same places: their moments balance about any axis."""
    gears = pair(20.0)
    lines = contact_lines(gears, roll_points(gears, 6).x, 1e-3)
    u = np.array([math.cos(gears.working_pressure_angle), math.sin(gears.working_pressure_angle)])
    rho, other = (lines.roll_length(gears, member) for member in ("driver", "driven"))
    # from each axis: the radius of the base circle square to the line of action, and the roll length along it
    across = np.array([-u[1], u[0]])
    at = gears.driver.base_radius * across[:, None, None] + rho * u[:, None, None]
    mate = -gears.driven.base_radius * across[:, None, None] - other * u[:, None, None]
    centre = np.array([0.0, gears.centre_distance])[:, None, None]
    np.testing.assert_allclose((at - mate - centre)[:, lines.present], 0.0, atol=1e-15)
    np.testing.assert_allclose(lines.radius(gears, "driver"), np.hypot(*at), rtol=1e-12)
    # a unit force on each station, along the normal of both flanks, about the driver's axis and the driven gear's
    for base, arm in ((gears.driver.base_radius, at), (-gears.driven.base_radius, mate)):
        torque = arm[0] * u[1] - arm[1] * u[0]
        np.testing.assert_allclose(np.abs(torque[lines.present]), abs(base), rtol=1e-12)


@pytest.mark.last_bit
@pytest.mark.parametrize("count", [12, 16, 17, 48, 96])
def test_no_last_digit_chooses_the_piece_that_has_one_more_point(count):
    """The largest line load at a place of the face was 9 % off by it."""
    lengths = np.array([0.3, 0.2, 0.3, 0.2])
    for seed in range(5):
        noise = 1.0 + 1e-12 * np.random.default_rng(seed).uniform(-1.0, 1.0, 4)
        assert _shared((lengths * noise).tolist(), count) == _shared(lengths.tolist(), count)


@pytest.mark.parametrize("count", range(12, 60))
def test_which_gear_drives_changes_no_number_of_points_on_a_piece(count):
    """The first of two pieces that are alike had one more: K_Hbeta of exchanged gears differed by 1.8e-5."""
    lengths = [0.3014590, 0.1886140, 0.3213130, 0.1886140]
    found = _shared(lengths, count)
    assert sum(found) == count
    assert _shared(lengths[::-1], count) == found[::-1]
    assert max(np.array(lengths) / (np.array(found) - 1)) < 2.0 * min(np.array(lengths) / (np.array(found) - 1))
    assert _shared([0.5, 0.5], 7) == [4, 3]  # nothing else can take the last one


def test_loads_below_heights_of_many_lines_at_once_are_those_of_each():
    rng = np.random.default_rng(7)
    place = [np.sort(np.concatenate([[0.0, 1.0], rng.random(count)])) for count in (1, 5, 0, 12)]
    load = [rng.random((one.size, 2)) for one in place]
    ends = rng.uniform(-0.3, 1.3, (4, 3, 9))
    ends[:, 0, :4] = [0.0, 1.0, -np.inf, np.inf]
    ends[3, 1, :] = place[3][3:12]  # at the stations
    found = _loads_below(place, load, ends)
    for k in range(4):
        np.testing.assert_allclose(found[k], load_below(place[k], load[k], ends[k]), rtol=0.0, atol=1e-14)


def test_curves_through_roll_positions_are_the_same_to_the_last_digit_every_time():
    """scipy's interpolator lays its points in a random order: harmonics differed by 1e-14 from run to run."""
    points = roll_points(pair(20.0), 33)
    values = np.cos(2.0 * math.pi * points.x / points.period)
    x = np.linspace(points.breaks[0], points.breaks[-1], 400)[1:-1]
    found, half = curve_through(points, values, x), from_half(points, values)
    for _ in range(8):
        assert np.array_equal(curve_through(points, values, x), found)
        assert np.array_equal(from_half(points, values), half)
    np.testing.assert_allclose(found, np.cos(2.0 * math.pi * x / points.period), atol=1e-3)


@pytest.mark.parametrize("positions", [16, 24, 48])
def test_what_positions_leave_of_harmonics_is_read_as_the_harmonics_are(positions):
    """Read straight from every second position to the next they were stated 10 times too large."""
    points = roll_points(pair(20.0), positions)
    turn = 2.0 * math.pi * (points.x - points.breaks[0]) / points.period
    values = 1.0 / (1.2 + np.cos(turn + 0.3))
    flat = np.full(values.shape, 3.0)
    te = FlankTransmissionError(1.0, points, values, flat, flat, series_over_pitch(points, values), 1.0)
    stated = flank_transmission_error_shift(te, te, te, te).amplitude[:4]
    root = math.sqrt(1.2**2 - 1.0)  # of 1 / (a + cos): 2 / root times this power
    exact = 2.0 / root * (1.2 - root) ** np.arange(1, 5)
    true = np.abs(te.series.amplitude[:4] - exact)
    assert (true <= 1.5 * stated + 1e-12).all()
    kept = every_second(points)
    straight = np.interp(points.x, points.x[kept], values[kept], period=points.period)
    by_lines = 2.0 * np.abs(series_over_pitch(points, straight).coefficients - te.series.coefficients)[1:5]
    assert stated.max() < by_lines.max()
    if positions == 48:
        assert stated.max() < 0.3 * by_lines.max()


@pytest.mark.parametrize("place", [0.35, 0.42, 0.57])
@pytest.mark.parametrize("positions", [24, 48])
def test_harmonics_beyond_those_of_half_the_positions_are_stated_no_better_than_a_kink_leaves_them(place, positions):
    """A kink where no line begins: of a pair 7 nm of a harmonic were 6.4 off where 2.2 were stated."""
    points = roll_points(pair(20.0), positions)
    turn = (points.x - points.breaks[0]) / points.period
    away = np.abs(np.mod(turn - place + 0.5, 1.0) - 0.5)
    values = 1.0 - 2.0 * away
    te = FlankTransmissionError(1.0, points, values, values, values, series_over_pitch(points, values), 1.0)
    stated = flank_transmission_error_shift(te, te, te, te).amplitude
    n = np.arange(1, positions // 2 + 1)
    exact = np.where(n % 2, 4.0 / (math.pi * n) ** 2, 0.0)
    true = np.abs(te.series.amplitude - exact)
    assert (true <= 1.5 * stated).all()
    assert np.sqrt(np.mean(stated**2)) < 20.0 * np.sqrt(np.mean(true**2))


def with_kink(place, positions):
    """Known harmonics of a loaded pair whose curve has a kink at a place of the base pitch, and roll positions [m]."""
    points = roll_points(pair(20.0), positions)
    turn = (points.x - points.breaks[0]) / points.period
    te = (1.0 - 2.0 * np.abs(np.mod(turn - place + 0.5, 1.0) - 0.5))[:, None]
    flanks = SimpleNamespace(at=0, found=SimpleNamespace(transmission_error=te))
    flanks.error = SimpleNamespace(coarse=flanks.found)
    found = SimpleNamespace(points=points)
    return loaded_harmonics(SimpleNamespace(flanks=flanks, found=found, other=found), positions // 4, shuttling=False)


#: Where a kink stands within the base pitch: no two of them alike beside the positions.
KINKS = np.linspace(0.05, 0.95, 16)


@pytest.mark.parametrize("positions", [16, 17, 32])
def test_harmonics_that_excite_a_pair_err_by_no_more_than_stated_of_a_curve_with_a_kink(positions):
    """Half of the positions share the kink's place with all of them: beyond their harmonics both know nothing."""
    n = np.arange(1, positions // 4 + 1)
    found = [with_kink(place, positions) for place in KINKS]
    assert {one.shape for pair in found for one in pair} == {(n.size, 5)}
    assert not any(stated[:, 1:].any() for _, stated in found)
    size, stated = (np.abs(np.stack([pair[i][:, 0] for pair in found])) for i in (0, 1))
    true = np.abs(size - np.where(n % 2, 4.0 / (math.pi * n) ** 2, 0.0))
    assert (true <= 1.5 * stated).all()
    assert np.sqrt(np.mean(stated**2)) < 8.0 * np.sqrt(np.mean(true**2))


def test_errors_of_harmonics_of_a_kink_fall_with_the_square_of_the_positions():
    """The law by which `no_less_than_shown_by_half` goes on: root mean square over places of the kink and harmonics."""
    n = np.arange(1, 7)
    exact = np.where(n % 2, 4.0 / (math.pi * n) ** 2, 0.0)
    off = [[np.abs(with_kink(place, count)[0][:6, 0]) - exact for place in KINKS] for count in (24, 96)]
    few, many = np.sqrt(np.mean(np.square(off), axis=(1, 2)))
    assert 1.6 < math.log(few / many, 4.0) < 2.4


def test_what_half_of_the_positions_show_is_continued():
    change = np.array([9.0, 1.0, 2.0, 4.0, 0.5, 3.0, 0.1, 0.2])
    np.testing.assert_allclose(
        no_less_than_shown_by_half(change), [9.0, 1.0, 2.0, 4.0, 2.56, 3.0, 4.0 * (4 / 7) ** 2, 1.0]
    )
    for few in ([], [0.3]):
        assert no_less_than_shown_by_half(np.array(few)).tolist() == few


def test_coarser_gears_count_in_part_and_longer_panels_whole_as_errors_that_know_nothing_of_each_other():
    """Sines over the base pitch, about means: of what gears change a part is error, of means another than of shapes.

    Added up, what both leave of helical pairs was stated 4 to 6 times too large in the median.
    """
    points = roll_points(pair(20.0), 48)
    turn = 2.0 * math.pi * points.x / points.period

    def curve(mean, amplitude):
        values = mean + 2.0 * amplitude * np.sin(turn)
        flat = np.full(values.shape, 3.0)
        series = series_over_pitch(points, values)
        return FlankTransmissionError(1.0, points, values, flat, flat * mean, series, float(np.ptp(values)))

    fine, longer, coarse = curve(10.0, 1.0), curve(10.5, 1.01), curve(12.5, 1.06)
    same = flank_transmission_error_shift(fine, fine, fine, fine)
    whole = flank_transmission_error_shift(fine, fine, longer, coarse)
    part = flank_transmission_error_shift(fine, fine, longer, coarse, (0.6, 0.4, 0.3))
    of_mean, of_shape, of_whole = math.hypot(0.5, 0.6 * 2.0), math.hypot(0.01, 0.4 * 0.05), math.hypot(0.01, 0.05)
    of_harmonics = math.hypot(0.01, 0.3 * 0.05)
    assert whole.mean - same.mean == pytest.approx(math.hypot(0.5, 2.0), rel=1e-9)
    assert part.mean - same.mean == pytest.approx(of_mean, rel=1e-9)
    assert part.stiffness - same.stiffness == pytest.approx(3.0 * of_mean, rel=1e-9)
    assert part.first_harmonic - same.first_harmonic == pytest.approx(2.0 * of_harmonics, rel=1e-3)
    assert part.peak_to_peak - same.peak_to_peak == pytest.approx(4.0 * of_shape, rel=5e-3)
    share = of_shape / of_whole
    assert part.effective - same.effective == pytest.approx(share * (whole.effective - same.effective), rel=5e-3)
    # One harmonic may agree by chance in size, or altogether: its phase counts, and what those beside it are off by.
    later = replace(fine, series=series_over_pitch(points, 10.0 + 2.0 * np.sin(turn + 0.01)))
    assert later.series.amplitude[0] == pytest.approx(fine.series.amplitude[0], rel=1e-6)
    assert flank_transmission_error_shift(fine, fine, fine, later).first_harmonic > 0.015
    assert part.amplitude[1] > 0.5 * part.first_harmonic


def test_what_positions_panels_and_gears_leave_of_a_harmonic_knows_nothing_of_each_other(monkeypatch):
    """Half of the positions tell otherwise of a rough curve; each harmonic's three changes have phases of their own.

    Added up they were stated 5 times too large in the median of five helical pairs.
    """
    points = roll_points(pair(20.0), 48)
    turn = 2.0 * math.pi * points.x / points.period
    rough = 0.02 * np.random.default_rng(3).standard_normal(turn.size)

    def curve(amplitude):
        values = 10.0 + rough + amplitude * np.sin(turn)
        flat = np.full(values.shape, 3.0)
        return FlankTransmissionError(
            1.0, points, values, flat, flat, series_over_pitch(points, values), float(np.ptp(values))
        )

    monkeypatch.setattr("fegear.contact.wide.transmission_error.no_less_than_beside", lambda error: error)
    alone, longer, coarse = curve(1.0), curve(1.003), curve(1.008)
    by_positions = flank_transmission_error_shift(alone, alone, alone, alone).first_harmonic
    found = flank_transmission_error_shift(alone, alone, longer, coarse, (1.0, 1.0, 0.8)).first_harmonic
    assert by_positions > 1e-3
    assert found == pytest.approx(math.hypot(by_positions, 0.003, 0.8 * 0.005), rel=1e-3)
