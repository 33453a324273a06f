"""Figures of a study of cost: error against time on logarithmic axes, and error against each knob."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel, Points, Zone

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.engine.figure import Item
    from fegear.studies.cost.quantities import Quantity
    from fegear.studies.cost.result import CostResults, Measured

#: How quantities are called.
NAMES = {
    "c_0": "c_{0}, self compliance",
    "c_1": "c_{1}, next tooth",
    "root-stress": "root stress",
    "te-peak-to-peak": "peak-to-peak transmission error",
    "tooth-force": "largest tooth force",
    "dynamic-factor": "dynamic factor",
    "te-harmonics": "harmonics of the transmission error",
    "stiffness-harmonics": "harmonics of the mesh stiffness",
    "te-mean": "mean transmission error",
    "face-load-factor": "K_{Hbeta}, face load factor",
}
#: Formulas answer so quickly that their seconds would stretch the axis; they stand no farther left than this [s].
_QUICKEST = 1e-4
#: Errors below what a double resolves.
_ROUND_OFF = 1e-16
#: What tells alike marks of a pair with its width apart.
_OF_FLANKS = " Edges shorten from one group of equal marks to the next on the right; within a group panels differ."
_ORDERS = ((2, "sky", "circle"), (3, "blue", "square"), (4, "green", "diamond"))
#: Where the grey zone of the reference's own error starts, over that error.
_BELOW = 0.3


def cost_figures(results: CostResults) -> tuple[Figure, ...]:
    """Describe all: the quantities together, each alone, and the knobs where some were turned."""
    alone = tuple(_quantity_figure(results, quantity) for quantity in results.quantities)
    more = _OF_FLANKS if results.asked.over_face else ""
    together = Figure(
        "cost", "What accuracy costs",
        f"Every configuration of the study; grey: below the reference's own error.{more}",
        tuple(_panel(results, q, title=NAMES.get(q.name, q.name), written=False) for q in results.quantities),
        columns=min(2, len(results.quantities)),
    )  # fmt: skip
    return together, *alone, *((_knobs_figure(results),) if results.knobs else ())


def _quantity_figure(results: CostResults, quantity: Quantity) -> Figure:
    floor = results.floors[quantity.name]
    name = NAMES.get(quantity.name, quantity.name).replace("_{", "_").replace("}", "")
    return Figure(
        f"cost_{quantity.name}",
        f"Cost of {name}",
        f"{quantity.meaning[0].upper()}{quantity.meaning[1:]}: relative error against a converged solution over the "
        f"seconds it takes. The grey band lies below the error of the reference itself ({floor:.0e})."
        + (_OF_FLANKS if results.asked.over_face else ""),
        (_panel(results, quantity, title="", written=True),),
    )


def _panel(results: CostResults, quantity: Quantity, *, title: str, written: bool) -> Panel:
    rows = results.of(quantity.name)
    items: list[Item] = []
    for order, role, symbol in _ORDERS:
        whole = [row for row in rows if row.configuration.family == "ring"]
        ring = [row for row in whole if row.configuration.settings and row.configuration.settings.order == order]
        items += _points(results, ring, f"ring, order {order}", role, symbol)
    for families, label, role, symbol in (
        (("sector",), "sector with free sides", "orange", "triangle-up"),
        (("compliance-formula", "stress-formula"), "closed form", "red", "x"),
        (("table",), "the case's table", "ink", "square"),
        (("thin-slices-alone",), "thin slices without neighbours", "orange", "x"),
        (("thin-slices",), "thin slices", "orange", "triangle-up"),
        (("coupled-slices-alone",), "coupled slices without neighbours", "green", "x"),
        (("coupled-slices",), "coupled slices", "green", "diamond"),
        (("solid-alone",), "solid without neighbours", "blue", "x"),
        (("solid",), "solid", "blue", "circle"),
        (("tolerance",), "chosen for accuracy.tolerance, error estimate included", "purple", "star"),
    ):
        here = [row for row in rows if row.configuration.family in families]
        items += _points(results, here, label, role, symbol, written=written and not results.asked.over_face)
    front = results.front(quantity.name)
    if front.front.size:
        t, e = np.maximum(front.seconds[front.front], _QUICKEST), front.error[front.front]
        items.append(Curve(t, e, "Pareto front", "ink", dash="steps", width=1.0, markers=False))
    floor = results.floors[quantity.name]
    marks = (Zone("y", _BELOW * floor, floor), Mark("y", floor)) if floor > 0.0 else ()
    x = Axis("processor seconds of one core, from nothing to the answer", log=True)
    return Panel(x, Axis("largest relative error", log=True), tuple(items), marks, title, height=1.4)


def _points(
    results: CostResults, rows: Sequence[Measured], label: str, role: str, symbol: str, *, written: bool = False
) -> list[Points]:
    """Configurations with an error; a formula that leaves positions out still shows what it misses at the others."""
    error = [results.error_where_answered(row) for row in rows]
    known = [(row, e) for row, e in zip(rows, error, strict=True) if math.isfinite(e) and e > 0.0]
    if not known:
        return []
    x = [max(row.seconds.cpu, _QUICKEST) for row, _ in known]
    size = 5.0 if label.startswith("ring") else 8.0
    notes = tuple(_note(row) for row, _ in known)
    return [Points(x, [e for _, e in known], label, role, symbol, size, notes=notes, written=written)]


def _note(row: Measured) -> str:
    configuration = row.configuration
    text = f"{configuration.teeth} teeth" if configuration.teeth else configuration.formula or configuration.label
    return text + (f" ({row.miss.answered:.0%} of the flank)" if row.miss.answered < 1.0 else "")


def _knobs_figure(results: CostResults) -> Figure:
    names, quantities = (list(dict.fromkeys(getattr(k, key) for k in results.knobs)) for key in ("name", "quantity"))
    panels = []
    for name in names:
        curves, orders = [], []
        for knob in (k for k in results.knobs if k.name == name):
            known = np.isfinite(knob.error)
            error = np.maximum(knob.error[known], _ROUND_OFF)
            role = f"series:{quantities.index(knob.quantity)}"
            curves.append(Curve(knob.settings[known], error, knob.quantity, role, width=1.2, markers=True))
            if not math.isnan(knob.order.slope):
                orders.append(f"{knob.quantity} {knob.order.slope:.1f}")
        title = f"order: {', '.join(orders)}" if orders else "no order seen"
        unit = "modules" if name.startswith(("edge", "patch")) else ""
        axes = Axis(name, unit, log=True), Axis("relative error", log=True)
        panels.append(Panel(*axes, tuple(curves), title=title))
    return Figure(
        "cost_knobs", "What each setting does", "One setting varied at a time, all others fine.", tuple(panels),
        columns=min(3, len(names)),
    )  # fmt: skip
