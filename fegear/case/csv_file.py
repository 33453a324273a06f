"""CSV files that a case names: columns with units in their heads, as fegear itself writes them."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fegear.base.errors import InputError, shown
from fegear.base.unit_text import plain_number
from fegear.base.units import unit_size
from fegear.case.part import LARGEST
from fegear.case.text_file import read_text

#: Most lines of a table: some seconds of reading.
_MOST_LINES = 400_000

_HEAD = re.compile(r"\s*(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*")


def read_columns(
    path: Path, key: str, dimensions: Mapping[str, str], units: Mapping[str, str] | None = None
) -> dict[str, NDArray[np.float64]]:
    """Read the columns that are known by name into SI; others are passed over.

    Parameters
    ----------
    path : Path
        The first line that does not start with ``#`` holds the heads, ``name [unit]``; entries are parted by commas,
        or by what parts the heads: semicolons or tabs.
    key : str
        Where the case names the file, for messages.
    dimensions : mapping
        Dimension of each column that may be there; empty for plain numbers.
    units : mapping, optional
        Units of columns whose heads have none.

    Raises
    ------
    InputError
        If the file is no such table: its encoding, a head's unit, two columns of one name, a line with more or fewer
        entries than heads, an entry that is no finite number or
        beyond any machine.
    """
    numbered = _lines(path, key)
    (_, heads), rows = numbered[0], numbered[1:]
    for number, row in rows:
        if len(row) != len(heads):
            raise InputError(
                key, f'"{path.name}"', f"has {len(row)} entries in line {number} but {len(heads)} column heads",
                "use decimal points, not commas",
            )  # fmt: skip
    columns: dict[str, NDArray[np.float64]] = {}
    for i, head in enumerate(heads):
        match = _HEAD.fullmatch(head)
        if match is None or match["name"] not in dimensions:
            continue
        name = match["name"]
        if name in columns:
            raise InputError(key, f'"{path.name}"', f"has two columns {name}", "remove one of them")
        if not dimensions[name] and match["unit"]:
            raise InputError(
                key, f'"{path.name}"', f"has a unit in the head of column {name}, which is dimensionless", "remove it"
            )
        dimension = dimensions[name]
        given = (units or {}).get(name, "")
        scale = unit_size(match["unit"] or given, dimension, f"{key}, column {name}") if dimension else 1.0
        if given and unit_size(given, dimension, key) != scale:
            raise InputError(
                key, f'"{path.name}"', f"has [{match['unit']}] in the head of column {name}, the case says {given}",
                "remove one of them",
            )  # fmt: skip
        entries = np.array([_entry(row[i], path, key, f"line {number}, {name}") for number, row in rows])
        beyond = np.flatnonzero(np.abs(entries) > LARGEST / scale)
        if beyond.size:
            number, row = rows[beyond[0]]
            rule = f"has {shown(row[i])} in line {number}, {name}, which is beyond any machine"
            raise InputError(key, f'"{path.name}"', rule, "check the unit")
        columns[name] = scale * entries
    return columns


def _lines(path: Path, key: str) -> list[tuple[int, list[str]]]:
    """Heads and rows with the numbers of their lines, the last entry of each without the empty one behind a comma."""
    every = read_text(path, key).splitlines()
    if len(every) > _MOST_LINES:
        raise InputError(key, f'"{path.name}"', f"has more than {_MOST_LINES:,} lines", "use every second point")
    lines = [(number, line) for number, line in enumerate(every, start=1) if line.strip()]
    lines = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise InputError(key, f'"{path.name}"', "must have column heads with numbers below")
    head = lines[0][1]
    parting = next((sign for sign in ",;\t" if sign in head), ",")
    try:
        rows = [(number, next(csv.reader([line], delimiter=parting, strict=True))) for number, line in lines]
    except csv.Error as error:
        raise InputError(key, f'"{path.name}"', f"is not a readable table ({error})") from None
    if all(not row[-1].strip() for _, row in rows):
        rows = [(number, row[:-1]) for number, row in rows]
    return rows


def _entry(text: str, path: Path, key: str, where: str) -> float:
    value = plain_number(text)
    if value is None:
        comma = plain_number(text.replace(",", ".", 1)) is not None
        remedy = "use decimal points, not commas" if comma else "correct or remove the line"
        raise InputError(key, f'"{path.name}"', f"contains {shown(text)} in {where}: not a number", remedy)
    if not math.isfinite(value):
        raise InputError(key, f'"{path.name}"', f"has {shown(text)} in {where}, which is not finite")
    return value


def one_column(columns: Mapping[str, NDArray[np.float64]], names: tuple[str, ...], key: str, file: str | None) -> str:
    """The one name of several of which a file has a column.

    Raises
    ------
    InputError
        If it has none of them, or two that may contradict each other.
    """
    found = [name for name in names if name in columns]
    if not found:
        raise InputError(key, f'"{file}"', f"requires a column {' or '.join(names)}")
    if len(found) > 1:
        raise InputError(
            key, f'"{file}"', f"must have only one of the columns {' and '.join(found)}", f"remove column {found[1]}"
        )
    return found[0]
