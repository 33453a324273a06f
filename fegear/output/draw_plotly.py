"""Figures as plotly JSON: plain dicts of data and layout, made without plotly's Python, which takes long to import.

Arrays travel as plotly.js's own typed arrays (base64). Colours are those of light ground; `DARKER` says which shade
stands for each on dark ground, so that a page changes between them by replacing one by the other.
"""

from __future__ import annotations

import base64
import html
import json
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.engine.colours import look
from fegear.engine.figure import (
    NOTEBOOK,
    Axis,
    Bars,
    Curve,
    Figure,
    HeatMap,
    Mark,
    Panel,
    Points,
    Stems,
    Which,
)
from fegear.output.numbers import pretty_unit
from fegear.output.shades import DARK, DIVERGING, LIGHT, SEQUENTIAL, shade

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

Spec = dict[str, Any]

#: Pixels: a panel alone, panels above each other, the room between them and around them.
_ALONE, _STACKED, _GAP, _TITLED = 350, 240, 78, 22
_LEFT, _RIGHT, _BOTTOM, _TOP = 74, 24, 56, 34
_SECOND, _LEGEND_LINE, _MENU = 44, 21, 46
_BESIDE = 4
_TILE = 26
_DASHES = {"dashdot": "dashdot", "dot": "dot", "steps": "solid"}


def typed(values: ArrayLike) -> Spec:
    """An array as plotly.js reads it."""
    array = np.ascontiguousarray(values, dtype="<f8")
    made: Spec = {"dtype": "f8", "bdata": base64.b64encode(array.tobytes()).decode()}
    if array.ndim > 1:
        made["shape"] = ", ".join(str(n) for n in array.shape)
    return made


def _along(axis: Axis, values: ArrayLike) -> Spec | list[str | None]:
    """Places on an axis: numbers, or the names of its categories."""
    if not axis.categories:
        return typed(values)
    return [rich(axis.categories[round(v)]) if np.isfinite(v) else None for v in np.asarray(values).tolist()]


def _place(panel: Panel, item: Curve | Points | HeatMap) -> Spec:
    return {"x": _along(panel.x, item.x), "y": _along(panel.y, item.y)}


def rich(text: str) -> str:
    """Plain text for plotly, which takes names for HTML: escaped, with ``_{...}`` set lower."""
    return re.sub(r"_\{([^{}]*)\}", r"<sub>\1</sub>", html.escape(text, quote=False).replace("\n", "<br>"))


def titled(label: str, unit: str) -> str:
    """Label with its unit in brackets."""
    return rich(f"{label} [{pretty_unit(unit)}]" if unit else label)


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
            data += _traces(panel, number, shared=_shared(figure))
        members.append(list(range(first, len(data))))
        _one_entry_each(data[first:])
    for number, listed in enumerate(members):
        if number:
            for i in listed:
                data[i]["visible"] = False
    names = max((sum(bool(data[i]["showlegend"]) for i in listed) for listed in members), default=0)
    return {"data": data, "layout": _layout(figure, members, len(data), names)}


def _shared(figure: Figure) -> bool:
    """Whether pointing at one curve reads all of them at that place."""
    return all(isinstance(i, (Curve, Bars)) and not getattr(i, "notes", ()) for p in figure.all_panels for i in p.items)


def _one_entry_each(traces: Sequence[Spec]) -> None:
    """Traces of one name share an entry of the legend."""
    seen: set[str] = set()
    for trace in traces:
        name = trace.get("name", "")
        trace["showlegend"] = bool(name) and trace.pop("legend_entry", True) and name not in seen
        if trace["showlegend"]:
            seen.add(name)


def _anchor(number: int) -> str:
    return "" if number == 1 else str(number)


def _traces(panel: Panel, number: int, *, shared: bool) -> list[Spec]:
    made = [trace for item in panel.items if not isinstance(item, Bars) for trace in _DRAWN[type(item)](panel, item)]
    made += [
        {"type": "bar", "x": _along(panel.x, row.x), "y": typed(row.y), "base": typed(foot), "width": width,
         "offset": float(x[0] - np.asarray(row.x)[0]) - 0.5 * width if x.size else 0.0, **_named(row),
         "marker": {"color": shade(row.role).light}, "hovertemplate": _read(panel.y, row.error),
         **({"customdata": typed(row.error), "error_y": {"type": "data", "array": typed(row.error), "thickness": 1}}
            if row.error is not None else {})}
        for row, x, foot, width in panel.bars()
    ]  # fmt: skip
    if panel.x.second:
        places, _ = panel.x.second.ticks()
        nothing = {"x": typed(places), "y": typed(np.full(places.size, np.nan)), "type": "scatter", "hoverinfo": "skip"}
        made.append({**nothing, "xaxis": f"x{100 + number}", "legend_entry": False})
    for trace in made:
        trace.setdefault("xaxis", f"x{_anchor(number)}")
        trace["yaxis"] = f"y{_anchor(number)}"
        if not shared and trace.get("hovertemplate"):
            trace["hovertemplate"] = trace["hovertemplate"].removesuffix("<extra></extra>") + "<extra></extra>"
    return made


