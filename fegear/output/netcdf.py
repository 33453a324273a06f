"""Variables of a NetCDF 3 file, written through scipy: xarray would cost half a second to import."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from scipy.io import netcdf_file, netcdf_variable

    Array = NDArray[np.generic]


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
    unit, meaning : str
        Attributes ``units`` and ``long_name``, where not empty.

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
        variable[:] = values.astype(kind)
    if unit:
        variable.units = unit.encode()
    if meaning:
        variable.long_name = meaning.encode()
    return variable
