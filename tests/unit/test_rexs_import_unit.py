"""REXS models, written here from the standard's attributes, become cases; bad ones are refused in a sentence."""

from __future__ import annotations

import math
import sys
import tomllib
from pathlib import Path
from types import SimpleNamespace

import pytest
from rexs_models import in_json, link, part, planetary_set, shaft, two_stages

import fegear.cli
from fegear.base.errors import InputError
from fegear.case.built.shafts import gearbox_of
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.exchange.case_tables import text
from fegear.exchange.rexs.model import Attribute
from fegear.exchange.rexs.model_to_case import case_of
from fegear.exchange.rexs.reading import model_of
from fegear.exchange.rexs.said import _in_si
from fegear.exchange.rexs.written_gearbox import model_text
from fegear.results.catalogue import STAGES

HERE = Path("model.rexs")


def in_xml(tree):
    """The same model as XML."""

    def attribute(one):
        value = one.get("float", one.get("value", ""))
        if isinstance(value, list):
            value = "<array>" + "".join(f"<c>{cell}</c>" for cell in value) + "</array>"
        return f'<attribute id="{one["id"]}" unit="{one.get("unit", "none")}">{value}</attribute>'

    parts = "".join(
        f'<component id="{c["id"]}" type="{c["type"]}" name="{c["name"]}">{"".join(map(attribute, c["attributes"]))}'
        "</component>"
        for c in tree["components"]
    )
    links = "".join(
        f'<relation id="{r["id"]}" type="{r["type"]}">'
        + "".join(f'<ref id="{ref["id"]}" role="{ref["role"]}"/>' for ref in r["refs"]) + "</relation>"
        for r in tree["relations"]
    )  # fmt: skip
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><model version="{tree["version"]}" applicationId="test">'
        f"<relations>{links}</relations><components>{parts}</components></model>"
    )


def case(text):
    return tomllib.loads(case_of(model_of(text, HERE)))


def without(tree, number, *names):
    """The model without attributes of a component, or without the component and its relations."""
    parts = [
        {**one, "attributes": [a for a in one["attributes"] if a["id"] not in names]} if one["id"] == number else one
        for one in tree["components"] if names or one["id"] != number
    ]  # fmt: skip
    links = [
        one for one in tree["relations"] if names or all(ref["id"] != number for ref in one["refs"])
    ]  # fmt: skip
    return {**tree, "components": parts, "relations": links}


def test_xml_and_json_give_the_same_case():
    assert case(in_xml(two_stages())) == case(in_json(two_stages()))


def test_torque_and_speed_go_through_the_gearbox():
    found = case(in_json(two_stages()))
    first, second = found["pair"]["I"], found["pair"]["II"]
    assert (first["driver"], first["driven"]) == ("gear_11", "gear_12")
    assert (first["torque"], first["speed"]) == ("100 N*m", "1500 rpm")
    assert (second["torque"], second["speed"]) == ("300 N*m", "500 rpm")
    assert found["gear"]["gear_11"]["hand"] == "right"
    assert found["gear"]["gear_12"]["hand"] == "left"
    assert "clockwise" not in found["shaft"]["shaft_3"]
    assert found["shaft"]["shaft_4"]["clockwise"] is True
    scene = build_scene(found, "case", Path())
    assert scene.pairs["I"].centre_distance == pytest.approx(80e-3 / math.cos(math.radians(10.0)), rel=1e-12)
    assert {step.stage.name for step in make_plan(scene, STAGES).steps} >= {"misalignment", "rating", "loaded-flanks"}


def test_power_from_the_other_end_turns_the_pairs_round():
    """The torque is given on the last shaft, and works with its speed."""
    tree = two_stages()
    tree = without(without(tree, 31, "torque_around_u_axis", "defines_torque"), 32)
    load = part(33, "external_load", torque_around_u_axis=(-900.0, "N m"), u_coordinate_on_shaft=(120.0, "mm"))
    link_to = link(200, "assembly", assembly=5, part=33)
    tree = {**tree, "components": [*tree["components"], load], "relations": [*tree["relations"], link_to]}
    found = case(in_json(tree))
    # The shafts turn at 1500, -500 and 166.7 rpm: -900 N m brake the last one, and the first drives.
    assert found["pair"]["II"]["driver"] == "gear_13"
    assert float(found["pair"]["I"]["torque"].split()[0]) == pytest.approx(100.0, rel=1e-12)
    turned = in_json(tree).replace("-900.0", "900.0")
    assert case(turned)["pair"]["II"]["driver"] == "gear_14"
    assert case(turned)["pair"]["II"]["torque"] == "900 N*m"


