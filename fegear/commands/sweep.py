"""``fegear sweep``: a case over a grid of values."""

from __future__ import annotations

import contextlib
import math
from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.common import (
    AsJson,
    CaseFile,
    NoPlots,
    Overrides,
    Quiet,
    Scheduler,
    Voice,
    Wanted,
    changes,
    leave,
    out_option,
)


def sweep(
    case: CaseFile,
    over: Annotated[
        list[str],
        typer.Option(
            "--over",
            metavar="KEY=START:STOP:COUNT",
            help="An axis, e.g. gear.a.profile_shift=-0.4:0.8:25, =10:20:6:mm, =1:1000:4:log or =0.1,0.2,0.5.",
        ),
    ],
    overrides: Overrides = None,
    wanted: Wanted = None,
    out: Annotated[Path | None, out_option("Output folder; default results/<case>_sweep.")] = None,
    scheduler: Scheduler = None,
    workers: Annotated[
        int | None, typer.Option("--workers", min=1, help="Processes on this machine; default one for each core.")
    ] = None,
    no_plots: NoPlots = False,
    no_cache: Annotated[
        bool,
        typer.Option("--no-cache", help="Recompute everything and keep nothing: a killed sweep starts again."),
    ] = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Run a case over a grid of values; killed and started again, it resumes where it stopped."""
    from fegear.engine.executor import Executor
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.output.sweep import write_sweep
    from fegear.solution_cache import SolutionCache, cache_on_disk
    from fegear.studies.axis import read_axis
    from fegear.studies.sweep import sweep_case

    voice = Voice(quiet, as_json)
    try:
        axes = [read_axis(text) for text in over]
        target = out or default_folder(case.stem, "_sweep")
        with contextlib.ExitStack() as stack:
            scratch = stack.enter_context(whole_or_nothing(target))
            watching = stack.enter_context(voice.watcher(remaining=True))
            count = math.prod(len(axis) for axis in axes)
            watching.begin(f"{count} points", 1, 1)
            results = sweep_case(
                case,
                axes,
                changes(overrides, wanted),
                cache=SolutionCache() if no_cache else cache_on_disk(),
                executor=Executor(scheduler, workers),
                progress=watching.advance,
            )
            watching.end(results.seconds)
            remarks = write_sweep(results, scratch, plots=not no_plots)
    except KeyboardInterrupt:
        leave("interrupted; started again, the sweep resumes where it stopped.", 130)
    for remark in remarks:
        voice.note(remark)
    solved, read, spared = results.shapes
    voice.say(f"{count - len(results.failures)} of {count} points have results.")
    if results.kept:
        voice.say(f"{results.kept} points were finished by an earlier sweep.")
    if read:
        voice.say(f"Tooth shapes: {solved} solved now; {read} recalled ({spared:.2f} s when solved).")
    voice.say(f"Wrote {target} in {results.seconds:.2f} s.")
    voice.tell_folder(target)
    if len(results.failures) == count:
        raise typer.Exit(1)
