"""A train with its gear pairs at work: bodies, shafts, springs of the teeth and what they excite.

A gear pair at work in a train: which body drives, its teeth as springs, what they excite, the force they carry.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.dynamics.train.matrices import static_forces
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.torque_ripple import TorqueRipple
from fegear.dynamics.train.train import Train
from fegear.geometry.pair import GearPair, Member

if TYPE_CHECKING:
    from fegear.dynamics.train.back_flanks import BackFlanks
    from fegear.dynamics.train.excitation import MeshExcitation


@dataclass(frozen=True)
class GearTrain:
    """A train with what its gear pairs do to it.

    Parameters
    ----------
    train : Train
        With mean mesh stiffnesses.
    meshes : tuple of TrainMesh
        Each gear pair as it runs, its springs, its static transmission error and its mean force.
    speed_ratio : float
        Speed of the body that speeds refer to over that of the first body.
    speed_of : str
        That body.
    ripple : tuple of TorqueRipple
        Torques that fluctuate about the constant ones.
    """

    train: Train
    meshes: tuple[TrainMesh, ...]
    speed_ratio: float
    speed_of: str
    ripple: tuple[TorqueRipple, ...] = ()

    @property
    def errors(self) -> tuple[Periodic, ...]:
        """Static transmission error of each mesh under its mean force [m]."""
        return tuple(mesh.error for mesh in self.meshes)

    @property
    def forces(self) -> Array:
        """Mean mesh forces, shape (meshes,) [N]."""
        return np.array([mesh.force for mesh in self.meshes])

    @property
    def phases(self) -> tuple[float, ...]:
        """Phase of each mesh at time zero [its base pitches]."""
        return tuple(mesh.excitation.phase for mesh in self.meshes)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the meshes."""
        return tuple(mesh.name for mesh in self.train.meshes)

    @property
    def exciters(self) -> tuple[str, ...]:
        """Names of all that excites the train: its meshes, then its torque ripple."""
        return (*self.names, *(one.name for one in self.ripple))


#: A mesh idles where it carries less than this share of the largest mesh force.
_IDLE = 1e-9


@dataclass(frozen=True)
class TrainMesh:
    """A gear pair of a train under its mean force.

    Parameters
    ----------
    pair : GearPair
        As it runs: its driver is the gear that drives in fact, and x counts toward that gear's tip.
    excitation : MeshExcitation
        One-sided springs of its teeth.
    error : Periodic
        Static transmission error under the mean force [m].
    force : float
        Mean mesh force [N].
    a_drives : bool
        Whether the train's body `a` of this mesh drives, and not body `b`.
    doubt : (float, float), optional
        Estimated errors of its mean stiffness [N/m] and of the peak-to-peak static transmission error [m].
    back : BackFlanks, optional
        Of asymmetric teeth whose back flanks are known.
    """

    pair: GearPair
    excitation: MeshExcitation
    error: Periodic
    force: float
    a_drives: bool = True
    doubt: tuple[float, float] | None = None
    back: BackFlanks | None = None

    @classmethod
    def under(cls, pair: GearPair, excitation: MeshExcitation, force: float, *, a_drives: bool = True) -> TrainMesh:
        """The mesh under a mean force [N], with the static transmission error that its springs give."""
        return cls(pair, excitation, excitation.transmission_error(max(force, 0.0), tolerance=1e-9), force, a_drives)

    def role(self, named: Member) -> Member:
        """What the gear of body `a` ("driver") or `b` ("driven") is as the mesh runs."""
        return named if self.a_drives else ("driven" if named == "driver" else "driver")


def a_drives(train: Train) -> tuple[bool, ...]:
    """Whether body `a` of each gear pair drives: it feeds power into the mesh as the first body turns forward.

    The mesh force turns body `a` back by its radius; where `a` turns forward against it, it drives. A gear pair that
    carries no mean force counts as it is named.
    """
    forces = static_forces(train)
    idle = _IDLE * float(np.max(np.abs(forces), initial=0.0))
    return tuple(
        bool(abs(force) <= idle or force * mesh.radius_a * train.ratios[train.dof[mesh.a]] > 0.0)
        for mesh, force in zip(train.meshes, forces, strict=True)
    )
