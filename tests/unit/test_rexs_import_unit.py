"""REXS models, written here from the standard's attributes, become cases; bad ones are refused in a sentence."""

from __future__ import annotations

import math
import sys
import tomllib
from pathlib import Path

import pytest
from rexs_models import in_json, link, part, planetary_set, two_stages

import fegear.cli
from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.exchange.rexs.gearbox import case_of
from fegear.exchange.rexs.reading import model_of
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
