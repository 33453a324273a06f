"""Units in which cases are written and REXS models are read: every row of both tables against pint, or by hand."""

import math

import pytest

from fegear.base.units import registry
from fegear.exchange import case_tables
from fegear.exchange.rexs import units

#: What pint calls the units of REXS; the rest are the same words.
IN_PINT = {
    "mum": "um", "µm": "um", "μm": "um", "°": "deg", "1/min": "rev/min", "rot/min": "rev/min", "kg/dm^3": "kg/dm^3",
    "%": "0.01", "none": "1", "": "1",
}  # fmt: skip
#: SI unit of each quantity of REXS in pint's words.
SI = {
    "length": "m", "angle": "rad", "force": "N", "torque": "N*m", "speed": "rad/s", "power": "W", "stiffness": "N/m",
    "tilting stiffness": "N*m/rad", "stress": "Pa", "density": "kg/m^3", "viscosity": "m^2/s", "time": "s",
    "share": "1", "number": "1",
}  # fmt: skip
BY_HAND = {"C": 1.0, "°C": 1.0, "HV": 1.0, "HRC": 1.0, "HB": 1.0, "Nmm/rad": 1e-3, "Nm/rad": 1.0, "kg/dm^3": 1e3}


def pint_size(unit, si):
    quantity = registry().parse_expression(unit)
    if isinstance(quantity, int | float):
        return float(quantity)
    return quantity.to(si).magnitude


@pytest.mark.parametrize("unit", units._UNITS)
def test_a_unit_of_rexs_has_its_size(unit):
    quantity, size = units._UNITS[unit]
    wanted = BY_HAND[unit] if unit in BY_HAND else pint_size(IN_PINT.get(unit, unit), SI[quantity])
    assert size == pytest.approx(wanted, rel=1e-14)
    assert units.size_of(f" {unit} ", quantity) == size
    assert units.size_of(unit, "another quantity") is None


@pytest.mark.parametrize("unit", sorted(set(case_tables._UNITS) - {"degC"}))
def test_a_unit_of_a_case_that_is_written_has_its_size(unit):
    quantity = registry().parse_expression(unit)
    assert case_tables._UNITS[unit] == pytest.approx(quantity.to_root_units().magnitude, rel=1e-14)
    assert case_tables._UNITS["degC"] == 1.0


def test_units_of_a_quantity_are_listed_in_words_that_every_keyboard_has():
    assert units.units_of("angle") == "deg, rad"
    assert units.units_of("number") == "none, none"
    assert units.units_of("speed").split(", ") == ["1/min", "rot/min", "rad/s"]
    assert math.isclose(units.size_of("deg", "angle"), math.pi / 180.0)
