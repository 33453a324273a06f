"""From ``[train]`` to the graph of bodies, shafts and gear pairs, with the teeth of the scene's pairs in between.

What moves: a train at a speed, with the effects that its case calls for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.torque_ripple import torque_ripples
from fegear.dynamics.train.gear_train import GearTrain, TrainMesh, a_drives
from fegear.dynamics.train.matrices import static_forces
from fegear.dynamics.train.train import (
    Body,
    Damper,
    Mesh,
    Shaft,
    Torque,
    Train,
    joined_inertias,
    mesh_damping,
    shaft_damping,
    shaft_stiffness,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.base.arrays import Array
    from fegear.case.dynamics import FrictionPart
    from fegear.case.reading import Scene
    from fegear.case.train import BodyPart, ShaftPart, TrainMeshPart, TrainPart
    from fegear.dynamics.motion.motion_model import MotionModel
    from fegear.dynamics.motion.steady_state import SteadyState
    from fegear.dynamics.train.charts import Direction
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.dynamics.train.torque_ripple import TorqueRipple
    from fegear.geometry.pair import GearPair


#: Mean mesh stiffness of trains of which only the ratios and the static forces matter [N/m].
_ANY_STIFFNESS = 1e8


#: How far a pair's load may be from the mean mesh force that the torques give.
LOAD_AGREES = 2e-3


def train_part(scene: Scene) -> TrainPart:
    """The case's train, or a refusal."""
    if scene.case.train is None:
        raise InputError("train", "(not given)", "is required for this result", "specify bodies, meshes and torques")
    return scene.case.train


def check_train(scene: Scene) -> None:
    """Refuse trains that cannot turn, before anything is computed."""
    part = train_part(scene)
    forces = static_forces(build_train(train_inputs(scene)))
    for name, force in zip(part.mesh, forces, strict=True):
        pair = part.loaded_pair_of(name)
        stated = scene.case.pair[pair].normal_load(scene.pairs[pair])
        if part.mesh[name].like is None and stated is not None and abs(stated - force) > LOAD_AGREES * abs(stated):
            raise InputError(
                f"pair.{pair}.load", f"{stated:.8g} N",
                f"differs from the mean force of {force:.8g} N that train.torque puts on mesh {name}",
                "make the load and the torques agree",
            )  # fmt: skip


@dataclass(frozen=True)
class TrainInputs:
    """What a train depends on besides the loaded teeth of its gear pairs.

    Parameters
    ----------
    part : TrainPart
    inertias : mapping of str to float
        Of each body, that of its gears included [kg m^2].
    pairs : mapping of str to GearPair
        Of each mesh.
    speed_of : str
        Body that speeds refer to.
    assumed : bool
        Whether that is assumed: speeds are given, and not whose they are.
    ripple : tuple of TorqueRipple
        Torques that fluctuate, where the effect is on.
    ripple_means : mapping of str to float
        Mean torques of files, which are left out [N m].
    idle_ripple : bool
        Whether the case describes torque ripple, and its effect is off.
    """

    part: TrainPart
    inertias: Mapping[str, float]
    pairs: Mapping[str, GearPair]
    speed_of: str
    assumed: bool = field(default=False, compare=False)
    ripple: tuple[TorqueRipple, ...] = ()
    ripple_means: Mapping[str, float] = field(default_factory=dict)
    idle_ripple: bool = field(default=False, compare=False)


def train_inputs(scene: Scene) -> TrainInputs:
    """Collect what a case says of its train."""
    part = train_part(scene)
    pairs = {name: scene.pairs[part.pair_of(name)] for name in part.mesh}
    inertias = {name: _inertia(scene, body) for name, body in part.body.items()}
    dynamics = scene.case.dynamics
    assumed = dynamics.speed_of is None and dynamics.speed_values.size > 0
    speed_of = dynamics.speed_of or next(iter(part.body))
    # without its effect, ripple is nothing that a result depends on
    still = TrainInputs(part.model_copy(update={"torque_ripple": {}}), inertias, pairs, speed_of, assumed)
    if not scene.case.effects.torque_ripple:
        return replace(still, idle_ripple=bool(part.torque_ripple))
    ripple, means = torque_ripples(scene, part, build_train(still))
    return replace(still, ripple=ripple, ripple_means=means)


def _inertia(scene: Scene, part: BodyPart) -> float:
    inertia = part.inertia or 0.0
    for gear_name in part.gears or ():
        inertia += scene.gears[gear_name].mass_properties.inertia
    return inertia


def _shaft(name: str, part: ShaftPart, inertias: Mapping[str, float]) -> Shaft:
    if part.rigid:
        return Shaft(name, part.a, part.b, math.inf)
    stiffness = part.stiffness
    if stiffness is None:
        stiffness = shaft_stiffness(
            part.length or math.nan, part.diameter or math.nan, part.shear_modulus, part.bore_diameter
        )
    damping = part.damping or 0.0
    if part.damping_ratio is not None:
        damping = shaft_damping(part.damping_ratio, stiffness, inertias[part.a], inertias[part.b])
    return Shaft(name, part.a, part.b, stiffness, damping)


def backlash_of(mesh: TrainMeshPart, pair: GearPair) -> float:
    """Backlash of a mesh along the transverse line of action [m]: as it is given, else that of its gears."""
    if mesh.backlash is None:
        return pair.free_backlash
    return math.inf if mesh.backlash == "unlimited" else mesh.backlash