@pytest.mark.parametrize("speed", [1500.0, -1500.0])
@pytest.mark.parametrize("datum", ["negative", "positive", None])
def test_slopes_and_end_reliefs_count_from_the_datum_face(speed, datum):
    """The gear's own u is that of the gearbox; end II lies toward -u where the driver turns about +u."""
    tree = two_stages()
    torque = 100.0 if speed > 0.0 else -100.0
    tree = values_of(values_of(tree, 3, rotational_speed=(speed, "1/min")), 31, torque_around_u_axis=(torque, "N m"))
    tree["components"] += [
        part(61, "cylindrical_gear_flank", normal_pressure_angle=(20.0, "deg")),
        part(62, "helix_slope", helix_slope=(8.0, "mum")),
        part(63, "end_relief_datum_face", end_relief_depth_datum_face=(12.0, "mum"),
             end_relief_length_datum_face=(5.0, "mm")),
    ]  # fmt: skip
    tree["relations"] += [
        link(201, "flank", gear=11, left=61, right=61), link(202, "reference", origin=61, referenced=62),
        link(203, "reference", origin=61, referenced=63),
    ]  # fmt: skip
    if datum:
        tree = values_of(tree, 11, datum_face_orientation=datum)
    text = case_of(model_of(in_json(tree), HERE))
    far = "I" if datum and (datum == "negative") == (speed > 0.0) else "II"
    lead = tomllib.loads(text)["gear"]["gear_11"]["lead"]
    assert lead["slope"] == ("8 um" if far == "II" else "-8 um")
    assert lead["end_relief"] == [{"amount": "12 um", "length": "5 mm", "end": "I" if far == "II" else "II"}]
    assert (": datum face not specified; end I assumed." in text) == (datum is None)


def test_what_was_used_assumed_and_not_read_is_named():
    said = case_of(model_of(in_json(two_stages()), HERE))
    assert "# number_of_teeth" in said
    assert ": material not specified; case-hardened steel," in said
    assert "assumed: no tool and no root_diameter specified" in said
    tree = two_stages()
    tree["components"][0]["attributes"].append({"id": "colour_of_casing", "unit": "none", "value": "grey"})
    assert "Ignored attributes of gear_unit: colour_of_casing." in case_of(model_of(in_json(tree), HERE))


def test_a_shaft_without_bearings_is_imported_as_a_pair_alone():
    tree = two_stages()
    for number in (51, 52):
        tree = without(tree, number)
    text = case_of(model_of(in_json(tree), HERE))
    assert "shaft 3 has no bearings; shafts and bearings are not imported" in text
    found = tomllib.loads(text)
    assert "shaft" not in found
    assert "misalignment" not in found["results"]
    assert make_plan(build_scene(found, "case", Path()), STAGES).steps


def test_a_planetary_stage_becomes_a_set():
    found = case(in_json(planetary_set()))
    assert {name: (one["driver"], one["driven"]) for name, one in found["pair"].items()} == {
        "P_sun": ("gear_11", "gear_120"), "P_ring": ("gear_120", "gear_15"),
    }  # fmt: skip
    one = found["planetary"]["P"]
    assert {key: one[key] for key in ("planets", "fixed", "input", "torque", "speed")} == {
        "planets": 3, "fixed": "ring", "input": "sun", "torque": "90 N*m", "speed": "1000 rpm",
    }  # fmt: skip
    assert [found["gear"][one[role]]["teeth"] for role in ("sun", "planet", "ring")] == [18, 24, 66]
    assert found["gear"][one["ring"]]["internal"] is True
    stages = {step.stage.name for step in make_plan(build_scene(found, "case", Path()), STAGES).steps}
    assert {"planet-set", "planet-load-sharing", "rating", "load-distribution"} <= stages


