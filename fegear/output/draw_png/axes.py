"""Axes on paper: scales, ranges, numbers, marks across the panel."""

from __future__ import annotations

from typing import Any

import numpy as np

from fegear.engine.figure.axis import FEW_DECADES, Axis
from fegear.engine.figure.items import (
    Bars,
    HeatMap,
    Mark,
    Which,
)
from fegear.engine.figure.panel import Panel
from fegear.output.draw_png.texts import titled, words
from fegear.output.shades import shade


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
