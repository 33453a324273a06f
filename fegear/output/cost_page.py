"""``report.html`` of a study of cost: every point says which rung it is, every table can be taken along."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.report import Page, Section
from fegear.output.report.blocks import DataTable, Facts, Grid, Notes, Paragraph, Plot
from fegear.output.report.figure import Figure, column
from fegear.studies.cost.result import TOLERANCES
from fegear.studies.cost.tables import tables

if TYPE_CHECKING:
    from fegear.engine.outcome import Table
    from fegear.output.report.page import Block
    from fegear.studies.cost.quantities import Quantity
    from fegear.studies.cost.result import CostResults

_FAMILIES = (
    ("ring", "whole gear", "@blue", "circle"),
    ("sector", "sector with free sides", "@orange", "triangle-up"),
    ("compliance-formula", "closed form", "@red", "x"),
    ("stress-formula", "closed form", "@red", "x"),
    ("table", "the case's table", "@green", "square"),
    ("tolerance", "picked for accuracy.tolerance, its error estimate paid", "@purple", "star"),
)


def _figure(results: CostResults, quantity: Quantity, table: Table) -> Figure:
    floor = results.floors[quantity.name]
    made = Figure(
        f"cost_{quantity.name}", f"Cost of {quantity.name}: {quantity.meaning}",
        "Largest relative error over processor seconds, from nothing to the answer. Below the dotted line nothing is "
        "claimed: the reference itself knows no better.",
    )  # fmt: skip
    panel = made.panel("processor seconds [s]", "largest relative error", log_x=True, log_y=True)
    hover = "%{customdata}<br>%{x:.3~g} s, error %{y:.2~g}<extra></extra>"
    present = {row.rung.family for row in results.of(quantity.name)}
    for family, label, colour, symbol in _FAMILIES:
        if family in present:
            where = {"quantity": quantity.name, "family": family}
            panel.points(
                table, "seconds", "error_where_answered", label, where=where, customdata=column(table, "rung", where),
                hovertemplate=hover, marker={"color": colour, "symbol": symbol, "size": 8},
            )  # fmt: skip
    where = {"quantity": quantity.name, "on_front": "1"}
    panel.line(table, "seconds", "error", "Pareto front", where=where, colour="@blue", dash="dot", hoverinfo="skip")
    panel.mark("y", floor, "what the reference knows")
    made.shared = False
    return made


def _cheapest(results: CostResults) -> Grid:
    rows = []
    for name in results.named:
        found = [results.cheapest(name, tolerance) for tolerance in TOLERANCES]
        cells = [f"{row.rung.label}: {row.seconds.cpu:.2g} s" if row else "not reached" for row in found]
        rows.append([name, *cells])
    return Grid(["", *(f"{tolerance:.0e}" for tolerance in TOLERANCES)], rows)


def cost_page(results: CostResults) -> Page:
    """Make the page of a study.

    Parameters
    ----------
    results : CostResults

    Returns
    -------
    Page
    """
    cost, orders, knobs, cheapest = tables(results)
    scene = results.asked.scene
    total = f"{results.finished} of {results.planned} rungs in {results.seconds:.0f} s"
    lead: list[Block] = [Paragraph(
        "Every rung computes the same quantities with other means. Errors are relative, the largest over the load "
        "positions, against a converged solution; seconds are those of one core and wander on a busy machine."
    )]  # fmt: skip
    if results.remarks:
        lead.insert(0, Notes(results.remarks))
    settings = {k: v for k, v in results.asked.scene.case.effects.model_dump().items() if v not in (False, "none")}
    sections = [Section("Cheapest settings for a tolerance", (*lead, _cheapest(results), DataTable(cheapest)))]
    sections += [Section(f"Cost of {q.name}", (Plot(_figure(results, q, cost)),)) for q in results.quantities]
    if np.size(orders.columns[0].values):
        sections.append(Section("What each knob does", (DataTable(orders), DataTable(knobs))))
    sections.append(Section("Every rung", (DataTable(cost), Facts({"reference": results.reference.label, **settings}))))
    title = f"What accuracy costs: {scene.case.title or scene.name}"
    return Page(title, total, tuple(sections), (cost, orders, knobs, cheapest), name=f"{scene.name}-cost")
