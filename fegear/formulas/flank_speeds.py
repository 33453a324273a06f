"""How fast flanks move through their contact: rolling of both, and sliding on each other, at places on the path."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.shown import shown, shows
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike

    from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class FlankSpeeds:
    """Flanks at places on the path of contact, in the section across the axes; arrays of one shape.

    Parameters
    ----------
    x : ndarray
        Place on the line of action from the pitch point, toward the driver's tip [m].
    radius_driver, radius_driven : ndarray
        Transverse.
    relative_radius : ndarray
        rho_n: the transverse one over cos(beta_b).
    rolling_driver, rolling_driven : ndarray
        Tangential speeds.
    """

    x: Array
    radius_driver: Array = shown("mm", "radius of curvature of the driver flank")
    radius_driven: Array = shown("mm", "radius of curvature of the driven flank")
    relative_radius: Array = shown("mm", "relative radius of curvature in the normal section")
    rolling_driver: Array = shown("m/s", "rolling velocity of the driver flank")
    rolling_driven: Array = shown("m/s", "rolling velocity of the driven flank")

    @property
    @shows("m/s", "sliding velocity", name="sliding_velocity")
    def sliding(self) -> Array:
        """Speed of the driver's flank less that of the driven one [m/s]; negative before the pitch point."""
        return np.asarray(self.rolling_driver - self.rolling_driven)

    @property
    @shows("m/s", "sum of the rolling velocities", name="sum_velocity")
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
            "must be greater than zero: no film and no frictional heat at zero speed",
        )
    place = np.asarray(x, dtype=float)
    radii = (np.asarray(pair.flank_curvature_radius(place, member)) for member in MEMBERS)
    sides = pair.driver.tooth.side, pair.driven.tooth.side
    turns = speed, speed * pair.driver.teeth / pair.driven.teeth
    return _moving(place, radii, sides, turns, math.cos(pair.driver.base_helix_angle))


def speeds_on_line(x: ArrayLike, radii: tuple[float, float], pressure_angle: float, speed: float) -> FlankSpeeds:
    """As `flank_speeds`, of spur gears of which nothing but their base circles is known.

    Parameters
    ----------
    x : array_like
        Places [m].
    radii : (float, float)
        Base radii of driver and driven gear [m]; negative of a ring gear, whose flanks are hollow.
    pressure_angle : float
        Working pressure angle [rad].
    speed : float
        Of the contact along the line of action, the speed of the base circles [m/s].
    """
    place, tangent = np.asarray(x, dtype=float), math.tan(pressure_angle)
    one, other = radii[0] * tangent + place, radii[1] * tangent - place
    sides = math.copysign(1.0, radii[0]), math.copysign(1.0, radii[1])
    return _moving(place, (one, other), sides, (speed / abs(radii[0]), speed / abs(radii[1])))


def _moving(
    place: Array,
    radii: Iterable[Array],
    sides: tuple[float, float],
    turns: tuple[float, float],
    lean: float = 1.0,
) -> FlankSpeeds:
    """Flanks of given radii of curvature on gears that turn [rad/s]; hollow ones have a negative radius and side.

    Beyond the base circle there is no flank; on it the radius is zero, and so is the flank's speed.
    """
    one, other = (side * np.maximum(side * rho, 0.0) for side, rho in zip(sides, radii, strict=True))
    relative = one * other / (one + other) / lean
    return FlankSpeeds(place, one, other, np.asarray(relative), turns[0] * np.abs(one), turns[1] * np.abs(other))
