"""Tables and values of a design chart of tip relief.

Figures of a design chart of tip relief: TM-89901's Figs. 7 to 11.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.dynamics.train.dynamic_factor import FactorLine
from fegear.engine.declared import axis_of, column_of, column_over, columns_on_grid, drawn, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, View
from fegear.engine.figure.items import Curve, Mark, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.table import Column, Table
from fegear.engine.value import Value

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.dynamics.train.dynamic_factor import FactorLine


#: What was computed at every point of the chart, in the order of its table.
_CELLS = ("dynamic_factor", "speed", "effective_error", "contact_loss", "unsteady")


#: Largest factor over the least of an amount at which a length is as good as the best: its optimum is flat.
_NEARLY = 1.01


@dataclass(frozen=True)
class DesignChartData:
    """The chart; arrays of shape (amounts, lengths), nan where a point has no result.

    Harmonics A_1 to A_4 have the shape (4, amounts, lengths); reasons have the last axis fastest.
    """

    amounts: Array = shown("", "amount of tip relief / Delta", name="amount")
    lengths: Array = shown("", "length L_n (1: from tip to HPSTC)", name="length", label="length of relief L_{n}")
    dynamic_factor: Array = shown("", "maximum over the speeds", label="maximum dynamic factor")
    effective_error: Array = shown("um", "A_e of the static transmission error", label="effective error A_{e}")
    speed: Array = shown("rpm", "speed of the maximum dynamic factor")
    contact_loss: Array = shown("", "maximum over the speeds", name="contact_loss_fraction")
    unsteady: Array = shown("", "number of speeds with non-periodic motion", name="unsteady_speeds")
    harmonics: Array = shown("um", "amplitude of the static transmission error", label="amplitude")
    reasons: tuple[str, ...] = shown("", "reason for missing result", name="failure")
    unequal: tuple[UnequalRelief, ...] = shown("", "unequal reliefs of both gears")
    line: FactorLine | None = shown("", "straight line of the dynamic factor over A_e, all points")
    unmodified: float = shown("", "maximum dynamic factor without modification")
    unmodified_error: float = shown("um", "A_e without modification")
    delta: float = shown("um", "Welbourn's Delta: deflection at the HPSTC under the mean force")
    speed_of: str = shown("", "body to which speeds refer")

    def best_for_all(self) -> tuple[float, float]:
        """Length at which the worst of all amounts is least, and that factor; straight between the chart's lengths.

        Nan where an amount has no results.
        """
        lengths = np.unique(np.concatenate([self.lengths, np.linspace(self.lengths[0], self.lengths[-1], 2001)]))
        worst = np.max([np.interp(lengths, self.lengths, row) for row in self.dynamic_factor], axis=0)
        k = int(np.argmin(worst))
        return float(lengths[k]), float(worst[k])

    def flat_range(self, amount: int) -> tuple[float, float]:
        """Lengths around the best of one amount between which no factor of the chart is 1 % above the least.

        Parameters
        ----------
        amount : int
            Index of an amount with at least one result.
        """
        row = self.dynamic_factor[amount]
        k = int(np.nanargmin(row))
        off = np.flatnonzero(~(row <= _NEARLY * row[k]))
        first, last = off[off < k], off[off > k]
        return (
            float(self.lengths[first[-1] + 1 if first.size else 0]),
            float(self.lengths[last[0] - 1 if last.size else -1]),
        )


@dataclass(frozen=True)
class UnequalRelief:
    """A relief of its own on each gear; nan where there is no result, and the reason for that."""

    driver: float = shown("", "amount on the driver / Delta")
    driven: float = shown("", "amount on the driven gear / Delta")
    length: float = shown("", "length L_n of both")
    dynamic_factor: float = shown("", "maximum over the speeds")
    speed: float = shown("rpm", "speed of the maximum dynamic factor")
    effective_error: float = shown("um", "A_e of the static transmission error")
    between: float = shown(
        "", "predicted from A_e, interpolated between equal reliefs of either amount (TM-89901, Fig. 11)"
    )
    reason: str = shown("", "reason for missing result", name="failure", default="")


def _with_body(columns: Iterable[Column], body: str) -> tuple[Column, ...]:
    """The columns, of the speed with the body that it is of."""
    return tuple(replace(one, meaning=f"{one.meaning}, of {body}") if one.name == "speed" else one for one in columns)


def chart_tables(chart: DesignChartData, mesh: str) -> tuple[Table, ...]:
    """The chart, and reliefs of their own on each gear where there are any."""
    tables = [
        Table(
            f"design_chart_{mesh}",
            (
                *_with_body(columns_on_grid(chart, ("amounts", "lengths"), *_CELLS), chart.speed_of),
                *(
                    column_of(
                        chart, "harmonics", row.ravel(), name=f"amplitude_{n}",
                        meaning=f"A_{n} of the static transmission error, amplitude",
                    )
                    for n, row in enumerate(chart.harmonics, 1)
                ),
                *_foretold(chart.line, chart.effective_error.ravel()),
                column_of(chart, "reasons"),
            ),
            f"Dynamic factor of mesh {mesh} over tip relief",
        )
    ]  # fmt: skip
    if chart.unequal:
        tables.append(_unequal_table(chart, mesh))
    return tuple(tables)


def _foretold(line: FactorLine | None, error: Array) -> tuple[Column, ...]:
    if line is None:
        return ()
    return (Column("foretold_factor", line(error), "", "predicted by the straight line over A_e"),)


def _unequal_table(chart: DesignChartData, mesh: str) -> Table:
    every = (column_over(chart.unequal, field.name) for field in fields(chart.unequal[0]))
    *numbers, reason = _with_body(every, chart.speed_of)
    foretold = _foretold(chart.line, np.array([one.effective_error for one in chart.unequal]))
    return Table(
        f"design_chart_unequal_{mesh}",
        (*numbers, *foretold, reason),
        f"Dynamic factor of mesh {mesh} with unequal reliefs",
    )


def chart_values(chart: DesignChartData) -> tuple[Value, ...]:
    """Best lengths and least factors, what A_e tells of the factor, and unequal reliefs."""
    values = [value_of(chart, key, "design_chart") for key in ("delta", "unmodified", "unmodified_error")]
    for number, (a, row) in enumerate(zip(chart.amounts, chart.dynamic_factor, strict=True)):
        if np.isfinite(row).any():
            k, (start, end) = int(np.nanargmin(row)), chart.flat_range(number)
            values += [
                Value(f"design_chart.best_length_{a:g}", float(chart.lengths[k]), "", None, f"L_n at {a:g} Delta"),
                Value(f"design_chart.least_factor_{a:g}", float(row[k]), "", None, f"at {a:g} Delta"),
                Value(
                    f"design_chart.flat_from_{a:g}",
                    start,
                    "",
                    None,
                    f"L_n, factor within 1 % of the minimum, {a:g} Delta",
                ),
                Value(
                    f"design_chart.flat_to_{a:g}", end, "", None, f"L_n, factor within 1 % of the minimum, {a:g} Delta"
                ),
            ]
    if chart.amounts.size > 1 and chart.lengths.size > 1 and np.isfinite(chart.dynamic_factor).all():
        length, factor = chart.best_for_all()
        ends = f"{chart.amounts[0]:g} to {chart.amounts[-1]:g} Delta"
        values += [
            Value(
                "design_chart.best_length_for_all",
                length,
                "",
                None,
                f"L_n with the minimum of the maximum factor, {ends}",
            ),
            Value("design_chart.least_factor_for_all", factor, "", None, f"this factor, {ends}"),
        ]
    if chart.line is not None:
        keys = ("constant", "slope", "scatter", "correlation")
        values += [value_of(chart.line, key, "design_chart") for key in keys]
    values += [
        Value(
            f"design_chart.factor_{one.driver:g}_{one.driven:g}_{one.length:g}", one.dynamic_factor, "", None,
            f"{one.driver:g} Delta on the driver, {one.driven:g} on the driven gear, L_n = {one.length:g}",
        )
        for one in chart.unequal if not one.reason
    ]  # fmt: skip
    return tuple(values)


def line_remark(chart: DesignChartData) -> tuple[str, ...]:
    """Say how well the effective error tells the dynamic factor, and where it misses most."""
    if chart.line is None:
        return ()
    line, missed = chart.line, chart.dynamic_factor - chart.line(chart.effective_error)
    a, n = np.unravel_index(int(np.nanargmax(np.abs(missed))), missed.shape)
    found, error = chart.dynamic_factor[a, n], chart.effective_error[a, n]
    sentence = (
        f"Design chart: the line {line.constant:.3g} + {line.slope * 1e-6:.3g} A_e/um through all points has an rms "
        f"residual of {line.scatter:.2g} (correlation {line.correlation:.3f}). Maximum deviation at "
        f"{chart.amounts[a]:g} Delta, L_n = {chart.lengths[n]:g}: {found:.3g}, predicted {line(error):.3g}."
    )
    return (sentence,)


def design_chart_figures(chart: DesignChartData) -> tuple[Figure, ...]:
    """The chart, harmonics of the transmission error behind it, and how A_e tells the factor; none for one length."""
    if chart.lengths.size < 2:
        return ()
    return (_chart(chart), _harmonics(chart), *_drawn_forecast(chart))


def _axes(chart: DesignChartData) -> tuple[Axis, Axis, Axis]:
    """Length of relief, dynamic factor and effective error."""
    return axis_of(chart, "lengths"), axis_of(chart, "dynamic_factor"), axis_of(chart, "effective_error", zero=True)


def _chart(chart: DesignChartData) -> Figure:
    """Largest dynamic factor and A_e over the length of relief for every amount."""

    def curves(rows: Array) -> list[Curve | Points]:
        return [
            Curve(chart.lengths, row, f"{amount:.4g} Δ", f"series:{k}", markers=True)
            for k, (amount, row) in enumerate(zip(chart.amounts, rows, strict=True))
        ]

    factor, error = curves(chart.dynamic_factor), curves(drawn(chart, "effective_error"))
    length_axis, factor_axis, error_axis = _axes(chart)
    told = ""
    if chart.amounts.size > 1 and np.isfinite(chart.dynamic_factor).all():
        best = np.argmin(chart.dynamic_factor, axis=1)
        least = chart.dynamic_factor[np.arange(best.size), best]
        factor.append(Curve(chart.lengths[best], least, "minimum of each amount", "ink", dash="dash", markers=False))
        length, worst = chart.best_for_all()
        factor.append(Points([length], [worst], "optimum for all amounts", "ink", symbol="star", size=10.0))
        told = f" Star: optimum length for all amounts, L_n = {length:.3g}."
    return Figure(
        "design_chart",
        "Tip relief design chart",
        "Maximum dynamic factor over the speeds and effective error, over the length of tip relief (1 from the tip "
        f"to the highest point of single contact), by amount over Δ = {chart.delta * 1e6:.4g} µm.{told}",
        (
            Panel(length_axis, factor_axis, tuple(factor), (Mark("y", chart.unmodified, "unmodified"),)),
            Panel(length_axis, error_axis, tuple(error)),
        ),
        columns=2,
    )


def _harmonics(chart: DesignChartData) -> Figure:
    """Dynamic factor, and A_1 to A_4 with A_e, over the length of relief."""
    views = []
    length, factor, _ = _axes(chart)
    for k, amount in enumerate(chart.amounts):
        below = [
            Curve(chart.lengths, drawn(chart, "harmonics", row[k]), f"A_{{{n + 1}}}", f"series:{n}", markers=True)
            for n, row in enumerate(chart.harmonics)
        ]
        error = drawn(chart, "effective_error", chart.effective_error[k])
        below.append(Curve(chart.lengths, error, "A_{e}", "ink", markers=True, width=2.6))
        views.append(
            View(
                f"{amount:.4g} Δ",
                (
                    Panel(length, factor, (Curve(chart.lengths, chart.dynamic_factor[k], "", "blue", markers=True),)),
                    Panel(length, axis_of(chart, "harmonics", zero=True), tuple(below)),
                ),
            )
        )
    return Figure(
        "design_chart_harmonics",
        "Harmonics of the transmission error over the length of relief",
        "Maximum dynamic factor, and first harmonics A_i of the static transmission error with the effective error "
        "A_e, over the length of tip relief.",
        views=tuple(views),
    )


def _drawn_forecast(chart: DesignChartData) -> tuple[Figure, ...]:
    """Dynamic factor over effective error: the points, their line, and unequal reliefs."""
    if chart.line is None:
        return ()
    _, factor_axis, error_axis = _axes(chart)
    items: list[Curve | Points] = [
        Points(error, factor, f"{amount:.4g} Δ", f"series:{k}", size=7.0)
        for k, (amount, error, factor) in enumerate(
            zip(chart.amounts, drawn(chart, "effective_error"), chart.dynamic_factor, strict=True)
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
        "Maximum dynamic factor over the speeds versus effective error A_e of the static transmission error, all "
        f"reliefs of the chart, with least-squares line (rms residual {chart.line.scatter:.2g}).",
        (Panel(error_axis, factor_axis, tuple(items)),),
    )
    return (figure,)
