"""``fegear apply``: a designed relief or a lead correction written into a case."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.common import Quiet, Voice


def apply(
    results: Annotated[Path, typer.Argument(metavar="RESULTS", help="Folder of a run with a design.")],
    case: Annotated[Path, typer.Option("--case", metavar="CASE", help="Case file (TOML) to be changed.")],
    relief: Annotated[
        str,
        typer.Option(
            "--relief",
            metavar="NAME",
            help='Design of the grinding table, e.g. linear, parabolic, "lead correction"; exact: relief by theory. '
            "Default: the best.",
        ),
    ] = "",
    pair: Annotated[str, typer.Option("--pair", help="Pair. Default: the only pair with a design.")] = "",
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show the change without writing.")] = False,
    quiet: Quiet = False,
) -> None:
    """Write a designed relief or lead correction into a case; comments, order and form of the rest stay.

    For example: fegear apply results/drive --relief linear --case drive.toml
    """
    from fegear.case.text_file import read_file, write_file
    from fegear.output.run_folder import read_side
    from fegear.results.relief.applied_design import applied_design

    voice = Voice(quiet)
    side, file = read_side(results, "RESULTS"), read_file(case, "--case")
    found = applied_design(file.text, case, side.document, side.tables, str(results), relief, pair)
    if not dry_run:
        write_file(case, file.written(found.text), "--case")
    voice.say(f"{'Would write' if dry_run else 'Wrote'} {found.said}")
