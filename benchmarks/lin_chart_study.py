"""Makes docs/sources/lin_townsend_oswald_chart: NASA TM-89901, Figs. 8 to 10, on a grid that knows no answer of theirs.

All six amounts of relief over lengths from 0 to the pitch point in steps of 0.02 and 46 speeds: 17,940 motions, some
five minutes of one core and too long for the site. Where an amount is best, and where the curves of 1.00 and 1.50 Delta
cross, lengths are `FINE` apart, closer than the paper's two decimals can be read: on a grid that is coarser the best
length would be a member of the grid and no reading. The page of the paper reads its numbers from what is kept here; a
long test computes it again.

    python benchmarks/lin_chart_study.py
"""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import TYPE_CHECKING

import fegear

if TYPE_CHECKING:
    from fegear.workbench.results import Results

ROOT = Path(__file__).resolve().parents[1]
CASE = ROOT / "cases" / "sources" / "lin_townsend_oswald_fig9.toml"
KEPT = ROOT / "docs" / "sources" / "lin_townsend_oswald_chart"
AMOUNTS = [0.25, 0.5, 0.75, 1.0, 1.25, 1.5]
#: To 1.284, the pitch point; without relief there is no length.
LENGTHS = [*(round(0.02 * k, 2) for k in range(1, 65)), 1.284]
#: Every 250 rpm where the largest factors lie, and finer where teeth come to part: there the factor jumps.
SPEEDS = sorted({*range(1500, 6001, 250), *range(9500, 14501, 250), *range(11175, 11326, 25)})
#: Step of the lengths about each optimum, and how far they go beyond those that are within 1 % of the best.
FINE, BEYOND = 0.002, 0.02
#: Point A of Fig. 10 is best for loads between those of these amounts.
ENDS = (1.0, 1.5)
#: What the page reads, and what shows where a factor comes from.
COLUMNS = ("amount", "length", "dynamic_factor", "speed [rpm]", "effective_error [um]")


def chart(amounts: list[float], lengths: list[float]) -> Results:
    """The chart of the case over some amounts and lengths, at the speeds of the study."""
    return fegear.run(
        CASE,
        {"dynamics.chart": {"amounts": amounts, "lengths": lengths}, "dynamics.speeds": [f"{n} rpm" for n in SPEEDS]},
        progress=True,
    )


def fine(low: float, high: float) -> list[float]:
    """Lengths `FINE` apart from one to another, none beyond the pitch point."""
    steps = range(round((low - BEYOND) / FINE), round((high + BEYOND) / FINE) + 1)
    return sorted({min(round(FINE * k, 3), LENGTHS[-1]) for k in steps})


def near_crossing(table: dict[tuple[float, float], float]) -> float:
    """Length at which the larger of the factors of both ends is least, in a chart by amount and length."""
    return min(LENGTHS, key=lambda length: max(table[amount, length] for amount in ENDS))


def rows_of(found: Results) -> list[tuple[float, ...]]:
    """Its points, as they are kept."""
    table = found.tables["design_chart_I"]
    return list(zip(*(next(c.values for c in table.columns if c.head == head) for head in COLUMNS), strict=True))


def values_of(found: Results, prefixes: tuple[str, ...]) -> dict[str, dict[str, float | str]]:
    """Its values whose names begin so, as they are kept."""
    return {
        one.name: {"value": round(one.value, 4), "unit": one.unit}
        for one in found.values
        if one.value is not None and one.name.startswith(tuple(f"design_chart.{name}" for name in prefixes))
    }


def main() -> None:
    """Compute the chart and keep it, as `fegear run` would leave it, with the columns that are read."""
    coarse = chart(AMOUNTS, LENGTHS)
    keep(rows_of(coarse), values_of(coarse, ("delta", "unmodified")))


def keep(rows: list[tuple[float, ...]], values: dict[str, dict[str, float | str]]) -> None:
    """Refine the optima of a coarse chart, and keep both."""
    table = {(row[0], round(row[1], 3)): row for row in rows}
    factors = {at: row[2] for at, row in table.items()}
    for amount in AMOUNTS:
        least = min(factors[amount, length] for length in LENGTHS)
        flat = [length for length in LENGTHS if factors[amount, length] <= 1.01 * least]
        found = chart([amount], fine(flat[0], flat[-1]))
        values |= values_of(found, ("best_length", "least_factor", "flat"))
        table |= {(row[0], round(row[1], 3)): row for row in rows_of(found)}
    cross = near_crossing(factors)
    found = chart(list(ENDS), fine(cross, cross))
    values |= values_of(found, ("best_length_for_all", "least_factor_for_all"))
    table |= {(row[0], round(row[1], 3)): row for row in rows_of(found)}
    (KEPT / "tables").mkdir(parents=True, exist_ok=True)
    (KEPT / "summary.json").write_text(json.dumps({"results": values}, indent=1) + "\n", "utf-8")
    with (KEPT / "tables" / "design_chart_I.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows([f"{value:.6g}" for value in table[at]] for at in sorted(table))


if __name__ == "__main__":
    main()
