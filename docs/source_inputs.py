"""Whether a case holds the printed number that it is compared with: then it cannot but come out."""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pint
from source_runs import unit_of

from fegear.base.unit_text import UnreadableError, split

if TYPE_CHECKING:
    from source_runs import Found

#: Members from which on an evenly spaced list of a case is a grid that knows no answer.
_NEUTRAL = 10


def answer_in_input(printed: Found, case: dict[str, Any]) -> str:
    """The key of a case under which a printed number is given, or nothing.

    A member of a list counts, unless the list is evenly spaced and long, as a grid is that knows no answer; a single
    value counts unless it is 0 or 1, which are given for other reasons.
    """
    for key, values in _given(case):
        alone = len(values) == 1
        if (alone and printed.value in (0.0, 1.0)) or _neutral(values):
            continue
        if any(_is_printed(value, printed) for value in values):
            return key
    return ""


def _given(part: Any, key: str = "") -> list[tuple[str, list[Any]]]:
    """Numbers of a case by their keys, those of a list together."""
    if isinstance(part, dict):
        return [one for name, below in part.items() for one in _given(below, f"{key}.{name}".lstrip("."))]
    if isinstance(part, list):
        plain = [one for one in part if not isinstance(one, (dict, list))]
        return [(key, plain)] * bool(plain) + [found for one in part if one not in plain for found in _given(one, key)]
    return [(key, [part])] if isinstance(part, (int, float, str)) and not isinstance(part, bool) else []


@cache
def _size(value: float | str) -> Any:
    """A number of a case with its unit; none where it is a word."""
    try:
        number, unit = split(value) if isinstance(value, str) else (float(value), "")
        return number * unit_of(unit)
    except (UnreadableError, pint.UndefinedUnitError):
        return None


def _is_printed(value: Any, printed: Found) -> bool:
    size, wanted = _size(value), printed.value * unit_of(printed.unit)
    if size is None or not size.is_compatible_with(wanted):
        return False
    return math.isclose(size.to(wanted.units).magnitude, wanted.magnitude, rel_tol=1e-9)


def _neutral(values: list[Any]) -> bool:
    """Whether a list is evenly spaced and long; its last member may be the end of the range."""
    sizes = [_size(value) for value in values]
    if len(values) < _NEUTRAL or any(size is None for size in sizes):
        return False
    found = [size.to_base_units().magnitude for size in sizes]
    steps = [b - a for a, b in pairwise(found[:-1])]
    return max(steps) - min(steps) <= 1e-6 * max(map(abs, steps))
