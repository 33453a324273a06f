"""Figures in a notebook."""

from __future__ import annotations

import base64
import html
import json
from typing import Any

import numpy as np

from fegear.engine.figure.figure import Figure
from fegear.output.draw_plotly.layout import plotly_json, template
from fegear.output.shades import LIGHT

#: What JupyterLab, VS Code and others draw as an interactive plot; who does not takes the picture.
PLOTLY = "application/vnd.plotly.v1+json"


def notebook_bundle(figure: Figure) -> dict[str, Any]:
    """A figure for a notebook: a picture, and where it can be the interactive plot; some 100 kB, without plotly.js."""
    made: dict[str, Any] = {"text/html": still_html(figure)}
    return made | ({PLOTLY: _plain(_spec(figure))} if figure.drawable_in_page else {})


def page_html(figure: Figure, *, library: bool = True) -> str:
    """A figure as HTML for a page of its own, by plotly's Python; fields and surfaces as a picture.

    Parameters
    ----------
    figure : Figure
    library : bool
        Whether plotly.js comes with it; the first of several figures on one page brings it for all.
    """
    if not figure.drawable_in_page:
        return still_html(figure)
    from plotly.io import to_html

    plot: str = to_html(json.loads(json.dumps(_spec(figure))), full_html=False, include_plotlyjs=library,
                        validate=False)  # fmt: skip
    return f"<b>{html.escape(figure.title)}</b>{plot}<p>{html.escape(figure.caption)}</p>"


def _spec(figure: Figure) -> dict[str, Any]:
    spec = plotly_json(figure)
    layout = spec["layout"] | {"template": template() | {"data": {}}, "paper_bgcolor": LIGHT["paper"]}
    return {"data": spec["data"], "layout": layout}


def _plain(item: Any) -> Any:
    """Typed arrays as lists, which every version of plotly.js reads; no number as None."""
    if isinstance(item, dict) and "bdata" in item:
        array = np.frombuffer(base64.b64decode(item["bdata"]), item["dtype"])
        if "shape" in item:
            array = array.reshape([int(size) for size in item["shape"].split(",")])
        numbers = array.astype(object)
        numbers[~np.isfinite(array)] = None
        return numbers.tolist()
    if isinstance(item, dict):
        return {key: _plain(value) for key, value in item.items()}
    return [_plain(value) for value in item] if isinstance(item, (list, tuple)) else item


def still_html(figure: Figure) -> str:
    """A figure as a picture in HTML."""
    import tempfile
    from pathlib import Path

    from fegear.output.draw_png import draw_pictures

    with tempfile.TemporaryDirectory() as folder:
        images = [picture.path.read_bytes() for picture in draw_pictures(figure, Path(folder))]
    shown = "".join(f"<img src='data:image/png;base64,{base64.b64encode(i).decode()}'>" for i in images)
    return f"<b>{html.escape(figure.title)}</b>{shown}<p>{html.escape(figure.caption)}</p>"
