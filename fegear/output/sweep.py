"""What a sweep writes: ``tables/sweep.csv`` with a row for each point, ``sweep.nc``, report, pictures, summary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import fegear
from fegear.engine.figure.figure import Figure
from fegear.engine.table import Column, Table
from fegear.output.folder import SUMMARY, files_in
from fegear.output.report.page import write_page
from fegear.output.summary import write_json
from fegear.output.sweep_dataset import write_sweep_dataset
from fegear.output.sweep_page import sweep_page
from fegear.output.tables import write_table
from fegear.studies.sweep import SweepResults
from fegear.studies.swept import axis_head, failures, sweep_figures, swept_values, varying

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.engine.figure.figure import Figure

    Array = NDArray[np.generic]


#: Of more values than this the report alone has pictures.
_MOST_PICTURES = 12


def sweep_table(results: SweepResults) -> Table:
    """One row for each point: where it is, its values with their errors, and why it failed if it did."""
    where = np.unravel_index(np.arange(len(results.points)), [len(axis) for axis in results.axes])
    columns = []
    for axis, index in zip(results.axes, where, strict=True):
        values = np.array(axis.values if axis.numbers is None else axis.numbers)
        if axis.numbers is not None and all(isinstance(value, int) for value in axis.values):
            values = values.astype(int)
        columns.append(Column(axis_head(axis), values[index]))
    for one in swept_values(results):
        columns.append(Column(one.head, one.number))
        if one.error is not None and np.nan_to_num(one.error).any():
            columns.append(Column(one.error_head, one.error))
    columns.append(Column("failure", failures(results)))
    return Table("sweep", tuple(columns), results.title)


def _draw(figures: Sequence[Figure], folder: Path, case: str) -> list[str]:
    """Draw the first figure, value by value, where its values are pictures of their own; a remark where too many."""
    if not figures or not figures[0].views[0].key:
        return []
    from fegear.output.draw_png import draw_pictures

    folder.mkdir()
    views = figures[0].views
    for _ in draw_pictures(replace(figures[0], views=views[:_MOST_PICTURES], case=case), folder):
        pass
    left = len(views) - _MOST_PICTURES
    return [f"Figures show the first {_MOST_PICTURES} values; the report shows all."] if left > 0 else []


def write_sweep(results: SweepResults, folder: Path, *, plots: bool = True) -> list[str]:
    """Write dataset, table, pictures, report and summary.

    Parameters
    ----------
    results : SweepResults
    folder : Path
        An empty folder.
    plots : bool
        Whether to draw; without, matplotlib is not imported.

    Returns
    -------
    list of str
        Sentences that the user should read: grouped failures, and what the points remark.
    """
    (folder / "tables").mkdir()
    table, swept = sweep_table(results), list(swept_values(results))
    write_table(folder / "tables", table)
    write_sweep_dataset(folder / "sweep.nc", results)
    figures = sweep_figures(results, varying(swept))
    drawn = _draw(figures, folder / "plots", results.name) if plots else []
    remarks = [*results.grouped_failures(), *results.remarks(), *drawn]
    write_page(folder / "report.html", sweep_page(results, table, swept, figures, results.remarks()))
    solved, read, spared = results.shapes
    summary = {
        "title": results.title,
        "case": results.name,
        "sweep": {
            "axes": {axis.key: {"values": list(axis.values), "unit": axis.unit} for axis in results.axes},
            "points": len(results.points),
            "failed": len(results.failures),
        },
        "timings": {
            "total": round(results.seconds, 6),
            "points_kept_from_earlier": results.kept,
            "shapes_solved": solved,
            "shapes_from_cache": read,
            "seconds_that_these_took_when_solved": round(spared, 6),
        },
        "remarks": remarks,
        "files": [*files_in(folder), SUMMARY],
        "version": fegear.__version__,
    }
    write_json(folder / SUMMARY, summary)
    return remarks
