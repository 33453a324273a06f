"""``results.nc``: every table and value as one labelled dataset that ``xarray.open_dataset`` reads.

NetCDF 3 by the CF conventions is written through scipy, which a run has loaded anyway; importing xarray to write the
same file would cost half a second of a two-second run. Table ``stiffness_a`` becomes the dimension ``stiffness_a`` and
the variables ``stiffness_a.radius``, ``stiffness_a.c_self``, ...; the first column is their coordinate and, where it
rises or falls throughout, the dimension's own (``data.sel(stiffness_a=45.0, method="nearest")``). Values become
scalars. Estimated errors are ancillary variables of what they belong to.

Variables of a NetCDF 3 file by the CF conventions, written through scipy: xarray would cost half a second to import.

The conventions (https://cfconventions.org) let any reader know units, meanings, coordinates and errors. Names with dots
(``I.te_mean``), which they advise against, stay: they are the names of the summary. Those that readers do not agree
about (scipy's takes UTF-8 for Latin-1) are written as the files of tables are called, in ASCII; the attribute
``fegear_names`` holds them by what they were.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

import fegear
from fegear.engine.citation import bibliography
from fegear.engine.outcome import Value, error_columns
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from numpy.typing import NDArray
    from scipy.io import netcdf_file, netcdf_variable

    from fegear.engine.run import Results
    from fegear.engine.table import Column, Table

    Array = NDArray[np.generic]


def _is_index(column: Column) -> bool:
    """Whether the conventions let a column be a dimension's own coordinate: numbers that rise or fall throughout."""
    if column.si.dtype.kind not in "iuf" or not len(column):
        return False
    steps = np.diff(column.si)
    return bool(np.isfinite(column.si).all() and ((steps > 0).all() or (steps < 0).all()))


def _add_table(file: netcdf_file, table: Table) -> None:
    rows, first, errors = plain(table.name), table.columns[0], error_columns(table)
    file.createDimension(rows, len(table))
    if _is_index(first):
        put(file, rows, (rows,), first.values, first.unit, first.meaning or first.name)
    for column in table.columns:
        variable = put(file, f"{rows}.{column.name}", (rows,), column.values, column.unit, column.meaning)
        if column is not first:
            variable.coordinates = f"{rows}.{first.name}"
        if column.name in errors:
            variable.ancillary_variables = f"{rows}.{errors[column.name]}"


def _add_value(file: netcdf_file, value: Value) -> None:
    variable = put(file, value.name, (), np.array(value.value), value.unit, value.meaning)
    if value.error is not None:
        variable.error = value.error
        variable.ancillary_variables = plain(f"{value.name}_error")
        put(file, f"{value.name}_error", (), np.array(value.error), value.unit, f"estimated error of {value.name}")


def _references(results: Results) -> str:
    """Works that the results rest on, one a line."""
    works = bibliography()
    cited = {c.key for step in results.plan.steps for c in step.stage.cites(results.scene, step.task.subject)}
    return "\n".join(work.full for key, work in works.items() if key in cited)


def plain_names(results: Results) -> dict[str, str]:
    """Names of tables, columns and values that the file has otherwise, by what it has."""
    values = [name for value in results.values for name in (value.name, f"{value.name}_error")]
    return plain_of(((table.name, table.keys()) for table in results.tables), values)


def write_dataset(path: Path, results: Results) -> None:
    """Write all tables and values of a run.

    Parameters
    ----------
    path : Path
    results : Results
    """
    from scipy.io import netcdf_file

    name, case = results.scene.name, results.scene.case
    with netcdf_file(path, "w", version=2) as file:
        head(file, case.title or name, f"case {name}", _references(results))
        file.case = json.dumps(case.model_dump(mode="json", exclude_unset=True), ensure_ascii=False).encode()
        if results.remarks:
            file.comment = "\n".join(results.remarks).encode()
        say_names(file, plain_names(results))
        for table in results.tables:
            _add_table(file, table)
        for value in results.values:
            _add_value(file, value)


CONVENTIONS = "CF-1.11"


#: Characters of a name, of the 256 that the format takes.
_LONGEST = 200


#: Units that UDUNITS, by which the conventions read them, spells otherwise (compared with UDUNITS 2.2.28).
UDUNITS = {"": "1", "deg": "degree", "1/mm": "mm-1"}


def plain(name: str) -> str:
    """Name of a variable or a dimension that every reader reads alike."""
    return (
        name if name.isascii() and name.isprintable() and "/" not in name and len(name) <= _LONGEST else file_name(name)
    )


def plain_of(tables: Iterable[tuple[str, Iterable[str]]], others: Iterable[str]) -> dict[str, str]:
    """Names that are not written as they are, by what they are written as.

    Parameters
    ----------
    tables : iterable of (str, iterable of str)
        Names of tables with those of their columns.
    others : iterable of str
        Names of values and axes.
    """
    found = {plain(name): name for name in others}
    for table, columns in tables:
        found |= {plain(table): table} | {f"{plain(table)}.{column}": f"{table}.{column}" for column in columns}
    return {written: name for written, name in found.items() if written != name}


def say_names(file: netcdf_file, names: Mapping[str, str]) -> None:
    """Write down what `plain_of` has found, if anything."""
    if names:
        file.fegear_names = json.dumps(names, ensure_ascii=False).encode("utf-8", "replace")


def head(file: netcdf_file, title: str, history: str, references: str = "") -> None:
    """Say what a file is and where it comes from; without the time of day, so that equal runs leave equal files.

    Parameters
    ----------
    file : scipy.io.netcdf_file
    title : str
    history : str
        What made it.
    references : str
        Papers and standards that its numbers rest on.
    """
    file.Conventions = CONVENTIONS
    file.title, file.source = title.encode(), f"fegear {fegear.__version__}"
    file.history = f"fegear {fegear.__version__}: {history}".encode()
    if references:
        file.references = references.encode()


def put(
    file: netcdf_file, name: str, dimensions: tuple[str, ...], values: Array, unit: str = "", meaning: str = ""
) -> netcdf_variable:
    """Add a variable: numbers as float or 32-bit integer, texts as characters, as the NetCDF conventions have it.

    Parameters
    ----------
    file : scipy.io.netcdf_file
    name : str
    dimensions : tuple of str
        Created before, by their names as `plain` has them.
    values : ndarray
    unit : str
        Attribute ``units`` of numbers; ``1`` where empty.
    meaning : str
        Attribute ``long_name``; the name where empty.

    Returns
    -------
    scipy.io.netcdf_variable
    """
    told, name = name.rsplit(".", 1)[-1], plain(name)
    if values.dtype.kind in "US":
        encoded = np.char.encode(values.astype(str), "utf-8")
        width = max(encoded.dtype.itemsize, 1)
        file.createDimension(f"{name}_length", width)
        variable = file.createVariable(name, "c", (*dimensions, f"{name}_length"))
        variable[:] = encoded.astype(f"S{width}").view("S1").reshape(*values.shape, width)
        variable._Encoding = "utf-8"  # noqa: SLF001  (the attribute's name in the NetCDF conventions)
    else:
        kind = "i4" if values.dtype.kind in "iub" else "f8"
        variable = file.createVariable(name, kind, dimensions)
        variable.data[...] = values.astype(kind)
        variable.units = UDUNITS.get(unit, unit).encode()
        if kind == "f8" and np.isnan(values).any():
            variable._FillValue = np.nan  # noqa: SLF001  (the attribute's name in the NetCDF conventions)
    variable.long_name = (meaning or told).encode()
    return variable
