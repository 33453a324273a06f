"""Where something is largest: the first of the places that tie, whatever their last digits are."""

import numpy as np
import pytest

from fegear.base.arrays import first_of_largest
from fegear.contact.wide.root_stress import StressOverFace
from fegear.fem.solid.influence import solid_influence
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import SolidSolution
from fegear.fem.solid.table import _root, bands_of_table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

RANDOM = np.random.default_rng(7)


def noisy(values, share=1e-12):
    return values * (1.0 + share * RANDOM.uniform(-1.0, 1.0, np.shape(values)))


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_the_first_of_equal_values_is_taken_and_a_larger_one_before_it(scale):
    wave = scale * np.array([[1.0, 3.0, 2.0, 3.0], [-4.0, -2.0, -2.0, -3.0]])
    for _ in range(50):
        np.testing.assert_array_equal(first_of_largest(noisy(wave), axis=1), [1, 1])
        assert int(first_of_largest(noisy(wave))) == 1
    wave[0, 3] *= 1.0 + 1e-8
    np.testing.assert_array_equal(first_of_largest(wave, axis=1), [3, 1])
    assert int(first_of_largest([-np.inf, 0.0, -1.0, 0.0])) == 1
    np.testing.assert_array_equal(first_of_largest(scale * np.array([[1.0, 1.0 - 1e-7], [1.0, 2.0]]), 0, 1e-6), [0, 1])


def test_a_tooth_that_is_symmetric_over_the_face_is_worst_at_one_place_under_noise():
    z = np.linspace(-0.01, 0.01, 33)
    value = 3e8 * (1.0 + 0.2 * np.cos(4.0 * np.pi * z / 0.01) * np.ones((5, 1)))
    for sign in (1.0, -1.0):
        for _ in range(50):
            of = StressOverFace(np.arange(5.0), z, sign * noisy(value), np.full(value.shape, 0.02))
            most, place, radius = of.largest(sign)
            np.testing.assert_allclose(place, z[0])
            np.testing.assert_allclose(most, sign * 3.6e8, rtol=1e-11)
            assert radius.shape == place.shape


def test_a_band_in_the_middle_of_a_spur_s_face_stresses_it_most_at_one_place(monkeypatch):
    """Its stress is the same at either side of the middle, and where it was largest hung on the last bit."""
    tooth = Tooth(19, BasicRack(1.0, 1.25, 0.25), profile_shift=0.1)
    known = solid_influence(
        tooth, 0.0, 12.0, 0.3, 0.6 * tooth.root_radius, SolidSettings().scaled(2.5), estimate_error=False
    )
    asked = bands_of_table(known.fine, np.array([9.6]), np.array([0.0]), np.array([0.02]))
    original, places = SolidSolution.fillet_stress, set()
    monkeypatch.setattr(SolidSolution, "fillet_stress", lambda *given: noisy(twofold(original(*given))))

    def twofold(stress):
        """Stress that is largest at two places beside the middle."""
        z = np.linspace(-1.0, 1.0, stress.shape[2])[:, None]
        return 0.5 * (stress + stress[:, :, ::-1]) * (1.0 - np.cos(3.0 * np.pi * z))

    for _ in range(20):
        root = _root(known.fine, "tension", asked, 1.0)
        assert root.along.max() == pytest.approx(float(root.value.item()), rel=1e-9)
        places.add(float(root.position.item()))
    (place,) = places
    assert place < 0.0
