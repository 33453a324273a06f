"""Figures in a notebook."""

from __future__ import annotations

import base64
import html
import json
from typing import TYPE_CHECKING

from fegear.output.draw_plotly.description import plotly_json
from fegear.output.draw_plotly.layout import template
from fegear.output.shades import LIGHT

if TYPE_CHECKING:
    from fegear.engine.figure import Figure


def notebook_html(figure: Figure, *, library: bool = True) -> str:
    """A figure as HTML for a notebook, by plotly's Python; fields and surfaces as a picture.

    Parameters
    ----------
    figure : Figure
    library : bool
        Whether plotly.js comes with it; the first of several figures on one page brings it for all.
    """
    if not figure.drawable_in_page:
        return still_html(figure)
    from plotly.io import to_html

    spec = plotly_json(figure)
    layout = spec["layout"] | {"template": template() | {"data": {}}, "paper_bgcolor": LIGHT["paper"]}
    plot: str = to_html(json.loads(json.dumps({"data": spec["data"], "layout": layout})), full_html=False,
                        include_plotlyjs=library, validate=False)  # fmt: skip
    return f"<b>{html.escape(figure.title)}</b>{plot}<p>{html.escape(figure.caption)}</p>"


def still_html(figure: Figure) -> str:
    """A figure as a picture in HTML."""
    import tempfile
    from pathlib import Path

    from fegear.output.draw_png import draw_pictures

    with tempfile.TemporaryDirectory() as folder:
        images = [picture.path.read_bytes() for picture in draw_pictures(figure, Path(folder))]
    shown = "".join(f"<img src='data:image/png;base64,{base64.b64encode(i).decode()}'>" for i in images)
    return f"<b>{html.escape(figure.title)}</b>{shown}<p>{html.escape(figure.caption)}</p>"
