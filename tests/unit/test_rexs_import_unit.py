"""REXS models, written here from the standard's attributes, become cases; bad ones are refused in a sentence."""

from __future__ import annotations

import json
import math
import sys
import tomllib
from pathlib import Path

import pytest

import fegear.cli
from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.exchange.rexs.gearbox import case_of
from fegear.exchange.rexs.reading import model_of
from fegear.results.catalogue import STAGES

HERE = Path("model.rexs")


def part(number, kind, name="", **attributes):
    """A component; values with a unit as (value, unit)."""
    listed = [{"id": key, "unit": one[1], "float": one[0]} if isinstance(one, tuple) else {"id": key, "value": one}
              for key, one in attributes.items()]  # fmt: skip
    return {"id": number, "type": kind, "name": name, "attributes": listed}


def link(number, kind, **refs):
    return {"id": number, "type": kind, "refs": [{"role": role, "id": one} for role, one in refs.items()]}


def gear(number, teeth, helix, face=20.0, module=2.0, at=50.0, **more):
    return part(
        number, "cylindrical_gear", f"gear {number}", number_of_teeth=(teeth, "none"), normal_module=(module, "mm"),
        helix_angle_reference_diameter=(helix, "deg"), face_width=(face, "mm"), u_coordinate_on_shaft=(at, "mm"),
        addendum_modification_coefficient=(0.0, "none"), **more,
    )  # fmt: skip


def shaft(number, v, w, **more):
    place = {"support_vector": ([0.0, v, w], "mm"), "u_axis_vector": ([1.0, 0.0, 0.0], "mm")}
    return part(number, "shaft", f"shaft {number}", **place, **more)


def two_stages(**changed):
    """20/60 and 21/63 teeth on three shafts in one plane; 100 N m and 1500 rpm on the first."""
    helix = 10.0
    first = 0.5 * 80 * 2.0 / math.cos(math.radians(helix))
    second = 0.5 * 84 * 2.0
    components = [
        part(1, "gear_unit", "Two stages"),
        part(2, "gear_casing"),
        shaft(3, 0.0, 0.0, rotational_speed=(1500.0, "1/min"), defines_speed="true"),
        shaft(4, first, 0.0),
        shaft(5, first + second, 0.0),
        gear(11, 20, helix), gear(12, 60, -helix), gear(13, 21, 0.0, at=90.0), gear(14, 63, 0.0, at=90.0),
        part(21, "cylindrical_stage", "one", center_distance=(first, "mm")),
        part(22, "cylindrical_stage", "two", center_distance=(second, "mm")),
        part(31, "external_load", "in", torque_around_u_axis=(100.0, "N m"), u_coordinate_on_shaft=(0.0, "mm"),
             transmits_torque="true", defines_torque="true"),
        part(32, "external_load", "out", u_coordinate_on_shaft=(120.0, "mm"), transmits_torque="true"),
    ]  # fmt: skip
    relations = [
        link(101, "stage", stage=21, gear_1=11, gear_2=12), link(102, "stage", stage=22, gear_1=13, gear_2=14),
        *(link(110 + n, "assembly", assembly=s, part=g) for n, (s, g) in enumerate(
            ((3, 11), (4, 12), (4, 13), (5, 14), (3, 31), (5, 32)))),
    ]  # fmt: skip
    for n, (one, size) in enumerate(((3, 25.0), (4, 30.0), (5, 40.0))):
        section = part(41 + n, "shaft_section", length=(120.0, "mm"), outer_diameter_begin=(size, "mm"))
        components.append(section)
        relations.append(link(130 + n, "ordered_assembly", assembly=one, part=41 + n))
        for m, at in enumerate((10.0, 110.0)):
            number = 51 + 2 * n + m
            components.append(
                part(number, "concept_bearing", f"bearing {number}", u_coordinate_on_shaft_inner_side=(at, "mm"),
                     radial_stiffness=(4e5, "N/mm"), axial_stiffness=(1e5, "N/mm"))
            )  # fmt: skip
            relations.append(link(140 + number, "side", assembly=number, inner_part=one, outer_part=2))
    tree = {"version": "1.4", "applicationId": "test", "components": components, "relations": relations}
    return {**tree, **changed}


def in_json(tree):
    return json.dumps({"model": tree})


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


def test_what_was_used_assumed_and_not_read_is_named():
    said = case_of(model_of(in_json(two_stages()), HERE))
    assert "# number_of_teeth" in said
    assert "has no material: case-hardened steel of quality MQ is assumed" in said
    assert "assumed: no tool and no root_diameter given" in said
    tree = two_stages()
    tree["components"][0]["attributes"].append({"id": "colour_of_casing", "unit": "none", "value": "grey"})
    assert "Not used of gear_unit: colour_of_casing." in case_of(model_of(in_json(tree), HERE))


def test_a_shaft_without_bearings_is_imported_as_a_pair_alone():
    tree = two_stages()
    for number in (51, 52):
        tree = without(tree, number)
    text = case_of(model_of(in_json(tree), HERE))
    assert "shaft 3 has no bearings: shafts and bearings are not imported" in text
    found = tomllib.loads(text)
    assert "shaft" not in found
    assert "misalignment" not in found["results"]
    assert make_plan(build_scene(found, "case", Path()), STAGES).steps


