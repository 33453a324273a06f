"""Stage ``shaft-deflection``: shafts bent by all meshes, forces and lives of bearings, misalignment of each mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.shafts import deflected, shaft_inputs, tilt_of
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import Curve
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Stage
from fegear.engine.table import Column, Table
from fegear.results import forecasts
from fegear.shafts.rolling_bearing import RollingBearing

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.built.shafts import ShaftInputs
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.shafts.life import LifeRating
    from fegear.shafts.solution import Deflection

#: Places along a shaft that are shown besides its gears, bearings and steps.
_PLACES = 101


@dataclass(frozen=True)
class DeflectionInputs:
    """Shafts and the ratings of their bearings' lives, in the order of shafts and bearings."""

    asked: ShaftInputs
    bearings: tuple[tuple[str, ...], ...]
    lives: tuple[tuple[LifeRating | None, ...], ...]


@dataclass(frozen=True)
class DeflectionData:
    """Shafts in equilibrium by name, and tilts of each mesh (in plane, across, wind-up): all, by rigid shafts."""

    bent: dict[str, Deflection]
    tilts: Array
    by_bearings: Array


def shafts_of(scene: Scene) -> tuple[str, ...]:
    """One solution for all shafts of a case."""
    return ("all",) if scene.case.shaft else ()


def _inputs(scene: Scene, _name: str) -> DeflectionInputs:
    asked = shaft_inputs(scene)
    names = [tuple(one.bearing for one in part.bearings) for part in scene.case.shaft.values()]
    lives = [tuple(life.build() if (life := scene.case.bearing[one].life) else None for one in row) for row in names]
    return DeflectionInputs(asked, tuple(names), tuple(lives))


def _compute(inputs: DeflectionInputs, _upstream: Upstream, _work: Work) -> DeflectionData:
    bent, rigid = deflected(inputs.asked)
    tilts = [np.array([tilt_of(mesh, these) for mesh in inputs.asked.meshes]).reshape(-1, 3) for these in (bent, rigid)]
    return DeflectionData(bent, tilts[0], tilts[1])


def _line(found: Deflection) -> Array:
    """Places along a shaft."""
    shaft = found.loaded.shaft
    marks = [seat.at for seat in found.loaded.seats]
    return np.unique(
        np.concatenate([np.linspace(0.0, shaft.length, _PLACES), shaft.steps, marks, found.loaded.loads_at])
    )


def _present(data: DeflectionData, inputs: DeflectionInputs) -> Outcome:
    tables, figures = [], []
    for name, found in data.bent.items():
        z = _line(found)
        u = found.at(z)
        words = (
            ("x", "um", "displacement of the axis along x"), ("y", "um", "displacement of the axis along y"),
            ("along", "um", "displacement along the axis"), ("turn_x", "arcsec", "turn of the section about x"),
            ("turn_y", "arcsec", "turn of the section about y"), ("twist", "arcsec", "twist from the left end"),
        )  # fmt: skip
        columns = [Column("z", z, "mm", "from the left end of the shaft")]
        columns += [Column(key, u[:, n], unit, meaning) for n, (key, unit, meaning) in enumerate(words)]
        tables.append(Table(f"shaft_deflection_{name}", tuple(columns), f"Deflection of shaft {name}"))
        curves = tuple(
            Curve(z * 1e3, u[:, n] * 1e6, key, f"series:{n}", markers=False) for n, key in enumerate(("x", "y"))
        )
        figures.append(Figure(
            f"shaft_deflection_{name}", f"Deflection of shaft {name}",
            f"Shaft {name}: displacement of its axis along x and y under the forces of all meshes.",
            (Panel(Axis("z", "mm"), Axis("displacement of the axis", "um"), curves),),
        ))  # fmt: skip
    tables.append(_bearings(data, inputs))
    values = []
    if inputs.asked.meshes:
        tables.append(_meshes(data, inputs))
        for mesh, tilt in zip(inputs.asked.meshes, _in_plane_of_action(data.tilts, inputs), strict=True):
            values.append(Value(
                f"{mesh.pair}.shaft_misalignment", float(tilt) * mesh.found.face_width, "um",
                meaning="over the face in the plane of action, by shafts, bearings and housing",
            ))  # fmt: skip
    return Outcome(data, tuple(tables), tuple(values), {}, tuple(_remarks(inputs)), tuple(figures))


