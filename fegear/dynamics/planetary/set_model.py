"""Bodies of a planetary set and the springs between them, in a frame that turns with the carrier.

The model of Lin and Parker (1999): every body moves in two directions across the axis and turns; a turn counts as the
length u = r theta at the base circle (of planets with asymmetric teeth at that of the flanks which meet the sun), that
of the carrier at the circle of the pins. Planets move radially (zeta) and
tangentially (eta). Gyroscopic forces of the carrier's rotation are neglected.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.dynamics.planetary.planet_set import CENTRALS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.dynamics.planetary.planet_set import Central, PlanetarySet

#: Coordinates of one body.
AXES = 3


@dataclass(frozen=True)
class CentralBody:
    """Sun, ring or carrier with what holds it.

    Parameters
    ----------
    mass : float
        [kg]
    inertia : float
        About its axis [kg m^2].
    bearing : float
        Stiffness of its bearing in either direction across the axis [N/m]; zero floats, infinity holds.
    turning : float
        Torsional stiffness that holds it [N m/rad]; infinity holds.
    """

    mass: float = math.nan
    inertia: float = math.nan
    bearing: float = math.inf
    turning: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what is no spring and no body."""
        for key in ("bearing", "turning"):
            if not getattr(self, key) >= 0.0:
                raise InputError(key, getattr(self, key), "must be zero or positive")
        for key in ("mass", "inertia"):
            if not (math.isnan(getattr(self, key)) or 0.0 < getattr(self, key) < math.inf):
                raise InputError(key, getattr(self, key), "must be positive and finite")


@dataclass(frozen=True)
class PlanetBody:
    """A planet on its pin.

    Parameters
    ----------
    mass, inertia : float
        [kg], [kg m^2].
    pin : float
        Stiffness of pin and bearing in either direction [N/m]; infinity holds the planet on the carrier.
    """

    mass: float = math.nan
    inertia: float = math.nan
    pin: float = math.inf

    def __post_init__(self) -> None:
        """Refuse what is no spring and no body."""
        if not self.pin > 0.0:
            raise InputError("pin", self.pin, "must be greater than zero")
        for key in ("mass", "inertia"):
            if not (math.isnan(getattr(self, key)) or 0.0 < getattr(self, key) < math.inf):
                raise InputError(key, getattr(self, key), "must be positive and finite")


