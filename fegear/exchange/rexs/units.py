"""Units of REXS: what a number of an attribute is in SI.

Source: the unit lists of REXS 1.0 to 1.7. Degrees are written as ``deg`` or with their sign, which version depends on.
"""

from __future__ import annotations

import math

#: Quantity and size in SI of every unit that attributes of a case have; blanks do not count.
_UNITS = {
    "mm": ("length", 1e-3),
    "m": ("length", 1.0),
    "mum": ("length", 1e-6),
    "µm": ("length", 1e-6),  # the micro sign
    "μm": ("length", 1e-6),  # the Greek letter
    "deg": ("angle", math.pi / 180.0),
    "°": ("angle", math.pi / 180.0),
    "rad": ("angle", 1.0),
    "N": ("force", 1.0),
    "kN": ("force", 1e3),
    "Nm": ("torque", 1.0),
    "Nmm": ("torque", 1e-3),
    "kNm": ("torque", 1e3),
    "1/min": ("speed", 2.0 * math.pi / 60.0),
    "rot/min": ("speed", 2.0 * math.pi / 60.0),
    "rad/s": ("speed", 1.0),
    "W": ("power", 1.0),
    "kW": ("power", 1e3),
    "N/m": ("stiffness", 1.0),
    "N/mm": ("stiffness", 1e3),
    "Nmm/rad": ("tilting stiffness", 1e-3),
    "Nm/rad": ("tilting stiffness", 1.0),
    "N/mm^2": ("stress", 1e6),
    "MPa": ("stress", 1e6),
    "Pa": ("stress", 1.0),
    "kg/dm^3": ("density", 1e3),
    "kg/m^3": ("density", 1.0),
    "mm^2/s": ("viscosity", 1e-6),
    "h": ("time", 3600.0),
    "s": ("time", 1.0),
    "%": ("share", 0.01),
    "C": ("temperature", 1.0),
    "°C": ("temperature", 1.0),
    "HV": ("hardness HV", 1.0),
    "HRC": ("hardness HRC", 1.0),
    "HB": ("hardness HBW", 1.0),
    "none": ("number", 1.0),
    "": ("number", 1.0),
}


def size_of(unit: str, quantity: str) -> float | None:
    """Size of a unit in SI (temperatures in degC); None where it is no unit of the quantity."""
    kind, size = _UNITS.get(unit.replace(" ", ""), ("", 0.0))
    return size if kind == quantity else None


def units_of(quantity: str) -> str:
    """The units of a quantity as messages list them."""
    return ", ".join(unit or "none" for unit, (kind, _) in _UNITS.items() if kind == quantity and unit.isascii())
