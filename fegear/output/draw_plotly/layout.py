"""Panels placed above each other, their axes, marks and menus, as plotly's layout.

A figure as plotly's data and layout.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fegear.engine.figure.axis import FEW_DECADES, Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import HeatMap, Mark, Which
from fegear.engine.figure.panel import Panel
from fegear.output.draw_plotly.traces import Spec, anchor, one_entry_each, rich, shared, titled, traces
from fegear.output.numbers import pretty_unit
from fegear.output.shades import DARK, LIGHT, shade

#: Pixels: a panel alone, panels above each other, the room between them and around them.
_ALONE, _STACKED, _GAP, _TITLED = 350, 240, 78, 22


_LEFT, _RIGHT, _BOTTOM, _TOP = 74, 24, 56, 34


_SECOND, _LEGEND_LINE, _MENU = 44, 21, 46


_BESIDE = 4


_TILE = 26


#: Numbers between these are read without powers of ten.
_PLAIN = 1e-3, 1e5


def _inner(panel: Panel, alone: bool) -> float:
    """Height of a panel's axes in pixels."""
    rows = len(panel.y.categories)
    return _TILE * rows if rows else (_ALONE if alone else _STACKED) * panel.height


def layout(figure: Figure, members: list[list[int]], count: int, names: int) -> Spec:
    """Place the panels of a figure, with the menu of its views.

    Parameters
    ----------
    figure : Figure
    members : list of list of int
        Which traces each view shows.
    count, names : int
        How many traces there are, and names in the legend.
    """
    panels = figure.views[0].panels
    heights = [_inner(panel, len(panels) == 1) for panel in panels]
    above = [_SECOND * bool(p.x.second) + _TITLED * (p.title.count("\n") + 1 if p.title else 0) for p in panels]
    inner = sum(heights) + sum(above[1:]) + _GAP * (len(panels) - 1)
    menu = len(figure.views) > 1
    top = _TOP + above[0] + _MENU * menu + (_LEGEND_LINE * -(-names // _BESIDE) - 10 if names > 1 else 0)
    legend = 1 + (above[0] + 8) / inner
    made: Spec = {
        "height": top + inner + _BOTTOM, "showlegend": names > 1, "barmode": "overlay",
        "margin": {"l": _LEFT, "r": _RIGHT, "t": top, "b": _BOTTOM},
        "hovermode": "x unified" if shared(figure) else "closest",
        "legend": {"orientation": "h", "x": 0, "xanchor": "left", "y": legend, "yanchor": "bottom",
                   "traceorder": "normal"},
        "meta": {"names": names, "inner": inner, "beside": _BESIDE},
    }  # fmt: skip
    if any(
        isinstance(i, HeatMap) and not np.isfinite(np.asarray(i.z)).all() for p in figure.all_panels for i in p.items
    ):
        made["plot_bgcolor"] = f"{LIGHT['grey']}66"
    domains = _domains(heights, above)
    for number, (panel, domain) in enumerate(zip(panels, domains, strict=True), start=1):
        joined = number > 1 and panel.x.like(panels[0].x) and not panel.x.categories
        _axes(made, panel, anchor(number), domain, joined=joined)
        if panel.x.second:
            made[f"xaxis{100 + number}"] = _second(panel, anchor(number))
    uppers = [upper for _, upper in domains]
    made |= _said_in(panels, uppers)
    if menu:
        place = 1 + (top - 8) / inner
        made["updatemenus"] = [_choice(figure, members, count, place, uppers)]
    return made


def _domains(heights: Sequence[float], above: Sequence[float]) -> list[tuple[float, float]]:
    """Lower and upper end of each panel's axes, as shares of the height from the first panel's to the last one's."""
    inner = sum(heights) + sum(above[1:]) + _GAP * (len(heights) - 1)
    upper, found = 1.0, []
    for number, height in enumerate(heights, start=1):
        lower = max(0.0, upper - height / inner)
        found.append((lower, upper))
        upper = lower - (_GAP + (above[number] if number < len(heights) else 0.0)) / inner
    return found


def _said_in(panels: Sequence[Panel], uppers: list[float]) -> Spec:
    """Titles and marks of the panels of a view."""
    made: Spec = {"shapes": [], "annotations": []}
    for number, (panel, upper) in enumerate(zip(panels, uppers, strict=True), start=1):
        _marks(made, panel, anchor(number))
        if panel.title:
            made["annotations"].append({
                "text": f"<b>{rich(panel.title)}</b>", "xref": "paper", "yref": "paper", "x": 0, "xanchor": "left",
                "y": upper, "yanchor": "bottom", "align": "left",
                "yshift": 2 + _SECOND * bool(panel.x.second), "showarrow": False,
            })  # fmt: skip
    return made


def _choice(figure: Figure, members: list[list[int]], count: int, place: float, uppers: list[float]) -> Spec:
    buttons = []
    said = [_said_in(view.panels, uppers) for view in figure.views]
    for view, listed, own in zip(figure.views, members, said, strict=True):
        titles: Spec = {} if all(one == said[0] for one in said) else dict(own)
        for number, panel in enumerate(view.panels, start=1):
            first = figure.views[0].panels[number - 1]
            if not panel.y.like(first.y) or any(not v.panels[number - 1].y.like(first.y) for v in figure.views):
                axis = f"yaxis{anchor(number)}"
                titles |= {f"{axis}.title.text": titled(panel.y.label, panel.y.unit), f"{axis}.autorange": True}
        chosen = set(listed)
        buttons.append({
            "label": rich(view.label), "method": "update", "args": [{"visible": [i in chosen for i in range(count)]},
                                                                   titles],
        })  # fmt: skip
    return {
        "x": 0, "xanchor": "left", "y": place, "yanchor": "top", "direction": "down", "showactive": True,
        "pad": {"t": 0}, "bgcolor": LIGHT["paper"], "bordercolor": LIGHT["grid"], "font": {"color": LIGHT["ink"]},
        "buttons": buttons,
    }  # fmt: skip


def _axes(made: Spec, panel: Panel, name: str, domain: tuple[float, float], *, joined: bool) -> None:
    x = _axis(panel.x) | {"anchor": f"y{name}", "domain": [0, 1], "hoverformat": ".5~g"}
    unit = pretty_unit(panel.x.unit)
    x["unifiedhovertitle"] = {"text": f"{rich(panel.x.label)} %{{x}} {rich(unit)}".rstrip()}
    y = _axis(panel.y) | {"anchor": f"x{name}", "domain": list(domain)}
    both: tuple[tuple[Which, Axis, Spec], ...] = (("x", panel.x, x), ("y", panel.y, y))
    for which, axis, made_of in both:
        if axis.whole:
            made_of.update({"tick0": 0, "dtick": panel.whole_step(which)})
        if axis.log and not axis.categories:
            made_of.update(_log_ticks(*panel.extent(which)))
    if joined:
        x["matches"] = "x"
    if panel.limits:
        y["range"] = [float(np.log10(end)) if panel.y.log else end for end in panel.limits]
    if panel.equal:
        y |= {"scaleanchor": f"x{name}", "constrain": "domain"}
        x["constrain"] = "domain"
    if panel.y.hidden:
        x |= {"gridcolor": LIGHT["grey"], "showline": False, "tickangle": -20, "fixedrange": True}
    made[f"xaxis{name}"], made[f"yaxis{name}"] = x, y


def _axis(axis: Axis) -> Spec:
    made: Spec = {"title": {"text": titled(axis.label, axis.unit)}, "type": "log" if axis.log else "linear"}
    if axis.categories:
        names = [rich(name) for name in axis.categories]
        made |= {"type": "category", "categoryarray": names, "range": [-0.5, len(names) - 0.5]}
    if axis.ticks:
        made |= {"tickvals": [at for at, _ in axis.ticks], "ticktext": [rich(word) for _, word in axis.ticks]}
    if axis.limits:
        made["range"] = [float(np.log10(end)) if axis.log else end for end in axis.limits]
    if axis.zero:
        made["rangemode"] = "tozero"
    if axis.hidden:
        made |= {"visible": False, "fixedrange": True}
    return made


def _log_ticks(low: float, high: float) -> Spec:
    """Marks of a logarithmic axis: whole powers over many decades, else 1, 2, 3 and 5 times them, as plain numbers."""
    if not 0.0 < low <= high or high >= FEW_DECADES * low:
        return {"dtick": 1}
    if low < _PLAIN[0] or high > _PLAIN[1]:
        return {}
    powers = range(math.floor(math.log10(low)) - 1, math.ceil(math.log10(high)) + 2)
    places = [factor * 10.0**power for power in powers for factor in (1.0, 2.0, 3.0, 5.0)]
    return {"tickvals": places, "ticktext": [f"{place:g}" for place in places]}


def _second(panel: Panel, name: str) -> Spec:
    second = panel.x.second
    if second is None:
        return {}
    places, texts = second.ticks()
    return {
        "title": {"text": titled(second.label, second.unit)}, "overlaying": f"x{name}", "matches": f"x{name}",
        "side": "top",
        "tickvals": places.tolist(), "ticktext": list(texts), "showgrid": False, "anchor": f"y{name}",
    }  # fmt: skip


def _marks(made: Spec, panel: Panel, name: str) -> None:
    for mark in panel.marks:
        along, across = (mark.axis, "y" if mark.axis == "x" else "x")
        low, high = (mark.at, mark.at) if isinstance(mark, Mark) else (mark.low, mark.high)
        shape: Spec = {
            f"{along}ref": f"{along}{name}", f"{across}ref": f"{across}{name} domain", f"{along}0": low,
            f"{along}1": high, f"{across}0": 0, f"{across}1": 1,
        }  # fmt: skip
        if not isinstance(mark, Mark):
            look_of = {"type": "rect", "fillcolor": f"{LIGHT['grey']}26", "line": {"width": 0}, "layer": "below"}
            made["shapes"].append(shape | look_of)
            continue
        made["shapes"].append(shape | {"type": "line", "line": {"color": LIGHT["grey"], "width": 1.2, "dash": "dot"}})
        if panel.written(mark):
            log = panel.x.log if along == "x" else panel.y.log
            made["annotations"].append({
                "text": rich(mark.label), f"{along}ref": f"{along}{name}", f"{across}ref": f"{across}{name} domain",
                along: float(np.log10(mark.at)) if log else mark.at, across: 1, "showarrow": False,
                "xanchor": "left" if along == "x" else "right", "yanchor": "top" if along == "x" else "bottom",
                "xshift": 4 if along == "x" else 0, "font": {"size": 11, "color": LIGHT["grey"]},
            })  # fmt: skip


def template() -> Spec:
    """What all figures have in common, as plotly's template on light ground."""
    axis = {
        "gridcolor": LIGHT["grid"], "zerolinecolor": LIGHT["grid"], "linecolor": LIGHT["grey"], "automargin": True,
        "minexponent": 5, "ticks": "outside", "ticklen": 4, "tickcolor": LIGHT["grid"], "exponentformat": "power",
        "title": {"standoff": 8, "font": {"size": 13}},
    }  # fmt: skip
    return {"layout": {
        "xaxis": axis, "yaxis": axis, "paper_bgcolor": "rgba(0,0,0,0)", "plot_bgcolor": "rgba(0,0,0,0)",
        "font": {"size": 13, "color": LIGHT["ink"]},
        "hoverlabel": {"bgcolor": LIGHT["paper"], "bordercolor": LIGHT["grid"],
                       "font": {"color": LIGHT["ink"], "size": 13}},
        "modebar": {"bgcolor": "rgba(0,0,0,0)", "color": LIGHT["grey"], "activecolor": LIGHT["blue"]},
    }}  # fmt: skip


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
    made = layout(figure, members, len(data), names)
    for trace in data:
        holder = trace if "colorbar" in trace else trace.get("marker", {})
        if (
            "colorbar" in holder
        ):  # a scale of colours is as high as its panel, not as the figure: two would lie together
            low, high = made[f"yaxis{trace.get('yaxis', 'y')[1:]}"]["domain"]
            holder["colorbar"] |= {"y": 0.5 * (low + high), "yanchor": "middle", "len": high - low}
    return {"data": data, "layout": made}
