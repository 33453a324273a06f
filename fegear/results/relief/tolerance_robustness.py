"""Stage ``tolerance-robustness``: a pair whose gears and housing deviate inside the tolerances of the drawing.

What is drawn of a pair, how it is set up and what that takes stands in `fegear.results.relief.tolerance_benches`.

Figures of deviations drawn inside tolerances: distributions, which deviation matters, reliefs side by side.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from fegear.base.errors import FegearError, InputError
from fegear.base.units import from_si
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, View
from fegear.engine.figure.items import Bars, Curve, Mark, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Upstream, Work
from fegear.results.forecasts import HERTZ
from fegear.results.pair.loaded_teeth import teeth_stage
from fegear.results.relief.tolerance_benches import (
    DrawInputs,
    check_draws,
    draw_inputs,
    forecast_draws,
    needs_of_draws,
    pairs_to_draw,
    set_up,
)
from fegear.results.relief.tolerance_tables import (
    NOMINAL,
    OWN,
    ROBUST,
    SHOWN,
    ToleranceData,
    influence_table,
    leading_told,
    nominal,
    outcome,
    percentiles,
    search_told,
    told,
    tolerance_remarks,
    tolerance_tables,
    tolerance_values,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.base.arrays import Array
    from fegear.design.robustness.deviated_pair import Bench, DrawBench
    from fegear.design.robustness.tolerance_draws import Deviations
    from fegear.design.tip_relief.robust import RobustRelief
    from fegear.geometry.relief import Relief

#: Beside the seed of the case, that of the draws over which reliefs are searched for.
_SEARCHED = 1
#: Chunks that are done here sooner than other processes start.
_FEW = 4


@dataclass(frozen=True)
class Chunk:
    """Some draws of a pair: all that a process needs.

    Parameters
    ----------
    inputs : DrawInputs
    relief : tuple of float
        Numbers of a relief that is not the case's own.
    bench : DrawBench
    deviations : Deviations
    """

    inputs: DrawInputs
    relief: tuple[float, ...]
    bench: DrawBench
    deviations: Deviations


def compute_chunk(chunk: Chunk) -> dict[str, object]:
    """Outcomes of some draws, as plain data."""
    from fegear.base.one_thread import one_thread
    from fegear.design.robustness.deviated_pair import drawn_outcomes

    with one_thread():
        found = drawn_outcomes(chunk.bench, chunk.deviations)
    return {"values": found.values, "reasons": found.reasons}


def chunk_content(chunk: Chunk) -> object:
    """All that the numbers of a chunk depend on: its own draws, not how many there are besides."""
    asked = chunk.inputs
    return asked.teeth, asked.source, asked.solved, asked.moved, chunk.relief, chunk.deviations


def _compute(asked: DrawInputs, upstream: Upstream, work: Work) -> ToleranceData:
    from fegear.base.one_thread import one_thread
    from fegear.design.robustness.deviated_pair import drawn_outcomes
    from fegear.design.robustness.tolerance_draws import NO_LIMITS, draw

    part, size = asked.part, asked.chunk
    own = set_up(asked, upstream)
    deviations = draw(asked.limits, part.draws, part.seed, own.teeth, part.sequence, part.distribution)
    benches: dict[str, tuple[tuple[float, ...], DrawBench]] = {OWN: ((), own)}
    relief: RobustRelief | None = None
    numbers: tuple[float, ...] = ()
    with one_thread():
        exact = own.exact
        if part.reliefs is not None:
            numbers, relief, found = _reliefs(asked, cast("Bench", own))
            benches |= found
        none = draw(NO_LIMITS, 1, 0, own.teeth)
        nominal = {state: drawn_outcomes(one, none).values[0] for state, (_, one) in benches.items()}
    starts = range(0, part.draws, size)
    chunks = [
        Chunk(asked, key, one, deviations.rows(slice(first, first + size)))
        for key, one in benches.values()
        for first in starts
    ]
    done = _drawn(chunks, asked.name, work)
    values: dict[str, Array] = {}
    reasons: dict[int, str] = {}
    for number, state in enumerate(benches):
        values[state], failed = _together(done[number * len(starts) : (number + 1) * len(starts)], size)
        reasons |= failed
    return ToleranceData(own.names, deviations, values, nominal, reasons, exact, relief, numbers)


def _drawn(chunks: Sequence[Chunk], name: str, work: Work) -> list[dict[str, Any]]:
    """Outcomes of every chunk of draws of a pair, on all cores where there are many."""
    from fegear.engine.executor import map_points
    from fegear.engine.processes import Failure

    executor = work.executor
    if executor.scheduler is None and len(chunks) <= _FEW:
        executor = replace(executor, here=True)
    done = map_points(compute_chunk, chunks, executor, work.cache, key=chunk_content, progress=work.progress)
    for one in done:
        if isinstance(one, Failure):
            raise FegearError(f"Samples of pair {name} failed: {one.reason}")
    return list(done)


def _together(done: Sequence[Mapping[str, Any]], size: int) -> tuple[Array, dict[int, str]]:
    """Outcomes of all draws of a state, and why some have none, from those of its chunks in their order."""
    reasons: dict[int, str] = {}
    for number, chunk in enumerate(done):
        reasons |= {number * size + row: reason for row, reason in chunk["reasons"].items()}
    return np.concatenate([chunk["values"] for chunk in done]), reasons


def _reliefs(
    asked: DrawInputs, own: Bench
) -> tuple[tuple[float, ...], RobustRelief, dict[str, tuple[tuple[float, ...], Bench]]]:
    """The nominal and the robust optimum, and the pair with each of them."""
    from fegear.design.robustness.tolerance_draws import draw
    from fegear.design.tip_relief.grindable import grindable
    from fegear.design.tip_relief.robust import robust_tip_relief

    wish = asked.part.reliefs
    if wish is None:
        raise InputError("robustness.reliefs", "(not given)", "is required to compare reliefs")
    pair = own.engagement.pair
    best = grindable(own.engagement.unmodified(), own.load, wish.shape)
    numbers: list[float] = []
    for gear, tip in ((pair.driver, best.driver), (pair.driven, best.driven)):
        numbers += [tip.amount, (tip.end - tip.start) * gear.base_radius / pair.path_length]
    nominal = (numbers[0], numbers[1], numbers[2], numbers[3])
    # Draws of their own: a percentile over draws that a search has seen is the search's, and not that of any pair.
    part = asked.part
    searched = draw(asked.limits, wish.draws, (part.seed, _SEARCHED), own.teeth, part.sequence, part.distribution)
    relief = robust_tip_relief(
        own, searched, nominal, amounts=wish.amounts, lengths=wish.lengths,
        power=1.0 if wish.shape == "linear" else 2.0, percent=wish.percentile,
    )  # fmt: skip

    def with_tips(driver: Relief, driven: Relief) -> Bench:
        return replace(own, engagement=replace(own.engagement, driver_relief=driver, driven_relief=driven))

    shape = 1.0 if wish.shape == "linear" else 2.0
    return nominal, relief, {
        NOMINAL: ((*nominal, shape), with_tips(best.driver, best.driven)),
        ROBUST: ((*relief.numbers, shape), with_tips(relief.driver, relief.driven)),
    }  # fmt: skip


def _present(data: ToleranceData, asked: DrawInputs) -> Outcome:
    """Tables, values, remarks and figures of the draws of a pair."""
    part, limits = asked.part, asked.limits
    settings: dict[str, object] = {
        "draws": part.draws, "seed": part.seed, "sequence": part.sequence, "distribution": part.distribution,
        "centre_distance_tolerance": limits.centre_distance, "profile_slope_tolerance": list(limits.profile_slope),
        "profile_form_tolerance": list(limits.profile_form), "helix_slope_tolerance": list(limits.helix_slope),
        "base_pitch_tolerance": list(limits.pitch),
    }  # fmt: skip
    return Outcome(
        data, tolerance_tables(data, asked), tolerance_values(data, asked), settings, tolerance_remarks(data, asked),
        tolerance_figures(data, asked),
    )  # fmt: skip


#: Deviations that the picture of influences has, and classes of a histogram.
_MOST, _LEAST_CLASSES, _MOST_CLASSES = 12, 8, 60


_ROLES = {OWN: "relief of the case", NOMINAL: "designed", ROBUST: "linear tip relief"}


def tolerance_figures(data: ToleranceData, asked: DrawInputs) -> tuple[Figure, ...]:
    """Of one pair; none where no draw has a result."""
    if not np.isfinite(outcome(data, "te_peak_to_peak")).any():
        return ()
    figures = [_distributions(data, asked), _drawn_influences(data, asked)]
    if data.relief is not None:
        figures.append(_drawn_reliefs(data, asked))
    return tuple(figures)


def _histogram(values: Array) -> tuple[Array, Array]:
    """Middles and shares [%] of classes as wide as Freedman and Diaconis ask for."""
    low, high = float(values.min()), float(values.max())
    if high - low <= 1e-9 * abs(high):
        low, high = low - 5e-4 * abs(low), high + 5e-4 * abs(high)
    quartiles = np.quantile(values, [0.25, 0.75])
    width = 2.0 * float(quartiles[1] - quartiles[0]) / np.cbrt(values.size)
    classes = int(np.clip(np.ceil((high - low) / width) if width > 0.0 else 1, _LEAST_CLASSES, _MOST_CLASSES))
    counts, edges = np.histogram(values, classes, (low, high))
    return 0.5 * (edges[1:] + edges[:-1]), 100.0 * counts / values.size


def _distributions(data: ToleranceData, asked: DrawInputs) -> Figure:
    views = []
    for name in (key for key in told(data) if key != "te_harmonic_1"):
        one, factor = SHOWN[name], from_si(SHOWN[name].unit) if SHOWN[name].unit else 1.0
        values = outcome(data, name)
        values = np.sort(values[np.isfinite(values)]) * factor
        axis, mark = Axis(one.label, one.unit), Mark("x", nominal(data, name) * factor, "nominal")
        below = 100.0 * (np.arange(values.size) + 0.5) / values.size
        levels = tuple(Mark("y", p.percent, f"{p.value * factor:.4g}") for p in percentiles(data, name))
        views.append(
            View(one.label, (
                Panel(axis, Axis("samples per class", "%", zero=True),
                      (Bars(*_histogram(values), "", "blue"),), (mark,), title=one.label),
                Panel(axis, Axis("fraction of samples below", "%", limits=(0.0, 100.0)),
                      (Curve(values, below, "", "blue", markers=False),), (mark, *levels)),
            ))
        )  # fmt: skip
    return Figure(
        f"robustness_distributions_{asked.name}",
        f"Pair {asked.name} within its tolerances",
        f"Pair {asked.name}, {asked.part.draws} draws: histogram and cumulative distribution of the results. Dotted: "
        "the pair of the drawing (nominal), and percentiles 5, 50 and 95 with their values.",
        views=tuple(views),
        under=f"{asked.load:.5g} N",
    )


def _drawn_influences(data: ToleranceData, asked: DrawInputs) -> Figure:
    rows = influence_table(data, asked.gears)
    views = []
    for name in told(data):
        ranked = sorted(rows, key=lambda row: np.nan_to_num(row[1][name].share))[-_MOST:]
        names = tuple(column.name.replace("_", " ") for column, _ in ranked)
        places = np.arange(len(ranked), dtype=float)
        share = np.array([100.0 * np.nan_to_num(found[name].share) for _, found in ranked])
        rank = np.array([found[name].rank_correlation for _, found in ranked])
        across = Axis("", categories=names)
        views.append(
            View(SHOWN[name].label, (
                Panel(Axis("share of the variance (single deviation)", "%", zero=True), across,
                      (Points(share, places, "", "blue", size=8.0),), title=SHOWN[name].label),
                Panel(Axis("rank correlation", limits=(-1.0, 1.0)), across,
                      (Points(rank, places, "", "orange", "diamond", size=8.0),), (Mark("x", 0.0),)),
            ))
        )  # fmt: skip
    return Figure(
        f"robustness_influences_{asked.name}",
        f"Influence of the deviations of pair {asked.name}",
        f"Pair {asked.name}: first-order (Sobol) share of the variance and rank correlation; the remainder to 100 % "
        f"is due to interactions.{leading_told(data, asked.gears)}",
        views=tuple(views),
        most_views=2,
    )


def _drawn_reliefs(data: ToleranceData, asked: DrawInputs) -> Figure:
    name, factor = "te_peak_to_peak", 1e6
    curves, marks = [], []
    percent = asked.part.reliefs.percentile if asked.part.reliefs else 95.0
    for state in data.values:
        values = outcome(data, name, state)
        values = np.sort(values[np.isfinite(values)]) * factor
        below = 100.0 * (np.arange(values.size) + 0.5) / values.size
        curves.append(Curve(values, below, f"tip relief {state}", _ROLES[state], markers=False))
    marks.append(Mark("y", percent, f"percentile {percent:g}"))
    return Figure(
        f"robustness_reliefs_{asked.name}",
        f"Tip reliefs of pair {asked.name} over the samples",
        f"Pair {asked.name}: fraction of samples with a lower peak-to-peak transmission error, for the relief of the "
        f"case, the nominal optimum and the optimum at percentile {percent:g}.{search_told(data, asked)}",
        (
            Panel(
                Axis("peak-to-peak transmission error", "um", zero=True), Axis(
                    "fraction of samples below", "%", limits=(0.0, 100.0)),
                tuple(curves), tuple(marks),
            ),
        ),
        under=f"{asked.load:.5g} N",
    )  # fmt: skip


TOLERANCE_ROBUSTNESS = teeth_stage(
    subjects=pairs_to_draw,
    needs=needs_of_draws,
    inputs=draw_inputs,
    compute=_compute,
    present=_present,
    check=check_draws,
    cites=citing(
        Citation("iso-1328-1", "tolerances of the sampled deviations", "5.3, formulas (5) to (12)"),
        Citation("mark", "load sharing of the tooth pairs", "Appendix A"), HERTZ,
    ),
    forecast=forecast_draws,
    in_points=True,
)  # fmt: skip
