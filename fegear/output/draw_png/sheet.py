"""Panels placed on a sheet in rows: margins in inches, legends above the panels, off the curves.

The legend above the panels.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np

from fegear.engine.colours import look
from fegear.engine.figure.items import Bars, Curve, Surface, TriangleField
from fegear.engine.figure.panel import Panel
from fegear.output.draw_png.axes import draw_marks, dress, plain_numbers, set_scales
from fegear.output.draw_png.items import DASHES, SYMBOLS, draw_items
from fegear.output.draw_png.texts import bar_label, lines_of, longest_number, maps_of, words
from fegear.output.shades import shade

#: Inches: a panel alone, panels above each other, and around them.
_WIDTHS = {1: 6.5, 2: 4.3, 3: 3.4}


_ALONE, _STACKED = 3.4, 2.3


_LEFT, _RIGHT, _BOTTOM, _NARROW = 0.45, 0.25, 0.55, 0.22


_TITLE, _SECOND, _LINE, _BAR = 0.27, 0.5, 0.21, 1.0


#: Inches of a scale of colours with its label, without its numbers.
_BARE = 0.66


#: Inches of a line at the head of a picture, and of a letter in it.
_HEAD, _HEAD_LETTER = 0.22, 0.1


#: Inches of a letter of a title.
_TITLE_LETTER = 0.083


#: Inches of a letter at an axis.
_LETTER = 0.078


class Sheet:
    """Panels placed on a sheet in rows, all sizes in inches."""

    def __init__(
        self, made: Any, panels: Sequence[tuple[Panel, str]], columns: int, head: tuple[str, str] = ("", "")
    ) -> None:
        letters = int(_WIDTHS.get(columns, _WIDTHS[3]) / _TITLE_LETTER)
        self.made, self.columns, self.head = made, columns, head
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
        if self.panels[i][0].camera:
            return False
        return below < len(self.panels) and self.panels[i][0].x.like(self.panels[below][0].x) and not any(
            panel.equal for panel, _ in self.panels
        )  # fmt: skip

    def _beside(self, i: int) -> bool:
        """Whether the panel to the left has the same ordinate, which then names it for both."""
        if i % self.columns == 0:
            return False
        here, left = self.panels[i][0], self.panels[i - 1][0]
        if here.camera or left.camera:  # a picture of a space, whose ordinate runs downwards
            return False
        if here.equal and here.y.limits != left.y.limits:
            return False
        return here.y.like(left.y) and (not maps_of(here) or self._one_bar())

    def _one_bar(self) -> bool:
        """Whether all panels are maps of one quantity, which have one scale of colours."""
        return len({bar_label(item) for panel, _ in self.panels for item in maps_of(panel)}) == 1

    def _row(self, row: int) -> range:
        return range(row * self.columns, min((row + 1) * self.columns, len(self.panels)))

    def _column(self, column: int) -> range:
        return range(column, len(self.panels), self.columns)

    def draw(self) -> None:
        """Draw every panel, then give it the room that its numbers need."""
        drawn, images = [], []
        for i, (panel, title) in enumerate(self.panels):
            axes = self.made.add_axes((0.1, 0.1, 0.8, 0.8), label=str(i))
            set_scales(axes, panel)
            images.append(draw_items(axes, panel))
            # Left to itself a title looks for what stands above its panel, which lays every label out once more.
            above = None if panel.x.second or panel.camera else 1.0
            axes.set_title(words(title), y=above, pad=6 + 72 * _SECOND * bool(panel.x.second))
            joined = self._joined(*divmod(i, self.columns))
            dress(axes, panel, joined=joined, beside=self._beside(i))
            drawn.append(axes)
        self._share(drawn)
        for axes, (panel, _) in zip(drawn, self.panels, strict=True):
            plain_numbers(axes, panel)
            draw_marks(axes, panel)
        self._place(drawn, images)

    def _place(self, drawn: Sequence[Any], images: Sequence[Any]) -> None:
        panels, count = [panel for panel, _ in self.panels], self.columns
        base, width = _ALONE if self.rows == 1 else _STACKED, _WIDTHS.get(count, _WIDTHS[3])
        heights = [base * max(panels[i].height for i in self._row(r)) for r in range(self.rows)]
        bottoms = [
            _NARROW if all(self._joined(r, i % count) for i in self._row(r))
            else _BOTTOM + 0.14 * max(lines_of(panels[i].x) - 1 for i in self._row(r))
            for r in range(self.rows)
        ]  # fmt: skip
        tops = [self._title_room(r) for r in range(self.rows)]
        lefts = [
            _NARROW if all(self._beside(i) for i in self._column(c))
            else _LEFT + _LETTER * max(longest_number(drawn[i].yaxis) for i in self._column(c) if not self._beside(i))
            for c in range(count)
        ]  # fmt: skip
        scales = self._scales(images)
        bars = [
            max(
                (_BARE + _LETTER * longest_number(scales[i].yaxis) for i in self._column(c) if i in scales), default=0.0
            )
            for c in range(count)
        ]
        bars = [max(_BAR, bar) if bar else 0.0 for bar in bars]
        whole = sum(lefts) + count * width + sum(bars) + _RIGHT
        legend = legend_entries(panels)
        across = columns_that_fit(list(legend), whole - lefts[0])
        lines = -(-len(legend) // across) if len(legend) > 1 else 0
        head = self._head_lines(whole)
        top = 0.18 + _HEAD * len(head)
        tall = top + lines * _LINE + sum(heights) + sum(bottoms) + sum(tops)
        self.made.set_size_inches(whole, tall)
        for number, (line, style) in enumerate(head):
            place = 0.12 / whole, 1.0 - (0.1 + _HEAD * number) / tall
            self.made.text(*place, words(line), ha="left", va="top", **style)
        y = tall - top - lines * _LINE
        for i, axes in enumerate(drawn):
            row, column = divmod(i, count)
            if column == 0:
                y -= heights[row] + tops[row] + (bottoms[row - 1] if row else 0.0)
            x = sum(lefts[: column + 1]) + column * width + sum(bars[:column])
            axes.set_position((x / whole, y / tall, width / whole, heights[row] / tall))
            axes.yaxis.set_label_coords(-(lefts[column] - 0.18) / width, 0.5)
            if i in scales:
                scales[i].set_position(((x + width + 0.15) / whole, y / tall, 0.14 / whole, heights[row] / tall))
        if lines:
            self.made.legend(
                list(legend.values()), [words(name) for name in legend], loc="upper left", ncols=across, fontsize=9,
                bbox_to_anchor=((lefts[0] - 0.06) / whole, 1.0 - (top - 0.15) / tall), borderaxespad=0.0,
                columnspacing=1.4,
            )  # fmt: skip

    def _head_lines(self, whole: float) -> list[tuple[str, dict[str, Any]]]:
        """Title and case in lines that fit, each with its style."""
        title, case = self.head
        lines = textwrap.wrap(title, max(20, int((whole - 0.3) / _HEAD_LETTER)))
        styles: list[tuple[str, dict[str, Any]]] = [(line, {"fontsize": 11, "weight": "bold"}) for line in lines]
        return styles + ([(f"case {case}", {"fontsize": 8.5, "color": "0.35"})] if case else [])

    def _scales(self, images: Sequence[Any]) -> dict[int, Any]:
        """Axes of the scales of colours, by panel: of the last one alone where all show one quantity."""
        found = {}
        for i, image in enumerate(images):
            if image is not None and (not self._one_bar() or i == len(images) - 1):
                item, room = maps_of(self.panels[i][0])[0], self.made.add_axes((0.9, 0.1, 0.02, 0.8))
                ends = {"extend": "max"} if isinstance(item, TriangleField) else {}
                self.made.colorbar(image, cax=room, label=bar_label(item), **ends)
                room.grid(visible=False)
                found[i] = room
        return found

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


#: Inches of a letter in the legend, and of the line before its words.
_SMALL_LETTER, _HANDLE = 0.069, 0.6


def columns_that_fit(names: list[str], width: float) -> int:
    """How many columns of a legend fit into a width."""
    for count in range(len(names), 1, -1):
        parts = np.array_split(np.array([len(name) for name in names]), count)
        if sum(_HANDLE + _SMALL_LETTER * int(part.max()) for part in parts) <= width:
            return count
    return 1


def legend_entries(panels: Sequence[Panel]) -> dict[str, Any]:
    """A handle for each name, in the order of the items."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    found: dict[str, Any] = {}
    for panel in panels:
        for item in panel.items:
            name = getattr(item, "name", "")
            if not name or name in found:
                continue
            style, colour = look(item.role), shade(item.role).light  # type: ignore[union-attr]  # items with a name have a role
            if isinstance(item, (Bars, Surface)):
                found[name] = Patch(color=colour)
            elif isinstance(item, Curve):
                found[name] = Line2D(
                    [], [], color=colour, ls=DASHES[item.dash or style.dash], lw=item.width,
                    marker=SYMBOLS[style.symbol] if item.marked else "", ms=4,
                )  # fmt: skip
            else:
                symbol = getattr(item, "symbol", "") or style.symbol
                found[name] = Line2D([], [], color=colour, ls="", marker=SYMBOLS[symbol], ms=5)
    return found
