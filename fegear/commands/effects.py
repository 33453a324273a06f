"""``fegear effects``: a case with each effect switched."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.common import (
    INTERRUPTED,
    AsJson,
    CaseFile,
    Overrides,
    Quiet,
    Voice,
    Wanted,
    changes,
    complete_effects,
    leave,
    out_option,
)


def effects(
    case: CaseFile,
    overrides: Overrides = None,
    wanted: Wanted = None,
    out: Annotated[Path | None, out_option("Output folder; default results/<case>_effects.")] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--effect",
            metavar="NAME",
            help="An effect to study; default all that influence the results.",
            autocompletion=complete_effects,
        ),
    ] = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Run a case with each effect switched, one at a time: what it changes, the time it costs, one picture for each."""
    from fegear.output.effects import write_effects
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.studies.effect_study import effect_study

    voice = Voice(quiet, as_json)
    start = time.perf_counter()
    try:
        target = out or default_folder(case.stem, "_effects")
        with whole_or_nothing(target) as scratch:
            with voice.watcher() as watching:
                watching.begin("Each effect switched", 1, 1)
                scene, switched, fixed = effect_study(
                    case, changes(overrides, wanted), only or (), lambda _effect, fraction: watching.advance(fraction)
                )
                watching.end(time.perf_counter() - start)
            sentences = write_effects(scene, switched, fixed, scratch)
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    for line in sentences:
        voice.say(line)
    voice.say(f"Wrote {target} in {time.perf_counter() - start:.2f} s.")
    voice.tell_folder(target)
