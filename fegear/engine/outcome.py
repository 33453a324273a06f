"""What a stage leaves: tables, single values, remarks, and the numerical result itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.engine.stated_errors import with_least_error_columns, with_least_errors
from fegear.engine.table import Column, Table
from fegear.frozen import Alike
from fegear.units import from_si, quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pint

    from fegear.engine.figure import DeferredFigure, Figure


__all__ = ["Column", "Outcome", "Table", "Value"]


@dataclass(frozen=True, slots=True)
class Value(Alike):
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
class Outcome(Alike):
    """Result of one stage; no estimated error in it is below what another processor gives (`stated_errors`).

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

    def __post_init__(self) -> None:
        """Raise errors that are below what the digits of their numbers are worth."""
        object.__setattr__(self, "values", with_least_errors(self.values))
        object.__setattr__(self, "tables", tuple(with_least_error_columns(table) for table in self.tables))
