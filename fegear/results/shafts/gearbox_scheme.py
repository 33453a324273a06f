"""A gearbox drawn in the plane: its shafts unrolled side by side, bent as under load, with gears and bearings."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.printed import figures
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Points, polylines
from fegear.engine.figure.panel import Panel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.contact.wide.on_shafts import LoadedShafts
    from fegear.results.shafts.drawn_gearbox import DrawnBody
    from fegear.results.shafts.gearbox_data import GearboxData
    from fegear.shafts.deflection import Deflection

#: The largest deflection is drawn as this share of the height of the drawing.
_DRAWN = 0.05
#: Letters that fit beside each other into the width of the figure, and into its height; height of a line in letters.
_LETTERS_WIDE, _LETTERS_TALL, _LINE = 122.0, 62.0, 2.0
#: Colour and line width of each kind of body.
_LOOKS = {"shaft": ("ink", 1.2), "gear": ("blue", 1.6), "bearing": ("green", 1.2)}
_LEGEND = {"shaft": "shafts", "gear": "gears", "bearing": "bearings"}


def unrolled(data: LoadedShafts) -> dict[str, float]:
    """Height of every shaft in the drawing: meshing ones lie their centre distance apart, beside each other [m].

    The first shaft of a chain lies at the top; where a shaft drives two, the second lies above it, or below all.
    """
    heights: dict[str, float] = {}
    meshes = list(data.gearbox.meshes)
    for name in data.gearbox.names:
        if name in heights:
            continue
        heights[name] = min(heights.values(), default=0.0) - (_room(data) if heights else 0.0)
        waiting = [name]
        while waiting:
            one = waiting.pop(0)
            for mesh in meshes:
                if one not in mesh.shafts:
                    continue
                other = mesh.shafts[1 - mesh.shafts.index(one)]
                if other in heights:
                    continue
                apart = mesh.found.centre_distance
                below, above = heights[one] - apart, heights[one] + apart
                taken = [h for n, h in heights.items() if n != one]
                free = [h for h in (below, above) if all(abs(h - t) > 0.3 * apart for t in taken)]
                heights[other] = free[0] if free else min(taken) - apart
                waiting.append(other)
    return heights


def _room(data: LoadedShafts) -> float:
    return max((mesh.found.centre_distance for mesh in data.gearbox.meshes), default=0.1)


def _sideways(bent: Deflection) -> tuple[Array, float]:
    """Direction of the largest displacement across the axis, and its size [m]."""
    shifts = np.column_stack([bent.line.x, bent.line.y])
    sizes = np.hypot(*shifts.T)
    most = int(np.argmax(sizes))
    return (shifts[most] / sizes[most] if sizes[most] > 0.0 else np.array([1.0, 0.0])), float(sizes[most])


def scheme(data: GearboxData) -> Figure:
    """The drawing; displacements, all by one factor, in the direction of each shaft's largest one.

    Parameters
    ----------
    data : GearboxData
    """
    shafts = data.shafts
    heights, bent = unrolled(shafts), dict(zip(shafts.gearbox.names, shafts.nominal.bent, strict=True))
    ways = {name: _sideways(one) for name, one in bent.items()}
    bodies = data.drawn.bodies
    tall = max(heights[b.shaft] + b.outer.max() for b in bodies) - min(heights[b.shaft] - b.outer.max() for b in bodies)
    largest = max(size for _, size in ways.values())
    factor = _nice(_DRAWN * tall / largest) if largest > 0.0 else 1.0
    start = {name: data.drawn.places[name][2] for name in heights}
    items: list[Curve | Points] = []
    upright = _upright(data, heights, start)
    for kind in ("shaft", "gear", "bearing"):
        role, width = _LOOKS[kind]
        lines = [
            line
            for body in bodies
            if body.kind == kind
            for line in _outline(body, heights[body.shaft], start[body.shaft], bent[body.shaft], ways, factor)
        ]
        if lines:
            x, y = _turned(polylines(lines) * 1e3, upright=upright)
            items.append(Curve(x, y, _LEGEND[kind], role, dash="solid", width=width, markers=False))
    straight, curved = [], []
    for name, one in bent.items():
        z = one.line.z
        shift = np.column_stack([one.line.x, one.line.y]) @ ways[name][0]
        straight.append(np.array([start[name] + z[[0, -1]], np.full(2, heights[name])]))
        curved.append(np.array([start[name] + z, heights[name] + factor * shift]))
    for lines, label, role, dash, width in (
        (straight, "axes without load", "grey", "dash", 1.0), (curved, "axes under load", "red", "solid", 2.4),
    ):  # fmt: skip
        x, y = _turned(polylines(lines) * 1e3, upright=upright)
        items.append(Curve(x, y, label, role, dash=dash, width=width, markers=False))
    items.append(_names(data, heights, start, ways, upright=upright))
    caption = (
        f"Shafts developed into a plane, in the order of the meshes; displacements magnified {figures(factor)} times, "
        "each in the direction of the maximum displacement of the shaft."
    )
    axes = _turned((Axis("along the shafts, z", "mm"), Axis("centre distances", "mm")), upright=upright)
    panel = Panel(*axes, tuple(items), equal=True)
    return Figure("gearbox", "Gearbox under load", caption, (panel,), under="nominal load")


def _outline(
    body: DrawnBody, height: float, start: float, bent: Deflection, ways: dict[str, tuple[Array, float]], factor: float
) -> list[Array]:
    """Closed outline of a body in the plane, moved with its shaft; a bearing's stand above and below it, crossed."""
    way = ways[body.shaft][0]
    moved = bent.at(body.moves_with)
    shift = height + factor * (moved[:, :2] @ way) if body.kind != "bearing" else np.full(body.z.size, height)
    z = start + body.z
    if body.kind != "bearing":
        return [
            np.array([np.concatenate([z, z[::-1], z[:1]]),
                      np.concatenate([shift + body.outer, (shift - body.outer)[::-1], (shift + body.outer)[:1]])])
        ]  # fmt: skip
    left, right = z[0], z[-1]
    found = []
    for side in (1.0, -1.0):
        low, high = height + side * body.inner[0], height + side * body.outer[0]
        found.append(np.array([[left, right, right, left, left, right], [low, low, high, high, low, high]]))
        found.append(np.array([[left, right], [high, low]]))
    return found