def _named(item: Curve | Points | Bars | Stems) -> Spec:
    name = rich(item.name)
    return {"name": name, "legendgroup": name}


def _read(axis: Axis, error: ArrayLike | None = None) -> str:
    """What pointing at a value says: number, error, unit."""
    sure = "" if error is None else " ± %{customdata:.1~e}"
    return f"%{{y:.6~g}}{sure} {rich(pretty_unit(axis.unit))}".rstrip()


def _curve(panel: Panel, item: Curve) -> list[Spec]:
    style, colour = look(item.role), shade(item.role).light
    dash = item.dash or style.dash
    line: Spec = {"color": colour, "dash": _DASHES.get(dash, dash), "width": item.width + 0.2}
    if dash == "steps":
        line["shape"] = "hv"
    trace: Spec = {
        "type": "scatter", "mode": "lines+markers" if item.marked else "lines", **_place(panel, item),
        "line": line, "hovertemplate": _read(panel.y, item.error), **_named(item),
    }  # fmt: skip
    if item.marked:
        trace["marker"] = {"symbol": style.symbol, "size": 6}
    if item.fill:
        trace |= {"fill": "tozeroy", "fillcolor": f"{colour}40"}
    if item.notes:
        trace |= {"text": [rich(note) for note in item.notes], "hovertemplate": "%{text}<extra></extra>"}
    elif not item.name and not item.fill:
        trace["hoverinfo"] = "skip"
        del trace["hovertemplate"]
    if item.error is None:
        return [trace]
    x, y, error = (np.asarray(part) for part in (item.x, item.y, item.error))
    known = np.isfinite(x + y + error)
    x, y, error = x[known], y[known], error[known]
    band: Spec = {
        "type": "scatter", "mode": "lines", "x": typed(np.concatenate([x, x[::-1]])),
        "y": typed(np.concatenate([y + error, (y - error)[::-1]])), "fill": "toself", "fillcolor": f"{colour}40",
        "line": {"width": 0}, "hoverinfo": "skip", "legend_entry": False, **_named(item),
    }  # fmt: skip
    return [band, trace | {"customdata": typed(item.error)}]


def _points(panel: Panel, item: Points) -> list[Spec]:
    marker: Spec = {"color": shade(item.role).light, "symbol": item.symbol or look(item.role).symbol, "size": item.size}
    place = f"%{{x:.6~g}} {pretty_unit(panel.x.unit)}".rstrip() + f", %{{y:.6~g}} {pretty_unit(panel.y.unit)}".rstrip()
    trace: Spec = {
        "type": "scatter", "mode": "markers", **_place(panel, item), **_named(item),
        "marker": marker, "hovertemplate": place,
    }  # fmt: skip
    if item.shade is not None:
        level = np.log10(np.asarray(item.shade))
        powers = np.arange(np.floor(level.min()), np.ceil(level.max()) + 1)
        ticks = {"tickvals": powers.tolist(), "ticktext": [f"10<sup>{p:.0f}</sup>" for p in powers]}
        bar = {"title": {"text": rich(item.shade_label), "side": "right"}, "outlinewidth": 0, **ticks}
        marker |= {"color": typed(level), "colorscale": SEQUENTIAL.title(), "showscale": True, "colorbar": bar}
    if item.error is not None:
        trace |= {"error_y": {"type": "data", "array": typed(item.error), "thickness": 1}}
    if item.notes:
        trace |= {"text": [rich(note) for note in item.notes], "hovertemplate": f"%{{text}}<br>{place}"}
    return [trace]


def _stems(panel: Panel, item: Stems) -> list[Spec]:
    drop = {"type": "data", "symmetric": False, "array": [0], "arrayminus": typed(np.asarray(item.y) - panel.foot)}
    (trace,) = _points(panel, Points(item.x, item.y, item.name, item.role, notes=item.notes))
    zeros = typed(np.zeros(np.size(item.y)))
    return [trace | {"error_y": drop | {"array": zeros, "width": 0, "thickness": 1, "color": shade(item.role).light}}]


def _heat(panel: Panel, item: HeatMap) -> list[Spec]:
    low, high = item.ends
    scale: Any = SEQUENTIAL.title()
    if item.centre:
        scale = [[i / (len(DIVERGING) - 1), f"rgb{colour}"] for i, colour in enumerate(DIVERGING)]
    names = rich(panel.x.label), rich(panel.y.label)
    unit = rich(pretty_unit(item.unit))
    trace: Spec = {
        "type": "heatmap", **_place(panel, item), "z": typed(item.z), "zmin": low, "zmax": high,
        "colorscale": scale, "colorbar": {"title": {"text": titled(item.label, item.unit), "side": "right"}},
        "hovertemplate": f"{names[0]} %{{x}}<br>{names[1]} %{{y}}<br>{rich(item.label)} %{{z:.5~g}} {unit}".rstrip(),
    }  # fmt: skip
    if item.numbers:
        z = np.asarray(item.z)
        trace |= {
            "text": [[f"{v:.2f}" if np.isfinite(v) else "×" for v in row] for row in z], "texttemplate": "%{text}",
            "textfont": {"size": 10},
        }  # fmt: skip
    return [trace]


