"""Periodic functions with jumps: values, exact Fourier coefficients, excitations built from them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import ConvergenceError, InputError, RangeError
from fegear.dynamics.train.excitation import MeshExcitation, effective_error
from fegear.dynamics.train.periodic import Periodic, combine

SQUARE = Periodic.through_points([0, 0.25, 0.25, 0.75, 0.75, 1], [1, 1, -1, -1, 1, 1])


def test_square_wave():
    """cos-type square wave: alpha_n = 2 sin(n pi/2)/(n pi), exact at n = 1 as at n = 1e5 + 1."""
    n = np.array([0, 1, 2, 3, 100_001, -3])
    exact = np.array([0.0, *(2 * np.sin(k * np.pi / 2) / (k * np.pi) for k in (1, 2, 3, 100_001, -3))])
    assert SQUARE.fourier(n) == pytest.approx(exact, abs=1e-13)
    assert SQUARE.fourier(100_001).real == pytest.approx(2 / (100_001 * np.pi), rel=1e-8)
    assert SQUARE.mean == pytest.approx(0.0, abs=1e-15)


def test_sawtooth_and_jump_sides():
    saw = Periodic.through_points([0, 1], [0, 1])
    n = np.arange(1, 60)
    assert saw.fourier(n) == pytest.approx(1j / (2 * np.pi * n), rel=1e-11)
    assert saw.mean == 0.5
    assert saw(np.array([0.0, 1.0, 0.999999, -0.25, 7.5])) == pytest.approx([0, 0, 0.999999, 0.75, 0.5], abs=1e-12)
    assert saw.slope(0.3) == pytest.approx(1.0)
    assert SQUARE(0.25) == -1.0  # at a jump, the value after it


def test_smooth_function_is_fitted_to_the_tolerance():
    f = Periodic.fit(lambda s: np.exp(np.sin(2 * np.pi * s)), tolerance=1e-12)
    s = np.random.default_rng(2).uniform(-3, 3, 500)
    assert f(s) == pytest.approx(np.exp(np.sin(2 * np.pi * s)), abs=1e-11)
    assert f.slope(s) == pytest.approx(2 * np.pi * np.cos(2 * np.pi * s) * np.exp(np.sin(2 * np.pi * s)), abs=1e-8)
    # Fourier coefficients of exp(sin) are modified Bessel functions: alpha_n = I_n(1) (-i)^n
    from scipy.special import iv

    n = np.arange(0, 8)
    assert f.fourier(n) == pytest.approx(iv(n, 1.0) * (-1j) ** n, abs=1e-12)


def test_longer_periods():
    """Spacing errors repeat after z pitches; the argument stays the base pitch."""
    steps = Periodic.through_points([0, 0.5, 0.5, 1], [0, 0, 1, 1], pitches=4)
    assert steps(np.array([0.5, 1.9, 2.1, 3.9, 4.1])) == pytest.approx([0, 0, 1, 1, 0])
    both = combine((steps, SQUARE), lambda a, b: a + b)
    assert both.pitches == 4
    s = np.linspace(0, 8, 333) + 1e-3
    assert both(s) == pytest.approx(steps(s) + SQUARE(s), abs=1e-13)
    assert steps.breaks_over(8).tolist() == [0, 2, 4, 6, 8]


@pytest.mark.parametrize("apart", [9e-10, 3e-10, 2e-11])
def test_a_jump_between_break_points_that_all_but_coincide_is_taken_as_it_can_be_known(apart):
    """As of teeth that come to bear within 1e-8 of a pitch, over 17: places are known to 1e-7 of such a piece."""
    low, pitches = 0.8703727054422479, 17

    def compliance(s):
        within = np.clip((s * pitches - low * pitches) / (apart * pitches), 0.0, 1.0)
        return 7e-9 * (1.0 + 0.3 * np.sin(2.5 * within))

    found = Periodic.fit(compliance, [low, low + apart], tolerance=1e-12, pitches=pitches)
    s = np.array([0.1, low - 1e-6, low + 0.5 * apart, low + apart + 1e-6, 0.99])
    assert found(s * pitches) == pytest.approx(compliance(s), rel=1e-4)


def test_what_is_made_of_a_piece_shorter_than_jumps_are_looked_for_is_halved_on():
    """As 1/k of a stiffness that rose within 1e-8 of a pitch, and of which each piece is a polynomial of its own."""
    apart, low = 8e-10, 0.3
    cuts = [low, low + apart]
    rising = Periodic.fit(lambda s: np.where(s < low, 1.0, 1.0 + np.clip((s - low) / apart, 0.0, 1.0)), cuts)
    found = combine((rising,), lambda k: 1.0 / k**9)
    s = low + apart * np.linspace(0.01, 0.99, 99)
    assert found(s) == pytest.approx(1.0 / rising(s) ** 9, rel=1e-5)
    assert found(np.array([0.1, 0.9])) == pytest.approx([1.0, 2.0**-9], rel=1e-12)
    with pytest.raises(ConvergenceError, match=r"near s = 0\.3"):
        Periodic.fit(lambda s: np.where(s < low + 0.37 * apart, 0.0, 1.0), cuts)


def test_undeclared_jump_is_said():
    with pytest.raises(ConvergenceError, match=r"near s = 0\.3"):
        Periodic.fit(lambda s: np.where(s < 0.3, 0.0, 1.0))
    with pytest.raises(InputError, match="increase from 0 to 1"):
        Periodic(np.array([0.0, 0.5]), np.zeros((1, 1)))
    with pytest.raises(InputError, match="finite"):
        Periodic.constant(math.nan)


@given(st.lists(st.floats(-1, 1), min_size=3, max_size=9), st.integers(1, 400))
def test_fourier_series_of_straight_lines(values, n):
    """Against the elementary formula: sum over corners of slope changes / (2 pi n)^2 (no jumps)."""
    s = np.linspace(0, 1, len(values) + 1)
    f = np.append(values, values[0])
    slope = np.diff(f) / np.diff(s)
    change = slope - np.roll(slope, 1)
    exact = -np.sum(change * np.exp(-2j * np.pi * n * s[:-1])) / (2 * np.pi * n) ** 2
    assert Periodic.through_points(s, f).fourier(n) == pytest.approx(exact, abs=1e-12)


PITCH = 9e-3


def pair(length=1.5, gap=0.0):
    half = 0.5 * length * PITCH

    def separation(x):
        return gap * np.clip((np.abs(x) - 0.3 * PITCH) / (half - 0.3 * PITCH), 0, None)

    return MeshExcitation.from_tooth_pair(
        lambda x: 1e8 * np.ones_like(x), separation, -half, half, PITCH, breaks=[-0.3 * PITCH, 0.3 * PITCH]
    )


@pytest.mark.parametrize("length", [1.0, 1.5, 2.0, 3.2])
def test_slots_of_constant_tooth_stiffness(length):
    """Mean stiffness is stiffness times contact ratio; at ratio 1 and 2 the mesh stiffness has no jump."""
    found = pair(length)
    assert found.total_stiffness().mean == pytest.approx(1e8 * length, rel=1e-12)
    s = np.linspace(0, 1, 101) + 1e-4
    assert set(np.round(found.total_stiffness()(s) / 1e8)) <= {math.floor(length), math.ceil(length)}
    error = found.transmission_error(900.0)
    assert error(s) == pytest.approx(900.0 / found.total_stiffness()(s), rel=1e-9)
    assert found.mean_compliance() == pytest.approx(
        np.mean(1 / found.total_stiffness()(np.arange(10_000) / 1e4)), rel=1e-3
    )


def test_relief_lifts_the_teeth_off_and_kinks_are_found():
    """Relief of 50 um under 100 N: the outer pairs never bear; under 30 times the load they do part of the way."""
    light, heavy = pair(1.5, 5e-5), pair(1.5, 5e-5)
    s = np.linspace(0, 1, 200) + 1e-4
    gap = np.where(np.abs(np.mod(s + 0.5, 1) - 0.5) < 0.3, 0.0, np.nan)
    inside = ~np.isnan(gap)
    assert light.approach(100.0, s)[inside] == pytest.approx(100.0 / 1e8, rel=1e-12)
    error = heavy.transmission_error(3000.0)
    assert error(s) == pytest.approx(heavy.approach(3000.0, s), abs=1e-13)
    assert len(heavy.contact_changes(3000.0)) == 2
    # load balance at every phase
    k = np.array([f(s) for f in heavy.stiffness])
    m = np.array([f(s) for f in heavy.separation])
    carried = np.sum(np.where(k > 0, k * np.maximum(error(s) - m, 0), 0), axis=0)
    assert carried == pytest.approx(3000.0, rel=1e-8)


def test_contact_ratio_below_one_is_refused():
    with pytest.raises(RangeError, match="contact ratio below 1"):
        pair(0.9)


def test_effective_error_of_a_cosine():
    """A_e = A_1 + sqrt(A_1^2) = 2 A_1."""
    f = Periodic.fit(lambda s: 3e-6 * np.cos(2 * np.pi * s))
    assert effective_error(f) == pytest.approx(6e-6, rel=1e-9)


def test_linearised_about_the_mean_load():
    """At the mean approach the spring carries the mean load, whatever the sharing; shares split it."""
    k = Periodic.fit(lambda s: 2e8 * (1 + 0.2 * np.cos(2 * np.pi * s)))
    z = Periodic.fit(lambda s: 5e-6 + 1e-6 * np.sin(2 * np.pi * s))
    share = Periodic.fit(lambda s: 0.5 + 0.3 * np.sin(2 * np.pi * s))
    other = combine((share,), lambda q: 1 - q)
    s = np.linspace(0, 1, 50)
    for found in (MeshExcitation.at_mean_load(k, z, 1000.0), MeshExcitation.at_mean_load(k, z, 1000.0, (share, other))):
        assert found.approach(1000.0, s) == pytest.approx(z(s), abs=1e-14)
        assert found.total_stiffness()(s) == pytest.approx(k(s), rel=1e-9)


def test_perfect_flanks_that_deflect_in_proportion_leave_no_separation():
    """z - W/k is then nothing but round-off, which no polynomial follows."""
    k = Periodic.fit(lambda s: 2e8 * (1 + 0.2 * np.cos(2 * np.pi * s)))
    z = Periodic.fit(lambda s: 1000.0 / k(s))
    found = MeshExcitation.at_mean_load(k, z, 1000.0)
    assert np.abs(found.separation[0](np.linspace(0, 1, 50))).max() < 1e-15
    noise = np.random.default_rng(1)
    assert np.abs(Periodic.fit(lambda s: 1e-19 * noise.standard_normal(s.size), scale=1e-6).mean) < 1e-16


def test_what_is_rough_everywhere_is_refused_before_there_are_many_pieces():
    calls = []

    def rough(s):
        calls.append(s.size)
        return np.modf(1e7 * np.sin(1e7 * s))[0]

    with pytest.raises(ConvergenceError):
        Periodic.fit(rough, np.linspace(0.1, 0.9, 9))
    assert len(calls) < 64 * 40


def test_values_computed_at_once_ahead_are_those_that_are_asked_for():
    cuts, ahead, asked = [0.3, 0.31, 0.8], [], []

    def function(s):
        asked.append(s.tobytes())
        return np.sqrt(s + 1e-4) * (1.0 + (s > 0.3))

    alone = Periodic.fit(function, cuts, tolerance=1e-9)
    once = asked.copy()
    asked.clear()
    found = Periodic.fit(
        function, cuts, tolerance=1e-9, ahead=lambda places: ahead.extend(one.tobytes() for one in places)
    )
    assert asked == ahead == once
    assert len(asked) > 2 * len(cuts)
    assert np.array_equal(found.breaks, alone.breaks)
    assert np.array_equal(found.coefficients, alone.coefficients)
    s = np.linspace(0.301, 0.999, 500)
    assert np.max(np.abs(found(s) - 2.0 * np.sqrt(s + 1e-4))) < 1e-8


def test_pieces_that_are_asked_for_in_one_array_are_those_asked_for_one_by_one():
    calls = []

    def function(s):
        calls.append(s.size)
        return np.abs(np.sin(7.0 * s)) ** 0.5 + (s > 0.3)

    cuts = [0.3, *(k * np.pi / 7.0 for k in range(1, 3))]
    fits = [Periodic.fit(function, cuts, tolerance=1e-6, shortest=1e-4, pointwise=pointwise) for pointwise in (0, 1)]
    assert fits[0].breaks.size > 20
    assert np.array_equal(fits[0].breaks, fits[1].breaks)
    assert np.array_equal(fits[0].coefficients, fits[1].coefficients)
    one_by_one = calls.count(min(calls))
    assert len(calls) - one_by_one < 0.5 * one_by_one


def test_the_stiffness_of_all_pairs_together_is_fitted_once():
    mesh = MeshExcitation((SQUARE.plus(3.0), SQUARE.plus(4.0)), (Periodic.constant(0.0),) * 2)
    assert mesh.total_stiffness() is mesh.total_stiffness()
    assert mesh.total_stiffness()(0.1) == pytest.approx(9.0)
    assert mesh.widened(2.0).total_stiffness()(0.1) == pytest.approx(18.0)
