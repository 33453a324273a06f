"""Figures of gear trains in motion: modes, increments, spectra, tooth forces, root stress, dynamic factor, chart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.report.figure import COLOURS, DASHES, SYMBOLS, Figure, column, has, size
from fegear.output.report.plots.common import cells, starting, table_named

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.outcome import Outcome
    from fegear.engine.stage import Task

_PLACE = "place of the tooth pair on the line of action [mm]"
#: Lines weaker than these shares of the strongest are left out of spectrum and waterfall.
_WEAKEST, _WEAKEST_OVER_SPEED = 1e-5, 1e-2


def modes(outcome: Outcome, _task: Task) -> Iterator[Figure]:
    """Describe which share of its strain energy each mode has in each mesh, and where harmonics meet modes."""
    table = table_named(outcome, "natural_modes")
    energies = [c.name for c in table.columns if c.name.startswith("energy_")] if table else []
    if table is not None and energies and len(table["mode"]) > 1:
        made = Figure(
            "natural_modes", "Natural modes",
            "Share of each mode's strain energy in the meshes; the rest is in the shafts. Mode 0, the rigid motion, is "
            "left out.",
        )  # fmt: skip
        panel = made.panel("natural frequency [Hz]", "share of strain energy", categories=True)
        where: dict[str, object] = {"mode": ("min", 1)}
        for number, name in enumerate(energies):
            label = f"mesh {name.removeprefix('energy_')}"
            panel.bars(table, "frequency", name, label, COLOURS[number % 6], where)
        yield made
    critical = table_named(outcome, "critical_speeds")
    if critical is not None and len(critical["speed"]):
        made = Figure(
            "critical_speeds", "Critical speeds",
            "Speeds at which a harmonic of a mesh frequency meets a natural frequency.",
        )  # fmt: skip
        panel = made.panel("speed [rpm]", "harmonic of the mesh frequency", log_x=True)
        for number, mesh in enumerate(cells(critical, "mesh")):
            where = {"mesh": mesh}
            panel.points(
                critical, "speed", "n", f"mesh {mesh}", number, where, customdata=column(critical, "mode", where),
                hovertemplate="harmonic %{y} meets mode %{customdata} at %{x:.5~g} rpm", marker={"size": 9},
            )  # fmt: skip
        made.shared = False
        yield made


def increments(outcome: Outcome, _task: Task) -> Iterator[Figure]:
    """Describe the size of the dynamic increment functions."""
    table = outcome.tables[0]
    names = [c.name.removesuffix("_re") for c in table.columns if c.name.endswith("_re")]
    made = Figure(
        "dynamic_increments", "Dynamic increment functions",
        "|Q|: how much the force of one mesh, over its stiffness, differs from the quasi-static one for a static "
        "transmission error of its own or of another mesh (excited mesh first).",
    )  # fmt: skip
    panel = made.panel("frequency [Hz]", "|Q|", log_x=True, log_y=True)
    for number, name in enumerate(names):
        values = size(column(table, f"{name}_re"), column(table, f"{name}_im"))
        panel.line(table, "frequency", values, name.replace("Q_", "").replace("_", " from "), number)
    yield made


def spectrum(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the line spectrum of the force in one mesh, and its lines over speed."""
    name = task.subject
    table = table_named(outcome, f"mesh_force_spectrum_{name}")
    if table is not None:
        made = Figure(table.name, f"Spectrum of the force in mesh {name}", "Harmonics by the mesh that excites them.")
        panel = made.panel("frequency [Hz]", "mesh force [N]", log_y=True)
        largest = float(np.nanmax(np.asarray(table["force"], dtype=float)))
        for number, other in enumerate(cells(table, "from_pair")):
            where: dict[str, object] = {"from_pair": other, "force": ("min", _WEAKEST * largest)}
            panel.points(
                table, "frequency", "force", f"from mesh {other}", number, where,
                stems=True, customdata=column(table, "n", where),
                hovertemplate="%{y:.4~g} N at %{x:.6~g} Hz, harmonic %{customdata}",
            )  # fmt: skip
        made.shared = False
        yield made
    over = table_named(outcome, f"mesh_force_waterfall_{name}")
    if over is not None:
        made = Figure(
            over.name, f"Waterfall of the force in mesh {name}",
            "Lines of the mesh force over speed, down to a hundredth of the strongest.",
        )  # fmt: skip
        panel = made.panel("frequency [Hz]", "speed [rpm]")
        where = {"force": ("min", _WEAKEST_OVER_SPEED * float(np.nanmax(np.asarray(over["force"], dtype=float))))}
        force = column(over, "force", where)
        panel.add(
            "force", column(over, "frequency", where), column(over, "speed", where), mode="markers", showlegend=False,
            customdata=force, hovertemplate="%{customdata:.4~g} N at %{x:.6~g} Hz, %{y:.6~g} rpm<extra></extra>",
            marker={"color": {"$": "log", "of": force}, "colorscale": "@ramp", "size": 5, "showscale": True,
                    "colorbar": {"title": {"text": "log10 of force [N]", "side": "right"}}},
        )  # fmt: skip
        made.shared = False
        yield made


