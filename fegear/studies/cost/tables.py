"""The study's numbers as tables.

Figures of a study of cost: error against time on logarithmic axes, and error against each knob.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import percent
from fegear.base.units import from_si
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Item, Mark, Points, Zone
from fegear.engine.figure.panel import Panel
from fegear.engine.table import Column, Table
from fegear.studies.cost.ladder import FlankConfiguration
from fegear.studies.cost.result import ALL, TOLERANCES, CostResults, Measured

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.studies.cost.quantities import Quantity


def cost_table(results: CostResults) -> Table:
    """Every configuration for every quantity, in rising time."""
    names = [q.name for q in results.quantities]
    rows = sorted(results.rows, key=lambda row: (names.index(row.quantity), row.seconds.cpu))
    unit = {q.name: q.unit for q in results.quantities}
    on_front = set()
    for quantity in results.quantities:
        front = results.front(quantity.name)
        on_front |= {id(front.rows[i]) for i in front.front}

    def number(read: Callable[[Measured], float]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.array([read(row) for row in rows], dtype=float)

    def words(read: Callable[[Measured], str]) -> np.ndarray[tuple[int], np.dtype[np.str_]]:
        return np.array([read(row) for row in rows], dtype=np.str_)

    def setting(name: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        found = [row.configuration.settings for row in rows]
        return np.array([float(getattr(s, name)) if s else math.nan for s in found])

    panels = [c.panels if isinstance(c := row.configuration, FlankConfiguration) else 0 for row in rows]
    columns = (
        Column("quantity", words(lambda r: r.quantity), "", "computed quantity"),
        Column("configuration", words(lambda r: r.configuration.label), "", "configuration"),
        Column("family", words(lambda r: r.configuration.family), "", "kind of configuration"),
        Column("seconds", number(lambda r: r.seconds.cpu), "s", "CPU time on one core, from scratch"),
        Column("seconds_wall", number(lambda r: r.seconds.wall), "s", "wall-clock time"),
        Column("seconds_solving", number(lambda r: r.solve.cpu), "s", "CPU time for meshing and solving the gears"),
        Column("seconds_fixed", number(lambda r: r.fixed.cpu), "s", "CPU time common to all configurations (not "
                                                                    "compared)"),
        Column("error", number(results.shown_error), "", "maximum relative error, at least that of the reference"),
        Column("below_floor", number(lambda r: r.miss.largest <= results.floors[r.quantity]).astype(int), "",
               "1: error below that of the reference (at most `error`)"),
        Column("floor", number(lambda r: results.floors[r.quantity]), "", "estimated error of the reference"),
        Column("error_where_answered", number(results.error_where_answered), "",
            "`error` over the positions with a result"),
        Column("compliance_error", number(lambda r: r.compliance_error), "",
               "error of c_0 of the pair used for the quantity; settings exceeding a tolerance in it are not selected"),
        Column("answered", number(lambda r: r.miss.answered), "", "fraction of load positions with a result"),
        Column("on_front", np.array([int(id(r) in on_front) for r in rows]), "", "1: Pareto optimal"),
        Column("value", number(lambda r: r.value * (from_si(unit[r.quantity]) if unit[r.quantity] else 1.0)), "",
               "result; maximum over several positions"),
        Column("unit", words(lambda r: unit[r.quantity]), "", "unit of value"),
        Column("order", setting("order"), "", "order of the elements"),
        Column("root_edge_length", setting("root_edge_length"), "", "[modules]"),
        Column("flank_edge_length", setting("flank_edge_length"), "", "[modules]"),
        Column("patch_half_width", setting("patch_half_width"), "", "[modules]"),
        Column("teeth", np.array([r.configuration.teeth for r in rows]), "",
            "number of teeth of a sector; 0: full gear"),
        Column("panels", np.array(panels, dtype=int), "", "panels over the face width of a 3D pair; otherwise 0"),
        Column("case_line", words(lambda r: r.configuration.paste(results.asked.pair)), "",
               "case setting for this configuration"),
        Column("reason", words(lambda r: r.reason), "", "reason for missing result"),
    )  # fmt: skip
    return Table("cost", columns, "Error and CPU time of all configurations")


def orders_table(results: CostResults) -> Table:
    """Observed order of every knob."""
    knobs = results.knobs
    columns = (
        Column("quantity", np.array([k.quantity for k in knobs], dtype=np.str_)),
        Column("knob", np.array([k.name for k in knobs], dtype=np.str_), "", "setting varied"),
        Column("order", np.array([k.order.slope for k in knobs]), "", "p of error ~ step^p; blank: none"),
        Column(
            "configurations_used",
            np.array([k.order.used for k in knobs], dtype=int),
            "",
            "number of configurations on the line",
        ),
        Column("configurations", np.array([k.step.size for k in knobs], dtype=int), "", "tried"),
        Column("scatter", np.array([k.order.scatter for k in knobs]), "", "maximum factor from the line"),
        Column("rests_on", np.array([k.order.words for k in knobs], dtype=np.str_)),
        Column("at", np.array([k.at for k in knobs], dtype=np.str_), "", "other settings"),
    )
    return Table("cost_orders", columns, "Observed order of each setting")


def knobs_table(results: CostResults) -> Table:
    """The configurations behind the observed orders."""
    knobs = results.knobs
    count = np.array([k.step.size for k in knobs], dtype=int)

    def joined(name: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.concatenate([np.empty(0), *(getattr(k, name) for k in knobs)])

    columns = (
        Column("quantity", np.repeat(np.array([k.quantity for k in knobs], dtype=np.str_), count)),
        Column("knob", np.repeat(np.array([k.name for k in knobs], dtype=np.str_), count)),
        Column("setting", joined("settings"), "", "value of the setting: edges and patches in modules"),
        Column("error", joined("error"), "", "relative error from this setting only"),
        Column("floor", np.repeat(np.array([k.floor for k in knobs]), count), "", "error of the reference"),
        Column("seconds", joined("seconds"), "s", "CPU time on one core; blank if negligible"),
    )
    return Table("cost_knobs", columns, "Error over each setting")


def cheapest_table(results: CostResults) -> Table:
    """The cheapest settings for each tolerance, of each quantity and of all at once."""
    wanted = [(name, tolerance) for name in results.named for tolerance in TOLERANCES]
    found = [results.cheapest(name, tolerance) for name, tolerance in wanted]
    error = [_error(results, row) for row in found]
    labels = [row.configuration.label if row else "not reached" for row in found]
    lines = [row.configuration.paste(results.asked.pair) if row else "" for row in found]
    columns = (
        Column("quantity", np.array([name for name, _ in wanted], dtype=np.str_)),
        Column("tolerance", np.array([tolerance for _, tolerance in wanted]), "", "relative"),
        Column("configuration", np.array(labels, dtype=np.str_)),
        Column("seconds", np.array([row.seconds.cpu if row else math.nan for row in found]), "s",
            "CPU time on one core"),
        Column("error", np.array(error), "", "maximum relative error"),
        Column("case_line", np.array(lines, dtype=np.str_), "", "case setting for this configuration"),
    )  # fmt: skip
    return Table("cost_cheapest", columns, "Cheapest settings for a tolerance")


def _error(results: CostResults, row: Measured | None) -> float:
    if row is None:
        return math.nan
    return row.miss.largest if row.quantity == ALL else results.shown_error(row)


def tables(results: CostResults) -> tuple[Table, ...]:
    """All of them."""
    return cost_table(results), orders_table(results), knobs_table(results), cheapest_table(results)


#: How quantities are called.
NAMES = {
    "c_0": "c_{0}, self-compliance",
    "c_1": "c_{1}, next tooth",
    "root-stress": "root stress",
    "te-peak-to-peak": "peak-to-peak transmission error",
    "tooth-force": "maximum tooth force",
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
_OF_FLANKS = (
    " Edge lengths decrease from each group of equal marks to the next on the right; panels differ within a group."
)


_ORDERS = ((2, "sky", "circle"), (3, "blue", "square"), (4, "green", "diamond"))


#: Where the grey zone of the reference's own error starts, over that error.
_BELOW = 0.3


def cost_figures(results: CostResults) -> tuple[Figure, ...]:
    """Describe all: the quantities together, each alone, and the knobs where some were turned."""
    alone = tuple(_quantity_figure(results, quantity) for quantity in results.quantities)
    more = _OF_FLANKS if results.asked.over_face else ""
    together = Figure(
        "cost", "Accuracy versus computing time",
        f"All configurations; grey: below the error of the reference.{more}",
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
        f"{quantity.meaning[0].upper()}{quantity.meaning[1:]}: relative error (reference: converged solution) over "
        f"CPU time. Grey band: below the error of the reference ({floor:.0e})."
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
        (("scikit-fem",), "ring, sector by scikit-fem", "green", "x"),
        (("table",), "table of the case", "ink", "square"),
        (("thin-slices-alone",), "thin slices without neighbours", "orange", "x"),
        (("thin-slices",), "thin slices", "orange", "triangle-up"),
        (("coupled-slices-alone",), "coupled slices without neighbours", "green", "x"),
        (("coupled-slices",), "coupled slices", "green", "diamond"),
        (("solid-alone",), "solid without neighbours", "blue", "x"),
        (("solid",), "solid", "blue", "circle"),
        (("tolerance",), "selected by accuracy.tolerance, including error estimation", "purple", "star"),
    ):
        here = [row for row in rows if row.configuration.family in families]
        items += _points(results, here, label, role, symbol, written=written and not results.asked.over_face)
    front = results.front(quantity.name)
    if front.front.size:
        t, e = np.maximum(front.seconds[front.front], _QUICKEST), front.error[front.front]
        items.append(Curve(t, e, "Pareto front", "ink", dash="steps", width=1.0, markers=False))
    floor = results.floors[quantity.name]
    marks = (Zone("y", _BELOW * floor, floor), Mark("y", floor)) if floor > 0.0 else ()
    x = Axis("CPU time [s], one core, from scratch", log=True)
    return Panel(x, Axis("maximum relative error", log=True), tuple(items), marks, title, height=1.4)


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
    return text + (f" ({percent(row.miss.answered)} of the flank)" if row.miss.answered < 1.0 else "")


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
        title = f"order: {', '.join(orders)}" if orders else "no order observed"
        unit = "modules" if name.startswith(("edge", "patch")) else ""
        axes = Axis(name, unit, log=True), Axis("relative error", log=True)
        panels.append(Panel(*axes, tuple(curves), title=title))
    return Figure(
        "cost_knobs", "Influence of each setting", "One setting varied at a time, all others at the "
                                                "finest level.", tuple(panels),
        columns=min(3, len(names)),
    )  # fmt: skip
