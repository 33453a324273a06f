"""Stage ``gear-train``: the train of the case with the stiffness and transmission error of its gear pairs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.dynamics.gear_train import GearTrain
from fegear.dynamics.matrices import static_forces
from fegear.dynamics.train_mesh import TrainMesh, a_drives
from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Forecast, Stage, Task
from fegear.models.pair_checks import check_relief
from fegear.models.train import build_train, check_train, train_part
from fegear.results import forecasts
from fegear.results.loaded_pair import EFFECTS, loaded_pair

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.dynamics.excitation import MeshExcitation
    from fegear.engine.stage import Done, Progress


#: One mesh as springs [s]: tooth pairs that stand alone, and pairs that share.
_ALONE, _SHARED = 0.05, 0.6


def the_train(scene: Scene) -> tuple[str, ...]:
    """The one train of a case that has one."""
    return () if scene.case.train is None else ("",)


def needs_train(_scene: Scene, _subject: str) -> tuple[Task, ...]:
    """The task of this stage."""
    return (Task("gear-train"),)


def gear_train(upstream: Mapping[Task, object]) -> GearTrain:
    """What this stage computed."""
    found = upstream[Task("gear-train")]
    return cast("GearTrain", getattr(found, "data", found))


def _needs(scene: Scene, _subject: str) -> tuple[Task, ...]:
    part = train_part(scene)
    return tuple(Task("loaded-pair", name) for name in dict.fromkeys(part.loaded_pair_of(mesh) for mesh in part.mesh))


def _check(scene: Scene, _subject: str) -> None:
    check_train(scene)
    part = train_part(scene)
    for name in dict.fromkeys(part.loaded_pair_of(mesh) for mesh in part.mesh):
        check_relief(scene, name)


def assemble(scene: Scene, excitations: dict[str, MeshExcitation]) -> GearTrain:
    """Put excitations, by mesh, into the train."""
    part = train_part(scene)
    train = build_train(scene, {name: 1.0 / found.mean_compliance() for name, found in excitations.items()})
    meshes = []
    for (name, found), force, forward in zip(excitations.items(), static_forces(train), a_drives(train), strict=True):
        pair = scene.pairs[part.pair_of(name)]
        meshes.append(TrainMesh.under(pair if forward else pair.reversed(), found, float(force), a_drives=forward))
    speed_of = scene.case.dynamics.speed_of or train.bodies[0].name
    return GearTrain(train, tuple(meshes), abs(float(train.ratios[train.dof[speed_of]])), speed_of)


def _run(scene: Scene, _subject: str, done: Done, progress: Progress) -> Outcome:
    from fegear.dynamics.mesh_excitation import mesh_excitation

    part, train = train_part(scene), build_train(scene)
    forces, forward = static_forces(train), a_drives(train)
    excitations: dict[str, MeshExcitation] = {}
    remarks: list[str] = []
    for number, (name, mesh) in enumerate(part.mesh.items()):
        loaded = loaded_pair(done, part.loaded_pair_of(name))
        width = mesh.like.width_ratio if mesh.like else 1.0
        engagement = loaded.engagement.unmodified() if mesh.like else loaded.engagement
        found = mesh_excitation(
            engagement if forward[number] else engagement.reversed(),
            abs(float(forces[number])) / width or loaded.nominal,
        )
        excitations[name] = replace(found.widened(width), phase=mesh.phase)
        if not forward[number]:
            remarks.append(
                f"Mesh {name}: the torques make {mesh.driven} drive {mesh.driver}, so x counts toward the tip of the "
                f"gear of {mesh.driven}."
            )
        if not found.slotted:
            remarks.append(f"Mesh {name}: coupled teeth and contacts off the path are linear about the mean load.")
        if mesh.like is None and loaded.engagement.cycles > 1:
            remarks.append(
                f"Mesh {name}: its excitation repeats after {loaded.engagement.cycles} base pitches (spacing errors)."
            )
        progress((number + 1) / len(part.mesh))
    data = assemble(scene, excitations)
    values: list[Value] = []
    for mesh_, force, error in zip(data.train.meshes, data.forces, data.errors, strict=True):
        name = mesh_.name
        s = np.linspace(0.0, 1.0, 2001)
        values += [
            Value(f"{name}.mean_force", float(force), "N", None, "along the line of action, from the torques"),
            Value(f"{name}.mean_stiffness", mesh_.stiffness, "N/um", None, "1 over the mean compliance"),
            Value(f"{name}.static_te_peak_to_peak", float(np.ptp(error(s))), "um", None, "under the mean force"),
        ]
    settings: dict[str, object] = {body.name: body.inertia for body in data.train.bodies}
    return Outcome(data, (), tuple(values), {"inertia": settings}, tuple(remarks))


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """Springs of every mesh."""
    effects, count = scene.case.effects, len(scene.case.train.mesh) if scene.case.train else 0
    each = _SHARED if effects.corner_contact or effects.neighbour_coupling else _ALONE
    return forecasts.constant(each * count)


#: What every result of a train rests on.
TRAIN_SOURCES = citing(
    Citation("mark", "gear train of rotors, shafts and meshes", "section 2"),
    Citation("lin-huston-coy", "four-inertia model, damping", "Eqs. 1 to 4 and 16"),
)


GEAR_TRAIN = Stage(
    name="gear-train",
    title="Gear train",
    results=("gear-train",),
    subjects=the_train,
    run=_run,
    needs=_needs,
    check=_check,
    effects=EFFECTS,
    cites=TRAIN_SOURCES,
    forecast=_forecast,
)
