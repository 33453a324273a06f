"""What a stage leaves: tables, single values, remarks, and the numerical result itself.

Results by name: tables, values and figures of a run, in their order.

The least that an estimated error may be: what another processor makes of the same numbers.

An estimate from two discretisations, two widths or two quadratures can come out as nothing where both agree by
symmetry, by chance, or because one is exact there; the number itself then still hangs on the last digits of hundreds of
sums, which kernels with and without fused multiply-add make differently. So an error that is stated is never below a
share of the largest number that the quantity could have been taken from.

How results show themselves in a notebook: plain tables of HTML.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from html import escape
from typing import TYPE_CHECKING, Protocol, SupportsIndex, TypeVar, overload

import numpy as np

from fegear.base.arrays import Alike
from fegear.base.errors import UnknownNameError, UnknownPlaceError, shown
from fegear.base.units import from_si, quantity
from fegear.case.part import nearest

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    import pint

    from fegear.engine.figure.figure import DeferredFigure, Figure
    from fegear.engine.table import Column, Table


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
    sharper_by : str
        What makes the estimated errors of its values smaller: key and verb of a remedy; empty where nothing does.
    """

    data: object = None
    tables: tuple[Table, ...] = ()
    values: tuple[Value, ...] = ()
    settings: Mapping[str, object] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    figures: tuple[Figure | DeferredFigure, ...] = ()
    sharper_by: str = "reduce accuracy.tolerance"

    def __post_init__(self) -> None:
        """Raise errors that are below what the digits of their numbers are worth; note those that are large."""
        object.__setattr__(self, "values", with_least_errors(self.values))
        object.__setattr__(self, "remarks", tuple(dict.fromkeys((*self.remarks, *self._rough_values))))
        object.__setattr__(self, "tables", tuple(with_least_error_columns(table) for table in self.tables))

    @property
    def _rough_values(self) -> tuple[str, ...]:
        """One note for all values whose estimated error exceeds a fifth of them."""
        rough = [value for value in self.values if _is_rough(value, self.values)] if self.sharper_by else []
        if not rough:
            return ()
        shown = [f"{one.name} ({one.value:.4g} +- {one.error:.2g} {one.unit}".rstrip() + ")" for one in rough[:_NAMED]]
        more = f" and {len(rough) - _NAMED} more" if len(rough) > _NAMED else ""
        return (f"{', '.join(shown)}{more}: estimated error above {_ROUGH:.0%} of the value".replace("%", " %")
                + f"; {self.sharper_by}.",)  # fmt: skip


class HasName(Protocol):
    """What can be asked for by its name."""

    @property
    def name(self) -> str:
        """Unique in its run."""


T = TypeVar("T", bound=HasName)


class Named(tuple[T, ...]):
    """Things of a run in their order, each also by its name: ``tables[0]``, ``tables["stiffness_a"]``."""

    __slots__ = ()

    @overload
    def __getitem__(self, key: SupportsIndex) -> T: ...
    @overload
    def __getitem__(self, key: str) -> T: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[T, ...]: ...
    def __getitem__(self, key: SupportsIndex | slice | str) -> T | tuple[T, ...]:
        """Return one by its name or place; an unknown name is refused with the nearest."""
        if not isinstance(key, str):
            try:
                return super().__getitem__(key)
            except (IndexError, TypeError):
                rule, remedy = f"is no place among these {len(self)} results", nearest("", self.keys())
                raise UnknownPlaceError("name", shown(key), rule, remedy) from None
        for one in self:
            if one.name == key:
                return one
        raise UnknownNameError("name", f'"{key}"', "is not among these results", nearest(key, self.keys()))

    def __contains__(self, key: object) -> bool:
        """Whether a name or a thing is among them."""
        return any(one.name == key for one in self) if isinstance(key, str) else super().__contains__(key)

    def keys(self) -> tuple[str, ...]:
        """Names, in order."""
        return tuple(one.name for one in self)

    def items(self) -> Iterator[tuple[str, T]]:
        """Pairs of name and thing, in order."""
        return ((one.name, one) for one in self)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.keys())

    def __repr__(self) -> str:
        """One line for each."""
        return "\n".join(repr(one) for one in self) or "(none)"


#: Of the largest number in its unit beside it: differences of what is as large keep no digits below. Two processors
#: differ by up to 3e-9 in a history of root stress.
ROUND_OFF = 1e-8


