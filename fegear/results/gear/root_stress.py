"""Result ``root-stress``: stress along both fillets of a gear under the load that is worst for it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, first_of_largest
from fegear.base.printed import figures, rounded
from fegear.base.shown import shown
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.forecasts import RING
from fegear.results.gear.load_positions import chosen_gears

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.engine.figure.figure import DeferredFigure
    from fegear.engine.figure.items import Mark
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.influence import Side
    from fegear.fem.plane.table import StiffnessTable

#: Line load of the deformed gear's picture when the case names none [N/m].
_USUAL_LINE_LOAD = 100e3
#: Angle of the fillet's tangent with the tooth's centre line at which ISO 6336-3 looks [deg].
_ISO_TANGENT = 30.0
_SIDES: tuple[Side, ...] = ("tension", "compression")


@dataclass(frozen=True)
class FilletStress:
    """Tangential stress along one fillet under a load on the tooth, and on its neighbours under the same load.

    Parameters
    ----------
    arc, radius, angle, tangent_angle : ndarray, shape (P,)
        [m], [m], [rad], [rad].
    stress, stress_prev, stress_next : ndarray, shape (P,)
        Per line load [1/m].
    side : ndarray of str, shape (P,)
    """

    arc: Array = shown("mm", "arc length along the fillet from the root land", label="arc length from the root land")
    radius: Array = shown("mm", "radius")
    angle: Array = shown("deg", "angle from the tooth centre line, clockwise")
    tangent_angle: Array = shown("deg", "angle of the fillet tangent to the tooth centre line")
    stress: Array = shown(
        "MPa.mm/N", "tangential stress per line load, load on the same tooth", label="tangential stress per line load"
    )
    stress_prev: Array = shown("MPa.mm/N", "tangential stress of the previous tooth, per line load")
    stress_next: Array = shown("MPa.mm/N", "tangential stress of the next tooth, per line load")
    side: NDArray[np.str_] = shown("", "tension side (fillet of the loaded flank) or compression side")

    @property
    def marks(self) -> tuple[Mark, ...]:
        """Zero stress, and where ISO 6336-3 looks."""
        from fegear.engine.figure.items import Mark

        tangent, arc, iso = np.rad2deg(self.tangent_angle), self.arc * 1e3, _ISO_TANGENT
        inside = tangent.min() < iso < tangent.max()
        at = (Mark("x", float(np.interp(-iso, -tangent, arc)), "30° tangent"),) if inside else ()
        return (Mark("y", 0.0), *at)


def _fillet_stress(influence: GearInfluence, side: Side, radius: float) -> FilletStress:
    fillet, m, at = influence.fine.fillets[side], influence.gear.module, np.array([radius])
    own, before, after = (influence.fillet_stress(k, side, at)[:, 0] for k in (0, -1, 1))
    name = np.repeat(np.array([side]), fillet.arc.size)
    angle, tangent = np.asarray(fillet.angle), np.asarray(fillet.tangent_angle)
    return FilletStress(fillet.arc * m, fillet.radius * m, angle, tangent, own, before, after, name)


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
    radius: float = shown("mm", "radius of the contact")

    @cached_property
    def sides(self) -> dict[Side, FilletStress]:
        """By fillet."""
        return {side: _fillet_stress(self.table.influence, side, self.radius) for side in _SIDES}


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


def _deformed(seen: Seen) -> Iterator[DeferredFigure]:
    """The gear as its load bends it."""
    from fegear.engine.figure.figure import DeferredFigure
    from fegear.results.gear.drawing import deformed_figure

    name, draw = seen.name, partial(deformed_figure, seen.name, seen.data.table.influence, seen.asked.line_load)
    yield DeferredFigure(f"deformed_{name}", f"Deformed gear {name}", draw)


def _panel(side: Side, title: str) -> Over:
    lines = (("stress", "loaded tooth"), ("stress_next", "next tooth"), ("stress_prev", "previous tooth"))
    return Over(
        "arc",
        tuple(
            Line(key, role, role, of=lambda seen: seen.data.sides[side], look={"markers": False}) for key, role in lines
        ),
        marks=lambda seen: seen.data.sides[side].marks,
        title=title,
    )


def _largest(seen: Seen) -> Iterator[str]:
    """The largest stress, and where."""
    t: StiffnessTable = seen.data.table
    i = int(first_of_largest(t.root_tension))
    size, off, at = t.root_tension[i] * 1e-3, t.errors["root_tension"][i] * 1e-3, np.rad2deg(t.root_tension_angle[i])
    yield (
        f"Gear {seen.name}: root tension is largest, {rounded(size, off)} MPa mm/N, with the load at radius "
        f"{figures(t.radius[i] * 1e3)} mm."
    )
    yield (
        f"Gear {seen.name}: there the fillet's tangent is at {figures(at, 2)}° to the tooth centre line (ISO 6336-3 "
        "assumes 30°)."
    )


_SHEET = Sheet(
    tables=(
        Rows(
            "root_stress_{name}", "Root stress along the fillets of gear {name}, load at radius {d.radius:.6g}",
            ("arc", "side", "radius", "angle", "tangent_angle", "stress", "stress_prev", "stress_next"),
            stacked="sides",
        ),
    ),
    figures=(
        Chart(
            "fillet_{name}", "Stress along the fillets of gear {name}",
            "Gear {name}: tangential stress along both fillets with the load at radius {d.radius:.6g}.",
            (_panel("tension", "Fillet of the loaded flank (tension side)"), _panel("compression",
                "Opposite fillet (compression side)")),
            of="sides.tension", columns=2,
        ),
        _deformed,
    ),
    answer=Answer(_largest, figure="fillet_{name}"),
)  # fmt: skip


ROOT_STRESS = Stage(
    subjects=chosen_gears,
    needs=lambda _scene, name: (Task("stiffness", name),),
    inputs=FilletInputs.of,
    compute=_worst_load,
    present=_SHEET.present,
    cites=citing(*RING, Citation("iso-6336-3", "30 degree tangent for comparison of the position", "clause 6")),
    forecast=lambda _scene, _name: Forecast({}, 0.01),
)
