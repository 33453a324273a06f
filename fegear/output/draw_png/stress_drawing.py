"""Gears in mesh with the stress inside their teeth, drawn for a slide: light ground, large letters, arrows of loads."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.printed import figures
from fegear.output.draw_png.texts import words
from fegear.output.shades import LIGHT, STRESS

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.results.pair.drawn_mesh import StressDrawing

#: Inches of the drawing's width, of the room for a title above it and a scale below it.
_WIDTH, _TITLE, _SCALE = 9.0, 0.55, 0.75
#: Points of a letter: title, letters and loads, small print.
_LARGE, _LETTERS, _SMALL = 17, 15, 12
#: Colours of the gears, as in the window.
_GEARS = {"driver": "blue", "driven": "red"}
#: Length of the arrow of all of the load [modules].
_ARROW = 2.6
#: Places of letters beside their points, and of loads beside the ends of their arrows [modules].
_BESIDE, _ABOVE, _BELOW, _AWAY = 0.1, 0.24, -0.52, 0.22


def write_drawing(drawing: StressDrawing, case: str, path: Path) -> None:
    """Write one drawing as SVG, PDF or PNG, by the ending of its name."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Canvas

    from fegear.output.draw_png import DPI, SAVED, SETTINGS

    wide, tall = drawing.room
    height = _WIDTH * tall / wide
    with rc_context(SETTINGS):
        made = Canvas(figsize=(_WIDTH, height + _TITLE + _SCALE))
        FigureCanvasAgg(made)
        whole = height + _TITLE + _SCALE
        axes = made.add_axes((0.0, _SCALE / whole, 1.0, height / whole))
        axes.set_axis_off()
        axes.set_xlim(-wide, wide)
        axes.set_ylim(-tall, tall)
        image = _stress(axes, drawing)
        _gears(axes, drawing)
        _path(axes, drawing)
        _loads(axes, drawing)
        title = f"Pair {drawing.name}, contact at {words(drawing.letter)}, {drawing.under}"
        made.text(0.12 / _WIDTH, 1.0 - 0.5 * _TITLE / whole, title, fontsize=_LARGE, weight="bold", va="center")
        made.text(1.0 - 0.12 / _WIDTH, 1.0 - 0.5 * _TITLE / whole, case, fontsize=_SMALL, color="0.35", va="center",
                  ha="right")  # fmt: skip
        bar = made.add_axes((0.3, 0.45 * _SCALE / whole, 0.4, 0.2 / whole))
        made.colorbar(image, cax=bar, orientation="horizontal", extend="max")
        bar.tick_params(labelsize=_SMALL)
        made.text(0.285, 0.45 * _SCALE / whole, "von Mises stress [MPa]", fontsize=_SMALL, ha="right", va="bottom")
        made.savefig(path, dpi=DPI, **SAVED[path.suffix])


def _stress(axes: Any, drawing: StressDrawing) -> Any:
    from matplotlib.colors import LinearSegmentedColormap

    return axes.tripcolor(
        *drawing.points, drawing.triangles.T, drawing.stress, shading="gouraud", vmin=0.0, vmax=drawing.top,
        cmap=LinearSegmentedColormap.from_list("stress", list(STRESS)),
        rasterized=True,  # as triangles an SVG has 17 MB
    )  # fmt: skip


def _gears(axes: Any, drawing: StressDrawing) -> None:
    wide, tall = drawing.room
    for member, outline in drawing.outlines.items():
        colour = LIGHT[_GEARS[member]]
        axes.plot(*outline, color=colour, lw=2.0)
        down = member == "driver"
        axes.text(-0.98 * wide, -0.97 * tall if down else 0.97 * tall, member, color=colour, fontsize=_LETTERS,
                  weight="bold", va="bottom" if down else "top")  # fmt: skip


def _path(axes: Any, drawing: StressDrawing) -> None:
    along, m = drawing.along, drawing.module
    axes.plot(*np.outer(along, drawing.path), color=LIGHT["green"], lw=2.4)
    beside = -np.inf  # letters of points close to each other stand apart
    for letter, place in drawing.letters:
        x, y = along * place
        axes.plot(x, y, "o", color=LIGHT["green"], ms=5)
        if letter == "C":  # B and D may be close to it
            at = x, y + _BELOW * m
        else:
            beside = max(x - _BESIDE * m, beside + 0.34 * m)
            at = beside, y + _ABOVE * m
        axes.text(*at, words(letter), fontsize=_LETTERS, weight="bold", color=LIGHT["ink"])


def _loads(axes: Any, drawing: StressDrawing) -> None:
    """Arrows on the driven gear, at the contacts."""
    along, m = drawing.along, drawing.module
    across = np.array([along[1], -along[0]])
    for place, load in drawing.loads:
        start = along * place
        end = start + along * _ARROW * m * load / drawing.load
        axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": LIGHT["ink"], "lw": 2.4, "shrinkA": 0,
                                                  "shrinkB": 0, "mutation_scale": 16})  # fmt: skip
        axes.plot(*start, "o", color=LIGHT["ink"], ms=7)
        label = end + _AWAY * m * (along + across)
        axes.text(*label, f"{figures(load * 1e-3, 3)} kN", fontsize=_LETTERS, color=LIGHT["ink"], va="top",
                  bbox={"facecolor": "white", "alpha": 0.85, "edgecolor": "none", "pad": 1.5})  # fmt: skip
