"""A train with the effects that are on: its model at a speed, and its steady motions over speeds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from fegear.dynamics.motion.averaging import averaged_motion
from fegear.dynamics.motion.effort import of_one
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import SteadyState, steady_state
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.friction import with_friction
from fegear.dynamics.train.periodic import Periodic

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.dynamics.motion.motion_spec import MotionSpec
    from fegear.dynamics.train.gear_train import GearTrain


def excitations_at(asked: MotionSpec, data: GearTrain, speed: float) -> tuple[MeshExcitation, ...]:
    """What the effects leave of each mesh, at a speed of the first body [rad/s] (friction depends on it)."""
    found = []
    frequencies = data.train.mesh_frequencies(speed)
    for mesh, one, frequency in zip(data.train.meshes, data.meshes, frequencies, strict=True):
        excitation = one.excitation
        if not asked.parametric:
            # Mark's (2.9b): constant stiffness, all fluctuation in the transmission error
            flat = MeshExcitation.from_mesh(Periodic.constant(mesh.stiffness), one.error.plus(-one.error.mean))
            back = None if one.back is None else one.back.even
            found.append(replace(flat, phase=excitation.phase, parting=asked.contact_loss, back=back))
            continue
        if not asked.contact_loss:
            excitation = excitation.never_parting(one.force)
        if asked.friction:
            excitation = with_friction(
                excitation, mesh, one.pair.base_pitch, one.pair.working_pressure_angle, float(frequency), one.force,
                asked.law.of(one.pair), a_drives=one.a_drives, internal=one.pair.internal,
            )  # fmt: skip
        found.append(replace(excitation, back=one.back))
    return tuple(found)


def motion_model(asked: MotionSpec, data: GearTrain, speed: float) -> MotionModel:
    """The train at a speed of the first body [rad/s] with the effects that are on."""
    return MotionModel(data.train, excitations_at(asked, data, speed), speed, asked.taken_by, data.ripple)


def steady_motion(
    asked: MotionSpec,
    model: MotionModel,
    start: str | tuple[Array, Array],
    tolerance: float,
    progress: Callable[[float], None] | None = None,
) -> SteadyState:
    """Find the steady motion at one speed in the way that is asked for."""
    find = averaged_motion if asked.method == "averaging" else steady_state
    return find(model, start=start, tolerance=tolerance, progress=progress)


def steady_motions(
    asked: MotionSpec, data: GearTrain, progress: Callable[[float], None] | None = None
) -> tuple[SteadyState, ...]:
    """Steady motions over the speeds, in increasing order of speed, each started as the direction says."""
    speeds = asked.speeds / data.speed_ratio
    order = speeds[::-1] if asked.direction == "down" else speeds
    start: str | tuple[Array, Array] = asked.start
    states: list[SteadyState] = []
    model = motion_model(asked, data, float(order[0]))
    for number, speed in enumerate(order):
        within = of_one(progress, number, order.size)
        model = motion_model(asked, data, float(speed)) if asked.friction else model.at_speed(float(speed))
        state = steady_motion(asked, model, start, asked.tolerance, within)
        states.append(state)
        if asked.direction in ("up", "down"):
            start = (state.x, state.v)
        if progress:
            progress((number + 1) / order.size)
    return tuple(states[::-1] if asked.direction == "down" else states)
