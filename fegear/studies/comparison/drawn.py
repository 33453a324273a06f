"""Pictures of a comparison: what differs most, over each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.table import Column, Table
from fegear.studies.comparison.joined import Joined, follows

if TYPE_CHECKING:
    from collections.abc import Set

    from fegear.studies.comparison.compare import Comparison


#: Panels of a figure: more are in the table.
_PANELS = 4

#: Rows from which a column is a curve.
_ROWS = 3


def comparison_figures(comparison: Comparison) -> list[Figure]:
    """One figure for each table that differs and whose rows follow its first column: what differs most, in order."""
    found = []
    for joined in comparison.different_tables:
        name = joined.table.name
        tables = comparison.first.tables[name], comparison.second.tables[name]
        columns = _columns(joined, comparison.tolerance)
        if columns and all(_rising(table) for table in tables):
            labels = f"A: {comparison.first.label}", f"B: {comparison.second.label}"
            panels = tuple(_panel(tables, column.name, labels) for column in columns)
            caption = "Solid: A. Dashed: B."
            found.append(Figure(f"compare_{name}", joined.table.title or name, caption, panels))
    return found


def _columns(joined: Joined, tolerance: float) -> list[Column]:
    names = {one.column.name for one in joined.differences}
    shown = [one for one in joined.differences if not _is_error(one.column.name, names)]
    moving = [one for one in shown if one.share > tolerance and np.isfinite(one.share)]
    most = {one.column.name for one in sorted(moving, key=lambda one: -one.share)[:_PANELS]}
    # Rows that do not meet have no difference: such tables show their first columns.
    return [one.column for one in shown if one.column.name in most] or [one.column for one in shown[:_PANELS]]


def _is_error(name: str, names: Set[str]) -> bool:
    """Whether a column holds the estimated errors of another one."""
    return name.endswith("_error") and name.removesuffix("_error") in names


def _rising(table: Table) -> bool:
    return len(table) >= _ROWS and follows(table, table.columns[0].name)


def _panel(tables: tuple[Table, Table], name: str, labels: tuple[str, str]) -> Panel:
    place, column = tables[0].columns[0], tables[0].column(name)
    curves = tuple(
        Curve(table.columns[0].values, np.asarray(table.column(name).values, dtype=float), label, role, dash=dash)
        for table, label, role, dash in zip(tables, labels, ("series:0", "series:1"), ("solid", "dash"), strict=True)
    )
    return Panel(Axis(place.name, place.unit), Axis(column.name, column.unit), curves)
