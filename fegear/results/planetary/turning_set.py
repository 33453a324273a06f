"""A planetary set ready to be drawn turning: real tooth outlines in mesh, where the flanks touch, and what they carry.

Angles count counter-clockwise from +x [rad]. The cycle q counts base pitches: at q = 0 a tooth pair of sun and first
planet touches at their pitch point, and all tooth pairs move on by one pitch while q grows by one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.case.built.planetary import planet_at, planetary_part, set_inputs
from fegear.case.planetary import set_pair
from fegear.geometry.outline import tooth_outline

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.built.planetary import SetInputs
    from fegear.case.planetary import Mesh
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.planet_loads import PlanetLoads
    from fegear.dynamics.planetary.planet_set import PlanetarySet
    from fegear.geometry.gear import Gear

#: How far chords of a tooth may lie off its outline [modules].
_CHORD = 1e-3


@dataclass(frozen=True)
class TurningGear(ReadOnlyArrays):
    """Sun, planets or ring: one tooth, how many there are, and how they stand.

    Parameters
    ----------
    teeth : int
    tooth : ndarray, shape (2, N)
        Outline of one tooth, its centre line along +y [m]; no points where the gear is not of the case.
    start : ndarray, shape (copies,)
        Angle of a tooth's centre line in the frame of the carrier at q = 0, of every copy.
    turn : float
        By which it turns against the carrier while q grows by one.
    radius : float
        Of its bore, of the ring's outside, or, where it is not of the case, of its working pitch circle [m].
    """

    teeth: int
    tooth: Array
    start: Array
    turn: float
    radius: float


@dataclass(frozen=True)
class TurningMesh(ReadOnlyArrays):
    """The meshes of all planets with the sun or the ring.

    Parameters
    ----------
    radius : float
        Of the pitch points from the axis of the set [m].
    along : tuple of float
        Unit vector of the line of action at a planet, outward and counter-clockwise: the way contacts move.
    push : int
        1 where the force on the planet points that way, else -1.
    delay : ndarray, shape (planets,)
        Of each planet's mesh [base pitches]: a tooth pair stands at x = (q - delay + k) p_b.
    start, end : float
        Of the path of contact [m]; both zero where the mating gear is not of the case.
    base_pitch : float
        p_b [m].
    """

    radius: float
    along: tuple[float, float]
    push: int
    delay: Array
    start: float
    end: float
    base_pitch: float


@dataclass(frozen=True)
class TurningSet(ReadOnlyArrays):
    """All of a set; `carrier` is by how much the carrier turns while q grows by one, `driving` what is driven.

    Parameters
    ----------
    gears : dict of str to TurningGear
        By "sun", "planet" and "ring".
    meshes : dict of str to TurningMesh
        By "sun" and "ring".
    angles : ndarray, shape (planets,)
        Of the planets on the carrier.
    centre_distance, module : float
        [m].
    carrier : float
    per_cycle : float
        Turn of the driving member against the housing while q grows by one.
    driving, fixed : str
        "sun", "ring" or "carrier".
    """

    gears: dict[str, TurningGear]
    meshes: dict[str, TurningMesh]
    angles: Array
    centre_distance: float
    module: float
    carrier: float
    per_cycle: float
    driving: str
    fixed: str


@dataclass(frozen=True)
class TurningLoads(ReadOnlyArrays):
    """What the meshes of the planets carry over the cycle.

    Parameters
    ----------
    q : ndarray, shape (M,)
        Places in the cycle, ascending.
    force : ndarray, shape (2, planets, M)
        In the meshes with sun (0) and ring (1) [N].
    mean : float
        Where all planets carry alike [N].
    shares : ndarray, shape (planets,)
        Mean load of each planet over an equal share.
    """

    q: Array
    force: Array
    mean: float
    shares: Array


def turning_loads(data: PlanetLoads) -> TurningLoads:
    """Loads of the planets in the order of the cycle."""
    order = np.argsort(data.s)
    return TurningLoads(data.s[order], data.mesh_force[:, :, order], data.mean_force, data.shares)


def turning_set(scene: Scene, name: str) -> TurningSet:
    """Make a set ready to be turned.

    A tooth that drives stands behind its contact by half its thickness at the working pitch circle, one that is driven
    ahead of it. The first planet places the ring: its flank reaches the pitch point of their mesh at the phase between
    both meshes.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the set.

    Raises
    ------
    GeometryError
        If the set cannot be assembled.
    """
    part, asked = planetary_part(scene, name), set_inputs(scene, name)
    found, phases = asked.found, asked.phases
    sun, planet = scene.gears[part.sun], planet_at(scene, name, "sun")
    ring = None if part.ring is None else scene.gears[part.ring]
    way = math.copysign(1.0, asked.run.sun_turns)  # of the sun against the carrier
    push = way if asked.run.sun_drives else -way  # of the sun on the planets
    turn = {one: 2.0 * math.pi * way / getattr(found, f"{one}_teeth") for one in ("sun", "planet", "ring")}
    first = found.angles[0]
    of_sun = first - push * _half(found, sun, "sun")
    of_planet = first + math.pi - push * _half(found, planet, "sun")
    ahead = found.angles - first
    planets = of_planet + ahead * (1.0 + found.sun_teeth / found.planet_teeth)
    of_ring = first + turn["ring"] * phases.ring_behind_sun - push * (_half(found, ring, "ring") if ring else 0.0)
    speeds = {"sun": turn["sun"], "ring": -turn["ring"], "carrier": 0.0}
    carrier = -speeds[asked.run.fixed]
    distance = found.centre_distance
    none = np.empty((2, 0))
    return TurningSet(
        {
            "sun": TurningGear(sun.teeth, _tooth(sun, push), np.array([of_sun]), turn["sun"], sun.bore_radius),
            "planet": TurningGear(planet.teeth, _tooth(planet, push), planets, -turn["planet"], planet.bore_radius),
            "ring": TurningGear(
                found.ring_teeth, none if ring is None else _tooth(ring, push), np.array([of_ring]), -turn["ring"],
                found.base_radius("ring") / math.cos(found.ring_angle) if ring is None else ring.bore_radius,
            ),
        },
        {"sun": _mesh(scene, asked, "sun", push), "ring": _mesh(scene, asked, "ring", push)},
        found.angles, distance, planet.module, carrier,
        speeds[asked.run.input] + carrier, asked.run.input, asked.run.fixed,
    )  # fmt: skip


def _half(found: PlanetarySet, gear: Gear, mesh: Mesh) -> float:
    """Angle from the middle of a gear's tooth to its loaded flank at its working pitch circle of a mesh."""
    angle = found.sun_angle if mesh == "sun" else found.ring_angle
    return float(gear.tooth.flank_angle(gear.base_radius / math.cos(angle) / gear.module))


