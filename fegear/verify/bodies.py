"""Helical planetary sets as rigid bodies in space, six ways to move each, with a spring along the flanks' normal.

Nothing of the set's own model is used: flanks are helicoids whose normals are cross products of their tangents, contact
is found by trying every set of meshes, and what rigid bearings hold along the axis and against tilting is a reaction.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import product

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.dynamics.planetary.planet_set import Central, PlanetarySet

TWIST = math.tan(math.radians(17.0))
PIN = 3e8


def flank_normal(base_radius: float, at: Array, turns: float, twist: float) -> Array:
    """Unit normal out of the material of a helicoid at a point in space, on the flank that pushes as its gear turns.

    The involute through the point is unwound from its base circle about the origin, and screws along the axis.
    """
    radius = math.hypot(*at[:2])
    roll = math.sqrt(radius**2 / base_radius**2 - 1.0)
    start = math.atan2(at[1], at[0]) + turns * (roll - math.atan(roll))

    def surface(unwound: float, height: float) -> Array:
        turn = start + twist * height / base_radius
        foot = turn - turns * unwound
        x = base_radius * (math.cos(foot) - turns * unwound * math.sin(foot))
        y = base_radius * (math.sin(foot) + turns * unwound * math.cos(foot))
        return np.array([x, y, height])

    h = 1e-6
    along = (surface(roll + h, 0.0) - surface(roll - h, 0.0)) / (2.0 * h)
    up = (surface(roll, h * base_radius) - surface(roll, -h * base_radius)) / (2.0 * h * base_radius)
    normal = np.cross(along, up)
    normal /= np.linalg.norm(normal)
    forward = turns * np.array([-at[1], at[0], 0.0])
    return normal * math.copysign(1.0, float(normal @ forward))


def way(size: int, body: int, centre: Array, at: Array, direction: Array) -> Array:
    """Row that turns the six ways of a body into how far its point moves along a direction."""
    row = np.zeros(size)
    row[body : body + 3], row[body + 3 : body + 6] = direction, np.cross(at - centre, direction)
    return row


def meshes_in_space(found: PlanetarySet) -> tuple[Array, list[tuple[Array, Array, Array]]]:
    """Approach rows (2 N, size), and by mesh the contact, the planet's centre and the force's direction on it."""
    n, origin = found.count, np.zeros(3)
    rows, contacts = np.zeros((2 * n, 6 * (3 + n))), []
    for m, i in product(range(2), range(n)):
        out = np.array([math.cos(found.angles[i]), math.sin(found.angles[i]), 0.0])
        planet, centre = 18 + 6 * i, found.centre_distance * out
        base = found.base_radius("sun" if m == 0 else "ring")
        at = base / math.cos(found.sun_angle if m == 0 else found.ring_angle) * out
        if m == 0:  # a right-handed sun that turns counter-clockwise pushes the planet
            normal = flank_normal(base, at, 1.0, TWIST)
            one, other = (0, origin), (planet, centre)
        else:  # the left-handed planet turns clockwise and pushes the ring
            normal = flank_normal(found.base_radius("planet"), at - centre, -1.0, -TWIST)
            one, other = (planet, centre), (6, origin)
        rows[m * n + i] = way(rows.shape[1], *one, at, normal) - way(rows.shape[1], *other, at, normal)
        contacts.append((at, centre, normal if m == 0 else -normal))
    return rows, contacts


def held_in_space(
    found: PlanetarySet, supports: Mapping[Central, float], errors: Array, driving: Central
) -> tuple[Array, Array, Index, int]:
    """Stiffness of pins and bearings, load of the pins' errors, and what is free to move."""
    size, where = 6 * (3 + found.count), {"sun": 0, "ring": 6, "carrier": 12}
    linear, load = np.zeros((size, size)), np.zeros(size)
    held = [b + k for b in range(0, size, 6) for k in (2, 3, 4)]  # along the axis and against tilting
    for name, bearing in supports.items():
        across = [where[name], where[name] + 1]
        held += across if math.isinf(bearing) else []
        linear[across, across] += 0.0 if math.isinf(bearing) else bearing
        held += [] if name == driving else [where[name] + 5]
    for i, psi in enumerate(found.angles):
        out, side = np.array([math.cos(psi), math.sin(psi), 0.0]), np.array([-math.sin(psi), math.cos(psi), 0.0])
        pin = found.centre_distance * out
        for direction, error in zip((out, side), errors[:, i], strict=True):
            row = way(size, 12, np.zeros(3), pin, direction) - way(size, 18 + 6 * i, pin, pin, direction)
            linear += PIN * np.outer(row, row)
            load -= PIN * error * row
    return linear, load, np.setdiff1d(np.arange(size), held), where[driving] + 5


def contact_in_space(rows: Array, linear: Array, load: Array, k: Array) -> Array | None:
    """Forces of one-sided springs, by trying every set of them that bear; None without equilibrium."""
    n = k.size // 2
    for state in sorted(product((True, False), repeat=2 * n), key=sum, reverse=True):
        on = np.array(state)
        whole = linear + (rows[on].T * k[on]) @ rows[on]
        q = np.linalg.lstsq(whole, load, rcond=1e-13)[0]
        if np.abs(whole @ q - load).max() > 1e-6 * np.abs(load).max():
            continue  # nothing holds it
        gap = rows @ q
        # a planet that touches neither sun nor ring turns as it likes: only the sum of its gaps matters
        loose = np.tile(~on[:n] & ~on[n:], 2)
        parted = np.where(loose, np.tile(gap[:n] + gap[n:], 2), gap)
        if np.all(gap[on] > 0.0) and np.all(parted[~on] <= 0.0):
            return np.where(on, k * gap, 0.0)
    return None


def bodies_in_space(
    found: PlanetarySet, supports: Mapping[Central, float], stiffness: Array, errors: Array, torque: float,
    driving: Central,
) -> tuple[Array, Array, Array] | None:  # fmt: skip
    """Normal forces (2, N), and what both meshes do to each planet: moments about the path's tangent, axial force.

    The axial force is (2, N), that on the planets; its first row is what the planets do to the sun but for its sign.
    """
    rows, contacts = meshes_in_space(found)
    linear, load, free, turned = held_in_space(found, supports, errors, driving)
    load[turned] += torque
    k = np.repeat(stiffness, found.count)
    force = contact_in_space(rows[:, free], linear[np.ix_(free, free)], load[free], k)
    if force is None:
        return None
    pushed = [f * direction for f, (_, _, direction) in zip(force, contacts, strict=True)]
    tangents = np.tile(np.array([-np.sin(found.angles), np.cos(found.angles), 0.0 * found.angles]).T, (2, 1))
    moments = [
        np.cross(at - centre, one) @ tangent
        for (at, centre, _), one, tangent in zip(contacts, pushed, tangents, strict=True)
    ]
    shape = (2, found.count)
    return force.reshape(shape), np.reshape(moments, shape).sum(axis=0), np.reshape([p[2] for p in pushed], shape)
