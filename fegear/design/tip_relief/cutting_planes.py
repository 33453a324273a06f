"""Least of a convex function of a few numbers within a box, many problems at once: Kelley's cutting planes.

The function lies above each of its tangents. The lowest point of a set of tangents within the box is a small linear
programme; the tangent at that point joins the set, and so on until the function there is no higher than the tangents
say. The programme is followed by the dual simplex method: one tangent, or one face of the box, enters and one leaves,
so that d + 1 planes are kept for d numbers and every step is a handful of products, the same for all problems. Of a
peak-to-peak value, the largest of finitely many linear functions, this ends at the least itself.

J. E. Kelley, The cutting-plane method for solving convex programs, J. SIAM 8 (1960) 703-712.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fegear.base.arrays import Floats

_ROUND_OFF = 1e-10


def least_in_box(
    tangent: Callable[[Floats], tuple[Floats, Floats]],
    low: Floats,
    high: Floats,
    tolerance: float,
    most: int = 60,
    share: float = 0.0,
) -> tuple[Floats, Floats, Floats]:
    """Find the least of B convex functions of d numbers within boxes about zero.

    Parameters
    ----------
    tangent : callable
        Of points, shape (B, d): the B values and gradients there, shapes (B,), (B, d).
    low, high : ndarray, shape (B, d)
        Not above and not below zero, and best of the order of one.
    tolerance : float
        What the value found may lie above the tangents, over the value at zero.
    most : int
        Tangents to a problem at most.
    share : float
        Or over how far the tangents are below the value at zero, where that is more.

    Returns
    -------
    best : ndarray, shape (B, d)
        Lowest points found.
    found : ndarray, shape (B,)
        Values there.
    bound : ndarray, shape (B,)
        What the functions do not fall below within their boxes.
    """
    count, d = low.shape
    start, slope = tangent(np.zeros((count, d)))
    allowed = tolerance * np.abs(start)
    # Planes a . (x, value) >= b; the first are the tangent at zero and the faces to which it descends.
    rises = slope > 0.0
    sign = np.where(rises, 1.0, -1.0)
    right = np.concatenate([np.where(rises, low, -high), start[:, None]], axis=1)
    pull = np.concatenate([np.abs(slope), np.ones((count, 1))], axis=1)
    inverse = np.zeros((count, d + 1, d + 1))
    inverse[:, range(d), range(d)] = sign
    inverse[:, d, :d] = slope * sign
    inverse[:, d, d] = 1.0
    best, found, bound = np.zeros((count, d)), start.copy(), np.full(count, -np.inf)
    rows, faces = np.arange(count), np.concatenate([np.eye(d), -np.eye(d)])
    for _ in range(most):
        vertex = (inverse @ right[:, :, None])[..., 0]
        x, bound = vertex[:, :d], np.maximum(bound, vertex[:, d])
        outside = np.concatenate([low - x, x - high], axis=1)
        face = outside.argmax(axis=1)
        beyond = outside[rows, face] > _ROUND_OFF
        value, slope = tangent(x)
        better = ~beyond & (value < found)
        best[better], found[better] = x[better], value[better]
        open_ = found - bound > np.maximum(allowed, share * (start - bound))
        if not open_.any():
            break
        plane = np.concatenate([-slope, np.ones((count, 1))], axis=1)
        plane[beyond] = 0.0
        plane[beyond, :d] = faces[face[beyond]]
        offset = np.where(beyond, np.concatenate([low, -high], axis=1)[rows, face], value - (slope * x).sum(axis=1))
        part = (plane[:, None] @ inverse)[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            room = np.where(part > _ROUND_OFF, pull / part, np.inf)
        leaves = room.argmin(axis=1)
        step = room[rows, leaves]
        go = open_ & np.isfinite(step)
        if not go.any():
            break
        step = np.where(go, step, 0.0)
        pull -= step[:, None] * part
        np.maximum(pull, 0.0, out=pull)
        pull[rows[go], leaves[go]] = step[go]
        pivot = part[rows, leaves]
        part[rows, leaves] -= 1.0
        change = inverse[rows, :, leaves] / np.where(go, pivot, np.inf)[:, None]
        inverse -= change[:, :, None] * part[:, None]
        right[rows[go], leaves[go]] = offset[go]
    return best, found, bound
