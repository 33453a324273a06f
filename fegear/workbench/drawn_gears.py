"""Gears and pairs as a notebook shows them: the drawing, and the data that it carries."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import outline
from fegear.engine.figure.panel import Panel
from fegear.geometry.outline import gear_outline
from fegear.output.draw_plotly.notebook import still_html

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.geometry import gear as geometry
    from fegear.workbench.results import Results


#: Chords of a drawn outline stay this close to it [modules].
_CHORD = 1e-3


def _circle(radius: float) -> Array:
    angle = np.linspace(0.0, 2.0 * math.pi, 361)
    return radius * np.stack([np.cos(angle), np.sin(angle)])


def gear_figure(name: str, gear: geometry.Gear) -> Figure:
    """The whole gear: outline, pitch circle, and where the body is held."""
    points = gear_outline(gear, _CHORD) * 1e3
    lines = (
        outline(np.hstack([points, points[:, :1]]), name, width=1.4),
        outline(_circle(gear.pitch_radius * 1e3), "reference circle", "grey", dash="dashdot", width=0.8),
        outline(_circle(gear.bore_radius * 1e3), "held", "grey", width=0.8),
    )
    return Figure(
        f"gear_{name}", f"Gear {name}",
        f"{gear.teeth} teeth, module {gear.module * 1e3:.6g} mm, profile shift {gear.tooth.profile_shift:.4g}"
        + (f"; transverse section, {gear.hand} hand." if gear.helix_angle else "."),
        (Panel(Axis("x", "mm"), Axis("y", "mm"), lines, equal=True, height=1.5),),
    )  # fmt: skip


def _data_html(data: Results) -> str:
    values = data._repr_html_() if data.values else ""
    return values + "".join(table._repr_html_() for table in data.tables)


def gear_html(name: str, gear: geometry.Gear, data: Results) -> str:
    """Drawing and data of a gear."""
    return still_html(gear_figure(name, gear)) + _data_html(data)


def pair_html(data: Results) -> str:
    """Drawing and data of a pair."""
    return "".join(still_html(figure.made()) for figure in data.figures) + _data_html(data)
