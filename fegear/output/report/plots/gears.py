"""Figures of one gear: compliance, root stress, fillets, and the closed forms beside the finite elements."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.output.report.figure import COLOURS, DASHES, SYMBOLS, Figure, column
from fegear.output.report.plots.common import cells, starting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.outcome import Outcome, Table
    from fegear.engine.stage import Task
    from fegear.results.stiffness import FilletCurves

_ROLL = "roll angle of the load [°]"
_COMPLIANCE = "compliance [µm·mm/N]"
_STRESS = "stress per line load [MPa·mm/N]"


def stiffness(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe c_0 and c_1, and the largest root stresses, over the load's roll angle."""
    table, name = outcome.tables[0], task.subject
    made = Figure(
        f"compliance_{name}",
        f"Compliance of gear {name}",
        "Deflection per line load of the loaded tooth and, at the same radius, of its neighbours; whole ring. The band "
        "of the estimated error may be thinner than the line; point at a curve to read it.",
    )
    top = made.panel(_ROLL, _COMPLIANCE)
    top.line(table, "roll_angle", "c_self", "c<sub>0</sub>, loaded tooth", error="c_self_error")
    bottom = made.panel(_ROLL, _COMPLIANCE)
    bottom.line(table, "roll_angle", "c_next", "c<sub>+1</sub>, next tooth", 1, error="c_neighbour_error", dash="solid")
    bottom.line(table, "roll_angle", "c_prev", "c<sub>−1</sub>, previous tooth", 2, error="c_neighbour_error")
    yield made
    made = Figure(
        f"root_stress_{name}",
        f"Root stress of gear {name}",
        "Largest tangential stress of the fillet below the loaded flank (tension) and of the other one (compression).",
    )
    panel = made.panel(_ROLL, _STRESS)
    panel.line(table, "roll_angle", "root_tension", "tension", 3, error="root_tension_error", dash="solid")
    panel.line(table, "roll_angle", "root_compression", "compression", 0, error="root_compression_error", dash="dash")
    yield made


def fillets(outcome: Outcome, task: Task) -> Iterator[Figure]:
    """Describe the stress along both fillets for one load position."""
    table, radius = outcome.tables[0], cast("FilletCurves", outcome.data).radius * 1e3
    made = Figure(
        f"fillet_{task.subject}",
        f"Stress along the fillets of gear {task.subject}",
        f"Tangential stress with the load at radius {radius:.6g} mm, on the loaded tooth and on its neighbours.",
    )
    for side, title in (("tension", "Fillet below the loaded flank"), ("compression", "Fillet of the other flank")):
        panel = made.panel("arc length from the root land [mm]", _STRESS, title=title)
        for number, (name, label) in enumerate(
            (("stress", "loaded tooth"), ("stress_next", "next tooth"), ("stress_prev", "previous tooth"))
        ):
            panel.line(table, "arc", name, label, number, where={"side": side})
    yield made


def _family(made: Figure, table: Table, x: str, title: str, panels: tuple[tuple[str, str, str | None], ...]) -> Figure:
    """One curve for each formula in each panel, and the finite elements where the panel has them."""
    formulas = cells(table, "formula")
    for y, label, reference in panels:
        panel = made.panel(title, label)
        if reference is not None:
            panel.line(
                table, x, reference, "finite elements", where={"formula": formulas[0]}, colour="@ink", dash="solid"
            )
        for number, formula in enumerate(formulas):
            trace = panel.line(table, x, y, formula, number, where={"formula": formula}, dash=DASHES[number % 6])
            if len(table.columns[0].values) <= _FEW_ROWS * len(formulas):
                trace |= {"mode": "lines+markers", "marker": {"symbol": SYMBOLS[number % 6], "size": 6}}
        if y == "ratio_to_fe":
            panel.mark("y", 1.0, "finite elements")
    return made


#: With no more positions than this every one is marked.
_FEW_ROWS = 15


def crosscheck(outcome: Outcome, _task: Task) -> Iterator[Figure]:
    """Describe every closed form beside the finite elements."""
    for table in starting(outcome, "crosscheck_root_stress_"):
        made = Figure(table.name, table.title, "Formula beside finite elements, their ratio, and the stress's place.")
        yield _family(made, table, "roll_angle", _ROLL, (
            ("root_tension", _STRESS, "root_tension_fe"),
            ("ratio_to_fe", "formula / FE", None),
            ("place_angle", "fillet tangent to centre line [°]", "place_angle_fe"),
        ))  # fmt: skip
    for table in starting(outcome, "crosscheck_compliance_"):
        of_pair = table.columns[1].name == "x"
        x, title = ("x", "contact point from the pitch point [mm]") if of_pair else ("roll_angle", _ROLL)
        made = Figure(table.name, table.title, "Secant compliance along the line of action, and its ratio to FE.")
        yield _family(made, table, x, title, (
            ("compliance", _COMPLIANCE, "compliance_fe"), ("ratio_to_fe", "formula / FE", None),
        ))  # fmt: skip


def study(outcome: Outcome, _task: Task) -> Iterator[Figure]:
    """Describe where each root-stress formula is high or low: every gear and load position against its ratio to FE."""
    table = outcome.tables[0]
    made = Figure(
        "root_stress_ratios",
        "How far each root-stress formula is from the finite elements",
        "One point for each gear and load position; 1 agrees, above 1 is safe. Point at one to see which gear it is.",
    )
    panel = made.panel("teeth", "formula / FE", log_x=True)
    panel.mark("y", 1.0, "finite elements")
    keys = ("profile_shift", "rack_tip_radius", "load_position")
    for number, formula in enumerate(cells(table, "formula")):
        where = {"formula": formula}
        details = [column(table, key, where) for key in keys]
        told = "".join(f"<br>{key.replace('_', ' ')} %{{customdata[{i}]:.3~g}}" for i, key in enumerate(keys))
        panel.points(
            table, "teeth", "ratio_to_fe", formula, number, where,
            customdata={"$": "rows", "of": details}, hovertemplate="%{x} teeth, %{y:.3f}" + told,
        )  # fmt: skip
    made.shared = False
    yield made
    ratios = np.asarray(table["ratio_to_fe"], dtype=float)
    if np.isfinite(ratios).any():
        made = Figure(
            "root_stress_histogram", "How often each formula is how far off",
            "Share of the study's points over the ratio of formula to finite elements.",
        )  # fmt: skip
        panel = made.panel("formula / FE", "points")
        for number, formula in enumerate(cells(table, "formula")):
            where = {"formula": formula}
            panel.add(
                formula, column(table, "ratio_to_fe", where), [], type="histogram", mode=None, opacity=0.65,
                marker={"color": COLOURS[number % 6]}, xbins={"start": 0.0, "end": 2.0, "size": 0.05},
            )  # fmt: skip
        yield made
