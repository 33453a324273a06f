"""A table of a result: columns of one length, each with its unit."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.arrays import Alike
from fegear.base.errors import NOTEBOOK_EXTRA, MissingLibraryError, UnknownNameError
from fegear.base.units import from_si, quantity
from fegear.case.nearest import nearest
from fegear.engine.html_table import ROWS, html_table, short

if TYPE_CHECKING:
    import pandas as pd
    import pint
    from numpy.typing import NDArray


#: Heads that the short form of a table shows.
_HEADS = 8
#: Tables of no more rows and of more columns than that are shown on their side in a notebook.
_TALL = 3


@dataclass(frozen=True, slots=True)
class Column(Alike):
    """One column of a table.

    Parameters
    ----------
    name : str
        Name of the quantity, as in the table's head.
    si : ndarray, shape (N,)
        In SI; integers and texts stay as they are.
    unit : str
        Unit of the column; empty for dimensionless.
    meaning : str
        One clause for reports and datasets.
    """

    name: str
    si: NDArray[np.generic]
    unit: str = ""
    meaning: str = ""

    def __post_init__(self) -> None:
        """Make the array read-only."""
        si = np.array(self.si)
        si.setflags(write=False)
        object.__setattr__(self, "si", si)

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.si)

    def __repr__(self) -> str:
        """Name, unit, rows, first and last."""
        shown = self.values if len(self) < 2 else self.values[[0, -1]]
        ends = ", ".join(f"{value:.6g}" if shown.dtype.kind == "f" else str(value) for value in shown)
        return f"<column {self.head}: {len(self)} rows, {ends}>"

    @property
    def explained(self) -> str:
        """The meaning, with what the blank cells of a written table say where it has some."""
        if self.si.dtype.kind != "f" or "blank" in self.meaning or np.isfinite(self.si).all():
            return self.meaning
        endless = "is unlimited or " if np.isinf(self.si).any() else ""
        return "; ".join(filter(None, (self.meaning, f"blank where it {endless}does not apply")))

    @property
    def head(self) -> str:
        """``name [unit]``."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def values(self) -> NDArray[np.generic]:
        """The values in the column's unit."""
        if not self.unit or not np.issubdtype(self.si.dtype, np.number):
            return self.si
        return np.asarray(self.si, dtype=float) * from_si(self.unit)

    @property
    def quantity(self) -> pint.Quantity[NDArray[np.float64]]:
        """The values with their unit, as pint has it."""
        return quantity(self.values, self.unit)


@dataclass(frozen=True, slots=True)
class Table(Alike):
    """A named table; the first column is what the rows are ordered by.

    Parameters
    ----------
    name : str
    columns : tuple of Column
    title : str
    printed : bool
        Whether a run shows it on the terminal, a column for each row: few rows, whose names the first column holds.
    matlab : bool
        Whether a run writes it as ``.mat``, too: a table that other programs read.
    """

    name: str
    columns: tuple[Column, ...]
    title: str = ""
    printed: bool = False
    matlab: bool = False

    def __post_init__(self) -> None:
        """Refuse columns of different length: that would be a bug of a stage."""
        lengths = {column.name: len(column) for column in self.columns}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"table {self.name} has columns of different length: {lengths}")

    @property
    def filled(self) -> Table:
        """The same without columns in which no row has a number or a text."""
        columns = tuple(
            one
            for one in self.columns
            if not (
                np.isnan(one.si).all()
                if one.si.dtype.kind == "f"
                else one.si.dtype.kind == "U" and (one.si == "").all()
            )
        )
        return self if len(columns) == len(self.columns) else replace(self, columns=columns)

    def column(self, name: str) -> Column:
        """Column of a name or a head (``speed`` or ``speed [rpm]``).

        Raises
        ------
        UnknownNameError
            With the nearest name.
        """
        for column in self.columns:
            if name in (column.name, column.head):
                return column
        heads = [column.head for column in self.columns]
        raise UnknownNameError("column", f'"{name}"', f"is not a column of table {self.name}", nearest(name, heads))

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.columns[0]) if self.columns else 0

    def __bool__(self) -> bool:
        """A table is one even without rows."""
        return True

    def __getitem__(self, name: str) -> NDArray[np.generic]:
        """Return the values of a column in its unit; ``column(name).si`` has them in SI."""
        return self.column(name).values

    def keys(self) -> tuple[str, ...]:
        """Names of the columns, in order."""
        return tuple(column.name for column in self.columns)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.keys())

    def __repr__(self) -> str:
        """Name, rows and the first heads."""
        heads = [column.head for column in self.columns]
        more = [f"{len(heads) - _HEADS} more"] if len(heads) > _HEADS else []
        return f"<table {self.name}: {len(self)} rows of {', '.join(heads[:_HEADS] + more)}>"

    def _repr_html_(self) -> str:
        """Show the first rows in a notebook; few rows of many columns with a line for each column."""
        title = self.title or self.name
        if 0 < len(self) <= _TALL and len(self.columns) > _HEADS:
            heads = ["", *(str(1 + n) if len(self) > 1 else "" for n in range(len(self)))]
            tall = ((column.head, *map(short, column.values.tolist())) for column in self.columns)
            return html_table(heads, tall, title)
        rows = zip(*(map(short, column.values[:ROWS].tolist()) for column in self.columns), strict=True)
        more = f", the first {ROWS} of {len(self)} rows" if len(self) > ROWS else ""
        return html_table([column.head for column in self.columns], rows, f"{title}{more}")

    def rows(self) -> list[dict[str, Any]]:
        """Each row as plain numbers and texts by the heads of the columns; needs no further library."""
        heads = [column.head for column in self.columns]
        cells = zip(*(column.values.tolist() for column in self.columns), strict=True)
        return [dict(zip(heads, row, strict=True)) for row in cells]

    def to_pandas(self) -> pd.DataFrame:
        """As pandas has it: what ``tables/<name>.csv`` holds, with units in the heads.

        Raises
        ------
        MissingLibraryError
            If pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError:
            raise MissingLibraryError(f"pandas is not installed; {NOTEBOOK_EXTRA}. Without it: rows().") from None
        frame = pd.DataFrame({column.head: column.values for column in self.columns})
        frame.attrs |= {"name": self.name, "title": self.title}
        return frame
