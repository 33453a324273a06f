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
    from fegear.shafts.solution import Deflection

#: The largest deflection is drawn as this share of the height of the drawing.
_DRAWN = 0.05
#: Width of a letter and height of a line, over the larger side of the drawing.
_WIDE, _TALL = 0.0145, 0.028
#: Width of a letter of names that stand close to what they name, where the drawing is wide.
_DENSE = 0.0065
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
    bodies = data.drawn.bodies
    ends = np.array([start[body.shaft] + body.z[[0, -1]] for body in bodies])
    across = np.array([heights[body.shaft] + body.outer.max() * np.array([-1.0, 1.0]) for body in bodies])
    return bool(np.ptp(across) > np.ptp(ends))


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
    room = 0.03 * _span(heights)
    ends = np.array([start[body.shaft] + body.z[[0, -1]] for body in data.drawn.bodies])
    size = max(float(np.ptp(ends)), _span(heights) + 2.0 * max(body.outer.max() for body in data.drawn.bodies))
    for body in data.drawn.bodies:
        middle, height = start[body.shaft] + 0.5 * (body.z[0] + body.z[-1]), heights[body.shaft]
        if body.kind == "shaft":
            words = f"{body.shaft}: {figures(ways[body.shaft][1] * 1e6)} µm"
            beyond = room * (1.0 if upright else 0.5 * len(words))
            places.append((start[body.shaft] + body.z[-1] + beyond, height, words))
        elif body.kind == "gear":
            places.append((middle, height - 0.5 * (body.inner[0] + body.outer[0]), body.name))
        else:
            beside = 0.5 * _DENSE * size * len(body.name) if upright else 0.0
            places.append((middle, height - body.outer[0] - room - beside, body.name))
    z, y, labels = zip(*places, strict=True)
    x, y = _turned((np.array(z) * 1e3, np.array(y) * 1e3), upright=upright)
    return Points(x, apart(x, y, labels, 1e3 * size), "", "ink", size=0.0, labels=labels)


def apart(x: Array, y: Array, labels: Sequence[str], size: float) -> Array:
    """Ordinates of labels that do not lie over each other: each as near to its place as the others before it let it be.

    Parameters
    ----------
    x, y : ndarray, shape (N,)
        Middles of the labels.
    labels : sequence of str, length N
    size : float
        The larger side of the drawing, in the unit of `x` and `y`.
    """
    wide, tall = _WIDE * size, _TALL * size
    moved = np.array(y, dtype=float)
    order = np.argsort(-moved, kind="stable")
    for k, one in enumerate(order):
        before = order[:k]
        near = np.abs(x[before] - x[one]) < 0.5 * wide * np.array([len(labels[one]) + len(labels[b]) for b in before])
        taken = moved[before][near]
        steps = (sign * n * 0.5 * tall for n in range(2 * len(labels) + 1) for sign in (-1.0, 1.0))
        moved[one] += next(step for step in steps if (np.abs(taken - moved[one] - step) >= 0.999 * tall).all())
    return moved


def _span(heights: dict[str, float]) -> float:
    return max(heights.values()) - min(heights.values()) or 0.1


def _nice(factor: float) -> float:
    """One, two or five times a power of ten, not above."""
    power = 10.0 ** math.floor(math.log10(factor))
    return next(times * power for times in (5.0, 2.0, 1.0) if times * power <= factor * (1.0 + 1e-9))
