"""Curvature and speeds of both flanks along the path of contact, as the formulas of the surface take them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.geometry import GearPair


@dataclass(frozen=True)
class FlankSpeeds:
    """Flanks at places on the path of contact, in the section across the axes; arrays of one shape.

    Parameters
    ----------
    x : ndarray
        Place on the line of action from the pitch point, toward the driver's tip [m].
    radius_driver, radius_driven : ndarray
        Transverse radii of curvature [m].
    relative_radius : ndarray
        rho_n, relative radius of curvature in the normal section [m]: the transverse one over cos(beta_b).
    rolling_driver, rolling_driven : ndarray
        Tangential speeds of the flanks through the contact [m/s].
    """

    x: Array
    radius_driver: Array
    radius_driven: Array
    relative_radius: Array
    rolling_driver: Array
    rolling_driven: Array

    @property
    def sliding(self) -> Array:
        """Speed of the driver's flank less that of the driven one [m/s]; negative before the pitch point."""
        return np.asarray(self.rolling_driver - self.rolling_driven)

    @property
    def sum(self) -> Array:
        """v_Sigma, sum of both speeds [m/s]."""
        return np.asarray(self.rolling_driver + self.rolling_driven)


def flank_speeds(pair: GearPair, x: ArrayLike, speed: float) -> FlankSpeeds:
    """Radii of curvature and speeds on the path of contact.

    Parameters
    ----------
    pair : GearPair
    x : array_like
        Places [m].
    speed : float
        Of the driver [rad/s].

    Raises
    ------
    RangeError
        If the gears stand still: without speed there is neither film nor flash temperature.
    """
    if not (math.isfinite(speed) and speed > 0.0):
        raise RangeError(
            "speed",
            f"{speed:.6g} rad/s",
            "must be above zero: flanks that stand still have no film and no friction heat",
        )
    place = np.asarray(x, dtype=float)
    one, other = (np.asarray(pair.flank_curvature_radius(place, member)) for member in ("driver", "driven"))
    # Beyond the base circle there is no flank; on it the radius is zero, and so is the flank's speed.
    one, other = np.maximum(one, 0.0), np.maximum(other, 0.0)
    relative = one * other / (one + other) / math.cos(pair.driver.base_helix_angle)
    slow = speed * pair.driver.teeth / pair.driven.teeth
    return FlankSpeeds(place, one, other, np.asarray(relative), speed * one, slow * other)


def contact_ratios(pair: GearPair) -> tuple[float, float]:
    """epsilon_1 and epsilon_2: contact ratio from the pitch point to the tips of driver and driven gear."""
    return pair.x_end / pair.base_pitch, -pair.x_start / pair.base_pitch
