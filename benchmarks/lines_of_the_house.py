"""Code lines of fegear by room and by kind: what describes and serves, for each line of mechanics.

    python benchmarks/lines_of_the_house.py [FOLDER THAT HOLDS fegear/]

A code line is a physical line that is not blank, no comment and no docstring. Mechanics: geometry, fem, shafts,
contact, design, dynamics, formulas. Kinds: imports; signatures of functions and classes; declared quantities (`shown`,
`shows`); and statements that call a table, a value or a figure, or make a text or a schema. A statement counts as the
first kind that it has; `other` is what is left.
"""

from __future__ import annotations

import ast
import io
import sys
import tokenize
from collections import Counter
from pathlib import Path

#: `base` stands below both; the last line counts it as mechanics too.
MECHANICS = ("geometry", "fem", "shafts", "contact", "design", "dynamics", "formulas")
#: The kinds of a statement by the names that it calls, in the order in which they are tried.
KINDS = {
    "figures": {"Figure", "DeferredFigure", "Panel", "Curve", "Mark", "Points", "HeatMap", "Bars", "Bar", "Axis",
                "Scale", "axis_of", "drawn", "Skin", "Band", "Outline", "Text"},
    "columns": {"Column", "column_of", "columns_of", "error_column", "Table"},
    "values": {"Value", "value_of", "value"},
    "stages": {"Stage", "Task", "Forecast", "Outcome", "citing", "Citation"},
    "schema": {"key", "Field", "given", "rule", "length", "angle", "needs"},
    "errors": {"InputError", "ValueError", "TypeError"},
}  # fmt: skip


def code_lines(source: str) -> set[int]:
    """Numbers of the lines that hold code."""
    lines: set[int] = set()
    skipped = (tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER)
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in skipped:
            lines.update(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            lines -= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return lines


def _called(node: ast.AST) -> set[str]:
    calls = (one.func for one in ast.walk(node) if isinstance(one, ast.Call))
    return {call.id if isinstance(call, ast.Name) else getattr(call, "attr", "") for call in calls}


def kinds_of(source: str) -> Counter[str]:
    """Code lines of a module by kind."""
    lines, found = code_lines(source), Counter[str]()

    def take(kind: str, first: int, last: int) -> None:
        inside = lines & set(range(first, last + 1))
        found[kind] += len(inside)
        lines.difference_update(inside)

    def walk(body: list[ast.stmt]) -> None:
        for node in body:
            first, last = node.lineno, node.end_lineno or node.lineno
            inner = [one for name in ("body", "orelse", "finalbody") for one in getattr(node, name, ())]
            typing_only = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
            if isinstance(node, (ast.Import, ast.ImportFrom)) or typing_only:
                take("imports", first, last)
            elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                walk(node.body)
                take("signatures", min([first, *(d.lineno for d in node.decorator_list)]), node.body[0].lineno)
            elif inner:
                walk(inner)
            else:
                called = _called(node)
                texts = any(isinstance(one, ast.JoinedStr) for one in ast.walk(node))
                if called & {"shown", "shows"}:
                    kind = "declared"
                else:
                    kind = next((k for k, names in KINDS.items() if called & names), "texts" if texts else "other")
                take(kind, first, last)

    walk(ast.parse(source).body)
    found["other"] += len(lines)
    return found


def main() -> None:
    """Print the table of rooms and the ratios."""
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1]) / "fegear"
    rooms: dict[str, Counter[str]] = {}
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).parts[:-1]
        room = "/".join(parts[:2] if parts[:1] == ("results",) else parts[:1]) or "."
        rooms.setdefault(room, Counter()).update(kinds_of(path.read_text("utf-8")) + Counter(files=1))
    kinds = ("imports", "signatures", "declared", *KINDS, "texts", "other")
    print(f"{'room':20}{'files':>7}{'lines':>8}" + "".join(f"{k:>11}" for k in kinds))
    groups = {"mechanics": Counter[str](), "describing": Counter[str]()}
    for room, found in rooms.items():
        groups["mechanics" if room.split("/")[0] in MECHANICS else "describing"].update(found)
    for room, found in (*rooms.items(), *groups.items(), ("all", groups["mechanics"] + groups["describing"])):
        print(f"{room:20}{found['files']:7}{sum(found[k] for k in kinds):8}" + "".join(f"{found[k]:11}" for k in kinds))
    sums = {name: sum(found[k] for k in kinds) for name, found in groups.items()}
    total, imports = sum(sums.values()), sum(found["imports"] for found in groups.values())
    base = sum(rooms["base"][k] for k in kinds)
    print(f"describing for a line of mechanics: {sums['describing'] / sums['mechanics']:.3f} ", end="")
    print(f"({(sums['describing'] - base) / (sums['mechanics'] + base):.3f} with base as mechanics); ", end="")
    print(f"imports: {imports / total:.1%}; all: {total}")


if __name__ == "__main__":
    main()
