"""Tables and values of a design chart of tip relief."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column, Table, Value

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.dynamics.factor_prediction import FactorLine
    from fegear.results.design_chart import DesignChartData


def chart_tables(chart: DesignChartData, mesh: str) -> tuple[Table, ...]:
    """The chart, and reliefs of their own on each gear where there are any."""
    amounts, lengths = chart.amounts, chart.lengths
    amount, length = np.repeat(amounts, lengths.size), np.tile(lengths, amounts.size)
    tables = [
        Table(
            f"design_chart_{mesh}",
            (
                Column("amount", amount, "", "of tip relief over Delta"),
                Column("length", length, "", "L_n, 1 from the tip to the HPSTC"),
                Column("dynamic_factor", chart.dynamic_factor.ravel(), "", "largest over the speeds"),
                Column("speed", chart.speed.ravel(), "rpm", f"of {chart.speed_of}, where it is largest"),
                Column("effective_error", chart.effective_error.ravel(), "um", "A_e of the static transmission error"),
                Column("contact_loss_fraction", chart.contact_loss.ravel(), "", "largest over the speeds"),
                Column("unsteady_speeds", chart.unsteady.ravel(), "", "how many speeds have no repeating motion"),
                *(
                    Column(
                        f"amplitude_{n + 1}", row.ravel(), "um", f"A_{n + 1} of the static transmission error, 0-peak"
                    )
                    for n, row in enumerate(chart.harmonics)
                ),
                *_foretold(chart.line, chart.effective_error.ravel()),
                Column("failure", np.array(chart.reasons, dtype=str), "", "why a point has no result"),
            ),
            f"Dynamic factor of mesh {mesh} against tip relief",
        )
    ]
    if chart.unequal:
        tables.append(_unequal_table(chart, mesh))
    return tuple(tables)


def _foretold(line: FactorLine | None, error: Array) -> tuple[Column, ...]:
    if line is None:
        return ()
    return (Column("foretold_factor", line(error), "", "by the straight line over A_e"),)


def _unequal_table(chart: DesignChartData, mesh: str) -> Table:
    def column(key: str, unit: str, meaning: str) -> Column:
        return Column(key, np.array([getattr(one, key) for one in chart.unequal]), unit, meaning)

    found = column("effective_error", "um", "A_e of the static transmission error")
    return Table(
        f"design_chart_unequal_{mesh}",
        (
            column("driver", "", "amount on the driver over Delta"),
            column("driven", "", "amount on the driven gear over Delta"),
            column("length", "", "L_n of both"),
            column("dynamic_factor", "", "largest over the speeds"),
            column("speed", "rpm", f"of {chart.speed_of}, where it is largest"),
            found,
            column("between", "", "foretold from A_e between both amounts on both gears (TM-89901, Fig. 11)"),
            *_foretold(chart.line, np.asarray(found.si)),
            Column("failure", np.array([one.reason for one in chart.unequal], dtype=str), "", "why there is no result"),
        ),
        f"Dynamic factor of mesh {mesh} with a relief of its own on each gear",
    )


def chart_values(chart: DesignChartData) -> tuple[Value, ...]:
    """Best lengths and least factors, what A_e tells of the factor, and unequal reliefs."""
    about = "Welbourn's Delta: deflection at the HPSTC under the mean force"
    values = [
        Value("design_chart.delta", chart.delta, "um", None, about),
        Value("design_chart.unmodified", chart.unmodified, "", None, "largest dynamic factor of perfect involutes"),
        Value("design_chart.unmodified_error", chart.unmodified_error, "um", None, "A_e of perfect involutes"),
    ]
    for number, (a, row) in enumerate(zip(chart.amounts, chart.dynamic_factor, strict=True)):
        if np.isfinite(row).any():
            k, (start, end) = int(np.nanargmin(row)), chart.flat_range(number)
            values += [
                Value(f"design_chart.best_length_{a:g}", float(chart.lengths[k]), "", None, f"L_n at {a:g} Delta"),
                Value(f"design_chart.least_factor_{a:g}", float(row[k]), "", None, f"at {a:g} Delta"),
                Value(
                    f"design_chart.flat_from_{a:g}", start, "", None, f"L_n, factor within 1 % of least, {a:g} Delta"
                ),
                Value(f"design_chart.flat_to_{a:g}", end, "", None, f"L_n, factor within 1 % of least, {a:g} Delta"),
            ]
    if chart.amounts.size > 1 and chart.lengths.size > 1 and np.isfinite(chart.dynamic_factor).all():
        length, factor = chart.best_for_all()
        ends = f"{chart.amounts[0]:g} to {chart.amounts[-1]:g} Delta"
        values += [
            Value("design_chart.best_length_for_all", length, "", None, f"L_n with the least worst factor from {ends}"),
            Value("design_chart.least_factor_for_all", factor, "", None, f"that factor, {ends}"),
        ]
    if chart.line is not None:
        line = chart.line
        values += [
            Value("design_chart.line_constant", line.constant, "", None, "dynamic factor at no effective error"),
            Value("design_chart.line_slope", line.slope, "1/mm", None, "of the dynamic factor over A_e"),
            Value("design_chart.line_scatter", line.scatter, "", None, "root mean square of what it misses"),
            Value("design_chart.line_correlation", line.correlation, "", None, "of dynamic factor and A_e"),
        ]
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
        f"Design chart: the line {line.constant:.3g} + {line.slope * 1e-6:.3g} A_e/um through all points leaves "
        f"{line.scatter:.2g} of the dynamic factor (root mean square; correlation {line.correlation:.3f}). It misses "
        f"most at {chart.amounts[a]:g} Delta, L_n = {chart.lengths[n]:g}: {found:.3g}, foretold {line(error):.3g}."
    )
    return (sentence,)
