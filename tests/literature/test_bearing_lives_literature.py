"""Basic rating lives of ISO 281 beside printed examples."""

import pytest

from fegear.shafts.life import LifeRating


@pytest.mark.parametrize(
    ("rating", "radial", "axial", "equivalent", "hours", "speed"),
    [
        # hchbearing.com, bearing size selection, example 1: F_a/F_r = .15 below e, so P_r = F_r; C_r = 19730 N.
        (LifeRating(19730.0, "ball", 0.56, 1.6, 0.2), 2000.0, 300.0, 2000.0, 10_000.0, 1600.0),
        # The same, example 2: X = .56, Y = 1.6; C_r = 51280 N. Both ask for 10,000 h; their speeds follow from C_r.
        (LifeRating(51280.0, "ball", 0.56, 1.6, 0.2), 4000.0, 2400.0, 6080.0, 10_000.0, 1000.0),
    ],
)
def test_ratings_that_ten_thousand_hours_need(rating, radial, axial, equivalent, hours, speed):
    assert rating.equivalent_load(radial, axial) == pytest.approx(equivalent)
    # Printed to four digits, of which the third power makes three times the error.
    assert rating.revolutions(radial, axial) == pytest.approx(60.0 * speed * hours, rel=1e-3)


def test_a_rating_eight_times_the_load():
    # sarthaks.com, question 2642436: C = 16 kN, W = 2 kN, 512 million revolutions.
    assert LifeRating(16e3).revolutions(2e3, 0.0) == pytest.approx(512e6)
