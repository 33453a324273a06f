"""The curve through stresses at Gauss points and its largest value."""

import numpy as np
import pytest

from fegear.fem.plane.root_stress import extreme, search_end

LENGTH = 0.9


def gauss_points(edges, order):
    ends = LENGTH * np.linspace(0.0, 1.0, edges + 1) ** 1.3
    xi = 0.5 + 0.5 * np.polynomial.legendre.leggauss(order)[0]
    return (ends[:-1, None] + np.diff(ends)[:, None] * xi).ravel()


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_largest_of_a_polynomial_is_found_between_the_points(order, sign):
    arc, top = gauss_points(12, order), np.linspace(0.0, LENGTH, 41)
    values = sign * (3.0 - 2.0 * (arc[:, None] - top) ** 2 + 0.4 * (arc[:, None] - top) ** 3)
    found, place = extreme(values, arc, sign, LENGTH)
    assert found == pytest.approx(np.full(41, 3.0 * sign), rel=1e-12)
    assert place == pytest.approx(top, abs=1e-7)


def test_the_end_of_the_search_is_passed_steadily():
    arc = gauss_points(9, 4)
    rising = np.exp(arc)[:, None]
    ends = np.linspace(0.0, LENGTH, 1001)
    found, place = extreme(np.repeat(rising, ends.size, axis=1), arc, 1.0, ends)
    assert found == pytest.approx(np.exp(ends), rel=1e-5)
    assert place == pytest.approx(ends, abs=1e-12)


def test_a_load_alone_has_the_same_bits_as_in_company():
    arc, values = gauss_points(10, 3), np.random.default_rng(4).standard_normal((30, 37))
    ends = np.linspace(0.1, LENGTH, 37)
    together = extreme(values, arc, 1.0, ends)
    for j in range(37):
        alone = extreme(values[:, j : j + 1], arc, 1.0, ends[j])
        assert (alone[0][0], alone[1][0]) == (together[0][j], together[1][j])


def test_the_search_ends_at_a_distance_from_the_contact_or_half_way_up_what_is_left():
    above = np.array([0.0, 0.05, 0.07, 1.0])
    assert search_end(0.7, above, 0.02, 0.05) == pytest.approx([0.63, 0.68, 0.7, 0.7])
    assert search_end(0.04, above, np.array([0.0, 0.02, 0.02, 0.02]), 0.05) == pytest.approx([0.02, 0.035, 0.04, 0.04])
    assert search_end(0.04, np.array([0.0]), 0.1, 0.05) == pytest.approx([0.0])
