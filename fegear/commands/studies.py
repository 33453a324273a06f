"""``fegear cost``: what accuracy costs in time.

``fegear effects``: a case with each effect switched.

``fegear sweep``: a case over a grid of values.

``fegear check``: gears solved a second time, whole and by scikit-fem alone.

``fegear compare``: compare two runs or cases.
"""

from __future__ import annotations

import contextlib
import math
import os
import stat
import time
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fegear.base.errors import PATH, InputError, shown
from fegear.commands.arguments import (
    AsJson,
    CaseFile,
    NoPlots,
    Overrides,
    Quiet,
    Scheduler,
    Wanted,
    changes,
    complete_effects,
    out_option,
)
from fegear.commands.terminal import INTERRUPTED, Voice, leave

if TYPE_CHECKING:
    from fegear.studies.comparison.compare import Side


def cost(
    case: CaseFile,
    overrides: Overrides = None,
    out: Annotated[Path | None, out_option("Output folder. Default: results/<case>_cost.")] = None,
    quick: Annotated[bool, typer.Option("--quick", help="A few configurations only, for a quick overview.")] = False,
    no_plots: NoPlots = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Show what accuracy costs in time: every closed form, sectors, whole gears from coarse to fine."""
    from fegear.case.reading import read_scene
    from fegear.output.cost import cheapest_lines, write_cost
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.studies.cost.asked import asked
    from fegear.studies.cost.study import forecast, ladder_of, study_cost

    voice = Voice(quiet, as_json)
    try:
        scene = read_scene(case, overrides or ())
        if not scene.gears:
            voice.say("Cost study: the case has no gears, so there is no mesh, formula or tolerance to choose.")
            voice.tell({"configurations": 0, "quantities": []})
            return
        studied = asked(scene)
        target = out or default_folder(case.stem, "_cost")
        ladder = ladder_of(studied, quick=quick)
        quantities = ", ".join(q.name for q in studied.quantities)
        voice.say(f"Cost study: {len(ladder.configurations)} configurations for {quantities}.")
        voice.say(f"Estimated CPU time: about {forecast(studied, ladder, quick=quick):.2g} s on a reference machine.")
        with whole_or_nothing(target) as scratch:
            with voice.watcher() as watching:
                results = study_cost(studied, quick=quick, watcher=watching)
            write_cost(results, scratch, plots=not no_plots)
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    for line in cheapest_lines(results):
        voice.say(line)
    if results.solvers:
        voice.say(results.solvers)
    for remark in results.remarks:
        voice.note(remark)
    voice.say(f"Wrote {target} in {results.seconds:.1f} s.")
    voice.tell_folder(target)
    if not results.complete:
        leave(f"interrupted; {results.finished} of {results.planned} configurations are in {target}.", 130)


def effects(
    case: CaseFile,
    overrides: Overrides = None,
    wanted: Wanted = None,
    out: Annotated[Path | None, out_option("Output folder. Default: results/<case>_effects.")] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--effect",
            metavar="NAME",
            help="Effect to study. Default: all that influence the results.",
            autocompletion=complete_effects,
        ),
    ] = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Run a case with each effect switched, one at a time: what it changes, the time it costs, one picture for each."""
    from fegear.output.effects import write_effects
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.studies.effects import effect_study

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


def sweep(
    case: CaseFile,
    over: Annotated[
        list[str],
        typer.Option(
            "--over",
            metavar="KEY=START:STOP:COUNT",
            help="Axis of the grid, e.g. gear.a.profile_shift=-0.4:0.8:25, =10:20:6:mm, =1:1000:4:log or =0.1,0.2,0.5.",
        ),
    ],
    overrides: Overrides = None,
    wanted: Wanted = None,
    out: Annotated[Path | None, out_option("Output folder. Default: results/<case>_sweep.")] = None,
    scheduler: Scheduler = None,
    workers: Annotated[
        int | None, typer.Option("--workers", min=1, help="Number of processes. Default: one per core.")
    ] = None,
    no_plots: NoPlots = False,
    no_cache: Annotated[
        bool,
        typer.Option("--no-cache", help="Do not use the cache; an interrupted sweep cannot be resumed."),
    ] = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Run a case over a grid of values; killed and started again, it resumes where it stopped."""
    from fegear.base.solution_cache import SolutionCache, cache_on_disk
    from fegear.engine.executor import Executor
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.output.sweep import write_sweep
    from fegear.studies.sweep import read_axis, sweep_case
    from fegear.studies.swept import best_lines, swept_values, varying

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
    for line in best_lines(results, varying(list(swept_values(results)))):
        voice.say(line)
    solved, read, spared = results.shapes
    voice.say(f"{count - len(results.failures)} of {count} points computed.")
    if results.kept:
        voice.say(f"{results.kept} points taken from an earlier sweep.")
    if read:
        voice.say(f"Tooth shapes: {solved} solved, {read} from the cache ({spared:.2f} s saved).")
    voice.say(f"Wrote {target} in {results.seconds:.2f} s.")
    voice.tell_folder(target)
    if len(results.failures) == count:
        raise typer.Exit(1)


def check(
    case: CaseFile,
    overrides: Overrides = None,
    positions: Annotated[
        int,
        typer.Option(
            "--positions", min=1, max=1000, help="Number of load positions on the flank, equally spaced in roll angle."
        ),
    ] = 3,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Solve the spur gears of a case whole by scikit-fem alone, and compare what differs with the stated errors.

    Exit code 0: every difference is covered by the stated error; 1: some are not.
    """
    from fegear.case.reading import read_scene
    from fegear.studies.check import OWN_ERROR, check_gear, gears_to_check

    voice = Voice(quiet, as_json)
    scene = read_scene(case, overrides or ())
    names, found = gears_to_check(scene), []
    try:
        with voice.watcher() as watching:
            for number, name in enumerate(names, start=1):
                watching.begin(f"Gear {name}, full gear by scikit-fem", number, len(names))
                found.append(check_gear(scene, name, positions))
                watching.end(found[-1].seconds)
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    for gear in found:
        voice.say(f"Gear {gear.gear}: {gear.unknowns} unknowns by scikit-fem, {gear.seconds:.2g} s.")
        solvers = gear.solvers
        voice.say(
            f"  accuracy.solver: scikit-fem agrees within {solvers.difference:.0e}, CPU time "
            f"{solvers.scikit_fem:.2g} s; nested dissection {solvers.condensed:.2g} s, {solvers.ratio:.1f} times "
            "faster."
        )
        voice.say(f"{'':18}{'radius':>12}{'fegear':>14}{'scikit-fem':>14}{'':10}{'difference':>12}{'stated':>9}")
        for one in gear.compared:
            end = "" if one.covered else "  NOT COVERED"
            voice.say(
                f"{one.quantity:18}{one.radius:9.5g} mm{one.fegear:14.7g}{one.scikit_fem:14.7g} {one.unit:9}"
                f"{one.difference:12.1e}{one.stated_error:9.1e}{end}"
            )
    compared = [one for gear in found for one in gear.compared]
    covered = sum(one.covered for one in compared)
    voice.say(
        f"{covered} of {len(compared)} differences are within the estimated error plus that of the check itself, "
        f"{OWN_ERROR:.0e}."
    )
    gears = {
        gear.gear: {
            "unknowns": gear.unknowns,
            "seconds": gear.seconds,
            "solvers": {**asdict(gear.solvers), "ratio": gear.solvers.ratio},
            "compared": [{**asdict(one), "covered": one.covered} for one in gear.compared],
        }
        for gear in found
    }
    voice.tell({"gears": gears, "compared": len(compared), "covered": covered, "check_error": OWN_ERROR})
    if covered < len(compared):
        raise typer.Exit(1)


Compared = Annotated[Path, typer.Argument(help="Results folder of fegear run, or a case file (will be computed).")]


def compare(
    a: Compared,
    b: Compared,
    overrides: Overrides = None,
    wanted: Wanted = None,
    tolerance: Annotated[
        float, typer.Option("--tolerance", metavar="SHARE", help="Relative changes up to this value are ignored.")
    ] = 1e-9,
    out: Annotated[Path | None, out_option("Output folder. Default: results/<a>_<b>_compare.")] = None,
    no_plots: NoPlots = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Tell two runs or two cases apart: inputs, values, tables, curves over each other.

    Exit code 0: the results are the same; 1: they differ; 2: they cannot be compared.
    """
    from fegear.case.text_file import leads_to
    from fegear.output.comparison import write_comparison
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.studies.comparison import compare as comparison

    if not (math.isfinite(tolerance) and tolerance >= 0.0):
        raise InputError("--tolerance", tolerance, "must be zero or greater", "for example 1e-6")
    voice = Voice(quiet, as_json)
    asked = changes(overrides, wanted)
    if asked and all(leads_to(path, stat.S_ISDIR) for path in (a, b)):
        raise InputError(
            "--set", ", ".join(asked), "applies to case files, but both are folders", "specify a case file"
        )
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
                "--out", shown(str(target), PATH), "is one of the runs to be compared and would be overwritten",
                "choose another folder with --out",
            )  # fmt: skip


def _side(path: Path, asked: list[str], voice: Voice) -> Side:
    """Read a folder, or run a case."""
    from fegear.case.text_file import leads_to
    from fegear.output.run_folder import read_side
    from fegear.studies.comparison.compare import side_of

    if leads_to(path, stat.S_ISDIR):
        return read_side(path, "compare")
    from fegear.case.reading import read_scene
    from fegear.engine.plan import make_plan
    from fegear.engine.run import run_plan
    from fegear.results.catalogue import STAGES

    scene = read_scene(path, asked)
    with voice.watcher() as watching:
        return side_of(run_plan(scene, make_plan(scene, STAGES), watching), str(path))
