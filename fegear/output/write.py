"""Write everything that a run makes into one folder."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from fegear.output.dataset import write_dataset
from fegear.output.figures import described, draw_all
from fegear.output.folder import SUMMARY, files_in
from fegear.output.report import write_report
from fegear.output.summary import write_summary
from fegear.output.tables import write_table

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.engine.run import Results, Watcher

#: Steps of writing that a watcher sees after those of the plan.
STEPS = 1


def write_results(results: Results, folder: Path, watcher: Watcher, *, plots: bool = True) -> list[str]:
    """Write tables, dataset, pictures, report and summary.

    Parameters
    ----------
    results : Results
    folder : Path
        An empty folder.
    watcher : Watcher
    plots : bool
        Whether to draw; without, neither matplotlib nor pyvista is imported.

    Returns
    -------
    list of str
        Remarks of the run and of its drawing.
    """
    started = time.perf_counter()
    count = len(results.plan.steps) + STEPS
    watcher.begin("Tables, pictures, report" if plots else "Tables and report", count, count)
    tables = folder / "tables"
    tables.mkdir()
    for table in results.tables:
        write_table(tables, table)
    write_dataset(folder / "results.nc", results)
    drawn, missing = draw_all(results, folder / "plots", watcher.advance) if plots else (described(results), [])
    remarks = [*results.remarks, *results.cache_remarks, *missing]
    write_report(folder / "report.html", results, drawn, remarks)
    write_summary(folder / SUMMARY, results, remarks, [*files_in(folder), SUMMARY])
    watcher.end(time.perf_counter() - started)
    return remarks
