"""Units at the door: the everyday table equals pint, and what cannot be read is refused in words."""

import math

import pytest

from fegear.errors import InputError
from fegear.units import DIMENSIONS, EVERYDAY, PER_SI, registry, to_si

EVERY = [(dimension, unit, size) for dimension, units in EVERYDAY.items() for unit, size in units.items()]


@pytest.mark.parametrize(("dimension", "unit", "size"), EVERY)
def test_everyday_units_equal_pint(dimension, unit, size):
    pint_value = registry().Quantity(f"3.7 {unit}").to(DIMENSIONS[dimension][0] or "dimensionless").magnitude
    assert size * 3.7 == pytest.approx(pint_value, rel=1e-14)


@pytest.mark.parametrize("unit", sorted(PER_SI))
def test_units_of_tables_equal_pint(unit):
    quantity = registry().Quantity(1.0, unit).to_base_units()
    assert PER_SI[unit] * quantity.magnitude == pytest.approx(1.0, rel=1e-14)


def test_every_dimension_reads_its_own_example():
    for dimension, (_, example) in DIMENSIONS.items():
        assert math.isfinite(to_si(example, dimension))


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("3.175 mm", "length", 3.175e-3),
        (" 3.175mm ", "length", 3.175e-3),
        ("8 / inch", "inverse_length", 8 / 0.0254),
        ("8/inch", "inverse_length", 8 / 0.0254),
        ("8 / in", "inverse_length", 8 / 0.0254),
        ("1/8 inch", "length", 0.0254 / 8),  # a fraction goes to pint
        ("2 feet", "length", 0.6096),
        ("30e6 psi", "pressure", 30e6 * 6894.757293168361),
        ("-0.5 deg", "angle", -0.5 * math.pi / 180),
        ("1e-3 N/mm", "line_load", 1.0),
        ("250 N / mm", "line_load", 250e3),
        (0.25, "dimensionless", 0.25),
        ("25 degC", "temperature", 298.15),
    ],
)
def test_quantities_are_read(text, dimension, value):
    assert to_si(text, dimension) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "dimension", "words"),
    [
        ("3 N", "length", "is not a length"),
        ("3", "length", "is not a length"),
        (3.0, "length", "needs a unit"),
        ("three mm", "length", "is not a"),
        ("", "length", "that can be read"),
        ("1e999 mm", "length", "finite"),
        ("nan mm", "length", "gear.a.module"),
        (True, "length", "must be a length"),
        (["1 mm"], "length", "must be a length"),
    ],
)
def test_what_is_no_quantity_is_refused_with_key_value_and_example(text, dimension, words):
    with pytest.raises(InputError, match=words) as refusal:
        to_si(text, dimension, "gear.a.module")
    assert str(refusal.value).startswith("gear.a.module = ")
