"""Stages ``relief-chart`` and ``robustness``: many candidate reliefs, and how one holds up off its nominal state."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.case.built.design_range import design_range
from fegear.design.load_range import NEAR
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Map, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Every, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Task, Upstream, Work
from fegear.geometry.relief import CombinedRelief, EndRelief, roll_of_radius
from fegear.results import forecasts
from fegear.results.relief.ground_tips import GroundTip, tip_numbers, tips_of
from fegear.results.relief.relief import design_pairs, design_part, relief_stage

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from fegear.base.arrays import Array
    from fegear.case.design import ChartPart, RobustnessPart
    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.design.charts import Metric, ReliefChart
    from fegear.design.held_relief import Robustness
    from fegear.design.load_range import LoadRange
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.engine.sheet.seen import Seen
    from fegear.results.relief.relief_data import ReliefData


#: How the single best of a chart is found.
_BEST = "equal tip reliefs, maximum over the loads, by A_e"


@dataclass(frozen=True)
class MarkedReliefs:
    """What is marked in a chart, the same at each load: points as amounts [m] and lengths.

    Parameters
    ----------
    best_amount, best_length : ndarray, shape (1,)
        The optimum for all loads.
    near_amounts, near_lengths : ndarray, shape (N,)
        Boundary of those that are equally good.
    present_amounts, present_lengths : ndarray, shape (M,)
        Tip reliefs of the case inside the chart, each gear on its own.
    """

    best_amount: Array
    best_length: Array
    near_amounts: Array
    near_lengths: Array
    present_amounts: Array
    present_lengths: Array


@dataclass(frozen=True)
class ChartAtLoad:
    """A chart under one of its loads.

    Parameters
    ----------
    chart : ReliefChart
        With amounts (A,) and lengths (B,).
    label : str
    effective_error : ndarray, shape (A, B)
        [m].
    best_lengths : ndarray, shape (A,)
        With the least of it for each amount; nan at an end of the chart.
    limits : tuple of float
        Ends of its colours [m].
    marked : MarkedReliefs
    """

    chart: ReliefChart
    label: str
    effective_error: Array
    best_lengths: Array
    limits: tuple[float, float]
    marked: MarkedReliefs


@dataclass(frozen=True)
class ReliefChartData:
    """What the stage hands to pictures.

    Parameters
    ----------
    pair : LoadedPair
    chart : ReliefChart
    best : TipReliefPair
        Found by the optimiser over the chart's loads, each gear on its own.
    finer : ReliefChart
        Around the optimum.
    delta : float
        Unit of the amounts in the picture: transmission error of the unmodified pair at its largest.
    """

    pair: LoadedPair
    chart: ReliefChart
    best: TipReliefPair
    finer: ReliefChart
    delta: float = shown("um", "unit of the amounts")

    @property
    def tips(self) -> tuple[GroundTip, ...]:
        """The best reliefs, a gear each."""
        return tips_of(self.best, self.pair.pair)

    @property
    def drawable(self) -> bool:
        """Whether there are enough candidates for a picture."""
        return self.chart.amounts.size > 1 and self.chart.lengths.size > 2

    @property
    def limits(self) -> tuple[float, float]:
        """Of the effective errors of all loads [m]."""
        return float(self.chart.effective_error.min()), float(self.chart.effective_error.max())

    @property
    def loads(self) -> list[ChartAtLoad]:
        """The chart at each load, the nominal one first; of several loads the worst in proportion last."""
        chart, marked = self.chart, self.marked

        def chart_of(label: str, values: Array, limits: tuple[float, float]) -> ChartAtLoad:
            best = chart.lowest(values[:, :, None])[:, 0]
            inside = (best > chart.lengths[0]) & (best < chart.lengths[-1])
            return ChartAtLoad(chart, label, values, np.where(inside, best, np.nan), limits, marked)

        found = [
            chart_of(
                f"{load:.5g} N{' (nominal)' if load == self.pair.nominal else ''}", chart.effective_error[:, :, i],
                self.limits,
            )
            for i, load in sorted(enumerate(chart.loads.tolist()), key=lambda one: one[1] != self.pair.nominal)
        ]  # fmt: skip
        if chart.loads.size > 1:
            worst = chart.worst()
            found.append(chart_of("all loads, worst in proportion", worst, (float(worst.min()), float(worst.max()))))
        return found

    @cached_property
    def marked(self) -> MarkedReliefs:
        """Optimum, the equally good ones and the present reliefs."""
        chart = self.chart
        amount, length = self.finer.best()
        amounts, shortest, longest = self.finer.near_optimum()
        boundary = (
            np.concatenate([way, way_back[::-1], way[:1]])
            for way, way_back in ((amounts, amounts), (shortest, longest))
        )
        present = np.array([one for one in self._present if _inside(chart, *one)]).reshape(-1, 2).T
        return MarkedReliefs(np.array([amount]), np.array([length]), *boundary, *present)

    @property
    def _present(self) -> Iterator[tuple[float, float]]:
        """Amount and length of each tip relief of the case."""
        pair, engagement = self.pair.pair, self.pair.engagement
        for gear, relief in ((pair.driver, engagement.driver_relief), (pair.driven, engagement.driven_relief)):
            tip = float(roll_of_radius(gear, gear.involute_tip_radius))
            for part in relief.parts if isinstance(relief, CombinedRelief) else (relief,):
                if isinstance(part, EndRelief) and (part.end - part.start) * (tip - part.start) > 0.0:
                    yield part.amount, gear.base_radius * abs(part.end - part.start) / self.chart.unit_length


def _inside(chart: ReliefChart, amount: float, length: float) -> bool:
    return chart.amounts[0] <= amount <= chart.amounts[-1] and chart.lengths[0] <= length <= chart.lengths[-1]


@dataclass(frozen=True)
class ChartInputs:
    """What the chart of a pair depends on."""

    part: ChartPart
    metric: Metric
    over: LoadRange | None
    name: str = field(compare=False)


def _chart_inputs(scene: Scene, name: str) -> ChartInputs:
    part = design_part(scene)
    over = None if part.chart.loads else design_range(scene, name)
    return ChartInputs(part.chart, part.metric, over, name)


def _compute_chart(inputs: ChartInputs, upstream: Upstream, work: Work) -> ReliefChartData:
    from fegear.design.charts import relief_chart, unit_amount
    from fegear.design.load_range import LoadRange
    from fegear.design.tip_relief.grindable import grindable

    pair: LoadedPair
    (pair,) = upstream.values()
    asked, e = inputs.part, pair.engagement.unmodified()
    over = inputs.over or LoadRange(tuple(asked.loads or pair.loads))
    loads = np.array(over.loads)
    delta = unit_amount(e, pair.nominal)
    shares = asked.amounts_over_delta or np.linspace(0.1, 1.6, 16)
    amounts = np.array(asked.amounts) if asked.amounts else delta * np.array(shares)
    lengths = np.array(asked.lengths) if asked.lengths else np.linspace(0.05, 1.3, 26)
    chart = relief_chart(e, np.sort(amounts), np.sort(lengths), loads, asked.shape, over.weights)
    work.progress(0.3)
    finer = relief_chart(e, *chart.finer(), loads, asked.shape, over.weights)
    work.progress(0.5)
    return ReliefChartData(pair, chart, grindable(e, over, asked.shape, inputs.metric), finer, delta)


def unit_in_words(seen: Seen) -> str:
    """What the unit of the amounts of a pair is."""
    from fegear.design.charts import meaning_of_unit

    return meaning_of_unit(seen.data.pair.pair)


_CHART_SHEET = Sheet(
    tables=(
        Rows(
            "relief_chart_{name}", "Excitation of {name} over amount, length and load", (Every("chart"),), of="chart",
            on=("amounts", "lengths", "loads"),
        ),
        Rows(
            "relief_optimum_{name}", "Optimum lengths of tip relief of {name}", (Every("optimum"),), of="chart",
            on=("amounts", "loads"),
        ),
    ),
    values=(
        Number("delta", meaning=unit_in_words),
        Number("unit_length", exact, "chart"),
        Number("amounts", of="chart", si=lambda seen: seen.data.chart.best()[0], name="best_amount", meaning=_BEST),
        Number("lengths", of="chart", si=lambda seen: seen.data.chart.best()[1], name="best_length", meaning=_BEST),
        tip_numbers("tips", "optimum_"),
        Number(
            "{asked.metric}", of="chart", si=lambda seen: getattr(seen.data.best, seen.asked.metric)[-1],
            name="optimum_{asked.metric}", meaning="remaining at the maximum load",
        ),
    ),
    figures=(
        Chart(
            "relief_chart_{name}", "Tip relief chart of pair {name}",
            lambda seen: seen.said(
                "Pair {name}: effective error A_e (NASA TM-89901) with equal tip relief on both gears. White: length "
                "with minimum A_e for each amount; star: optimum for all loads, each in proportion, and dashed: within "
                "10 % of it; diamonds: tip reliefs of the case. Dotted: "
            ) + f"{unit_in_words(seen)} at {seen.data.pair.nominal:.5g} N, {seen.said('{d.delta:.4g}')}.",
            (
                Over(
                    "chart.lengths",
                    (
                        Map(
                            "chart.effective_error", "chart.amounts", si="effective_error",
                            limits="limits",
                        ),
                        Line(
                            "chart.amounts", f"within {percent(NEAR)} of the optimum", "orange",
                            si="marked.near_amounts", x_si="marked.near_lengths",
                            look={"width": 1.8, "dash": "dash", "markers": False},
                        ),
                        Line(
                            "chart.amounts", lambda _: "length with minimum A_{e}", "over map", x_si="best_lengths",
                            look={"width": 2.2, "markers": False},
                        ),
                        Line(
                            "chart.amounts", "optimum for all loads", "orange", si="marked.best_amount",
                            x_si="marked.best_length", kind="points", look={"symbol": "star", "size": 13.0},
                        ),
                        Line(
                            "chart.amounts", "present relief of each gear", "red", si="marked.present_amounts",
                            x_si="marked.present_lengths", kind="points", look={"symbol": "diamond", "size": 9.0},
                            when="marked.present_amounts",
                        ),
                    ),
                    "chart.amounts",
                    marks=lambda seen: (Mark("y", seen.data.delta * 1e6, "Δ"),),
                ),
            ),
            when="drawable", views="loads", view="{one.label}",
        ),
    ),
    settings={
        "shape": lambda seen: seen.asked.part.shape,
        "metric": lambda seen: seen.asked.metric,
        "candidates": "best.candidates",
        "starts": "best.starts",
        "apart": lambda seen: f"difference between two independent searches {seen.data.best.least_error * 1e6:.1g} um",
    },
)  # fmt: skip


@dataclass(frozen=True)
class RobustnessData:
    """How each candidate holds up, by its name."""

    candidates: Mapping[str, Robustness]
    candidate: str = shown("", "relief", default="")


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
    factors = asked.load_factors
    if design.task.over is not None and "load_factors" not in asked.given:
        factors = [load / design.task.load for load in design.task.over.loads]
    states = {"designed": design.designed}
    states |= {f"{shape} tip relief": g.applied(design.designed) for shape, g in design.ground.items()}
    if inputs.own_relief:
        own = designed.pair.engagement
        states["relief of the case"] = replace(own, driver_spacing=np.empty(0), driven_spacing=np.empty(0))
    found: dict[str, Robustness] = {}
    for label, state in states.items():
        found[label] = robustness(
            state, design.task.load, factors, asked.spacing_errors, asked.relief_errors, inputs.metric
        )
        work.progress(len(found) / len(states))
    return RobustnessData(found)


def _worst_combination(seen: Seen) -> str:
    """Which combination is worst, in words."""
    factor, spacing, depth = seen.one.worst_case
    where = f"load factor {factor:g}, pitch deviation {spacing * 1e6:g} um, relief {percent(depth, signed=True)}"
    return f"{seen.key}, maximum of the {seen.one.values.size} combinations: {where}"


def _over_load(extreme: Callable[..., Array], width: float) -> Line:
    """The extreme of all combinations at each load, over the loads in their order."""
    return Line(
        "values", "{key}", si=lambda seen: extreme(seen.one.values, axis=(1, 2))[np.argsort(seen.one.load_factors)],
        x_si=lambda seen: np.sort(seen.one.load_factors), look={"width": width, "markers": width > 1.0},
    )  # fmt: skip


_EXCITATION = {"peak_to_peak": "peak-to-peak", "effective_error": "effective"}
_ROBUSTNESS_SHEET = Sheet(
    tables=(
        Rows(
            "robustness_{name}", "Robustness of the reliefs of {name}",
            (
                Cell("candidate", lambda seen: seen.key, lambda _: RobustnessData),
                Cell("values", name="{asked.metric}"),
            ),
            stacked="candidates", on=("load_factors", "spacing_errors", "relief_errors"),
        ),
    ),
    values=(
        Number(
            "values", si="worst", each="candidates", meaning=_worst_combination,
            name=lambda seen: f"worst_{seen.asked.metric}.{seen.key.replace(' ', '_')}",
        ),
    ),
    figures=(
        Chart(
            "robustness_{name}", "Robustness of the reliefs of pair {name}",
            "Pair {name}: maximum (marked) and minimum (thin) over all combinations of pitch deviation and relief "
            "tolerance.",
            (
                Over(
                    "load_factors",
                    (Bundle(Family("candidates", role="{key}"), (_over_load(np.max, 1.8), _over_load(np.min, 0.8))),),
                    lambda seen: Axis(f"{_EXCITATION[seen.asked.metric]} transmission error", "um", zero=True),
                ),
            ),
            of=lambda seen: next(iter(seen.data.candidates.values())),
        ),
    ),
    settings={"metric": lambda seen: seen.asked.metric},
)  # fmt: skip


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
    present=_CHART_SHEET.present,
    cites=_CITES,
    forecast=_chart_forecast,
)


ROBUSTNESS = relief_stage(
    subjects=_robustness_pairs,
    needs=lambda _scene, name: (Task("relief", name),),
    inputs=_robustness_inputs,
    compute=_compute_robustness,
    present=_ROBUSTNESS_SHEET.present,
    cites=_CITES,
    forecast=_robustness_forecast,
)
