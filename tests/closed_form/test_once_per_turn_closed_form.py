"""What a trace of a gauge has once per turn, from the samples outside the mesh."""

import math

import numpy as np
import pytest

from fegear.contact.once_per_turn import once_per_turn

CURVE = np.linspace(-0.45, 0.5, 200)
AT = np.arange(0.0, 8.0 * math.pi, 0.008)


def trace(amplitude, place, *, shift=1.3, noise=3e-6, drift=0.0, seed=1):
    """A tooth of 900 um/m, a wave, a drift per turn, noise and a few spikes."""
    rng = np.random.default_rng(seed)
    of_mesh = np.mod(AT - shift + math.pi, 2.0 * math.pi) - math.pi
    strain = 9e-4 * np.clip(1.0 - np.abs(of_mesh) / 0.4, 0.0, None) + 5e-5 + drift * AT / (2.0 * math.pi)
    strain += amplitude * np.cos(AT - place) + rng.normal(0.0, noise, AT.size)
    strain[rng.choice(AT.size, 9, replace=False)] += 2e-3
    return np.mod(AT, 2.0 * math.pi), strain, AT / (2.0 * math.pi)


@pytest.mark.parametrize("drift", [0.0, 2e-5])
@pytest.mark.parametrize(("amplitude", "place"), [(2.5e-5, 0.7), (4e-5, -2.9), (1e-5, 3.0)])
def test_amplitude_and_place_are_found_again_whatever_mesh_drift_and_spikes_do(amplitude, place, drift):
    found = once_per_turn(*trace(amplitude, place, drift=drift), 1.3, CURVE)
    assert found.error < 2e-7
    assert abs(found.amplitude - amplitude) < 4.0 * found.error
    assert math.cos(found.place - place) == pytest.approx(1.0, abs=5e-4)
    assert found.at(np.array([found.place])) == pytest.approx(found.amplitude)


def test_a_trace_without_a_wave_has_none_and_its_error_is_that_of_many_traces():
    found = [once_per_turn(*trace(0.0, 0.0, seed=seed), 1.3, CURVE) for seed in range(40)]
    # of a vector of two normal parts: the mean of its size is 1.25 times the standard error of each
    assert np.mean([one.amplitude for one in found]) == pytest.approx(1.25 * found[0].error, rel=0.3)


def test_too_little_outside_the_mesh_is_none():
    angle, strain, turns = trace(2e-5, 0.0)
    near = np.abs(np.mod(angle - 1.3 + math.pi, 2.0 * math.pi) - math.pi) < 0.9
    assert once_per_turn(angle[near], strain[near], turns[near], 1.3, CURVE) is None
    assert once_per_turn(angle[::200], strain[::200], turns[::200], 1.3, CURVE) is None
