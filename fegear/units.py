"""The one place where units enter and leave: SI floats inside, text with units outside.

Inside fegear every number is a plain float in SI (m, N, Pa, kg, s, rad). Case files write
``"3.175 mm"``; tables name the unit in the column head.
"""

from __future__ import annotations

import functools
import math
import re
from numbers import Real
from typing import TYPE_CHECKING, Any

from fegear.errors import InputError

if TYPE_CHECKING:
    import pint

#: SI unit of each dimension that a case file may ask for, with an example for error messages.
DIMENSIONS: dict[str, tuple[str, str]] = {
    "length": ("m", "3.175 mm"),
    "angle": ("rad", "20 deg"),
    "force": ("N", "1615 N"),
    "torque": ("N*m", "68 N*m"),
    "pressure": ("Pa", "206.8 GPa"),
    "density": ("kg/m^3", "7850 kg/m^3"),
    "line_load": ("N/m", "250 N/mm"),
    "speed": ("rad/s", "10000 rpm"),
    "frequency": ("Hz", "3500 Hz"),
    "inertia": ("kg*m^2", "0.002 kg*m^2"),
    "mass": ("kg", "2.882 kg"),
    "torsional_stiffness": ("N*m/rad", "2.18e4 N*m/rad"),
    "torsional_damping": ("N*m*s/rad", "12.6 N*m*s"),
    "stiffness": ("N/m", "300 N/um"),
    "damping": ("N*s/m", "1000 N*s/m"),
    "inverse_length": ("1/m", "8 / inch"),
    "compliance": ("m/N", "1.26e-8 m/N"),
    "time": ("s", "0.1 s"),
    "viscosity": ("Pa*s", "0.02 Pa*s"),
    "temperature": ("K", "350 K"),
    "dimensionless": ("", "0.3"),
}

_INCH = 0.0254

#: Everyday units and their size in SI, by dimension. A case file written in these is read without pint, whose import
#: alone would take a quarter of a cold run; any other unit goes to pint. A test holds every entry against pint.
EVERYDAY: dict[str, dict[str, float]] = {
    "length": {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "cm": 1e-2, "inch": _INCH, "in": _INCH},
    "angle": {"rad": 1.0, "deg": math.pi / 180.0, "degree": math.pi / 180.0, "arcmin": math.pi / 10800.0},
    "force": {"N": 1.0, "kN": 1e3, "lbf": 4.4482216152605},
    "torque": {"N*m": 1.0, "kN*m": 1e3},
    "pressure": {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9},
    "density": {"kg/m^3": 1.0, "g/cm^3": 1e3},
    "line_load": {"N/m": 1.0, "N/mm": 1e3},
    "speed": {"rad/s": 1.0, "rpm": math.pi / 30.0},
    "frequency": {"Hz": 1.0, "kHz": 1e3},
    "inertia": {"kg*m^2": 1.0},
    "mass": {"kg": 1.0, "g": 1e-3},
    "torsional_stiffness": {"N*m/rad": 1.0},
    "torsional_damping": {"N*m*s/rad": 1.0, "N*m*s": 1.0},
    "stiffness": {"N/m": 1.0, "N/mm": 1e3, "N/um": 1e6},
    "damping": {"N*s/m": 1.0},
    "inverse_length": {"/inch": 1.0 / _INCH, "/in": 1.0 / _INCH, "/mm": 1e3, "/m": 1.0},
    "compliance": {"m/N": 1.0, "um/N": 1e-6},
    "time": {"s": 1.0, "ms": 1e-3},
    "viscosity": {"Pa*s": 1.0},
    "temperature": {"K": 1.0},
    "dimensionless": {},
}

_NUMBER_AND_UNIT = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S.*?)\s*")


def _everyday(text: str, dimension: str) -> float | None:
    """Return the quantity in SI if it is a number and one of the everyday units of its dimension."""
    match = _NUMBER_AND_UNIT.fullmatch(text)
    size = EVERYDAY[dimension].get(match[2].replace(" ", "")) if match else None
    return None if match is None or size is None else float(match[1]) * size


@functools.lru_cache(maxsize=1)
def registry() -> pint.UnitRegistry[float]:
    """Pint's registry, made at first use (importing it costs a fifth of a second)."""
    import pint

    return pint.UnitRegistry(cache_folder=":auto:", autoconvert_offset_to_baseunit=True)


