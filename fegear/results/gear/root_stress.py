"""Result ``root-stress``: stress along both fillets of a gear under the load that is worst for it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, first_of_largest
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import Curve, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.results.forecasts import RING
from fegear.results.gear.drawing import deformed_figure
from fegear.results.gear.load_positions import chosen_gears

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.table import StiffnessTable

#: Line load of the deformed gear's picture when the case names none [N/m].
_USUAL_LINE_LOAD = 100e3
#: Angle of the fillet's tangent with the tooth's centre line at which ISO 6336-3 looks [deg].
_ISO_TANGENT = 30.0


def _curve_columns(influence: GearInfluence, radius: float) -> tuple[Column, ...]:
    m, at = influence.gear.module, np.array([radius])
    fillets = [influence.fine.fillets[side] for side in ("tension", "compression")]
    stress = {
        k: np.concatenate([influence.fillet_stress(k, side, at)[:, 0] for side in ("tension", "compression")])
        for k in (-1, 0, 1)
    }
    side = np.repeat(np.array(["tension", "compression"]), [fillet.arc.size for fillet in fillets])

    def both(attribute: str, scale: float) -> Array:
        return np.concatenate([getattr(fillet, attribute) for fillet in fillets]) * scale

    return (
        Column("arc", both("arc", m), "mm", "arc length along the fillet from the root land"),
        Column("side", side, "", "fillet below the loaded flank (tension) or the other one"),
        Column("radius", both("radius", m), "mm", "distance from the gear's centre"),
        Column("angle", both("angle", 1.0), "deg", "clockwise angle from the tooth's centre line"),
        Column("tangent_angle", both("tangent_angle", 1.0), "deg", "fillet tangent to tooth centre line"),
        Column("stress", stress[0], "MPa.mm/N", "tangential stress per line load on the same tooth"),
        Column("stress_prev", stress[-1], "MPa.mm/N", "the same on the tooth before the loaded one"),
        Column("stress_next", stress[1], "MPa.mm/N", "the same on the tooth after the loaded one"),
    )


@dataclass(frozen=True)
class FilletCurves:
    """Stress along both fillets under the load that gives the largest root tension.

    Parameters
    ----------
    table : StiffnessTable
    radius : float
        Of the contact [m].
    """

    table: StiffnessTable
    radius: float


@dataclass(frozen=True)
class FilletInputs:
    """What the curves read: the gear's name and the line load of the picture of the deformed gear [N/m]."""

    line_load: float = field(compare=False)
    name: str = field(compare=False)

    @classmethod
    def of(cls, scene: Scene, name: str) -> FilletInputs:
        """As `Stage.inputs`."""
        return cls(scene.case.stiffness.load or _USUAL_LINE_LOAD, name)


def _worst_load(_asked: FilletInputs, upstream: Upstream, _work: Work) -> FilletCurves:
    (table,) = upstream.values()
    return FilletCurves(table, float(table.radius[int(first_of_largest(table.root_tension))]))


def _present_curves(found: FilletCurves, asked: FilletInputs) -> Outcome:
    name, radius = asked.name, found.radius
    title = f"Root stress along the fillets of gear {name}, load at radius {radius * 1e3:.6g} mm"
    influence = found.table.influence
    table = Table(f"root_stress_{name}", _curve_columns(influence, radius), title)
    figures: tuple[Figure | DeferredFigure, ...] = (
        _fillet_figure(name, radius, table),
        DeferredFigure(
            f"deformed_{name}", f"Deformed gear {name}", partial(deformed_figure, name, influence, asked.line_load)
        ),
    )
    return Outcome(found, (table,), figures=figures)


def _fillet_figure(name: str, radius: float, table: Table) -> Figure:
    panels = []
    columns = {column.name: column.values for column in table.columns}
    for side, title in (("tension", "Fillet below the loaded flank"), ("compression", "Fillet of the other flank")):
        here = columns["side"] == side
        arc, tangent = (np.asarray(columns[key][here], dtype=float) for key in ("arc", "tangent_angle"))
        marks = [Mark("y", 0.0)]
        if tangent.min() < _ISO_TANGENT < tangent.max():
            marks.append(Mark("x", float(np.interp(-_ISO_TANGENT, -tangent, arc)), "30° tangent"))
        curves = tuple(
            Curve(arc, np.asarray(columns[key][here], dtype=float), role, role, markers=False)
            for key, role in (
                ("stress", "loaded tooth"), ("stress_next", "next tooth"), ("stress_prev", "previous tooth")
            )
        )  # fmt: skip
        axes = Axis("arc length from the root land", "mm"), Axis("tangential stress per line load", "MPa.mm/N")
        panels.append(Panel(*axes, curves, tuple(marks), title))
    return Figure(
        f"fillet_{name}",
        f"Stress along the fillets of gear {name}",
        f"Gear {name}: tangential stress along both fillets with the load at radius {radius * 1e3:.6g} mm.",
        tuple(panels),
        columns=2,
    )


ROOT_STRESS = Stage(
    subjects=chosen_gears,
    needs=lambda _scene, name: (Task("stiffness", name),),
    inputs=FilletInputs.of,
    compute=_worst_load,
    present=_present_curves,
    cites=citing(*RING, Citation("iso-6336-3", "the 30 degree tangent that the place is compared with", "clause 6")),
    forecast=lambda _scene, _name: Forecast({}, 0.01),
    internal=True,
)
