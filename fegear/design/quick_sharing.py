"""Load sharing good enough to search with: straight laws for every set of loaded pairs, and the least approach of them.

With straight laws u_j = b_j + sum_j' t_jj' W_j' the pairs of a set S that carry the load W together approach by

    zeta_S = (W + sum_S y_j (b_j + e_j)) / sum_S y_j,    y = t_SS^-1 1,

and, as the total load at a given approach is the largest over all sets (pairs cannot pull), the true approach is the
least zeta_S. The logarithm of the contact is replaced by its tangent at an even share: a pair alone is exact. Tip
reliefs are convex along the path, so that the loaded pairs are neighbours and other sets need not be tried.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Floats
from fegear.contact.plane.roll_grids import RollGrid


@dataclass(frozen=True)
class LoadedSet:
    """Neighbouring pairs that carry the load together, over the states at which all of them are in reach.

    Parameters
    ----------
    pairs : range
        Rows of the pairs.
    states : slice
        From the first to the last of the N states at which all are in reach.
    base : ndarray, shape (M,)
        zeta_S without modifications [m]; infinite where a pair is out of reach.
    weight : ndarray, shape (S, M)
        d zeta_S / d m_j of the S pairs.
    """

    pairs: range
    states: slice
    base: Floats
    weight: Floats


@dataclass(frozen=True)
class QuickSharing:
    """Approach of a pair at N states (roll positions times loads) as a function of the modifications.

    Parameters
    ----------
    sets : tuple of LoadedSet
    size : int
        N.
    """

    sets: tuple[LoadedSet, ...]
    size: int

    @cached_property
    def every_set(self) -> tuple[Floats, Floats]:
        """Approach without modifications, shape (S, N), infinite where not all are in reach, and weights, (S, n, N)."""
        pairs = max(s.pairs.stop for s in self.sets)
        base, weight = np.full((len(self.sets), self.size), np.inf), np.zeros((len(self.sets), pairs, self.size))
        for row, s in enumerate(self.sets):
            base[row, s.states] = s.base
            weight[row, s.pairs.start : s.pairs.stop, s.states] = s.weight
        return base, weight

    def by_set(self, m: Floats) -> Floats:
        """zeta_S [m], shape (C, S, N), for modifications m [m], shape (C, n, N)."""
        base, weight = self.every_set
        return np.asarray(base + np.einsum("sjn,cjn->csn", weight, m))


def quick_sharing(grid: RollGrid, loads: Floats) -> QuickSharing:
    """Set up at the P roll positions of a grid under loads [N], shape (L,): N = P L states, loads fastest."""
    contacts, matrices = grid.contacts, grid.matrices
    n, positions = contacts.x.shape
    count = loads.size
    gap = np.broadcast_to(np.where(contacts.present, contacts.gap, 0.0)[:, :, None], (n, positions, count))
    sets = []
    for pairs in (range(i, k) for i in range(n) for k in range(i + 1, n + 1)):
        there = np.logical_and.reduce(contacts.present[pairs.start : pairs.stop], axis=0)
        if not there.any():
            continue
        share = np.broadcast_to(loads / len(pairs), (n, positions, count))
        tangent, secant = matrices.tangent(share), matrices.at_load(share)
        t = np.where(there[:, None], tangent[np.ix_(pairs, pairs)], np.eye(len(pairs))[:, :, None, None])
        y = np.linalg.solve(np.moveaxis(t, (0, 1), (-2, -1)), np.ones((len(pairs), 1)))[..., 0]
        y = np.moveaxis(y, -1, 0)
        v = y / y.sum(axis=0)
        offset = (secant - tangent)[pairs, pairs] * share[pairs] + gap[pairs]
        base = np.where(there[:, None], loads / y.sum(axis=0) + (v * offset).sum(axis=0), np.inf)
        first, last = int(there.argmax()), positions - int(there[::-1].argmax())
        states = slice(first * count, last * count)
        # Single precision: 1e-6 um of a deflection, at half the time.
        rough = [a.reshape(*a.shape[:-2], -1)[..., states].astype(np.float32) for a in (base, v)]
        sets.append(LoadedSet(pairs, states, *rough))
    return QuickSharing(tuple(sets), positions * count)