#: Estimated errors above this part of their value are noted, and of so many values the names.
_ROUGH, _NAMED = 0.2, 3


def _is_rough(value: Value, beside: Iterable[Value]) -> bool:
    """Whether an estimated error is a large part of its value, and more than digits of the values beside it.

    A value of exactly zero has no part: its error says all.
    """
    if not value.si_error or not value.si or not math.isfinite(value.si) or not math.isfinite(value.si_error):
        return False
    largest = max(abs(one.si) for one in beside if one.unit == value.unit and math.isfinite(one.si))
    if abs(value.si) <= (ROUND_OFF * largest if value.unit else 0.0):
        # A zero has no share of itself: what a designed relief leaves is judged by what no relief leaves.
        return bool(value.unit) and value.si_error > _ROUGH * largest > 0.0
    return value.si_error > _ROUGH * abs(value.si) and value.si_error > 10.0 * ROUND_OFF * largest


def error_columns(table: Table) -> dict[str, str]:
    """Which column holds the estimated error of which: ``c_self_error``, whose meaning may name several columns."""
    found: dict[str, str] = {}
    for column in table.columns:
        base = column.name.removesuffix("_error")
        if base != column.name:
            words = {base, *re.findall(r"\w+", column.meaning)}
            found |= {one.name: column.name for one in table.columns if one.name in words and one is not column}
    return found


def with_least_errors(values: Iterable[Value]) -> tuple[Value, ...]:
    """Values of one result whose estimated errors are no smaller than what another processor gives.

    What is exact (an error of zero) or not known (None) stays so. Numbers without a unit are compared with themselves.
    """
    every = tuple(values)
    largest: dict[str, float] = {}
    for value in every:
        if value.unit and np.isfinite(value.si):
            largest[value.unit] = max(largest.get(value.unit, 0.0), abs(value.si))
    found = []
    for value in every:
        least = ROUND_OFF * (largest.get(value.unit, 0.0) if value.unit else abs(value.si))
        if value.si_error is not None and not value.si_error >= least:
            # what is not a number no one has estimated
            error = None if np.isnan(value.si_error) else least if value.si_error > 0.0 else value.si_error
            value = replace(value, si_error=error)  # noqa: PLW2901
        found.append(value)
    return tuple(found)


def with_least_error_columns(table: Table) -> Table:
    """The same for columns of estimated errors; one that is zero throughout belongs to what is exact."""
    serves: dict[str, list[str]] = {}
    for name, error in error_columns(table).items():
        serves.setdefault(error, []).append(name)
    if not serves:
        return table
    columns = tuple(_raised(column, table, serves.get(column.name, ())) for column in table.columns)
    same = all(new is old for new, old in zip(columns, table.columns, strict=True))
    return table if same else replace(table, columns=columns)


def _raised(column: Column, table: Table, serves: Iterable[str]) -> Column:
    """A column of errors of others, no smaller than what their digits are worth."""
    alike = [
        np.abs(np.asarray(one.si, dtype=float))
        for one in table.columns
        if one.si.dtype.kind == "f" and (one.unit == column.unit if column.unit else one.name in serves)
    ]
    if not serves or not alike or column.si.dtype.kind != "f":
        return column
    errors = np.asarray(column.si, dtype=float)
    if not (errors > 0.0).any():
        return column
    size = np.concatenate(alike)
    least = ROUND_OFF * float(size[np.isfinite(size)].max(initial=0.0))
    raised = np.where(errors < least, least, errors)
    return column if np.array_equal(raised, errors, equal_nan=True) else replace(column, si=raised)


#: Rows of a table that a notebook shows.
ROWS = 10


def html_table(heads: Sequence[str], rows: Iterable[Sequence[str]], caption: str = "") -> str:
    """A table of texts, its first column to the left and the others to the right."""
    said = f"<caption style='text-align:left'>{escape(caption)}</caption>" if caption else ""
    head = "".join(f"<th>{escape(one)}</th>" for one in heads)
    body = "".join(
        "<tr>" + "".join(f"<td style='text-align:{'left' if i == 0 else 'right'}'>{escape(cell)}</td>"
                         for i, cell in enumerate(row)) + "</tr>"
        for row in rows
    )  # fmt: skip
    return f"<table>{said}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def short(value: object) -> str:
    """A number of a table with six significant digits; texts as they are."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
