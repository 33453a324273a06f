"""Axes on paper: scales, ranges, numbers, marks across the panel.

What stands in a panel, drawn by matplotlib.

Texts on paper: subscripts, units, and how many letters they take.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np

from fegear.engine.colours import look
from fegear.engine.figure.figure import FEW_DECADES, Axis, Panel
from fegear.engine.figure.items import (
    Bars,
    Curve,
    HeatMap,
    Mark,
    Points,
    Skin,
    Spot,
    Stems,
    Surface,
    TriangleField,
    Which,
)
from fegear.output.numbers import DIVERGING, SEQUENTIAL, pretty_unit, shade


def set_scales(axes: Any, panel: Panel) -> None:
    """Make logarithmic what is to be."""
    for which, axis in (("x", panel.x), ("y", panel.y)):
        if axis.log:
            getattr(axes, f"set_{which}scale")("log")


def _ranges(axes: Any, panel: Panel) -> None:
    """Ranges of both axes, and whole numbers at those that have no others."""
    from matplotlib.ticker import MultipleLocator

    sides: tuple[tuple[Which, Axis], ...] = (("x", panel.x), ("y", panel.y))
    for which, axis in sides:
        if axis.whole:
            getattr(axes, f"{which}axis").set_major_locator(MultipleLocator(panel.whole_step(which)))
    if panel.limits:
        axes.set_ylim(*panel.limits)
    elif panel.y.zero:
        axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0] if np.min(axes.dataLim.intervaly) < 0.0 else 0.0))
    if panel.x.limits:
        axes.set_xlim(*panel.x.limits)
    elif panel.x.zero:
        axes.set_xlim(left=0.0)


def plain_numbers(axes: Any, panel: Panel) -> None:
    """Numbers without powers at logarithmic axes of few decades."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for which, axis in (("x", panel.x), ("y", panel.y)):
        low, high = getattr(axes, f"get_{which}lim")()
        if axis.log and high < FEW_DECADES * low:
            here = getattr(axes, f"{which}axis")
            here.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0)))
            here.set_major_formatter(FuncFormatter(lambda value, _place: f"{value:g}"))
            here.set_minor_formatter(NullFormatter())


def dress(axes: Any, panel: Panel, *, joined: bool, beside: bool) -> None:
    """Axes: titles, scales, ranges, marks."""
    _axis(axes, panel.x, "x", "" if joined else titled(panel.x.label, panel.x.unit))
    _axis(axes, panel.y, "y", "" if beside else titled(panel.y.label, panel.y.unit))
    if panel.equal:
        axes.set_aspect("equal")
        axes.grid(visible=False)
    _ranges(axes, panel)
    if joined:
        axes.tick_params(labelbottom=False)
    if beside:
        axes.tick_params(labelleft=False)
    if any(isinstance(item, HeatMap) for item in panel.items):
        axes.grid(visible=False)
    elif any(isinstance(item, Bars) for item in panel.items):
        axes.grid(visible=False, axis="x")
    if panel.x.second:
        places, texts = panel.x.second.ticks()
        top = axes.secondary_xaxis("top")
        top.set_xticks(places, texts)
        top.set_xlabel(titled(panel.x.second.label, panel.x.second.unit))