@dataclass(frozen=True)
class SetModel:
    """Sun, ring, carrier and planets as rigid bodies on springs.

    Coordinates stand in the order x, y, u of sun, ring and carrier, then zeta, eta, u of each planet; x points to the
    angle zero, and the torque on the sun is positive.

    Parameters
    ----------
    found : PlanetarySet
    sun, ring, carrier : CentralBody
    planet : PlanetBody
    mirrored : bool
        Whether the torque on the sun acts clockwise: the set is then seen from its other side, y and all rotations
        change their signs.
    """

    found: PlanetarySet
    sun: CentralBody
    ring: CentralBody
    carrier: CentralBody
    planet: PlanetBody
    mirrored: bool = False

    @property
    def count(self) -> int:
        """Number of planets."""
        return self.found.count

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return AXES * (len(CENTRALS) + self.count)

    @property
    def angles(self) -> Array:
        """Of the planets as the model sees them [rad]."""
        return -self.found.angles if self.mirrored else self.found.angles

    def central(self, member: Central) -> CentralBody:
        """The body of a member."""
        body: CentralBody = getattr(self, member)
        return body

    def _planet(self, n: int) -> int:
        return AXES * (len(CENTRALS) + n)

    @cached_property
    def mesh_rows(self) -> Array:
        """Rows that turn coordinates into the approach of the teeth, at sun (0) and ring (1) of each planet.

        Shape (2, planets, size).
        """
        rows = np.zeros((2, self.count, self.size))
        sun, ring = self.found.sun_angle, self.found.ring_angle
        for n, psi in enumerate(self.angles):
            p = self._planet(n)
            rows[0, n, 0:3] = -math.sin(psi - sun), math.cos(psi - sun), 1.0
            rows[0, n, p : p + 3] = -math.sin(sun), -math.cos(sun), 1.0
            rows[1, n, 3:6] = -math.sin(psi + ring), math.cos(psi + ring), 1.0
            rows[1, n, p : p + 3] = math.sin(ring), -math.cos(ring), -self.found.ring_lever
        rows.setflags(write=False)
        return rows

    @cached_property
    def pin_rows(self) -> Array:
        """Rows that turn coordinates into the way of a pin beyond its planet, radial (0) and tangential (1).

        Shape (2, planets, size).
        """
        rows = np.zeros((2, self.count, self.size))
        for n, psi in enumerate(self.angles):
            p = self._planet(n)
            rows[0, n, 6:9] = math.cos(psi), math.sin(psi), 0.0
            rows[1, n, 6:9] = -math.sin(psi), math.cos(psi), 1.0
            rows[0, n, p] = rows[1, n, p + 1] = -1.0
        rows.setflags(write=False)
        return rows

    @cached_property
    def supports(self) -> Array:
        """Stiffness of what holds each coordinate [N/m], shape (size,); infinity holds it where it is."""
        found = np.zeros(self.size)
        for index, member in enumerate(CENTRALS):
            body = self.central(member)
            turning = body.turning / self.found.lever(member) ** 2
            found[AXES * index : AXES * index + AXES] = body.bearing, body.bearing, turning
        found.setflags(write=False)
        return found

    @cached_property
    def masses(self) -> Array:
        """Mass of each coordinate [kg], shape (size,).

        Raises
        ------
        InputError
            If a body that moves has no mass.
        """
        bodies: list[tuple[str, CentralBody | PlanetBody, float]] = [
            (member, self.central(member), self.found.lever(member)) for member in CENTRALS
        ]
        bodies += [("planet", self.planet, self.found.base_radius("planet"))] * self.count
        found = np.concatenate([[one.mass, one.mass, one.inertia / radius**2] for _, one, radius in bodies])
        moved = np.any(self.free != 0.0, axis=1)
        for index in np.flatnonzero(np.isnan(found) & moved):
            raise InputError(bodies[index // AXES][0], "(not given)", "requires mass and inertia (free to move)")
        return np.where(np.isnan(found), 1.0, found)

    def held(self, turning: Iterable[Central] = ()) -> NDArray[np.bool_]:
        """Which coordinates cannot move, shape (size,): those held by rigid supports, and rotations asked for."""
        fixed = np.isinf(self.supports)
        for member in turning:
            fixed[AXES * CENTRALS.index(member) + 2] = True
        return fixed

    @cached_property
    def free(self) -> Array:
        """Coordinates as functions of those that are free, shape (size, free)."""
        return self.freed(())

    def freed(self, turning: Iterable[Central]) -> Array:
        """The same with the rotations of some members held; planets on rigid pins follow the carrier."""
        basis = np.eye(self.size)
        keep = ~self.held(turning)
        if math.isinf(self.planet.pin):
            for n in range(self.count):
                p = self._planet(n)
                for axis in (0, 1):
                    basis[p + axis] += self.pin_rows[axis, n]
                    keep[p + axis] = False
        return basis[:, keep]

    def with_pin_errors(self, errors: Array) -> Array:
        """Where the coordinates are if only the pins are displaced [m], shape (size,).

        Parameters
        ----------
        errors : ndarray, shape (2, planets)
            Displacement of each pin from its place on the carrier, radially outward and tangentially in the sense of
            the torque on the sun [m].
        """
        start = np.zeros(self.size)
        if math.isinf(self.planet.pin):
            places = [self._planet(n) for n in range(self.count)]
            start[places], start[[p + 1 for p in places]] = errors
        return start

    def held_stiffness(self) -> Array:
        """Stiffness of pins and supports that are not rigid [N/m], shape (size, size)."""
        total = np.diag(np.where(np.isinf(self.supports), 0.0, self.supports))
        if math.isfinite(self.planet.pin):
            rows = self.pin_rows.reshape(-1, self.size)
            total += self.planet.pin * rows.T @ rows
        return total

    def stiffness(self, sun_mesh: float, ring_mesh: float) -> Array:
        """Stiffness with mean mesh stiffnesses [N/m], shape (size, size)."""
        total = self.held_stiffness()
        for rows, stiffness in zip(self.mesh_rows, (sun_mesh, ring_mesh), strict=True):
            total += stiffness * rows.T @ rows
        return total

    def torque_load(self, sun_torque: float) -> Array:
        """Forces of the outer torques on all coordinates [N], shape (size,), for a torque on the sun [N m]."""
        load = np.zeros(self.size)
        force = sun_torque / self.found.lever("sun")
        load[2], load[5] = force, force / self.found.ring_lever
        load[8] = -force * (math.cos(self.found.sun_angle) + math.cos(self.found.ring_angle) / self.found.ring_lever)
        return load
