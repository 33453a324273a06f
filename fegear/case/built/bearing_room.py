"""Whether bearings, gears and shafts of a gearbox have room: bores on their shafts, bodies that would cut each other.

All shafts are parallel, so that two bodies on different axes touch where they stand beside each other and their radii
are more than the distance of the axes. What nominal diameters say is looked at; fits and clearances are not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

from fegear.base.notes import failing
from fegear.base.printed import figures
from fegear.shafts.bearing_seat import BearingSeat, Obstacle

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.notes import Note
    from fegear.case.reading import Scene
    from fegear.case.shaft import BearingPlacePart, ShaftInSpacePart

#: Share by which bore and shaft may differ, and two bodies cut each other: places and diameters are rounded.
_SAME, _ROUNDED = 0.005, 0.002


@dataclass(frozen=True)
class _Body:
    """A cylinder about the axis of a shaft, from one end to the other along z, lengths in [m]."""

    name: str
    shaft: str
    kind: str
    radius: float
    start: float
    end: float


def said_of_room(scene: Scene) -> tuple[Note, ...]:
    """Bearings whose bore is not that of their shaft, and bodies that cut each other.

    Parameters
    ----------
    scene : Scene
    """
    found = [note for name, part in scene.case.shaft.items() for note in _bores(scene, name, part)]
    bodies = list(_bodies(scene))
    mating = {frozenset((part.driver, part.driven)) for part in scene.case.pair.values()}
    for one, two in combinations(bodies, 2):
        if {one.kind, two.kind} != {"shaft"} and frozenset((one.name, two.name)) not in mating:
            found.extend(_cut(scene, one, two))
    return tuple(found)


def _bores(scene: Scene, shaft: str, part: ShaftInSpacePart) -> Iterator[Note]:
    for place in part.bearings:
        bearing = scene.case.bearing.get(place.bearing)
        printed = bearing.printed if bearing is not None else None
        if printed is None:
            continue
        outer = min(_diameters(part, place.at), key=lambda one: abs(one - printed.bore), default=printed.bore)
        if abs(outer - printed.bore) <= _SAME * printed.bore:
            continue
        bore, thick = (f"{figures(one * 1e3, 4)} mm" for one in (printed.bore, outer))
        wrong = "is larger than" if printed.bore > outer else "is smaller than"
        of = f" ({bearing.designation})" if bearing is not None and bearing.designation else ""
        yield failing(
            f"Bearing {place.bearing}: bore {bore}{of} {wrong} the diameter of shaft {shaft} there, {thick}; correct "
            f"shaft.{shaft}.sections or bearings, or choose a bearing of bore {thick}",
            min(printed.bore, outer) / max(printed.bore, outer),
        )


def _diameters(part: ShaftInSpacePart, at: float) -> list[float]:
    """Outer diameters of a shaft at a distance from its left end, two at a step."""
    found, start = [], 0.0
    for one in part.sections:
        end = start + one.length
        if start - 1e-9 <= at <= end + 1e-9:
            last = one.outer if one.outer_end is None else one.outer_end
            found.append(one.outer + (last - one.outer) * (at - start) / one.length)
        start = end
    return found


def seats_of(scene: Scene) -> tuple[tuple[BearingSeat, ...], ...]:
    """Seat of every bearing by shafts, with what another bearing there has to keep away from.

    Of bearings between two shafts nothing is known but the bore: they have no shoulder and no other bodies.

    Parameters
    ----------
    scene : Scene
    """
    bodies = list(_bodies(scene))
    return tuple(
        tuple(BearingSeat() if one.around is not None else _seat(scene, bodies, name, one) for one in part.bearings)
        for name, part in scene.case.shaft.items()
    )


def _seat(scene: Scene, bodies: list[_Body], shaft: str, place: BearingPlacePart) -> BearingSeat:
    part = scene.case.shaft[shaft]
    length, shoulder, start = 0.0, 0.0, 0.0
    sections = [max(one.outer, one.outer_end or 0.0) for one in part.sections]
    for n, one in enumerate(part.sections):
        end = start + one.length
        if start - 1e-9 <= place.at <= end + 1e-9 and not length:
            length = one.length
            shoulder = max((sections[k] for k in (n - 1, n + 1) if 0 <= k < len(sections)), default=0.0)
        start = end
    found = []
    for body in bodies:
        if body.shaft == shaft and (body.kind == "shaft" or body.name == place.bearing):
            continue
        apart = math.dist(part.axis, scene.case.shaft[body.shaft].axis)
        if body.shaft != shaft and apart < _ROUNDED * body.radius:
            continue  # one within the other, or behind it
        reach = 0.0 if body.shaft == shaft else apart - body.radius
        found.append(Obstacle(body.start - part.start, body.end - part.start, reach))
    return BearingSeat(place.at, length or math.inf, shoulder, tuple(found))


def _bodies(scene: Scene) -> Iterator[_Body]:
    """Gears, bearings of a known size and sections of all shafts; none of what sits in or around another shaft."""
    for name, part in scene.case.shaft.items():
        for place in part.gears:
            gear = scene.gears[place.gear]
            if not gear.tooth.internal:
                middle = part.start + place.at
                half = 0.5 * gear.face_width
                yield _Body(place.gear, name, "gear", gear.tip_radius, middle - half, middle + half)
        for seat in part.bearings:
            bearing = scene.case.bearing.get(seat.bearing)
            if bearing is not None and seat.around is None and (printed := bearing.printed) is not None:
                middle, half = part.start + seat.at, 0.5 * printed.width
                yield _Body(seat.bearing, name, "bearing", 0.5 * printed.outside_diameter, middle - half, middle + half)
        start = part.start
        for one in part.sections:
            yield _Body(name, name, "shaft", 0.5 * max(one.outer, one.outer_end or 0.0), start, start + one.length)
            start += one.length


def _cut(scene: Scene, one: _Body, two: _Body) -> Iterator[Note]:
    """What two bodies lack in room; nothing for those side by side."""
    beside = min(one.end, two.end) - max(one.start, two.start)
    if beside <= _ROUNDED * min(one.end - one.start, two.end - two.start):
        return
    if one.shaft == two.shaft:
        if "shaft" not in (one.kind, two.kind) and {one.kind, two.kind} != {"gear"}:  # gears are refused
            yield failing(
                f"{_said(one)} and {two.kind} {two.name} on shaft {one.shaft} overlap by {figures(beside * 1e3)} mm "
                f"along it; move one of them (shaft.{one.shaft})"
            )
        return
    axes = [scene.case.shaft[body.shaft].axis for body in (one, two)]
    apart, needed = math.dist(*axes), one.radius + two.radius
    if apart < max(one.radius, two.radius) * _ROUNDED or apart >= needed * (1.0 - _ROUNDED):
        return
    yield failing(
        f"{_said(one)} (diameter {figures(2e3 * one.radius, 4)} mm) and {two.kind} {two.name} (diameter "
        f"{figures(2e3 * two.radius, 4)} mm) intersect: radii {figures(needed * 1e3, 4)} mm, axes of shafts "
        f"{one.shaft} and {two.shaft} {figures(apart * 1e3, 4)} mm apart; move one along its shaft or reduce its "
        "diameter",
        apart / needed,
    )


def _said(one: _Body) -> str:
    return f"{one.kind.capitalize()} {one.name}"
