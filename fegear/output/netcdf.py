"""Variables of a NetCDF 3 file by the CF conventions, written through scipy: xarray would cost half a second to import.

The conventions (https://cfconventions.org) let any reader know units, meanings, coordinates and errors. Names with dots
(``I.te_mean``), which they advise against, stay: they are the names of the summary.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import fegear

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.io import netcdf_file, netcdf_variable

    Array = NDArray[np.generic]

CONVENTIONS = "CF-1.11"
#: Units that UDUNITS, by which the conventions read them, spells otherwise (held against UDUNITS 2.2.28).
UDUNITS = {"": "1", "deg": "degree", "1/mm": "mm-1"}


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
        Created before.
    values : ndarray
    unit : str
        Attribute ``units`` of numbers; ``1`` where empty.
    meaning : str
        Attribute ``long_name``; the name where empty.

    Returns
    -------
    scipy.io.netcdf_variable
    """
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
    variable.long_name = (meaning or name.rsplit(".", 1)[-1]).encode()
    return variable
