"""A jump of the zero of a trace is found with its height and place; drifts, noise and stepped torques have none."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.curve_fit import fit_curve
from fegear.contact.zero_jump import zero_jump
from fegear.results.pair.trace_named import drift_named, jump_of
from fegear.results.pair.trace_verdict import ComputedPeak, verdict

ANGLE = np.linspace(-0.4, 0.5, 300)
STRAIN = 9e-4 * np.interp(ANGLE, [-0.2, -0.15, 0.0, 0.05, 0.1, 0.2, 0.24], [0.0, 0.3, 0.9, 1.0, 0.6, 0.65, 0.0])
TURNED = np.arange(0.0, 8.0 * math.pi, 0.01)
TURNS = TURNED / (2.0 * math.pi)
FIT = ("offset", "scale", "shift")


def trace(zero=0.0, gain=1.0):
    place = np.mod(TURNED - 1.0 + math.pi, 2.0 * math.pi) - math.pi
    noise = np.random.default_rng(6).normal(0.0, 5e-6, TURNED.size)
    return gain * np.interp(place, ANGLE, STRAIN) + zero + noise


def jump(measured, turns=4.0):
    some = turns >= TURNS
    return zero_jump(TURNED[some], measured[some], TURNS[some], 1.0, ANGLE)


@pytest.mark.parametrize(("height", "turn"), [(1.1e-4, 1.3), (-6e-5, 2.55)])
def test_height_and_place_of_a_jump_are_found(height, turn):
    found = jump(trace(np.where(turn < TURNS, height, 0.0)))
    assert found.height == pytest.approx(height, rel=0.01)
    assert found.turn == pytest.approx(turn, abs=0.01)


def test_what_is_no_jump_has_none():
    drift, warming = 8e-5 * TURNS, 2e-4 * (1.0 - np.exp(-TURNS / 1.5))
    runout, stepped = 5e-5 * np.cos(TURNED), np.where(TURNS > 2.0, 1.4, 1.0)
    for measured in (trace(), trace(drift), trace(warming), trace(runout), trace(gain=stepped)):
        assert jump(measured) is None
    assert jump(trace(np.where(TURNS > 0.6, 1e-4, 0.0)), turns=1.2) is None


def test_a_jump_is_named_in_place_of_drift_and_runout():
    measured = trace(np.where(TURNS > 1.3, 1.1e-4, 0.0))
    found = fit_curve(TURNED, measured, ANGLE, STRAIN, FIT)
    assert drift_named(found).startswith("the measured strain drifts by ")
    found = replace(found, jump=jump(measured))
    said = drift_named(found)
    assert said.startswith("the zero of the measured strain jumps by 110 µm/m after 1.30 turns (connector, slip ring, ")
    assert "; its zero jumps by 110 µm/m after 1.30 turns" in verdict(found, ComputedPeak(9e-4), brief=True)
    assert found.unfitted_drift is None
    assert jump_of(replace(found, jump=replace(found.jump, height=1e-6))) == ""
