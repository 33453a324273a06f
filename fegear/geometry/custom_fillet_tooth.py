"""A tooth whose flanks a tool has generated and whose fillets are another curve than the tool's.

Powder metal, moulded, forged and wire-cut teeth, fillets that were designed or measured: below the form circle their
outline is given, above it the involute is that of a rack or pinion-type cutter. It is an `InvoluteTooth`, for its two
sides are alike, but neither a `Tooth` nor an `InternalTooth`: what needs a tool asks for these.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from fegear.base.errors import GeometryError
from fegear.geometry.curves import Curve
from fegear.geometry.external_tooth import THINNEST_NECK, Tooth
from fegear.geometry.fillet_shapes import FilletShape, FlankAbove, Foot
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.involute_side import SideOfTooth
from fegear.geometry.involute_tooth import InvoluteTooth

#: Points of a fillet that are looked at.
_LOOKED_AT = 513
#: Smallest radius of curvature of a fillet [modules]: stress of a sharper one has no bound.
SHARPEST_FILLET = 5e-3
#: How much a fillet may come back toward the root circle [modules].
_COMES_BACK = 1e-6


@dataclass(frozen=True)
class CustomFilletTooth(SideOfTooth, InvoluteTooth):
    """An external tooth with fillets of its own.

    Parameters
    ----------
    generated : Tooth or InternalTooth
        The tooth as its tool makes it.
    shape : FilletShape
        The right fillet; the left one is its mirror image.

    Raises
    ------
    GeometryError
        If the fillet does not join root circle and flank, or leaves no tooth.
    """

    shaped: ClassVar[bool] = True

    generated: Tooth | InternalTooth
    shape: FilletShape

    def __post_init__(self) -> None:
        """Take over what the tool decides, and refuse fillets of no tooth."""
        self.take_over(self.generated)
        self._check_form()
        self._check_fillet()

    @cached_property
    def _foot(self) -> Foot:
        made = self.generated
        return self.shape.below(
            FlankAbove(
                made.base_radius, made.base_half_angle, self.side, math.pi / self.teeth, made.root_radius,
                made.form_radius,
            )
        )  # fmt: skip

    def _check_form(self) -> None:
        form, end = self.form_radius, self.involute_tip_radius
        if not self.side * (end - form) > 0.0:
            raise GeometryError(
                "fillet.form_diameter", f"{2.0 * form:.6g} modules", "leaves no involute: the flank ends at "
                f"{2.0 * end:.6g} modules", "choose a form diameter nearer to the root circle",
            )  # fmt: skip

    def _check_fillet(self) -> None:
        fillet = self.fillet
        u = np.linspace(fillet.start, fillet.end, _LOOKED_AT)
        x, y = fillet.points(u)
        radius, angle = self.side * np.hypot(x, y), np.arctan2(x, y)
        back = float((np.maximum.accumulate(radius) - radius).max())
        if back > _COMES_BACK:
            raise GeometryError(
                "fillet", f"{back:.3g} modules", "is how far the fillet comes back toward the root circle",
                "specify a curve that rises from root circle to flank, or set scatter",
            )  # fmt: skip
        if not (angle.max() <= math.pi / self.teeth + 1e-9):
            beyond = (angle.max() - math.pi / self.teeth) * abs(radius[0])
            raise GeometryError(
                "fillet", f"{beyond:.3g} modules", "is how far the fillet extends beyond the middle of the tooth space",
                "specify a narrower fillet",
            )  # fmt: skip
        neck = float(x.min())
        if neck < THINNEST_NECK:
            raise GeometryError(
                "fillet", f"{2.0 * neck:.3g} modules",
                f"is the narrowest part of the tooth, which must be at least {2.0 * THINNEST_NECK:g} modules",
                "specify a fillet that cuts less into the tooth",
            )  # fmt: skip
        sharpest = 1.0 / float(np.abs(fillet.curvatures(u)).max())
        if sharpest < SHARPEST_FILLET:
            raise GeometryError(
                "fillet", f"{sharpest:.3g} modules",
                f"is the smallest radius of curvature, which must be at least {SHARPEST_FILLET:g} modules",
                "set scatter if the points scatter",
            )  # fmt: skip

    # ---- what the tool decides -------------------------------------------------------------------------------------
    @property
    def normal_pressure_angle(self) -> float:
        """alpha_n [rad]."""
        return self.generated.normal_pressure_angle

    @property
    def pressure_angle(self) -> float:
        """alpha_t [rad]."""
        return self.generated.pressure_angle

    @property
    def dedendum(self) -> float:
        """Depth of the root circle below the reference circle that the profile shift moves [modules]."""
        if self.internal:
            return self.root_radius - self.pitch_radius + self.profile_shift
        return self.pitch_radius + self.generating_shift - self.root_radius

    # ---- what the fillet decides -----------------------------------------------------------------------------------
    @property
    def root_radius(self) -> float:
        """r_f [modules], where the fillet starts."""
        return self._foot.root_radius

    @property
    def root_land_half_angle(self) -> float:
        """Half the angle of the root land between the two fillets of one tooth space [rad]."""
        return self._foot.root_land_half_angle

    @property
    def form_roll(self) -> float:
        """Roll angle of the involute where the fillet ends [rad]."""
        return self._foot.roll

    @property
    def undercut(self) -> bool:
        """Whether the involute starts in a corner."""
        return self._foot.corner

    @property
    def fillet(self) -> Curve:
        """The right fillet, from the root circle to the involute."""
        return self._foot.fillet

    @property
    def smallest_radius(self) -> float:
        """Smallest radius of curvature of the fillet [modules]."""
        u = np.linspace(self.fillet.start, self.fillet.end, _LOOKED_AT)
        return 1.0 / float(np.abs(self.fillet.curvatures(u)).max())

    @property
    def swings(self) -> int:
        """How often the fillet's curvature has a largest value between its ends: points that scatter have many."""
        u = np.linspace(self.fillet.start, self.fillet.end, _LOOKED_AT)
        k = np.abs(self.fillet.curvatures(u))
        inner = k[1:-1]
        marked = (inner > k[:-2]) & (inner > k[2:]) & (inner > 1.02 * np.minimum(k[0], k[-1]))
        return int(np.count_nonzero(marked))


class ShapedRingTooth(CustomFilletTooth):
    """The same of an internal gear."""

    side: ClassVar[int] = -1


def with_fillet(tooth: Tooth | InternalTooth, shape: FilletShape) -> CustomFilletTooth:
    """A tooth with another fillet than its tool's."""
    return ShapedRingTooth(tooth, shape) if isinstance(tooth, InternalTooth) else CustomFilletTooth(tooth, shape)


def with_tip(tooth: InvoluteTooth, radius: float) -> InvoluteTooth:
    """An external tooth that ends at another tip circle [modules]; flanks and fillets stay."""
    if isinstance(tooth, CustomFilletTooth):
        return replace(tooth, generated=replace(tooth.generated, tip_radius=radius))
    if not isinstance(tooth, Tooth):
        raise GeometryError("tip_radius", f"{radius:.6g} modules", "is possible for external teeth only")
    return replace(tooth, tip_radius=radius)
