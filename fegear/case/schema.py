"""The JSON schema of case files, by which editors complete keys and check values.

The schema of case files read by machines: what a key may hold, its default and its help, for form and reference.

What keys a case file knows, table by table.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from fegear.base.units import DIMENSIONS, EVERYDAY
from fegear.case.model import Case
from fegear.case.part import QUANTITY
from fegear.case.renamed import current

Node = Mapping[str, Any]


#: By which a schema of fegear is known.
TITLE = "A case of fegear"


#: A number with a point, and a unit.
_PATTERN = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*([^\s\d.,]|1\s*/\s*[^\s\d]).*$"


def case_schema(results: Mapping[str, str]) -> dict[str, Any]:
    """Make the schema.

    Parameters
    ----------
    results : mapping of str to str
        Names of all results with what each tells.

    Returns
    -------
    dict
        JSON schema, draft 2020-12. What it accepts may still break a rule that holds between keys.
    """
    schema = _plain(Case.model_json_schema(mode="validation"))
    schema["properties"]["results"]["items"] = {
        "anyOf": [{"const": name, "description": about} for name, about in results.items()]
    }
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": TITLE}


#: What pydantic writes for limits behind a validator, and what JSON schema calls them.
_LIMITS = {"gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"}


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


#: A list of more names than these is shown by what they are.
_MANY = 12


def unit_note(node: Node) -> str:
    """What the description of a quantity says at its end of units."""
    return f" ({node['title']})" if "title" in node and "pattern" in node else ""


def _range(kind: Node) -> list[str]:
    words = []
    if "exclusiveMinimum" in kind:
        words.append(f"greater than {kind['exclusiveMinimum']:g}")
    low, high = kind.get("minimum"), kind.get("maximum")
    if low is not None or high is not None:
        words.append(f"{low:g} to {high:g}" if low is not None and high is not None else
                     f"at least {low:g}" if low is not None else f"at most {high:g}")  # fmt: skip
    if kind.get("type") == "integer":
        words.append("a whole number")
    return words


def help_of(node: Node) -> str:
    """What a key means, as a sentence; its units are distinguished from it."""
    text = str(node.get("description", "")).removesuffix(unit_note(node)).strip()
    if not text:
        return ""
    first = text if text[:2].isupper() or not text[0].isalpha() else text[0].upper() + text[1:]
    return first if first.endswith(".") else f"{first}."


def part_models(annotation: object) -> list[type[BaseModel]]:
    """Tables that an annotation allows: ``Part``, ``Part | None``, ``Annotated[Part, ...]``, ``dict[str, Part]``."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) is Annotated:
        return part_models(get_args(annotation)[0])
    if get_origin(annotation) is dict:
        return part_models(get_args(annotation)[1])
    if get_origin(annotation) is list:
        return part_models(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return [model for argument in get_args(annotation) for model in part_models(argument)]
    return []


def keys_at(loc: Sequence[str]) -> list[str]:
    """Return the known keys of the table at `loc`; none where the tables carry names of the user's choice."""
    models: list[type[BaseModel]] = [Case]
    steps = list(loc)
    while steps:
        step = steps.pop(0)
        annotations = [model.model_fields[step].annotation for model in models if step in model.model_fields]
        if any(get_origin(annotation) is dict for annotation in annotations):
            if not steps:
                return []
            steps.pop(0)  # the name that the user gave
        models = [model for annotation in annotations for model in part_models(annotation)] or models
    return sorted({name for model in models for name in model.model_fields})


def places_of(key: str) -> list[str]:
    """Where a case file has a key of this name: ``gear.NAME.face_width``."""
    found: list[str] = []

    def look(model: type[BaseModel], prefix: str, above: tuple[type[BaseModel], ...]) -> None:
        for name, field in model.model_fields.items():
            here = f"{prefix}{name}"
            found.extend([here] if name == key else [])
            named = ".NAME." if get_origin(field.annotation) is dict else "."
            for inner in part_models(field.annotation):
                if inner not in above:
                    look(inner, f"{here}{named}", (*above, inner))

    look(Case, "", (Case,))
    return found


def flat(document: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    """Tables within tables as dotted keys; lists of tables are numbered."""
    found: dict[str, object] = {}
    for key, value in document.items():
        if isinstance(value, Mapping):
            found |= flat(value, f"{prefix}{key}.")
        elif isinstance(value, (list, tuple)) and any(isinstance(one, Mapping) for one in value):
            for number, one in enumerate(value):
                found |= flat(one, f"{prefix}{key}[{number}].") if isinstance(one, Mapping) else {}
        else:
            found[f"{prefix}{key}"] = value
    return found


def meaning_of(document: Mapping[str, object]) -> dict[str, object]:
    """A case by dotted keys in SI, with the defaults of what it does not give; as it is written if it is no case."""
    try:
        return flat(Case.model_validate(current(document)[0]).model_dump())
    except ValidationError:
        return flat(document)
