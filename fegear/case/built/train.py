"""From ``[train]`` and ``[dynamics]`` to what the mechanics needs of a train and of its motion."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.built.odd_gears import odd_gears_of
from fegear.case.built.torque_ripple import torque_ripples
from fegear.case.halves import double_gears
from fegear.dynamics.motion.motion_spec import MotionSpec
from fegear.dynamics.train.friction_law import FrictionLaw
from fegear.dynamics.train.gear_train import a_drives
from fegear.dynamics.train.matrices import static_forces
from fegear.dynamics.train.train import Body, Damper, Torque, shaft_stiffness
from fegear.dynamics.train.train_spec import MeshSpec, ShaftSpec, TrainSpec, build_train

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.case.train import BodyPart, ShaftPart, TrainMeshPart, TrainPart


#: How far a pair's load may be from the mean mesh force that the torques give.
LOAD_AGREES = 2e-3
#: Inertia of a body beside its gears, and in place of them, over theirs: below these and above the last no one's.
_LIGHT, _BARE, _HEAVY = 1e-4, 0.05, 1e5


def train_part(scene: Scene) -> TrainPart:
    """The case's train, or a refusal."""
    if scene.case.train is None:
        raise InputError("train", "(not given)", "is required for this result", "specify bodies, meshes and torques")
    return scene.case.train


def check_train(scene: Scene) -> None:
    """Refuse trains that cannot turn, before anything is computed."""
    part = train_part(scene)
    for mesh in part.mesh:
        _check_back(scene, part, mesh)
    train = build_train(train_inputs(scene).spec)
    forces = static_forces(train)
    _check_flanks(scene, part, a_drives(train))
    for name, force in zip(part.mesh, forces, strict=True):
        pair = part.loaded_pair_of(name)
        of_one, halves = scene.case.pair[pair].normal_load(scene.pairs[pair]), scene.case.pair[pair].halves
        stated = None if of_one is None else halves * of_one
        if part.mesh[name].like is None and stated is not None and abs(stated - force) > LOAD_AGREES * abs(stated):
            raise InputError(
                f"pair.{pair}.load", f"{stated:.8g} N",
                f"differs from the mean force of {force:.8g} N that train.torque puts on mesh {name}",
                "make the load and the torques agree",
            )  # fmt: skip


def _check_back(scene: Scene, part: TrainPart, mesh: str) -> None:
    """Refuse a pair of back flanks that is none."""
    name = part.mesh[mesh].back_pair
    if name is None:
        return
    key, value, front = f"train.mesh.{mesh}.back_pair", f'"{name}"', part.pair_of(mesh)
    this, other = ([scene.written.get(gear, gear) for gear in (pair.driver, pair.driven)]
                   for pair in (scene.case.pair[front], scene.case.pair[name]))  # fmt: skip
    if not scene.pairs[front].asymmetric:
        raise InputError(key, value, "requires asymmetric teeth", "remove it: equal flanks are equally stiff")
    if part.mesh[mesh].like is not None:
        raise InputError(key, value, "is not available for a mesh with like", "remove it, or like")
    if this != other[::-1]:
        raise InputError(
            key, value, f"must be a pair of the gears of pair {front} with driver and driven exchanged",
            f'set driver = "{this[1]}" and driven = "{this[0]}" in [pair.{name}]',
        )  # fmt: skip


def _check_flanks(scene: Scene, part: TrainPart, drives: tuple[bool, ...]) -> None:
    """Refuse idlers with asymmetric teeth whose pairs name driver and driven against the power of one mesh only."""
    known: dict[str, tuple[str, bool]] = {}
    for mesh, as_named in zip(part.mesh, drives, strict=True):
        pair = scene.case.pair[part.loaded_pair_of(mesh)]
        for gear in (pair.driver, pair.driven):
            if not scene.gears[gear].asymmetric:
                continue
            name = scene.written.get(gear, gear)
            first, before = known.setdefault(name, (mesh, as_named))
            if before != as_named:
                raise InputError(
                    f"train.mesh.{mesh}.driver", f'"{part.mesh[mesh].driver}"',
                    f"is driven where mesh {first} runs as named: gear {name} would be loaded on the wrong flank",
                    f"exchange driver and driven of mesh {mesh} and of its pair",
                )  # fmt: skip


@dataclass(frozen=True)
class MeshTeeth:
    """Whose teeth a mesh has: those of a loaded pair, or unmodified ones like them, so many times as wide.

    `odd`: whether some of them differ from the others. `halves`: 2 of a double helical pair, whose teeth are one half.
    `back`: the pair that loads their other flanks, if one is named.
    """

    pair: str
    like: bool = False
    width_ratio: float = 1.0
    odd: bool = False
    halves: int = 1
    back: str = ""


@dataclass(frozen=True)
class TrainInputs:
    """What a train depends on besides the loaded teeth of its gear pairs.

    Parameters
    ----------
    spec : TrainSpec
        With the torques that fluctuate, where the effect is on.
    teeth : mapping of str to MeshTeeth
        Of each mesh.
    sources : mapping of str to str
        What the inertia of each body is made of, in words.
    unlikely : mapping of str to float
        Inertias that a case gives over that of the gears of their body, where that is far from any body's.
    assumed : bool
        Whether the body that speeds refer to is assumed: speeds are given, and not whose they are.
    ripple_means : mapping of str to float
        Mean torques of files, which are left out [N m].
    idle_ripple : bool
        Whether the case describes torque ripple, and its effect is off.
    """

    spec: TrainSpec
    teeth: Mapping[str, MeshTeeth]
    sources: Mapping[str, str] = field(default_factory=dict, compare=False)
    unlikely: Mapping[str, float] = field(default_factory=dict, compare=False)
    assumed: bool = field(default=False, compare=False)
    ripple_means: Mapping[str, float] = field(default_factory=dict)
    idle_ripple: bool = field(default=False, compare=False)


