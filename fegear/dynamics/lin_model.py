"""The four-inertia model: motor, two gears, load, two shafts (TM-100180, Eqs. 1 to 4; TM-89901)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.train import Body, Mesh, Shaft, Torque, Train, mesh_damping, shaft_damping
from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.dynamics.parts import DampingLaw


@dataclass(frozen=True)
class FourInertia:
    """Motor, shaft, gear 1, gear 2, shaft, load; angles as they run, so that the approach is R1 a1 - R2 a2.

    Parameters
    ----------
    motor, gear_1, gear_2, load : float
        Inertias [kg m^2].
    shaft_1, shaft_2 : float
        Shaft stiffnesses [N m/rad].
    base_radius_1, base_radius_2 : float
        Base radii [m].
    teeth_1, teeth_2 : int
        Tooth numbers.
    force : float
        Mean mesh force along the line of action [N].
    shaft_ratio, mesh_ratio : float
        Damping ratios of the shafts (14, 15) and of the gear pair (16), for the gears' own inertias as the report
        has it, whatever the shafts: stiff ones tend to rigid ones.
    backlash : float
        Backlash along the line of action [m].
    damping_law : {"constant", "momentary"}
        Mesh damping from the mean stiffness, or, as the report writes it, from that of the teeth that touch.
    """

    motor: float
    gear_1: float
    gear_2: float
    load: float
    shaft_1: float
    shaft_2: float
    base_radius_1: float
    base_radius_2: float
    teeth_1: int
    teeth_2: int
    force: float
    shaft_ratio: float = 0.005
    mesh_ratio: float = 0.1
    backlash: float = math.inf
    damping_law: DampingLaw = "constant"

    def train(self, mesh_stiffness: float) -> Train:
        """The model as a train, for a mean mesh stiffness [N/m]."""
        r1, r2 = self.base_radius_1, self.base_radius_2
        damping = mesh_damping(self.mesh_ratio, mesh_stiffness, r1, r2, self.gear_1, self.gear_2)

        def damp(stiffness: float, a: float, b: float) -> float:
            return shaft_damping(self.shaft_ratio, stiffness, a, b) if math.isfinite(stiffness) else 0.0

        pair = Mesh(
            "pair", "gear 1", "gear 2", r1, -r2, self.teeth_1, self.teeth_2, mesh_stiffness, damping, self.backlash,
            self.damping_law,
        )  # fmt: skip
        return Train(
            bodies=(
                Body("motor", self.motor),
                Body("gear 1", self.gear_1),
                Body("gear 2", self.gear_2),
                Body("load", self.load),
            ),
            shafts=(
                Shaft("shaft 1", "motor", "gear 1", self.shaft_1, damp(self.shaft_1, self.motor, self.gear_1)),
                Shaft("shaft 2", "gear 2", "load", self.shaft_2, damp(self.shaft_2, self.gear_2, self.load)),
            ),
            meshes=(pair,),
            torques=(Torque("motor", self.force * r1), Torque("load", -self.force * r2)),
        )  # fmt: skip


def linear_tip_relief(x: ArrayLike, tip: float, start: float, amount: float) -> Array:
    """Linear relief [m] at positions x [m]: zero up to `start`, `amount` at `tip`; the tip may lie on either side."""
    if tip == start:
        raise RangeError("relief length", 0.0, "must not be zero", "set the amount to zero instead")
    share = (np.asarray(x, dtype=float) - start) / (tip - start)
    found: Array = amount * np.clip(share, 0.0, None)
    return found


def relief_start(tip: float, single_contact: float, length: float) -> float:
    """Position x [m] where relief of length L_n starts: L_n = 1 runs from the tip to the HPSTC (TM-89901)."""
    return tip - length * (tip - single_contact)
