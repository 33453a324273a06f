"""Numbers in sentences: rounded, and large ones without a power of ten."""

import math

import pytest

from fegear.base.printed import figures, percent, with_its_error, with_rough_error


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (-1383.2, 3, "-1380"), (12.345, 3, "12.3"), (0.0045678, 3, "0.00457"), (999.6, 3, "1000"),
        (30_000.0, 4, "30000"), (0.0, 3, "0"), (123_456_789.0, 5, "123460000"), (5.4321e12, 3, "5.43e+12"),
        (math.inf, 3, "inf"),
    ],
)  # fmt: skip
def test_a_number_of_a_sentence_is_rounded(value, digits, text):
    """A change of load was "-1.38e+03 N", a pressure "1e+04 MPa"."""
    assert figures(value, digits) == text
    if value > 0.0:
        assert figures(value, digits, signed=True) == f"+{text}"


@pytest.mark.parametrize(
    ("error", "text"), [(260.0, "730 +- 260"), (80.0, "731 +- 80"), (70.0, "730"), (3.0, "731"), (None, "731")]
)
def test_a_rough_number_has_its_error_where_one_digit_would_stay(error, text):
    """A list had "731 +- 260 um/m" and the answer "700 um/m"."""
    assert with_rough_error(731.0, error) == text


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (12_345.6, 234.0, "12350 +- 230"), (12_345.6, 2340.0, "12300 +- 2300"), (-1852.4, 317.2, "-1850 +- 320"),
        (407.0, 740.0, "410 +- 740"), (40.0, 740.0, "40 +- 740"), (731.2, 99.4, "731 +- 99"),
        (7.61867, 0.0034, "7.6187 +- 0.0034"),
    ],
)  # fmt: skip
def test_a_value_and_its_error_end_at_the_same_digit(value, error, text):
    """Above errors of 100 the value kept its units: "1852 +- 317 MPa"."""
    assert with_its_error(value, error) == text


def test_rounding_is_no_share():
    assert percent(5.6e-16) == percent(-3e-15) == percent(0.0)
    assert percent(1e-9) == "0.00000010 %"


@pytest.mark.parametrize(
    ("share", "text"), [(0.1, "10 %"), (0.01, "1.0 %"), (0.001, "0.10 %"), (1e-4, "0.010 %"), (1e-6, "0.00010 %")]
)
def test_the_last_bit_of_a_share_adds_no_digit(share, text):
    """A verdict said "10 %" on one processor and "10.0 %" on another."""
    assert percent(math.nextafter(share, 0.0)) == percent(share) == percent(math.nextafter(share, 1.0)) == text
    assert percent(-math.nextafter(share, 0.0), signed=True) == "-" + text
