"""Static condensation of the solid sector onto its ports, by halving the section again and again.

The section's unknowns are ordered by nested dissection as in the plane (`fegear.fem.plane.condensation`); each stands
for as many unknowns of the solid as it has functions along the face. The halves are worked off depth first, so that few
matrices exist at a time, and a smallest part is formed when its turn comes: its section matrices are short sums over
its elements, and the block between two functions along the face is a multiple of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.condensation import Condensed, Eliminated, numbered, symmetric
from fegear.fem.solid.cuts import halves
from fegear.fem.solid.fronts import Node, eliminated, joined
from fegear.fem.solid.unknowns import Unknowns
from fegear.fem.solid.whole_sector import condense_whole

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.solid.face import FaceFunctions, JoinedFunctions
    from fegear.fem.solid.section import Section


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
    stiffness = eliminated(root, lambda own: _smallest(section, products, number, own), natural, steps)
    return Condensed(natural[root.left], symmetric(stiffness).T, known.size, tuple(steps or ()))


def _smallest(
    section: Section, products: list[tuple[Array, Array, Array]], number: Index, elements: Index
) -> tuple[Index, Array]:
    """Unknowns, in the order of elimination by their numbers, and stiffness of a few elements, in any order.

    `products` are the face functions' over the part of the face that each zone of the section fills.
    """
    dofs = section.element_dofs[elements]
    every, local = np.unique(dofs, return_inverse=True)
    local = local.reshape(dofs.shape)
    n = every.size
    place = local[:, :, None] * n + local[:, None, :]
    functions = np.flatnonzero((number[every] >= 0).any(axis=0))
    own = number[every][:, functions].T
    rows = [np.flatnonzero(one >= 0) for one in own]  # unknowns that have a function
    start = np.concatenate([[0], np.cumsum([row.size for row in rows], dtype=np.int64)])
    none = np.zeros(0, dtype=np.int64)
    ids = np.concatenate([none, *(one[row] for one, row in zip(own, rows, strict=True))])
    matrix = np.zeros((ids.size, ids.size))
    for zone, product in enumerate(products):
        mine = section.zone[elements] == zone
        if not mine.any():
            continue
        a00, a01, a11 = (
            np.bincount(place[mine].ravel(), matrices[elements[mine]].ravel(), n * n).reshape(n, n)
            for matrices in section.stiffness
        )
        a10 = np.ascontiguousarray(a01.T)
        m0, m1, m2 = (part[np.ix_(functions, functions)] for part in product)
        for k, m in np.argwhere((m0 != 0.0) | (m1 != 0.0) | (m1.T != 0.0) | (m2 != 0.0)).tolist():
            both = np.ix_(rows[k], rows[m])
            block = matrix[start[k] : start[k + 1], start[m] : start[m + 1]]
            for a, factor in ((a00, m0[k, m]), (a01, m1[k, m]), (a10, m1[m, k]), (a11, m2[k, m])):
                if factor != 0.0:
                    block += factor * a[both]
    return ids, matrix
