"""Estimated errors of a double helical pair: both halves solved again with longer panels, then with coarser gears."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.double_helical.loaded_double import DoubleError
from fegear.contact.wide.over_pitch import every_second

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.contact.double_helical.loaded_double import LoadedDoublePair

#: By how much panels of the second solution are longer.
LONGER = 1.5
#: What is taken for an error of what half of the mesh positions change of a mean.
_OF_MEAN = 0.5


def double_error(steps: Sequence[LoadedDoublePair], missed: float) -> DoubleError:
    """Errors of the first of solutions, each of which has less than the one before.

    Parameters
    ----------
    steps : sequence of LoadedDoublePair
        At the same mesh positions.
    missed : float
        Share by which compliances of slices are known to be off; 0 for solids.
    """
    best = steps[0]
    te, kept = best.transmission_error, every_second(best.points)

    def changed(key: str) -> Array:
        return np.asarray(sum(np.abs(getattr(two, key) - getattr(one, key)) for one, two in pairwise(steps)))

    def by_fewer(values: Array) -> Array:
        """What half of the mesh positions leave of a mean."""
        x, period = best.points.x, best.points.period
        straight = np.stack([np.interp(x, x[kept], one[kept], period=period) for one in values.T], axis=1)
        return _OF_MEAN * np.abs(best.mean(straight) - best.mean(values))

    uneven = missed * np.abs(best.share[0] - best.spec.nominal_parts[0])
    narrower = min(best.spec.nominal_parts)
    factor = missed * np.abs(best.load_factor - 1.0) + by_fewer(best.share[0]) / narrower
    return DoubleError(
        changed("transmission_error") + missed * np.abs(te),
        changed("share_of_first") + uneven,
        # at a stop the place is given
        changed("axial_motion") + missed * np.where(best.balance.free, np.abs(best.balance.position), 0.0),
        changed("mean_transmission_error") + missed * np.abs(best.mean_transmission_error) + by_fewer(te),
        changed("peak_to_peak") + missed * best.peak_to_peak + np.ptp(te, axis=0) - np.ptp(te[kept], axis=0),
        changed("load_factor") + factor,
        changed("face_load_factors") + missed * np.abs(best.face_load_factors - 1.0),
    )
