"""Estimated errors of what follows from load sharing: solved again with each compliance off by its own error.

`shifted` holds engagements whose compliances are off, one source each (`fegear.contact.shifted_compliance`); the
changes that they make add up.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.engagement import Loaded
from fegear.contact.fourier import fourier_series
from fegear.contact.load_sharing import share_load
from fegear.contact.mesh_curve import mean_secant_stiffness
from fegear.contact.roll_grids import RollGrid

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.arrays import Array
    from fegear.contact.engagement import Engagement
    from fegear.contact.pair_history import PairHistory
    from fegear.contact.transmission_error import TransmissionError


def solve_again(other: Engagement, loaded: Loaded) -> Loaded:
    """Solve with another engagement's compliances at the same contacts, loads and separations."""
    grid = loaded.grid
    m = other.compliance.matrices(grid.contacts)
    shared = share_load(m.compliance, loaded.separation, loaded.load, m.log_slope, m.reference_load, m.tilt, m.power)
    return Loaded(RollGrid(grid.x, grid.contacts, m), loaded.load, shared, loaded.separation)


@dataclass(frozen=True)
class TransmissionErrorShift:
    """Estimated errors of a transmission error's numbers, each the sum of the changes by the shifted compliances."""

    mean: float
    peak_to_peak: float
    effective: float
    amplitude: Array
    stiffness: float


def transmission_error_shift(te: TransmissionError, shifted: Sequence[Engagement]) -> TransmissionErrorShift | None:
    """Solve again at the same quadrature points with each compliance off by its error; None where none states one."""
    if not shifted:
        return None
    found = []
    for engagement in shifted:
        other = solve_again(engagement, te.loaded)
        values = other.transmission_error[:, 0]
        again = replace(te, loaded=other, series=fourier_series(te.points, values, te.series.amplitude.size))
        found.append(
            (
                abs(again.mean - te.mean),
                abs(again.peak_to_peak - te.peak_to_peak),
                abs(again.effective_error - te.effective_error),
                np.abs(again.series.amplitude - te.series.amplitude),
                abs(mean_secant_stiffness(again) - mean_secant_stiffness(te)),
            )
        )
    return TransmissionErrorShift(
        sum(f[0] for f in found), sum(f[1] for f in found), sum(f[2] for f in found),
        np.sum([f[3] for f in found], axis=0), sum(f[4] for f in found),
    )  # fmt: skip


def load_shift(history: PairHistory, other: PairHistory) -> Array:
    """How far the loads of a shifted solution are from the original's, shape of its loads [N]."""
    columns = [
        np.interp(history.x, other.x, other.load[:, i], left=0.0, right=0.0) for i in range(history.load.shape[1])
    ]
    difference = np.abs(np.stack(columns, axis=1) - history.load)
    # A jump of the load at an end of the path is in the same place in both; outside it one of them may have no point.
    inside = (history.x >= other.x[0]) & (history.x <= other.x[-1]) if other.x.size else np.zeros(history.x.size, bool)
    return np.where(inside[:, None], difference, 0.0)
