"""Picture in space: the largest pressure that every place on the flanks sees, on a tooth of either gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Skin
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.load_words import load_words
from fegear.geometry.outline import tooth_outline, turned
from fegear.geometry.pair import MEMBERS, GearPair, Member

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.contact.wide.loaded import LoadedFlanks

#: How far chords of the outline may lie off it [modules], and longest steps on it and along the face.
_CHORD, _STEP, _ALONG = 1e-4, 0.05, 0.1


#: Room between both teeth, of the face width.
_APART = 0.2


#: Where the scale of colours ends: this share of the pressed places has less pressure.
_TOP = 98.0


def flank_pressure_figure(name: str, found: LoadedFlanks, case: int) -> Figure:
    """Draw the driver's tooth on the left and the driven gear's on the right, loaded flanks toward the eye."""
    shift = 0.5 * (1.0 + _APART) * (found.lines.high - found.lines.low)
    parts = [_tooth(found, member, case) for member in MEMBERS]
    moved = [
        points + np.array([[0.0], [parts[0][0][1].max() - points[1].max()], [sign * shift]])
        for sign, (points, _, _) in zip((1, -1), parts, strict=True)
    ]  # side by side with the driver, however different the radii
    count = moved[0].shape[1]
    values = np.concatenate([value for _, _, value in parts]) * 1e-6
    top = float(np.percentile(values[values > 0.0], _TOP)) if (values > 0.0).any() else 1.0
    skin = Skin(
        np.hstack(moved) * 1e3, np.hstack([parts[0][1], parts[1][1] + count]), values, top, "pressure", "MPa"
    )  # fmt: skip
    return Figure(
        f"flank_pressure_{name}",
        f"Pressure on the flanks of pair {name}",
        f"Pair {name}: maximum Hertzian pressure at each point of the flank over the mesh cycle; driver on the left, "
        f"driven gear on the right, +z to the left. Colour scale limited to {top:.4g} MPa; higher pressure possible "
        "at tips and face ends.",
        (Panel(Axis(), Axis(), (skin,), height=1.0, camera=((1.6, 0.6, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))),),
        under=load_words(float(found.load[case])),
    )


def _tooth(found: LoadedFlanks, member: Member, case: int) -> tuple[Array, Index, Array]:
    """Points (3, N) [m], triangles (3, T) and pressure (N,) [Pa] of a tooth's skin, its loaded flank toward +x."""
    pair, lines = found.pair, found.lines
    gear = pair.gear(member)
    section = _refined(tooth_outline(gear.tooth, _CHORD)) * gear.module
    stations = np.linspace(lines.low, lines.high, max(9, round((lines.high - lines.low) / (_ALONG * gear.module)) + 1))
    layers = [np.vstack([turned(section, -gear.twist * z), np.full(section.shape[1], z)]) for z in stations.tolist()]
    value = _on_flank(found, pair, member, section, stations, case)
    low = float(section[1].min())
    centre = np.array([[0.0], [0.5 * (low + gear.tooth.root_radius * gear.module)]])  # of both ends, inside the tooth
    ends = [np.append(turned(centre, -gear.twist * z).ravel(), z) for z in (stations[0], stations[-1])]
    n, m = section.shape[1], stations.size
    points = np.hstack([*layers, np.array(ends).T])
    return points, _triangles(n, m), np.append(value.ravel(), [np.nan, np.nan])


def _refined(outline: Array) -> Array:
    """The outline with chords no longer than a step [modules], shape (2, N)."""
    parts = [outline[:, :1]]
    for a, b in zip(outline.T[:-1], outline.T[1:], strict=True):
        count = max(1, int(np.ceil(np.hypot(*(b - a)) / _STEP)))
        parts.append(a[:, None] + (b - a)[:, None] * np.arange(1, count + 1) / count)
    return np.hstack(parts)


def _on_flank(found: LoadedFlanks, pair: GearPair, member: Member, section: Array, stations: Array, case: int) -> Array:
    """Pressure at the points of the section at all stations, shape (stations, N)."""
    radius = np.hypot(*section)
    reach = np.sort(pair.radius(np.array([pair.x_start, pair.x_end]), member))
    tip = radius.min() if pair.gear(member).tooth.internal else radius.max()
    corner = int(np.flatnonzero(np.isclose(radius, tip, rtol=1e-9, atol=0.0))[-1])  # the outline goes on down the flank
    low, high = reach * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    on = corner + np.flatnonzero((radius[corner:] >= low) & (radius[corner:] <= high))
    on = on[section[0, on] > 0.0]
    value = np.full((stations.size, radius.size), np.nan)  # nothing presses on the rest of the tooth
    x = pair.x_of_radius(np.clip(radius[on], *reach), member)
    order = np.argsort(x)
    value[:, on[order]] = found.spread(x[order], stations, found.pressure[:, :, case])
    return value


def _triangles(n: int, m: int) -> Index:
    """Of m layers of n points, and of fans over both ends about two more points, shape (3, T)."""
    first = (np.arange(m - 1)[:, None] * n + np.arange(n - 1)).ravel()
    sides = [np.stack([first, first + 1, first + n]), np.stack([first + 1, first + n + 1, first + n])]
    edge = np.arange(n - 1)
    fans = [
        np.stack([edge + start, edge + start + 1, np.full(n - 1, m * n + k)]) for k, start in ((0, 0), (1, (m - 1) * n))
    ]
    return np.hstack([*sides, *fans])
