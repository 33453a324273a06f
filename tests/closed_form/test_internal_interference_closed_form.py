"""Interference of ring gears by polygons: teeth rolled, pulled apart and fed, overlap where the margin is negative.

Polygons know the outlines and the motion alone. Every check is seen on 100 random pairs close to its limit, on either
side of it.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import brentq

from fegear.base.errors import GeometryError
from fegear.dynamics.planetary.planet_set import PlanetarySet, even_angles
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_interference import TipCorner, internal_checks, radial_room
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.involute import inv, pressure_angle_of_inv

ALPHA = math.radians(20.0)
#: Pairs near each limit, in the ordinary run and in the long one.
PAIRS = pytest.mark.parametrize("count", [8, pytest.param(100, marks=pytest.mark.long)])
#: Of polygons with this many points a curve, chords lie within 3e-9 modules; what overlaps by more meets.
POINTS, MEETS = 16_000, 1e-7


class Side(NamedTuple):
    """Half a tooth as a polygon: radius, rising, and the angle of its flank from the centre line; where it ends."""

    teeth: int
    radius: np.ndarray
    half: np.ndarray
    internal: bool
    corners: tuple[tuple[float, float], ...]

    def inside(self, radius: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """How far points lie within teeth of which one stands at angle zero, along the arc; negative outside."""
        pitch = 2.0 * math.pi / self.teeth
        beyond = np.abs((angle + 0.5 * pitch) % pitch - 0.5 * pitch)
        deep = (np.interp(radius, self.radius, self.half) - beyond) * radius
        past = radius < self.radius[0] if self.internal else radius > self.radius[-1]
        return np.where(past, -np.inf, deep)


def side(tooth: Tooth | InternalTooth, count: int = POINTS) -> Side:
    lines = [c.points(np.linspace(c.start, c.end, count)) for n, c in tooth.outline.items() if not n.endswith("land")]
    x, y = np.hstack(lines)
    radius, half = np.hypot(x, y), np.arctan2(x, y)
    order = np.argsort(radius, kind="stable")
    ends = [(float(radius[k]), float(half[k])) for k in (-1, -count)]
    return Side(tooth.teeth, radius[order], half[order], tooth.internal, tuple(ends))


def cutter_side(ring: InternalTooth) -> Side:
    """A tooth of the cutter: its rounding and its involute, from their definitions."""
    cutter, base = ring.cutter, ring.cutter.teeth / 2 * math.cos(ring.pressure_angle)
    tip, rho = cutter.teeth / 2 + cutter.profile_shift + cutter.addendum, cutter.tip_radius
    string = math.sqrt((tip - rho) ** 2 - base**2) + rho
    half = (math.pi / 2 + 2 * cutter.profile_shift * math.tan(ring.pressure_angle)) / cutter.teeth
    half += float(inv(ring.pressure_angle))
    roll = np.linspace(0.0, string / base, POINTS)
    lean = half - string / base
    centre = ((string - rho) * math.cos(lean) + base * math.sin(lean),
              base * math.cos(lean) - (string - rho) * math.sin(lean))  # fmt: skip
    along = np.linspace(math.pi / 2 + lean, math.atan2(*centre), POINTS)
    x, y = centre[0] + rho * np.sin(along), centre[1] + rho * np.cos(along)
    radius = np.concatenate([base * np.hypot(1.0, roll), np.hypot(x, y)])
    angle = np.concatenate([half - (roll - np.arctan(roll)), np.arctan2(x, y)])
    order = np.argsort(radius, kind="stable")
    rounding = [(float(np.hypot(u, v)), math.atan2(u, v)) for u, v in zip(x[::1600], y[::1600], strict=True)]
    return Side(cutter.teeth, radius[order], angle[order], False, tuple(rounding))


def overlap(planet: Side, ring: Side, turns, shift, distance, points) -> np.ndarray:
    """Largest overlap of both at turns of a planet's tooth from the line between the axes, and of the ring's tooth."""
    turn, space = turns
    first, second = points
    r, own = (np.array(one)[:, None] for one in zip(*first, strict=True))
    x, y = distance - shift + r * np.cos(turn + own), r * np.sin(turn + own)
    deep = ring.inside(np.hypot(x, y), np.arctan2(y, x) - space - math.pi / ring.teeth).max(axis=0)
    r, own = (np.array(one)[:, None] for one in zip(*second, strict=True))
    angle = space + math.pi / ring.teeth - own
    x, y = r * np.cos(angle) - distance + shift, r * np.sin(angle)
    return np.maximum(deep, planet.inside(np.hypot(x, y), np.arctan2(y, x) - turn).max(axis=0))


def picked(one: Side, count: int) -> list[tuple[float, float]]:
    """Points of both flanks of a polygon."""
    at = np.linspace(0, one.radius.size - 1, count).astype(int)
    return [(float(one.radius[k]), sign * float(one.half[k])) for k in at for sign in (1.0, -1.0)]


def rolled(planet: Tooth, ring: InternalTooth, distance: float) -> float:
    """Largest overlap as a planet's tooth rolls through a space, its leading flank on that of the ring."""
    one, other = side(planet), side(ring)
    angle = math.acos((ring.base_radius - planet.base_radius) / distance)
    front = planet.base_half_angle - float(inv(angle))
    gap = math.pi / ring.teeth - (ring.base_half_angle + float(inv(angle)))
    ratio = planet.teeth / ring.teeth
    most = -math.inf
    for count, steps in ((40, 301), (0, 12_001)):
        points = [[*picked(side, count), *side.corners] for side in (one, other)]
        turn = np.linspace(-2.2, 2.2, steps)
        for _ in range(3):
            deep = overlap(one, other, (turn, (turn + front) * ratio - gap), 0.0, distance, points)
            at, step = turn[int(np.argmax(deep))], turn[1] - turn[0]
            most = max(most, float(deep.max()))
            turn = np.linspace(at - step, at + step, 41)
    return most


