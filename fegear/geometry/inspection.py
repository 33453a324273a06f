"""Span measurement: what a disc micrometer reads over several teeth (ISO 21771, 5.6: base tangent length W_k).

Dimension over two balls or pins in opposite tooth spaces (ISO 21771, 5.6: M_dK and M_dR), or, of an internal gear,
between them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from fegear.base.errors import GeometryError
from fegear.geometry.gear import Gear
from fegear.geometry.involute import pressure_angle_of_inv


def span(gear: Gear, teeth: int) -> float:
    """Base tangent length W_k over k teeth [m]: k - 1 base pitches and one tooth thickness on the base circle.

    On helical teeth the discs stand along the normal of the flanks, which lies in the plane tangent to the base
    cylinder and leans by beta_b: all of it is shortened by cos(beta_b), and the discs touch W_k sin(beta_b) apart along
    the axis. Thickness allowances count: it is what the drawing's nominal value becomes by its allowance.

    Parameters
    ----------
    gear : Gear
    teeth : int
        k >= 1, teeth between the discs.

    Raises
    ------
    GeometryError
        If the gear is internal, k is less than 1, the discs do not touch involutes, or the face is narrower than
        W_k sin(beta_b).
    """
    if gear.tooth.internal:
        raise GeometryError("internal", "true", "has no room for the discs of a span", "measure between balls")
    if teeth < 1:
        raise GeometryError("teeth", teeth, "must be at least 1")
    lean = math.cos(gear.base_helix_angle)
    length = ((teeth - 1) * gear.base_pitch + 2.0 * gear.base_radius * gear.tooth.base_half_angle) * lean
    radius = math.hypot(gear.base_radius, 0.5 * length * lean)
    if not gear.form_radius <= radius <= gear.involute_tip_radius:
        raise GeometryError(
            "teeth",
            teeth,
            f"puts the discs at radius {radius * 1e3:.6g} mm, outside the involute from "
            f"{gear.form_radius * 1e3:.6g} mm to {gear.involute_tip_radius * 1e3:.6g} mm",
            f"measure over {span_teeth(gear)} teeth",
        )
    apart = length * math.sin(gear.base_helix_angle)
    if apart > gear.face_width:
        raise GeometryError(
            "face_width",
            f"{gear.face_width * 1e3:.6g} mm",
            f"is too narrow for a span over {teeth} teeth, whose discs touch {apart * 1e3:.6g} mm apart along the axis",
            "measure over fewer teeth, or over balls",
        )
    return length


def usual_span(gear: Gear) -> tuple[int, float] | None:
    """Number of teeth and base tangent length [m] of the measurement that `span_teeth` would take.

    A face too narrow for the lean of helical teeth takes fewer teeth; None where no number is left, and of internal
    gears.
    """
    if gear.tooth.internal:
        return None
    for teeth in range(span_teeth(gear), 0, -1):
        try:
            return teeth, span(gear, teeth)
        except GeometryError:
            continue
    return None


def span_teeth(gear: Gear) -> int:
    """Number of teeth whose measurement touches the flanks nearest to the middle of the involute."""
    middle = 0.5 * (gear.form_radius + gear.involute_tip_radius)
    half = math.sqrt(max(middle**2 - gear.base_radius**2, 0.0))
    base_thickness = 2.0 * gear.base_radius * gear.tooth.base_half_angle
    across = 2.0 * half / math.cos(gear.base_helix_angle) ** 2
    return max(1, round((across - base_thickness) / gear.base_pitch) + 1)


#: Preferred numbers R 40 within one decade, rounded as ISO 3 has them for sizes.
_R40 = (
    1.0, 1.06, 1.12, 1.18, 1.25, 1.32, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0, 2.12, 2.24, 2.36, 2.5, 2.65, 2.8, 3.0, 3.15,
    3.35, 3.55, 3.75, 4.0, 4.25, 4.5, 4.75, 5.0, 5.3, 5.6, 6.0, 6.3, 6.7, 7.1, 7.5, 8.0, 8.5, 9.0, 9.5, 10.0,
)  # fmt: skip


class OverBalls(NamedTuple):
    """What a gauge reads over two balls, or between those of an internal gear; spur gears read the same over pins.

    Attributes
    ----------
    dimension : float
        M_dK [m].
    ball_diameter : float
        D_M [m].
    contact_radius : float
        Where the balls touch the flanks [m].
    """

    dimension: float
    ball_diameter: float
    contact_radius: float


def over_balls(gear: Gear, ball_diameter: float) -> OverBalls:
    """Dimension over (internal gears: between) two balls in opposite tooth spaces, or the nearest two of odd teeth.

    Thickness allowances count, as in `span`. With alpha_K the transverse pressure angle at the centre of the ball,
    inv(alpha_K) = D_M / (d_b cos(beta_b)) - (half the angle of a tooth space on the base circle); of an internal gear
    both terms have the other sign, for the ball lies on the flanks' hollow side. On helical teeth the balls lie in one
    section across the axis; pins along an odd number of helical spaces would read otherwise.

    Parameters
    ----------
    gear : Gear
    ball_diameter : float
        D_M [m].

    Raises
    ------
    GeometryError
        If the balls do not touch both involutes, drop to the root circle or stay below the tip circle.
    """
    if not (math.isfinite(ball_diameter) and ball_diameter > 0.0):
        raise GeometryError("ball_diameter", ball_diameter, "must be positive and finite")
    base, space = gear.base_radius, math.pi / gear.teeth - gear.tooth.base_half_angle
    lean, side = math.cos(gear.base_helix_angle), gear.tooth.side
    rise = side * (0.5 * ball_diameter / lean / base - space)
    if rise <= 0.0:
        size = "small that it falls between the base circle's points" if side > 0 else "large that it has no room"
        raise _refused(gear, ball_diameter, f"is so {size}")
    angle = float(pressure_angle_of_inv(rise))
    length = base * math.tan(angle) - side * 0.5 * ball_diameter * lean
    contact = math.hypot(base, length)
    if length < 0.0 or side * contact < side * gear.form_radius:
        raise _refused(gear, ball_diameter, "touches the flanks below the start of the involute")
    if side * contact > side * gear.involute_tip_radius:
        raise _refused(gear, ball_diameter, "touches no involute: it lies on the tips")
    centre = base / math.cos(angle)
    if side * (centre - gear.root_radius) <= 0.5 * ball_diameter:
        raise _refused(gear, ball_diameter, "rests on the root circle")
    if side * (centre - gear.tip_radius) <= -0.5 * ball_diameter:
        raise _refused(gear, ball_diameter, "stays below the tip circle, where no gauge reaches it")
    across = centre if gear.teeth % 2 == 0 else centre * math.cos(0.5 * math.pi / gear.teeth)
    return OverBalls(2.0 * across + side * ball_diameter, ball_diameter, contact)


def _refused(gear: Gear, ball_diameter: float, rule: str) -> GeometryError:
    remedy = f"choose about {touching_ball(gear) * 1e3:.4g} mm"
    return GeometryError("ball_diameter", f"{ball_diameter * 1e3:.6g} mm", rule, remedy)


def touching_ball(gear: Gear) -> float:
    """Diameter of the ball that touches both flanks at the V-circle d + 2 x m, d - 2 x m of an internal gear [m].

    Where that circle lies beyond the involute's ends, the ball touches in the middle of the involute.
    """
    tooth = gear.tooth
    radius, (low, high) = tooth.pitch_radius + tooth.side * tooth.profile_shift, tooth.involute_radii
    if not low < radius < high:
        radius = 0.5 * (tooth.form_radius + tooth.involute_tip_radius)
    roll = float(tooth.roll(radius))
    space = math.pi / tooth.teeth - float(tooth.half_thickness_angle(radius))
    centre = math.atan(roll) + space  # pressure angle at the ball's centre, for a spur gear
    steep = math.tan(gear.base_helix_angle) ** 2
    target = centre + steep * roll  # centre + steep tan(centre) = target, by Newton's rule
    for _ in range(50 if steep else 0):
        off = centre + steep * math.tan(centre) - target
        centre -= off / (1.0 + steep / math.cos(centre) ** 2)
    return 2.0 * gear.base_radius * (math.tan(centre) - roll) / math.cos(gear.base_helix_angle)


def usual_ball(gear: Gear) -> float:
    """The next larger preferred number R 40 [mm] above `touching_ball`, in [m]: a ball that is to be had."""
    size = touching_ball(gear) * 1e3
    decade = 10.0 ** math.floor(math.log10(size))
    return next(step for step in _R40 if step * decade >= size * (1.0 - 1e-9)) * decade * 1e-3
