"""Tip corners of one pair beyond the path of contact, as machine code: the numbers of `contact.plane.corner`.

The corner's way is followed by the roll length of the mate's flank in an external pair, by the angle that the tip's
gear has turned since the path's end in an internal one. Turns are differences without cancellation in both.
"""

# The arrays of these functions are typed by numba from their arguments.
# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

#: What a pair's numbers are, in their order; roll lengths, and pressure angle, carry the sign of the flank (`SIDE`).
(
    AT1, AT2, PITCH, START, END, RB1, RB2, DISTANCE, TIP1, TIP2, EARLY, LATE, LOW1, HIGH1, LOW2, HIGH2, MODULUS, KAPPA1,
    KAPPA2, SOFT1, SOFT2, FACE, MODULE, AMOUNT1, BEGIN1, POWER1, AMOUNT2, BEGIN2, POWER2, SIDE1, SIDE2, ANGLE,
) = range(32)  # fmt: skip
#: What is kept of a corner's way: both angles where it begins (internal: that of the corner from the centre line, and
#: the whole turn of its gear), how far it reaches, and how far it may touch under a load.
FIRST, SECOND, REACH, LIMIT = range(4)
_SMALLEST_GAP = 2.3e-308


def corner_of(n, late):
    """What a corner's way is made of: that of the driver after the path, or of the driven gear before it.

    Returns
    -------
    start, top, distance, tip, base_tip, base, side : float
        Roll lengths of the mate's flank at the path's end and at its own end, centre distance, radius of the corner,
        base radii of its gear and of the mate; side of the mate's flank in an internal pair, 0 in an external one.
    """
    inside = 0.0 if n[SIDE1] == n[SIDE2] else 1.0
    if late:
        return n[AT2] - n[END], n[HIGH2], n[DISTANCE], n[TIP1], n[RB1], n[RB2], inside * n[SIDE2]
    return n[AT1] + n[START], n[HIGH1], n[DISTANCE], n[TIP2], n[RB2], n[RB1], inside * n[SIDE1]


def triangle_angle(s, a, own, other):
    """Angle at a gear's centre; as `corner._triangle_angle`."""
    across = math.sqrt(max((s - a) * (s - own), 0.0))
    return 2.0 * math.atan2(across, math.sqrt(max(s * (s - other), 0.0)))


def difference(of_cosines, total):
    """Difference of two angles by that of their cosines and by their sum; as `corner._difference`."""
    sine = math.sin(0.5 * total)
    return 2.0 * math.asin(min(max(-of_cosines / (2.0 * sine), -1.0), 1.0)) if sine > 0.0 else 0.0


def rolled_back(length, start, base):
    """Difference of the polar angles of an involute at two roll lengths, inv(length) - inv(start)."""
    step = (length - start) / base
    return step - math.atan(step / (1.0 + length * start / (base * base)))


def turned(place, way, corner):
    """By how much the tip's and the flank's gear have turned with the corner at a place, slopes, and the roll length.

    As `corner._turned` of both kinds of pairs.
    """
    start, _, a, r, _, base, side = corner
    if side != 0.0:
        half, first = math.sin(0.5 * place), way[FIRST]
        middle, now = first + 0.5 * place, first + place
        along, across = r * math.cos(first) - side * a, r * math.sin(first)
        # cross and scalar product of the lines from the mate's centre to the corner, then and now
        cross = r * r * math.sin(place) - 2.0 * side * a * r * half * math.cos(middle)
        scalar = along * (r * math.cos(now) - side * a) + across * r * math.sin(now)
        farther = 4.0 * side * a * r * half * math.sin(middle)  # of the squares of the distances
        length = side * math.sqrt(max(start * start + farther, 0.0))
        squared = base * base + length * length
        of_flank = math.atan2(cross, scalar) - rolled_back(length, start, base)
        grows = (r * r - side * a * r * math.cos(now)) / squared
        # d inv = (length / base)^2 / (1 + (length / base)^2) d length / base, and length d length = a r sin d angle
        grows -= length * side * a * r * math.sin(now) / (base * squared)
        return place, of_flank, 1.0, grows, length
    rho, first = math.hypot(base, place), math.hypot(base, start)
    s = 0.5 * (a + r + rho)
    at_tip, at_flank, t = triangle_angle(s, a, r, rho), triangle_angle(s, a, rho, r), place / base
    farther = (place - start) * (place + start)
    of_tip = difference(-farther / (2.0 * a * r), at_tip + way[FIRST])
    bent = 1.0 - (a - r) * (a + r) / (rho * first)
    of_flank = difference(farther / (rho + first) / (2.0 * a) * bent, at_flank + way[SECOND])
    of_flank -= rolled_back(place, start, base)
    along = place / rho
    tip_grows = rho * along / (a * r * math.sin(at_tip))
    flank_grows = -0.5 * (1.0 - (a * a - r * r) / (rho * rho)) / a * along / math.sin(at_flank)
    return of_tip, of_flank, tip_grows, flank_grows - t * t / (1.0 + t * t) / base, place


