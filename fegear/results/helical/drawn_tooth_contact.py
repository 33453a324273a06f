"""Drawings of helical pairs: flanks in space, transverse sections and frames (NASA TM-107451, Figs. A.1.1 to A.1.3)."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import Item, Points, Spot, Surface, outline, polylines
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.seen import Seen
from fegear.geometry.helicoid import InvoluteHelicoid

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.contact.unloaded.tooth_contact import ToothContact
    from fegear.geometry.gear import Gear


#: Flanks drawn on either side of the one in the middle, and points along and across each.
_BESIDE, _ALONG, _ACROSS = 2, 41, 25


def in_space(seen: Seen) -> tuple[DeferredFigure, ...]:
    """Teeth of both gears in mesh."""
    name, made = seen.name, partial(_flanks, seen.name, seen.data.contact)
    return (DeferredFigure(f"flanks_{name}", f"Teeth of pair {name} in mesh", made),)


def _flanks(name: str, contact: ToothContact) -> Figure:
    """The flanks in mesh in space, with the earliest contact in the middle of the cycle."""
    middle = contact.phi_1.size // 2
    phi_1 = float(contact.phi_1[middle])
    phi_2 = float(contact.error[middle]) + contact.pair.ratio * phi_1
    spot = Spot(contact.mesh.point[:, middle] * 1e3, "red", "first contact")
    pitch, width = contact.pair.cut_pinion.pitch_radius * 1e3, contact.pair.pinion.face_width * 1e3
    camera = ((pitch - 1.2 * width, -2.2 * width, 1.8 * width), (pitch, 0.0, 0.0), (0.0, 0.0, 1.0))
    items: tuple[Surface | Spot, ...] = (*_surfaces(contact, phi_1, phi_2), spot)
    return Figure(
        f"flanks_{name}",
        f"Teeth of pair {name} in mesh",
        f"Pair {name}: teeth of pinion and gear in mesh, in the frame of the pinion; red: first contact. Not drawn "
        "below the form circles.",
        (Panel(Axis(), Axis(), items, height=1.25, camera=camera),),
    )


def _surfaces(contact: ToothContact, phi_1: float, phi_2: float) -> list[Surface]:
    """Some teeth of pinion and gear in the fixed frame [mm], from the form circle to the tip."""
    pair, flank, helicoid = contact.pair, contact.pair.flank, contact.pair.mating_flank
    a, b, g = pair.cut_pinion, pair.gear, pair.errors.shaft_angle
    along = np.linspace(-0.5, 0.5, _ALONG)
    s, z = np.meshgrid(np.linspace(flank.s_form, flank.s_tip, _ACROSS), along * a.face_width)
    found = []
    for k in range(-_BESIDE, _BESIDE + 1):
        turn = phi_1 - k * a.angular_pitch
        for x, y, z1 in solid_tooth(flank.points(s, z), a.twist * z - 0.5 * a.angular_pitch):
            x1, y1 = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
            found.append(Surface(np.stack([x1, y1, z1]) * 1e3, "blue", name="pinion"))
    r = np.linspace(max(b.form_radius, b.base_radius * (1.0 + 1e-9)), b.involute_tip_radius, _ACROSS)
    t, z = np.meshgrid(helicoid.tangent_length(r), along * b.face_width + pair.axial_offset)
    for k in range(-_BESIDE, _BESIDE + 1):
        turn = phi_2 - k * b.angular_pitch
        for x, y, z2 in solid_tooth(helicoid.points(t, z), b.twist * z):
            x2, y2 = np.cos(turn) * x + np.sin(turn) * y, -np.sin(turn) * x + np.cos(turn) * y
            fixed = pair.centre_distance - x2, -y2 * np.cos(g) - z2 * np.sin(g), z2 * np.cos(g) - y2 * np.sin(g)
            found.append(Surface(np.stack(fixed) * 1e3, "orange", 0.6, "gear"))
    return found


def solid_tooth(flank: Array, middle: Array) -> list[Array]:
    """A tooth from a flank, shape (3, along, across), and the azimuth of its middle: flanks with top land, and ends."""
    x, y, z = flank
    c, s = np.cos(2.0 * middle), np.sin(2.0 * middle)
    other = np.stack([c * x + s * y, s * x - c * y, z])
    ends = [np.stack([flank[:, end], other[:, end]], axis=1) for end in (0, -1)]
    return [np.concatenate([flank, other[:, :, ::-1]], axis=2), *ends]


#: Angle at which crossed axes are drawn at least, and turn of the pinion in the picture of the frames [rad].
_CROSSED, _TURNED = math.radians(12.0), math.radians(25.0)


def section_figures(name: str, gears: tuple[str, str], pair: HelicalPair) -> tuple[Figure, ...]:
    """Describe the sections of both gears and the frames."""
    sections = Figure(
        f"sections_{name}",
        f"Transverse sections of pair {name} and the parameters of their surfaces",
        f"Pair {name}: sections z = 0, seen along z. A point M of the flank lies u cos λ_{{b}} along the tangent to "
        "the base circle, which touches it by θ beyond the start of the involute.",
        (
            _section(pair.cut_pinion, gears[0], "space", "μ", 1),
            _section(pair.gear, gears[1], "tooth", "η", 2),
        ),
    )
    return sections, _frames(name, gears, pair)


def _arc(radius: float, start: float, end: float) -> Array:
    around = np.linspace(start, end, 61)
    return np.stack([radius * np.sin(around), radius * np.cos(around)]) * 1e3


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.4g}°"


def _section(gear: Gear, name: str, x_axis: Literal["space", "tooth"], letter: str, index: int) -> Panel:
    """z = 0, x upwards: a space or a tooth about the x axis, with the parameters of its surface."""
    flank = InvoluteHelicoid.of(gear, x_axis)
    base, tip, pitch = gear.base_radius, gear.tip_radius, gear.angular_pitch
    involute = flank.points(flank.tangent_length(np.linspace(base, tip, 61)), 0.0)[[1, 0]] * 1e3
    turn = np.array([[math.cos(pitch), math.sin(pitch)], [-math.sin(pitch), math.cos(pitch)]])
    whole = max(base, gear.form_radius)
    cut = flank.points(flank.tangent_length(np.linspace(whole, tip, 61)), 0.0)[[1, 0]] * 1e3
    back = cut * np.array([[-1.0], [1.0]])
    spot = float(flank.tangent_length(0.5 * (gear.pitch_radius + tip)))
    start, end = flank.offset, float(flank.roll_direction(spot, 0.0))
    point = flank.points(spot, 0.0)[[1, 0]] * 1e3
    tangent = np.stack([_arc(base, end, end)[:, 0], point], axis=1)
    reach = -1.15 * abs(end), max(1.6 * pitch, 0.25 * abs(end))
    foot = base * math.cos(end) - 0.15 * (tip - base * math.cos(end))
    role = "blue" if index == 1 else "orange"
    circles = (
        (tip, "tip circle", "solid"),
        (gear.pitch_radius, "reference circle", "dashdot"),
        (base, "base circle", "dot"),
    )
    items: tuple[Item, ...] = (
        outline(polylines([back, turn.T @ cut, turn @ back]), "", role, 1.0),
        outline(involute, f"flank Σ_{{{index}}}", role, 2.4),
        *(outline(_arc(r, *reach), label, "grey", 1.0, dash) for r, label, dash in circles),
        outline(_arc(base, 0.0, start), f"{letter}_{{{index}}} = {_degrees(abs(start))}", "red", 3.0),
        outline(_arc(0.985 * base, start, end), f"θ_{{{index}}} = {_degrees(spot / base)} at M", "green", 2.0),
        outline(tangent, f"u_{{{index}}} cos λ_{{b{index}}} = {spot * 1e3:.4g} mm", "purple", 2.0),
        Points(point[:1], point[1:], "M", "ink", size=6.0),
        outline(np.array([[0.0, 0.0], [foot, 1.02 * tip]]) * 1e3, "x axis", "ink", 1.0),
    )
    up = Axis(f"x_{{{index}}}", "mm", limits=(foot * 1e3, 1.02 * tip * 1e3))
    across = Axis(f"y_{{{index}}}", "mm", limits=(tip * math.sin(reach[0]) * 1e3, tip * math.sin(reach[1]) * 1e3))
    return Panel(across, up, items, title=f"{name}: the x axis halves a {x_axis}", equal=True)


def _frames(name: str, gears: tuple[str, str], pair: HelicalPair) -> Figure:
    """Frames fixed to housing, pinion and gear: along the pinion's axis, and along the line of centres."""
    return Figure(
        f"frames_{name}",
        f"Frames of pair {name}",
        f"Pair {name}: view along the pinion axis with the frames of housing, pinion and gear; view along the line "
        "of centres with the shaft angle error. The pinion turns counter-clockwise, the gear clockwise.",
        (_along_axis(gears, pair), _along_centres(gears, pair)),
        columns=2,
    )


