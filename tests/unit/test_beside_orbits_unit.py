"""How motions beside an orbit go on: with a map of one period made up, of which all is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.dynamics.motion import shooting
from fegear.dynamics.motion.shooting import leads_to, leap, straight, way_beside

X, V = np.array([2.0]), np.array([-1.0])


@pytest.fixture
def beside(monkeypatch):
    """An orbit whose neighbours are multiplied, bend by a share of their distance and may change contact otherwise."""

    def made(multipliers, bent=0.0, changes=4):
        tangent = np.diag(multipliers)
        packed = SimpleNamespace(size=1, free=np.array([True]), period=3.0)

        def propagate(given, x, v, duration, *, tolerance, peaks):
            assert (given, duration, tolerance, peaks) == (packed, 6.0, 1e-9, False)
            away = np.concatenate([x - X, v - V])
            moved = np.concatenate([X, V]) + tangent @ away + bent * float(np.linalg.norm(away)) * np.array([0.0, 1.0])
            return SimpleNamespace(x=moved[:1], v=moved[1:], changes=changes)

        monkeypatch.setattr(shooting, "propagate", propagate)
        return shooting.Orbit(packed, X, V, 2, SimpleNamespace(tangent=tangent, changes=4), 0.0)

    return made


def test_a_way_is_compared_with_the_multipliers(beside):
    way = way_beside(beside([0.5, -0.25]), X + 0.3, V + 0.4, 1e-9)
    assert way.far == pytest.approx(0.4)
    assert way.bent == pytest.approx(0.0, abs=1e-12)
    assert way.shrinks == pytest.approx(np.hypot(0.15, 0.1) / 0.5)
    assert way.alike
    way = way_beside(beside([0.5, -0.25], bent=0.07, changes=6), X + 0.3, V + 0.4, 1e-9)
    assert way.bent == pytest.approx(0.07)
    assert not way.alike
    on_it = way_beside(beside([0.5, 0.25], bent=1.0), X + 9e-7, V - 1e-7, 1e-9)
    assert (on_it.bent, on_it.shrinks, on_it.alike) == (0.0, 0.5, True)
    assert on_it.far == pytest.approx(9e-7, rel=1e-6)


def test_a_motion_leads_to_an_orbit_that_is_near_and_shrinks_it_about_as_it_says(beside):
    def leads(multipliers, bent, x, v=0.0):
        return leads_to(beside(multipliers, bent), X + x, V + v, 1e-9)

    assert leads([0.5, 0.25], 0.09, 0.9)
    assert not leads([0.5, 0.25], 0.11, 0.9)  # bends
    assert not leads([0.5, 0.25], 0.09, 1.1)  # from afar
    assert leads([0.5, 0.25], 5e-4, 1.1)  # however straight
    assert leads([0.5, 0.25], 5.0, 5e-7)  # it is there
    assert leads([0.5, 0.25], 0.09, 0.0, 0.9)
    assert leads([0.6, 0.75], 0.09, 0.0, 0.9)  # 0.75 + 0.09 against 0.875
    assert not leads([0.6, 0.95], 0.09, 0.0, 0.9)  # 1.04 against 0.975


def test_straight_is_what_the_multipliers_leave_far_behind(beside):
    assert straight(beside([0.5, 0.25])) == 1e-3
    assert straight(beside([0.9995, 0.25])) == pytest.approx(5e-5)
    assert straight(beside([1.0, 0.25])) == 1e-6
    assert straight(beside([-1.0005, 0.25])) == pytest.approx(5e-5)


@pytest.mark.parametrize(("bent", "changes"), [(2e-3, 4), (0.0, 6)])
def test_nothing_leaps_where_the_way_bends_or_contact_changes_otherwise(beside, bent, changes):
    x, v = leap(beside([2.0, 0.5], bent, changes), X + 1e-3, V + 1e-3, 1e-9)
    assert (x, v) == (X + 1e-3, V + 1e-3)


def test_a_leap_is_as_many_periods_as_stay_below_the_farthest(beside):
    """2^n 1e-3 below 1000: n = 19; what shrinks has vanished."""
    x, v = leap(beside([2.0, 0.5]), X + 1e-3, V + 1e-3, 1e-9)
    assert x - X == pytest.approx(2.0**19 * 1e-3, rel=1e-4)
    assert abs(v - V) < 1e-8
    x, v = leap(beside([2.0, 0.5]), X, V, 1e-9)  # moved off by 1e-9
    assert x - X == pytest.approx(2.0**39 * 1e-9, rel=1e-4)
