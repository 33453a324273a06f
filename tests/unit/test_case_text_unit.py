"""A key changed in the text of a case: the document has it, and nothing else has changed, comments included."""

from __future__ import annotations

import copy
import random
import re
import tomllib
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case import changed_text as case_text
from fegear.case.changed_text import as_typed, literal, value_at, with_value, with_values
from fegear.window.inputs import stepped

CASES = sorted((Path(__file__).parents[2] / "cases").rglob("*.toml"))
HARD = '''# head "quoted" [brackets] = no key
title = """three
lines ""quoted"" [gear.x]""" # behind
results = [ # a list over lines
  "geometry", # with a comment, and a ] in it
  'load-sharing',
]
"odd key" = { a = { b = [1, 2, { c = "}" }, [{ f = 1 }, {}]] }, d.e = 1 }

[gear."a b"]   # a name with a blank
teeth = 28 # z
rack = { addendum = 1.0, tip_radius = 'x\\' } # not an escape

[[lists]]
teeth = 3

[[lists]] # of two
teeth = 4
[[lists.inner]]
x = 1 # mm
[[lists.inner]]
[lists.more]
y = 2

[pair]
I.load = "1 kN"
[pair.J]
'''


def solid(document):
    inside = {key: solid(one) if isinstance(one, dict) else one for key, one in document.items()}
    return {key: one for key, one in inside.items() if one != {}}


def places(document, path=()):
    """Paths of all values that are no tables, those in tables of lists included."""
    for key, one in document.items() if isinstance(document, dict) else enumerate(document):
        here = (*path, str(key))
        tables = isinstance(one, dict) or (isinstance(one, list) and any(isinstance(part, dict) for part in one))
        if isinstance(document, dict) and not tables:
            yield here
        if isinstance(one, (dict, list)):
            yield from places(one, here)


def alike(one, other):
    """How many characters two texts have in common at their beginning."""
    return next((i for i, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))


def changed(document, path, value):
    """The document with another value, by plain dictionaries."""
    made = copy.deepcopy(document)
    inside = made
    for step in path[:-1]:
        inside = inside[int(step)] if isinstance(inside, list) else inside[step]
    inside[path[-1]] = value
    return made


@pytest.mark.parametrize(
    "text", [*(path.read_text("utf-8") for path in CASES), HARD], ids=[*(p.stem for p in CASES), "hard"]
)
def test_every_key_can_be_changed_and_removed_where_it_stands(text):
    document = tomllib.loads(text)
    paths = list(places(document))
    assert paths
    for path in paths if len(paths) < 5 or text == HARD else random.Random(1).sample(paths, 2):  # noqa: S311
        held = value_at(document, path)
        assert with_value(text, path, literal(held)) == text
        new = with_value(text, path, '"new # [x]"')
        assert tomllib.loads(new) == changed(document, path, "new # [x]")
        before = alike(text, new)
        behind = alike(text[before:][::-1], new[before:][::-1])
        assert new[before : len(new) - behind] in '"new # [x]"'  # nothing else is touched
        gone = tomllib.loads(with_value(text, path, None))
        assert value_at(gone, path) is None
        back = tomllib.loads(with_value(with_value(text, path, None), path, literal(held)))
        assert solid(back) == solid(document)


@pytest.mark.parametrize("number", range(6))
def test_a_document_that_is_changed_again_and_again_gives_the_texts_of_one_read_anew_each_time(number):
    rng, changed_last = random.Random(number), 0  # noqa: S311
    text = [HARD, *(path.read_text("utf-8") for path in rng.sample(CASES, 5))][number]
    for _ in range(40):
        path = rng.choice([one for one in places(tomllib.loads(text)) if not any(map(str.isdecimal, one))])
        if rng.random() < 0.15:
            path = (*path[:-1], f"new{rng.randrange(3)}")
        values = [f'"{rng.uniform(0, 30):.2f} um"', "0.25", '{ amount = "3 um" }', "[1, 2]"]
        value = None if rng.random() < 0.1 else rng.choice(values)
        found = {}
        for name in ("again", "anew"):
            if name == "anew":
                last = dict(case_text._last)
                case_text._last.clear()
            try:
                found[name] = with_value(text, path, value)
            except InputError as error:
                found[name] = str(error)
        assert found["again"] == found["anew"]
        case_text._last.clear()
        case_text._last.update(last)
        changed_last += text not in last and found["again"] in last
        text = found["again"] if "\n" in found["again"] else text
    assert changed_last > 15


