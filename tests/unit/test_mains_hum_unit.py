"""Mains hum of a trace is told from everything that turns with the gear or strains its tooth."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.curve_fit import fit_curve
from fegear.contact.mains_hum import mains_hum
from fegear.contact.turns import turns_along
from fegear.results.pair.trace_named import hum_named, step_named
from fegear.results.pair.trace_verdict import ComputedPeak, verdict

ANGLE = np.linspace(-0.45, 0.5, 400)
STRAIN = 9e-4 * np.interp(ANGLE, [-0.2, -0.18, -0.03, 0.0, 0.1, 0.22, 0.25], [0.0, 0.3, 0.5, 0.9, 0.6, 0.65, 0.0])
TURNS = np.arange(0.0, 14.0 * math.pi, 5e-3)
SPEED = 2.0 * math.pi * 11.0


def hum(measured, speed=SPEED, angle=TURNS):
    return mains_hum(angle, measured, turns_along(angle), speed, 1.0, ANGLE)


def trace(amplitude=0.0, frequency=50.0, wave=0.0, drift=0.0, noise=5e-6):
    place = np.mod(TURNS - 1.0 + math.pi, 2.0 * math.pi) - math.pi
    strain = np.interp(place, ANGLE, STRAIN, left=0.0, right=0.0) * (1.0 + wave * np.cos(0.62 * TURNS))
    strain += amplitude * np.sin(2.0 * math.pi * frequency * TURNS / SPEED + 0.4) + drift * TURNS / TURNS[-1]
    return strain + 4e-5 * np.cos(TURNS) + np.random.default_rng(2).normal(0.0, noise, TURNS.size)


@pytest.mark.parametrize("frequency", [50.0, 59.6])
def test_frequency_and_amplitude_of_hum_are_recovered(frequency):
    found = hum(trace(4e-5, frequency))
    assert found.frequency == pytest.approx(frequency, abs=0.05)
    assert found.amplitude == pytest.approx(4e-5, rel=0.02)
    assert found.order == pytest.approx(frequency / 11.0, rel=1e-3)
    rest = trace(4e-5, frequency) - found.at(turns_along(TURNS)) - trace()
    assert np.abs(rest).max() < 3e-6
    wrapped = hum(trace(4e-5, frequency), angle=np.mod(TURNS, 2.0 * math.pi))
    assert wrapped.amplitude == pytest.approx(found.amplitude, rel=1e-6)


def test_what_is_no_hum_has_none():
    for other in (trace(), trace(4e-5, 44.0), trace(wave=0.3), trace(drift=4e-4), trace(4e-5, 55.0)):
        assert hum(other) is None
    assert hum(trace(4e-5), None) is None  # of an unknown speed
    assert hum(trace(4e-5), 2.0 * math.pi * 10.0) is None  # five times per turn
    few = 4.0 * math.pi > TURNS
    assert hum(trace(4e-5)[few], angle=TURNS[few]) is None


def test_hum_is_named_beside_the_verdict_where_it_is_large():
    measured = trace(4e-5)
    found = fit_curve(TURNS, measured, ANGLE, STRAIN, ("offset", "shift", "scale"))
    found = replace(found, hum=hum(measured))
    assert hum_named(found).startswith(
        "the measured strain has ±40.1 µm/m at 50 Hz (4.55 times per turn, no multiple of "
    )
    said = verdict(found, ComputedPeak(8e-4), brief=True)
    assert "; mains hum of ±40.1 µm/m at 50 Hz" in said
    assert said.word.endswith(", mains hum")
    assert hum_named(replace(found, hum=replace(found.hum, amplitude=1e-6))) == ""
    assert step_named(replace(found, step=2e-5)).startswith("the measured strain has steps of 20 µm/m, 2.")
    assert step_named(found) == ""
