"""What a stage leaves: tables, single values, remarks, and the numerical result itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.names import nearest
from fegear.errors import UnknownNameError
from fegear.units import from_si, quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pint
    from numpy.typing import NDArray

    from fegear.engine.figure import DeferredFigure, Figure


@dataclass(frozen=True, slots=True)
class Column:
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
class Table:
    """A named table; the first column is what the rows are ordered by."""

    name: str
    columns: tuple[Column, ...]
    title: str = ""

    def __post_init__(self) -> None:
        """Refuse columns of different length: that would be a bug of a stage."""
        lengths = {column.name: len(column) for column in self.columns}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"table {self.name} has columns of different length: {lengths}")

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
        raise UnknownNameError("column", f'"{name}"', f"is none of table {self.name}", nearest(name, heads))

    def __getitem__(self, name: str) -> NDArray[np.generic]:
        """Return the values of a column in its unit; ``column(name).si`` has them in SI."""
        return self.column(name).values


@dataclass(frozen=True, slots=True)
class Value:
    """A single result with its own error estimate.

    Parameters
    ----------
    name : str
    si : float
        In SI.
    unit : str
        Unit in which `value` and `error` are.
    si_error : float or None
        Estimated absolute error in SI; None where the error is unknown, zero where the value is exact.
    meaning : str
        One clause for the report.
    """

    name: str
    si: float
    unit: str = ""
    si_error: float | None = None
    meaning: str = ""

    def __repr__(self) -> str:
        """Name, number, error and unit on one line."""
        error = f" +- {self.error:.2g}" if self.error else ""
        return f"{self.name} = {self.value:.9g}{error} {self.unit}".rstrip()

    def __float__(self) -> float:
        """Return the value in its unit."""
        return self.value

    @property
    def value(self) -> float:
        """The value in its unit."""
        return self.si * (from_si(self.unit) if self.unit else 1.0)

    @property
    def error(self) -> float | None:
        """The estimated absolute error in the value's unit."""
        return None if self.si_error is None else self.si_error * (from_si(self.unit) if self.unit else 1.0)

    @property
    def quantity(self) -> pint.Quantity[float]:
        """The value with its unit, as pint has it."""
        return quantity(self.value, self.unit)


@dataclass(frozen=True, slots=True)
class Outcome:
    """Result of one stage.

    Parameters
    ----------
    data : object
        The numerical layer's own frozen result, for later stages and for pictures.
    tables, values : tuples
        What is written down.
    settings : mapping
        The settings that it was computed with, plain numbers and texts.
    remarks : tuple of str
        Sentences that the user should read.
    figures : tuple of Figure or DeferredFigure
        What can be drawn.
    """

    data: object = None
    tables: tuple[Table, ...] = ()
    values: tuple[Value, ...] = ()
    settings: Mapping[str, object] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    figures: tuple[Figure | DeferredFigure, ...] = ()
