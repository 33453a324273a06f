"""Load sharing of one pair after the other, as machine code (numba): plain Python on arrays and numbers.

What is computed is that of `contact.plane`: contacts on the path and at tip corners beyond it (`meshing`, `corners`),
compliances (`pair_compliance`), the contact's law at corners (`edge_law`), active sets with Newton's method
(`load_sharing`). One load is the reference of all compliances, so that shares of it are what is solved for.
"""

# The arrays of these functions are typed by numba from their arguments.
# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

import numpy as np

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
    POWER1,
    POWER2,
    RB1,
    RB2,
    SIDE1,
    SIDE2,
    SOFT1,
    SOFT2,
    START,
    corner_at,
    corner_of,
)

#: Pairs in reach at most, and numbers of one: present, both roll lengths, diagonal, gap, tilt, gamma, room.
MOST, NUMBERS = 7, 8
HERE, LENGTH1, LENGTH2, DIAGONAL, GAP, TILT, WEDGE, ROOM = range(NUMBERS)
_NOMINAL, _REFERENCE = 0.08, 0.02  # half-widths [modules], as of `fe_compliance` and `contact_width`
_SMALLEST, _ROUND_OFF, _STEPS = 1e-20, 1e-15, 40
_A, _B, _C, _SOFTEST = 0.282, 0.241, -0.0436, 1.0  # as of `edge_law`


def own_lengths(base_radius, module, lowest, highest, out):
    """Roll lengths at which c_0 is known; as `fe_compliance.own_lengths`."""
    corner = min(0.1 * module * base_radius / max(abs(highest), 1e-9 * base_radius), 0.3 * (highest - lowest))
    half = (out.size + 1) // 2
    for i in range(half):
        s = i / (half - 1)
        if i < half - 1:
            out[i] = lowest + (highest - corner - lowest) * (s * s * (3.0 - 2.0 * s))
        out[half - 1 + i] = highest - corner * (1.0 - s)


def slopes(x, y, out, low, up):
    """Slopes of the not-a-knot spline at its points; as `spline.spline`, with two arrays to work in."""
    n = x.size
    h0, h1 = x[1] - x[0], x[2] - x[1]
    d0, d1 = (y[1] - y[0]) / h0, (y[2] - y[1]) / h1
    middle = h1
    up[0], low[0] = h0 + h1, h1
    out[0] = ((h0 + 2.0 * (h0 + h1)) * h1 * d0 + h0**2 * d1) / (h0 + h1)
    for i in range(1, n - 1):
        ha, hb = x[i] - x[i - 1], x[i + 1] - x[i]
        da, db = (y[i] - y[i - 1]) / ha, (y[i + 1] - y[i]) / hb
        share = hb / low[i - 1]
        up[i] = ha
        middle = 2.0 * (ha + hb) - share * up[i - 1]
        out[i] = 3.0 * (hb * da + ha * db) - share * out[i - 1]
        low[i] = middle
    ha, hb = x[n - 2] - x[n - 3], x[n - 1] - x[n - 2]
    da, db = (y[n - 2] - y[n - 3]) / ha, (y[n - 1] - y[n - 2]) / hb
    right = ((hb + 2.0 * (ha + hb)) * ha * db + hb**2 * da) / (ha + hb)
    share = (ha + hb) / low[n - 2]
    out[n - 1] = (right - share * out[n - 2]) / (ha - share * up[n - 2])
    for i in range(n - 2, -1, -1):
        out[i] = (out[i] - up[i] * out[i + 1]) / low[i]


def spline_at(x, y, slope, at):
    """The spline at a place."""
    i = min(max(np.searchsorted(x, at, side="right") - 1, 0), x.size - 2)
    h = x[i + 1] - x[i]
    s = (at - x[i]) / h
    rise = (y[i + 1] - y[i]) / h
    return y[i] + s * h * (rise + (1.0 - s) * ((slope[i] - rise) * (1.0 - s) - (slope[i + 1] - rise) * s))


def beside_at(coefficients, p, q):
    """Chebyshev series of two places from -1 to 1."""
    n = coefficients.shape[0]
    total, before, now = 0.0, 1.0, p
    for i in range(n):
        first = 1.0 if i == 0 else now
        if i >= 2:
            now, before = 2.0 * p * now - before, now
            first = now
        inner, b1, b2 = 0.0, 0.0, 0.0
        for j in range(n - 1, 0, -1):  # Clenshaw
            b1, b2 = 2.0 * q * b1 - b2 + coefficients[i, j], b1
        inner = q * b1 - b2 + coefficients[i, 0]
        total += first * inner
    return total


