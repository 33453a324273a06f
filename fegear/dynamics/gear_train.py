"""A train with its gear pairs at work: bodies, shafts, springs of the teeth and what they excite."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.dynamics.periodic import Periodic
    from fegear.dynamics.train import Train
    from fegear.dynamics.train_mesh import TrainMesh


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
    """

    train: Train
    meshes: tuple[TrainMesh, ...]
    speed_ratio: float
    speed_of: str

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
