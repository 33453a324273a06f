"""Where contact comes and goes over the mesh cycle of one pair, as machine code: the numbers of `contact.sign_changes`.

The same samples, the same cells that a change may hide in, and each of them cut as finely: a change lies in the middle
of the same smallest part. That part is found by the false position among whole numbers of parts, a dozen positions to
a change in place of some hundred; and a cell in which nearness goes away from zero at either end hides none.
"""

# The arrays of these functions are typed by numba from their arguments.
# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

import numpy as np

from fegear.contact.many.corners import FACE, KAPPA1, KAPPA2, PITCH, START
from fegear.contact.many.kernel import (
    DIAGONAL,
    GAP,
    HERE,
    MOST,
    ROOM,
    TILT,
    WEDGE,
    contacts,
    couple,
    edge_law,
    share,
)

#: Of the load, below which a pair bears none; how far beside places both sides are looked at, in base pitches; as of
#: `contact.plane.transmission_error` and `fourier`.
NO_SHARE, SIDE = 1e-9, 1e-9
#: Parts of a cell, and of these in turn, in all passes; changes beyond which a function hovers at zero; as of
#: `contact.sign_changes` and `transmission_error`.
_PARTS, _FINEST, _MOST_IN_A_CELL = 32, 32**3, 8


def solved(n, own, ways, beside1, beside2, corners, load, numbers, first, x, state, c, v, work):
    """Load sharing at a roll position: transmission error [m], and whether it was found."""
    contacts(n, own, ways, corners, load, numbers, first, x, state)
    couple(n, beside1, beside2, numbers, state, c)
    half = 0.5 * (n[KAPPA1] + n[KAPPA2]) / n[FACE]
    z, nearest, good = share(half, load, numbers, state, c, v, work)
    return nearest + z * load, good


def nearness(n, load, numbers, error, state, c, v, out):
    """How firmly each pair is in contact; as `transmission_error._nearness`."""
    half = 0.5 * (n[KAPPA1] + n[KAPPA2]) / n[FACE]
    most = 0.0
    for i in range(numbers):
        out[i] = -math.inf
        if state[i, HERE] > 0.0:
            own = 0.0
            for j in range(numbers):
                if j != i and v[j] > 1e-19:
                    own += c[i, j] * v[j] * load
            if v[i] > 1e-19:
                grown = math.log(v[i])
                if state[i, TILT] > -math.inf:
                    root = math.sqrt(v[i])
                    grown -= 2.0 * edge_law(state[i, TILT] / root, state[i, WEDGE], state[i, ROOM] / root)[0]
                own += (state[i, DIAGONAL] - half * grown) * v[i] * load
                most = max(most, own)
                out[i] = v[i] - NO_SHARE
            else:
                out[i] = -1.0 - max(own + state[i, GAP] - error, 0.0)  # marked; brought over the deflection below
    for i in range(numbers):
        if -math.inf < out[i] <= -1.0:
            out[i] = (out[i] + 1.0) / most


def inserted(places, count, x):
    """Put a place among ascending ones."""
    if count >= places.size:
        return count
    i = count
    while i > 0 and places[i - 1] > x:
        places[i] = places[i - 1]
        i -= 1
    places[i] = x
    return count + 1


def slope_of(values, x, k, j):
    """Slope of a pair's nearness over a cell in which its sign stays; 0 where it does not, or at either end."""
    if k < 0 or k + 1 >= x.size or (values[k, j] > 0.0) != (values[k + 1, j] > 0.0):
        return 0.0
    if min(values[k, j], values[k + 1, j]) == -math.inf:
        return 0.0
    return abs((values[k + 1, j] - values[k, j]) / (x[k + 1] - x[k]))


def turns(values, x, k, j):
    """Whether a pair's nearness may reach zero in a cell if it goes on as steeply as in those beside it."""
    if (values[k, j] > 0.0) != (values[k + 1, j] > 0.0):
        return False
    steepest = max(slope_of(values, x, k - 1, j), slope_of(values, x, k + 1, j))
    return steepest * (x[k + 1] - x[k]) > min(abs(values[k, j]), abs(values[k + 1, j]))


def dips(values, x, k, beside, other):
    """Whether nearness that may reach zero in a cell goes toward it from one end, by its values beside it.

    Parameters
    ----------
    beside : ndarray
        Nearness of all pairs a part of the cell from that end.
    other : bool
        Whether that is the cell's second end.
    """
    at, found = values[k + 1] if other else values[k], False
    for j in range(at.size):
        found = found or (turns(values, x, k, j) and abs(beside[j]) < abs(at[j]))
    return found


