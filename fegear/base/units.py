"""The one place where units enter and leave: SI floats inside, text with units outside.

Inside fegear every number is a plain float in SI (m, N, Pa, kg, s, rad; temperatures in degrees Celsius). Case files
write ``"3.175 mm"``; tables name the unit in the column head.
"""

from __future__ import annotations

import functools
import math
from numbers import Real
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.base.errors import InputError, shown
from fegear.base.unit_text import UnreadableError, canonical, names, split

if TYPE_CHECKING:
    import pint


class Dimension(NamedTuple):
    """What may be asked for.

    Attributes
    ----------
    si : str
        Unit inside fegear.
    example : str
        For messages.
    also : dict of str to float
        Units of other dimensions in which engineers give it, with their size in `si`: the revolutions that a
        rotational speed in 1/min leaves out, the radian that a stiffness in N*m leaves out.
    """

    si: str
    example: str
    also: dict[str, float] = {}  # noqa: RUF012  (no one changes it)


_TURN = 2.0 * math.pi

DIMENSIONS: dict[str, Dimension] = {
    "length": Dimension("m", "3.175 mm"),
    "angle": Dimension("rad", "20 deg"),
    "force": Dimension("N", "1615 N"),
    "torque": Dimension("N*m", "68 N*m"),
    "power": Dimension("W", "40 kW"),
    "pressure": Dimension("Pa", "206.8 GPa"),
    "density": Dimension("kg/m^3", "7850 kg/m^3"),
    "line_load": Dimension("N/m", "250 N/mm"),
    "speed": Dimension("rad/s", "10000 rpm", {"1/s": _TURN}),
    "frequency": Dimension("1/s", "3500 Hz", {"rad/s": 1.0 / _TURN}),
    "inertia": Dimension("kg*m^2", "0.002 kg*m^2"),
    "mass": Dimension("kg", "2.882 kg"),
    "torsional_stiffness": Dimension("N*m/rad", "2.18e4 N*m/rad", {"N*m": 1.0}),
    "torsional_damping": Dimension("N*m*s/rad", "12.6 N*m*s", {"N*m*s": 1.0}),
    "stiffness": Dimension("N/m", "300 N/um"),
    "damping": Dimension("N*s/m", "1000 N*s/m"),
    "inverse_length": Dimension("1/m", "8 / inch"),
    "compliance": Dimension("m/N", "1.26e-8 m/N"),
    "viscosity": Dimension("Pa*s", "0.02 Pa*s"),
    "kinematic_viscosity": Dimension("m^2/s", "220 mm^2/s"),
    "temperature": Dimension("degC", "60 degC"),
    "time": Dimension("s", "20000 h"),
    "hardness": Dimension("HV", "700 HV"),
    "strain": Dimension("m/m", "400 um/m"),
    "voltage": Dimension("V", "5 V"),
    "bridge_output": Dimension("V/V", "0.8 mV/V"),
}

#: Dimensions whose units cancel, and the names that tell one of them from the other.
_BARE, _VOLTS = ("strain", "bridge_output"), {"V", "mV", "uV"}

#: Units of temperature with their size and the reading of their zero, both in degrees Celsius: the one quantity with
#: an offset. The formulas of oils and scuffing are written in degrees Celsius, and so are temperatures inside fegear.
TEMPERATURES: dict[str, tuple[float, float]] = {
    "degC": (1.0, 0.0),
    "deg*C": (1.0, 0.0),  # what becomes of the degree sign
    "K": (1.0, -273.15),
    "degF": (5.0 / 9.0, -160.0 / 9.0),
    "deg*F": (5.0 / 9.0, -160.0 / 9.0),
}

_INCH, _LBF, _PSI = 0.0254, 4.4482216152605, 6894.757293168361
#: Mechanical horsepower, 550 ft lbf/s, and metric, 75 m kgf/s.
_HP, _PS = 550.0 * 12.0 * _INCH * _LBF, 735.49875