def to_si(text: str | float, dimension: str, key: str = "value") -> float:
    """Parse a quantity written by a user and return it in SI.

    Parameters
    ----------
    text : str or float
        For example ``"3.175 mm"``. A bare number is accepted for dimensionless values only.
    dimension : str
        A key of `DIMENSIONS`.
    key : str
        Name of the input for the error message.

    Returns
    -------
    float
        The value in the SI unit of `dimension`.

    Raises
    ------
    InputError
        If the text is no quantity, has no unit, or has the wrong dimension.
    """
    unit, example = DIMENSIONS[dimension]
    kind = dimension.replace("_", " ")
    if isinstance(text, bool) or not isinstance(text, (str, int, float)):
        raise InputError(key, repr(text), f"must be a {kind} with its unit", f'write for example "{example}"')
    if isinstance(text, (int, float)):
        if dimension == "dimensionless":
            return float(text)
        raise InputError(key, text, f"is a bare number, but a {kind} needs a unit", f'write for example "{example}"')
    everyday = _everyday(text, dimension)
    if everyday is not None and math.isfinite(everyday):
        return everyday
    import pint

    try:
        quantity: pint.Quantity[float] = registry().Quantity(text)
        value = float(quantity.to(unit or "dimensionless").magnitude)
    except pint.DimensionalityError:
        raise InputError(key, f'"{text}"', f"is not a {kind}", f'write for example "{example}"') from None
    except Exception as problem:  # noqa: BLE001  (pint raises a dozen kinds, tokenizer errors among them)
        detail = str(problem).splitlines()[0] if str(problem) else type(problem).__name__
        raise InputError(
            key, f'"{text}"', f"is not a quantity that can be read ({detail})", f'write for example "{example}"'
        ) from None
    if not math.isfinite(value):
        raise InputError(key, f'"{text}"', "must be finite")
    return value


#: What one SI unit is in the units of tables and pictures, so that writing a table needs no pint.
PER_SI: dict[str, float] = {
    "mm": 1e3,
    "um": 1e6,
    "deg": 57.29577951308232,
    "rad": 1.0,
    "N": 1.0,
    "N^2": 1.0,
    "s": 1.0,
    "MPa": 1e-6,
    "GPa": 1e-9,
    "N/mm": 1e-3,
    "N/um": 1e-6,
    "um/N": 1e6,
    "um.mm/N": 1e9,
    "MPa.mm/N": 1e-3,
    "Hz": 1.0,
    "rpm": 9.549296585513721,
    "arcsec": 206264.80624709636,
    "N/(mm.um)": 1e-9,
    "1/mm": 1e-3,
}


def from_si(unit: str) -> float:
    """Factor that turns an SI number into `unit`, one of the units used in tables."""
    return PER_SI[unit]


def as_text(value: Any, dimension: str, *, bare_si: bool = False) -> Any:
    """A quantity of pint as text with its unit, so that it is read like any other; everything else as it is.

    Parameters
    ----------
    value : object
        What a user gave.
    dimension : str
        A key of `DIMENSIONS`.
    bare_si : bool
        Whether numbers are SI and become text with their unit too.

    Raises
    ------
    InputError
        If a quantity of pint has the wrong dimension.
    """
    unit, example = DIMENSIONS[dimension][:2]
    if callable(getattr(value, "to", None)) and hasattr(value, "magnitude"):
        import pint

        try:
            return f"{float(value.to(unit or 'dimensionless').magnitude)!r} {unit}"
        except pint.DimensionalityError:
            kind = dimension.replace("_", " ")
            raise InputError("value", str(value), f"is not a {kind}", f'write for example "{example}"') from None
    if bare_si and not isinstance(value, (bool, str)) and isinstance(value, Real):
        return f"{float(value)!r} {unit}"
    return value


def quantity(value: Any, unit: str) -> Any:
    """A number or array in one of the units of tables, as a quantity of pint's own (application) registry.

    Parameters
    ----------
    value : float or ndarray
    unit : str
        A key of `PER_SI`, or empty.

    Returns
    -------
    pint.Quantity
    """
    import pint

    return pint.Quantity(value, unit.replace(".", "*"))
