"""A key changed in the text of a case: the document has it, and nothing else has changed, comments included."""

from __future__ import annotations

import random
import tomllib
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.window.case_text import as_typed, literal, statements, value_at, with_value
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
[lists.more]
y = 2
[[lists.inner]]

[pair]
I.load = "1 kN"
[pair.J]
'''


def solid(document):
    inside = {key: solid(one) if isinstance(one, dict) else one for key, one in document.items()}
    return {key: one for key, one in inside.items() if one != {}}


@pytest.mark.parametrize(
    "text", [*(path.read_text("utf-8") for path in CASES), HARD], ids=[*(p.stem for p in CASES), "hard"]
)
def test_every_key_can_be_changed_and_removed_where_it_stands(text):
    document = tomllib.loads(text)
    entries, _ = statements(text)
    keys = [entry for entry in entries if not isinstance(value_at(document, entry.path), dict)]
    assert keys
    for entry in keys if len(keys) < 5 or text == HARD else random.Random(1).sample(keys, 4):  # noqa: S311
        held = value_at(document, entry.path)
        assert tomllib.loads(f"v = {text[entry.start : entry.end]}")["v"] == held
        assert with_value(text, entry.path, literal(held)) == text
        new = with_value(text, entry.path, '"new # [x]"')
        assert new == text[: entry.start] + '"new # [x]"' + text[entry.end :]
        gone = tomllib.loads(with_value(text, entry.path, None))
        assert value_at(gone, entry.path) is None
        back = tomllib.loads(with_value(with_value(text, entry.path, None), entry.path, literal(held)))
        assert solid(back) == solid(document)


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("gear", "a b", "module"), 'module = "3 mm"'),
        (("gear", "a b", "relief", "tip", "amount"), 'relief = { tip = { amount = "3 mm" } }'),
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
    assert made == HARD.replace("{ f = 1 }, {}", "{ f = 1 }, { g = 2 }")
    assert tomllib.loads(with_value(made, path, None)) == tomllib.loads(HARD)


def test_what_cannot_be_changed_by_itself_is_refused():
    with pytest.raises(InputError, match="in the text"):
        with_value(HARD, ("lists", "teeth"), "4")
    with pytest.raises(InputError, match="in the text"):
        with_value(HARD, ("lists", "2", "teeth"), "4")
    with pytest.raises(InputError, match="is no value"):
        with_value(HARD, ("title",), "not toml")


@pytest.mark.parametrize(
    ("typed", "written"),
    [("3", "3"), (" 0.25 ", "0.25"), ("true", "true"), ("[1, 2]", "[1, 2]"), ("full", '"full"'), ("3, 4", '"3, 4"')],
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
