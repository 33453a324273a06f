"""A quantity is declared once, where the mechanics computes it: results take its unit and meaning from there."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
MECHANICS = ("geometry", "formulas", "fem", "shafts", "contact", "design", "dynamics")
#: Rooms whose tables take meanings from the mechanics.
ROOMS = ("gear", "pair", "relief", "helical", "planetary", "shafts", "train", "rating")
#: Shorter clauses are ordinary words, as "base circle" is: several quantities may be called so.
WORDS = 4
SHOWING = ("Column", "Value", "Axis")
#: Columns of one name in several units: another one is either a mistake or needs another name.
TWO_UNITS = {
    "x": {"mm", ""},  # in base pitches where a case has no pair
    "load": {"N", ""},  # over the design load there
    "amount": {"um", ""},  # over Delta in a design chart
    "length": {"mm", ""},  # of contact lines; of tip reliefs over that from tip to HPSTC
    "half_width": {"mm", "um"},  # of a contact that a pressure field shows, and of one along the face
    "te": {"um", "arcsec"},  # along the line of action; of unloaded helical contact, as its sources have it
    "limit": {"um", ""},
    "stress": {"MPa", "MPa.mm/N"},  # under a load, and per line load
    "root_tension": {"MPa", ""},  # and over the mean of the teeth over holes
    "power": {"W", "N^2"},  # of losses, and of a spectrum
}


def _calls(source: str, *names: str) -> list[ast.Call]:
    if not any(name in source for name in names):
        return []
    return [
        node
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in names
    ]


def _text(node: ast.expr) -> str | None:
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def declared_meanings(sources: dict[str, str]) -> dict[str, str]:
    """Meanings of declared quantities, each with the file that declares it."""
    found = {}
    for name, source in sources.items():
        for call in _calls(source, "shown", "shows"):
            meaning = _text(call.args[1]) if len(call.args) > 1 else None
            if meaning and len(meaning.split()) >= WORDS:
                found[meaning] = name
    return found


def written_again(sources: dict[str, str], meanings: dict[str, str]) -> list[str]:
    """Where a declared meaning stands again as a text of a column, a value or an axis."""
    return [
        f"{name}:{argument.lineno} writes {text!r}, which {meanings[text]} declares"
        for name, source in sources.items()
        for call in _calls(source, *SHOWING)
        for argument in (*call.args, *(keyword.value for keyword in call.keywords))
        if (text := _text(argument)) in meanings
    ]


def _columns(source: str) -> Iterator[tuple[str | None, ast.expr | None]]:
    """Name and unit of every column, made by hand or declared as one of a table."""
    for call in _calls(source, "Column"):
        yield _text(call.args[0]), call.args[2] if len(call.args) > 2 else None
    for node in ast.walk(ast.parse(source)) if "table=" in source else ():
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            name, how = node.target.id, [node.value]
        elif isinstance(node, ast.FunctionDef):
            name, how = node.name, list(node.decorator_list)
        else:
            continue
        for call in how:
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in ("shown", "shows"):
                words = {keyword.arg: keyword.value for keyword in call.keywords}
                if "table" in words:
                    yield _text(words["name"]) if "name" in words else name, call.args[0] if call.args else None


def units_of_columns(sources: dict[str, str]) -> dict[str, set[str]]:
    """Units that columns are given in the source, by the names of the columns."""
    found: dict[str, set[str]] = defaultdict(set)
    for source in sources.values():
        for name, given in _columns(source):
            unit = "" if given is None else _text(given)
            if name is not None and unit is not None:
                found[name].add(unit)
    return found


def _sources(*folders: str) -> dict[str, str]:
    paths = sorted(path for folder in folders for path in (HOUSE / folder).rglob("*.py"))
    return {str(path.relative_to(HOUSE)): path.read_text(encoding="utf-8") for path in paths}


def test_a_meaning_that_the_mechanics_declares_stands_in_no_result():
    meanings = declared_meanings(_sources(*MECHANICS))
    assert len(meanings) > 30
    assert not written_again(_sources(*(f"results/{room}" for room in ROOMS)), meanings)


def test_columns_of_one_name_have_one_unit():
    units = units_of_columns(_sources("results"))
    assert len(units) > 50
    several = {name: found for name, found in units.items() if len(found) > 1}
    assert {name: found for name, found in several.items() if not found <= TWO_UNITS.get(name, set())} == {}


def test_what_the_two_tests_look_for_is_found():
    meanings = declared_meanings({"fem/a.py": 'x: Array = shown("mm", "radius of the contact point")'})
    assert meanings == {"radius of the contact point": "fem/a.py"}
    source = 'Column("radius", r, "mm", "radius of the contact point")'
    assert written_again({"results/b.py": source}, meanings)
    assert not written_again({"results/b.py": 'column_of(t, "radius")'}, meanings)
    assert units_of_columns({"a": source, "b": 'Column("radius", r, "um")'}) == {"radius": {"mm", "um"}}
    declared = 'class A:\n    r: Array = shown("um", "", name="radius", table="a")\n    x: Array = shown("mm", "")'
    shows = 'class A:\n    @property\n    @shows("deg", "of it", table="a")\n    def turn(self): ...'
    assert units_of_columns({"a": source, "b": declared, "c": shows}) == {"radius": {"mm", "um"}, "turn": {"deg"}}