def edge_law(t, gamma, room):
    """Psi and its slope at a corner; as `edge_law.edge_law`."""
    g = min(gamma, _SOFTEST)
    if t <= -1.0:
        farther = max(-t, room)
        return (g * math.log(farther / -t) if farther > -t else 0.0), 0.0
    y = 2.0 / (t + math.sqrt(t * t + 3.0))
    inside = min(t, 0.0)
    psi = 0.5 - 0.375 * y * y - math.log(0.5 * y) + inside * inside
    slope = t * (2.0 - t * y) / (1.5 * y + t) + 2.0 * inside * inside
    if g != 0.0:
        least = _A + g * (_B + g * _C)
        fading = (0.5 * y) ** (0.5 / (0.5 - least))
        share = least + (0.5 - least) * fading
        psi += g * math.log(max(-t, room, 2.3e-308) / (y * share))
        slope += g * (1.0 + t / math.sqrt(t * t + 3.0) * (1.0 + 0.5 * fading / share))
    return psi, slope


def relief_at(amount, begin, power, length, low, high):
    """Removal of a tip relief at a roll length."""
    s = ((length - low) / (high - low) - begin) / (1.0 - begin)
    return amount * max(s, 0.0) ** power if amount != 0.0 else 0.0


def contacts(n, own, ways, corners, load, numbers, first, x, state):
    """Fill in the state of each pair that may touch at a roll position.

    Parameters
    ----------
    n : ndarray
        A pair's numbers.
    own : tuple of arrays
        Of both gears: roll lengths, c_0 and slopes (`own_lengths`, `slopes`).
    ways : ndarray, shape (2, 4)
        Of the driven gear's corner and the driver's (`corner_way`), and how far they may touch (`corner_limit`).
    numbers, first : int
        How many pairs, and which is the first.
    """
    x1, y1, s1, x2, y2, s2 = own
    middle = 0.5 * (n[START] + n[END])
    slack = 1e-10 * n[PITCH]
    kappa, w = (n[KAPPA1] + n[KAPPA2]) / n[FACE], load / n[FACE]
    for j in range(numbers):
        at = x + (first + j) * n[PITCH]
        one = state[j]
        on_path = min(max(at, n[START]), n[END])
        length1, length2 = n[AT1] + on_path, n[AT2] - on_path
        curvature, gap, edge = 1.0 / length1 + 1.0 / length2, math.inf, -math.inf
        if n[START] - slack <= at <= n[END] + slack:
            gap = 0.0
            if corners:
                edge = max(-max(n[SIDE2] * (n[HIGH2] ** 2 - length2**2) / (2.0 * n[RB2]), 0.0),
                           -max(n[SIDE1] * (n[HIGH1] ** 2 - length1**2) / (2.0 * n[RB1]), 0.0))  # fmt: skip
        elif corners:
            before, after = n[START] - at, at - n[END]
            tilt = 0.0
            if 0.0 < before < min(n[PITCH], ways[0, LIMIT]) and n[EARLY] > 0.0:
                gap, length1, tilt = corner_at(before, ways[0], corner_of(n, False))
                curvature = 1.0 / length1 + 1.0 / n[HIGH2]
            elif 0.0 < after < min(n[PITCH], ways[1, LIMIT]) and n[LATE] > 0.0:
                gap, length2, tilt = corner_at(after, ways[1], corner_of(n, True))
                curvature = 1.0 / length2 + 1.0 / n[HIGH1]
            edge = tilt / curvature
        one[HERE] = 1.0 if gap < math.inf else 0.0
        if gap == math.inf:
            continue
        relative = max(1.0 / curvature, 1e-6 * n[MODULE])
        b = math.sqrt(4.0 * w * relative / (math.pi * n[MODULUS]))
        wider = math.log(_NOMINAL * n[MODULE] / b)
        length1, length2 = min(max(length1, n[LOW1]), n[HIGH1]), min(max(length2, n[LOW2]), n[HIGH2])
        c = spline_at(x1, y1, s1, length1) + spline_at(x2, y2, s2, length2) + (n[KAPPA1] + n[KAPPA2]) * wider
        one[LENGTH1], one[LENGTH2], one[DIAGONAL] = length1, length2, c / n[FACE]
        gap += relief_at(n[AMOUNT1], n[BEGIN1], n[POWER1], length1, n[LOW1], n[HIGH1])
        one[GAP] = gap + relief_at(n[AMOUNT2], n[BEGIN2], n[POWER2], length2, n[LOW2], n[HIGH2])
        one[TILT] = edge / b
        soft, ours = (n[SOFT2], n[KAPPA2]) if at < middle else (n[SOFT1], n[KAPPA1])
        one[WEDGE] = soft * ours / n[FACE] / kappa
        one[ROOM] = _REFERENCE * n[MODULE] / b


