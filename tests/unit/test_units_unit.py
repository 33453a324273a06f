"""Units at the door: ``number unit`` as engineers spell it equals pint, and anything else is refused in words."""

import functools
import math
import re
import time
from pathlib import Path

import pint
import pytest

from fegear.base.errors import InputError
from fegear.base.units import DIMENSIONS, EVERYDAY, PER_SI, UNITS, as_text, registry, to_si, unit_size

EVERY = [
    (dimension, unit, size)
    for dimension, units in EVERYDAY.items()
    for unit, size in units.items()
    if dimension != "temperature"  # has an offset, and a test of its own
]
#: What pint's own registry calls otherwise.
IN_PINTS_WORDS = {
    "uin": "1e-6*inch", "thou": "1e-3*inch", "daN": "10*N", "U": "turn", "rev": "turn", "Mpsi": "1e6*psi", "Nm": "N*m",
    "kNm": "kN*m", "MNm": "MN*m", "Nmm": "N*mm", "Ncm": "N*cm", "Ns": "N*s", "Nms": "N*m*s", "kgm^2": "kg*m^2",
    "kgmm^2": "kg*mm^2", "Nm/rad": "N*m/rad", "kNm/rad": "kN*m/rad", "Nms/rad": "N*m*s/rad", "Ns/m": "N*s/m",
    "lbf*inch": "force_pound*inch", "Pas": "Pa*s", "mPas": "mPa*s",
    "PS": "75*m*kgf/s", "HBW": "HV/0.95", "HB": "HV/0.95", "ustrain": "um/m", "microstrain": "um/m",
}  # fmt: skip
#: Where a rotational speed is meant, a cycle is a revolution; where a frequency is meant, a revolution is a cycle.
CYCLES = {"speed": {"1/min", "1/s", "Hz"}}


@functools.lru_cache(maxsize=1)
def whole_pint():
    made = pint.UnitRegistry()
    made.define("HV = [hardness]")  # pint knows no hardness; HBW = 0.95 HV is ISO 18265's
    return made


def by_pint(unit: str) -> float:
    return (1.0 * whole_pint()(IN_PINTS_WORDS.get(unit, unit))).to_base_units().magnitude


@pytest.mark.parametrize(("dimension", "unit", "size"), EVERY)
def test_everyday_units_equal_pint(dimension, unit, size):
    expected = by_pint(unit)
    if unit in CYCLES.get(dimension, ()):
        expected *= 2.0 * math.pi
    if dimension == "frequency" and unit == "rpm":
        expected /= 2.0 * math.pi
    assert size == pytest.approx(expected, rel=1e-14)
    assert to_si(f"3.7 {unit}", dimension) == 3.7 * size


@pytest.mark.parametrize("unit", sorted(UNITS))
def test_every_unit_that_is_known_has_the_size_that_pint_gives_it(unit):
    ours = registry().Quantity(1.0, unit).to_base_units()
    assert ours.magnitude == pytest.approx(by_pint(unit), rel=1e-14, abs=0.0)


@pytest.mark.parametrize("unit", sorted(set(PER_SI) - {"degC"}))
def test_units_of_tables_equal_pint(unit):
    quantity = whole_pint().Quantity(1.0, unit).to_base_units()
    assert PER_SI[unit] * quantity.magnitude == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "celsius"),
    [
        ("60 degC", 60.0),
        ("60 \u00b0C", 60.0),
        ("-40 degF", -40.0),
        ("140 \u00b0F", 60.0),
        ("333.15 K", 60.0),
        ("0 K", -273.15),
    ],
)
def test_temperatures_equal_pint_offset_and_all(text, celsius):
    assert to_si(text, "temperature") == pytest.approx(celsius, abs=1e-12)
    number, unit = text.split()
    unit = {"\u00b0C": "degC", "\u00b0F": "degF", "K": "kelvin"}.get(unit, unit)
    assert whole_pint().Quantity(float(number), unit).to("degC").magnitude == pytest.approx(celsius, abs=1e-12)
    read = as_text(whole_pint().Quantity(float(number), unit), "temperature")
    assert to_si(read, "temperature") == pytest.approx(celsius, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("60", "has no unit"), (60, "has no unit;"), ("60 C", "unknown unit"), ("60 mm", "not a temperature"),
        ("-1 K", "absolute zero"), ("-274 degC", "absolute zero"), ("60 deg", "not a temperature"),
    ],
)  # fmt: skip
def test_what_is_no_temperature_is_refused(text, rule):
    with pytest.raises(InputError, match=rule):
        to_si(text, "temperature")


def test_every_dimension_reads_its_own_example():
    assert set(EVERYDAY) == set(DIMENSIONS)
    for dimension, asked in DIMENSIONS.items():
        assert math.isfinite(to_si(asked.example, dimension))
        assert unit_size(asked.si, dimension) == pytest.approx(1.0, rel=1e-15)


