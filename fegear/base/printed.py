"""Numbers in sentences that people read: shares in per cent, values with the digits of their errors."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

#: Significant digits of a value without an error; whole numbers are written out up to the limit.
_DIGITS, _WHOLE = 6, 1e9
#: Digits that a float holds; no error asks for more.
_MOST = 10
#: An error above this share of a number is said with it.
_ROUGH = 0.5
#: Above this one `rounded` keeps a single digit, fewer than a single value has that is printed with its error.
_SAID = 0.1
#: Shares below this are zero but for rounding.
_ROUNDING = 1e-12
#: Counts that sentences write out.
_COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")


def percent(share: float, signed: bool = False, whole: bool = False) -> str:
    """A share in per cent with two or three figures and a space before the sign.

    Parameters
    ----------
    share : float
    signed : bool
        Write the sign of a positive share as well.
    whole : bool
        Round to whole per cent.

    Returns
    -------
    str
        ``"41 %"``, ``"-3.2 %"``, ``"0.32 %"``, ``"0.0041 %"``.
    """
    size = abs(share)
    if not math.isfinite(share):
        return f"{share} %"
    if size < _ROUNDING:
        share = size = 0.0
    # Decimals of the share as it is rounded: the last bit of a tenth does not decide between "10 %" and "10.0 %".
    decimals = 0 if whole else _decimals(round(size, 2 + _decimals(size)))
    return f"{100.0 * share:{'+' if signed else ''}.{decimals}f} %"


def _decimals(size: float) -> int:
    if size >= 0.1 or size == 0.0:
        return 0
    if size >= 0.01:
        return 1
    return 2 if size >= 0.001 else 1 - math.floor(math.log10(100.0 * size))


def percents(low: float, high: float) -> str:
    """A range of shares in per cent, as `percent`: ``"41 % to 52 %"``; one value where both read the same."""
    first, last = percent(low), percent(high)
    return first if first == last else f"{first} to {last}"


def in_words(count: int) -> str:
    """A count of a sentence: ``"three"``, ``"14"``."""
    return _COUNTS[count] if count < len(_COUNTS) else str(count)


def column_figures(values: Sequence[float], digits: int = 4) -> list[str]:
    """Rounded numbers of one column, all with the decimals that the largest of them has: ``["0.978", "1.002"]``.

    Parameters
    ----------
    values : sequence of float
        Empty where they are not finite.
    digits : int
        Significant ones of the largest.
    """
    known = [abs(one) for one in values if math.isfinite(one)]
    largest = max(known, default=0.0)
    decimals = max(digits - 1 - math.floor(math.log10(largest)), 0) if largest else 0
    if all(abs(one - round(one)) < 0.5 * 10.0**-decimals for one in known):
        decimals = 0
    return [f"{one:.{decimals}f}" if math.isfinite(one) else "" for one in values]


def plain(value: float) -> str:
    """A value without an error: six significant digits, whole numbers written out."""
    if math.isfinite(value) and value == round(value) and abs(value) < _WHOLE:
        return f"{value:.0f}"
    return f"{value:.{_DIGITS}g}"


def figures(value: float, digits: int = 3, signed: bool = False) -> str:
    """A rounded number of a sentence, large ones without a power of ten.

    Parameters
    ----------
    value : float
    digits : int
        Significant ones.
    signed : bool
        Write the sign of a positive number as well.

    Returns
    -------
    str
        ``"-1380"``, ``"12.3"``, ``"0.00456"``.
    """
    if math.isfinite(value) and abs(value) < _WHOLE:
        value = float(f"{value:.{digits}g}")
        if abs(value) >= 10.0**digits:
            return f"{value:{'+' if signed else ''}.0f}"
    return f"{value:{'+' if signed else ''}.{digits}g}"


def rounded(value: float, error: float | None = None, digits: int = 3) -> str:
    """A number as a person says it: few digits, none beyond the leading one of its error.

    Parameters
    ----------
    value : float
    error : float, optional
        Estimated absolute error; None or zero where there is none.
    digits : int
        Significant ones at most.

    Returns
    -------
    str
        ``"11.7"``, ``"12"`` with an error of 2, ``"1 +- 3"`` where the error exceeds half of the number.
    """
    if not math.isfinite(value) or value == 0.0:
        return figures(value, digits)
    if not error or not math.isfinite(error):
        return figures(value, digits)
    if error > _ROUGH * abs(value):
        return f"{figures(value, 1)} +- {figures(error, 1)}"
    room = math.floor(math.log10(abs(value))) - math.floor(math.log10(error)) + 1
    return figures(value, max(1, min(digits, room)))


def with_rough_error(value: float, error: float | None = None) -> str:
    """A number of a sentence, with its error where that leaves it a single digit: ``"731 +- 260"``, else `rounded`.

    Parameters
    ----------
    value : float
    error : float, optional
        Estimated absolute error.
    """
    if error and math.isfinite(error) and error > _SAID * abs(value):
        return with_its_error(value, error)
    return rounded(value, error)


def unit_said(unit: str) -> str:
    """A unit as a sentence has it: ``µm``, ``N m``, ``MPa·√m``."""
    return unit.replace(".m^(1/2)", "·√m").replace("um", "µm").replace(".", " ")


def with_its_error(value: float, error: float) -> str:
    """Value and error, both to the error's second significant digit: ``"7.6187 +- 0.0034"``, ``"12350 +- 230"``.

    Parameters
    ----------
    value : float
    error : float
        Positive.
    """
    if not (math.isfinite(value) and math.isfinite(error)):
        return f"{value:.{_DIGITS}g} +- {error:.2g}"
    size = max(abs(value), error)
    if not 1e-4 <= size < 1e7:
        decimals = math.floor(math.log10(size)) - math.floor(math.log10(error)) + 1
        return f"{value:.{max(0, min(decimals, _MOST))}e} +- {error:.1e}"
    decimals = 1 - math.floor(math.log10(error))
    if decimals < 0:
        value, error = round(value, decimals), round(error, decimals)
    most = _MOST - math.floor(math.log10(size))
    shown = f"{value:.{max(0, min(decimals, most))}f}"
    if float(shown) == 0.0:
        shown = shown.replace("-", "")
    small = f"{error:.{max(0, decimals)}f}" if decimals <= _DIGITS else f"{error:.2g}"
    return f"{shown} +- {small}"
