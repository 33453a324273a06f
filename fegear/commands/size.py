"""``fegear size``: from a requirement to the teeth of a pair."""

from __future__ import annotations

from typing import Annotated

import typer

from fegear.commands.arguments import AsJson, CaseFile, NoPlots, Out, Overrides, Quiet, Scheduler, changes
from fegear.commands.run import run_case
from fegear.commands.terminal import Voice


def size(
    case: CaseFile,
    overrides: Overrides = None,
    out: Out = None,
    scheduler: Scheduler = None,
    workers: Annotated[
        int | None, typer.Option("--workers", min=1, help="Number of processes. Default: one per core.")
    ] = None,
    no_plots: NoPlots = False,
    no_cache: Annotated[
        bool, typer.Option("--no-cache", help="Do not use the cache; an interrupted sizing cannot be resumed.")
    ] = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Choose the teeth of a pair for the requirement in [sizing]; started again, it resumes where it stopped."""
    run_case(
        case, changes(overrides, "sizing"), out, Voice(quiet, as_json), scheduler=scheduler, workers=workers,
        plots=not no_plots, cache=not no_cache,
    )  # fmt: skip
