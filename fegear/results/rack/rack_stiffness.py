"""Stage ``rack-stiffness``: compliance and root stress of the teeth of a rack, at its ends and in its middle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.case.built.rack import racks
from fegear.engine.citation import citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage
from fegear.results import forecasts
from fegear.results.forecasts import PATCH, RING
from fegear.results.rack.solved_rack import RackToSolve, needs_rack, rack_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.contact.rack.rack_teeth import RackTeeth
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: Heights over the flank.
_POINTS = 41


@dataclass(frozen=True)
class ToothOfRack:
    """One tooth under unit line loads over its flank, shape (P,); NaN where there is no neighbour."""

    number: int
    height: Array = shown("mm", "height of the load above the reference line")
    own: Array = shown(
        "um.mm/N", "self-compliance c_0 (contact half-width 0.02 modules)", name="c_self", label="self-compliance c_0"
    )
    before: Array = shown("um.mm/N", "coupling compliance of the tooth before; blank: none", name="c_prev")
    after: Array = shown("um.mm/N", "coupling compliance of the tooth after; blank: none", name="c_next")
    tension: Array = shown(
        "MPa.mm/N", "root stress, tension side, per line load", name="root_tension", label="root stress"
    )
    compression: Array = shown("MPa.mm/N", "root stress, compression side, per line load", name="root_compression")
    own_error: Array = shown("um.mm/N", "estimated error of c_self", name="c_self_error")
    tension_error: Array = shown("MPa.mm/N", "estimated error of root_tension", name="root_tension_error")


@dataclass(frozen=True)
class RackStiffness:
    """First, middle and last tooth."""

    teeth: dict[str, ToothOfRack]


def _numbers(of: RackTeeth, i: int, heights: Array) -> tuple[Array, ...]:
    m, modulus = of.rack.module, of.rack.material.young_modulus
    one = of.solved.loaded(i)
    y = heights / m
    none = np.full(y.size, np.nan)
    beside = [
        np.array([float(one.neighbour(k, [at], [at], of.patch)[0, 0]) for at in y]) / modulus
        if k in one.compliance else none
        for k in (-1, 1)
    ]  # fmt: skip
    stress = [one.largest_root_stress(0, side, y)[0] / m for side in ("tension", "compression")]
    return of.self_compliance(i, heights, 0.02 * m), *beside, *stress


def _compute(asked: RackToSolve, upstream: Upstream, _work: Work) -> RackStiffness:
    both = rack_of(upstream, asked.name)
    rack, found = asked.rack, {}
    low, high = (one * rack.module for one in both.fine.solved.flank.heights)
    heights = np.linspace(low, high, _POINTS)
    for i in dict.fromkeys((0, (rack.teeth - 1) // 2, rack.teeth - 1)):
        own, before, after, tension, compression = _numbers(both.fine, i, heights)
        off, torn = np.full((2, _POINTS), np.nan)
        if both.coarse is not None:
            other = _numbers(both.coarse, i, heights)
            off, torn = np.abs(own - other[0]), np.abs(tension - other[3])
        found[str(i + 1)] = ToothOfRack(i + 1, heights, own, before, after, tension, compression, off, torn)
    return RackStiffness(found)


def _answer(seen: Seen) -> Iterator[str]:
    teeth = list(seen.data.teeth.values())
    middle = teeth[len(teeth) // 2]
    at = int(np.argmin(np.abs(middle.height)))
    said = f"Rack {seen.name}: c_0 on the reference line {figures(middle.own[at] * 1e9)} µm mm/N in the middle"
    if len(teeth) > 1:
        softer = 100.0 * (teeth[0].own[at] / middle.own[at] - 1.0), 100.0 * (teeth[-1].own[at] / middle.own[at] - 1.0)
        said += f", {figures(softer[0])} % and {figures(softer[1])} % more at the first and the last tooth"
    yield said + "."


_COLUMNS = (
    "height", "own", "before", "after", "tension", "compression", "own_error", "tension_error",
)  # fmt: skip
_SHEET = Sheet(
    answer=Answer(_answer, figure=lambda seen: f"rack_stiffness_{seen.name}"),
    tables=(
        Rows("rack_stiffness_{name}_{key}", "Rack {name}: compliance and root stress of tooth {key}", _COLUMNS,
             each="teeth"),
    ),
    figures=(
        Chart(
            "rack_stiffness_{name}", "Stiffness of the teeth of rack {name}",
            "Rack {name}: self-compliance and root stress over the height of the load; half-width 0.02 modules.",
            (
                Over("height", (Line("own", each=Family("teeth", "tooth {key}")),)),
                Over("height", (Line("tension", each=Family("teeth", "tooth {key}")),)),
            ),
            of=lambda seen: next(iter(seen.data.teeth.values())),
        ),
    ),
)  # fmt: skip

RACK_STIFFNESS = Stage(
    subjects=racks,
    needs=needs_rack,
    inputs=RackToSolve.of,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(*RING, PATCH),
    forecast=lambda _scene, _name: forecasts.constant(0.1),
)