def tooth_force(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the force on one tooth pair and its parts."""
    table, name = outcome.tables[0], task.subject
    others = [c.name for c in table.columns if c.name.startswith("increment_from_")]
    made = Figure(f"tooth_force_{name}", f"Force on a tooth pair of mesh {name}", "The force and its dynamic parts.")
    top = made.panel(_PLACE, "tooth force [N]")
    top.line(table, "x", "static", "static", colour="@grey", dash="dash")
    top.line(table, "x", "force", "static and own increment", 0)
    if others and has(table, "force_with_others"):
        top.line(table, "x", "force_with_others", "with the other meshes", 3, dash="dot")
    bottom = made.panel(_PLACE, "increment [N]", height=0.7)
    bottom.line(table, "x", "own_increment", f"from mesh {name}", 2, dash="solid")
    for number, other in enumerate(others):
        bottom.line(table, "x", other, f"from mesh {other.removeprefix('increment_from_')}", number + 4)
    yield made


def root_stress(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the root stress of one tooth of either gear in motion."""
    made = Figure(
        f"dynamic_root_stress_{task.subject}", f"Dynamic root stress of mesh {task.subject}",
        "Largest root tension of one tooth of either gear through its engagement, with and without vibration.",
    )  # fmt: skip
    panel = made.panel(_PLACE, "largest root tension [MPa]")
    for number, table in enumerate(starting(outcome, "root_stress_history_")):
        member, colour = ("driver", "driven")[number % 2], COLOURS[(0, 3)[number % 2]]
        panel.line(table, "x", "stress", f"{member}, dynamic", colour=colour, dash="solid")
        panel.line(table, "x", "static_stress", f"{member}, quasi-static", colour=colour, dash="dash")
    yield made


def dynamic_factor(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the dynamic factor over speed, and the share of the time without contact where there is any."""
    table = table_named(outcome, f"dynamic_factor_{task.subject}")
    if table is None or len(table["speed"]) < 2:
        return
    made = Figure(
        table.name, f"Dynamic factor of mesh {task.subject}",
        "Largest force on one tooth pair and largest mesh force, both over the mean mesh force.",
    )  # fmt: skip
    panel = made.panel("speed [rpm]", "largest over mean force")
    panel.line(table, "speed", "dynamic_factor", "tooth force", 0, mode="lines+markers", marker={"size": 4})
    panel.line(table, "speed", "mesh_force_factor", "mesh force", 2)
    for motion in cells(table, "motion"):
        if motion != "periodic":
            panel.points(table, "speed", "dynamic_factor", motion, 3, {"motion": motion}, marker={"size": 9})
    lost = [n for n in ("contact_loss_fraction", "backside_fraction") if np.asarray(table[n], dtype=float).any()]
    if lost:
        below = made.panel("speed [rpm]", "share of the time", height=0.45, zero=True)
        for number, column_name in enumerate(lost):
            label = {"contact_loss_fraction": "no contact", "backside_fraction": "on the back flanks"}[column_name]
            below.line(table, "speed", column_name, label, (1, 4)[number], dash="solid")
    yield made


def design_chart(outcome: Outcome, _task: Task) -> Iterator[Figure]:
    """Describe the largest dynamic factor and A_e over the length of relief for every amount."""
    for table in starting(outcome, "design_chart"):
        if len(cells(table, "length")) < 2:
            continue
        made = Figure(
            "design_chart", "Design chart of tip relief",
            "Largest dynamic factor over the speeds, and effective error, against the length of tip relief (1 from the "
            "tip to the highest point of single contact), by amount over Delta.",
        )  # fmt: skip
        panels = (
            (made.panel("length of relief L_n", "largest dynamic factor"), "dynamic_factor"),
            (made.panel("length of relief L_n", "effective error A_e [µm]", zero=True), "effective_error"),
        )
        for number, amount in enumerate(cells(table, "amount")):
            for panel, name in panels:
                panel.line(
                    table, "length", name, f"{amount} Delta", where={"amount": amount}, mode="lines+markers",
                    colour=COLOURS[number % 6], dash=DASHES[number // 6 % 6], marker={"symbol": SYMBOLS[number % 6]},
                )  # fmt: skip
        yield made
