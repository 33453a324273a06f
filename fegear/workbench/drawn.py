"""Gears and pairs as a notebook shows them: the drawing, and the data that it carries."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Panel, outline
from fegear.geometry.outline import gear_outline
from fegear.output.draw_plotly.notebook import still_html

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.geometry import Gear as SpurGear
    from fegear.geometry import GearPair
    from fegear.workbench.gear import Gear
    from fegear.workbench.pair import Pair
    from fegear.workbench.results import Results

#: Chords of a drawn outline stay this close to it [modules].
_CHORD = 1e-3


def _circle(radius: float, centre: float) -> Array:
    angle = np.linspace(0.0, 2.0 * math.pi, 361)
    return np.stack([radius * np.cos(angle), centre + radius * np.sin(angle)])


def _lines(gear: SpurGear, name: str, role: str, *, centre: float = 0.0, turn: float = 0.0) -> tuple[Curve, ...]:
    """Outline [mm] of a gear whose tooth 0 points up before it is turned [rad], and its circles."""
    points = gear_outline(gear, _CHORD) * 1e3
    c, s = math.cos(turn), math.sin(turn)
    x, y = c * points[0] - s * points[1], s * points[0] + c * points[1] + centre
    closed = np.stack([np.append(x, x[0]), np.append(y, y[0])])
    return (
        outline(closed, name, role, width=1.4, dash="solid"),
        outline(_circle(gear.pitch_radius * 1e3, centre), "pitch circle", "grey", dash="dashdot", width=0.8),
        outline(_circle(gear.bore_radius * 1e3, centre), "held", "grey", width=0.8),
    )


def gear_figure(name: str, gear: SpurGear) -> Figure:
    """The whole gear."""
    return Figure(
        f"gear_{name}", f"Gear {name}",
        f"{gear.teeth} teeth, module {gear.module * 1e3:.6g} mm, profile shift {gear.tooth.profile_shift:.4g}.",
        (Panel(Axis("x", "mm"), Axis("y", "mm"), _lines(gear, name, "outline"), equal=True, height=1.5),),
    )  # fmt: skip


def pair_figure(name: str, names: tuple[str, str], pair: GearPair) -> Figure:
    """Both gears in mesh: a tooth of the driver in a space of its mate, on the line of centres."""
    driver, driven, distance = pair.driver, pair.driven, pair.centre_distance * 1e3
    items = (
        *_lines(driver, names[0], "driver"),
        *_lines(driven, names[1], "driven", centre=distance, turn=math.pi + math.pi / driven.teeth),
    )
    return Figure(
        f"pair_{name}", f"Pair {name}",
        f"Pair {name}: centre distance {distance:.6g} mm, contact ratio {pair.contact_ratio:.4g}.",
        (Panel(Axis("x", "mm"), Axis("y", "mm"), items, equal=True, height=1.8),),
    )  # fmt: skip


def _data_html(data: Results) -> str:
    values = data._repr_html_() if data.values else ""
    return values + "".join(table._repr_html_() for table in data.tables)


def gear_html(gear: Gear) -> str:
    """Drawing and data of a gear; of a helical one its description alone."""
    if not gear.is_spur:
        return f"<code>{escape(repr(gear))}</code>"
    return still_html(gear_figure(gear.name, gear.spur)) + _data_html(gear.data)


def pair_html(pair: Pair) -> str:
    """Drawing and data of a pair; of a helical one its description alone."""
    if not pair.is_spur:
        return f"<code>{escape(repr(pair))}</code>"
    return still_html(pair_figure(pair.name, pair.names, pair.spur)) + _data_html(pair.data)
