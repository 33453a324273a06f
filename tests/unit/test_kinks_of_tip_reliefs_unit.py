"""Kinks between roll positions on curves made by hand, and harmonics of ramps, against what they are.

A curve's four numbers are its height, both of its slopes and the place of its kink: derivatives of what is found are
known.
"""

import math

import numpy as np
import pytest

from fegear.contact.fourier import Panels, panels
from fegear.design.tip_relief.kinks import KinkQuadrature, Kinks, Positions, _continued, _continued_slopes

PITCH = 1.93
#: Uneven, with both sides of a change of pairs at 0.5 and at the ends of the period.
X = np.array([
    1e-7, 0.1, 0.22, 0.35, 0.5 - 1e-7, 0.5 + 1e-7, 0.63, 0.75, 0.9, 1.02, 1.2, 1.33, 1.5, 1.62, 1.8, 1.87, PITCH - 1e-7,
])  # fmt: skip
PAIRS = np.where(X < 0.5, 2, 1)
POSITIONS = Positions(X, PITCH, PAIRS)


def tent(height, before, after, at, curve=0.0):
    """Values at the positions and their derivatives by the four numbers, of lines that meet, and a parabola."""
    d = X - at
    left = d < 0.0
    slope = np.where(left, before, after)
    values = height + slope * d + curve * (X - 1.0) ** 2
    by = [np.ones(X.size), np.where(left, d, 0.0), np.where(left, 0.0, d), -slope]
    return values, np.array(by)


def met(*tents):
    values, slopes = zip(*(tent(*one) for one in tents), strict=True)
    return POSITIONS.kinks(np.array(values)[..., None], np.array(slopes)[..., None])


def peak_at(interval, *one):
    """The one in an interval."""
    peaks, _ = met(one)
    return peaks.of(peaks.where[1] == interval)


def test_both_sides_of_changes_are_known():
    assert POSITIONS.changes == ((5, 4, -1), (16, 0, 1))
    assert np.flatnonzero(~POSITIONS.whole).tolist() == [4]
    np.testing.assert_allclose(POSITIONS.width, [X[i + 1] - X[i] for i in range(X.size - 1)], rtol=1e-14)


def test_lines_meet_in_peaks_and_troughs_and_take_their_numbers_along():
    peaks, troughs = met((3.0, 2.0, -1.5, 0.93), (1.0, -0.7, 0.4, 0.8), (2.0, 0.3, 0.1, 1.1), (2.0, 0.9, -0.2, 1.27))
    peaks = peaks.of((peaks.where[1] > 0) & (peaks.where[1] < 14))  # where the period ends these curves do not go on
    assert peaks.where.tolist() == [[0, 3], [8, 10], [0, 0]]
    assert troughs.where.tolist() == [[1], [7], [0]]
    np.testing.assert_allclose(peaks.values, [3.0, 2.0], rtol=1e-13)
    np.testing.assert_allclose(troughs.values, [1.0], rtol=1e-13)
    for found in (peaks, troughs):
        # The value at the kink is the height, whatever its slopes and its place.
        np.testing.assert_allclose(found.slopes, np.tile([1.0, 0.0, 0.0, 0.0], (found.values.size, 1)), atol=1e-12)
    assert peaks.of(np.array([False, True])).values.tolist() == peaks.values[1:].tolist()


@pytest.mark.parametrize("curve", [0.05, -0.08])
def test_curves_on_both_sides_are_continued_with_their_bend(curve):
    """Rises are those of chords: continued in proportion to the distances of their middles, they are a parabola's."""
    one = 3.0, 2.0, -1.5, 0.97
    peaks = peak_at(8, *one, curve)
    a, c = (s + curve * 2.0 * (0.5 * (X[8] + X[9]) - 1.0) for s in (2.0, -1.5))
    t = [tent(*one, curve)[0][k] for k in (8, 9)]
    at = (t[1] - t[0] - c * (X[9] - X[8])) / (a - c)
    assert peaks.values == pytest.approx([t[0] + a * at], rel=1e-13)
    step = 1e-6
    for k in range(4):
        ends = ([v + sign * step * (i == k) for i, v in enumerate(one)] for sign in (1.0, -1.0))
        moved = [peak_at(8, *end, curve).values[0] for end in ends]
        assert (moved[0] - moved[1]) / (2.0 * step) == pytest.approx(peaks.slopes[0, k], abs=1e-8)