def test_sets_that_nothing_holds_or_that_have_no_ring_are_refused():
    with pytest.raises(InputError, match="has no output in the gear train"):
        case(in_json(without(planetary_set(), 7)))
    with pytest.raises(InputError, match="must have a cylindrical gear as gear_1"):
        case(in_json(without(planetary_set(), 15)))
    two_suns = in_json(planetary_set()).replace('{"role": "gear_1", "id": 11}', '{"role": "gear_1", "id": 15}', 1)
    with pytest.raises(InputError, match="is not a planetary set of one sun, planets and one ring"):
        case(two_suns.replace('{"role": "gear_1", "id": 11}', '{"role": "gear_1", "id": 15}'))


def test_a_bearing_between_two_shafts_counts_as_held_by_the_casing():
    tree = two_stages()
    links = [
        link(one["id"], "side", assembly=52, inner_part=3, outer_part=4)
        if {"role": "assembly", "id": 52} in one["refs"] else one
        for one in tree["relations"]
    ]  # fmt: skip
    text = case_of(model_of(in_json({**tree, "relations": links}), HERE))
    assert "concept_bearing 52 supports shaft 3 in another shaft; treated as supported by the housing" in text
    assert text.count("[bearing.bearing_52]") == 1
    # What presses inside a shaft that stands on two bearings does not hold it, too.
    shafts = tomllib.loads(text)["shaft"]
    assert [len(one["bearings"]) for one in shafts.values()] == [2, 2, 2]
    assert "concept_bearing 52: reaction on shaft 4 neglected" in text
    assert make_plan(build_scene(tomllib.loads(text), "case", Path()), STAGES).steps


def coaxial():
    """Two stages of one centre distance: the output shaft has its left bearing in the hollow input shaft."""
    distance, first = 80.0 / math.cos(math.radians(10.0)), 60.0
    tree = values_of(two_stages(), 5, support_vector=([first, 0.0, 0.0], "mm"))
    tree = values_of(tree, 13, number_of_teeth=(20, "none"), helix_angle_reference_diameter=(10.0, "deg"))
    tree = values_of(
        tree, 14, number_of_teeth=(60, "none"), helix_angle_reference_diameter=(-10.0, "deg"),
        u_coordinate_on_shaft=(90.0 - first, "mm"),
    )  # fmt: skip
    tree = values_of(tree, 22, center_distance=(distance, "mm"))
    tree = values_of(tree, 41, length=(75.0, "mm"), inner_diameter_begin=(12.0, "mm"))
    tree = values_of(tree, 52, u_coordinate_on_shaft_inner_side=(70.0, "mm"))
    places = {"inner": (5.0, "mm"), "outer": (65.0, "mm")}
    tree = values_of(tree, 55, **{f"u_coordinate_on_shaft_{side}_side": at for side, at in places.items()})
    links = [one for one in tree["relations"] if {"role": "assembly", "id": 55} not in one["refs"]]
    return {**tree, "relations": [*links, link(199, "side", assembly=55, inner_part=5, outer_part=3)]}


def test_a_bearing_between_two_shafts_on_one_axis_joins_them():
    text = case_of(model_of(in_json(coaxial()), HERE))
    again, _ = model_text(build_scene(tomllib.loads(text), "case", Path()), "2026-01-01T00:00:00")
    for found in (text, case_of(model_of(again, HERE))):
        one = tomllib.loads(found)
        inner = one["shaft"]["shaft_5"]
        assert [seat.get("around") for seat in inner["bearings"]] == ["shaft_3", None]
        assert [len(shaft["bearings"]) for shaft in one["shaft"].values()] == [2, 2, 2]
        assert "in another shaft; treated as supported by the" not in found
        box = gearbox_of(build_scene(one, "case", Path()))
        bent = box.under(box.even)
        assert max(shaft.balance.max() for shaft in bent) < 1e-9
        assert [shaft.inside_at.size for shaft in bent] == [1, 0, 0]
        assert bent[0].inside_at == pytest.approx([0.065], rel=1e-9)


def values_of(tree, number, **changed):
    """The model with attributes of a component changed or added."""
    made = part(number, "", **changed)["attributes"]
    others = without(tree, number, *changed)
    parts = [
        {**one, "attributes": [*one["attributes"], *made]} if one["id"] == number else one
        for one in others["components"]
    ]  # fmt: skip
    return {**others, "components": parts}


def fixed_ones(tree):
    return [name for name, one in case(in_json(tree))["bearing"].items() if one.get("fixed") or "axial" in one]


