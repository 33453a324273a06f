"""Figures of one gear that are drawings: the tooth with its tool and mesh, and the whole gear under load.

The figure at the head of a report: a pair drawn in mesh with its line of action, and its specific sliding.

A pair in motion: what a moving picture of it turns and points at, from the same outlines as its drawing.

The tool rolling through one space of either gear of a pair in mesh: its positions, whose envelope is the profile.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, MeshField
from fegear.engine.figure.items import Curve, Points, TriangleField, edges, outline, polylines
from fegear.engine.figure.panel import Panel
from fegear.geometry.checks import Undercut, undercut_of
from fegear.geometry.gear import Gear
from fegear.geometry.outline import tool_in_gear, tool_in_space, tooth_outline, turned
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.path_of_contact import path_points, specific_sliding
from fegear.results.gear.path_marks import LINE_OF_ACTION, path_marks

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.geometry.gear import Gear
    from fegear.results.gear.drawing_data import Drawing


#: Positions of the tool in the picture of a tooth.
_TOOL_POSITIONS = 31


#: Largest displacement as drawn [modules].
_DRAWN = 0.15


#: The deformed gear's scale of colours ends where this share of the nodes near the loaded tooth lies below [%].
_TOP = 99.5


#: Chords of a drawn outline stay this close to it [modules].
_CHORD = 1e-5


def tooth_figure(name: str, gear: Gear, mesh: SectorMesh) -> Figure:
    """The tooth with the positions of its tool, and the mesh of its sector."""
    tooth, m = gear.tooth, gear.module * 1e3
    shape, pitch = tooth_outline(tooth, _CHORD) * m, 2.0 * math.pi / tooth.teeth
    height, radius = float(np.ptp(shape[1])), gear.pitch_radius * 1e3
    around = np.linspace(-1.6 * pitch, 1.6 * pitch, 121)
    tool = "pinion cutter" if tooth.internal else "rack"
    made = " of the flanks (fillets as specified)" if gear.shaped else ""

    def circle(r: float) -> Array:
        return np.stack([r * np.sin(around), r * np.cos(around)])

    lines = (
        outline(polylines(tool_in_space(tooth, _TOOL_POSITIONS) * m),
              "positions of the tool", "sky", width=0.6),
        outline(tool_in_gear(tooth, 0.0) * m, f"tool ({tool})", "tool"),
        outline(polylines(turned(shape, k * pitch) for k in (-1, 1)), "", "outline", width=1.0),
        outline(shape, "tooth", "outline", width=2.2),
        outline(circle(radius), "reference circle", "grey", dash="dashdot", width=1.0),
        outline(circle(gear.base_radius * 1e3), "base circle", "grey", dash="dot", width=1.0),
    )  # fmt: skip
    points, t = mesh.points * m, mesh.triangles
    sides = np.hstack([t[[a, b, c]] for a, b, c in ((0, 3, 1), (1, 4, 2), (2, 5, 0))])
    sides = sides[:, np.unique(sides[1], return_index=True)[1]]  # each side once, by its middle node
    fillets = np.hstack([mesh.edges[side][[0, 2, 1]] for side in ("fillet", "back_fillet")])
    side = tooth.side
    root = side * float((side * np.hypot(*points[:, np.unique(mesh.edges["fillet"])])).min())
    top = side * float((side * np.hypot(*points)).max())
    across = 1.05 * max(float(np.abs(points[0]).max()), abs(top - root))
    below, above = sorted((root - 1.2 * (top - root), top + 0.15 * (top - root)))
    sector = (
        outline(edges(points, sides), "element", "grey", width=0.4),
        outline(edges(points, mesh.edges["flank"][[0, 2, 1]]), "loaded flank", "orange", width=2.0),
        outline(edges(points, fillets), "fillets", "red", width=2.0),
    )
    space = (-0.62 * pitch * radius, 1.12 * pitch * radius)
    room = (0.55, 0.25) if tooth.internal else (0.25, 0.55)
    depth = (float(shape[1].min()) - room[0] * height, float(shape[1].max()) + room[1] * height)
    return Figure(
        f"tooth_{name}",
        f"Tooth, tool and mesh of gear {name}",
        f"Gear {name}: {gear.teeth} teeth, module {m:.6g} mm. Generation{made} by the {tool} tool, and FE mesh of one "
        "sector (cyclic symmetry, complete gear).",
        (
            Panel(Axis("x", "mm", limits=space), Axis("y", "mm", limits=depth), lines,
                  title="Tooth and generating tool", height=1.5, equal=True),
            Panel(Axis("x", "mm", limits=(-across, across)),
                  Axis("y", "mm", limits=(below, above)), sector,
                  title=f"Sector mesh: {mesh.triangles.shape[1]} six-node triangles", height=1.5, equal=True),
        ),
        columns=2,
    )  # fmt: skip


def deformed_figure(name: str, influence: GearInfluence, line_load: float) -> Figure:
    """The whole gear and the loaded tooth, deformed on a larger scale and coloured by von Mises stress."""
    from fegear.fem.plane.loaded_gear import loaded_gear, nodal_fields
    from fegear.fem.plane.mesh import GENERATED

    gear, mesh = influence.gear, influence.fine.mesh
    whole, field = loaded_gear(gear, influence.settings, None if mesh.origin == GENERATED else mesh)
    fields = nodal_fields(gear, whole, field, line_load)
    m, rest = gear.module * 1e3, whole.points * gear.module * 1e3
    moved = fields["displacement"][:, :2].T
    scale = _DRAWN * m / float(np.hypot(*moved).max())
    points = rest + scale * moved
    near = np.hypot(rest[0], rest[1] - gear.pitch_radius * 1e3) < 4.0 * m
    top = float(np.percentile(fields["von_mises"][near], _TOP))
    side = gear.tooth.side
    low, high = sorted((gear.root_radius * 1e3 - side * 1.8 * m, gear.tip_radius * 1e3 + side * 0.5 * m))
    shown = whole.triangles[:, near[whole.triangles].any(axis=0)]
    finer = np.hstack([shown[[a, b, c]] for a, b, c in ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))])
    undeformed = outline(edges(rest, whole.outline), "", "ink", 0.5)
    panels = [
        Panel(
            Axis("x", "mm", limits=(-half, half)), Axis("y", "mm", limits=(centre - half, centre + half)),
            (_stress(points, triangles, fields["von_mises"], top), undeformed),
            title=title, height=1.26, equal=True,
        )
        for half, centre, triangles, title in (
            (1.06 * max(gear.tip_radius, gear.bore_radius) * 1e3, 0.0, whole.triangles[:3], "Full gear"),
            (0.5 * (high - low), 0.5 * (high + low), finer, "Loaded tooth"),
        )
    ]  # fmt: skip
    return Figure(
        f"deformed_{name}",
        f"Deformed gear {name}",
        f"Gear {name} with {line_load * 1e-3:.4g} N/mm on tooth 0, displacements x {scale:.3g}; thin lines: "
        f"undeformed gear. Colour scale limited to {top:.3g} MPa (higher below the contact).",
        tuple(panels),
        columns=2,
        field=MeshField(name, rest, whole.triangles, fields),
        under=f"{line_load * 1e-3:.4g} N/mm",
    )


def _stress(points: Array, triangles: Index, von_mises: Array, top: float) -> TriangleField:
    """Von Mises stress on some triangles, with their own corners alone: most nodes are not drawn."""
    nodes, corners = np.unique(triangles, return_inverse=True)
    return TriangleField(
        points[:, nodes], corners.reshape(triangles.shape), von_mises[nodes], top, "von Mises stress", "MPa"
    )


#: Chords of a drawn outline stay this close to it [modules].
_PAIR_CHORD = 1e-3


#: And those of a moving picture, which is drawn large: at 1e-3 a tip is three chords.
_MOVING_CHORD = 2e-4


#: Room above and below the pitch point [modules], and the same to the sides in pitches.
_TALL, _WIDE = 3.0, 1.9


#: Places at which sliding is drawn, and the most negative that an axis shows: it has no bound on the base circle.
_PLACES, _MOST_SLIDING = 101, -5.0


def in_mesh(pair: GearPair, member: Member, teeth: int = 2, chord: float = _PAIR_CHORD) -> Array:
    """Outline of a gear's teeth near the pitch point, which is the origin; the flanks touch there, shape (2, N) [m].

    The driver lies below and turns clockwise; along the line of action it pushes to the right and up, a driving ring
    gear to the right and down. The centres of an internal pair both lie below.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    teeth : int
        How many on either side of the one that touches.
    chord : float
        How far chords may lie off the curves [modules].

    Returns
    -------
    ndarray, shape (2, N)
        One line, from tooth to tooth.
    """
    gear = pair.gear(member)
    shape = tooth_outline(gear.tooth, chord) * gear.module
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
    half = float(gear.tooth.flank_angle(working / gear.module))
    ahead = number if member == "driver" else -number
    x, y = turned(points, ahead * 2.0 * math.pi / gear.teeth - half)
    line = np.stack([x, y if moved else y - working])
    # the driven gear stands opposite: turned by half a turn, or, its loaded flank at the left, mirrored inside the ring
    return line if member == "driver" else np.stack([-line[0], -pair.side * line[1]])


def _working_radius(pair: GearPair, gear: Gear) -> float:
    return gear.base_radius / math.cos(pair.working_pressure_angle)


def _arc(pair: GearPair, member: Member, radius: float, reach: float) -> Array:
    """The arc of a circle about a gear's centre near the pitch point [m]."""
    half = min(math.pi, 1.3 * reach / radius)
    angle = np.linspace(-half, half, 61)
    arc = np.stack([radius * np.sin(angle), radius * np.cos(angle) - _working_radius(pair, pair.gear(member))])
    return arc if member == "driver" else arc * np.array([[1.0], [-pair.side]])


