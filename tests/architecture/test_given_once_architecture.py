"""An input is declared once, by `given` at the spec that takes it: tables of a case take their keys from there."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
MECHANICS = ("base", "geometry", "formulas", "fem", "shafts", "contact", "design", "dynamics")
#: Fewer keys that a table and a spec have in common are taken for chance.
FEW = 4
#: Tables that still write out so many keys of one spec. A table that takes its keys from the spec leaves this list.
STILL_TWICE = {
    "compound.CompoundPart": 4,  # of what a simple set answers, not of a spec
    "flank_design.FlankDesignPart": 4,
    "gear_keys.GearKeys": 4,
    "gear_teeth.TeethPart": 4,
    "gear_tool.CutterPart": 4,
    "helical.MisalignmentPart": 4,
    "operation.ShaftsPart": 4,
    "pair.PairPart": 4,
    "planetary.SetBodiesPart": 4,
    "shaft.RollingElementsPart": 6,
    "shaft.BearingPart": 5,
    "strength.StrengthPart": 5,
    "studies.StudyPart": 4,
    "train.ShaftPart": 5,
    "train.TrainMeshPart": 7,
    "transmissibility.MeshStiffnessPart": 4,
}

#: Name of a key with its default as it is written; "required" without one.
Keys = dict[str, str]


def _default(node: ast.AnnAssign) -> str:
    if node.value is None:
        return "required"
    if isinstance(node.value, ast.Call) and ast.unparse(node.value.func) in ("Field", "field", "given"):
        words = {word.arg: ast.unparse(word.value) for word in node.value.keywords}
        return words.get("default", words.get("default_factory", "required"))
    return ast.unparse(node.value)


def _classes(sources: dict[str, str], mark: str) -> Iterator[tuple[str, ast.ClassDef]]:
    for file, source in sources.items():
        if mark in source:
            stem = Path(file).stem
            yield from ((f"{stem}.{node.name}", node) for node in ast.parse(source).body if hasattr(node, "bases"))


def _keys(node: ast.ClassDef, *, written: bool) -> Keys:
    return {
        line.target.id: _default(line)
        for line in node.body
        if isinstance(line, ast.AnnAssign)
        and isinstance(line.target, ast.Name)
        and (not written or (isinstance(line.value, ast.Call) and ast.unparse(line.value.func) == "Field"))
    }


def written_keys(sources: dict[str, str]) -> dict[str, Keys]:
    """Keys that tables of a case write out, by file and name of the tables."""
    found = {name: _keys(node, written=True) for name, node in _classes(sources, "Field(")}
    return {name: keys for name, keys in found.items() if keys}


def fields_of_specs(sources: dict[str, str]) -> dict[str, Keys]:
    """Fields of dataclasses, by file and name of the classes."""
    return {
        name: _keys(node, written=False)
        for name, node in _classes(sources, "@dataclass")
        if any("dataclass" in ast.unparse(mark) for mark in node.decorator_list)
    }


def declared_twice(tables: dict[str, Keys], specs: dict[str, Keys]) -> dict[str, tuple[str, int]]:
    """Tables that write out keys which one spec has, too: the spec, and how many.

    Their defaults are the same, or None in the table: what a case may leave out follows from something else.
    """
    found = {}
    for table, keys in tables.items():
        shared = {
            name: sum(key in fields and default in ("None", fields[key]) for key, default in keys.items())
            for name, fields in specs.items()
        }
        spec = min(shared, key=lambda name: (-shared[name], name), default="")
        if spec and shared[spec] >= FEW:
            found[table] = (spec, shared[spec])
    return found


def meanings(sources: dict[str, str], call: str, word: str) -> Iterator[str]:
    """Texts that calls of a function give for a meaning, as keyword or second argument."""
    for source in sources.values():
        for node in ast.walk(ast.parse(source)) if f"{call}(" in source else ():
            if isinstance(node, ast.Call) and ast.unparse(node.func) == call:
                texts = [*node.args[1:2], *(key.value for key in node.keywords if key.arg == word)]
                yield from (text.value for text in texts if isinstance(text, ast.Constant))


def _sources(*folders: str) -> dict[str, str]:
    paths = sorted(path for folder in folders for path in (HOUSE / folder).rglob("*.py"))
    return {str(path.relative_to(HOUSE)): path.read_text(encoding="utf-8") for path in paths}


def test_no_table_writes_out_the_keys_of_a_spec():
    """Derive the table (`fegear.case.derived.keys_of`); a table that does so leaves the list."""
    tables, specs = written_keys(_sources("case")), fields_of_specs(_sources(*MECHANICS))
    assert len(tables) > 60
    assert len(specs) > 200
    found = declared_twice(tables, specs)
    assert {table: (spec, count) for table, (spec, count) in found.items() if count > STILL_TWICE.get(table, 0)} == {}
    assert set(STILL_TWICE) <= set(found)


def test_no_key_repeats_the_meaning_that_a_spec_gives():
    given = set(meanings(_sources(*MECHANICS), "given", "meaning"))
    assert len(given) > 30
    repeated = [about for about in meanings(_sources("case"), "Field", "description") if about.startswith(tuple(given))]
    assert repeated == []


def test_what_the_two_tests_look_for_is_found():
    spec = (
        "@dataclass\nclass Section:\n    length: float = given('length', 'Of it.')\n    b: int = 1\n    c: int = 2\n"
        "    d: float = 3.0"
    )
    table = (
        "class SectionPart(Part):\n    length: Length = Field(description='Of it.')\n    b: int = Field(default=1)\n"
        "    c: int = Field(default=%d)\n    d: Number | None = Field(default=None)\n"
    )
    specs = fields_of_specs({"a": spec})
    assert declared_twice(written_keys({"b": table % 2}), specs) == {"b.SectionPart": ("a.Section", 4)}
    assert declared_twice(written_keys({"b": table % 3}), specs) == {}
    assert list(meanings({"a": spec}, "given", "meaning")) == ["Of it."]
    assert list(meanings({"b": table % 2}, "Field", "description")) == ["Of it."]