def _along_axis(gears: tuple[str, str], pair: HelicalPair) -> Panel:
    r1, r2, distance = pair.cut_pinion.pitch_radius, pair.gear.pitch_radius, pair.centre_distance
    around = np.linspace(0.0, 2.0 * math.pi, 181)
    circle, turn_2 = np.stack([np.cos(around), np.sin(around)]), pair.ratio * _TURNED

    def frame(angle: float, size: float, centre: float = 0.0, side: float = 1.0) -> Array:
        """The x and y axis of a frame; that of the gear looks at the pinion."""
        c, s = side * size * math.cos(angle), side * size * math.sin(angle)
        return polylines([np.array([[centre, centre + c], [0.0, s]]), np.array([[centre, centre - s], [0.0, c]])]) * 1e3

    items: tuple[Item, ...] = (
        outline(circle * r1 * 1e3, f"reference circle of {gears[0]}", "blue", 1.2),
        outline((circle * r2 + np.array([[distance], [0.0]])) * 1e3, f"reference circle of {gears[1]}", "orange", 1.2),
        outline(frame(0.0, 1.35 * r1), "S_{f}, fixed to the housing", "ink", 1.6),
        outline(frame(_TURNED, 1.1 * r1), f"S_{{1}}, rotated by φ_{{1}} = {_degrees(_TURNED)}", "blue", 2.0),
        outline(frame(0.0, 0.9 * r1, distance, -1.0), "S_{q}, rotated by Δγ", "grey", 1.4, "dash"),
        outline(
            frame(-turn_2, 1.1 * r1, distance, -1.0), f"S_{{2}}, and by φ_{{2}} = {_degrees(turn_2)}", "orange", 2.0
        ),
        outline(np.array([[0.0, distance], [0.0, 0.0]]) * 1e3, f"E = {distance * 1e3:.6g} mm", "green", 1.0, "dot"),
        Points([r1 * 1e3], [0.0], "pitch point", "red", size=5.0),
    )
    return Panel(Axis("x_{f}", "mm"), Axis("y_{f}", "mm"), items, title="along the pinion axis", equal=True)


