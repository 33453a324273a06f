"""The figure of a gear's body: its section along the axis with the dimensions of the case, and where its holes lie."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Points, outline, polylines
from fegear.engine.figure.panel import Panel
from fegear.geometry.outline import tooth_outline, turned

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.geometry.gear import Gear
    from fegear.geometry.gear_body import GearBody, WebHoles

#: Chords of drawn teeth stay this close to them [modules]; lines that hatch the section; angles round a circle.
_CHORD, _HATCHED, _ROUND = 3e-3, 40, np.linspace(0.0, 2.0 * math.pi, 181)
#: How far dimensions stand off the section, room around it, and strokes at their ends, as a share of its larger side.
_OFF, _ROOM, _STROKE = 0.045, 0.13, 0.012
#: Width over height of the section's panel on paper, alone and with another one.
_ALONE, _TWO = 1.25, 0.83
#: Offsets, and hubs, that are smaller than this share of the face or of the bore are none.
_ZERO = 1e-9


def dimensions(gear: Gear, body: GearBody) -> dict[str, tuple[str, float, Array]]:
    """Letter, size [mm or deg] and drawn line (2, N) [mm] of each key that the case gives; none of what is zero."""
    end, rim, hub, bore = (1e3 * x for x in (gear.face_width / 2, body.rim_radius, body.hub_radius, gear.bore_radius))
    web, foot, seat = 1e3 * np.array([body.web, body.foot, body.hub])
    off, middle, seated = _OFF * max(2.0 * end, 1e3 * gear.tip_radius), float(web.mean()), float(seat.mean())
    found: dict[str, tuple[str, float, Array]] = {}

    def add(key: str, letter: str, low: tuple[float, float], high: tuple[float, float]) -> None:
        found[key] = letter, high[0] - low[0] + high[1] - low[1], np.array([low, high]).T

    add("face_width", "b", (-end, 1e3 * gear.tip_radius + off), (end, 1e3 * gear.tip_radius + off))
    add("rim_thickness", "s_{R}", (-end - off, rim), (-end - off, 1e3 * gear.root_radius))
    (left, right), place = map(float, 0.8 * foot + 0.2 * web), 0.8 * hub + 0.2 * rim
    add("web_thickness", "b_{s}", (left, place), (right, place))
    if abs(middle) > _ZERO * end:
        add("web_offset", "e_{s}", (0.0, rim - 0.8 * off), (middle, rim - 0.8 * off))
    if body.lean:
        angle, reach = np.linspace(0.0, math.atan(body.lean), 9), 0.55 * (rim - hub)
        arc = np.array([middle + reach * np.sin(angle), rim - reach * np.cos(angle)])
        line = polylines([np.array([arc[:, -1], (middle, rim), arc[:, 0]]).T, arc])[:, :-1]
        found["web_inclination"] = "δ", math.degrees(angle[-1]), line
    if hub - bore > _ZERO * bore:
        add("hub_radius", "r_{h}", (end + off, 0.0), (end + off, hub))
        add("hub_width", "b_{h}", (float(seat[0]), bore - off), (float(seat[1]), bore - off))
        if abs(seated) > _ZERO * end:
            add("hub_offset", "e_{h}", (0.0, bore - 2.5 * off), (seated, bore - 2.5 * off))
    add("bore_radius", "r_{i}", (-end - off, 0.0), (-end - off, bore))
    return found


def _corners(gear: Gear, body: GearBody) -> Array:
    return np.array(body.section(gear.tip_radius, gear.bore_radius, gear.face_width)).T


def hatched(gear: Gear, body: GearBody) -> Array:
    """Lines at 45 degrees inside the section, with gaps, shape (2, N) [m]."""
    step, lines, corners = max(gear.face_width, gear.tip_radius) / _HATCHED, [], _corners(gear, body)
    for part in ([0, 1, 2, 11], [3, 4, 9, 10], [5, 6, 7, 8]):  # rim with teeth, web, hub
        here = corners[:, part]
        rank, there = here[1] - here[0], np.roll(here, -1, axis=1)
        after = np.roll(rank, -1)
        for level in step * np.arange(math.ceil(rank.min() / step), math.floor(rank.max() / step) + 1):
            cut = (rank < level) != (after < level)  # two sides of a convex part, or none
            if cut.any():  # none where the line only touches a corner
                lines.append(here[:, cut] + (level - rank[cut]) / (after - rank)[cut] * (there - here)[:, cut])
    return polylines(lines)


def body_figures(gears: Mapping[str, Gear]) -> tuple[Figure, ...]:
    """The section of each gear with a body, and seen along the axis its web where that has holes."""
    return tuple(_figure(name, gear, gear.body) for name, gear in gears.items() if gear.body is not None)


def _figure(name: str, gear: Gear, body: GearBody) -> Figure:
    holes, panels, given = body.holes, [_section(gear, body)], []
    for key, (letter, size, _) in dimensions(gear, body).items():
        unit = "deg" if key == "web_inclination" else "mm"
        given.append(f"{letter.replace('{', '').replace('}', '')} = {size:.6g} {unit} ({key})")
    said = f"Gear {name}, axial section, teeth drawn up to the tip: {', '.join(given)}."
    if holes is not None:
        panels.append(_along_axis(gear, body, holes))
        turn = f", turned by {math.degrees(holes.angle):.6g} deg (holes.angle)" if holes.angle else ""
        taken = "" if holes.tooth is None else f" All teeth use the results of tooth {holes.tooth}."
        said += (
            f" {holes.count} holes of {2e3 * holes.radius:.6g} mm (holes.diameter) on a circle of "
            f"{2e3 * holes.circle_radius:.6g} mm (holes.circle_diameter){turn}, dashed in the section. Seen from end "
            f"II, tooth 0 is at the top with its loaded flank on the right.{taken}"
        )
    return Figure(f"gear_body_{name}", f"Section of the body of gear {name}", said, tuple(panels), columns=len(panels))


def _section(gear: Gear, body: GearBody) -> Panel:
    end, tip, root, holes = 0.5e3 * gear.face_width, 1e3 * gear.tip_radius, 1e3 * gear.root_radius, body.holes
    size, room = max(2.0 * end, tip), _ROOM * max(2.0 * end, tip)
    low, high = -0.3 * room, tip + room
    side = max(end + room, 0.5 * (_ALONE if holes is None else _TWO) * (high - low))
    middles = np.array([[(-end - room, end + room), (0.0, 0.0)], [(0.0, 0.0), (low, high)]])
    items: list[Curve | Points] = [
        outline(1e3 * hatched(gear, body), "", "grey", 0.4),
        outline(1e3 * _corners(gear, body), "section", "outline", 2.0),
        outline(np.array([(-end, end), (root, root)]), "root circle", "grey", 1.0, "dot"),
        outline(polylines(middles), "axis and mid-face", "grey", 1.0, "dashdot"),
    ]
    if holes is not None:
        rings = (holes.circle_radius - holes.radius, holes.circle_radius + holes.radius)
        drawn = 1e3 * polylines(np.array([body.web, (r, r)]) for r in rings)
        items.append(outline(drawn, "holes", "orange", 1.6, "dash"))
    ends = (-end, "end I"), (end, "end II")
    axes = Axis("axial", limits=(-side, side), ticks=ends), Axis("radial", "mm", limits=(low, high))
    letters, lines, at = [], [], []
    for letter, _, line in dimensions(gear, body).values():
        letters.append(letter)
        lines.append(line)
        at.append(0.65 * line[:, -9:][:, 0] + 0.35 * line[:, -1])
        if line.shape[1] == 2:  # strokes at both ends
            upright = bool(line[0, 0] == line[0, 1])
            stroke = _STROKE * size * np.array([[-1.0, 1.0], [0.0, 0.0]])[:: 1 if upright else -1]
            lines += [place[:, None] + stroke for place in line.T]
            at[-1][0] -= 0.4 * _OFF * size * upright
    (x, y), notes = np.array(at).T, tuple(letters)
    items += [outline(polylines(lines), "", "ink", 1.0), Points(x, y, "", "ink", size=0.1, written=True, notes=notes)]
    return Panel(*axes, tuple(items), title="Axial section", height=1.5, equal=True)


def _along_axis(gear: Gear, body: GearBody, holes: WebHoles) -> Panel:
    circle, half = 1e3 * np.array([np.sin(_ROUND), np.cos(_ROUND)]), 1.1e3 * gear.tip_radius
    tooth, pitch = tooth_outline(gear.tooth, _CHORD) * gear.module * 1e3, 2.0 * math.pi / gear.teeth
    first, apart = holes.radius * circle + np.array([[0.0], [1e3 * holes.circle_radius]]), 2.0 * math.pi / holes.count
    rings = body.rim_radius, body.hub_radius, gear.bore_radius
    every = polylines(turned(first, holes.angle + k * apart) for k in range(holes.count))
    items = (
        outline(np.hstack([turned(tooth, k * pitch) for k in range(gear.teeth)]), "teeth", "outline", 1.4),
        outline(polylines(r * circle for r in rings), "rim, hub and bore", "grey", 1.2),
        outline(holes.circle_radius * circle, "circle of the holes", "grey", 0.9, "dashdot"),
        outline(every, "holes", "orange", 2.0),
        Points([0.0], [1e3 * gear.tip_radius], "", "ink", size=4.0, written=True, notes=("0",)),
    )
    axes = Axis("across", "mm", limits=(-half, half)), Axis("towards tooth 0", "mm", limits=(-half, half))
    return Panel(*axes, items, title="Axial view from end II", height=1.5, equal=True)
