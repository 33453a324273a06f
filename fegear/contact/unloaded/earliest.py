"""The earliest contact of one tooth pair: the largest gear angle over the facing flanks, found as a nested maximum.

Inner: along a pinion helix (fixed s) the gear angle rises and falls once; its top, or an end of the reach, comes from
a bracketed Newton iteration. Outer: that top as a function of s is continuously differentiable, also where the inner
one changes from the inside to an end, and rises and falls once; its top is bracketed by samples and closed in on.
Neither needs an initial guess to be near, neither can diverge.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.tally import tallied
from fegear.contact.unloaded.placement import Placement
from fegear.contact.unloaded.reach import Bound, Reach, corner_on_face, reach
from fegear.contact.unloaded.roots import falling_bracket, falling_root

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Complex
    from fegear.geometry.rack_cutter import RackFlank

    Codes = NDArray[np.int8]


#: Samples over the height of the flank that bracket the outer maximum.
SAMPLES = 13

#: A reach shorter than this part of the face is a point.
_SHORT = 1e-11


@dataclass(frozen=True, slots=True)
class Top:
    """Top of each helix: place, what bounds it there, slope of the top by s, and on which side of reach it is.

    ``slope`` is +-1/r_b1 outside the reach, pointing back into it.
    """

    z: Array
    bound: Codes
    slope: Array
    within: Reach


@dataclass(frozen=True, slots=True)
class Earliest:
    """Earliest contact of a tooth pair at each pinion angle, shape (n,).

    Parameters
    ----------
    phi_2 : ndarray
        Gear angle [rad]; -inf where the flanks do not face each other.
    s, z : ndarray
        Contact point on the pinion's flank [m] (see `RackFlank`).
    bounds : ndarray of int8, shape (2, n)
        What bounds the contact point (`Bound`), NONE twice for surface contact.
    """

    phi_2: Array
    s: Array
    z: Array
    bounds: Codes


def top_of_helix(p: Placement, w: Complex, dw: Complex) -> Top:
    """Largest gear angle along each pinion helix."""
    r = reach(p, w)
    with np.errstate(divide="ignore", invalid="ignore"):
        # In the aligned drive the contact point on this helix lies on the line of action: the guess.
        line = np.arccos(np.minimum(p.base_1 / np.abs(w), 1.0)) - p.pressure_angle
        guess = (line - np.angle(w)) / p.twist_1 if p.twist_1 != 0.0 else 0.5 * (r.lo + r.hi)
    z = falling_root(p.slope_along_helix, r.lo, r.hi, np.nan_to_num(guess), (w,))
    at_lo, at_hi = z <= r.lo, z >= r.hi
    # Near a corner the reach is as short as round-off: which end the top is at is then for the slope to say.
    short = np.flatnonzero((r.hi - r.lo <= _SHORT * (p.face_1[1] - p.face_1[0])) & (r.outside == 0))
    if short.size:
        rising = p.slope_along_helix(z[short], w[short])[0] > 0.0
        at_lo[short], at_hi[short] = ~rising, rising
        z[short] = np.where(rising, r.hi[short], r.lo[short])
    bound = np.where(at_lo, r.lo_bound, np.where(at_hi, r.hi_bound, Bound.NONE)).astype(np.int8)
    slope = p.slope_along_profile(z, w, dw)
    edge = np.flatnonzero((at_lo | at_hi) & (r.outside == 0))
    if edge.size:
        along = p.slope_along_helix(z[edge], w[edge])[0]
        slope[edge] += along * _end_shift(p, z[edge], w[edge], dw[edge], bound[edge])
    slope = np.where(r.outside == 0, slope, r.outside / p.base_1)
    return Top(z, bound, slope, r)


def _end_shift(p: Placement, z: Array, w: Complex, dw: Complex, bound: Codes) -> Array:
    """dz/ds of an end of the reach."""
    q, qs = p.turned(w, z), p.turned(dw, z)
    qz = 1j * p.rate(z) * q
    by_face = qs.imag * p.sin / (p.cos - qz.imag * p.sin)
    x2, y2, _ = p.in_gear_frame(q, z)
    radius_s = -x2 * qs.real - y2 * qs.imag * p.cos
    radius_z = -x2 * qz.real - y2 * (qz.imag * p.cos + p.sin)
    with np.errstate(divide="ignore", invalid="ignore"):
        by_radius = np.where(radius_z == 0.0, 0.0, -radius_s / radius_z)
    face = (bound == Bound.GEAR_FACE_LOW) | (bound == Bound.GEAR_FACE_HIGH)
    radius = (bound == Bound.GEAR_TIP) | (bound == Bound.GEAR_FORM)
    return np.where(face, by_face, np.where(radius, by_radius, 0.0))


@tallied("tooth contacts")
def earliest_contact(p: Placement, flank: RackFlank, phi_1: Array) -> Earliest:
    """Earliest contact of one tooth pair.

    Parameters
    ----------
    p : Placement
    flank : RackFlank
        The pinion's flank.
    phi_1 : ndarray, shape (n,)
        Pinion angles [rad]; the pair that meets on the line of centres near phi_1 = 0.

    Returns
    -------
    Earliest
    """
    n = phi_1.size
    turn = np.exp(1j * phi_1)
    heights = np.linspace(flank.s_form, flank.s_tip, SAMPLES)
    w, dw = flank.profile(heights)
    w_all, dw_all = (w[:, None] * turn).ravel(), (dw[:, None] * turn).ravel()
    top = top_of_helix(p, w_all, dw_all)
    angle = np.where(top.within.outside == 0, p.gear_angle(w_all, top.z), -np.inf).reshape(SAMPLES, n)
    slope = top.slope.reshape(SAMPLES, n)

    column = np.arange(n)
    best = np.argmax(angle, axis=0)
    # Where no sample is within reach, a sliver between one sample too low and one too high may still be.
    sliver = np.argmax((slope[:-1] > 0.0) & (slope[1:] < 0.0), axis=0)
    found = np.isfinite(angle[best, column])
    rising = slope[best, column] > 0.0
    first = np.where(found, np.where(rising, best, best - 1), sliver)
    first = np.clip(first, 0, SAMPLES - 2)
    at_end = found & ((rising & (best == SAMPLES - 1)) | (~rising & (best == 0)))

    def slope_at(s: Array, turn: Complex) -> Array:
        w, dw = flank.profile(s)
        return top_of_helix(p, w * turn, dw * turn).slope

    lo = np.where(at_end, heights[best], heights[first])
    hi = np.where(at_end, heights[best], heights[first + 1])
    noise = 4e-15 / p.base_1
    tiny = 1e-14 * (flank.s_tip - flank.s_form)
    lo, hi = _probe_corners(p, flank, slope_at, lo, hi, turn, tiny)
    lo, hi = falling_bracket(slope_at, lo, hi, (turn,), np.full(n, 4.0 * tiny), zero=noise)
    candidates = [_at(p, flank, s, turn) for s in (lo, hi, heights[best])]
    return _choose(candidates, flank, noise)


def _probe_corners(
    p: Placement,
    flank: RackFlank,
    slope_at: Callable[[Array, Complex], Array],
    lo: Array,
    hi: Array,
    turn: Complex,
    tiny: float,
) -> tuple[Array, Array]:
    """Narrow the outer brackets by trying both sides of the points where the gear's tip circle meets a face end.

    The outer function jumps there; knowing the place beforehand saves the many bisections that would find it.
    """
    for upper in (False, True):
        corner = corner_on_face(p, flank, lo, hi, turn, upper=upper)
        for x in (corner - tiny, corner + tiny):
            index = np.flatnonzero((x > lo) & (x < hi))
            if index.size:
                rising = slope_at(x[index], turn[index]) > 0.0
                lo[index] = np.where(rising, x[index], lo[index])
                hi[index] = np.where(rising, hi[index], x[index])
    return lo, hi


def _at(p: Placement, flank: RackFlank, s: Array, turn: Complex) -> tuple[Array, Array, Top]:
    w, dw = flank.profile(s)
    top = top_of_helix(p, w * turn, dw * turn)
    return s, np.where(top.within.outside == 0, p.gear_angle(w * turn, top.z), -np.inf), top


def _choose(candidates: list[tuple[Array, Array, Top]], flank: RackFlank, noise: float) -> Earliest:
    (s_lo, g_lo, t_lo), (s_hi, g_hi, t_hi), (s_m, g_m, t_m) = candidates
    upper = g_hi > g_lo
    angle, s = np.where(upper, g_hi, g_lo), np.where(upper, s_hi, s_lo)
    z, first = np.where(upper, t_hi.z, t_lo.z), np.where(upper, t_hi.bound, t_lo.bound)
    length = np.where(upper, t_hi.within.hi - t_hi.within.lo, t_lo.within.hi - t_lo.within.lo)
    closed = length <= 1e-10 * flank.gear.face_width
    # The bracket closes on a jump where the reach ends, between its two ends, or where one end takes over from another.
    gone = (t_lo.within.outside != 0) | (t_hi.within.outside != 0) | closed
    here = np.where(upper, t_hi.within.hi_bound, t_lo.within.hi_bound)
    there = np.where(upper, t_hi.within.lo_bound, t_lo.within.lo_bound)
    other = np.where(gone, np.where(first == here, there, here), np.where(upper, t_lo.bound, t_hi.bound))
    second = np.where((first != Bound.NONE) & (other != first) & (other != Bound.NONE), other, Bound.NONE)
    slope = np.where(upper, t_hi.slope, t_lo.slope)
    second = np.where((s >= flank.s_tip) & (slope > noise), Bound.PINION_TIP, second)
    second = np.where((s <= flank.s_form) & (slope < -noise), Bound.PINION_FORM, second)
    # Samples are a net below: where the function has more than one top, the best sample may be higher.
    net = g_m > angle + 1e-15
    angle, s, z = np.where(net, g_m, angle), np.where(net, s_m, s), np.where(net, t_m.z, z)
    first, second = np.where(net, t_m.bound, first), np.where(net, Bound.NONE, second)
    return Earliest(angle, s, z, np.stack([first, second]).astype(np.int8))