def _tooth(gear: Gear, push: float) -> Array:
    """A tooth, with its loaded flank toward where it is pushed."""
    found = tooth_outline(gear.tooth, _CHORD) * gear.module
    return found[:, ::-1] * np.array([[-1.0], [1.0]]) if gear.asymmetric and push > 0.0 else found


def _mesh(scene: Scene, asked: SetInputs, mesh: Mesh, push: float) -> TurningMesh:
    found, row = asked.found, 0 if mesh == "sun" else 1
    angle = found.sun_angle if mesh == "sun" else found.ring_angle
    force = (math.sin(angle) * (1.0 if mesh == "sun" else -1.0), push * math.cos(angle))
    # contacts move from the driver's root to its tip: with the force on a planet that is driven, against that on one
    # that drives
    planet_driven = asked.run.sun_drives == (mesh == "sun")
    side = 1 if planet_driven else -1
    pair = scene.pairs.get(set_pair(asked.name, mesh))
    return TurningMesh(
        found.base_radius(mesh) / math.cos(angle),
        (side * force[0], side * force[1]),
        side,
        asked.phases.delays[row],
        0.0 if pair is None else pair.x_start,
        0.0 if pair is None else pair.x_end,
        found.base_pitch if mesh == "sun" else found.ring_base_pitch,
    )
