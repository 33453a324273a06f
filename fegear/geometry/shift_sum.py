"""The sum of two profile shifts from a centre distance, how it is shared, and what a backlash takes (ISO 21771, 5.4).

Lengths are in normal modules. Tooth numbers of internal gears count negative in the equations, so that one serves all.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from fegear.base.errors import GeometryError
from fegear.geometry.involute import inv, pressure_angle_of_inv
from fegear.geometry.shift_of_thickness import ToothNumbers

#: Steps of a search over shares, and how far a share may be from equal ones.
_STEPS, _FARTHEST = 20, 1.5
_HALVINGS = 45


@dataclass(frozen=True, slots=True)
class MeshNumbers:
    """What is known of two gears in mesh before their teeth have a thickness.

    Parameters
    ----------
    driver, driven : ToothNumbers
        Of one module, pressure angle and helix angle.
    """

    driver: ToothNumbers
    driven: ToothNumbers

    @property
    def teeth(self) -> int:
        """z_1 + z_2, internal ones negative."""
        return self.driver.side * self.driver.teeth + self.driven.side * self.driven.teeth

    @property
    def side(self) -> int:
        """1 of an external pair, -1 of an internal one."""
        return self.driver.side * self.driven.side

    @property
    def base_radii(self) -> float:
        """Sum of the base radii, or their difference in an internal pair [modules]."""
        return abs(self.driver.base_radius + self.side * self.driven.base_radius)

    def distance(self, shifts: float) -> float:
        """Centre distance without backlash of a sum of profile shifts [modules]."""
        working = self._inv(shifts)
        if working <= 0.0:
            raise GeometryError("profile_shift", f"sum {shifts:.6g}", "gives no working pressure angle")
        return self.base_radii / math.cos(float(pressure_angle_of_inv(working)))

    def working_angle(self, distance: float) -> float:
        """alpha_wt [rad] at a centre distance [modules]."""
        if not distance >= self.base_radii:
            raise GeometryError(
                "centre_distance", f"{distance:.6g}", f"must be at least {self.base_radii:.6g} modules (base circles)"
            )
        return math.acos(self.base_radii / distance)

    def shifts(self, distance: float) -> float:
        """Sum of the profile shifts without backlash at a centre distance [modules]."""
        return self._shifts_of_inv(float(inv(self.working_angle(distance))))

    def shifts_with_backlash(self, distance: float, normal_backlash: float) -> float:
        """Sum of the generating profile shifts that gives a backlash normal to the flanks [modules]."""
        turn = normal_backlash / (2.0 * self.side * self.base_radii * self.driver.base_helix_cosine)
        return self._shifts_of_inv(float(inv(self.working_angle(distance))) - turn)

    def normal_backlash(self, distance: float, circumferential: float) -> float:
        """j_bn of a backlash on the working pitch circle [modules]."""
        return circumferential * math.cos(self.working_angle(distance)) * self.driver.base_helix_cosine

    def _inv(self, shifts: float) -> float:
        first = self.driver
        return float(inv(first.transverse_pressure_angle)) + 2.0 * shifts * self._tangent / self.teeth

    def _shifts_of_inv(self, working: float) -> float:
        first = self.driver
        return (working - float(inv(first.transverse_pressure_angle))) * self.teeth / (2.0 * self._tangent)

    @property
    def _tangent(self) -> float:
        return math.tan(self.driver.normal_pressure_angle)

    def end_sliding(self, distance: float, tips: tuple[float, float]) -> tuple[float, float]:
        """Specific sliding at the ends of the path between both tips: driver at A, driven gear at E; external pairs.

        Parameters
        ----------
        distance : float
        tips : tuple of float
            Tip radii [modules].

        Returns
        -------
        tuple of float
            Minus infinity where the path reaches a base circle, or beyond.
        """
        whole = distance * math.sin(self.working_angle(distance))
        found = []
        for own, mate, tip in ((self.driver, self.driven, tips[1]), (self.driven, self.driver, tips[0])):
            far = math.sqrt(max(tip**2 - mate.base_radius**2, 0.0))
            near = whole - far
            found.append(1.0 - own.teeth * far / (mate.teeth * near) if near > 0.0 else -math.inf)
        return found[0], found[1]


def shared_evenly(difference: Callable[[float], float | None], total: float) -> float | None:
    """The driver's part of a sum of profile shifts at which a difference of both gears vanishes, nearest to one half.

    Parameters
    ----------
    difference : callable
        ``difference(x_1)``; None where a gear cannot be.
    total : float

    Returns
    -------
    float or None
        None where no change of sign is within reach.
    """
    middle = 0.5 * total
    places = [middle + _FARTHEST * step / _STEPS for step in range(-_STEPS, _STEPS + 1)]
    values = [difference(place) for place in places]
    brackets = [
        (low, high, one)
        for (low, one), (high, other) in pairwise(zip(places, values, strict=True))
        if one is not None and other is not None and (one <= 0.0) != (other <= 0.0)
    ]
    if not brackets:
        return None
    low, high, below = min(brackets, key=lambda ends: abs(ends[0] + ends[1] - total))
    for _ in range(_HALVINGS):
        at = 0.5 * (low + high)
        here = difference(at)
        if here is None:
            return None
        low, high = (at, high) if (here <= 0.0) == (below <= 0.0) else (low, at)
    return 0.5 * (low + high)
