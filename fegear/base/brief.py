"""How results show themselves in a terminal: a line or two, whatever they hold.

What dataclasses write by themselves repeats everything within them: a loaded pair took two hundred lines.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass

import numpy as np

#: Members of a list, and numbers of an array, that are written out.
_FEW = 4
#: Most characters of a text within.
_TEXT = 60


class Brief:
    """Base of dataclasses that write their fields without what is within these."""

    __slots__ = ()

    def __init_subclass__(cls) -> None:
        """Take the place of what the decorator of a dataclass would write."""
        super().__init_subclass__()
        if "__repr__" not in cls.__dict__:
            cls.__repr__ = _written  # type: ignore[method-assign]  # on purpose


def _written(self: object) -> str:
    given = (f"{one.name}={brief(getattr(self, one.name))}" for one in fields(self) if one.repr)  # type: ignore[arg-type]  # only dataclasses have it
    return f"{type(self).__qualname__}({', '.join(given)})"


def brief(value: object, depth: int = 1) -> str:
    """Write a value in a few words.

    Parameters
    ----------
    value : object
    depth : int
        So many lists within each other are opened.
    """
    if isinstance(value, np.ndarray):
        if value.size <= _FEW and value.dtype != object:
            return np.array2string(value, precision=6, separator=", ", max_line_width=10_000).replace("\n", "")
        return f"<array {' x '.join(map(str, value.shape))}>"
    if isinstance(value, str):
        return repr(value if len(value) <= _TEXT else f"{value[:_TEXT]}...")
    if isinstance(value, (bool, int, type(None))):
        return repr(value)
    if isinstance(value, (float, complex, np.generic)):
        return f"{value:.6g}" if isinstance(value, (float, complex, np.floating)) else repr(value)
    if is_dataclass(value) and not isinstance(value, type):
        return f"{type(value).__qualname__}(...)"
    if isinstance(value, Mapping):
        inner = [f"{key!r}: {brief(one, depth - 1)}" for key, one in list(value.items())[:_FEW]]
        return _closed("{}", inner, len(value), depth)
    if isinstance(value, (tuple, list)):
        inner = [brief(one, depth - 1) for one in value[:_FEW]]
        return _closed("()" if isinstance(value, tuple) else "[]", inner, len(value), depth)
    if isinstance(value, Callable):  # type: ignore[arg-type]  # an abstract class of Python
        return f"<{getattr(value, '__qualname__', type(value).__qualname__)}>"
    return f"{type(value).__qualname__}(...)"


def _closed(ends: str, inner: list[str], count: int, depth: int) -> str:
    """A list between its ends, its members counted where they are not written."""
    if not count:
        return ends
    if depth <= 0:
        return f"{ends[0]}{count} of them{ends[1]}"
    more = f", ... {count} in all" if count > len(inner) else "," if ends == "()" and count == 1 else ""
    return f"{ends[0]}{', '.join(inner)}{more}{ends[1]}"
