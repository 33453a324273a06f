"""Which differences, scatter and height on the flank the error of a root stress is made of."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.fem.plane.flank_samples import SAMPLES
from fegear.fem.plane.stress_estimate import StressEstimate

RADIUS, WIDTH = np.array([10.0, 10.4, 11.2]), np.full(3, 0.03)
VALUE, PLACE = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.2, 0.3])
DIFFERENCE, SCATTER, BESIDE = np.array([0.1, 0.5, 0.2]), np.array([0.01, 0.02, 0.03]), np.array([0.3, 0.1, 0.2])


@pytest.mark.parametrize("side", ["tension", "compression"])
@pytest.mark.parametrize(("k", "scatters", "climbs"), [(0, True, True), (1, True, False), (-1, False, False)])
def test_the_loaded_tooth_errs_less_up_its_flank_and_a_tooth_behind_does_not_scatter(side, k, scatters, climbs):
    asked = []
    known = StressEstimate(Space(tooth=Space(internal=False)), None, np.linspace(10.0, 12.0, SAMPLES))

    def put(name, one):
        known.__dict__[name] = one

    put("_stress_at_samples", lambda number: asked.append(number))

    def stress_of(*given):
        assert asked == [k]  # of the samples first
        number, of, radius, half = given
        assert (number, of) == (k, side)
        assert radius is RADIUS
        assert half is WIDTH
        return VALUE, PLACE, DIFFERENCE, SCATTER, BESIDE

    def estimate(number, of, value, off, scatter, up):
        assert (number, of) == (k, side)
        assert value is VALUE
        np.testing.assert_array_equal(off, [0.3, 0.5, 0.2])
        np.testing.assert_array_equal(scatter, SCATTER if scatters else 0.0)
        np.testing.assert_allclose(up, [0.0, 0.2, 0.6] if climbs else 0.0, rtol=1e-12)
        return "error"

    put("_stress_of", stress_of)
    put("_stress_estimate", estimate)
    assert known.root_stress(k, side, RADIUS, WIDTH) == (VALUE, PLACE, "error")


@pytest.mark.parametrize("internal", [False, True])
def test_a_contact_is_as_far_up_as_from_the_start_of_the_flank_to_its_end(internal):
    known = StressEstimate(Space(tooth=Space(internal=internal)), None, np.linspace(10.0, 12.0, SAMPLES))
    up = np.array([0.0, 0.0, 0.25, 1.0, 1.0])
    np.testing.assert_allclose(known._up(np.array([9.0, 10.0, 10.5, 12.0, 13.0])), 1.0 - up if internal else up)
