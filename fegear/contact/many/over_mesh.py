"""Transmission error and shares of pairs over the mesh cycle, as machine code: each pair by itself.

As `contact.plane.transmission_error`: pieces between the places where pairs enter or leave the path, reliefs begin and
contact comes or goes; Gauss's points on each piece, crowding to its ends; extremes between them by parabolas.
"""

# The arrays of these functions are typed by numba from their arguments.
# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

import numpy as np

from fegear.contact.many.changes import SIDE, changes, inserted, solved
from fegear.contact.many.corners import (
    AMOUNT1,
    AMOUNT2,
    AT1,
    AT2,
    BEGIN1,
    BEGIN2,
    EARLY,
    END,
    FACE,
    HIGH1,
    HIGH2,
    KAPPA1,
    KAPPA2,
    LATE,
    LIMIT,
    LOW1,
    LOW2,
    MODULE,
    MODULUS,
    PITCH,
    RB1,
    RB2,
    REACH,
    START,
    corner_limit,
    corner_of,
    corner_way,
)
from fegear.contact.many.kernel import MOST, NUMBERS, own_lengths, slopes

#: How near places are one, in base pitches; as of `contact.plane.engagement`.
_APART = 1e-12
#: Pieces of a base pitch at most, points on all of them.
_PIECES, _POINTS = 40, 4000
_UNEVEN = 8.0


def pair_numbers(n, ways, corners):
    """First of the pairs that can touch in a base pitch, and how many there are; as `Meshing.pair_numbers`."""
    ratio = (n[END] - n[START]) / n[PITCH]
    ahead = math.ceil(ratio * (1.0 - 1e-12)) - 1
    if not corners:
        return 0, ahead + 1
    early, late = ways[0, REACH], ways[1, REACH]
    low = -max(1, min(math.ceil(early / n[PITCH]), 2))
    high = max(ahead, math.ceil(ratio + min(late / n[PITCH], 1.0)) - 1)
    return low, min(high - low + 1, MOST)


def reduced(n, x):
    """The same roll position from the start of the path on."""
    return n[START] + (x - n[START]) % n[PITCH]


def begun(n, places):
    """Places in a base pitch where pairs enter or leave or a relief begins, ascending; as `Engagement.breaks`."""
    count = inserted(places, 0, n[START])
    wanted = np.empty(3)
    wanted[0] = n[END]
    wanted[1] = wanted[2] = math.nan
    if n[AMOUNT1] != 0.0:
        wanted[1] = n[LOW1] + n[BEGIN1] * (n[HIGH1] - n[LOW1]) - n[AT1]
    if n[AMOUNT2] != 0.0:
        wanted[2] = n[AT2] - (n[LOW2] + n[BEGIN2] * (n[HIGH2] - n[LOW2]))
    apart = _APART * n[PITCH]
    for x in wanted:
        if n[START] - apart <= x <= n[END] + apart:
            at = reduced(n, x)
            known = at >= n[START] + n[PITCH] - apart
            for i in range(count):
                known = known or abs(places[i] - at) <= apart
            if not known:
                count = inserted(places, count, at)
    return count


def highest(x, f, piece, count, sign):
    """Largest value and the one of the parabola about it; as `Panels.highest`."""
    best = 0
    for i in range(count):
        if sign * f[i] > sign * f[best]:
            best = i
    top = sign * f[best]
    if best == 0 or best == count - 1 or piece[best - 1] != piece[best + 1]:
        return top
    before, after = x[best] - x[best - 1], x[best + 1] - x[best]
    if not 0.0 < max(before, after) <= _UNEVEN * min(before, after):
        return top
    falls, rises = (top - sign * f[best + 1]) / after, (top - sign * f[best - 1]) / before
    bend = (falls + rises) / (before + after)
    if not bend > 0.0:
        return top
    slope = (rises * after - falls * before) / (before + after)
    return top + slope * slope / (4.0 * bend)


