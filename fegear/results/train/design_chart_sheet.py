"""A design chart of tip relief as it is shown: tables, values, and figures after TM-89901's Figs. 7 to 11."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.dynamics.train.dynamic_factor import FactorLine
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import ALL, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import itself
from fegear.engine.sheet.sheet import Sheet

if TYPE_CHECKING:
    from fegear.engine.sheet.seen import Seen

#: Largest factor over the least of an amount at which a length is as good as the best: its optimum is flat.
_NEARLY = 1.01


@dataclass(frozen=True)
class AmountRow:
    """One amount of the chart over the lengths: arrays of shape (lengths,), harmonics by their number.

    The best length, and those between which no factor is 1 % above its own, are None where there is no result.
    """

    amount: float
    factor: Array
    error: Array
    harmonics: dict[str, Array]
    best: float | None = shown("", "L_n", name="best_length")
    least: float | None = shown("", "minimum", name="least_factor")
    start: float | None = shown("", "L_n, factor within 1 % of the minimum", name="flat_from")
    end: float | None = shown("", "L_n, factor within 1 % of the minimum", name="flat_to")


@dataclass(frozen=True)
class ForAll:
    """Best length of every amount with its factor, and the length at which the worst of all amounts is least."""

    ends: str
    lengths: Array
    factors: Array
    length: float = shown("", "L_n with the minimum of the maximum factor", name="best_length_for_all")
    factor: float = shown("", "this factor", name="least_factor_for_all")


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

    @property
    @shows("", "predicted by the straight line over A_e", name="foretold_factor")
    def foretold(self) -> Array | None:
        """Shape (amounts, lengths)."""
        return None if self.line is None else self.line(self.effective_error)

    @property
    def foretold_unequal(self) -> Array | None:
        """The same of reliefs of their own."""
        return None if self.line is None else self.line([one.effective_error for one in self.unequal])

    @cached_property
    def rows(self) -> list[AmountRow]:
        """Of every amount."""
        return [self._row(k, float(amount)) for k, amount in enumerate(self.amounts)]

    def _row(self, k: int, amount: float) -> AmountRow:
        factor = self.dynamic_factor[k]
        best: tuple[float | None, ...] = (None,) * 4
        if np.isfinite(factor).any():
            least = int(np.nanargmin(factor))
            best = (float(self.lengths[least]), float(factor[least]), *self.flat_range(k))
        harmonics = {str(n): row[k] for n, row in enumerate(self.harmonics, 1)}
        return AmountRow(amount, factor, self.effective_error[k], harmonics, *best)

    @cached_property
    def for_all(self) -> ForAll | None:
        """Where there are several amounts and lengths, all with results."""
        if min(self.amounts.size, self.lengths.size) < 2 or not np.isfinite(self.dynamic_factor).all():
            return None
        best = np.argmin(self.dynamic_factor, axis=1)
        ends = f"{self.amounts[0]:g} to {self.amounts[-1]:g} Delta"
        least = self.dynamic_factor[np.arange(best.size), best]
        return ForAll(ends, self.lengths[best], least, *self.best_for_all())

    @property
    def drawn(self) -> bool:
        """Whether there is anything over the length."""
        return self.lengths.size > 1

    @property
    def reached(self) -> list[UnequalRelief] | None:
        """Reliefs of their own that have a result."""
        return [one for one in self.unequal if not one.reason] or None

    @property
    def error_ends(self) -> Array:
        """Ends of the straight line [m]."""
        return np.array([0.0, max(self.unmodified_error, float(np.nanmax(self.effective_error)))])

    @property
    def failures(self) -> list[str]:
        """Points without a result, and why."""
        points = zip(product(self.amounts, self.lengths), self.reasons, strict=True)
        return [
            *(f"amount {a:.4g} Delta, length {n:.4g}: {reason}" for (a, n), reason in points if reason),
            *(
                f"amounts {one.driver:.4g} and {one.driven:.4g} Delta, length {one.length:.4g}: {one.reason}"
                for one in self.unequal
                if one.reason
            ),
        ]

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


def _on_line(seen: Seen) -> tuple[str, ...]:
    """Say how well the effective error tells the dynamic factor, and where it misses most."""
    chart: DesignChartData = seen.data
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


def _caption(seen: Seen) -> str:
    star = " Star: optimum length for all amounts, L_n = {d.for_all.length:.3g}." if seen.data.for_all else ""
    return seen.said(
        "Maximum dynamic factor over the speeds and effective error, over the length of tip relief (1 from the tip to "
        f"the highest point of single contact), by amount over Δ = {{d.delta:.4g}}.{star}"
    )


def _data(seen: Seen) -> DesignChartData:
    """What declares the quantities of one row of the chart."""
    found: DesignChartData = seen.data
    return found


_OWNER = "design_chart"
_SPEED = Cell("speed", further=", of {d.speed_of}")
_ROWS = Family("rows", "{one.amount:.4g} Δ", most=ALL)
_MARKED, _LEVEL = {"markers": True}, {"dash": "dash", "markers": False}
_ERROR = Line("effective_error", si="error", of=_data, each=_ROWS, look=_MARKED)
CHART_SHEET = Sheet(
    name=lambda asked: str(asked.mesh),
    tables=(
        Rows(
            "design_chart_{name}", "Dynamic factor of mesh {name} over tip relief",
            (
                "dynamic_factor", _SPEED, "effective_error", "contact_loss", "unsteady",
                Cell(
                    "harmonics", itself, _data, "amplitude_{key}",
                    "A_{key} of the static transmission error, amplitude",
                    each=lambda seen: dict(enumerate(seen.data.harmonics, 1)),
                ),
                "foretold", "reasons",
            ),
            on=("amounts", "lengths"),
        ),
        Rows(
            "design_chart_unequal_{name}", "Dynamic factor of mesh {name} with unequal reliefs",
            (
                "driver", "driven", "length", "dynamic_factor", _SPEED, "effective_error", "between",
                Cell("foretold", "foretold_unequal", _data), "reason",
            ),
            of="unequal", when="unequal",
        ),
    ),
    values=(
        *(Number(key, owner=_OWNER) for key in ("delta", "unmodified", "unmodified_error")),
        Each(
            "rows",
            Number("best", owner=_OWNER, name="best_length_{one.amount:g}", further=" at {one.amount:g} Delta"),
            Number("least", owner=_OWNER, name="least_factor_{one.amount:g}", meaning="at {one.amount:g} Delta"),
            Number("start", owner=_OWNER, name="flat_from_{one.amount:g}", further=", {one.amount:g} Delta"),
            Number("end", owner=_OWNER, name="flat_to_{one.amount:g}", further=", {one.amount:g} Delta"),
        ),
        *(Number(key, of="for_all", owner=_OWNER, further=", {d.for_all.ends}") for key in ("length", "factor")),
        *(
            Number(key, of="line", owner=_OWNER) for key in ("constant", "slope", "scatter", "correlation")
        ),
        Number(
            "dynamic_factor", owner=_OWNER, name="factor_{one.driver:g!}_{one.driven:g!}_{one.length:g!}",
            meaning="{one.driver:g!} Delta on the driver, {one.driven:g!} on the driven gear, L_n = {one.length:g!}",
            each="reached",
        ),
    ),
    figures=(
        Chart(
            "design_chart", "Tip relief design chart", _caption,
            (
                Over(
                    "lengths",
                    (
                        Line("dynamic_factor", si="factor", of=_data, each=_ROWS, look=_MARKED),
                        Line(
                            "dynamic_factor", "minimum of each amount", "ink", si="for_all.factors",
                            x_si="for_all.lengths", look=_LEVEL,
                        ),
                        Line(
                            "factor", "optimum for all amounts", "ink", x="length", kind="points",
                            of=lambda seen: seen.data.for_all and [seen.data.for_all],
                            look={"symbol": "star", "size": 10.0},
                        ),
                    ),
                    "dynamic_factor", lambda seen: [Mark("y", seen.data.unmodified, "unmodified")],
                ),
                Over("lengths", (_ERROR,), "effective_error", options={"zero": True}),
            ),
            columns=2, when="drawn",
        ),
        Chart(
            "design_chart_harmonics", "Harmonics of the transmission error over the length of relief",
            "Maximum dynamic factor, and first harmonics A_i of the static transmission error with the effective error "
            "A_e, over the length of tip relief.",
            (
                Over("lengths", (Line("dynamic_factor", si="factor", look=_MARKED),), "dynamic_factor", of=_data),
                Over(
                    "lengths",
                    (
                        Line(
                            "harmonics", si=itself, of=_data, look=_MARKED,
                            each=Family("harmonics", "A_{{{key}}}", most=ALL),
                        ),
                        Line("effective_error", "A_{{e}}", "ink", si="error", look=_MARKED | {"width": 2.6}),
                    ),
                    "harmonics", options={"zero": True}, of=_data,
                ),
            ),
            when="drawn", views="rows", view="{one.amount:.4g} Δ",
        ),
        Chart(
            "design_chart_foretold", "Dynamic factor over effective error",
            "Maximum dynamic factor over the speeds versus effective error A_e of the static transmission error, all "
            "reliefs of the chart, with least-squares line (rms residual {d.line.scatter:.2g}).",
            (
                Over(
                    "effective_error",
                    (
                        Line(
                            "dynamic_factor", si="factor", x_si="error", of=_data, each=_ROWS, kind="points",
                            look={"size": 7.0},
                        ),
                        Line(
                            "unmodified", "unmodified", "grey", x="unmodified_error", of=lambda seen: [seen.data],
                            kind="points", look={"symbol": "square", "size": 8.0},
                        ),
                        Line(
                            "dynamic_factor", "unequal reliefs", "ink", of="reached", kind="points",
                            look=lambda seen: {
                                "symbol": "star", "size": 11.0,
                                "notes": tuple(
                                    f"{one.driver:g} and {one.driven:g} Δ, L_n = {one.length:g}"
                                    for one in seen.data.reached
                                ),
                            },
                        ),
                        Line(
                            "dynamic_factor", "straight line", "ink", x_si="error_ends",
                            si=lambda seen: seen.data.line(seen.data.error_ends), look=_LEVEL | {"width": 1.2},
                        ),
                    ),
                    "dynamic_factor", x_options={"zero": True},
                ),
            ),
            when=lambda seen: seen.data.drawn and seen.data.line is not None,
        ),
    ),
    remarks=(lambda seen: seen.data.failures, _on_line),
    settings={
        "points": lambda seen: 1 + seen.data.dynamic_factor.size + 3 * len(seen.data.unequal),
        "speeds": lambda seen: int(seen.asked.motion.speeds.size),
    },
)  # fmt: skip
