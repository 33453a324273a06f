"""What the mechanics needs of a gear train: bodies, shafts, gear pairs, dampers and torques, with damping ratios.

`build_train` makes the graph of it, whose mean mesh stiffnesses come from loaded teeth; `assemble` puts in what these
excite. All in SI; nothing of it about files or names of keys.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.dynamics.train.gear_train import GearTrain, TrainMesh, a_drives
from fegear.dynamics.train.matrices import static_forces
from fegear.dynamics.train.torque_ripple import TorqueRipple
from fegear.dynamics.train.train import (
    Body,
    Damper,
    DampingLaw,
    Mesh,
    Shaft,
    Torque,
    Train,
    joined_inertias,
    mesh_damping,
    shaft_damping,
)
from fegear.geometry.pair import GearPair

if TYPE_CHECKING:
    from fegear.dynamics.train.excitation import MeshExcitation

#: Mean mesh stiffness of trains of which only the ratios and the static forces matter [N/m].
_ANY_STIFFNESS = 1e8


@dataclass(frozen=True)
class ShaftSpec:
    """A shaft between two bodies.

    Parameters
    ----------
    name, a, b : str
    stiffness : float
        Torsional [N m/rad]; infinite for a rigid one.
    damping : float
        [N m s/rad].
    damping_ratio : float, optional
        In place of it (TM-100180, 14 and 15).
    """

    name: str
    a: str
    b: str
    stiffness: float
    damping: float = 0.0
    damping_ratio: float | None = None

    def shaft(self, inertias: Mapping[str, float]) -> Shaft:
        """The shaft between bodies of these inertias [kg m^2]."""
        damping = self.damping
        if self.damping_ratio is not None and math.isfinite(self.stiffness):
            damping = shaft_damping(self.damping_ratio, self.stiffness, inertias[self.a], inertias[self.b])
        return Shaft(self.name, self.a, self.b, self.stiffness, damping)


@dataclass(frozen=True)
class MeshSpec:
    """A gear pair between two bodies.

    Parameters
    ----------
    name, a, b : str
        Bodies of the driver and of the driven gear as the pair is named.
    pair : GearPair
    stiffness : float, optional
        Mean mesh stiffness [N/m]; by default that of the loaded teeth.
    damping : float
        Along the line of action [N s/m].
    damping_ratio : float, optional
        In place of it (TM-100180, 16).
    damping_law : {"constant", "momentary"}
    backlash : float, optional
        Along the transverse line of action [m], infinite for teeth that never touch behind; by default that of the
        gears.
    phase : float
        At time zero [base pitches].
    """

    name: str
    a: str
    b: str
    pair: GearPair
    stiffness: float | None = None
    damping: float = 0.0
    damping_ratio: float | None = None
    damping_law: DampingLaw = "constant"
    backlash: float | None = None
    phase: float = 0.0

    @property
    def room(self) -> float:
        """Backlash: as it is given, else that of its gears [m]."""
        return self.pair.free_backlash if self.backlash is None else self.backlash

    def mesh(self, inertias: Mapping[str, float], stiffness: float) -> Mesh:
        """The gear pair between bodies of these inertias [kg m^2], of a mean stiffness [N/m] where it has none."""
        gear_a, gear_b = self.pair.driver, self.pair.driven
        r1, r2, k = gear_a.base_radius, self.pair.side * gear_b.base_radius, self.stiffness or stiffness
        damping = self.damping
        if self.damping_ratio is not None:
            damping = mesh_damping(self.damping_ratio, k, r1, r2, inertias[self.a], inertias[self.b])
        return Mesh(
            self.name, self.a, self.b, r1, r2, gear_a.teeth, gear_b.teeth, k, damping, self.room, self.damping_law
        )  # fmt: skip


@dataclass(frozen=True)
class TrainSpec:
    """A gear train as it is given.

    Parameters
    ----------
    bodies : tuple of Body
        With the inertias of their gears; the first is the reference for speeds where `speed_of` is empty.
    meshes : tuple of MeshSpec
    torques : tuple of Torque
    shafts : tuple of ShaftSpec
    dampers : tuple of Damper
    balance : str, optional
        Body whose torque follows from equilibrium.
    speed_of : str
        Body that speeds refer to.
    ripple : tuple of TorqueRipple
        Torques that fluctuate about the constant ones.
    """

    bodies: tuple[Body, ...]
    meshes: tuple[MeshSpec, ...]
    torques: tuple[Torque, ...]
    shafts: tuple[ShaftSpec, ...] = ()
    dampers: tuple[Damper, ...] = ()
    balance: str | None = None
    speed_of: str = ""
    ripple: tuple[TorqueRipple, ...] = ()

    @property
    def reference(self) -> str:
        """Body that speeds refer to."""
        return self.speed_of or self.bodies[0].name

    @property
    def pairs(self) -> dict[str, GearPair]:
        """Gear pairs by the name of their mesh."""
        return {mesh.name: mesh.pair for mesh in self.meshes}


def build_train(spec: TrainSpec, stiffness: Mapping[str, float] | None = None) -> Train:
    """Make the train for mean mesh stiffnesses [N/m]; without them only ratios and static forces mean anything.

    All angles count in one sense of rotation, so both base radii of an external mesh have one sign, and those of an
    internal one have two; they are those for which the torques press the teeth together. Bodies joined by rigid shafts
    count together in damping ratios.

    Parameters
    ----------
    spec : TrainSpec
    stiffness : mapping of str to float, optional
        By the name of the mesh.

    Raises
    ------
    InputError
        As `Train`.
    """
    rigid = [Shaft(shaft.name, shaft.a, shaft.b, math.inf) for shaft in spec.shafts if math.isinf(shaft.stiffness)]
    inertias = joined_inertias(spec.bodies, rigid)
    shafts = tuple(shaft.shaft(inertias) for shaft in spec.shafts)
    known = stiffness or {}
    meshes = tuple(mesh.mesh(inertias, known.get(mesh.name, _ANY_STIFFNESS)) for mesh in spec.meshes)
    free = Train(spec.bodies, shafts, meshes, spec.dampers)
    torques = spec.torques
    if spec.balance is not None:
        ratio = {body: float(free.ratios[free.dof[body]]) for body in inertias}
        rest = sum(ratio[torque.body] * torque.value for torque in torques)
        torques = (*torques, Torque(spec.balance, -rest / ratio[spec.balance]))
    train = replace(free, torques=torques)
    turned = tuple(
        replace(mesh, radius_a=-mesh.radius_a, radius_b=-mesh.radius_b) if force < 0.0 else mesh
        for mesh, force in zip(train.meshes, static_forces(train), strict=True)
    )
    return replace(train, meshes=turned)


def speed_ratio(spec: TrainSpec, train: Train) -> float:
    """Speed of the body that speeds refer to over that of the first body."""
    return abs(float(train.ratios[train.dof[spec.reference]]))


def assemble(spec: TrainSpec, excitations: Mapping[str, MeshExcitation]) -> GearTrain:
    """Put excitations, by the name of the mesh and under its mean force, into the train, each at the phase of its mesh.

    Parameters
    ----------
    spec : TrainSpec
    excitations : mapping of str to MeshExcitation
        One for each mesh (`mesh_excitation`, `excitation_of_flanks`), in their order.
    """
    train = build_train(spec, {name: 1.0 / found.mean_compliance() for name, found in excitations.items()})
    forces, forward, meshes = static_forces(train), a_drives(train), []
    for mesh, force, ahead in zip(spec.meshes, forces, forward, strict=True):
        found = replace(excitations[mesh.name], phase=mesh.phase)
        pair = mesh.pair if ahead else mesh.pair.reversed()
        meshes.append(TrainMesh.under(pair, found, float(force), a_drives=ahead))
    return GearTrain(train, tuple(meshes), speed_ratio(spec, train), spec.reference, spec.ripple)
