"""Stages ``natural-modes`` and ``dynamic-increments``: what the train is, before anything excites it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Stage
from fegear.results import forecasts
from fegear.results.gear_train import gear_train, needs_train, the_train

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.dynamics.modes import Campbell, Modes
    from fegear.engine.stage import Done, Progress
    from fegear.models.train import GearTrain


@dataclass(frozen=True)
class ModesData:
    """Modes, and the Campbell diagram where the case gives speeds (in rad/s of the first body)."""

    train: GearTrain
    modes: Modes
    campbell: Campbell | None


@dataclass(frozen=True)
class IncrementsData:
    """Q_ij over frequency, shape (meshes, meshes, F)."""

    train: GearTrain
    frequencies: NDArray[np.float64]
    increments: NDArray[np.complex128]


def _run_modes(scene: Scene, _subject: str, done: Done, _progress: Progress) -> Outcome:
    from fegear.dynamics.modes import campbell, modes

    data = gear_train(done)
    part, train = scene.case.dynamics, data.train
    found = modes(train)
    count = np.arange(found.frequencies.size)
    columns = [
        Column("mode", count, "", "0 is the rigid-body motion"),
        Column("frequency", found.frequencies, "Hz", "undamped, with mean mesh stiffnesses"),
    ]
    columns += [
        Column(f"energy_{mesh.name}", found.mesh_energy[:, m], "", "share of the mode's strain energy in this mesh")
        for m, mesh in enumerate(train.meshes)
    ]
    columns += [
        Column(f"shape_{body.name}", found.shapes[train.dof[body.name]], "", "rotation angle for unit modal mass")
        for body in train.bodies
    ]
    tables = [Table("natural_modes", tuple(columns), "Natural frequencies and mode shapes")]
    speeds, diagram = part.speed_values / data.speed_ratio, None
    if speeds.size:
        diagram = campbell(train, speeds, part.lines)
        rows = [
            (mesh, line, mode, diagram.critical[m, line - 1, mode - 1] * data.speed_ratio)
            for m, mesh in enumerate(data.names)
            for line in range(1, part.lines + 1)
            for mode in range(1, found.frequencies.size)
        ]
        tables.append(
            Table(
                "critical_speeds",
                (
                    Column("mesh", np.array([row[0] for row in rows], dtype=str), "", "whose harmonic it is"),
                    Column("n", np.array([row[1] for row in rows], dtype=int), "", "harmonic of the mesh frequency"),
                    Column("mode", np.array([row[2] for row in rows], dtype=int), "", "natural mode that it meets"),
                    Column(
                        "speed", np.array([row[3] for row in rows], dtype=float), "rpm", f"speed of {data.speed_of}"
                    ),
                ),
                "Speeds at which mesh harmonics meet natural frequencies",
            )
        )
    values = tuple(
        Value(f"natural_frequency_{k}", float(found.frequencies[k]), "Hz", None, "undamped") for k in count[1:]
    )
    return Outcome(ModesData(data, found, diagram), tuple(tables), values)


def _run_increments(scene: Scene, _subject: str, done: Done, _progress: Progress) -> Outcome:
    from fegear.dynamics.increments import dynamic_increments

    data = gear_train(done)
    frequencies = scene.case.dynamics.frequencies.array
    found = dynamic_increments(data.train, 2.0 * math.pi * frequencies)
    columns = [Column("frequency", frequencies, "Hz", "of the static transmission error")]
    values = []
    for i, first in enumerate(data.names):
        for j, second in enumerate(data.names):
            q, name = found[i, j], f"Q_{first}_{second}"
            meaning = f"dynamic increment of mesh {first} per static transmission error of mesh {second}"
            columns += [Column(f"{name}_re", q.real, "", meaning), Column(f"{name}_im", q.imag, "", meaning)]
            at = int(np.argmax(np.abs(q)))
            values.append(
                Value(
                    f"{name}_largest",
                    float(abs(q[at])),
                    "",
                    None,
                    f"modulus, at {frequencies[at]:.6g} Hz of those asked for",
                )
            )
    table = Table("dynamic_increments", tuple(columns), "Dynamic increment functions")
    return Outcome(IncrementsData(data, frequencies, np.asarray(found, dtype=np.complex128)), (table,), tuple(values))


NATURAL_MODES = Stage(
    name="natural-modes",
    title="Natural frequencies and Campbell diagram",
    results=("natural-modes", "campbell"),
    subjects=the_train,
    run=_run_modes,
    needs=needs_train,
    forecast=lambda _scene, _subject: forecasts.constant(0.005),
)

DYNAMIC_INCREMENTS = Stage(
    name="dynamic-increments",
    title="Dynamic increment functions",
    results=("dynamic-increments",),
    subjects=the_train,
    run=_run_increments,
    needs=needs_train,
    forecast=forecasts.dynamic_increments,
)
