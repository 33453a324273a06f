"""A planetary set as it is drawn: flanks touch where contacts are marked, teeth never overlap, whoever drives."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fegear.case.reading import build_scene
from fegear.results.planetary.turning_set import turning_set

TEXT = """title = "set"
results = ["planet-set"]
[gear.sun]
teeth = 19
module = "4 mm"
profile_shift = 0.3
face_width = "40 mm"
[gear.planet]
teeth = 23
module = "4 mm"
profile_shift = 0.3
face_width = "40 mm"
[gear.ring]
internal = true
teeth = 65
module = "4 mm"
profile_shift = -0.9
cutter = {{ teeth = 25, addendum = 1.25, tip_radius = 0.2 }}
tip_diameter = "260 mm"
thickness_allowance = "80 um"
face_width = "40 mm"
[planetary.P]
sun = "sun"
planet = "planet"
ring = "ring"
{planets}
fixed = "{fixed}"
input = "{driving}"
clockwise = {clockwise}
torque = "900 N*m"
"""


def scene_of(flank="", **said: str):
    """The set, with asymmetric teeth where the flank is named that works at the sun."""
    document = tomllib.loads(TEXT.format(**said))
    if flank:
        for name, gear in document["gear"].items():
            gear |= {"pressure_angle": "26 deg", "coast_pressure_angle": "19 deg"}
            if name != "ring":
                gear["rack"] = {"tip_radius": 0.2, "coast_tip_radius": 0.3}
        roles = ("sun", "planet") if said["driving"] == "sun" or said["fixed"] == "sun" else ("planet", "sun")
        document["pair"] = {"P_sun": {"driver": roles[0], "driven": roles[1], "flank": flank}}
    return build_scene(document, "set", Path())


def placed(gear, copy: int, q: float, centre, tooth: int):
    """Points of a tooth in the frame of the carrier, its centre line where the drawing puts it."""
    angle = gear.start[copy] + gear.turn * q + 2.0 * math.pi * tooth / gear.teeth - 0.5 * math.pi
    c, s = math.cos(angle), math.sin(angle)
    x, y = gear.tooth
    return np.stack([c * x - s * y + centre[0], s * x + c * y + centre[1]])


def gap(points, line) -> float:
    """Least distance of a point from a polyline."""
    a, b = line[:, :-1], line[:, 1:]
    d = b - a
    t = np.clip(((points[:, None] - a) * d).sum(axis=0) / (d**2).sum(axis=0), 0.0, 1.0)
    return float(np.hypot(*(points[:, None] - a - t * d)).min())


@pytest.mark.parametrize("flank", ["", "drive", "coast"])
@pytest.mark.parametrize(
    ("planets", "fixed", "driving", "clockwise"),
    [
        ("planets = 3", "ring", "sun", "false"),
        ("planets = 3", "ring", "carrier", "true"),
        ('angles = ["0 deg", "124.285714285714 deg", "244.285714285714 deg"]', "carrier", "ring", "false"),
        ("planets = 4", "sun", "carrier", "false"),
    ],
)
def test_flanks_touch_where_the_contacts_are_marked(planets, fixed, driving, clockwise, flank):
    scene = scene_of(flank, planets=planets, fixed=fixed, driving=driving, clockwise=clockwise)
    drawn = turning_set(scene, "P")
    found, chord = 0, 2.1e-3 * drawn.module
    for q in np.random.default_rng(5).uniform(0.0, 1.0, 3):
        for copy, psi in enumerate(drawn.angles):
            out = np.array([math.cos(psi), math.sin(psi)])
            across = np.array([-out[1], out[0]])
            for name, mesh in drawn.meshes.items():
                along = mesh.along[0] * out + mesh.along[1] * across
                mate, planet = drawn.gears[name], drawn.gears["planet"]
                teeth = [placed(mate, 0, q, (0.0, 0.0), k) for k in range(mate.teeth)]
                others = [placed(planet, copy, q, drawn.centre_distance * out, k) for k in range(planet.teeth)]
                for k in range(-3, 4):
                    x = (q - mesh.delay[copy] + k) * mesh.base_pitch
                    if not mesh.start <= x <= mesh.end:
                        continue
                    found += 1
                    at = mesh.radius * out + x * along
                    assert min(gap(at, one) for one in teeth) < chord
                    assert min(gap(at, one) for one in others) < chord
    assert found > 3 * 2 * drawn.angles.size  # more than one tooth pair in each mesh


def test_the_member_that_is_held_stands_still():
    for fixed, driving in (("ring", "sun"), ("carrier", "sun"), ("sun", "ring")):
        scene = scene_of(planets="planets = 3", fixed=fixed, driving=driving, clockwise="false")
        drawn = turning_set(scene, "P")
        turns = {"sun": drawn.gears["sun"].turn, "ring": drawn.gears["ring"].turn, "carrier": 0.0}
        assert turns[fixed] + drawn.carrier == 0.0
        assert drawn.per_cycle == turns[driving] + drawn.carrier != 0.0
