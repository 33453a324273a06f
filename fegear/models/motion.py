"""What moves: a train at a speed, with the effects that its case calls for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.arrays import Array
    from fegear.case.dynamics import FrictionPart
    from fegear.case.reading import Scene
    from fegear.dynamics.charts import Direction
    from fegear.dynamics.excitation import MeshExcitation
    from fegear.dynamics.gear_train import GearTrain
    from fegear.dynamics.motion_model import MotionModel
    from fegear.dynamics.steady_state import SteadyState
    from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class MotionInputs:
    """What the motion of a train depends on besides the train.

    Parameters
    ----------
    contact_loss, parametric, friction : bool
        Effects that are on.
    law : FrictionPart
    taken_by : str
        Body that takes what friction loses; empty where nothing is said.
    direction : {"up", "down", "static", "rest"}
        How speeds are gone through, and from what each motion starts.
    tolerance : float
    speeds : ndarray
        Of the body that speeds refer to [rad/s].
    """

    contact_loss: bool
    parametric: bool
    friction: bool
    law: FrictionPart
    taken_by: str
    direction: Direction
    tolerance: float
    speeds: Array

    @property
    def in_time(self) -> bool:
        """Whether it is computed in time: an effect calls for it that the linearised train does not know."""
        return self.contact_loss or self.parametric or self.friction

    @property
    def start(self) -> str:
        """From what the first motion starts."""
        return "rest" if self.direction == "rest" else "static"


def motion_inputs(scene: Scene) -> MotionInputs:
    """Collect what a case says of the motion of its train."""
    effects, part = scene.case.effects, scene.case.dynamics
    taken_by = part.loss_taken_by or (scene.case.train and scene.case.train.balance) or ""
    return MotionInputs(
        effects.contact_loss, effects.parametric, effects.friction, part.friction, taken_by, part.direction,
        part.tolerance, part.speed_values,
    )  # fmt: skip


def friction_coefficient(part: FrictionPart, pair: GearPair) -> Callable[[Array, Array, Array], Array]:
    """Friction coefficient of a law from sliding speed, sum of the rolling speeds [m/s] and tooth force [N]."""
    from fegear.dynamics.friction import benedict_kelley, buckingham

    if part.law == "buckingham":
        return lambda sliding, _rolling, _force: buckingham(sliding)
    if part.law == "constant":
        return lambda sliding, _rolling, _force: np.full(np.shape(sliding), part.coefficient or 0.0)
    viscosity, width = part.viscosity or 0.0, pair.face_width
    return lambda sliding, rolling, force: benedict_kelley(np.asarray(force) / width, viscosity, sliding, rolling)


def excitations_at(asked: MotionInputs, data: GearTrain, speed: float) -> tuple[MeshExcitation, ...]:
    """What the effects leave of each mesh, at a speed of the first body [rad/s] (friction depends on it)."""
    from fegear.dynamics.excitation import MeshExcitation
    from fegear.dynamics.friction import with_friction
    from fegear.dynamics.periodic import Periodic

    found = []
    frequencies = data.train.mesh_frequencies(speed)
    for mesh, one, frequency in zip(data.train.meshes, data.meshes, frequencies, strict=True):
        excitation = one.excitation
        if not asked.parametric:
            # Mark's (2.9b): constant stiffness, all fluctuation in the transmission error
            flat = MeshExcitation.from_mesh(Periodic.constant(mesh.stiffness), one.error.plus(-one.error.mean))
            found.append(replace(flat, phase=excitation.phase, parting=asked.contact_loss))
            continue
        if not asked.contact_loss:
            excitation = excitation.never_parting(one.force)
        if asked.friction:
            excitation = with_friction(
                excitation, mesh, one.pair.base_pitch, one.pair.working_pressure_angle, float(frequency), one.force,
                friction_coefficient(asked.law, one.pair), a_drives=one.a_drives,
            )  # fmt: skip
        found.append(excitation)
    return tuple(found)


def motion_model(asked: MotionInputs, data: GearTrain, speed: float) -> MotionModel:
    """The train at a speed of the first body [rad/s] with the effects that are on."""
    from fegear.dynamics.motion_model import MotionModel

    return MotionModel(data.train, excitations_at(asked, data, speed), speed, asked.taken_by)


def steady_motions(
    asked: MotionInputs, data: GearTrain, progress: Callable[[float], None] | None = None
) -> tuple[SteadyState, ...]:
    """Steady motions over the speeds, in increasing order of speed, each started as the direction says."""
    from fegear.dynamics.steady_state import steady_state

    speeds = asked.speeds / data.speed_ratio
    order = speeds[::-1] if asked.direction == "down" else speeds
    start: str | tuple[Array, Array] = asked.start
    states: list[SteadyState] = []
    model = motion_model(asked, data, float(order[0]))
    for number, speed in enumerate(order):
        model = motion_model(asked, data, float(speed)) if asked.friction else model.at_speed(float(speed))
        state = steady_state(model, start=start, tolerance=asked.tolerance)
        states.append(state)
        if asked.direction in ("up", "down"):
            start = (state.x, state.v)
        if progress:
            progress((number + 1) / order.size)
    return tuple(states[::-1] if asked.direction == "down" else states)
