"""Root stress of pairs over the mesh cycle, as machine code: each pair by itself.

As `contact.plane.root_stress_history` and `FilletCurve.largest`: the stress along a fillet is that of the load on its
own tooth and of those on its neighbours, and its largest value that of the smooth curve through its points, no nearer
to a contact than the search goes. Places along a fillet are shares of its length.
"""

# The arrays of these functions are typed by numba from their arguments.
# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

import numpy as np

from fegear.contact.many.changes import solved
from fegear.contact.many.corners import END, FACE, HIGH1, HIGH2, LOW1, LOW2, MODULE, PITCH, RB1, RB2, START
from fegear.contact.many.kernel import LENGTH1, LENGTH2, MOST
from fegear.contact.many.over_mesh import begun, limited, pair_numbers, pieces, room_for, tabulated
from fegear.fem.plane.root_stress import FORCES_OF_PRESSURE

#: As of `fem.plane.root_stress` and `contact_width` [modules].
_CLEARANCE, _HALF_WIDTH, _POINT = 0.05, 0.02, 1e-4
_FORCES = np.array(FORCES_OF_PRESSURE)
#: Points that the smooth curve at a point of the fillet is fitted to.
_FITTED = 10
#: A stress below this part of the largest is not looked at closer, nor one that is above the least by this part.
_COUNTS, _ABOVE = 0.6, 0.05
#: Pieces and positions of a base pitch at most; how far beside their ends both sides are looked at, in base pitches.
_PIECES, _POSITIONS, _SIDE = 40, 1000, 1e-9
#: Steps towards a peak between positions.
_REFINED = 3
TENSION, COMPRESSION = 0, 1


def slopes_over_contacts(x, y, out, low, up):
    """Slopes of the not-a-knot splines over contacts, one for each point of a fillet; as `kernel.slopes`."""
    n, points = y.shape
    h0, h1 = x[1] - x[0], x[2] - x[1]
    up[0], low[0] = h0 + h1, h1
    for q in range(points):
        d0, d1 = (y[1, q] - y[0, q]) / h0, (y[2, q] - y[1, q]) / h1
        out[0, q] = ((h0 + 2.0 * (h0 + h1)) * h1 * d0 + h0**2 * d1) / (h0 + h1)
    for i in range(1, n - 1):
        ha, hb = x[i] - x[i - 1], x[i + 1] - x[i]
        share = hb / low[i - 1]
        up[i] = ha
        low[i] = 2.0 * (ha + hb) - share * up[i - 1]
        before, after = 3.0 * hb / ha, 3.0 * ha / hb
        for q in range(points):
            out[i, q] = before * (y[i, q] - y[i - 1, q]) + after * (y[i + 1, q] - y[i, q]) - share * out[i - 1, q]
    ha, hb = x[n - 2] - x[n - 3], x[n - 1] - x[n - 2]
    share = (ha + hb) / low[n - 2]
    last = ha - share * up[n - 2]
    for q in range(points):
        da, db = (y[n - 2, q] - y[n - 3, q]) / ha, (y[n - 1, q] - y[n - 2, q]) / hb
        right = ((hb + 2.0 * (ha + hb)) * ha * db + hb**2 * da) / (ha + hb)
        out[n - 1, q] = (right - share * out[n - 2, q]) / last
    for i in range(n - 2, -1, -1):
        over = 1.0 / low[i]
        for q in range(points):
            out[i, q] = (out[i, q] - up[i] * out[i + 1, q]) * over


def weighed(x, share, at, weights):
    """Which two contacts a third lies between, and the weights of their values and slopes there."""
    i = min(max(np.searchsorted(x, share, side="right") - 1, 0), x.size - 2)
    h = x[i + 1] - x[i]
    s = (share - x[i]) / h
    at[0] = i
    weights[0], weights[1] = (1.0 + 2.0 * s) * (1.0 - s) ** 2, s * s * (3.0 - 2.0 * s)
    weights[2], weights[3] = h * s * (1.0 - s) ** 2, -h * s * s * (1.0 - s)


