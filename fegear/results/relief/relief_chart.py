"""Stage ``relief-chart``: many candidate reliefs."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.printed import figures, percent
from fegear.base.shown import shown
from fegear.case.built.design_range import design_range
from fegear.case.built.relief_limits import relief_limits
from fegear.case.built.tip_tolerances import tip_tolerances
from fegear.design.load_range import NEAR
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Map, Over
from fegear.engine.sheet.load_words import load_words
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Every, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Upstream, Work
from fegear.geometry.pair import MEMBER_WORDS
from fegear.geometry.relief import CombinedRelief, EndRelief, roll_of_radius
from fegear.results import forecasts
from fegear.results.relief.answer_numbers import microns, torque_words
from fegear.results.relief.grinding import NOTHING
from fegear.results.relief.ground_tips import GroundTip, tip_numbers, tips_of
from fegear.results.relief.relief import design_part, relief_stage

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from fegear.base.arrays import Array
    from fegear.case.design import ChartPart
    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.design.charts import Metric, ReliefChart
    from fegear.design.flanks.families import FamilyBest
    from fegear.design.load_range import LoadRange
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.design.tip_relief.relief_limits import ReliefLimits
    from fegear.design.tip_relief.tip_tolerance import TipTolerance
    from fegear.engine.sheet.seen import Seen
    from fegear.geometry.relief import Relief
    from fegear.results.relief.relief_over_face_data import Tip


#: How the single best of a chart is found.
_BEST = "equal tip reliefs, maximum over the loads, by A_e"


@dataclass(frozen=True)
class MarkedReliefs:
    """What is marked in a chart, the same at each load: points as amounts [m] and lengths.

    Parameters
    ----------
    best_amount, best_length : ndarray, shape (1,)
        The optimum for all loads, by A_e.
    near_amounts, near_lengths : ndarray, shape (N,)
        Boundary of those that are equally good, nan between its parts.
    present_amounts, present_lengths : ndarray, shape (M,)
        Tip reliefs of the case inside the chart, each gear on its own.
    peak_amount, peak_length : ndarray, shape (1,)
        The optimum of the chart's own points for all loads by the peak-to-peak value.
    """

    best_amount: Array
    best_length: Array
    near_amounts: Array
    near_lengths: Array
    present_amounts: Array
    present_lengths: Array
    peak_amount: Array
    peak_length: Array


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
    pair : LoadedPair or LoadedWidePair
    chart : ReliefChart
    best : TipReliefPair or FamilyBest
        Found by the optimiser over the chart's loads, each gear on its own.
    finer : ReliefChart
        Around the optimum.
    delta : float
        Unit of the amounts in the picture: transmission error of the unmodified pair at its largest.
    """

    pair: LoadedPair | LoadedWidePair
    chart: ReliefChart
    best: TipReliefPair | FamilyBest
    finer: ReliefChart
    delta: float = shown("um", "unit of the amounts")

    @property
    def tips(self) -> tuple[GroundTip | Tip, ...]:
        """The best reliefs, a gear each."""
        return tips_of(cast("TipReliefPair", self.best), self.pair.pair)

    def left(self, metric: Metric) -> float:
        """What the best reliefs leave at the largest load [m]."""
        return float(getattr(self.best, metric)[-1])

    @property
    def unit_words(self) -> str:
        """What the unit of the amounts is."""
        from fegear.design.charts import meaning_of_unit

        return meaning_of_unit(self.pair.pair)

    @property
    def searched(self) -> Mapping[str, object]:
        """How the best reliefs were searched for."""
        best = cast("TipReliefPair", self.best)
        apart = f"difference between two independent searches {best.least_error * 1e6:.1g} um"
        return {"candidates": best.candidates, "starts": best.starts, "apart": apart}

    @property
    def reliefs(self) -> tuple[Relief, Relief]:
        """Of driver and driven gear in the case."""
        engagement = cast("LoadedPair", self.pair).engagement
        return engagement.driver_relief, engagement.driven_relief

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
                load_words(load) + (" (nominal)" if load == self.pair.nominal else ""),
                chart.effective_error[:, :, i], self.limits,
            )
            for i, load in sorted(enumerate(chart.loads.tolist()), key=lambda one: one[1] != self.pair.nominal)
        ]  # fmt: skip
        if chart.loads.size > 1:
            worst = chart.worst()
            found.append(
                chart_of("all loads, maximum relative to load", worst, (float(worst.min()), float(worst.max())))
            )
        return found

    @cached_property
    def marked(self) -> MarkedReliefs:
        """Optimum, the equally good ones and the present reliefs."""
        chart = self.chart
        amount, length = self.finer.best()
        boundary = self.finer.boundary()
        present = np.array([one for one in self._present if _inside(chart, *one)]).reshape(-1, 2).T
        peak = (np.array([one]) for one in chart.best("peak_to_peak"))
        return MarkedReliefs(np.array([amount]), np.array([length]), *boundary, *present, *peak)

    @property
    def _present(self) -> Iterator[tuple[float, float]]:
        """Amount and length of each tip relief of the case."""
        pair = self.pair.pair
        for gear, relief in zip((pair.driver, pair.driven), self.reliefs, strict=True):
            tip = float(roll_of_radius(gear, gear.involute_tip_radius))
            for part in relief.parts if isinstance(relief, CombinedRelief) else (relief,):
                if isinstance(part, EndRelief) and (part.end - part.start) * (tip - part.start) > 0.0:
                    yield part.amount, gear.base_radius * abs(part.end - part.start) / self.chart.unit_length


