"""Damaged REXS models: a case that can be planned or refused in words, or one sentence; never a traceback."""

from __future__ import annotations

import copy
import json
import random
import tomllib
from collections import Counter
from pathlib import Path

import pytest
from mutations import processor_seconds
from rexs_models import planetary_set, two_stages
from rexs_mutations import mutated_file

from fegear.base.errors import FegearError, InputError
from fegear.case.reading import build_scene
from fegear.commands.import_model import import_, refuse_unplanned
from fegear.engine.plan import make_plan
from fegear.exchange.rexs.model_to_case import case_of
from fegear.exchange.rexs.reading import model_of, read_model
from fegear.results.catalogue import STAGES

_VALUES = (0, -1, 1e300, -1e-300, "", "x", None, [], {}, [1, 2], True, 1e9, "1e999", "nan")
_UNITS = ("", "mm", "rad", "N", "kg", "1/min")
_TYPES = ("shaft", "cylindrical_gear", "ring_gear", "external_load", "x", "planetary_stage", "concept_bearing")


def damaged(seed: int) -> dict:
    """A model with one to three things wrong."""
    draw = random.Random(seed)  # noqa: S311
    tree = copy.deepcopy(draw.choice((two_stages, planetary_set))())
    parts, links = tree["components"], tree["relations"]
    for _ in range(draw.randint(1, 3)):
        part, what = draw.choice(parts), draw.random()
        if what < 0.4 and part["attributes"]:
            one = draw.choice(part["attributes"])
            key = "float" if "float" in one else "value"
            number = isinstance(one[key], int | float)
            one[key] = draw.choice((*_VALUES, *((one[key] * f for f in (-1, 10, 0.1, 1e6)) if number else ())))
            one["unit"] = draw.choice((one["unit"], one["unit"], *_UNITS)) if "unit" in one else ""
        elif what < 0.5 and part["attributes"]:
            part["attributes"].remove(draw.choice(part["attributes"]))
        elif what < 0.6:
            part["type"] = draw.choice(_TYPES)
        elif what < 0.7:
            part["id"] = draw.choice([*(one["id"] for one in parts), 10**30, -1])
        elif what < 0.8:
            links.remove(draw.choice(links))
        elif what < 0.9:
            draw.choice(draw.choice(links)["refs"])["id"] = draw.choice(parts)["id"]
        else:
            draw.choice(links)["type"] = draw.choice(("assembly", "stage", "side", "reference"))
    return tree


@pytest.mark.parametrize(("first", "count"), [(0, 60), pytest.param(60, 2000, marks=pytest.mark.long)])
def test_damaged_rexs_models_end_in_a_case_or_a_sentence(first, count):
    ends = Counter()
    for seed in range(first, first + count):
        try:
            found = tomllib.loads(case_of(model_of(json.dumps({"model": damaged(seed)}), Path("model.rexs"))))
            make_plan(build_scene(found, "case", Path()), STAGES)
            ends["planned"] += 1
        except FegearError as refusal:
            ends["refused" if "\n" not in str(refusal) else str(refusal)] += 1
    assert set(ends) == {"planned", "refused"}
    assert min(ends["planned"], ends["refused"]) > 0.1 * count


@pytest.mark.dear("0-25")
@pytest.mark.parametrize(("first", "count"), [(0, 25), pytest.param(25, 1000, marks=pytest.mark.long)])
def test_models_with_broken_structure_end_in_a_case_that_is_planned_or_a_sentence(tmp_path, first, count):
    """XML, JSON and archives: parts lost, doubled, exchanged, of wrong kinds, with numbers that are none, cut texts."""
    ends = Counter()
    for seed in range(first, first + count):
        name, content = mutated_file(seed)
        (tmp_path / name).write_bytes(content)
        with processor_seconds(20.0):
            try:
                text = case_of(read_model(tmp_path / name), None, name)
                refuse_unplanned(text, name)
                text.encode()
                ends["planned"] += 1
            except FegearError as refusal:
                said = str(refusal)
                said.encode()
                ends["refused" if "\n" not in said else said] += 1
    assert set(ends) == {"planned", "refused"}
    assert ends["planned"] > 0.1 * count


def test_what_import_writes_plan_takes(tmp_path, monkeypatch):
    """A face of 20 m: the case was written, and every command on it refused it."""
    tree = two_stages()
    for one in tree["components"]:
        for attribute in one["attributes"]:
            if one["id"] in (11, 12) and attribute["id"] == "face_width":
                attribute["unit"] = "m"
    monkeypatch.chdir(tmp_path)
    Path("box.rexsj").write_text(json.dumps({"model": tree}))
    with pytest.raises(InputError, match=r"cannot be computed: gear.gear_11.face_width = 20 m: .* --unchecked"):
        import_(Path("box.rexsj"), None, None, None)
    assert not Path("box.toml").exists()
    import_(Path("box.rexsj"), None, None, None, unchecked=True)
    assert "face_width" in Path("box.toml").read_text()


