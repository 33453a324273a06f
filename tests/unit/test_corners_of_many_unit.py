"""Ways of tip corners in arrays of pairs, as plain Python: angles by vectors, slopes by differences."""

import math

import numpy as np
import pytest

from fegear.contact.many import corners

ROLLED, TURNED, TRIANGLE = (getattr(f, "py_func", f) for f in (
    corners.rolled_back, corners.turned, corners.triangle_angle,
))  # fmt: skip
BASE, STEP = 28.0, 1e-6


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    """None of them compiled."""
    for name, function in list(vars(corners).items()):
        if callable(function):
            monkeypatch.setattr(corners, name, getattr(function, "py_func", function))


def involute(length):
    return length / BASE - math.atan(length / BASE)


@pytest.mark.parametrize(("length", "start"), [(9.0, 4.0), (4.0, 9.0), (5.0, 5.0), (3.0, -2.0)])
def test_an_involute_turns_back_by_the_difference_of_its_polar_angles(length, start):
    assert ROLLED(length, start, BASE) == pytest.approx(involute(length) - involute(start), abs=1e-15)


def slopes(place, way, corner):
    more, less = (TURNED(place + by, way, corner) for by in (STEP, -STEP))
    return [(more[k] - less[k]) / (2.0 * STEP) for k in (0, 1)]


@pytest.mark.parametrize("place", [6.0, 7.5, 9.0])
def test_a_corner_of_an_external_pair_turns_with_the_triangle_of_both_centres(place):
    """Distances a, r and rho of the centres and the corner; the flank turns back by its involute besides."""
    centre, tip, start = 60.0, 33.0, 6.0
    corner = start, 12.0, centre, tip, 25.0, BASE, 0.0

    def angles(roll):
        rho = math.hypot(BASE, roll)
        at_tip = math.acos((centre**2 + tip**2 - rho**2) / (2.0 * centre * tip))
        return at_tip, math.acos((centre**2 + rho**2 - tip**2) / (2.0 * centre * rho))

    first, now = angles(start), angles(place)
    way = np.array([*first, 0.0, 0.0])
    of_tip, of_flank, tip_grows, flank_grows, length = TURNED(place, way, corner)
    assert length == place
    assert abs(of_tip) == pytest.approx(abs(now[0] - first[0]), abs=1e-12)
    expected = now[1] - first[1]
    assert of_flank + involute(place) - involute(start) == pytest.approx(expected, abs=1e-12)
    assert [tip_grows, flank_grows] == pytest.approx(slopes(place, way, corner), rel=1e-6)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("place", [0.0, 0.05, 0.15])
def test_a_corner_of_an_internal_pair_turns_as_seen_from_the_mate_s_centre(place, side):
    """The corner goes round its own centre, with the mate's on one side of it or on the other."""
    centre, radius, first = 12.0, (44.0 if side > 0.0 else 32.0), 0.3

    def seen(angle):
        return np.array([radius * math.cos(angle) - side * centre, radius * math.sin(angle)])

    def roll(angle):
        return side * math.sqrt(float(seen(angle) @ seen(angle)) - BASE**2)

    way, start = np.array([first, 0.5, 0.0, 0.0]), roll(first)
    corner = start, 30.0, centre, radius, 25.0, BASE, side
    of_tip, of_flank, tip_grows, flank_grows, length = TURNED(place, way, corner)
    one, other = seen(first), seen(first + place)
    turned = math.atan2(one[0] * other[1] - one[1] * other[0], float(one @ other))
    assert (of_tip, tip_grows) == (place, 1.0)
    assert length == pytest.approx(roll(first + place))
    assert of_flank == pytest.approx(turned - involute(length) + involute(start), abs=1e-12)
    if place:
        assert flank_grows == pytest.approx(slopes(place, way, corner)[1], rel=1e-6)


@pytest.mark.parametrize(("a", "b", "c"), [(3.0, 4.0, 5.0), (60.0, 33.0, 28.6), (60.0, 31.6, 28.5)])
def test_an_angle_of_a_triangle_is_that_of_its_cosine(a, b, c):
    assert TRIANGLE(0.5 * (a + b + c), a, b, c) == pytest.approx(math.acos((a * a + b * b - c * c) / (2.0 * a * b)))
