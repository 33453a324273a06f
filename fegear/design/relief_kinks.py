"""Largest and least transmission errors between roll positions: at kinks that move with the reliefs tried.

A peak-to-peak value sits on kinks: where a set of pairs hands over to another the error is largest, where straight
relief starts it is least. Seen at fixed positions only, what a relief leaves has a tooth at every position, and a
descent ends in the first. Between positions everything but the kink itself is taken as straight.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.arrays import Floats


def handed_over(by_set: Floats, slopes: Floats) -> tuple[Floats, Floats]:
    """Largest transmission errors between positions, where another set of pairs takes over, and their slopes.

    Parameters
    ----------
    by_set : ndarray, shape (C, S, P, L)
        Approaches of all sets; the least counts.
    slopes : ndarray, shape (C, 4, S, P, L)

    Returns
    -------
    values, slopes : ndarray, shapes (C, P - 1, L), (C, 4, P - 1, L)
        Of straight lines between the positions; where the error only rises or falls, its value at the first of them.
    """
    least = by_set.argmin(axis=1)[:, None]
    one, other = least[:, :, :-1], least[:, :, 1:]
    f = [np.take_along_axis(by_set[:, :, at], one, axis=1)[:, 0] for at in (slice(None, -1), slice(1, None))]
    g = [np.take_along_axis(by_set[:, :, at], other, axis=1)[:, 0] for at in (slice(None, -1), slice(1, None))]
    with np.errstate(invalid="ignore"):
        rise, fall = f[1] - f[0], g[0] - g[1]
    peak = (rise > 0.0) & (fall > 0.0) & (one != other)[:, 0] & np.isfinite(rise) & np.isfinite(fall)
    value = f[0].copy()
    slope = np.take_along_axis(slopes[:, :, :, :-1], one[:, None], axis=2)[:, :, 0]
    at = np.nonzero(peak)
    if at[0].size:
        c, i, load = at
        s, t = one[c, 0, i, load], other[c, 0, i, load]
        up, down = rise[at], fall[at]
        where = (g[0][at] - f[0][at]) / (up + down)
        value[at] += where * up
        part = down / (up + down)
        first = (1.0 - where)[:, None] * slopes[c, :, s, i, load] + where[:, None] * slopes[c, :, s, i + 1, load]
        second = (1.0 - where)[:, None] * slopes[c, :, t, i, load] + where[:, None] * slopes[c, :, t, i + 1, load]
        slope[c, :, i, load] = part[:, None] * first + (1.0 - part)[:, None] * second
    return value, slope


def relief_starts(gear: int, depth: Floats, p: Floats, found: tuple[Floats, Floats, Floats]) -> tuple[Floats, Floats]:
    """Transmission errors where straight reliefs of a gear start between positions, and their slopes.

    Parameters
    ----------
    gear : int
        0 or 1.
    depth : ndarray, shape (n, P)
        Distance of each contact from the gear's tip over the path of contact.
    p : ndarray, shape (C, 4)
        Candidates, see `Trials`.
    found : tuple of ndarray
        Transmission error, shape (C, P, L) [m], its derivatives by the four numbers, (C, 4, P, L), and by the
        removals of the pairs, (C, n, P, L).

    Returns
    -------
    values, slopes : ndarray, shapes (C, P - 1, L), (C, 4, P - 1, L)
        Where nothing starts, the value at the first of both positions.
    """
    zeta, slope, weight = found
    amount, length = p[:, 2 * gear], p[:, 2 * gear + 1]
    inside = depth < length[:, None, None]
    value, its_slope = zeta[:, :-1].copy(), slope[:, :, :-1].copy()
    c, j, i = np.nonzero(inside[:, :, 1:] != inside[:, :, :-1])
    if not c.size:
        return value, its_slope
    forward = inside[c, j, i + 1]
    out, into = np.where(forward, i, i + 1), np.where(forward, i + 1, i)
    d_out, d_in, length, amount = depth[j, out], depth[j, into], length[c], amount[c]
    at = ((d_out - length) / (d_out - d_in))[:, None]
    removed = 1.0 - d_in / length
    v = 0.5 * (weight[c, j, i] + weight[c, j, i + 1])
    change = zeta[c, into] - zeta[c, out] - v * (amount * removed)[:, None]
    value[c, i] = zeta[c, out] + at * change
    by = (1.0 - at[..., None]) * slope[c, :, out] + at[..., None] * slope[c, :, into]
    by[:, 2 * gear] -= v * at * removed[:, None]
    by[:, 2 * gear + 1] -= v * at * (amount * d_in / length**2)[:, None] + change / (d_out - d_in)[:, None]
    its_slope[c, :, i] = by
    return value, its_slope