def _remarks(inputs: DeflectionInputs) -> list[str]:
    """What the model neglects, and what is not from a print at hand."""
    said = ["Shafts: mesh forces act in the middle of the faces, and gear bodies do not stiffen their shafts."]
    if inputs.asked.meshes:
        said.append(
            "Shafts: these tilts do not enter load distribution, rating and transmission error; what is misaligned "
            "there is what line_error gives."
        )
    seats = [seat.bearing for shaft in inputs.asked.shafts for seat in shaft.seats]
    if any(isinstance(one, RollingBearing) and one.kind == "roller" for one in seats):
        said.append("Shafts: the law of roller contacts (ISO/TS 16281) is recalled, not compared with the standard.")
    return said


def _in_plane_of_action(tilts: Array, inputs: DeflectionInputs) -> Array:
    angles = np.array([mesh.found.working_pressure_angle for mesh in inputs.asked.meshes])
    return np.asarray(tilts[:, 0] * np.sin(angles) + tilts[:, 1] * np.cos(angles) + tilts[:, 2])


def _bearings(data: DeflectionData, inputs: DeflectionInputs) -> Table:
    shaft, bearing, rows = [], [], []
    for (name, found), names, lives in zip(data.bent.items(), inputs.bearings, inputs.lives, strict=True):
        for n, (seat, one, life) in enumerate(zip(found.loaded.seats, names, lives, strict=True)):
            force, ring = found.bearing_forces[n], found.rings[n]
            radial = float(np.hypot(force[0], force[1]))
            turns = math.nan if life is None else life.revolutions(radial, float(force[2]))
            shaft.append(name)
            bearing.append(one)
            rows.append(
                (seat.at, *force[:3], radial, math.hypot(ring[0], ring[1]), math.hypot(ring[3], ring[4]), turns)
            )
    words = (
        ("at", "mm", "place of the bearing from the left end"),
        ("force_x", "N", "of the bearing on the shaft, along x"),
        ("force_y", "N", "of the bearing on the shaft, along y"), ("force_axial", "N", "of the bearing on the shaft"),
        ("force_radial", "N", "of the bearing, across the axis"), ("shift", "um", "of the shaft in its seat"),
        ("tilt", "arcsec", "of the shaft in its seat"), ("life", "", "basic rating life L_10 in revolutions (ISO 281)"),
    )  # fmt: skip
    found_rows = np.array(rows)
    return Table(
        "bearing_forces",
        (Column("shaft", np.array(shaft), "", "name of the shaft"),
         Column("bearing", np.array(bearing), "", "its name"),
         *(Column(key, found_rows[:, n], unit, meaning) for n, (key, unit, meaning) in enumerate(words))),
        "Forces and lives of the bearings",
    )  # fmt: skip


def _meshes(data: DeflectionData, inputs: DeflectionInputs) -> Table:
    meshes = inputs.asked.meshes
    columns = [Column("pair", np.array([mesh.pair for mesh in meshes]), "", "name of the pair")]
    causes = (("bearings", data.by_bearings), ("bending", data.tilts - data.by_bearings))
    for n, (key, meaning) in enumerate((("in_plane", "of the axes, apart toward +z"), ("out_of_plane", "across it"))):
        columns.append(
            Column(key, data.tilts[:, n], "arcsec", f"tilt in the plane {meaning}" if not n else "tilt " + meaning)
        )
        columns += [
            Column(
                f"{key}_{cause}", tilts[:, n], "arcsec", f"share of {'bearings and housing' if not m else 'the shafts'}"
            )
            for m, (cause, tilts) in enumerate(causes)
        ]
    columns.append(Column("wind_up", data.tilts[:, 2], "arcsec", "twist of both gears in the plane of action"))
    width = np.array([mesh.found.face_width for mesh in meshes])
    columns.append(Column("over_face", _in_plane_of_action(data.tilts, inputs) * width, "um", "in the plane of action"))
    return Table("misalignment", tuple(columns), "Misalignment of the meshes by cause")


SHAFT_DEFLECTION = Stage(
    subjects=shafts_of,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    cites=citing(Citation("cowper", "shear coefficient of hollow circles")),
    forecast=lambda _scene, _name: forecasts.constant(0.05),
    internal=True,
)
