"""The stretch of a pinion helix that faces the gear's flank: between faces, inside the tip, outside the form circle."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.unloaded.roots import falling_root

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Complex, Mask
    from fegear.contact.unloaded.placement import Placement
    from fegear.geometry.rack_cutter import RackFlank

    Codes = NDArray[np.int8]


class Bound(IntEnum):
    """What ends the reach of a pinion helix at a point; NONE inside."""

    NONE = 0
    PINION_FACE_LOW = 1
    PINION_FACE_HIGH = 2
    GEAR_FACE_LOW = 3
    GEAR_FACE_HIGH = 4
    GEAR_TIP = 5
    GEAR_FORM = 6
    BASE_TANGENT = 7
    PINION_TIP = 8
    PINION_FORM = 9


@dataclass(frozen=True, slots=True)
class Reach:
    """Ends of the reach along z [m], what makes them, and whether a helix is out of reach and which way back in.

    ``outside`` is 0 within reach, +1 where larger s (nearer the pinion's tip) is within reach, -1 where smaller s is.
    """

    lo: Array
    hi: Array
    lo_bound: Codes
    hi_bound: Codes
    outside: Codes


def _tighten(
    ends: tuple[Array, Codes], new: Array, bound: int | Codes, where: Mask, *, upper: bool
) -> tuple[Array, Codes]:
    value, code = ends
    take = where & ((new < value) if upper else (new > value))
    return np.where(take, new, value), np.where(take, bound, code).astype(np.int8)


def _face_of_gear(p: Placement, w: Complex, height: float, low: Array, high: Array) -> Array:
    """Where the helix passes the gear's transverse plane z2 = `height`; beyond the bracket its nearer end."""
    if p.sin == 0.0:
        return np.clip(np.full_like(low, height), low, high)

    def below(z: Array, w: Complex) -> tuple[Array, Array]:
        q = p.turned(w, z)
        return height - (z * p.cos - q.imag * p.sin), -(p.cos - p.rate(z) * q.real * p.sin)

    return falling_root(below, low, high, np.full_like(low, height), (w,))


def _slope_of_radius(p: Placement, z: Array, w: Complex) -> tuple[Array, Array, Array]:
    """r2^2 and its first two derivatives by z."""
    q = p.turned(w, z)
    rate = p.rate(z)
    qz, qzz = 1j * rate * q, -(rate**2) * q - 2j * p.crown * q
    x2, y2, _ = p.in_gear_frame(q, z)
    dx, dy = -qz.real, -qz.imag * p.cos - p.sin
    first = 2.0 * (x2 * dx + y2 * dy)
    second = 2.0 * (dx * dx + dy * dy - x2 * qzz.real - y2 * qzz.imag * p.cos)
    return x2 * x2 + y2 * y2, first, second


def _fall_of_radius(p: Placement, z: Array, w: Complex) -> tuple[Array, Array]:
    """-d(r2^2)/dz, which falls through zero where r2^2 is least, and its slope."""
    _, first, second = _slope_of_radius(p, z, w)
    return -first, -second


def reach(p: Placement, w: Complex) -> Reach:
    """Stretch of z over which the points of each pinion helix face the gear's flank.

    Parameters
    ----------
    p : Placement
    w : ndarray of complex, shape (n,)
        Profile points turned by the pinion angle [m].
    """
    n = w.size
    everywhere = np.ones(n, dtype=bool)
    lo, hi = np.full(n, p.face_1[0]), np.full(n, p.face_1[1])
    lows = (lo, np.full(n, Bound.PINION_FACE_LOW, dtype=np.int8))
    highs = (hi, np.full(n, Bound.PINION_FACE_HIGH, dtype=np.int8))
    margin = 0.5 * abs(p.sin) * p.distance + 1e-3 * (hi - lo)
    lows = _tighten(
        lows, _face_of_gear(p, w, p.face_2[0], lo - margin, hi + margin), Bound.GEAR_FACE_LOW, everywhere, upper=False
    )
    highs = _tighten(
        highs, _face_of_gear(p, w, p.face_2[1], lo - margin, hi + margin), Bound.GEAR_FACE_HIGH, everywhere, upper=True
    )
    lows, highs, behind = _past_base_tangent(p, w, lows, highs)
    lo, hi = lows[0], highs[0]
    outside = np.where((hi <= lo) | behind, 1, 0).astype(np.int8)

    # r2^2 is convex along the helix: its least value splits the reach into two monotone sides.
    azimuth = np.angle(w)
    with np.errstate(divide="ignore", invalid="ignore"):
        guess = np.nan_to_num(-azimuth / p.twist_1 if p.twist_1 != 0.0 else np.zeros(n), posinf=0.0, neginf=0.0)
    hi = np.maximum(hi, lo)
    middle = falling_root(lambda z, w: _fall_of_radius(p, z, w), lo, hi, guess, (w,))
    least = _slope_of_radius(p, middle, w)[0]
    outside = np.where(least > p.tip_2**2, 1, outside).astype(np.int8)
    lows, highs = _cut_at_radius(p, w, p.tip_2, middle, lows, highs)
    lows, highs, below = _cut_below_form(p, w, middle, least, lows, highs)
    outside = np.where((outside == 0) & below, -1, outside).astype(np.int8)
    outside = np.where((outside == 0) & (highs[0] < lows[0]), 1, outside).astype(np.int8)
    return Reach(lows[0], np.maximum(highs[0], lows[0]), lows[1], highs[1], outside)


def _past_base_tangent(
    p: Placement, w: Complex, lows: tuple[Array, Codes], highs: tuple[Array, Codes]
) -> tuple[tuple[Array, Codes], tuple[Array, Codes], Mask]:
    """Leave out azimuths at which the pinion point has not yet passed its base tangent point on the line of action.

    There the pinion's involute would be touched from its far side of the base tangent point: that part is cut away
    by any gear that can turn in mesh, and leaving it out keeps one maximum along the helix.
    """
    limit = -p.pressure_angle - np.arccos(np.minimum(p.base_1 / np.abs(w), 1.0))
    spare = np.angle(w) - limit
    if p.twist_1 == 0.0:
        return lows, highs, spare < 0.0
    z = -spare / p.twist_1
    everywhere = np.ones(w.size, dtype=bool)
    if p.twist_1 > 0.0:
        lows = _tighten(lows, z, Bound.BASE_TANGENT, everywhere, upper=False)
    else:
        highs = _tighten(highs, z, Bound.BASE_TANGENT, everywhere, upper=True)
    return lows, highs, highs[0] <= lows[0]


def _crossing(p: Placement, w: Complex, radius: float, inner: Array, outer: Array, where: Mask) -> Array:
    """Where r2 = `radius` between `inner` (smaller r2) and `outer` (larger r2), elements `where` only."""
    z = outer.copy()
    index = np.flatnonzero(where)
    sign = np.where(outer[index] >= inner[index], 1.0, -1.0)

    def inside(d: Array, w: Complex, start: Array, sign: Array) -> tuple[Array, Array]:
        value, slope, _ = _slope_of_radius(p, start + sign * d, w)
        return radius**2 - value, -sign * slope

    span = np.abs(outer[index] - inner[index])
    start = inner[index]
    step = falling_root(inside, np.zeros_like(span), span, span, (w[index], start, sign))
    z[index] = start + sign * step
    return z


def _cut_at_radius(
    p: Placement, w: Complex, radius: float, middle: Array, lows: tuple[Array, Codes], highs: tuple[Array, Codes]
) -> tuple[tuple[Array, Codes], tuple[Array, Codes]]:
    """Keep the part inside the gear's tip cylinder."""
    for upper in (False, True):
        end = highs[0] if upper else lows[0]
        beyond = _slope_of_radius(p, end, w)[0] > radius**2
        if beyond.any():
            z = _crossing(p, w, radius, middle, end, beyond)
            if upper:
                highs = _tighten(highs, z, Bound.GEAR_TIP, beyond, upper=True)
            else:
                lows = _tighten(lows, z, Bound.GEAR_TIP, beyond, upper=False)
    return lows, highs


def _cut_below_form(
    p: Placement, w: Complex, middle: Array, least: Array, lows: tuple[Array, Codes], highs: tuple[Array, Codes]
) -> tuple[tuple[Array, Codes], tuple[Array, Codes], Mask]:
    """Leave out what faces the gear's fillet: of the two sides beyond it, contact is on the receding one (y_f > 0)."""
    deep = least < p.form_2**2
    below = np.zeros(w.size, dtype=bool)
    if not deep.any():
        return lows, highs, below
    q = p.turned(w, middle)
    receding_is_low = p.rate(middle) * q.real * p.cos + p.sin < 0.0
    for upper in (False, True):
        side = deep & (receding_is_low != upper)
        end = highs[0] if upper else lows[0]
        whole = side & (_slope_of_radius(p, end, w)[0] < p.form_2**2)
        below |= whole
        cut = side & ~whole
        z = _crossing(p, w, p.form_2, middle, end, cut) if cut.any() else end
        if upper:
            lows = _tighten(lows, z, Bound.GEAR_FORM, cut, upper=False)
        else:
            highs = _tighten(highs, z, Bound.GEAR_FORM, cut, upper=True)
    return lows, highs, below


def corner_on_face(p: Placement, flank: RackFlank, lo: Array, hi: Array, turn: Complex, *, upper: bool) -> Array:
    """Parameter s [m] at which the lower or upper end of the common face lies on the gear's tip circle.

    Parameters
    ----------
    p : Placement
    flank : RackFlank
    lo, hi : ndarray, shape (n,)
        Bracket of s; its nearer end is the answer where there is no such point inside.
    turn : ndarray of complex, shape (n,)
        exp(i phi_1).
    upper : bool
        Which face end.
    """
    face_1, face_2 = p.face_1[int(upper)], p.face_2[int(upper)]

    def outside(s: Array, turn: Complex) -> tuple[Array, Array]:
        w, dw = flank.profile(s)
        w, dw = w * turn, dw * turn
        margin = np.full(s.shape, p.distance)
        by_gear = _face_of_gear(p, w, face_2, face_1 - margin, face_1 + margin)
        z = np.minimum(by_gear, face_1) if upper else np.maximum(by_gear, face_1)
        q, qs = p.turned(w, z), p.turned(dw, z)
        x2, y2, _ = p.in_gear_frame(q, z)
        slope = -2.0 * (x2 * qs.real + y2 * qs.imag * p.cos)
        if p.sin != 0.0:  # along the gear's end plane z moves as well
            qz = 1j * p.rate(z) * q
            shift = np.where(z == face_1, 0.0, qs.imag * p.sin / (p.cos - qz.imag * p.sin))
            slope += -2.0 * (x2 * qz.real + y2 * (qz.imag * p.cos + p.sin)) * shift
        return x2 * x2 + y2 * y2 - p.tip_2**2, slope

    return falling_root(outside, lo, hi, 0.5 * (lo + hi), (turn,))
