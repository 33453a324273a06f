"""Figures of a design chart of tip relief: TM-89901's Figs. 7 to 11."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel, Points, View

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.results.design_chart import DesignChartData

_LENGTH = Axis("length of relief L_{n}")
_FACTOR = Axis("largest dynamic factor")
_ERROR = Axis("effective error A_{e}", "um", zero=True)


def design_chart_figures(chart: DesignChartData) -> tuple[Figure, ...]:
    """The chart, harmonics of the transmission error behind it, and how A_e tells the factor; none for one length."""
    if chart.lengths.size < 2:
        return ()
    return (_chart(chart), _harmonics(chart), *_foretold(chart))


def _chart(chart: DesignChartData) -> Figure:
    """Largest dynamic factor and A_e over the length of relief for every amount."""

    def curves(rows: Array) -> list[Curve | Points]:
        return [
            Curve(chart.lengths, row, f"{amount:.4g} Δ", f"series:{k}", markers=True)
            for k, (amount, row) in enumerate(zip(chart.amounts, rows, strict=True))
        ]

    factor, error = curves(chart.dynamic_factor), curves(chart.effective_error * 1e6)
    told = ""
    if chart.amounts.size > 1 and np.isfinite(chart.dynamic_factor).all():
        best = np.argmin(chart.dynamic_factor, axis=1)
        least = chart.dynamic_factor[np.arange(best.size), best]
        factor.append(Curve(chart.lengths[best], least, "least of each amount", "ink", dash="dash", markers=False))
        length, worst = chart.best_for_all()
        factor.append(Points([length], [worst], "least for all amounts", "ink", symbol="star", size=10.0))
        told = f" The star is the length that is best for all amounts together, L_n = {length:.3g}."
    return Figure(
        "design_chart",
        "Design chart of tip relief",
        "Largest dynamic factor over the speeds, and effective error, against the length of tip relief (1 from the "
        f"tip to the highest point of single contact), by amount over Δ = {chart.delta * 1e6:.4g} µm.{told}",
        (
            Panel(_LENGTH, _FACTOR, tuple(factor), (Mark("y", chart.unmodified, "unmodified"),)),
            Panel(_LENGTH, _ERROR, tuple(error)),
        ),
        columns=2,
    )


def _harmonics(chart: DesignChartData) -> Figure:
    """Dynamic factor, and A_1 to A_4 with A_e, over the length of relief."""
    views = []
    for k, amount in enumerate(chart.amounts):
        below = [
            Curve(chart.lengths, row[k] * 1e6, f"A_{{{n + 1}}}", f"series:{n}", markers=True)
            for n, row in enumerate(chart.harmonics)
        ]
        below.append(Curve(chart.lengths, chart.effective_error[k] * 1e6, "A_{e}", "ink", markers=True, width=2.6))
        views.append(
            View(
                f"{amount:.4g} Δ",
                (
                    Panel(_LENGTH, _FACTOR, (Curve(chart.lengths, chart.dynamic_factor[k], "", "blue", markers=True),)),
                    Panel(_LENGTH, Axis("amplitude, 0-peak", "um", zero=True), tuple(below)),
                ),
            )
        )
    return Figure(
        "design_chart_harmonics",
        "Harmonics of the transmission error over the length of relief",
        "Largest dynamic factor, and below it the first harmonics A_i of the static transmission error with the "
        "effective error A_e, against the length of tip relief.",
        views=tuple(views),
    )


def _foretold(chart: DesignChartData) -> tuple[Figure, ...]:
    """Dynamic factor over effective error: the points, their line, and unequal reliefs."""
    if chart.line is None:
        return ()
    items: list[Curve | Points] = [
        Points(error * 1e6, factor, f"{amount:.4g} Δ", f"series:{k}", size=7.0)
        for k, (amount, error, factor) in enumerate(
            zip(chart.amounts, chart.effective_error, chart.dynamic_factor, strict=True)
        )
    ]
    items.append(
        Points([chart.unmodified_error * 1e6], [chart.unmodified], "unmodified", "grey", symbol="square", size=8.0)
    )
    there = [one for one in chart.unequal if not one.reason]
    if there:
        notes = tuple(f"{one.driver:g} and {one.driven:g} Δ, L_n = {one.length:g}" for one in there)
        error = [one.effective_error * 1e6 for one in there]
        factor = [one.dynamic_factor for one in there]
        items.append(Points(error, factor, "unequal reliefs", "ink", symbol="star", size=11.0, notes=notes))
    ends = np.array([0.0, max(chart.unmodified_error, float(np.nanmax(chart.effective_error)))])
    items.append(Curve(ends * 1e6, chart.line(ends), "straight line", "ink", dash="dash", markers=False, width=1.2))
    figure = Figure(
        "design_chart_foretold",
        "Dynamic factor over effective error",
        "Largest dynamic factor over the speeds against the effective error A_e of the static transmission error, for "
        f"every relief of the chart, and the line of least squares ({chart.line.scatter:.2g} root mean square).",
        (Panel(Axis("effective error A_{e}", "um", zero=True), _FACTOR, tuple(items)),),
    )
    return (figure,)
