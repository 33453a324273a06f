"""Dynamic factor of a linearised train over speed: no contact loss, the other meshes at the worst relative phase."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.charts import SpeedChart
from fegear.dynamics.pull import mesh_force_range
from fegear.dynamics.single_tooth import force_history

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.arrays import Array
    from fegear.dynamics.gear_train import GearTrain


def linear_chart(
    data: GearTrain,
    i: int,
    speeds: Array,
    positions: int,
    harmonics: int,
    progress: Callable[[float], None] | None = None,
) -> SpeedChart:
    """Largest tooth and mesh force of mesh `i` over its mean force.

    Parameters
    ----------
    data : GearTrain
    i : int
    speeds : ndarray, shape (N,)
        Of the first body [rad/s].
    positions : int
        Over the path of contact.
    harmonics : int
    progress : callable, optional
    """
    mean = float(data.forces[i])
    tooth, mesh = np.empty(speeds.size), np.empty(speeds.size)
    for number, speed in enumerate(speeds):
        found = force_history(data, i, float(speed) * data.speed_ratio, positions, harmonics)
        tooth[number] = (float(found.total.max()) + float(found.cross_peak.sum())) / mean
        mesh[number] = mesh_force_range(data, i, float(speed), harmonics)[1] / mean
        if progress:
            progress((number + 1) / speeds.size)
    return SpeedChart.linear(speeds, tooth, mesh)