def _upright(data: GearboxData, heights: dict[str, float], start: dict[str, float]) -> bool:
    """Whether the shafts stand upright, so that the drawing is wider than high."""
    along, across = _extents(data, heights, start)
    return across > along


def _turned(pair: Any, *, upright: bool) -> tuple[Any, Any]:
    """Along the shafts and across them, in the order of abscissa and ordinate."""
    along, across = pair
    if not upright:
        return along, across
    return (-across if isinstance(across, np.ndarray) else across), along


def _names(
    data: GearboxData, heights: dict[str, float], start: dict[str, float], ways: dict[str, tuple[Array, float]],
    *, upright: bool,
) -> Points:  # fmt: skip
    """Names of shafts with their largest displacement, of bearings, and of gears."""
    places: list[tuple[float, float, str]] = []
    bodies = data.drawn.bodies
    letter = _letter(*_turned(_extents(data, heights, start), upright=upright))
    line = _LINE * letter
    boxes = []
    thick = {name: max(b.outer.max() for b in bodies if b.shaft == name and b.kind == "shaft") for name in heights}
    if not upright:
        boxes += [box for body in bodies if body.kind == "shaft" for box in _pieces(body, heights, start)]
    far = {name: max(b.z[-1] for b in bodies if b.shaft == name) for name in heights}
    for body in bodies:
        middle, height = start[body.shaft] + 0.5 * (body.z[0] + body.z[-1]), heights[body.shaft]
        if body.kind == "shaft":
            words = f"{body.shaft}: {figures(ways[body.shaft][1] * 1e6)} µm"
            beyond = 0.6 * line if upright else letter * (0.5 * len(words) + 1.0)
            places.append((start[body.shaft] + far[body.shaft] + beyond, height, words))
        elif body.kind == "gear":
            along, across = _of_gear(body, thick[body.shaft], letter, upright=upright)
            places.append((start[body.shaft] + along, height - across, body.name))
        else:
            beyond = letter * (0.5 * len(body.name) + 1.0) if upright else 0.6 * line
            places.append((middle, height - body.outer[0] - beyond, body.name))
            for side in (-1.0, 1.0):
                across, half = height + 0.5 * side * (body.inner[0] + body.outer[0]), body.outer[0] - body.inner[0]
                boxes.append([*_turned((middle, -across if upright else across), upright=upright),
                              *_turned((body.z[-1] - body.z[0], half), upright=upright)])  # fmt: skip
    z, y, labels = zip(*places, strict=True)
    x, y = _turned((np.array(z) * 1e3, np.array(y) * 1e3), upright=upright)
    moved = apart(x, y, labels, 1e3 * letter, 1e3 * np.array(boxes).reshape(-1, 4))
    return Points(x, moved, "", "ink", size=0.0, labels=labels)


