"""Figures of deviations drawn inside tolerances: distributions, which deviation matters, reliefs side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Bars, Curve, Figure, Mark, Panel, Points, View
from fegear.results.tolerance_remarks import leading_told, search_told
from fegear.results.tolerance_tables import (
    NOMINAL,
    OWN,
    ROBUST,
    SHOWN,
    influence_table,
    nominal,
    outcome,
    percentiles,
    told,
)
from fegear.units import from_si

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.results.tolerance_robustness import ToleranceData
    from fegear.results.tolerance_tables import PairDrawn

#: Deviations that the picture of influences has, and classes of a histogram.
_MOST, _LEAST_CLASSES, _MOST_CLASSES = 12, 8, 60
_ROLES = {OWN: "relief of the case", NOMINAL: "designed", ROBUST: "linear tip relief"}


def tolerance_figures(data: ToleranceData, asked: PairDrawn) -> tuple[Figure, ...]:
    """Of one pair; none where no draw has a result."""
    if not np.isfinite(outcome(data, "te_peak_to_peak")).any():
        return ()
    figures = [_distributions(data, asked), _influences(data, asked)]
    if data.relief is not None:
        figures.append(_reliefs(data, asked))
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


def _distributions(data: ToleranceData, asked: PairDrawn) -> Figure:
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
                Panel(axis, Axis("draws in a class", "%", zero=True),
                      (Bars(*_histogram(values), "", "blue"),), (mark,), title=one.label),
                Panel(axis, Axis("draws below", "%", limits=(0.0, 100.0)),
                      (Curve(values, below, "", "blue", markers=False),), (mark, *levels)),
            ))
        )  # fmt: skip
    return Figure(
        f"robustness_distributions_{asked.name}",
        f"Pair {asked.name} inside its tolerances",
        f"Pair {asked.name}, {asked.part.draws} draws: how results are spread, and which share lies below. Dotted: the "
        "pair of the drawing (nominal), and percentiles 5, 50 and 95 with their values.",
        views=tuple(views),
        under=f"{asked.load:.5g} N",
    )


def _influences(data: ToleranceData, asked: PairDrawn) -> Figure:
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
                Panel(Axis("share of the variance by itself", "%", zero=True), across,
                      (Points(share, places, "", "blue", size=8.0),), title=SHOWN[name].label),
                Panel(Axis("rank correlation", limits=(-1.0, 1.0)), across,
                      (Points(rank, places, "", "orange", "diamond", size=8.0),), (Mark("x", 0.0),)),
            ))
        )  # fmt: skip
    return Figure(
        f"robustness_influences_{asked.name}",
        f"Which deviations of pair {asked.name} matter",
        f"Pair {asked.name}: share of a result's variance that each deviation explains by itself (either sign may "
        "raise the result), and its rank correlation with it. The rest of 100 % is what deviations do together."
        f"{leading_told(data, asked.gears)}",
        views=tuple(views),
        most_views=2,
    )


def _reliefs(data: ToleranceData, asked: PairDrawn) -> Figure:
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
        f"Tip reliefs of pair {asked.name} over the draws",
        f"Pair {asked.name}: share of the draws whose peak-to-peak transmission error lies below, with the relief of "
        f"the case, the tip reliefs that are best for the drawing, and those that are best at percentile {percent:g}."
        f"{search_told(data, asked)}",
        (
            Panel(
                Axis("peak-to-peak transmission error", "um", zero=True), Axis("draws below", "%", limits=(0.0, 100.0)),
                tuple(curves), tuple(marks),
            ),
        ),
        under=f"{asked.load:.5g} N",
    )  # fmt: skip
