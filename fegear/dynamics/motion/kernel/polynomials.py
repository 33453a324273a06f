"""Polynomials in time over one step: values, shifts, crossings of zero, largest forces."""

from __future__ import annotations

import math
from typing import Any


# The arrays of these functions are typed by numba from their arguments.
def value_at(row: Any, t: float) -> float:
    """Value of a polynomial, lowest power first."""
    value = 0.0
    for k in range(row.shape[0] - 1, -1, -1):
        value = value * t + row[k]
    return value


def slope_at(row: Any, t: float) -> float:
    """Its derivative."""
    value = 0.0
    for k in range(row.shape[0] - 1, 0, -1):
        value = value * t + k * row[k]
    return value


def shift_in_time(row: Any, v: float, scale: float, out: Any) -> None:
    """Coefficients in time from here on, of a polynomial in v whose v advances by `scale` per unit time."""
    n = row.shape[0]
    for k in range(n):
        out[k] = row[k]
    for j in range(n):
        for k in range(n - 2, j - 1, -1):
            out[k] += v * out[k + 1]
    power = 1.0
    for k in range(n):
        out[k] *= power
        power *= scale


def _root(row: Any, low: float, high: float, sign: float) -> float:
    """Where sign * polynomial falls through zero between low (above zero) and high (not above)."""
    x = 0.5 * (low + high)
    for _ in range(200):
        value, slope = 0.0, 0.0
        for k in range(row.shape[0] - 1, -1, -1):
            slope = slope * x + value
            value = value * x + row[k]
        if sign * value > 0.0:
            low = x
        else:
            high = x
        if high - low <= 4e-16 * high:
            break
        new = x - value / slope if slope != 0.0 else low
        if not (low < new < high):
            new = 0.5 * (low + high)
        if abs(new - x) <= 1e-16 * abs(x):
            x = new
            break
        x = new
    return high if sign * value_at(row, x) > 0.0 else x


def _first_dip(row: Any, low: float, at_low: float, high: float, at_high: float, sign: float) -> float:
    """Where sign * polynomial, positive at both ends of the first interval, is not so between them, or -1.

    It is the bottom of the parabola through both values with the slope at the lower end.
    """
    fall = -sign * slope_at(row, low)
    bend = (at_high - at_low) / (high - low) + fall
    if fall > 0.0 and bend > 0.0:
        bottom = low + 0.5 * fall * (high - low) / bend
        if bottom < high and sign * value_at(row, bottom) <= 0.0:
            return bottom
    return -1.0


def first_crossing(row: Any, h: float, sign: float, moment: float) -> float:
    """First time in (0, h] at which sign * polynomial is no longer positive, or -1.

    A contact that has just changed lies within round-off of zero, on either side: it is looked at a `moment` later, a
    millionth of the step that the motion allows, however short h is. What is clear of zero and changes within that
    moment does so in its own time. Else two teeth that close in together would each be found open and closed in turn,
    and time would stand still.
    """
    reach = 0.0
    power = 1.0
    for k in range(1, row.shape[0]):
        power *= h
        reach += abs(row[k]) * power
    if sign * row[0] > reach:
        return -1.0
    samples = 16
    before, last = moment, sign * value_at(row, moment)
    if last <= 0.0:
        when = _root(row, 0.0, moment, sign) if sign * row[0] > 0.0 else 0.0
        return when if when <= h else -1.0
    if moment >= h:
        return -1.0
    older_t, older = before, last
    for j in range(1, samples + 1):
        t = h * j / samples
        value = sign * value_at(row, t)
        if value <= 0.0:
            return _root(row, before, t, sign)
        bottom = _first_dip(row, before, last, t, value, sign) if j == 1 else -1.0
        if bottom >= 0.0:
            return _root(row, before, bottom, sign)
        if j > 1 and last < older and last <= value:
            # a dip between samples: look at the bottom of the parabola through them
            d1, d2 = (last - older) / (before - older_t), (value - last) / (t - before)
            bend = (d2 - d1) / (t - older_t)
            if bend > 0.0:
                bottom = 0.5 * (older_t + before) - 0.5 * d1 / bend
                if older_t < bottom < t and sign * value_at(row, bottom) <= 0.0:
                    return _root(row, older_t, bottom, sign)
        older_t, older = before, last
        before, last = t, value
    return -1.0


def _load(force: Any, slide: Any, n_springs: int, mesh_of: Any, m: int, pick: int, t: float, sign: float) -> float:
    """Force of mesh m at time t of the step, or, for pick >= 0, what spring `pick` carries of it.

    Springs share the damping force in proportion to what they bear. Two that begin to bear within round-off of each
    other are a difference of nothing for a moment, one of them by a last digit below zero, while the damping force of
    the impact is finite: so a share is taken of what pushes alone, and lies between none and all.
    """
    elastic, pushing, own = 0.0, 0.0, 0.0
    for s in range(n_springs):
        if mesh_of[s] == m:
            value = value_at(force[s], t)
            elastic += value
            pushing += abs(value) if value * sign > 0.0 else 0.0
            if s == pick:
                own = abs(value) if value * sign > 0.0 else 0.0
    total = elastic + value_at(slide[m], t)
    if pick < 0:
        return total
    return own * total / pushing if pushing != 0.0 else 0.0


def largest_force(
    force: Any, slide: Any, n_springs: int, mesh_of: Any, m: int, pick: int, h: float, sign: float
) -> float:
    """Largest of sign * load over one step: samples, then golden section around the best."""
    samples = 12
    best_j, best = 0, -math.inf
    for j in range(samples + 1):
        value = sign * _load(force, slide, n_springs, mesh_of, m, pick, h * j / samples, sign)
        if value > best:
            best_j, best = j, value
    low, high = h * max(best_j - 1, 0) / samples, h * min(best_j + 1, samples) / samples
    golden = 0.6180339887498949
    a, b = high - golden * (high - low), low + golden * (high - low)
    fa = sign * _load(force, slide, n_springs, mesh_of, m, pick, a, sign)
    fb = sign * _load(force, slide, n_springs, mesh_of, m, pick, b, sign)
    for _ in range(36):
        if fa > fb:
            high, b, fb = b, a, fa
            a = high - golden * (high - low)
            fa = sign * _load(force, slide, n_springs, mesh_of, m, pick, a, sign)
        else:
            low, a, fa = a, b, fb
            b = low + golden * (high - low)
            fb = sign * _load(force, slide, n_springs, mesh_of, m, pick, b, sign)
    return max(best, fa, fb)
