"""What a script may write for a quantity."""

from __future__ import annotations

import reprlib
from typing import TYPE_CHECKING, Any, TypeAlias

from fegear.base.units import as_text, to_si
from fegear.workbench.given import taken

if TYPE_CHECKING:
    import pint


#: A text with its unit (``"3 mm"``), a quantity of pint, or a number in SI.
Quantity: TypeAlias = "str | float | pint.Quantity[Any]"

Length: TypeAlias = Quantity

Torque: TypeAlias = Quantity

Force: TypeAlias = Quantity

Speed: TypeAlias = Quantity

_brief = reprlib.Repr()

_brief.maxlist = _brief.maxdict = 4

_brief.maxstring = _brief.maxother = 60


def brief(value: object) -> str:
    """Write what was given, long lists cut short."""
    return _brief.repr(value)


def in_si(value: Quantity, dimension: str, key: str) -> float:
    """A quantity in SI.

    Raises
    ------
    InputError
        If it has another dimension or cannot be read.
    """
    return to_si(as_text(value, dimension, bare_si=True), dimension, key)


def listed(value: Any, key: str) -> list[Any] | None:
    """The members of a list, tuple, range or array of quantities; None for a single one."""
    found = taken(value, key)
    return found if isinstance(found, list) else None
