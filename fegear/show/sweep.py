"""What a sweep leaves behind: ``tables/sweep.csv`` with one row for each point, ``sweep.nc`` and ``summary.json``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import fegear
from fegear.scene.outcome import Column, Table
from fegear.show.folder import SUMMARY, files_in
from fegear.show.summary import write_json
from fegear.show.sweep_dataset import failures, swept_values, write_sweep_dataset
from fegear.show.tables import write_table

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.scene.sweep import SweepResults


def sweep_table(results: SweepResults) -> Table:
    """One row for each point: where it is, its values with their errors, and why it failed if it did."""
    where = np.unravel_index(np.arange(len(results.points)), [len(axis) for axis in results.axes])
    columns = []
    for axis, index in zip(results.axes, where, strict=True):
        told = np.array(axis.values if axis.numbers is None else axis.numbers)
        if axis.numbers is not None and all(isinstance(value, int) for value in axis.values):
            told = told.astype(int)
        columns.append(Column(f"{axis.key} [{axis.unit}]" if axis.unit else axis.key, told[index]))
    for name, unit, _, number, error in swept_values(results):
        head = f" [{unit}]" if unit else ""
        columns.append(Column(name + head, number))
        if error is not None and error.any():
            columns.append(Column(f"{name}_error{head}", error))
    columns.append(Column("failure", failures(results)))
    return Table("sweep", tuple(columns), results.title)


def write_sweep(results: SweepResults, folder: Path) -> list[str]:
    """Write dataset, table and summary.

    Parameters
    ----------
    results : SweepResults
    folder : Path
        An empty folder.

    Returns
    -------
    list of str
        Sentences that the user should read: grouped failures, and what the points remark.
    """
    (folder / "tables").mkdir()
    write_table(folder / "tables", sweep_table(results))
    write_sweep_dataset(folder / "sweep.nc", results)
    remarks = [*results.grouped_failures(), *results.remarks()]
    solved, read, spared = results.shapes
    told = {
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
    write_json(folder / SUMMARY, told)
    return remarks
