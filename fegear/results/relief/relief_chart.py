"""Stages ``relief-chart`` and ``robustness``: many candidate reliefs, and how one holds up off its nominal state."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import percent
from fegear.base.shown import declared
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, columns_on_grid, drawn, stacked, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, View
from fegear.engine.figure.items import Curve, HeatMap, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.pair import MEMBERS
from fegear.results import forecasts
from fegear.results.relief.relief import ReliefData, design_pairs, design_part, relief_stage
from fegear.results.relief.relief_tables import tip_values

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.design import ChartPart, RobustnessPart
    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.design.charts import Metric, ReliefChart
    from fegear.design.held_relief import Robustness
    from fegear.design.tip_relief.grindable import TipReliefPair


#: How the single best of a chart is found.
_BEST = "equal tip reliefs, maximum over the loads, by A_e"


@dataclass(frozen=True)
class ReliefChartData:
    """What the stage hands to pictures.

    Parameters
    ----------
    pair : LoadedPair
    chart : ReliefChart
    best : TipReliefPair
        Found by the optimiser over the chart's loads, each gear on its own.
    delta : float
        Unit of the amounts in the picture [m]: transmission error of the unmodified pair at its largest.
    """

    pair: LoadedPair
    chart: ReliefChart
    best: TipReliefPair
    delta: float


@dataclass(frozen=True)
class ChartInputs:
    """What the chart of a pair depends on."""

    part: ChartPart
    metric: Metric
    name: str = field(compare=False)


def _chart_inputs(scene: Scene, name: str) -> ChartInputs:
    part = design_part(scene)
    return ChartInputs(part.chart, part.metric, name)


def _compute_chart(inputs: ChartInputs, upstream: Upstream, work: Work) -> ReliefChartData:
    from fegear.design.charts import relief_chart, unit_amount
    from fegear.design.tip_relief.grindable import optimise_tip_relief

    pair: LoadedPair
    (pair,) = upstream.values()
    asked, e = inputs.part, pair.engagement.unmodified()
    loads = np.array(asked.loads or pair.loads)
    delta = unit_amount(e, pair.nominal)
    shares = asked.amounts_over_delta or np.linspace(0.1, 1.6, 16)
    amounts = np.array(asked.amounts) if asked.amounts else delta * np.array(shares)
    lengths = np.array(asked.lengths) if asked.lengths else np.linspace(0.05, 1.3, 26)
    chart = relief_chart(e, np.sort(amounts), np.sort(lengths), loads, asked.shape)
    work.progress(0.5)
    return ReliefChartData(pair, chart, optimise_tip_relief(e, loads, asked.shape, inputs.metric), delta)


def _present_chart(data: ReliefChartData, inputs: ChartInputs) -> Outcome:
    from fegear.design.charts import meaning_of_unit

    name, metric, asked = inputs.name, inputs.metric, inputs.part
    chart, best, delta = data.chart, data.best, data.delta
    tables = (
        Table(
            f"relief_chart_{name}",
            columns_on_grid(chart, ("amounts", "lengths", "loads"), table="chart"),
            f"Excitation of {name} over amount, length and load",
        ),
        Table(
            f"relief_optimum_{name}",
            columns_on_grid(chart, ("amounts", "loads"), table="optimum"),
            f"Optimum lengths of tip relief of {name}",
        ),
    )
    amount, length = chart.best()
    values = [
        Value(f"{name}.delta", delta, "um", None, meaning_of_unit(data.pair.pair)),
        value_of(chart, "unit_length", name, 0.0),
        value_of(chart, "amounts", name, si=amount, name="best_amount", meaning=_BEST),
        value_of(chart, "lengths", name, si=length, name="best_length", meaning=_BEST),
    ]
    for member in MEMBERS:
        values += tip_values(f"{name}.{member}.optimum_", best, member)
    left = float(getattr(best, metric)[-1])
    values.append(Value(f"{name}.optimum_{metric}", left, "um", None, "remaining at the maximum load"))
    settings = {
        "shape": asked.shape, "metric": metric, "candidates": best.candidates, "starts": best.starts,
        "apart": f"difference between two independent searches {best.least_error * 1e6:.1g} um",
    }  # fmt: skip
    return Outcome(data, tables, tuple(values), settings, figures=_chart_figures(name, data))


@dataclass(frozen=True)
class RobustnessData:
    """How each candidate holds up, by its name."""

    candidates: Mapping[str, Robustness]


@dataclass(frozen=True)
class RobustnessInputs:
    """What the robustness of a pair's reliefs depends on.

    Parameters
    ----------
    part : RobustnessPart
    metric : str
    own_relief : bool
        Whether the relief of the case is a candidate too.
    name : str
        Of the pair.
    """

    part: RobustnessPart
    metric: Metric
    own_relief: bool
    name: str = field(compare=False)


def _robustness_inputs(scene: Scene, name: str) -> RobustnessInputs:
    part = design_part(scene)
    return RobustnessInputs(part.robustness, part.metric, scene.case.effects.relief, name)


def _compute_robustness(inputs: RobustnessInputs, upstream: Upstream, work: Work) -> RobustnessData:
    from fegear.design.held_relief import robustness

    designed: ReliefData = next(found for task, found in upstream.items() if task.stage == "relief")
    asked, design = inputs.part, designed.design
    states = {"designed": design.designed}
    states |= {f"{shape} tip relief": g.applied(design.designed) for shape, g in design.ground.items()}
    if inputs.own_relief:
        own = designed.pair.engagement
        states["relief of the case"] = replace(own, driver_spacing=np.empty(0), driven_spacing=np.empty(0))
    found: dict[str, Robustness] = {}
    for label, state in states.items():
        found[label] = robustness(
            state, design.task.load, asked.load_factors, asked.spacing_errors, asked.relief_errors, inputs.metric
        )
        work.progress(len(found) / len(states))
    return RobustnessData(found)


def _present_robustness(data: RobustnessData, inputs: RobustnessInputs) -> Outcome:
    name, metric, values = inputs.name, inputs.metric, []
    for label, r in data.candidates.items():
        factor, spacing, depth = r.worst_case
        where = f"load factor {factor:g}, pitch deviation {spacing * 1e6:g} um, relief {percent(depth, signed=True)}"
        where = f"maximum of the {r.values.size} combinations: {where}"
        values.append(
            Value(f"{name}.worst_{metric}.{label.replace(' ', '_')}", r.worst, "um", None, f"{label}, {where}")
        )
    labels = np.repeat(list(data.candidates), [r.values.size for r in data.candidates.values()])
    axes = ("load_factors", "spacing_errors", "relief_errors")
    *over, excitation = stacked([columns_on_grid(r, axes, "values") for r in data.candidates.values()])
    table = Table(
        f"robustness_{name}",
        (Column("candidate", labels, "", "relief"), *over, replace(excitation, name=metric)),
        f"Robustness of the reliefs of {name}",
    )
    figure = _robustness_figure(name, data.candidates, metric)
    return Outcome(data, (table,), tuple(values), {"metric": metric}, figures=(figure,))


def _chart_figures(name: str, data: ReliefChartData) -> tuple[Figure, ...]:
    """A_e over amount and length for every load with the best length; none without enough candidates."""
    from fegear.design.charts import meaning_of_unit

    chart = data.chart
    if chart.amounts.size < 2 or chart.lengths.size < 3:
        return ()
    best, error, amounts, views = chart.optimum_lengths(), drawn(chart, "effective_error"), drawn(chart, "amounts"), []
    effective = declared(type(chart), "effective_error")
    for i in sorted(range(len(chart.loads)), key=lambda i: float(chart.loads[i]) != data.pair.nominal):
        load = chart.loads[i]
        inside = (best[:, i] > chart.lengths[0]) & (best[:, i] < chart.lengths[-1])
        length = np.where(inside, best[:, i], np.nan)
        items = (
            HeatMap(chart.lengths, amounts, error[:, :, i], effective.label, effective.unit,
                    limits=(float(error.min()), float(error.max()))),
            Curve(length, amounts, "length with minimum A_{e}", "over map", width=2.2, markers=False),
        )  # fmt: skip
        axes = axis_of(chart, "lengths"), axis_of(chart, "amounts")
        word = " (nominal)" if float(load) == data.pair.nominal else ""
        views.append(View(f"{load:.5g} N{word}", (Panel(*axes, items, (Mark("y", data.delta * 1e6, "Δ"),)),)))
    figure = Figure(
        f"relief_chart_{name}",
        f"Tip relief chart of pair {name}",
        f"Pair {name}: effective error A_e (NASA TM-89901) with equal tip relief on both gears. White: length with "
        f"minimum A_e for each amount. Dotted: {meaning_of_unit(data.pair.pair)} at {data.pair.nominal:.5g} N, "
        f"{data.delta * 1e6:.4g} µm.",
        views=tuple(views),
    )
    return (figure,)


def _robustness_figure(name: str, found: Mapping[str, Robustness], metric: str) -> Figure:
    curves = []
    for label, r in found.items():
        order = np.argsort(r.load_factors)
        for values, width in ((r.values.max(axis=(1, 2)), 1.8), (r.values.min(axis=(1, 2)), 0.8)):
            curves.append(
                Curve(r.load_factors[order], values[order] * 1e6, label, label, width=width, markers=width > 1)
            )
    what = "peak-to-peak" if metric == "peak_to_peak" else "effective"
    return Figure(
        f"robustness_{name}",
        f"Robustness of the reliefs of pair {name}",
        f"Pair {name}: maximum (marked) and minimum (thin) over all combinations of pitch deviation and relief "
        "tolerance.",
        (
            Panel(
                axis_of(next(iter(found.values())), "load_factors"),
                Axis(f"{what} transmission error", "um", zero=True),
                tuple(curves),
            ),
        ),
    )


def _chart_forecast(scene: Scene, name: str) -> Forecast:
    """Candidates of the chart, and the optimiser."""
    chart = scene.case.design.chart if scene.case.design else None
    amounts = len((chart and (chart.amounts or chart.amounts_over_delta)) or ()) or 16
    lengths = len((chart and chart.lengths) or ()) or 26
    loads = len((chart and chart.loads) or ()) or forecasts.loads(scene, name)
    corners = 3.0 if scene.case.effects.corner_contact else 1.0
    return Forecast(
        {"candidates": amounts * lengths, "loads": loads}, corners * (1.2 + 4e-4 * amounts * lengths * loads)
    )


def _robustness_pairs(scene: Scene) -> tuple[str, ...]:
    """Those of the design, unless the case asks for draws inside tolerances alone."""
    return () if scene.case.robustness is not None and scene.case.design is None else design_pairs(scene)


def _robustness_forecast(scene: Scene, _name: str) -> Forecast:
    """Every deviation with every other, for each candidate."""
    part = scene.case.design.robustness if scene.case.design else None
    count = len(part.load_factors) * len(part.spacing_errors) * len(part.relief_errors) if part else 15
    return Forecast({"deviations": count}, 0.005 + 5e-4 * count)


_CITES = citing(
    Citation("lin-townsend-oswald", "charts of tip relief, normalised length and amount, effective error A_e")
)


RELIEF_CHART = relief_stage(
    answers=("transmission error",),
    every_load=True,
    inputs=_chart_inputs,
    compute=_compute_chart,
    present=_present_chart,
    cites=_CITES,
    forecast=_chart_forecast,
)


ROBUSTNESS = relief_stage(
    subjects=_robustness_pairs,
    needs=lambda _scene, name: (Task("relief", name),),
    inputs=_robustness_inputs,
    compute=_compute_robustness,
    present=_present_robustness,
    cites=_CITES,
    forecast=_robustness_forecast,
)
