"""The JSON schema of case files, by which editors complete keys and check values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.case.model import Case
from fegear.case.part import QUANTITY
from fegear.case.schema_nodes import unit_note
from fegear.units import DIMENSIONS, EVERYDAY

if TYPE_CHECKING:
    from collections.abc import Mapping

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
