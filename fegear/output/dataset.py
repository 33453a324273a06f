"""``results.nc``: every table and value as one labelled dataset that ``xarray.open_dataset`` reads.

NetCDF 3 by the CF conventions is written through scipy, which a run has loaded anyway; importing xarray to write the
same file would cost half a second of a two-second run. Table ``stiffness_a`` becomes the dimension ``stiffness_a`` and
the variables ``stiffness_a.radius``, ``stiffness_a.c_self``, ...; the first column is their coordinate and, where it
rises or falls throughout, the dimension's own (``data.sel(stiffness_a=45.0, method="nearest")``). Values become
scalars. Estimated errors are ancillary variables of what they belong to.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import bibliography
from fegear.engine.least_errors import error_columns
from fegear.engine.value import Value
from fegear.output.netcdf import head, plain, plain_of, put, say_names

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray
    from scipy.io import netcdf_file

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
