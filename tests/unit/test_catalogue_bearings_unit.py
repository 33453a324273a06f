"""Bearings by designation and from catalogues: what is read and refused, REXS models."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import pytest
from pydantic import ValidationError
from rexs_cases import case, imported, same, text_of, there_and_back
from rexs_models import part, two_stages

import fegear
from fegear.base.errors import InputError, RangeError
from fegear.base.notes import NoteClass, class_of
from fegear.case.built.shafts import said_of_bearings
from fegear.case.reading import build_scene
from fegear.case.shaft import BearingPart
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES
from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import KNOWN, envelope_of


@pytest.mark.parametrize(
    ("designation", "known"),
    [("6206", "6206"), ("6305-2Z", "6305"), ("6206ZZ", "6206"), ("6000/C3", "6000"), ("FAG 30206-A", "30206"),
     ("NUP204-E-XL-TVP2", "NUP204"), ("nu 2210 ecp", "NU2210"), (" NJ310.M1 ", "NJ310"), ("6303-C", "6303")],
)  # fmt: skip
def test_designations_are_read_with_what_makers_add(designation, known):
    assert envelope_of(designation) is KNOWN[known]


def test_dimensions_by_designation():
    sizes = {
        name: tuple(round(1e3 * one) for one in (k.bore, k.outside_diameter, k.width)) for name, k in KNOWN.items()
    }
    assert sizes["6206"] == sizes["30206"] == sizes["NU206"] == (30, 62, 16)
    assert (sizes["32206"], sizes["6308"], sizes["6010"], sizes["6203"]) == (
        (30, 62, 20), (40, 90, 23), (50, 80, 16), (17, 40, 12),
    )  # fmt: skip
    for one in KNOWN.values():  # each can be estimated, with an error that is of use
        made = CatalogueBearing(one.kind, one.bore, one.outside_diameter, one.width, contact_angle=one.contact_angle)
        assert 0.05 < made.error < 0.42


@pytest.mark.parametrize(
    ("typed", "angle"),
    [("7208", 40), ("7208-B-XL-TVP", 40), ("7308 BECBP", 40), ("7208 CTA/P4", 15), ("7208-C-T-P4S-UL", 15),
     ("7208 ACD", 25), ("7208A5TRSU", 25), ("7208 AW", 30), ("7208/C3", 40), ("NTN 7208", 40)],
)  # fmt: skip
def test_letters_of_angular_contact_ball_bearings_are_their_contact_angle(typed, angle):
    one = envelope_of(typed)
    assert math.degrees(one.contact_angle) == pytest.approx(angle)
    assert (one.kind, one.width) == ("ball", KNOWN[typed.replace("NTN ", "")[:4]].width)
    part = BearingPart.model_validate({"designation": typed, "life": {}})
    assert part.build().contact_angle == pytest.approx(math.radians(angle))
    assert (part.catalogue_rating is None) is (angle != 40)
    own = BearingPart.model_validate({"designation": typed, "catalogue": {"contact_angle": "35 deg"}})
    assert own.build().contact_angle == pytest.approx(math.radians(35.0))


def test_dimensions_and_limits_of_further_series():
    sizes = {
        name: tuple(round(1e3 * one) for one in (k.bore, k.outside_diameter, k.width)) for name, k in KNOWN.items()
    }
    assert [sizes[one] for one in ("6407", "16008", "32008", "31308", "22208", "22308", "7208", "31320", "6418")] == [
        (35, 100, 25), (40, 68, 9), (40, 68, 19), (40, 90, 23), (40, 80, 23), (40, 90, 33), (40, 80, 18),
        (100, 215, 51), (90, 225, 54),
    ]  # fmt: skip
    limits = {"32004": 0.37, "32007": 0.45, "32010": 0.42, "32020": 0.46, "31310": 0.83, "22208": 0.28, "22320": 0.33}
    for name, limit in limits.items():  # e = 1.5 tan(alpha), as NSK prints it
        assert 1.5 * math.tan(KNOWN[name].contact_angle) == pytest.approx(limit, abs=0.0055)


def test_a_spherical_roller_bearing_has_the_factors_of_two_rows_and_takes_no_moment():
    part = BearingPart.model_validate({"designation": "22208 E", "life": {"dynamic_rating": "96.5 kN"}})
    rating, made = part.rating, part.build()
    assert made.aligning
    assert rating.equivalent_load(10e3, 2e3) == pytest.approx(10e3 + 2.4 * 2e3, rel=0.01)  # Y_3 of NSK 2.4
    assert rating.equivalent_load(10e3, 6e3) == pytest.approx(0.67 * 10e3 + 3.6 * 6e3, rel=0.01)  # Y_2 3.6
    assert not made.usual[3:].any()
    assert part.tilt.high == 0.045


@pytest.mark.parametrize(("typed", "meant"), [("6026", "6206"), ("NUU206", "NU206"), ("32036", "32306"), ("62O6", "6")])
def test_a_typo_suggests_a_designation(typed, meant):
    with pytest.raises(InputError, match=rf'is not a known designation; did you mean "{meant}'):
        envelope_of(typed)


@pytest.mark.parametrize(
    ("typed", "series"), [("1207", "12"), ("23224", "232"), ("FAG 3207-B", "32"), ("2206", "22"), ("33206", "332")]
)
def test_series_that_are_not_tabulated_are_named_without_a_guess(typed, series):
    with pytest.raises(InputError, match=f"is of series {series}, which is not in the table; set catalogue") as refused:
        envelope_of(typed)
    assert "did you mean" not in str(refused.value)


BALL = {"bore": 0.03, "outside_diameter": 0.062, "width": 0.016}


@pytest.mark.parametrize(
    ("kind", "given", "said"),
    [("ball", {**BALL, "static_rating": 90e3}, "90 kN: is not possible within the envelope 30 x 62 x 16"),
     ("ball", {**BALL, "static_rating": 1e3}, "static_rating = 1 kN: is not possible within the envelope"),
     ("cylindrical", {**BALL, "static_rating": 90e3}, "it requires 14 rollers of 8.32 mm x 21"),
     ("ball", {**BALL, "static_rating": 11.2e3, "dynamic_rating": 60e3}, "contradicts static_rating = 11.2 kN"),
     ("tapered", {**BALL, "dynamic_rating": 200e3}, "dynamic_rating = 200 kN: is not possible within the envelope"),
     ("ball", {**BALL, "bore": 0.07}, "must be larger than the bore of 70 mm")],
)  # fmt: skip
def test_data_that_contradict_each_other_are_one_sentence(kind, given, said):
    with pytest.raises(RangeError, match=said) as error:
        _ = CatalogueBearing(kind, **given).inside
    assert "\n" not in str(error.value)


def test_a_bearing_of_a_case_takes_what_is_missing_from_its_designation_and_its_life():
    one = BearingPart.model_validate({"designation": "30206", "catalogue": {"static_rating": "49 kN"},
                                      "life": {"dynamic_rating": "46 kN", "kind": "roller"}})  # fmt: skip
    printed = one.printed
    assert (printed.kind, printed.static_rating, printed.dynamic_rating) == ("tapered", 49e3, 46e3)
    assert one.build().contact_angle == -one.build(mirrored=True).contact_angle == pytest.approx(0.24498, rel=1e-3)


@pytest.mark.parametrize(
    ("given", "said"),
    [({"designation": "6206", "radial": "20 N/um"}, "contradicts other keys"),
     ({"catalogue": {"kind": "ball", "bore": "30 mm", "width": "16 mm"}}, "is required without a designation"),
     ({"designation": "6026"}, "is not a known designation"),
     ({"designation": "6206", "life": {"radial_factor": 0.56, "limit": 0.26}}, "is required with radial_factor"),
     ({"designation": "6206", "life": {"limit": 0.26}}, "is required with limit"),
     ({"designation": "6206", "life": {"dynamic_rating": "190 kN"}}, "is not possible within the envelope")],
)  # fmt: skip
def test_a_bearing_of_a_case_is_refused(given, said):
    with pytest.raises(ValueError, match=said):
        BearingPart.model_validate(given)


def catalogued(**changed: object) -> dict:
    """Two stages whose first bearing is given by what a catalogue prints, as rigid as programs write it."""
    given = {"bearing_type": "radial_grooved_ball_bearing", "axial_force_absorption": "both_directions",
             "inner_diameter": (25.0, "mm"), "outer_diameter": (62.0, "mm"), "width": (17.0, "mm"),
             "dynamic_capacity": (22.4, "kN"), "static_capacity": (11.4, "kN"), "name": "6305-2Z",
             "radial_stiffness": (1e23, "N / m"), "u_coordinate_on_shaft_inner_side": (10.0, "mm"),
             **changed}  # fmt: skip
    tree = two_stages()
    made = part(51, "rolling_bearing_with_catalog_geometry", "bearing 51",
                **{key: one for key, one in given.items() if one is not None and key != "name"})  # fmt: skip
    made["attributes"].append({"id": "name", "value": given["name"]})
    return {**tree, "components": [made if one["id"] == 51 else one for one in tree["components"]]}


def test_a_bearing_of_a_model_that_prints_ratings_is_not_rigid():
    found = case(catalogued(name="special"))["bearing"]["bearing_51"]
    assert found["catalogue"] == {
        "kind": "ball", "bore": "25 mm", "outside_diameter": "62 mm", "width": "17 mm", "dynamic_rating": "22.4 kN",
        "static_rating": "11.4 kN",
    }  # fmt: skip
    for changed in ({}, {"inner_diameter": None, "outer_diameter": None, "width": None}):  # a name is as good
        named = case(catalogued(**changed))["bearing"]["bearing_51"]
        assert named == {"designation": "6305", "catalogue": {"static_rating": "11.4 kN"}, "life": found["life"]}
    soft = case(catalogued(radial_stiffness=(2e8, "N / m")))["bearing"]["bearing_51"]
    assert soft["radial"] == "200 N/um"
    text = " ".join(text_of(catalogued(static_capacity=(114.0, "kN"))).replace("\n#", " ").split())
    assert "rolling elements not estimated" in text
    assert "is not possible within the envelope" in text


def test_a_bearing_of_a_model_without_a_load_rating_has_a_life_by_its_dimensions():
    for name in ("6305-2Z", "special"):
        found = case(catalogued(dynamic_capacity=None, name=name))["bearing"]["bearing_51"]
        assert found["life"] == {}
        assert "dynamic_rating" not in found["catalogue"]
    assert case(catalogued())["bearing"]["bearing_51"]["life"]["dynamic_rating"] == "22.4 kN"
    rating = imported(catalogued(dynamic_capacity=None)).case.bearing["bearing_51"].rating
    assert rating.dynamic_rating == pytest.approx(22.4e3, rel=0.17)  # of a 6305


def test_a_catalogue_bearing_goes_to_rexs_and_back():
    scene = imported(catalogued(name="special"))
    again, _ = there_and_back(scene)
    first, second = (one.case.bearing["bearing_51"].printed for one in (scene, again))
    assert same(first, second)


@pytest.mark.parametrize("name", ["7208-B-XL", "22208-E1", "31308"])
def test_designations_of_both_rows_and_of_contact_angles_go_to_rexs_and_back(name):
    document = shaft_on({"designation": name, "life": {}}, {"designation": name, "life": {}})
    document["shaft"]["s"]["bearings"][1]["reversed"] = True
    scene = build_scene(document, "box", Path())
    again, _ = there_and_back(scene)
    first, second = (
        [one.case.bearing[place.bearing] for place in one.case.shaft["s"].bearings] for one in (scene, again)
    )
    assert [one.designation for one in second] == [name, name]
    assert same(first[0].printed, second[0].printed)
    ways = [one.reversed for one in again.case.shaft["s"].bearings]
    assert ways == ([False, False] if name.startswith("2") else [False, True])


@pytest.mark.parametrize(("given", "key"), [
    ({"designation": "6206", "life": {"dynamic_rating": "190 kN"}}, "life.dynamic_rating"),
    ({"designation": "6206", "catalogue": {"dynamic_rating": "190 kN"}}, "catalogue.dynamic_rating"),
    ({"designation": "6206", "catalogue": {"static_rating": "90 kN"}}, "catalogue.static_rating"),
    ({"designation": "6206", "catalogue": {"bore": "70 mm"}}, "catalogue.outside_diameter"),
    ({"designation": "6026"}, "designation"),
])  # fmt: skip
def test_what_a_bearing_is_refused_for_is_said_under_the_key_that_was_given(given, key):
    with pytest.raises(ValidationError) as refused:
        BearingPart.model_validate(given)
    (said,) = refused.value.errors()
    assert said["ctx"]["key"] == key


def notes_of(given: dict) -> list:
    """Notes on a bearing of a shaft, without that on its inside."""
    part = BearingPart.model_validate(given)
    shaft = SimpleNamespace(bearings=[SimpleNamespace(bearing="one")])
    scene = SimpleNamespace(case=SimpleNamespace(shaft={"in": shaft}, bearing={"one": part}))
    return list(said_of_bearings(scene))[1:]


@pytest.mark.parametrize(("given", "said", "remedy"), [
    ({"designation": "6306", "life": {"dynamic_rating": "20 kN"}}, "C = 20 kN does not fit 6306",
     "bearing.one.life.dynamic_rating"),
    ({"designation": "6306", "life": {"dynamic_rating": "20 kN"}, "catalogue": {"static_rating": "16 kN"}},
     "C = 20 kN does not fit 6306", "bearing.one.life.dynamic_rating"),
    ({"designation": "6306", "catalogue": {"static_rating": "11.2 kN"}}, "C_0 = 11.2 kN does not fit 6306",
     "bearing.one.catalogue.static_rating"),
    ({"designation": "NU206", "catalogue": {"dynamic_rating": "65 kN"}}, "C = 65 kN does not fit NU206",
     "bearing.one.catalogue.dynamic_rating"),
])  # fmt: skip
def test_a_rating_of_another_designation_is_a_warning_with_its_remedy(given, said, remedy):
    (note,) = notes_of(given)
    assert class_of(note) is NoteClass.BEYOND_TOLERANCE
    assert said in note
    assert remedy in note
    assert "bearing.one.designation" in note


@pytest.mark.parametrize("given", [
    {"designation": "6306", "life": {"dynamic_rating": "29.6 kN"}, "catalogue": {"static_rating": "16 kN"}},
    {"designation": "6306", "catalogue": {"bore": "31 mm", "outside_diameter": "60 mm", "dynamic_rating": "18 kN"}},
    {"designation": "6306"},
    {"radial": "200 N/um", "life": {"dynamic_rating": "20 kN"}},
])  # fmt: skip
def test_ratings_that_fit_or_belong_to_given_dimensions_are_no_warning(given):
    assert not notes_of(given)


def test_a_life_without_rating_takes_that_of_the_catalogue_else_an_estimate_of_the_designation():
    def rating(**given: object) -> object:
        return BearingPart.model_validate({"life": {}, **given}).rating

    small, large = rating(designation="6206"), rating(designation="6306")
    assert (large.kind, large.dynamic_rating) == ("ball", pytest.approx(29.6e3, rel=0.17))
    assert large.dynamic_rating > 1.3 * small.dynamic_rating
    assert rating(designation="NU206").kind == rating(designation="30206").kind == "roller"
    assert rating(designation="6306", catalogue={"dynamic_rating": "28 kN"}).dynamic_rating == 28e3
    (note,) = notes_of({"designation": "6306", "life": {}})
    assert class_of(note) is NoteClass.ASSUMED
    assert "C = 29.6 kN from the SKF General Catalogue, other makers and designs within 19 %" in note
    (note,) = notes_of({"designation": "6306", "catalogue": {"width": "20 mm"}, "life": {}})
    assert "kN estimated from the dimensions, error 19 %" in note
    assert "life.dynamic_rating" in note
    assert not notes_of({"designation": "6306", "life": {}, "catalogue": {"dynamic_rating": "28 kN"}})
    # the estimate as a given C makes the same inside
    bare = BearingPart.model_validate({"designation": "6306", "life": {}}).printed.estimated_rating
    given = {"designation": "6306", "life": {"dynamic_rating": f"{bare!r} N"}}
    bare = BearingPart.model_validate({"designation": "6306", "life": {}}).printed.inside
    assert BearingPart.model_validate(given).printed.inside.element_diameter == pytest.approx(bare.element_diameter)
    with pytest.raises(ValidationError, match="is required without a designation or catalogue") as refused:
        rating(radial="200 N/um")
    assert refused.value.errors()[0]["ctx"]["key"] == "life.dynamic_rating"


def test_an_exponent_follows_from_what_rolls_unless_given():
    life = {"dynamic_rating": "40 kN"}
    assert BearingPart.model_validate({"designation": "NU206", "life": life}).rating.kind == "roller"
    assert BearingPart.model_validate({"designation": "NU206", "life": life | {"kind": "ball"}}).rating.kind == "ball"
    assert BearingPart.model_validate({"radial": "200 N/um", "life": life}).rating.kind == "ball"


def test_axial_force_counts_where_what_rolls_is_known_unless_factors_are_given():
    """A 6308 of C 42.5 and C_0 25 kN under 1724 and 1330 N had P = F_r; f_0 = 13.2 of its print gives 3225 N."""
    life = {"dynamic_rating": "42.5 kN"}
    printed = {"designation": "6308", "catalogue": {"static_rating": "25 kN"}}
    known = BearingPart.model_validate({**printed, "life": life}).rating
    assert known.equivalent_load(1724.0, 1330.0) == pytest.approx(3225.0, rel=5e-3)
    own = {**life, "radial_factor": 0.56, "axial_factor": 1.4, "limit": 0.31}
    said = BearingPart.model_validate({**printed, "life": own}).rating
    assert said.equivalent_load(1724.0, 1330.0) == pytest.approx(0.56 * 1724.0 + 1.4 * 1330.0)
    balls = {"kind": "ball", "count": 8, "diameter": "15.08 mm", "pitch_diameter": "65 mm"}
    rolling = BearingPart.model_validate({"elements": balls, "life": life}).rating
    assert rolling.equivalent_load(1724.0, 1330.0) == pytest.approx(3225.0, rel=2e-2)
    plain = BearingPart.model_validate({"radial": "200 N/um", "life": life}).rating
    assert plain.equivalent_load(1724.0, 1330.0) == 1724.0
    assert plain.overlooks(1724.0, 1330.0)


def shaft_on(*bearings: dict) -> dict:
    """A helical pinion between two bearings of one kind, its wheel on rigid ones."""
    gears = {
        name: {"teeth": teeth, "normal_module": "3 mm", "helix_angle": "20 deg", "hand": hand, "face_width": "30 mm"}
        for name, teeth, hand in (("p", 21, "left"), ("w", 53, "right"))
    }
    sections = [{"length": "120 mm", "outer": "30 mm"}]
    on = [{"bearing": "A", "at": "20 mm"}, {"bearing": "B", "at": "100 mm"}]
    shafts = {
        "s": {"sections": sections, "gears": [{"gear": "p", "at": "60 mm"}], "bearings": on, "coupling": "0 mm"},
        "t": {"axis": ["118.124 mm", "0 mm"], "sections": sections, "gears": [{"gear": "w", "at": "60 mm"}],
              "bearings": [{"bearing": "C", "at": "20 mm"}, {"bearing": "D", "at": "100 mm"}], "coupling": "120 mm"},
    }  # fmt: skip
    rest = {"C": {"radial": "200 N/um", "fixed": True}, "D": {"radial": "200 N/um"}}
    return {
        "results": ["shaft-deflection"], "gear": gears, "shaft": shafts,
        "pair": {"I": {"driver": "p", "driven": "w", "torque": "120 N*m"}},
        "bearing": {**dict(zip("AB", bearings, strict=True)), **rest},
    }  # fmt: skip


@pytest.mark.dear
def test_tapered_bearings_of_one_direction_do_not_hold_a_shaft():
    """It was a tilt of 3.6 million degrees."""
    document = shaft_on(*({"designation": "30206", "life": {}},) * 2)
    with pytest.raises(InputError, match=r"in one direction only; set reversed = true for one of them"):
        fegear.run(document, progress=False)
    coupled = {**document, "effects": {"misalignment": True}}
    coupled["pair"]["I"]["width"] = "slices"
    with pytest.raises(InputError, match=r"shaft\.s\.bearings.*in one direction only; set reversed = true"):
        make_plan(build_scene(coupled, "box", Path()), STAGES)  # before gears are solved
    document["shaft"]["s"]["bearings"][1]["reversed"] = True
    assert fegear.run(document, progress=False).tables["bearing_forces"].column("life").si[:2].min() > 1e9
