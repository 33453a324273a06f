"""What carries the rim of a ring gear: pins that are evenly spaced on its outer circle, or a spline."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from fegear.base.errors import GeometryError

#: Pins that a ring can have at least: one alone lets it turn about itself.
_FEWEST_PINS = 2
#: Narrowest pin [modules]: a narrower one is a point, into which a held rim gives way without limit.
_NARROWEST = 0.02


@dataclass(frozen=True, slots=True)
class RimSupport:
    """A rim that is not held all round; without one the whole outer circle is held.

    Parameters
    ----------
    pins : int
        Evenly spaced on the outer circle; 0 for a spline, whose force and torque are spread evenly over it.
    width : float
        Of the part of the outer circle that each pin holds on average, along the circle; in the unit of the gear.
    angle : float
        Of the first pin from the centre line of tooth 0, positive the way that the loaded flank faces [rad].
    """

    pins: int = 0
    width: float = 0.0
    angle: float = 0.0

    def scaled(self, factor: float) -> RimSupport:
        """The same in other units."""
        return replace(self, width=self.width * factor)

    def different_teeth(self, teeth: int) -> int:
        """How many teeth in a row stand differently to the pins before the first of them comes again."""
        return teeth // math.gcd(teeth, self.pins) if self.pins else 1

    def check(self, module: float, outer_radius: float, teeth: int) -> None:
        """Refuse pins that hold no ring, or have no room on its outer circle [m].

        Raises
        ------
        GeometryError
        """
        if self.pins == 0:
            return
        if not _FEWEST_PINS <= self.pins <= teeth:
            raise GeometryError(
                "rim_support.pins", self.pins, f"must be between {_FEWEST_PINS} and the number of teeth, {teeth}",
                "remove rim_support for a rim fixed over the full circumference",
            )  # fmt: skip
        least, room = _NARROWEST * module, 2.0 * math.pi * outer_radius / self.pins
        if not least <= self.width <= room:
            raise GeometryError(
                "rim_support.width", f"{self.width * 1e3:.6g} mm",
                f"must be between {least * 1e3:.6g} mm ({_NARROWEST:g} modules) and {room * 1e3:.6g} mm (pin spacing "
                "on the outer circle)", "change the width or the number of pins",
            )  # fmt: skip
        if not math.isfinite(self.angle):
            raise GeometryError("rim_support.angle", self.angle, "must be finite")
