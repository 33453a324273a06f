"""The page of a sweep: every value over the axes, the table, and the failures with their reasons."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.output.report.blocks import DataTable, Facts, Grid, Notes, Paragraph, Plot
from fegear.output.report.figure import COLOURS, DASHES, Figure, column, has, ramp
from fegear.output.report.numbers import plain_number, pretty_unit
from fegear.output.report.page import Page, Section, write_page
from fegear.output.report.plots.common import cells, few

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.engine.outcome import Table
    from fegear.output.sweep_dataset import Swept
    from fegear.studies.axis import Axis
    from fegear.studies.sweep import SweepResults

    Array = NDArray[np.float64]

#: Values that vary by less than this share of their size do not vary.
_ROUND_OFF = 1e-12
#: Ranges of colour of parallel coordinates.
_LEVELS = 6
#: Parallel coordinates with more values than this cannot be read.
_MOST_COORDINATES = 8
_MENU = "The menu chooses the value; failed points are gaps."


def axis_head(axis: Axis) -> str:
    """Head of an axis's column in the table of the sweep."""
    return f"{axis.key} [{axis.unit}]" if axis.unit else axis.key


def axis_title(axis: Axis) -> str:
    """Title of an axis in a picture."""
    return f"{axis.key} [{pretty_unit(axis.unit)}]" if axis.unit else axis.key


def is_geometric(axis: Axis) -> bool:
    """Whether the values grow by a constant factor, so that a logarithmic scale spaces them evenly."""
    values = np.array(axis.numbers or ())
    if values.size < 3 or values.min() <= 0.0:
        return False
    steps, differences = np.diff(np.log(values)), np.diff(values)
    return bool(np.ptp(steps) < 1e-6 * abs(steps[0]) and np.ptp(differences) > 1e-6 * abs(differences[0]))


def varying(swept: Sequence[Swept]) -> list[Swept]:
    """The values that differ between points; the others need no picture."""

    def moves(number: Array) -> bool:
        found = number[np.isfinite(number)]
        return found.size > 1 and float(np.ptp(found)) > _ROUND_OFF * float(np.abs(found).max())

    return [one for one in swept if moves(one.number)]


def _title(one: Swept) -> str:
    return f"{one.name} [{pretty_unit(one.unit)}]" if one.unit else one.name


def _long(results: SweepResults) -> tuple[Axis, ...]:
    """Axes with more than one value."""
    return tuple(axis for axis in results.axes if len(axis) > 1)


def _curves(results: SweepResults, table: Table, swept: Sequence[Swept]) -> Figure:
    """Every value over the longest numeric axis, one curve for each value of the other axis."""
    axes = sorted(_long(results), key=lambda axis: (axis.numbers is not None, len(axis)), reverse=True)
    along, others = axes[0], axes[1:]
    made = Figure("sweep_curves", f"Values over {along.key}", _MENU)
    panel = made.panel(axis_title(along), _title(swept[0]), log_x=is_geometric(along), categories=along.numbers is None)
    x = axis_head(along)
    entries = []
    for one in swept:
        look: dict[str, Any] = {"mode": "lines+markers" if len(along) < 40 and along.numbers is not None else "lines"}
        if along.numbers is None:
            look = {"mode": "markers"}
        if not others:
            band = one.error_head if has(table, one.error_head) else None
            sure = " ± %{customdata:.1~e}" if band else ""
            look["hovertemplate"] = f"%{{y:.6~g}}{sure} {pretty_unit(one.unit)}".rstrip()
            first = len(panel.traces)
            panel.line(table, x, one.head, one.name, error=band, colour=COLOURS[0], dash="solid", **look)
            entries.append(panel.traces[first:])
            continue
        heads = few(cells(table, axis_head(others[0])))
        colours = ramp(len(heads)) if others[0].numbers is not None else list(COLOURS)
        entries.append([
            panel.line(
                table, x, one.head, f"{others[0].key.rsplit('.', 1)[-1]} {cell} {pretty_unit(others[0].unit)}".rstrip(),
                where={axis_head(others[0]): cell}, colour=colours[i % len(colours)],
                dash="solid" if others[0].numbers is not None else DASHES[i % 6],
                legendgroup=f"{one.name} {cell}", showlegend=True, **look,
            )
            for i, cell in enumerate(heads)
        ])  # fmt: skip
    for one, traces in zip(swept, entries, strict=True):
        made.choose(one.name, traces, _title(one))
    made.shared = along.numbers is not None
    return made


def _map(results: SweepResults, table: Table, swept: Sequence[Swept]) -> Figure:
    """Every value over two axes as a heat map."""
    across, up = _long(results)
    made = Figure("sweep_map", f"Values over {across.key} and {up.key}", _MENU)
    panel = made.panel(axis_title(across), axis_title(up), log_x=is_geometric(across), log_y=is_geometric(up))
    traces = [panel.heat(table, axis_head(across), axis_head(up), one.head, _title(one)) for one in swept]
    for one, trace in zip(swept, traces, strict=True):
        made.choose(one.name, [trace])
    made.shared = False
    return made


def _coordinate(label: str, head: str, numbers: Array | None, names: Sequence[object] = ()) -> dict[str, Any]:
    """One upright of parallel coordinates: which column, and what its ends are."""
    if numbers is None:
        return {"label": label, "head": head, "names": [str(name) for name in names]}
    found = numbers[np.isfinite(numbers)]
    return {"label": label, "head": head, "low": float(found.min()), "high": float(found.max())}