def couple(n, beside1, beside2, numbers, state, c):
    """Fill in what loads on other pairs do, c[i, j] [m/N]; as `PairCompliance._couple`."""
    reach = beside1.shape[0]
    half1, half2 = 0.5 * (n[HIGH1] - n[LOW1]), 0.5 * (n[HIGH2] - n[LOW2])
    for i in range(numbers):
        for j in range(i + 1, numbers):
            c[i, j] = 0.0
            k = j - i
            if k <= reach and state[i, HERE] > 0.0 and state[j, HERE] > 0.0:
                p1, q1 = (state[i, LENGTH1] - n[LOW1]) / half1 - 1.0, (state[j, LENGTH1] - n[LOW1]) / half1 - 1.0
                p2, q2 = (state[i, LENGTH2] - n[LOW2]) / half2 - 1.0, (state[j, LENGTH2] - n[LOW2]) / half2 - 1.0
                value = beside_at(beside1[k - 1], q1, p1) + beside_at(beside2[k - 1], p2, q2)
                c[i, j] = value / n[FACE]
            c[j, i] = c[i, j]


def linearised(one, half, v):
    """Slope and height of the straight line that touches a contact's approach at a share; as `ContactLaw`."""
    share = max(v, _SMALLEST)
    grown = math.log(share) + 1.0
    slope, height = one[DIAGONAL], half * share
    if one[TILT] > -math.inf:
        root = math.sqrt(share)
        psi, rate = edge_law(one[TILT] / root, one[WEDGE], one[ROOM] / root)
        grown += rate - 2.0 * psi
        height += half * share * rate
    return slope - half * grown, height


def share(half, load, numbers, state, c, v, work):  # noqa: C901  (one iteration)
    """Shares of the load and approach over the load of pairs in a state; as `load_sharing._solve`.

    Parameters
    ----------
    half : float
        kappa / 2 for the whole face [m/N].
    v : ndarray, shape (numbers,)
        Answer.
    work : ndarray, shape (MOST, MOST + 2)
        To work in.

    Returns
    -------
    z, nearest, good : float, float, bool
        Approach over the load beyond that of the nearest pair, whose separation this is [m]; whether it settled.
    """
    nearest, most = math.inf, 0.0
    for i in range(numbers):
        if state[i, HERE] > 0.0:
            nearest = min(nearest, state[i, GAP])
    if nearest == math.inf:
        return math.nan, nearest, False
    for i in range(numbers):
        if state[i, HERE] > 0.0 and state[i, GAP] == nearest:
            most = max(most, state[i, DIAGONAL])
    on = np.zeros(numbers, dtype=np.bool_)
    count = 0
    for i in range(numbers):
        on[i] = state[i, HERE] > 0.0 and (state[i, GAP] - nearest) / load <= most
        count += int(on[i])
    for i in range(numbers):
        v[i] = 1.0 / count if on[i] else _SMALLEST
    z = 0.0
    for _ in range(_STEPS):
        rows = 0
        index = np.empty(numbers, dtype=np.int64)
        for i in range(numbers):
            if on[i]:
                index[rows] = i
                rows += 1
        for a in range(rows):
            i = index[a]
            slope, height = linearised(state[i], half, v[i])
            for b in range(rows):
                work[a, b] = slope if a == b else c[i, index[b]]
            work[a, rows], work[a, rows + 1] = 1.0, height + (state[i, GAP] - nearest) / load
        for a in range(rows):
            for b in range(a + 1, rows):
                factor = work[b, a] / work[a, a]
                for k in range(a + 1, rows + 2):
                    work[b, k] -= factor * work[a, k]
        ones, heights = 0.0, 0.0
        for a in range(rows - 1, -1, -1):
            for k in range(rows, rows + 2):
                for b in range(a + 1, rows):
                    work[a, k] -= work[a, b] * work[b, k]
                work[a, k] /= work[a, a]
            ones += work[a, rows]
            heights += work[a, rows + 1]
        z = (1.0 + heights) / ones
        settled, close = True, True
        new = np.zeros(numbers)
        for a in range(rows):
            new[index[a]] = z * work[a, rows] - work[a, rows + 1]
        keeps = np.zeros(numbers, dtype=np.bool_)
        for i in range(numbers):
            if on[i]:
                keeps[i] = new[i] > 0.0
                close = close and abs(new[i] - v[i]) <= 1e-8 * abs(new[i]) + _ROUND_OFF
                settled = settled and keeps[i]
            elif state[i, HERE] > 0.0:
                gap = (state[i, GAP] - nearest) / load
                left = gap - z
                for j in range(numbers):
                    if on[j]:
                        left += c[i, j] * new[j]
                keeps[i] = left < -1e-15 * (abs(z) + abs(gap))
                settled = settled and not keeps[i]
        if settled and close:
            total = 0.0
            for i in range(numbers):
                total += new[i]
            for i in range(numbers):
                v[i] = new[i] / total
            return z, nearest, True
        for i in range(numbers):
            stays = on[i] and new[i] > 0.0
            v[i] = min(new[i], 1.0) if stays else _SMALLEST
            on[i] = keeps[i]
    return z, nearest, False
