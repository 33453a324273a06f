"""A planetary set as data: shafts on its axis, planets that ride on them, the gears of both, and what meshes.

Every shaft is one rigid body about the axis: a sun, a ring, a carrier, or several of them in one piece. A planet of a
group is one rigid body as well: one with several gears is a stepped planet. Lengths are in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import GeometryError, InputError
from fegear.geometry.involute import inv

if TYPE_CHECKING:
    from collections.abc import Iterator

#: By how much base pitches of two gears in mesh may differ, as a share.
_ONE_PITCH = 1e-9


@dataclass(frozen=True)
class Wheel:
    """A gear of a shaft or planet.

    Parameters
    ----------
    name : str
    teeth : int
        Positive.
    internal : bool
    base_radius, tip_radius : float
        [m]; nan where only speeds and torques are wanted.
    base_half_angle : float
        Half the angle of a tooth at the base circle [rad].
    """

    name: str
    teeth: int
    internal: bool = False
    base_radius: float = math.nan
    tip_radius: float = math.nan
    base_half_angle: float = math.nan

    @property
    def signed(self) -> int:
        """Number of teeth, negative of an internal gear."""
        return -self.teeth if self.internal else self.teeth

    @property
    def signed_base_radius(self) -> float:
        """Base radius, negative of an internal gear [m]."""
        return -self.base_radius if self.internal else self.base_radius

    def half_tooth(self, angle: float) -> float:
        """Half the angle of a tooth where the pressure angle is this [rad]."""
        turned = float(inv(angle))
        return self.base_half_angle + (turned if self.internal else -turned)


@dataclass(frozen=True)
class Shaft:
    """A body about the axis of the set.

    Parameters
    ----------
    name : str
    wheels : tuple of Wheel
    mass, inertia : float
        [kg], [kg m^2]; nan where only speeds, torques and phases are wanted.
    bearing : float
        Stiffness of its bearing in either direction across the axis [N/m]; zero floats, infinity holds.
    """

    name: str
    wheels: tuple[Wheel, ...] = ()
    mass: float = math.nan
    inertia: float = math.nan
    bearing: float = math.inf


@dataclass(frozen=True)
class Planets:
    """Equal planets on one carrier.

    Parameters
    ----------
    name : str
    carrier : str
        Shaft on which they ride.
    wheels : tuple of Wheel
    angles : tuple of float
        Of their centres, counter-clockwise [rad].
    radius : float
        Of the circle of their centres [m].
    mass, inertia : float
        Of one [kg], [kg m^2].
    pin : float
        Stiffness of pin and bearing in either direction [N/m]; infinity holds.
    """

    name: str
    carrier: str
    wheels: tuple[Wheel, ...]
    angles: tuple[float, ...]
    radius: float = math.nan
    mass: float = math.nan
    inertia: float = math.nan
    pin: float = math.inf

    @property
    def count(self) -> int:
        """Number of planets."""
        return len(self.angles)


class End(NamedTuple):
    """A gear in mesh: the shaft or group of planets, and its gear, by name."""

    member: str
    wheel: str


@dataclass(frozen=True)
class Mesh:
    """Two gears in mesh, in every planet of a group.

    Parameters
    ----------
    first, second : End
        A planet, and the shaft or other planet that it meshes with, in either order.
    efficiency : float
        Power out over power in, with the carrier at rest.
    stiffness : float
        Of the mesh of one planet, mean [N/m]; nan where modes are not wanted.
    """

    first: End
    second: End
    efficiency: float = 1.0
    stiffness: float = math.nan

    @property
    def name(self) -> str:
        """Both members."""
        return f"{self.first.member}-{self.second.member}"


class Toothed(NamedTuple):
    """A mesh of a set with what it joins.

    A planet comes first; an internal gear, and of two planets the one that is named last, second.
    """

    mesh: Mesh
    planets: Planets
    wheel: Wheel
    other: Shaft | Planets
    other_wheel: Wheel


@dataclass(frozen=True)
class CompoundSet:
    """Shafts, planets and meshes.

    Raises
    ------
    InputError
        If members are named twice, a mesh or a carrier names nothing, gears cannot mesh, or meshes close a loop.
    GeometryError
        If base pitches differ, or gears in mesh have no line of action.
    """

    shafts: tuple[Shaft, ...]
    planets: tuple[Planets, ...]
    meshes: tuple[Mesh, ...]

    def __post_init__(self) -> None:
        """Refuse what cannot be a set."""
        for names, key in ((self.names, ""), ([one.name for one in self.meshes], "mesh")):
            twice = next((one for one in names if list(names).count(one) > 1), None)
            if twice is not None:
                raise InputError(key or twice, f'"{twice}"', "is the name of two members" if not key else
                                 "is given twice", "name every member and every mesh once")  # fmt: skip
        for group in self.planets:
            if group.carrier not in self.shaft_names:
                raise InputError(f"planet.{group.name}.carrier", f'"{group.carrier}"', "must be a shaft of the set",
                                 f"name one of {', '.join(self.shaft_names)}")  # fmt: skip
            if any(wheel.internal for wheel in group.wheels):
                raise InputError(f"planet.{group.name}", "(internal gear)", "must have external gears only",
                                 "give internal gears to a shaft")  # fmt: skip
            self._check_angles(group)
        for number, mesh in enumerate(self.meshes):
            self._check_mesh(number, mesh)
        for group in self.planets:
            if not any(group.name in (one.first.member, one.second.member) for one in self.meshes):
                raise InputError(f"planet.{group.name}", "(no mesh)", "must mesh with a shaft or another planet",
                                 "add the mesh, or remove the planet")  # fmt: skip
        for number, toothed in enumerate(self.toothed):
            self._check_line_of_action(number, toothed)

    @property
    def shaft_names(self) -> tuple[str, ...]:
        """Names of the shafts."""
        return tuple(one.name for one in self.shafts)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of shafts and planets."""
        return (*self.shaft_names, *(one.name for one in self.planets))

    @cached_property
    def members(self) -> dict[str, Shaft | Planets]:
        """Shafts and planets by name."""
        every: tuple[Shaft | Planets, ...] = (*self.shafts, *self.planets)
        return {one.name: one for one in every}

    def wheel(self, end: End) -> Wheel:
        """The gear of an end."""
        return next(one for one in self.members[end.member].wheels if one.name == end.wheel)

    @staticmethod
    def _check_angles(group: Planets) -> None:
        angles = np.array(group.angles)
        key = f"planet.{group.name}.angles"
        if not angles.size:
            raise InputError(key, "(none)", "must name at least one planet", "set planets = 3")
        if np.any(np.diff(angles) <= 0.0) or angles[-1] - angles[0] >= 2.0 * math.pi:
            raise InputError(
                key, ", ".join(f"{one:.6g} deg" for one in np.degrees(angles)),
                "must be increasing within one revolution", "specify the planets counter-clockwise",
            )  # fmt: skip

    def _check_mesh(self, number: int, mesh: Mesh) -> None:
        key = f"mesh[{number}].gears"
        for end in (mesh.first, mesh.second):
            member = self.members.get(end.member)
            if member is None:
                raise InputError(key, f'"{end.member}"', "must be a shaft or planet of the set",
                                 f"name one of {', '.join(self.names)}")  # fmt: skip
            if end.wheel not in [one.name for one in member.wheels]:
                raise InputError(key, f'"{end.member}.{end.wheel}"', f"must be a gear of {end.member}",
                                 "name one of its gears")  # fmt: skip
        first, second = self.members[mesh.first.member], self.members[mesh.second.member]
        both = f'"{first.name}", "{second.name}"'
        if isinstance(first, Shaft) and isinstance(second, Shaft):
            raise InputError(key, both, "must include a planet (both members rotate about the axis of the set)",
                             "use a planet that meshes with each of them")  # fmt: skip
        if isinstance(first, Planets) and isinstance(second, Planets):
            if first.name == second.name:
                raise InputError(key, both, "must be two members", "name another member")
            if first.carrier != second.carrier:
                raise InputError(key, both, f"are on two carriers, {first.carrier} and {second.carrier}",
                                 "planets in mesh must be on the same carrier")  # fmt: skip
            if first.count != second.count:
                raise InputError(key, both, f"are {first.count} and {second.count} planets",
                                 "planets in mesh must be equal in number")  # fmt: skip
        elif (isinstance(first, Planets) and first.carrier == second.name) or (
            isinstance(second, Planets) and second.carrier == first.name
        ):
            raise InputError(key, both, "must be two members that can rotate relative to each other (a planet cannot "
                             "mesh with its own carrier)", "name another shaft")  # fmt: skip
        if not 0.0 < mesh.efficiency <= 1.0:
            raise InputError(f"mesh[{number}].efficiency", mesh.efficiency, "must be above 0 and at most 1")

    @cached_property
    def toothed(self) -> tuple[Toothed, ...]:
        """Every mesh with what it joins."""
        found = []
        for mesh in self.meshes:
            ends = mesh.first, mesh.second
            if not isinstance(self.members[ends[0].member], Planets):
                ends = ends[1], ends[0]
            planets = next(one for one in self.planets if one.name == ends[0].member)
            found.append(Toothed(mesh, planets, self.wheel(ends[0]), self.members[ends[1].member], self.wheel(ends[1])))
        return tuple(found)

    def distance(self, toothed: Toothed) -> float:
        """Centre distance of a mesh [m]."""
        planets, other = toothed.planets, toothed.other
        if isinstance(other, Shaft):
            return planets.radius
        between = other.angles[0] - planets.angles[0]
        return math.sqrt(planets.radius**2 + other.radius**2 - 2.0 * planets.radius * other.radius * math.cos(between))

    def working_angle(self, toothed: Toothed) -> float:
        """Working pressure angle of a mesh [rad]."""
        radii = abs(toothed.wheel.base_radius + toothed.other_wheel.signed_base_radius)
        return math.acos(radii / self.distance(toothed))

    def direction(self, toothed: Toothed, n: int = 0) -> float:
        """Direction of the line from the planet to the other gear's pitch point, of planet n [rad]."""
        planets, other = toothed.planets, toothed.other
        angle = planets.angles[n]
        if isinstance(other, Shaft):
            return angle if toothed.other_wheel.internal else angle + math.pi
        here, there = (
            one.radius * np.array([math.cos(one.angles[n]), math.sin(one.angles[n])]) for one in (planets, other)
        )
        return math.atan2(*(there - here)[::-1])

    def _check_line_of_action(self, number: int, toothed: Toothed) -> None:
        planet, other = toothed.wheel, toothed.other_wheel
        key = f"mesh[{number}].gears"
        if other.internal and other.teeth <= planet.teeth:
            raise GeometryError(key, f"{planet.teeth} teeth in {other.teeth}",
                                "must have more teeth on the internal gear than on the planet",
                                "change the numbers of teeth")  # fmt: skip
        if isinstance(toothed.other, Planets):
            turns = np.array(toothed.other.angles) - np.array(toothed.planets.angles)
            if np.ptp(turns) > 1e-9:
                raise InputError(key, toothed.mesh.name, "must have the same angle between the two planets of each "
                                 "mesh", "specify the angles of both groups with one offset between them")  # fmt: skip
        if math.isnan(planet.base_radius) or math.isnan(other.base_radius) or math.isnan(toothed.planets.radius):
            return
        pitches = planet.base_radius / planet.teeth, other.base_radius / other.teeth
        if abs(pitches[0] - pitches[1]) > _ONE_PITCH * pitches[0]:
            raise GeometryError(
                key, " and ".join(f"{2e3 * math.pi * one:.6g} mm" for one in pitches),
                "are base pitches that must be equal for the gears to mesh", "use the same module and pressure angle",
            )  # fmt: skip
        radii = abs(planet.base_radius + other.signed_base_radius)
        distance = self.distance(toothed)
        if distance <= radii:
            raise GeometryError(
                key, f"centre distance {distance * 1e3:.6g} mm",
                f"must exceed {radii * 1e3:.6g} mm, for a line of action to exist",
                "increase it, or change the numbers of teeth",
            )  # fmt: skip

    def rolling(self) -> list[list[int]]:
        """Rows that turn speeds of shafts and planets into rolling of each mesh, which is zero.

        With signed numbers of teeth: z_i w_i + z_j w_j - (z_i + z_j) w_c = 0, w_c that of the carrier.
        """
        column = {name: k for k, name in enumerate(self.names)}
        rows = []
        for planets, wheel, other, other_wheel in (one[1:] for one in self.toothed):
            row = [0] * len(column)
            row[column[planets.name]] += wheel.signed
            row[column[other.name]] += other_wheel.signed
            row[column[planets.carrier]] -= wheel.signed + other_wheel.signed
            rows.append(row)
        return rows

    def carriers(self) -> Iterator[str]:
        """Shafts on which planets ride, each once."""
        yield from dict.fromkeys(group.carrier for group in self.planets)
