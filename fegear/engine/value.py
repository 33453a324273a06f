"""A single number of a result, with its unit, its estimated error and what it means."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.arrays import Alike
from fegear.base.printed import plain, with_its_error
from fegear.base.units import from_si, quantity

if TYPE_CHECKING:
    import pint


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
    zero : bool
        Whether it is meant to be zero: its error is then a part of the largest value of the unit beside it.
    choice : bool
        Whether it is chosen among equally good ones: its error says how sharp the optimum is, not how well the result
        is known, and no finer computation makes it smaller.
    """

    name: str
    si: float
    unit: str = ""
    si_error: float | None = None
    meaning: str = ""
    zero: bool = False
    choice: bool = False

    def __repr__(self) -> str:
        """Name, number with the digits of its error, error and unit on one line."""
        number = with_its_error(self.value, self.error) if self.error else plain(self.value)
        return f"{self.name} = {number} {self.unit}".rstrip()

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
