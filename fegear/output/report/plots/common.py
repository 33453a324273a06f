"""What several figures need: tables by name, families of curves, cells as the CSV files write them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.tables import cell

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.engine.outcome import Outcome, Table

#: More curves of a family than this cannot be told apart.
MOST_CURVES = 7


def table_named(outcome: Outcome, name: str) -> Table | None:
    """The table of that name, or None."""
    return next((table for table in outcome.tables if table.name == name), None)


def starting(outcome: Outcome, start: str) -> list[Table]:
    """Tables whose name starts so."""
    return [table for table in outcome.tables if table.name.startswith(start)]


def cells(table: Table, name: str) -> list[str]:
    """Different cells of a column, in order, as the CSV file writes them."""
    shown = next(column.shown for column in table.columns if column.name == name)
    return list(dict.fromkeys(cell(value) for value in shown))


def few(found: list[str], keep: Iterable[str] = ()) -> list[str]:
    """At most `MOST_CURVES` of a family, evenly chosen, with those to keep."""
    if len(found) <= MOST_CURVES:
        return found
    chosen = {found[round(i)] for i in np.linspace(0, len(found) - 1, MOST_CURVES)} | set(keep)
    return [item for item in found if item in chosen]


def short(told: str) -> str:
    """A cell of numbers with few digits."""
    return f"{float(told):.5g}"
