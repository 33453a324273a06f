"""Drawings of rack cutters: their normal sections, their surfaces in space, and the flanks that they leave."""

from __future__ import annotations

import dataclasses
import math
from functools import partial

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.unloaded.pair import HelicalPair
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import Curve, Item, Mark, Points, Surface, outline, polylines
from fegear.engine.figure.panel import Panel
from fegear.geometry.rack_cutter import RackCutter
from fegear.results.helical.flank_generation_shown import GeneratedFlank

#: Departure from the straight profile as drawn, at most, in a section and in space [normal modules].
_IN_SECTION, _IN_SPACE = 0.15, 0.6


#: Positions of a rolling cutter, and points of a drawn profile.
_ROLLS, _FINE = 11, 61


#: Width of a line drawn in space [normal modules].
_RIBBON = 0.06


def rack_cutter_figures(
    name: str, gears: tuple[str, str], pair: HelicalPair, flanks: tuple[GeneratedFlank, GeneratedFlank]
) -> tuple[Figure | DeferredFigure, ...]:
    """Describe the figures of both cutters."""
    u = np.linspace(min(f.u.min() for f in flanks), max(f.u.max() for f in flanks), _FINE)
    cutters = flanks[0].cutter, flanks[1].cutter
    title = f"Rack-cutter surfaces of pair {name}"
    return (
        _sections(name, cutters, u),
        DeferredFigure(f"cutter_surfaces_{name}", title, partial(_surfaces, name, title, pair, cutters, u)),
        _frames(name, cutters),
        _generation(name, gears, flanks),
    )


def _drawn(cutter: RackCutter, u: Array, share: float) -> tuple[RackCutter, str]:
    """The cutter with a departure that can be seen, a round number of times as large, and words that say so."""
    largest = abs(cutter.parabola) * float(np.max(u**2))
    ratio = share * cutter.gear.module / largest if largest else 1.0
    if ratio < 2.0:
        return cutter, ""
    power = 10.0 ** math.floor(math.log10(ratio))
    scale = int(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= ratio))
    return dataclasses.replace(cutter, parabola=cutter.parabola * scale), f" (deviation magnified {scale} times)"


def _tooth(profile: Array) -> Array:
    """A tooth of the rack from its flank, y to the right and x upwards [mm]: both flanks with the land between them."""
    x, y = profile * 1e3
    if abs(y[0]) < abs(y[-1]):  # the flank begins at its narrow end: go through it the other way, to the land
        x, y = x[::-1], y[::-1]
    return np.stack([np.concatenate([y, -y[::-1]]), np.concatenate([x, x[::-1]])])


def _sections(name: str, cutters: tuple[RackCutter, RackCutter], u: Array) -> Figure:
    """Normal sections: both cutters in contact, each in its own frame, and the departure of the pinion's."""
    (pinion, told), gear = _drawn(cutters[0], u, _IN_SECTION), cutters[1]
    module, a_m = gear.gear.module * 1e3, gear.half_width * 1e3
    pitch = math.pi * module
    parabolic, line = (
        _tooth(cutter.normal_profile(u)) for cutter in (pinion, dataclasses.replace(pinion, parabola=0.0))
    )
    # The x axis of the gear's cutter runs through a tooth of the gear: its own teeth stand half a pitch beside it.
    x, y = gear.normal_profile(u)
    tooth = _tooth(np.stack([x, 0.5e-3 * pitch - y]))
    mate = polylines(tooth + np.array([[0.5 * side * pitch], [0.0]]) for side in (-1, 1))
    around = (
        outline(-mate, "gear cutter Σ_{t}", "orange"),
        outline(polylines(np.stack([parabolic[0] + k * pitch, parabolic[1]]) for k in (-1, 0, 1)),
                f"pinion cutter Σ_{{c}}{told}", "blue"),
        outline(np.array([[-1.2 * pitch, 1.2 * pitch], [0.0, 0.0]]), "reference line", "grey", 1.0, "dashdot"),
    )  # fmt: skip
    spot = partial(Points, name="o_{b}, where the line of contact passes", role="red", size=6.0)
    axes = _axes(1.5 * module)
    own = (
        outline(line, "straight profile", "grey", 1.0, "dash"),
        outline(parabolic, "", "blue"),
        axes,
        spot([-a_m], [0.0]),
    )
    other = (outline(mate, "", "orange"), axes, spot([a_m], [0.0]))
    departure = np.stack([u * 1e3, cutters[0].parabola * u**2 * 1e6])
    panels = (
        Panel(Axis("y_{c}", "mm"), Axis("x_{c}, out of the pinion", "mm"), (*around, spot([-a_m], [0.0])),
              title="both cutters in contact", equal=True),
        Panel(Axis("y_{c1}", "mm"), Axis("x_{c1}", "mm"), own, (Mark("x", -a_m, "-a_{m}"),),
              title="pinion cutter, cutter coordinates", equal=True),
        Panel(Axis("y_{c2}", "mm"), Axis("x_{c2}", "mm"), other, (Mark("x", a_m, "a_{m}"),),
              title="gear cutter, cutter coordinates", equal=True),
        Panel(Axis("u along the straight profile", "mm"), Axis("deviation a_{c} u²", "um"),
              (outline(departure, "", "blue"),), title="departure, true scale"),
    )  # fmt: skip
    angles = " and ".join(f"{math.degrees(cutter.gear.normal_pressure_angle):.6g}" for cutter in cutters)
    return Figure(
        f"rack_cutters_{name}",
        f"Normal sections of the rack cutters of pair {name}",
        f"Pair {name}: rack cutters in the normal section, with profile angles of {angles} deg. Maximum departure of "
        f"the pinion profile from the straight line {departure[1].max():.4g} um. Non-working flanks are the mirror "
        "image.",
        panels,
        columns=2,
    )