def pulled(one: Side, ring: InternalTooth, distance: float) -> float:
    """Largest overlap as a gear leaves a ring straight across, at any turn, in the middle of its backlash."""
    other, ratio = side(ring), one.teeth / ring.teeth
    points = one.corners, other.corners
    turn, past = np.linspace(0.0, 1.5, 151), np.linspace(-0.35, 0.35, 71)
    most = -math.inf
    for _ in range(4):
        at, more = (grid.ravel() for grid in np.meshgrid(turn, past, indexing="ij"))
        (r1, own), (r3, half) = one.corners[0], other.corners[0]
        space = at * ratio
        shift = distance + r1 * np.cos(at + own) - r3 * np.cos(space + math.pi / ring.teeth - half) + more
        deep = overlap(one, other, (at, space), shift, distance, points)
        deep = np.where(shift > 0.03, deep, -np.inf)  # teeth in mesh touch
        best = int(np.argmax(deep))
        most = max(most, float(deep[best]))
        turn = at[best] + np.linspace(-1.0, 1.0, 21) * (turn[1] - turn[0])
        past = more[best] + np.linspace(-1.0, 1.0, 21) * (past[1] - past[0])
    return most


def margin(name: str, planet: Tooth, ring: InternalTooth, distance: float) -> float:
    return next(one.margin for one in internal_checks(planet, ring, distance) if one.name == name)


