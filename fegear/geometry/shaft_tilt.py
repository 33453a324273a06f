"""Shafts that are not parallel: what their deviations do to the gap between flanks (ISO/TR 10064-3)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.geometry.pair import GearPair

#: Largest deviation for which the gap is linear in it [rad].
LARGEST_TILT = math.radians(0.5)


@dataclass(frozen=True, slots=True)
class ShaftTilt:
    """Deviation of a pair's axes from parallel, of both gears together, positive where it opens the gap toward end II.

    Parameters
    ----------
    in_plane : float
        f_Sigma_delta per length: in the plane of the axes, which move apart toward end II [rad]. In an internal pair
        that closes the gap.
    out_of_plane : float
        f_Sigma_beta per length: across that plane, the driven gear moving ahead of the driver toward end II [rad].

    Raises
    ------
    RangeError
        If it is no small error.
    """

    in_plane: float = 0.0
    out_of_plane: float = 0.0

    def __post_init__(self) -> None:
        """Refuse crossed axes."""
        for key in ("in_plane", "out_of_plane"):
            value = getattr(self, key)
            if not abs(value) <= LARGEST_TILT:
                raise RangeError(
                    key, f"{math.degrees(value):.4g} deg", "is not small",
                    f"keep it within {math.degrees(LARGEST_TILT):g} deg",
                )  # fmt: skip

    def in_plane_of_action(self, pair: GearPair) -> float:
        """kappa [rad], turn about the normal of the plane of action: the in-plane part with sin(alpha_wt).

        The flank of a ring gear comes nearer as the axes move apart: that part counts negative.
        """
        angle = pair.working_pressure_angle
        return pair.side * self.in_plane * math.sin(angle) + self.out_of_plane * math.cos(angle)

    def gap(self, pair: GearPair, x: ArrayLike, z: ArrayLike) -> Array:
        """Gap at places in the plane of action, along the transverse line of action [m].

        A turn theta of a gear moves its flank by theta x r, and the gap is what of that lies along the flank's normal
        (u + tan(beta_b) e_z), u along the line of action: kappa (z - x tan(beta_b)), and the same everywhere, which
        belongs to where the shafts are held and is left out. Along a contact line a helix makes it 1/cos(beta_b)^2
        times as steep as the shafts, for the normal feels the turn along the axis, too.

        Parameters
        ----------
        pair : GearPair
        x, z : array_like
            From the pitch point along the line of action, from the middle of the face [m].
        """
        lean = pair.driver.flank_twist * pair.driver.base_radius
        along = np.asarray(z, dtype=float) - lean * np.asarray(x, dtype=float)
        return np.asarray(self.in_plane_of_action(pair) * along)


#: Parallel axes.
PARALLEL = ShaftTilt()
