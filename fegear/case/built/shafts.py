"""From ``[shaft.NAME]`` and ``[bearing.NAME]`` to loaded shafts: the forces of all meshes, and what they tilt.

The force of a mesh acts in the middle of the face: how the load lies over the face is not yet fed back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.part import at, nearest
from fegear.shafts.solution import Deflection, LoadedShaft, Seat, deflect

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.geometry.pair import GearPair

#: By so much the distance of two axes may differ from a pair's centre distance [m].
_APART = 1e-6


@dataclass(frozen=True)
class MeshPlace:
    """Where a pair of the case meshes between two shafts.

    Parameters
    ----------
    pair : str
    shafts : tuple of str
        Of driver and driven.
    at : tuple of float
        Middle of the faces from the left ends [m].
    towards : ndarray, shape (2,)
        From the driver's axis to the driven one's.
    sense : int
        1 where the driver turns counter-clockwise seen from +z, else -1.
    found : GearPair
    load : float
        Along the transverse line of action [N].
    """

    pair: str
    shafts: tuple[str, str]
    at: tuple[float, float]
    towards: Array
    sense: int
    found: GearPair
    load: float

    @property
    def ahead(self) -> Array:
        """Direction in which the driver pushes the driven gear at the pitch point, shape (2,)."""
        return self.sense * np.array([-self.towards[1], self.towards[0]])

    @property
    def force(self) -> Array:
        """On the driven gear, shape (3,) [N]."""
        angle = self.found.working_pressure_angle
        across = self.load * (self.ahead * math.cos(angle) + self.towards * math.sin(angle))
        driver = self.found.driver
        return np.append(across, -self.sense * self.load * driver.base_radius * driver.twist)

    def loads(self) -> tuple[Array, Array]:
        """Force and moment at the axes of driver and driven, shape (6,) each."""
        angle, found = self.found.working_pressure_angle, []
        for gear, side in ((self.found.driver, 1.0), (self.found.driven, -1.0)):
            arm = np.append(side * self.towards * gear.base_radius / math.cos(angle), 0.0)
            force = -side * self.force
            found.append(np.concatenate([force, np.cross(arm, force)]))
        return found[0], found[1]


@dataclass(frozen=True)
class ShaftInputs:
    """Shafts of a case under the forces of its meshes, as they are and with rigid shafts.

    Parameters
    ----------
    shafts, rigid : tuple of LoadedShaft
    names : tuple of str
    housing : ndarray, shape (5 b, 5 b)
    meshes : tuple of MeshPlace
    """

    shafts: tuple[LoadedShaft, ...]
    rigid: tuple[LoadedShaft, ...]
    names: tuple[str, ...]
    housing: Array
    meshes: tuple[MeshPlace, ...]


def mesh_places(scene: Scene) -> tuple[MeshPlace, ...]:
    """Every loaded pair both of whose gears stand on shafts.

    Raises
    ------
    InputError
        If a gear stands on two shafts, faces are not side by side, or axes are not at the centre distance.
    """
    where: dict[str, tuple[str, float]] = {}
    for name, part in scene.case.shaft.items():
        for n, place in enumerate(part.gears):
            key = f"shaft.{name}.gears.{n}.gear"
            if place.gear not in scene.gears:
                raise InputError(key, f'"{place.gear}"', "is no gear of this case", nearest(place.gear, scene.gears))
            if place.gear in where:
                raise InputError(
                    key, f'"{place.gear}"', f"stands on shaft {where[place.gear][0]} already", "name it once"
                )
            where[place.gear] = name, place.at
    found = []
    driven = {where[one.driven][0] for one in scene.case.pair.values() if one.driven in where and one.driver in where}
    senses = {name: -1 if part.clockwise else 1 for name, part in scene.case.shaft.items() if name not in driven}
    left = {name: one for name, one in scene.case.pair.items() if one.driver in where and one.driven in where}
    while left:
        ready = [name for name, one in left.items() if where[one.driver][0] in senses]
        if not ready:
            raise InputError(
                "shaft", ", ".join(sorted(driven)), "drive each other in a loop", "let one drive the others"
            )
        for name in ready:
            one = left.pop(name)
            ends = where[one.driver], where[one.driven]
            found.append(_mesh(scene, name, ends, senses[ends[0][0]]))
            senses[ends[1][0]] = -senses[ends[0][0]]
    return tuple(found)


def _mesh(scene: Scene, name: str, ends: tuple[tuple[str, float], tuple[str, float]], sense: int) -> MeshPlace:
    pair, part = scene.pairs[name], scene.case.pair[name]
    if pair.internal:
        raise InputError(
            f"pair.{name}", "an internal pair", "is not yet known to shafts", "take its gears off the shafts"
        )
    first, second = (scene.case.shaft[shaft] for shaft, _ in ends)
    across = np.subtract(second.axis, first.axis)
    apart = float(np.hypot(*across))
    if abs(apart - pair.centre_distance) > _APART:
        raise InputError(
            f"shaft.{ends[1][0]}.axis", f"{apart * 1e3:.6g} mm from shaft {ends[0][0]}",
            f"is not at the centre distance of pair {name}, {pair.centre_distance * 1e3:.6g} mm",
            "move one of the axes",
        )  # fmt: skip
    middles = first.start + ends[0][1], second.start + ends[1][1]
    if abs(middles[0] - middles[1]) >= 0.5 * (pair.driver.face_width + pair.driven.face_width):
        raise InputError(
            f"shaft.{ends[1][0]}.gears", f"middle at {middles[1] * 1e3:.6g} mm",
            f"does not meet its mate of pair {name} at {middles[0] * 1e3:.6g} mm",
            "move the gear, or the shaft's start",
        )  # fmt: skip
    load = part.normal_load(pair)
    if load is None:
        raise InputError(f"pair.{name}.load", "(not given)", "is needed to bend its shafts", "give load or torque")
    return MeshPlace(name, (ends[0][0], ends[1][0]), (ends[0][1], ends[1][1]), across / apart, sense, pair, load)


def shaft_inputs(scene: Scene) -> ShaftInputs:
    """Collect the shafts of a case with all that acts on them.

    Raises
    ------
    InputError
        If a name is unknown, a shaft is not held, or something is off it.
    """
    meshes = mesh_places(scene)
    made: dict[bool, list[LoadedShaft]] = {False: [], True: []}
    seat_compliance: list[float] = []
    for name, part in scene.case.shaft.items():
        places, loads = _outer(scene, name, meshes)
        seats = []
        for n, place in enumerate(part.bearings):
            known = scene.case.bearing
            if place.bearing not in known:
                key = f"shaft.{name}.bearings.{n}.bearing"
                raise InputError(key, f'"{place.bearing}"', "is no bearing of this case", nearest(place.bearing, known))
            data = known[place.bearing]
            try:
                seats.append(Seat(data.build(mirrored=place.reversed), place.at, f"bearings.{n}"))
            except InputError as error:
                raise at(f"bearing.{place.bearing}", error) from None
            across, along = (1.0 / k if k else 0.0 for k in (data.housing_radial, data.housing_axial))
            seat_compliance += [across, across, along, 0.0, 0.0]
        for rigid, these in made.items():
            try:
                body = part.build(rigid=rigid)
            except InputError as error:
                raise at(f"shaft.{name}", error) from None
            these.append(LoadedShaft(body, tuple(seats), places, loads, f"shaft.{name}"))
    return ShaftInputs(tuple(made[False]), tuple(made[True]), tuple(scene.case.shaft), np.diag(seat_compliance), meshes)


def _outer(scene: Scene, name: str, meshes: tuple[MeshPlace, ...]) -> tuple[Array, Array]:
    """Where forces act on a shaft and what they are; the coupling takes the torque that is left."""
    part = scene.case.shaft[name]
    places: list[float] = []
    loads: list[Array] = []
    for mesh in meshes:
        for shaft, place, load in zip(mesh.shafts, mesh.at, mesh.loads(), strict=True):
            if shaft == name:
                places.append(place)
                loads.append(load)
    for one in part.loads:
        places.append(one.at)
        loads.append(np.array([*(one.force or (0.0,) * 3), *(one.moment or (0.0,) * 3)]))
    if part.coupling is not None:
        places.append(part.coupling)
        loads.append(np.array([0.0] * 5 + [-sum(float(load[5]) for load in loads)]))
    return np.array(places), np.array(loads).reshape(-1, 6)


def tilt_of(mesh: MeshPlace, bent: dict[str, Deflection]) -> Array:
    """Deviation of a mesh's axes from parallel, in and out of their plane, and the wind-up of both gears [rad].

    As `ShaftTilt` counts them, positive where the gap opens toward +z; the wind-up lies in the plane of action.
    Shape (3,).
    """
    turns, wind = [], 0.0
    for shaft, place, gear in zip(mesh.shafts, mesh.at, (mesh.found.driver, mesh.found.driven), strict=True):
        half, length = 0.5 * gear.face_width, bent[shaft].loaded.shaft.length
        ends = np.clip([place - half, place + half], 0.0, length)
        twisted = bent[shaft].at([*ends, place])
        turns.append(np.array([twisted[2, 4], -twisted[2, 3]]))
        wind -= mesh.sense * gear.base_radius * float(twisted[1, 5] - twisted[0, 5]) / gear.face_width
    apart = turns[1] - turns[0]
    return np.array([apart @ mesh.towards, apart @ mesh.ahead, wind])


def deflected(asked: ShaftInputs) -> tuple[dict[str, Deflection], dict[str, Deflection]]:
    """All shafts in equilibrium by name, as they are and as if they did not bend."""
    bent, rigid = (
        dict(zip(asked.names, deflect(these, asked.housing), strict=True)) for these in (asked.shafts, asked.rigid)
    )
    return bent, rigid
