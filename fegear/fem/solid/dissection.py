"""Static condensation of the solid sector onto its ports, by halving the section again and again.

The section's unknowns are ordered by nested dissection as in the plane (`fegear.fem.plane.condensation`); each stands
for as many unknowns of the solid as it has functions along the face. The halves are worked off depth first, so that few
matrices exist at a time, and a smallest part is formed when its turn comes: its section matrices are short sums over
its elements, and the block between two functions along the face is a multiple of them.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.fem.plane.condensation import Condensed, Eliminated, numbered, symmetric
from fegear.fem.solid.cuts import halves
from fegear.fem.solid.fronts import Front, Node, eliminated, joined
from fegear.fem.solid.unknowns import Unknowns
from fegear.fem.solid.whole_sector import condense_whole

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index, Mask
    from fegear.fem.solid.face import FaceFunctions, JoinedFunctions
    from fegear.fem.solid.section import Section

#: Entries that a smallest part is written in at once: of so few memory is at hand.
_AT_ONCE = 200_000


def condense_solid(
    section: Section, face: FaceFunctions | JoinedFunctions, known: Unknowns, kept: Index, *, expandable: bool = False
) -> Condensed:
    """Eliminate all unknowns but those of some of the section's.

    Parameters
    ----------
    section : Section
    face : FaceFunctions
    known : Unknowns
    kept : ndarray of int
        Unknowns of the section; all that they stand for is kept, in this order.
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
    if section.whole is not None:
        return condense_whole(section, section.whole, face, known, kept, expandable=expandable)
    dofs = section.element_dofs
    counts = (known.number >= 0).sum(axis=1)
    carried = np.zeros_like(counts)
    carried[kept] = counts[kept]
    leaf, depth, _ = halves(
        section.centres, dofs[:, ::3] // 3,
        *(one.reshape(-1, 3).sum(axis=1).astype(float) for one in (counts - carried, carried)),
    )  # fmt: skip
    held = np.flatnonzero(counts == 0)
    stays = kept[counts[kept] > 0]
    order, level_start, old = numbered(dofs, leaf, depth, section.size, stays, held)
    # What is kept stands in the order that is wanted: nothing needs sorting in the end.
    old[level_start[depth + 1] : level_start[depth + 2]] = stays
    order[stays] = level_start[depth + 1] + np.arange(stays.size)
    # Each unknown of the section brings its functions along the face to its place in the order of elimination.
    first = np.concatenate([[0], np.cumsum(counts[old])])
    rank = np.where(known.number >= 0, np.cumsum(known.number >= 0, axis=1) - 1, 0)
    number = np.where(known.number >= 0, first[order][:, None] + rank, -1)
    ends = [int(first[start]) for start in level_start]
    natural = np.empty(known.size, dtype=np.int64)
    natural[number[number >= 0]] = known.number[known.number >= 0]
    steps: list[Eliminated] | None = [] if expandable else None
    elements = np.argsort(leaf, kind="stable")
    leaf = leaf[elements]
    products = section.products_along(face)

    def part(level: int, i: int) -> Node | None:
        first, middle, end = np.searchsorted(leaf, [i << level, (2 * i + 1) << level >> 1, (i + 1) << level]).tolist()
        if first == end:
            return None
        goes = ends[level + 1]
        if level == 0:
            own = elements[first:end]
            ids = number[np.unique(dofs[own])]
            ids = np.sort(ids[ids >= 0])
            return Node(ids, int(np.searchsorted(ids, goes)), (), own) if ids.size else None
        # The larger half first: what is made on its way is gone when the other's is.
        larger = 2 * (middle - first) >= end - first
        both = (part(level - 1, one) for one in sorted((2 * i, 2 * i + 1), reverse=not larger))
        parts = tuple(half for half in both if half is not None)
        if len(parts) == 1 and parts[0].left.size and parts[0].left[0] >= goes:
            return parts[0]
        return joined(parts, goes) if parts else None

    root = part(depth, 0)
    if root is None:
        raise ValueError("the section has no unknowns")
    stiffness = eliminated(root, lambda own, front: _smallest(section, products, number, own, front), natural, steps)
    return Condensed(natural[root.left], symmetric(stiffness).T, known.size, tuple(steps or ()))