def draw_marks(axes: Any, panel: Panel) -> None:
    """Draw lines and bands across the panel, with their words."""
    grey = shade("grey").light
    for mark in panel.marks:
        line, span = (axes.axvline, axes.axvspan) if mark.axis == "x" else (axes.axhline, axes.axhspan)
        if not isinstance(mark, Mark):
            span(mark.low, mark.high, color="0.5", alpha=0.12, lw=0, zorder=0)
            continue
        line(mark.at, color=grey, lw=1.0, ls=":")
        word = panel.written(mark)
        if not word:
            continue
        where, shift, more = (
            ((mark.at, 1.0), (3, -9), {"xycoords": ("data", "axes fraction")}) if mark.axis == "x"
            else ((1.0, mark.at), (-2, 2), {"xycoords": ("axes fraction", "data"), "ha": "right"})
        )  # fmt: skip
        axes.annotate(
            words(mark.label),
            where,
            xytext=shift,
            textcoords="offset points",
            fontsize=8,
            color="0.35",
            bbox={"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.4},
            **more,
        )


def _axis(axes: Any, axis: Axis, which: str, title: str) -> None:
    getattr(axes, f"set_{which}label")(title)
    if axis.categories:
        getattr(axes, f"set_{which}ticks")(range(len(axis.categories)), [words(name) for name in axis.categories])
    if axis.ticks:
        getattr(axes, f"set_{which}ticks")([at for at, _ in axis.ticks], [words(word) for _, word in axis.ticks])
    if axis.hidden:
        getattr(axes, f"{which}axis").set_visible(False)
        axes.spines["left" if which == "y" else "bottom"].set_visible(False)


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
    image = axes.pcolormesh(x, y, np.ma.masked_invalid(z), cmap=scale, vmin=low, vmax=high, shading="nearest")
    if item.numbers:
        for (row, column), value in np.ndenumerate(z):
            known = bool(np.isfinite(value))
            axes.text(
                x[column], y[row], f"{value:.2f}" if known else "×", ha="center", va="center", fontsize=8.5,
                color="white" if known and _dark(item, float(value)) else "black",
            )  # fmt: skip
    return image


def _dark(item: HeatMap, value: float) -> bool:
    """Whether a tile of a value is too dark for black numbers."""
    low, high = item.ends
    if item.centre:
        return value < item.centre[0] - 0.75 * item.centre[1]
    return value < low + 0.55 * (high - low)


def _field(axes: Any, _panel: Panel, item: TriangleField) -> Any:
    x, y = np.asarray(item.points)
    return axes.tripcolor(
        x, y, item.triangles.T, item.values, shading="gouraud", cmap=SEQUENTIAL, vmin=0.0, vmax=item.top
    )


_DRAWN: dict[type, Callable[[Any, Panel, Any], Any]] = {
    Curve: _curve,
    Points: _points,
    Stems: _stems,
    HeatMap: _heat,
    TriangleField: _field,
}


#: Letters that stand lower as letters of their own: laying out mathematics takes long.
_LOWER = str.maketrans("0123456789+−-=()aehklmnopstx", "₀₁₂₃₄₅₆₇₈₉₊₋₋₌₍₎ₐₑₕₖₗₘₙₒₚₛₜₓ")


def words(text: str) -> str:
    """Plain text for matplotlib: nothing in it is mathematics but what ``_{...}`` sets lower and no letter shows."""

    def lower(found: re.Match[str]) -> str:
        plain = found[1].translate(_LOWER)
        return rf"$_{{\mathrm{{{found[1]}}}}}$" if any(a == b for a, b in zip(plain, found[1], strict=True)) else plain

    return re.sub(r"_\{([^{}]*)\}", lower, text.replace("$", r"\$"))


def titled(label: str, unit: str) -> str:
    """Label with its unit in brackets."""
    return words(f"{label} [{pretty_unit(unit)}]" if unit else label)


def maps_of(panel: Panel) -> list[HeatMap | TriangleField | Points]:
    """Items whose colours need a scale."""
    return [
        i for i in panel.items
        if isinstance(i, (HeatMap, TriangleField)) or (isinstance(i, Points) and i.shade is not None)
    ]  # fmt: skip


def bar_label(item: HeatMap | TriangleField | Points) -> str:
    """What a scale of colours shows."""
    return words(item.shade_label) if isinstance(item, Points) else titled(item.label, item.unit)


def lines_of(axis: Axis) -> int:
    """Lines of the longest name of a category."""
    return max((name.count("\n") + 1 for name in axis.categories), default=1)


def longest_number(axis: Any) -> int:
    """Letters of the longest number at an axis."""
    low, high = sorted(axis.get_view_interval())
    places = [place for place in axis.get_majorticklocs() if low <= place <= high]
    texts = axis.get_major_formatter().format_ticks(places)
    return max((len(re.sub(r"\$|\\[a-z]+|[{}^]", "", text)) for text in texts), default=0)
