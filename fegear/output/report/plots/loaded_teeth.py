"""Figures of a loaded pair: load sharing, transmission error, harmonics, root stress through the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.output.report.figure import COLOURS, DASHES, Figure, column, has, ramp
from fegear.output.report.plots.common import cells, few, short, table_named

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.outcome import Outcome, Table
    from fegear.engine.stage import Task

    Rows = dict[str, object]

_X = "position on the line of action from the pitch point [mm]"
_PITCH = "roll position over one base pitch [mm]"
#: Harmonics that are worth a bar.
_BARS = 24


def _by_load(one: Table, several: Table | None) -> list[tuple[Table, Rows, str, str]]:
    """Table, rows, label and colour for each load that is drawn."""
    if several is None:
        return [(one, {}, "", COLOURS[0])]
    loads = few(cells(several, "total_load"))
    return [
        (several, {"total_load": load}, f"{short(load)} N", colour)
        for load, colour in zip(loads, ramp(len(loads)), strict=True)
    ]


def load_sharing(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe load and pressure of one tooth pair from its first to its last contact."""
    name = task.subject
    one, several = table_named(outcome, f"load_sharing_{name}"), table_named(outcome, f"load_sharing_loads_{name}")
    if one is None:
        return
    made = Figure(
        f"load_sharing_{name}",
        f"Load on a tooth pair of {name}",
        "One tooth pair from its first to its last contact: load, largest Hertzian pressure.",
    )
    top, bottom = made.panel(_X, "load on the pair [N]", zero=True), made.panel(_X, "pressure [MPa]", zero=True)
    for table, rows, label, colour in _by_load(one, several):
        error = "load_error" if has(table, "load_error") else None
        top.line(table, "x", "load", label or "load", where=rows, colour=colour, dash="solid", error=error)
        bottom.line(table, "x", "hertz_pressure", label or "pressure", where=rows, colour=colour, dash="solid")
    yield made


def transmission_error(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe transmission error and mesh stiffness over one base pitch, and the harmonics."""
    name = task.subject
    one = table_named(outcome, f"transmission_error_{name}")
    several = table_named(outcome, f"transmission_error_loads_{name}")
    if one is None:
        return
    made = Figure(
        f"transmission_error_{name}",
        f"Transmission error of {name}",
        "Loaded transmission error over one base pitch, for every load of the case, and the mesh stiffness at the "
        "nominal load.",
    )
    top = made.panel(_PITCH, "transmission error [µm]")
    for table, rows, label, colour in _by_load(one, several):
        top.line(table, "x", "te", label or "transmission error", where=rows, colour=colour, dash="solid")
    bottom = made.panel(_PITCH, "mesh stiffness [N/µm]", zero=True)
    bottom.line(one, "x", "mesh_stiffness", "secant stiffness", 0)
    bottom.line(one, "x", "local_stiffness", "local slope", 1)
    yield made
    for start, title, x in (
        ("transmission_error_harmonics", "Harmonics", "harmonic of the tooth-mesh frequency"),
        ("transmission_error_rotational", "Rotational harmonics", "frequency over the tooth-mesh frequency"),
    ):
        harmonics = table_named(outcome, f"{start}_{name}")
        if harmonics is None:
            continue
        made = Figure(
            harmonics.name, f"{title} of the transmission error of {name}", "Amplitudes, 0-peak, of the nominal load."
        )
        rotational = has(harmonics, "mesh_order")
        panel = made.panel(x, "amplitude [µm, 0-peak]")
        where: Rows = {} if rotational else {"n": ("max", _BARS)}
        error = {}
        if has(harmonics, "amplitude_error"):
            error = {"error_y": {"type": "data", "array": column(harmonics, "amplitude_error", where), "thickness": 1}}
        panel.bars(harmonics, "mesh_order" if rotational else "n", "amplitude", "amplitude", "@blue", where, **error)
        yield made


def root_stress_history(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the root stress of a tooth of either gear on its way through the mesh."""
    made = Figure(
        f"root_stress_history_{task.subject}",
        f"Root stress through the mesh, {task.subject}",
        "Fillet stress of one tooth of either gear at the nominal load: its own load's and its neighbours' added.",
    )
    panel = made.panel("position of the tooth's contact on the line of action [mm]", "largest root stress [MPa]")
    panel.mark("y", 0.0)
    for number, table in enumerate(outcome.tables):
        member, dash = ("driver", "driven")[number % 2], DASHES[number % 2]
        colours = ((3, 4), (0, 2))[number % 2]
        panel.line(table, "x", "stress", f"{member}, tension", colours[0], error="stress_error", dash=dash)
        panel.line(table, "x", "compression", f"{member}, compression", colours[1], dash=dash)
    yield made
