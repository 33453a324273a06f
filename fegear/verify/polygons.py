"""Phases of a planetary set's meshes by brute force: polygons of sun, planets and ring turned until they touch.

Planets are turned by the sun's polygon, the ring by each planet's; where the flanks then cross their pitch circles is
the phase. Tooth numbers, shifts and angles enter the polygons only.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from fegear.base.arrays import Array
from fegear.dynamics.planetary.planet_set import PlanetarySet
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.involute import inv, pressure_angle_of_inv
from fegear.geometry.outline import tooth_outline

Flank = tuple[Array, Array]

ALPHA = math.radians(20.0)


class Given(NamedTuple):
    """Teeth, profile shifts and places of the planets."""

    sun: int
    planet: int
    ring: int
    shift_sun: float
    shift_planet: float
    shift_ring: float
    angles: tuple[float, ...]  # deg


SETS = (
    Given(24, 30, 84, 0.0, 0.0, 0.0, (0.0, 120.0, 240.0)),
    Given(25, 29, 83, 0.3, 0.21, -0.4, (0.0, 120.0, 240.0)),
    Given(27, 31, 89, -0.2, 0.15, 0.1, tuple(360.0 / 116 * k for k in (0, 30, 57, 88))),
    Given(18, 36, 93, 0.389, 0.5039, 0.1171, (0.0, 120.0, 240.0)),
    Given(31, 22, 77, -0.1, 0.25, -0.05, tuple(360.0 / 108 * k for k in (0, 23, 41, 60, 87))),
)


def distance(one: Given) -> float:
    """Centre distance of sun and planet without backlash [modules]."""
    shifts, teeth = one.shift_sun + one.shift_planet, one.sun + one.planet
    angle = float(pressure_angle_of_inv(inv(ALPHA) + 2.0 * shifts * math.tan(ALPHA) / teeth))
    return 0.5 * teeth * math.cos(ALPHA) / math.cos(angle)


def teeth(one: Given) -> list[Tooth]:
    """Sun and planet, tips as high as leaves a quarter of a module to the mate's root."""
    gears = Tooth(one.sun, profile_shift=one.shift_sun), Tooth(one.planet, profile_shift=one.shift_planet)
    rooms = [distance(one) - mate.root_radius - 0.25 for mate in gears[::-1]]
    return [replace(gear, tip_radius=min(gear.tip_radius, room)) for gear, room in zip(gears, rooms, strict=True)]


def described(one: Given) -> PlanetarySet:
    """As `fegear.dynamics.planetary` takes it."""
    _, planet = teeth(one)
    return PlanetarySet(
        one.sun, one.planet, one.ring, math.pi * math.cos(ALPHA), distance(one), np.radians(one.angles),
        float(planet.base_half_angle), float(planet.tip_radius),
    )  # fmt: skip