def narrowed_to(
    n, own, ways, beside1, beside2, corners, load, numbers, first, low, high, parts, before, after, pair, state, c, v,
    work, middle,
):  # fmt: skip
    """Middle of the one of so many parts of a stretch in which a pair's nearness changes its sign [m].

    Parameters
    ----------
    low, high : float
        Ends of the stretch [m].
    before, after : float
        Nearness at both ends, of different signs.
    """
    a, b, f_a, f_b, side = 0, parts, before, after, 0
    while b - a > 1:
        share_of = f_a / (f_a - f_b) if -math.inf < min(f_a, f_b) else 0.5
        m = a + min(max(round(min(max(share_of, 0.02), 0.98) * (b - a)), 1), b - a - 1)
        error, _ = solved(
            n, own, ways, beside1, beside2, corners, load, numbers, first, low + (high - low) * m / parts, state, c, v,
            work,
        )  # fmt: skip
        nearness(n, load, numbers, error, state, c, v, middle)
        if (middle[pair] > 0.0) == (before > 0.0):
            a, f_a = m, middle[pair]
            if side < 0:
                f_b *= 0.5
            side = -1
        else:
            b, f_b = m, middle[pair]
            if side > 0:
                f_a *= 0.5
            side = 1
    return low + (high - low) * (a + 0.5) / parts


def changes(  # noqa: C901  (one search: what it shares is its local variables)
    n, own, ways, beside1, beside2, corners, load, numbers, first, samples, edges, count, state, c, v, work, found
):
    """Places where a pair comes into contact or leaves it, between given ones; how many [m]."""
    known, aside = 0, SIDE * n[PITCH]
    middle, within = np.empty(MOST), np.empty((_PARTS + 1, MOST))
    for i in range(count):
        a, b = edges[i], edges[i + 1] if i + 1 < count else n[START] + n[PITCH]
        if not b - a > 4.0 * aside:
            continue
        cells = max(4, round(samples * (b - a) / n[PITCH]))
        x, values = np.empty(cells + 2), np.empty((cells + 2, MOST))
        x[0], x[cells + 1] = a + aside, b - aside
        for k in range(cells):
            x[1 + k] = a + aside + (b - a - 2.0 * aside) * (k + 0.5) / cells
        for k in range(cells + 2):
            error, _ = solved(n, own, ways, beside1, beside2, corners, load, numbers, first, x[k], state, c, v, work)
            nearness(n, load, numbers, error, state, c, v, values[k])
        for k in range(cells + 1):
            low, high, several, changing, change = x[k], x[k + 1], False, 0, 0
            for j in range(numbers):
                several = several or turns(values[:, :numbers], x, k, j)
                if (values[k, j] > 0.0) != (values[k + 1, j] > 0.0):
                    changing, change = changing + 1, j
            for part in (1, _PARTS - 1):
                if several and changing < 2:
                    at = low + (high - low) * part / _PARTS
                    error, _ = solved(
                        n, own, ways, beside1, beside2, corners, load, numbers, first, at, state, c, v, work
                    )
                    nearness(n, load, numbers, error, state, c, v, middle)
                    several = dips(values[:, :numbers], x, k, middle, part > 1)
            if changing == 1 and not several:
                place = narrowed_to(
                    n, own, ways, beside1, beside2, corners, load, numbers, first, low, high, _PARTS * _FINEST,
                    values[k, change], values[k + 1, change], change, state, c, v, work, middle,
                )  # fmt: skip
                known = inserted(found, known, place)
                continue
            if changing == 0 and not several:
                continue
            within[0], within[_PARTS] = values[k], values[k + 1]
            for part in range(1, _PARTS):
                at = low + (high - low) * part / _PARTS
                error, _ = solved(n, own, ways, beside1, beside2, corners, load, numbers, first, at, state, c, v, work)
                nearness(n, load, numbers, error, state, c, v, within[part])
            first_part, last_part, changed = _PARTS, -1, 0
            for part in range(_PARTS):
                differs = False
                for j in range(numbers):
                    differs = differs or (within[part, j] > 0.0) != (within[part + 1, j] > 0.0)
                if differs:
                    first_part, last_part, changed = min(first_part, part), part, changed + 1
            for part in range(first_part, last_part + 1):
                if changed > _MOST_IN_A_CELL and first_part < part < last_part:
                    continue
                for j in range(numbers):
                    if (within[part, j] > 0.0) != (within[part + 1, j] > 0.0):
                        place = narrowed_to(
                            n, own, ways, beside1, beside2, corners, load, numbers, first,
                            low + (high - low) * part / _PARTS, low + (high - low) * (part + 1) / _PARTS, _FINEST,
                            within[part, j], within[part + 1, j], j, state, c, v, work, middle,
                        )  # fmt: skip
                        known = inserted(found, known, place)
    return known