def _along_centres(gears: tuple[str, str], pair: HelicalPair) -> Panel:
    gamma, face = pair.errors.shaft_angle, pair.pinion.face_width
    shown = math.copysign(max(abs(gamma), _CROSSED), gamma) if gamma else 0.0
    told = f"Δγ = {math.degrees(gamma) * 60.0:.4g}'" + (f", drawn as {_degrees(shown)}" if shown != gamma else "")
    axis = np.array([-math.sin(shown), math.cos(shown)])  # of the gear: (0, -sin, cos) in the fixed frame
    turn = np.array([[axis[1], axis[0]], [-axis[0], axis[1]]])
    square = np.array([[-0.35, 0.35, 0.35, -0.35, -0.35], [-0.5, -0.5, 0.5, 0.5, -0.5]])
    scale = np.array([[face], [pair.gear.face_width]])
    moved = turn @ (square * scale + np.array([[0.0], [pair.axial_offset]]))
    arc = np.linspace(0.0, -shown, 21)
    items: tuple[Item, ...] = (
        outline(square * face * 1e3, gears[0], "blue", 1.2),
        outline(moved * 1e3, gears[1], "orange", 1.2),
        outline(np.array([[0.0, 0.0], [-0.2, 0.9]]) * face * 1e3, "z_{f}, axis of the pinion", "ink", 1.6),
        outline(np.array([[0.0, 0.6], [0.0, 0.0]]) * face * 1e3, "y_{f}", "ink", 1.0),
        outline(np.outer(axis, [-0.2, 0.9]) * face * 1e3, "z_{2}, axis of the gear", "orange", 1.6, "dash"),
        outline(np.stack([np.sin(arc), np.cos(arc)]) * 0.75 * face * 1e3, told, "red", 2.0),
    )
    return Panel(Axis("y_{f}", "mm"), Axis("z_{f}", "mm"), items, title="along the line of centres", equal=True)
