"""Where a load on the involute points: the line of action against the tooth's centre line.

The tooth stands upright: gear centre at the origin, centre line along +y, the loaded flank at x > 0; lengths in
modules. A load normal to the flank at roll angle t makes the load angle phi = t - psi_b with the x axis (Cornell's
epsilon - beta; psi_b is half the tooth's angle on the base circle) and pushes the tooth toward -x and, for phi > 0,
toward the gear's centre.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.geometry import Tooth


@dataclass(frozen=True, slots=True)
class LoadLine:
    """Loads normal to the flank of a tooth; arrays of one shape (N,) each, lengths in modules.

    Parameters
    ----------
    radius : ndarray
        Radius of the load points.
    roll : ndarray
        Roll angles t [rad].
    angle : ndarray
        Load angle phi = t - psi_b [rad]: of the load against the perpendicular to the tooth's centre line.
    x, y : ndarray
        Load point: half the tooth's thickness there and its height above the gear's centre.
    apex : ndarray
        Height above the gear's centre at which the line of action crosses the tooth's centre line.
    """

    radius: Array
    roll: Array
    angle: Array
    x: Array
    y: Array
    apex: Array

    @property
    def depth(self) -> Array:
        """Distance along the line of action from the load point to the tooth's centre line [modules]."""
        return self.x / np.cos(self.angle)


def refuse_helix(tooth: Tooth) -> None:
    """Refuse a helical tooth, which no formula for plane teeth knows.

    Raises
    ------
    RangeError
    """
    if tooth.helix_angle != 0.0:
        angle = f"{math.degrees(tooth.helix_angle):.6g} deg"
        raise RangeError("helix angle", angle, "must be zero: this formula is for spur teeth; ISO 6336's rating is not")


def load_line(tooth: Tooth, radius: ArrayLike) -> LoadLine:
    """Geometry of loads at `radius` [modules] on the involute of a spur tooth.

    Raises
    ------
    RangeError
        If a radius lies off the involute (below the form circle or above its end at the tip), or the tooth is helical.
    """
    refuse_helix(tooth)
    r = np.atleast_1d(np.asarray(radius, dtype=float))
    low, high = tooth.form_radius, tooth.involute_tip_radius
    slack = 1e-9 * high  # radii often come from a path of contact, computed with other round-off
    bad = ~((r >= low - slack) & (r <= high + slack))
    if bad.any():
        raise RangeError(
            "load radius",
            f"{r[bad].flat[0]:.6g} modules",
            f"is not on the involute, which runs from {low:.6g} to {high:.6g} modules",
        )
    roll = tooth.roll(np.clip(r, max(low, tooth.base_radius), high))
    angle = roll - tooth.base_half_angle
    half = tooth.half_thickness_angle(np.clip(r, max(low, tooth.base_radius), high))
    # the line of action touches the base circle, so it crosses the centre line at r_b / cos(phi)
    return LoadLine(r, roll, angle, r * np.sin(half), r * np.cos(half), tooth.base_radius / np.cos(angle))
