"""Errors from two orders of elements: what counts of edges, of widths, and of neighbours' stress."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.fem.plane.estimate import (
    _COMPRESSED,
    _LEAST_NEIGHBOUR_STRESS,
    _LEAST_STRESS_SHARE,
    _OF_OWN_STRESS,
    _SMOOTH_STRESS,
    _STRESS_EDGES,
    _STRESS_POWER,
    _USUAL,
    Estimate,
)

ORDER = 4


def estimate(edges, stresses):
    """With fillet edges so long, and differences as if looked for at samples: tooth, side -> value, difference."""
    arc = np.concatenate([[0.0], np.cumsum(np.repeat(np.asarray(edges) / ORDER, ORDER))])
    fine = SimpleNamespace(flank=SimpleNamespace(order=ORDER), fillets={"tension": SimpleNamespace(arc=arc)})
    found = Estimate(fine, fine, 0.1, 0.2)
    found.__dict__["_stresses"] = stresses
    return found


@pytest.mark.parametrize(
    ("count", "share"),
    [
        (3, 1.0),
        (5, (_STRESS_EDGES / 5) ** _STRESS_POWER),
        (8, (_STRESS_EDGES / 8) ** _STRESS_POWER),
        (40, _LEAST_STRESS_SHARE),
    ],
)
def test_the_shorter_the_edges_the_less_counts_of_the_difference(count, share):
    assert estimate([0.3 / count] * count, {})._stress_share == pytest.approx(share, rel=1e-9)


def test_edges_graded_toward_the_end_of_a_fillet_say_nothing_of_those_at_the_largest_stress():
    """Five edges and as many ever shorter ones beside the root land were ten: 1.8 times the stated error was true."""
    graded = [0.08, 0.08, 0.08, 0.08, *(0.04 * 0.5**i for i in range(6))]
    even = estimate([sum(graded) / 10] * 10, {})._stress_share
    assert even == pytest.approx((_STRESS_EDGES / 10) ** _STRESS_POWER)
    assert estimate([sum(graded) / 6] * 6, {})._stress_share < estimate(graded, {})._stress_share < 2.0 * even


def test_the_error_of_a_neighbours_stress_is_relatively_no_less_than_a_part_of_what_the_tooth_itself_differs_by():
    """Both orders agreed by chance: 2.6e-4 of a neighbour's stress was true, 7.5 times what was stated."""
    samples = np.ones(17)
    own = {"tension": (100.0 * samples, 0.1 * samples), "compression": (-100.0 * samples, 0.1 * samples)}
    stresses = {
        0: own,
        2: {"tension": (75.0 * samples, 0.01 * samples), "compression": (-0.3 * samples, 0.2 * samples)},
    }
    found = estimate([0.3 / 40] * 40, stresses)
    wanted = [_OF_OWN_STRESS * _USUAL * 1e-3 * 75.0, _SMOOTH_STRESS * _LEAST_STRESS_SHARE * 3.0]
    assert found._stress_estimate(2, "tension", np.array([75.0, 75.0]), np.array([0.0, 3.0])) == pytest.approx(wanted)


def test_the_error_of_a_neighbours_fillet_that_is_hardly_stressed_does_not_vanish_and_is_not_that_of_the_other():
    """Of the other, where stress ends at the flank, it was up to fifty times too large."""
    samples = np.ones(17)
    own = {"tension": (100.0 * samples, 0.0 * samples), "compression": (-100.0 * samples, 0.0 * samples)}
    stresses = {0: own, 1: {"tension": (0.0 * samples, 0.01 * samples), "compression": (-0.3 * samples, 0.2 * samples)}}
    found = estimate([0.3 / 40] * 40, stresses)
    for side, least in (
        ("tension", _SMOOTH_STRESS * _LEAST_STRESS_SHARE * 0.02),
        ("compression", _LEAST_NEIGHBOUR_STRESS * _USUAL * 0.2),
    ):
        assert found._stress_estimate(1, side, np.zeros(2), np.zeros(2)) == pytest.approx([least] * 2)


@pytest.mark.parametrize(("k", "side"), [(1, "tension"), (-1, "tension"), (-1, "compression"), (1, "compression")])
def test_only_the_fillet_of_a_neighbour_that_lies_beside_the_loaded_flank_errs_by_what_both_orders_share(k, side):
    """Of the smooth others 10 to 30 times the true error was stated: 3 % of the difference were true."""
    samples = np.ones(17)
    own = {"tension": (100.0 * samples, 0.0 * samples), "compression": (-100.0 * samples, 0.0 * samples)}
    found = estimate([0.3 / 40] * 40, {0: own, k: dict.fromkeys(own, (samples, 0.2 * samples))})
    beside = (k, side) == (1, "compression")
    least = _LEAST_NEIGHBOUR_STRESS * _USUAL if beside else _SMOOTH_STRESS * _LEAST_STRESS_SHARE
    assert found._stress_estimate(k, side, samples, 0.0 * samples) == pytest.approx(least * 0.2 * samples)


def test_both_fillets_of_the_loaded_tooth_err_by_the_larger_share():
    samples = np.ones(17)
    stresses = {0: {"tension": (10.0 * samples, 0.1 * samples), "compression": (-20.0 * samples, 0.0 * samples)}}
    found = estimate([0.1] * 3, stresses)
    wanted = _COMPRESSED * _USUAL * 0.01 * 20.0
    assert found._stress_estimate(0, "compression", np.array([-20.0]), np.zeros(1)) == pytest.approx([wanted])


def test_of_a_neighbours_deflection_more_of_the_order_counts_where_edges_are_long():
    """On a thin rim half of what third order changed was true at a tolerance of 0.01: 3.1 times what was stated."""
    shares = []
    for patch in (0.18, 0.25, 0.36):
        found = estimate([0.1] * 5, {})
        shares.append(Estimate(found.fine, found.coarse, patch, 1.4 * patch)._neighbour_share)
    assert shares[0] == shares[1] == 0.15
    assert 0.33 < shares[2] < 0.4