def test_a_curve_that_bends_much_is_continued_by_a_share_of_the_kink_only():
    """Beyond 15 % of the kink it is another kink."""
    curve, one = 2.0, (3.0, 2.0, -1.5, 1.0)
    values, peaks = tent(*one, curve)[0], peak_at(8, *one, curve)
    rise = np.diff(values) / np.diff(X)
    most = 0.15 * (rise[7] - rise[9])
    a, c = rise[7] + most, rise[9] - most
    at = (values[9] - values[8] - c * (X[9] - X[8])) / (a - c)
    assert peaks.values == pytest.approx([values[8] + a * at], rel=1e-12)
    step = 1e-6
    for k in range(4):
        ends = ([v + sign * step * (i == k) for i, v in enumerate(one)] for sign in (1.0, -1.0))
        moved = [peak_at(8, *end, curve).values[0] for end in ends]
        assert (moved[0] - moved[1]) / (2.0 * step) == pytest.approx(peaks.slopes[0, k], abs=1e-8)


def test_peaks_are_found_across_a_change_where_a_pair_comes_in_and_troughs_are_not():
    """Beside the change there is one neighbour only; for peaks of the side with more pairs what lies beyond counts."""
    v, s = tent(1.0, 3.0, -2.0, 0.42)
    peaks, _ = POSITIONS.kinks(v[None, :, None], s[None, ..., None])
    assert peaks.where[1].tolist() == [3]
    assert peaks.values == pytest.approx([1.0], rel=1e-12)
    _, troughs = POSITIONS.kinks(-v[None, :, None], -s[None, ..., None])
    assert not troughs.values.size
    # On the side with one pair nothing comes in.
    v, s = tent(1.0, 3.0, -2.0, 0.58)
    peaks, _ = POSITIONS.kinks(v[None, :, None], s[None, ..., None])
    assert not peaks.values.size


def test_a_period_begins_where_it_ends():
    """There a pair comes in: peaks behind the change have their neighbours before the period's end."""
    d = X - 0.04
    away = np.where(d > 0.5 * PITCH, d - PITCH, d)
    values = np.where(away < 0.0, 2.0, -1.5) * away + 0.03 * away**2
    peaks, _ = POSITIONS.kinks(values[None, :, None], np.zeros((1, 4, X.size, 1)))
    rise = np.diff(values) / np.diff(X)
    middle = 0.5 * (X[1:] + X[:-1])
    assert peaks.where[1].tolist() == [0]
    a = rise[15] + (rise[15] - rise[14]) * (middle[0] + PITCH - middle[15]) / (middle[15] - middle[14])
    c = rise[1] + (rise[1] - rise[2]) * (middle[1] - middle[0]) / (middle[2] - middle[1])
    at = (values[1] - values[0] - c * (X[1] - X[0])) / (a - c)
    assert peaks.values == pytest.approx([values[0] + a * at], rel=1e-12)


def test_the_last_interval_but_one_has_neighbours():
    assert peak_at(14, 3.0, 2.0, -1.5, 1.84).values == pytest.approx([3.0], rel=1e-12)


def test_slopes_of_what_is_continued_are_those_of_differences():
    rng = np.random.default_rng(4)
    rises, on, turned = rng.normal(size=(4, 300)), rng.uniform(0.5, 1.5, (2, 300)), rng.normal(size=(4, 300, 4))
    rises[1::2] = rises[::2] + 0.2 * rng.normal(size=(2, 300))
    found = _continued_slopes(rises, on, turned)
    for k in range(4):
        ahead, behind = (_continued(rises + sign * 1e-6 * turned[..., k], on) for sign in (1.0, -1.0))
        for one, other, slope in zip(ahead, behind, found, strict=True):
            off = np.abs((one - other) / 2e-6 - slope[:, k])
            assert np.mean(off > 1e-7) < 0.01  # a difference across where the share of a kink begins to count


def test_a_peak_beyond_a_change_is_the_one_that_comes_in():
    """Outside the error rises to the change, inside it falls from a lower value: lines meet beyond the change."""
    outside, inside, way = POSITIONS.changes[0]
    assert way == -1
    height, step, rise, fall = 1.0, 0.2, -2.0, 1.5  # slopes along x, outside and inside
    d = X - X[outside]
    values = np.where(X > 0.5, height + rise * d, height - step + fall * (X - X[inside]))
    slopes = np.array([
        np.ones(X.size), np.where(X > 0.5, 0.0, -1.0), np.where(X > 0.5, d, 0.0), np.where(X > 0.5, 0.0, X - X[inside]),
    ])  # fmt: skip
    found = POSITIONS.entering(values[None, :, None], slopes[None, ..., None])
    assert found.where.tolist() == [[0], [inside], [0]]
    # Going inward from the change outside, a = -rise upward, b = -fall downward: they part by the step.
    a, b = -rise, -fall
    at = -step / (a - b)
    assert found.values == pytest.approx([height + a * at], rel=1e-12)
    by_step, by_rise, by_fall = -a / (a - b), -at + a * at / (a - b), -a * at / (a - b)
    np.testing.assert_allclose(found.slopes[0], [1.0, by_step, by_rise, by_fall], rtol=1e-9)
    assert inside not in POSITIONS.entering(-values[None, :, None], -slopes[None, ..., None]).where[1]