def room_for(size):
    """Arrays to work in, for compliances at so many places: one set serves all pairs, one after the other."""
    return (
        np.empty((2, size)), np.empty((2, size)), np.empty((2, size)), np.zeros((MOST, NUMBERS)),
        np.zeros((MOST, MOST)), np.zeros(MOST), np.zeros((MOST, MOST + 2)), np.zeros((2, 4)),
    )  # fmt: skip


def tabulated(n, own1, own2, x, y_slopes, ways, work):
    """Roll lengths and slopes of both gears' c_0, and the ways of both corners, in place."""
    ways[:] = 0.0
    if n[EARLY] > 0.0:
        corner_way(n, False, ways[0])
    if n[LATE] > 0.0:
        corner_way(n, True, ways[1])
    own_lengths(n[RB1], n[MODULE], n[LOW1], n[HIGH1], x[0])
    own_lengths(n[RB2], n[MODULE], n[LOW2], n[HIGH2], x[1])
    slopes(x[0], own1, y_slopes[0], work[0], work[1])
    slopes(x[1], own2, y_slopes[1], work[0], work[1])


def limited(n, own, load, ways):
    """How far beyond the path both corners may touch under a load, in place: no pair gives way by more than this."""
    highest1, highest2 = own[1].max(), own[4].max()
    narrowest = math.sqrt(4.0 * load / n[FACE] * 0.02 * n[MODULE] / (math.pi * n[MODULUS]))
    wider = max(math.log(0.08 * n[MODULE] / narrowest), 0.0) + 3.0
    compliance = highest1 + highest2 + (n[KAPPA1] + n[KAPPA2]) * wider
    deepest = load / n[FACE] * compliance + abs(n[AMOUNT1]) + abs(n[AMOUNT2])
    if n[EARLY] > 0.0:
        ways[0, LIMIT] = corner_limit(deepest, ways[0], corner_of(n, False))
    if n[LATE] > 0.0:
        ways[1, LIMIT] = corner_limit(deepest, ways[1], corner_of(n, True))


def pieces(
    n, own, ways, beside1, beside2, corners, load, numbers, first, samples, edges, begins, state, c, v, work, found,
    every,
):  # fmt: skip
    """Where pieces begin between which no pair comes or goes and no relief begins, in place, in order; how many [m]."""
    changed = changes(
        n, own, ways, beside1, beside2, corners, load, numbers, first, samples, edges, begins, state, c, v, work, found
    )
    count = 0
    for i in range(begins):
        count = inserted(every, count, edges[i])
    for i in range(changed):
        near = False
        for j in range(count):
            near = near or abs(every[j] - found[i]) <= _APART * n[PITCH]
        if not near:
            count = inserted(every, count, found[i])
    return count


