"""``fegear schema``: what editors need to complete and check case files."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.common import out_option
from fegear.errors import PATH, InputError, shown

#: Name by which drafted cases ask for it.
SCHEMA_FILE = "fegear.schema.json"


def schema(
    out: Annotated[Path | None, out_option(f"File, e.g. {SCHEMA_FILE}; default stdout.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file of that name, whatever is in it.")] = False,
) -> None:
    """Print the JSON schema of case files: keys, units, choices.

    Editors that know Taplo (Even Better TOML) use it in files whose first line is: #:schema ./fegear.schema.json
    """
    if out is None:
        typer.echo(schema_text(), nl=False)
    else:
        write_schema(out, "--out", force=force)
        typer.echo(f"Wrote {out}")


def write_schema(
    path: Path, key: str, *, force: bool = False, remedy: str = "choose another name, or replace it with --force"
) -> None:
    """Write the schema; a file in its place is replaced if it is an earlier schema.

    Parameters
    ----------
    path : Path
    key : str
        Where it is named, for messages.
    force : bool
        Whether any file is replaced.
    remedy : str
        What to do where another file stands there.

    Raises
    ------
    InputError
        If it cannot be written, or something else stands there.
    """
    from fegear.case.text_file import read_text, write_file

    there = os.path.isfile(path)  # noqa: PTH113  (the method of Path raises where a name is too long)
    if there and not force and not _is_schema(read_text(path, key)):
        raise InputError(
            key, shown(str(path), PATH), "is there already and is no schema of fegear",
            remedy,
        )  # fmt: skip
    write_file(path, schema_text().encode(), key)


def _is_schema(text: str) -> bool:
    """Whether a text is a schema that fegear wrote, of whatever version."""
    from fegear.case.schema import TITLE

    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        return False
    return isinstance(found, dict) and found.get("title") == TITLE


def schema_text() -> str:
    """The schema as JSON."""
    from fegear.case.schema import case_schema
    from fegear.results.catalogue import STAGES

    results = {name: entry.about for entry in STAGES.entries for name in entry.results}
    return json.dumps(case_schema(results), indent=1, ensure_ascii=False) + "\n"
