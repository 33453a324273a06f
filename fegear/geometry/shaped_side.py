"""A side of a tooth whose fillet is given: what its foot decides, and which fillets leave no tooth."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import ClassVar, Literal

import numpy as np

from fegear.base.errors import GeometryError
from fegear.geometry.curves import Curve
from fegear.geometry.external_tooth import THINNEST_NECK
from fegear.geometry.flank_above import Foot
from fegear.geometry.involute_side import InvoluteSide

#: Points of a fillet that are looked at.
_LOOKED_AT = 513
#: Smallest radius of curvature of a fillet [modules]: stress of a sharper one has no bound.
SHARPEST_FILLET = 5e-3
#: How much a fillet may come back toward the root circle [modules].
_COMES_BACK = 1e-6
#: Keys by which fillets are given: of both sides, or the drive side, and of the coast side.
FilletKey = Literal["fillet", "coast_fillet"]


class ShapedSide(InvoluteSide):
    """A side whose flank a tool has generated, and whose fillet is another curve than the tool's, or beside one."""

    shaped: ClassVar[bool] = True

    @property
    @abstractmethod
    def foot(self) -> Foot:
        """The fillet below the flank, in the tooth's frame."""

    @property
    @abstractmethod
    def fillet_key(self) -> FilletKey | None:
        """By which its fillet is given; None where it is the tool's."""

    @property
    @abstractmethod
    def as_generated(self) -> InvoluteSide:
        """The side as its tool makes it."""

    # ---- what the fillet decides -----------------------------------------------------------------------------------
    @property
    def root_radius(self) -> float:
        """r_f [modules], where the fillet starts."""
        return self.foot.root_radius

    @property
    def root_land_half_angle(self) -> float:
        """Half the angle of the root land between the two fillets of one tooth space [rad]."""
        return self.foot.root_land_half_angle

    @property
    def form_roll(self) -> float:
        """Roll angle of the involute where the fillet ends [rad]."""
        return self.foot.roll

    @property
    def undercut(self) -> bool:
        """Whether the involute starts in a corner."""
        return self.foot.corner

    @property
    def fillet(self) -> Curve:
        """The right fillet, from the root circle to the involute."""
        return self.foot.fillet

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

    # ---- what no tooth has -----------------------------------------------------------------------------------------
    def check_fillet(self) -> None:
        """Refuse fillets that leave no involute, come back, cross the space, cut the tooth off, or are too sharp.

        Raises
        ------
        GeometryError
            Under keys that begin with "fillet".
        """
        form, end = self.form_radius, self.involute_tip_radius
        if not self.side * (end - form) > 0.0:
            raise GeometryError(
                "fillet.form_diameter", f"{2.0 * form:.6g} modules", "leaves no involute: the flank ends at "
                f"{2.0 * end:.6g} modules", "choose a form diameter nearer to the root circle",
            )  # fmt: skip
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
        neck = self.neck
        if neck < 2.0 * THINNEST_NECK:
            raise GeometryError(
                "fillet", f"{neck:.3g} modules",
                f"is the narrowest part of the tooth, which must be at least {2.0 * THINNEST_NECK:g} modules",
                "specify a fillet that cuts less into the tooth",
            )  # fmt: skip
        if self.smallest_radius < SHARPEST_FILLET:
            raise GeometryError(
                "fillet", f"{self.smallest_radius:.3g} modules",
                f"is the smallest radius of curvature, which must be at least {SHARPEST_FILLET:g} modules",
                "set scatter if the points scatter",
            )  # fmt: skip

    @property
    def neck(self) -> float:
        """Narrowest thickness of the tooth between its two fillets [modules]."""
        sides = (self,) if self.back is self else (self, self.back)
        top = max(self.side * side.form_radius for side in sides)
        height = np.linspace(self.side * self.root_radius, top, _LOOKED_AT)
        angle = np.zeros(_LOOKED_AT)
        for side in sides:
            x, y = side.fillet.points(np.linspace(side.fillet.start, side.fillet.end, _LOOKED_AT))
            form = self.side * side.form_radius
            on_fillet = np.interp(height, self.side * np.hypot(x, y), np.arctan2(x, y))
            on_flank = side.flank_angle(np.abs(np.maximum(height, form)))
            angle += np.where(height <= form, on_fillet, on_flank) * (2.0 / len(sides))
        return float((2.0 * np.abs(height) * np.sin(0.5 * angle)).min())
