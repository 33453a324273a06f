"""A typed quantity one step up or down, as the arrow keys change it."""

from __future__ import annotations

import re
from decimal import Decimal

_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(.*)", re.DOTALL)


def stepped(text: str, steps: int) -> str | None:
    """The text with its leading number changed by so many units of its last digit; None where there is no number.

    Parameters
    ----------
    text : str
        ``23``, ``0.30``, ``20 deg``.
    steps : int

    Returns
    -------
    str or None
        As many decimals as before; the unit stays.
    """
    found = _NUMBER.fullmatch(text)
    if found is None:
        return None
    number = Decimal(found[1])
    exponent = number.as_tuple().exponent
    if not isinstance(exponent, int):
        return None
    unit = Decimal(1).scaleb(exponent)
    made = number + steps * unit
    return f"{made:f}{found[2]}" if "e" not in found[1].lower() else f"{made}{found[2]}"
