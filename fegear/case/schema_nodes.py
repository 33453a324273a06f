"""The schema of case files read by machines: what a key may hold, its default and its help, for form and reference."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from fegear.base.units import DIMENSIONS, EVERYDAY
from fegear.case.known_keys import _MANY, Node, _range, help_of, unit_note
from fegear.case.part import QUANTITY

#: What pydantic writes for limits behind a validator, and what JSON schema calls them.
_LIMITS = {"gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"}


#: A number with a point, and a unit.
_PATTERN = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*([^\s\d.,]|1\s*/\s*[^\s\d]).*$"


def _plain(node: Any) -> Any:
    """Say what quantities look like, give defaults as they are written, leave out null, which TOML does not know."""
    if isinstance(node, list):
        return [_plain(one) for one in node if one != {"type": "null"}]
    if not isinstance(node, dict):
        return node
    made: dict[str, Any] = {_LIMITS.get(str(key), str(key)): _plain(value) for key, value in node.items()}
    default = made.pop("default", None)
    each = node.get("items")
    if isinstance(default, list) and isinstance(each, dict) and QUANTITY in each:
        default = [_written(value, each[QUANTITY]) for value in default]
    for kind in node.get("anyOf", ()):
        if QUANTITY in kind and isinstance(default, float):  # a quantity, or a name
            default = _written(default, kind[QUANTITY])
    if isinstance(made.get("title"), str):
        del made["title"]  # the key once more, with blanks; a table of properties may have one of that name
    if QUANTITY in made:
        dimension = made.pop(QUANTITY)
        made = _told(made, _quantity(dimension))
        default = default if default is None else _written(default, dimension)
    if len(made.get("anyOf", ())) == 1:
        made = _told(made, made.pop("anyOf")[0])
    return made if default is None else {**made, "default": default}


def _told(made: dict[str, Any], kind: dict[str, Any]) -> dict[str, Any]:
    """A key and what it may hold in one: what the key means stands first, units after it."""
    joined = made | kind
    if "description" in made:
        joined["description"] = made["description"] + unit_note(kind)
    return joined


def _quantity(dimension: str) -> dict[str, Any]:
    name, example = dimension.replace("_", " "), DIMENSIONS[dimension].example
    return {
        "type": "string",
        "pattern": _PATTERN,
        "title": (told := f"{name} with its unit: {', '.join(EVERYDAY[dimension])}, ..."),
        "description": told,
        "examples": [example],
    }


def _written(default: float, dimension: str) -> str:
    """A default in the unit of the dimension's example."""
    unit = DIMENSIONS[dimension].example.split(" ", 1)[1].replace(" ", "")
    size = EVERYDAY[dimension].get(unit) or EVERYDAY[dimension][f"1{unit}"]
    return f"{default / size:.6g} {unit}"


@dataclass(frozen=True, slots=True)
class KeyHelp:
    """What is to be known of one key.

    Parameters
    ----------
    key : str
        Dotted, below the table that was asked for.
    help : str
        One sentence, names of keys in backticks.
    value : str
        What may be written.
    default : str
        As TOML writes it; empty where there is none, or it follows from other keys, as the help then says.
    required : bool
    """

    key: str
    help: str
    value: str
    default: str
    required: bool


