"""The command line: ``fegear run``, ``fegear plan``, ``fegear export``."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

import fegear
from fegear.errors import FegearError

if TYPE_CHECKING:
    from fegear.scene.plan import Plan

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
def run(case: CaseFile, overrides: Overrides = None, out: Out = None, no_plots: NoPlots = False) -> None:
    """Compute what a case asks for and write tables, pictures and a report."""
    from fegear.scene.load import read_scene
    from fegear.scene.plan import make_plan
    from fegear.scene.run import run_plan
    from fegear.scene.stages import STAGES
    from fegear.show.folder import whole_or_nothing
    from fegear.show.write import STEPS, write_results
    from fegear.terminal import watcher

    start = time.perf_counter()
    try:
        scene = read_scene(case, overrides or ())
        planned = make_plan(scene, STAGES)
        target = out or Path("results") / scene.name
        with whole_or_nothing(target) as scratch, watcher(sys.stderr) as watching:
            results = run_plan(scene, planned, watching, following=STEPS)
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
    """Tell what a case would compute and why, and what it would not."""
    from fegear.scene.load import read_scene
    from fegear.scene.plan import make_plan
    from fegear.scene.stages import STAGES

    scene = read_scene(case, overrides or ())
    typer.echo("\n".join(_plan_lines(make_plan(scene, STAGES))))


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
    from fegear.scene.load import read_scene
    from fegear.show.export import export_gears
    from fegear.show.folder import whole_or_nothing

    try:
        scene = read_scene(case, overrides or ())
        target = out or Path("results") / scene.name / "export"
        with whole_or_nothing(target) as scratch:
            written = export_gears(scene, scratch, gear or list(scene.gears), formats)
    except KeyboardInterrupt:
        _leave(_INTERRUPTED, 130)
    for name in written:
        typer.echo(f"Wrote {target / name}")


def _plan_lines(planned: Plan) -> list[str]:
    lines = ["Will compute:"]
    for number, step in enumerate(planned.steps, start=1):
        effects = f"; effects: {', '.join(step.effects)}" if step.effects else ""
        lines.append(f"  {number}. {step.task}: {'; '.join(step.reasons)}{effects}")
    if planned.skipped:
        lines.append("Will not compute:")
        lines += [f"  - {name}: {reason}" for name, reason in planned.skipped]
    if planned.idle_effects:
        lines.append("Effects that are on but that nothing planned uses: " + ", ".join(planned.idle_effects))
    return lines


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
