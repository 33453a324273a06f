"""What a result shows is data (`fegear.engine.sheet`): no function makes columns, values or plain curves by hand.

``by_hand/<room>.txt`` names the functions of a room that still do. After ``special`` stand those that no sheet can say,
each with its reason; the others are to become sheets, and none may be added.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

RESULTS = Path(__file__).resolve().parents[2] / "fegear" / "results"
LISTS = Path(__file__).with_name("by_hand")
MAKES = {"Column", "Value", "Curve", "Bars", "Stems", "Points"}
ROOMS = sorted(path.name for path in RESULTS.iterdir() if (path / "__init__.py").exists())


def made_by_hand(room: Path) -> set[str]:
    """Functions of a room that call what tables, values and plain curves are made of, as ``module.function``."""
    found = set()
    for path in room.glob("*.py"):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            within = [node] if isinstance(node, ast.FunctionDef) else getattr(node, "body", [])
            for function in within:
                calls = (call.func for call in ast.walk(function) if isinstance(call, ast.Call))
                if isinstance(function, ast.FunctionDef) and MAKES & {c.id for c in calls if isinstance(c, ast.Name)}:
                    found.add(f"{path.stem}.{function.name}")
    return found


def listed(room: str) -> dict[str, str]:
    """Functions of a room's list, each with its reason; empty for those that are to become sheets."""
    path = LISTS / f"{room}.txt"
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return {name: reason.strip() for name, _, reason in (line.partition(" special:") for line in lines) if name}


@pytest.mark.parametrize("room", ROOMS)
def test_no_function_makes_what_a_sheet_says(room: str) -> None:
    found, known = made_by_hand(RESULTS / room), listed(room)
    assert found <= known.keys(), f"to be said by a sheet: {sorted(found - known.keys())}"
    assert known.keys() <= found, (
        f"no longer by hand, to be taken off by_hand/{room}.txt: {sorted(known.keys() - found)}"
    )


def test_a_function_by_hand_is_seen(tmp_path: Path) -> None:
    (tmp_path / "one.py").write_text(
        "def f():\n    return Column('x', [1.0])\n\n\nclass A:\n    def g(self):\n        h()\n"
    )
    assert made_by_hand(tmp_path) == {"one.f"}
