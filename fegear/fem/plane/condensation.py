"""Static condensation of a sector onto the few unknowns that matter, by halving it again and again.

The elements are split in two along the longer side of the box around them, each half in two again, down to a handful
of elements. From the bottom up, each part eliminates the unknowns that no other part shares and that no result needs
(nested dissection, George 1973), by dense Cholesky factors. What is left in the end is the stiffness between the kept
unknowns, as dense as it must be; no factor of the whole and no right-hand side is needed.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import cast

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import FegearError
from fegear.fem.plane.elasticity import SectorElasticity
from fegear.fem.plane.scikit_fem_solver import between_kept

#: Unknowns that a smallest part has about, with its elements' own ones gone: fewer cost calls, more cost arithmetic.
_SMALLEST_PART = 160
#: Runs of unknowns on average at least so long are added run by run.
_SHORTEST_RUN = 24
#: Rows that are copied from below the diagonal to beside it at once.
_BLOCK = 256


@dataclass(frozen=True)
class Eliminated:
    """What one part (or a stack of elements) eliminated: u_gone = -factor^-T border u_left."""

    gone: Index
    left: Index
    factor: Array
    border: Array


@dataclass(frozen=True)
class Condensed:
    """A sector's stiffness between its kept unknowns.

    Attributes
    ----------
    kept : ndarray of int, shape (n,)
    stiffness : ndarray, shape (n, n)
    size : int
        Unknowns of the sector.
    steps : tuple of Eliminated
        What `expand` goes through backwards.
    motions : ndarray, shape (size, n), optional
        In their place: of every unknown with one of the kept ones moved by one (`scikit_fem_solver`).
    """

    kept: Index
    stiffness: Array
    size: int
    steps: tuple[Eliminated, ...]
    motions: Array | None = None

    def expand(self, displacement: Array) -> Array:
        """Displacement of every unknown from that of the kept ones (unloaded elsewhere), shape (size, P)."""
        from scipy.linalg import solve_triangular

        if self.motions is not None:
            return np.asarray(self.motions @ displacement)
        u = np.zeros((self.size, displacement.shape[1]))
        u[self.kept] = displacement
        for step in reversed(self.steps):
            if step.factor.ndim == 2:
                inner = solve_triangular(step.factor, step.border @ u[step.left], lower=True, trans="T")
            else:
                inner = np.linalg.solve(step.factor.transpose(0, 2, 1), step.border @ u[step.left])
            u[step.gone] = -inner
        return u

    def collect(self, forces: Array) -> Array:
        """Forces on the kept unknowns that do to them what forces on any unknowns do, shape (n, P).

        The counterpart of `expand`: what is watched inside by weights follows from the kept unknowns by these.
        """
        if self.motions is not None:
            return np.asarray(self.motions.T @ forces)
        from scipy.linalg import solve_triangular

        left = np.array(forces, dtype=float)
        for step in self.steps:
            if step.factor.ndim == 2:
                inner = solve_triangular(step.factor, left[step.gone], lower=True)
                left[step.left] -= step.border.T @ inner
            else:
                inner = np.linalg.solve(step.factor, left[step.gone])
                np.subtract.at(left, step.left, step.border.transpose(0, 2, 1) @ inner)
        return np.asarray(left[self.kept])


def condense(elasticity: SectorElasticity, kept: Index, held: Index, *, expandable: bool = False) -> Condensed:
    """Eliminate every unknown that is neither kept nor held.

    Parameters
    ----------
    elasticity : SectorElasticity
    kept : ndarray of int, shape (n,)
        Unknowns to keep, in this order.
    held : ndarray of int
        Unknowns that are zero.
    expandable : bool
        Whether `Condensed.expand` will be asked for; it takes memory.

    Returns
    -------
    Condensed

    Raises
    ------
    FegearError
        If the stiffness is not positive definite.
    """
    if elasticity.whole is not None:
        stiffness, motions = between_kept(elasticity.whole, kept, held, motions=expandable)
        return Condensed(kept, stiffness, elasticity.size, (), motions)
    steps: list[Eliminated] = []
    matrices, dofs = _without_inner(elasticity, steps if expandable else None)
    leaf, depth = halved(elasticity.centres, dofs.size, _SMALLEST_PART)
    number, level_start, old = numbered(dofs, leaf, depth, elasticity.size, kept, held)
    parts = _smallest_parts(matrices, number[dofs], leaf, depth, level_start[-1])
    for level in range(depth + 1):
        if level:
            parts = [joined(*parts[i : i + 2]) for i in range(0, len(parts), 2)]
        parts = [reduced(*part, level_start[level + 1], old, steps if expandable else None) for part in parts]
    ((left, stiffness),) = parts
    order = np.searchsorted(left, number[kept])
    return Condensed(kept, symmetric(stiffness)[np.ix_(order, order)], elasticity.size, tuple(steps))


def _without_inner(elasticity: SectorElasticity, steps: list[Eliminated] | None) -> tuple[Array, Index]:
    """Elements without the unknowns that are their own (orders 3 and 4), all at once."""
    k, dofs, inside = elasticity.stiffness, elasticity.element_dofs, elasticity.inside
    if inside == 0:
        return k, dofs
    factor = cast("Array", np.linalg.cholesky(k[:, -inside:, -inside:]))
    border = cast("Array", np.linalg.solve(factor, k[:, -inside:, :-inside]))
    if steps is not None:
        gone, left = dofs[:, -inside:], dofs[:, :-inside]
        steps.append(Eliminated(gone, left, factor, border))
    return k[:, :-inside, :-inside] - border.transpose(0, 2, 1) @ border, dofs[:, :-inside]


def halved(centres: Array, incidences: int, smallest: int) -> tuple[Index, int]:
    """Smallest part of each element, numbered so that parts 2 i and 2 i + 1 join, and how often was halved.

    Parameters
    ----------
    centres : ndarray, shape (2, M)
    incidences : int
        Unknowns of all elements, one by one.
    smallest : int
        Unknowns that a smallest part has about.
    """
    elements = centres.shape[1]
    unknowns = 0.5 * incidences  # each is shared by two elements, about
    depth = max(0, round(np.log2(unknowns / smallest)))
    groups = [np.arange(elements)]
    for _ in range(depth):
        halves = []
        for group in groups:
            x = centres[:, group]
            along = x[int(np.argmax(np.ptp(x, axis=1)))]
            ordered = group[np.argsort(along, kind="stable")]
            halves += [ordered[: group.size // 2], ordered[group.size // 2 :]]
        groups = halves
    leaf = np.empty(elements, dtype=np.int64)
    for i, group in enumerate(groups):
        leaf[group] = i
    return leaf, depth


def numbered(
    dofs: Index, leaf: Index, depth: int, size: int, kept: Index, held: Index
) -> tuple[Index, list[int], Index]:
    """New number of each unknown, in the order of elimination; where each level starts; the old numbers."""
    first, last = np.full(size, 1 << depth), np.full(size, -1)
    whose = np.repeat(leaf, dofs.shape[1])
    np.minimum.at(first, dofs.reshape(-1), whose)
    np.maximum.at(last, dofs.reshape(-1), whose)
    # Two parts meet where their numbers first agree: at level l if the highest differing bit is bit l - 1.
    level = np.frexp((first ^ last).astype(float))[1].astype(np.int64)
    level[last < 0] = depth + 2  # eliminated already with its element
    level[kept] = depth + 1
    level[held] = depth + 2
    old = np.argsort(level, kind="stable")
    number = np.empty(size, dtype=np.int64)
    number[old] = np.arange(size)
    return number, np.searchsorted(level[old], np.arange(depth + 3)).tolist(), old


def _smallest_parts(matrices: Array, number: Index, leaf: Index, depth: int, free: int) -> list[tuple[Index, Array]]:
    """Unknowns (ascending) and stiffness of each smallest part; without the held unknowns."""
    parts: list[tuple[Index, Array]] = []
    order = np.argsort(leaf, kind="stable")
    bounds = np.searchsorted(leaf[order], np.arange((1 << depth) + 1))
    for begin, end in itertools.pairwise(bounds):
        chosen = order[begin:end]
        ids = number[chosen]
        every = np.unique(ids)
        row = np.searchsorted(every, ids)
        n = every.size
        place = row[:, :, None] * n + row[:, None, :]
        entries = cast("Array", np.bincount(place.reshape(-1), matrices[chosen].reshape(-1), n * n))
        stiffness = entries.reshape(n, n)
        m = int(np.searchsorted(every, free))
        parts.append((every[:m], stiffness[:m, :m]))
    return parts


def joined(one: tuple[Index, Array], other: tuple[Index, Array]) -> tuple[Index, Array]:
    """Unknowns of two parts and the sum of their stiffness, of which only the lower triangle is sure to be there."""
    if not (one[0].size and other[0].size):
        return one if one[0].size else other
    low, high = min(one[0][0], other[0][0]), max(one[0][-1], other[0][-1])
    there = np.zeros(high - low + 1, dtype=bool)
    there[one[0] - low] = there[other[0] - low] = True
    every, place = np.flatnonzero(there) + low, np.cumsum(there) - 1
    n = every.size
    entries = np.zeros((n, n))
    for ids, block in (one, other):
        at = place[ids - low]
        breaks = (np.flatnonzero(at[1:] - at[:-1] != 1) + 1).tolist()
        if (len(breaks) + 1) * _SHORTEST_RUN > at.size:
            entries.reshape(-1)[(at[:, None] * n + at).reshape(-1)] += block.reshape(-1)  # quicker than two indices
            continue
        runs = [
            (first, slice(int(at[first]), int(at[first]) + end - first), end)
            for first, end in itertools.pairwise([0, *breaks, at.size])
        ]
        for i, (first, rows, end) in enumerate(runs):
            for begin, columns, stop in runs[: i + 1]:
                entries[rows, columns] += block[first:end, begin:stop]
    return every, entries


def symmetric(lower: Array) -> Array:
    """The whole of a matrix whose lower triangle is known: the same, its upper triangle filled block by block."""
    n = lower.shape[0]
    for first in range(0, n, _BLOCK):
        end = min(first + _BLOCK, n)
        block = lower[first:end, first:end]
        block[...] = np.tril(block) + np.tril(block, -1).T
        lower[first:end, end:] = lower[end:, first:end].T
    return lower


def reduced(ids: Index, stiffness: Array, end: int, old: Index, steps: list[Eliminated] | None) -> tuple[Index, Array]:
    """Eliminate the unknowns numbered below `end`, which come first; reads and makes the lower triangle."""
    from scipy.linalg import lapack

    n = int(np.searchsorted(ids, end))
    if n == 0:
        return ids, stiffness
    factor, failed = lapack.dpotrf(stiffness[:n, :n], lower=1)
    if failed:
        raise FegearError("the sector's stiffness cannot be factored: it is not positive definite")
    # The block below the diagonal turned round: LAPACK's columns are its rows, copied as they lie.
    border = (
        cast("Array", lapack.dtrtrs(factor, stiffness[n:, :n].T, lower=1)[0]) if n < ids.size else stiffness[:n, n:]
    )
    if steps is not None:
        steps.append(Eliminated(old[ids[:n]], old[ids[n:]], factor, border))
    gone = border.T @ border
    return ids[n:], np.subtract(stiffness[n:, n:], gone, out=gone)