def test_the_bearing_that_takes_the_axial_force_holds_the_shaft():
    """Gear 11 turns about +u and is braked by its mate: its teeth, wound right-handed, are pushed towards +u."""
    tree = two_stages()
    for first, second, holds in (
        ("both_directions", "no_direction", "bearing_51"),
        ("no_direction", "both_directions", "bearing_52"),
        ("positive", "negative", "bearing_51"),
        ("negative", "positive", "bearing_52"),
        ("negative", "both_directions", "bearing_52"),
        ("no_direction", "no_direction", "bearing_51"),
    ):
        said = values_of(tree, 51, axial_force_absorption=first)
        said = values_of(said, 52, axial_force_absorption=second)
        assert fixed_ones(said)[0] == holds, (first, second)
    assert ": no axial support in both directions;" not in case_of(model_of(in_json(tree), HERE))
    other = in_json(values_of(values_of(tree, 51, axial_force_absorption="negative"), 52, axial_force_absorption="x"))
    assert "shaft 3: no axial support in both directions; concept_bearing 51 assumed as locating bearing" in case_of(
        model_of(other, HERE)
    )


def oiled(called="Oil", **about):
    """Two stages in oil: name and attributes of the lubricant, and what stands elsewhere."""
    tree = values_of(two_stages(), 2, temperature_lubricant=(55.0, "C"))
    tree = values_of(tree, 1, operating_time=(5000.0, "h"))
    tree = values_of(tree, 21, application_factor_iso_6336_2006=(1.25, "none"))
    oil = part(60, "lubricant", called, **about)
    links = [*tree["relations"], link(190, "reference", origin=2, referenced=60)]
    return case(in_json({**tree, "components": [*tree["components"], oil], "relations": links}))["pair"]


def test_oil_temperature_life_and_application_factor_are_those_of_the_model():
    found = oiled(
        viscosity_at_40_degree_celsius=(100.0, "mm^2 / s"), viscosity_at_100_degree_celsius=(11.0, "mm^2 / s"),
        density_at_15_degree_celsius=(0.88, "kg / dm^3"), lubricant_type_iso_6336_2006="polyalfaolefin",
    )  # fmt: skip
    assert found["I"]["lubricant"] == {
        "viscosity_40": "100 mm^2/s", "viscosity_100": "11 mm^2/s", "density_15": "880 kg/m^3",
        "kind": "polyalphaolefin", "temperature": "55 degC",
    }  # fmt: skip
    assert found["I"]["operation"] == {"application_factor": 1.25, "life": "5000 h"}
    assert found["II"]["operation"]["application_factor"] == 1


@pytest.mark.parametrize(
    ("name", "grade"),
    [("ISO-VG-100 [91]", "100"), ("CLP 220", "220"), ("Mobilgear 600 XP 320", "320"), ("VG 68 of 1999", "68"),
     ("oil", "220")],
)  # fmt: skip
def test_an_oil_without_viscosity_has_the_grade_of_its_name(name, grade):
    assert oiled(called=name)["I"]["lubricant"] == {"viscosity_40": f"{grade} mm^2/s", "temperature": "55 degC"}


def planned(tree):
    """Torques and speeds of the pairs of a model whose case can be planned."""
    text = case_of(model_of(in_json(tree), HERE))
    found = tomllib.loads(text)
    assert make_plan(build_scene(found, "case", Path()), STAGES).steps
    return [tuple(float(one[key].split()[0]) for key in ("torque", "speed")) for one in found["pair"].values()], text


@pytest.mark.dear
def test_one_assumed_torque_and_speed_are_carried_through_the_train():
    tree = without(without(two_stages(), 31, "torque_around_u_axis"), 3, "rotational_speed")
    (first, second), text = planned(tree)
    assert second == pytest.approx((3.0 * first[0], first[1] / 3.0), rel=1e-12)
    assert first[1] == 1500.0
    assert "No torque specified for cylindrical_stage 21, cylindrical_stage 22: 2.8 N m assumed" in text
    assert text.count("# assumed, and calculated through the gearbox") == 4
    # Without a word on where torque enters or leaves it does so at the ends of the shafts.
    bare, text = planned(without(without(tree, 31), 32))
    assert bare == [first, second]
    assert "shaft 3: position of the coupling not specified; shaft end assumed" in text
    # A torque that is given alone leaves at the other end, whichever end it enters.
    assert planned(without(two_stages(), 32))[0] == [(100.0, 1500.0), (300.0, 500.0)]
    from_behind = values_of(without(two_stages(), 31), 32, torque_around_u_axis=(90.0, "N m"), transmits_torque="false")
    assert planned(from_behind)[0][1] == (90.0, 166.666666667)


