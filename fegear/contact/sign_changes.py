"""Where functions that are known at sample points change their sign: every such place, also of several in one cell.

Contact comes and goes at such places: a tooth pair carries where its load is positive, and where it is apart its gap
says how near the next contact is. Two changes may lie between two sample points, of two pairs or of one that touches
and parts again; what keeps the first of them depends on the way along which it is looked for.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fegear.base.arrays import Array, Index, Mask

#: Parts into which a pass cuts every cell in question: as fast as cutting them in two, for all are computed at once.
_PARTS = 32
#: Changes of sign within a cell beyond which a function hovers at zero.
_MOST_IN_A_CELL = 8


def sign_changes(nearness: Callable[[Array], Array], x: Array, piece: Index, passes: int) -> Array:
    """Places at which any of n functions becomes positive, or ceases to be, ascending.

    Parameters
    ----------
    nearness : callable
        Values of the functions, shape (n, P), at places of shape (P,): smooth on either side of a change, so that
        neighbouring values tell how near the next one may be; infinite where there is nothing to change.
    x : ndarray, shape (P,)
        Sample points, ascending.
    piece : ndarray of int, shape (P,)
        Numbers of the smooth pieces on which they lie; what jumps from one piece to the next is no change.
    passes : int
        Each finds a place 32 times as exactly.
    """
    values = nearness(x)
    looked_at = _may_change(x, piece, values)
    low, high = x[:-1][looked_at], x[1:][looked_at]
    first, last = values[:, :-1][:, looked_at] > 0.0, values[:, 1:][:, looked_at] > 0.0
    end = np.zeros(low.size, dtype=np.intp)
    inside = np.arange(1, _PARTS) / _PARTS
    for _ in range(passes):
        if not low.size:
            break
        ends = np.concatenate([low[None], low + inside[:, None] * (high - low), high[None]])
        between = nearness(ends[1:-1].ravel()).reshape(-1, _PARTS - 1, low.size) > 0.0
        positive = np.concatenate([first[:, None], between, last[:, None]], axis=1)
        part, cell, end = _followed((positive[:, 1:] != positive[:, :-1]).any(axis=0), end)
        low, high = ends[part, cell], ends[part + 1, cell]
        first, last = positive[:, part, cell], positive[:, part + 1, cell]
    return np.sort(0.5 * (low + high))


def _followed(changes: Mask, end: Index) -> tuple[Index, Index, Index]:
    """Parts and cells of the changes to follow, and at which end of a hovering function each stands.

    Where the sign changes in many parts of a cell it is that of round-off: flanks that are designed to touch without
    load do so. Of such a cell the first and the last change are followed, and of theirs only the outermost.

    Parameters
    ----------
    changes : ndarray of bool, shape (parts, cells)
    end : ndarray of int, shape (cells,)
        -1 where only the first change is followed, 1 where only the last, 0 where all are.
    """
    hovers = (changes.sum(axis=0) > _MOST_IN_A_CELL) & (end == 0)
    wanted = changes & (~hovers & (end == 0))
    part, cell = np.nonzero(wanted)
    ends = np.zeros(cell.size, dtype=np.intp)
    some = changes.any(axis=0)
    first, last = np.flatnonzero((hovers | (end < 0)) & some), np.flatnonzero((hovers | (end > 0)) & some)
    return (
        np.concatenate([part, changes[:, first].argmax(axis=0), _PARTS - 1 - changes[::-1, last].argmax(axis=0)]),
        np.concatenate([cell, first, last]),
        np.concatenate([ends, np.full(first.size, -1), np.full(last.size, 1)]),
    )


def _may_change(x: Array, piece: Index, nearness: Array) -> Mask:
    """Cells in which a function changes its sign, or comes so near to zero that it may do so twice, shape (P - 1,)."""
    same_piece = piece[1:] == piece[:-1]
    positive = nearness > 0.0
    alike = positive[:, 1:] == positive[:, :-1]
    with np.errstate(invalid="ignore"):  # where nothing can change
        slope = np.abs(np.diff(nearness) / np.diff(x))
    slope = np.where(same_piece & alike & np.isfinite(slope), slope, 0.0)
    # it may reach zero if it goes on as steeply as in the cell beside
    steepest = np.zeros_like(slope)
    steepest[:, 1:] = slope[:, :-1]
    steepest[:, :-1] = np.maximum(steepest[:, :-1], slope[:, 1:])
    nearest = np.minimum(np.abs(nearness[:, :-1]), np.abs(nearness[:, 1:]))
    turns = steepest * np.diff(x) > nearest
    return np.asarray(same_piece & (~alike | turns).any(axis=0))
