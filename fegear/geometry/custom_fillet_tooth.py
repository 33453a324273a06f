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

from fegear.base.errors import GeometryError
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import FilletShape
from fegear.geometry.flank_above import FlankAbove, Foot
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.involute_side import SideOfTooth
from fegear.geometry.involute_tooth import InvoluteTooth
from fegear.geometry.shaped_side import FilletKey, ShapedSide


@dataclass(frozen=True)
class CustomFilletTooth(ShapedSide, SideOfTooth, InvoluteTooth):
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

    generated: Tooth | InternalTooth
    shape: FilletShape

    def __post_init__(self) -> None:
        """Take over what the tool decides, and refuse fillets of no tooth."""
        self.take_over(self.generated)
        self.check_fillet()

    @cached_property
    def foot(self) -> Foot:
        """The fillet below the flank."""
        made = self.generated
        return self.shape.below(
            FlankAbove(
                made.base_radius, made.base_half_angle, self.side, math.pi / self.teeth, made.root_radius,
                made.form_radius,
            )
        )  # fmt: skip

    @property
    def fillet_key(self) -> FilletKey:
        """Of both fillets."""
        return "fillet"

    @property
    def as_generated(self) -> Tooth | InternalTooth:
        """The tooth as its tool makes it."""
        return self.generated

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
