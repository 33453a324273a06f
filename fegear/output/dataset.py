"""``results.nc``: every table and value as one labelled dataset that ``xarray.open_dataset`` reads.

NetCDF 3 is written through scipy, which a run has loaded anyway; importing xarray to write the same file would cost
half a second of a two-second run. Table ``stiffness_a`` becomes the dimension ``stiffness_a`` and the variables
``stiffness_a.radius``, ``stiffness_a.c_self``, ...; the first column is their coordinate. Values become scalars with
their error estimate as attribute.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import fegear
from fegear.output.netcdf import put

if TYPE_CHECKING:
    from pathlib import Path

    from scipy.io import netcdf_file

    from fegear.engine.outcome import Table
    from fegear.engine.run import Results


def _add_table(file: netcdf_file, table: Table) -> None:
    rows = table.name
    file.createDimension(rows, len(table.columns[0]))
    first = f"{table.name}.{table.columns[0].name}"
    for column in table.columns:
        name = f"{table.name}.{column.name}"
        variable = put(file, name, (rows,), column.values, column.unit, column.meaning)
        if name != first:
            variable.coordinates = first


def write_dataset(path: Path, results: Results) -> None:
    """Write all tables and values of a run.

    Parameters
    ----------
    path : Path
    results : Results
    """
    from scipy.io import netcdf_file

    with netcdf_file(path, "w", version=2) as file:
        file.title = (results.scene.case.title or results.scene.name).encode()
        file.source = f"fegear {fegear.__version__}"
        case = results.scene.case.model_dump(mode="json", exclude_unset=True)
        file.case = json.dumps(case, ensure_ascii=False).encode()
        for table in results.tables:
            _add_table(file, table)
        for value in results.values:
            variable = file.createVariable(value.name, "f8", ())
            variable.data[...] = value.value
            if value.unit:
                variable.units = value.unit
            if value.error is not None:
                variable.error = value.error
            if value.meaning:
                variable.long_name = value.meaning.encode()
