"""The wave of a trace once per turn: a drift is told from it where more than a turn was measured, and outliers left."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fegear.contact.once_per_turn import _FEWEST, _NEAR, once_per_turn, outside_mesh

CURVE = np.array([-0.3, 0.0, 0.3])
WAVE, AHEAD = 4e-6, 0.7


def trace(length, drift=0.0, count=4000):
    turns = np.linspace(0.0, length, count)
    angle = 2.0 * math.pi * turns
    used = outside_mesh(angle, 0.0, CURVE)
    measured = 1e-5 + WAVE * np.cos(angle - AHEAD) + drift * turns + np.where(used, 0.0, 1e-3)
    return angle, measured, turns


@pytest.mark.parametrize("length", [1.0, 1.3, 5.0])
def test_the_wave_is_that_of_the_samples_outside_the_mesh(length):
    angle, measured, turns = trace(length)
    found = once_per_turn(angle, measured, turns, 0.0, CURVE)
    assert found.amplitude == pytest.approx(WAVE, rel=1e-9)
    assert found.place == pytest.approx(AHEAD, rel=1e-9)
    later = once_per_turn(angle + 0.2, measured, turns, 0.2, CURVE)
    assert later.place == pytest.approx(AHEAD + 0.2, rel=1e-9)


@pytest.mark.parametrize(("length", "told"), [(0.99, False), (1.1, True), (4.0, True)])
def test_a_drift_is_told_from_the_wave_from_one_turn_on(length, told):
    """Within a turn a slope is as good a part of a wave; its ends outside the mesh are nearly a turn apart."""
    angle, measured, turns = trace(length, drift=2e-6)
    found = once_per_turn(angle, measured, turns, 0.0, CURVE)
    used = outside_mesh(angle, 0.0, CURVE)
    assert (float(np.ptp(turns[used])) > 1.0) is told
    if told:
        assert found.amplitude == pytest.approx(WAVE, rel=1e-9)
        assert found.error < 1e-9 * WAVE
    else:
        assert found.amplitude != pytest.approx(WAVE, rel=0.05)


def test_few_samples_far_off_change_nothing():
    angle, measured, turns = trace(3.0)
    noise = 1e-8 * np.random.default_rng(0).normal(size=angle.size)
    spoiled = measured + noise
    spoiled[np.flatnonzero(outside_mesh(angle, 0.0, CURVE))[100:160]] += 5e-4
    found = once_per_turn(angle, spoiled, turns, 0.0, CURVE)
    assert found.amplitude == pytest.approx(WAVE, rel=1e-3)
    assert 1e-11 < found.error < 1e-8


def test_too_little_of_a_turn_or_too_few_samples_say_nothing():
    angle, measured, turns = trace(1.0)
    part = angle < 0.5 * math.pi
    assert once_per_turn(angle[part], measured[part], turns[part], 0.0, CURVE) is None
    few = np.linspace(0, angle.size - 1, _FEWEST - 1).astype(int)
    assert once_per_turn(angle[few], measured[few], turns[few], 0.0, CURVE) is None


@pytest.mark.parametrize("shift", [0.0, 0.5, 2.0 * math.pi + 0.5])
def test_samples_are_outside_the_mesh_on_either_side_of_its_curve_and_in_every_turn(shift):
    edge = _NEAR * 0.3
    angle = shift + 0.1 + np.array([-edge - 1e-9, -edge + 1e-9, 0.0, edge - 1e-9, edge + 1e-9])
    expected = [True, False, False, False, True]
    for turn in (-2, 0, 3):
        found = outside_mesh(angle + 2.0 * math.pi * turn, shift, CURVE + 0.1)
        assert found.tolist() == expected
