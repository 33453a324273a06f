"""Root stress of many pairs as machine code: splines, superposition, searches and steps to a peak; plain Python.

Splines are scipy's, sums and largest values are taken point by point.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from fegear.contact.many import over_fillets, over_mesh
from fegear.fem.plane.root_stress import CLEARANCE, FORCES_OF_PRESSURE
from fegear.fem.plane.root_stress import search_end as end_of_search


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    for module in (over_fillets, over_mesh):
        for name, one in list(vars(module).items()):
            if hasattr(one, "py_func"):
                monkeypatch.setattr(module, name, one.py_func)


CONTACTS = np.array([0.0, 0.1, 0.25, 0.5, 0.8, 1.0])
VALUES = np.random.default_rng(3).normal(size=(CONTACTS.size, 3))


def slopes():
    out, low, up = np.empty_like(VALUES), np.empty(CONTACTS.size), np.empty(CONTACTS.size)
    over_fillets.slopes_over_contacts(CONTACTS + 0.3, VALUES, out, low, up)  # wherever they begin
    return out


def test_slopes_over_contacts_are_those_of_the_spline_without_a_knot():
    np.testing.assert_allclose(slopes(), CubicSpline(CONTACTS, VALUES).derivative()(CONTACTS), rtol=1e-11)


@pytest.mark.parametrize("share", [0.0, 0.05, 0.1, 0.4, 0.8, 0.99, 1.0])
def test_weights_of_a_contact_between_two_are_the_cubics(share):
    at, weights, rise = np.zeros(1, dtype=int), np.zeros(4), slopes()
    over_fillets.weighed(CONTACTS, share, at, weights)
    i = at[0]
    assert CONTACTS[i] <= share <= CONTACTS[i + 1]
    found = weights @ np.array([VALUES[i], VALUES[i + 1], rise[i], rise[i + 1]])
    np.testing.assert_allclose(found, CubicHermiteSpline(CONTACTS, VALUES, rise)(share), atol=1e-12)


@pytest.mark.parametrize("length", [1.0, 1.001, 1.03, 1.3, 1.6, 1.75, 3.2, 3.99, 4.0])
@pytest.mark.parametrize("nearest", [0.0, 0.02])
def test_a_pressure_is_three_forces_on_the_flank_as_wide_as_there_is_room(length, nearest):
    low, high, base = 1.0, 4.0, 9.0
    at, weights = np.zeros(4, dtype=int), np.zeros((4, 4))
    count = over_fillets.pressed(CONTACTS, length, low, high, base, nearest, at, weights)
    arc, most = max((length**2 - low**2) / 2.0 / base, nearest), (high**2 - low**2) / 2.0 / base
    width = min(0.02, max(min(arc, most - arc), 1e-4))
    spline, expected = CubicHermiteSpline(CONTACTS, VALUES, rise := slopes()), 0.0
    for place, part in FORCES_OF_PRESSURE:
        there = min(max(arc + place * width, 0.0), most)
        expected = expected + part * spline((math.sqrt(low**2 + 2.0 * base * there) - low) / (high - low))
    found = sum(weights[n] @ np.array([VALUES[at[n]], VALUES[at[n] + 1], rise[at[n]], rise[at[n] + 1]])
                for n in range(1, 1 + count))  # fmt: skip
    assert count == (3 if length in (1.3, 1.75) else 1)  # across a contact of the table, or all between two
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("ahead", [1, -1])
@pytest.mark.parametrize("tooth", [-1, 0, 1, 2, 3])
def test_stress_along_a_fillet_is_the_sum_over_all_loads_within_reach(ahead, tooth):
    rng, numbers = np.random.default_rng(5), 3
    stress, rise = rng.normal(size=(2, 3, CONTACTS.size, 4))
    v, line = np.array([0.5, 0.0, 0.3]), 2e5
    at, weights = rng.integers(0, 5, (numbers, 4)), rng.normal(size=(numbers, 4, 4))
    forces, out = np.array([3, 1, 0]), np.full(4, 7.0)
    over_fillets.superposed(stress, rise, tooth, ahead, numbers, v, line, at, weights, forces, out)
    expected = np.zeros(4)
    for j in range(numbers):
        k = ahead * (tooth - j)
        if v[j] > 0.0 and abs(k) <= 1:
            of_pressure = k == 0 and forces[j] > 0
            for n in range(1, 1 + forces[j]) if of_pressure else (0,):
                i, table, slope = at[j, n], stress[k + 1], rise[k + 1]
                four = np.array([table[i], table[i + 1], slope[i], slope[i + 1]])
                expected += line * v[j] * (weights[j, n] @ four)
    np.testing.assert_allclose(out, expected, rtol=1e-12)


@pytest.mark.parametrize("at", [1.0, 1.002, 1.2, 2.5, 3.99, 4.0])
@pytest.mark.parametrize("length", [0.03, 0.6])
def test_the_search_ends_below_a_contact_as_in_the_gear_s_own(at, length):
    low, high, base = 1.0, 4.0, 9.0
    above, room = (at**2 - low**2) / 2.0 / base, (high**2 - at**2) / 2.0 / base
    width = min(0.02, max(min(above, room), 1e-4))
    expected = end_of_search(length, np.array([above]), width, CLEARANCE)[0] / length
    assert over_fillets.search_end(length, low, high, base, at) == pytest.approx(expected, rel=1e-12)


def test_the_rough_largest_is_of_the_points_below_the_end_and_one_beyond():
    arc, values = np.array([0.1, 0.3, 0.5, 0.7]), np.array([1.0, -3.0, 2.0, 5.0])
    for sign, end, wanted in ((1.0, 1.0, 5.0), (1.0, 0.4, 2.0), (1.0, 0.2, 1.0), (-1.0, 0.2, 3.0), (1.0, 0.5, 5.0)):
        assert over_fillets.roughly(values, sign, end, arc) == wanted


@pytest.mark.parametrize("places", [(1.0, 2.0, 4.0), (4.0, 2.0, 1.0)])
def test_the_top_of_a_parabola_through_three_points_is_found(places):
    for top in (1.7, 2.3, 2.9):
        f = np.array([5.0 - 0.3 * (x - top) ** 2 for x in places])
        assert over_fillets.vertex(np.array(places), f, -1e9) == pytest.approx(top, rel=1e-12)
    # no nearer than a fiftieth of the way to the middle one, on the longer side, and within the ends
    f = np.array([5.0 - (x - 2.001) ** 2 for x in places])
    assert over_fillets.vertex(np.array(places), f, -1e9) == pytest.approx(2.06)
    flat = over_fillets.vertex(np.array(places), np.zeros(3), -1e9)
    assert flat == pytest.approx(2.06)
    steep = np.array([0.0, 1.0, 1e3])[:: 1 if places[0] < places[2] else -1]
    assert 1.0 < over_fillets.vertex(np.array(places), steep, -1e9) < 4.0
    # values below the lowest that counts draw the top no farther
    f = np.array([-1e9, 1.0, 0.7])
    assert over_fillets.vertex(np.array([0.0, 1.0, 2.0]), f, 0.5) == pytest.approx(1.125)


@pytest.mark.parametrize("falling", [False, True])
def test_three_points_close_in_about_the_largest_value(falling):
    def f(x):
        return 7.0 - (x - 1.618) ** 2

    x = np.array([0.5, 1.2, 2.9])[:: -1 if falling else 1].copy()
    values = f(x)
    for _ in range(9):
        place = over_fillets.vertex(x, values, -1e9)
        over_fillets.narrowed(x, values, place, f(place))
        assert (np.sign(np.diff(x)) == (-1.0 if falling else 1.0)).all()
        np.testing.assert_allclose(values, f(x), rtol=1e-12)
        assert values[1] == values.max()
        assert min(x[0], x[2]) <= 1.618 <= max(x[0], x[2])
    assert x[1] == pytest.approx(1.618, abs=0.03)


# ---- values over the mesh --------------------------------------------------------------------------------------------
X = np.array([0.0, 0.1, 0.25, 0.3, 0.45, 0.5])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_largest_value_is_the_top_of_the_parabola_through_its_neighbours(sign):
    piece = np.zeros(6, dtype=int)
    f = sign * (3.0 - 20.0 * (X - 0.27) ** 2)
    assert over_mesh.highest(X, f, piece, 6, sign) == pytest.approx(3.0, rel=1e-12)
    # only as many points as there are
    assert over_mesh.highest(X, f, piece, 3, sign) == pytest.approx(sign * f[2])


def test_at_ends_kinks_and_between_uneven_steps_the_largest_value_is_that_of_a_point():
    f, one = 3.0 - 20.0 * (X - 0.27) ** 2, np.zeros(6, dtype=int)
    for pieces in ((0, 0, 0, 1, 1, 1), (0, 0, 1, 1, 1, 1)):
        assert over_mesh.highest(X, f, np.array(pieces), 6, 1.0) == f.max()
    assert over_mesh.highest(X, X, one, 6, 1.0) == 0.5
    assert over_mesh.highest(X, -X, one, 6, 1.0) == 0.0
    x = np.array([0.0, 1.0, 1.0 + 1.0 / over_mesh._UNEVEN * 0.99])
    assert over_mesh.highest(x, np.array([0.0, 1.0, 0.9]), one, 3, 1.0) == 1.0
    assert over_mesh.highest(np.array([0.0, 1.0, 1.0]), np.array([0.0, 1.0, 0.9]), one, 3, 1.0) == 1.0
    assert over_mesh.highest(X, np.ones(6), one, 6, 1.0) == 1.0