#: Everyday units and their size in SI, by dimension. A case file written in these is read without pint, whose import
#: alone would take a quarter of a cold run; any other unit goes to pint. A test compares every entry with pint. The
#: first four are named where a unit is missing or wrong.
EVERYDAY: dict[str, dict[str, float]] = {
    "length": {"mm": 1e-3, "um": 1e-6, "m": 1.0, "inch": _INCH, "in": _INCH, "cm": 1e-2},
    "angle": {"deg": math.pi / 180.0, "rad": 1.0, "arcmin": math.pi / 10800.0, "arcsec": math.pi / 648000.0},
    "force": {"N": 1.0, "kN": 1e3, "lbf": _LBF},
    "torque": {"N*m": 1.0, "kN*m": 1e3, "N*mm": 1e-3, "lbf*inch": _LBF * _INCH, "Nm": 1.0, "kNm": 1e3, "Nmm": 1e-3},
    "power": {"kW": 1e3, "W": 1.0, "hp": _HP, "PS": _PS, "MW": 1e6},
    "pressure": {"GPa": 1e9, "MPa": 1e6, "N/mm^2": 1e6, "psi": _PSI, "Pa": 1.0, "bar": 1e5},
    "density": {"kg/m^3": 1.0, "g/cm^3": 1e3, "kg/dm^3": 1e3},
    "line_load": {"N/mm": 1e3, "kN/m": 1e3, "N/m": 1.0},
    "speed": {"rpm": _TURN / 60.0, "1/min": _TURN / 60.0, "Hz": _TURN, "rad/s": 1.0, "1/s": _TURN},
    "frequency": {"Hz": 1.0, "kHz": 1e3, "rpm": 1.0 / 60.0, "1/s": 1.0, "1/min": 1.0 / 60.0},
    "inertia": {"kg*m^2": 1.0, "kg*mm^2": 1e-6, "kg*cm^2": 1e-4, "kgm^2": 1.0, "kgmm^2": 1e-6},
    "mass": {"kg": 1.0, "g": 1e-3},
    "torsional_stiffness": {"N*m/rad": 1.0, "kN*m/rad": 1e3, "Nm/rad": 1.0, "kNm/rad": 1e3},
    "torsional_damping": {"N*m*s/rad": 1.0, "N*m*s": 1.0, "Nms/rad": 1.0, "Nms": 1.0},
    "stiffness": {"N/um": 1e6, "N/mm": 1e3, "N/m": 1.0},
    "damping": {"N*s/m": 1.0, "N*s/mm": 1e3, "Ns/m": 1.0},
    "inverse_length": {"1/inch": 1.0 / _INCH, "1/in": 1.0 / _INCH, "1/mm": 1e3, "1/m": 1.0},
    "compliance": {"um/N": 1e-6, "mm/N": 1e-3, "m/N": 1.0},
    "viscosity": {"Pa*s": 1.0, "mPa*s": 1e-3},
    "kinematic_viscosity": {"mm^2/s": 1e-6, "cSt": 1e-6, "m^2/s": 1.0},
    "temperature": {"degC": 1.0},
    "time": {"h": 3600.0, "min": 60.0, "s": 1.0, "ms": 1e-3},
    "hardness": {"HV": 1.0, "HBW": 1.0 / 0.95, "HB": 1.0 / 0.95},
    "strain": {"um/m": 1e-6, "ustrain": 1e-6, "mm/m": 1e-3, "m/m": 1.0, "ppm": 1e-6},
    "voltage": {"V": 1.0, "mV": 1e-3, "uV": 1e-6},
    "bridge_output": {"mV/V": 1e-3, "uV/V": 1e-6, "V/V": 1.0},
}

