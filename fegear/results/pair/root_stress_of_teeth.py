"""Root stress of every tooth of a gear that runs against another until the same teeth mesh again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.fem.alike_teeth import meshing_order
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.contact.plane.stress_over_revolution import StressOfTeeth
    from fegear.engine.sheet.seen import Seen

#: Change of the root stress from which on a cracked tooth is called relieved.
_RELIEVED = -0.02


@dataclass(frozen=True)
class StressByTooth:
    """Largest root stress of every tooth of a gear on its way through the mesh, in meshing order.

    Parameters
    ----------
    cracked : tuple of int
        Numbers of cracked teeth: theirs is the stress of the fillet beside the mouth of the crack.
    """

    gear: str
    tooth: Index = shown("", "number of the tooth in meshing order", table="teeth")
    root_tension: Array = shown("MPa", "maximum root stress, tension side", table="teeth")
    root_tension_change: Array = shown("%", "change from the median of all teeth", table="teeth")
    root_tension_error: Array | None = None
    cracked: tuple[int, ...] = ()

    @property
    def relieved(self) -> tuple[int, ...]:
        """Cracked teeth whose fillet the crack relieves."""
        low = set(self.tooth[self.root_tension_change < _RELIEVED].tolist())
        return tuple(one for one in self.cracked if one in low)

    @property
    def beside_cracks(self) -> StressByTooth | None:
        """Of these teeth only; None where there are none."""
        at = np.flatnonzero(np.isin(self.tooth, self.relieved))
        return replace(self, tooth=self.tooth[at], root_tension=self.root_tension[at]) if at.size else None

    @property
    def clause(self) -> str:
        """What the stress of these teeth is; empty where there are none."""
        if not self.relieved:
            return ""
        teeth = (
            f"tooth {self.relieved[0]}" if len(self.relieved) == 1 else f"teeth {', '.join(map(str, self.relieved))}"
        )
        return f"; {teeth}: fillet beside the crack, relieved by it (maximum at the crack tip: stress-intensity)"


def _numbered(teeth: tuple[int, ...]) -> str:
    return f"tooth {teeth[0]}" if len(teeth) == 1 else f"teeth {', '.join(map(str, teeth))}"


def by_tooth(found: StressOfTeeth, gear: str, cracked: tuple[int, ...] = ()) -> StressByTooth:
    """In meshing order; of a gear whose teeth are all alike only those that mesh until the same teeth come again."""
    order = np.array([meshing_order(tooth, found.teeth, found.member) for tooth in range(found.teeth)])
    at = np.argsort(order)
    largest = found.largest[at]
    error = None if found.largest_error is None else found.largest_error[at]
    return StressByTooth(gear, order[at], largest, largest / np.median(largest) - 1.0, error, cracked)


def not_listed(seen: Seen) -> Iterator[str]:
    """Why a table of root stress has fewer rows than its gear has teeth."""
    data = seen.data
    for member, one in zip(MEMBERS, data.stress, strict=False):
        teeth = data.pair.gear(member).teeth
        if 1 < one.tooth.size < teeth:
            yield (
                f"Pair {seen.name}: root stress of gear {one.gear} is listed for {one.tooth.size} of its "
                f"{teeth} identical teeth: the meshing repeats after {data.base_pitches} base pitches, counted from "
                "the mesh of tooth 0 with tooth 0 of the other gear."
            )


def beside_cracks(seen: Seen) -> Iterator[str]:
    """Where the root stress of cracked teeth is that of a fillet which the crack relieves."""
    for one in seen.data.stress:
        if teeth := one.relieved:
            lowest = float(one.root_tension_change[np.isin(one.tooth, teeth)].min())
            yield (
                f"Pair {seen.name}: root stress of the cracked {_numbered(teeth)} of gear {one.gear} is that of the "
                f"fillet beside the crack, which relieves it ({percent(lowest, signed=True)}); the maximum is at the "
                "tip of the crack: request stress-intensity."
            )


def _others(seen: Seen) -> str:
    return "other teeth" if seen.one.relieved else ""


TABLE_OF_TEETH = Rows(
    "root_stress_teeth_{name}_{one.gear}",
    "Maximum root stress of every tooth of gear {one.gear} in {name}{one.clause}",
    (Every("teeth"), Off("root_tension", "root_tension_error")),
    each="stress",
)
CHART_OF_TEETH = Chart(
    "root_stress_teeth_{name}_{one.gear}",
    "Root stress of every tooth of gear {one.gear} in pair {name}",
    "Gear {one.gear}: maximum root stress (tension side) of every tooth over its engagement{one.clause}.",
    (
        Over(
            "tooth",
            (
                Line("root_tension", _others, kind="points", error="root_tension_error"),
                Line("root_tension", "fillet beside the crack", "red", kind="points", of="beside_cracks"),
            ),
        ),
    ),
    each="stress",
)
