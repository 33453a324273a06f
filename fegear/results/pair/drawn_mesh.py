"""The gears of a pair in mesh with the stress inside their teeth, as it stands at the points of the path of contact.

The stress is that of the window: tables for unit loads, superposed with the loads that the tooth pairs share.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.engine.sheet.load_words import load_words
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.path_of_contact import path_points
from fegear.results.gear.drawing import MovingPair, moving_pair

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement
    from fegear.fem.plane.inner_stress import InnerStress
    from fegear.results.pair.stress_inside import StressInsideData, ToothStress

#: How far beside a point at which a pair comes or goes the gears stand [base pitches]: B with one pair, A with both.
_BESIDE = 1e-6
#: Which side of it: where the interval that it begins or ends is, the one in which fewer pairs carry for B and D.
_SIDES = {"A": 1.0, "B": 1.0, "C": 0.0, "D": -1.0, "E": -1.0}
#: Teeth on either side of the one that touches, and room about the pitch point [modules].
_TEETH, _TALL, _WIDE = 6, 3.2, 6.0
#: Digits of the end of the colour scale.
_DIGITS = 2


class Touching(NamedTuple):
    """A tooth pair that carries a load: its number, its place on the line of action [m], and the load [N]."""

    number: int
    x: float
    load: float


@dataclass(frozen=True)
class Standing:
    """Gears at one roll position.

    Parameters
    ----------
    letter : str
        Of the point of the path of contact.
    x : float
        Place of pair 0 on the line of action [m].
    touching : tuple of Touching
    """

    letter: str
    x: float
    touching: tuple[Touching, ...]


def standing_at_points(engagement: Engagement, load: float) -> tuple[Standing, ...]:
    """The gears at points A to E of the path of contact, each once, with the loads of the tooth pairs."""
    pair, found = engagement.pair, []
    places = {point.letter: point.x for point in reversed(path_points(pair))}
    for letter in sorted(places):
        x = places[letter] + _SIDES.get(letter, 0.0) * _BESIDE * pair.base_pitch
        state = engagement.solve(engagement.grid([x]), [load])
        carried, at = state.loads[:, 0, 0], state.pair_x[:, 0]
        on = np.flatnonzero(carried > 0.0)
        # the pair that stands at the point is pair 0, whichever base pitch the solution is in
        touching = tuple(Touching(round((at[i] - x) / pair.base_pitch), float(at[i]), float(carried[i])) for i in on)
        found.append(Standing(letter, x, touching))
    return tuple(found)


def turned_by(moving: MovingPair, member: Member, number: int, x: float, base_pitch: float) -> float:
    """Angle by which the tooth of a pair has turned from where it touches at the pitch point [rad], anticlockwise."""
    way, base = (-1.0, moving.driver_base) if member == "driver" else (1.0, moving.driven_base)
    return way * (number * base_pitch + x) / base


def tooth_stress(
    tooth: ToothStress, pair: GearPair, member: Member, number: int, touching: tuple[Touching, ...]
) -> Array:
    """Von Mises stress at the points of the tooth of a pair under the loads of all pairs, shape (N,) [Pa]."""
    table: InnerStress = tooth.table
    moving = moving_pair(pair, 0)
    base = moving.driver_base if member == "driver" else moving.driven_base
    touches = base * math.tan(moving.pressure_angle)
    total = np.zeros((3, table.points.shape[1]))
    for one in touching:
        clockwise = number - one.number if member == "driver" else one.number - number
        if abs(clockwise) > table.reach:
            continue
        roll = touches + (one.x if member == "driver" else -one.x)
        row = float(np.interp(roll, tooth.roll, np.arange(tooth.roll.size)))
        low = min(int(row), tooth.roll.size - 2)
        own = table.stress[low : low + 2, clockwise + table.reach].astype(float)
        total += one.load * tooth.per_load * ((low + 1 - row) * own[0] + (row - low) * own[1])
    xx, yy, xy = total
    half = 0.5 * (xx + yy)
    zz = 2.0 * table.across * half
    return np.sqrt((half - zz) ** 2 + 3.0 * (0.25 * (xx - yy) ** 2 + xy**2))


@dataclass(frozen=True)
class StressDrawing(ReadOnlyArrays):
    """Gears at a point of the path of contact, ready to be drawn: lengths in mm from the pitch point, stress in MPa.

    Parameters
    ----------
    name, letter : str
        Of the pair, and of the point.
    under : str
        The load, in words.
    points, triangles, stress : ndarray, shape (2, N), (3, T), (N,)
    top : float
        End of the scale of colours.
    outlines : dict of Member to ndarray, shape (2, n)
        By "driver" and "driven".
    along : ndarray, shape (2,)
        Unit vector of the line of action, toward which the driver pushes.
    path : ndarray, shape (2,)
        Places of its ends on it.
    letters : tuple of (str, float)
        Points of the path of contact.
    loads : tuple of (float, float)
        Places at which tooth pairs touch, and their loads [N].
    load : float
        Of all pairs [N].
    room : tuple of float
        Half width and height of the drawing.
    module : float
    """

    name: str
    letter: str
    under: str
    points: Array
    triangles: NDArray[np.int64]
    stress: Array
    top: float
    outlines: dict[Member, Array]
    along: Array
    path: Array
    letters: tuple[tuple[str, float], ...]
    loads: tuple[tuple[float, float], ...]
    load: float
    room: tuple[float, float]
    module: float


def stress_drawings(
    name: str, engagement: Engagement, load: float, inside: StressInsideData
) -> Iterator[StressDrawing]:
    """A drawing for each point of the path of contact, all with one scale of colours.

    Parameters
    ----------
    name : str
        Of the pair.
    engagement : Engagement
    load : float
        Along the line of action [N].
    inside : StressInsideData
    """
    pair, moving = inside.pair, moving_pair(inside.pair, _TEETH)
    stands = standing_at_points(engagement, load)
    fields = [{member: _field(inside, member, one) for member in MEMBERS} for one in stands]
    fillets = [
        float(stress[:, inside.gears[member].table.fillet].max())
        for field in fields for member, (_, stress) in field.items()
    ]  # fmt: skip
    top = _rounded_up(max(fillets))
    for one, field in zip(stands, fields, strict=True):
        yield _drawing(name, pair, moving, one, field, inside, top, load)


_Field = tuple["Array", "Array"]


def _field(inside: StressInsideData, member: Member, stand: Standing) -> _Field:
    """Points, shape (T, 2, N) [m], and stress, shape (T, N) [Pa], of the teeth of one gear."""
    pair, tooth, moving = inside.pair, inside.gears[member], moving_pair(inside.pair, 0)
    centre = _centre(moving, member)
    count = min(_TEETH, (pair.gear(member).teeth - 1) // 2)
    numbers = range(-count, count + 1)
    places = np.stack([
        _about(tooth.places, centre, turned_by(moving, member, number, stand.x, pair.base_pitch)) for number in numbers
    ])  # fmt: skip
    stress = np.stack([tooth_stress(tooth, pair, member, number, stand.touching) for number in numbers])
    return places, stress


def _centre(moving: MovingPair, member: Member) -> float:
    return -moving.driver_radius if member == "driver" else moving.driven_radius


def _about(points: Array, centre: float, angle: float) -> Array:
    """Points turned about a centre on the line of centres, anticlockwise."""
    c, s = math.cos(angle), math.sin(angle)
    x, y = points[0], points[1] - centre
    return np.stack([c * x - s * y, s * x + c * y + centre])


def _rounded_up(stress: float) -> float:
    """Two digits, no less than a stress."""
    step = 10.0 ** (math.floor(math.log10(stress)) - _DIGITS + 1) if stress > 0.0 else 1.0
    return math.ceil(stress / step) * step


def _drawing(
    name: str, pair: GearPair, moving: MovingPair, stand: Standing, field: Mapping[Member, _Field],
    inside: StressInsideData, top: float, load: float,
) -> StressDrawing:  # fmt: skip
    m = pair.driver.module
    tall, wide = 1e3 * _TALL * m, 1e3 * max(_WIDE * m, 1.15 * max(-pair.x_start, pair.x_end))
    points, triangles, stress, before = [], [], [], 0
    for member, (places, values) in field.items():
        for one, value in zip(places, values, strict=True):
            if np.abs(one[1]).min() < 1e-3 * tall and np.abs(one[0]).min() < 1e-3 * wide:
                points.append(one)
                stress.append(value)
                triangles.append(inside.gears[member].table.triangles + before)
                before += value.size
    outlines = {
        member: 1e3 * _about(getattr(moving, member), _centre(moving, member),
                             turned_by(moving, member, 0, stand.x, pair.base_pitch))
        for member in MEMBERS
    }  # fmt: skip
    along = np.array([math.cos(moving.pressure_angle), math.sin(moving.pressure_angle)])
    return StressDrawing(
        name=name, letter=stand.letter, under=load_words(load), points=1e3 * np.hstack(points),
        triangles=np.hstack(triangles), stress=1e-6 * np.concatenate(stress), top=1e-6 * top, outlines=outlines,
        along=along, path=1e3 * np.array([pair.x_start, pair.x_end]),
        letters=tuple((point.letter, 1e3 * point.x) for point in path_points(pair)),
        loads=tuple((1e3 * one.x, one.load) for one in stand.touching), load=load, room=(wide, tall), module=1e3 * m,
    )  # fmt: skip
