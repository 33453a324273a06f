"""What ``fegear compare`` writes: joined tables, pictures, a page, a summary."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import fegear
from fegear.base.printed import percent
from fegear.output.folder import SUMMARY, files_in
from fegear.output.report.blocks import DataTable, Grid, Notes, Paragraph, Plot
from fegear.output.report.page import Page, Section, write_page
from fegear.output.summary import write_json
from fegear.output.tables import write_table
from fegear.studies.comparison.compare import Comparison
from fegear.studies.comparison.drawn import comparison_figures


def comparison_page(comparison: Comparison) -> Page:
    """The page of a comparison: inputs, values, curves over each other, joined tables."""
    first, second = comparison.first, comparison.second
    tables = tuple(joined.table for joined in comparison.different_tables)
    inputs = [(one.key, *(_shown(text) for text in (one.first, one.second))) for one in comparison.inputs or ()]
    none = "Inputs not available for both runs (written by an older version)."
    none = none if comparison.inputs is None else "None."
    values = [
        (
            one.name,
            *("" if value is None else f"{value.value:.9g} {value.unit}".rstrip() for value in (one.first, one.second)),
            percent(one.share, signed=True) if np.isfinite(one.share) else "",
            "yes" if one.within_errors else "",
        )
        for one in comparison.different_values
    ]
    alone = [f"Table {name} only in {label}." for name, label in comparison.alone]
    alone += [
        f"Column {name} of table {joined.table.name} only in {label}."
        for joined in comparison.different_tables for name, label in joined.alone
    ]  # fmt: skip
    return Page(
        title="Two runs compared",
        note=f"A: {first.label}. B: {second.label}.",
        sections=(
            Section("Inputs that differ", (
                Grid(("Key", "A", "B"), inputs) if inputs else Paragraph(none),
            )),
            Section("Values that differ", (
                Grid(("Value", "A", "B", "Ratio B / A", "Within the estimated errors"), values) if values
                else Paragraph(f"None of {len(comparison.values)}."),
            )),
            Section("Curves overlaid", tuple(map(Plot, comparison_figures(comparison)))),
            Section("Tables that differ", (*((Notes(alone),) if alone else ()), *map(DataTable, tables))),
        ),
        tables=tables,
        name="compare",
    )  # fmt: skip


def _shown(text: object) -> str:
    return "(not given)" if text is None else str(text)


def comparison_summary(comparison: Comparison) -> dict[str, object]:
    """What programs read of a comparison."""

    def number(value: float) -> float | None:
        return float(value) if np.isfinite(value) else None

    return {
        "a": comparison.first.label,
        "b": comparison.second.label,
        "same": not comparison.results_differ,
        "inputs": None if comparison.inputs is None else {
            one.key: {"a": one.first, "b": one.second} for one in comparison.inputs
        },
        "values": {
            one.name: {
                "a": None if one.first is None else number(one.first.value),
                "b": None if one.second is None else number(one.second.value),
                "unit": (one.first or one.second).unit,  # type: ignore[union-attr]  # one of them is there
                "share": number(one.share),
                "within_errors": one.within_errors,
            }
            for one in comparison.different_values
        },
        "tables": {
            joined.table.name: {
                "largest": {
                    one.column.head: number(one.largest)
                    for one in joined.differences
                    if one.share > comparison.tolerance
                },
                "rows_only_in_a": joined.only_first,
                "rows_only_in_b": joined.only_second,
                "columns_only_in": {name: label.lower() for name, label in joined.alone},
            }
            for joined in comparison.different_tables
        },
        "tables_only_in": {name: label.lower() for name, label in comparison.alone},
    }  # fmt: skip


def write_comparison(comparison: Comparison, folder: Path, *, plots: bool = True) -> None:
    """Write joined tables, pictures, page and summary.

    Parameters
    ----------
    comparison : Comparison
    folder : Path
        An empty folder.
    plots : bool
        Whether to draw; without, matplotlib is not imported.
    """
    (folder / "tables").mkdir()
    for joined in comparison.different_tables:
        write_table(folder / "tables", joined.table)
    if plots:
        from fegear.output.draw_png import draw_pictures

        (folder / "plots").mkdir()
        for figure in comparison_figures(comparison):
            for _ in draw_pictures(figure, folder / "plots"):
                pass
    write_page(folder / "report.html", comparison_page(comparison))
    files = [*files_in(folder), SUMMARY]
    write_json(folder / SUMMARY, {**comparison_summary(comparison), "files": files, "version": fegear.__version__})
