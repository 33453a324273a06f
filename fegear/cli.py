"""The command line: ``fegear run``, ``plan``, ``cost``, ``sweep``, ``effects`` and ``export``."""

from __future__ import annotations

import contextlib
import math
import os
import sys
import time
from pathlib import Path
from typing import Annotated, NoReturn

import typer

import fegear
from fegear.errors import FegearError

_INTERRUPTED = "interrupted; results of earlier runs are as they were."

app = typer.Typer(
    help="Finite-element workbench for gear teeth.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

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


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"fegear {fegear.__version__}")
        raise typer.Exit


@app.callback()
def _options(
    _show_version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Options of the program itself."""


@app.command()
def run(
    case: CaseFile,
    overrides: Overrides = None,
    out: Out = None,
    no_plots: NoPlots = False,
    scheduler: Scheduler = None,
    cache: Annotated[
        bool,
        typer.Option(
            "--cache", help="Recall tooth shapes and chart points from the disk cache, and keep new ones there."
        ),
    ] = False,
) -> None:
    """Compute what a case asks for and write tables, pictures and a report."""
    from fegear.case.reading import read_scene
    from fegear.engine.executor import Executor
    from fegear.engine.plan import make_plan
    from fegear.engine.run import run_plan
    from fegear.output.folder import whole_or_nothing
    from fegear.output.write import STEPS, write_results
    from fegear.results.catalogue import STAGES
    from fegear.solution_cache import SolutionCache, cache_on_disk
    from fegear.terminal import watcher

    start = time.perf_counter()
    try:
        scene = read_scene(case, overrides or ())
        planned = make_plan(scene, STAGES)
        target = out or Path("results") / scene.name
        with contextlib.ExitStack() as stack:
            scratch = stack.enter_context(whole_or_nothing(target))
            watching = stack.enter_context(watcher(sys.stderr))
            # Nothing is recalled by default: the seconds of a run are one of its results.
            known = cache_on_disk() if cache else SolutionCache()
            results = run_plan(scene, planned, watching, STEPS, cache=known, executor=Executor(scheduler))
            remarks = write_results(results, scratch, watching, plots=not no_plots)
    except KeyboardInterrupt:  # before typer sees it and ends in words and a code of its own
        _leave(_INTERRUPTED, 130)
    for value in results.values:
        error = f" +- {value.shown_error:.2g}" if value.shown_error else ""
        typer.echo(f"{value.name} = {value.shown:.9g}{error} {value.unit}".rstrip())
    for remark in remarks:
        typer.echo(f"Note: {remark}")
    typer.echo(f"Wrote {target} in {time.perf_counter() - start:.2f} s.")


@app.command()
def plan(case: CaseFile, overrides: Overrides = None) -> None:
    """Show what a case would compute and why, with which settings, in about how long, and what it would not."""
    from fegear.case.reading import read_scene
    from fegear.engine.plan import make_plan
    from fegear.engine.plan_text import plan_lines
    from fegear.results.catalogue import STAGES

    scene = read_scene(case, overrides or ())
    typer.echo("\n".join(plan_lines(scene, make_plan(scene, STAGES))))


@app.command()
def cost(
    case: CaseFile,
    overrides: Overrides = None,
    out: Annotated[Path | None, typer.Option("--out", help="Output folder; default results/<case>-cost.")] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="A few configurations instead of all, for a first look.")
    ] = False,
    no_plots: NoPlots = False,
) -> None:
    """Show what accuracy costs in time: every closed form, sectors, whole gears from coarse to fine."""
    from fegear.case.reading import read_scene
    from fegear.output.cost import cheapest_lines, write_cost
    from fegear.output.folder import check_target, whole_or_nothing
    from fegear.studies.cost import asked, forecast, ladder_of, study_cost
    from fegear.terminal import watcher

    try:
        studied = asked(read_scene(case, overrides or ()))
        target = out or Path("results") / f"{case.stem}-cost"
        check_target(target)
        ladder = ladder_of(studied, quick=quick)
        quantities = ", ".join(q.name for q in studied.quantities)
        typer.echo(f"Cost study: {len(ladder.configurations)} configurations for {quantities}.")
        typer.echo(f"Predicted: about {forecast(studied, ladder):.2g} s of one core, measured on a usual machine.")
        with watcher(sys.stderr) as watching:
            results = study_cost(studied, quick=quick, watcher=watching)
        with whole_or_nothing(target) as scratch:
            write_cost(results, scratch, plots=not no_plots)
    except KeyboardInterrupt:
        _leave(_INTERRUPTED, 130)
    typer.echo("\n".join(cheapest_lines(results)))
    for remark in results.remarks:
        typer.echo(f"Note: {remark}")
    typer.echo(f"Wrote {target} in {results.seconds:.1f} s.")
    if not results.complete:
        _leave(f"interrupted; {results.finished} of {results.planned} configurations are in {target}.", 130)


@app.command()
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
    out: Annotated[Path | None, typer.Option("--out", help="Output folder; default results/<case>_sweep.")] = None,
    scheduler: Scheduler = None,
    workers: Annotated[
        int | None, typer.Option("--workers", min=1, help="Processes on this machine; default one for each core.")
    ] = None,
    no_plots: NoPlots = False,
    no_cache: Annotated[
        bool,
        typer.Option("--no-cache", help="Recompute everything and keep nothing: a killed sweep starts again."),
    ] = False,
) -> None:
    """Run a case over a grid of values; killed and started again, it resumes where it stopped."""
    from fegear.engine.executor import Executor
    from fegear.output.folder import check_target, whole_or_nothing
    from fegear.output.sweep import write_sweep
    from fegear.solution_cache import SolutionCache, cache_on_disk
    from fegear.studies.axis import read_axis
    from fegear.studies.sweep import sweep_case
    from fegear.terminal import watcher

    try:
        axes = [read_axis(text) for text in over]
        target = out or Path("results") / f"{case.stem}_sweep"
        check_target(target)
        with contextlib.ExitStack() as stack:
            watching = stack.enter_context(watcher(sys.stderr, remaining=True))
            count = math.prod(len(axis) for axis in axes)
            watching.begin(f"{count} points", 1, 1)
            results = sweep_case(
                case,
                axes,
                overrides or (),
                cache=SolutionCache() if no_cache else cache_on_disk(),
                executor=Executor(scheduler, workers),
                progress=watching.advance,
            )
            watching.end(results.seconds)
        with whole_or_nothing(target) as scratch:
            remarks = write_sweep(results, scratch, plots=not no_plots)
    except KeyboardInterrupt:
        _leave("interrupted; started again, the sweep resumes where it stopped.", 130)
    for remark in remarks:
        typer.echo(f"Note: {remark}")
    solved, read, spared = results.shapes
    typer.echo(f"{count - len(results.failures)} of {count} points have results.")
    if results.kept:
        typer.echo(f"{results.kept} points were finished by an earlier sweep.")
    if read:
        typer.echo(f"Tooth shapes: {solved} solved now; {read} recalled ({spared:.2f} s when solved).")
    typer.echo(f"Wrote {target} in {results.seconds:.2f} s.")
    if len(results.failures) == count:
        raise typer.Exit(1)


@app.command()
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
    from fegear.output.folder import check_target, whole_or_nothing
    from fegear.studies.effect_study import effect_study
    from fegear.terminal import watcher

    start = time.perf_counter()
    try:
        target = out or Path("results") / f"{case.stem}_effects"
        check_target(target)
        with watcher(sys.stderr) as watching:
            watching.begin("Each effect switched", 1, 1)
            scene, switched, fixed = effect_study(
                case, overrides or (), only or (), lambda _effect, fraction: watching.advance(fraction)
            )
            watching.end(time.perf_counter() - start)
        with whole_or_nothing(target) as scratch:
            sentences = write_effects(scene, switched, fixed, scratch)
    except KeyboardInterrupt:
        _leave(_INTERRUPTED, 130)
    for line in sentences:
        typer.echo(line)
    typer.echo(f"Wrote {target} in {time.perf_counter() - start:.2f} s.")


@app.command()
def export(
    case: CaseFile,
    overrides: Overrides = None,
    gear: Annotated[list[str] | None, typer.Option("--gear", help="Name of a gear; default all of them.")] = None,
    formats: Annotated[
        str, typer.Option("--format", help="Any of dxf, msh, vtu, inp, separated by commas.")
    ] = "dxf,msh,vtu,inp",
    out: Out = None,
) -> None:
    """Write drawings (DXF) and meshes of the whole gear (gmsh, VTU, Abaqus/CalculiX) for other programs."""
    from fegear.case.reading import read_scene
    from fegear.output.export import export_gears
    from fegear.output.folder import whole_or_nothing

    try:
        scene = read_scene(case, overrides or ())
        target = out or Path("results") / scene.name / "export"
        with whole_or_nothing(target) as scratch:
            written = export_gears(scene, scratch, gear or list(scene.gears), formats)
    except KeyboardInterrupt:
        _leave(_INTERRUPTED, 130)
    for name in written:
        typer.echo(f"Wrote {target / name}")


def main() -> None:
    """Entry point: every foreseen error is one line on stderr and exit code 2; Ctrl-C is 130."""
    # The dense blocks of a sector are too small for threads: two take twice the work of one for no gain in time, and
    # on a busy machine they wait for each other. Set before numpy is loaded; a user's own choice stands.
    for library in ("OMP", "OPENBLAS", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    try:
        app()
    except KeyboardInterrupt:
        _leave(_INTERRUPTED, 130)
    except FegearError as error:
        _leave(str(error), 2)


def _leave(message: str, code: int) -> NoReturn:
    sys.stderr.write(f"fegear: {message}\n")
    raise SystemExit(code)
