"""The legend above the panels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.engine.colours import look
from fegear.engine.figure import Bars, Curve, Panel, Surface
from fegear.output.draw_png.items import DASHES, SYMBOLS
from fegear.output.shades import shade

if TYPE_CHECKING:
    from collections.abc import Sequence

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
            style, colour = look(item.role), shade(item.role).light  # type: ignore[union-attr]
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