def _smallest(
    section: Section, products: list[tuple[Array, Array, Array]], number: Index, elements: Index, front: Front
) -> None:
    """Write the stiffness of a few elements into their front.

    Every entry is a sum of a few products of an entry between unknowns of the section and one between functions along
    the face, which all entries of a group have in common (`_groups`): the block between two groups is one product of
    two matrices, whose rows and columns are then put in order. `products` are those of the functions over the part of
    the face that each zone of the section fills.
    """
    every, local = np.unique(section.element_dofs[elements], return_inverse=True)
    lowest = np.where(number[every] >= 0, number[every], number.max() + 1).min(axis=1)
    sequence = np.argsort(lowest, kind="stable")
    has = number[every[sequence]] >= 0
    has = has[has.any(axis=1)]
    rank = np.empty_like(sequence)
    rank[sequence] = np.arange(sequence.size)
    in_section, along = _factors(section, products, elements, rank[local].reshape(elements.size, -1), has.shape[0])

    groups = _groups(has, front.inner.shape[0])
    for i, columns in enumerate(groups):
        for rows in groups[i:]:
            target = front.block(rows.places, columns.places).T
            target = target.reshape(columns.repeated, -1, rows.repeated, target.shape[1] // rows.repeated)
            for (column, at, functions), (row, own_at, own) in itertools.product(columns.unknowns, rows.unknowns):
                pairs = along[:, functions[:, None], own].reshape(along.shape[0], -1)
                sections = in_section[:, column, row]
                step = max(1, _AT_ONCE // (pairs.shape[1] * rows.repeated))
                for first in range(0, columns.repeated, step):
                    some = sections[:, first : first + step]
                    block = some.reshape(along.shape[0], -1).T @ pairs
                    target[first : first + step, at, :, own_at] = block.reshape(
                        some.shape[1], rows.repeated, functions.size, own.size
                    ).transpose(0, 2, 1, 3)


class _Group(NamedTuple):
    """Unknowns of the section that follow each other, whose functions repeat after one, two or three.

    Attributes
    ----------
    places : slice
        Of all that they stand for.
    repeated : int
        How often.
    unknowns : list of (slice, slice, ndarray of int)
        Of each that is repeated, which of the section's, their places within what is repeated, and their functions.
    """

    places: slice
    repeated: int
    unknowns: list[tuple[slice, slice, Index]]


def _groups(has: Mask, gone: int) -> list[_Group]:
    """Groups of unknowns, which either all go or all stay.

    Parameters
    ----------
    has : ndarray of bool, shape (n, functions)
        Which functions each unknown of the section has, in the order of elimination.
    gone : int
        How many of what they stand for go.
    """
    counts = has.sum(axis=1)
    starts = np.concatenate([[0], np.cumsum(counts)])
    kind = np.unique(has, axis=0, return_inverse=True)[1].reshape(-1)
    border = int(np.searchsorted(starts, gone))
    # From each unknown on, how many have the functions of the one that is one, two or three behind them.
    like = []
    for period in (1, 2, 3):
        same = np.zeros(kind.size, dtype=bool)
        same[:-period] = kind[:-period] == kind[period:]
        same[max(border - period, 0) : border] = False
        where = np.append(np.flatnonzero(~same), kind.size)
        like.append(where[np.searchsorted(where, np.arange(kind.size))] - np.arange(kind.size))
    found, first = [], 0
    while first < kind.size:
        lengths = [(period * (int(like[period - 1][first]) // period + 1), -period) for period in (1, 2, 3)]
        end = border if first < border else kind.size
        length, period = max(one for one in lengths if first + one[0] <= end)
        period = -period
        within = starts[first : first + period + 1] - starts[first]
        found.append(_Group(
            slice(int(starts[first]), int(starts[first + length])), length // period,
            [
                (slice(first + i, first + length, period), slice(int(within[i]), int(within[i + 1])),
                 np.flatnonzero(has[first + i]))
                for i in range(period)
            ],
        ))  # fmt: skip
        first += length
    return found


def _factors(
    section: Section, products: list[tuple[Array, Array, Array]], elements: Index, local: Index, size: int
) -> tuple[Array, Array]:
    """What each zone's elements give between the section's first unknowns, and the functions' products with each.

    Returns
    -------
    in_section : ndarray, shape (4 zones, size, size)
    along : ndarray, shape (4 zones, functions, functions)
    """
    n = int(local.max()) + 1
    place = local[:, :, None] * n + local[:, None, :]
    in_section, along = [], []
    for zone, (m0, m1, m2) in enumerate(products):
        mine = section.zone[elements] == zone
        if not mine.any():
            continue
        a00, a01, a11 = (
            np.bincount(place[mine].ravel(), matrices[elements[mine]].ravel(), n * n).reshape(n, n)[:size, :size]
            for matrices in section.stiffness
        )
        in_section += [a00, a01, a01.T, a11]
        along += [m0, m1, m1.T, m2]
    return np.stack(in_section), np.stack(along)