def test_a_power_is_read_as_a_torque():
    tree = values_of(without(two_stages(), 31, "torque_around_u_axis"), 31, power=(15.0, "kW"))
    assert planned(tree)[0][0] == pytest.approx((15e3 / (50.0 * math.pi), 1500.0), rel=1e-11)


def test_paths_beside_each_other_share_a_torque_that_is_not_determined():
    """A second wheel like gear 12 on a shaft of its own, whose torque nothing gives."""
    tree = two_stages()
    more = [
        shaft(6, -80.0 / math.cos(math.radians(10.0)), 0.0), {**part_of(tree, 12), "id": 15, "name": "gear 15"},
        part(23, "cylindrical_stage", "three"),
        part(33, "external_load", u_coordinate_on_shaft=(120.0, "mm"), transmits_torque="true"),
        part(48, "shaft_section", length=(120.0, "mm"), outer_diameter_begin=(30.0, "mm")),
        *(part(n, "concept_bearing", f"bearing {n}", u_coordinate_on_shaft_inner_side=(at, "mm"),
               radial_stiffness=(4e5, "N/mm")) for n, at in ((71, 10.0), (72, 110.0))),
    ]  # fmt: skip
    links = [
        link(180, "stage", stage=23, gear_1=11, gear_2=15), link(181, "assembly", assembly=6, part=15),
        link(182, "assembly", assembly=6, part=33), link(183, "ordered_assembly", assembly=6, part=48),
        *(link(184 + n, "side", assembly=71 + n, inner_part=6, outer_part=2) for n in range(2)),
    ]  # fmt: skip
    tree = {**tree, "components": [*tree["components"], *more], "relations": [*tree["relations"], *links]}
    pairs, text = planned(tree)
    assert pairs[0][0] + pairs[2][0] == pytest.approx(100.0, rel=1e-9)
    assert pairs[1][0] == pytest.approx(3.0 * pairs[0][0], rel=1e-9)
    assert "cylindrical_stage 21: torque not determined by the model" in text


def with_load_cases(*cases):
    """Two stages under loads: torque [N m] and speed [1/min] of the first shaft, and how long."""
    made = [
        {"id": n, "components": [
            part(3, "shaft", rotational_speed=(speed, "1/min")),
            part(31, "external_load", torque_around_u_axis=(torque, "N m")),
            part(1, "gear_unit", **time),
        ]}
        for n, (torque, speed, time) in enumerate(cases, 1)
    ]  # fmt: skip
    tree = without(without(two_stages(), 31, "torque_around_u_axis"), 3, "rotational_speed")
    return model_of(in_json({**tree, "load_spectrum": [{"id": 1, "load_cases": made}]}), HERE)


def test_load_cases_become_the_spectrum_of_every_pair():
    shares = [{"load_duration_fraction": (p, "%")} for p in (20.0, 80.0)]
    model = with_load_cases((100.0, 1500.0, shares[0]), (40.0, 3000.0, shares[1]))
    found = tomllib.loads(case_of(model, spectrum=True))
    assert found["pair"]["I"]["operation"]["spectrum"] == [
        {"torque": "100 N*m", "speed": "1500 rpm", "share": 0.2},
        {"torque": "40 N*m", "speed": "3000 rpm", "share": 0.8},
    ]  # fmt: skip
    assert found["pair"]["II"]["operation"]["spectrum"][1] == {"torque": "120 N*m", "speed": "1000 rpm", "share": 0.8}
    assert build_scene(found, "case", Path()).case.pair["I"].operation.spectrum
    assert "spectrum" not in tomllib.loads(case_of(model, 2))["pair"]["I"]["operation"]
    hours = [{"operating_time": (h, "h")} for h in (1000.0, 3000.0)]
    model = with_load_cases((100.0, 1500.0, hours[0]), (40.0, 3000.0, hours[1]))
    timed = tomllib.loads(case_of(model, spectrum=True))["pair"]["I"]["operation"]
    assert (timed["life"], [one["share"] for one in timed["spectrum"]]) == ("4000 h", [0.25, 0.75])


