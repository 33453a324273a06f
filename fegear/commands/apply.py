"""``fegear apply``: a designed relief or a lead correction written into a case, or a variant of a sizing as a case."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from fegear.base.errors import PATH, InputError, shown
from fegear.commands.arguments import Quiet
from fegear.commands.terminal import Voice


def apply(
    results: Annotated[Path, typer.Argument(metavar="RESULTS", help="Folder of a run with a design.")],
    case: Annotated[
        Path,
        typer.Option("--case", metavar="CASE", help="Case file (TOML) to be changed; with --variant: to be written."),
    ],
    relief: Annotated[
        str,
        typer.Option(
            "--relief",
            metavar="NAME",
            help='Design of the grinding table, e.g. linear, parabolic, "lead correction"; exact: relief by theory. '
            "Default: the best.",
        ),
    ] = "",
    variant: Annotated[
        int | None,
        typer.Option("--variant", min=0, help="Variant of a sizing to be written as a new case; 0: the best."),
    ] = None,
    fillet: Annotated[
        bool, typer.Option("--fillet", help="Write the fillet of a fillet design, as points of the gear.")
    ] = False,
    pair: Annotated[str, typer.Option("--pair", help="Pair. Default: the only pair with a design.")] = "",
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show the change without writing.")] = False,
    quiet: Quiet = False,
) -> None:
    """Write a designed relief, lead correction or fillet into a case, or a variant of a sizing as a new case.

    Comments, order and form of the rest of a changed case stay.

    For example: fegear apply results/drive --relief linear --case drive.toml
    """
    from fegear.case.text_file import read_file, write_file
    from fegear.output.run_folder import read_side
    from fegear.results.relief.applied_design import applied_design

    voice = Voice(quiet)
    if variant is not None:
        from fegear.results.sizing.applied_variant import text_of_variant

        if os.path.lexists(case):
            raise InputError("--case", shown(str(case), PATH), "already exists", "choose another name for the new case")
        side = read_side(results, "RESULTS")
        text, said = text_of_variant(side.document, side.tables, variant, str(results))
        if not dry_run:
            write_file(case, text.encode(), "--case")
        voice.say(f"{'Would write' if dry_run else 'Wrote'} {said} to {case}.")
        return
    side, file = read_side(results, "RESULTS"), read_file(case, "--case")
    if fillet:
        from fegear.results.relief.applied_fillet import applied_fillet

        found = applied_fillet(file.text, case, side.document, side.tables, str(results), pair)
    else:
        found = applied_design(file.text, case, side.document, side.tables, str(results), relief, pair)
    if not dry_run:
        write_file(case, file.written(found.text), "--case")
    voice.say(f"{'Would write' if dry_run else 'Wrote'} {found.said}")