def transmission_errors(
    numbers_of, own1, own2, beside1, beside2, corners, loads, waves, samples, gauss, gauss_weights, out
):
    """Mean, peak-to-peak value and largest share of the load of each pair under each of its loads.

    Parameters
    ----------
    numbers_of : ndarray, shape (N, 32)
    own1, own2, beside1, beside2 : ndarray
        Of `ManyFlanks`, by gear.
    corners : bool
    loads : ndarray, shape (N, L)
        [N].
    waves, samples : int
        Harmonics that the points would be enough for; points among which changes of contact are looked for.
    gauss, gauss_weights : ndarray, shape (order,)
        Between 0 and 1.
    out : ndarray, shape (N, L, 3)
        NaN where load sharing does not settle, or no teeth touch at some position.
    """
    size = own1.shape[1]
    x, y_slopes, thomas, state, c, v, work, ways = room_for(size)
    edges, found, every = np.empty(_PIECES), np.empty(_PIECES), np.empty(2 * _PIECES)
    place, value, piece = np.empty(_POINTS), np.empty(_POINTS), np.empty(_POINTS, dtype=np.int64)
    order = gauss.size
    for p in range(numbers_of.shape[0]):
        n = numbers_of[p]
        if not (n[END] > n[START] and np.isfinite(n).all() and np.isfinite(own1[p, 0] + own2[p, 0])):
            out[p] = math.nan
            continue
        tabulated(n, own1[p], own2[p], x, y_slopes, ways, thomas)
        own = (x[0], own1[p], y_slopes[0], x[1], own2[p], y_slopes[1])
        first, numbers = pair_numbers(n, ways, corners)
        begins = begun(n, edges)
        for load_number in range(loads.shape[1]):
            load = loads[p, load_number]
            limited(n, own, load, ways)
            count = pieces(
                n, own, ways, beside1[p], beside2[p], corners, load, numbers, first, samples, edges, begins, state, c,
                v, work, found, every,
            )  # fmt: skip
            points, mean, most, good = 0, 0.0, 0.0, True
            for i in range(count):
                a, b = every[i], every[i + 1] if i + 1 < count else n[START] + n[PITCH]
                parts = max(1, math.ceil(1.5 * waves * (b - a) / n[PITCH] / (0.16 * order)))
                aside = min(SIDE * n[PITCH] / (b - a), 0.5)
                for k in range(-1, parts * order + 1):
                    if k < 0 or k == parts * order:
                        at, weight = (aside if k < 0 else 1.0 - aside), 0.0
                    else:
                        s = (k // order + gauss[k % order]) / parts
                        at = min(max(s * s * (3.0 - 2.0 * s), aside), 1.0 - aside)
                        weight = gauss_weights[k % order] / parts * 6.0 * s * (1.0 - s)
                    if points >= _POINTS:
                        good = False
                        break
                    where = a + (b - a) * at
                    error, settled = solved(
                        n, own, ways, beside1[p], beside2[p], corners, load, numbers, first, where, state, c, v, work
                    )
                    good = good and settled
                    mean += (b - a) * weight * error / n[PITCH]
                    place[points], value[points], piece[points] = where, error, i
                    points += 1
                    for j in range(numbers):
                        if v[j] > most:
                            most = v[j]
            out[p, load_number, 0] = mean if good else math.nan
            out[p, load_number, 1] = (
                highest(place, value, piece, points, 1.0) + highest(place, value, piece, points, -1.0)
                if good
                else math.nan
            )
            out[p, load_number, 2] = most if good else math.nan


def shared_at(numbers_of, own1, own2, beside1, beside2, corners, load, at, error_out, share_out, first_out):
    """Transmission error and shares of the load at roll positions in the first base pitch.

    Parameters
    ----------
    load : ndarray, shape (N,)
        [N].
    at : ndarray, shape (N, P)
        [m].
    error_out, share_out, first_out : ndarray, shape (N, P), (N, P, MOST), (N,)
        Number of the first pair; shares are zero beyond the last.
    """
    size = own1.shape[1]
    x, y_slopes, thomas, state, c, v, work, ways = room_for(size)
    for p in range(numbers_of.shape[0]):
        n = numbers_of[p]
        if not (n[END] > n[START] and np.isfinite(n).all() and np.isfinite(own1[p, 0] + own2[p, 0])):
            error_out[p], share_out[p], first_out[p] = math.nan, math.nan, 0
            continue
        tabulated(n, own1[p], own2[p], x, y_slopes, ways, thomas)
        own = (x[0], own1[p], y_slopes[0], x[1], own2[p], y_slopes[1])
        first, numbers = pair_numbers(n, ways, corners)
        first_out[p] = first
        limited(n, own, load[p], ways)
        for i in range(at.shape[1]):
            error, good = solved(
                n, own, ways, beside1[p], beside2[p], corners, load[p], numbers, first, at[p, i], state, c, v, work
            )
            error_out[p, i] = error if good else math.nan
            for j in range(numbers):
                share_out[p, i, j] = v[j] if good else math.nan
