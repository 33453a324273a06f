"""Documents with defaults written out: where a case may state one, and what each is in the schema that editors read."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from fegear.case.known_keys import Node, part_models
from fegear.case.model import Case
from fegear.case.schema import case_schema
from fegear.case.schema_nodes import SchemaNodes

if TYPE_CHECKING:
    from pydantic import BaseModel

Place = tuple[str | int, ...]


class Schema:
    """The schema of case files, asked for the table that stands at a place."""

    def __init__(self) -> None:
        plain = case_schema({})
        self._nodes = SchemaNodes(plain)
        self._parts = plain["$defs"]
        self._tables = {  # a table that may be written in another way, too, is one of several
            name: kind["properties"]
            for name, part in self._parts.items() for kind in (part, *part.get("anyOf", ())) if "properties" in kind
        }  # fmt: skip
        self._names = {id(properties): name for name, properties in self._tables.items()}

        self._defaults = {
            f"{self._named(part)}.{key}": (field, part_models(field.annotation))
            for part in _parts() for key, field in part.model_fields.items()
        }  # fmt: skip

    def _named(self, part: type[BaseModel]) -> str:
        long = f"{part.__module__}.{part.__qualname__}".replace(".", "__")
        return long if long in self._parts else part.__name__

    def every(self) -> Iterator[tuple[str, str, Node]]:
        """Part, key and what the schema says, of every key that there is."""
        for key, node in self._nodes.top.items():
            yield "Case", key, node
        for part, properties in self._tables.items():
            for key, node in properties.items():
                yield part, key, node

    def default(self, ident: str, node: Node) -> object:
        """What the pages say is taken where a key is not written, as TOML would hold it; None: nothing is said there.

        A table that is always there is one without keys; a list of quantities has the unit of the schema's example.
        """
        field, tables = self._defaults[ident]
        stated = self._nodes.meant(node).get("default")
        if stated is not None or field.default_factory is None or field.default_factory is dict:
            return stated
        if field.default_factory in tables:
            return {}
        lists = next(kind for kind in self._nodes.kinds(node) if kind.get("type") == "array")
        examples = self._nodes.kinds(lists["items"])[0].get("examples")
        values: list[Any] = field.get_default(call_default_factory=True)
        return [f"0 {examples[0].split(' ', 1)[1]}" if examples and value == 0.0 else value for value in values]

    def entries(self, document: Mapping[str, Any]) -> Iterator[tuple[str, Place, Node, bool]]:
        """Part with key, place and schema of every key that the tables of a document may have; whether they have it."""
        yield from self._of("Case", self._nodes.top, document, ())

    def absent(self, document: Mapping[str, Any]) -> Iterator[tuple[str, Place, Node]]:
        """Those that they do not have."""
        for ident, path, node, given in self.entries(document):
            if not given:
                yield ident, path, node

    def _of(self, part: str, keys: Mapping[str, Node], table: Mapping[str, Any], path: Place) -> Iterator[Any]:
        for key, node in keys.items():
            yield f"{part}.{key}", (*path, key), node, key in table
            if key in table:
                yield from self._inside(node, table[key], (*path, key))

    def _inside(self, node: Node, value: object, path: Place) -> Iterator[Any]:
        each = self._nodes.named(node)
        if each is not None and isinstance(value, dict):
            for name, one in value.items():
                yield from self._inside(each, one, (*path, name))
        elif isinstance(value, dict):
            table = self._nodes.table(node)
            if table is not None:
                name = self._names.get(id(table["properties"]), "?")
                yield from self._of(name, table["properties"], value, path)
        elif isinstance(value, list):
            lists = [kind for kind in self._nodes.kinds(node) if kind.get("type") == "array"]
            for number, one in enumerate(value if lists else ()):
                yield from self._inside(lists[0]["items"], one, (*path, number))


def _parts() -> list[type[BaseModel]]:
    """Every table that a case file may have."""
    left: list[type[BaseModel]] = [Case]
    found: list[type[BaseModel]] = []
    while left:
        part = left.pop()
        if part not in found:
            found.append(part)
            left += [inner for field in part.model_fields.values() for inner in part_models(field.annotation)]
    return found


def written(document: Mapping[str, Any], path: Place, value: object) -> dict[str, Any]:
    """The document with one value more."""
    made: Any = copy.deepcopy(document)
    table = made
    for step in path[:-1]:
        table = table.setdefault(step, {}) if isinstance(step, str) else table[step]
    table[path[-1]] = copy.deepcopy(value)
    return made


def without(document: Mapping[str, Any], path: Place) -> dict[str, Any]:
    """The document with one key less."""
    made: Any = copy.deepcopy(document)
    table = made
    for step in path[:-1]:
        table = table[step]
    del table[path[-1]]
    return made


def places(schema: Schema, document: Mapping[str, Any]) -> list[tuple[str, Place, Node]]:
    """Every key that may be written, with those of tables that are there without being written."""
    found = []
    for ident, path, node in schema.absent(document):
        found.append((ident, path, node))
        if schema.default(ident, node) == {}:
            below = schema.absent(written(document, path, {}))
            found += [one for one in below if one[1][: len(path)] == path]
    return found
