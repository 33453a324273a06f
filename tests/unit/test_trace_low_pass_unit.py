"""A trace behind a low pass: the time constant is found, and no other trace is said to have one."""

import math
from functools import partial

import numpy as np
import pytest
from scipy.signal import bessel, butter, lfilter

from fegear.base.notes import NoteClass
from fegear.contact.curve_fit import fit_curve
from fegear.contact.fitted_error import behind_low_pass, beside_computed
from fegear.contact.measured_error import measured_error
from fegear.contact.trace_low_pass import filtered, filtered_higher, low_pass
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.trace_verdict import ComputedPeak, alike, verdict

ANGLE = np.linspace(-0.45, 0.5, 400)
STRAIN = 9e-4 * np.interp(
    ANGLE, [-0.2, -0.18, -0.03, 0.0, 0.06, 0.1, 0.22, 0.25], [0.0, 0.3, 0.5, 0.9, 1, 0.6, 0.65, 0]
)
TURNS = np.arange(0.0, 6.0 * math.pi, 5e-3)
FIT = ("offset", "scale", "shift")


def trace(lag, noise=5e-6):
    """Filtered sample by sample along the time, as an amplifier does."""
    place = np.mod(TURNS - 1.0 + math.pi, 2.0 * math.pi) - math.pi
    strain = np.interp(place, ANGLE, STRAIN)
    behind = strain.copy()
    for i in range(1, strain.size):
        behind[i] = behind[i - 1] + (strain[i] - behind[i - 1]) * (1.0 - math.exp(-5e-3 / lag)) if lag else strain[i]
    return 0.98 * behind + 3e-5 + np.random.default_rng(3).normal(0.0, noise, TURNS.size)


def test_a_step_and_a_ramp_behind_a_low_pass_have_their_closed_forms():
    angle = np.array([0.0, 1e-9, 1.0])
    at, step = filtered(angle, np.array([0.0, 1.0, 1.0]), 0.2)
    assert step == pytest.approx(1.0 - np.exp(-at / 0.2), abs=2e-3)
    at, ramp = filtered(np.array([0.0, 1.0]), np.array([0.0, 1.0]), 0.2)
    assert ramp == pytest.approx(at - 0.2 * (1.0 - np.exp(-at / 0.2)), abs=1e-12)


@pytest.mark.parametrize("lag", [0.05, 0.5, 4.0])
def test_harmonics_of_a_curve_that_repeats_have_their_closed_form_behind_a_low_pass(lag):
    angle = np.linspace(1.0, 1.0 + 2.0 * math.pi, 721)
    at, found = filtered(angle, 2.0 + np.cos(angle) + 0.4 * np.sin(3.0 * angle), lag, repeats=True)
    assert found[-1] == pytest.approx(found[0], abs=1e-9)
    expected = 2.0 + sum(
        (factor * np.exp(1j * n * at) / (1.0 + 1j * n * lag)).real for n, factor in ((1, 1.0), (3, -0.4j))
    )
    np.testing.assert_allclose(found, expected, atol=1e-4)


@pytest.mark.dear
def test_an_encoder_behind_a_low_pass_has_its_time_constant_and_no_other_difference_has_one():
    """A transmission error with three harmonics, 23 teeth; samples filtered one by one along three turns."""
    x = np.linspace(-2e-3, 7e-3, 181)

    def curve(phase):
        return 1e-6 * (np.cos(phase) + 0.5 * np.sin(2.0 * phase) + 0.3 * np.cos(3.0 * phase))

    te = curve(2.0 * math.pi * x / 9e-3)
    phase = np.arange(0.0, 3.0 * 23 * 2.0 * math.pi, 0.1)
    rng = np.random.default_rng(8)

    def asked(trace):
        found = measured_error(phase / 23.0, trace + rng.normal(0.0, 2e-8, phase.size), 23)
        fitted = beside_computed(found, x, te, 9e-3, FIT)
        return behind_low_pass(found, fitted, x, te, 9e-3, FIT)

    for lag in (0.4, 1.5):
        behind = 1.04 * curve(phase) + 8e-6 * np.cos(phase / 23.0)
        for i in range(1, phase.size):
            behind[i] = behind[i - 1] + (behind[i] - behind[i - 1]) * (1.0 - math.exp(-0.1 / lag))
        found = asked(behind)
        assert 23.0 * found.lag == pytest.approx(lag, rel=0.05)
        assert found.fitted.gain == pytest.approx(1.04, rel=0.01)
    assert asked(1.1 * curve(phase)) is None
    assert asked(curve(phase) + 2e-7 * np.sin(3.0 * phase)) is None  # flanks of another shape
    assert asked(curve(-phase)) is None


