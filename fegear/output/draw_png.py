"""Figures as PNG or SVG, by matplotlib: margins are set in inches, legends stand above the panels, off the curves."""

from __future__ import annotations

import math
import re
import textwrap
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.engine.colours import look
from fegear.engine.figure import (
    Axis,
    Bars,
    Curve,
    Figure,
    HeatMap,
    Mark,
    Panel,
    Points,
    Spot,
    Stems,
    Surface,
    TriangleField,
    View,
    Which,
    few,
)
from fegear.output.numbers import pretty_unit
from fegear.output.shades import DIVERGING, SEQUENTIAL, shade

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

DPI = 150
#: Logarithmic axes that span less have plain numbers.
_FEW_DECADES = 100.0
#: They reach so much farther where notes stand beside points.
_ROOM_FOR_NOTES = 1.6
#: So many views stand two by two, others three abreast.
_SQUARE = 4
#: Inches: a panel alone, panels above each other, and around them.
_WIDTHS = {1: 6.5, 2: 4.3, 3: 3.4}
_ALONE, _STACKED = 3.4, 2.3
_LEFT, _RIGHT, _BOTTOM, _NARROW = 0.45, 0.25, 0.55, 0.22
_TITLE, _SECOND, _LINE, _BAR = 0.27, 0.5, 0.21, 1.0
#: Inches of a letter of a title.
_TITLE_LETTER = 0.083
#: Inches of a letter at an axis, of one in a legend, and of the line before the legend's words.
_LETTER, _SMALL_LETTER, _HANDLE = 0.078, 0.069, 0.6
_DASHES = {
    "solid": "-", "dash": "--", "dashdot": "-.", "dot": ":", "longdash": (0, (8, 3)),
    "longdashdot": (0, (8, 2, 2, 2)), "steps": "-",
}  # fmt: skip
_SYMBOLS = {
    "circle": "o", "square": "s", "triangle-up": "^", "triangle-down": "v", "diamond": "D", "cross": "P", "x": "X",
    "star": "*",
}  # fmt: skip
_SETTINGS = {
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
}


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
    kind : {"png", "svg"}
    """
    alone = [view for view in figure.views if view.key]
    for view in alone:
        path = folder / f"{view.key}.{kind}"
        _draw(figure, (view,), path)
        yield Picture(path, view.label, figure.caption)
    if not alone:
        path = folder / f"{figure.key}.{kind}"
        chosen = few(len(figure.views), most=figure.most_views)
        _draw(figure, tuple(figure.views[i] for i in chosen), path)
        yield Picture(path, figure.title, figure.caption)


#: Letters that stand lower as letters of their own: laying out mathematics takes long.
_LOWER = str.maketrans("0123456789+−-=()aehklmnopstx", "₀₁₂₃₄₅₆₇₈₉₊₋₋₌₍₎ₐₑₕₖₗₘₙₒₚₛₜₓ")


def _words(text: str) -> str:
    """Plain text for matplotlib: nothing in it is mathematics but what ``_{...}`` sets lower and no letter shows."""

    def lower(found: re.Match[str]) -> str:
        plain = found[1].translate(_LOWER)
        return rf"$_{{\mathrm{{{found[1]}}}}}$" if any(a == b for a, b in zip(plain, found[1], strict=True)) else plain

    return re.sub(r"_\{([^{}]*)\}", lower, text.replace("$", r"\$"))


def _titled(label: str, unit: str) -> str:
    return _words(f"{label} [{pretty_unit(unit)}]" if unit else label)


def _draw(figure: Figure, views: tuple[View, ...], path: Path) -> None:
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Canvas

    panels = [
        (panel, view.label if len(views) > 1 and not panel.title else panel.title)
        for view in views
        for panel in view.panels
    ]
    columns = figure.columns if len(views) == 1 else min(len(views), 2 if len(views) == _SQUARE else 3)
    with rc_context(_SETTINGS):
        made = Canvas()
        FigureCanvasAgg(made)
        _Sheet(made, panels, min(columns, len(panels))).draw()
        options: dict[str, Any] = {"metadata": {"Date": None}} if path.suffix == ".svg" else {}
        made.savefig(path, dpi=DPI, **options)


class _Sheet:
    """Panels placed on a sheet in rows, all sizes in inches."""

    def __init__(self, made: Any, panels: Sequence[tuple[Panel, str]], columns: int) -> None:
        letters = int(_WIDTHS.get(columns, _WIDTHS[3]) / _TITLE_LETTER)
        self.made, self.columns = made, columns
        self.panels = [
            (panel, "\n".join(line for part in title.split("\n") for line in textwrap.wrap(part, letters)))
            for panel, title in panels
        ]
        self.rows = -(-len(panels) // columns)

    def _title_room(self, row: int) -> float:
        here = self.panels[row * self.columns : (row + 1) * self.columns]
        second = any(panel.x.second for panel, _ in here)
        return _TITLE * max(title.count("\n") + 1 if title else 0 for _, title in here) + _SECOND * second

    def _joined(self, row: int, column: int) -> bool:
        """Whether the panel below has the same abscissa, which then names it for both."""
        i = row * self.columns + column
        below = i + self.columns
        return below < len(self.panels) and self.panels[i][0].x.like(self.panels[below][0].x) and not any(
            panel.equal for panel, _ in self.panels
        )  # fmt: skip

    def _beside(self, i: int) -> bool:
        """Whether the panel to the left has the same ordinate, which then names it for both."""
        if i % self.columns == 0:
            return False
        here, left = self.panels[i][0], self.panels[i - 1][0]
        if here.equal and here.y.limits != left.y.limits:
            return False
        return here.y.like(left.y) and (not _maps(here) or self._one_bar())

    def _one_bar(self) -> bool:
        """Whether all panels are maps of one quantity, which have one scale of colours."""
        return len({_bar_label(item) for panel, _ in self.panels for item in _maps(panel)}) == 1

    def _row(self, row: int) -> range:
        return range(row * self.columns, min((row + 1) * self.columns, len(self.panels)))

    def _column(self, column: int) -> range:
        return range(column, len(self.panels), self.columns)

    def draw(self) -> None:
        """Draw every panel, then give it the room that its numbers need."""
        drawn, images = [], []
        for i, (panel, title) in enumerate(self.panels):
            axes = self.made.add_axes((0.1, 0.1, 0.8, 0.8), label=str(i))
            _scales(axes, panel)
            images.append(_fill(axes, panel))
            axes.set_title(_words(title), pad=6 + 72 * _SECOND * bool(panel.x.second))
            joined = self._joined(*divmod(i, self.columns))
            _dress(axes, panel, joined=joined, beside=self._beside(i))
            drawn.append(axes)
        self._share(drawn)
        for axes, (panel, _) in zip(drawn, self.panels, strict=True):
            _plain_numbers(axes, panel)
            _marks(axes, panel)
        self._place(drawn, images)

    def _place(self, drawn: Sequence[Any], images: Sequence[Any]) -> None:
        panels, count = [panel for panel, _ in self.panels], self.columns
        base, width = _ALONE if self.rows == 1 else _STACKED, _WIDTHS.get(count, _WIDTHS[3])
        heights = [base * max(panels[i].height for i in self._row(r)) for r in range(self.rows)]
        bottoms = [
            _NARROW if all(self._joined(r, i % count) for i in self._row(r))
            else _BOTTOM + 0.14 * max(_lines(panels[i].x) - 1 for i in self._row(r))
            for r in range(self.rows)
        ]  # fmt: skip
        tops = [self._title_room(r) for r in range(self.rows)]
        lefts = [
            _NARROW if all(self._beside(i) for i in self._column(c))
            else _LEFT + _LETTER * max(_longest(drawn[i].yaxis) for i in self._column(c) if not self._beside(i))
            for c in range(count)
        ]  # fmt: skip
        one = self._one_bar()
        bars = [
            _BAR * (any(_maps(panels[i]) for i in self._column(c)) and (not one or c == count - 1))
            for c in range(count)
        ]
        whole = sum(lefts) + count * width + sum(bars) + _RIGHT
        legend = _legend_entries(panels)
        across = _columns(list(legend), whole - lefts[0])
        lines = -(-len(legend) // across) if len(legend) > 1 else 0
        tall = 0.18 + lines * _LINE + sum(heights) + sum(bottoms) + sum(tops)
        self.made.set_size_inches(whole, tall)
        y = tall - 0.18 - lines * _LINE
        for i, axes in enumerate(drawn):
            row, column = divmod(i, count)
            if column == 0:
                y -= heights[row] + tops[row] + (bottoms[row - 1] if row else 0.0)
            x = sum(lefts[: column + 1]) + column * width + sum(bars[:column])
            axes.set_position((x / whole, y / tall, width / whole, heights[row] / tall))
            axes.yaxis.set_label_coords(-(lefts[column] - 0.18) / width, 0.5)
            if images[i] is not None and (not one or i == len(drawn) - 1):
                room = ((x + width + 0.15) / whole, y / tall, 0.14 / whole, heights[row] / tall)
                self._bar(images[i], panels[i], room)
        if lines:
            self.made.legend(
                list(legend.values()), [_words(name) for name in legend], loc="upper left", ncols=across, fontsize=9,
                bbox_to_anchor=((lefts[0] - 0.06) / whole, 1.0 - 0.03 / tall), borderaxespad=0.0, columnspacing=1.4,
            )  # fmt: skip

    def _bar(self, image: Any, panel: Panel, place: tuple[float, float, float, float]) -> None:
        room, item = self.made.add_axes(place), _maps(panel)[0]
        ends = {"extend": "max"} if isinstance(item, TriangleField) else {}
        self.made.colorbar(image, cax=room, label=_bar_label(item), **ends)
        room.grid(visible=False)

    def _share(self, drawn: Sequence[Any]) -> None:
        """Give panels with the same axes the same range."""
        for c in range(self.columns):
            column = list(self._column(c))
            if len(column) > 1 and all(self._joined(i // self.columns, c) for i in column[:-1]):
                _span("x", [drawn[i] for i in column])
        for r in range(self.rows):
            row = list(self._row(r))
            if len(row) > 1 and all(self._beside(i) for i in row[1:]) and not self.panels[row[0]][0].equal:
                _span("y", [drawn[i] for i in row])


def _span(which: str, drawn: Sequence[Any]) -> None:
    """Give axes the range that holds all of theirs."""
    ends = np.array([getattr(axes, f"get_{which}lim")() for axes in drawn])
    for axes in drawn:
        getattr(axes, f"set_{which}lim")(ends.min(), ends.max())


def _scales(axes: Any, panel: Panel) -> None:
    for which, axis in (("x", panel.x), ("y", panel.y)):
        if axis.log:
            getattr(axes, f"set_{which}scale")("log")


def _maps(panel: Panel) -> list[HeatMap | TriangleField | Points]:
    """Items whose colours need a scale."""
    return [
        i for i in panel.items
        if isinstance(i, (HeatMap, TriangleField)) or (isinstance(i, Points) and i.shade is not None)
    ]  # fmt: skip


def _bar_label(item: HeatMap | TriangleField | Points) -> str:
    return _words(item.shade_label) if isinstance(item, Points) else _titled(item.label, item.unit)


def _lines(axis: Axis) -> int:
    return max((name.count("\n") + 1 for name in axis.categories), default=1)


def _columns(names: list[str], width: float) -> int:
    """How many columns of a legend fit into a width."""
    for count in range(len(names), 1, -1):
        parts = np.array_split(np.array([len(name) for name in names]), count)
        if sum(_HANDLE + _SMALL_LETTER * int(part.max()) for part in parts) <= width:
            return count
    return 1


def _longest(axis: Any) -> int:
    """Letters of the longest number at an axis."""
    low, high = sorted(axis.get_view_interval())
    places = [place for place in axis.get_majorticklocs() if low <= place <= high]
    texts = axis.get_major_formatter().format_ticks(places)
    return max((len(re.sub(r"\$|\\[a-z]+|[{}^]", "", text)) for text in texts), default=0)


def _legend_entries(panels: Sequence[Panel]) -> dict[str, Any]:
    """A handle for each name, in the order of the items."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    found: dict[str, Any] = {}
    for panel in panels:
        for item in panel.items:
            name = getattr(item, "name", "")
            if not name or name in found:
                continue
            style, colour = look(item.role), shade(item.role).light  # type: ignore[union-attr]
            if isinstance(item, Bars):
                found[name] = Patch(color=colour)
            elif isinstance(item, Curve):
                found[name] = Line2D(
                    [], [], color=colour, ls=_DASHES[item.dash or style.dash], lw=item.width,
                    marker=_SYMBOLS[style.symbol] if item.marked else "", ms=4,
                )  # fmt: skip
            else:
                symbol = getattr(item, "symbol", "") or style.symbol
                found[name] = Line2D([], [], color=colour, ls="", marker=_SYMBOLS[symbol], ms=5)
    return found


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


