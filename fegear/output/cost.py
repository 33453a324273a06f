"""What a cost study writes: tables, pictures, a page and ``summary.json``.

``report.html`` of a cost study: every point says which configuration it is, every table can be downloaded.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import fegear
from fegear.base.units import from_si
from fegear.engine.figure.figure import Figure
from fegear.output.folder import SUMMARY, files_in
from fegear.output.report.blocks import Block, DataTable, Facts, Grid, Notes, Paragraph, Plot
from fegear.output.report.page import Page, Section, write_page
from fegear.output.summary import write_json
from fegear.output.tables import write_table
from fegear.studies.cost.result import ALL, TOLERANCES, CostResults
from fegear.studies.cost.tables import cost_figures, tables


def write_cost(results: CostResults, folder: Path, *, plots: bool = True) -> None:
    """Write tables, pictures, page and summary.

    Parameters
    ----------
    results : CostResults
    folder : Path
        An empty folder.
    plots : bool
        Whether to draw.
    """
    (folder / "tables").mkdir()
    for table in tables(results):
        write_table(folder / "tables", table)
    figures = cost_figures(results)
    if plots:
        from fegear.output.draw_png import draw_pictures

        (folder / "plots").mkdir()
        for figure in figures:
            for _ in draw_pictures(replace(figure, case=results.asked.scene.name), folder / "plots"):
                pass
    write_page(folder / "report.html", cost_page(results, figures))
    write_json(folder / SUMMARY, _summary(results, [*files_in(folder), SUMMARY]))


def _summary(results: CostResults, files: list[str]) -> dict[str, object]:
    scene = results.asked.scene
    reference = {}
    for quantity in results.quantities:
        scale = from_si(quantity.unit) if quantity.unit else 1.0
        value = results.reference_values[quantity.name] * scale
        floor = results.floors[quantity.name]
        reference[f"{quantity.subject}.{quantity.name}"] = {
            "value": value, "unit": quantity.unit, "error": floor * abs(value), "meaning": quantity.meaning,
        }  # fmt: skip
    cheapest = {
        q.name: {f"{tolerance:.0e}": _configuration(results, q.name, tolerance) for tolerance in TOLERANCES}
        for q in results.quantities
    }
    return {
        "title": scene.case.title,
        "case": scene.name,
        "results": reference,
        "cheapest": cheapest,
        "settings": {"reference": results.reference.paste(""), "effects": list(scene.case.effects.on())},
        "configurations": {"planned": results.planned, "finished": results.finished},
        "timings": {"total": round(results.seconds, 6)},
        "remarks": list(results.remarks),
        "files": files,
        "version": fegear.__version__,
    }


def _configuration(results: CostResults, quantity: str, tolerance: float) -> dict[str, object] | None:
    row = results.cheapest(quantity, tolerance)
    if row is None:
        return None
    error = results.shown_error(row)
    return {
        "configuration": row.configuration.label,
        "seconds": round(row.seconds.cpu, 6),
        "error": error if math.isfinite(error) else None,
        "case_line": row.configuration.paste(results.asked.pair),
    }


def cheapest_lines(results: CostResults) -> list[str]:
    """The cheapest settings in words, for the terminal."""
    lines = []
    for name in results.named:
        floor = "" if name == ALL else f" (error of the reference: {results.floors[name]:.0e})"
        lines.append(f"{name}{floor}:")
        for tolerance in TOLERANCES:
            row = results.cheapest(name, tolerance)
            best = f"{row.seconds.cpu:9.3g} s  {row.configuration.label}" if row else "not reached"
            lines.append(f"  {tolerance:.0e}  {best}")
    return lines


def _cheapest(results: CostResults) -> Grid:
    rows = []
    for name in results.named:
        found = [results.cheapest(name, tolerance) for tolerance in TOLERANCES]
        cells = [f"{row.configuration.label}: {row.seconds.cpu:.2g} s" if row else "not reached" for row in found]
        rows.append([name, *cells])
    return Grid(["", *(f"{tolerance:.0e}" for tolerance in TOLERANCES)], rows)


def cost_page(results: CostResults, figures: Sequence[Figure]) -> Page:
    """Make the page of a study.

    Parameters
    ----------
    results : CostResults
    figures : sequence of Figure

    Returns
    -------
    Page
    """
    cost, orders, knobs, cheapest = tables(results)
    scene = results.asked.scene
    total = f"{results.finished} of {results.planned} configurations in {results.seconds:.0f} s"
    lead: list[Block] = [Paragraph(
        "All configurations compute the same quantities with different settings. Maximum relative errors over the "
        "load positions, relative to a converged solution; CPU time on one core (varies on a busy machine)."
    )]  # fmt: skip
    if results.remarks:
        lead.insert(0, Notes(results.remarks))
    settings = {k: v for k, v in results.asked.scene.case.effects.model_dump().items() if v not in (False, "none")}
    sections = [Section("Cheapest settings for a tolerance", (*lead, _cheapest(results), DataTable(cheapest)))]
    by_key = {figure.key: figure for figure in figures}
    sections += [Section(f"Cost of {q.name}", (Plot(by_key[f"cost_{q.name}"]),)) for q in results.quantities]
    knobs_drawn = (Plot(by_key["cost_knobs"]),) if "cost_knobs" in by_key else ()
    if len(orders.columns[0]):
        sections.append(Section("Influence of each setting", (*knobs_drawn, DataTable(orders), DataTable(knobs))))
    reference = Facts({"reference": results.reference.label, **settings})
    sections.append(Section("All configurations", (DataTable(cost), reference)))
    title = f"Accuracy versus computing time: {scene.case.title or scene.name}"
    return Page(title, total, tuple(sections), (cost, orders, knobs, cheapest), name=f"{scene.name}-cost")
