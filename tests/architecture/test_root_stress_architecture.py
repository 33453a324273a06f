"""Loads become root stress in one place: an effect on root stress only is a row and what that place does with it."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
#: Where loads on plane teeth are superposed.
PLACE = Path("contact/plane/root_stress.py")
#: What answers for unit loads on one gear, or compares such answers.
UNIT_LOADS = {
    Path("contact/plane/both_flanks.py"),  # arc lengths of a fillet's points, no stress
    Path("contact/wide/rated.py"),
    Path("results/rack/rack_stiffness.py"),
    Path("studies/check.py"),
    Path("studies/cost/answers.py"),
    Path("verify/calculix.py"),
    Path("verify/programs.py"),
}
ROOMS = (Path("atlas"), Path("fem"), Path("formulas"), Path("contact/compared"), Path("results/gear"))
#: Questions about teeth by number, and their fewest arguments.
ASKED = {"root_stress": 4, "root_stress_error": 3, "fillet_stress": 3, "fillet_curve": 2, "largest_root_stress": 2}


def _numbers_a_tooth(call: ast.Call) -> bool:
    """Whether a call asks about teeth by number, as influence functions are asked."""
    return isinstance(call.func, ast.Attribute) and len(call.args) >= ASKED.get(call.func.attr, 99)


def asks(source: str) -> list[int]:
    """Lines of a source that ask for root stress under unit loads."""
    return [
        node.lineno for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call) and _numbers_a_tooth(node)
    ]


def answers(source: str) -> bool:
    """Whether a source is one of such answers: it has a class that answers, too."""
    functions = (node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef))
    return any(function.name == "root_stress_error" for function in functions)


def test_loads_are_superposed_in_one_place():
    found = {}
    for path in HOUSE.rglob("*.py"):
        place, source = path.relative_to(HOUSE), path.read_text("utf-8")
        if place != PLACE and place not in UNIT_LOADS and not any(place.is_relative_to(room) for room in ROOMS):
            if not any(f".{name}(" in source for name in ASKED) or answers(source):
                continue
            if lines := asks(source):
                found[str(place)] = lines
    assert found == {}
    assert asks((HOUSE / PLACE).read_text("utf-8"))


@pytest.mark.parametrize(
    "line", ["row = source.root_stress(-k, 0, radius, 'tension')", "off = a.b.root_stress_error(0, 0, few)",
             "curve = source.fillet_curve(0, side)", "known.fillet_stress(k, side, radius)"],
)  # fmt: skip
def test_each_way_to_ask_would_be_found(line):
    assert asks(line) == [1]
    assert not asks("found = teeth.root_stress(sources)")


@pytest.mark.dear
def test_an_effect_on_root_stress_is_a_row_and_its_place_of_use():
    """Made in a copy of two files and nowhere else: it is a key, is refused, noted, listed, and acts everywhere."""
    done = subprocess.run(
        [sys.executable, str(Path(__file__).with_name("effect_on_roots.py"))],
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
