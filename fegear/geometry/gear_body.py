"""The body under the teeth of a gear: a rim as wide as the face, and web and hub that fill a part of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from fegear.base.errors import GeometryError

#: Outer and inner radius, and the two ends along the axis.
Cylinder = tuple[float, float, float, float]
#: Thinnest web, hub and ring between two circles [modules]; thinner ones are shells, which want other elements.
_THINNEST = 0.2
_ROUND_OFF = 1e-9


@dataclass(frozen=True, slots=True)
class GearBody:
    """Rim, web and hub, all of one length unit; places along the face from its middle.

    Parameters
    ----------
    rim_radius : float
        Inside of the rim, where the web begins.
    hub_radius : float
        Outside of the hub, where the web ends; the bore's radius where there is no hub.
    web, hub : (float, float)
        The parts of the face that they fill. The bore is held over the hub.
    """

    rim_radius: float
    hub_radius: float
    web: tuple[float, float]
    hub: tuple[float, float]

    @property
    def spans(self) -> tuple[tuple[float, float], ...]:
        """Parts of the face that rim (all of it), web and hub fill."""
        return (-math.inf, math.inf), self.web, self.hub

    @property
    def ends(self) -> tuple[float, ...]:
        """Places along the face where web and hub end."""
        return *self.web, *self.hub

    @property
    def even(self) -> bool:
        """Whether it is alike to both sides of the middle of the face."""
        return all(abs(low + high) <= _ROUND_OFF * (high - low) for low, high in (self.web, self.hub))

    def is_disc(self, width: float) -> bool:
        """Whether web and hub fill a face, so that the gear is a disc."""
        return all(high - low >= (1.0 - _ROUND_OFF) * width for low, high in (self.web, self.hub))

    def scaled(self, factor: float) -> GearBody:
        """The same in other units."""
        (a, b), (c, d) = self.web, self.hub
        return GearBody(
            self.rim_radius * factor, self.hub_radius * factor, (a * factor, b * factor), (c * factor, d * factor)
        )

    def cylinders(self, outer_radius: float, bore_radius: float, width: float) -> tuple[Cylinder, ...]:
        """The hollow cylinders that the gear consists of, its teeth as a ring up to some radius."""
        face = (-0.5 * width, 0.5 * width)
        return (
            (outer_radius, self.rim_radius, *face), (self.rim_radius, self.hub_radius, *self.web),
            (self.hub_radius, bore_radius, *self.hub),
        )  # fmt: skip

    def check(self, module: float, width: float, bore_radius: float, root_radius: float) -> None:
        """Refuse bodies that do not fit their gear; all lengths in the body's unit [m].

        Raises
        ------
        GeometryError
        """
        near = _ROUND_OFF * width
        low, high = self.web
        if not -0.5 * width - near <= low < high <= 0.5 * width + near:
            raise GeometryError(
                "body.web", f"{low * 1e3:.6g} to {high * 1e3:.6g} mm",
                f"must lie on the face, from {-500 * width:.6g} to {500 * width:.6g} mm",
                "reduce web_thickness or web_offset",
            )  # fmt: skip
        if high - low < min(_THINNEST * module, width) - near:
            raise GeometryError(
                "body.web_thickness", f"{(high - low) * 1e3:.6g} mm",
                f"must be at least {_THINNEST * module * 1e3:.6g} mm ({_THINNEST:g} modules)",
                "a thinner web is a shell, which is not computed",
            )  # fmt: skip
        start, end = self.hub
        if not -0.5 * width - near <= start <= low + near or not high - near <= end <= 0.5 * width + near:
            raise GeometryError(
                "body.hub", f"{start * 1e3:.6g} to {end * 1e3:.6g} mm",
                f"must reach over the web, from {low * 1e3:.6g} to {high * 1e3:.6g} mm, and not beyond the face",
                "change hub_width or hub_offset",
            )  # fmt: skip
        thin = _THINNEST * module
        if not thin - _ROUND_OFF * root_radius <= root_radius - self.rim_radius <= root_radius - bore_radius - thin:
            raise GeometryError(
                "body.rim_thickness", f"{(root_radius - self.rim_radius) * 1e3:.6g} mm",
                f"must be at least {thin * 1e3:.6g} mm ({_THINNEST:g} modules) and leave as much of the "
                f"{(root_radius - bore_radius) * 1e3:.6g} mm between bore and root circle for a web",
            )  # fmt: skip
        hubless = abs(self.hub_radius - bore_radius) <= _ROUND_OFF * bore_radius
        if not (hubless or bore_radius + thin <= self.hub_radius) or not self.hub_radius <= self.rim_radius - thin:
            raise GeometryError(
                "body.hub_radius", f"{self.hub_radius * 1e3:.6g} mm",
                f"must lie between the bore, {bore_radius * 1e3:.6g} mm, and the inside of the rim, "
                f"{self.rim_radius * 1e3:.6g} mm, {thin * 1e3:.6g} mm off both ({_THINNEST:g} modules)",
            )  # fmt: skip


def moments(cylinders: Sequence[Cylinder], density: float) -> tuple[float, float, float]:
    """Mass [kg], inertia about the axis and about a line across it at z = 0 [kg m^2] of hollow cylinders [m]."""
    mass = spin = tilt = 0.0
    for outer, inner, low, high in cylinders:
        length, squares = high - low, outer**2 + inner**2
        own = math.pi * density * length * (outer**2 - inner**2)
        mass += own
        spin += own * squares / 2.0
        tilt += own * ((3.0 * squares + length**2) / 12.0 + (0.5 * (low + high)) ** 2)
    return mass, spin, tilt