def flanks_of(x, te, *intervals):
    even = Positions(x, PITCH, np.ones(x.size, dtype=int))
    kinks = Kinks(np.array([[0, i, 0] for i in intervals]).T, np.zeros(len(intervals)), np.zeros((len(intervals), 4)))
    return np.flatnonzero(even.flanks(te[None, :, None], kinks, with_changes=False)[0, :, 0]).tolist()


def test_flanks_of_a_sharp_peak_go_to_the_next_turn_and_a_tenth_of_the_period_at_most():
    x = (np.arange(60) + 0.5) * PITCH / 60.0
    te = -np.abs(x - 0.5 * PITCH)
    te[33:] = te[33] + 0.5 * (x[33:] - x[33])
    # 6 positions to the left of the one before; to the right the turn at 33.
    assert flanks_of(x, te, 29) == [*range(23, 34)]
    assert flanks_of(x, -((x - 0.5 * PITCH) ** 2), 29) == []
    assert flanks_of(x, -np.abs(x - x[4:6].mean()), 4) == [*range(12)]
    assert flanks_of(x, -np.abs(x - x[56:58].mean()), 56) == [*range(50, 60)]
    for i in (0, 1, 57, 58):  # nothing beyond the ends
        assert set(flanks_of(x, -np.abs(x - x[i : i + 2].mean()), i)) <= set(range(60))


@pytest.mark.parametrize("times", [2.9, 3.1])
def test_a_kink_is_sharp_that_bends_three_times_as_much_as_the_curves_beside_it(times):
    """These bend by 0.3 before and by 0.2 behind; that the positions are uneven does not count."""
    x = np.array([0.0, 0.1, 0.3, 0.45, 0.6, 0.7, 0.9, 1.0, 1.15, 1.35, 1.45, 1.6])
    before = 0.7
    after = before - 0.5 * times
    slopes = np.array([1.0, 1.0, 1.0, 1.0, before + 0.3, before, 0.0, after, after - 0.2, -3.0, -3.0])
    te = np.append(0.0, np.cumsum(slopes * np.diff(x)))
    assert (flanks_of(x, te, 6) != []) is (times > 3.0)


def test_inner_sides_of_changes_have_flanks_where_the_error_falls_inward():
    rising = np.linspace(0.0, 1.0, X.size)[None, :, None]
    none = Kinks(np.zeros((3, 0), dtype=int), np.empty(0), np.empty((0, 4)))
    # Of the change at 0.5 the inside is 4, inward is down: it has risen to there, from 0 and 2 positions at most.
    assert np.flatnonzero(POSITIONS.flanks(rising, none, with_changes=True)).tolist() == [0, 2, 3, 4]
    assert np.flatnonzero(POSITIONS.flanks(-rising, none, with_changes=True)).tolist() == [0, 1, 2, 4]
    assert not POSITIONS.flanks(rising, none, with_changes=False).any()
    # The pair more is on the other side: inward is up, from 5 and from the end.
    other = Positions(X, PITCH, 3 - PAIRS)
    assert other.changes == ((4, 5, 1), (0, 16, -1))
    assert np.flatnonzero(other.flanks(-rising, none, with_changes=True)).tolist() == [5, 6, 7, 16]
    assert np.flatnonzero(other.flanks(rising, none, with_changes=True)).tolist() == [5, 14, 15, 16]


def quadrature():
    points = panels(-0.3, PITCH, (0.4, 1.1), waves=3, order=4)
    n = np.arange(1, 6)
    phase = 2.0 * math.pi / PITCH * np.multiply.outer(points.x, n)
    weighed = 2.0 * points.weights[:, None] / PITCH
    return points, np.concatenate([weighed * np.cos(phase), weighed * np.sin(phase)], axis=1)


def test_what_quadrature_is_off_for_a_ramp_is_the_sum_less_the_integral():
    points, kernel = quadrature()
    assert isinstance(points, Panels)
    places = np.array([-0.21, 0.07, 0.55, 1.3, 1.64])
    error, slope = KinkQuadrature(points, kernel).errors(places)
    end, wave = points.breaks[-1], 2.0 * math.pi / PITCH * np.arange(1, 6)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    for x, off, by_place in zip(places, error, slope, strict=True):
        t, w = x + 0.5 * (end - x) * (nodes + 1.0), 0.5 * (end - x) * weights
        waves = np.concatenate([np.cos(np.outer(t, wave)), np.sin(np.outer(t, wave))], axis=1)
        exact = 2.0 / PITCH * ((w * (t - x)) @ waves)
        np.testing.assert_allclose(off, np.maximum(points.x - x, 0.0) @ kernel - exact, atol=1e-13)
        level = -(points.x > x).astype(float) @ kernel + 2.0 / PITCH * (w @ waves)
        np.testing.assert_allclose(by_place, level, atol=1e-13)


