"""What the flank of a solid rack is by its shape alone: straight, one normal and one contact line for all places."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.plane.influence import Side
from fegear.fem.plane.trace import LoadedFlank
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.fillet import SolidFillet
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solved_flank import SolvedFlank
from fegear.geometry.rack_tooth import RackTooth

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike


@dataclass(frozen=True)
class SolidRackSpec:
    """A rack with its width; lengths in modules.

    Parameters
    ----------
    tooth : RackTooth
        The transverse section.
    slide : float
        Way of the section along the rack per length along the face: -tan(beta) of a right hand, 0 of a spur rack.
    width : float
        Face width.
    body : float
        From the back to the root.
    teeth : int
        Number of teeth.
    poisson_ratio : float
    settings : SolidSettings
    reach : int
        Neighbours that are answered for.
    held : tuple of bool
        Below which teeth there is a pin, along all of the face; empty where all of the back is held.
    pin_width : float
    plane_strain : bool
        Nothing moves along the axis: a check, which without a helix is the plane problem.
    """

    tooth: RackTooth
    slide: float
    width: float
    body: float
    teeth: int
    poisson_ratio: float
    settings: SolidSettings = field(default_factory=SolidSettings)
    reach: int = 1
    held: tuple[bool, ...] = ()
    pin_width: float = 0.0
    plane_strain: bool = False


class StraightFlankOfRack(SolvedFlank):
    """A rack's flank: radii are heights above the reference line [modules]."""

    spec: SolidRackSpec
    tau = 0.0

    @property
    def tooth(self) -> RackTooth:  # type: ignore[override]  # asked for its angle only
        """The transverse section."""
        return self.spec.tooth

    @property
    def slide(self) -> float:  # type: ignore[override]  # read-only
        """Way of the section along the rack per length along the face."""
        return self.spec.slide

    @property
    def width(self) -> float:  # type: ignore[override]  # read-only
        """[modules]."""
        return self.spec.width

    @property
    def poisson_ratio(self) -> float:  # type: ignore[override]  # read-only
        """Of the material."""
        return self.spec.poisson_ratio

    @property
    def settings(self) -> SolidSettings:  # type: ignore[override]  # read-only
        """Of its section's mesh and of the pressed bands."""
        return self.spec.settings

    @property
    def reach(self) -> int:  # type: ignore[override]  # read-only
        """Neighbours that are answered for."""
        return self.spec.reach

    @property
    def plane_strain(self) -> bool:  # type: ignore[override]  # read-only
        """Whether nothing moves along the axis."""
        return self.spec.plane_strain

    @property
    def base_twist(self) -> float:
        """tan(beta_b) = tan(beta) cos(alpha_t), positive for a right hand."""
        return -self.slide * math.cos(self.tooth.pressure_angle)

    def curvature(self, radius: Array) -> Array:
        """None."""
        return np.zeros(np.shape(radius))

    def line_slope(self, radius: ArrayLike) -> Array:
        """Arc up the flank per length along the face of the contact line: tan(beta) sin(alpha_t), up for a left hand.

        The limit of a gear's -tau r_b tan(alpha) with the twist tau = tan(beta) / r.
        """
        return np.full(np.shape(np.atleast_1d(radius)), self.slide * math.sin(self.tooth.pressure_angle))


@dataclass(frozen=True)
class SolidRackTooth(StraightFlankOfRack):
    """One loaded tooth of a rack and its neighbours, as if all teeth were as it is; module 1, E = 1.

    Parameters
    ----------
    spec : SolidRackSpec
    number : int
        Of the tooth.
    face : FaceFunctions
    flank : LoadedFlank
    compliance : mapping of int to ndarray, shape (n, n)
        Approach of the flank of tooth k under forces on tooth 0; zero where there is no such tooth.
    fillets : mapping of {"tension", "compression"} to SolidFillet
    displacement : mapping of (int, side) to ndarray, shape (nodes, 3, functions, n)
    """

    spec: SolidRackSpec
    number: int
    face: FaceFunctions = field(compare=False)
    flank: LoadedFlank = field(compare=False)
    compliance: Mapping[int, Array] = field(compare=False)
    fillets: Mapping[Side, SolidFillet] = field(compare=False)
    displacement: Mapping[tuple[int, Side], Array] = field(compare=False)
