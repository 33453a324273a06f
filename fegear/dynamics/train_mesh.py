"""A gear pair at work in a train: which body drives, its teeth as springs, what they excite, the force they carry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.matrices import static_forces

if TYPE_CHECKING:
    from fegear.dynamics.excitation import MeshExcitation
    from fegear.dynamics.periodic import Periodic
    from fegear.dynamics.train import Train
    from fegear.geometry.pair import GearPair, Member

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
    """

    pair: GearPair
    excitation: MeshExcitation
    error: Periodic
    force: float
    a_drives: bool = True
    doubt: tuple[float, float] | None = None

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