_DRAWN: dict[type, Callable[[Panel, Any], list[Spec]]] = {
    Curve: _curve, Points: _points, Stems: _stems, HeatMap: _heat,
}  # fmt: skip


# ---- layout --------------------------------------------------------------------------------------------------------
def _inner(panel: Panel, alone: bool) -> float:
    """Height of a panel's axes in pixels."""
    rows = len(panel.y.categories)
    return _TILE * rows if rows else (_ALONE if alone else _STACKED) * panel.height


def _layout(figure: Figure, members: list[list[int]], count: int, names: int) -> Spec:
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
        "hovermode": "x unified" if _shared(figure) else "closest",
        "legend": {"orientation": "h", "x": 0, "xanchor": "left", "y": legend, "yanchor": "bottom",
                   "traceorder": "normal"},
        "shapes": [], "annotations": [], "meta": {"names": names, "inner": inner, "beside": _BESIDE},
    }  # fmt: skip
    if any(
        isinstance(i, HeatMap) and not np.isfinite(np.asarray(i.z)).all() for p in figure.all_panels for i in p.items
    ):
        made["plot_bgcolor"] = f"{LIGHT['grey']}66"
    upper = 1.0
    for number, panel in enumerate(panels, start=1):
        lower = max(0.0, upper - heights[number - 1] / inner)
        joined = number > 1 and panel.x.like(panels[0].x) and not panel.x.categories
        _axes(made, panel, _anchor(number), (lower, upper), joined=joined)
        if panel.x.second:
            made[f"xaxis{100 + number}"] = _second(panel, _anchor(number))
        _marks(made, panel, _anchor(number))
        if panel.title:
            made["annotations"].append({
                "text": f"<b>{rich(panel.title)}</b>", "xref": "paper", "yref": "paper", "x": 0, "xanchor": "left",
                "y": upper, "yanchor": "bottom", "align": "left",
                "yshift": 2 + _SECOND * bool(panel.x.second), "showarrow": False,
            })  # fmt: skip
        upper = lower - (_GAP + (above[number] if number < len(panels) else 0.0)) / inner
    if menu:
        place = 1 + (top - 8) / inner
        made["updatemenus"] = [_choice(figure, members, count, place)]
    return made


def _choice(figure: Figure, members: list[list[int]], count: int, place: float) -> Spec:
    buttons = []
    for view, listed in zip(figure.views, members, strict=True):
        titles: Spec = {}
        for number, panel in enumerate(view.panels, start=1):
            first = figure.views[0].panels[number - 1]
            if not panel.y.like(first.y) or any(not v.panels[number - 1].y.like(first.y) for v in figure.views):
                axis = f"yaxis{_anchor(number)}"
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
            made_of |= {"tick0": 0, "dtick": panel.whole_step(which)}
    if joined:
        x["matches"] = "x"
    if panel.limits:
        y["range"] = list(panel.limits)
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
    if axis.limits:
        made["range"] = [float(np.log10(end)) if axis.log else end for end in axis.limits]
    if axis.zero:
        made["rangemode"] = "tozero"
    if axis.hidden:
        made |= {"visible": False, "fixedrange": True}
    return made


def _second(panel: Panel, name: str) -> Spec:
    second = panel.x.second
    if second is None:
        return {}
    places, texts = second.ticks()
    return {
        "title": {"text": titled(second.label, second.unit)}, "overlaying": f"x{name}", "matches": "x", "side": "top",
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


def notebook_html(figure: Figure) -> str:
    """A figure as HTML for a notebook, by plotly's Python; fields and surfaces as a picture."""
    if not figure.drawable_in_page:
        return _still(figure)
    from plotly.io import to_html

    spec = plotly_json(figure)
    layout = spec["layout"] | {"template": template() | {"data": {}}, "paper_bgcolor": LIGHT["paper"]}
    plot: str = to_html(json.loads(json.dumps({"data": spec["data"], "layout": layout})), full_html=False,
                        include_plotlyjs=True, validate=False)  # fmt: skip
    return f"<b>{html.escape(figure.title)}</b>{plot}<p>{html.escape(figure.caption)}</p>"


def _still(figure: Figure) -> str:
    import tempfile
    from pathlib import Path

    from fegear.output.draw_png import draw_pictures

    with tempfile.TemporaryDirectory() as folder:
        images = [picture.path.read_bytes() for picture in draw_pictures(figure, Path(folder))]
    shown = "".join(f"<img src='data:image/png;base64,{base64.b64encode(i).decode()}'>" for i in images)
    return f"<b>{html.escape(figure.title)}</b>{shown}<p>{html.escape(figure.caption)}</p>"


NOTEBOOK[:] = [notebook_html]
