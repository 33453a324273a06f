"""No modules import each other in a circle, not even for annotations: each can be read before what builds on it."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping
from pathlib import Path

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
HOLDS = (ast.stmt, ast.excepthandler, ast.match_case)


def name_of(path: Path) -> str:
    parts = path.relative_to(HOUSE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported(source: str, modules: Iterable[str]) -> set[str]:
    """Modules of the house that a source imports, wherever it does: at the top, within a function, for annotations."""
    known, found = set(modules), set()
    todo: list[ast.AST] = [ast.parse(source)]
    while todo:  # an import is a statement: no expression is looked into
        node = todo.pop()
        todo += (one for one in ast.iter_child_nodes(node) if isinstance(one, HOLDS))
        if isinstance(node, ast.ImportFrom) and node.module in known:
            full = {f"{node.module}.{one.name}" for one in node.names}
            found |= (full & known) or {node.module}
        elif isinstance(node, ast.Import):
            found |= {one.name for one in node.names} & known
    return found


def circles(graph: Mapping[str, set[str]]) -> list[list[str]]:
    """Modules that reach each other, those of each circle in order of their names."""
    reach = {name: set(after) for name, after in graph.items()}
    grew = True
    while grew:  # some six rounds: as many as the longest way is deep, in powers of two
        grew = False
        for after in reach.values():
            count = len(after)
            after.update(*[reach[one] for one in after])
            grew |= len(after) > count
    found = {tuple(sorted(one for one in after if name in reach[one])) for name, after in reach.items()} - {()}
    return [list(one) for one in sorted(found)]


def test_no_circle_of_modules():
    """The top of the package is left out: it names what a script needs, and its version is read everywhere."""
    sources = {name_of(path): path.read_text() for path in sorted(HOUSE.rglob("*.py"))}
    del sources["fegear"]
    assert len(sources) > 500
    assert circles({name: imported(source, sources) - {name} for name, source in sources.items()}) == []


def test_circles_are_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}, "e": set()}) == [["a", "b", "c"]]
    assert circles({"a": {"b"}, "b": {"a"}, "c": {"d"}, "d": {"c"}}) == [["a", "b"], ["c", "d"]]
    assert imported("if TYPE_CHECKING:\n    from x.y import Z, w\n", ["x.y", "x.y.w", "x"]) == {"x.y.w"}
    assert imported("def f():\n    from x.y import Z\n    import x\n", ["x.y", "x"]) == {"x.y", "x"}