RPM, REVOLUTION = math.pi / 30.0, 2.0 * math.pi


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("3.175 mm", "length", 3.175e-3),
        (" 3.175mm ", "length", 3.175e-3),
        ("3.175\u00a0mm", "length", 3.175e-3),
        (".5 inch", "length", 0.0127),
        ("3 \u00b5m", "length", 3e-6),  # the micro sign
        ("3 \u03bcm", "length", 3e-6),  # the Greek letter
        ("3 um", "length", 3e-6),
        ("2 feet", "length", 0.6096),
        ("8 / inch", "inverse_length", 8 / 0.0254),
        ("8/inch", "inverse_length", 8 / 0.0254),
        ("8 1/in", "inverse_length", 8 / 0.0254),
        ("8 inch^-1", "inverse_length", 8 / 0.0254),
        ("30e6 psi", "pressure", 30e6 * 6894.757293168361),
        ("500 N/mm2", "pressure", 500e6),
        ("500 N/mm^2", "pressure", 500e6),
        ("500 N/mm**2", "pressure", 500e6),
        ("500 N / mm\u00b2", "pressure", 500e6),
        ("206.8 kN/mm2", "pressure", 206.8e9),
        ("-0.5 deg", "angle", -0.5 * math.pi / 180),
        ("\u22120.5 deg", "angle", -0.5 * math.pi / 180),
        ("20\u00b0", "angle", 20 * math.pi / 180),
        ("20 \u00b0", "angle", 20 * math.pi / 180),
        ("3'", "angle", math.pi / 3600),
        ("3 \u2032", "angle", math.pi / 3600),
        ("1e-3 N/mm", "line_load", 1.0),
        ("250 N / mm", "line_load", 250e3),
        ("1 lbf/in", "line_load", 175.12683524647636),
        ("200 Nm", "torque", 200.0),
        ("200 N m", "torque", 200.0),
        ("200 N\u00b7m", "torque", 200.0),
        ("200 N.m", "torque", 200.0),
        ("1.5 kNm", "torque", 1500.0),
        ("1 kN m", "torque", 1000.0),
        ("100 lbf ft", "torque", 135.58179483314004),
        ("3000 rpm", "speed", 3000 * RPM),
        ("3000 1/min", "speed", 3000 * RPM),
        ("3000 /min", "speed", 3000 * RPM),
        ("3000 min^-1", "speed", 3000 * RPM),
        ("3000 min-1", "speed", 3000 * RPM),
        ("3000 min\u207b\u00b9", "speed", 3000 * RPM),
        ("3000 U/min", "speed", 3000 * RPM),
        ("3000 rev/min", "speed", 3000 * RPM),
        ("50 Hz", "speed", 50 * REVOLUTION),
        ("50 1/s", "speed", 50 * REVOLUTION),
        ("50 s^-1", "speed", 50 * REVOLUTION),
        ("50 rad/s", "speed", 50.0),
        ("6000 rpm", "frequency", 100.0),
        ("6000 1/min", "frequency", 100.0),
        ("100 rad/s", "frequency", 100.0 / REVOLUTION),
        ("3.5 kHz", "frequency", 3500.0),
        ("12 kg mm^2", "inertia", 12e-6),
        ("12 kgm\u00b2", "inertia", 12.0),
        ("1 lb in^2", "inertia", 2.926396534292e-4),
        ("2.18e4 Nm/rad", "torsional_stiffness", 2.18e4),
        ("380 N m/deg", "torsional_stiffness", 380 * 180 / math.pi),
        ("2.18e4 N m", "torsional_stiffness", 2.18e4),
        ("12.6 Nms", "torsional_damping", 12.6),
        ("1 N/(mm um)", "pressure", 1e9),
        ("20 cP", "viscosity", 0.02),
    ],
)
def test_quantities_are_read(text, dimension, value):
    assert to_si(text, dimension) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "dimension", "words"),
    [
        ("3,175 mm", "length", 'write "3.175 mm"'),
        ("100,5 N*m", "torque", r'write "100.5 N\*m"'),
        ("1,5 kN", "force", 'write "1.5 kN"'),
        ("1,234.5 mm", "length", 'write "1234.5 mm"'),
        ("1.234,5 mm", "length", "decimal point"),
        ("1 500 N", "force", 'write "1500 N"'),
        ("1'500 N", "force", 'write "1500 N"'),
        ("1_500 N", "force", 'write "1500 N"'),
        ("1 1/2 in", "length", 'write "1.5 in"'),
        ("1/8 inch", "length", 'write "0.125 inch"'),
        ("11/inch", "inverse_length", 'write "11 / inch"'),
        ("N", "force", "must begin with a number"),
        ("20", "angle", "has no unit, but an angle needs one; an angle is expected, e.g. in deg, rad"),
        ("3", "length", "has no unit, but a length needs one; a length is expected, e.g. in mm, um, m, inch"),
        ("3 N", "length", "is not a length; a length is expected, e.g. in mm, um, m, inch"),
        (3.0, "length", "has no unit;"),
        ("three mm", "length", "must begin with a number"),
        ("", "length", "must begin with a number"),
        ("9**9**9**9 mm", "length", "is not a number and a unit"),
        ("9^9^9^9 mm", "length", "is not a number and a unit"),
        ("3 mm^99999999", "length", "is not a number and a unit"),
        ("3 mm + 4 mm", "length", "is not a number and a unit"),
        ("2 * 3 mm", "length", "is not a number and a unit"),
        ("(3 mm)", "length", "must begin with a number"),
        ("3 mm 4", "length", "is not a number and a unit"),
        ("3.175.2 mm", "length", "is not a number and a unit"),
        ("20\u00b0 30'", "angle", "is not a number and a unit"),
        ("\u0663 mm", "length", "must begin with a number"),  # a digit of another script
        ("1e999 mm", "length", "finite"),
        ("1e400 mm", "length", "finite"),
        ("nan mm", "length", "must begin with a number"),
        ("inf mm", "length", "must begin with a number"),
        ("3 Mm", "length", 'unknown unit "Mm"'),
        ("3 mms", "length", 'unknown unit "mms"'),
        ("3 NM", "torque", 'unknown unit "NM"'),
        ("3 Mpa", "pressure", 'unknown unit "Mpa"'),
        ("5 lb/in", "stiffness", "the force is lbf"),
        ("500 N*m/rad", "torque", "is not a torque"),
        ("5 rad/N", "compliance", "is not a compliance"),
        ("1 N/mm um", "pressure", "is ambiguous: denominator unclear in"),
        ("7 " + 1000 * "m", "length", "longer than"),
        (True, "length", "must be a length"),
        (["1 mm"], "length", "must be a length"),
    ],
)
def test_what_is_no_quantity_is_refused_with_key_value_and_example(text, dimension, words):
    with pytest.raises(InputError, match=words) as refusal:
        to_si(text, dimension, "gear.a.module")
    assert str(refusal.value).startswith("gear.a.module = ")
    assert len(str(refusal.value)) < 250
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("number", "unit", "dimension", "value"),
    [(3000, "1/min", "speed", 3000 * RPM), (50, "Hz", "speed", 50 * REVOLUTION), (3000, "rpm", "speed", 3000 * RPM),
     (50, "rad/s", "speed", 50.0), (6000, "rpm", "frequency", 100.0), (50, "turn/s", "speed", 50 * REVOLUTION),
     (20, "degree", "angle", math.pi / 9), (3, "km", "length", 3000.0)],
)  # fmt: skip
def test_quantities_of_pint_mean_what_their_text_means(number, unit, dimension, value):
    assert to_si(as_text(whole_pint().Quantity(number, unit), dimension), dimension) == pytest.approx(value, rel=1e-14)


