"""Errors of root stress from two orders of elements: what counts of the fillet's edges and its neighbours' stress."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.fem.plane.estimate import _LEAST_STRESS_SHARE, _STRESS_EDGES, _USUAL, Estimate

ORDER = 4


def estimate(edges, stresses):
    """With fillet edges so long, and differences as if looked for at samples: tooth, side -> value, difference."""
    arc = np.concatenate([[0.0], np.cumsum(np.repeat(np.asarray(edges) / ORDER, ORDER))])
    fine = SimpleNamespace(flank=SimpleNamespace(order=ORDER), fillets={"tension": SimpleNamespace(arc=arc)})
    found = Estimate(fine, fine, 0.1, 0.2)
    found.__dict__["_stresses"] = stresses
    return found


@pytest.mark.parametrize(
    ("count", "share"), [(3, 1.0), (5, 1.0), (8, (_STRESS_EDGES / 8) ** 2), (40, _LEAST_STRESS_SHARE)]
)
def test_the_shorter_the_edges_the_less_counts_of_the_difference(count, share):
    assert estimate([0.3 / count] * count, {})._stress_share == pytest.approx(share, rel=1e-9)


def test_edges_graded_toward_the_end_of_a_fillet_say_nothing_of_those_at_the_largest_stress():
    """Five edges and as many ever shorter ones beside the root land were ten: 1.8 times the stated error was true."""
    graded = [0.08, 0.08, 0.08, 0.08, *(0.04 * 0.5**i for i in range(6))]
    assert estimate(graded, {})._stress_share > 0.7
    assert estimate([sum(graded) / 10] * 10, {})._stress_share == pytest.approx((_STRESS_EDGES / 10) ** 2)


def test_a_neighbours_fillet_whose_stress_nearly_vanishes_passes_on_its_error_and_no_share():
    """Its difference, large beside so small a stress, was taken for a share of the other's: 0.3 of 75 N/mm^2."""
    samples = np.ones(17)
    stresses = {2: {"tension": (75.0 * samples, 0.01 * samples), "compression": (-0.3 * samples, 0.2 * samples)}}
    found = estimate([0.1] * 5, stresses)
    value = np.array([75.0, 74.0])
    assert found._stress_estimate(2, "tension", value, np.array([0.0, 0.5])) == pytest.approx([_USUAL * 0.2, 0.5])
    assert found._stress_estimate(2, "compression", value, np.zeros(2)) == pytest.approx([_USUAL * 0.2] * 2)


def test_both_fillets_of_the_loaded_tooth_err_by_the_larger_share():
    samples = np.ones(17)
    stresses = {0: {"tension": (10.0 * samples, 0.1 * samples), "compression": (-20.0 * samples, 0.0 * samples)}}
    found = estimate([0.1] * 5, stresses)
    wanted = _USUAL * 0.01 * 20.0
    assert found._stress_estimate(0, "compression", np.array([-20.0]), np.zeros(1)) == pytest.approx([wanted])