def _inside(chart: ReliefChart, amount: float, length: float) -> bool:
    return chart.amounts[0] <= amount <= chart.amounts[-1] and chart.lengths[0] <= length <= chart.lengths[-1]


@dataclass(frozen=True)
class ChartInputs:
    """What the chart of a pair depends on.

    Parameters
    ----------
    part : ChartPart
    metric : {"peak_to_peak", "effective_error"}
    over : LoadRange or None
        Loads of the chart where it has none of its own.
    limits : ReliefLimits or None
        Of the optimum of each gear on its own.
    tolerances : tuple of TipTolerance or None
        Within which its maximum is least; None where it is least as drawn.
    name : str
        Of the pair.
    said_by_relief : bool
        Whether ``relief`` designs for the same loads and shape: what to grind on each gear is its answer.
    """

    part: ChartPart
    metric: Metric
    over: LoadRange | None
    limits: ReliefLimits | None
    tolerances: tuple[TipTolerance, TipTolerance] | None
    name: str = field(compare=False)
    said_by_relief: bool = field(default=False, compare=False)


def chart_inputs(scene: Scene, name: str) -> ChartInputs:
    """Collect what a case says of the chart of a pair."""
    part = design_part(scene)
    over = None if part.chart.loads else design_range(scene, name)
    said = over is not None and part.chart.shape in part.grind
    limits = relief_limits(part, scene.pairs[name]) if name in scene.plane_pairs else None
    tolerances = tip_tolerances(scene, name) if part.metric == "peak_to_peak_max" else None
    return ChartInputs(part.chart, part.measure, over, limits, tolerances, name, said)


def _compute_chart(inputs: ChartInputs, upstream: Upstream, work: Work) -> ReliefChartData:
    from fegear.design.charts import relief_chart, unit_amount
    from fegear.design.load_range import LoadRange
    from fegear.design.tip_relief.grindable import grindable, tolerated

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
    if inputs.tolerances is None:
        best = grindable(e, over, asked.shape, inputs.metric, limits=inputs.limits, cache=work.cache)
    else:
        best = tolerated(e, over, asked.shape, inputs.tolerances, limits=inputs.limits, cache=work.cache)
    return ReliefChartData(pair, chart, best, finer, delta)


def unit_in_words(seen: Seen) -> str:
    """What the unit of the amounts of a pair is."""
    from fegear.design.charts import meaning_of_unit

    return meaning_of_unit(seen.data.pair.pair)


def at_edges(chart: ReliefChart, metric: Metric = "effective_error") -> str:
    """That the best of a chart lies at an edge of it, beyond which less may be left, and what to do; empty inside."""
    axes = {"amounts": chart.amounts, "lengths": chart.lengths}
    edges = [
        f"{'maximum' if at else 'minimum'} {name.removesuffix('s')}"
        for at, (name, axis) in zip(chart.best_point(metric), axes.items(), strict=True)
        if axis.size > 1 and at in (0, axis.size - 1)
    ]
    keys = [f"design.chart.{name}" for name in axes if any(name.startswith(edge.split()[1]) for edge in edges)]
    return f"is at the edge of the chart ({', '.join(edges)}): extend {' and '.join(keys)}" if edges else ""


def _best_meaning(seen: Seen) -> str:
    """How the single best of a chart is found, and whether it is at the edge."""
    edges = at_edges(seen.data.chart)
    return f"{_BEST}; {edges}" if edges else _BEST