#: Every unit that is known, in words of pint; there are no prefixes but these. The radian is a dimension of its own
#: here, so that a torque is no stiffness and a number no angle. Units of other trades are left out on purpose: whoever
#: writes Mm, nm or mN has slipped.
UNITS: dict[str, str] = {
    "m": "[length]", "cm": "1e-2*m", "mm": "1e-3*m", "um": "1e-6*m", "micron": "um",
    "inch": "0.0254*m", "in": "inch", "inches": "inch", "thou": "1e-3*inch", "uin": "1e-6*inch",
    "ft": "12*inch", "foot": "ft", "feet": "ft",
    "rad": "[angle]", "mrad": "1e-3*rad", "urad": "1e-6*rad", "deg": f"{math.pi / 180.0!r}*rad", "degree": "deg",
    "degrees": "deg", "arcmin": "deg/60", "arcsec": "deg/3600", "rev": f"{_TURN!r}*rad", "turn": "rev", "U": "rev",
    "s": "[time]", "ms": "1e-3*s", "min": "60*s", "h": "3600*s", "Hz": "1/s", "kHz": "1e3/s", "rpm": "rev/min",
    "kg": "[mass]", "g": "1e-3*kg", "t": "1e3*kg", "lb": "0.45359237*kg",
    "N": "kg*m/s^2", "kN": "1e3*N", "MN": "1e6*N", "daN": "10*N", "kgf": "9.80665*N", "lbf": "4.4482216152605*N",
    "W": "N*m/s", "kW": "1e3*W", "MW": "1e6*W", "hp": f"{_HP!r}*W", "PS": f"{_PS!r}*W",
    "Pa": "N/m^2", "kPa": "1e3*Pa", "MPa": "1e6*Pa", "GPa": "1e9*Pa", "bar": "1e5*Pa",
    "psi": "lbf/inch^2", "ksi": "1e3*psi", "Mpsi": "1e6*psi",
    "Nm": "N*m", "kNm": "kN*m", "MNm": "MN*m", "Nmm": "N*mm", "Ncm": "N*cm", "Ns": "N*s", "Nms": "N*m*s",
    "HV": "[hardness]", "HBW": "HV/0.95", "HB": "HBW",  # steel, ISO 18265: HBW = 0.95 HV
    "ustrain": "um/m", "microstrain": "um/m", "ppm": "um/m",
    "V": "[voltage]", "mV": "1e-3*V", "uV": "1e-6*V",
    "Pas": "Pa*s", "mPas": "1e-3*Pa*s", "cP": "1e-3*Pa*s", "St": "1e-4*m^2/s", "cSt": "1e-6*m^2/s",
}  # fmt: skip


@functools.lru_cache(maxsize=1)
def registry() -> pint.UnitRegistry[float]:
    """Pint with the units of `UNITS` and no others, made at first use: its import costs a fifth of a second.

    Nothing is kept on disk: these definitions are read in a hundredth of a second.
    """
    import pint

    made: pint.UnitRegistry[float] = pint.UnitRegistry(None)
    made.load_definitions([f"{name} = {meaning}" for name, meaning in UNITS.items()])
    return made


@functools.lru_cache(maxsize=256)
def _size(unit: str, dimension: str) -> float:
    """Size in SI of a unit in its canonical spelling."""
    everyday = EVERYDAY[dimension].get(unit)
    if everyday is not None:
        return everyday
    if not unit:
        raise UnreadableError(f"has no unit, but {_kind(dimension)} needs one", _choices(dimension))
    unknown = [name for name in names(unit) if name not in UNITS]
    if unknown:
        raise UnreadableError(f"has the unknown unit {shown(unknown[0])}", _choices(dimension))
    volts = not _VOLTS.isdisjoint(names(unit))
    if dimension in _BARE and volts != (dimension == "bridge_output"):  # to pint both are plain numbers
        raise UnreadableError(f"is not {_kind(dimension)}", _choices(dimension))
    quantity = registry().parse_expression(unit)
    wanted = DIMENSIONS[dimension]
    for si, size in {wanted.si: 1.0, **wanted.also}.items():
        if quantity.check(registry().parse_expression(si).dimensionality):
            return float(quantity.to(si).magnitude) * size
    pound = ' ("lb" is a mass, the force is lbf)' if "lb" in names(unit) else ""
    raise UnreadableError(f"is not {_kind(dimension)}{pound}", _choices(dimension))


def _celsius(number: float, unit: str) -> float:
    """A temperature in degrees Celsius; below absolute zero there is none."""
    if not unit:
        raise UnreadableError("has no unit, but a temperature needs one", _choices("temperature"))
    if unit not in TEMPERATURES:
        rule = "has an unknown unit" if unit not in UNITS else "is not a temperature"
        raise UnreadableError(rule, 'use degC, degF or K: "60 degC"')
    size, zero = TEMPERATURES[unit]
    value = number * size + zero
    if value < -273.15:
        raise UnreadableError("is below absolute zero", "check the number and its unit")
    return value


