"""Figures of closed forms beside finite elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel, Zone
from fegear.results.crosscheck_tables import COMPLIANCE, STRESS

if TYPE_CHECKING:
    from fegear.engine.outcome import Table

#: Ratios that figures shade as agreement.
_AGREEMENT = (0.95, 1.05)


def crosscheck_figure(table: Table) -> Figure:
    """Every formula of a table beside the finite elements, their ratio, and of a root stress its place."""
    shown = {column.name: column.values for column in table.columns}
    formulas = list(dict.fromkeys(str(name) for name in shown["formula"]))
    stress = "root_tension" in shown
    first = "x" if "x" in shown else "roll_angle"
    label = ("contact point from the pitch point", "mm") if first == "x" else ("roll angle of the load", "deg")

    def curves(key: str, reference: str) -> tuple[Curve, ...]:
        drawn = []
        for number, formula in enumerate(formulas):
            rows = shown["formula"] == formula
            x, y = (np.asarray(shown[k][rows], dtype=float) for k in (first, key))
            if reference and not number:
                fe = np.asarray(shown[reference][rows], dtype=float)
                drawn.append(Curve(x, fe, "finite elements", "finite elements", width=2.6))
            drawn.append(Curve(x, y, formula, f"series:{number}"))
        return tuple(drawn)

    x = Axis(*label)
    key, unit = ("root_tension", STRESS) if stress else ("compliance", COMPLIANCE)
    title = "root stress per line load" if stress else "deflection per line load"
    panels = [
        Panel(x, Axis(title, unit, zero=not stress), curves(key, f"{key}_fe"), height=1.2),
        Panel(x, Axis("formula / FE"), curves("ratio_to_fe", ""), (Zone("y", *_AGREEMENT), Mark("y", 1.0, "±5 %"))),
    ]
    if stress:
        angle = Axis("fillet tangent to centre line", "deg")
        panels.append(Panel(x, angle, curves("place_angle", "place_angle_fe")))
    silent = dict.fromkeys(str(f) for f, r in zip(shown["formula"], shown["reason"], strict=True) if r)
    out = f" Out of range at some positions (see the table's reasons): {', '.join(silent)}." if silent else ""
    what = "along the line of action (secant), and its ratio to the finite elements"
    if stress:
        what = (
            "largest fillet stress under a load normal to the flank, its ratio to the finite elements, and its place "
            "(ISO looks at 30 deg always)"
        )
    subject = table.title.split(":", maxsplit=1)[0]
    return Figure(table.name, table.title, f"{subject}: {what}.{out}", tuple(panels))
