"""``fegear schema``: what editors need to complete and check case files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

#: Name by which drafted cases ask for it.
SCHEMA_FILE = "fegear.schema.json"


def schema(
    out: Annotated[Path | None, typer.Option("--out", help=f"File, e.g. {SCHEMA_FILE}; default stdout.")] = None,
) -> None:
    """Print the JSON schema of case files: keys, units, choices.

    Editors that know Taplo (Even Better TOML) use it in files whose first line is: #:schema ./fegear.schema.json
    """
    text = schema_text()
    if out is None:
        typer.echo(text, nl=False)
    else:
        out.write_text(text, "utf-8")
        typer.echo(f"Wrote {out}")


def schema_text() -> str:
    """The schema as JSON."""
    from fegear.case.schema import case_schema
    from fegear.results.catalogue import STAGES

    results = {name: stage.about for stage in STAGES for name in stage.results}
    return json.dumps(case_schema(results), indent=1, ensure_ascii=False) + "\n"
