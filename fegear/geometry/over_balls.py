"""Dimension over two balls or pins in opposite tooth spaces, of an internal gear between them (ISO 21771, 5.6)."""

from __future__ import annotations

import math
from typing import NamedTuple

from fegear.base.errors import GeometryError
from fegear.geometry.balls_on_two_flanks import ball_of, ball_touching_at
from fegear.geometry.gear import Gear
from fegear.geometry.involute import pressure_angle_of_inv

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
    over_pins : float
        M_dR [m]: pins lie along the spaces of a helical gear, and those of an odd number of teeth stand opposite each
        other, at two heights of the axis; nan of internal helical gears, where no pin fits.
    """

    dimension: float
    ball_diameter: float
    contact_radius: float
    over_pins: float


def over_balls(gear: Gear, ball_diameter: float) -> OverBalls:
    """Dimension over (internal gears: between) two balls in opposite tooth spaces, or the nearest two of odd teeth.

    Thickness allowances count, as in `span`. With alpha_K the transverse pressure angle at the centre of the ball,
    inv(alpha_K) = D_M / (d_b cos(beta_b)) - (half the angle of a tooth space on the base circle); of an internal gear
    both terms have the other sign, for the ball lies on the flanks' hollow side. On helical teeth the balls lie in one
    section across the axis.

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
    if gear.asymmetric:
        return _over_two_flanks(gear, ball_diameter)
    base, space = gear.base_radius, math.pi / gear.teeth - gear.symmetric_tooth.base_half_angle
    lean, side = math.cos(gear.base_helix_angle), gear.tooth.side
    rise = side * (0.5 * ball_diameter / lean / base - space)
    if rise <= 0.0:
        size = "small that it has no contact above the base circle" if side > 0 else "large that it does not fit"
        raise _refused(gear, ball_diameter, f"is so {size}")
    angle = float(pressure_angle_of_inv(rise))
    length = base * math.tan(angle) - side * 0.5 * ball_diameter * lean
    contact = math.hypot(base, length)
    if length < 0.0 or side * contact < side * gear.form_radius:
        raise _refused(gear, ball_diameter, "contacts the flanks below the root form circle")
    if side * contact > side * gear.involute_tip_radius:
        raise _refused(gear, ball_diameter, "does not touch the involute: it rests on the tips")
    centre = base / math.cos(angle)
    if side * (centre - gear.root_radius) <= 0.5 * ball_diameter:
        raise _refused(gear, ball_diameter, "rests on the root circle")
    if side * (centre - gear.tip_radius) <= -0.5 * ball_diameter:
        raise _refused(gear, ball_diameter, "lies below the tip circle and cannot be measured")
    across = centre if gear.teeth % 2 == 0 else centre * math.cos(0.5 * math.pi / gear.teeth)
    over = 2.0 * across + side * ball_diameter
    pins = over if gear.helix_angle == 0.0 else math.nan if side < 0 else 2.0 * centre + ball_diameter
    return OverBalls(over, ball_diameter, contact, pins)


def _over_two_flanks(gear: Gear, ball_diameter: float) -> OverBalls:
    """The same over spur teeth whose flanks have two base circles."""
    try:
        ball = ball_of(gear.tooth, ball_diameter / gear.module)
    except GeometryError as error:
        raise _refused(gear, ball_diameter, error.rule) from None
    if ball.trouble:
        raise _refused(gear, ball_diameter, ball.trouble)
    centre = ball.centre * gear.module
    across = centre if gear.teeth % 2 == 0 else centre * math.cos(0.5 * math.pi / gear.teeth)
    over = 2.0 * across + ball_diameter
    return OverBalls(over, ball_diameter, 0.5 * sum(ball.contact_radii) * gear.module, over)


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
    if gear.asymmetric:
        return ball_touching_at(tooth, radius).diameter * gear.module
    roll = float(tooth.roll(radius))
    space = math.pi / tooth.teeth - float(gear.symmetric_tooth.half_thickness_angle(radius))
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
