"""Wrong lines: one sign, operator, comparison, index, constant, term or order of arguments of a source file changed.

Text is no subject: docstrings, messages, meanings, annotations and what a `raise` says stay as they are. Numbers below
1e-6 are guards against round-off and stay, too, as does `strict` of `zip`, which only guards.
"""

from __future__ import annotations

import ast
import random
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

#: Rooms whose numbers the rest is about: a line there is drawn twice as often as one of the rooms above.
MECHANICS = ("base", "contact", "design", "dynamics", "fem", "formulas", "geometry", "shafts")
#: Calls that hold text and bounds of inputs, or in which the order of arguments means nothing.
TEXTS = {"shown", "given", "print", "warn", "InputError", "TypeVar", "cast"}
SYMMETRIC = {
    "isinstance",
    "issubclass",
    "max",
    "min",
    "maximum",
    "minimum",
    "hypot",
    "allclose",
    "isclose",
    "gcd",
    "lcm",
}
OPERATORS = {
    ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*"),
    ast.FloorDiv: ("//", "*"), ast.Mod: ("%", "*"), ast.Pow: ("**", "*"), ast.MatMult: ("@", "*"),
}  # fmt: skip
COMPARISONS = {
    ast.Lt: ("<", ">="), ast.LtE: ("<=", ">"), ast.Gt: (">", "<="), ast.GtE: (">=", "<"), ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="), ast.Is: ("is", "is not"), ast.IsNot: ("is not", "is"), ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
}  # fmt: skip
BOUNDARIES = {ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">"}
TWINS = [
    ("sin", "cos"), ("min", "max"), ("minimum", "maximum"), ("argmin", "argmax"), ("floor", "ceil"), ("any", "all"),
    ("nanmin", "nanmax"), ("sinh", "cosh"),
]  # fmt: skip
TWIN = {one: other for pair in TWINS for one, other in (pair, pair[::-1])}


def room_of(path: str) -> str:
    """The package below `fegear`, or the name of a module at its top."""
    return Path(path).parts[1].removesuffix(".py")


@dataclass(frozen=True)
class Mutant:
    """A file with one place changed: bytes `start` to `end` of it are `text`."""

    path: str
    line: int
    start: int
    end: int
    text: str
    kind: str

    @property
    def room(self) -> str:
        """Where the file is."""
        return room_of(self.path)

    def applied(self, source: bytes) -> bytes:
        """The wrong file."""
        return source[: self.start] + self.text.encode() + source[self.end :]

    def shown(self, source: bytes) -> str:
        """What changes: the lines before and after."""
        first, last = source.rfind(b"\n", 0, self.start) + 1, source.find(b"\n", self.end)
        wrong = self.applied(source)
        old, new = source[first:last].decode(), wrong[first : len(wrong) - len(source) + last].decode()
        return f"{self.path}:{self.line} ({self.kind})\n    - {old.strip()}\n    + {new.strip()}"


