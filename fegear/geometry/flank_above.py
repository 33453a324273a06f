"""What a fillet is fitted to, and what comes of it: the flank above, root circle and middle of the tooth space.

Of teeth with two different flanks each fillet has a flank of its own; both meet at one root circle, and neither need
end in the middle of the space that the tool makes. Lengths are in modules, in the section across the axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.curves import Curve, Involute


@dataclass(frozen=True, slots=True)
class FlankAbove:
    """What a fillet is fitted to: the involute above it, the root circle and the middle of the tooth space.

    Parameters
    ----------
    base_radius, base_half_angle : float
        Of the involute [modules, rad].
    side : {1, -1}
        1 of an external tooth, -1 of an internal one.
    half_pitch : float
        pi / z [rad].
    root_radius, form_radius : float
        As the tool makes them [modules].
    bottom : float, optional
        Radius of the root circle at which the other fillet of the tooth space ends, if that is another curve [modules].
    beyond : float or None
        Angle beyond the middle of the tooth space at which that fillet ends, negative before it [rad]; None where it
        follows this one.
    """

    base_radius: float
    base_half_angle: float
    side: int
    half_pitch: float
    root_radius: float
    form_radius: float
    bottom: float | None = None
    beyond: float | None = 0.0

    def roll(self, radius: float) -> float:
        """Roll angle at a radius outside the base circle [rad]."""
        return (
            self.side
            * math.sqrt(max((radius - self.base_radius) * (radius + self.base_radius), 0.0))
            / self.base_radius
        )

    def point(self, roll: float) -> Array:
        """Of the involute, shape (2,)."""
        return Involute(self.base_radius, self.base_half_angle, 0.0, 1.0).points(roll)

    def normal(self, roll: float) -> Array:
        """Out of the material, shape (2,)."""
        return Involute(self.base_radius, self.base_half_angle, 0.0, 1.0).normals(roll)

    def tangent(self, roll: float) -> Array:
        """Toward the tip, shape (2,)."""
        n = self.normal(roll)
        return self.side * np.array([-n[1], n[0]])

    def in_space(self, points: Array) -> Array:
        """Points beside and along the centre line of the tooth space, shape (2, ...), and back."""
        s, c = math.sin(self.half_pitch), math.cos(self.half_pitch)
        return np.stack([points[1] * s - points[0] * c, points[1] * c + points[0] * s])

    @property
    def last(self) -> float:
        """Largest angle from the centre line at which a fillet may begin [rad]."""
        return 2.0 * self.half_pitch if self.beyond is None else self.half_pitch + self.beyond

    def at_the_bottom(self, root: float, key: str, reach: float) -> float:
        """Root radius of the other fillet of the tooth space, or of this one where it has none of its own [modules].

        Raises
        ------
        GeometryError
            If they differ by more than a reach [modules].
        """
        if self.bottom is None:
            return root
        if abs(root - self.bottom) > reach:
            raise GeometryError(
                key, f"root diameter {2.0 * root:.6g} modules",
                f"must be that of the other fillet of the tooth space, {2.0 * self.bottom:.6g} modules",
                "start both fillets at one root circle",
            )  # fmt: skip
        return self.bottom

    def start(self, key: str, form_radius: float | None) -> float:
        """Roll angle where the flank begins at a form circle, by default that of the tool.

        Raises
        ------
        GeometryError
            If no involute is there.
        """
        radius = self.form_radius if form_radius is None else form_radius
        if not radius >= self.base_radius:
            raise GeometryError(
                key, f"{radius:.6g} modules", f"must be at least the base radius of {self.base_radius:.6g} modules",
                "start the flank outside the base circle",
            )  # fmt: skip
        return self.roll(radius)


class Foot(NamedTuple):
    """A fillet below a flank.

    Attributes
    ----------
    fillet : Curve
    roll : float
        Roll angle where the involute begins [rad].
    root_radius : float
        [modules].
    root_land_half_angle : float
        Angle of the root land that is left up to the middle of the tooth space, negative beyond it [rad].
    corner : bool
        Whether the flank begins in a corner, as with undercut.
    """

    fillet: Curve
    roll: float
    root_radius: float
    root_land_half_angle: float
    corner: bool = False