def test_a_plain_number_of_pint_is_no_angle():
    with pytest.raises(InputError, match="has no unit"):
        to_si(as_text(whole_pint().Quantity(20.0), "angle"), "angle")


def test_no_text_takes_long_to_refuse():
    hostile = [
        "9**9**9**9 mm",
        "1e999999999 mm",
        "3 " + 40 * "m ",
        "3 " + 49 * "(m",
        "1 2 " * 25,
        "1" * 99 + ",",
        "1 000" * 20,
    ]
    start = time.process_time()
    for text in hostile:
        with pytest.raises(InputError):
            to_si(text, "length")
    assert time.process_time() - start < 2.0  # 0.1 s or so of the processor; one that is computed takes minutes


def test_a_unit_of_a_column_is_named_as_the_head_has_it():
    assert unit_size("um/N", "compliance") == 1e-6
    with pytest.raises(InputError, match=r'column x = "N": is not a length'):
        unit_size("N", "length", "column x")
    with pytest.raises(InputError, match="has no unit"):
        unit_size("", "angle", "column roll_angle")


def test_units_leave_nothing_on_the_disk(tmp_path, monkeypatch):
    for name in ("HOME", "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.setenv(name, str(tmp_path))
    registry.__wrapped__().parse_expression("lb*inch^2")
    assert not list(tmp_path.iterdir())


def test_the_docs_list_every_unit():
    page = (Path(__file__).parents[2] / "docs" / "case-files.md").read_text("utf-8")
    section = page[page.index("## Quantities") : page.index("## The case itself")]
    listed = set(re.findall(r"[A-Za-z]+", " ".join(re.findall(r"`([^`]+)`", section))))
    assert set(UNITS) <= listed


@pytest.mark.parametrize(
    ("text", "thousands"),
    [("1,234 mm", True), ("123,456 mm", True), ("-12,500 mm", True), ("1234,567 mm", False), ("0,125 mm", False),
     ("1,25 mm", False), ("1,2345 mm", False)],
)  # fmt: skip
def test_a_comma_may_separate_thousands_only_behind_three_digits_at_most(text, thousands):
    number, unit = text.split()
    with pytest.raises(InputError, match="contains a comma") as refused:
        to_si(text, "length")
    assert f'write "{number.replace(",", ".")} {unit}"' in str(refused.value)
    assert ("if the comma separates thousands" in str(refused.value)) == thousands
    if thousands:
        assert f'or "{number.replace(",", "")} {unit}"' in str(refused.value)
