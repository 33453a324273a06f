"""Values that are known less well than a case asks for, and too little to be relied on."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.notes import exceeding
from fegear.base.printed import percent

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.engine.value import Value

#: Differences of large numbers, as a peak to peak, miss a sharp tolerance by little without anybody being misled.
_MISLEADING = 0.01
#: So many values are named whose errors are too large; of the others it is said how many.
_NAMED = 4
#: A value so small compared with its error is the round-off of zero.
_ROUND_OFF = 1e-9
#: Digits of relative errors that put them in order: mirrored halves differ by round-off.
_ORDERED = 6


def is_inexact(value: Value, tolerance: float) -> bool:
    """Whether a value is known less well than the tolerance requires and than 1 %: enough to change a decision.

    One that is meant to be zero is not: `Outcome` compares its error with the values beside it; nor is a choice.
    """
    if value.zero or value.choice or not value.error or abs(value.value) <= _ROUND_OFF * value.error:
        return False
    return value.error > max(tolerance, _MISLEADING) * abs(value.value)


def inexact_values(values: Iterable[Value], tolerance: float) -> str:
    """Which values are known less well than the tolerance requires and than 1 %, the worst first; empty if none is.

    Parameters
    ----------
    values : iterable of Value
    tolerance : float
        Relative, of ``[accuracy]``.
    """
    found = sorted(
        ((one.error / abs(one.value), one) for one in values if one.error and is_inexact(one, tolerance)),
        key=lambda pair: -float(f"{pair[0]:.{_ORDERED}g}"),  # equal ones in their own order
    )
    if not found:
        return ""
    named = "; ".join(f"{one!r} ({percent(share)})" for share, one in found[:_NAMED])
    more = f"; and {len(found) - _NAMED} more" if len(found) > _NAMED else ""
    limit = f"{100.0 * tolerance:g} %"
    beyond = (
        f"the tolerance of {limit}" if tolerance >= _MISLEADING else f"{100.0 * _MISLEADING:g} % (tolerance {limit})"
    )
    return exceeding(f"Estimated errors above {beyond}: {named}{more}.")