def _of_gear(body: DrawnBody, thick: float, letter: float, *, upright: bool) -> tuple[float, float]:
    """Middle of a gear's name, along its shaft and away from its axis: on its body if there is room, else beside it."""
    wide, line = letter * (len(body.name) + 1.0), _LINE * letter
    inside, outside = max(thick, float(body.inner.min())), float(body.outer.max())
    along = 0.5 * float(body.z[0] + body.z[-1])
    room = wide if upright else line
    if outside - inside >= room:
        return along, 0.5 * (inside + outside)
    if upright:  # past the end of its face, beside the shaft: its mate lies beside its body
        return float(body.z[-1]) + 0.6 * line, inside + 0.5 * wide
    return float(body.z[-1]) + 0.5 * wide, inside + 0.6 * line


def _pieces(body: DrawnBody, heights: dict[str, float], start: dict[str, float]) -> list[list[float]]:
    """Boxes of a shaft along the drawing: middle, length and thickness of each of its pieces [m]."""
    height, z = heights[body.shaft], start[body.shaft] + body.z
    return [
        [0.5 * (a + b), height, b - a, 2.0 * max(r, s)]
        for a, b, r, s in zip(z[:-1], z[1:], body.outer[:-1], body.outer[1:], strict=True)
        if b > a
    ]


def _extents(data: GearboxData, heights: dict[str, float], start: dict[str, float]) -> tuple[float, float]:
    """Of the drawing along the shafts and across them [m]."""
    bodies = data.drawn.bodies
    ends = np.array([start[body.shaft] + body.z[[0, -1]] for body in bodies])
    across = np.array([heights[body.shaft] + body.outer.max() * np.array([-1.0, 1.0]) for body in bodies])
    return float(np.ptp(ends)), float(np.ptp(across))


def _letter(wide: float, tall: float) -> float:
    """Width of a letter, in a drawing of this width and height with equal scales."""
    return max(wide / _LETTERS_WIDE, tall / _LETTERS_TALL)


def apart(x: Array, y: Array, labels: Sequence[str], letter: float, boxes: Array | None = None) -> Array:
    """Ordinates of labels that do not lie over each other: each as near to its place as the others before it let it be.

    Parameters
    ----------
    x, y : ndarray, shape (N,)
        Middles of the labels.
    labels : sequence of str, length N
    letter : float
        Width of a letter, in the unit of `x` and `y`.
    boxes : ndarray, shape (B, 4), optional
        Middle (x, y), width and height of what they shall not lie over.
    """
    tall = _LINE * letter
    boxes = np.empty((0, 4)) if boxes is None else boxes
    size = letter * np.array([len(one) for one in labels])
    moved = np.array(y, dtype=float)
    order = np.argsort(-moved, kind="stable")
    for k, one in enumerate(order):
        before = order[:k]
        middles = np.concatenate([x[before], boxes[:, 0]])
        near = np.abs(middles - x[one]) < 0.5 * (size[one] + np.concatenate([size[before], boxes[:, 2]]))
        taken = np.concatenate([moved[before], boxes[:, 1]])[near]
        clear = 0.5 * (tall + np.concatenate([np.full(k, tall), boxes[:, 3]]))[near]
        steps = (sign * n * 0.25 * tall for n in range(8 * (len(labels) + len(boxes)) + 1) for sign in (-1.0, 1.0))
        free = (step for step in steps if (np.abs(taken - moved[one] - step) >= 0.999 * clear).all())
        moved[one] += next(free, 0.0)
    return moved


def _nice(factor: float) -> float:
    """One, two or five times a power of ten, not above."""
    power = 10.0 ** math.floor(math.log10(factor))
    return next(times * power for times in (5.0, 2.0, 1.0) if times * power <= factor * (1.0 + 1e-9))
