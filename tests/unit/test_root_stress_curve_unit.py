"""The curve through stresses at Gauss points and its largest value."""

import math

import numpy as np
import pytest

from fegear.fem.plane.root_stress import CutFillet, FilletCurve, extreme, search_end

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


def curves(module, side="tension", internal=False):
    """A fillet's curve in modules, or in another unit in which a module is so long."""
    flank = (0.05, 0.5) if not internal else (0.5, 0.05)
    return FilletCurve(side, gauss_points(10, 3), LENGTH, 13.0, flank, module)


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize("side", ["tension", "compression"])
def test_in_metres_a_fillet_has_the_same_largest_stress_at_so_many_modules(side, internal):
    arc = gauss_points(10, 3)
    stress = np.cos(np.multiply.outer(arc, [3.0, 6.0, 9.0, 2.0, 2.0])) * (1.0 if side == "tension" else -1.0)
    stress[:, 3] = stress[:, 4] = np.exp(arc) * (1.0 if side == "tension" else -1.0)
    first = 13.0 * math.sqrt(1.0 + (0.05 if not internal else 0.5))
    radius = first + np.array([0.0, 0.3, 1.0, 0.05, np.inf]) * (1.0 if not internal else -1.0)
    value, place = curves(1.0, side, internal).largest(stress, np.abs(radius))
    for module in (2e-3, 7.0):
        again, there = curves(module, side, internal).largest(stress, module * np.abs(radius))
        np.testing.assert_allclose(again, value, rtol=1e-12)
        np.testing.assert_allclose(there, module * place, rtol=1e-12)
    assert place[4] == pytest.approx(LENGTH)
    if side == "tension":  # a contact close by hides what is below it
        assert place[3] < place[4]
        assert value[3] < value[4]
    else:
        assert place[3] == place[4]


def test_of_a_fillet_in_two_pieces_the_larger_counts_where_it_stands():
    module = 2e-3
    one, other = curves(module), curves(module)
    stress = np.vstack(
        [np.cos(np.multiply.outer(one.arc, [3.0, 9.0])), np.cos(np.multiply.outer(other.arc, [1.0, 2.0]))]
    )
    stress[:30] *= [[1.0, 0.5]]
    stress[30:] *= [[0.5, 1.0]]
    cut = CutFillet(((0.0, one, slice(0, 30)), (0.4, other, slice(30, 60))))
    value, place = cut.largest(stress)
    first, second = (curve.largest(stress[points]) for curve, points in ((one, slice(0, 30)), (other, slice(30, 60))))
    assert value.tolist() == [first[0][0], second[0][1]]
    assert place.tolist() == pytest.approx([first[1][0], second[1][1] + 0.4 * module])
    assert cut.at(stress, place).diagonal() == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("side", ["tension", "compression"])
def test_at_the_place_of_its_largest_a_curve_has_its_largest(side):
    """And what else is superposed there changes the largest by as much, to first order."""
    curve = curves(2e-3, side)
    sign = 1.0 if side == "tension" else -1.0
    stress = sign * np.cos(np.multiply.outer(curve.arc, [1.0, 3.0, 9.0]) - [0.2, 0.9, 0.3])
    more = np.sin(4.0 * curve.arc + 0.5)[:, None]
    value, place = curve.largest(stress)
    assert curve.at(stress, place).diagonal() == pytest.approx(value, rel=1e-12)
    changed = curve.largest(stress + 1e-6 * more)[0]
    assert (changed - value) / 1e-6 == pytest.approx(curve.at(more, place)[:, 0], rel=1e-4)
