"""A gearbox ready to be drawn in space: shafts, gears and bearings as bodies of revolution, and how they are moved."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.case.built.shafts import mesh_places

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.case.shaft import ShaftInSpacePart
    from fegear.contact.wide.on_shafts import LoadedShafts

#: Stations of a section of a shaft; its curve between supports is a cubic, or near one.
_STATIONS = 9
#: Outer radius of a drawn bearing over that of its shaft, and its width over the same.
_BEARING, _BEARING_WIDTH = 1.45, 0.6


@dataclass(frozen=True)
class DrawnBody(ReadOnlyArrays):
    """A body of revolution about the axis of its shaft.

    Parameters
    ----------
    kind : {"shaft", "gear", "bearing"}
    name : str
    shaft : str
    z : ndarray, shape (n,)
        Stations along the shaft, from its left end [m].
    outer, inner : ndarray, shape (n,)
        Radii there [m].
    moves_with : ndarray, shape (n,)
        Place of the shaft with which each station moves as a rigid body [m].
    """

    kind: Literal["shaft", "gear", "bearing"]
    name: str
    shaft: str
    z: Array
    outer: Array
    inner: Array
    moves_with: Array


@dataclass(frozen=True)
class DrawnGearbox:
    """All bodies, where the shafts stand, and where their gears mesh.

    Parameters
    ----------
    places : dict of str to tuple of float
        x, y and z of the left end of every shaft [m].
    bodies : tuple of DrawnBody
    meshes : dict of str to tuple of float
        By the pair's name: x, y and z of the pitch point in the middle of the driver's face [m].
    """

    places: dict[str, tuple[float, float, float]]
    bodies: tuple[DrawnBody, ...]
    meshes: dict[str, tuple[float, float, float]]

    @property
    def size(self) -> float:
        """Largest extent of the shafts in space [m]."""
        ends = [
            (x + way * body.outer.max(), y + way * body.outer.max(), z + along)
            for body in self.bodies
            for x, y, z in (self.places[body.shaft],)
            for way in (-1.0, 1.0)
            for along in (body.z[0], body.z[-1])
        ]
        return float(np.ptp(np.array(ends), axis=0).max())


def drawn_gearbox(scene: Scene) -> DrawnGearbox:
    """Make the shafts of a case with what stands on them ready to be drawn.

    Parameters
    ----------
    scene : Scene

    Raises
    ------
    InputError
        If gears of a pair do not meet on their shafts.
    """
    places, bodies = {}, []
    for name, part in scene.case.shaft.items():
        places[name] = (part.axis[0], part.axis[1], part.start)
        shaft = _shaft(name, part)
        bodies.append(shaft)
        for seat in part.bearings:
            radius = float(np.interp(seat.at, shaft.z, shaft.outer))
            bodies.append(_ring("bearing", seat.bearing, name, seat.at, _BEARING_WIDTH * radius, radius, _BEARING))
        for place in part.gears:
            gear = scene.gears[place.gear]
            inner, outer = sorted((gear.bore_radius, gear.tip_radius))
            bodies.append(_ring("gear", place.gear, name, place.at, gear.face_width, inner, outer / inner))
    meshes = {}
    for mesh in mesh_places(scene):
        part = scene.case.shaft[mesh.shafts[0]]
        radius = mesh.found.driver.base_radius / math.cos(mesh.found.working_pressure_angle)
        x, y, _ = np.array([*part.axis, 0.0]) + radius * mesh.axes[1]
        meshes[mesh.pair] = (float(x), float(y), part.start + mesh.at[0])
    return DrawnGearbox(places, tuple(bodies), meshes)


def _shaft(name: str, part: ShaftInSpacePart) -> DrawnBody:
    z: list[Array] = []
    outer: list[Array] = []
    inner: list[Array] = []
    start = 0.0
    for section in part.build().sections:
        share = np.linspace(0.0, 1.0, _STATIONS)
        z.append(start + section.length * share)
        for radii, ends in zip((outer, inner), section.ends, strict=True):
            radii.append(0.5 * (ends[0] + (ends[1] - ends[0]) * share))
        start += section.length
    along = np.concatenate(z)
    return DrawnBody("shaft", name, name, along, np.concatenate(outer), np.concatenate(inner), along)


def _ring(
    kind: Literal["gear", "bearing"], name: str, shaft: str, at: float, width: float, inner: float, times: float
) -> DrawnBody:
    z = at + 0.5 * width * np.array([-1.0, 1.0])
    return DrawnBody(kind, name, shaft, z, np.full(2, times * inner), np.full(2, inner), np.full(2, at))


def motions(data: LoadedShafts, box: DrawnGearbox) -> tuple[Array, ...]:
    """Displacement and turn of every body at its stations, of bearings none; shape (n, 6) each [m, rad].

    Parameters
    ----------
    data : LoadedShafts
    box : DrawnGearbox
    """
    bent = dict(zip(data.gearbox.names, data.nominal.bent, strict=True))
    return tuple(
        np.zeros((body.z.size, 6)) if body.kind == "bearing" else bent[body.shaft].at(body.moves_with)
        for body in box.bodies
    )


def largest_shift(moved: tuple[Array, ...]) -> float:
    """The largest displacement across or along an axis [m]."""
    return max(float(np.hypot(one[:, 0], np.hypot(one[:, 1], one[:, 2])).max()) for one in moved)