def flank(tooth: Tooth) -> Flank:
    """Radius and polar angle before the tooth's centre line of one flank of the tooth's polygon, by rising radius."""
    points = tooth_outline(tooth, 3e-8)
    left = points[:, : points.shape[1] // 2 + 1]
    radius = np.hypot(*left)
    rising = np.flatnonzero(np.diff(radius) > 0.0)
    left, radius = left[:, rising[0] :], radius[rising[0] :]
    top = int(np.argmax(radius > tooth.tip_radius - 1e-9))
    return radius[: top + 1], np.arctan2(-left[0], left[1])[: top + 1]


def ring_space(one: Given) -> tuple[Flank, float]:
    """Radius and half the angle of a space of the ring, by rising radius: involutes alone.

    They begin below the tip where the pitch circle lies there, which is read on them; second, where the tip is.
    """
    room = distance(one) + teeth(one)[1].root_radius + 0.25
    tip = max(0.5 * one.ring - 1.0 - one.shift_ring, room, 0.4725 * one.ring)
    radius = np.linspace(min(tip, distance(one) * one.ring / (one.ring - one.planet)), 0.5 * one.ring + 1.4, 4001)
    half = (0.5 * math.pi - 2.0 * one.shift_ring * math.tan(ALPHA)) / one.ring + float(inv(ALPHA))
    return (radius, half - inv(np.arccos(0.5 * one.ring * math.cos(ALPHA) / radius))), tip


def wrapped(angle: Array, pitch: float) -> Array:
    """Within half a pitch of zero."""
    return (angle + 0.5 * pitch) % pitch - 0.5 * pitch


def closest(
    points: Flank,
    centre: tuple[float, float],
    curve: Flank,
    pitch: float,
    start: float,
    sense: float,
    least: float = 0.0,
) -> float:
    """Least angle about the axis by which a planet's flank points are ahead of the flanks of a central polygon.

    Its tooth, or the ring's space, has its middle at `start`; positive as long as they do not touch.
    """
    x, y = points[0] + centre[0], points[1] + centre[1]
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    inside = (radius >= max(curve[0][0], least)) & (radius <= curve[0][-1])
    ahead = angle[inside] - start - sense * np.interp(radius[inside], *curve)
    return float(np.min(wrapped(ahead, pitch)))


def planet_flank(curve: Flank, teeth: int, turned: float, sense: float, side: float) -> Flank:
    """Points of one flank of the teeth of a planet at the origin that point to an angle; `sense` says which flank."""
    towards = turned + 2.0 * math.pi * np.arange(teeth) / teeth
    towards = towards[np.cos(towards - side) > math.cos(3.8 * math.pi / teeth)]
    angle = towards[:, None] + sense * curve[1]
    return (curve[0] * np.cos(angle)).ravel(), (curve[0] * np.sin(angle)).ravel()


def touching(gap: Callable[[float], float], pitch: float) -> float:
    """Where a gap that opens with the turn closes, within one pitch of the partner."""
    turns = np.linspace(0.0, pitch, 13)
    gaps = np.array([gap(turn) for turn in turns])
    near = np.abs(gaps[1:] - gaps[:-1]) < 0.4 * np.max(np.abs(gaps))
    (at, *_) = np.flatnonzero(
        (gaps[:-1] < 0.0) & (gaps[1:] >= 0.0) & near | (gaps[:-1] > 0.0) & (gaps[1:] <= 0.0) & near
    )
    return brentq(gap, turns[at], turns[at + 1], xtol=1e-10)


def by_polygons(one: Given) -> Array:
    """Phases of all meshes with the sun at some angle: places past the pitch point in base pitches, (2, planets)."""
    sun, planet = (flank(gear) for gear in teeth(one))
    ring, tip = ring_space(one)
    a, theta = distance(one), 0.0123
    pitches = [2.0 * math.pi / z for z in (one.sun, one.planet, one.ring)]
    radii = [a * z / (one.sun + one.planet) for z in (one.sun,)] + [a * one.ring / (one.ring - one.planet)]
    phases = np.zeros((2, len(one.angles)))
    for n, psi in enumerate(np.radians(one.angles)):
        centre = a * math.cos(psi), a * math.sin(psi)

        def sun_gap(turn: float, centre: tuple[float, float] = centre, side: float = psi) -> float:
            points = planet_flank(planet, one.planet, turn, 1.0, side + math.pi)
            return closest(points, centre, sun, pitches[0], theta, 1.0)

        turned = touching(sun_gap, pitches[1])

        def ring_gap(
            turn: float, centre: tuple[float, float] = centre, turned: float = turned, side: float = psi
        ) -> float:
            points = planet_flank(planet, one.planet, turned, -1.0, side)
            return closest(points, centre, ring, pitches[2], turn, -1.0, tip)

        space = touching(ring_gap, pitches[2])
        at_sun = theta + np.interp(radii[0], *sun)
        at_ring = space - np.interp(radii[1], *ring)
        phases[0, n] = (at_sun - psi) / pitches[0]
        phases[1, n] = (psi - at_ring) / pitches[2]
    return phases


def apart(one: Array, other: Array) -> float:
    """Largest distance of phases [base pitches]."""
    return float(np.max(np.abs(wrapped(np.asarray(one) - np.asarray(other), 1.0))))
