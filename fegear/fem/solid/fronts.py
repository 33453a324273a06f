"""Parts of a solid sector joined and eliminated in place, in one piece of memory that all of them share.

A front is what the halves of a part are together, split where LAPACK wants it: the unknowns that go, those that stay,
and the block between. Factor, solution and what is left take the place of what they are made from; only lower triangles
are added and read. What is left of parts at even and at odd depths is piled up from either end of the memory, so that
each pile grows and shrinks at its end alone (the stack of multifrontal methods, Duff and Reid 1983), and no page is
asked for twice: with matrices of a hundred megabytes fresh pages take longer than the sums that fill them.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import FegearError
from fegear.fem.plane.condensation import Eliminated

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.arrays import Array, Index

#: Columns that are added at once: beside the diagonal as many rows more than needed.
_BLOCK = 256


class Node(NamedTuple):
    """A part before anything is computed.

    Attributes
    ----------
    ids : ndarray of int, shape (n + m,)
        Its unknowns as they are numbered in the order of elimination, ascending.
    gone : int
        n, how many of them go.
    halves : tuple of Node
        What it joins; none of a smallest part.
    elements : ndarray of int
        Of a smallest part.
    """

    ids: Index
    gone: int
    halves: tuple[Node, ...]
    elements: Index

    @property
    def left(self) -> Index:
        """Unknowns that stay."""
        return self.ids[self.gone :]


class Front(NamedTuple):
    """Matrices of a part, columns one after the other in memory.

    Attributes
    ----------
    inner : ndarray, shape (n, n)
        Stiffness between the unknowns that go; of this and of `rest` only the lower triangle is sure to be there.
    border : ndarray, shape (m, n)
    rest : ndarray, shape (m, m)
    """

    inner: Array
    border: Array
    rest: Array

    def block(self, rows: slice, columns: slice) -> Array:
        """Part of the lower triangle of all; neither rows nor columns may reach beyond those that go and stay."""
        n = self.inner.shape[0]
        if rows.start < n:
            return self.inner[rows, columns]
        rows = slice(rows.start - n, rows.stop - n)
        if columns.start < n:
            return self.border[rows, columns]
        return self.rest[rows, columns.start - n : columns.stop - n]


def joined(halves: tuple[Node, ...], end: int) -> Node:
    """A part of which the unknowns numbered below `end` go."""
    low, high = min(int(half.left[0]) for half in halves), max(int(half.left[-1]) for half in halves)
    there = np.zeros(high - low + 1, dtype=bool)
    for half in halves:
        there[half.left - low] = True
    ids = np.flatnonzero(there) + low
    return Node(ids, int(np.searchsorted(ids, end)), halves, np.zeros(0, dtype=np.int64))


@dataclass
class _Memory:
    """Two piles in one piece of memory, and how high they are."""

    numbers: Array
    heights: list[int]

    def matrix(self, pile: int, *shape: int) -> Array:
        """A matrix on top of a pile, its entries as they were left."""
        size = shape[0] * shape[1]
        start = self.heights[0] if pile == 0 else self.numbers.size - self.heights[1] - size
        self.heights[pile] += size
        return self.numbers[start : start + size].reshape(shape, order="F")


def _needed(node: Node, depth: int, heights: tuple[int, int]) -> int:
    """Numbers that the memory must have for a part while the piles are so high."""
    now, most = list(heights), 0
    for half in node.halves:
        most = max(most, _needed(half, depth + 1, (now[0], now[1])))
        now[(depth + 1) % 2] += half.left.size**2
    n, m = node.gone, node.left.size
    return max(most, sum(now) + n * n + m * n + (m * m if depth else 0))


def eliminated(
    root: Node, smallest: Callable[[Index, Front], None], old: Index, steps: list[Eliminated] | None
) -> Array:
    """Eliminate what goes in all parts.

    Parameters
    ----------
    root : Node
        The whole.
    smallest : callable
        Writes the stiffness of elements into their front, whose entries are whatever stood there.
    old : ndarray of int
        Of each unknown in the order of elimination the number that `steps` are to say.
    steps : list of Eliminated or None
        To which what was eliminated is added.

    Returns
    -------
    ndarray, shape (m, m)
        Stiffness between what is left of the whole, its lower triangle, columns one after the other.

    Raises
    ------
    FegearError
        If the stiffness is not positive definite.
    """
    # Zeros, not whatever stood there: above the diagonal finite numbers are added up that nobody reads.
    memory = _Memory(np.zeros(_needed(root, 0, (0, 0))), [0, 0])
    return _left_of(root, 0, memory, smallest, old, steps)


def _left_of(
    node: Node, depth: int, memory: _Memory, smallest: Callable[[Index, Front], None], old: Index,
    steps: list[Eliminated] | None,
) -> Array:  # fmt: skip
    """Stiffness between what is left of a part, on top of its depth's pile; of the whole in memory of its own."""
    other, pile = memory.heights[(depth + 1) % 2], depth % 2
    below = [_left_of(half, depth + 1, memory, smallest, old, steps) for half in node.halves]
    n, m = node.gone, node.left.size
    rest = memory.matrix(pile, m, m) if depth else np.zeros((m, m), order="F")
    height = memory.heights[pile]
    if steps is None:
        front = Front(memory.matrix(pile, n, n), memory.matrix(pile, m, n), rest)
    else:  # factor and border are wanted later
        front = Front(np.zeros((n, n), order="F"), np.zeros((m, n), order="F"), rest)
    if node.halves:
        for i, (half, stiffness) in enumerate(zip(node.halves, below, strict=True)):
            _add(front, stiffness, np.searchsorted(node.ids, half.left), first=i == 0)
    else:
        smallest(node.elements, front)
    left = _without(node, front, old, steps)
    memory.heights[pile], memory.heights[1 - pile] = height, other
    return left


