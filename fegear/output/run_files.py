"""Write everything that a run makes into one folder."""

from __future__ import annotations

import time
from pathlib import Path

from fegear.engine.run import Results, Watcher
from fegear.output.dataset import write_dataset
from fegear.output.fields import FOLDER, FieldFile, write_field
from fegear.output.figures import Drawing, described, with_fields
from fegear.output.folder import SUMMARY, files_in
from fegear.output.report.run import write_report
from fegear.output.summary import write_summary
from fegear.output.tables import write_table

#: Steps of writing that a watcher sees after those of the plan.
STEPS = 1


def write_results(
    results: Results,
    folder: Path,
    watcher: Watcher,
    *,
    plots: bool = True,
    begun: Drawing | None = None,
    fields: list[FieldFile] | None = None,
) -> list[str]:
    """Write tables, dataset, pictures, report and summary.

    Parameters
    ----------
    results : Results
    folder : Path
        An empty folder.
    watcher : Watcher
    plots : bool
        Whether to draw; without, neither matplotlib nor pyvista is imported.
    begun : Drawing, optional
        Pictures that were begun while the run computed; by default they are begun now.
    fields : list of FieldFile, optional
        Receives what is written for other programs; given, fields are written where nothing is drawn, too.

    Returns
    -------
    list of str
        Remarks of the run and of its drawing.
    """
    started = time.perf_counter()
    count = len(results.plan.steps) + STEPS
    watcher.begin("Tables, figures, report" if plots else "Tables and report", count, count)
    tables = folder / "tables"
    tables.mkdir()
    for table in results.tables:
        write_table(tables, table)
    write_dataset(folder / "results.nc", results)
    if plots and begun is None:
        begun = Drawing(folder / "plots", case=results.scene.name)
        for task, outcome in results.outcomes.items():
            begun.begin(task, outcome)
    drawn, missing = begun.finish(watcher.advance) if begun else (described(results), [])
    if fields is not None and begun is None:
        drawn = [*drawn, *with_fields(results)]
        fields += [file for file in (write_field(one.figure, folder / FOLDER) for one in drawn) if file]
    elif fields is not None and begun is not None:
        fields += begun.fields
    remarks = [*results.remarks, *filter(None, [results.inexact]), *results.cache_remarks, *missing]
    write_report(folder / "report.html", results, drawn, remarks)
    write_summary(folder / SUMMARY, results, remarks, [*files_in(folder), SUMMARY])
    watcher.end(time.perf_counter() - started)
    return remarks
