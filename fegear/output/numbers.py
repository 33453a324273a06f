"""Numbers as people read them: as many digits as the error leaves, units with their signs."""

from __future__ import annotations

import math
from collections.abc import Iterable

from fegear.base.printed import percent
from fegear.engine.value import Value

_SIGNS = (("um", "µm"), (".", "·"), ("^2", "²"), ("^3", "³"))


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


#: Differences of large numbers, as a peak to peak, miss a sharp tolerance by little without anybody being misled.
_MISLEADING = 0.01
#: So many values are named whose errors are too large; of the others it is said how many.
_NAMED = 4
#: A value so small compared with its error is the round-off of zero.
_ROUND_OFF = 1e-9


def beyond_tolerance(values: Iterable[Value], tolerance: float) -> str:
    """Which values are known less well than the tolerance requires and than 1 %, the worst first; empty if none is.

    Parameters
    ----------
    values : iterable of Value
    tolerance : float
        Relative, of ``[accuracy]``.
    """
    found = sorted(
        ((one.error / abs(one.value), one) for one in values if one.error and abs(one.value) > _ROUND_OFF * one.error),
        key=lambda pair: -pair[0],
    )
    found = [(share, one) for share, one in found if share > max(tolerance, _MISLEADING)]
    if not found:
        return ""
    named = "; ".join(f"{one!r} ({percent(share)})" for share, one in found[:_NAMED])
    more = f"; and {len(found) - _NAMED} more" if len(found) > _NAMED else ""
    limit = f"{100.0 * tolerance:g} %"
    beyond = (
        f"the tolerance of {limit}" if tolerance >= _MISLEADING else f"{100.0 * _MISLEADING:g} % (tolerance {limit})"
    )
    return f"Estimated errors above {beyond}: {named}{more}."
