"""Table and figure of the teeth of a gear that stand differently to the holes of its web."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.table import Column, Table

if TYPE_CHECKING:
    from fegear.fem.solid.solution import SolidSolution

_COLUMNS = {
    "deflection": "deflection of a band at half height in the middle of the face, over its mean over all teeth",
    "root_tension": "largest root tension under it along the face, over its mean over all teeth",
    "root_compression": "largest root compression under it along the face, over its mean over all teeth",
}


def teeth_over_holes(
    name: str, solution: SolidSolution, tooth: int | None = None
) -> tuple[tuple[Table, ...], tuple[Figure, ...]]:
    """What teeth over holes depart from their mean; nothing where all are alike.

    `tooth` is the one that pairs take for all, if they do not take the mean.
    """
    if (
        solution.body is None
        or solution.body.holes is None
        or solution.uneven is None
        or solution.uneven.deflection.size == 1
    ):
        return (), ()
    teeth = np.arange(solution.uneven.deflection.size)
    shares = {key: getattr(solution.uneven, key) / getattr(solution.uneven, key).mean() for key in _COLUMNS}
    columns = [Column(key, share, "", _COLUMNS[key]) for key, share in shares.items()]
    title = f"Teeth of gear {name} over the holes of its web, each under the same load"
    table = Table(f"teeth_over_holes_{name}", (Column("tooth", teeth, "", "clockwise from tooth 0"), *columns), title)
    curves = tuple(
        Curve(teeth, 100.0 * (share - 1.0), key.replace("_", " "), f"series:{i}")
        for i, (key, share) in enumerate(shares.items())
    )
    taken = "the mean" if tooth is None else f"tooth {tooth} for all"
    figure = Figure(
        f"teeth_over_holes_{name}", title,
        f"Gear {name}: each tooth loaded at half height in the middle of the face; pairs take {taken}.",
        (Panel(Axis("tooth", whole=True), Axis("off the mean", "%"), curves),),
    )  # fmt: skip
    return (table,), (figure,)
