"""The whole comparison of two runs, and what it says in words.

Where two cases differ: in what they mean, not in how it is written.

Single values of two runs, compared.

One side of a comparison, from a run in memory; `fegear.output.comparison` reads one from a folder.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from fegear.base.printed import percent
from fegear.case.known_keys import flat, meaning_of
from fegear.engine.run import Results
from fegear.engine.table import Table
from fegear.engine.value import Value
from fegear.studies.comparison.joined import Joined, join

#: Columns of a table on the terminal.
_COLUMNS = 4


#: Lines of each kind on the terminal.
_LINES = 40


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two runs compared.

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
            lines.append("Inputs: not available for both runs (written by an older version).")
        elif not self.inputs:
            lines.append("Inputs: identical.")
        else:
            lines += ["Inputs that differ:", *(input_line(one) for one in self.inputs)]
        lines += _listed("Values", len(self.values), [value_line(one) for one in self.different_values])
        lines += _listed("Tables", len(self.tables), [
            line for one in self.different_tables for line in table_lines(one, self.tolerance)
        ])  # fmt: skip
        return lines + [f"Table {name} only in {label}." for name, label in self.alone]


def compare(first: Side, second: Side, tolerance: float = 0.0) -> Comparison:
    """Compare two runs.

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
        return [f"{what}: {'identical' if count else 'none'}."]
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
    return (
        f"  {one.name}: {one.first.value:.6g} -> {one.second.value:.6g}{unit} "
        f"({percent(one.share, signed=True)}{errors})"
    )


def table_lines(one: Joined, tolerance: float) -> list[str]:
    """The columns of a table that differ most."""
    place = one.table.columns[0]
    moving = sorted((found for found in one.differences if found.share > tolerance), key=lambda found: -found.share)
    lines = []
    for found in moving[:_COLUMNS]:
        where = f"{found.where:.6g}" if isinstance(found.where, float) else found.where
        unit = f" {found.column.unit}" if found.column.unit else ""
        at = f" at {place.name} = {where}{f' {place.unit}' if place.unit else ''}" if found.where != "" else ""
        size = f"by up to {found.largest:+.4g}{unit}{at}" if math.isfinite(found.largest) else "value in one run only"
        lines.append(f"  {one.table.name}, {found.column.name}: {size}")
    if len(moving) > _COLUMNS:
        lines.append(f"  {one.table.name}: {len(moving) - _COLUMNS} more columns")
    if one.only_first or one.only_second:
        lines.append(f"  {one.table.name}: {one.only_first} rows only in A, {one.only_second} only in B")
    for label in "AB":
        names = [name for name, side in one.alone if side == label]
        if names:
            lines.append(f"  {one.table.name}: column{'s' * (len(names) > 1)} {', '.join(names)} only in {label}")
    return lines


#: Numbers that differ by less than this share are the same: 3 mm and 0.003 m.
_SAME = 1e-12


class Input(NamedTuple):
    """A key that differs, with what each case writes: None where it is not given."""

    key: str
    first: object
    second: object


def different_inputs(first: Mapping[str, object], second: Mapping[str, object]) -> tuple[Input, ...]:
    """Return the keys whose meanings differ; a key at its default is the same as one not given.

    Parameters
    ----------
    first, second : mapping
        Cases as they are written.
    """
    written = flat(first), flat(second)
    meant = meaning_of(first), meaning_of(second)
    keys = dict.fromkeys([*meant[0], *meant[1]])
    found = [key for key in keys if not _same(meant[0].get(key), meant[1].get(key))]
    told = [Input(key, *(_written(key, text) for text in written)) for key in found]
    # What neither writes are defaults within a table that one of them has, which its own keys tell.
    return tuple(one for one in told if one.first is not None or one.second is not None)


def _written(key: str, written: Mapping[str, object]) -> object:
    """What a case writes for a key, or for the table that it stands in (``rack = "ISO 53 A"``)."""
    while key:
        for form in (key, key.replace("[0]", "")):  # one table stands for a list of one
            if form in written:
                return written[form]
        key = key.rpartition(".")[0]
    return None


def _same(a: object, b: object) -> bool:
    if isinstance(a, float) and isinstance(b, float):
        return math.isclose(a, b, rel_tol=_SAME, abs_tol=0.0)
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(_same(x, y) for x, y in zip(a, b, strict=True))
    return a == b


#: Share that the last digits of a processor may change of a number without an estimated error.
_ROUND_OFF = 1e-9


class Pairing(NamedTuple):
    """A value in both runs; None where a run has none."""

    name: str
    first: Value | None
    second: Value | None

    @property
    def both(self) -> tuple[Value, Value]:
        """The two values, where no run lacks it."""
        if self.first is None or self.second is None:
            raise LookupError(f"{self.name} is missing on one side")
        return self.first, self.second

    @property
    def change(self) -> float:
        """Second less first, in the first one's unit; not a number where one is missing."""
        if self.first is None or self.second is None or self.first.unit != self.second.unit:
            return math.nan
        return self.second.value - self.first.value

    @property
    def share(self) -> float:
        """The change over the larger of the two."""
        if self.change == 0.0 or self.first is None or self.second is None:
            return self.change
        return self.change / max(abs(self.first.value), abs(self.second.value))

    @property
    def within_errors(self) -> bool:
        """Whether the estimated errors of the two explain the change."""
        errors = [value.error or 0.0 for value in (self.first, self.second) if value is not None]
        return abs(self.change) <= sum(errors)

    @property
    def resolved(self) -> bool:
        """Whether the change exceeds the estimated errors of the two, and the round-off of numbers without one."""
        return abs(self.share) > _ROUND_OFF and not self.within_errors

    def differs(self, tolerance: float) -> bool:
        """Whether it is missing on one side, or changes by more than a share; no number twice is no change."""
        both = self.first is not None and self.second is not None
        if both and math.isnan(self.first.si) and math.isnan(self.second.si):  # type: ignore[union-attr]  # both are there
            return False
        return not abs(self.share) <= tolerance


def paired(first: Mapping[str, Value], second: Mapping[str, Value]) -> tuple[Pairing, ...]:
    """Every value of either run, in the order of the first."""
    return tuple(Pairing(name, first.get(name), second.get(name)) for name in dict.fromkeys([*first, *second]))


@dataclass(frozen=True, slots=True)
class Side:
    """What is known of a run.

    Parameters
    ----------
    label : str
        By which the reader knows it.
    document : mapping
        The case as it was written, ``--set`` options included; empty where it is not known.
    values : mapping of str to Value
    tables : mapping of str to Table
    """

    label: str
    document: Mapping[str, object]
    values: Mapping[str, Value]
    tables: Mapping[str, Table]


def side_of(results: Results, label: str) -> Side:
    """A run as one side of a comparison."""
    return Side(
        label,
        results.scene.document,
        {value.name: value for value in results.values},
        {table.name: table for table in results.tables},
    )