def pair_figure(name: str, drawing: Drawing) -> Figure:
    """A pair in mesh, and the specific sliding of its flanks over the path of contact."""
    pair, names = drawing.pairs[name], drawing.members[name]
    single = 1.0 <= pair.contact_ratio < 2.0
    places = ("", "") if pair.internal else (" (below)", " (above)")
    alone = (
        "; between B and D it is in single contact"
        if single
        else "; at every B and D the number of pairs in contact changes"
    )
    alone += " in one section" if pair.driver.helix_angle else ""
    return Figure(
        f"gear_data_{name}",
        f"Pair {name} in mesh",
        f"Pair {name}: {names[0]} drives{places[0]}, {names[1]} is driven{places[1]}. Shown in contact at the pitch "
        f"point C. Path of contact A to E{alone}. Specific sliding is negative below the working pitch "
        "circle." + (" Transverse section." if pair.driver.helix_angle else ""),
        (_drawn(pair), _sliding(pair)),
    )


def _drawn(pair: GearPair) -> Panel:
    module, along = pair.driver.module, pair.driver.tooth.side * pair.working_pressure_angle
    wide = max(_WIDE * math.pi * module, 1.15 * max(-pair.x_start, pair.x_end))
    tall = _TALL * module
    points = path_points(pair)
    x = np.array([point.x for point in points]) * 1e3
    reach = np.array([-1.0, 1.0]) * min(wide, tall / abs(math.sin(along))) * 1e3
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
        Axis("perpendicular to the line of centres, from the pitch point", "mm", limits=(-wide * 1e3, wide * 1e3)),
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


