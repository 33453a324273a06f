"""What stands in a panel, drawn by matplotlib."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.engine.colours import look
from fegear.engine.figure.items import (
    Curve,
    HeatMap,
    Points,
    Skin,
    Spot,
    Stems,
    Surface,
    TriangleField,
)
from fegear.engine.figure.panel import Panel
from fegear.output.draw_png.texts import words
from fegear.output.shades import DIVERGING, SEQUENTIAL, shade

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: They reach so much farther where notes stand beside points.
_ROOM_FOR_NOTES = 1.6

DASHES = {
    "solid": "-", "dash": "--", "dashdot": "-.", "dot": ":", "longdash": (0, (8, 3)),
    "longdashdot": (0, (8, 2, 2, 2)), "steps": "-",
}  # fmt: skip

SYMBOLS = {
    "circle": "o", "square": "s", "triangle-up": "^", "triangle-down": "v", "diamond": "D", "cross": "P", "x": "X",
    "star": "*",
}  # fmt: skip


def draw_items(axes: Any, panel: Panel) -> Any:
    """Draw the items; return what a scale of colours needs, if anything does."""
    image = None
    solid = [item for item in panel.items if isinstance(item, (Surface, Skin, Spot))]
    if solid:
        from fegear.output.draw_space import draw_space

        axes.imshow(draw_space(solid, panel.camera))
        axes.set_axis_off()
        return None
    for bars, x, foot, width in panel.bars():
        colour = shade(bars.role).light
        error = {} if bars.error is None else {"yerr": bars.error, "error_kw": {"lw": 1.0}}
        axes.bar(x, bars.y, width, foot, color=colour, **error)
    for item in panel.items:
        found = _DRAWN[type(item)](axes, panel, item) if type(item) in _DRAWN else None
        image = found if found is not None else image
    return image


def _curve(axes: Any, _panel: Panel, item: Curve) -> None:
    style, colour = look(item.role), shade(item.role).light
    x, y = np.asarray(item.x), np.asarray(item.y)
    axes.plot(
        x, y, ls=DASHES[item.dash or style.dash], color=colour, lw=item.width, ms=4,
        marker=SYMBOLS[style.symbol] if item.marked else "",
        drawstyle="steps-post" if item.dash == "steps" else "default",
    )  # fmt: skip
    if item.error is not None:
        error = np.asarray(item.error)
        axes.fill_between(x, y - error, y + error, color=colour, alpha=0.25, lw=0)
    if item.fill:
        axes.fill_between(x, y, color=colour, alpha=0.25, lw=0)


def _points(axes: Any, _panel: Panel, item: Points) -> Any:
    symbol = SYMBOLS[item.symbol or look(item.role).symbol]
    if item.shade is not None:
        shaded = np.asarray(item.shade)
        order = np.argsort(shaded)
        return axes.scatter(
            np.asarray(item.x)[order], np.asarray(item.y)[order], c=shaded[order], s=item.size**2, cmap=SEQUENTIAL,
            norm="log", linewidths=0.0,
        )  # fmt: skip
    axes.plot(item.x, item.y, ls="", marker=symbol, ms=0.8 * item.size, color=shade(item.role).light, mew=0.3)
    if item.error is not None:
        axes.errorbar(item.x, item.y, item.error, fmt="none", ecolor=shade(item.role).light, elinewidth=1.0)
    if item.written:
        _write_notes(axes, item)
    for label, a, b in zip(item.labels, np.asarray(item.x), np.asarray(item.y), strict=False):
        axes.annotate(
            words(label), (a, b), ha="center", va="center", fontsize=7, zorder=3.0,
            bbox={"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.6},
        )  # fmt: skip
    return None


def _write_notes(axes: Any, item: Points) -> None:
    """Names beside points; those that would lie on each other go below each other."""
    log = axes.get_xscale() == "log", axes.get_yscale() == "log"
    x, y = np.asarray(item.x), np.asarray(item.y)
    if log[0]:
        left, right = axes.get_xlim()
        axes.set_xlim(left, _ROOM_FOR_NOTES * right)
    if item.lettered:
        for note, a, b in zip(item.notes, x, y, strict=True):
            axes.annotate(words(note), (a, b), xytext=(-9, 4), textcoords="offset points", fontsize=10, weight="bold")
        return
    placed: list[tuple[float, float]] = []
    for i in np.argsort(-y):
        a, b = (math.log10(v) if scale else float(v) for v, scale in zip((x[i], y[i]), log, strict=True))
        crowd = sum(abs(a - c) < 0.9 and abs(b - d) < 0.13 for c, d in placed)
        placed.append((a, b))
        axes.annotate(
            words(item.notes[i]), (x[i], y[i]), xytext=(6, 3 - 8 * crowd), textcoords="offset points", fontsize=7,
            bbox={"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.6}, color="0.25", zorder=1.5,
        )  # fmt: skip


def _stems(axes: Any, panel: Panel, item: Stems) -> None:
    style, colour = look(item.role), shade(item.role).light
    axes.vlines(item.x, panel.foot, item.y, color=colour, lw=1.0)
    axes.plot(item.x, item.y, ls="", marker=SYMBOLS[style.symbol], color=colour, ms=4)
    for number, x, y in zip(item.numbers, np.asarray(item.x), np.asarray(item.y), strict=False):
        axes.annotate(number, (x, y), xytext=(0, 4), textcoords="offset points", ha="center", fontsize=7, color=colour)


def _heat(axes: Any, _panel: Panel, item: HeatMap) -> Any:
    from matplotlib.colors import LinearSegmentedColormap

    low, high = item.ends
    scale: Any = SEQUENTIAL
    if item.centre:
        scale = LinearSegmentedColormap.from_list("diverging", [tuple(v / 255 for v in c) for c in DIVERGING])
    x, y, z = np.asarray(item.x), np.asarray(item.y), np.asarray(item.z)
    axes.set_facecolor("0.75")
    sides = _sides(x), _sides(y)
    image = axes.pcolormesh(*sides, np.ma.masked_invalid(z), cmap=scale, vmin=low, vmax=high, shading="flat")
    if item.numbers:
        for (row, column), value in np.ndenumerate(z):
            known = bool(np.isfinite(value))
            axes.text(
                x[column], y[row], f"{value:.2f}" if known else "×", ha="center", va="center", fontsize=8.5,
                color="white" if known and _dark(item, float(value)) else "black",
            )  # fmt: skip
    return image


def _sides(middles: NDArray[Any]) -> NDArray[Any]:
    """Where tiles end: halfway between their middles; a single one is as wide as a category."""
    half = 0.5 * np.diff(middles) if middles.size > 1 else np.array([0.5])
    return np.concatenate([middles[:1] - half[:1], middles[:-1] + half[: middles.size - 1], middles[-1:] + half[-1:]])


def _dark(item: HeatMap, value: float) -> bool:
    """Whether a tile of a value is too dark for black numbers."""
    low, high = item.ends
    if item.centre:
        return value < item.centre[0] - 0.75 * item.centre[1]
    return value < low + 0.55 * (high - low)


def _field(axes: Any, _panel: Panel, item: TriangleField) -> Any:
    x, y = np.asarray(item.points)
    return axes.tripcolor(
        x,
        y,
        item.triangles.T,
        item.values,
        shading="gouraud",
        cmap=SEQUENTIAL,
        vmin=0.0,
        vmax=item.top,
        rasterized=True,  # as triangles an SVG has 17 MB
    )


_DRAWN: dict[type, Callable[[Any, Panel, Any], Any]] = {
    Curve: _curve,
    Points: _points,
    Stems: _stems,
    HeatMap: _heat,
    TriangleField: _field,
}
