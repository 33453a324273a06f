"""``fegear run``: compute what a case asks for.

``fegear plan``: what a case would compute, before it does.
"""

from __future__ import annotations

import contextlib
import time
from typing import TYPE_CHECKING, Annotated

import typer

from fegear.base.errors import InputError
from fegear.commands.arguments import (
    AsJson,
    CaseFile,
    NoPlots,
    Out,
    Overrides,
    Plots,
    Quiet,
    Scheduler,
    Wanted,
    changes,
)
from fegear.commands.terminal import INTERRUPTED, Voice, leave

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.case.reading import Scene
    from fegear.engine.plan import Plan
    from fegear.output.fields import FieldFile
    from fegear.output.picture_process import PictureProcess


def run(
    case: CaseFile,
    overrides: Overrides = None,
    wanted: Wanted = None,
    out: Out = None,
    no_plots: NoPlots = False,
    plots: Plots = None,
    scheduler: Scheduler = None,
    cache: Annotated[
        bool,
        typer.Option("--cache", help="Use the disk cache for tooth FE solutions, relief searches and chart points."),
    ] = False,
    fields: Annotated[
        bool,
        typer.Option(
            "--fields",
            help="List the files of displacement and stress fields (VTU), write them with --no-plots as well, and "
            "draw plane gears in 3D if pyvista is installed.",
        ),
    ] = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
    only_needs: Annotated[
        bool, typer.Option("--needs", hidden=True, help="List missing extras without computing.")
    ] = False,
) -> None:
    """Compute what a case asks for and write tables, pictures and a report."""
    if no_plots and plots is not None:
        raise InputError("--plots", plots, "contradicts --no-plots", "remove one of them")
    run_case(
        case, changes(overrides, wanted), out, Voice(quiet, as_json), scheduler=scheduler,
        plots=not no_plots, kind=plots or "png", cache=cache, with_fields=fields, only_needs=only_needs,
    )  # fmt: skip


def run_case(
    case: Path, asked: list[str], out: Path | None, voice: Voice, *, scheduler: str | None = None,
    workers: int | None = None, plots: bool = True, cache: bool = False, with_fields: bool = False,
    only_needs: bool = False, kind: str = "png",
) -> None:  # fmt: skip
    """Compute what a case asks for, write it and say it; what `run` and `size` have in common."""
    from fegear.output.picture_process import PictureProcess

    start = time.perf_counter()
    with contextlib.ExitStack() as early:
        # Before all else: it loads what draws while this process loads what computes.
        process = early.enter_context(PictureProcess()) if plots and not only_needs else None
        _run_case(
            case, asked, out, voice, early, process, start, scheduler=scheduler, workers=workers, cache=cache,
            with_fields=with_fields, only_needs=only_needs, plots=plots, kind=kind,
        )  # fmt: skip


