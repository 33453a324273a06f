"""A figure as plotly's data and layout."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.output.draw_plotly.layout import layout
from fegear.output.draw_plotly.traces import one_entry_each, shared, traces
from fegear.output.shades import DARK, LIGHT, shade

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.engine.figure import (
        Figure,
    )
    from fegear.output.draw_plotly.words import Spec


def darker(figures: Sequence[Figure]) -> dict[str, str]:
    """Which shade on dark ground stands for each on light ground in these figures."""
    roles = {
        role for figure in figures for panel in figure.all_panels for item in panel.items
        if (role := getattr(item, "role", ""))
    }  # fmt: skip
    pairs = [shade(role) for role in sorted(roles)]
    return {LIGHT[name]: DARK[name] for name in LIGHT} | {pair.light: pair.dark for pair in pairs}


def plotly_json(figure: Figure) -> Spec:
    """Describe a figure for plotly.

    Parameters
    ----------
    figure : Figure
        Of curves, points, bars, stems and heat maps.

    Returns
    -------
    dict
        ``data`` and ``layout``; ``layout.meta`` holds the names in the legend, for pages that fit their margins.
    """
    data: list[Spec] = []
    members: list[list[int]] = []
    for view in figure.views:
        first = len(data)
        for number, panel in enumerate(view.panels, start=1):
            data += traces(panel, number, shared=shared(figure))
        members.append(list(range(first, len(data))))
        one_entry_each(data[first:])
    for number, listed in enumerate(members):
        if number:
            for i in listed:
                data[i]["visible"] = False
    names = max((sum(bool(data[i]["showlegend"]) for i in listed) for listed in members), default=0)
    return {"data": data, "layout": layout(figure, members, len(data), names)}
