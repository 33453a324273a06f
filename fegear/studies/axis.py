"""``--over KEY=START:STOP:COUNT``: one axis of a sweep."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import dataclass
from typing import Any

import numpy as np

from fegear.errors import InputError

_EXAMPLE = "for example --over gear.a.profile_shift=-0.4:0.8:25, =0.1,0.2,0.5 or =10:20:6:mm"
_QUANTITY = re.compile(r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*([^\s0-9].*|1\s*/.*)?")
_MOST = 1_000_000


@dataclass(frozen=True, slots=True)
class Axis:
    """A key of the case and the values that it takes.

    Parameters
    ----------
    key : str
        ``gear.a.profile_shift``.
    values : tuple
        As a case file would hold them.
    numbers : tuple of float or None
        The same as numbers in `unit`; None where they are none.
    unit : str
    """

    key: str
    values: tuple[object, ...]
    numbers: tuple[float, ...] | None
    unit: str = ""

    def __len__(self) -> int:
        """Return how many values it has."""
        return len(self.values)

    def words(self, index: int) -> str:
        """``profile_shift = 0.25``."""
        return f"{self.key} = {self.values[index]}"


def read_axis(text: str) -> Axis:
    """Read an axis as the user writes it.

    Parameters
    ----------
    text : str
        ``KEY=START:STOP:COUNT`` for equally spaced values, with ``:log`` behind for values in geometric progression;
        ``KEY=V1,V2,...`` for a list. Quantities carry their unit: ``10 mm:20 mm:6`` or, once for all,
        ``10:20:6:mm``. Whole numbers stay whole where the spacing allows it.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    key, equals, given = (part.strip() for part in text.partition("="))
    if not equals or not key or not given:
        raise InputError("--over", f'"{text}"', "must read KEY=START:STOP:COUNT or KEY=V1,V2,...", _EXAMPLE)
    parts = [part.strip() for part in given.split(":")]
    if len(parts) == 1 or given.startswith(("[", '"')):
        return _list(key, given)
    if len(parts) not in (3, 4, 5):
        raise InputError("--over", f'"{text}"', "must read START:STOP:COUNT", _EXAMPLE)
    return _range(key, parts, text)


def _range(key: str, parts: list[str], text: str) -> Axis:
    geometric = "log" in parts[3:]
    units = [part for part in parts[3:] if part != "log"]
    ends = [_QUANTITY.fullmatch(part) for part in parts[:2]]
    found = {match[2] for match in ends if match and match[2]} | set(units)
    if None in ends or len(found) > 1 or not re.fullmatch("[0-9]{1,9}", parts[2]):
        raise InputError("--over", f'"{text}"', "must read START:STOP:COUNT with one unit for both ends", _EXAMPLE)
    start, stop = (float(match[1]) for match in ends if match)
    if not (math.isfinite(start) and math.isfinite(stop)):
        raise InputError("--over", f'"{text}"', "must have finite ends", _EXAMPLE)
    count, unit = int(parts[2]), next(iter(found), "")
    if not 1 <= count <= _MOST:
        raise InputError("--over", f'"{text}"', f"asks for {count} values, but it must be 1 to {_MOST}", _EXAMPLE)
    if count == 1 and start != stop:
        raise InputError("--over", f'"{text}"', "has one value, but two ends that differ", _EXAMPLE)
    if geometric and not (start > 0.0 and stop > 0.0):
        raise InputError("--over", f'"{text}"', "spaces by logarithm, so both ends must be positive", _EXAMPLE)
    raw = np.geomspace(start, stop, count) if geometric else np.linspace(start, stop, count)
    # What the user would have written: 0.1, not 0.09999999999999998; and 0, not 5.6e-17.
    digits = 12 - math.ceil(math.log10(max(abs(start), abs(stop)) or 1.0))
    numbers = [float(f"{value:.12g}") if geometric else round(float(value), digits) + 0.0 for value in raw]
    whole = all(match is not None and match[1].lstrip("+-").isdigit() for match in ends)
    if whole and not unit and all(number.is_integer() for number in numbers):
        return Axis(key, tuple(int(number) for number in numbers), tuple(numbers))
    values = tuple(f"{number:.12g} {unit}" if unit else number for number in numbers)
    return Axis(key, values, tuple(numbers), unit)


def _list(key: str, given: str) -> Axis:
    glued = re.search(r"(?<![\w.])[-+]?[0-9]+,[0-9]+(?![\w.])", given)
    if glued and "." in given and '"' not in given:
        point, two = glued[0].replace(",", "."), glued[0].replace(",", ".0,") + ".0"
        raise InputError(
            "--over", f'"{key}={given}"', f"can be read with a decimal comma in {glued[0]}",
            f"write {point}, or {two} for two numbers",
        )  # fmt: skip
    try:
        read = tomllib.loads(f"values = {given if given.startswith('[') else f'[{given}]'}")
    except (ValueError, RecursionError):
        read = {}
    values: list[Any] = read["values"] if set(read) == {"values"} else [part.strip() for part in given.split(",")]
    if not values or len({str(value) for value in values}) < len(values):
        raise InputError("--over", f'"{key}={given}"', "must list different values", _EXAMPLE)
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
        if not all(math.isfinite(value) for value in values):
            raise InputError("--over", f'"{key}={given}"', "must list finite values", _EXAMPLE)
        return Axis(key, tuple(values), tuple(float(value) for value in values))
    found = [_QUANTITY.fullmatch(value) if isinstance(value, str) else None for value in values]
    units = {match[2] for match in found if match}
    if len(units) > 1 and None in units:
        raise InputError(
            "--over", f'"{key}={given}"', "has numbers with a unit and numbers without",
            "decimal commas? write points, and the unit to each number",
        )  # fmt: skip
    if None not in found and len(units) == 1 and None not in units:
        return Axis(key, tuple(values), tuple(float(match[1]) for match in found if match), units.pop())
    return Axis(key, tuple(values), None)