#: Teeth on either side of the one that touches at the pitch point: enough for a turn over the whole path.
_TEETH = 6


@dataclass(frozen=True)
class MovingPair(ReadOnlyArrays):
    """Both gears with their flanks touching at the pitch point, which is the origin, and how they turn [m].

    Where a tooth pair touches at x on the line of action, the driver has turned clockwise and the driven gear the other
    way by x over their base radii; the contact stands at x (cos a, sin a), a the working pressure angle, and so does
    that of the pair k base pitches ahead at x + k p_b.

    Parameters
    ----------
    driver, driven : ndarray, shape (2, N)
        Outlines of their teeth near the mesh.
    driver_radius, driven_radius : float
        Of the working pitch circles: the driver's centre lies so far below the origin, that of the driven gear above,
        or, negative, below it in an internal pair.
    driver_base, driven_base : float
        Base radii; that of the driven gear of an internal pair is negative, for it turns as the driver does.
    pressure_angle : float
        Working, in the section across the axes [rad]; negative where a ring gear drives.
    start, end, base_pitch : float
        Of the path of contact.
    points : tuple of (str, float)
        Points A to E of the path with their places.
    module : float
    twist : float
        Tangent of the base helix angle, positive for a right-handed driver: a contact line that crosses the middle of
        the face at x stands at x - z twist at z along it.
    """

    driver: Array
    driven: Array
    driver_radius: float
    driven_radius: float
    driver_base: float
    driven_base: float
    pressure_angle: float
    start: float
    end: float
    base_pitch: float
    points: tuple[tuple[str, float], ...]
    module: float
    twist: float


