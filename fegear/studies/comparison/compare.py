"""The whole comparison of two runs, and what it says in words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.studies.comparison.inputs import Input, different_inputs
from fegear.studies.comparison.tables import Joined, join
from fegear.studies.comparison.values import Pairing, paired

if TYPE_CHECKING:
    from fegear.studies.comparison.side import Side

#: Columns of a table on the terminal.
_COLUMNS = 4
#: Lines of each kind on the terminal.
_LINES = 40


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two runs held against each other.

    Parameters
    ----------
    first, second : Side
    tolerance : float
        Share by which numbers may differ and count as the same.
    inputs : tuple of Input or None
        Keys that differ; None where the case of a side is not known.
    values : tuple of Pairing
    tables : tuple of Joined
        Tables that both have.
    alone : tuple of (str, str)
        Tables that only one side has, with its label.
    """

    first: Side
    second: Side
    tolerance: float
    inputs: tuple[Input, ...] | None
    values: tuple[Pairing, ...]
    tables: tuple[Joined, ...]
    alone: tuple[tuple[str, str], ...]

    @property
    def different_values(self) -> tuple[Pairing, ...]:
        """Values that differ by more than the tolerance."""
        return tuple(value for value in self.values if value.differs(self.tolerance))

    @property
    def different_tables(self) -> tuple[Joined, ...]:
        """Tables that differ by more than the tolerance."""
        return tuple(table for table in self.tables if table.differs(self.tolerance))

    @property
    def results_differ(self) -> bool:
        """Whether any number differs, or is missing on one side."""
        return bool(self.different_values or self.different_tables or self.alone)

    def lines(self) -> list[str]:
        """What the terminal shows."""
        lines = [f"A: {self.first.label}", f"B: {self.second.label}"]
        if self.inputs is None:
            lines.append("Inputs: not known of both; folders tell them that were written by this version.")
        elif not self.inputs:
            lines.append("Inputs: the same.")
        else:
            lines += ["Inputs that differ:", *(input_line(one) for one in self.inputs)]
        lines += _listed("Values", len(self.values), [value_line(one) for one in self.different_values])
        lines += _listed("Tables", len(self.tables), [
            line for one in self.different_tables for line in table_lines(one, self.tolerance)
        ])  # fmt: skip
        return lines + [f"Only {label} has the table {name}." for name, label in self.alone]


def compare(first: Side, second: Side, tolerance: float = 0.0) -> Comparison:
    """Hold two runs against each other.

    Parameters
    ----------
    first, second : Side
    tolerance : float
        Share by which numbers may differ and count as the same.
    """
    known = bool(first.document and second.document)
    both = [name for name in first.tables if name in second.tables]
    alone = [(name, "A") for name in first.tables if name not in second.tables]
    alone += [(name, "B") for name in second.tables if name not in first.tables]
    return Comparison(
        first,
        second,
        tolerance,
        different_inputs(first.document, second.document) if known else None,
        paired(first.values, second.values),
        tuple(join(first.tables[name], second.tables[name]) for name in both),
        tuple(alone),
    )


def _listed(what: str, count: int, lines: list[str]) -> list[str]:
    if not lines:
        return [f"{what}: {'the same' if count else 'none'}."]
    more = [f"  ... {len(lines) - _LINES} more in the report"] if len(lines) > _LINES else []
    return [f"{what} that differ:", *lines[:_LINES], *more]


def input_line(one: Input) -> str:
    """A key that differs."""
    told = ["(not given)" if text is None else str(text) for text in (one.first, one.second)]
    return f"  {one.key}: {told[0]} -> {told[1]}"


def value_line(one: Pairing) -> str:
    """A value that differs."""
    if one.first is None or one.second is None:
        return f"  {one.name}: only in {'A' if one.second is None else 'B'}"
    unit = f" {one.first.unit}" if one.first.unit else ""
    if one.first.unit != one.second.unit:
        return f"  {one.name}: {one.first.value:.6g}{unit} -> {one.second.value:.6g} {one.second.unit}"
    errors = ", within the estimated errors" if one.within_errors else ""
    return f"  {one.name}: {one.first.value:.6g} -> {one.second.value:.6g}{unit} ({one.share:+.2%}{errors})"


def table_lines(one: Joined, tolerance: float) -> list[str]:
    """The columns of a table that differ most."""
    place = one.table.columns[0]
    moving = sorted((found for found in one.differences if found.share > tolerance), key=lambda found: -found.share)
    lines = []
    for found in moving[:_COLUMNS]:
        where = f"{found.where:.6g}" if isinstance(found.where, float) else found.where
        unit = f" {found.column.unit}" if found.column.unit else ""
        at = f" at {place.name} = {where}{f' {place.unit}' if place.unit else ''}" if found.where != "" else ""
        size = (
            f"by up to {found.largest:+.4g}{unit}{at}" if math.isfinite(found.largest) else "a number on one side alone"
        )
        lines.append(f"  {one.table.name}, {found.column.name}: {size}")
    if len(moving) > _COLUMNS:
        lines.append(f"  {one.table.name}: {len(moving) - _COLUMNS} more columns")
    if one.only_first or one.only_second:
        lines.append(f"  {one.table.name}: {one.only_first} rows stand in A alone, {one.only_second} in B alone")
    for label in "AB":
        names = [name for name, side in one.alone if side == label]
        if names:
            lines.append(f"  {one.table.name}: only {label} has the column{'s' * (len(names) > 1)} {', '.join(names)}")
    return lines
