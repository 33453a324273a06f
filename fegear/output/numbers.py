"""Numbers as people read them: as many digits as the error leaves, units with their signs."""

from __future__ import annotations

import math

_SIGNS = (("m^(1/2)", "√m"), ("um", "µm"), (".", "·"), ("^2", "²"), ("^3", "³"))


#: Errors below this share of the value are given as a share; digits that a float does not hold are not.
_DIGITS = 10


_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def pretty_unit(unit: str) -> str:
    """``um.mm/N`` as ``µm·mm/N``; degrees get their sign."""
    for plain, sign in _SIGNS:
        unit = unit.replace(plain, sign)
    return {"deg": "°", "degC": "°C"}.get(unit, unit)


def _power(exponent: int) -> str:
    return f"·10{str(exponent).translate(_SUPERSCRIPTS)}"


def plain_number(value: float, digits: int = 6) -> str:
    """A number with up to `digits` significant digits, powers of ten written out."""
    if not math.isfinite(value):
        return "none" if math.isnan(value) else ("∞" if value > 0.0 else "-∞")
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text.replace("-", "−")
    mantissa, exponent = text.split("e")
    return mantissa.replace("-", "−") + _power(int(exponent))


def with_error(value: float, error: float) -> tuple[str, str]:
    """Value and error, both to the error's second significant digit.

    Parameters
    ----------
    value : float
    error : float
        Positive.

    Returns
    -------
    value, error : str
        ``("0.039148", "0.000030")``; both with the same power of ten where the value is very large or small.
    """
    if not (math.isfinite(value) and math.isfinite(error)):
        return plain_number(value), plain_number(error, 2)
    size = max(abs(value), error)
    exponent = math.floor(math.log10(size))
    shift = exponent if not -4 <= exponent < 6 else 0
    value, error = value / 10.0**shift, error / 10.0**shift
    decimals = 1 - math.floor(math.log10(error))
    decimals = max(0, min(decimals, _DIGITS - (exponent - shift)))
    power = _power(shift) if shift else ""
    shown = f"{value:.{decimals}f}".replace("-", "−")
    if float(f"{value:.{decimals}f}") == 0.0:
        shown = shown.replace("−", "")
    left = f"{error:.{decimals}f}"
    if float(left) == 0.0:
        left = f"{error:.0e}"
    return shown + power, left + power
