"""Figures as PNG, SVG, PDF by matplotlib: margins are set in inches, legends are above the panels, off the curves."""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fegear.engine.figure.family import few
from fegear.engine.figure.figure import Figure, View
from fegear.output.draw_png.sheet import Sheet
from fegear.output.file_names import file_name

DPI = 150
#: SVG and PDF without dates, so that equal figures are equal bytes; PNG packed in two thirds of the time, a tenth
#: larger.
SAVED: dict[str, dict[str, Any]] = {
    ".svg": {"metadata": {"Date": None}},
    ".pdf": {"metadata": {"CreationDate": None}},
    ".png": {"pil_kwargs": {"compress_level": 3}},
}
#: So many views stand two by two, others three abreast.
_SQUARE = 4
SETTINGS = {
    "font.size": 10.0,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "0.88",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "legend.frameon": False,
    "svg.hashsalt": "fegear",
    "text.hinting": "none",  # fitting letters to pixels takes a tenth of a picture's time
}


#: Formats of pictures, the usual one first.
KINDS = ("png", "svg", "pdf")


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture on disk and the sentence below it in the report."""

    path: Path
    title: str
    caption: str


def draw_pictures(figure: Figure, folder: Path, kind: str = "png") -> Iterator[Picture]:
    """Draw a figure into ``<key>.png``, or every view of it into a file of its own where views have keys.

    Parameters
    ----------
    figure : Figure
    folder : Path
    kind : {"png", "svg", "pdf"}
    """
    alone = [view for view in figure.views if view.key]
    for view in alone:
        path = folder / f"{file_name(view.key)}.{kind}"
        _draw(figure, (view,), path, (f"{figure.heading}: {view.label}", figure.case))
        yield Picture(path, view.label, figure.caption)
    if not alone:
        path = folder / f"{file_name(figure.key)}.{kind}"
        chosen = few(len(figure.views), most=figure.most_views)
        _draw(figure, tuple(figure.views[i] for i in chosen), path, (figure.heading, figure.case))
        yield Picture(path, figure.heading, figure.caption)


def _draw(figure: Figure, views: tuple[View, ...], path: Path, head: tuple[str, str]) -> None:
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Canvas

    panels = [
        (panel, view.label if len(views) > 1 and not panel.title else panel.title)
        for view in views
        for panel in view.panels
    ]
    columns = figure.columns if len(views) == 1 else min(len(views), 2 if len(views) == _SQUARE else 3)
    with rc_context(SETTINGS):
        made = Canvas()
        FigureCanvasAgg(made)
        Sheet(made, panels, min(columns, len(panels)), head).draw()
        made.savefig(path, dpi=DPI, **SAVED[path.suffix])


def warm_up() -> None:
    """Load matplotlib, its font and the writer of PNG, so that the first picture need not: a word on a stamp's room.

    In a process that only draws: matplotlib writes the help texts of all its classes as it is loaded, a fifth of that
    time, and nobody asks for them there.
    """
    from matplotlib import artist as artists

    artists.kwdoc = lambda artist: ""  # noqa: ARG005  (it is called by that name)
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Canvas

    made = Canvas(figsize=(0.5, 0.5))
    FigureCanvasAgg(made)
    made.text(0.0, 0.0, "a")
    made.savefig(io.BytesIO(), format="png")
