"""The room between two gears whose flanks differ: where both pairs of flanks touch, and the backlash.

The drive flanks of both gears touch each other, or the coast flanks do. For each the mesh is that of an involute pair
of the flank's own base circles (ISO 21771, 5.4); the two have the same pitch circles, for both divide the centre
distance by the numbers of teeth. At the working pitch circles the teeth of both gears fill the pitch but for the
backlash: a tooth reaches there from its centre line to psi_b - inv(alpha_w) of each flank, so that

    z_1 + z_2 times the backlash's angle = 2 pi - sum of z (psi_b - inv(alpha_w)) over both gears and both flanks.

Of an internal pair tooth numbers, base radii and inv(alpha_w) of the ring gear count negative, as in ISO 21771.

Lengths are in normal modules, in the section across the axes.
"""

from __future__ import annotations

import math

from fegear.base.errors import GeometryError
from fegear.geometry.involute import inv
from fegear.geometry.involute_side import InvoluteSide

#: Largest centre distance that is looked at, over the smallest.
_FARTHEST = 4.0


def _filled(one: InvoluteSide, other: InvoluteSide) -> float:
    """Sum of z psi_b over both gears and both flanks [rad]."""
    return sum(side.teeth * side.base_half_angle for side in (one, one.back, other, other.back))


def _flanks(one: InvoluteSide, other: InvoluteSide) -> tuple[float, float]:
    """Sums of the base radii of both pairs of flanks, of an internal pair their differences."""
    return (
        abs(one.side * one.base_radius + other.side * other.base_radius),
        abs(one.side * one.back.base_radius + other.side * other.back.base_radius),
    )


def _teeth(one: InvoluteSide, other: InvoluteSide) -> int:
    """Sum of the numbers of teeth, of an internal pair the external gear's less the ring gear's."""
    return one.side * one.teeth + other.side * other.teeth


def _free(one: InvoluteSide, other: InvoluteSide, distance: float) -> float:
    """Angle of the pitch that is free, times the sum of the numbers of teeth [rad]."""
    angles = (math.acos(min(radii / distance, 1.0)) for radii in _flanks(one, other))
    return 2.0 * math.pi - _filled(one, other) + _teeth(one, other) * sum(float(inv(a)) for a in angles)


def free_arc(one: InvoluteSide, other: InvoluteSide, distance: float) -> float:
    """j_wt, arc of the working pitch circles that is free [modules]; the same whichever flanks touch.

    Parameters
    ----------
    one, other : InvoluteSide
        Teeth of two gears, seen from the flanks that touch.
    distance : float
        Centre distance [modules].
    """
    return distance / abs(_teeth(one, other)) * _free(one, other, distance)


def touching_distance(one: InvoluteSide, other: InvoluteSide, *, allowance: bool) -> float:
    """Centre distance at which both pairs of flanks touch [modules].

    Parameters
    ----------
    one, other : InvoluteSide
    allowance : bool
        Whether the teeth are as thick as their thickness allowances leave them, or as profile shifts make them.

    Raises
    ------
    GeometryError
        If the profile shifts are too negative for any.
    """
    from scipy.optimize import brentq

    # An allowance A_sn takes an arc A_sn / cos(beta) of the reference circle, z / (2 cos(beta)) in radius.
    thicker = 0.0 if allowance else 2.0 * (one.thickness_allowance + other.thickness_allowance)
    least = max(_flanks(one, other))
    sign = math.copysign(1.0, _teeth(one, other))  # of an internal pair the free angle falls with the distance
    if sign * (_free(one, other, least) - thicker) > 0.0:
        shifts = one.profile_shift + other.profile_shift
        far, remedy = ("negative", "increase") if sign > 0.0 else ("large", "reduce")
        raise GeometryError(
            "profile_shift", f"sum {shifts:.6g}", f"is too {far}: no working pressure angle", f"{remedy} one of them"
        )
    if sign * (_free(one, other, _FARTHEST * least) - thicker) < 0.0:
        far, remedy = ("large", "reduce") if sign > 0.0 else ("negative", "increase")
        raise GeometryError(
            "profile_shift", f"sum {one.profile_shift + other.profile_shift:.6g}",
            f"is too {far}: working pressure angle above {math.degrees(math.acos(1.0 / _FARTHEST)):.0f} deg",
            f"{remedy} one of them",
        )  # fmt: skip
    return float(
        brentq(lambda distance: _free(one, other, distance) - thicker, least, _FARTHEST * least, xtol=1e-14, rtol=9e-16)
    )
