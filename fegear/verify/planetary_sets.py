"""Planetary sets that rows and tests take: their geometry, and the example of Lin and Parker (1999)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fegear.dynamics.planetary.phases import mesh_phases
from fegear.dynamics.planetary.planet_set import Central, PlanetarySet, even_angles
from fegear.dynamics.planetary.set_cycle import MeshedSet
from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.geometry.involute import inv


def unshifted(
    sun: int, planet: int, angles: ArrayLike, module: float = 2e-3, pressure_angle: float = 20.0,
    ring: int | None = None, addendum: float = 1.0,
) -> PlanetarySet:  # fmt: skip
    """A set without profile shifts: both working pressure angles are that of the rack, where the ring suits."""
    alpha = math.radians(pressure_angle)
    half = 0.5 * math.pi / planet + float(inv(alpha))
    return PlanetarySet(
        sun, planet, ring or sun + 2 * planet, math.pi * module * math.cos(alpha), 0.5 * (sun + planet) * module,
        even_angles(int(np.asarray(angles))) if np.ndim(angles) == 0 else np.asarray(angles), half,
        (0.5 * planet + addendum) * module,
    )  # fmt: skip


def lin_parker(planets: int) -> SetModel:
    """The example of Lin and Parker (1999), table 1: masses and I/r^2 in kg, stiffnesses in N/m, 24.6 degrees.

    Frequencies depend on I/r^2 and the pressure angles, not on the radii; so tooth numbers that suit are as good.
    """
    found = unshifted(24, 30, planets, pressure_angle=24.6, addendum=-5.0)  # six planets fit

    def body(name: Central, mass: float, turning_mass: float, turning: float) -> CentralBody:
        square = found.lever(name) ** 2
        return CentralBody(mass, turning_mass * square, 1e8, turning * square)

    return SetModel(
        found,
        body("sun", 0.4, 0.39, 0.0),
        body("ring", 2.35, 3.00, 1e9),
        body("carrier", 5.43, 6.29, 0.0),
        PlanetBody(0.66, 0.61 * found.base_radius("planet") ** 2, 1e8),
    )


def constant(stiffness: float) -> MeshExcitation:
    """A mesh of one stiffness [N/m]."""
    return MeshExcitation.from_mesh(Periodic.constant(stiffness))


def jumping(low: float, high: float, share: float) -> MeshExcitation:
    """Teeth whose stiffness jumps where a second pair comes in."""
    return MeshExcitation.from_mesh(Periodic.through_points([0.0, share, share, 1.0], [high, high, low, low]))


def meshed(
    model: SetModel, sun: MeshExcitation, ring: MeshExcitation, torque: float = 500.0, driving: Central = "sun",
    **how: Any,
) -> MeshedSet:  # fmt: skip
    """A set with its meshes in their phases."""
    return MeshedSet(model, sun, ring, mesh_phases(model.found, **how), torque, driving)
