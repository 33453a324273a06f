"""Bearings on shafts of another diameter and bodies that cut each other: what is said of them, and when nothing is."""

import tomllib
from copy import deepcopy
from pathlib import Path

import pytest

from fegear.base.notes import NoteClass, class_of
from fegear.case.built.bearing_room import said_of_room, seats_of
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.first_size import with_teeth_of_ratio
from fegear.case.drafts.kinds import TWO_STAGES
from fegear.case.drafts.text import draft
from fegear.case.reading import build_scene

BOX = tomllib.loads(draft(Answers(TWO_STAGES, {"teeth": "21 53 19 61"}), "case"))


def notes_of(changed: dict) -> list:
    """Notes on a box of which some keys, "shaft.input.gears.0.at", have other values."""
    document = deepcopy(BOX)
    for path, value in changed.items():
        *way, last = (int(step) if step.isdigit() else step for step in path.split("."))
        at = document
        for step in way:
            at = at[step]
        at[last] = value
    return list(said_of_room(build_scene(document, "case", Path())))


def test_a_draft_has_room():
    assert not notes_of({})


@pytest.mark.parametrize("ratio", ["6.5", "10", "16", "22", "36"])
@pytest.mark.parametrize("torque", ["3.3 N m", "49.4 N m", "490 N m"])
def test_drafts_of_every_ratio_have_room(ratio, torque):
    kind, told, _ = with_teeth_of_ratio("gearbox", {"ratio": ratio, "torque": torque})
    document = tomllib.loads(draft(Answers(kind, told), "case"))
    assert not said_of_room(build_scene(document, "case", Path()))


@pytest.mark.parametrize(("kind", "ratio"), [
    ("gearbox", "1"), ("gearbox", "1.1"), ("gearbox", "1.5"), ("gearbox", "2"), ("gearbox", "3"),
    ("two-stage-gearbox", "3"), ("two-stage-gearbox", "4"), ("two-stage-gearbox", "5"),
])  # fmt: skip
@pytest.mark.parametrize("torque", ["3.3 N m", "49.4 N m", "490 N m"])
def test_drafts_of_small_ratios_have_room_by_a_larger_module(kind, ratio, torque):
    # bearings for a life need more room than these gears: modules by torque alone collided in 43 of 78 drafts
    kind, told, _ = with_teeth_of_ratio(kind, {"ratio": ratio, "torque": torque})
    text = draft(Answers(kind, told), "case")
    assert not said_of_room(build_scene(tomllib.loads(text), "case", Path()))
    assert text.count("# assumed") > 4
    assert next(line for line in text.splitlines() if line.startswith("normal_module")).endswith(
        "# assumed" if kind == "gearbox" else "# assumed, for the torque"
    )


def test_a_given_module_is_kept_and_what_cannot_be_built_is_said():
    told = {"teeth": "17 17", "torque": "49.4 N m", "module": "2.5 mm"}
    document = tomllib.loads(draft(Answers("gearbox", told), "case"))
    assert document["gear"]["pinion"]["normal_module"] == "2.5 mm"
    assert any("intersect" in note for note in said_of_room(build_scene(document, "case", Path())))


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"bearing.input_locating.designation": "6312"},
         "Bearing input_locating: bore 60 mm (6312) is larger than the diameter of shaft input there, 40 mm; correct"),
        ({"shaft.input.sections.0.outer": "45 mm"},
         "is smaller than the diameter of shaft input there, 45 mm"),
    ],
)  # fmt: skip
def test_a_bore_that_is_not_that_of_the_shaft_is_a_failure_with_both_numbers(changed, said):
    (note,) = notes_of(changed)
    assert class_of(note) is NoteClass.FAILS
    assert said in note
    assert "shaft.input.sections or bearings, or choose a bearing of bore" in note
    assert note.margin == pytest.approx(40.0 / (60.0 if "6312" in note else 45.0))


def test_at_a_step_and_on_a_cone_the_diameter_there_counts():
    seat = float(BOX["shaft"]["input"]["sections"][0]["length"].split()[0])
    at_step = notes_of({"shaft.input.bearings.0.at": f"{seat} mm"})  # 40 mm to the left, 46 mm to the right
    assert not [note for note in at_step if "bore" in note]
    cone = {"shaft.input.sections.0.outer": "35 mm", "shaft.input.sections.0.outer_end": "45 mm"}
    assert not notes_of(cone)  # 40 mm in the middle, where the bearing is
    steep = cone | {"shaft.input.sections.0.outer_end": "47 mm"}
    (note,) = notes_of(steep)
    assert "41 mm" in note


def test_a_bearing_without_known_dimensions_says_nothing():
    assert not notes_of({"bearing.input_floating": {"radial": "200 N/um"}})


def test_bodies_on_two_shafts_that_cut_each_other_are_named_with_radii_and_distance():
    # the output shaft under the wheel of the first stage: 87.6 mm of tip radius and 85 mm of shaft, axes 170.3 mm apart
    (note,) = notes_of({"shaft.output.sections.1.outer": "170 mm"})
    assert class_of(note) is NoteClass.FAILS
    assert "Gear wheel_1 (diameter 175.2 mm) and shaft output (diameter 170 mm) intersect" in note
    assert "radii 172.6 mm, axes of shafts middle and output 170.3 mm apart" in note
    assert not notes_of({"shaft.output.sections.1.outer": "164 mm"})


def test_a_seat_has_its_shoulder_and_the_room_beside_its_neighbours():
    scene = build_scene(deepcopy(BOX), "case", Path())
    seats = seats_of(scene)
    names = [[place.bearing for place in part.bearings] for part in scene.case.shaft.values()]
    assert [len(one) for one in seats] == [len(one) for one in names] == [2, 2, 2]
    first, part = seats[0][0], scene.case.shaft["input"]
    assert (first.at, first.length) == (part.bearings[0].at, part.sections[0].length)
    assert first.shoulder == part.sections[1].outer
    apart = scene.case.shaft["middle"].axis[0] - part.axis[0]
    beside = scene.case.bearing[names[1][0]].printed
    most = 2.0 * (apart - 0.5 * beside.outside_diameter)  # the bearing on the next shaft is in the way
    assert first.has_room(0.99 * most / 1.05, 0.01)
    assert not first.has_room(1.01 * most / 1.05, 0.01)
    gap = 2.0 * (part.gears[0].at - 0.5 * scene.gears["pinion_1"].face_width - first.at)
    assert first.has_room(0.02, 0.99 * gap)
    assert not first.has_room(0.02, 1.01 * gap)


def test_a_bearing_beside_a_gear_overlaps_it_along_the_shaft():
    face, width = 30.0, 23.0  # of pinion_1, and of the 6308 that is moved to it, with an outside diameter of 90 mm
    place = BOX["shaft"]["input"]
    at = float(place["gears"][0]["at"].split()[0])
    thick = {"shaft.input.sections.1.outer": "40 mm"}
    note, cut = notes_of(thick | {"shaft.input.bearings.0.at": f"{at - 0.5 * (face + width) + 2.0} mm"})
    assert "Bearing input_locating (diameter 90 mm) and gear wheel_1 (diameter 175.2 mm) intersect" in cut
    assert "Gear pinion_1 and bearing input_locating on shaft input overlap by 2 mm along it" in note
    assert not notes_of(thick | {"shaft.input.bearings.0.at": f"{at - 0.5 * (face + width)} mm"})