class SchemaNodes:
    """Looks into the schema of case files.

    Parameters
    ----------
    schema : dict
        From `fegear.case.schema.case_schema`.
    """

    def __init__(self, schema: dict[str, Any]) -> None:
        self._parts = schema["$defs"]
        self.top: dict[str, Node] = schema["properties"]
        self.required: frozenset[str] = frozenset(schema.get("required", ()))

    def meant(self, node: Node) -> Node:
        """The same with its references followed."""
        while "$ref" in node:
            own = {key: value for key, value in node.items() if key != "$ref"}
            node = {**self._parts[str(node["$ref"]).rpartition("/")[2]], **own}
        return node

    def kinds(self, node: Node) -> list[Node]:
        """What a value may be, where it may be several things."""
        node = self.meant(node)
        return [kind for one in node["anyOf"] for kind in self.kinds(one)] if "anyOf" in node else [node]

    def table(self, node: Node) -> Node | None:
        """The table that a value may be."""
        return next((kind for kind in self.kinds(node) if "properties" in kind), None)

    def named(self, node: Node) -> Node | None:
        """What each of several tables is that carry names of the user's choice."""
        each = self.meant(node).get("additionalProperties")
        return each if isinstance(each, dict) else None

    def choices(self, kinds: list[Node]) -> dict[str, str]:
        """Names that may be written, with what each means."""
        found: dict[str, str] = {}
        for kind in kinds:
            found |= dict.fromkeys(map(str, kind.get("enum", ())), "")
            found |= {str(kind["const"]): str(kind.get("description", ""))} if "const" in kind else {}
            if kind.get("type") == "array":
                found |= self.choices(self.kinds(kind["items"]))
        return found

    def hint(self, kind: Node) -> str:
        """What may be typed, in a few words."""
        if "properties" in kind:
            return f"a table of {', '.join(kind['properties'])}"
        if kind.get("type") == "array":
            inside = self.hint(self.kinds(kind["items"])[0])
            return f"a list{f': {inside}' if inside else ''}"
        return ", ".join(filter(None, [str(kind.get("title", "")), *_range(kind)]))

    def keys(self, name: str) -> Iterator[KeyHelp]:
        """Every key of a table at the top of a case, those of tables in it below them; ``""``: what stands outside."""
        if not name:
            for key, node in self.top.items():
                if self.table(node) is None and self.named(node) is None:
                    yield self._told(key, node, required=key in self.required)
            return
        node = self.top[name]
        table = self.table(self.named(node) or node)
        if table is not None:
            yield from self._below(table, "", {})

    def _below(self, table: Node, prefix: str, known: dict[int, str]) -> Iterator[KeyHelp]:
        for key, node in table["properties"].items():
            here = f"{prefix}{key}"
            each = self.named(node)
            inner = self.table(each or node) or self._of_list(node)
            if inner is None:
                yield self._told(here, node, required=key in table.get("required", ()))
                continue
            same = known.setdefault(id(inner["properties"]), here)
            value = "" if same == here else f"as `{same}`"
            yield self._told(here, node, required=key in table.get("required", ()), value=value)
            if same == here:
                yield from self._below(inner, f"{here}.NAME." if each else f"{here}.", known)

    def _of_list(self, node: Node) -> Node | None:
        lists = [kind for kind in self.kinds(node) if kind.get("type") == "array"]
        return self.table(lists[0]["items"]) if lists else None

    def _told(self, key: str, node: Node, *, required: bool, value: str = "") -> KeyHelp:
        meant = self.meant(node)
        default = meant.get("default")
        values = dict.fromkeys(filter(None, map(self._value, self.kinds(node))))
        if self.named(node) is not None:
            values = {"tables by name" if self.table(self.named(node) or {}) else "table by name": None}
        return KeyHelp(
            key, help_of(node), value or ", or ".join(values),
            "" if default in (None, []) else json.dumps(default, ensure_ascii=False), required,
        )  # fmt: skip

    def _value(self, kind: Node) -> str:
        """What may be written, for a table of keys."""
        if "properties" in kind:
            return "table"
        if kind.get("type") == "array":
            inside = self.choices([kind])
            items = list(dict.fromkeys(filter(None, map(self._value, self.kinds(kind["items"])))))
            many = "names of results" if len(inside) > _MANY else " or ".join(items)
            return f"list of {many}" if many != "table" else "list of tables"
        if "enum" in kind or "const" in kind:
            return ", ".join(f"`{json.dumps(one)}`" for one in kind.get("enum", [kind.get("const")]))
        if "title" in kind:
            return ", ".join([str(kind["title"]).partition(" with its unit")[0], *_range(kind)])
        plain = {"boolean": "`true`, `false`", "string": "text", "integer": "", "number": "number"}
        return ", ".join(filter(None, [plain.get(str(kind.get("type")), ""), *_range(kind)]))