def test_tables_of_a_list_that_stand_apart_come_together_and_keep_what_they_hold():
    text = "[[a]]\nx = 1 # one\n[[a.b]]\ny = 2 # two\n[a.c]\nz = 3\n[[a.b]]\ny = 4 # four\n"
    made = with_value(text, ("a", "0", "x"), "5")
    assert tomllib.loads(made) == changed(tomllib.loads(text), ("a", "0", "x"), 5)
    assert sorted(re.findall("# \\w+", made)) == ["# four", "# one", "# two"]


def test_several_keys_are_changed_one_after_the_other():
    changes = {("pair", "J", "speed"): '"1 rpm"', ("title",): None, ("lists", "0", "teeth"): "5"}
    one_by_one = HARD
    for path, value in changes.items():
        one_by_one = with_value(one_by_one, path, value)
    assert with_values(HARD, changes) == one_by_one
    assert with_values(HARD, {}) == HARD


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("gear", "a b", "module"), 'module = "3 mm"'),
        (("gear", "a b", "relief", "tip", "amount"), 'relief = {tip = {amount = "3 mm"}}'),
        (("effects", "relief"), '[effects]\nrelief = "3 mm"'),
        (("gear", "new", "teeth"), '[gear.new]\nteeth = "3 mm"'),
        (("pair", "I", "speed"), 'I.speed = "3 mm"'),
        (("pair", "J", "speed"), 'speed = "3 mm"'),
        (("lists", "0", "speed"), 'teeth = 3\nspeed = "3 mm"'),
        (("lists", "1", "inner", "0", "speed"), 'x = 1 # mm\nspeed = "3 mm"'),
        (("lists", "1", "inner", "1", "speed"), '[[lists.inner]]\nspeed = "3 mm"'),
        (("lists", "1", "more", "speed"), 'y = 2\nspeed = "3 mm"'),
    ],
)
def test_a_new_key_stands_in_its_table_and_goes_without_a_trace(path, line):
    made = with_value(HARD, path, '"3 mm"')
    assert line in made
    assert value_at(tomllib.loads(made), path) == "3 mm"
    assert [row for row in HARD.splitlines() if row not in made.splitlines()] == []
    assert solid(tomllib.loads(with_value(made, path, None))) == solid(tomllib.loads(HARD))


def test_a_new_key_stands_in_a_table_of_a_list():
    path = ("odd key", "a", "b", "3", "1", "g")
    made = with_value(HARD, path, "2")
    assert made == HARD.replace("{ f = 1 }, {}", "{ f = 1 }, {g = 2}")
    assert tomllib.loads(with_value(made, path, None)) == tomllib.loads(HARD)


def test_what_cannot_be_changed_by_itself_is_refused():
    with pytest.raises(InputError, match="in the text"):
        with_value(HARD, ("lists", "teeth"), "4")
    with pytest.raises(InputError, match="in the text"):
        with_value(HARD, ("lists", "2", "teeth"), "4")
    with pytest.raises(InputError, match="is not a valid value"):
        with_value(HARD, ("title",), "not toml")


@pytest.mark.parametrize(
    ("typed", "written"),
    [
        ("3", "3"),
        (" 0.25 ", "0.25"),
        (".05", "0.05"),
        ("true", "true"),
        ("[1, 2]", "[1, 2]"),
        ("full", '"full"'),
        ("3, 4", '"3, 4"'),
    ],
)
def test_what_is_typed_is_toml_or_a_text(typed, written):
    assert as_typed(typed) == written


@pytest.mark.parametrize(
    ("text", "steps", "made"),
    [
        ("23", 1, "24"),
        ("0.30", -1, "0.29"),
        ("20 deg", 10, "30 deg"),
        ("-0.1", 1, "0.0"),
        ("1e3 N", 1, "2E+3 N"),
        ("full", 1, None),
    ],
)
def test_arrow_keys_step_by_the_last_digit_and_keep_the_unit(text, steps, made):
    assert stepped(text, steps) == made


def test_a_table_under_heads_of_its_own_goes_with_the_tables_in_it():
    text = '[gear.a]\nteeth = 3 # kept\n\n[gear.a.relief.tip]\namount = "1 um"\n\n[gear.b]\nteeth = 4\n'
    assert with_value(text, ("gear", "a", "relief"), None) == "[gear.a]\nteeth = 3 # kept\n\n[gear.b]\nteeth = 4\n"
    assert with_value(text, ("gear", "a", "relief", "tip", "amount"), None) == with_value(
        text, ("gear", "a", "relief"), None
    )
