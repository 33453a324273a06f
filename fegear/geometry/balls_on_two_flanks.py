"""A ball or pin in the tooth space of a spur gear whose flanks have two base circles.

The ball's centre lies on a parallel of each flank, an involute of the same base circle: seen from the middle of a tooth
it stands at psi_b + D_M / (2 r_b) - inv(alpha_K), cos(alpha_K) = r_b / r_K, of the flank on that side. Both flanks of a
space together take a pitch,

    2 pi / z = sum of psi_b + D_M / (2 r_b) - inv(alpha_K) over both flanks,

which gives D_M of a radius r_K of the centre (with equal flanks: inv(alpha_K) of ISO 21771, 5.6). Lengths in modules.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fegear.base.errors import GeometryError
from fegear.geometry.involute import inv
from fegear.geometry.involute_side import InvoluteSide

#: Ball centres are searched up to so many modules outside the tip circle.
_REACH = 4.0


@dataclass(frozen=True, slots=True)
class BallOnTwoFlanks:
    """The ball whose centre lies on a circle.

    Parameters
    ----------
    tooth : InvoluteSide
    centre : float
        r_K [modules], outside both base circles.
    """

    tooth: InvoluteSide
    centre: float

    @property
    def _sides(self) -> tuple[InvoluteSide, InvoluteSide]:
        return self.tooth, self.tooth.back

    @property
    def diameter(self) -> float:
        """D_M [modules]; it rises with the centre's radius."""
        angles = (math.acos(min(side.base_radius / self.centre, 1.0)) for side in self._sides)
        left = 2.0 * math.pi / self.tooth.teeth + sum(float(inv(angle)) for angle in angles)
        left -= sum(side.base_half_angle for side in self._sides)
        return 2.0 * left / sum(1.0 / side.base_radius for side in self._sides)

    @property
    def roll_lengths(self) -> tuple[float, float]:
        """Radii of curvature of this flank and the other one where the ball touches [modules]."""
        half = 0.5 * self.diameter
        one, other = (math.sqrt(max(self.centre**2 - side.base_radius**2, 0.0)) - half for side in self._sides)
        return one, other

    @property
    def contact_radii(self) -> tuple[float, float]:
        """Where it touches this flank and the other one [modules]."""
        one, other = (
            math.hypot(side.base_radius, length) for side, length in zip(self._sides, self.roll_lengths, strict=True)
        )
        return one, other

    @property
    def trouble(self) -> str:
        """Why a gauge could not use it, as a rule; empty where it can."""
        half, tooth = 0.5 * self.diameter, self.tooth
        for side, length, radius in zip(self._sides, self.roll_lengths, self.contact_radii, strict=True):
            if length < 0.0 or radius < side.form_radius:
                return "contacts the flanks below the root form circle"
            if radius > side.involute_tip_radius:
                return "does not touch the involute: it rests on the tips"
        if self.centre - tooth.root_radius <= half:
            return "rests on the root circle"
        return "" if self.centre - tooth.tip_radius > -half else "lies below the tip circle and cannot be measured"


def _range(tooth: InvoluteSide) -> tuple[float, float]:
    return max(tooth.base_radius, tooth.back.base_radius), tooth.tip_radius + _REACH


def ball_of(tooth: InvoluteSide, diameter: float) -> BallOnTwoFlanks:
    """The ball of a diameter [modules].

    Raises
    ------
    GeometryError
        If it has no contact outside the base circles, or lies far outside the teeth.
    """
    from scipy.optimize import brentq

    low, high = _range(tooth)
    for radius, sign, size in (
        (low, 1.0, "small that it has no contact above the base circle"), (high, -1.0, "large that it does not fit"),
    ):  # fmt: skip
        if sign * (diameter - BallOnTwoFlanks(tooth, radius).diameter) < 0.0:
            raise GeometryError("ball_diameter", diameter, f"is so {size}")
    centre = brentq(
        lambda r: BallOnTwoFlanks(tooth, r).diameter - diameter, low, high, xtol=1e-14, rtol=9e-16
    )  # fmt: skip
    return BallOnTwoFlanks(tooth, float(centre))


def ball_touching_at(tooth: InvoluteSide, radius: float) -> BallOnTwoFlanks:
    """The ball that touches both flanks at a radius [modules] in the mean."""
    from scipy.optimize import brentq

    def off(centre: float) -> float:
        return 0.5 * sum(BallOnTwoFlanks(tooth, centre).contact_radii) - radius

    low, high = _range(tooth)
    while BallOnTwoFlanks(tooth, low).roll_lengths[1] < 0.0 and low < high:  # contact lengths rise with the centre
        low += 0.01
    return BallOnTwoFlanks(tooth, float(brentq(off, low, high, xtol=1e-12)) if off(low) < 0.0 < off(high) else low)