def pressed(x, length, low, high, base, nearest, at, weights):
    """Forces for the pressure of a contact, as `tables.pressed`, in place; how many.

    Parameters
    ----------
    x : ndarray
        Contacts of the tables.
    length, low, high, base : float
        Roll lengths of the contact and of the flank's ends, and base radius [modules].
    nearest : float
        How near to the flank's start contacts press [modules].
    at, weights : ndarray, shape (4,), (4, 4)
        As of `weighed`, of the forces in rows 1 to 3, or of all that lie between the same two contacts in row 1.
    """
    above, most = 0.5 * (length - low) * (length + low) / base, 0.5 * (high - low) * (high + low) / base
    above = max(above, nearest)
    width = min(_HALF_WIDTH, max(min(above, most - above), _POINT))
    together = True
    for i in range(3):
        place = min(max(above + _FORCES[i, 0] * width, 0.0), most)
        share = min(max((math.sqrt(low * low + 2.0 * base * place) - low) / (high - low), 0.0), 1.0)
        weighed(x, share, at[1 + i :], weights[1 + i])
        weights[1 + i] *= _FORCES[i, 1]
        together = together and at[1 + i] == at[1]
    if not together:
        return 3
    for k in range(4):
        weights[1, k] += weights[2, k] + weights[3, k]
    return 1


def superposed(stress, rise, tooth, ahead, numbers, v, line, at, weights, forces, out):
    """Stress along one fillet of a tooth under the loads of all pairs.

    Parameters
    ----------
    stress, rise : ndarray, shape (2 K + 1, contacts, points)
        Per unit line load, and their slopes over the contact.
    ahead : int
        1: the tooth of the next pair is the next tooth; -1 of the driven gear.
    line : float
        Load over face width and module.
    at, weights : ndarray, shape (numbers, 4), (numbers, 4, 4)
        Of each contact: as one load, and its pressure as forces (`pressed`).
    forces : ndarray of int, shape (numbers,)
        How many forces; 0 where the stress of the loaded tooth itself is that under pressures too.
    """
    reach = stress.shape[0] // 2
    for q in range(out.size):
        out[q] = 0.0
    for j in range(numbers):
        k = ahead * (tooth - j)
        if v[j] > 0.0 and -reach <= k <= reach:
            load, values, slopes = line * v[j], stress[k + reach], rise[k + reach]
            first, last = (1, 1 + forces[j]) if k == 0 and forces[j] > 0 else (0, 1)
            for n in range(first, last):
                i, w = at[j, n], weights[j, n]
                a, b, c, d = load * w[0], load * w[1], load * w[2], load * w[3]
                for q in range(out.size):
                    out[q] += a * values[i, q] + b * values[i + 1, q] + c * slopes[i, q] + d * slopes[i + 1, q]


def search_end(length, low, high, base, at):
    """Share of a fillet up which root tension is looked for below a contact; as `FilletCurve._beside`, `search_end`.

    Parameters
    ----------
    length : float
        Of the fillet [modules].
    low, high, base, at : float
        Roll lengths of the flank's ends, base radius, and roll length of the contact [modules].
    """
    above, room = 0.5 * (at * at - low * low) / base, 0.5 * (high * high - at * at) / base
    width = min(_HALF_WIDTH, max(min(above, room), _POINT))
    free = max(length + above - width, 0.0)
    return min(length, max(free - _CLEARANCE, 0.5 * free)) / length


def roughly(values, sign, end, arc):
    """Largest of the points below the end of the search."""
    most = sign * values[0]
    for i in range(1, arc.size):
        if arc[i - 1] > end:
            break
        most = max(most, sign * values[i])
    return most


