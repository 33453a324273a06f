"""What a stage leaves: tables, single values, remarks, and the numerical result itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.units import from_si

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from fegear.engine.figure import DeferredFigure, Figure


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a table.

    Parameters
    ----------
    name : str
        Name of the quantity, as in the table's head.
    values : ndarray, shape (N,)
        In SI; integers and texts stay as they are.
    unit : str
        Unit in which the column is written; empty for dimensionless.
    meaning : str
        One clause for reports and datasets.
    """

    name: str
    values: NDArray[np.generic]
    unit: str = ""
    meaning: str = ""

    def __post_init__(self) -> None:
        """Make the array read-only."""
        values = np.array(self.values)
        values.setflags(write=False)
        object.__setattr__(self, "values", values)

    @property
    def head(self) -> str:
        """``name [unit]``."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def shown(self) -> NDArray[np.generic]:
        """The values in the column's unit."""
        if not self.unit or not np.issubdtype(self.values.dtype, np.number):
            return self.values
        return np.asarray(self.values, dtype=float) * from_si(self.unit)


@dataclass(frozen=True, slots=True)
class Table:
    """A named table; the first column is what the rows are ordered by."""

    name: str
    columns: tuple[Column, ...]
    title: str = ""

    def __post_init__(self) -> None:
        """Refuse columns of different length: that would be a bug of a stage."""
        lengths = {column.name: len(column.values) for column in self.columns}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"table {self.name} has columns of different length: {lengths}")

    def __getitem__(self, name: str) -> NDArray[np.generic]:
        """Return the values of a column in SI."""
        for column in self.columns:
            if column.name == name:
                return column.values
        raise KeyError(f"table {self.name} has no column {name}")


@dataclass(frozen=True, slots=True)
class Value:
    """A single result with its own error estimate.

    Parameters
    ----------
    name : str
    value : float
        In SI.
    unit : str
        Unit in which it is reported.
    error : float or None
        Estimated absolute error in SI; None where the value is exact or the error unknown.
    meaning : str
        One clause for the report.
    """

    name: str
    value: float
    unit: str = ""
    error: float | None = None
    meaning: str = ""

    @property
    def shown(self) -> float:
        """The value in its unit."""
        return self.value * (from_si(self.unit) if self.unit else 1.0)

    @property
    def shown_error(self) -> float | None:
        """The error in the value's unit."""
        return None if self.error is None else self.error * (from_si(self.unit) if self.unit else 1.0)


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
