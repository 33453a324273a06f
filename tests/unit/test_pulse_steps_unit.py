"""Lost pulses, few samples and moving averages of traces of encoders are named, and nothing of good traces."""

import math

import numpy as np
import pytest

from fegear.contact.fitted_error import behind_low_pass, beside_computed
from fegear.contact.measured_error import measured_error
from fegear.contact.trace_low_pass import filtered_higher
from fegear.results.pair.better_described import behind_low_pass as said

TEETH, MATE, PITCH, TURN = 23, 61, 9e-3, 2.0 * math.pi
X = np.linspace(-2e-3, -2e-3 + PITCH, 181)
FIT = ("offset", "scale", "shift")


def curve(x):
    phase = TURN * np.asarray(x) / PITCH
    return 1e-6 * (10.0 + np.cos(phase - 0.4) + 0.5 * np.sin(2.0 * phase) + 0.2 * np.cos(3.0 * phase))


def trace(turns, a_tooth=46.7, noise=0.3e-6, scale=1.0, seed=1):
    count = int(turns * TEETH * a_tooth)
    angle = 0.3 + TURN * turns * np.arange(count) / count
    te = scale * curve((angle - 0.02) * TEETH * PITCH / TURN)
    te = te + 8e-6 * np.cos(angle - 0.7) + 2e-6 * np.cos(2.0 * angle) + 4e-6 * np.cos(angle * TEETH / MATE)
    return angle, te + noise * np.random.default_rng(seed).normal(size=count)


def stepped(te, angle, *steps):
    return te + sum(height * (angle > angle[0] + TURN * turn) for turn, height in steps)


@pytest.mark.parametrize("steps", [((1.37, 3e-6),), ((0.9, -1.5e-6),), ((0.8, 2e-6), (2.6, 2e-6))])
def test_lost_pulses_are_found_with_height_and_place(steps):
    angle, te = trace(4.0)
    found = measured_error(angle, stepped(te, angle, *steps), TEETH, MATE).steps
    assert len(found) == len(steps)
    for one, (turn, height) in zip(found, steps, strict=True):
        assert one.height == pytest.approx(height, rel=0.15)
        assert one.angle == pytest.approx(0.3 + TURN * turn, abs=1.1 * TURN / TEETH)


def test_runout_and_drift_and_pitch_deviations_are_no_lost_pulses():
    for seed in range(12):
        rng = np.random.default_rng(seed)
        angle, te = trace(rng.uniform(1.1, 5.0), rng.uniform(20.0, 60.0), rng.uniform(0.05, 0.5) * 1e-6, seed=seed)
        walk = np.cumsum(rng.normal(size=TEETH)) * 1e-6
        walk -= np.linspace(0.0, walk[-1], TEETH)
        te = (
            te
            + 1.5e-6 * np.cos(3.0 * angle)
            + 3e-6 * angle / angle[-1]
            + walk[(angle / TURN * TEETH).astype(int) % TEETH]
        )
        assert measured_error(angle, te, TEETH, MATE).steps == ()


@pytest.mark.parametrize(("a_tooth", "resolved"), [(5.3, 2), (7.7, 3), (13.0, 5)])
def test_few_samples_give_the_harmonics_that_they_resolve(a_tooth, resolved):
    found = measured_error(*trace(4.0, a_tooth, 0.03e-6, scale=1.1), TEETH, MATE)
    assert found.resolved == resolved
    assert found.samples == pytest.approx(a_tooth, rel=0.01)
    assert found.n[-1] == resolved
    assert found.amplitude[:2] == pytest.approx([1.1e-6, 0.55e-6], rel=0.02)
    fitted = beside_computed(found, X, curve(X), PITCH, FIT)
    assert fitted.scale == pytest.approx(1.1, rel=0.01)
    assert fitted.likeness > 0.999
    assert measured_error(*trace(4.0, 16.4), TEETH, MATE).resolved is None


def test_a_moving_average_over_samples_is_named_with_its_width():
    angle, te = trace(3.0, 200.0, 0.05e-6)
    count = round(0.1 / (angle[1] - angle[0]))
    averaged = np.convolve(te, np.ones(count) / count)[count : te.size]
    found = measured_error(angle[count:], averaged, TEETH, MATE)
    fitted = beside_computed(found, X, curve(X), PITCH, FIT)
    behind = behind_low_pass(found, fitted, X, curve(X), PITCH, FIT)
    assert behind.kind == "moving average"
    assert behind.width == pytest.approx(count * (angle[1] - angle[0]), rel=0.01)
    assert behind.fitted.gain == pytest.approx(1.0, abs=0.01)
    words = said(behind, fitted, 3e-6, TURN, "the peak-to-peak value", "averaging")
    assert words.startswith("the trace fits behind a moving average over 5.7° of rotation, 16 ms at 60 rpm: RMS of ")


def test_a_moving_average_of_a_curve_that_repeats_has_its_closed_form():
    angle = np.linspace(0.0, TURN, 721)
    at, found = filtered_higher(angle, np.cos(2.0 * angle), 0.1, "moving average", 1, repeats=True)
    width = 2.783115 * 0.1
    expected = (np.sin(2.0 * at) - np.sin(2.0 * (at - width))) / (2.0 * width)
    np.testing.assert_allclose(found, expected, atol=1e-4)
    assert abs(np.sinc(0.5 * 2.783115 / math.pi)) == pytest.approx(math.sqrt(0.5), rel=1e-6)
