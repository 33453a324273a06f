"""Teeth of one gear that differ: they stand differently to the pins of their rim, or to the holes of their web."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.fem.plane.influence import Side
from fegear.fem.plane.root_stress import extreme
from fegear.fem.solid.fillet import surface_stress

if TYPE_CHECKING:
    from fegear.fem.solid.bands import Bands
    from fegear.fem.solid.flank_body import SolidFlank

#: Places along the face at which root stress is compared.
_PLACES = 17


@dataclass(frozen=True)
class UnevenTeeth(ReadOnlyArrays):
    """Each tooth that differs under the same load, clockwise from tooth 0, shape (T,); lengths in modules, E = 1.

    `deflection` of the load's own band, and the largest tension and compression of the tooth's fillets over the face.
    """

    deflection: Array
    root_tension: Array
    root_compression: Array


def teeth_apart(
    solution: SolidFlank, band: Bands, load: Array, approach: Array, moved: Mapping[Side, Array]
) -> UnevenTeeth:
    """Each tooth under one load, from how it departs from the mean over all.

    Parameters
    ----------
    solution : SolidFlank
        The mean.
    band : Bands
    load : ndarray, shape (n,)
        That of the band.
    approach : ndarray, shape (T,)
    moved : mapping of side to ndarray, shape (nodes, 3, functions, T)
    """
    places = np.linspace(-0.5, 0.5, _PLACES) * solution.width
    values, slopes = solution.face.at(places)
    root = {}
    for side, fillet in solution.fillets.items():
        every = (solution.displacement[0, side] @ load)[..., None] + moved[side]
        stress = surface_stress(fillet, solution.tau, solution.poisson_ratio, every, values, slopes)[0]
        flat, sign = stress.reshape(stress.shape[0], -1), 1.0 if side == "tension" else -1.0
        end = np.full(flat.shape[1], float(solution.root_end(0, side, band)[0]))
        largest = sign * extreme(flat, fillet.arc, sign, end)[0].reshape(stress.shape[1:])
        root[side] = sign * largest.max(axis=0)
    return UnevenTeeth(float(load @ solution.compliance[0] @ load) + approach, root["tension"], root["compression"])
