"""What a sweep writes: ``tables/sweep.csv`` with a row for each point, ``sweep.nc``, report, pictures, summary.

``sweep.nc``: every value and table of a sweep over its axes, for ``xarray.open_dataset``.

The axes are dimensions and coordinates; a value is a variable over them, a table's column one over them and the table's
rows (dimension ``<table>.row``). Where a point failed, numbers are NaN and the variable ``failure`` holds the reason.

The page of a sweep: every value over the axes, the table, and the failures with their reasons.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import fegear
from fegear.engine.figure.figure import Figure
from fegear.engine.table import Column, Table
from fegear.output.dataset import head, plain, plain_of, put, say_names
from fegear.output.folder import SUMMARY, files_in
from fegear.output.numbers import plain_number, pretty_unit
from fegear.output.report.blocks import DataTable, Facts, Grid, Notes, Paragraph, Plot
from fegear.output.report.page import Page, Section, write_page
from fegear.output.tables import write_json, write_table
from fegear.studies.sweep import Point, SweepResults
from fegear.studies.swept import Swept, axis_head, failures, shared_clauses, sweep_figures, swept_values, varying

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray
    from scipy.io import netcdf_file

    from fegear.engine.figure.figure import Figure

    Array = NDArray[np.generic]


def _title(one: Swept) -> str:
    return f"{one.name} [{pretty_unit(one.unit)}]" if one.unit else one.name


def sweep_page(
    results: SweepResults, table: Table, swept: Sequence[Swept], figures: Sequence[Figure], remarks: Sequence[str]
) -> Page:
    """Put the page of a sweep together; equal results give equal pages, so it shows no seconds.

    Parameters
    ----------
    results : SweepResults
    table : Table
        What ``tables/sweep.csv`` holds.
    swept : sequence of Swept
        Its values.
    figures : sequence of Figure
    remarks : sequence of str
        What the points remark.
    """
    count, failed = len(results.points), len(results.failures)
    moving = varying(swept)
    level = [one for one in swept if one not in moving and np.isfinite(one.number).any()]
    constant = {
        _title(one): plain_number(float(one.number[np.isfinite(one.number)][0])) for one in level
    }  # fmt: skip
    axes = [
        (axis.key, ", ".join(str(value) for value in axis.values) if len(axis) <= 12
         else f"{axis.values[0]} to {axis.values[-1]}, {len(axis)} values")
        for axis in results.axes
    ]  # fmt: skip
    summary = f"{count - failed} of {count} points have results." if failed else f"All {count} points have results."
    failures = [
        (len(group.members), group.kind, results.place(group.members[0]), group.reason) for group in results.failed()
    ]
    return Page(
        title=f"Sweep: {results.title}",
        note=f"Case {results.name} over {' and '.join(axis.key for axis in results.axes)}. {summary}",
        sections=(
            Section("Warnings", (Notes(remarks, "warning"),) if remarks else ()),
            Section("What was varied", (Grid(("Key", "Values"), axes), Paragraph(summary))),
            Section("Values over the axes", tuple(map(Plot, figures))),
            Section("Values that do not change", (Facts(constant),) if constant else ()),
            Section("Failures", (Grid(("Points", "Kind", "First at", "Message"), failures),) if failures else ()),
            Section("Table", (DataTable(table),)),
        ),
        tables=(table,),
        name=f"{results.name}_sweep",
    )  # fmt: skip


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
    return [f"Pictures are drawn of the first {_MOST_PICTURES} values; the report shows all."] if left > 0 else []


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


def _found_tables(results: SweepResults) -> dict[str, dict[int, Table]]:
    """Tables by name, and of each the points that have it."""
    found: dict[str, dict[int, Table]] = {}
    for i, point in enumerate(results.points):
        for table in point.tables if isinstance(point, Point) else ():
            found.setdefault(table.name, {})[i] = table
    return found


def _stacked(columns: dict[int, Column], points: int, rows: int) -> Array:
    """One column of all points, shape (points, rows); what is missing is NaN or an empty text."""
    parts = {i: column.values for i, column in columns.items()}
    kinds = {part.dtype.kind for part in parts.values()}
    if kinds & set("US"):
        parts = {i: part.astype(str) for i, part in parts.items()}
        filled: Array = np.full(
            (points, rows), "", max((part.dtype for part in parts.values()), key=lambda d: d.itemsize)
        )
    elif kinds <= set("iub") and len(parts) == points and all(part.size == rows for part in parts.values()):
        filled = np.zeros((points, rows), dtype=int)
    else:
        filled = np.full((points, rows), np.nan)
    for i, part in parts.items():
        filled[i, : part.size] = part
    return filled


def _put_table(
    file: netcdf_file, name: str, found: dict[int, Table], axes: tuple[str, ...], sizes: tuple[int, ...]
) -> None:
    points = int(np.prod(sizes))
    rows = {i: len(table.columns[0]) for i, table in found.items()}
    name = plain(name)
    row = f"{name}.row"
    file.createDimension(row, max(rows.values()))
    if len(rows) < points or len(set(rows.values())) > 1:
        count = np.array([rows.get(i, 0) for i in range(points)]).reshape(sizes)
        put(file, f"{name}.rows", axes, count, "", "rows of the table at this point; the others are empty")
    for column, unit in dict.fromkeys((c.name, c.unit) for table in found.values() for c in table.columns):
        same = {i: c for i, table in found.items() for c in table.columns if (c.name, c.unit) == (column, unit)}
        values = _stacked(same, points, max(rows.values())).reshape(*sizes, -1)
        put(
            file,
            f"{name}.{column}",
            (*axes, row),
            values,
            unit,
            shared_clauses(c.meaning for c in same.values()),
        )


def _plain_names(results: SweepResults) -> dict[str, str]:
    """Names of axes, tables, columns and values that the file has otherwise, by what it has."""
    values = [name for value in swept_values(results) for name in (value.name, f"{value.name}_error")]
    tables = [
        (name, ["row", "rows", *dict.fromkeys(key for table in found.values() for key in table.keys())])  # noqa: SIM118
        for name, found in _found_tables(results).items()
    ]
    return plain_of(tables, [axis.key for axis in results.axes] + values)


def write_sweep_dataset(path: Path, results: SweepResults) -> None:
    """Write the dataset.

    Parameters
    ----------
    path : Path
    results : SweepResults
    """
    from scipy.io import netcdf_file

    sizes = tuple(len(axis) for axis in results.axes)
    names = tuple(plain(axis.key) for axis in results.axes)
    with netcdf_file(path, "w", version=2) as file:
        head(file, results.title, f"sweep of case {results.name} over {', '.join(axis.key for axis in results.axes)}")
        say_names(file, _plain_names(results))
        file.axes = json.dumps({axis.key: list(axis.values) for axis in results.axes}, ensure_ascii=False).encode()
        for axis in results.axes:
            file.createDimension(plain(axis.key), len(axis))
            places = np.array([str(value) for value in axis.values] if axis.numbers is None else axis.numbers)
            put(file, axis.key, (plain(axis.key),), places, axis.unit)
        put(file, "failure", names, failures(results).reshape(sizes), "", "why the point has no result")
        for name, unit, meaning, number, error in swept_values(results):
            variable = put(file, name, names, number.reshape(sizes), unit, meaning)
            if error is not None:
                variable.ancillary_variables = plain(f"{name}_error")
                put(file, f"{name}_error", names, error.reshape(sizes), unit, f"estimated error of {name}")
        for name, found in _found_tables(results).items():
            _put_table(file, name, found, names, sizes)
