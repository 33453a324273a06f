"""``fegear effects``: a case with each effect switched."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.common import INTERRUPTED, CaseFile, Overrides, leave


def effects(
    case: CaseFile,
    overrides: Overrides = None,
    out: Annotated[Path | None, typer.Option("--out", help="Output folder; default results/<case>_effects.")] = None,
    only: Annotated[
        list[str] | None,
        typer.Option("--effect", metavar="NAME", help="An effect to study; default all that influence the results."),
    ] = None,
) -> None:
    """Run a case with each effect switched, one at a time: what it changes, the time it costs, one picture for each."""
    from fegear.output.effects import write_effects
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.studies.effect_study import effect_study
    from fegear.terminal import watcher

    start = time.perf_counter()
    try:
        target = out or default_folder(case.stem, "_effects")
        with whole_or_nothing(target) as scratch:
            with watcher(sys.stderr) as watching:
                watching.begin("Each effect switched", 1, 1)
                scene, switched, fixed = effect_study(
                    case, overrides or (), only or (), lambda _effect, fraction: watching.advance(fraction)
                )
                watching.end(time.perf_counter() - start)
            sentences = write_effects(scene, switched, fixed, scratch)
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    for line in sentences:
        typer.echo(line)
    typer.echo(f"Wrote {target} in {time.perf_counter() - start:.2f} s.")
