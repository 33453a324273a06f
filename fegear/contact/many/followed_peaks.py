"""Largest root stresses of pairs over the mesh as those of each pair alone, as machine code.

The same roll positions and the same way from samples to peaks as `contact.plane.base_pitch.roll_positions` and `peaks`:
some ten times the work of `over_fillets.root_stresses`, for numbers that agree to round-off.
"""

# The arrays of these functions are typed by numba from their arguments.
# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

import numpy as np

from fegear.contact.many.changes import inserted, solved
from fegear.contact.many.corners import END, PITCH, START
from fegear.contact.many.kernel import MOST
from fegear.contact.many.over_fillets import COMPRESSION, TENSION, slopes_over_contacts, stressed
from fegear.contact.many.over_mesh import begun, limited, pair_numbers, room_for, tabulated

#: As of `contact.plane.base_pitch`, `peaks` and `first_of_largest`.
_BESIDE, _EACH_SIDE, _PASSES, _LACKS, _FOLLOWED, _TIE = 1e-7, 4, 5, 0.05, 4, 1e-9
_PLACES = 40


def positions(n, count, edges, begins, out):
    """Roll positions over a base pitch, in place, ascending; how many. As `base_pitch.roll_positions`."""
    start, pitch = n[START], n[PITCH]
    beside = _BESIDE * pitch
    low, high = start + 0.5 * beside, start + pitch - 0.5 * beside
    found = inserted(out, 0, start + beside)
    found = inserted(out, found, start + pitch - beside)
    for k in range(count + 1):
        x = start + pitch * k / count
        if low < x < high:
            found = inserted(out, found, x)
    for i in range(begins):
        for sign in (-1.0, 1.0):
            x = edges[i] + sign * beside
            if low < x < high:
                found = inserted(out, found, x)
    kept = 0
    for i in range(found):
        if i == 0 or out[i] != out[kept - 1]:
            out[kept] = out[i]
            kept += 1
    return kept


def peaks_of(curve, count, out):
    """Local maxima that are followed, the highest samples first, in place; how many. As `peaks.refined_peaks`."""
    peak, found = curve[:count].max(), 0
    taken = np.zeros(count, dtype=np.bool_)
    for _ in range(_FOLLOWED):
        best = -1
        for i in range(count):
            before, after = curve[i - 1] if i > 0 else -math.inf, curve[i + 1] if i + 1 < count else -math.inf
            local = curve[i] >= before and curve[i] >= after and curve[i] >= peak - _LACKS * abs(peak)
            if local and not taken[i] and (best < 0 or curve[i] > curve[best]):
                best = i
        if best < 0:
            break
        taken[best] = True
        out[found] = best
        found += 1
    return found


def first_of_tied(at, value, count):
    """Which of some places is the first of those whose values are the largest but for round-off."""
    largest, best = value[:count].max(), -1
    for i in range(count):
        if value[i] >= largest - _TIE * abs(largest) and (best < 0 or at[i] < at[best]):
            best = i
    return best