def build_train(asked: TrainInputs, stiffness: Mapping[str, float] | None = None) -> Train:
    """Make the train for mean mesh stiffnesses [N/m]; without them only ratios and static forces mean anything.

    All angles count in one sense of rotation, so both base radii of an external mesh have one sign, and those of an
    internal one have two; they are those for which the torques press the teeth together. Bodies joined by rigid shafts
    count together in damping ratios.
    """
    part = asked.part
    bodies = tuple(Body(name, inertia) for name, inertia in asked.inertias.items())
    rigid = [Shaft(name, shaft.a, shaft.b, math.inf) for name, shaft in part.shaft.items() if shaft.rigid]
    inertias = joined_inertias(bodies, rigid)
    shafts = tuple(_shaft(name, shaft, inertias) for name, shaft in part.shaft.items())
    meshes = []
    for name, mesh in part.mesh.items():
        pair = asked.pairs[name]
        r1, r2 = pair.driver.base_radius, pair.side * pair.driven.base_radius
        k = mesh.stiffness or (stiffness or {}).get(name, _ANY_STIFFNESS)
        damping = mesh.damping or 0.0
        if mesh.damping_ratio is not None:
            damping = mesh_damping(mesh.damping_ratio, k, r1, r2, inertias[mesh.driver], inertias[mesh.driven])
        backlash = backlash_of(mesh, pair)
        teeth = pair.driver.teeth, pair.driven.teeth
        meshes.append(Mesh(name, mesh.driver, mesh.driven, r1, r2, *teeth, k, damping, backlash, mesh.damping_law))
    dampers = tuple(Damper(damper.a, damper.b, damper.damping) for damper in part.damper.values())
    free = Train(bodies, shafts, tuple(meshes), dampers)
    torques = [Torque(body, value) for body, value in part.torque.items()]
    if part.balance is not None:
        ratio = {body: float(free.ratios[free.dof[body]]) for body in inertias}
        rest = sum(ratio[torque.body] * torque.value for torque in torques)
        torques.append(Torque(part.balance, -rest / ratio[part.balance]))
    train = replace(free, torques=tuple(torques))
    turned = tuple(
        replace(mesh, radius_a=-mesh.radius_a, radius_b=-mesh.radius_b) if force < 0.0 else mesh
        for mesh, force in zip(train.meshes, static_forces(train), strict=True)
    )
    return replace(train, meshes=turned)


def assemble(asked: TrainInputs, excitations: Mapping[str, MeshExcitation]) -> GearTrain:
    """Put excitations, by mesh, into the train."""
    train = build_train(asked, {name: 1.0 / found.mean_compliance() for name, found in excitations.items()})
    meshes = []
    for (name, found), force, forward in zip(excitations.items(), static_forces(train), a_drives(train), strict=True):
        pair = asked.pairs[name]
        meshes.append(TrainMesh.under(pair if forward else pair.reversed(), found, float(force), a_drives=forward))
    ratio = abs(float(train.ratios[train.dof[asked.speed_of]]))
    return GearTrain(train, tuple(meshes), ratio, asked.speed_of, asked.ripple)


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
    method : {"shooting", "averaging"}
        How a steady motion is found.
    """

    contact_loss: bool
    parametric: bool
    friction: bool
    law: FrictionPart
    taken_by: str
    direction: Direction
    tolerance: float
    speeds: Array
    method: Literal["shooting", "averaging"] = "shooting"

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
        part.tolerance, part.speed_values, part.method,
    )  # fmt: skip


def friction_coefficient(part: FrictionPart, pair: GearPair) -> Callable[[Array, Array, Array], Array]:
    """Friction coefficient of a law from sliding speed, sum of the rolling speeds [m/s] and tooth force [N]."""
    from fegear.dynamics.train.friction import benedict_kelley, buckingham

    if part.law == "buckingham":
        return lambda sliding, _rolling, _force: buckingham(sliding)
    if part.law == "constant":
        return lambda sliding, _rolling, _force: np.full(np.shape(sliding), part.coefficient or 0.0)
    viscosity, width = part.viscosity or 0.0, pair.face_width
    return lambda sliding, rolling, force: benedict_kelley(np.asarray(force) / width, viscosity, sliding, rolling)


def excitations_at(asked: MotionInputs, data: GearTrain, speed: float) -> tuple[MeshExcitation, ...]:
    """What the effects leave of each mesh, at a speed of the first body [rad/s] (friction depends on it)."""
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.dynamics.train.friction import with_friction
    from fegear.dynamics.train.periodic import Periodic

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
                friction_coefficient(asked.law, one.pair), a_drives=one.a_drives, internal=one.pair.internal,
            )  # fmt: skip
        found.append(excitation)
    return tuple(found)


def motion_model(asked: MotionInputs, data: GearTrain, speed: float) -> MotionModel:
    """The train at a speed of the first body [rad/s] with the effects that are on."""
    from fegear.dynamics.motion.motion_model import MotionModel

    return MotionModel(data.train, excitations_at(asked, data, speed), speed, asked.taken_by, data.ripple)


def steady_motion(
    asked: MotionInputs,
    model: MotionModel,
    start: str | tuple[Array, Array],
    tolerance: float,
    progress: Callable[[float], None] | None = None,
) -> SteadyState:
    """Find the steady motion at one speed in the way that the case asks for."""
    from fegear.dynamics.motion.averaging import averaged_motion
    from fegear.dynamics.motion.steady_state import steady_state

    find = averaged_motion if asked.method == "averaging" else steady_state
    return find(model, start=start, tolerance=tolerance, progress=progress)


def steady_motions(
    asked: MotionInputs, data: GearTrain, progress: Callable[[float], None] | None = None
) -> tuple[SteadyState, ...]:
    """Steady motions over the speeds, in increasing order of speed, each started as the direction says."""
    from fegear.dynamics.motion.effort import of_one

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
