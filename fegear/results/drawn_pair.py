"""The figure at the head of a report: a pair drawn in mesh with its line of action, and its specific sliding."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel, Points, outline, polylines
from fegear.geometry.outline import tooth_outline, turned
from fegear.geometry.pair import MEMBERS
from fegear.geometry.path_of_contact import path_points, specific_sliding

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.geometry import Gear, GearPair
    from fegear.geometry.pair import Member
    from fegear.results.gear_data import Drawing

#: Abscissa of everything that is followed along the path of contact.
LINE_OF_ACTION = Axis("position on the line of action from the pitch point", "mm")
#: Chords of a drawn outline stay this close to it [modules].
_CHORD = 1e-3
#: Room above and below the pitch point [modules], and the same to the sides in pitches.
_TALL, _WIDE = 3.0, 1.9
#: Places at which sliding is drawn, and the most negative that an axis shows: it has no bound on the base circle.
_PLACES, _MOST_SLIDING = 101, -5.0


def path_marks(pair: GearPair) -> tuple[Mark, ...]:
    """The points A to E of the path of contact as marks of an abscissa in millimetres."""
    return tuple(Mark("x", point.x * 1e3, point.letter) for point in path_points(pair))


def roll_marks(pair: GearPair, member: Member) -> tuple[Mark, ...]:
    """The same points as marks of a gear's roll angle in degrees."""
    return tuple(
        Mark("x", math.degrees(float(pair.roll_angle(point.x, member))), point.letter) for point in path_points(pair)
    )


def in_mesh(pair: GearPair, member: Member, teeth: int = 2) -> Array:
    """Outline of a gear's teeth near the pitch point, which is the origin; the flanks touch there, shape (2, N) [m].

    The driver lies below and turns clockwise; along the line of action it pushes to the right and up.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    teeth : int
        How many on either side of the one that touches.

    Returns
    -------
    ndarray, shape (2, N)
        One line, from tooth to tooth.
    """
    gear = pair.gear(member)
    shape = tooth_outline(gear.tooth, _CHORD) * gear.module
    count = min(teeth, (gear.teeth - 1) // 2)
    way = (
        1 if member == "driver" else -1
    )  # from left to right below the pitch point: the line goes on from tooth to tooth
    return np.hstack([placed_in_mesh(pair, member, shape, way * k) for k in range(-count, count + 1)])


def placed_in_mesh(pair: GearPair, member: Member, points: Array, number: int, *, moved: bool = False) -> Array:
    """Points of one tooth where it stands while the flanks of pair 0 touch at the pitch point, the origin.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    points : ndarray, shape (2, ...)
        In the tooth's own frame: from the gear's centre, the centre line along +y, the loaded flank at x > 0.
    number : int
        Of the tooth's pair; higher ones are ahead.
    moved : bool
        Whether these are displacements, which are turned alone.
    """
    gear = pair.gear(member)
    working = _working_radius(pair, gear)
    half = float(gear.tooth.half_thickness_angle(working / gear.module))
    ahead = number if member == "driver" else -number
    x, y = turned(points, ahead * 2.0 * math.pi / gear.teeth - half)
    line = np.stack([x, y if moved else y - working])
    return line if member == "driver" else -line


def _working_radius(pair: GearPair, gear: Gear) -> float:
    return gear.base_radius / math.cos(pair.working_pressure_angle)


def _arc(pair: GearPair, member: Member, radius: float, reach: float) -> Array:
    """The arc of a circle about a gear's centre near the pitch point [m]."""
    half = min(math.pi, 1.3 * reach / radius)
    angle = np.linspace(-half, half, 61)
    arc = np.stack([radius * np.sin(angle), radius * np.cos(angle) - _working_radius(pair, pair.gear(member))])
    return arc if member == "driver" else arc * np.array([[1.0], [-1.0]])


def pair_figure(name: str, drawing: Drawing) -> Figure:
    """A pair in mesh, and the specific sliding of its flanks over the path of contact."""
    pair, names = drawing.pairs[name], drawing.members[name]
    single = 1.0 <= pair.contact_ratio < 2.0
    alone = "; between B and D it is alone" if single else "; at every B and D the number of pairs in contact changes"
    alone += " in one section" if pair.driver.helix_angle else ""
    return Figure(
        f"gear_data_{name}",
        f"Pair {name} in mesh",
        f"Pair {name}: {names[0]} drives (below), {names[1]} is driven (above). Drawn where the flanks touch at the "
        f"pitch point. A tooth pair comes into contact at A and leaves it at E{alone}. Specific sliding is negative "
        "where a flank is dragged, below its own pitch circle."
        + (" All of it lies in the section across the axes." if pair.driver.helix_angle else ""),
        (_drawn(pair), _sliding(pair)),
    )


def _drawn(pair: GearPair) -> Panel:
    module, along = pair.driver.module, pair.working_pressure_angle
    wide = max(_WIDE * math.pi * module, 1.15 * max(-pair.x_start, pair.x_end))
    tall = _TALL * module
    points = path_points(pair)
    x = np.array([point.x for point in points]) * 1e3
    reach = np.array([-1.0, 1.0]) * min(wide, tall / math.sin(along)) * 1e3
    items: list[Curve | Points] = [
        outline(in_mesh(pair, member) * 1e3, member, member, 1.8, "solid") for member in MEMBERS
    ]
    for label, dash, attribute in (("tip circles", "dot", "tip_radius"), ("base circles", "dash", "base_radius")):
        arcs = [_arc(pair, member, getattr(pair.gear(member), attribute), wide) for member in MEMBERS]
        items.append(outline(polylines(arcs) * 1e3, label, "grey", 0.9, dash))
    arcs = [_arc(pair, member, _working_radius(pair, pair.gear(member)), wide) for member in MEMBERS]
    items += [
        outline(polylines(arcs) * 1e3, "working pitch circles", "grey", 0.9, "dashdot"),
        outline(np.stack([reach * math.cos(along), reach * math.sin(along)]), "line of action", "green", 1.2, "solid"),
        outline(np.stack([x[[0, -1]] * math.cos(along), x[[0, -1]] * math.sin(along)]), "", "green", 2.6, "solid"),
        Points(x * math.cos(along), x * math.sin(along), "", "ink", size=6.0, written=True,
               notes=tuple(point.letter for point in points)),
    ]  # fmt: skip
    return Panel(
        Axis("across, from the pitch point", "mm", limits=(-wide * 1e3, wide * 1e3)),
        Axis("along the centre line", "mm", limits=(-tall * 1e3, tall * 1e3)),
        tuple(items), title="The pair in mesh", height=1.5, equal=True,
    )  # fmt: skip


def _sliding(pair: GearPair) -> Panel:
    x = np.linspace(pair.x_start, pair.x_end, _PLACES)
    curves = tuple(
        Curve(
            x * 1e3,
            np.maximum(specific_sliding(pair, x, member), _MOST_SLIDING),
            member,
            member,
            dash="solid",
        )
        for member in MEMBERS
    )
    return Panel(LINE_OF_ACTION, Axis("specific sliding ζ"), curves, path_marks(pair), title="Specific sliding")