def moving_pair(pair: GearPair, teeth: int = _TEETH) -> MovingPair:
    """Make a pair ready to be turned.

    Parameters
    ----------
    pair : GearPair
    teeth : int
        How many on either side of those that touch.
    """
    base = pair.driver.base_radius, pair.side * pair.driven.base_radius
    share = pair.centre_distance / abs(base[0] + base[1])
    return MovingPair(
        in_mesh(pair, "driver", teeth, _MOVING_CHORD),
        in_mesh(pair, "driven", teeth, _MOVING_CHORD),
        base[0] * share,
        base[1] * share,
        *base,
        pair.driver.tooth.side * pair.working_pressure_angle,
        pair.x_start,
        pair.x_end,
        pair.base_pitch,
        tuple((point.letter, point.x) for point in path_points(pair)),
        pair.driver.module,
        pair.driver.twist * pair.driver.base_radius,
    )


def undercut_in_mesh(pair: GearPair) -> dict[Member, Undercut]:
    """What the tool cuts off the involutes of a pair, of the gears that have any undercut."""
    found = {member: undercut_of(pair.gear(member)) for member in MEMBERS}
    return {member: one for member, one in found.items() if one is not None and one.lost > 0.0}


def undercut_limits(pair: GearPair) -> dict[Member, float]:
    """Profile shifts from which on the tool cuts nothing off the involutes of a pair, of gears generated by a rack."""
    return {member: one.enough for member in MEMBERS if (one := undercut_of(pair.gear(member))) is not None}


#: Positions of the tool in one space.
_POSITIONS = 31


#: Beside which teeth: clear of the teeth in contact on either side.
_BESIDE: Mapping[Member, int] = {"driver": 1, "driven": -1}


def tool_envelope(pair: GearPair) -> dict[Member, Array]:
    """The rack tool's positions in the space beside a tooth next to the one that touches at the pitch point.

    Parameters
    ----------
    pair : GearPair

    Returns
    -------
    dict of str to ndarray, shape (positions, 2, N)
        By member, where `placed_in_mesh` puts the tooth [m].
    """
    found: dict[Member, Array] = {}
    for member in MEMBERS:
        gear = pair.gear(member)
        at = tool_in_space(gear.tooth, _POSITIONS) * gear.module
        found[member] = placed_in_mesh(pair, member, at.transpose(1, 0, 2), _BESIDE[member]).transpose(1, 0, 2)
    return found