def _axes(length: float) -> Curve:
    arm = np.array([0.0, length])
    return outline(polylines([np.stack([arm, 0.0 * arm]), np.stack([0.0 * arm, arm])]), "axes", "ink", 1.0)


def _about_reference(cutter: RackCutter, u: Array, z: Array) -> Array:
    """Points of a cutter surface, x from its reference line: without what a profile shift moves the cutter by."""
    points = cutter.points(u, cutter.along(u, z))
    return np.stack([points[0] - cutter.shift, points[1], points[2]])


def _surfaces(name: str, title: str, pair: HelicalPair, cutters: tuple[RackCutter, RackCutter], u: Array) -> Figure:
    """Both cutter surfaces in the pinion cutter's frame, and the line along which they touch."""
    (drawn, told), module, face = _drawn(cutters[0], u, _IN_SPACE), pair.pinion.module, pair.pinion.face_width
    z = np.linspace(-0.5, 0.5, 2)[:, None] * face
    pinion, gear = (_about_reference(cutter, u, z) for cutter in (drawn, cutters[1]))
    gear = np.stack([-gear[0], -gear[1], gear[2]])  # the tool is one body: the gear's frame is turned by half a turn
    side = drawn.normals(0.0)  # where the pinion cutter stands off the plane
    middle = np.array([-_RIBBON, _RIBBON]) * module
    line = _about_reference(drawn, middle, z) + 0.5 * _RIBBON * module * side[:, None, None]
    items = (
        Surface(gear * 1e3, "orange", name="gear cutter: plane Σ_{t}"),
        Surface(pinion * 1e3, "blue", 0.75, f"pinion cutter: cylinder Σ_{{c}}{told}"),
        Surface(line * 1e3, "red", name="line of contact o_{b} z_{b}"),
    )
    centre = _about_reference(drawn, np.zeros(()), np.zeros(())) * 1e3
    tooth = drawn.points(0.0, 1.0) - drawn.points(0.0, 0.0)
    eye = centre + face * 1e3 * (0.9 * side + 1.4 * tooth + np.array([-0.7, 0.0, 0.0]))
    camera = (tuple(eye.tolist()), tuple(centre.tolist()), (0.0, 0.0, 1.0))
    caption = (
        f"Pair {name}: surfaces generating the flanks; contact along a line at the helix angle of "
        f"{math.degrees(pair.gear.helix_angle):.4g} deg to the gear axes."
    )
    return Figure(
        f"cutter_surfaces_{name}", title, caption, (Panel(Axis(), Axis(), items, height=1.25, camera=camera),)
    )


