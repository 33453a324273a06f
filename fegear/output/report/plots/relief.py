"""Figures of relief design: reliefs, what they leave, Harris maps, charts, robustness."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from fegear.output.report.figure import COLOURS, DASHES, SYMBOLS, Figure, column, has, ramp
from fegear.output.report.plots.common import cells, few, short, starting, table_named

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.outcome import Outcome
    from fegear.engine.stage import Task

_PITCH = "roll position over one base pitch [mm]"
_TE = "transmission error [µm]"


def reliefs(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe designed reliefs, the transmission error that each candidate leaves, and the Harris maps."""
    name = task.subject
    made = Figure(
        f"relief_{name}", f"Profile relief of {name}",
        "Material to remove from both gears over the active profile, and the load that each was designed for.",
    )  # fmt: skip
    top = made.panel("roll angle [°]", "material to remove [µm]")
    bottom = made.panel("roll angle [°]", "load [N]", height=0.6, zero=True)
    for number, table in enumerate(starting(outcome, f"relief_{name}_")):
        member, dash = ("driver", "driven")[number % 2], DASHES[number % 2]
        error = "relief_error" if has(table, "relief_error") else None
        top.line(table, "roll_angle", "relief", f"{member}, designed", (0, 3)[number % 2], dash=dash, error=error)
        if has(table, "relief_diagonal"):
            top.line(
                table, "roll_angle", "relief_diagonal", f"{member}, neighbours left out", (5, 4)[number % 2], dash="dot"
            )
        bottom.line(table, "roll_angle", "load", f"{member}, designed", (0, 3)[number % 2], dash=dash)
    yield made
    harris = table_named(outcome, f"harris_map_{name}")
    if harris is None:
        return
    loads = cells(harris, "total_load")
    design = cast("float", outcome.settings.get("design_load", float(loads[-1])))
    at = min(loads, key=lambda load: abs(float(load) - design))
    candidates = [c.name for c in harris.columns if c.name.startswith("te_")]
    made = Figure(
        f"relief_candidates_{name}", f"Transmission error with and without relief, {name}",
        f"What each relief leaves of the transmission error at {short(at)} N, less its mean.",
    )  # fmt: skip
    panel = made.panel(_PITCH, "transmission error less its mean [µm]")
    for number, key in enumerate(candidates):
        values = {"$": "centred", "of": column(harris, key, {"total_load": at})}
        panel.line(harris, "x", values, _words(key), number, where={"total_load": at})
    yield made
    made = Figure(
        f"harris_map_{name}", f"Harris map of {name}",
        "Transmission error over the mesh cycle for a family of loads; the menu chooses the relief.",
    )  # fmt: skip
    panel = made.panel(_PITCH, _TE)
    shown = few(loads, (at,))
    entries = []
    for key in candidates:
        curves = [
            panel.line(harris, "x", key, f"{short(load)} N", where={"total_load": load}, colour=colour, dash="solid",
                       legendgroup=f"{key} {load}", showlegend=True)
            for load, colour in zip(shown, ramp(len(shown)), strict=True)
        ]  # fmt: skip
        entries.append((_words(key), curves))
    for label, curves in entries:
        made.choose(label, curves)
    yield made


def _words(key: str) -> str:
    return key.removeprefix("te_").replace("_", " ")


def chart(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe A_e over amount and length of tip relief, one load at a time, with the best length."""
    name = task.subject
    table, best = table_named(outcome, f"relief_chart_{name}"), table_named(outcome, f"relief_optimum_{name}")
    if table is None or len(cells(table, "amount")) < 2 or len(cells(table, "length")) < 2:
        return
    made = Figure(
        f"relief_chart_{name}", f"Chart of tip reliefs of {name}",
        "Effective transmission error with equal tip relief on both gears; points: the length with the least error for "
        "each amount. The menu chooses the load.",
    )  # fmt: skip
    panel = made.panel("length of tip relief (1: tip to HPSTC)", "amount at both tips [µm]")
    entries = []
    for load in cells(table, "total_load"):
        where = {"total_load": load}
        traces = [panel.heat(table, "length", "amount", "te_effective", "effective error [µm]", where)]
        if best is not None:
            traces.append(
                panel.add(
                    "best length", column(best, "length_effective", where), column(best, "amount", where),
                    mode="lines+markers", showlegend=False, line={"color": "#ffffff"}, marker={"size": 5},
                    hovertemplate="best length %{x:.3~g} at %{y:.3~g} µm<extra></extra>",
                )
            )  # fmt: skip
        entries.append((f"{short(load)} N", traces))
    for label, traces in entries:
        made.choose(label, traces)
    made.shared = False
    yield made


def robustness(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the worst and the least excitation of every candidate over the load."""
    table = outcome.tables[0]
    value = table.columns[-1]
    made = Figure(
        f"robustness_{task.subject}", f"Robustness of the reliefs of {task.subject}",
        "Worst (marked) and least of all combinations of spacing error and relief tolerance, over the load.",
    )  # fmt: skip
    panel = made.panel("load over design load", f"{value.name.replace('_', ' ')} [µm]", zero=True)
    for number, candidate in enumerate(cells(table, "candidate")):
        where = {"candidate": candidate}
        keys = column(table, "load_factor", where)
        for how in ("max", "min"):
            reduced = {"$": "by", "key": keys, "values": column(table, value.name, where), "how": how}
            look = {"mode": "lines+markers", "marker": {"symbol": SYMBOLS[number % 6]}} if how == "max" else {}
            panel.add(
                candidate, {"$": "unique", "of": keys}, reduced,
                line={"color": COLOURS[number % 6], "dash": DASHES[number % 6], "width": 1 + (how == "max")}, **look,
            )  # fmt: skip
    yield made
