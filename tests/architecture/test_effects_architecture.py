"""An effect is one row of `fegear.base.effects`: no other list of effects, and no branch on an effect's name."""

from __future__ import annotations

import ast
import functools
from dataclasses import fields
from pathlib import Path

import pytest

from fegear.base.effects import EFFECTS, GROUPS

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
ROWS = Path("base/effects.py")
#: Names of effects that nothing else in fegear has: keys of gears and pairs, results and columns have the other ones.
OWN = {"corner_contact", "neighbour_coupling", "parametric"}
#: Lists in which keys of gears or templates are called like effects.
OTHERS = {
    Path("case/drafts/text.py"),
    Path("case/drafts/gears_text.py"),
    Path("case/drafts/kinds_text.py"),
}  # placeholders of a template
#: What takes names of effects.
TAKE = {"Need", "is_on", "has_data", "with_effect", "example", "remedy", "remark", "effects", "effect"}


def _names(*nodes: ast.AST) -> list[str]:
    return [node.value for node in nodes if isinstance(node, ast.Constant) and node.value in EFFECTS]


def _elements(node: ast.AST) -> list[ast.AST]:
    match node:
        case ast.Tuple() | ast.List() | ast.Set():
            return list(node.elts)
        case ast.Dict():
            return [key for key in node.keys if key is not None]
    return []


def written(source: str) -> list[str]:
    """Places in a source that list effects by name, branch on one, or hand one over."""
    found = []
    for node in ast.walk(ast.parse(source)):
        what: list[str] = [name for name in _names(node) if name in OWN]
        if len(listed := _names(*_elements(node))) > 1:
            what += listed
        if isinstance(node, ast.Compare) and "effect" in ast.unparse(node.left):
            what += _names(node.left, *node.comparators, *(e for one in node.comparators for e in _elements(one)))
        if isinstance(node, ast.Call):
            called = ast.unparse(node.func).rpartition(".")[2]
            handed = [word.value for word in node.keywords if word.arg in TAKE]
            handed += node.args if called in TAKE else []
            what += _names(*handed, *(e for one in handed for e in _elements(one)))
        found += [f"{node.lineno}: {', '.join(what)}"] if what else []
    return found


@functools.cache
def sources() -> dict[Path, str]:
    return {path.relative_to(HOUSE): path.read_text("utf-8") for path in HOUSE.rglob("*.py")}


def test_an_effect_s_name_is_written_in_its_row_only():
    told = {str(path): found for path, text in sources().items() if path not in {ROWS, *OTHERS}
            if any(name in text for name in EFFECTS) and (found := written(text))}  # fmt: skip
    assert told == {}, (
        "at these lines take the row of fegear.base.effects (RELIEF.name), or a list made of the rows (PLANE_EFFECTS); "
        "where a key of a gear has the name of a new effect, call the effect otherwise"
    )


@pytest.mark.parametrize(
    "line",
    [
        'PLANE = ("relief", "spacing_errors")',
        'OFF = {"contact_loss": 1, "friction": 2}',
        'if effect == "misalignment": pass',
        'known = effect in ("relief",)',
        'Need("friction", "why")',
        'spec.is_on("hertz")',
        'Entry("x", effects=("torque_ripple",))',
        'x = "corner_contact"',
    ],
)
def test_each_kind_of_list_would_be_found(line):
    assert written(line)


def test_a_row_and_its_field_say_the_same():
    for group in GROUPS:
        for one in fields(group):
            row = EFFECTS[one.name]
            assert row.name == one.name
            assert one.default == (row.on if row.usual is None else row.usual)
            assert row.on != row.off
            assert row.plane or row.wide
            assert row.kernels
            assert all(other in EFFECTS for other in row.excludes)
            for words in (row.about, row.without, row.needs):
                assert words
                assert "  " not in words
