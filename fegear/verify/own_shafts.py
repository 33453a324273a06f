"""Rows of shafts and bearings against closed forms and independent code of our own."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import Bearing
from fegear.shafts.deflection import Deflection
from fegear.verify.row import Compared, Rows, near

ROWS = Rows()
E, NU = 206e9, 0.3


def _shaft(*sections: tuple[float, ...]) -> Shaft:
    from fegear.shafts.beam import Shaft
    from fegear.shafts.section import Section

    return Shaft(tuple(Section(*one) for one in sections), E, NU)


def _deflected(shaft: Shaft, seats: tuple[tuple[Bearing, float], ...], at: float, *load: float) -> Deflection:
    from fegear.shafts.deflection import deflect
    from fegear.shafts.held import LoadedShaft, Seat

    held = tuple(Seat(bearing, z) for bearing, z in seats)
    return deflect((LoadedShaft(shaft, held, np.array([at]), np.array([load], dtype=float), "shaft"),))[0]


def _bending(d: float, h: float = 0.0) -> float:
    return E * math.pi / 64.0 * (d**4 - h**4)


def _shear(d: float, h: float = 0.0) -> float:
    """Cowper's coefficient for a hollow circle."""
    m = (h / d) ** 2
    kappa = 6 * (1 + NU) * (1 + m) ** 2 / ((7 + 6 * NU) * (1 + m) ** 2 + (20 + 12 * NU) * m)
    return kappa * E / (2 * (1 + NU)) * math.pi / 4 * (d * d - h * h)


def _held() -> tuple[Bearing, Bearing, Bearing]:
    """A fixed bearing, a floating one, a clamp: all rigid."""
    from fegear.shafts.bearing import stiff

    return stiff(math.inf, math.inf), stiff(math.inf), stiff(math.inf, math.inf, math.inf)


@ROWS.add("shafts between and beyond their bearings", "own", "Timoshenko beams in closed form")
def beams() -> Iterator[Compared]:
    """A force between the bearings (solid and hollow), on an overhung end, and in the middle of a stepped shaft."""
    pin, roller, _ = _held()
    length, a, force, d = 0.4, 0.15, 3000.0, 0.05
    b = length - a
    for hole in (0.0, 0.02):
        found = _deflected(_shaft((length, d, hole)), ((pin, 0.0), (roller, length)), a, 0, force, 0, 0, 0, 0)
        wanted = force * a**2 * b**2 / (3 * _bending(d, hole) * length) + force * a * b / length / _shear(d, hole)
        yield from near(found.at(a)[0, 1], wanted, 1e-10)
    span, over = 0.3, 0.1
    found = _deflected(_shaft((span + over, 0.04)), ((pin, 0.0), (roller, span)), span + over, force, 0, 0, 0, 0, 0)
    wanted = force * over**2 * (span + over) / (3 * _bending(0.04)) + force * over / _shear(0.04) * (1 + over / span)
    yield from near(found.at(span + over)[0, 0], wanted, 1e-10)
    stepped, thin, thick = _shaft((0.1, 0.04), (0.2, 0.06), (0.1, 0.04)), 0.04, 0.06
    found = _deflected(stepped, ((pin, 0.0), (roller, 0.4)), 0.2, force, 0, 0, 0, 0, 0)
    bent = (0.1**3 / _bending(thin) + (0.2**3 - 0.1**3) / _bending(thick)) * force / 6
    yield from near(found.at(0.2)[0, 0], bent + force / 2 * (0.1 / _shear(thin) + 0.1 / _shear(thick)), 1e-10)


@ROWS.add("conical shafts", "own", "the integral of the bending line in closed form")
def cones() -> Iterator[Compared]:
    """Free end of a clamped cone."""
    length, d0, d1, force = 0.2, 0.06, 0.02, 800.0
    found = _deflected(_shaft((length, d0, 0.0, d1)), ((_held()[2], 0.0),), length, force, 0, 0, 0, 0, 0)
    wanted = 64 * force * length**3 / (3 * math.pi * E * d0**3 * d1) + force * length / _shear(1.0) / (d0 * d1)
    yield from near(found.at(length)[0, 0], wanted, 1e-10)


@ROWS.add("tension and torsion of shafts", "own", "rods in closed form")
def tension_and_twist() -> Iterator[Compared]:
    """Free end of a hollow shaft."""
    from fegear.shafts.deflection import deflect
    from fegear.shafts.held import LoadedShaft, Seat

    loads = np.array([[0, 0, 700.0, 0, 0, -50.0], [0, 0, 0, 0, 0, 50.0]])
    held = (Seat(_held()[2], 0.0),)
    loaded = LoadedShaft(_shaft((0.3, 0.03, 0.01)), held, np.array([0.3, 0.1]), loads, "shaft")
    found = deflect((loaded,))[0].at(0.3)[0]
    area, polar = math.pi / 4 * (0.03**2 - 0.01**2), math.pi / 32 * (0.03**4 - 0.01**4)
    yield from near(found[2], 700 * 0.3 / (E * area), 1e-11)
    yield from near(found[5], -50 * 0.2 / (E / 2.6 * polar), 1e-11)


@ROWS.add("bearings with clearance", "own", "springs behind a gap in closed form")
def clearances() -> Iterator[Compared]:
    """A rigid shaft on two bearings of 30 um radial and 10 um axial clearance."""
    from fegear.shafts.beam import Shaft
    from fegear.shafts.bearing import LooseBearing
    from fegear.shafts.section import Section

    bearing, force = LooseBearing(2e8, 1e8, 0.0, 30e-6, 10e-6), 1000.0
    rigid = Shaft((Section(0.2, 0.05),), math.inf)
    found = _deflected(rigid, ((bearing, 0.0), (bearing, 0.2)), 0.1, 0.6 * force, 0.8 * force, 500, 0, 0, 0).at(0.1)[0]
    across = 30e-6 + force / 2 / 2e8
    yield from near(found[:3], (0.6 * across, 0.8 * across, 10e-6 + 500 / 2e8), 1e-8)
