"""Root stress of every tooth of a gear that runs against another until the same teeth mesh again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.shown import shown
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.fem.alike_teeth import meshing_order
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.contact.plane.stress_over_revolution import StressOfTeeth
    from fegear.engine.sheet.seen import Seen
    from fegear.results.pair.mesh_stiffness_revolution import RevolutionData


@dataclass(frozen=True)
class StressByTooth:
    """Largest root stress of every tooth of a gear on its way through the mesh, in meshing order."""

    gear: str
    tooth: Index = shown("", "number of the tooth in meshing order", table="teeth")
    root_tension: Array = shown("MPa", "maximum root stress, tension side", table="teeth")
    root_tension_change: Array = shown("%", "change from the median of all teeth", table="teeth")
    root_tension_error: Array | None = None


def by_tooth(found: StressOfTeeth, gear: str) -> StressByTooth:
    """In meshing order; of a gear whose teeth are all alike only those that mesh until the same teeth come again."""
    order = np.array([meshing_order(tooth, found.teeth, found.member) for tooth in range(found.teeth)])
    at = np.argsort(order)
    largest = found.largest[at]
    error = None if found.largest_error is None else found.largest_error[at]
    return StressByTooth(gear, order[at], largest, largest / np.median(largest) - 1.0, error)


def not_listed(seen: Seen) -> Iterator[str]:
    """Why a table of root stress has fewer rows than its gear has teeth."""
    data: RevolutionData = seen.data
    for member, one in zip(MEMBERS, data.stress, strict=False):
        teeth = data.pair.gear(member).teeth
        if 1 < one.tooth.size < teeth:
            yield (
                f"Pair {seen.name}: root stress of gear {one.gear} is listed for {one.tooth.size} of its "
                f"{teeth} identical teeth: the meshing repeats after {data.base_pitches} base pitches, counted from "
                "the mesh of tooth 0 with tooth 0 of the other gear."
            )


TABLE_OF_TEETH = Rows(
    "root_stress_teeth_{name}_{one.gear}",
    "Maximum root stress of every tooth of gear {one.gear} in {name}",
    (Every("teeth"), Off("root_tension", "root_tension_error")),
    each="stress",
)
CHART_OF_TEETH = Chart(
    "root_stress_teeth_{name}_{one.gear}",
    "Root stress of every tooth of gear {one.gear} in pair {name}",
    "Gear {one.gear}: maximum root stress (tension side) of every tooth over its engagement.",
    (Over("tooth", (Line("root_tension", kind="points", error="root_tension_error"),)),),
    each="stress",
)
