"""Variables of a NetCDF 3 file by the CF conventions, written through scipy: xarray would cost half a second to import.

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
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import NDArray
    from scipy.io import netcdf_file, netcdf_variable

    Array = NDArray[np.generic]


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
