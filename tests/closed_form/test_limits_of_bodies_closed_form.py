"""Bodies and holes are refused from the limit on that their refusal names: found by bisection of one length each."""

import math
from dataclasses import replace

import pytest

from fegear.base.errors import GeometryError
from fegear.geometry.gear_body import GearBody, WebHoles

MODULE, WIDTH, BORE, ROOT, TEETH = 2e-3, 30e-3, 10e-3, 40e-3, 42
BODY = GearBody(34e-3, 16e-3, (-6e-3, 6e-3), (-15e-3, 15e-3))
HOLES = WebHoles(6, 25e-3, 4e-3)
THIN = 0.2 * MODULE


def refusal(body):
    try:
        body.check(MODULE, WIDTH, BORE, ROOT, TEETH)
    except GeometryError as error:
        return error
    return None


def limit(make, good, bad):
    """Value between a good and a bad one from which on a body is refused, and the key that is named there."""
    assert refusal(make(good)) is None
    assert refusal(make(bad)) is not None
    for _ in range(60):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if refusal(make(middle)) is None else (good, middle)
    return good, refusal(make(bad)).key


@pytest.mark.parametrize(
    ("make", "good", "bad", "at", "key"),
    [
        (lambda t: replace(BODY, web=(-0.5 * t, 0.5 * t)), 5e-3, 1e-5, THIN, "body.web_thickness"),
        (lambda z: replace(BODY, web=(-6e-3, z)), 6e-3, 20e-3, 15e-3, "body.web"),
        (lambda z: replace(BODY, web=(z, 6e-3)), -6e-3, -20e-3, -15e-3, "body.web"),
        (lambda z: replace(BODY, hub=(-15e-3, z)), 15e-3, 20e-3, 15e-3, "body.hub"),
        (lambda z: replace(BODY, hub=(-15e-3, z)), 15e-3, 2e-3, 6e-3, "body.hub"),
        (lambda z: replace(BODY, hub=(z, 15e-3)), -15e-3, -2e-3, -6e-3, "body.hub"),
        (lambda r: replace(BODY, rim_radius=r), 34e-3, 39.9e-3, ROOT - THIN, "body.rim_thickness"),
        (lambda r: replace(BODY, rim_radius=r), 34e-3, 12e-3, 16e-3 + THIN, "body.hub_radius"),
        (lambda r: replace(BODY, hub_radius=r), 16e-3, 10.1e-3, BORE + THIN, "body.hub_radius"),
        (lambda r: replace(BODY, hub_radius=BORE, rim_radius=r), 34e-3, 10.05e-3, BORE + THIN, "body.rim_thickness"),
    ],
)  # fmt: skip
def test_webs_hubs_and_rims_keep_what_is_said(make, good, bad, at, key):
    found, named = limit(make, good, bad)
    assert found == pytest.approx(at, rel=1e-6)
    assert named == key
    assert refusal(replace(BODY, hub_radius=BORE)) is None  # no hub at all


def test_webs_lean_by_thirty_degrees_and_no_more():
    short = replace(BODY, rim_radius=20e-3, web=(-3e-3, 3e-3))

    def leaning(degrees):
        return replace(short, lean=math.tan(math.radians(degrees)))

    assert limit(leaning, 10.0, 40.0) == (pytest.approx(30.0, rel=1e-6), "body.web_inclination")
    assert limit(leaning, -10.0, -40.0) == (pytest.approx(-30.0, rel=1e-6), "body.web_inclination")
    # Beside its end the rim goes on by a fifth of what the hub does.
    tall = replace(BODY, lean=math.tan(math.radians(20.0)), web=(-14e-3, -8e-3))
    foot = tall.foot[0]
    found, key = limit(lambda z: replace(tall, hub=(z, 15e-3)), foot, -15e-3)
    assert (foot - found) * 0.2 == pytest.approx(15e-3 - 14e-3, rel=1e-6)
    assert key == "body.web_offset"


@pytest.mark.parametrize(
    ("make", "good", "bad", "at", "key"),
    [
        (lambda r: replace(HOLES, radius=r), 4e-3, 1e-5, 0.5 * THIN, "body.holes.diameter"),
        (lambda r: replace(HOLES, circle_radius=r), 25e-3, 33e-3, 34e-3 - 4e-3 - THIN, "body.holes.diameter"),
        (lambda r: replace(HOLES, circle_radius=r), 25e-3, 17e-3, 16e-3 + 4e-3 + THIN, "body.holes.diameter"),
        (lambda r: replace(HOLES, count=18, radius=r), 2e-3, 6e-3, 25e-3 * math.sin(math.pi / 18) - 0.5 * THIN,
         "body.holes.diameter"),
    ],
)  # fmt: skip
def test_holes_keep_off_rim_hub_and_each_other(make, good, bad, at, key):
    found, named = limit(lambda value: replace(BODY, holes=make(value)), good, bad)
    assert found == pytest.approx(at, rel=1e-6)
    assert named == key


def test_holes_stay_six_hundredths_of_its_radius_below_the_root_circle():
    wide = replace(BODY, rim_radius=39.5e-3, hub_radius=12e-3)
    found, key = limit(lambda r: replace(wide, holes=replace(HOLES, circle_radius=r)), 25e-3, 36e-3)
    assert found + 4e-3 == pytest.approx(0.94 * ROOT, rel=1e-6)
    assert key == "body.holes.diameter"
    assert "2.4 mm (6 % of its radius)" in str(refusal(replace(wide, holes=replace(HOLES, circle_radius=34e-3))))


def test_teeth_in_question_are_those_of_the_gear():
    for tooth, fits in ((-1, False), (0, True), (TEETH - 1, True), (TEETH, False)):
        assert (refusal(replace(BODY, holes=replace(HOLES, tooth=tooth))) is None) is fits
    assert refusal(replace(BODY, holes=replace(HOLES, count=0))).key == "body.holes.count"
    assert refusal(replace(BODY, holes=replace(HOLES, count=1))) is None
    assert refusal(replace(BODY, holes=replace(HOLES, angle=math.inf))).key == "body.holes.angle"
    assert [WebHoles(count, 1.0, 0.1).different_teeth(42) for count in (6, 4, 5, 42)] == [7, 21, 42, 1]


def test_the_ring_of_the_holes_lies_off_the_corners_of_the_web():
    """By three tenths of its thickness, or two fifths of what is left beside a hole."""
    inner, outer = replace(BODY, holes=HOLES).holed_ring
    assert inner == pytest.approx(16e-3 + min(0.3 * 12e-3, 0.4 * (25e-3 - 4e-3 - 16e-3)))
    assert outer == pytest.approx(34e-3 - min(0.3 * 12e-3, 0.4 * (34e-3 - 25e-3 - 4e-3)))
    thin = replace(BODY, holes=HOLES, web=(-1e-3, 1e-3))
    assert thin.holed_ring == (pytest.approx(16e-3 + 0.6e-3), pytest.approx(34e-3 - 0.6e-3))
    assert BODY.holed_ring is None