def largest(values, sign, end, length, arc, fit, fit_slope, height, rise):  # noqa: C901  (one search)
    """Largest value, times its sign, of the smooth curve through a fillet's points; as `root_stress.extreme`."""
    n = arc.size
    if end < 1.0:  # as `without_contact`
        below = min(max(np.searchsorted(arc, end) - 1, 0), n - 2)
        share = min(max((end - arc[below]) / (arc[below + 1] - arc[below]), 0.0), 1.0)
        last = (1.0 - share) * values[below] + share * values[below + 1]
        for i in range(n - 1, -1, -1):
            faded = ((arc[i] - end) * length / _CLEARANCE - 0.2) / 0.3
            if faded <= 0.0:
                break
            values[i] += min(faded, 1.0) * (last - values[i])
    reached = -math.inf
    for i in range(n):
        if i > 1 and arc[i - 1] > end:
            break
        first = min(max(i - _FITTED // 2, 0), n - _FITTED)
        h, s = 0.0, 0.0
        for k in range(_FITTED):
            h += fit[i, k] * values[first + k]
            s += fit_slope[i, k] * values[first + k]
        height[i], rise[i] = sign * h, sign * s
        if arc[i] <= end:
            reached = max(reached, height[i])
    best = -math.inf
    for i in range(n - 1):
        if i > 0 and arc[i] > end:
            break
        step = arc[i + 1] - arc[i]
        a, b, p, q = height[i], height[i + 1], rise[i] * step, rise[i + 1] * step
        if 0 < i < n - 2 and max(a, b) + (4.0 / 27.0) * (abs(p) + abs(q)) < reached:
            continue
        low = -arc[0] / step if i == 0 else 0.0
        high = max((end - arc[i]) / step, low)
        if i < n - 2:
            high = min(high, 1.0)
        square, cube = 3.0 * (b - a) - 2.0 * p - q, p + q - 2.0 * (b - a)
        best = max(best, a + low * (p + low * (square + low * cube)))
        best = max(best, a + high * (p + high * (square + high * cube)))
        root = -(square + math.copysign(math.sqrt(max(square * square - 3.0 * cube * p, 0.0)), square))
        for k in range(2):
            over, under = (root, 3.0 * cube) if k == 0 else (p, root)
            place = over / under if abs(under) > abs(over) * 1e-9 else 0.0
            place = min(max(place, low), high)
            best = max(best, a + place * (p + place * (square + place * cube)))
    return best


def stressed(
    n, first, numbers, x, load, state, v, stress1, stress2, rise1, rise2, length, nearest, over, arc, fit, fit_slope,
    at, weights, forces, values, height, rise, top, least, whole, out,
):  # fmt: skip
    """Largest stress of each fillet at a roll position that is solved for, in every row of teeth.

    Parameters
    ----------
    length, nearest : ndarray, shape (2,)
        Of the fillets, and how near to the flank's start contacts press [modules].
    over : ndarray
        Contacts of the tables.
    top, least : ndarray, shape (2, 2), (2,)
        Largest so far and least root tension so far, renewed in place.
    whole : bool
        Whether all are wanted: otherwise what can change neither of these is left out.
    out : ndarray, shape (2, 2, MOST + 2)
        By gear, fillet and row, from the tooth before the first pair on; times the sign, -inf where left out.
    """
    m = n[MODULE]
    line = load / n[FACE] / m
    for member in range(2):
        low, high, base = (n[LOW1], n[HIGH1], n[RB1]) if member == 0 else (n[LOW2], n[HIGH2], n[RB2])
        stress, slopes = (stress1, rise1) if member == 0 else (stress2, rise2)
        contact = LENGTH1 if member == 0 else LENGTH2
        for j in range(numbers):
            if v[j] > 0.0:
                share = min(max((state[j, contact] - low) / (high - low), 0.0), 1.0)
                weighed(over, share, at[j], weights[j, 0])
        for side in range(2):
            sign = 1.0 if side == TENSION else -1.0
            for j in range(numbers):
                forces[j] = 0
                if side == TENSION and v[j] > 0.0:
                    touched = min(max(state[j, contact], low), high) / m
                    forces[j] = pressed(over, touched, low / m, high / m, base / m, nearest[member], at[j], weights[j])
            for row in range(numbers + 2):
                out[member, side, row] = -math.inf
                place = x + (first + row - 1) * n[PITCH]
                if not n[START] - n[PITCH] < place < n[END] + n[PITCH]:
                    continue
                superposed(
                    stress[side], slopes[side], row - 1, 1 if member == 0 else -1, numbers, v, line, at, weights,
                    forces, values,
                )  # fmt: skip
                end = 1.0
                if side == TENSION and 0 < row <= numbers and v[row - 1] > 0.0:
                    end = search_end(length[member], low / m, high / m, base / m, state[row - 1, contact] / m)
                rough = roughly(values, sign, end, arc)
                lowest = side == TENSION and rough < least[member] + _ABOVE * abs(top[member, side])
                if not whole and rough < _COUNTS * top[member, side] and not lowest:
                    continue
                found = largest(values, sign, end, length[member], arc, fit, fit_slope, height, rise)
                out[member, side, row] = found
                top[member, side] = max(top[member, side], found)
                if side == TENSION:
                    least[member] = min(least[member], found)


def vertex(x, f, lowest):
    """Where the parabola through three points is largest, away from all of them."""
    a, b = x[1] - x[0], x[2] - x[1]
    rises, falls = (f[1] - max(f[0], lowest)) / a, (f[1] - max(f[2], lowest)) / b
    bend = (rises + falls) / (a + b)
    place = x[1] + 0.5 * (rises * b - falls * a) / (a + b) / bend if bend > 0.0 else x[1]
    away = 0.02 * (x[2] - x[0])
    if abs(place - x[1]) < abs(away):
        place = x[1] + (away if abs(b) > abs(a) else -away)
    low, high = min(x[0], x[2]) + 0.1 * abs(away), max(x[0], x[2]) - 0.1 * abs(away)
    return min(max(place, low), high)


def narrowed(x, f, place, value):
    """Three points about a largest value, in place, once another one is known."""
    right = (place > x[1]) == (x[2] > x[0])
    if value > f[1]:
        i = 0 if right else 2
        x[i], f[i] = x[1], f[1]
        x[1], f[1] = place, value
    else:
        i = 2 if right else 0
        x[i], f[i] = place, value


def root_stresses(  # noqa: C901  (one loop over positions)
    numbers_of, own1, own2, beside1, beside2, corners, loads, samples, stress1, stress2, length, nearest, over, arc,
    fit, fit_slope, out,
):  # fmt: skip
    """Largest root tension, most negative root compression and range of root tension over the mesh.

    Parameters
    ----------
    stress1, stress2 : ndarray, shape (N, 2, 2 K + 1, contacts, points)
        By fillet and tooth, per unit line load, of module 1.
    length, nearest : ndarray, shape (N, 2)
        Of the fillets, and how near to the flank's start contacts press [modules].
    samples : int
        Positions of a base pitch.
    out : ndarray, shape (N, L, 2, 3)
        By gear [Pa]; NaN where load sharing does not settle.
    """
    size = own1.shape[1]
    x, y_slopes, thomas, state, c, v, work, ways = room_for(size)
    edges, found, every = np.empty(_PIECES), np.empty(_PIECES), np.empty(2 * _PIECES)
    rise1, rise2 = np.empty(stress1.shape[1:]), np.empty(stress1.shape[1:])
    at, weights, forces = np.zeros((MOST, 4), dtype=np.int64), np.zeros((MOST, 4, 4)), np.zeros(MOST, dtype=np.int64)
    points, contacts = arc.size, over.size
    values, height, rise = np.empty(points), np.empty(points), np.empty(points)
    lower, upper = np.empty(contacts), np.empty(contacts)
    top, least, rows = np.empty((2, 2)), np.empty(2), np.empty((2, 2, MOST + 2))
    place, piece = np.empty(_POSITIONS), np.empty(_POSITIONS, dtype=np.int64)
    curve, xs, fs = np.empty((2, 2, _POSITIONS)), np.empty(3), np.empty(3)
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
        begins = begun(n, edges)
        for load_number in range(loads.shape[1]):
            load = loads[p, load_number]
            limited(n, own, load, ways)
            count = pieces(
                n, own, ways, beside1[p], beside2[p], corners, load, numbers, first, samples, edges, begins, state, c,
                v, work, found, every,
            )  # fmt: skip
            top[:], least[:], good, positions = -math.inf, math.inf, True, 0
            for i in range(count):
                a, b = every[i], every[i + 1] if i + 1 < count else n[START] + n[PITCH]
                parts = max(2, math.ceil(samples * (b - a) / n[PITCH]))
                aside = min(_SIDE * n[PITCH], 0.5 * (b - a))
                for k in range(parts + 1):
                    if positions >= _POSITIONS:
                        good = False
                        break
                    where = a + aside + (b - a - 2.0 * aside) * k / parts
                    _, settled = solved(
                        n, own, ways, beside1[p], beside2[p], corners, load, numbers, first, where, state, c, v, work
                    )
                    good = good and settled
                    stressed(
                        n, first, numbers, where, load, state, v, stress1[p], stress2[p], rise1, rise2, length[p],
                        nearest[p], over, arc, fit, fit_slope, at, weights, forces, values, height, rise, top, least,
                        False, rows,
                    )  # fmt: skip
                    place[positions], piece[positions] = where, i
                    for member in range(2):
                        for side in range(2):
                            curve[member, side, positions] = rows[member, side, : numbers + 2].max()
                    positions += 1
            for member in range(2):
                for side in range(2):
                    f, steps = curve[member, side, :positions], _REFINED
                    best = int(f.argmax())
                    before = best > 0 and piece[best - 1] == piece[best]
                    after = best + 1 < positions and piece[best + 1] == piece[best]
                    if before and after:
                        xs[0], xs[1], xs[2] = place[best - 1], place[best], place[best + 1]
                        fs[0], fs[1], fs[2] = f[best - 1], f[best], f[best + 1]
                    else:  # at a jump or a kink, or just beside it
                        other = best - 1 if before else best + 1
                        xs[0], xs[1], xs[2] = place[best], 0.75 * place[best] + 0.25 * place[other], place[other]
                        fs[0], fs[1], fs[2] = f[best], -math.inf, f[other]
                        steps += 1
                    for step in range(steps):
                        first_try = step == 0 and fs[1] == -math.inf
                        where = xs[1] if first_try else vertex(xs, fs, _COUNTS * f[best])
                        solved(n, own, ways, beside1[p], beside2[p], corners, load, numbers, first, where, state, c, v,
                               work)  # fmt: skip
                        stressed(
                            n, first, numbers, where, load, state, v, stress1[p], stress2[p], rise1, rise2, length[p],
                            nearest[p], over, arc, fit, fit_slope, at, weights, forces, values, height, rise, top,
                            least, False, rows,
                        )  # fmt: skip
                        value = rows[member, side, : numbers + 2].max()
                        if first_try:
                            fs[1] = value
                            if value <= fs[0]:
                                break
                        else:
                            narrowed(xs, fs, where, value)
            for member in range(2):
                out[p, load_number, member, 0] = top[member, TENSION] if good else math.nan
                out[p, load_number, member, 1] = -top[member, COMPRESSION] if good else math.nan
                out[p, load_number, member, 2] = top[member, TENSION] - least[member] if good else math.nan


def root_stress_at(
    numbers_of, own1, own2, beside1, beside2, corners, load, x_of, stress1, stress2, length, nearest, over, arc, fit,
    fit_slope, out, first_out,
):  # fmt: skip
    """Largest root tension and most negative compression of every tooth at roll positions in the first base pitch.

    Parameters
    ----------
    load : ndarray, shape (N,)
        [N].
    x_of : ndarray, shape (N, P)
        [m].
    out : ndarray, shape (N, 2, 2, MOST + 2, P)
        By gear and fillet, rows from the tooth before that of the first pair on; NaN beyond a base pitch from the path.
    first_out : ndarray of int, shape (N,)
        Number of the first pair.
    """
    size = own1.shape[1]
    x, y_slopes, thomas, state, c, v, work, ways = room_for(size)
    rise1, rise2 = np.empty(stress1.shape[1:]), np.empty(stress1.shape[1:])
    at, weights, forces = np.zeros((MOST, 4), dtype=np.int64), np.zeros((MOST, 4, 4)), np.zeros(MOST, dtype=np.int64)
    values, height, rise = np.empty(arc.size), np.empty(arc.size), np.empty(arc.size)
    lower, upper = np.empty(over.size), np.empty(over.size)
    top, least, rows = np.empty((2, 2)), np.empty(2), np.empty((2, 2, MOST + 2))
    for p in range(numbers_of.shape[0]):
        n = numbers_of[p]
        out[p], first_out[p] = math.nan, 0
        good = n[END] > n[START] and np.isfinite(n).all() and np.isfinite(own1[p, 0] + own2[p, 0])
        if not (good and np.isfinite(length[p]).all()):
            continue
        tabulated(n, own1[p], own2[p], x, y_slopes, ways, thomas)
        own = (x[0], own1[p], y_slopes[0], x[1], own2[p], y_slopes[1])
        for side in range(2):
            for k in range(stress1.shape[2]):
                slopes_over_contacts(over, stress1[p, side, k], rise1[side, k], lower, upper)
                slopes_over_contacts(over, stress2[p, side, k], rise2[side, k], lower, upper)
        first, numbers = pair_numbers(n, ways, corners)
        first_out[p] = first
        limited(n, own, load[p], ways)
        for i in range(x_of.shape[1]):
            _, settled = solved(
                n, own, ways, beside1[p], beside2[p], corners, load[p], numbers, first, x_of[p, i], state, c, v, work
            )
            top[:], least[:] = -math.inf, math.inf
            stressed(
                n, first, numbers, x_of[p, i], load[p], state, v, stress1[p], stress2[p], rise1, rise2, length[p],
                nearest[p], over, arc, fit, fit_slope, at, weights, forces, values, height, rise, top, least, True,
                rows,
            )  # fmt: skip
            for member in range(2):
                for side in range(2):
                    sign = 1.0 if side == TENSION else -1.0
                    for row in range(numbers + 2):
                        found = rows[member, side, row]
                        out[p, member, side, row, i] = sign * found if settled and found > -math.inf else math.nan
