"""``report.html`` of a cost study: every point says which configuration it is, every table can be downloaded."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.output.report import Page, Section
from fegear.output.report.blocks import DataTable, Facts, Grid, Notes, Paragraph, Plot
from fegear.studies.cost.result import TOLERANCES
from fegear.studies.cost.tables import tables

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.engine.figure import Figure
    from fegear.output.report.blocks import Block
    from fegear.studies.cost.result import CostResults


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
        "Every configuration computes the same quantities in another way. Errors are relative, the largest over "
        "the load positions, against a converged solution; seconds are those of one core and wander on a busy machine."
    )]  # fmt: skip
    if results.remarks:
        lead.insert(0, Notes(results.remarks))
    settings = {k: v for k, v in results.asked.scene.case.effects.model_dump().items() if v not in (False, "none")}
    sections = [Section("Cheapest settings for a tolerance", (*lead, _cheapest(results), DataTable(cheapest)))]
    by_key = {figure.key: figure for figure in figures}
    sections += [Section(f"Cost of {q.name}", (Plot(by_key[f"cost_{q.name}"]),)) for q in results.quantities]
    knobs_drawn = (Plot(by_key["cost_knobs"]),) if "cost_knobs" in by_key else ()
    if len(orders.columns[0]):
        sections.append(Section("What each setting does", (*knobs_drawn, DataTable(orders), DataTable(knobs))))
    reference = Facts({"reference": results.reference.label, **settings})
    sections.append(Section("Every configuration", (DataTable(cost), reference)))
    title = f"What accuracy costs: {scene.case.title or scene.name}"
    return Page(title, total, tuple(sections), (cost, orders, knobs, cheapest), name=f"{scene.name}-cost")
