"""How far a load at one radius deflects a neighbouring tooth at another: what several pairs in contact need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.shown import shown
from fegear.fem.plane.gear import GearInfluence

#: Radii of each flank, equally spaced in roll angle: bilinear interpolation between them is off by less than 1e-4 of
#: the self-compliance (gears of 23 and 57 teeth).
POSITIONS = 21


@dataclass(frozen=True)
class NeighbourTable:
    """c_k(p, q) of the neighbours k = 1 ... reach over a grid of radii, arrays of shape (N,), the last radius fastest.

    Those on the other side follow by reciprocity: c_-k(p, q) = c_k(q, p).
    """

    tooth: Index = shown(
        "", "number k of the deflected tooth, counted from the loaded one on the side that its loaded flank faces",
        table="neighbours",
    )  # fmt: skip
    radius_p: Array = shown("mm", "radius of the deflected point p, on tooth k", table="neighbours")
    radius_q: Array = shown("mm", "radius of the load q, on tooth 0", table="neighbours")
    c_neighbour: Array = shown(
        "um.mm/N",
        "deflection c_k(p, q) of tooth k per line load on tooth 0; on the other side c_-k(p, q) = c_k(q, p)",
        table="neighbours",
    )
    c_neighbour_error: Array = shown("um.mm/N", "estimated error of c_neighbour", table="neighbours")


def neighbour_table(known: GearInfluence, positions: int = POSITIONS) -> NeighbourTable:
    """Tabulate a gear's neighbours, on both flanks over the whole involute, equally spaced in roll angle.

    Parameters
    ----------
    known : GearInfluence
    positions : int
        Radii of each flank.

    Returns
    -------
    NeighbourTable
        Without rows where the gear was solved without neighbours.
    """
    base, (low, high) = known.gear.base_radius, known.gear.involute_radii
    first, last = (float(np.sqrt(max((r - base) * (r + base), 0.0))) for r in (low, high))
    radii = np.clip(np.hypot(base, np.linspace(first, last, positions)), low, high)
    teeth = np.arange(1, known.reach + 1)
    found = [known.neighbour_with_error(int(k), radii, radii) for k in teeth]
    value, error = (np.array([one[i] for one in found]).reshape(-1) for i in (0, 1))
    k, p, q = (axis.ravel() for axis in np.meshgrid(teeth, radii, radii, indexing="ij"))
    return NeighbourTable(k, p, q, value, error)