class _Places:
    """The wrong lines that a module offers."""

    def __init__(self, path: str, source: bytes) -> None:
        self.path, self.source = path, source
        self.starts = [0, *(place + 1 for place, byte in enumerate(source) if byte == 10)]
        self.found: list[Mutant] = []

    def span(self, node: ast.expr) -> tuple[int, int]:
        """First byte of an expression and the one after its last."""
        return self.starts[node.lineno - 1] + node.col_offset, self.starts[node.end_lineno - 1] + node.end_col_offset

    def text(self, node: ast.expr) -> str:
        """An expression as written."""
        start, end = self.span(node)
        return self.source[start:end].decode()

    def offer(self, start: int, end: int, text: str, kind: str) -> None:
        """One change."""
        if self.source[start:end] != text.encode():
            self.found.append(Mutant(self.path, bisect_right(self.starts, start), start, end, text, kind))

    def between(self, left: ast.expr, right: ast.expr, old: str, new: str, kind: str) -> None:
        """Change an operator between two operands: brackets may stand beside it, and comments."""
        start, end = self.span(left)[1], self.span(right)[0]
        gap = self.source[start:end].decode()
        if gap.count(old) == 1 and "#" not in gap:
            at = start + len(gap[: gap.index(old)].encode())
            self.offer(at, at + len(old.encode()), new, kind)

    def visit(self, node: ast.AST, within: str = "") -> None:
        """Walk all but text and types."""
        if isinstance(node, ast.Raise | ast.JoinedStr | ast.Import | ast.ImportFrom | ast.Assert):
            return
        if isinstance(node, ast.Call) and _name(node.func) in TEXTS:
            return
        if isinstance(node, ast.keyword) and node.arg == "strict":
            return
        self.mutate(node, within)
        for name, value in ast.iter_fields(node):
            if name in {"annotation", "returns", "decorator_list", "type_params", "bases", "type_comment"}:
                continue
            inside = "index" if isinstance(node, ast.Subscript) and name == "slice" else ""
            inside = inside or (within if isinstance(node, ast.UnaryOp | ast.Slice | ast.Tuple) else "")
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    self.visit(child, inside)

    def mutate(self, node: ast.AST, within: str) -> None:
        """Offer what a node allows."""
        match node:
            case ast.BinOp() if not _is_text(node.left) and not _is_text(node.right):
                self.mutate_terms(node)
            case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
                self.offer(*self.span(node), f"({self.text(operand)})", "sign")
            case ast.Compare(ops=[_]):
                self.mutate_comparison(node)
            case ast.BoolOp(op=op, values=[first, second, *_]):
                old, new = ("and", "or") if isinstance(op, ast.And) else ("or", "and")
                self.between(first, second, old, new, "operator")
            case ast.Constant():
                self.mutate_constant(node, within)
            case ast.Call(args=[_, *_]):
                self.mutate_call(node)

    def mutate_terms(self, node: ast.BinOp) -> None:
        """Another operator, or one of the terms only."""
        old, new = OPERATORS.get(type(node.op), ("", ""))
        if old:
            self.between(node.left, node.right, old, new, "operator")
        if isinstance(node.op, ast.Add | ast.Sub | ast.Mult | ast.Div | ast.Pow):
            self.offer(*self.span(node), f"({self.text(node.left)})", "term dropped")
        if isinstance(node.op, ast.Add | ast.Mult):
            self.offer(*self.span(node), f"({self.text(node.right)})", "term dropped")

    def mutate_comparison(self, node: ast.Compare) -> None:
        """The opposite; between whole numbers equality counts otherwise, too."""
        sides = node.left, node.comparators[0]
        old, new = COMPARISONS[type(node.ops[0])]
        self.between(*sides, old, new, "comparison")
        if type(node.ops[0]) in BOUNDARIES and any(_counts(one) for one in sides):
            self.between(*sides, old, BOUNDARIES[type(node.ops[0])], "comparison")

    def mutate_constant(self, node: ast.Constant, within: str) -> None:
        """Another truth, the next whole number, or 10 % or all of a number more or less."""
        match node.value:
            case bool() as value:
                self.offer(*self.span(node), str(not value), "constant")
            case int() as value:
                self.offer(*self.span(node), str(value + 1), "index" if within else "constant")
            case float() as value if abs(value) >= 1e-6 or not value:
                for wrong in (1.1 * value, 0.9 * value, 2.0 * value) if value else (1.0,):
                    self.offer(*self.span(node), repr(float(f"{wrong:.12g}")), "constant")

    def mutate_call(self, node: ast.Call) -> None:
        """The twin of a function, or two of its arguments in each other's place."""
        name, end = _name(node.func), self.span(node.func)[1]
        if name in TWIN:
            self.offer(end - len(name), end, TWIN[name], "operator")
        if name in SYMMETRIC:
            return
        for one, other in pairwise(node.args):
            if isinstance(one, _PLAIN) and isinstance(other, _PLAIN):
                swapped = f"{self.text(other)}, {self.text(one)}"
                self.offer(self.span(one)[0], self.span(other)[1], swapped, "arguments swapped")


_PLAIN = ast.Name | ast.Attribute | ast.Subscript


def _name(function: ast.expr) -> str:
    return getattr(function, "attr", "") or getattr(function, "id", "")


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _counts(node: ast.expr) -> bool:
    whole = isinstance(node, ast.Constant) and isinstance(node.value, int)
    return whole or (isinstance(node, ast.Call) and _name(node.func) == "len")


def mutants_of(path: str, source: bytes) -> list[Mutant]:
    """All wrong lines of a module that Python can still compile."""
    places = _Places(path, source)
    places.visit(ast.parse(source))
    return places.found


def draw(root: Path, count: int, seed: int, rooms: tuple[str, ...] = ()) -> Iterator[Mutant]:
    """Draw wrong lines of `fegear`: first a line, then one of its changes; no line twice.

    Parameters
    ----------
    root : Path
        The folder that has `fegear`.
    count, seed : int
        How many, and what decides which.
    rooms : tuple of str
        Only these, all alike; none: all, and the mechanics twice as often.
    """
    lines: dict[tuple[str, int], list[Mutant]] = {}
    for path in sorted((root / "fegear").rglob("*.py")):
        name = path.relative_to(root).as_posix()
        if rooms and room_of(name) not in rooms:
            continue
        for mutant in mutants_of(name, path.read_bytes()):
            lines.setdefault((mutant.path, mutant.line), []).append(mutant)
    chance = random.Random(seed)  # noqa: S311  (nothing secret)
    weights = {place: 2.0 if found[0].room in MECHANICS and not rooms else 1.0 for place, found in lines.items()}
    # The keys of a weighted draw without replacement: the largest u^(1/w) are those drawn.
    ranked = sorted(lines, key=lambda place: chance.random() ** (1.0 / weights[place]), reverse=True)
    for place in ranked[:count]:
        yield chance.choice(lines[place])
