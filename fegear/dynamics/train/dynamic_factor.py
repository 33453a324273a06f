"""Dynamic factor of a linearised train over speed: no contact loss, the other meshes at the worst relative phase.

Dynamic factor predicted from the effective error of the static transmission error (TM-89901, Fig. 11).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.dynamics.train.charts import SpeedChart
from fegear.dynamics.train.gear_train import GearTrain
from fegear.dynamics.train.single_tooth import force_history
from fegear.dynamics.train.tooth_force import mesh_force_range


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


#: Effective errors that differ by less, relative to the larger, do not tell two dynamic factors apart.
_ALIKE = 1e-6


@dataclass(frozen=True)
class FactorLine:
    """A straight line of the dynamic factor over the effective error, by least squares."""

    constant: float = shown("", "dynamic factor at no effective error", name="line_constant")
    slope: float = shown("1/mm", "slope of the dynamic factor over A_e", name="line_slope")
    scatter: float = shown("", "root mean square residual", name="line_scatter")
    correlation: float = shown("", "correlation coefficient of dynamic factor and A_e", name="line_correlation")

    def __call__(self, effective_error: ArrayLike) -> Array:
        """Dynamic factor at effective errors [m]."""
        return self.constant + self.slope * np.asarray(effective_error, dtype=float)


def factor_line(effective_error: ArrayLike, dynamic_factor: ArrayLike) -> FactorLine | None:
    """The line through points of a design chart, those without a result (nan) left out; None for fewer than three.

    Parameters
    ----------
    effective_error : array_like
        A_e [m].
    dynamic_factor : array_like, of the same shape
    """
    error, factor = (np.ravel(np.asarray(v, dtype=float)) for v in (effective_error, dynamic_factor))
    there = np.isfinite(error) & np.isfinite(factor)
    error, factor = error[there], factor[there]
    if error.size < 3 or not np.ptp(error) > _ALIKE * np.max(np.abs(error)):
        return None
    away = error - error.mean()
    slope = float(away @ (factor - factor.mean()) / (away @ away))
    constant = float(factor.mean() - slope * error.mean())
    left = factor - constant - slope * error
    spread = float(np.std(factor))
    correlation = slope * float(np.std(error)) / spread if spread > 0.0 else 0.0
    return FactorLine(constant, slope, float(np.sqrt(np.mean(left**2))), correlation)


def factor_between(effective_error: float, known_errors: tuple[float, float], factors: tuple[float, float]) -> float:
    """The paper's own way: the factor lies between two known ones as its effective error lies between theirs.

    Nan where the two known errors are alike.
    """
    low, high = known_errors
    if not abs(high - low) > _ALIKE * max(abs(high), abs(low)):
        return math.nan
    return factors[0] + (factors[1] - factors[0]) * (effective_error - low) / (high - low)