def _optimum_in_words(seen: Seen) -> Iterator[str]:
    """The optimum of each gear on its own for all loads, and the best equal reliefs of the chart."""
    chart, ground = seen.data.chart, [tip for tip in seen.data.tips if tip.relief.amount > NOTHING]
    if not ground:
        yield f"Pair {seen.name}: no tip relief reduces the excitation."
        return
    if not seen.asked.said_by_relief:
        amounts = " and ".join(f"{microns(tip.relief.amount)} µm on the {MEMBER_WORDS[tip.member]}" for tip in ground)
        yield (
            f"Pair {seen.name}: optimum of {seen.asked.part.shape} tip relief for all loads: {amounts} "
            f"({microns(seen.data.left(seen.asked.metric))} µm remain at the maximum load)."
        )
    if seen.asked.said_by_relief:  # its answer states better ones, one for each gear
        edges = at_edges(chart)
        if edges:
            yield f"Pair {seen.name}: equal tip relief with minimum A_e {edges}."
        return
    i, j = chart.best_point("peak_to_peak")  # what the sentence states, and the design minimises
    length = figures(chart.lengths[j] * chart.unit_length * 1e3, 2)
    torque = chart.loads * seen.data.pair.pair.driver.base_radius
    left = ", ".join(
        f"{microns(chart.peak_to_peak[i, j, k])} µm at {torque_words(torque[k])}"
        for k in dict.fromkeys((int(chart.loads.argmax()), int(chart.loads.argmin())))
    )
    edges = at_edges(chart, "peak_to_peak")
    edge = f"; it {edges}" if edges else ""
    yield (
        f"Pair {seen.name}: for comparison, equal {seen.asked.part.shape} tip relief on both gears, "
        f"{microns(chart.amounts[i])} µm over {length} mm, gives {left}, peak to peak{edge}."
    )


CHART_SHEET = Sheet(
    answer=Answer(_optimum_in_words, figure="relief_chart_{name}"),
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
        Number("delta", meaning="{d.unit_words}"),
        Number("unit_length", exact, "chart"),
        Number("amounts", of="chart", si=lambda seen: seen.data.chart.best()[0], name="best_amount",
               meaning=_best_meaning),
        Number("lengths", of="chart", si=lambda seen: seen.data.chart.best()[1], name="best_length",
               meaning=_best_meaning),
        tip_numbers("tips", "optimum_"),
        Number(
            "{asked.metric}", of="chart", si=lambda seen: seen.data.left(seen.asked.metric),
            name="optimum_{asked.metric}", meaning="remaining at the maximum load",
        ),
    ),
    figures=(
        Chart(
            "relief_chart_{name}", "Tip relief chart of pair {name}",
            lambda seen: seen.said(
                "Pair {name}: effective error A_e (NASA TM-89901) with equal tip relief on both gears. White with grey "
                "edges: length with minimum A_e for each amount; star: optimum for all loads (relative to load) by "
                "A_e, square: by the peak-to-peak value, as designs are; dashed: within 10 % of A_e; diamonds: tip "
                "reliefs of the case. Dotted: "
            ) + f"{seen.data.unit_words} at {load_words(seen.data.pair.nominal)}, {seen.said('{d.delta:.4g}')}.",
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
                        Line(  # its sample in the legend is seen on white, too
                            "chart.amounts", lambda _: "length with minimum A_{e}", "grey", x_si="best_lengths",
                            look={"width": 4.6, "markers": False},
                        ),
                        Line(
                            "chart.amounts", "", "over map", x_si="best_lengths",
                            look={"width": 2.2, "markers": False},
                        ),
                        Line(
                            "chart.amounts", lambda _: "optimum for all loads by A_{e}", "orange",
                            si="marked.best_amount", x_si="marked.best_length", kind="points",
                            look={"symbol": "star", "size": 13.0},
                        ),
                        Line(
                            "chart.amounts", "by peak to peak", "sky", si="marked.peak_amount",
                            x_si="marked.peak_length", kind="points", look={"symbol": "square", "size": 8.0},
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
    settings=lambda seen: {"shape": seen.asked.part.shape, "metric": seen.asked.metric, **seen.data.searched},
)  # fmt: skip


def _chart_forecast(scene: Scene, name: str) -> Forecast:
    """Candidates of the chart, and the optimiser."""
    chart = scene.case.design.chart if scene.case.design else None
    amounts = len((chart and (chart.amounts or chart.amounts_over_delta)) or ()) or 16
    lengths = len((chart and chart.lengths) or ()) or 26
    loads = len((chart and chart.loads) or ()) or forecasts.loads(scene, name)
    corners = 2.0 if scene.case.effects.corner_contact else 1.0
    return Forecast(
        {"candidates": amounts * lengths, "loads": loads}, corners * (1.2 + 4e-4 * amounts * lengths * loads)
    )


CITES = citing(
    Citation("lin-townsend-oswald", "charts of tip relief, normalised length and amount, effective error A_e")
)


RELIEF_CHART = relief_stage(
    answers=("transmission error",),
    every_load=True,
    inputs=chart_inputs,
    compute=_compute_chart,
    present=CHART_SHEET.present,
    cites=CITES,
    forecast=_chart_forecast,
)