def corner_way(n, late, out):
    """What is the same for all places of a corner's way: where it begins, and how far it reaches."""
    corner = corner_of(n, late)
    start, top, a, r, base_tip, base, side = corner
    out[REACH] = 0.0
    if not top > start:
        return
    if side != 0.0:
        own = n[AT1] + n[END] if late else n[AT2] - n[START]
        out[FIRST] = math.atan(own / base_tip) + side * n[ANGLE]
        at = math.hypot(base, top)
        last = triangle_angle(0.5 * (a + r + at), a, r, at)
        out[SECOND] = max((last if side > 0.0 else math.pi - last) - out[FIRST], 0.0)
        end = turned(out[SECOND], out, corner)
    else:
        rho = math.hypot(base, start)
        s = 0.5 * (a + r + rho)
        out[FIRST], out[SECOND] = triangle_angle(s, a, r, rho), triangle_angle(s, a, rho, r)
        end = turned(top, out, corner)
    out[REACH] = 0.5 * (base_tip * end[0] + base * end[1])


def corner_limit(deepest, way, corner):
    """How far beyond the path a corner may touch that deflections bring nearer by so much at most, for certain."""
    reach = way[REACH]
    low, high = 0.0, reach
    if reach > 0.0 and corner_at(reach, way, corner)[0] > deepest:
        for _ in range(6):
            middle = 0.5 * (low + high)
            if corner_at(middle, way, corner)[0] > deepest:
                high = middle
            else:
                low = middle
    return high


def corner_at(beyond, way, corner):
    """Gap, roll length on the mate's flank and tilt of a tip corner so far beyond the path; as `corner.locate`.

    An infinite gap where it has left the flank.
    """
    start, top, a, r, base_tip, base, side = corner
    reach = way[REACH]
    if reach <= 0.0 or beyond > reach * (1.0 + 1e-12):
        return math.inf, top, 0.0
    low, high = (start, top) if side == 0.0 else (0.0, way[SECOND])
    unit = base if side == 0.0 else 0.1
    place, gap = low + (high - low) * beyond / reach, 0.0
    for _ in range(60):
        now = turned(place, way, corner)
        u_t, u_f = base_tip * now[0], base * now[1]
        u, gap = 0.5 * (u_t + u_f), u_t - u_f
        if u < beyond:
            low = place
        else:
            high = place
        slope = 0.5 * (base_tip * now[2] + base * now[3])
        new = place + (beyond - u) / slope
        step = abs(new - place)
        if not low <= new <= high:
            if step <= 1e-12 * unit:
                break
            new = 0.5 * (low + high)
        gap += (base_tip * now[2] - base * now[3]) * (new - place)
        place = new
        if step <= 1e-9 * unit:
            break
    if side != 0.0:
        of_tip, of_flank, _, _, length = turned(place, way, corner)
        return max(gap, _SMALLEST_GAP), length, abs(of_tip - of_flank - (length - start) / base)
    rho = math.hypot(base, place)
    inside = min(max((rho * rho + r * r - a * a) / (2.0 * rho * r), -1.0), 1.0)
    tilt = max(math.pi - math.acos(inside) + math.asin(base_tip / r) - math.atan2(base, place), 0.0)
    return max(gap, _SMALLEST_GAP), place, tilt
