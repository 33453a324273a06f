"""Stage ``rack-geometry``: a rack and its pinion in mesh, with their drawing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.case.built.rack import rack_inputs, racks
from fegear.engine.citation import citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage
from fegear.results import forecasts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.built.rack import RackInputs
    from fegear.case.reading import Scene
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: Teeth of the rack that are drawn to either side of the pitch point.
_DRAWN = 5


@dataclass(frozen=True)
class RackGeometry:
    """Rack and pinion in mesh."""

    contact_ratio: float = shown("", "contact ratio of rack and pinion")
    distance: float = shown("mm", "distance from the axis of the pinion to the reference line of the rack")
    mounting_distance: float = shown("mm", "distance from the axis of the pinion to the back of the rack")
    rolling_height: float = shown("mm", "height of the rolling line above the reference line of the rack")
    backlash: float = shown("mm", "backlash as travel of the rack, pinion fixed")
    pinion_tip_clearance: float = shown("mm", "clearance between tip of the pinion and root of the rack")
    rack_tip_clearance: float = shown("mm", "clearance between tip of the rack and root of the pinion")
    travel_per_turn: float = shown("mm", "travel of the rack per revolution of the pinion")
    stroke: float = shown("mm", "travel from the first contact of the first tooth to the last contact of the last")
    length: float = shown("mm", "length of the rack (all teeth)")
    height: float = shown("mm", "height of the rack from back to tip")
    pitch: float = shown("mm", "pitch of the rack")
    path_start: float = shown("mm", "start of the path of contact, from the pitch point towards the pinion root")
    path_end: float = shown("mm", "end of the path of contact, from the pitch point towards the pinion tip")
    start_radius: float = shown("mm", "start of active profile of the pinion, radius")
    lowest_contact: float = shown("mm", "lowest contact on the rack, height above the reference line")


def _geometry(asked: RackInputs) -> RackGeometry:
    pair = asked.pair
    return RackGeometry(
        pair.contact_ratio, pair.distance, pair.distance + pair.rack.reference_height, pair.rolling_height,
        pair.backlash, pair.pinion_tip_clearance,
        pair.rack_tip_clearance, pair.travel_per_turn, pair.stroke, pair.rack.length, pair.rack.height,
        pair.rack.pitch, pair.x_start, pair.x_end, float(pair.radius(pair.x_start)), float(pair.height(pair.x_end)),
    )  # fmt: skip


def _compute(asked: RackInputs, _upstream: Upstream, _work: Work) -> RackGeometry:
    return _geometry(asked)


def _answer(seen: Seen) -> Iterator[str]:
    data = seen.data
    yield (
        f"Rack {seen.name}: contact ratio {figures(data.contact_ratio)} with pinion {seen.asked.pinion}, distance "
        f"{figures(data.distance * 1e3, 5)} mm, backlash {figures(data.backlash * 1e6)} µm."
    )
    yield (
        f"Travel per revolution of the pinion {figures(data.travel_per_turn * 1e3, 5)} mm; stroke "
        f"{figures(data.stroke * 1e3, 4)} mm."
    )


def _drawing(seen: Seen) -> tuple[Figure, ...]:
    from fegear.geometry.outline import gear_outline, turned
    from fegear.geometry.rack_outline import rack_outline

    pair, asked = seen.asked.pair, seen.asked
    middle = min(pair.rack.teeth // 2, _DRAWN)
    line = rack_outline(pair.rack, first=middle, count=min(pair.rack.teeth, 2 * _DRAWN + 1))
    x, y = (
        line[0] - pair.rack.module * float(pair.rack.tooth.half_thickness(pair.rolling_height / pair.rack.module)),
        (line[1]),
    )
    tooth = pair.pinion.tooth
    lean = float(tooth.flank_angle(tooth.pitch_radius))
    px, py = turned(gear_outline(pair.pinion), math.pi - lean)
    closed = [np.append(one, one[0]) * 1e3 for one in (px, py + pair.distance)]
    items = (
        Curve(x * 1e3, y * 1e3, f"rack {seen.name}", "series:0", markers=False),
        Curve(closed[0], closed[1], f"pinion {asked.pinion}", "series:1", markers=False),
        Curve(np.array([x.min(), x.max()]) * 1e3, np.full(2, pair.rolling_height * 1e3), "rolling line", "ink",
              markers=False),
    )  # fmt: skip
    panel = Panel(Axis("along the rack", "mm"), Axis("height above the reference line", "mm"), items, equal=True,
                  height=2.0)  # fmt: skip
    caption = f"Rack {seen.name} and pinion {asked.pinion}: flanks in contact at the pitch point."
    return (Figure(f"rack_{seen.name}", f"Rack {seen.name} and pinion", caption, (panel,)),)


_NAMES = tuple(RackGeometry.__dataclass_fields__)

_SHEET = Sheet(
    answer=Answer(_answer, figure=lambda seen: f"rack_{seen.name}", background=True),
    tables=(
        Rows(
            "rack_geometry_{name}", "Rack {name} and pinion in mesh", _NAMES, of=lambda seen: (seen.data,), printed=True
        ),
    ),
    values=tuple(Number(one, exact) for one in _NAMES),
    figures=(_drawing,),
)  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    rack_inputs(scene, name)


RACK_GEOMETRY = Stage(
    subjects=racks,
    inputs=rack_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(forecasts.INVOLUTE),
    forecast=lambda _scene, _name: forecasts.constant(0.05),
)
