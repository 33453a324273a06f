"""CSV files that a case names: columns with units in their heads, as fegear and measuring programs write them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fegear.base.errors import InputError, shown
from fegear.base.unit_text import plain_number
from fegear.base.units import unit_size
from fegear.case.csv_lines import CsvLines, decimal_commas, read_lines
from fegear.case.part import LARGEST

#: Units of heads as they are written elsewhere.
_ELSEWHERE = {"Grad": "deg", "Umdr.": "rev", "µE": "ustrain", "uE": "ustrain"}
#: What stands for a value that was not measured.
_MISSING = {
    "", "nan", "#n/a", "n/a", "na", "null", "none", "-", "--", "---",
    # errors of spreadsheets, English and German, and samples beyond an amplifier's range
    "#nv", "#num!", "#zahl!", "#value!", "#wert!", "#div/0!", "overflow", "overload", "overrange", "ovld",
}  # fmt: skip
#: Heads that a message names.
_NAMED = 8


class Columns(dict[str, NDArray[np.float64]]):
    """The known columns of a file in SI.

    Parameters
    ----------
    columns : mapping
    heads : tuple of str
        All heads of the file.
    reading : str
        What had to be understood: decimal commas, lines that were passed over; empty for nothing.
    units : mapping, optional
        Dimension and unit of the columns that may be of several dimensions.
    """

    def __init__(
        self,
        columns: Mapping[str, NDArray[np.float64]],
        heads: tuple[str, ...] = (),
        reading: str = "",
        units: Mapping[str, tuple[str, str]] | None = None,
    ) -> None:
        super().__init__(columns)
        self.heads, self.reading, self.units = heads, reading, dict(units or {})

    @property
    def has(self) -> str:
        """The heads as a message names them."""
        named = ", ".join(shown(head) for head in self.heads[:_NAMED])
        return f"{named} ..." if len(self.heads) > _NAMED else named

    def require(self, name: str, key: str, file: str, word: str) -> None:
        """Refuse a file without a column.

        Parameters
        ----------
        name : str
        key, file : str
            Where the case names the file.
        word : str
            Key that gives the column another name.

        Raises
        ------
        InputError
        """
        if name not in self:
            raise InputError(key, f'"{file}"', f"requires a column {name}; it has {self.has}", f"add it or set {word}")


def read_columns(
    path: Path,
    key: str,
    dimensions: Mapping[str, str | tuple[str, ...]],
    units: Mapping[str, str] | None = None,
    *,
    gaps: bool = False,
) -> Columns:
    """Read the columns that are known by name into SI; others are passed over.

    Parameters
    ----------
    path : Path
        The first line that has one of the names and does not start with ``#`` holds the heads, ``name [unit]`` or
        ``name (unit)``, or has a line with the units below; entries are parted by what parts the heads: commas,
        semicolons or tabs. Numbers have decimal points, or all of them decimal commas.
    key : str
        Where the case names the file, for messages.
    dimensions : mapping
        Dimension of each column that may be there; empty for plain numbers; several where its unit says which.
    units : mapping, optional
        Units of columns whose heads have none.
    gaps : bool
        Whether lines without a value (nothing, or what programs write for it) in one of the columns are left out.

    Raises
    ------
    InputError
        If the file is no such table: a head's unit, two columns of one name, a line with more or fewer entries than
        heads, an entry that is no finite number or beyond any machine, commas that may be those of thousands.
    """
    lines = read_lines(path, key, dimensions)
    at: dict[str, int] = {}
    for i, head in enumerate(lines.heads):
        if head.name not in dimensions:
            continue
        if head.name in at:
            raise InputError(key, f'"{path.name}"', f"has two columns {head.name}", "remove one of them")
        if not dimensions[head.name] and head.unit:
            raise InputError(
                key, f'"{path.name}"', f"has a unit in the head of column {head.name}, which is dimensionless",
                "remove it",
            )  # fmt: skip
        at[head.name] = i
    rows = [
        (number, row) for number, row in lines.rows
        if not gaps or not any(row[i].strip().casefold() in _MISSING for i in at.values())
    ]  # fmt: skip
    if not rows:
        raise InputError(key, f'"{path.name}"', "has no line with all values", "check the columns")
    missing = len(lines.rows) - len(rows)
    lines = replace(lines, rows=rows)
    commas = decimal_commas([(number, row[i]) for number, row in lines.rows for i in at.values()], path, key)
    columns, several = {}, {}
    for name, i in at.items():
        one, given = dimensions[name], (units or {}).get(name, "")
        if isinstance(one, tuple):
            unit = _unit(lines, i) or given
            one = next((other for other in one if _is_of(unit, other)), one[0])
            several[name] = one, unit
        columns[name] = _column(lines, i, path, key, one, given, commas=commas)
    return Columns(columns, tuple(head.text for head in lines.heads), _reading(lines, missing, commas=commas), several)


def _unit(lines: CsvLines, i: int) -> str:
    """Unit in a head, as it is written here."""
    return _ELSEWHERE.get(lines.heads[i].unit, lines.heads[i].unit)


def _is_of(unit: str, dimension: str) -> bool:
    """Whether a unit is one of a dimension."""
    try:
        return bool(unit_size(unit, dimension))
    except InputError:
        return False


def _column(
    lines: CsvLines, i: int, path: Path, key: str, dimension: str, given: str, *, commas: bool
) -> NDArray[np.float64]:
    """One column in SI."""
    head, unit = lines.heads[i], _unit(lines, i)
    scale = unit_size(unit or given, dimension, f"{key}, column {head.name}") if dimension else 1.0
    if given and unit_size(given, dimension, key) != scale:
        raise InputError(
            key, f'"{path.name}"', f"has [{head.unit}] in the head of column {head.name}, the case has {given}",
            "remove one of them",
        )  # fmt: skip
    entries = np.array(
        [_entry(row[i], path, key, f"line {number}, {head.name}", commas=commas) for number, row in lines.rows]
    )
    beyond = np.flatnonzero(np.abs(entries) > LARGEST / scale)
    if beyond.size:
        number, row = lines.rows[beyond[0]]
        rule = f"has {shown(row[i])} in line {number}, {head.name}, which is beyond any machine"
        raise InputError(key, f'"{path.name}"', rule, "check the unit")
    return scale * entries


def _reading(lines: CsvLines, missing: int, *, commas: bool) -> str:
    parts = (
        "decimal commas" if commas else "",
        "units from the line below the heads" if lines.units_below else "",
        f"{lines.above} line{'s' if lines.above > 1 else ''} above the heads left out" if lines.above else "",
        f"{missing} sample{'s' if missing > 1 else ''} without a value left out" if missing else "",
    )
    return ", ".join(part for part in parts if part)


def _entry(text: str, path: Path, key: str, where: str, *, commas: bool) -> float:
    value = plain_number(text.replace(",", ".", 1) if commas else text)
    if value is None:
        raise InputError(
            key, f'"{path.name}"', f"contains {shown(text)} in {where}: not a number", "correct or remove the line"
        )
    if not math.isfinite(value):
        raise InputError(key, f'"{path.name}"', f"has {shown(text)} in {where}, which is not finite")
    return value


def one_column(columns: Columns, names: tuple[str, ...], key: str, file: str | None) -> str:
    """The one name of several of which a file has a column.

    Raises
    ------
    InputError
        If it has none of them, or two that may contradict each other.
    """
    found = [name for name in names if name in columns]
    if not found:
        raise InputError(key, f'"{file}"', f"requires a column {' or '.join(names)}; it has {columns.has}")
    if len(found) > 1:
        raise InputError(
            key, f'"{file}"', f"must have only one of the columns {' and '.join(found)}", f"remove column {found[1]}"
        )
    return found[0]
