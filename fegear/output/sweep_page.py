"""The page of a sweep: every value over the axes, the table, and the failures with their reasons."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure.figure import Figure
from fegear.engine.table import Table
from fegear.output.numbers import plain_number, pretty_unit
from fegear.output.report.blocks import DataTable, Facts, Grid, Notes, Paragraph, Plot
from fegear.output.report.page import Page, Section
from fegear.studies.sweep import SweepResults
from fegear.studies.swept import Swept, varying

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fegear.engine.figure.figure import Figure

    Array = NDArray[np.generic]


def _title(one: Swept) -> str:
    return f"{one.name} [{pretty_unit(one.unit)}]" if one.unit else one.name


def sweep_page(
    results: SweepResults, table: Table, swept: Sequence[Swept], figures: Sequence[Figure], remarks: Sequence[str]
) -> Page:
    """Put the page of a sweep together; equal results give equal pages, so it shows no seconds.

    Parameters
    ----------
    results : SweepResults
    table : Table
        What ``tables/sweep.csv`` holds.
    swept : sequence of Swept
        Its values.
    figures : sequence of Figure
    remarks : sequence of str
        What the points remark.
    """
    count, failed = len(results.points), len(results.failures)
    moving = varying(swept)
    level = [one for one in swept if one not in moving and np.isfinite(one.number).any()]
    constant = {
        _title(one): plain_number(float(one.number[np.isfinite(one.number)][0])) for one in level
    }  # fmt: skip
    axes = [
        (axis.key, ", ".join(str(value) for value in axis.values) if len(axis) <= 12
         else f"{axis.values[0]} to {axis.values[-1]}, {len(axis)} values")
        for axis in results.axes
    ]  # fmt: skip
    summary = f"{count - failed} of {count} points computed." if failed else f"All {count} points computed."
    failures = [
        (len(group.members), group.kind, results.place(group.members[0]), group.reason) for group in results.failed()
    ]
    return Page(
        title=f"Sweep: {results.title}",
        note=f"Case {results.name} over {' and '.join(axis.key for axis in results.axes)}. {summary}",
        sections=(
            Section("Warnings", (Notes(remarks, "warning"),) if remarks else ()),
            Section("Varied keys", (Grid(("Key", "Values"), axes), Paragraph(summary))),
            Section("Values over the varied keys", tuple(map(Plot, figures))),
            Section("Constant values", (Facts(constant),) if constant else ()),
            Section("Failures", (Grid(("Points", "Kind", "First at", "Message"), failures),) if failures else ()),
            Section("Table", (DataTable(table),)),
        ),
        tables=(table,),
        name=f"{results.name}_sweep",
    )  # fmt: skip
