"""What moves: the train of a scene at a speed, with the effects that the scene calls for."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fegear.case.dynamics import FrictionPart
    from fegear.case.reading import Scene
    from fegear.dynamics.excitation import MeshExcitation
    from fegear.dynamics.gear_train import GearTrain
    from fegear.dynamics.motion_model import MotionModel

    Array = NDArray[np.float64]


def in_time(scene: Scene) -> bool:
    """Whether the motion is computed in time: an effect calls for it that the linearised train does not know."""
    effects = scene.case.effects
    return effects.contact_loss or effects.parametric or effects.friction


def _coefficient(part: FrictionPart, width: float) -> Callable[[Array, Array, Array], Array]:
    from fegear.dynamics.friction import benedict_kelley, buckingham

    if part.law == "buckingham":
        return lambda sliding, _rolling, _force: buckingham(sliding)
    if part.law == "constant":
        return lambda sliding, _rolling, _force: np.full(np.shape(sliding), part.coefficient or 0.0)
    viscosity = part.viscosity or 0.0
    return lambda sliding, rolling, force: benedict_kelley(np.asarray(force) / width, viscosity, sliding, rolling)


def excitations_at(scene: Scene, data: GearTrain, speed: float) -> tuple[MeshExcitation, ...]:
    """What the scene's effects leave of each mesh, at a speed of the first body [rad/s] (friction depends on it)."""
    from fegear.dynamics.excitation import MeshExcitation
    from fegear.dynamics.friction import with_friction
    from fegear.dynamics.periodic import Periodic

    effects = scene.case.effects
    found = []
    frequencies = data.train.mesh_frequencies(speed)
    for mesh, one, frequency in zip(data.train.meshes, data.meshes, frequencies, strict=True):
        excitation = one.excitation
        if not effects.parametric:
            # Mark's (2.9b): constant stiffness, all fluctuation in the transmission error
            flat = MeshExcitation.from_mesh(Periodic.constant(mesh.stiffness), one.error.plus(-one.error.mean))
            found.append(replace(flat, phase=excitation.phase, parting=effects.contact_loss))
            continue
        if not effects.contact_loss:
            excitation = excitation.never_parting(one.force)
        if effects.friction:
            width = min(one.pair.driver.face_width, one.pair.driven.face_width)
            excitation = with_friction(
                excitation, mesh, one.pair.base_pitch, one.pair.working_pressure_angle, float(frequency), one.force,
                _coefficient(scene.case.dynamics.friction, width), a_drives=one.a_drives,
            )  # fmt: skip
        found.append(excitation)
    return tuple(found)


def motion_model(scene: Scene, data: GearTrain, speed: float) -> MotionModel:
    """The train at a speed of the first body [rad/s] with the scene's effects."""
    from fegear.dynamics.motion_model import MotionModel

    taken_by = scene.case.dynamics.loss_taken_by or (scene.case.train and scene.case.train.balance) or ""
    return MotionModel(data.train, excitations_at(scene, data, speed), speed, taken_by)
