"""The least that an estimated error may be: what another processor makes of the same numbers.

An estimate from two discretisations, two widths or two quadratures can come out as nothing where both agree by
symmetry, by chance, or because one is exact there; the number itself then still hangs on the last digits of hundreds of
sums, which kernels with and without fused multiply-add make differently. So an error that is stated is never below a
share of the largest number that the quantity could have been taken from.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.value import Value

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.engine.table import Column, Table


#: Of the largest number in its unit beside it: differences of what is as large keep no digits below. Two processors
#: differ by up to 3e-9 in a history of root stress.
ROUND_OFF = 1e-8

#: Estimated errors above this part of their value are noted, and of so many values the names.
_ROUGH, _NAMED = 0.2, 3


def _is_rough(value: Value, beside: Iterable[Value]) -> bool:
    """Whether an estimated error is a large part of its value, and more than digits of the values beside it.

    A value of exactly zero has no part: its error says all. That of a choice is the width of its optimum.
    """
    if (
        value.choice
        or not value.si_error
        or not value.si
        or not math.isfinite(value.si)
        or not math.isfinite(value.si_error)
    ):
        return False
    largest = max(abs(one.si) for one in beside if one.unit == value.unit and math.isfinite(one.si))
    if value.zero or abs(value.si) <= (ROUND_OFF * largest if value.unit else 0.0):
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
            value = replace(value, si_error=error)  # noqa: PLW2901  (the same value with its error)
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
