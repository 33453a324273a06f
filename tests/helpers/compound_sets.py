"""Planetary sets described as data, with gears of one base pitch, for tests."""

import math

import numpy as np

from fegear.dynamics.compound.compound_set import CompoundSet, End, Mesh, Planets, Shaft, Wheel

#: Base pitch over 2 pi: base radius per tooth [m].
PER_TOOTH = 1e-3
#: Working over base radius of standard gears of 20 degrees.
_WORKING = 1.0 / math.cos(math.radians(20.0))


def wheel(name, teeth, internal=False, per_tooth=PER_TOOTH):
    """A gear of standard proportions."""
    half = math.pi / (2 * teeth) + (-1 if internal else 1) * (math.tan(math.radians(20)) - math.radians(20))
    return Wheel(name, teeth, internal, per_tooth * teeth, per_tooth * (teeth * _WORKING + 2.0), half)


def bodies(rng):
    """Mass, inertia and bearing."""
    return {"mass": rng.uniform(0.5, 5.0), "inertia": rng.uniform(1e-3, 1e-2), "bearing": 10 ** rng.uniform(6.0, 9.0)}


def evenly(count, first=0.0):
    return tuple(first + 2.0 * math.pi * n / count for n in range(count))


def simple(sun=25, planet=29, ring=83, planets=4, rng=None, efficiency=(1.0, 1.0)):
    """Sun, planets, ring, carrier."""
    rng = rng or np.random.default_rng(1)
    shafts = (
        Shaft("sun", (wheel("s", sun),), **bodies(rng)), Shaft("ring", (wheel("r", ring, True),), **bodies(rng)),
        Shaft("carrier", (), **bodies(rng)),
    )  # fmt: skip
    far = PER_TOOTH * (sun + planet) * _WORKING
    group = Planets("planet", "carrier", (wheel("p", planet),), evenly(planets), far, rng.uniform(0.2, 1.0),
                    rng.uniform(1e-4, 1e-3), 10 ** rng.uniform(7.0, 9.0))  # fmt: skip
    meshes = (
        Mesh(End("sun", "s"), End("planet", "p"), efficiency[0], 10 ** rng.uniform(8, 9)),
        Mesh(End("ring", "r"), End("planet", "p"), efficiency[1], 10 ** rng.uniform(8, 9)),
    )
    return CompoundSet(shafts, (group,), meshes)


def ravigneaux(small=26, large=34, long=20, short=21, ring=74, planets=3, rng=None, efficiency=1.0):
    """Small sun with short planets, which mesh with the long ones of the large sun and the ring."""
    rng = rng or np.random.default_rng(2)
    shafts = (
        Shaft("small", (wheel("s1", small),), **bodies(rng)), Shaft("large", (wheel("s2", large),), **bodies(rng)),
        Shaft("ring", (wheel("r", ring, True),), **bodies(rng)), Shaft("carrier", (), **bodies(rng)),
    )  # fmt: skip
    far = PER_TOOTH * _WORKING * (large + long)
    near, apart = PER_TOOTH * _WORKING * (small + short), PER_TOOTH * _WORKING * (long + short)
    between = math.acos((far**2 + near**2 - apart**2) / (2.0 * far * near))
    groups = tuple(
        Planets(name, "carrier", (wheel(own, teeth),), evenly(planets, first), radius, rng.uniform(0.2, 1.0),
                rng.uniform(1e-4, 1e-3), 10 ** rng.uniform(7.0, 9.0))
        for name, own, teeth, first, radius in (
            ("long", "p2", long, 0.0, far), ("short", "p1", short, between, near),
        )
    )  # fmt: skip
    pairs = (("small", "s1", "short", "p1"), ("short", "p1", "long", "p2"), ("large", "s2", "long", "p2"),
             ("ring", "r", "long", "p2"))  # fmt: skip
    meshes = tuple(Mesh(End(a, x), End(b, y), efficiency, 10 ** rng.uniform(8, 9)) for a, x, b, y in pairs)
    return CompoundSet(shafts, groups, meshes)


def stepped(sun=18, first=36, second=18, ring=78, planets=3, rng=None, second_ring=None):
    """Planets of two gears: the first meshes with the sun, the second with the ring (or each with a ring: Wolfrom)."""
    rng = rng or np.random.default_rng(3)
    far = PER_TOOTH * _WORKING * (sun + first)
    module = far / (_WORKING * (ring - second))  # its own module for the second gear
    shafts = [
        Shaft("sun", (wheel("s", sun),), **bodies(rng)),
        Shaft("ring", (wheel("r", ring, True, module),), **bodies(rng)), Shaft("carrier", (), **bodies(rng)),
    ]  # fmt: skip
    meshes = [
        Mesh(End("planet", "p1"), End("sun", "s"), 1.0, 10 ** rng.uniform(8, 9)),
        Mesh(End("planet", "p2"), End("ring", "r"), 1.0, 10 ** rng.uniform(8, 9)),
    ]
    if second_ring is not None:
        shafts.append(Shaft("other", (wheel("r1", second_ring, True),), **bodies(rng)))
        meshes.append(Mesh(End("other", "r1"), End("planet", "p1"), 1.0, 10 ** rng.uniform(8, 9)))
    group = Planets("planet", "carrier", (wheel("p1", first), wheel("p2", second, per_tooth=module)), evenly(planets),
                    far, rng.uniform(0.2, 1.0), rng.uniform(1e-4, 1e-3), 10 ** rng.uniform(7.0, 9.0))  # fmt: skip
    return CompoundSet(tuple(shafts), (group,), tuple(meshes))


def simpson(sun=30, planet=18, ring=66, rng=None, planets=(3, 4)):
    """One sun shaft for two sets; the carrier of the first is the ring of the second."""
    rng = rng or np.random.default_rng(4)
    shafts = (
        Shaft("sun", (wheel("a", sun), wheel("b", sun)), **bodies(rng)),
        Shaft("ring", (wheel("r", ring, True),), **bodies(rng)),
        Shaft("output", (wheel("r", ring, True),), **bodies(rng)), Shaft("carrier", (), **bodies(rng)),
    )  # fmt: skip
    far = PER_TOOTH * _WORKING * (sun + planet)
    groups = tuple(
        Planets(name, carrier, (wheel("p", planet),), evenly(count, 0.3), far, rng.uniform(0.2, 1.0),
                rng.uniform(1e-4, 1e-3), 10 ** rng.uniform(7.0, 9.0))
        for name, carrier, count in (("front", "output", planets[0]), ("rear", "carrier", planets[1]))
    )  # fmt: skip
    pairs = (("sun", "a", "front", "p"), ("ring", "r", "front", "p"), ("sun", "b", "rear", "p"),
             ("output", "r", "rear", "p"))  # fmt: skip
    meshes = tuple(Mesh(End(a, x), End(b, y), 1.0, 10 ** rng.uniform(8, 9)) for a, x, b, y in pairs)
    return CompoundSet(shafts, groups, meshes)
