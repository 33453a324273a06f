"""What the commands share: arguments that mean the same everywhere, and how a command is left early."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, NoReturn

import typer

from fegear.streams import complain

INTERRUPTED = "interrupted; results of earlier runs are as they were."

CaseFile = Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML).")]
Overrides = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change a key of the case, e.g. --set gear.a.teeth=30."),
]
Out = Annotated[Path | None, typer.Option("--out", help="Output folder; default results/<case>.")]
NoPlots = Annotated[bool, typer.Option("--no-plots", help="Draw nothing: tables, dataset and report alone.")]
Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="ADDRESS", help="A running Dask scheduler, e.g. tcp://10.0.0.5:8786."),
]


def leave(message: str, code: int) -> NoReturn:
    """End the program with a sentence on stderr and an exit code."""
    complain(f"fegear: {message}")
    raise SystemExit(code)
