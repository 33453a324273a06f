"""Extremes and mean squares over a cycle of what moves in modes: places that no wave of a mode slips through.

A piece between break points is cut into parts of half a wave of the fastest mode that still rings there. In a part all
is as good as a polynomial through its points, whose highest place is looked for between them as well; both ends of a
piece are points, so that jumps are seen from either side.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.dynamics.planetary.steady_modes import PiecewiseForces, SteadyModes

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(8)
#: Points of a part: Gauss's, which carry its integrals, between its ends.
_POINTS = np.concatenate([[-1.0], _GAUSS, [1.0]])
_SHARES = 0.5 * np.concatenate([[0.0], _WEIGHTS, [0.0]])
_TO_LEGENDRE = np.linalg.inv(np.polynomial.legendre.legvander(_POINTS, _POINTS.size - 1))
#: Places at which the polynomial of a part is looked at, and then again between those beside the highest.
_LOOKED_AT = np.linspace(-1.0, 1.0, 33)
_COARSE = np.polynomial.legendre.legvander(_LOOKED_AT, _POINTS.size - 1) @ _TO_LEGENDRE
#: By how much of what a force ranges over its highest place in a part may lie above those looked at: these stand a 64th
#: of half a wave to either side of it.
_BETWEEN = 2e-3
#: Half-waves of the fastest mode in a piece up to which it is not asked which modes still ring.
_FEW = 8
#: Ringing that is forgotten, relative to the forces.
_SILENT = 1e-10
#: Parts that are looked at together, and in a cycle at most.
_BLOCK, _MOST = 2048, 400_000


class CycleForces(NamedTuple):
    """Forces that modes and a fluctuating approach make together: stiffness * (rows @ modes - error).

    Parameters
    ----------
    stiffness : ndarray, shape (F,)
        [N/m]
    rows : ndarray, shape (F, J)
        Approach of each mode.
    error : PiecewiseForces
        Subtracted from it [m].
    """

    stiffness: Array
    rows: Array
    error: PiecewiseForces


class CycleExtremes(NamedTuple):
    """What a cycle shows.

    Parameters
    ----------
    force : ndarray, shape (2, F)
        Largest (0) and smallest (1) value of each force [N].
    place : ndarray, shape (2, F)
        Where they stand [periods].
    squares : ndarray, shape (J, J)
        Means over the cycle of products of two modal coordinates.
    """

    force: Array
    place: Array
    squares: Array


def cycle_extremes(modes: SteadyModes, natural: Array, forces: CycleForces) -> CycleExtremes:
    """Look at all of a cycle.

    Parameters
    ----------
    modes : SteadyModes
    natural : ndarray, shape (J,)
        Undamped natural frequencies [rad/s].
    forces : CycleForces

    Raises
    ------
    RangeError
        If modes ring on through more waves than can be looked at.
    """
    error = forces.error
    loud = np.abs(forces.stiffness[:, None] * forces.rows).max(axis=0) / modes.rate.imag
    scale = float(np.max(forces.stiffness[:, None] * np.abs(error.rows).sum(axis=2)))
    piece, low, high = _parts(modes, natural, loud, _SILENT * scale)
    best = np.array([np.full(forces.stiffness.size, -np.inf)] * 2)
    place = np.zeros_like(best)
    squares = np.zeros((natural.size, natural.size))
    for first in range(0, piece.size, _BLOCK):
        own = slice(first, first + _BLOCK)
        middle, half = 0.5 * (low[own] + high[own])[:, None], 0.5 * (high[own] - low[own])[:, None]
        v = middle + half * _POINTS
        x = modes.at(piece[own], v).reshape(natural.size, -1)
        weight = (half * error.widths[piece[own]][:, None] * _SHARES).ravel()
        squares += (x * weight) @ x.T
        found = (forces.rows @ x).reshape(-1, *v.shape) - error.at(piece[own], v)
        found *= forces.stiffness[:, None, None]
        for side, sign in enumerate((1.0, -1.0)):
            top, part, where = _highest(sign * found)
            better = top > best[side]
            best[side, better] = top[better]
            i = part + first
            start, width = error.starts[piece[i]], error.widths[piece[i]]
            v_top = low[i] + 0.5 * (high[i] - low[i]) * (where + 1.0)
            place[side, better] = (start + 0.5 * width * (v_top + 1.0))[better]
    best[1] *= -1.0
    return CycleExtremes(best, place, squares)


def _highest(values: Array) -> tuple[Array, Array, Array]:
    """Largest values over parts known at `_POINTS`, shape (F, parts, points): value, part, and place in it."""
    coarse = values @ _COARSE.T
    tops = coarse.max(axis=2)
    high, low = tops.max(axis=1, keepdims=True), coarse.min(axis=(1, 2))[:, None]
    # Of several parts as high as each other the highest may look lower: each is looked at again.
    row, part = np.nonzero(tops >= high - _BETWEEN * (high - low))
    step = _LOOKED_AT[1] - _LOOKED_AT[0]
    middle = np.clip(_LOOKED_AT[coarse[row, part].argmax(axis=1)], -1.0 + step, 1.0 - step)
    fine = middle[:, None] + step * _LOOKED_AT
    own = values[row, part] @ _TO_LEGENDRE.T
    found = np.einsum("cqn,cn->cq", np.polynomial.legendre.legvander(fine, _POINTS.size - 1), own)
    best = found.argmax(axis=1)
    at = np.clip(best, 1, _LOOKED_AT.size - 2)
    each = np.arange(best.size)
    before, here, after = (found[each, at + k] for k in (-1, 0, 1))
    bend = before - 2.0 * here + after
    inside = (best == at) & (bend < 0.0)
    shift = np.where(inside, 0.5 * (before - after) / np.where(inside, bend, -1.0), 0.0)
    value = np.where(inside, here - 0.25 * (before - after) * shift, found[each, best])
    place = fine[each, best] + shift * step * step
    order = np.lexsort((-part, value, row))  # of equal ones the first
    last = order[np.append(np.diff(row[order]) > 0, True)]
    return value[last], part[last], place[last]


def _parts(modes: SteadyModes, natural: Array, loud: Array, silent: float) -> tuple[Array, Array, Array]:
    """Parts of all pieces, each of half a wave at most: number of its piece, and from where to where in it."""
    fastest = float(natural.max())
    waves = np.maximum(np.ceil(2.0 * modes.halves * fastest / math.pi), 1.0)
    few = waves <= _FEW
    pieces, lows, highs = [], [], []
    for count in np.unique(waves[few]).astype(int):
        own = np.flatnonzero(waves == count)
        edges = np.linspace(-1.0, 1.0, count + 1)
        pieces.append(np.repeat(own, count))
        lows.append(np.tile(edges[:-1], own.size))
        highs.append(np.tile(edges[1:], own.size))
    order = np.argsort(natural)[::-1]
    damping = -modes.rate.real
    for i in np.flatnonzero(~few):
        with np.errstate(divide="ignore", invalid="ignore"):
            times = np.log(np.abs(modes.ringing[:, i]) * loud / silent)
            times = np.where(times > 0.0, np.where(damping > 0.0, times / damping, np.inf), 0.0)
        duration, now = 2.0 * float(modes.halves[i]), 0.0
        ends = [np.zeros(1)]
        for j in order:
            until = min(float(times[j]), duration)
            if until > now:
                count = math.ceil((until - now) * natural[j] / math.pi)
                if count > _MOST:
                    raise RangeError(
                        "speed", f"a mesh frequency of {1.0 / (2.0 * modes.halves.sum()):.3g} Hz",
                        "is too low: too many oscillation cycles between two tooth engagements",
                        "increase damping_ratio or the minimum speed",
                    )  # fmt: skip
                ends.append(np.linspace(now, until, count + 1)[1:])
                now = until
        if now < duration:
            ends.append(np.array([duration]))
        v = 2.0 * np.concatenate(ends) / duration - 1.0
        v[-1] = 1.0
        pieces.append(np.full(v.size - 1, i))
        lows.append(v[:-1])
        highs.append(v[1:])
    return np.concatenate(pieces), np.concatenate(lows), np.concatenate(highs)