def followed_stresses(  # noqa: C901  (one search: what it shares is its local variables)
    numbers_of, own1, own2, beside1, beside2, corners, loads, samples, stress1, stress2, length, nearest, over, arc,
    fit, fit_slope, out,
):  # fmt: skip
    """Largest root tension, most negative root compression and range of root tension over the mesh.

    As `over_fillets.root_stresses`, whose parameters these are.
    """
    size = own1.shape[1]
    x, y_slopes, thomas, state, c, v, work, ways = room_for(size)
    edges, place = np.empty(_PLACES), np.empty(samples + 2 * _PLACES + 3)
    rise1, rise2 = np.empty(stress1.shape[1:]), np.empty(stress1.shape[1:])
    at, weights, forces = np.zeros((MOST, 4), dtype=np.int64), np.zeros((MOST, 4, 4)), np.zeros(MOST, dtype=np.int64)
    values, height, rise = np.empty(arc.size), np.empty(arc.size), np.empty(arc.size)
    lower, upper = np.empty(over.size), np.empty(over.size)
    top, least, rows = np.empty((2, 2)), np.empty(2), np.empty((2, 2, MOST + 2))
    highest, none = np.empty((2, 2)), np.full(2, -math.inf)
    curve, begin = np.empty((2, 2, place.size)), np.empty(_FOLLOWED, dtype=np.int64)
    where, reached, last = np.empty(2 * _EACH_SIDE + 3), np.empty(2 * _EACH_SIDE + 3), np.empty((2, _FOLLOWED))
    for p in range(numbers_of.shape[0]):
        n = numbers_of[p]
        good = n[END] > n[START] and np.isfinite(n).all() and np.isfinite(own1[p, 0] + own2[p, 0])
        if not (good and np.isfinite(length[p]).all()):
            out[p] = math.nan
            continue
        tabulated(n, own1[p], own2[p], x, y_slopes, ways, thomas)
        own = (x[0], own1[p], y_slopes[0], x[1], own2[p], y_slopes[1])
        for side in range(2):
            for k in range(stress1.shape[2]):
                slopes_over_contacts(over, stress1[p, side, k], rise1[side, k], lower, upper)
                slopes_over_contacts(over, stress2[p, side, k], rise2[side, k], lower, upper)
        first, numbers = pair_numbers(n, ways, corners)
        count = positions(n, samples, edges, begun(n, edges), place)
        for load_number in range(loads.shape[1]):
            load = loads[p, load_number]
            limited(n, own, load, ways)
            top[:], least[:], good = -math.inf, math.inf, True
            for i in range(count):
                _, settled = solved(
                    n, own, ways, beside1[p], beside2[p], corners, load, numbers, first, place[i], state, c, v, work
                )
                good = good and settled
                stressed(
                    n, first, numbers, place[i], load, state, v, stress1[p], stress2[p], rise1, rise2, length[p],
                    nearest[p], over, arc, fit, fit_slope, at, weights, forces, values, height, rise, top, least, True,
                    rows,
                )  # fmt: skip
                for member in range(2):
                    for side in range(2):
                        curve[member, side, i] = rows[member, side, : numbers + 2].max()
            for member in range(2):
                for side in range(2):
                    followed = peaks_of(curve[member, side], count, begin)
                    for f in range(followed):
                        i = begin[f]
                        low, middle, high = place[max(i - 1, 0)], place[i], place[min(i + 1, count - 1)]
                        value = curve[member, side, i]
                        for _ in range(_PASSES):
                            where[0], where[_EACH_SIDE + 1], where[2 * _EACH_SIDE + 2] = low, middle, high
                            reached[:] = -math.inf
                            reached[_EACH_SIDE + 1] = value
                            for k in range(1, _EACH_SIDE + 1):
                                share = k / (_EACH_SIDE + 1)
                                where[k] = low + share * (middle - low)
                                where[_EACH_SIDE + 1 + k] = middle + share * (high - middle)
                            for k in range(1, 2 * _EACH_SIDE + 2):
                                if k == _EACH_SIDE + 1:
                                    continue
                                highest[:] = top  # what cannot be as large is left out
                                solved(n, own, ways, beside1[p], beside2[p], corners, load, numbers, first, where[k],
                                       state, c, v, work)  # fmt: skip
                                stressed(
                                    n, first, numbers, where[k], load, state, v, stress1[p], stress2[p], rise1, rise2,
                                    length[p], nearest[p], over, arc, fit, fit_slope, at, weights, forces, values,
                                    height, rise, highest, none, False, rows,
                                )  # fmt: skip
                                reached[k] = rows[member, side, : numbers + 2].max()
                            best = int(reached.argmax())
                            low, middle, high, value = where[best - 1], where[best], where[best + 1], reached[best]
                        last[0, f], last[1, f] = middle, value
                    # the peak itself is one of the positions of all four curves
                    best = int(first_of_tied(last[0], last[1], followed))
                    place[count + 2 * member + side] = last[0, best]
            for i in range(count, count + 4):
                solved(n, own, ways, beside1[p], beside2[p], corners, load, numbers, first, place[i], state, c, v, work)
                stressed(
                    n, first, numbers, place[i], load, state, v, stress1[p], stress2[p], rise1, rise2, length[p],
                    nearest[p], over, arc, fit, fit_slope, at, weights, forces, values, height, rise, top, least, True,
                    rows,
                )  # fmt: skip
            for member in range(2):
                out[p, load_number, member, 0] = top[member, TENSION] if good else math.nan
                out[p, load_number, member, 1] = -top[member, COMPRESSION] if good else math.nan
                out[p, load_number, member, 2] = top[member, TENSION] - least[member] if good else math.nan
