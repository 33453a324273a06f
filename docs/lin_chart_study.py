"""Makes docs/sources/lin_townsend_oswald_chart: NASA TM-89901, Figs. 8 to 10, on a grid that knows no answer of theirs.

All six amounts of relief over lengths from 0 to the pitch point in steps of 0.02 and 46 speeds: 17,940 motions, some
five minutes of one core and too long for the site. The page of the paper reads its numbers from what is kept here; a
long test computes it again.

    python docs/lin_chart_study.py
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
#: What the page reads, and what shows where a factor comes from.
COLUMNS = ("amount", "length", "dynamic_factor", "speed [rpm]", "effective_error [um]")


def chart(amounts: list[float], lengths: list[float]) -> Results:
    """The chart of the case over some amounts and lengths, at the speeds of the study."""
    return fegear.run(
        CASE,
        {"dynamics.chart": {"amounts": amounts, "lengths": lengths}, "dynamics.speeds": [f"{n} rpm" for n in SPEEDS]},
        progress=True,
    )


def main() -> None:
    """Compute the chart and keep it, as `fegear run` would leave it, with the columns that are read."""
    found = chart(AMOUNTS, LENGTHS)
    (KEPT / "tables").mkdir(parents=True, exist_ok=True)
    values = {
        one.name: {"value": round(one.value, 4), "unit": one.unit}
        for one in found.values
        if one.name.startswith("design_chart.") and one.value is not None and "line_" not in one.name
    }
    (KEPT / "summary.json").write_text(json.dumps({"results": values}, indent=1) + "\n", "utf-8")
    table = found.tables["design_chart_I"]
    rows = zip(*(next(c.values for c in table.columns if c.head == head) for head in COLUMNS), strict=True)
    with (KEPT / "tables" / "design_chart_I.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows([f"{value:.6g}" for value in row] for row in rows)


if __name__ == "__main__":
    main()
