"""What a script may write for a quantity."""

from __future__ import annotations

import reprlib
from typing import TYPE_CHECKING, Any, TypeAlias

from fegear.units import as_text, to_si

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pint

#: A text with its unit (``"3 mm"``), a quantity of pint, or a number in SI.
Length: TypeAlias = "str | float | pint.Quantity[Any]"
Torque: TypeAlias = Length
Force: TypeAlias = Length
Speed: TypeAlias = Length


_brief = reprlib.Repr()
_brief.maxlist = _brief.maxdict = 4
_brief.maxstring = _brief.maxother = 60


def brief(value: object) -> str:
    """Write what was given, long lists cut short."""
    return _brief.repr(value)


def in_si(value: Length, dimension: str, key: str) -> float:
    """A quantity in SI.

    Raises
    ------
    InputError
        If it has another dimension or cannot be read.
    """
    return to_si(as_text(value, dimension, bare_si=True), dimension, key)


def listed(value: Any) -> list[Any] | None:
    """The members of a list, tuple, range or array of quantities; None for a single one."""
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        return None
    try:
        several: Iterable[Any] = iter(value)
    except TypeError:  # a quantity of pint that holds one number
        return None
    return list(several)