def to_limit(name, planet, ring, distance, room):
    """The pair with that tip circle of one of them at which a margin is `room`; GeometryError where it is none."""
    along = math.sqrt(distance**2 - (ring.base_radius - planet.base_radius) ** 2)
    if name == "planet tip in ring fillet":
        rho = math.sqrt((ring.form_radius - room) ** 2 - ring.base_radius**2) - along
        return replace(planet, tip_radius=math.hypot(planet.base_radius, rho)), ring
    if name == "ring tip, planet root":
        rho = along + planet.base_radius * planet.involute.start + room
        return planet, replace(ring, tip_radius=math.hypot(ring.base_radius, rho))

    def other(tip):
        if name.startswith("planet tip corner"):
            return replace(planet, tip_radius=tip), ring
        return planet, replace(ring, tip_radius=tip)

    def off(tip):
        return margin(name, *other(tip), distance) - room

    low, high = ring.limit_radius + 1e-3, ring.form_radius - 1e-3
    if name.startswith("planet tip corner"):
        low, high = planet.pitch_radius, ring.root_radius - distance - 0.01
    tips = np.linspace(low, high, 6)
    found = []
    for tip in tips:
        try:
            found.append((off(tip), tip))
        except GeometryError:
            continue
    for (a, one), (b, two) in pairwise(found):
        if math.isfinite(a) and math.isfinite(b) and a * b < 0.0:
            return other(brentq(off, one, two, xtol=1e-5))
    raise GeometryError("tip_radius", low, "reaches no limit")


def tight_distance(z1: int, z3: int, x1: float, x3: float) -> float:
    """Between the axes without backlash [modules]; raises ValueError where there is no pressure angle."""
    value = float(inv(ALPHA)) - 2.0 * math.tan(ALPHA) * (x3 + x1) / (z3 - z1)
    if value < 1e-4:
        raise ValueError(value)
    return 0.5 * (z3 - z1) * math.cos(ALPHA) / math.cos(float(pressure_angle_of_inv(value)))


def pairs(name: str, seed: int, count: int):
    """Random pairs within hundredths of a module of the limit of one check and clear of others that meet in mesh."""
    rng, found = np.random.default_rng(seed), []
    fewer = {"trochoidal tip interference": (7, 11), "radial assembly": (9, 18), "infeed of the cutter": (12, 25)}
    for _ in range(20_000 * count):
        if len(found) == count:
            break
        z3 = int(rng.integers(40, 130))
        z1 = z3 - int(rng.integers(*fewer.get(name, (12, z3 - 17))))
        z0 = z3 - int(rng.integers(9, 22)) if name == "infeed of the cutter" else int(rng.integers(12, 30))
        x1, x3, allowance = rng.uniform(0.0, 0.6), rng.uniform(-0.2, 0.6), rng.uniform(0.02, 0.08)
        room = rng.choice([-1.0, 1.0]) * rng.uniform(0.003, 0.02)
        rounding = float(rng.choice([0.0, rng.uniform(0.0, 0.3)]))
        try:
            distance = tight_distance(z1, z3, x1, x3)
            planet = Tooth(z1, profile_shift=x1, thickness_allowance=allowance, tip_radius=z1 / 2 + x1 + 0.85)
            cutter = PinionCutter(z0, rng.uniform(0.0, 0.3), 1.25, tip_radius=rounding)
            planet, ring = to_limit(name, planet, InternalTooth(z3, cutter, profile_shift=x3), distance, room)
            others = [one for one in internal_checks(planet, ring, distance)[:7] if one.name != name]
        except (GeometryError, ValueError):
            continue
        rolls = name not in ("radial assembly", "infeed of the cutter")
        if name.endswith(("planet root", "ring fillet")):  # where a tip touches a fillet, its path is close as well
            others = [one for one in others if "corner" not in one.name or abs(one.margin) < 1e-5]
        if planet.undercut or (rolls and any(one.margin < 0.003 for one in others)):
            continue
        found.append((planet, ring, distance))
    assert len(found) == count, name
    return found


ROLLING = (
    "ring tip, planet root",
    "planet tip in ring fillet",
    "planet tip corner, ring fillet",
    "trochoidal tip interference",
)


@pytest.mark.dear
@PAIRS
@pytest.mark.parametrize("name", ROLLING)
def test_teeth_that_roll_overlap_where_a_margin_is_negative(name: str, count: int) -> None:
    signs = set()
    for planet, ring, distance in pairs(name, 281, count):
        left = margin(name, planet, ring, distance)
        assert abs(left) < 0.03
        meets = min(one.margin for one in internal_checks(planet, ring, distance)[:7]) < 0.0
        deepest = rolled(planet, ring, distance)
        assert (deepest > MEETS) == meets, (planet, ring, distance, left, deepest)
        signs.add(left < 0.0)
    assert signs == {True, False}