def _add(front: Front, stiffness: Array, at: Index, *, first: bool) -> None:
    """Add what is left of a half, whose unknowns stand at ascending places of the front, run by run.

    The first half is put there, and zeros beside it.
    """
    n, size = front.inner.shape[0], front.inner.shape[0] + front.rest.shape[0]
    ends = at[np.flatnonzero(np.diff(at, append=-1) != 1)] + 1
    starts = at[np.flatnonzero(np.diff(at, prepend=-2) != 1)]
    places = np.unique(np.concatenate([[0, n, size], starts, ends]))
    own = np.searchsorted(at, places)
    runs = [
        (low, high, begin if begin < end else None)
        for (low, high), (begin, end) in zip(
            itertools.pairwise(places.tolist()), itertools.pairwise(own.tolist()), strict=True
        )
        if first or begin < end
    ]
    for i, (start, stop, begin) in enumerate(runs):
        for left in range(start, stop, _BLOCK):
            right = min(left + _BLOCK, stop)
            for low, high, row in [(left, stop, None if begin is None else begin + left - start), *runs[i + 1 :]]:
                target = front.block(slice(low, high), slice(left, right))
                if begin is None or row is None:
                    target.fill(0.0)
                    continue
                block = stiffness[row : row + high - low, begin + left - start : begin + right - start]
                if first:
                    target[...] = block
                else:
                    target += block


def _without(node: Node, front: Front, old: Index, steps: list[Eliminated] | None) -> Array:
    """What is left of a front, in its own place, when its unknowns are gone."""
    from scipy.linalg import blas, lapack

    if node.gone == 0:
        return front.rest
    factor, failed = lapack.dpotrf(front.inner, lower=1, overwrite_a=1)
    if failed:
        raise FegearError("the sector's stiffness cannot be factored: it is not positive definite")
    border, rest = front.border, front.rest
    if node.left.size:
        border = blas.dtrsm(1.0, factor, border, side=1, lower=1, trans_a=1, overwrite_b=1)
        rest = blas.dsyrk(-1.0, border, beta=1.0, c=rest, lower=1, overwrite_c=1)
    if steps is not None:
        steps.append(Eliminated(old[node.ids[: node.gone]], old[node.left], factor, border.T))
    return np.asarray(rest)
