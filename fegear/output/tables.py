"""Tables as CSV: the first line holds the column heads with their units."""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from fegear.base.printed import column_figures, figures
from fegear.engine.table import Table
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

#: Characters of a name in MATLAB.
_LONGEST = 63
#: What begins a formula in a spreadsheet.
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


#: What names of values begin with that had no such beginning where the other result of their pair was not wanted.
_PREFIX = re.compile(r"^(.+\.)(?:unloaded|wide)_(?=[^.]+$)")
_QUANTITY = re.compile(r"[-+]?((\d+\.?\d*|\.\d+)([eE][-+]?\d+)?( ?[A-Za-zµ°%]+)?)?")


def cells(values: NDArray[np.generic]) -> list[str]:
    """Write a column: floats with 12 significant digits, whole numbers and texts as they are; blank: does not apply.

    Parameters
    ----------
    values : ndarray, shape (N,)

    Returns
    -------
    list of str, length N
    """
    return _written(values, "{:.12g}")


def _written(values: NDArray[np.generic], form: str) -> list[str]:
    if values.dtype.kind != "f":
        return [str(value) for value in values]
    write = form.format  # Python's own numbers are written five times as fast as numpy's
    return [write(value) if math.isfinite(value) else "" for value in values.tolist()]


def read_cells(values: NDArray[np.generic]) -> list[str]:
    """A column as a person reads it beside the others of a table: numbers of four digits with equal decimals."""
    return column_figures(values.tolist()) if values.dtype.kind == "f" else [str(value) for value in values]


def table_file(table: Table) -> str:
    """Name of a table's file."""
    return f"{file_name(table.name)}.csv"


def inert(text: str) -> str:
    """Text that a spreadsheet shows and does not compute: an apostrophe stands before what would begin a formula.

    Numbers, with or without a unit behind them, stay as they are.
    """
    return f"'{text}" if text.startswith(_FORMULA) and not _QUANTITY.fullmatch(text) else text


def table_text(table: Table) -> str:
    """Write a table as CSV text."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(inert(column.head) for column in table.columns)
    writer.writerows(zip(*(_inert_cells(column.values) for column in table.columns), strict=True))
    return stream.getvalue()


def _inert_cells(values: NDArray[np.generic]) -> list[str]:
    """Cells of a column; numbers never begin a formula."""
    written = cells(values)
    return written if values.dtype.kind == "f" else [inert(one) for one in written]


def sheet_lines(table: Table) -> list[str]:
    """Lines for the terminal: a line for each quantity, a column for each row of the table.

    Sizes of a drawing have seven digits, stresses and numbers without a unit five.
    """
    rows = [
        [one.head, *_written(one.values, "{:.5g}" if one.unit in _FEW_DIGITS else "{:.7g}")] for one in table.columns
    ]
    return _aligned(rows)


def brief_lines(table: Table) -> list[str]:
    """Title and lines for the terminal of a table beside an answer: the digits that a person reads, no errors."""
    rows = [
        [one.head, *(_brief(value) for value in one.values.tolist())]
        for one in table.columns
        if not one.name.endswith("_error")
    ]
    return [f"{table.title}:", *_aligned(rows)]


def _brief(value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    return figures(value) if math.isfinite(value) else ""


def _aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows whose first cells are heads, the other ones below each other to the right."""
    first, *widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        f"{row[0]:<{first}}" + "".join(f"  {cell:>{width}}" for cell, width in zip(row[1:], widths, strict=True))
        for row in rows
    ]


def row_lines(table: Table) -> list[str]:
    """Lines for the terminal: heads, and a line for each row of the table; numbers of four digits, to the right."""
    columns = [[one.head, *read_cells(one.values)] for one in table.columns]
    texts = [one.values.dtype.kind == "U" for one in table.columns]
    widths = [max(map(len, column)) for column in columns]
    return [
        "  ".join(
            f"{cell:<{width}}" if left else f"{cell:>{width}}"
            for cell, width, left in zip(row, widths, texts, strict=True)
        ).rstrip()
        for row in zip(*columns, strict=True)
    ]


def printed_lines(tables: Sequence[Table]) -> list[str]:
    """Lines for the terminal of several tables; of the same ones for several pairs each has its title above it.

    Estimated errors are left to the files.
    """
    tables = [_without_errors(table) for table in tables]
    kinds = [tuple(column.head for column in table.columns[:2]) for table in tables]  # further ones are errors, or none
    return [
        line
        for table, kind in zip(tables, kinds, strict=True)
        for line in (*((f"{table.title}:",) if kinds.count(kind) > 1 else ()), *sheet_lines(table))
    ]


def _without_errors(table: Table) -> Table:
    """The same without estimated errors of its other columns."""
    errors = {f"{column.name}_error" for column in table.columns}
    return replace(table, columns=tuple(column for column in table.columns if column.name not in errors))


def write_table(folder: Path, table: Table) -> Path:
    """Write ``<name>.csv`` into a folder, and ``<name>.mat`` beside it where the table is for other programs.

    Parameters
    ----------
    folder : Path
    table : Table

    Returns
    -------
    Path
    """
    path = folder / table_file(table)
    for kind in ("csv", "mat") if table.matlab else ("csv",):
        path.with_suffix(f".{kind}").write_bytes(table_bytes(table, kind))
    return path


#: Units of what is computed rather than measured on a drawing.
_FEW_DIGITS = ("", "MPa")
#: What tables are written as.
KINDS = ("csv", "mat")


def table_bytes(table: Table, kind: str) -> bytes:
    """A table as the bytes of a file of one of `KINDS`."""
    return table_text(table).encode("utf-8") if kind == "csv" else _matlab(table)


#: Text that begins a .mat file, 116 characters of it; scipy's own says the hour: two files of one table would differ.
_MATLAB = b"MATLAB 5.0 MAT-file, written by fegear"


def _matlab(table: Table) -> bytes:
    """A table as MATLAB's level 5: a column vector for each column, ``units`` with theirs, ``title``."""
    from io import BytesIO

    from scipy.io import savemat

    file = BytesIO()
    names = _variables([column.name for column in table.columns])
    units = {name: column.unit or "1" for name, column in zip(names, table.columns, strict=True)}
    columns = {name: column.values for name, column in zip(names, table.columns, strict=True)}
    savemat(file, {**columns, "units": units, "title": table.title}, oned_as="column", long_field_names=True)
    return _MATLAB.ljust(116) + file.getvalue()[116:]


def _variables(names: Sequence[str]) -> list[str]:
    """Names as variables of MATLAB: letters, digits and underscores, a letter first, 63 characters, none twice."""
    made = ["units", "title"]
    for name in names:
        plain = re.sub(r"\W", "_", name, flags=re.ASCII)
        plain = (plain if plain[:1].isalpha() else f"x{plain}")[:_LONGEST]
        same, number = plain, 1
        while same in made:
            number += 1
            same = f"{plain[: _LONGEST - 1 - len(str(number))]}_{number}"
        made.append(same)
    return made[2:]
