"""The import graph of fegear as the source states it, function-level imports included."""

from __future__ import annotations

import ast
import functools
import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Import:
    """One import statement: who imports what, where, and whether only type checkers see it."""

    importer: str
    imported: str
    line: int
    typing_only: bool

    def __str__(self) -> str:
        return f"{self.importer}:{self.line} imports {self.imported}"


def modules(root: Path = ROOT, package: str = "fegear") -> dict[str, Path]:
    """Every module of the package by dotted name."""
    found = {}
    for path in sorted((root / package).rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(name: str, source: str, known: set[str], *, is_package: bool) -> list[Import]:
    """All imports of one module, wherever they stand, resolved to absolute module names."""
    found: list[Import] = []

    def resolve(node: ast.ImportFrom) -> str:
        if node.level == 0:
            return node.module or ""
        base = name.split(".")
        base = base[: len(base) - node.level + (1 if is_package else 0)]
        return ".".join(base + ([node.module] if node.module else []))

    def walk(node: ast.AST, typing_only: bool) -> None:
        for child in parts(node):
            inside = typing_only or (isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test))
            if isinstance(child, ast.Import):
                found.extend(Import(name, alias.name, child.lineno, typing_only) for alias in child.names)
            elif isinstance(child, ast.ImportFrom):
                module = resolve(child)
                for alias in child.names:
                    full = f"{module}.{alias.name}"
                    found.append(Import(name, full if full in known else module, child.lineno, typing_only))
            elif isinstance(child, ast.Call) and _imports(child.func):
                target = child.args[0]
                text = target.value if isinstance(target, ast.Constant) else ast.unparse(target)
                found.append(Import(name, str(text), child.lineno, typing_only))
            walk(child, inside)

    # an expression imports nothing but by these two
    parts = ast.iter_child_nodes if re.search(r"import_module|__import__", source) else _statements
    walk(ast.parse(source), typing_only=False)
    return found


def _statements(node: ast.AST) -> list[ast.AST]:
    """The statements within one, and what holds others: handlers and cases."""
    return [
        part for part in ast.iter_child_nodes(node) if isinstance(part, (ast.stmt, ast.excepthandler, ast.match_case))
    ]


def _imports(called: ast.expr) -> bool:
    """Whether a function that is called is `importlib.import_module` or `__import__`."""
    name = called.id if isinstance(called, ast.Name) else getattr(called, "attr", "")
    return name in ("import_module", "__import__") and ast.unparse(called) in ("importlib.import_module", "__import__")


@functools.cache
def all_imports() -> list[Import]:
    """Every import in the package."""
    files = modules()
    known = set(files)
    found: list[Import] = []
    for name, path in files.items():
        found += imports_of(name, path.read_text(encoding="utf-8"), known, is_package=path.name == "__init__.py")
    return found