@pytest.mark.parametrize("lag", [0.02, 0.08])
def test_the_low_pass_is_named_in_place_of_a_verdict(lag):
    measured = trace(lag)
    found = fit_curve(TURNS, measured, ANGLE, STRAIN, FIT)
    behind = low_pass(found, TURNS, measured, ANGLE, STRAIN, FIT)
    assert behind.lag == pytest.approx(lag, rel=0.15)
    assert behind.fitted.gain == pytest.approx(0.98, abs=0.01)
    otherwise = Otherwise(low_pass=behind, speed=100.0)
    said = verdict(found, ComputedPeak(9e-4), otherwise)
    assert said.kind is NoteClass.FAILS
    assert said.startswith("the trace fits behind a low pass with a time constant of ")
    assert " Hz at 955 rpm: RMS" in said
    assert said.endswith("check filter and bandwidth of the amplifier")
    assert not alike(found, otherwise)


@pytest.mark.dear
def test_what_is_no_low_pass_has_none():
    steady = trace(0.0)
    other = steady + 6e-5 * np.sin(TURNS * 9.7)  # hum
    taller = trace(0.0) * (1.0 + 0.4 * (np.mod(TURNS - 1.0 + math.pi, 2.0 * math.pi) - math.pi))
    often = np.concatenate([steady[::2], steady[::2]])[: TURNS.size]  # an encoder that counts half
    for measured in (steady, other, taller, often):
        found = fit_curve(TURNS, measured, ANGLE, STRAIN, FIT)
        assert low_pass(found, TURNS, measured, ANGLE, STRAIN, FIT) is None
    backwards = fit_curve(-TURNS, trace(0.08), ANGLE, STRAIN, FIT)
    assert low_pass(backwards, -TURNS, trace(0.08), ANGLE, STRAIN, FIT) is None


def test_a_step_behind_a_butterworth_filter_of_second_order_has_its_closed_form():
    at, step = filtered_higher(np.array([0.0, 1e-9, 1.0]), np.array([2.0, 3.0, 3.0]), 0.05, "Butterworth", 2)
    phase = at / 0.05 / math.sqrt(2.0)
    expected = 3.0 - np.exp(-phase) * (np.cos(phase) + np.sin(phase))
    np.testing.assert_allclose(step, expected, atol=6e-3)  # the step is half a point early


@pytest.mark.parametrize("lag", [0.1, 1.3])
def test_harmonics_of_a_curve_that_repeats_have_their_closed_form_behind_a_butterworth_filter(lag):
    angle = np.linspace(1.0, 1.0 + 2.0 * math.pi, 721)
    at, found = filtered_higher(
        angle, 2.0 + np.cos(angle) + 0.4 * np.sin(3.0 * angle), lag, "Butterworth", 2, repeats=True
    )
    passed = {n: 1.0 / (1.0 + 1j * math.sqrt(2.0) * n * lag - (n * lag) ** 2) for n in (1, 3)}
    expected = 2.0 + (passed[1] * np.exp(1j * at) - 0.4j * passed[3] * np.exp(3j * at)).real
    np.testing.assert_allclose(found, expected, atol=1e-4)


@pytest.mark.parametrize(
    ("kind", "order", "made"), [("Butterworth", 4, butter), ("Bessel", 4, partial(bessel, norm="mag"))]
)
def test_filters_of_higher_order_are_named_with_their_limiting_frequency(kind, order, made):
    """Samples filtered one by one along three turns at 12 Hz, 2513 in each."""
    sampling, cutoff, speed = 2.0 * math.pi / 2.5e-3 * 12.0, 260.0, 2.0 * math.pi * 12.0
    turns = np.arange(0.0, 6.0 * math.pi, 2.5e-3)
    place = np.mod(turns - 1.0 + math.pi, 2.0 * math.pi) - math.pi
    noise = np.random.default_rng(5).normal(0.0, 4e-6, turns.size)
    measured = 1.03 * lfilter(*made(order, cutoff / (0.5 * sampling)), np.interp(place, ANGLE, STRAIN)) + noise
    found = fit_curve(turns, measured, ANGLE, STRAIN, FIT)
    behind = low_pass(found, turns, measured, ANGLE, STRAIN, FIT)
    assert (behind.kind, behind.order) == (kind, order)
    assert speed / (2.0 * math.pi * behind.lag) == pytest.approx(cutoff, rel=0.02)
    assert behind.fitted.gain == pytest.approx(1.03, abs=0.005)
    said = verdict(found, ComputedPeak(9e-4), Otherwise(low_pass=behind, speed=speed))
    assert f"behind a low pass of about order {order} ({kind}) with a limiting frequency of 260 Hz at 720 rpm" in said