def _plain_numbers(axes: Any, panel: Panel) -> None:
    """Numbers without powers at logarithmic axes of few decades."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for which, axis in (("x", panel.x), ("y", panel.y)):
        low, high = getattr(axes, f"get_{which}lim")()
        if axis.log and high < _FEW_DECADES * low:
            here = getattr(axes, f"{which}axis")
            here.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0)))
            here.set_major_formatter(FuncFormatter(lambda value, _place: f"{value:g}"))
            here.set_minor_formatter(NullFormatter())


def _dress(axes: Any, panel: Panel, *, joined: bool, beside: bool) -> None:
    """Axes: titles, scales, ranges, marks."""
    _axis(axes, panel.x, "x", "" if joined else _titled(panel.x.label, panel.x.unit))
    _axis(axes, panel.y, "y", "" if beside else _titled(panel.y.label, panel.y.unit))
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
        top.set_xlabel(_titled(panel.x.second.label, panel.x.second.unit))


def _marks(axes: Any, panel: Panel) -> None:
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
            _words(mark.label),
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
        getattr(axes, f"set_{which}ticks")(range(len(axis.categories)), [_words(name) for name in axis.categories])
    if axis.hidden:
        getattr(axes, f"{which}axis").set_visible(False)
        axes.spines["left" if which == "y" else "bottom"].set_visible(False)


def _fill(axes: Any, panel: Panel) -> Any:
    """Draw the items; return what a scale of colours needs, if anything does."""
    image = None
    solid = [item for item in panel.items if isinstance(item, (Surface, Spot))]
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
        x, y, ls=_DASHES[item.dash or style.dash], color=colour, lw=item.width, ms=4,
        marker=_SYMBOLS[style.symbol] if item.marked else "",
        drawstyle="steps-post" if item.dash == "steps" else "default",
    )  # fmt: skip
    if item.error is not None:
        error = np.asarray(item.error)
        axes.fill_between(x, y - error, y + error, color=colour, alpha=0.25, lw=0)
    if item.fill:
        axes.fill_between(x, y, color=colour, alpha=0.25, lw=0)


def _points(axes: Any, _panel: Panel, item: Points) -> Any:
    symbol = _SYMBOLS[item.symbol or look(item.role).symbol]
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
    placed: list[tuple[float, float]] = []
    for i in np.argsort(-y):
        a, b = (math.log10(v) if scale else float(v) for v, scale in zip((x[i], y[i]), log, strict=True))
        crowd = sum(abs(a - c) < 0.9 and abs(b - d) < 0.13 for c, d in placed)
        placed.append((a, b))
        axes.annotate(
            _words(item.notes[i]), (x[i], y[i]), xytext=(6, 3 - 8 * crowd), textcoords="offset points", fontsize=7,
            bbox={"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.6}, color="0.25", zorder=1.5,
        )  # fmt: skip


def _stems(axes: Any, panel: Panel, item: Stems) -> None:
    style, colour = look(item.role), shade(item.role).light
    axes.vlines(item.x, panel.foot, item.y, color=colour, lw=1.0)
    axes.plot(item.x, item.y, ls="", marker=_SYMBOLS[style.symbol], color=colour, ms=4)


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
            dark = known and item.centre and abs(value - item.centre[0]) > 0.75 * item.centre[1] and value < high
            axes.text(
                x[column], y[row], f"{value:.2f}" if known else "×", ha="center", va="center", fontsize=8.5,
                color="white" if dark and value < item.centre[0] else "black",  # type: ignore[index]
            )  # fmt: skip
    return image


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