def test_kinks_are_the_same_in_other_units():
    """Places and errors in thousandths: the same kinks, and derivatives by heights and places that are lengths."""
    tents = tent(3.0, 2.0, -1.5, 0.93, 0.1), tent(-1.0, -0.7, 0.4, 0.42)
    values, slopes = (np.array([one[k] for one in tents])[..., None] for k in (0, 1))
    small, few = Positions(1e-3 * X, 1e-3 * PITCH, PAIRS), 1e-3 * values
    assert small.changes == POSITIONS.changes
    whole = *POSITIONS.kinks(values, slopes), POSITIONS.entering(values, slopes)
    for wanted, found in zip(whole, (*small.kinks(few, slopes), small.entering(few, slopes)), strict=True):
        assert found.where.tolist() == wanted.where.tolist()
        np.testing.assert_allclose(found.values, 1e-3 * wanted.values, rtol=1e-9)
        np.testing.assert_allclose(found.slopes, wanted.slopes, rtol=1e-6, atol=1e-9)
    there = POSITIONS.flanks(values, whole[0], with_changes=True)
    np.testing.assert_array_equal(small.flanks(few, whole[0], with_changes=True), there)


def circled(x, at):
    """Errors around the period that rise steeply to a place and fall behind it, bent by a cube on both sides."""
    d = (x - at + 0.5 * PITCH) % PITCH - 0.5 * PITCH
    return np.where(d < 0.0, 2.0 * d + 0.3 * d**3, -1.5 * d + 0.4 * d**3)


@pytest.mark.parametrize(("behind", "pair_more"), [(0.04, True), (-0.03, False), (0.04, False), (-0.03, True)])
def test_a_peak_beside_a_change_is_the_same_wherever_the_period_begins(behind, pair_more):
    """Positions are counted from each of them in turn: the change stands in their middle, at their ends and beside."""
    change = 0.8
    inner = np.array([0.05, 0.2, 0.36, 0.5, 0.63, 0.74, change - 1e-8, change + 1e-8, 0.9, 0.99, 1.15, 1.3, 1.5, 1.75])
    pairs = np.where((inner > change) == pair_more, 2, 1)
    peak = 7 if behind > 0.0 else 5
    found = []
    for begin in range(inner.size):
        x = np.concatenate([inner[begin:], inner[:begin] + PITCH])
        counted = Positions(x, PITCH, np.roll(pairs, -begin))
        assert counted.changes == (((6 - begin) % 14, (7 - begin) % 14, 1) if pair_more else (
            (7 - begin) % 14, (6 - begin) % 14, -1),)  # fmt: skip
        peaks, _ = counted.kinks(circled(x, change + behind)[None, :, None], np.zeros((1, 4, x.size, 1)))
        found.append(peaks.values[(peaks.where[1] + begin) % 14 == peak])
    sizes = np.array([one.size for one in found])
    if pair_more != (behind > 0.0):  # on the side with a pair less nothing comes in
        assert not sizes.any()
        return
    # None where the period begins within the interval of the peak, or beside it: there it has one neighbour only.
    assert np.flatnonzero(sizes == 0).tolist() == ([8, 9] if peak == 7 else [5, 6])
    assert found[0] == pytest.approx([0.0], abs=1e-3)
    # Neighbours are the same unless the period begins in one of them.
    whole = sorted(set(range(14)) - ({5, 6, 8, 9, 10} if peak == 7 else {4, 5, 6, 8, 9}))
    for begin in whole:
        assert found[begin] == pytest.approx(found[0], rel=1e-9)


def test_where_no_pair_comes_in_curves_end_with_the_period_and_the_second_interval_has_a_neighbour():
    x = np.array([0.02, 0.2, 0.36, 0.5, 0.63, 0.74, 0.85, 0.99, 1.15, 1.3, 1.5, 1.75])
    even = Positions(x, PITCH, np.ones(x.size, dtype=int))
    for at, interval, found in ((0.1, 0, False), (0.29, 1, True), (1.4, 9, True), (1.6, 10, False)):
        d = x - at
        peaks, _ = even.kinks(np.where(d < 0.0, 2.0 * d, -1.5 * d)[None, :, None], np.zeros((1, 4, x.size, 1)))
        assert (interval in peaks.where[1]) is found
