"""The JSON schema of case files: it takes every case that fegear takes, and none with a slip in a key or a value."""

from __future__ import annotations

import copy
import json
import random
import sys
import tomllib
from pathlib import Path

import jsonschema
import pytest

import fegear.cli
from fegear.base.errors import FegearError
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.kinds import KINDS
from fegear.case.drafts.text import draft
from fegear.case.known_keys import flat
from fegear.case.reading import build_scene
from fegear.commands.schema import schema_text
from fegear.results.catalogue import RESULTS, STAGES

CASES = sorted((Path(__file__).parents[2] / "cases").rglob("*.toml"))


@pytest.fixture(scope="module")
def schema():
    made = json.loads(schema_text())
    jsonschema.Draft202012Validator.check_schema(made)
    return made


@pytest.fixture(scope="module")
def validator(schema):
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_every_case_of_the_gallery_is_one(validator, path):
    assert [error.message for error in validator.iter_errors(tomllib.loads(path.read_text("utf-8")))] == []


@pytest.mark.parametrize("kind", KINDS)
def test_every_draft_is_a_case(validator, kind):
    assert list(validator.iter_errors(tomllib.loads(draft(Answers(kind, {}), "x")))) == []


ANOTHER_WAY = [
    ("gear.a.rack", "ISO 53 A"),
    ("gear.a.rack", "c"),
    ("gear.a.rack", {"tip_radius": "full"}),
    ("gear.a.relief", {"tip": {"amount": "10 um", "length": "2 mm"}}),
    ("gear.a.relief", {"tip": [{"amount": "10 um", "length": "2 mm"}, {"amount": "1 um", "length": "1 mm"}]}),
    ("gear.a.spacing_errors", ["0 um"] * 20),
    ("gear.a.spacing_errors", {"file": "errors.csv"}),
    ("gear.a.profile_shift", 0),
    ("dynamics.speeds", ["1000 rpm", "20 1/s"]),
    ("dynamics.speeds", {"start": "1 rpm", "stop": "2 rpm", "count": 5}),
    ("gear.a.helix_angle", "20°"),
    ("design.peak", "least-root-stress"),
    ("design.peak", 1.2),
]


def changed(key: str, value: object) -> dict:
    document = {"results": ["geometry"], "gear": {"a": {"teeth": 20, "module": "3mm"}}}
    table = document
    *steps, last = key.split(".")
    for step in steps:
        table = table.setdefault(step, {})
    table[last] = value
    return document


@pytest.mark.parametrize(("key", "value"), ANOTHER_WAY)
def test_every_way_to_write_a_table_is_known(validator, key, value):
    assert [error.message for error in validator.iter_errors(changed(key, value))] == []


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("gear.a.module", "3,175 mm"),
        ("gear.a.module", "mm"),
        ("gear.a.module", "1 1/2 in"),
        ("gear.a.module", 3),
        ("gear.a.plane", "strian"),
        ("gear.a.rack", "ISO 53 E"),
        ("gear.a.teeth", 20.5),
        ("effects.frction", True),
        ("effects.hertz", 2),
        ("results", ["stifness"]),
        ("results", []),
        ("accuracy.order", 7),
        ("accuracy.root_edge_length", -1.0),
        ("design.peak", "most"),
    ],
)
def test_what_fegear_refuses_at_sight_is_refused_by_the_schema(validator, key, value):
    document = changed(key, value)
    assert not validator.is_valid(document)
    if key != "results" or not value:  # names of results are the plan's matter
        with pytest.raises(FegearError):
            build_scene(document, "x", Path())


def test_a_hundred_misspelt_keys_are_refused_by_both(validator):
    """A letter more, less, changed or swapped in a random key of a random case is never a key of another meaning."""
    chance = random.Random(7)  # noqa: S311
    tried = 0
    while tried < 100:
        document = tomllib.loads(chance.choice(CASES).read_text("utf-8"))
        *steps, last = chance.choice([key for key in flat(document) if "[" not in key]).split(".")
        table = copy.deepcopy(document)
        inner = table
        for step in steps:
            inner = inner[step]
        if steps == ["train", "torque"] or steps[-2:] == ["search", "teeth"]:
            continue  # its keys are names of the user's choice
        at, letter = chance.randrange(len(last)), chance.choice("abcdefghijklmnopqrstuvwxyz_")
        slips = [last[:at] + last[at + 1 :], last[:at] + letter + last[at:], last[:at] + letter + last[at + 1 :]]
        slip = chance.choice(slips)
        if slip in inner or not slip or slip == last:
            continue
        inner[slip] = inner.pop(last)
        tried += 1
        assert not validator.is_valid(table), (steps, last, slip)
        with pytest.raises(FegearError):
            build_scene(table, "x", Path())


def test_quantities_say_their_units_and_defaults(schema):
    gear = schema["$defs"]["GearPart"]["properties"]
    assert gear["pressure_angle"]["default"] == "20 deg"
    assert "length with its unit: mm, um, m, inch" in gear["module"]["description"]
    material = schema["$defs"]["MaterialPart"]["anyOf"][1]["properties"]
    assert (material["young_modulus"]["default"], material["density"]["default"]) == ("206.8 GPa", "7850 kg/m^3")
    assert "null" not in json.dumps(schema)
    assert {one["const"] for one in schema["properties"]["results"]["items"]["anyOf"]} == {*RESULTS, *STAGES.former()}


def test_the_command_writes_what_new_points_to(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for arguments in (["schema", "--out", "one.json"], ["new", "drive"], ["schema"]):
        monkeypatch.setattr(sys, "argv", ["fegear", *arguments])
        with pytest.raises(SystemExit) as end:
            fegear.cli.main()
        assert not end.value.code
    assert capsys.readouterr().out.endswith(schema_text())
    hint = (tmp_path / "drive.toml").read_text().splitlines()[0]
    assert hint == "#:schema ./fegear.schema.json"
    assert (tmp_path / "fegear.schema.json").read_text() == schema_text() == (tmp_path / "one.json").read_text()
