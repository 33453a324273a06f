"""Diameters of drafted shafts for their deflection: what their bending opens over the faces stays small to the teeth's.

Bearings are taken as rigid; the reactions are those of statics, so that each shaft bends for itself. Both gears of a
mesh tilt in its plane of action, and what they tilt against each other adds up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.shafts.beam import Shaft
from fegear.shafts.bearing_seat import SHOULDER
from fegear.shafts.section import Section

#: What the shafts may add to K_Hbeta, and mesh stiffness c_gamma_beta per face width, ISO 6336-1 [Pa].
MOST_OF_LOAD, _STIFFNESS = 0.2, 17e9
#: Diameter over that of the seats from which a collar lies between both.
_COLLAR = 1.25
#: Step of diameters [m].
_STEP = 1e-3


class MeshOnShaft(NamedTuple):
    """A mesh on one of its shafts: place from its left end, forces, radius, 1 for a pinion or -1 for a wheel, face."""

    at: float
    tangential: float
    radial: float
    axial: float
    radius: float
    side: float
    face: float


class Ends(NamedTuple):
    """Seats of a shaft: their diameter and length, places of the bearings, room before the faces [m]."""

    seat: float
    seat_length: float
    bearings: tuple[float, float]
    clear: float

    @property
    def length(self) -> float:
        """Of the shaft [m]."""
        return self.bearings[1] + 0.5 * self.seat_length


def collar(seat: float, thick: float) -> float:
    """Diameter of the collar beside a bearing; zero where the shaft itself is the shoulder [m]."""
    return math.ceil(SHOULDER * seat * 1e3) * 1e-3 if thick > _COLLAR * seat else 0.0


def sections(ends: Ends, thick: float) -> list[tuple[float, float]]:
    """Lengths and diameters of a shaft's sections from its left end [m]."""
    beside, between = collar(ends.seat, thick), ends.length - 2.0 * ends.seat_length
    if not beside:
        return [(ends.seat_length, ends.seat), (between, thick), (ends.seat_length, ends.seat)]
    half = [(ends.seat_length, ends.seat), (0.5 * ends.clear, beside)]
    return [*half, (between - ends.clear, thick), *half[::-1]]


def tilts(meshes: Sequence[MeshOnShaft], ends: Ends, thick: float, turned: float) -> list[float]:
    """What a shaft's bending opens over the face of each of its meshes, in its plane of action [m].

    Parameters
    ----------
    meshes : sequence of MeshOnShaft
    ends : Ends
    thick : float
        Diameter between its seats [m].
    turned : float
        1 or -1: sense of rotation, with which axial forces change their direction against the radial ones.
    """
    shaft = Shaft(tuple(Section(long, across) for long, across in sections(ends, thick)))
    left, right = ends.bearings
    places = [one.at for one in meshes]
    # On shafts in a row both meshes of the middle one push it up, and from both sides.
    forces = np.array([
        [one.tangential, -one.side * one.radial, 0.0, turned * one.axial * one.radius, 0.0, 0.0] for one in meshes
    ])  # fmt: skip
    arm = np.array(places) - left
    on_right = -(arm @ forces[:, :2] - np.array([0.0, forces[:, 3].sum()])) / (right - left)
    on_left = -forces[:, :2].sum(axis=0) - on_right
    at = np.array([left, right, *places])
    all_loads = np.zeros((at.size, 6))
    all_loads[0, :2], all_loads[1, :2], all_loads[2:] = on_left, on_right, forces
    bent: Array = shaft.bent(at, at, all_loads)
    chord = (bent[1, :2] - bent[0, :2]) / (right - left)
    turn_x, turn_y = bent[2:, 4] - chord[0], -bent[2:, 3] - chord[1]
    found = []
    for one, x, y in zip(meshes, turn_x, turn_y, strict=True):
        along = math.hypot(one.tangential, one.radial)
        found.append(one.face * (x * one.tangential - y * one.side * one.radial) / along)
    return found


def permissible(mesh: MeshOnShaft) -> float:
    """What both shafts of a mesh may open over its face together [m]: 2 (K_Hbeta - 1) F/b over the mesh stiffness."""
    return 2.0 * MOST_OF_LOAD * math.hypot(mesh.tangential, mesh.radial) / mesh.face / _STIFFNESS


def stiff_diameters(
    shafts: Sequence[tuple[Sequence[MeshOnShaft], Ends]], thick: Sequence[float], most: Sequence[float]
) -> tuple[float, ...]:
    """Diameters with which no mesh opens more than is permissible, as far as there is room [m].

    Parameters
    ----------
    shafts : sequence
        In a row: the wheel of a stage, then the pinion of the next one.
    thick, most : sequence of float
        Diameters that strength asks for, and those that there is room for [m].
    """
    found = list(thick)
    stages = len(shafts) - 1
    known = [_worst(*one, d) for one, d in zip(shafts, found, strict=True)]
    while True:
        open_now = []
        for stage in range(stages):
            pinion, wheel = known[stage][-1], known[stage + 1][0]
            allowed = permissible(shafts[stage][0][-1])
            if pinion + wheel > allowed:
                more = [n for n in (stage, stage + 1) if found[n] + _STEP <= most[n] + 1e-9]
                if more:
                    share = {stage: pinion, stage + 1: wheel}
                    open_now.append(((pinion + wheel) / allowed, max(more, key=lambda n: share[n] / found[n])))
        if not open_now:
            return tuple(found)
        n = max(open_now)[1]
        found[n] += _STEP
        known[n] = _worst(*shafts[n], found[n])


def _worst(meshes: Sequence[MeshOnShaft], ends: Ends, thick: float) -> list[float]:
    """The larger tilts of both senses of rotation."""
    return [max(map(abs, both)) for both in zip(*(tilts(meshes, ends, thick, s) for s in (1.0, -1.0)), strict=True)]
