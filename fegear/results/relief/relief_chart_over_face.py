"""Results ``relief-chart`` and ``robustness`` of teeth with a width."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.case.built.pair_spec import pair_spec
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.results import forecasts
from fegear.results.pair.loaded_flanks import loaded_flanks
from fegear.results.relief.relief_chart import CHART_SHEET, CITES, ChartInputs, ReliefChartData, chart_inputs
from fegear.results.relief.relief_over_face import (
    check_over_face,
    needs_over_face,
    over_face_forecast,
    pairs_over_face,
    relief_data,
)
from fegear.results.relief.relief_over_face_data import Tip
from fegear.results.relief.relief_robustness import (
    NO_RELIEF,
    ROBUSTNESS_SHEET,
    RobustnessData,
    RobustnessInputs,
    load_factors,
    recommended,
    robustness_inputs,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.design.charts import Metric
    from fegear.design.flanks.families import FamilyBest
    from fegear.design.flanks.trials import FlankTrials
    from fegear.geometry.relief import Relief

#: Seconds of a relief of a chart under one load, and of a combination of deviations under one.
_QUICK, _COMBINED = 1e-3, 8e-3


@dataclass(frozen=True)
class ChartOverFace(ReliefChartData):
    """A chart of teeth with a width.

    Parameters
    ----------
    optimum : float
        Peak to peak of the best reliefs at the largest load [m].
    off : float
        By how much peak-to-peak values of the chart are off, over the largest.
    present : tuple of Relief
        Of driver and driven gear in the case.
    """

    optimum: float = 0.0
    off: float = 0.0
    present: tuple[Relief, ...] = ()

    @property
    def tips(self) -> tuple[Tip, ...]:
        """The best reliefs, a gear each."""
        from fegear.design.flanks.flank_tolerance import end_reliefs

        relief = cast("FamilyBest", self.best).relief
        both = end_reliefs(relief.numbers, self.pair.pair, relief.tip_power)
        return tuple(Tip(of, "", tip, self.pair.pair.gear(of)) for of, tip in zip(MEMBERS, both, strict=True))

    def left(self, metric: Metric) -> float:  # noqa: ARG002  (peak to peak only)
        """What the best reliefs leave at the largest load [m]."""
        return self.optimum

    @property
    def unit_words(self) -> str:
        """What the unit of the amounts is."""
        return "maximum transmission error without relief"

    @property
    def searched(self) -> Mapping[str, object]:
        """How the best reliefs were searched for, and how far values of the chart are off."""
        best = cast("FamilyBest", self.best)
        return {"candidates": best.candidates, "loaded_exactly": best.exact, "screening_error": self.off}

    @property
    def reliefs(self) -> tuple[Relief, Relief]:
        """Of driver and driven gear in the case."""
        driver, driven = self.present
        return driver, driven


def _compute_chart(inputs: ChartInputs, upstream: Upstream, work: Work) -> ChartOverFace:
    from fegear.design.flanks.tip_bench import tip_trials, without_tips
    from fegear.design.flanks.tip_chart import chart_error, quick_at_loads, tip_chart
    from fegear.design.flanks.tip_design import POWERS
    from fegear.design.flanks.tip_search import best_tips
    from fegear.design.load_range import LoadRange

    found, asked = loaded_flanks(upstream, inputs.name), inputs.part
    over = inputs.over or LoadRange(tuple(sorted(asked.loads or found.loads)))
    apart = without_tips(found.gaps)
    trials = tip_trials(found.flanks, found.known, apart, found.nominal).over(over, POWERS[asked.shape], apart)
    work.progress(0.2)
    more = trials.more
    quick = quick_at_loads(more)
    here = tip_trials_at(more, found.nominal, apart)
    delta = float(here.of_gap(np.zeros(more.known.lines.x.shape)).te.max())
    shares = asked.amounts_over_delta or np.linspace(0.1, 1.6, 16)
    amounts = np.sort(asked.amounts or delta * np.array(shares))
    lengths = np.sort(asked.lengths or np.linspace(0.05, 1.3, 26))
    chart = tip_chart(more, quick, trials.points, amounts, lengths)
    work.progress(0.5)
    finer = tip_chart(more, quick, trials.points, *chart.finer())
    work.progress(0.7)
    best = best_tips(trials)
    left = float(more.of_numbers(best.relief.numbers).peak_to_peak[0, -1])
    present = (found.gaps.driver_relief, found.gaps.driven_relief)
    return ChartOverFace(found, chart, best, finer, delta, left, chart_error(chart, more), present)


def tip_trials_at(trials: FlankTrials, load: float, apart: FlankGaps) -> FlankTrials:
    """The same under one load [N]."""
    one = np.array([load])
    return replace(trials, apart=apart.at(trials.pair, trials.known.lines, one), loads=one, weights=None)


def _chart_forecast(scene: Scene, name: str) -> Forecast:
    chart = scene.case.design.chart if scene.case.design else None
    amounts = len((chart and (chart.amounts or chart.amounts_over_delta)) or ()) or 16
    lengths = len((chart and chart.lengths) or ()) or 26
    loads = len((chart and chart.loads) or ()) or forecasts.loads(scene, name)
    base = over_face_forecast(scene, name, 1.0, loads).seconds or 0.0
    panels = pair_spec(scene, name, over_face=True).panel_count
    seconds = base + _QUICK * (amounts * lengths + 2500) * loads * (panels / 12.0)
    return Forecast({"candidates": amounts * lengths, "loads": loads}, seconds)


def _compute_robustness(inputs: RobustnessInputs, upstream: Upstream, work: Work) -> RobustnessData:
    from fegear.design.flanks.tip_bench import tip_trials, without_tips
    from fegear.design.flanks.tip_chart import tip_robustness

    found, designed, asked = loaded_flanks(upstream, inputs.name), relief_data(upstream), inputs.part
    task, apart = designed.design.task, without_tips(found.gaps)
    factors = load_factors(asked, task.over, task.load)
    loads = task.load * np.array([*factors, 1.0])
    more = tip_trials(found.flanks, found.known, apart, task.load).more
    lines = more.known.lines
    more = replace(more, apart=apart.at(more.pair, lines, loads), loads=loads)
    removals = {
        f"{shape} tip relief": replace(more, tip_power=best.relief.tip_power).gap(best.relief.numbers)
        for shape, best in designed.design.found.items()
    }
    if inputs.own_relief:
        own = sum(
            relief.removal(lines.roll_angle(more.pair, member))
            for member, relief in zip(MEMBERS, (found.gaps.driver_relief, found.gaps.driven_relief), strict=True)
        )
        removals["relief of the case"] = np.where(lines.present, own, 0.0)
    removals[NO_RELIEF] = np.zeros(lines.present.shape)
    candidates = {}
    for number, (label, removal) in enumerate(removals.items()):
        candidates[label] = tip_robustness(more, removal, factors, asked.spacing_errors, asked.relief_errors)
        work.progress((number + 1) / len(removals))
    shapes = [f"{shape} tip relief" for shape in designed.design.shapes]
    return RobustnessData(candidates, recommended(shapes, candidates), task.load * inputs.base_radius)


def _robustness_pairs(scene: Scene) -> tuple[str, ...]:
    """Those of the design, unless the case asks for draws inside tolerances only."""
    return () if scene.case.robustness is not None and scene.case.design is None else pairs_over_face(scene)


def _robustness_forecast(scene: Scene, name: str) -> Forecast:
    part = scene.case.design.robustness if scene.case.design else None
    count = len(part.load_factors) * len(part.spacing_errors) * len(part.relief_errors) if part else 15
    base = over_face_forecast(scene, name, 0.0, 1).seconds or 0.0
    return Forecast({"deviations": count}, 0.3 * base + 3.0 * _COMBINED * count)


RELIEF_CHART_OVER_FACE = Stage(
    subjects=pairs_over_face,
    inputs=chart_inputs,
    compute=_compute_chart,
    present=CHART_SHEET.present,
    needs=needs_over_face,
    check=check_over_face,
    every_load=True,
    cites=CITES,
    forecast=_chart_forecast,
)


ROBUSTNESS_OVER_FACE = Stage(
    subjects=_robustness_pairs,
    inputs=robustness_inputs,
    compute=_compute_robustness,
    present=ROBUSTNESS_SHEET.present,
    needs=lambda scene, name: (Task("relief-over-face", name), *needs_over_face(scene, name)),
    check=check_over_face,
    cites=CITES,
    forecast=_robustness_forecast,
)
