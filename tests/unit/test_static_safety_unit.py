"""Static safety of bearings by ISO 76, against numbers made by hand."""

import math

import pytest

from fegear.case.shaft import BearingPart
from fegear.shafts.static_safety import StaticRating


def test_deep_groove_by_hand():
    rating = StaticRating(16e3, balls=True)
    assert rating.safety(2000.0, 3000.0) == pytest.approx(16e3 / (0.6 * 2000.0 + 0.5 * 3000.0))
    assert rating.safety(-2000.0, 500.0) == pytest.approx(8.0), "never below the radial force, whatever its sign"
    assert rating.safety(0.0, -1000.0) == pytest.approx(32.0)
    assert math.isinf(rating.safety(0.0, 0.0))


def test_forty_degrees_and_between_the_rows():
    assert StaticRating(1.0, balls=True, angle=math.radians(40.0)).factors == pytest.approx((0.5, 0.26))
    assert StaticRating(1.0, balls=True, angle=math.radians(17.5)).factors == pytest.approx((0.5, 0.44))


def test_tapered_spherical_and_cylindrical():
    angle = math.atan(0.25)
    assert StaticRating(1.0, balls=False, angle=angle).factors == pytest.approx((0.5, 0.88))
    assert StaticRating(1.0, balls=False, angle=angle, rows=2).factors == pytest.approx((1.0, 1.76))
    assert StaticRating(9e3, balls=False).safety(3000.0, 5000.0) == pytest.approx(3.0)


def test_catalogue_before_elements_and_none_of_a_spring():
    given = BearingPart(designation="6306", catalogue={"static_rating": "16 kN"}, life={})
    assert given.static.rating == pytest.approx(16e3)
    assert given.static.factors == (0.6, 0.5)
    elements = {"kind": "ball", "count": 8, "diameter": "12.3 mm", "pitch_diameter": "51 mm"}
    f_0 = 13.0 + (12.8 - 13.0) * (12.3 / 51.0 - 0.24) / 0.01  # rows of ISO 76 at 0.24 and 0.25
    assert BearingPart(elements=elements).static.rating == pytest.approx(f_0 * 8 * 12.3**2)
    assert BearingPart(radial="200 N/um").static is None


def test_designations_are_near_what_a_maker_prints():
    # C_0 of a maker, not verified against a printed source; estimates of eight designations were -10 to +18 % off
    for name, printed in (("6306", 16e3), ("30206", 44e3), ("NU210", 69.5e3)):
        assert BearingPart(designation=name, life={}).static.rating == pytest.approx(printed, rel=0.2), name