@PAIRS
def test_gears_put_in_across_the_axis_overlap_where_the_margin_is_negative(count: int) -> None:
    signs = set()
    for planet, ring, distance in pairs("radial assembly", 282, count):
        left = margin("radial assembly", planet, ring, distance)
        assert (pulled(side(planet), ring, distance) > MEETS) == (left < 0.0), (planet, ring, distance, left)
        signs.add(left < 0.0)
    assert signs == {True, False}


@PAIRS
def test_a_cutter_fed_across_the_axis_trims_where_the_margin_is_negative(count: int) -> None:
    signs = set()
    for planet, ring, distance in pairs("infeed of the cutter", 283, count):
        left = margin("infeed of the cutter", planet, ring, distance)
        deepest = pulled(cutter_side(ring), ring, ring.generating_distance)
        assert (deepest > MEETS) == (left < 0.0), (ring, left, deepest)
        signs.add(left < 0.0)
    assert signs == {True, False}


def by_formula(planet: Tooth, ring: InternalTooth, distance: float) -> float:
    """Room for radial assembly as an angle, as books on ring gears write it: sharp tips, no backlash."""
    k = ring.teeth / planet.teeth
    working = math.acos((ring.base_radius - planet.base_radius) / distance)
    cosine = [gear.base_radius / gear.tip_radius for gear in (planet, ring)]
    t1 = math.asin(math.sqrt((1.0 - (cosine[0] / cosine[1]) ** 2) / (1.0 - 1.0 / k**2)))
    t3 = math.asin(math.sqrt(((cosine[1] / cosine[0]) ** 2 - 1.0) / (k**2 - 1.0)))
    one, three = (float(inv(math.acos(c)) - inv(working)) for c in cosine)
    return t1 + one - k * (t3 + three)


def test_radial_room_has_the_sign_of_the_formula_of_books() -> None:
    rng, signs = np.random.default_rng(284), []
    for _ in range(200):
        z3 = int(rng.integers(50, 120))
        planet, x3 = Tooth(z3 - int(rng.integers(11, 24)), profile_shift=rng.uniform(0.0, 0.3)), rng.uniform(-0.3, 0.3)
        try:
            distance = tight_distance(planet.teeth, z3, planet.profile_shift, x3)
            ring = InternalTooth(z3, PinionCutter(20), profile_shift=x3)
        except (GeometryError, ValueError):
            continue
        half = float(planet.half_thickness_angle(planet.tip_radius))
        room = radial_room(TipCorner(planet.tip_radius, half, 0.0), planet.teeth, ring, distance)
        assert math.copysign(1.0, room) == math.copysign(1.0, by_formula(planet, ring, distance))
        signs.append(room < 0.0)
    assert 0.2 < np.mean(signs) < 0.8


def test_neighbouring_planets_meet_where_their_tip_circles_do() -> None:
    """Polygons of two planets, each turned any way: tips meet on the line between their axes."""
    rng = np.random.default_rng(285)
    for _ in range(100):
        planet = Tooth(int(rng.integers(15, 60)), profile_shift=rng.uniform(0.0, 0.4))
        count, room = int(rng.integers(3, 7)), rng.choice([-1.0, 1.0]) * rng.uniform(1e-4, 0.02)
        away = 2.0 * planet.tip_radius + room  # between two planets
        sun = max(3, round(away / math.sin(math.pi / count) * math.cos(ALPHA)) - planet.teeth)
        ring = sun + 2 * planet.teeth
        ring += -(sun + ring) % count  # fits evenly
        one = side(planet, 2000)
        tip = np.linspace(-one.half[-1], one.half[-1], 41)  # the tip land, turned to the neighbour's
        x, y = away - one.radius[-1] * np.cos(tip), one.radius[-1] * np.sin(tip)
        meets = float(one.inside(np.hypot(x, y) + 0.0, np.arctan2(y, x)).max()) > 0.0
        distance = away / (2.0 * math.sin(math.pi / count))
        given = (sun, planet.teeth, ring, math.pi * math.cos(ALPHA), distance, even_angles(count), 0.1)
        if distance <= (ring - planet.teeth) / 2 * math.cos(ALPHA):
            continue
        if meets:
            with pytest.raises(GeometryError, match="adjacent planets interfere: tip circles overlap by"):
                PlanetarySet(*given, planet.tip_radius)
        else:
            left = PlanetarySet(*given, planet.tip_radius).neighbour_clearance
            assert left == pytest.approx(room, abs=1e-9)
        assert meets == (room < 0.0)


