"""The JSON schema of case files, by which editors complete keys and check values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fegear.case.model import Case
from fegear.case.schema_nodes import _plain

#: By which a schema of fegear is known.
TITLE = "A case of fegear"


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
