"""``fegear compare``: two runs held against each other."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fegear.commands.common import (
    INTERRUPTED,
    AsJson,
    NoPlots,
    Overrides,
    Quiet,
    Voice,
    Wanted,
    changes,
    leave,
    out_option,
)
from fegear.errors import PATH, InputError, shown

if TYPE_CHECKING:
    from fegear.studies.comparison import Side

Compared = Annotated[Path, typer.Argument(help="A folder that fegear run wrote, or a case file, which is run.")]


def compare(
    a: Compared,
    b: Compared,
    overrides: Overrides = None,
    wanted: Wanted = None,
    tolerance: Annotated[
        float, typer.Option("--tolerance", metavar="SHARE", help="Changes up to this share of a value are none.")
    ] = 1e-9,
    out: Annotated[Path | None, out_option("Output folder; default results/<a>_<b>_compare.")] = None,
    no_plots: NoPlots = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Tell two runs or two cases apart: inputs, values, tables, curves over each other.

    Exit code 0: the results are the same; 1: they differ; 2: they cannot be compared.
    """
    from fegear.output.comparison import write_comparison
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.studies import comparison

    if not (math.isfinite(tolerance) and tolerance >= 0.0):
        raise InputError("--tolerance", tolerance, "must be zero or greater", "write for example 1e-6")
    voice = Voice(quiet, as_json)
    asked = changes(overrides, wanted)
    if asked and a.is_dir() and b.is_dir():
        raise InputError("--set", ", ".join(asked), "changes cases, and both are folders", "give a case file")
    try:
        target = out or default_folder(f"{a.resolve().stem}_{b.resolve().stem}", "_compare")
        _refuse_to_replace(target, a, b)
        with whole_or_nothing(target) as scratch:
            found = comparison.compare(_side(a, asked, voice), _side(b, asked, voice), tolerance)
            write_comparison(found, scratch, plots=not no_plots)
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    for line in found.lines():
        voice.say(line)
    voice.say(f"Wrote {target}")
    voice.tell_folder(target)
    if found.results_differ:
        raise typer.Exit(1)


def _refuse_to_replace(target: Path, *compared: Path) -> None:
    """Refuse to write a comparison over a run that it compares."""
    for path in compared:
        if os.path.realpath(target) == os.path.realpath(path):
            raise InputError(
                "--out", shown(str(target), PATH), "is one of the runs that are compared, which it would replace",
                "choose another folder with --out",
            )  # fmt: skip


def _side(path: Path, asked: list[str], voice: Voice) -> Side:
    """Read a folder, or run a case."""
    from fegear.output.comparison import read_side
    from fegear.studies.comparison import side_of

    if path.is_dir():
        return read_side(path)
    from fegear.case.reading import read_scene
    from fegear.engine.plan import make_plan
    from fegear.engine.run import run_plan
    from fegear.results.catalogue import STAGES

    scene = read_scene(path, asked)
    with voice.watcher() as watching:
        return side_of(run_plan(scene, make_plan(scene, STAGES), watching), str(path))
