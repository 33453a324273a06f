"""Round-off that modes are said to have, and springs of a mesh's law: against the formulas they stand for."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.dynamics.helical_pair.modal_indices import ModeTable, _doubts
from fegear.dynamics.planetary import mesh_law
from fegear.dynamics.planetary.mesh_law import SlotSprings, forces, springs

EPS = np.finfo(float).eps


def test_a_frequency_loses_digits_by_the_stiffest_mode_and_a_shape_by_the_nearest_one():
    """Eigenvalues are good to eps n times the largest: half of that over its square; over the gap to the nearest."""
    frequency = np.array([50.0, 20.0, 19.0, 2.0, 0.0, 0.0])
    of_frequency, of_shape = _doubts(frequency)
    noise = EPS * 6 * 2500.0
    np.testing.assert_allclose(of_frequency, [*(0.5 * noise / frequency[:4] ** 2), 0.0, 0.0], rtol=1e-12)
    gaps = [2100.0, 39.0, 39.0, 4.0]
    np.testing.assert_allclose(of_shape, [*(noise / np.array(gaps)), 0.0, 0.0], rtol=1e-12)
    together = _doubts(np.array([30.0, 30.0, 1e-6]))
    assert together[1].tolist() == [1.0, 1.0, pytest.approx(EPS * 3, rel=1e-6, abs=0.0)]  # one choice of many
    assert together[0][2] == pytest.approx(1.5 * EPS * 900.0 * 1e12)
    for none in _doubts(np.zeros(3)):
        assert none.tolist() == [0.0, 0.0, 0.0]


def test_modes_that_lost_half_of_their_digits_are_named_by_their_number():
    def remarks(frequency, of_frequency, of_shape):
        size = np.zeros(len(frequency))
        one = np.array
        return ModeTable(
            size, one(frequency), size, size, size, size, size, size, one(of_frequency), one(of_shape)
        ).remarks

    assert remarks([3.0, 2.0], [1e-9, 0.9e-8], [1e-9, 0.9e-8]) == ()
    (soft,) = remarks([9.0, 3.0, 2.0, 0.0], [1e-12, 2e-8, 3e-4, 1.0], [0.0, 0.0, 0.0, 1.0])
    assert soft.startswith("modes 2, 3: round-off error of the frequencies 0.030 %")
    (near,) = remarks([9.0, 9.0, 2.0], [1e-12, 1e-12, 1e-12], [1.0, 1.0, 1e-12])
    assert near.startswith("modes 1, 2: repeated natural frequencies")
    assert len(remarks([9.0, 2.0], [1e-7, 1e-12], [1e-12, 1e-7])) == 2


# ---- the law of a mesh -----------------------------------------------------------------------------------------------
def test_forces_of_a_law_reach_beyond_what_all_planets_carry_and_hold_that_of_an_equal_share():
    for planets in (1, 3, 4, 7):
        found, at_mean = forces(200.0, planets)
        assert found[at_mean] == 200.0
        assert (np.diff(found) > 0.0).all()
        assert found[-2] <= 200.0 * planets < found[-1]
        assert found[0] == 0.2
    assert len(mesh_law._LEVELS) == 20


def test_springs_of_a_law_give_its_forces_back_and_are_straight_between_them():
    """Load over approach of a contact that stiffens, at two places; its slope at the smallest force is given."""
    force = np.array([1.0, 10.0, 30.0, 100.0])
    flexible = np.array([2e-8, 5e-8])
    approach = flexible[:, None] * force**0.9 + np.array([[1e-6], [-2e-6]])
    stiffness = 1.0 / (0.9 * flexible * force[0] ** -0.1)
    found = springs(force, approach, stiffness, np.zeros((0, 2)))

    def carried(at):
        return (found.stiffness * np.maximum(at[:, None] - found.separation, 0.0)).sum(axis=1)

    for k, one in enumerate(force):
        np.testing.assert_allclose(carried(approach[:, k]), one, rtol=1e-9)
    np.testing.assert_allclose(carried(0.5 * (approach[:, 1] + approach[:, 2])), 20.0, rtol=1e-9)
    np.testing.assert_allclose(carried(approach[:, 0] - 0.5 / stiffness), 0.5, rtol=1e-9)
    np.testing.assert_allclose(found.stiffness[:, 0], stiffness, rtol=1e-12)
    assert found.level.tolist() == [0.0, 1.0, 10.0, 30.0]
    assert (found.stiffness >= 0.0).all()
    assert found.separation.shape == found.bent.shape == (2, 4)
    # A straight law has one spring, and what round-off makes of the others is none.
    straight = springs(force, force / 3e7 * np.ones((2, 1)), np.full(2, 3e7), np.zeros((0, 2)))
    np.testing.assert_allclose(straight.stiffness, [[3e7, 0.0, 0.0, 0.0]] * 2, rtol=1e-9)
    np.testing.assert_allclose(straight.bent, 0.0, atol=1e-18)
    softens = springs(force, force**1.1 * 1e-8 * np.ones((1, 1)), np.array([1e8 / 1.1]), np.zeros((0, 1)))
    assert (softens.stiffness[0, 1:] == 0.0).all()


def test_a_law_is_bent_by_what_a_parabola_misses_in_the_middle_of_its_forces():
    """Of an approach a F - c F^2 the chord over h misses c h^2/4 in its middle; both ends of a step are added."""
    force = np.array([1.0, 2.0, 4.0, 5.0])
    approach = (1e-6 * force - 3e-8 * force**2)[None]
    found = springs(force, approach, np.array([1.0 / (1e-6 - 6e-8)]), np.zeros((0, 1)))
    steps = np.diff(np.append(0.0, force))
    # To zero force the law is straight: half a step's bend less there, at its one neighbour counted twice.
    assert found.bent[0, 2:] == pytest.approx(2.0 * 3e-8 * 0.25 * steps[2:] ** 2, rel=1e-9, abs=0.0)
    assert found.bent.shape == (1, 4)
    assert (found.bent > 0.0).all()


def test_springs_of_slots_stand_at_their_place_and_the_first_alone_bears_from_the_start():
    part = SimpleNamespace
    one = [part(breaks=np.array([0.1, 0.9])), part(breaks=np.array([0.4]))]
    two = [part(breaks=np.array([0.7])), part(breaks=np.array([-0.2]))]
    teeth = part(stiffness=one, separation=two, phase=0.3)
    np.testing.assert_allclose(SlotSprings(teeth).breaks, [-0.2, 0.6, 0.1, 0.4, -0.5])
    teeth = part(
        stiffness=[lambda s: 10.0 + s, lambda s: 20.0 + s], separation=[lambda s: 1.0 - s, lambda s: 3.0 * s], phase=0.3
    )
    place = np.array([0.0, 0.5, 2.0])
    found = SlotSprings(teeth).at(place)
    s = place + 0.3
    np.testing.assert_allclose(found.stiffness, np.column_stack([10.0 + s, 20.0 + s]))
    np.testing.assert_allclose(found.separation, np.column_stack([1.0 - s, 3.0 * s]))
    assert found.level.tolist() == [0.0, np.inf]
    assert found.off.shape == (0, 3)
    assert not found.bent.any()
