"""Table and figure of the teeth of a gear that stand differently to the holes of its web."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shows
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.rows import Every, Rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.solid.solution import SolidSolution


@dataclass(frozen=True)
class TeethOverHoles:
    """What each tooth does under the same load, over the mean of all, shape (T,)."""

    tooth: NDArray[np.int64] = shown("", "tooth number, clockwise from tooth 0", label="tooth", table="teeth")
    deflection: Array = shown(
        "", "deflection of a band at half tooth height, mid-face, relative to the mean of all teeth", table="teeth"
    )
    root_tension: Array = shown(
        "", "maximum root stress (tension side) over the face width, relative to the mean of all teeth", table="teeth"
    )
    root_compression: Array = shown(
        "",
        "maximum root stress (compression side) over the face width, relative to the mean of all teeth",
        table="teeth",
    )

    @property
    @shows("", "off the mean, in %")
    def deflection_off(self) -> Array:
        """[%]."""
        return 100.0 * (self.deflection - 1.0)

    @property
    @shows("", "off the mean, in %")
    def root_tension_off(self) -> Array:
        """[%]."""
        return 100.0 * (self.root_tension - 1.0)

    @property
    @shows("", "off the mean, in %")
    def root_compression_off(self) -> Array:
        """[%]."""
        return 100.0 * (self.root_compression - 1.0)


def _uneven(seen: Seen) -> TeethOverHoles | None:
    """Nothing where all teeth are alike."""
    solution: SolidSolution = seen.data.influence.fine
    found = solution.uneven
    if solution.body is None or solution.body.holes is None or found is None or found.deflection.size == 1:
        return None
    shares = (one / one.mean() for one in (found.deflection, found.root_tension, found.root_compression))
    return TeethOverHoles(np.arange(found.deflection.size), *shares)


def _caption(seen: Seen) -> str:
    tooth = seen.asked.gear.body.holes.tooth
    taken = "the mean" if tooth is None else f"tooth {tooth} for all teeth"
    return f"Gear {seen.name}: each tooth loaded at half height in the middle of the face; pairs take {taken}."


_TITLE = "Variation of tooth compliance of gear {name} due to web holes (equal load)"
#: Of a result whose data have the `SolidInfluence` of a gear as ``influence``.
HOLES_TABLE = Rows("teeth_over_holes_{name}", _TITLE, (Every("teeth"),), of=_uneven)
HOLES_FIGURE = Chart(
    "teeth_over_holes_{name}",
    _TITLE,
    _caption,
    (
        Over(
            "tooth",
            tuple(
                Line(f"{key}_off", key.replace("_", " "), f"series:{i}")
                for i, key in enumerate(("deflection", "root_tension", "root_compression"))
            ),
            Axis("deviation from mean", "%"),
            x_options={"whole": True},
        ),
    ),
    of=_uneven,
)
