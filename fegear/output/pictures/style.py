"""How all pictures look."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from fegear.output.draw_png import Picture

__all__ = ["BLACK", "BLUE", "DASHES", "DPI", "GREEN", "ORANGE", "PURPLE", "RED", "SKY", "YELLOW", "Picture"]

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from matplotlib.figure import Figure

P = ParamSpec("P")
R = TypeVar("R")

#: Okabe and Ito's palette, told apart by all kinds of colour vision.
BLUE, ORANGE, GREEN, RED, SKY, YELLOW, PURPLE, BLACK = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#D55E00",
    "#56B4E9",
    "#F0E442",
    "#CC79A7",
    "#000000",
)
#: Line styles that differ even without colour.
DASHES = ("-", "--", "-.", ":")
DPI = 150

_SETTINGS = {
    "font.size": 10.0,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "0.88",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 11.0,
    "axes.titlelocation": "left",
    "legend.frameon": False,
    "lines.linewidth": 1.8,
}


def in_house_style(draw: Callable[P, R]) -> Callable[P, R]:
    """Let a function draw with the house's settings and leave the user's own as they are."""

    @functools.wraps(draw)
    def drawn(*arguments: P.args, **options: P.kwargs) -> R:
        from matplotlib import rc_context

        with rc_context(_SETTINGS):
            return draw(*arguments, **options)

    return drawn


def legend_above(axes: Any, columns: int) -> None:
    """Put the legend above the axes, where no curve is."""
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, fontsize=9, borderaxespad=0.2)


def figure(
    rows: int = 1, columns: int = 1, *, size: tuple[float, float] = (7.2, 4.2), **options: Any
) -> tuple[Figure, Any]:
    """Make a figure and its axes, without pyplot and its windows.

    Parameters
    ----------
    rows, columns : int
    size : (float, float)
        [inch].
    **options
        Passed to ``Figure.subplots``.

    Returns
    -------
    figure, axes
        `axes` is one axes or an array of them, as matplotlib gives it.
    """
    from matplotlib.figure import Figure

    made = Figure(figsize=size, layout="constrained")
    return made, made.subplots(rows, columns, **options)


def save(made: Figure, path: Path, title: str, caption: str) -> Picture:
    """Write a figure as PNG."""
    made.savefig(path, dpi=DPI)
    return Picture(path, title, caption)
