"""Coefficients of tooth friction by sliding speed, and the law that a case asks for (TM-100180, Eqs. 17 and 18)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.geometry.pair import GearPair

_INCH = 0.0254


_POUND_PER_INCH = 4.4482216152605 / _INCH


_REYN = 4.4482216152605 / _INCH**2


#: Largest friction coefficient used; (18) has no bound where sliding stops.
LARGEST_COEFFICIENT = 0.2


def buckingham(sliding: ArrayLike) -> Array:
    """Friction coefficient of boundary lubrication 0.05 exp(-0.125 V) + 0.002 sqrt(V), V in in/s (17).

    Parameters
    ----------
    sliding : array_like
        Sliding speed [m/s]; its sign does not matter.
    """
    v = np.abs(np.asarray(sliding, dtype=float)) / _INCH
    return 0.05 * np.exp(-0.125 * v) + 0.002 * np.sqrt(v)


def benedict_kelley(line_load: ArrayLike, viscosity: float, sliding: ArrayLike, rolling: ArrayLike) -> Array:
    """Friction coefficient of elastohydrodynamic lubrication 0.0127 log10(45.94 w / (mu V_s V_r^2)) (18).

    The constant 45.94 belongs to lb/in, lb s/in^2 and in/s (it follows from Benedict and Kelley's 3.17e8 in lb/in, cP
    and in/s; with the SI units that the report names it would be 0.0297). The value is held between zero and 0.2: the
    formula grows without bound where sliding stops, and falls below zero far outside its range.

    Parameters
    ----------
    line_load : array_like
        Load per face width [N/m].
    viscosity : float
        Dynamic viscosity [Pa s].
    sliding, rolling : array_like
        Sliding speed and sum of the rolling speeds [m/s].
    """
    if not (math.isfinite(viscosity) and viscosity > 0.0):
        raise RangeError("viscosity", viscosity, "must be positive")
    w = np.maximum(np.asarray(line_load, dtype=float), 0.0) / _POUND_PER_INCH
    speed = np.abs(np.asarray(sliding, dtype=float)) * np.asarray(rolling, dtype=float) ** 2 / _INCH**3
    below = viscosity / _REYN * speed
    tiny = np.finfo(float).tiny
    value = 0.0127 * (np.log10(np.maximum(45.94 * w, tiny)) - np.log10(np.maximum(below, tiny)))
    found: Array = np.clip(np.where(w > 0.0, value, 0.0), 0.0, LARGEST_COEFFICIENT)
    return found


@dataclass(frozen=True)
class FrictionLaw:
    """A law of the friction coefficient of teeth.

    Parameters
    ----------
    law : {"buckingham", "benedict-kelley", "constant"}
    viscosity : float, optional
        Of the oil, for ``benedict-kelley`` [Pa s].
    coefficient : float, optional
        For ``constant``.
    """

    law: Literal["buckingham", "benedict-kelley", "constant"] = "buckingham"
    viscosity: float | None = None
    coefficient: float | None = None

    def of(self, pair: GearPair) -> Callable[[Array, Array, Array], Array]:
        """Friction coefficient of a pair from sliding speed, sum of the rolling speeds [m/s] and tooth force [N]."""
        if self.law == "buckingham":
            return lambda sliding, _rolling, _force: buckingham(sliding)
        if self.law == "constant":
            return lambda sliding, _rolling, _force: np.full(np.shape(sliding), self.coefficient or 0.0)
        viscosity, width = self.viscosity or 0.0, pair.face_width
        return lambda sliding, rolling, force: benedict_kelley(np.asarray(force) / width, viscosity, sliding, rolling)
