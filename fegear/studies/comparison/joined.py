"""Tables of two runs joined row by row."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.units import from_si
from fegear.engine.table import Column, Table

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Mask


#: Digits by which rows are known: the same place, computed anew, may differ in the last ones.
_DIGITS = 9


#: Rows at one place: a curve has two where it jumps, a table over a grid has more.
_MOST_ALIKE = 2


class Difference(NamedTuple):
    """How much a column changes.

    Attributes
    ----------
    column : Column
        Of the first table.
    largest : float
        Largest change by size, second less first, in the column's unit.
    share : float
        The same over the largest entry of either column; infinite where only one of them is a number.
    where : object
        What the first column holds there.
    """

    column: Column
    largest: float
    share: float
    where: object


class Joined(NamedTuple):
    """Two tables as one.

    Attributes
    ----------
    table : Table
        Key columns, then for every other column both and their difference.
    differences : tuple of Difference
        For every column of numbers that both have.
    only_first, only_second : int
        Rows that only one of them has.
    alone : tuple of (str, str)
        Columns that only one of them has, with the label of that one.
    """

    table: Table
    differences: tuple[Difference, ...]
    only_first: int
    only_second: int
    alone: tuple[tuple[str, str], ...] = ()

    def differs(self, tolerance: float) -> bool:
        """Whether rows or columns are missing on one side, or a number changes by more than a share of its largest."""
        missing = self.only_first + self.only_second > 0 or bool(self.alone)
        return missing or any(one.share > tolerance for one in self.differences)


def join(first: Table, second: Table, labels: tuple[str, str] = ("a", "b")) -> Joined:
    """Join two tables of one name on their first column and their columns of texts.

    Parameters
    ----------
    first, second : Table
    labels : (str, str)
        What is put behind the names of the columns.

    Returns
    -------
    Joined
        Rows of the first table in its order, then those that only the second has. Where no row of a curve meets one of
        the other, differences are those of the interpolated curves where both are. Columns that only one table has
        stand at the end.
    """
    names = [name for name in first.keys() if name in second.keys()]  # noqa: SIM118  (a table iterates by columns)
    keys = [name for i, name in enumerate(names) if i == 0 or not _numeric(first, name) or not _numeric(second, name)]
    rows = [_row_keys(table, keys) for table in (first, second)]
    order = list(dict.fromkeys([*rows[0], *rows[1]]))
    at = [_places(order, {key: row for row, key in enumerate(found)}) for found in rows]
    columns, differences = [], []
    for name in keys:
        one, other = first.column(name), second.column(name)
        cells = [one.si[a] if a >= 0 else other.si[b] for a, b in zip(*at, strict=True)]
        columns.append(Column(one.name, np.array(cells), one.unit, one.meaning))
    for name in names:
        if name in keys:
            continue
        one, other = first.column(name), second.column(name)
        a, b = _at(one, at[0]), _at(other, at[1]) * (1.0 if one.unit == other.unit else np.nan)
        for label, values in zip((*labels, "change"), (a, b, _change(a, b)), strict=True):
            columns.append(Column(f"{name}_{label}", values, one.unit, one.meaning))
        meet = (np.isfinite(a) & np.isfinite(b)).any()
        if not meet and len(keys) == 1 and follows(first, keys[0]) and follows(second, keys[0]):
            places = first.column(keys[0])
            a = _numbers(one)
            b = np.interp(_numbers(places), _numbers(second.column(keys[0])), _numbers(other), np.nan, np.nan)
            differences.append(_difference(one, a, b, places))
        else:
            lost = (np.isnan(a) != np.isnan(b)) & (at[0] >= 0) & (at[1] >= 0)
            differences.append(_difference(one, a, b, columns[0], lost))
    alone = []
    for label, side, table, there in zip("AB", labels, (first, second), at, strict=True):
        for column in (one for one in table.columns if one.name not in names):
            alone.append((column.name, label))
            columns.append(Column(f"{column.name}_{side}", _cells(column, there), column.unit, column.meaning))
    found = Table(first.name, tuple(columns), first.title)
    return Joined(found, tuple(differences), int(np.sum(at[1] < 0)), int(np.sum(at[0] < 0)), tuple(alone))


def _numbers(column: Column) -> Array:
    return np.asarray(column.si, dtype=float)


def follows(table: Table, name: str) -> bool:
    """Whether the rows are a curve over a column: rising, with a place twice where the curve jumps, not more often."""
    if not _numeric(table, name) or len(table) < 2:
        return False
    places = _numbers(table.column(name))
    return bool(np.all(np.diff(places) >= 0.0)) and int(np.unique(places, return_counts=True)[1].max()) <= _MOST_ALIKE


def _numeric(table: Table, name: str) -> bool:
    return np.issubdtype(table.column(name).si.dtype, np.number)


def _row_keys(table: Table, names: list[str]) -> list[tuple[object, ...]]:
    """What each row is known by; rows alike are numbered."""
    seen: dict[tuple[object, ...], int] = {}
    found = []
    columns = [table.column(name).si.tolist() for name in names]
    for row in range(len(table)):
        cells = [column[row] for column in columns]
        key = tuple(float(f"{cell:.{_DIGITS}g}") if isinstance(cell, float) else cell for cell in cells)
        seen[key] = seen.get(key, 0) + 1
        found.append((*key, seen[key]))
    return found


def _places(order: list[tuple[object, ...]], rows: dict[tuple[object, ...], int]) -> np.ndarray:
    return np.array([rows.get(key, -1) for key in order], dtype=int)


def _at(column: Column, rows: np.ndarray) -> Array:
    values = _numbers(column)
    return np.where(rows >= 0, values[np.maximum(rows, 0)], np.nan) if len(values) else np.full(len(rows), np.nan)


def _cells(column: Column, rows: np.ndarray) -> np.ndarray:
    """The entries of a column in other rows, not numbers or empty texts where there are none."""
    if np.issubdtype(column.si.dtype, np.number):
        return _at(column, rows)
    return np.array([str(column.si[row]) if row >= 0 else "" for row in rows], dtype=str)


def _change(a: Array, b: Array) -> Array:
    """Second less first; no number where both are endless."""
    return np.asarray(np.subtract(b, a, out=np.full(a.shape, np.nan), where=np.isfinite(a) | np.isfinite(b)))


def _difference(column: Column, a: Array, b: Array, places: Column, lost: Mask | None = None) -> Difference:
    """The largest change of a column; `lost` are the rows in which only one of the two is a number, if that counts."""
    factor = from_si(column.unit) if column.unit else 1.0
    endless = (np.isinf(a) | np.isinf(b)) & (a != b) & ~np.isnan(a) & ~np.isnan(b)
    change = np.where(np.isfinite(a) & np.isfinite(b), _change(a, b), np.nan)
    gone = bool(endless.any()) or (lost is not None and bool(lost.any()))
    if gone or not np.isfinite(change).any():
        alone = gone or bool((np.isnan(a) != np.isnan(b)).any())
        return Difference(column, np.nan, np.inf if alone else 0.0, "")
    worst = int(np.nanargmax(np.abs(change)))
    size = max(float(np.abs(one[np.isfinite(one)]).max()) for one in (a, b))
    share = abs(change[worst]) / size if size > 0.0 else 0.0
    return Difference(column, float(change[worst] * factor), float(share), places.values[worst])
