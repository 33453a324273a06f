"""The tooth of a rack: the basic rack profile itself, whose flanks are straight (ISO 53).

Of a helical rack the basic rack is the normal section, and a module the normal module. The transverse section, in which
the tooth is given here, is longer along the rack by 1 / cos(beta): heights stay, flanks stand under alpha_t, and arcs
become parts of ellipses.

It is what the teeth of gears cut to this profile tend to as their number grows: the base circle's radius is infinite,
and neither roll angles nor radii are left. A place on the flank is given by its height above the reference line, on
which tooth and space are equally wide. The frame is that of a gear's tooth: centre line along +y, the loaded flank on
the right; y is the height, and the next tooth clockwise stands one pitch to the right.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, cast

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.curves import Arc, Curve, Line, Stretched
from fegear.geometry.rack import BasicRack, transverse_angle
from fegear.geometry.tooth_side import outline_of

#: Root roundings and tip lands below this [modules] are none.
_SMALLEST = 1e-3
#: Largest helix angle [rad].
_STEEPEST = math.radians(60.0)
#: Pitch of a rack in its normal section [modules].
PITCH = math.pi


@dataclass(frozen=True)
class RackTooth:
    """A straight tooth of module 1, spur or helical, in its transverse section; see the module's text for its frame.

    Parameters
    ----------
    rack : BasicRack
        Basic rack tooth profile: addendum and dedendum of this tooth, and the radius of its root rounding.
    thickness_allowance : float
        A_s, reduction of the tooth's thickness on the reference line [modules]; made, as on gears, by cutting deeper
        by A_s / (2 tan alpha).
    tip_rounding, tip_chamfer : float
        Radius of the rounding between flank and tip, or height of a chamfer that takes as much off the tip's width
        [modules]; of the normal section, as the allowance.
    helix_angle : float
        beta [rad], 0 to 60 degrees.

    Raises
    ------
    GeometryError
        If the tooth cannot exist.
    """

    rack: BasicRack = field(default_factory=BasicRack)
    thickness_allowance: float = 0.0
    tip_rounding: float = 0.0
    tip_chamfer: float = 0.0
    helix_angle: float = 0.0

    #: Material lies on the left of its curves.
    side: ClassVar[int] = 1
    #: No tool cuts anything off a straight flank.
    undercut: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Refuse teeth that cannot exist."""
        for name in ("thickness_allowance", "tip_rounding", "tip_chamfer", "helix_angle"):
            if not math.isfinite(getattr(self, name)):
                raise GeometryError(name, getattr(self, name), "must be finite")
        self._check_sizes()
        if self.tip_rounding > 0.0 and self.tip_chamfer > 0.0:
            raise GeometryError("tip_chamfer", self.tip_chamfer, "contradicts a tip rounding",
                                "specify either the rounding or the chamfer")  # fmt: skip
        if self.rack.protuberance > 0.0:
            raise GeometryError("rack.protuberance", self.rack.protuberance, "is not available for racks",
                                "use a basic rack without protuberance")  # fmt: skip
        if self.rack.tip_radius < _SMALLEST:
            raise GeometryError("rack.tip_radius", self.rack.tip_radius,
                                "gives the rack a sharp corner at its root", "0.25 or 0.38 is usual")  # fmt: skip
        width = 2.0 * float(self.half_thickness(self.tip_height))
        if width < _SMALLEST:
            if self._pointed < _SMALLEST:
                most = 0.5 * math.pi - 2.0 * _SMALLEST * math.tan(self.rack.pressure_angle)
                raise GeometryError(
                    "thickness_allowance", f"{self.thickness_allowance:.6g} modules",
                    "gives rack teeth that are pointed below their reference line", f"use less than {most:.4f} modules",
                )  # fmt: skip
            raise GeometryError("rack.addendum", self.rack.addendum, "gives pointed rack teeth",
                                f"use less than {self._pointed:.4f} modules")  # fmt: skip
        if not (self.flank_end > self.form_height and self._land_start > 0.5 * _SMALLEST):
            key, size = ("tip_rounding", self.tip_rounding) if self.tip_rounding > 0.0 else (
                "tip_chamfer", self.tip_chamfer)  # fmt: skip
            if size == 0.0:
                raise GeometryError("rack.addendum", self.rack.addendum, "leaves no straight flank",
                                    "increase it, or reduce rack.tip_radius")  # fmt: skip
            raise GeometryError(key, f"{size:.6g} modules", "is too large for the tip of the rack", "reduce it")

    def _check_sizes(self) -> None:
        if not 0.0 <= self.helix_angle <= _STEEPEST:
            raise GeometryError("helix_angle", f"{math.degrees(self.helix_angle):.6g} deg",
                                f"must be between 0 and {math.degrees(_STEEPEST):g} deg")  # fmt: skip
        for name in ("tip_rounding", "tip_chamfer"):
            if getattr(self, name) < 0.0:
                raise GeometryError(name, getattr(self, name), "must not be negative")

    @property
    def pressure_angle(self) -> float:
        """alpha_t [rad]: of the flanks against the centre line, and of every contact with them."""
        return transverse_angle(self.rack.pressure_angle, self.helix_angle)

    @property
    def pitch(self) -> float:
        """p_t, of the transverse section [modules]."""
        return PITCH / self._cos_helix

    @property
    def _cos_helix(self) -> float:
        return math.cos(self.helix_angle)

    @property
    def generating_shift(self) -> float:
        """x_E [modules], by which the profile stands higher than the nominal one: less where it is made thinner."""
        return -self.thickness_allowance / (2.0 * math.tan(self.rack.pressure_angle))

    @property
    def _pointed(self) -> float:
        return math.pi / 4.0 / math.tan(self.rack.pressure_angle) + self.generating_shift

    @property
    def tip_height(self) -> float:
        """Height of the tip above the reference line [modules]."""
        return self.rack.addendum

    @property
    def root_height(self) -> float:
        """Height of the root above the reference line [modules], negative."""
        return self.generating_shift - self.rack.dedendum

    @cached_property
    def form_height(self) -> float:
        """Where the straight flank starts above the root rounding [modules]."""
        return self.root_height + self.rack.tip_radius * (1.0 - math.sin(self.rack.pressure_angle))

    @cached_property
    def flank_end(self) -> float:
        """Where it ends at the tip, or at its rounding or chamfer [modules]."""
        r = self.tip_rounding
        return self.tip_height - r * (1.0 - math.sin(self.rack.pressure_angle)) - self.tip_chamfer

    def half_thickness(self, height: ArrayLike) -> Array:
        """Half the tooth's thickness between its straight flanks at a height [modules]."""
        slope = math.tan(self.rack.pressure_angle)
        normal = math.pi / 4.0 + (self.generating_shift - np.asarray(height, dtype=float)) * slope
        return np.asarray(normal / self._cos_helix)

    @property
    def _land_start(self) -> float:
        """Half the width of the tip land [modules]."""
        if self.tip_rounding > 0.0:
            centre = self.tip_height - self.tip_rounding
            return float(self.half_thickness(centre)) - self._beside_flank(self.tip_rounding)
        return float(self.half_thickness(self.flank_end)) - self.tip_chamfer / self._cos_helix

    def _beside_flank(self, radius: float) -> float:
        """How far beside the flank the centre of a rounding lies that touches it, at its height [modules]."""
        return radius / math.cos(self.rack.pressure_angle) / self._cos_helix

    def _rounding(self, centre: tuple[float, float], radius: float, start: float, end: float) -> Arc | Stretched:
        """A rounding of the normal section about a centre of the transverse one, its angles those of the normal."""
        arc = Arc((centre[0] * self._cos_helix, centre[1]), radius, start, end)
        return Stretched(arc, 1.0 / self._cos_helix) if self.helix_angle else arc

    # ---- curves, from the middle of the tooth space to the tooth's centre line ------------------------------------
    @property
    def back(self) -> RackTooth:
        """The tooth itself: its flanks are equal."""
        return self

    @cached_property
    def fillet(self) -> Arc | Stretched:
        """The root rounding."""
        radius, height = self.rack.tip_radius, self.root_height + self.rack.tip_radius
        beside = float(self.half_thickness(height)) + self._beside_flank(radius)
        return self._rounding((beside, height), -radius, math.pi, 1.5 * math.pi - self.rack.pressure_angle)

    @cached_property
    def involute(self) -> Line:
        """The usable flank: straight, an involute of an infinite base circle."""
        low, high = self.form_height, self.flank_end
        return Line((float(self.half_thickness(low)), low), (float(self.half_thickness(high)), high))

    @cached_property
    def tip_edge(self) -> Arc | Line | None:
        """Rounding or chamfer."""
        if self.tip_rounding > 0.0:
            centre = (self._land_start, self.tip_height - self.tip_rounding)
            # that of a helical rack is `Stretched`, which meshes and drawings take as any curve
            return cast("Arc", self._rounding(centre, self.tip_rounding, 0.5 * math.pi - self.rack.pressure_angle, 0.0))
        if self.tip_chamfer > 0.0:
            return Line(self.involute.b, (self._land_start, self.tip_height))
        return None

    @property
    def root_land_length(self) -> float:
        """Half the width of the root land [modules]."""
        return max(self.rack.tip_centre_offset, 0.0) / self._cos_helix

    @property
    def space_middle(self) -> tuple[float, float]:
        """Bottom of the middle of the tooth space on the right [modules]."""
        return 0.5 * self.pitch, self.root_height

    @cached_property
    def root_land(self) -> Line | None:
        """From the middle of the tooth space to the root rounding."""
        if self.root_land_length < 1e-12:
            return None
        return Line(self.space_middle, (self.fillet.centre[0], self.root_height))

    @cached_property
    def tip_land(self) -> Line:
        """Half of the tip."""
        return Line((self._land_start, self.tip_height), (0.0, self.tip_height))

    @property
    def outline(self) -> dict[str, Curve]:
        """Half of the outline from the middle of the tooth space to the middle of the tip land, by name."""
        return outline_of(self)
