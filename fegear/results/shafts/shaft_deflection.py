"""Result ``shaft-deflection``: how the shafts bend under all meshes, forces and lives of their bearings."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, columns_of, curve_of, stacked
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage
from fegear.engine.table import Column, Table
from fegear.results import forecasts
from fegear.results.shafts.loaded_shafts import LOADED_SHAFTS_TASK, loaded_shafts, shafts_of
from fegear.shafts.solution import BearingLoads

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.wide.on_shafts import LoadedShafts
    from fegear.engine.stage import Upstream, Work
    from fegear.shafts.life import LifeRating


@dataclass(frozen=True)
class DeflectionInputs:
    """Names of the bearings and ratings of their lives, in the order of shafts and bearings."""

    bearings: tuple[tuple[str, ...], ...]
    lives: tuple[tuple[LifeRating | None, ...], ...]


def _inputs(scene: Scene, _name: str) -> DeflectionInputs:
    names = tuple(tuple(one.bearing for one in part.bearings) for part in scene.case.shaft.values())
    known = scene.case.bearing
    lives = tuple(tuple(life.build() if (life := known[one].life) else None for one in row) for row in names)
    return DeflectionInputs(names, lives)


def _compute(_inputs: DeflectionInputs, upstream: Upstream, _work: Work) -> LoadedShafts:
    return loaded_shafts(upstream)


def _present(data: LoadedShafts, inputs: DeflectionInputs) -> Outcome:
    tables, figures, loads = [], [], []
    for name, bent, lives in zip(data.gearbox.names, data.nominal.bent, inputs.lives, strict=True):
        line = bent.line
        tables.append(Table(
            f"shaft_deflection_{name}",
            columns_of(line, "z", "x", "y", "along", "turn_x", "turn_y", "twist"), f"Deflection of shaft {name}",
        ))  # fmt: skip
        curves = tuple(
            replace(curve_of(line, "z", key, key, f"series:{n}"), markers=False) for n, key in enumerate(("x", "y"))
        )
        figures.append(Figure(
            f"shaft_deflection_{name}", f"Deflection of shaft {name}",
            f"Shaft {name}: displacement of its axis along x and y under the forces of all meshes.",
            (Panel(axis_of(line, "z"), axis_of(line, "x", "displacement of the axis"), curves),),
        ))  # fmt: skip
        loads.append(bent.bearing_loads(lives))
    tables.append(_bearings(data, inputs, loads))
    return Outcome(data, tuple(tables), (), {}, (), tuple(figures))


def _bearings(data: LoadedShafts, inputs: DeflectionInputs, loads: list[BearingLoads]) -> Table:
    keys = tuple(BearingLoads.__dataclass_fields__)
    on = [name for name, row in zip(data.gearbox.names, inputs.bearings, strict=True) for _ in row]
    return Table(
        "bearing_forces",
        (Column("shaft", np.array(on), "", "name of the shaft"),
         Column("bearing", np.array([name for row in inputs.bearings for name in row]), "", "its name"),
         *stacked([columns_of(one, *keys) for one in loads])),
        "Forces and lives of the bearings",
    )  # fmt: skip


SHAFT_DEFLECTION = Stage(
    subjects=shafts_of,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    needs=lambda _scene, _name: (LOADED_SHAFTS_TASK,),
    cites=citing(Citation("cowper", "shear coefficient of hollow circles")),
    forecast=lambda _scene, _name: forecasts.constant(0.01),
    internal=True,
)
