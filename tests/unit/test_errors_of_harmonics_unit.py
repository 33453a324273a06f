"""Errors of harmonics and of the effective error hold where what single shifts change cancels by chance."""

import numpy as np
import pytest

from fegear.contact.error_over_pitch import no_less_than_beside
from fegear.contact.fourier import panels
from fegear.contact.plane.shifted_loads import _between_two_places, _of_effective


def test_a_harmonic_in_which_changes_cancel_has_an_error_as_those_beside_it():
    error = np.array([4.0, 3.0, 0.0, 3.0, 2.0])
    found = no_less_than_beside(error)
    assert (found >= error).all()
    assert found[2] == pytest.approx(np.sqrt(7.6))
    assert no_less_than_beside(np.full(5, 2.0)) == pytest.approx(np.full(5, 2.0))
    assert (no_less_than_beside(np.zeros(5)) == 0.0).all()


def test_the_effective_errors_error_is_that_of_its_harmonics():
    """A_e = A_1 + sqrt(sum A_i^2): by differences, each harmonic off by itself."""
    rng = np.random.default_rng(5)
    a, off = rng.uniform(0.1, 1.0, 20), 1e-6 * rng.uniform(0.1, 1.0, 20)

    def effective(amplitude):
        return amplitude[0] + np.sqrt(np.sum(amplitude[:12] ** 2))

    changes = [effective(a + off * (np.arange(20) == i)) - effective(a) for i in range(20)]
    assert _of_effective(a, off) == pytest.approx(np.sqrt(np.sum(np.square(changes))), rel=1e-5)
    assert a[0] > 0.0  # amplitudes are left as they are
    assert _of_effective(np.zeros(20), off) == pytest.approx(off[0])


def test_a_peak_to_peak_value_errs_as_two_places_of_the_change_differ():
    """Of a straight change half of all places are 0.29 of it apart; a spike over a tenth of the pitch counts little."""
    points = panels(-1.0, 8.0, [2.0])
    place = (points.x - points.breaks[0]) / 8.0
    straight = 4e-6 * place
    assert _between_two_places(points, straight) == pytest.approx(4e-6 * (1.0 - np.sqrt(0.5)), rel=0.04)
    spike = np.where(np.abs(place - 0.4) < 0.05, 1e-3, 0.0)
    assert _between_two_places(points, spike) == 0.0
    assert _between_two_places(points, straight + spike) < 1.5 * _between_two_places(points, straight)
    assert _between_two_places(points, np.full(points.x.size, 7.0)) == 0.0