def _run_case(
    case: Path, asked: list[str], out: Path | None, voice: Voice, early: contextlib.ExitStack,
    process: PictureProcess | None, start: float, *, scheduler: str | None, workers: int | None, cache: bool,
    with_fields: bool, only_needs: bool, plots: bool, kind: str,
) -> None:  # fmt: skip
    from fegear.base.solution_cache import SolutionCache, cache_on_disk
    from fegear.case.reading import read_scene
    from fegear.engine.executor import Executor
    from fegear.engine.extras import missing
    from fegear.engine.own_speed import remember
    from fegear.engine.plan import make_plan
    from fegear.engine.plan_in_words import forecast_seconds
    from fegear.engine.run import run_plan
    from fegear.output.figures import Drawing
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.output.report.page import begin_page
    from fegear.output.run_files import STEPS, write_results
    from fegear.output.spoken_values import answer_lines, spoken_tables, spoken_values
    from fegear.output.tables import brief_lines, printed_lines
    from fegear.results.catalogue import STAGES

    try:
        scene = read_scene(case, asked)
        planned = make_plan(scene, STAGES)
        if only_needs:  # for the set-up, which installs what a case needs and no more
            typer.echo(",".join(missing(planned, plots=plots)))
            return
        begin_page()
        target = out or default_folder(scene.name)
        with contextlib.ExitStack() as stack:
            scratch = stack.enter_context(whole_or_nothing(target))
            # Nothing is recalled by default: the seconds of a run are one of its results.
            known = cache_on_disk() if cache else SolutionCache()
            if not voice.quiet:
                _say_draft(scene, planned, voice, kept=cache)
            watching = stack.enter_context(voice.watcher())
            stack.enter_context(early.pop_all())  # it ends before the folder that it draws into is moved
            drawing = (
                Drawing(scratch / "plots", process, scene.name, scene.gears if with_fields else None, kind)
                if process
                else None
            )
            results = run_plan(
                scene, planned, watching, STEPS, cache=known, executor=Executor(scheduler, workers),
                found=drawing.begin if drawing else None,
            )  # fmt: skip
            files: list[FieldFile] | None = [] if with_fields else None
            remarks = write_results(results, scratch, watching, plots=plots, begun=drawing, fields=files)
            remember(results, forecast_seconds(scene, planned))
    except KeyboardInterrupt:  # before typer sees it and ends in words and a code of its own
        leave(INTERRUPTED, 130)
    printed, of_answer = spoken_tables(results)
    for line in printed_lines(printed):
        voice.say(line)
    values, further = spoken_values(results)
    for value in values:
        voice.say(repr(value))
    if further:
        voice.say(f"{further} further value{'s' if further > 1 else ''} in summary.json.")
    for file in files or ():
        voice.say(f"Field {target / str(file)}")
    if with_fields and not files:
        voice.note("No requested result has a field: request root-stress, or stiffness with face_positions.")
    voice.notes(results.notes(remarks), "report.html")
    for line in answer_lines(results.answer):
        voice.say(line)
    for table in of_answer:
        for line in brief_lines(table):
            voice.say(line)
    voice.say(f"Wrote {target} in {time.perf_counter() - start:.2f} s.")
    voice.tell_folder(target)


def _say_draft(scene: Scene, planned: Plan, voice: Voice, *, kept: bool) -> None:
    """Say what a long run of pairs with a width comes to by coupled slices, before its 3D gears are solved."""
    from fegear.base.errors import FegearError
    from fegear.base.solution_cache import SolutionCache
    from fegear.engine.run import run_plan
    from fegear.studies.sliced_draft import draft_of_run

    try:
        draft = draft_of_run(scene, planned)
        if draft is None:
            return
        sentences = run_plan(draft.scene, draft.plan, cache=SolutionCache()).answer.sentences
    except FegearError:  # slices refuse what solids take: there is no draft
        return
    voice.aside("Draft by coupled slices, without estimated errors:")
    for line in "\n".join(sentences).splitlines():  # changes are lines of one sentence
        voice.aside(f"  {line}")
    again = "" if kept else "; --cache keeps the gears for runs with other loads, shafts or bearings"
    voice.aside(f"The result with 3D gears follows, in about {draft.seconds:.2g} s of CPU time{again}.")


def plan(case: CaseFile, overrides: Overrides = None, wanted: Wanted = None, as_json: AsJson = False) -> None:
    """Show what a case would compute and why, with which settings, in about how long, and what it would not."""
    from fegear.case.reading import read_scene
    from fegear.engine.own_speed import own_speed
    from fegear.engine.plan import make_plan
    from fegear.engine.plan_in_words import plan_content, plan_lines
    from fegear.results.catalogue import STAGES

    voice = Voice(as_json=as_json)
    scene = read_scene(case, changes(overrides, wanted))
    planned = make_plan(scene, STAGES)
    speed = own_speed()
    if as_json:
        voice.tell(plan_content(scene, planned, speed))
    else:
        voice.say("\n".join(plan_lines(scene, planned, speed)))
