"""``sweep.nc``: every value and table of a sweep over its axes, for ``xarray.open_dataset``.

The axes are dimensions and coordinates; a value is a variable over them, a table's column one over them and the table's
rows (dimension ``<table>.row``). Where a point failed, numbers are NaN and the variable ``failure`` holds the reason.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.table import Column, Table
from fegear.output.netcdf import head, plain, plain_of, put, say_names
from fegear.studies.sweep import Point, SweepResults
from fegear.studies.swept import failures, shared_clauses, swept_values

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray
    from scipy.io import netcdf_file

    Array = NDArray[np.generic]


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
        put(file, f"{name}.rows", axes, count, "", "number of rows of the table at this point")
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
        (name, ["row", "rows", *dict.fromkeys(key for table in found.values() for key in table.keys())])  # noqa: SIM118  (of a table, which lists its rows otherwise)
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
        put(file, "failure", names, failures(results).reshape(sizes), "", "reason for missing result")
        for name, unit, meaning, number, error in swept_values(results):
            variable = put(file, name, names, number.reshape(sizes), unit, meaning)
            if error is not None:
                variable.ancillary_variables = plain(f"{name}_error")
                put(file, f"{name}_error", names, error.reshape(sizes), unit, f"estimated error of {name}")
        for name, found in _found_tables(results).items():
            _put_table(file, name, found, names, sizes)
