"""``fegear cost``: what accuracy costs in time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.common import INTERRUPTED, AsJson, CaseFile, NoPlots, Overrides, Quiet, Voice, leave, out_option


def cost(
    case: CaseFile,
    overrides: Overrides = None,
    out: Annotated[Path | None, out_option("Output folder; default results/<case>_cost.")] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="A few configurations instead of all, for a first look.")
    ] = False,
    no_plots: NoPlots = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Show what accuracy costs in time: every closed form, sectors, whole gears from coarse to fine."""
    from fegear.case.reading import read_scene
    from fegear.output.cost import cheapest_lines, write_cost
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.studies.cost import asked, forecast, ladder_of, study_cost

    voice = Voice(quiet, as_json)
    try:
        studied = asked(read_scene(case, overrides or ()))
        target = out or default_folder(case.stem, "_cost")
        ladder = ladder_of(studied, quick=quick)
        quantities = ", ".join(q.name for q in studied.quantities)
        voice.say(f"Cost study: {len(ladder.configurations)} configurations for {quantities}.")
        voice.say(f"Predicted: about {forecast(studied, ladder):.2g} s of one core, measured on a usual machine.")
        with whole_or_nothing(target) as scratch:
            with voice.watcher() as watching:
                results = study_cost(studied, quick=quick, watcher=watching)
            write_cost(results, scratch, plots=not no_plots)
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    for line in cheapest_lines(results):
        voice.say(line)
    for remark in results.remarks:
        voice.note(remark)
    voice.say(f"Wrote {target} in {results.seconds:.1f} s.")
    voice.tell_folder(target)
    if not results.complete:
        leave(f"interrupted; {results.finished} of {results.planned} configurations are in {target}.", 130)