@PAIRS
def test_evenly_spaced_planets_fit_where_the_teeth_of_sun_and_ring_divide_by_their_number(count: int) -> None:
    """A planet is turned until polygons of sun and ring take it best: what is left of the overlap is none or clear."""
    rng, fits = np.random.default_rng(286), []
    for _ in range(count):
        sun, planet, planets = int(rng.integers(18, 40)), int(rng.integers(17, 40)), int(rng.integers(2, 6))
        ring = sun + 2 * planet
        gears = [Tooth(z, tip_radius=z / 2 + 0.9) for z in (sun, planet)]
        sides = [side(one, 2000) for one in gears]
        around = side(InternalTooth(ring, PinionCutter(30), tip_radius=ring / 2 - 0.9), 2000)
        distance = 0.5 * (sun + planet)
        psi = 2.0 * math.pi / planets
        # planet 1 stands at zero with a tooth toward the ring's space; then the sun's tooth or space follows
        sun_at = 0.0 if planet % 2 else math.pi / sun  # a space of the planet at its back, or a tooth
        points = [np.array(v)[:, None] for v in zip(*picked(sides[1], 12), strict=True)]
        teeth = 2.0 * math.pi / planet * np.arange(planet)[:, None, None]
        turns, left = np.linspace(0.0, 2.0 * math.pi / planet, 101), math.inf
        for _ in range(3):
            near = turns + points[1] + teeth
            x, y = (distance * of(psi) + points[0] * of(near) for of in (np.cos, np.sin))
            radius, angle = np.hypot(x, y), np.arctan2(y, x)
            outward = np.cos(near - psi) > 0.0
            deep = np.where(
                outward, around.inside(radius, angle - math.pi / ring), sides[0].inside(radius, angle - sun_at)
            )
            worst = deep.max(axis=(0, 1))
            left, at, step = float(worst.min()), turns[int(np.argmin(worst))], turns[1] - turns[0]
            turns = np.linspace(at - step, at + step, 21)
        given = (sun, planet, ring, math.pi * math.cos(ALPHA), distance, even_angles(planets), 0.1)
        fits.append(left < 1e-3)
        if fits[-1]:
            PlanetarySet(*given)
            assert (sun + ring) % planets == 0
        else:
            with pytest.raises(GeometryError, match="cannot be equally spaced with"):
                PlanetarySet(*given)
    assert any(fits)
    assert not all(fits)


@pytest.mark.parametrize(
    ("edge", "passes"),
    [({}, False), ({"tip_chamfer": 0.125}, True), ({"tip_rounding": 0.1}, True), ({"tip_chamfer": 0.01}, False)],
)
def test_a_chamfered_tip_of_a_ring_passes_a_fillet_that_a_sharp_one_cuts(edge: dict[str, float], passes: bool) -> None:
    """Planet of 22 and ring of 61 teeth without shifts, as in public models of planetary stages."""
    planet = Tooth(22, tip_radius=12.0)
    ring = InternalTooth(61, PinionCutter(45, 0.0, 1.25, tip_radius=0.0), tip_radius=29.5, **edge)
    assert (margin("ring tip corner, planet fillet", planet, ring, 19.5) > 0.0) == passes
    assert (rolled(planet, ring, 19.5) < MEETS) == passes
