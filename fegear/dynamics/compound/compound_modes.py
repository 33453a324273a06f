"""Natural modes of a planetary set described as data: rigid bodies on the springs of meshes, pins and bearings.

The model of Lin and Parker (1999) for any shafts and planets: every body moves in two directions across the axis and
turns. A planet's motion is radial and tangential at its place; rotations count as lengths at a radius of the body.
Gyroscopic forces of the carriers' rotation are neglected, and carriers that turn against each other stand at the angles
of the planets: with three or more equally spaced planets on each carrier their angles do not matter.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.dynamics.compound.compound_set import Shaft
from fegear.dynamics.planetary.set_modes import modes_by_kind

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from fegear.dynamics.compound.compound_set import CompoundSet, Planets

#: Coordinates of one body.
_AXES = 3


@dataclass(frozen=True)
class CompoundModel:
    """A set as rigid bodies on springs; three coordinates for every shaft, then for every planet, group by group.

    Parameters
    ----------
    of : CompoundSet
        With masses and mesh stiffnesses.
    flanks : tuple of int
        For each mesh the side of its teeth that carries: 1 where the planet pushes its mate at the pitch point
        counter-clockwise about the planet's axis, else -1.
    turning : mapping of str to float
        Torsional stiffness that holds a shaft [N m/rad]; infinity holds, and shafts that are not named are free.
    """

    of: CompoundSet
    flanks: tuple[int, ...]
    turning: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def first(self) -> dict[str, int]:
        """First coordinate of every shaft, and of the first planet of every group."""
        found, at = {}, 0
        for name, member in self.of.members.items():
            found[name] = at
            at += _AXES * (1 if isinstance(member, Shaft) else member.count)
        return found

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return _AXES * (len(self.of.shafts) + sum(one.count for one in self.of.planets))

    def lever(self, member: Shaft | Planets) -> float:
        """Radius at which a rotation counts as a length [m]: of a gear's base circle, or of a carrier's pins."""
        if member.wheels:
            return member.wheels[0].base_radius
        return next((one.radius for one in self.of.planets if one.carrier == member.name), 1.0)

    def _axes(self, member: Shaft | Planets, n: int) -> tuple[int, Array]:
        """First coordinate of a body, and the directions of its two motions as columns."""
        at = self.first[member.name]
        if isinstance(member, Shaft):
            return at, np.eye(2)
        c, s = math.cos(member.angles[n]), math.sin(member.angles[n])
        return at + _AXES * n, np.array([[c, -s], [s, c]])

    def mesh_rows(self, number: int) -> Array:
        """Rows that turn coordinates into the approach of the teeth, shape (planets, size)."""
        toothed = self.of.toothed[number]
        rows = np.zeros((toothed.planets.count, self.size))
        angle, side = self.of.working_angle(toothed), self.flanks[number]
        for n in range(toothed.planets.count):
            toward = self.of.direction(toothed, n)
            e = np.array([math.cos(toward), math.sin(toward)])
            push = side * math.cos(angle) * np.array([-e[1], e[0]]) + math.sin(angle) * e
            for member, sign, radius in (
                (toothed.planets, 1.0, toothed.wheel.base_radius),
                (toothed.other, -1.0, toothed.other_wheel.signed_base_radius),
            ):
                at, axes = self._axes(member, n)
                rows[n, at : at + 2] += sign * push @ axes
                rows[n, at + 2] += side * radius / self.lever(member)
        return rows

    def pin_rows(self, group: Planets) -> Array:
        """Rows that turn coordinates into the way of a pin beyond its planet, radial and tangential."""
        carrier = self.of.members[group.carrier]
        rows = np.zeros((group.count, 2, self.size))
        for n in range(group.count):
            at, axes = self._axes(group, n)
            own = self.first[group.carrier]
            rows[n, :, own : own + 2] = axes.T
            rows[n, 1, own + 2] = group.radius / self.lever(carrier)
            rows[n, 0, at] = rows[n, 1, at + 1] = -1.0
        return rows

    @cached_property
    def supports(self) -> Array:
        """Stiffness of what holds each coordinate [N/m]; infinity holds it where it is."""
        found = np.zeros(self.size)
        for shaft in self.of.shafts:
            at = self.first[shaft.name]
            found[at : at + 2] = shaft.bearing
            found[at + 2] = self.turning.get(shaft.name, 0.0) / self.lever(shaft) ** 2
        return found

    @cached_property
    def free(self) -> Array:
        """Coordinates as functions of those that are free, shape (size, free); planets on rigid pins follow."""
        basis, keep = np.eye(self.size), ~np.isinf(self.supports)
        for group in self.of.planets:
            if math.isfinite(group.pin):
                continue
            for n, rows in enumerate(self.pin_rows(group)):
                at = self.first[group.name] + _AXES * n
                for axis in (0, 1):
                    basis[at + axis] += rows[axis]
                    keep[at + axis] = False
        return basis[:, keep]

    @cached_property
    def masses(self) -> Array:
        """Mass of each coordinate [kg].

        Raises
        ------
        InputError
            If a body that moves has none.
        """
        found = np.ones(self.size)
        moved = np.any(self.free != 0.0, axis=1)
        for member in self.of.members.values():
            copies = 1 if isinstance(member, Shaft) else member.count
            own = slice(self.first[member.name], self.first[member.name] + _AXES * copies)
            known = math.isfinite(member.mass) and math.isfinite(member.inertia)
            if np.any(moved[own]) and not known:
                kind = "shaft" if isinstance(member, Shaft) else "planet"
                raise InputError(f"{kind}.{member.name}.body", "(not given)", "is required for modes (free to move)",
                                 'set body = { mass = "2 kg", inertia = "0.01 kg*m^2" }')  # fmt: skip
            if known:
                each = [member.mass, member.mass, member.inertia / self.lever(member) ** 2]
                found[own] = each * copies
        return found

    def stiffness(self) -> Array:
        """Stiffness of supports, pins and meshes that are not rigid [N/m], shape (size, size)."""
        total = np.diag(np.where(np.isinf(self.supports), 0.0, self.supports))
        for group in self.of.planets:
            if math.isfinite(group.pin):
                rows = self.pin_rows(group).reshape(-1, self.size)
                total += group.pin * rows.T @ rows
        for number, mesh in enumerate(self.of.meshes):
            rows = self.mesh_rows(number)
            total += mesh.stiffness * rows.T @ rows
        return total


@dataclass(frozen=True)
class CompoundModes:
    """Undamped modes of a set, by rising frequency.

    Parameters
    ----------
    shapes : ndarray, shape (size, modes)
        Coordinates as in `CompoundModel`, for unit modal mass.
    frequency, turning, moving : ndarray, shape (modes,)
    kind : tuple of str
        As those of `fegear.dynamics.planetary.set_modes.SetModes`.
    strain : ndarray, shape (meshes, modes)
        Share of the strain energy in each mesh.
    """

    shapes: Array
    strain: Array
    frequency: Array = shown("Hz", "undamped natural frequency with mean mesh stiffnesses")
    kind: tuple[str, ...] = shown("", "mode type (motion of the shafts)")
    turning: Array = shown("", "kinetic energy share, rotation of the shafts")
    moving: Array = shown("", "kinetic energy share, translation of the shafts")


def compound_modes(model: CompoundModel) -> CompoundModes:
    """Modes of a set."""
    central = np.arange(_AXES * len(model.of.shafts))
    turns = central % _AXES == 2
    found = modes_by_kind(model.free, model.masses, model.stiffness(), central[turns], central[~turns])
    strain = [
        np.divide(
            mesh.stiffness * ((model.mesh_rows(number) @ found.shapes) ** 2).sum(axis=0), found.squared,
            out=np.zeros_like(found.squared), where=found.squared > 0.0,
        )
        for number, mesh in enumerate(model.of.meshes)
    ]  # fmt: skip
    return CompoundModes(found.shapes, np.array(strain), found.frequency, found.kind, found.turning, found.moving)


def loaded_flanks(tooth: Sequence[Fraction], direction: int = 1) -> tuple[int, ...]:
    """Sides of the teeth that carry, by the tooth forces of a drive; 1 where a mesh has no load.

    Parameters
    ----------
    tooth : sequence of Fraction
    direction : int
        1 where the driving torque acts counter-clockwise, else -1.
    """
    return tuple(1 if not force else -direction if force > 0 else direction for force in tooth)
