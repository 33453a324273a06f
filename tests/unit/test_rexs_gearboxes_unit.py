"""What whole gearboxes of other programs hold besides: archives, fits, losses, bevel stages, tapered bearings."""

from __future__ import annotations

import math
import struct
import tomllib
import zipfile
from pathlib import Path

import pytest
from rexs_cases import case, more, put, text_of
from rexs_models import gear, in_json, link, part, planetary_set, shaft, two_stages
from scipy.optimize import brentq

from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.exchange.rexs.model_to_case import case_of
from fegear.exchange.rexs.reading import model_of, read_model
from fegear.exchange.rexs.written_gearbox import model_text


@pytest.mark.parametrize("name", ["model.rexsz", "model.rexs.zip"])
def test_an_archive_is_read_like_the_model_in_it(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("deep/gearbox.rexsj", "\ufeff" + in_json(two_stages()))
        archive.writestr("__MACOSX/._gearbox.rexsj", "x")
        archive.writestr("gears.gde", "")
    assert case_of(read_model(path)) == text_of(two_stages())


def test_archives_without_one_model_or_damaged_or_too_large_are_refused(tmp_path: Path, monkeypatch) -> None:
    path = tmp_path / "model.rexsz"

    def refused(files: dict[str, str], match: str, change=lambda data: data) -> None:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, text in files.items():
                archive.writestr(name, text)
        path.write_bytes(change(path.read_bytes()))
        with pytest.raises(InputError, match=match) as error:
            read_model(path)
        assert str(error.value).count("\n") == 0

    model = in_json(two_stages())
    refused({"a.gde": ""}, "archive with no model")
    refused({"a.rexs": model, "b/c.rexsj": model}, r"2 models \(a.rexs, b/c.rexsj\)")
    refused({"a.rexs": model}, "damaged archive", lambda data: data[: len(data) // 2])
    refused({"a.rexs": model}, "damaged archive", lambda data: data[:60] + b"\0\1\2\3" + data[64:])
    refused({"a.rexs": "\xff"}, "neither XML nor JSON")
    monkeypatch.setattr("fegear.exchange.rexs.archive._LARGEST", 1000)
    lies = struct.pack("<I", 10)  # the directory says ten bytes
    refused({"a.rexs": " " * 5000}, "more than 0 MB|damaged archive",
            lambda data: data[: data.rindex(b"PK\1\2") + 24] + lies + data[data.rindex(b"PK\1\2") + 28 :])  # fmt: skip
    refused({"a.rexs": " " * 5000}, "more than 0 MB")


@pytest.mark.parametrize(
    "kind", ["cylindrical_interference_fit", "feather_key_connection", "involute_spline_connection"]
)
def test_a_gear_stands_on_the_shaft_that_a_fit_key_or_spline_joins_it_to(kind: str) -> None:
    tree = two_stages()
    ((number, _),) = [(r["id"], r) for r in tree["relations"] if r["refs"][-1]["id"] == 12 and r["type"] == "assembly"]
    joined = more(tree, part(71, kind), relations=(link(171, "side", assembly=71, inner_part=4, outer_part=12),),
                  drop=(number,))  # fmt: skip
    assert case(joined) == case(tree)


def test_a_torque_that_counts_losses_is_left_to_the_load_that_defines_its_own() -> None:
    tree = put(two_stages(), 32, torque_around_u_axis=(870.0, "N m"))
    found = text_of(tree)
    assert tomllib.loads(found)["pair"] == case(two_stages())["pair"]
    assert "external_load 32: torque of 870 N m is not in equilibrium" in found
    both = put(tree, 32, defines_torque="true")
    with pytest.raises(InputError, match=r"100 N\*m of external_load 31, 870 N\*m of external_load 32: contradict"):
        case(both)
    with pytest.raises(InputError, match="1500 rpm of shaft 3, 700 rpm of shaft 5: contradict"):
        case(put(two_stages(), 5, rotational_speed=(700.0, "1/min")))


def test_a_torque_on_a_shaft_without_gears_is_not_used() -> None:
    tree = more(two_stages(), shaft(6, 0.0, 300.0), part(33, "external_load", torque_around_u_axis=(5.0, "N m")),
                relations=(link(160, "assembly", assembly=6, part=33),))  # fmt: skip
    assert "external_load 33: torque does not act on any gear" in text_of(tree)
    assert case(tree) == case(two_stages())


def turned(tree: dict) -> dict:
    """The same gearbox drawn with its shafts along -w."""
    parts = []
    for one in tree["components"]:
        changed = [
            {**a, "float": [a["float"][2], a["float"][1], -a["float"][0]]} if a["id"].endswith("_vector") else a
            for a in one["attributes"]
        ]
        parts.append({**one, "attributes": changed})
    return {**tree, "components": parts}


def test_shafts_along_another_axis_are_turned_into_that_of_the_case() -> None:
    text = text_of(turned(two_stages()))
    found, straight = tomllib.loads(text), case(two_stages())
    assert "Model rotated: the axis of shaft 3 is along u" in text
    assert {key: one for key, one in found.items() if key != "shaft"} == {
        key: one for key, one in straight.items() if key != "shaft"
    }
    for name, one in found["shaft"].items():
        size = [
            sum(float(part.split()[0]) ** 2 for part in two["axis"]) ** 0.5 for two in (one, straight["shaft"][name])
        ]
        assert size[0] == pytest.approx(size[1])
        assert {key: part for key, part in one.items() if key != "axis"} == {
            key: part for key, part in straight["shaft"][name].items() if key != "axis"
        }


def with_bevels(ways: tuple[str, str]) -> dict:
    """Two stages behind a bevel stage of 15 and 30 teeth, its pinion on a shaft along w; 50 N m on that."""
    tree = two_stages()
    across = part(6, "shaft", "across", support_vector=([0.0, 0.0, 0.0], "mm"), u_axis_vector=([0.0, 0.0, 1.0], "mm"))
    bevels = [
        part(15 + n, "bevel_gear", number_of_teeth=(15.0 * (n + 1), "none"), bevel_cone_orientation=way,
             u_coordinate_on_shaft=(5.0, "mm"))
        for n, way in enumerate(ways)
    ]  # fmt: skip
    links = (link(180, "stage", stage=23, gear_1=15, gear_2=16), link(181, "assembly", assembly=6, part=15),
             link(182, "assembly", assembly=3, part=16), link(183, "assembly", assembly=6, part=33))  # fmt: skip
    load = part(33, "external_load", torque_around_u_axis=(50.0, "N m"), transmits_torque="true", defines_torque="true")
    tree = more(tree, across, *bevels, part(23, "bevel_stage", "bevels"), load, relations=links)
    parts = [one for one in tree["components"] if one["id"] != 31]
    links = [one for one in tree["relations"] if all(ref["id"] != 31 for ref in one["refs"])]
    return put({**tree, "components": parts, "relations": links}, 3, rotational_speed=(-1500.0, "1/min"))


@pytest.mark.parametrize(("ways", "pushes"), [(("positive", "positive"), True), (("positive", "negative"), False)])
def test_torque_passes_a_bevel_stage(ways: tuple[str, str], pushes: bool) -> None:
    """Of cones that point alike the gears turn against each other about their own axes: -100 N m at -1500 rpm drive."""
    text = text_of(with_bevels(ways))
    found = tomllib.loads(text)
    assert "bevel_stage 23 ignored: torque and speed are transmitted" in text
    driver = found["pair"]["I"]["driver"]
    assert found["gear"][driver]["teeth"] == (20 if pushes else 60)
    torque = float(found["pair"]["I"]["torque"].split()[0])
    assert torque == pytest.approx(100.0 if pushes else 300.0)


def bearing(
    number: int, at: float, way: str, rows: tuple[str, ...], angle: float = 15.0
) -> tuple[list[dict], list[dict]]:
    kind = "radial_tapered_roller_bearing" if angle else "radial_roller_bearing"
    parts = [part(number, "rolling_bearing_with_detailed_geometry", f"bearing {number}", axial_force_absorption=way,
                  bearing_type=kind, u_coordinate_on_shaft_inner_side=(at, "mm"),
                  radial_dynamic_load_rating=(50.0, "kN"))]  # fmt: skip
    links = [link(140 + number, "side", assembly=number, inner_part=3, outer_part=2)]
    for n, one in enumerate(rows):
        row, roll = 1000 + 10 * number + 2 * n, 1001 + 10 * number + 2 * n
        parts += [
            part(row, "rolling_bearing_row", number_of_rolling_elements=(18.0, "none"), reference_diameter=(50.0, "mm"),
                 pressure_angle=(angle, "deg"), axial_force_absorption_of_row=one),
            part(roll, "rolling_element", diameter_of_rolling_element=(7.0, "mm"),
                 length_of_rolling_element=(10.0, "mm")),
        ]  # fmt: skip
        links += [
            link(2000 + row, "assembly", assembly=number, part=row),
            link(2000 + roll, "assembly", assembly=row, part=roll),
        ]
    return parts, links


def on_bearings(*bearings: tuple) -> dict:
    """A model whose first shaft runs on these bearings in place of its own."""
    tree = two_stages()
    parts = [one for one in tree["components"] if one["id"] not in (51, 52)]
    links = [one for one in tree["relations"] if all(ref["id"] not in (51, 52) for ref in one["refs"])]
    for one in bearings:
        made = bearing(*one)
        parts, links = [*parts, *made[0]], [*links, *made[1]]
    return {**tree, "components": parts, "relations": links}


def held_by(*bearings: tuple) -> dict:
    """The case of that model."""
    return case(on_bearings(*bearings))


def test_tapered_bearings_face_the_ways_that_they_hold() -> None:
    found = held_by((81, 10.0, "negative", ("negative",)), (82, 110.0, "positive", ("positive",)))
    seats = found["shaft"]["shaft_3"]["bearings"]
    assert [one.get("reversed", False) for one in seats] == [True, False]
    assert "fixed" not in found["bearing"][seats[0]["bearing"]]


def test_a_contact_angle_that_has_no_direction_is_said_to_be_assumed() -> None:
    told = text_of(on_bearings((81, 10.0, "both_directions", ("",)), (82, 110.0, "positive", ("positive",))))
    told = " ".join(told.replace("\n#", " ").split())
    assert "81: direction of the contact angle not specified; +u assumed" in told
    assert "82: direction of the contact angle" not in told


def test_rows_are_bearings_in_one_place_that_share_the_rating() -> None:
    found = held_by((81, 10.0, "both_directions", ("positive", "negative")), (82, 110.0, "no_direction", ("", "")))
    seats = found["shaft"]["shaft_3"]["bearings"]
    assert [(one["at"], one.get("reversed", False)) for one in seats] == [
        ("10 mm", False), ("10 mm", True), ("110 mm", False), ("110 mm", False),
    ]  # fmt: skip
    first, second = (found["bearing"][seats[n]["bearing"]] for n in (0, 2))
    assert float(first["life"]["dynamic_rating"].split()[0]) == pytest.approx(50.0 / 2.0 ** (7.0 / 9.0))
    assert (first["elements"]["contact_angle"], "contact_angle" in second["elements"]) == ("15 deg", False)


def test_a_shaft_that_rollers_leave_free_along_its_axis_is_stopped() -> None:
    found = held_by((81, 10.0, "both_directions", ("",), 0.0), (82, 110.0, "no_direction", ("",), 0.0))
    seats = [one["bearing"] for one in found["shaft"]["shaft_3"]["bearings"]]
    assert found["bearing"][seats[1]] == {"radial": "0 N/um", "fixed": True}
    assert len(seats) == 3


def test_small_gaps_between_sections_are_closed_and_told() -> None:
    tree = more(two_stages(), part(44, "shaft_section", length=(30.0, "mm"), outer_diameter_begin=(20.0, "mm"),
                                   u_coordinate_on_shaft=(120.1, "mm")),
                relations=(link(190, "ordered_assembly", assembly=3, part=44),))  # fmt: skip
    assert "shaft 3: gap of 0.1 mm between sections closed" in text_of(tree)
    assert [one["length"] for one in case(tree)["shaft"]["shaft_3"]["sections"]] == ["120.1 mm", "30 mm"]
    with pytest.raises(InputError, match="leave a gap"):
        case(put(tree, 44, u_coordinate_on_shaft=(121.0, "mm")))


def test_a_stage_that_no_torque_passes_is_not_in_the_case() -> None:
    """A loose gear beside the first stage, as of a speed that is not engaged."""
    tree = more(
        two_stages(),
        shaft(6, -80.0 / 0.984807753012208, 0.0),
        gear(17, 60, -10.0, at=50.0),
        part(24, "cylindrical_stage", "idle"),
        relations=(link(191, "assembly", assembly=6, part=17), link(192, "stage", stage=24, gear_1=11, gear_2=17)),
    )
    assert "No torque in cylindrical_stage 24" in text_of(tree)
    assert case(tree) == case(two_stages())


def test_a_pair_without_a_distance_has_that_of_its_axes() -> None:
    tree = two_stages()
    bare = {**tree, "components": [
        {**one, "attributes": []} if one["id"] == 22 else one for one in tree["components"]
    ]}  # fmt: skip
    assert case(bare)["pair"]["II"]["centre_distance"] == "84 mm"


def test_a_helical_set_passes_torque_to_the_stages_beside_it() -> None:
    """A set whose carrier drives a pair: 90 N m on the sun are 90 (1 + 66/18) on the carrier."""
    tree = planetary_set(helix=10.0)
    parts = [one for one in tree["components"] if one["id"] != 32]
    links = [one for one in tree["relations"] if all(ref["id"] != 32 for ref in one["refs"])]
    tree = more(
        {**tree, "components": parts, "relations": links},
        shaft(6, 80.0, 0.0),
        gear(16, 40, 0.0),
        gear(17, 40, 0.0),
        part(27, "cylindrical_stage", "beside", center_distance=(80.0, "mm")),
        part(33, "external_load", u_coordinate_on_shaft=(0.0, "mm"), transmits_torque="true"),
        relations=(
            link(400, "assembly", assembly=5, part=16),
            link(401, "assembly", assembly=6, part=17),
            link(402, "stage", stage=27, gear_1=16, gear_2=17),
            link(403, "assembly", assembly=6, part=33),
        ),
    )
    found = case(tree)
    assert found["planetary"]["P"]["torque"] == "90 N*m"
    helical = {found["gear"][found["planetary"]["P"][role]]["hand"] for role in ("sun", "planet")}
    assert helical == {"left", "right"}
    assert float(found["pair"]["I"]["torque"].split()[0]) == pytest.approx(90.0 * (1.0 + 66.0 / 18.0))


def test_a_rating_is_asked_for_below_the_sum_of_shifts_that_the_standard_states_too() -> None:
    tree = two_stages()
    for number in (11, 12, 13, 14):
        tree = put(tree, number, addendum_modification_coefficient=(-0.4, "none"))
    tree = put(put(tree, 21, center_distance=(79.5, "mm")), 22, center_distance=(82.0, "mm"))
    tree = put(put(tree, 4, support_vector=([0.0, 79.5, 0.0], "mm")), 5, support_vector=([0.0, 161.5, 0.0], "mm"))
    assert "rating not requested" not in text_of(tree)
    assert "rating" in tomllib.loads(text_of(tree))["results"]


def test_which_way_bearings_face_and_where_shafts_are_stopped_goes_there_and_back() -> None:
    bearings = [(81, 10.0, "negative", ("negative",)), (82, 60.0, "no_direction", ("",), 0.0),
                (83, 110.0, "negative", ("negative",))]  # fmt: skip
    found = held_by(*bearings)
    text, _ = model_text(build_scene(found, "case", Path()), "2026-01-01")
    again = tomllib.loads(case_of(model_of(text, Path("model.rexs"))))

    def seats(one: dict) -> set[tuple]:
        shaft = next(iter(one["shaft"].values()))
        return {(s["at"], s.get("reversed"), str(one["bearing"][s["bearing"]])) for s in shaft["bearings"]}

    assert seats(again) == seats(found)
    assert len(seats(found)) == 4


def halves(second: tuple[str, str], teeth: int = 23) -> str:
    """A gearbox of two stages on two shafts, written to REXS and imported; hands of the second stage."""
    common = {"normal_module": "3 mm", "helix_angle": "28 deg", "face_width": "12 mm"}
    gears = (("a", 23, "right"), ("b", 47, "left"), ("c", teeth, second[0]), ("d", 70 - teeth, second[1]))
    sections = [{"length": "120 mm", "outer": "30 mm"}]
    bearings = [{"bearing": "plain", "at": "10 mm"}, {"bearing": "fixed", "at": "110 mm"}]

    def shaft(coupling: str, *on: str) -> dict:
        placed = [{"gear": gear, "at": at} for gear, at in zip(on, ("44 mm", "76 mm"), strict=True)]
        return {"sections": sections, "gears": placed, "bearings": bearings, "coupling": coupling}

    document = {
        "results": ["geometry"],
        "gear": {name: {"teeth": z, "hand": hand, **common} for name, z, hand in gears},
        "pair": {"I": {"driver": "a", "driven": "b", "torque": "140 N*m"},
                 "II": {"driver": "c", "driven": "d", "torque": "140 N*m"}},
        "shaft": {"in": shaft("0 mm", "a", "c"),
                  "out": {"axis": ["118.92 mm", "0 mm"], **shaft("120 mm", "b", "d")}},
        "bearing": {"plain": {"radial": "200 N/um"}, "fixed": {"radial": "200 N/um", "fixed": True}},
    }  # fmt: skip
    text, _ = model_text(build_scene(document, "case", Path()), "2026-01-01")
    return " ".join(case_of(model_of(text, Path("model.rexs"))).replace("\n#", " ").split())


def test_stages_that_are_halves_of_a_double_helical_pair_are_named() -> None:
    """With the gap between their faces; not where hands are equal."""
    found = halves(("left", "right"))
    assert "halves of a double helical pair), imported as two pairs" in found
    assert 'double_helical = { gap = "20 mm" }' in found
    assert "double helical" not in halves(("right", "left"))


def test_faces_that_run_into_each_other_on_one_shaft_are_refused() -> None:
    tree = put(put(two_stages(), 13, u_coordinate_on_shaft=(69.0, "mm")), 14, u_coordinate_on_shaft=(69.0, "mm"))
    with pytest.raises(InputError, match=r"shaft.shaft_4.gears = gear_12 and gear_13: overlap by 1 mm"):
        case(tree)
    case(put(put(tree, 13, u_coordinate_on_shaft=(70.0, "mm")), 14, u_coordinate_on_shaft=(70.0, "mm")))


def test_more_stages_than_any_gearbox_has_are_refused_at_once() -> None:
    """A ring of 201 pairs; one of 1500 took minutes before it was refused for something else."""
    parts, links = [], []
    for n in range(201):
        parts += [shaft(1000 + n, 0.0, 0.0), gear(2000 + n, 20, 0.0), part(3000 + n, "cylindrical_stage")]
        links += [link(n, "assembly", assembly=1000 + n, part=2000 + n),
                  link(5000 + n, "stage", stage=3000 + n, gear_1=2000 + n, gear_2=2000 + (n + 1) % 201)]  # fmt: skip
    with pytest.raises(InputError, match="exceed the maximum of"):
        text_of({**two_stages(), "components": parts, "relations": links})


def test_modules_and_stiffnesses_that_are_none_are_refused() -> None:
    """A helical gear with a module of zero ended in a traceback; a stiffness below zero counted as rigid."""
    with pytest.raises(InputError, match=r"normal_module = 0 mm: of cylindrical_gear 11 must be positive"):
        case(put(two_stages(), 11, normal_module=(0.0, "mm")))
    with pytest.raises(InputError, match=r"radial_stiffness = -4e\+08 N/m: of concept_bearing 51 must not be negative"):
        case(put(two_stages(), 51, radial_stiffness=(-4e5, "N/mm")))


def test_of_torques_at_two_places_the_model_leaves_open_one_is_taken_and_told() -> None:
    tree = more(two_stages(), part(35, "external_load", u_coordinate_on_shaft=(5.0, "mm"), transmits_torque="true"),
                relations=(link(900, "assembly", assembly=5, part=35),))  # fmt: skip
    assert "shaft 5: torque input at 5 mm not specified; total torque assumed at 120 mm" in text_of(tree)


def of_zero_backlash(module: float, helix: float, teeth: int, shifts: float) -> float:
    """Centre distance, by the involute function only."""
    normal, tilt = math.radians(20.0), math.radians(helix)
    alpha = math.atan(math.tan(normal) / math.cos(tilt))

    def inv(angle: float) -> float:
        return math.tan(angle) - angle

    wanted = inv(alpha) + 2.0 * math.tan(normal) * shifts / teeth
    working = brentq(lambda angle: inv(angle) - wanted, 0.01, 1.2, xtol=1e-15)
    return 0.5 * module * teeth / math.cos(tilt) * math.cos(alpha) / math.cos(working)


def without_shift(tree: dict, *numbers: int) -> dict:
    parts = [
        {**one, "attributes": [a for a in one["attributes"] if "modification_coefficient" not in a["id"]]}
        if one["id"] in numbers else one
        for one in tree["components"]
    ]  # fmt: skip
    return {**tree, "components": parts}


@pytest.mark.parametrize("left_out", [(12,), (11,), (11, 12)])
def test_a_shift_that_a_model_leaves_out_is_what_the_centre_distance_leaves(left_out) -> None:
    distance = case(two_stages())["pair"]["I"]["centre_distance"]
    both = brentq(lambda x: of_zero_backlash(1.98, 10.0, 80, x) - float(distance.removesuffix(" mm")), -1.0, 2.0)
    assert both > 0.3  # teeth a little smaller than the distance is for
    tree = two_stages()
    for number, shift in ((11, 0.25), (12, both - 0.25)):
        tree = put(tree, number, normal_module=(1.98, "mm"), addendum_modification_coefficient=(shift, "none"))
    gears = case(without_shift(tree, *left_out))["gear"]
    wanted = (0.25, both - 0.25) if len(left_out) == 1 else (0.5 * both, 0.5 * both)
    found = gears["gear_11"]["profile_shift"], gears["gear_12"]["profile_shift"]
    assert found == pytest.approx(wanted, abs=1e-9)


def test_a_distance_that_no_teeth_reach_is_refused_where_a_shift_follows_from_it() -> None:
    tree = without_shift(two_stages(), 14)
    for number in (13, 14):
        tree = put(tree, number, normal_module=(4.0, "mm"))
    with pytest.raises(InputError, match="center_distance = 84 mm: is too small for the teeth of cylindrical_stage 22"):
        case(tree)


def test_external_pairs_are_3d_gears_with_a_tolerance_for_their_load_over_the_face() -> None:
    found = case(two_stages())
    assert {pair["width"] for pair in found["pair"].values()} == {"solid"}
    assert found["accuracy"] == {"tolerance": 0.05}
    assert found["load_distribution"] == {"panels": 24}
    assert "coupled slices" not in text_of(two_stages())


def test_one_face_of_more_than_forty_modules_makes_all_pairs_slices_and_is_said_once() -> None:
    tree = two_stages()
    gears = [one for one in tree["components"] if one["type"] == "cylindrical_gear"]
    module = next(a["float"] for a in gears[0]["attributes"] if a["id"] == "normal_module")
    wide = put(tree, gears[0]["id"], face_width=(40.5 * module, "mm"))
    assert {pair["width"] for pair in case(wide)["pair"].values()} == {"slices"}
    assert text_of(wide).count("external pairs are coupled slices") == 1
    just = put(tree, gears[0]["id"], face_width=(40.0 * module, "mm"))
    assert {pair["width"] for pair in case(just)["pair"].values()} == {"solid"}


@pytest.mark.parametrize(("holds", "turned"), [("positive", False), ("negative", True), ("no_direction", False)])
def test_an_angular_bearing_known_by_its_designation_keeps_its_angle_and_faces_the_way_that_it_holds(
    holds: str, turned: bool
) -> None:
    tree = two_stages()
    made = part(51, "rolling_bearing_with_catalog_geometry", "7205 BEP", axial_force_absorption=holds,
                bearing_type="angular_contact_ball_bearing", u_coordinate_on_shaft_inner_side=(10.0, "mm"),
                inner_diameter=(25.0, "mm"), outer_diameter=(52.0, "mm"), width=(15.0, "mm"),
                dynamic_capacity=(15.6, "kN"))  # fmt: skip
    rows, links = (
        [part(71, "rolling_bearing_row", pressure_angle=(40.0, "deg"))],
        [link(171, "assembly", assembly=51, part=71)],
    )
    tree["components"] = [made if one["id"] == 51 else one for one in tree["components"]] + rows
    tree["relations"] += links
    text = text_of(tree)
    seat = tomllib.loads(text)["shaft"]["shaft_3"]["bearings"][0]
    assert seat.get("reversed", False) is turned
    said = "is a non-locating bearing: contact angle of 40 deg kept" in " ".join(text.replace("\n#", " ").split())
    assert said is (holds == "no_direction")