def planetary_set():
    """18/24/66 teeth, three planets, the ring held by the casing; 90 N m and 1000 rpm on the sun."""
    distance = 0.5 * 42 * 2.0
    components = [
        part(1, "gear_unit", "A set"), part(2, "gear_casing"), part(9, "planetary_stage"), part(10, "planet_carrier"),
        shaft(3, 0.0, 0.0, rotational_speed=(1000.0, "1/min"), defines_speed="true"), shaft(4, 0.0, 0.0),
        shaft(5, 0.0, 0.0), gear(11, 18, 0.0), part(7, "coupling", "held", is_engaged="true"),
        {**gear(15, 66, 0.0), "type": "ring_gear"},
        part(31, "external_load", torque_around_u_axis=(90.0, "N m"), u_coordinate_on_shaft=(0.0, "mm"),
             defines_torque="true"),
        part(32, "external_load", u_coordinate_on_shaft=(0.0, "mm"), transmits_torque="true"),
    ]  # fmt: skip
    pairs = [(9, 10), (3, 11), (4, 15), (3, 31), (5, 32), (10, 5)]
    stages = []
    for n in range(3):
        components += [
            gear(12 + n, 24, 0.0), shaft(41 + n, distance, 0.0), shaft(51 + n, distance, 0.0),
            part(61 + n, "concept_bearing", f"pin {n}"),
            part(21 + n, "cylindrical_stage", center_distance=(distance, "mm")),
            part(24 + n, "cylindrical_stage", center_distance=(distance, "mm")),
        ]  # fmt: skip
        pairs += [(41 + n, 12 + n), (10, 51 + n), (9, 21 + n), (9, 24 + n)]
        stages += [
            link(200 + n, "stage", stage=21 + n, gear_1=11, gear_2=12 + n),
            link(210 + n, "stage", stage=24 + n, gear_1=12 + n, gear_2=15),
            link(220 + n, "side", assembly=61 + n, outer_part=41 + n, inner_part=51 + n),
        ]  # fmt: skip
    links = [link(300 + n, "assembly", assembly=one, part=other) for n, (one, other) in enumerate(pairs)]
    held = link(230, "side", assembly=7, inner_part=4, outer_part=2)
    return {"version": "1.4", "components": components, "relations": [*stages, *links, held]}


def test_a_planetary_stage_becomes_a_set():
    found = case(in_json(planetary_set()))
    assert "pair" not in found
    one = found["planetary"]["P"]
    assert {key: one[key] for key in ("planets", "fixed", "input", "torque", "speed")} == {
        "planets": 3, "fixed": "ring", "input": "sun", "torque": "90 N*m", "speed": "1000 rpm",
    }  # fmt: skip
    assert [found["gear"][one[role]]["teeth"] for role in ("sun", "planet", "ring")] == [18, 24, 66]
    assert found["gear"][one["ring"]]["internal"] is True
    stages = {step.stage.name for step in make_plan(build_scene(found, "case", Path()), STAGES).steps}
    assert {"planet-set", "planet-load-sharing"} <= stages


def test_sets_that_nothing_holds_or_that_have_no_ring_are_refused():
    with pytest.raises(InputError, match="do not balance through the teeth"):
        case(in_json(without(planetary_set(), 7)))
    with pytest.raises(InputError, match="must have a cylindrical gear as gear_1"):
        case(in_json(without(planetary_set(), 15)))
    two_suns = in_json(planetary_set()).replace('{"role": "gear_1", "id": 11}', '{"role": "gear_1", "id": 15}', 1)
    with pytest.raises(InputError, match="is no set of one sun, planets and one ring"):
        case(two_suns.replace('{"role": "gear_1", "id": 11}', '{"role": "gear_1", "id": 15}'))


def test_a_bearing_between_two_shafts_counts_as_held_by_the_casing():
    tree = two_stages()
    links = [
        link(one["id"], "side", assembly=52, inner_part=3, outer_part=4)
        if {"role": "assembly", "id": 52} in one["refs"] else one
        for one in tree["relations"]
    ]  # fmt: skip
    text = case_of(model_of(in_json({**tree, "relations": links}), HERE))
    assert "concept_bearing 52 holds shaft 3 in another shaft: it is taken as held by the casing" in text
    assert text.count("[bearing.bearing_52]") == 1
    assert make_plan(build_scene(tomllib.loads(text), "case", Path()), STAGES).steps


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("hello", "neither XML nor JSON"),
        ("<model", "damaged XML in line 1"),
        ('<!DOCTYPE m [<!ENTITY a "b">]><model version="1.4">&a;</model>', "declares a document type"),
        ("<gearbox/>", "begins with the element .?gearbox"),
        ('{"model": {"version": "9.9"}}', "has the version .9.9. of REXS"),
        ('{"model": ', "damaged JSON in line 1"),
        ('{"model": []}', "has no object model"),
        (in_json({**two_stages(), "components": [part(n, "x") for n in range(10_000)]}), "10000 components, more than"),
        (in_json({**two_stages(), "relations": [link(1, "stage", stage=21, gear_1=999)]}), "999, which is not there"),
        (in_json(without(two_stages(), 11, "number_of_teeth")), "number_of_teeth = .not given.: is missing"),
        (in_json(without(two_stages(), 11, "face_width")), "face_width = .not given.: is missing"),
        (in_json(without(two_stages(), 12)), "must have a cylindrical gear as gear_1 and one as gear_2"),
        (in_json(two_stages()).replace('"N m"', '"lbf ft"'), "has no unit of a torque"),
        (in_json(two_stages()).replace('"float": 1500.0', '"float": "fast"'), "is no finite number"),
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
    assert say("run", "box.toml", "--no-plots", "--results", "misalignment,geometry")[0] == 0
    code, words = say("import", "box.rexs")
    assert code == 2
    assert "is there already" in words
    assert say("import", "none.rexs")[0] == 2
    assert "is none of the model" in say("import", "box.rexs", "--load-case", "7", "--force")[1]
