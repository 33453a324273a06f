"""How much of what two solutions usually differ by is an error of neighbours at least, along the flank."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.fem.plane.estimate import _SAMPLES, Estimate
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rack import BasicRack

GEAR = Tooth(30, BasicRack(1.0, 1.25, 0.25))
RING = InternalTooth(50, PinionCutter(27, -0.134, 1.25, tip_radius=0.14), profile_shift=0.459, tip_radius=23.682)
#: Longest edges at tolerances of 0.01 and 0.1, half-width of the wider pressure at both [modules].
EDGE, LONG_EDGE, WIDE = 0.26, 0.44, 0.36


def least(tooth, edge=EDGE, patch=WIDE, order=4):
    """Ascending along the flank."""
    flank = SimpleNamespace(order=order, arc=np.linspace(0.0, 5.0 * edge, 6))
    found = Estimate(SimpleNamespace(flank=flank, tooth=tooth), None, patch, 2.0 * patch)
    low, high = sorted(tooth.involute_radii)
    samples = np.linspace(max(low, tooth.base_radius), high, _SAMPLES)
    found.__dict__["_samples"] = samples
    return found._least_of_usual(samples)


def test_a_tolerance_of_a_hundredth_leaves_a_quarter_of_gears():
    """It was 0.8: the median of a place was stated 8 times the true error."""
    assert least(GEAR) == pytest.approx(np.full(_SAMPLES, 0.25))


@pytest.mark.parametrize("tooth", [GEAR, RING])
def test_longer_edges_and_lower_orders_leave_more_all_over_the_flank(tooth):
    assert least(tooth, LONG_EDGE) == pytest.approx(np.full(_SAMPLES, 0.8), abs=1e-3)
    assert least(tooth, order=3) == pytest.approx(np.full(_SAMPLES, 0.8))


@pytest.mark.parametrize("tooth", [GEAR, RING])
def test_narrow_pressures_on_short_edges_leave_little(tooth):
    assert least(tooth, 0.05, 0.2) == pytest.approx(np.full(_SAMPLES, 0.2))


def test_by_the_tip_of_a_ring_more_is_left_and_fades_toward_its_root():
    """Three of 64 rings were off by half to all of what solutions usually differ by, and nowhere else so much."""
    found = least(RING)
    assert found[0] == pytest.approx(0.8, abs=1e-3)
    assert found[-1] == pytest.approx(0.25)
    assert (np.diff(found) <= 0.0).all()
    assert (np.abs(np.diff(found)) < 0.3).all()


def test_a_place_of_two_teeth_has_the_larger_part_of_both():
    flank = SimpleNamespace(order=4, arc=np.linspace(0.0, 5.0 * EDGE, 6))
    known = Estimate(SimpleNamespace(flank=flank, tooth=RING, reach=0), None, WIDE, 2.0 * WIDE)
    low, high = RING.involute_radii
    samples = np.linspace(low, high, _SAMPLES)
    usual = {1: np.ones((_SAMPLES, _SAMPLES))}
    known.__dict__.update(_samples=samples, common_errors=(0.0, 0.0), _least_beside=0.0, _neighbours=usual)
    off = np.zeros((2, 2))
    object.__setattr__(known, "_neighbour_difference", lambda *_asked: (off, off))
    _, error = known.neighbour(1, samples[[0, -1]], samples[[0, -1]])
    assert error == pytest.approx(np.array([[0.8, 0.8], [0.8, 0.25]]), abs=1e-3)