def test_power_that_turns_round_is_counted_on_the_driver_of_the_first_load_case():
    half = {"load_duration_fraction": (50.0, "%")}
    text = case_of(with_load_cases((100.0, 1500.0, half), (-30.0, 1500.0, half)), spectrum=True)
    bins = tomllib.loads(text)["pair"]["I"]["operation"]["spectrum"]
    assert [(one["torque"], one["speed"]) for one in bins] == [("100 N*m", "1500 rpm"), ("30 N*m", "1500 rpm")]
    assert "cylindrical_stage 21: power flow reverses in the load spectrum" in text


@pytest.mark.parametrize(
    ("cases", "words"),
    [
        ([], "0 load cases: do not all have a duration"),
        ([(100.0, 1500.0, {}), (40.0, 1500.0, {"load_duration_fraction": (50.0, "%")})], "do not all have a duration"),
        ([(0.0, 1500.0, {"load_duration_fraction": (50.0, "%")})], "has a load case without torque or speed"),
    ],
)
def test_load_cases_that_make_no_spectrum_are_refused(cases, words):
    with pytest.raises(InputError, match=words):
        case_of(with_load_cases(*cases), spectrum=True)


def part_of(tree, number):
    return next(one for one in tree["components"] if one["id"] == number)


def test_helices_that_cannot_mesh_and_teeth_below_zero_are_refused_and_a_ring_may_have_either_sign():
    with pytest.raises(InputError, match=r"10 deg and 10 deg.*cannot mesh in cylindrical_stage 21"):
        case(in_json(values_of(two_stages(), 12, helix_angle_reference_diameter=(10.0, "deg"))))
    with pytest.raises(InputError, match="cannot mesh"):
        case(in_json(values_of(two_stages(), 12, helix_angle_reference_diameter=(-11.0, "deg"))))
    with pytest.raises(InputError, match=r"number_of_teeth = -60: .*cylindrical_gear 12; .*for ring gears only"):
        case(in_json(values_of(two_stages(), 12, number_of_teeth=(-60, "none"))))
    negative = values_of(planetary_set(), 15, number_of_teeth=(-66, "none"))
    assert case(in_json(negative)) == case(in_json(planetary_set()))
    # A ring turns with its pinion, whatever the sign of its teeth.
    for teeth in (63, -63):
        tree = values_of(two_stages(), 14, number_of_teeth=(teeth, "none"), type="x")
        part_of(tree, 14)["type"] = "ring_gear"
        part_of(tree, 22)["attributes"][0]["float"] = 42.0
        tree = without(tree, 5, "support_vector")
        assert "clockwise" in case(in_json(tree))["shaft"]["shaft_5"], teeth
        assert float(case(in_json(tree))["pair"]["II"]["torque"].split()[0]) == pytest.approx(300.0)