def _parallel(results: SweepResults, table: Table, swept: Sequence[Swept]) -> Figure:
    """Every point as a line through its place and its values, coloured by the value that the menu chooses.

    plotly has a trace of its own for this, but it needs WebGL, which many machines lack or refuse.
    """
    made = Figure(
        "sweep_coordinates", "All points at a glance",
        "Each line is a point of the sweep, from its place to its values, low at the bottom. The menu chooses what "
        "colours the lines; click a range in the legend to hide its points.",
    )  # fmt: skip
    panel = made.panel("", "", categories=True, bare=True)
    chosen = swept[:_MOST_COORDINATES]
    uprights = [
        _coordinate(
            axis.key.rsplit(".", 1)[-1], axis_head(axis),
            None if axis.numbers is None else np.array(axis.numbers), axis.values,
        )
        for axis in _long(results)
    ]  # fmt: skip
    uprights += [_coordinate(one.name, one.head, one.number) for one in chosen]
    labels = [u["label"] for u in uprights]
    for place, end in ((1.0, "high"), (0.0, "low")):
        told = [plain_number(u[end], 4) if end in u else u["names"][-1 if end == "high" else 0] for u in uprights]
        panel.add(
            end, labels, [place] * len(labels), mode="text", text=told, showlegend=False, hoverinfo="skip",
            textposition="top center" if end == "high" else "bottom center", cliponaxis=False,
        )  # fmt: skip
    entries = []
    for one in chosen:
        found = one.number[np.isfinite(one.number)]
        edges = np.linspace(found.min(), found.max(), _LEVELS + 1)
        traces = []
        for k, colour in enumerate(ramp(_LEVELS)):
            low, high = float(edges[k]), float(edges[k + 1])
            inside = (found >= low) & ((found < high) | (k == _LEVELS - 1))
            if not inside.any():
                continue
            top = high if k < _LEVELS - 1 else float(np.inf)
            where: dict[str, object] = {"failure": "", one.head: ("between", low if k else float(-np.inf), top)}
            lines = [u | {"values": column(table, u["head"], where)} for u in uprights]
            parts = {part: {"$": "coordinates", "of": lines, "part": part} for part in ("x", "y", "text")}
            traces.append(
                panel.add(
                    f"{plain_number(low, 3)} to {plain_number(high, 3)}", parts["x"], parts["y"], text=parts["text"],
                    line={"color": colour, "width": 1.3}, hovertemplate="%{x}: %{text}<extra></extra>",
                    legendgroup=f"{one.name} {k}", showlegend=True, opacity=0.8,
                )
            )  # fmt: skip
        entries.append(traces)
    for one, traces in zip(chosen, entries, strict=True):
        made.choose(_title(one), traces)
    made.shared = False
    return made


def _figures(results: SweepResults, table: Table, swept: Sequence[Swept]) -> list[Figure]:
    axes = _long(results)
    if not swept or not axes:
        return []
    numeric = all(axis.numbers is not None for axis in axes)
    made = []
    if len(axes) == 2 and numeric:
        made.append(_map(results, table, swept))
    if len(axes) <= 2:
        made.append(_curves(results, table, swept))
    if len(axes) + len(swept) > 2:
        made.append(_parallel(results, table, swept))
    return made


def sweep_page(results: SweepResults, table: Table, swept: Sequence[Swept], remarks: Sequence[str]) -> Page:
    """Put the page of a sweep together; equal results give equal pages, so it tells no seconds.

    Parameters
    ----------
    results : SweepResults
    table : Table
        What ``tables/sweep.csv`` holds.
    swept : sequence of Swept
        Its values.
    remarks : sequence of str
        What the points remark.
    """
    count, failed = len(results.points), len(results.failures)
    moving = varying(swept)
    level = [one for one in swept if one not in moving and np.isfinite(one.number).any()]
    constant = {
        _title(one): plain_number(float(one.number[np.isfinite(one.number)][0])) for one in level
    }  # fmt: skip
    axes = [
        (axis.key, ", ".join(str(value) for value in axis.values) if len(axis) <= 12
         else f"{axis.values[0]} to {axis.values[-1]}, {len(axis)} values")
        for axis in results.axes
    ]  # fmt: skip
    told = f"{count - failed} of {count} points have results." if failed else f"All {count} points have results."
    failures = [
        (len(group.members), group.kind, results.place(group.members[0]), group.reason) for group in results.failed()
    ]
    return Page(
        title=f"Sweep: {results.title}",
        note=f"Case {results.name} over {' and '.join(axis.key for axis in results.axes)}. {told}",
        sections=(
            Section("To know first", (Notes(remarks, "warning"),) if remarks else ()),
            Section("What was varied", (Grid(("Key", "Values"), axes), Paragraph(told))),
            Section("Values over the axes", tuple(map(Plot, _figures(results, table, moving)))),
            Section("Values that do not change", (Facts(constant),) if constant else ()),
            Section("Failures", (Grid(("Points", "Kind", "First at", "What it says"), failures),) if failures else ()),
            Section("Table", (DataTable(table),)),
        ),
        tables=(table,),
        name=f"{results.name}_sweep",
    )  # fmt: skip


def write_sweep_report(
    path: Path, results: SweepResults, table: Table, swept: Sequence[Swept], remarks: Sequence[str]
) -> None:
    """Write the page of a sweep; see `sweep_page`."""
    write_page(path, sweep_page(results, table, swept, remarks))