@pytest.mark.parametrize("text", ["1_000", "\uff11\uff12", "\u0663", "0x10", "1e999", "12 mm", "", "nan", "1,5"])
def test_numbers_are_plain_ascii_ones(text):
    """Python reads 1_000 and full-width digits as numbers; other programs do not write them."""
    tree = two_stages()
    one = next(one for one in tree["components"] if one["id"] == 11)
    (teeth,) = (a for a in one["attributes"] if a["id"] == "number_of_teeth")
    teeth["float"] = text
    with pytest.raises(InputError, match=r"is not a finite number|is missing"):
        case_of(model_of(json.dumps({"model": tree}), Path("model.rexs")))
    del teeth["float"]
    teeth["value"] = " 20 "
    assert "teeth = 20 " in case_of(model_of(json.dumps({"model": tree}), Path("model.rexs")))


@pytest.mark.parametrize("number", ["1e999", "1.5", '"1_0"', '"\uff11"', "true", "null", "[1]", '"1e3"', "1" * 400])
def test_parts_have_whole_numbers(number):
    parts = '{"version": "1.4", "components": [{"id": ID, "type": "shaft", "attributes": []}], "relations": []}'
    with pytest.raises(InputError, match="component, relation or load case with"):
        model_of('{"model": ' + parts.replace("ID", number) + "}", Path("model.rexs"))


@pytest.mark.parametrize("where", ["name", "type", "value", "unit", "key"])
def test_halves_of_characters_are_refused(where):
    tree = two_stages()
    one = tree["components"][5]
    if where in ("name", "type"):
        one[where] = "a\ud800"
    elif where == "key":
        one["attributes"].append({"id": "\udc00", "unit": "", "value": "1"})
    else:
        one["attributes"][0][where] = "\udfff"
    with pytest.raises(InputError, match="contains an invalid character \\(surrogate\\)"):
        model_of(json.dumps({"model": tree}), Path("model.rexs"))
    one["name"], one["attributes"] = "\U0001d11e", []
    if where not in ("type", "key"):
        model_of(json.dumps({"model": tree}), Path("model.rexs"))  # both halves are a character


def changed(tree, number, **values):
    for one in tree["components"]:
        for attribute in one["attributes"]:
            if one["id"] == number and attribute["id"] in values:
                attribute["float"], attribute["unit"] = values[attribute["id"]]
    return json.dumps({"model": tree})


@pytest.mark.parametrize(
    ("number", "values", "said"),
    [
        (41, {"outer_diameter_begin": (35.0, "m")}, r"outer_diameter_begin = 35 m: of shaft 3 exceeds"),
        (41, {"outer_diameter_begin": (14e30, "mm")}, "exceeds the plausible maximum of 20 m; check the unit"),
        (41, {"length": (120.0, "m")}, "length = 120 m: of shaft 3 exceeds the plausible maximum of 30 m"),
        (41, {"length": (0.0, "mm")}, "length = 0 mm: of a section of shaft 3 must be positive"),
        (41, {"outer_diameter_begin": (0.0, "mm")}, "outer_diameter_begin = 0 mm: of a section of shaft 3 must be"),
        (21, {"center_distance": (0.0, "mm")}, "center_distance = 0 mm: of cylindrical_stage 21 must be positive"),
        (21, {"center_distance": (-81.0, "mm")}, "center_distance = -81 mm: of cylindrical_stage 21 must be positive"),
    ],
)  # fmt: skip
def test_sizes_that_no_gearbox_has_are_refused(number, values, said):
    with pytest.raises(InputError, match=said):
        case_of(model_of(changed(two_stages(), number, **values), Path("model.rexs")))


def test_a_distance_of_zero_is_refused_where_shifts_follow_from_it():
    """It was divided by."""
    tree = two_stages()
    for one in tree["components"]:
        one["attributes"] = [a for a in one["attributes"] if a["id"] != "addendum_modification_coefficient"]
    with pytest.raises(InputError, match="center_distance = 0 mm"):
        case_of(model_of(changed(tree, 22, center_distance=(0.0, "mm")), Path("model.rexs")))


@pytest.mark.parametrize("gear", [11, 15, 120, 121])
def test_a_gear_of_a_set_on_no_shaft_is_refused(gear):
    tree = planetary_set()
    tree["relations"] = [
        one for one in tree["relations"]
        if not (one["type"] == "assembly" and any(ref["id"] == gear and ref["role"] == "part" for ref in one["refs"]))
    ]  # fmt: skip
    with pytest.raises(InputError, match="does not belong to a shaft"):
        case_of(model_of(json.dumps({"model": tree}), Path("model.rexs")))
