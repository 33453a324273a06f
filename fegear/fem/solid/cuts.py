"""Where the section of a solid sector is cut in halves, again and again, so that eliminating its unknowns costs least.

What a part costs is known before it is eliminated: of n unknowns that nobody else has and m that stay, those of its
ports among them, come n^3/3 + n^2 m + n m^2 products. Straight cuts in many directions are judged by what the unknowns
on them cost, and by an estimate of what both sides will cost with all that the cut leaves them. Parts are halved as
long as that costs less than eliminating them whole.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index

#: Directions in which cuts are tried, and the least share of the elements on one side.
_DIRECTIONS, _LEAST_SHARE = 18, 0.05
#: How often is halved at most: numbers of parts stay exact as floating-point ones.
_DEEPEST = 48
#: What moving an entry of a matrix costs, in products.
_MOVED = 100.0
#: Digits of positions [modules]: what lies in one line stays in one order whatever the last bits.
_DIGITS = 9


class Halves(NamedTuple):
    """A section's parts.

    Attributes
    ----------
    part : ndarray of int, shape (M,)
        Of each element: parts 2 i and 2 i + 1 of the 2^depth join, and so on; many have no element.
    depth : int
        How often is halved at most.
    cost : float
        Of eliminating all, in products.
    """

    part: Index
    depth: int
    cost: float


class _Section(NamedTuple):
    """What halving looks at: directions' positions of elements, their nodes, and what nodes weigh."""

    along: Array
    nodes: Index
    free: Array
    carried: Array
    elements: Index


def halves(centres: Array, nodes: Index, free: Array, carried: Array) -> Halves:
    """Halve a section where that costs least.

    Parameters
    ----------
    centres : ndarray, shape (2, M)
        Of the elements [modules].
    nodes : ndarray of int, shape (M, n)
    free, carried : ndarray, shape (N,)
        Unknowns of each node that are eliminated, and that stay to the end.
    """
    angles = np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    along = np.round(np.cos(angles)[:, None] * centres[0] + np.sin(angles)[:, None] * centres[1], _DIGITS)
    section = _Section(along, nodes, free, carried, np.bincount(nodes.ravel(), minlength=free.size))
    cost, parts = _halved(section, np.arange(centres.shape[1]))
    depth = max(length for _, _, length in parts)
    part = np.empty(centres.shape[1], dtype=np.int64)
    for group, path, length in parts:
        part[group] = path << (depth - length)
    return Halves(part, depth, cost)


def products_of(n: Array, m: Array) -> Array:
    """What eliminating n unknowns costs while m stay."""
    return n * (n * n / 3.0 + n * m + m * m) + _MOVED * (n + m) ** 2


def _halved(section: _Section, group: Index, deep: int = 0) -> tuple[float, list[tuple[Index, int, int]]]:
    """Cost of a group of elements, and its parts: elements, which halves lead there, and how many."""
    own, local, times = np.unique(section.nodes[group], return_inverse=True, return_counts=True)
    inside = times == section.elements[own]
    heavy = np.where(inside, section.free[own], 0.0)
    stays = np.where(inside, 0.0, section.free[own]) + section.carried[own]
    m = stays.sum()
    whole = float(products_of(heavy.sum(), m))
    cut = _cheapest(section.along[:, group], local.reshape(section.nodes[group].shape), heavy, stays)
    if cut is None or deep == _DEEPEST:
        return whole, [(group, 0, 0)]
    ordered, at, n = cut
    near, far = (_halved(section, group[half], deep + 1) for half in (ordered[:at], ordered[at:]))
    cost = float(products_of(np.asarray(n), m)) + near[0] + far[0]
    if cost >= whole:
        return whole, [(group, 0, 0)]
    return cost, [
        (part, path | (side << length), length + 1)
        for side, (_, parts) in enumerate((near, far)) for part, path, length in parts
    ]  # fmt: skip


def _cheapest(along: Array, nodes: Index, heavy: Array, stays: Array) -> tuple[Index, int, float] | None:
    """Order of a group's elements, how many lie on the near side of the best cut, and the unknowns on it."""
    count = along.shape[1]
    if count < 2:
        return None
    low = max(1, math.floor(_LEAST_SHARE * count))
    places = np.arange(low, min(count - 1, count - low) + 1)
    own, rows = nodes.ravel(), np.repeat(np.arange(count), nodes.shape[1])
    least, found = math.inf, None
    for positions in along:
        ordered = np.argsort(positions, kind="stable")
        rank = np.empty(count, dtype=np.int64)
        rank[ordered] = np.arange(count)
        first, last = np.full(heavy.size, count), np.full(heavy.size, -1)
        np.minimum.at(first, own, rank[rows])
        np.maximum.at(last, own, rank[rows])
        # Before element i: what has begun and what has ended; elements on both sides share what has done one of both.
        begun, ended = (np.cumsum(np.bincount(one + 1, heavy, count + 2))[places] for one in (first, last))
        near = np.cumsum(np.bincount(first + 1, stays, count + 2))[places]
        far = stays.sum() - np.cumsum(np.bincount(last + 1, stays, count + 2))[places]
        on = begun - ended
        cost = (
            products_of(on.astype(float), stays.sum())
            + ended * (near + on) ** 2
            + (heavy.sum() - begun) * (far + on) ** 2
        )
        best = int(np.argmin(cost))
        if cost[best] < least:
            least, found = float(cost[best]), (ordered, int(places[best]), float(on[best]))
    return found