def train_inputs(scene: Scene) -> TrainInputs:
    """Collect what a case says of its train."""
    part, dynamics = train_part(scene), scene.case.dynamics
    spec = TrainSpec(
        tuple(Body(name, _inertia(scene, body)) for name, body in part.body.items()),
        tuple(_mesh(scene, part, name, mesh) for name, mesh in part.mesh.items()),
        tuple(Torque(body, value) for body, value in part.torque.items()),
        tuple(_shaft(name, shaft) for name, shaft in part.shaft.items()),
        tuple(Damper(damper.a, damper.b, damper.damping) for damper in part.damper.values()),
        part.balance, dynamics.speed_of or "",
    )  # fmt: skip
    assumed = dynamics.speed_of is None and dynamics.speed_values.size > 0
    sources = {
        name: " + ".join([*(_said(scene, gear) for gear in body.gears or ()), *(["inertia"] if body.inertia else [])])
        for name, body in part.body.items()
    }
    teeth = {name: _teeth(scene, part, name) for name in part.mesh}
    still = TrainInputs(spec, teeth, sources, _unlikely(scene, part), assumed)
    # without its effect, ripple is nothing that a result depends on
    if not scene.case.effects.torque_ripple:
        return replace(still, idle_ripple=bool(part.torque_ripple))
    ripple, means = torque_ripples(scene, part, build_train(spec))
    return replace(still, spec=replace(spec, ripple=ripple), ripple_means=means)


def _said(scene: Scene, gear: str) -> str:
    return f"gear {gear}" + (" (both halves)" if gear in double_gears(scene.case) else "")


def _inertia(scene: Scene, part: BodyPart) -> float:
    inertia, double = part.inertia or 0.0, double_gears(scene.case)
    for gear_name in part.gears or ():
        inertia += (2.0 if gear_name in double else 1.0) * scene.gears[gear_name].mass_properties.inertia
    return inertia


def _unlikely(scene: Scene, part: TrainPart) -> dict[str, float]:
    """Given inertias over that of the gears of their body, in its meshes or its own, where the ratio is out of range.

    A body whose gears are not counted otherwise is no lighter than these; beside them a hub or a shaft is no
    thousandth, and no motor or flywheel is a hundred thousand times as heavy.
    """
    found = {}
    for name, body in part.body.items():
        meshed = (scene.case.pair[part.pair_of(mesh)] for mesh in part.mesh)
        of_meshes = {
            gear for mesh, pair in zip(part.mesh.values(), meshed, strict=True)
            for member, gear in ((mesh.driver, pair.driver), (mesh.driven, pair.driven)) if member == name
        }  # fmt: skip
        gears = {scene.written.get(gear, gear) for gear in body.gears or of_meshes}
        if not gears or not body.inertia:
            continue
        ratio = body.inertia / sum(scene.gears[gear].mass_properties.inertia for gear in gears)
        if not (_LIGHT if body.gears else _BARE) <= ratio <= _HEAVY:
            found[name] = ratio
    return found


def _teeth(scene: Scene, part: TrainPart, name: str) -> MeshTeeth:
    like, pair = part.mesh[name].like, part.loaded_pair_of(name)
    odd = like is None and bool(odd_gears_of(scene, pair))
    halves = scene.case.pair[pair].halves
    back = part.mesh[name].back_pair or ""
    return MeshTeeth(pair, like is not None, like.width_ratio if like else 1.0, odd, halves, back)


def _shaft(name: str, part: ShaftPart) -> ShaftSpec:
    stiffness = math.inf if part.rigid else part.stiffness
    if stiffness is None:
        stiffness = shaft_stiffness(
            part.length or math.nan, part.diameter or math.nan, part.shear_modulus, part.bore_diameter
        )
    return ShaftSpec(name, part.a, part.b, stiffness, part.damping or 0.0, part.damping_ratio)


def _mesh(scene: Scene, part: TrainPart, name: str, mesh: TrainMeshPart) -> MeshSpec:
    backlash = math.inf if mesh.backlash == "unlimited" else mesh.backlash
    return MeshSpec(
        name, mesh.driver, mesh.driven, scene.pairs[part.pair_of(name)], mesh.stiffness, mesh.damping or 0.0,
        mesh.damping_ratio, mesh.damping_law, backlash, mesh.phase,
    )  # fmt: skip


def motion_spec(scene: Scene) -> MotionSpec:
    """Collect what a case says of the motion of its train."""
    effects, part = scene.case.effects, scene.case.dynamics
    friction = part.friction
    law = FrictionLaw(friction.law, friction.viscosity, friction.coefficient)
    taken_by = part.loss_taken_by or (scene.case.train and scene.case.train.balance) or ""
    return MotionSpec(
        effects.contact_loss, effects.parametric, effects.friction, law, taken_by, part.direction,
        part.tolerance, part.speed_values, part.method,
    )  # fmt: skip
