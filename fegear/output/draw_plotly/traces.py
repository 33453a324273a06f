"""What stands in a panel, as plotly's traces.

Texts and arrays as plotly.js reads them.
"""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fegear.engine.colours import look
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve, HeatMap, Points, Stems
from fegear.engine.figure.panel import Panel
from fegear.output.numbers import pretty_unit
from fegear.output.shades import DIVERGING, SEQUENTIAL, shade

_DASHES = {"dashdot": "dashdot", "dot": "dot", "steps": "solid"}


def _place(panel: Panel, item: Curve | Points | HeatMap) -> Spec:
    return {"x": along(panel.x, item.x), "y": along(panel.y, item.y)}


def shared(figure: Figure) -> bool:
    """Whether pointing at one curve reads all of them at that place."""
    return all(isinstance(i, (Curve, Bars)) and not getattr(i, "notes", ()) for p in figure.all_panels for i in p.items)


def one_entry_each(traces: Sequence[Spec]) -> None:
    """Traces of one name share an entry of the legend."""
    seen: set[str] = set()
    for trace in traces:
        name = trace.get("name", "")
        trace["showlegend"] = bool(name) and trace.pop("legend_entry", True) and name not in seen
        if trace["showlegend"]:
            seen.add(name)


def anchor(number: int) -> str:
    """What follows ``x`` or ``y`` in the name of a panel's axis."""
    return "" if number == 1 else str(number)


def traces(panel: Panel, number: int, *, shared: bool) -> list[Spec]:
    """Describe everything that stands in a panel, by its number from 1; `shared` as of its figure."""
    made = [trace for item in panel.items if not isinstance(item, Bars) for trace in _DRAWN[type(item)](panel, item)]
    made += [
        {"type": "bar", "x": along(panel.x, row.x), "y": typed(row.y), "base": typed(foot), "width": width,
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
        trace.setdefault("xaxis", f"x{anchor(number)}")
        trace["yaxis"] = f"y{anchor(number)}"
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
    if item.lettered:
        trace |= {"mode": "markers+text", "textposition": "top left"}
    if item.labels:
        mode = "markers+text" if item.size else "text"
        trace |= {"mode": mode, "text": [rich(label) for label in item.labels], "textposition": "middle center",
                  "textfont": {"size": 11}}  # fmt: skip
    return [trace]


def _stems(panel: Panel, item: Stems) -> list[Spec]:
    drop = {"type": "data", "symmetric": False, "array": [0], "arrayminus": typed(np.asarray(item.y) - panel.foot)}
    (trace,) = _points(panel, Points(item.x, item.y, item.name, item.role, notes=item.notes))
    zeros = typed(np.zeros(np.size(item.y)))
    if item.numbers:
        trace |= {
            "mode": "markers+text", "text": list(item.numbers), "textposition": "top center", "textfont": {"size": 10},
        }  # fmt: skip
        if item.notes:
            notes = [rich(note) for note in item.notes]
            trace |= {"customdata": notes, "hovertemplate": trace["hovertemplate"].replace("%{text}", "%{customdata}")}
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


Spec = dict[str, Any]


def typed(values: ArrayLike) -> Spec:
    """An array as plotly.js reads it."""
    array = np.ascontiguousarray(values, dtype="<f8")
    made: Spec = {"dtype": "f8", "bdata": base64.b64encode(array.tobytes()).decode()}
    if array.ndim > 1:
        made["shape"] = ", ".join(str(n) for n in array.shape)
    return made


def along(axis: Axis, values: ArrayLike) -> Spec | list[str | None]:
    """Places on an axis: numbers, or the names of its categories."""
    if not axis.categories:
        return typed(values)
    return [rich(axis.categories[round(v)]) if np.isfinite(v) else None for v in np.asarray(values).tolist()]


def rich(text: str) -> str:
    """Plain text for plotly, which takes names for HTML: escaped, with ``_{...}`` set lower."""
    return re.sub(r"_\{([^{}]*)\}", r"<sub>\1</sub>", html.escape(text, quote=False).replace("\n", "<br>"))


def titled(label: str, unit: str) -> str:
    """Label with its unit in brackets."""
    return rich(f"{label} [{pretty_unit(unit)}]" if unit else label)