def _frames(name: str, cutters: tuple[RackCutter, RackCutter]) -> Figure:
    """The pitch plane: traces of the cutters' teeth, the frames of the normal section and of the cutter."""
    panels = []
    for cutter, role, which, letter in ((cutters[0], "blue", "pinion", "c"), (cutters[1], "orange", "gear", "t")):
        beta, face = cutter.gear.helix_angle, 0.5 * cutter.gear.face_width
        step = math.pi * cutter.gear.module / math.cos(beta)
        _, y, z = cutter.points(0.0, cutter.along(0.0, np.array([-face, face])))
        flanks = polylines(np.stack([y + k * step, z]) for k in (-1, 0, 1))
        backs = polylines(np.stack([y + (k + 0.5) * step, z]) for k in (-2, -1, 0, 1))
        arm = 0.8 * face
        along = cutter.points(0.0, np.array([0.0, arm]))[1:] - cutter.points(0.0, 0.0)[1:, None]
        arc = np.linspace(0.0, math.atan2(along[0, 1], along[1, 1]), 21)
        own = polylines([np.array([[0.0, 1.2 * arm], [0.0, 0.0]]), np.array([[0.0, 0.0], [0.0, 1.2 * arm]])])
        normal = polylines([along, np.stack([along[1], -along[0]])])
        spread = np.stack([0.6 * arm * np.sin(arc), 0.6 * arm * np.cos(arc)])
        items: tuple[Item, ...] = (
            outline(flanks * 1e3, f"flank Σ_{{{letter}}} on the pitch plane", role),
            outline(backs * 1e3, "back flanks", "grey", 1.0),
            outline(own * 1e3, "axes of the cutter, z along that of the gear", "ink", 1.0),
            outline(normal * 1e3, "axes of the normal section", "red", 1.4, "dash"),
            outline(spread * 1e3, f"β = {math.degrees(beta):.4g}°", "green", 1.6),
        )
        across, up = Axis(f"y_{{{letter}}}", "mm"), Axis(f"z_{{{letter}}}", "mm")
        panels.append(
            Panel(across, up, items, title=f"{which} cutter, {cutter.gear.hand} hand", equal=True, height=0.9)
        )
    return Figure(
        f"cutter_frames_{name}",
        f"Rack cutters of pair {name} on the pitch plane",
        f"Pair {name}: pitch plane with the traces of the cutter teeth at the helix angle to the gear axes, along "
        "which the normal section is translated.",
        tuple(panels),
        columns=2,
    )


def _generation(name: str, gears: tuple[str, str], flanks: tuple[GeneratedFlank, GeneratedFlank]) -> Figure:
    """The transverse section z = 0: positions of the cutter in the gear's frame, and the flank that they leave."""
    panels = []
    for gear, flank, role, mark in zip(gears, flanks, ("blue", "orange"), ("c", "t"), strict=True):
        cutter, middle = flank.cutter, 1
        u = np.linspace(flank.u.min(), flank.u.max(), _FINE)
        profile = cutter.points(u, cutter.along(u, 0.0))
        rolls = np.linspace(flank.psi[middle].min(), flank.psi[middle].max(), _ROLLS)
        radius = cutter.gear.pitch_radius
        x, y, _ = flank.points[:, middle]
        span, centre = 1.2 * max(float(np.ptp(x)), float(np.ptp(y))), float(y.mean())
        around = centre + np.linspace(-span, span, 121)
        way = (1.0 if mark == "t" else -1.0) * radius * rolls
        axis = cutter.rolled(np.stack([0.0 * way, way, 0.0 * way]), rolls)
        items: tuple[Item, ...] = (
            outline(
                polylines(cutter.rolled(profile, psi)[[1, 0]] * 1e3 for psi in rolls),
                "positions of the cutter",
                "sky",
                0.8,
            ),
            outline(np.stack([y, x]) * 1e3, f"flank of {gear}", role, 2.4),
            outline(np.stack([around, np.sqrt(radius**2 - around**2)]) * 1e3, "pitch circle", "grey", 1.0, "dashdot"),
            Points(axis[1] * 1e3, axis[0] * 1e3, "instantaneous axis at each position", "red", size=3.5),
        )
        across = Axis("y", "mm", limits=((centre - 0.6 * span) * 1e3, (centre + 0.6 * span) * 1e3))
        up = Axis("x", "mm", limits=((float(x.min()) - 0.15 * span) * 1e3, (float(x.max()) + 0.15 * span) * 1e3))
        panels.append(Panel(across, up, items, title=f"{gear}: transverse section z = 0", equal=True, height=1.2))
    return Figure(
        f"generation_{name}",
        f"Generation of the flanks of pair {name} by rack cutters",
        f"Pair {name}, seen along the axis: the cutter rolls on the pitch circle, and the flank is the envelope of "
        "its positions. Contact where the normal passes through the instantaneous centre of rotation.",
        tuple(panels),
        columns=2,
    )
