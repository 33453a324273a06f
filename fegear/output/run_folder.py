"""The folder of a run as it is read again: values, tables and the case of one side of a comparison.

Whoever hands it over may have changed, cut short or exchanged any file of it.
"""

from __future__ import annotations

import csv
import io
import math
import re
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from fegear.base.errors import PATH, InputError, shown
from fegear.base.units import PER_SI
from fegear.case.json_file import read_json
from fegear.case.text_file import leads_to, read_text
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.output.folder import SUMMARY
from fegear.studies.comparison.compare import Side

_HEAD = re.compile(r"(.*?)(?: \[(.*)\])?", re.DOTALL)
_REMEDY = "specify a folder that fegear run wrote, or a case file"


def read_side(folder: Path, key: str) -> Side:
    """Read the folder of a run as one side of a comparison.

    Parameters
    ----------
    folder : Path
    key : str
        Where it is named, for messages.

    Raises
    ------
    InputError
        If it is no such folder, or a file of it is not what a run writes.
    """
    place = folder / SUMMARY
    if not leads_to(place, lambda _: True):
        raise InputError(key, shown(str(folder), PATH), f"is not a results folder (no {SUMMARY})", _REMEDY)
    summary = read_json(place, key)
    values = summary.get("results")
    if not isinstance(values, dict):
        _refuse(place, key, "has no results")
    document = summary.get("inputs", {})
    if not isinstance(document, dict):
        _refuse(place, key, "contains inputs that are not a case")
    found = [_value(name, one, place, key) for name, one in values.items() if not _of_a_sweep(one)]
    return Side(
        str(folder), document, {one.name: one for one in found},
        {path.stem: _read_table(path, key) for path in _tables(folder, key)},
    )  # fmt: skip


def _refuse(path: Path, key: str, rule: str) -> NoReturn:
    raise InputError(key, shown(str(path), PATH), rule, _REMEDY)


def _of_a_sweep(one: object) -> bool:
    return isinstance(one, Mapping) and "now" in one


def _value(name: str, given: object, path: Path, key: str) -> Value:
    """A value of the summary; one that is not known is null there."""
    if not isinstance(given, Mapping):
        _refuse(path, key, f"has {shown(given)} as the value {shown(name)}")
    value, error = (_number(given.get(part), name, path, key) for part in ("value", "error"))
    unit = given.get("unit", "")
    if not isinstance(unit, str) or unit not in ("", *PER_SI):
        _refuse(path, key, f"has the unknown unit {shown(unit)} at the value {shown(name)}")
    size = PER_SI[unit] if unit else 1.0
    return Value(name, math.nan if value is None else value / size, unit, None if error is None else error / size)


def _number(given: object, name: str, path: Path, key: str) -> float | None:
    if given is None:
        return None
    try:
        number = float(given) if isinstance(given, (int, float)) and not isinstance(given, bool) else math.nan
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        _refuse(path, key, f"has {shown(given)} for the value {shown(name)}; must be a finite number or null")
    return number


def _tables(folder: Path, key: str) -> list[Path]:
    place = folder / "tables"
    if not leads_to(place, stat.S_ISDIR):  # a run whose results are values only
        return []
    try:
        found = sorted(path for path in place.iterdir() if path.suffix == ".csv")
    except OSError as error:
        _refuse(place, key, f"cannot be read ({error.strerror or error})")
    for path in found:
        if not path.name.isprintable():
            _refuse(path, key, "has a name that cannot be printed")
    return found


def _read_table(path: Path, key: str) -> Table:
    try:
        rows = list(csv.reader(io.StringIO(read_text(path, key), newline=""), strict=True))
    except csv.Error as error:
        _refuse(path, key, f"is not a readable table ({error})")
    if not rows or not rows[0]:
        _refuse(path, key, "must have column heads in its first line")
    heads, rows = rows[0], rows[1:]
    for number, row in enumerate(rows, start=1):
        if len(row) != len(heads):
            _refuse(path, key, f"has {len(row)} entries in row {number} but {len(heads)} column heads")
    columns: dict[str, Column] = {}
    for head, cells in zip(heads, zip(*rows, strict=True) if rows else [()] * len(heads), strict=True):
        parted = _HEAD.fullmatch(head)
        name, unit = (parted[1], parted[2] or "") if parted and (parted[2] or "") in (*PER_SI, "") else (head, "")
        if name in columns:
            _refuse(path, key, f"has two columns {shown(name)}")
        values = _cells(cells)
        if unit and values.dtype.kind == "f":
            values = np.asarray(values, dtype=float) / PER_SI[unit]
        columns[name] = Column(name, values, unit)
    return Table(path.stem, tuple(columns.values()))


def _cells(cells: tuple[str, ...]) -> NDArray[np.generic]:
    """Numbers where all are, texts otherwise; whole numbers are numbers like others."""
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells)
