"""Whether a case holds the printed number that it is compared with: then it cannot but come out."""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise, takewhile
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

    A member of a list counts, unless it stands in a long evenly spaced part of it, as of a grid that knows no answer; a
    single value counts unless it is 0 or 1, which are given for other reasons.
    """
    for key, values in _given(case):
        alone = len(values) == 1
        if alone and printed.value in (0.0, 1.0):
            continue
        if any(_is_printed(value, printed) and not _neutral(values, at) for at, value in enumerate(values)):
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


def _neutral(values: list[Any], at: int) -> bool:
    """Whether a member of a list stands in a long evenly spaced part; the last one may be the end of the range."""
    sizes = [_size(value) for value in values]
    if len(values) < _NEUTRAL or any(size is None for size in sizes):
        return False
    found = [size.to_base_units().magnitude for size in sizes]
    steps = [b - a for a, b in pairwise(found)]
    beside = [at - 1, at, *([at - 2] if at == len(steps) else [])]
    return max(_alike(steps, k) for k in beside if 0 <= k < len(steps)) + 1 >= _NEUTRAL


def _alike(steps: list[float], at: int) -> int:
    """How many steps on end, this one among them, are equal."""
    before, after = steps[: at + 1][::-1], steps[at:]
    return (
        sum(len(list(takewhile(lambda s: math.isclose(s, steps[at], rel_tol=1e-6), way))) for way in (before, after))
        - 1
    )