def _kind(dimension: str) -> str:
    """``a length``, ``an inverse length``."""
    return f"{'an' if dimension[0] in 'aei' else 'a'} {dimension.replace('_', ' ')}"


def _choices(dimension: str) -> str:
    some = ", ".join(list(EVERYDAY[dimension])[:4])
    return f'{_kind(dimension)} is expected, e.g. in {some}; for example "{DIMENSIONS[dimension].example}"'


def unit_size(unit: str, dimension: str, key: str = "unit") -> float:
    """Size of a unit in SI.

    Parameters
    ----------
    unit : str
        As a column head holds it, ``um`` or ``N/mm``.
    dimension : str
        A key of `DIMENSIONS`.
    key : str
        Name of the input for the error message.

    Raises
    ------
    InputError
        If the unit is not known or of another dimension.
    """
    try:
        return _size(canonical(unit) if unit.strip() else "", dimension)
    except UnreadableError as error:
        raise InputError(key, shown(unit), error.rule, error.remedy) from None


def to_si(text: object, dimension: str, key: str = "value") -> float:
    """Parse a quantity written by a user and return it in SI.

    Parameters
    ----------
    text : str
        ``number unit``, for example ``"3.175 mm"``, and nothing else.
    dimension : str
        A key of `DIMENSIONS`. A rotational speed in 1/min, 1/s or Hz counts revolutions.
    key : str
        Name of the input for the error message.

    Returns
    -------
    float
        The value in the SI unit of `dimension`.

    Raises
    ------
    InputError
        If the text is no number with a unit, or the unit has the wrong dimension.
    """
    kind, remedy = _kind(dimension), f'for example "{DIMENSIONS[dimension].example}"'
    if isinstance(text, bool) or not isinstance(text, (str, int, float)):
        raise InputError(key, shown(text), f"must be {kind} with its unit", remedy)
    if isinstance(text, (int, float)):
        raise InputError(key, shown(text), f"has no unit; {kind} requires one", remedy)
    try:
        number, unit = split(text)
        value = _celsius(number, unit) if dimension == "temperature" else number * _size(unit, dimension)
    except UnreadableError as error:
        raise InputError(key, shown(text), error.rule, error.remedy or remedy) from None
    if not math.isfinite(value):
        raise InputError(key, shown(text), "must be finite")
    return value


#: What one SI unit is in the units of tables and pictures, so that writing a table needs no pint.
PER_SI: dict[str, float] = {
    "mm": 1e3,
    "um": 1e6,
    "deg": 57.29577951308232,
    "rad": 1.0,
    "N": 1.0,
    "N^2": 1.0,
    "N.m": 1.0,
    "W": 1.0,
    "kW": 1e-3,
    "m/s": 1.0,
    "m/s^2": 1.0,
    "s": 1.0,
    "h": 1.0 / 3600.0,
    "MPa": 1e-6,
    "GPa": 1e-9,
    "N/mm": 1e-3,
    "N/um": 1e-6,
    "um/N": 1e6,
    "um.mm/N": 1e9,
    "MPa.mm/N": 1e-3,
    "MPa/N": 1e-6,
    "Hz": 1.0,
    "kHz": 1e-3,
    "rpm": 9.549296585513721,
    "arcsec": 206264.80624709636,
    "arcmin": 3437.7467707849396,
    "N/(mm.um)": 1e-9,
    "N/(N.m)": 1.0,
    "1/mm": 1e-3,
    "kg/mm": 1e-3,
    "kg": 1.0,
    "kg.m^2": 1.0,
    "MPa^(1/2)": 1e-3,
    "MPa.m^(1/2)": 1e-6,
    "degC": 1.0,  # inside, too
    "K": 1.0,
    "mPa.s": 1e3,
    "%": 100.0,
    "um/m": 1e6,
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
    unit = DIMENSIONS[dimension].si
    if callable(getattr(value, "to", None)) and hasattr(value, "magnitude"):
        import pint

        if dimension in ("angle", "speed", "frequency"):  # pint's radian, cycle and revolution are plain numbers
            return f"{float(value.magnitude)!r} {value.units:~C}"
        try:
            return f"{float(value.to(unit).magnitude)!r} {unit}"
        except pint.DimensionalityError:
            raise InputError("value", str(value), f"is not {_kind(dimension)}", _choices(dimension)) from None
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
