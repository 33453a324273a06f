"""Every number that a draft assumes follows from the answers: worked out here once more, by hand."""

from __future__ import annotations

import math
import tomllib

import pytest

from fegear.base.units import to_si
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.text import draft

GIVEN = {"teeth": "20 30", "module": "2 mm", "profile_shift": "0.1 0.2", "face_width": "10 mm", "speed": "1000 rpm",
         "torque": "50 N*m"}  # fmt: skip


def drafted(kind, **answers):
    """The text, and what it says as a case."""
    text = draft(Answers(kind, GIVEN | answers), "x")
    return text, tomllib.loads(text)


def length(text):
    return to_si(text, "length")


def test_a_train_has_a_motor_shafts_and_a_machine_of_the_gears_size():
    _, case = drafted("train")
    train, (one, other) = case["train"], (0.02, 0.03)  # pitch radii
    for body, radius in (("motor", one), ("load", other)):
        disc = 0.5 * math.pi * 7850.0 * 0.01 * radius**4
        assert float(train["body"][body]["inertia"].split()[0]) == pytest.approx(10.0 * disc, rel=3e-3)
    shafts = train["shaft"]
    assert shafts["input"]["length"] == shafts["output"]["length"] == "160 mm"  # eight radii of the pinion
    assert shafts["input"]["diameter"] == "24 mm"
    assert float(shafts["output"]["diameter"].split()[0]) == pytest.approx(24.0 * 1.5 ** (1.0 / 3.0), rel=0.02)
    assert train["mesh"]["I"]["backlash"] == "100 um"  # 0.05 modules
    assert case["dynamics"]["speeds"]["start"] == "500 rpm"
    assert case["dynamics"]["speeds"]["stop"] == "1500 rpm"
    assert train["torque"]["motor"] == "50 N*m"


def test_a_planetary_set_has_a_ring_planets_and_a_carrier_that_suit():
    _, case = drafted("planetary")
    made = case["planetary"]["P"]
    assert made["ring_teeth"] == 20 + 2 * 30
    assert made["planets"] == 4  # three do not stand evenly: 2 (20 + 30)/3 is no whole number
    assert made["stiffness"] == {"ring_mesh": "200 N/um", "pin": "100 N/um"}  # 20 N/(mm um) over 10 mm, and half
    mass = math.pi * 7850.0 * 0.01 * 0.05**2  # a disc through the pins
    body = made["body"]["carrier"]
    assert float(body["mass"].split()[0]) == pytest.approx(mass, rel=3e-3)
    assert float(body["inertia"].split()[0]) == pytest.approx(0.5 * mass * 0.05**2, rel=3e-3)
    assert made["pin_errors"]["tangential"] == ["20 um", "0 um", "0 um", "0 um"]
    assert (made["speeds"]["start"], made["speeds"]["stop"]) == ("500 rpm", "1500 rpm")
    # planets as many as stand evenly and clear each other: three, else four, five, two, one
    for teeth, planets in (("18 36", 3), ("21 30", 3), ("20 29", 2), ("20 30", 4), ("12 38", 2)):
        _, case = drafted("planetary", teeth=teeth, profile_shift="0 0")
        found, sun, planet = case["planetary"]["P"]["planets"], *map(int, teeth.split())
        assert 2 * (sun + planet) % found == 0
        if found > 1:
            assert (sun + planet) * math.sin(math.pi / found) > planet + 2
        assert found == planets, teeth


def test_tips_and_centre_distances_in_comments_are_those_without_the_keys():
    text, _ = drafted("pair")
    assert '# tip_diameter = "44.4 mm"' in text  # 2 (20 + 2 (1 + .1))
    assert '# tip_diameter = "64.8 mm"' in text
    # a cos(alpha) / cos(alpha_w) with inv(alpha_w) = inv(alpha) + 2 tan(alpha) (x_1 + x_2) / (z_1 + z_2)
    assert '# centre_distance = "50.5759 mm"' in text  # 2 (25 + .3) is 24 um more
    given = {key: value for key, value in GIVEN.items() if key not in {"speed", "torque"}}
    text = draft(Answers("ring", given | {"teeth": "60", "profile_shift": "0.1"}), "x")
    made = tomllib.loads(text)["gear"]
    (ring,) = made.values()
    assert ring["cutter"]["teeth"] == 24  # two fifths of the ring's
    assert '# tip_diameter = "115.6 mm"' in text  # 2 (60 - 2 (1 + .1))
    text, case = drafted("helical", helix_angle="20 deg")
    assert '# centre_distance = "53.7885 mm"' in text  # the same in the transverse section
    assert [gear["hand"] for gear in case["gear"].values()] == ["right", "left"]


def test_a_study_has_the_gear_among_its_teeth_and_shifts():
    given = {key: value for key, value in GIVEN.items() if key not in {"speed", "torque"}}
    text = draft(Answers("study", given | {"teeth": "23", "profile_shift": "0.15"}), "x")
    assert "[17, 20, 23, 28, 50, 100]" in text
    assert "[0.0, 0.15, 0.3]" in text
