"""What carries the rim of a gear: pins or rollers that are evenly spaced on its circle, a spline, a web, or its bore.

The circle is the outer one of a ring gear and the bore of an external gear.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

from fegear.base.errors import GeometryError

Kind = Literal["splined", "pins", "bearing", "free_arc", "web"]

#: Pins that a ring can have at least: one lets it turn about itself. Rollers, which let it turn, hold it by three.
_FEWEST_PINS, _FEWEST_ROLLERS = 2, 3
#: Narrowest pin [modules]: a narrower one is a point, into which a held rim gives way without limit.
_NARROWEST = 0.02
#: Thinnest web [modules] as deep, and as a share of the face.
_SHORTEST_WEB, _THINNEST_WEB = 0.05, 1e-3


@dataclass(frozen=True, slots=True)
class RimSupport:
    """A rim that is not held all round; without one the whole circle is held.

    Parameters
    ----------
    pins : int
        Pins or rollers, evenly spaced on the circle; 0 for a spline, whose force and torque are spread evenly over it.
    width : float
        Of the part of the circle that each pin holds on average, along the circle; in the unit of the gear.
    angle : float
        Of the first pin from the centre line of tooth 0, positive the way that the loaded flank faces [rad].
    rollers : bool
        Whether these hold the rim along the radius only, as a bearing does; torque is then spread over the circle.
    free_teeth : int
        The bore is free below so many teeth, an odd number with the loaded tooth in the middle, and held elsewhere.
    web : float
        Thickness over the face width of a web inside the rim, down to `inner_radius`, where it is held.
    inner_radius : float
        In the unit of the gear.
    """

    pins: int = 0
    width: float = 0.0
    angle: float = 0.0
    rollers: bool = False
    free_teeth: int = 0
    web: float = 0.0
    inner_radius: float = 0.0

    @property
    def kind(self) -> Kind:
        """Which of the supports it is."""
        if self.free_teeth:
            return "free_arc"
        if self.web:
            return "web"
        if not self.pins:
            return "splined"
        return "bearing" if self.rollers else "pins"

    def scaled(self, factor: float) -> RimSupport:
        """The same in other units."""
        return replace(self, width=self.width * factor, inner_radius=self.inner_radius * factor)

    def different_teeth(self, teeth: int) -> int:
        """How many teeth in a row stand differently to the pins before the first of them comes again."""
        return teeth // math.gcd(teeth, self.pins) if self.pins else 1

    def check(self, module: float, radius: float, teeth: int, *, internal: bool) -> None:
        """Refuse pins that hold no ring, or have no room on its circle [m], free arcs and webs that are none.

        Raises
        ------
        GeometryError
        """
        if self.kind == "free_arc":
            self._check_arc(teeth, internal=internal)
        elif self.kind == "web":
            self._check_web(module, radius, internal=internal)
        elif self.pins:
            self._check_pins(module, radius, teeth, internal=internal)

    def _check_pins(self, module: float, radius: float, teeth: int, *, internal: bool) -> None:
        if self.rollers and internal:
            raise GeometryError("rim_support.kind", '"bearing"', "applies only to external gears", 'set kind = "pins"')
        fewest = _FEWEST_ROLLERS if self.rollers else _FEWEST_PINS
        held = "fixed over the full circumference" if internal else "fixed at the bore"
        if not fewest <= self.pins <= teeth:
            raise GeometryError(
                "rim_support.pins", self.pins, f"must be between {fewest} and the number of teeth, {teeth}",
                f"remove rim_support for a rim {held}",
            )  # fmt: skip
        least, room = _NARROWEST * module, 2.0 * math.pi * radius / self.pins
        if not least <= self.width <= room:
            circle = "outer circle" if internal else "bore"
            raise GeometryError(
                "rim_support.width", f"{self.width * 1e3:.6g} mm",
                f"must be between {least * 1e3:.6g} mm ({_NARROWEST:g} modules) and {room * 1e3:.6g} mm (pin spacing "
                f"on the {circle})", "change the width or the number of pins",
            )  # fmt: skip
        if not math.isfinite(self.angle):
            raise GeometryError("rim_support.angle", self.angle, "must be finite")

    def _check_arc(self, teeth: int, *, internal: bool) -> None:
        if internal:
            raise GeometryError("rim_support.kind", '"free_arc"', "applies only to external gears", 'set kind = "pins"')
        if not (self.free_teeth % 2 and 1 <= self.free_teeth < teeth):
            raise GeometryError(
                "rim_support.teeth", self.free_teeth,
                f"must be an odd number between 1 and {teeth - 1} (the loaded tooth is in the middle, one tooth at "
                "least has a fixed bore)", "specify the number of teeth above the free arc",
            )  # fmt: skip

    def _check_web(self, module: float, radius: float, *, internal: bool) -> None:
        if internal:
            raise GeometryError("rim_support.kind", '"web"', "applies only to external gears", 'set kind = "pins"')
        if not _THINNEST_WEB <= self.web <= 1.0 + 1e-9:
            raise GeometryError(
                "rim_support.web_thickness", f"{self.web:.4g} of the face width",
                f"must be between {_THINNEST_WEB:g} of the face width and the face width",
                "remove rim_support for a solid disc fixed at bore_radius",
            )  # fmt: skip
        most = radius - _SHORTEST_WEB * module
        if not 0.0 < self.inner_radius <= most:
            raise GeometryError(
                "rim_support.web_radius", f"{self.inner_radius * 1e3:.6g} mm",
                f"must be between 0 and {most * 1e3:.6g} mm ({_SHORTEST_WEB:g} modules inside bore_radius, the inner "
                "radius of the rim)", "specify the outer radius of the hub",
            )  # fmt: skip