def test_a_truth_value_is_no_name_and_no_place():
    lost = values_of(two_stages(), 5, support_vector=False)
    text = case_of(model_of(in_json(lost), HERE))
    assert "shaft 5: boolean support_vector ignored" in text
    assert tomllib.loads(text)["shaft"]["shaft_5"]["axis"][1] == "84 mm"  # its stage places it
    steel = part(61, "material", "steel", material_designation=True, elastic_modulus=(206e3, "N/mm^2"))
    tree = two_stages()
    links = [*tree["relations"], link(191, "reference", origin=11, referenced=61)]
    text = case_of(model_of(in_json({**tree, "components": [*tree["components"], steel], "relations": links}), HERE))
    assert "material 61: boolean material_designation ignored" in text
    assert "# material 61 steel" in text
    assert (
        model_of(in_json({"version": "1.4", "components": [{**steel, "name": True}]}), HERE).components[61].name == ""
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("hello", "neither XML nor JSON"),
        ("<model", "damaged XML in line 1"),
        ('<!DOCTYPE m [<!ENTITY a "b">]><model version="1.4">&a;</model>', "contains a document type declaration"),
        ("<gearbox/>", "begins with the element .?gearbox"),
        ('{"model": {"version": "9.9"}}', "has the version .9.9. of REXS"),
        ('{"model": ', "damaged JSON in line 1"),
        ('{"model": []}', "has no object model"),
        (in_json({**two_stages(), "components": [part(n, "x") for n in range(10_000)]}), "10000 components, more than"),
        (in_json({**two_stages(), "relations": [link(1, "stage", stage=21, gear_1=999)]}), "999, which does not exist"),
        (in_json(without(two_stages(), 11, "number_of_teeth")), "number_of_teeth = .not given.: is missing"),
        (in_json(without(two_stages(), 11, "face_width")), "face_width = .not given.: is missing"),
        (in_json(without(two_stages(), 12)), "must have a cylindrical gear as gear_1 and one as gear_2"),
        (in_json(two_stages()).replace('"N m"', '"lbf ft"'), "has an invalid unit for torque in"),
        (in_json(two_stages()).replace('"float": 1500.0', '"float": "fast"'), "is not a finite number in"),
        (in_json(without(without(two_stages(), 21), 22)), "has no stage"),
        ("<model>" + "<a>" * 100 + "</a>" * 100 + "</model>", "more than 40 deep"),
        ('{"model": ' + "[" * 100_000 + "]" * 100_000 + "}", "nests its values too deep|has no object model"),
    ],
)
def test_bad_models_are_refused_in_one_sentence(text, words):
    with pytest.raises(InputError, match=words) as refused:
        case_of(model_of(text, HERE))
    assert "\n" not in str(refused.value)


def test_the_command_writes_a_case_that_runs_and_replaces_nobody_s(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("box.rexs").write_text(in_xml(two_stages()), "utf-8")

    def say(*arguments):
        monkeypatch.setattr(sys, "argv", ["fegear", *arguments])
        with pytest.raises(SystemExit) as end:
            fegear.cli.main()
        return int(end.value.code or 0), "".join(capsys.readouterr())

    code, words = say("import", "box.rexs")
    assert (code, Path("box.toml").is_file()) == (0, True)
    assert "Wrote box.toml" in words
    assert say("run", "box.toml", "--no-plots", "--results", "geometry")[0] == 0
    code, words = say("import", "box.rexs")
    assert code == 2
    assert "already exists" in words
    assert say("import", "none.rexs")[0] == 2
    assert "is not in the model" in say("import", "box.rexs", "--load-case", "7", "--force")[1]


def test_a_number_of_hundreds_of_digits_is_no_number():
    """JSON has whole numbers of any length; as a part of a vector one was an OverflowError."""
    said = SimpleNamespace(said="shaft 3")
    with pytest.raises(InputError, match="is not a finite number in shaft"):
        _in_si(Attribute("u_axis_vector", "mm", (10**400, 0, 0)), 10**400, said, "length")


def test_a_coupling_is_engaged_where_a_program_wrote_its_arrays_as_false():
    """REXS has is_engaged as an array; FVA Workbench 5.5 wrote every array, so vectors too, as false into JSON."""
    tree = values_of(planetary_set(), 7, is_engaged=False)
    with pytest.raises(InputError, match="specify an output load, or fix a member of"):
        case(in_json(tree))
    for one in tree["components"]:
        for attribute in one["attributes"]:
            if attribute["id"].endswith("_vector"):
                attribute["value" if "value" in attribute else "float"] = False
    text = case_of(model_of(in_json(tree), HERE))
    assert "coupling 7: is_engaged is false, as are all arrays of this model" in text
    assert tomllib.loads(text)["planetary"] == case(in_json(planetary_set()))["planetary"]


def test_texts_of_a_model_are_read_back_from_the_case_as_they_are():
    """JSON leaves a delete character in quotes as it is, which TOML refuses."""
    for one in ("gear \x7f", 'a "quoted" \\ name', "\t\n\x01", "größer", ""):
        assert tomllib.loads(f"title = {text(one)}")["title"] == one


def test_an_axial_offset_has_no_digits_of_the_positions_that_it_is_the_difference_of() -> None:
    tree = values_of(two_stages(), 12, u_coordinate_on_shaft=(66.7, "mm"))
    tree = values_of(tree, 11, u_coordinate_on_shaft=(69.2, "mm"))
    assert tomllib.loads(case_of(model_of(in_json(tree), HERE)))["pair"]["I"]["axial_offset"] == "-2.5 mm"
